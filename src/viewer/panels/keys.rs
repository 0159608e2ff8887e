//! What the keyboard does.

use egui::{Grid, Label, Ui};

use crate::viewer::control::hint;
use crate::viewer::document::Document;
use crate::viewer::shortcuts::KEYS;
use crate::viewer::stage::Stage;

/// The widths of the two columns, in points.
const NAMES: f32 = 110.0;
const MEANINGS: f32 = 150.0;

/// Shows the panel.
pub fn show(ui: &mut Ui, _: &mut Document, _: &Stage) {
    Grid::new("keys").num_columns(2).striped(true).min_col_width(NAMES).max_col_width(NAMES).show(ui, |ui| {
        for (keys, meaning) in KEYS {
            ui.add(Label::new(keys).wrap());
            ui.vertical(|ui| {
                ui.set_max_width(MEANINGS);
                ui.add(Label::new(meaning).wrap());
            });
            ui.end_row();
        }
    });
    hint(ui, "Tab leads to the next control; Enter on a control's name puts it back.");
}
