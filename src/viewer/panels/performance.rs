//! What was computed, and how long it took.

use egui::{Grid, Ui};

use crate::viewer::document::Document;
use crate::viewer::stage::Stage;

/// Shows the panel.
pub fn show(ui: &mut Ui, _: &mut Document, stage: &Stage) {
    let (times, counts) = (stage.times(), stage.counts());
    Grid::new("times").num_columns(3).show(ui, |ui| {
        for (name, milliseconds, count) in [
            ("plan", times.plan, counts.spectra),
            ("spectrum", times.spectrum, counts.spectra),
            ("field and composite", times.composite, counts.composites),
        ] {
            ui.label(name);
            ui.label(format!("{milliseconds:.1} ms"));
            ui.label(format!("{count} times"));
            ui.end_row();
        }
        ui.label("view");
        ui.label("");
        ui.label(format!("{} times", counts.views));
        ui.end_row();
    });
}
