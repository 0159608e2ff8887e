//! What is planned unless it is set by hand: evaluator, degree and period.

use egui::{DragValue, Ui};
use glam::DVec2;

use crate::choices::Evaluator;
use crate::plan::HIGHEST_DEGREE;
use crate::viewer::control::{self, Tip, brief, choice};
use crate::viewer::document::Document;
use crate::viewer::stage::Stage;

/// What the evaluators are called where the prototype's terms are known.
fn name(evaluator: Option<Evaluator>) -> String {
    match evaluator {
        None => "planned".into(),
        Some(bells) if !bells.is_series() => format!("{bells} (non-parametric)"),
        Some(series) => format!("{series} (parametric)"),
    }
}

/// Shows the controls, folded away at first.
pub fn show(ui: &mut Ui, document: &mut Document, stage: &Stage) {
    control::fold(ui, "By hand", "Sets what is planned otherwise: evaluator, degree and period", |ui| {
        evaluator(ui, document);
        degree(ui, document, stage);
        period(ui, document, stage);
        constant(ui, document);
    });
}

fn evaluator(ui: &mut Ui, document: &mut Document) {
    let all: Vec<_> = std::iter::once(None)
        .chain(Evaluator::ALL.map(Some))
        .chain([Some(Evaluator::Plate)])
        .map(|one| (one, name(one)))
        .collect();
    let choices: Vec<_> = all.iter().map(|(one, name)| (*one, name.as_str(), "")).collect();
    let about = "Non-parametric sums the bells, at every pixel or where they reach, parametric sums their series.";
    let (opened, evaluator) = (document.opened.accuracy.evaluator, &mut document.look.accuracy.evaluator);
    choice(ui, "Evaluator", about, evaluator, &choices, opened);
}

fn degree(ui: &mut Ui, document: &mut Document, stage: &Stage) {
    let opened = document.opened.accuracy.degree;
    let degree = &mut document.look.accuracy.degree;
    let span = format!("N and M, 0 to {HIGHEST_DEGREE}; planned where it is not set");
    let reset = opened.map_or("planned".into(), |[n, m]| format!("{n} and {m}"));
    let tip = Tip { name: "Degree", about: "Highest harmonic of x and y.", span, reset };
    let row = tip.row(ui, |ui| {
        let mut set = degree.is_some();
        let mut all = ui.checkbox(&mut set, "");
        if all.changed() {
            *degree = set.then(|| stage.plan().map_or([16; 2], |plan| plan.degree()));
        }
        for (name, side) in ["N ", "M "].into_iter().zip(degree.iter_mut().flatten()) {
            all |= ui.add(DragValue::new(side).range(0..=HIGHEST_DEGREE).speed(0.2).prefix(name));
        }
        all
    });
    if row.back {
        *degree = opened;
    }
}

fn period(ui: &mut Ui, document: &mut Document, stage: &Stage) {
    let (opened, before) = (document.opened.accuracy.period, document.look.accuracy.period);
    let mut period = before;
    let span = "T₁ and T₂, 0.1 to 100 of the look's unit; planned where it is not set".to_owned();
    let reset = opened.map_or("planned".into(), |DVec2 { x, y }| format!("{} and {}", brief(x), brief(y)));
    let about = "Period of the series in x and y; by hand wherever a bell is periodic itself.";
    let tip = Tip { name: "Period", about, span, reset };
    let row = tip.row(ui, |ui| {
        let mut set = period.is_some();
        let mut all = ui.checkbox(&mut set, "");
        if all.changed() {
            period = set.then(|| stage.plan().map_or(DVec2::splat(4.0), |plan| plan.period()));
        }
        if let Some(DVec2 { x, y }) = &mut period {
            for (name, side) in [("T₁ ", x), ("T₂ ", y)] {
                let value = DragValue::new(side).range(0.1..=100.0).clamp_existing_to_range(false);
                all |= ui.add(value.speed(0.01).max_decimals(4).prefix(name));
            }
        }
        all
    });
    if row.back {
        period = opened;
    }
    if period != before && period.is_none_or(DVec2::is_finite) {
        document.look.set_period(period);
    }
}

fn constant(ui: &mut Ui, document: &mut Document) {
    let mut seen = !document.viewing.without_constant;
    let about = "Whether the constant term (DC) of the series is seen, where the plan has a series: the field's mean over a \
                 period. Of the view only; stretched values are the same without it.";
    if control::flag(ui, "Constant", about, &mut seen, true) {
        document.viewing.without_constant = !seen;
    }
}
