//! What was computed, and how long it took.

use egui::{Context, Grid, Id, Ui};
use egui_plot::{Legend, Line, Plot, PlotPoints};

use crate::plan::Cost;
use crate::viewer::control;
use crate::viewer::document::Document;
use crate::viewer::stage::{Stage, Times};

/// A kind of work, what it is, and its time.
type Pass = (&'static str, &'static str, fn(&Times) -> f64);

const PASSES: [Pass; 5] = [
    ("plan", "Weighing the ghosts and choosing degree and evaluator, on the CPU", |times| times.plan),
    ("spectrum", "The tables A, B, C, D of all ghosts", |times| times.spectrum),
    ("composite", "The field, its normalisation, and laying it over the photo", |times| times.composite),
    ("view", "Moving, magnifying and tone-mapping the picture for the screen", |times| times.view),
    ("veil", "Planning and summing the veil, on the CPU in the background", |times| times.veil),
];

fn vsync_id() -> Id {
    Id::unique("vsync")
}

/// Whether frames are to wait for the display.
pub fn vsync(context: &Context) -> bool {
    context.data(|data| data.get_temp(vsync_id())).unwrap_or(true)
}

/// Shows the panel.
pub fn show(ui: &mut Ui, _: &mut Document, stage: &Stage) {
    passes(ui, stage);
    graph(ui, stage);
    plan(ui, stage);
    let rate = stage.timings().frame_rate().map_or("–".to_owned(), |rate| format!("{rate:.0}"));
    ui.label(format!("{rate} frames/s")).on_hover_text("While something last moved; an idle window draws nothing");
    let mut waits = vsync(ui.ctx());
    let about = "Frames wait for the display, or come as fast as they can, and may tear.";
    if control::flag(ui, "vsync", about, &mut waits, true) {
        ui.data_mut(|data| data.insert_temp(vsync_id(), waits));
    }
}

fn passes(ui: &mut Ui, stage: &Stage) {
    let (times, counts) = (stage.times(), stage.counts());
    let done = [counts.spectra, counts.spectra, counts.composites, counts.views, counts.veils];
    Grid::new("times").num_columns(3).striped(true).show(ui, |ui| {
        for ((name, about, time), count) in PASSES.into_iter().zip(done) {
            ui.label(name).on_hover_text(about);
            ui.label(format!("{:.2} ms", time(&times)))
                .on_hover_text("The last one. Of a graphics card, the time to hand the work over");
            ui.label(format!("{count} times")).on_hover_text("Since the window was opened");
            ui.end_row();
        }
    });
}

/// The last pictures' times. Nothing in it moves by itself, so that it never asks for a frame.
fn graph(ui: &mut Ui, stage: &Stage) {
    let plot = Plot::new("times graph")
        .height(140.0)
        .include_y(0.0)
        .include_x(0.0)
        .include_x(30.0)
        .allow_drag(false)
        .allow_zoom(false)
        .allow_scroll(false)
        .allow_boxed_zoom(false)
        .show_x(false)
        .x_axis_label("picture")
        .y_axis_label("ms")
        .legend(Legend::default().position(egui_plot::Corner::RightTop).follow_insertion_order(true));
    let shown = plot.show(ui, |plot| {
        for (name, _, time) in PASSES {
            let points = stage.timings().pictures().enumerate().map(|(k, times)| [k as f64, time(times)]);
            plot.line(Line::new(name, points.collect::<PlotPoints<'_>>()).width(1.5));
        }
    });
    let about = "Milliseconds of the last pictures; a click on a name in the legend hides its line.";
    control::done_by(ui, "Times".into(), about, |_| shown.response);
}

fn plan(ui: &mut Ui, stage: &Stage) {
    let Some(plan) = stage.plan() else { return };
    Grid::new("work").num_columns(2).striped(true).show(ui, |ui| {
        let mut row = |name: &str, about: &str, value: String| {
            ui.label(name).on_hover_text(about);
            ui.label(value);
            ui.end_row();
        };
        let beside = plan.costs.first().and_then(Cost::beside).map_or(String::new(), |beside| format!(", {beside}"));
        row("K", "Ghosts that reach the picture", format!("{}{beside}", plan.ghosts()));
        row("terms", "Modes of the series that are kept", plan.terms().to_string());
        row("degree", "Highest harmonic of x and y", format!("{} × {}", plan.degree()[0], plan.degree()[1]));
        row("evaluator", "How the field is computed", plan.evaluator().to_string());
    });
}
