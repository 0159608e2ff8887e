//! How exact the glare is, and what was planned for that.

use egui::Ui;

use crate::viewer::control::Number;
use crate::viewer::document::Document;
use crate::viewer::look::TOLERANCE;
use crate::viewer::stage::Stage;

const TOLERANCES: Number = Number {
    name: "Tolerance",
    about: "Largest error at any pixel, relative to the largest glare of the same colour.",
    unit: "",
    range: 1e-5..=0.1,
    logarithmic: true,
};

/// Shows the panel.
pub fn show(ui: &mut Ui, document: &mut Document, stage: &Stage) {
    TOLERANCES.show(ui, &mut document.look.tolerance, TOLERANCE);
    let Some(plan) = stage.plan() else { return };
    let note = if stage.is_preview(document) { ", a preview" } else { "" };
    ui.label(format!("{} ghosts by {}{note}", plan.ghosts(), plan.evaluator));
    ui.label(format!("degree {} × {}, {} terms", plan.degree[0], plan.degree[1], plan.terms));
    ui.label(format!("predicted error {:.1e}", plan.predicted.total()));
}
