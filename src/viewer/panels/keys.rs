//! What the keyboard does.

use egui::{Grid, Ui};

use crate::viewer::control::hint;
use crate::viewer::document::Document;
use crate::viewer::shortcuts::KEYS;
use crate::viewer::stage::Stage;

/// Shows the panel.
pub fn show(ui: &mut Ui, _: &mut Document, _: &Stage) {
    Grid::new("keys").num_columns(2).show(ui, |ui| {
        for (keys, meaning) in KEYS {
            ui.monospace(keys);
            ui.add(egui::Label::new(meaning).wrap());
            ui.end_row();
        }
    });
    hint(ui, "Tab leads to the next control; Enter on a control's name puts it back.");
}
