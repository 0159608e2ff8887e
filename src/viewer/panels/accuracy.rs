//! How exact the glare is, and what was planned for that.

use egui::Ui;

use crate::scene::Goal;
use crate::viewer::control::Number;
use crate::viewer::document::Document;
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
    if let Goal::Tolerance(tolerance) = &mut document.look.accuracy.goal {
        let reset = match document.opened.accuracy.goal {
            Goal::Tolerance(tolerance) => tolerance,
            Goal::Budget(_) => 1e-3,
        };
        TOLERANCES.show(ui, tolerance, reset);
    }
    let Some(plan) = stage.plan() else { return };
    let note = if stage.is_preview() { ", a preview" } else { "" };
    ui.label(format!("{} ghosts by {}{note}", plan.ghosts(), plan.evaluator));
    ui.label(format!("degree {} × {}, {} terms", plan.degree[0], plan.degree[1], plan.terms));
    ui.label(format!("predicted error {:.1e}", plan.predicted.total()));
}
