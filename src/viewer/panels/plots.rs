//! The spectrum, a cross-section of the field, and how the error falls with the degree.

use egui::{Color32, Image, RichText, Ui, vec2};
use egui_plot::{HLine, Legend, Line, LineStyle, Plot as Chart, PlotPoints, Points, VLine};

use crate::viewer::document::Document;
use crate::viewer::stage::Stage;
use crate::viewer::study::{CutPoint, Degree, Plot, SPECTRUM_DECADES};

const HEIGHT: f32 = 190.0;
const CHOICES: [(Plot, &str, &str); 4] = [
    (Plot::Off, "Off", "Nothing is computed for plots"),
    (Plot::Spectrum, "Spectrum", "|A|, |B|, |C|, |D|, as they are on the device"),
    (Plot::Section, "Section", "The field along a line over the picture, and the direct sum in f64 beside it"),
    (Plot::Convergence, "Degree", "The error that is predicted for other degrees"),
];

/// Shows the panel.
pub fn show(ui: &mut Ui, document: &mut Document, stage: &Stage) {
    ui.horizontal_wrapped(|ui| {
        for (plot, name, about) in CHOICES {
            ui.selectable_value(&mut document.viewing.wanted.plot, plot, name).on_hover_text(about);
        }
    });
    let shown = match document.viewing.wanted.plot {
        Plot::Off => return,
        Plot::Spectrum => spectrum(ui, stage),
        Plot::Section => section(ui, document, stage),
        Plot::Convergence => convergence(ui, stage),
    };
    if shown.is_none() {
        ui.label(RichText::new("not known yet").weak());
    }
}

fn spectrum(ui: &mut Ui, stage: &Stage) -> Option<()> {
    let tables = stage.known().spectrum()?;
    if stage.plan()?.terms == 0 {
        ui.label("All ghosts are summed directly: there is no spectrum.");
        return Some(());
    }
    let side = (ui.available_width() - 12.0) / 2.0;
    for pair in [0, 2] {
        ui.horizontal(|ui| {
            for (table, name) in
                tables.iter().zip(["|A|  cos cos", "|B|  cos sin", "|C|  sin cos", "|D|  sin sin"]).skip(pair).take(2)
            {
                ui.vertical(|ui| {
                    ui.set_width(side);
                    ui.small(name);
                    ui.add(Image::new(table).fit_to_exact_size(vec2(side, side)).maintain_aspect_ratio(false));
                });
            }
        });
    }
    ui.small(format!("n to the right, m upwards; dark is 1e−{SPECTRUM_DECADES} of the largest or less"));
    Some(())
}

fn section(ui: &mut Ui, document: &mut Document, stage: &Stage) -> Option<()> {
    let cut = &mut document.viewing.wanted.cut;
    ui.horizontal(|ui| {
        ui.selectable_value(&mut cut.horizontal, true, "Row").on_hover_text("Along x");
        ui.selectable_value(&mut cut.horizontal, false, "Column").on_hover_text("Along y");
        ui.weak("drag the green line");
    });
    let axis = if cut.horizontal { "x, half picture heights" } else { "y, half picture heights" };
    let points = stage.known().section()?;
    let scale = points.iter().flat_map(|point| point.exact).fold(0.0f64, |most, value| most.max(value.abs()));
    let chart = chart("section").x_axis_label(axis).y_axis_label("field");
    chart.legend(Legend::default().position(egui_plot::Corner::LeftBottom)).show(ui, |plot| {
        for (colour, (name, tint)) in COLOURS.into_iter().enumerate() {
            plot.line(
                Line::new(name, curve(points, |point| point.exact[colour])).color(tint.gamma_multiply(0.5)).width(4.0),
            );
            plot.line(Line::new(name, curve(points, |point| point.rendered[colour])).color(tint).width(1.0));
        }
    });
    let worst = points.iter().map(error).fold(0.0f64, f64::max);
    let part = if scale > 0.0 { worst / scale } else { 0.0 };
    ui.small(format!("thin: rendered; wide: direct sum in f64; at most {part:.1e} of the largest apart"));
    Some(())
}

const COLOURS: [(&str, Color32); 3] = [
    ("red", Color32::from_rgb(220, 70, 60)),
    ("green", Color32::from_rgb(60, 160, 80)),
    ("blue", Color32::from_rgb(70, 110, 230)),
];

fn curve(points: &[CutPoint], value: impl Fn(&CutPoint) -> f64) -> PlotPoints<'static> {
    points.iter().map(|point| [point.along, value(point)]).collect()
}

fn error(point: &CutPoint) -> f64 {
    point.rendered.iter().zip(point.exact).map(|(rendered, exact)| (rendered - exact).abs()).fold(0.0, f64::max)
}

fn convergence(ui: &mut Ui, stage: &Stage) -> Option<()> {
    let degrees = stage.known().convergence()?;
    let plan = stage.plan()?;
    if degrees.is_empty() {
        ui.label("No series can be had of these ghosts.");
        return Some(());
    }
    // Nothing below what f64 tells from nothing.
    let decades = |error: f64| error.max(1e-16).log10();
    let points = |error: fn(&Degree) -> f64| -> PlotPoints<'static> {
        degrees.iter().map(|degree| [f64::from(degree.degree), decades(error(degree))]).collect()
    };
    let power = |mark: egui_plot::GridMark, _: &_| format!("1e{}", mark.value.round());
    let chart = chart("convergence").x_axis_label("degree").y_axis_label("error").y_axis_formatter(power);
    chart.legend(Legend::default().position(egui_plot::Corner::LeftBottom)).show(ui, |plot| {
        plot.line(Line::new("truncation", points(|degree| degree.truncation)));
        plot.points(Points::new("all sources", points(|degree| degree.total)).radius(2.5));
        plot.hline(HLine::new("tolerance", decades(plan.tolerance)).style(LineStyle::dashed_loose()));
        if plan.terms > 0 {
            let degree = f64::from(plan.degree[0].max(plan.degree[1]));
            plot.vline(VLine::new("planned", degree).style(LineStyle::dashed_loose()));
        }
    });
    ui.small("bounds of a series with the whole rectangle of modes, by rows, in the plan's period");
    Some(())
}

fn chart(name: &'static str) -> Chart<'static> {
    Chart::new(name).height(HEIGHT).allow_scroll(false)
}
