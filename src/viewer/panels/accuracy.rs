//! How exact the glare is: what is asked, what was planned for it, and what is measured.

use egui::{Grid, RichText, Ui, vec2};

use super::by_hand;
use crate::plan::{Cost, Plan, Source};
use crate::scene::Goal;
use crate::viewer::control::{Number, buttons, flag, hint};
use crate::viewer::document::Document;
use crate::viewer::stage::Stage;
use crate::viewer::study::{DECADES, colour};

const TOLERANCES: Number = Number {
    name: "Tolerance",
    about: "Largest error at any pixel, as a part of the largest glare of the same colour.",
    unit: "of the largest",
    range: 1e-6..=0.1,
    logarithmic: true,
};

const BUDGETS: Number = Number {
    name: "Budget",
    about: "Time for spectrum and field; the glare is as exact as it allows.",
    unit: "ms",
    range: 0.1..=2000.0,
    logarithmic: true,
};

/// What a budget begins with, in milliseconds.
const BUDGET: f64 = 50.0;
const TOLERANCE: f64 = 1e-3;

const GOALS: [(bool, &str, &str); 2] =
    [(false, "Tolerance", "the cheapest plan within an error"), (true, "Budget", "the most exact plan within a time")];

/// Shows the panel.
pub fn show(ui: &mut Ui, document: &mut Document, stage: &Stage) {
    goal(ui, document);
    by_hand::show(ui, document, stage);
    measured(ui, document, stage);
    let Some(plan) = stage.plan() else { return };
    let note = if stage.is_preview() { ", a preview" } else { "" };
    let beside = plan.costs.first().and_then(Cost::beside).map_or(String::new(), |beside| format!(", {beside}"));
    ui.label(format!("{} ghosts by {}{beside}{note}", plan.ghosts(), plan.evaluator()));
    if plan.terms() > 0 {
        ui.label(format!("degree {} × {}, {} terms", plan.degree()[0], plan.degree()[1], plan.terms()));
    }
    prediction(ui, plan);
    candidates(ui, plan);
}

fn goal(ui: &mut Ui, document: &mut Document) {
    let opened = document.opened.accuracy;
    let goal = &mut document.look.accuracy.goal;
    let mut by_budget = goal.budget().is_some();
    let about = "What the plan is to reach.";
    buttons(ui, "Goal", about, &mut by_budget, &GOALS, opened.goal.budget().is_some());
    if by_budget != goal.budget().is_some() {
        // Back to what it was opened with, where that is of the kind.
        *goal = match (by_budget, opened.goal) {
            (true, Goal::Tolerance(_)) => Goal::Budget(BUDGET),
            (false, Goal::Budget(_)) => Goal::Tolerance(TOLERANCE),
            (_, opened) => opened,
        };
    }
    match (goal, opened.goal) {
        (Goal::Tolerance(tolerance), Goal::Tolerance(reset)) => TOLERANCES.show(ui, tolerance, reset),
        (Goal::Tolerance(tolerance), Goal::Budget(_)) => TOLERANCES.show(ui, tolerance, TOLERANCE),
        (Goal::Budget(budget), opened) => BUDGETS.show(ui, budget, opened.budget().unwrap_or(BUDGET)),
    };
    let about = "Where the tolerance cannot be had, take the lowest that can.";
    flag(ui, "Allow floor", about, &mut document.look.accuracy.allow_floor, opened.allow_floor);
}

/// The error that was measured, and where it may be looked at.
fn measured(ui: &mut Ui, document: &mut Document, stage: &Stage) {
    let wanted = &mut document.viewing.wanted;
    let about =
        "Measures the error against the direct sum in f64, at some hundred pixels, once nothing has moved for 0.3 s.";
    flag(ui, "Measure", about, &mut wanted.certificate, true);
    let text = match stage.known().certificate() {
        _ if !wanted.certificate => None,
        Some(found) if found.measured <= found.predicted => {
            let about = format!("{:.1e} at {} pixels, within the prediction", found.measured, found.pixels);
            Some(RichText::new(format!("measured {about}")))
        }
        Some(found) => {
            let text = format!("measured {:.1e} at {} pixels, more than predicted", found.measured, found.pixels);
            Some(RichText::new(text).color(ui.visuals().error_fg_color))
        }
        None => Some(RichText::new("not measured yet").weak()),
    };
    if let Some(text) = text {
        ui.label(text);
    }
    let about = "|field − direct sum| over the picture, the worst colour; coarse at first, then up to 160 000 pixels.";
    flag(ui, "False colours", about, &mut wanted.error_map, false);
    if wanted.error_map {
        legend(ui);
    }
}

/// The false colours' scale.
fn legend(ui: &mut Ui) {
    let width = ui.available_width().min(260.0);
    let (bar, _) = ui.allocate_exact_size(vec2(width, 12.0), egui::Sense::hover());
    let steps = 64;
    for step in 0..steps {
        let [from, to] = [step, step + 1].map(|step| step as f32 / steps as f32);
        let part = 10f64.powf(DECADES * (f64::from(to) - 1.0));
        let [left, right] = [from, to].map(|at| bar.left() + at * bar.width());
        ui.painter().rect_filled(bar.with_min_x(left).with_max_x(right + 0.5), 0.0, colour(part));
    }
    ui.horizontal(|ui| {
        ui.set_max_width(width);
        hint(ui, "0.0001");
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| hint(ui, "1 × tolerance"));
    });
    hint(ui, "magenta: beyond the tolerance");
}

/// Every line of the predicted error.
fn prediction(ui: &mut Ui, plan: &Plan) {
    Grid::new("prediction").num_columns(2).striped(true).show(ui, |ui| {
        ui.strong("predicted error").on_hover_text("At most, relative to the largest glare of the same colour");
        ui.strong(format!("{:.1e}", plan.predicted.total()));
        ui.end_row();
        for Source { name, about, error } in plan.predicted.sources() {
            ui.label(name).on_hover_text(format!("from {about}"));
            ui.label(if error > 0.0 { format!("{error:.1e}") } else { "0".into() });
            ui.end_row();
        }
    });
}

/// What the plan was chosen from.
fn candidates(ui: &mut Ui, plan: &Plan) {
    let tip = "What each evaluator is expected to take, by the machine's calibration; the cheapest was chosen";
    Grid::new("candidates").num_columns(2).striped(true).show(ui, |ui| {
        ui.strong("candidates").on_hover_text(tip);
        ui.strong("cost");
        ui.end_row();
        for (rank, cost) in plan.costs.iter().enumerate() {
            let beside = cost.beside().map_or(String::new(), |beside| format!(", {beside}"));
            let chosen = if rank == 0 { " (chosen)" } else { "" };
            ui.label(format!("{}{beside}{chosen}", cost.evaluator));
            ui.label(format!("{:.1} ms", cost.milliseconds));
            ui.end_row();
        }
        for refusal in &plan.refused {
            ui.label(refusal.evaluator.to_string());
            ui.weak("refused").on_hover_text(&refusal.reason);
            ui.end_row();
        }
    });
}
