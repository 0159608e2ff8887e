//! What is planned unless it is set by hand: evaluator, degree and period.

use egui::{ComboBox, DragValue, Ui};
use glam::DVec2;

use crate::choices::Evaluator;
use crate::plan::HIGHEST_DEGREE;
use crate::viewer::control::place;
use crate::viewer::document::Document;
use crate::viewer::stage::Stage;

/// What the evaluators are called where the prototype's terms are known.
fn name(evaluator: Option<Evaluator>) -> String {
    match evaluator {
        None => "planned".into(),
        Some(Evaluator::Direct) => "direct (non-parametric)".into(),
        Some(series) => format!("{series} (parametric)"),
    }
}

/// Shows the controls, folded away at first.
pub fn show(ui: &mut Ui, document: &mut Document, stage: &Stage) {
    let shown = ui.collapsing("By hand", |ui| {
        evaluator(ui, document);
        degree(ui, document, stage);
        period(ui, document, stage);
        constant(ui, document, stage);
    });
    ui.data_mut(|data| data.insert_temp(place("By hand"), shown.header_response.rect));
}

fn evaluator(ui: &mut Ui, document: &mut Document) {
    let evaluator = &mut document.look.accuracy.evaluator;
    ui.horizontal(|ui| {
        ui.label("Evaluator");
        let combo = ComboBox::from_id_salt("evaluator").selected_text(name(*evaluator)).show_ui(ui, |ui| {
            ui.selectable_value(evaluator, None, name(None));
            for choice in Evaluator::ALL {
                let label = ui.selectable_value(evaluator, Some(choice), name(Some(choice)));
                ui.data_mut(|data| data.insert_temp(place(&format!("Evaluator {choice}")), label.rect));
            }
        });
        ui.data_mut(|data| data.insert_temp(place("Evaluator"), combo.response.rect));
        combo.response.on_hover_text("Non-parametric sums the bells at every pixel, parametric sums their series");
    });
}

fn degree(ui: &mut Ui, document: &mut Document, stage: &Stage) {
    let degree = &mut document.look.accuracy.degree;
    let tip = format!("Highest harmonic of x and y, 0 to {HIGHEST_DEGREE}; planned where it is not set");
    ui.horizontal(|ui| {
        let mut set = degree.is_some();
        if ui.checkbox(&mut set, "Degree").on_hover_text(&tip).changed() {
            *degree = set.then(|| stage.plan().map_or([16; 2], |plan| plan.degree));
        }
        for (name, side) in ["N ", "M "].into_iter().zip(degree.iter_mut().flatten()) {
            ui.add(DragValue::new(side).range(0..=HIGHEST_DEGREE).speed(0.2).prefix(name)).on_hover_text(&tip);
        }
    });
}

fn period(ui: &mut Ui, document: &mut Document, stage: &Stage) {
    let period = &mut document.look.accuracy.period;
    let tip = "Period of the series in x and y, 0.1 to 100 half picture heights; planned where it is not set";
    ui.horizontal(|ui| {
        let mut set = period.is_some();
        if ui.checkbox(&mut set, "Period").on_hover_text(tip).changed() {
            *period = set.then(|| stage.plan().map_or(DVec2::splat(4.0), |plan| plan.period));
        }
        if let Some(DVec2 { x, y }) = period {
            for (name, side) in [("T₁ ", x), ("T₂ ", y)] {
                let value = DragValue::new(side).range(0.1..=100.0).speed(0.01).max_decimals(4).prefix(name);
                ui.add(value).on_hover_text(tip);
            }
        }
    });
}

fn constant(ui: &mut Ui, document: &mut Document, stage: &Stage) {
    let series = stage.plan().is_some_and(|plan| plan.terms > 0);
    let mut seen = !document.viewing.without_constant;
    let tip = "Whether the series' constant term is seen: the field's mean over a period. Of the view only; stretched \
               values are the same without it";
    let check = ui.add_enabled(series, egui::Checkbox::new(&mut seen, "Constant term (DC)"));
    if check.on_hover_text(tip).on_disabled_hover_text("The plan has no series").changed() {
        document.viewing.without_constant = !seen;
    }
}
