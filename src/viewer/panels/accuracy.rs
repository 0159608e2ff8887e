//! How exact the glare is: what is asked, what was planned for it, and what is measured.

use egui::{Grid, RichText, Ui, vec2};

use super::by_hand;
use crate::plan::Plan;
use crate::scene::Goal;
use crate::viewer::control::Number;
use crate::viewer::document::Document;
use crate::viewer::stage::Stage;
use crate::viewer::study::{DECADES, colour};

const TOLERANCES: Number = Number {
    name: "Tolerance",
    about: "Largest error at any pixel, relative to the largest glare of the same colour.",
    unit: "",
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

/// Shows the panel.
pub fn show(ui: &mut Ui, document: &mut Document, stage: &Stage) {
    goal(ui, document);
    by_hand::show(ui, document, stage);
    measured(ui, document, stage);
    let Some(plan) = stage.plan() else { return };
    let note = if stage.is_preview() { ", a preview" } else { "" };
    let direct = match plan.summed() {
        summed if summed > 0 && summed < plan.ghosts() => format!(", {summed} of them directly"),
        _ => String::new(),
    };
    ui.label(format!("{} ghosts by {}{direct}{note}", plan.ghosts(), plan.evaluator));
    if plan.terms > 0 {
        ui.label(format!("degree {} × {}, {} terms", plan.degree[0], plan.degree[1], plan.terms));
    }
    prediction(ui, plan);
    candidates(ui, plan);
}

fn goal(ui: &mut Ui, document: &mut Document) {
    let opened = document.opened.accuracy.goal;
    let goal = &mut document.look.accuracy.goal;
    ui.horizontal(|ui| {
        let tolerance = ui.radio(goal.budget().is_none(), "Tolerance");
        if tolerance.on_hover_text("The cheapest plan within an error").clicked() && goal.budget().is_some() {
            *goal = Goal::Tolerance(TOLERANCE);
        }
        let budget = ui.radio(goal.budget().is_some(), "Budget");
        if budget.on_hover_text("The most exact plan within a time").clicked() && goal.budget().is_none() {
            *goal = Goal::Budget(BUDGET);
        }
    });
    match (goal, opened) {
        (Goal::Tolerance(tolerance), Goal::Tolerance(reset)) => TOLERANCES.show(ui, tolerance, reset),
        (Goal::Tolerance(tolerance), Goal::Budget(_)) => TOLERANCES.show(ui, tolerance, TOLERANCE),
        (Goal::Budget(budget), opened) => BUDGETS.show(ui, budget, opened.budget().unwrap_or(BUDGET)),
    };
    ui.checkbox(&mut document.look.accuracy.allow_floor, "Allow the floor")
        .on_hover_text("Where 32-bit floats cannot be as exact as asked, be as exact as they can");
}

/// The error that was measured, and where it may be looked at.
fn measured(ui: &mut Ui, document: &mut Document, stage: &Stage) {
    let wanted = &mut document.viewing.wanted;
    ui.checkbox(&mut wanted.certificate, "Measure the error")
        .on_hover_text("Against the direct sum in f64, at some hundred pixels, once nothing has moved for 0.3 s");
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
    ui.checkbox(&mut wanted.error_map, "Error in false colours").on_hover_text(
        "|field − direct sum| over the picture, the worst colour; coarse at first, then up to 160 000 pixels",
    );
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
        ui.small("0.0001");
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| ui.small("1 × tolerance"));
    });
    ui.small("magenta: beyond the tolerance");
}

/// Every line of the predicted error.
fn prediction(ui: &mut Ui, plan: &Plan) {
    let predicted = &plan.predicted;
    let lines = [
        ("ghosts left out", "Too faint to reach the picture", predicted.dropped),
        ("periodisation", "Copies of the bells, a period away", predicted.periodisation),
        ("truncation", "Harmonics that are left out", predicted.truncation),
        ("interpolation", "Between the lattice's nodes", predicted.interpolation),
        ("gathering", "Moments of cells that are left out", predicted.gathering),
        ("rounding", "32-bit floats while they compute", predicted.rounding),
        ("storage", "32-bit floats as passes leave them to each other", predicted.storage),
    ];
    Grid::new("prediction").num_columns(2).striped(true).show(ui, |ui| {
        ui.strong("predicted error").on_hover_text("At most, relative to the largest glare of the same colour");
        ui.strong(format!("{:.1e}", predicted.total()));
        ui.end_row();
        for (name, about, error) in lines {
            ui.label(name).on_hover_text(about);
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
            let beside = match cost.summed {
                summed if summed > 0 && summed < plan.ghosts() => format!(" + {summed} direct"),
                _ => String::new(),
            };
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
