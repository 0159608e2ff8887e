//! The spectrum, a cross-section of the field, and how the error falls with the degree.

use egui::{Color32, Image, Rangef, Response, RichText, Ui, vec2};
use egui_plot::{
    AxisHints, ColorConflictHandling, Corner, HLine, Legend, Line, LineStyle, Plot as Chart, PlotPoints, Points, VLine,
};

use crate::viewer::control::{Number, brief, buttons, choice, done_by, hint};
use crate::viewer::document::Document;
use crate::viewer::stage::Stage;
use crate::viewer::study::{CutPoint, Degree, Plot, SPECTRUM_DECADES};

const HEIGHT: f32 = 210.0;
const CHOICES: [(Plot, &str, &str); 4] = [
    (Plot::Off, "Off", "Nothing is computed for plots"),
    (Plot::Spectrum, "Spectrum", "|A|, |B|, |C|, |D|, as they are on the device"),
    (Plot::Section, "Section", "The field along a line over the picture, and the direct sum in f64 beside it"),
    (Plot::Convergence, "Degree", "The error that is predicted for other degrees"),
];

const CUT: Number = Number {
    name: "Cut at",
    about: "Where the picture is cut, from the top or from the left.",
    unit: "of the picture",
    range: 0.0..=1.0,
    logarithmic: false,
};

/// Shows the panel.
pub fn show(ui: &mut Ui, document: &mut Document, stage: &Stage) {
    let plot = &mut document.viewing.wanted.plot;
    choice(ui, "Plot", "What is found out about the picture and drawn here.", plot, &CHOICES, Plot::Off);
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
    if stage.plan()?.terms() == 0 {
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
                    hint(ui, name);
                    ui.add(Image::new(table).fit_to_exact_size(vec2(side, side)).maintain_aspect_ratio(false));
                });
            }
        });
    }
    hint(ui, format!("n to the right, m upwards; dark is 1e−{SPECTRUM_DECADES} of the largest or less"));
    Some(())
}

fn section(ui: &mut Ui, document: &mut Document, stage: &Stage) -> Option<()> {
    let cut = &mut document.viewing.wanted.cut;
    let about = "Which way the picture is cut; the green line over it can be dragged.";
    buttons(ui, "Cut", about, &mut cut.horizontal, &[(true, "Row", "along x"), (false, "Column", "along y")], true);
    CUT.show(ui, &mut cut.at, 0.5);
    let axis = if cut.horizontal { "x, look's unit" } else { "y, look's unit" };
    let points = stage.known().section()?;
    let scale = points.iter().flat_map(|point| point.exact).fold(0.0f64, |most, value| most.max(value.abs()));
    // Powers of ten apart, the axis has numbers of few digits.
    let power = if scale > 0.0 { scale.log10().floor() as i32 } else { 0 };
    let unit = 10f64.powi(power);
    let label = if power == 0 { "field".to_owned() } else { format!("field / 1e{power}") };
    let shown = chart("section", axis, label, brief, Corner::RightTop).show(ui, |plot| {
        for (colour, (name, tint)) in COLOURS.into_iter().enumerate() {
            let exact = curve(points, |point| point.exact[colour] / unit);
            plot.line(Line::new(name, exact).color(tint.gamma_multiply(0.4)).width(5.0));
            let rendered = curve(points, |point| point.rendered[colour] / unit);
            plot.line(Line::new(name, rendered).color(tint).width(1.5));
        }
    });
    explain(ui, "Section plot", shown.response);
    let worst = points.iter().map(error).fold(0.0f64, f64::max);
    let part = if scale > 0.0 { worst / scale } else { 0.0 };
    hint(ui, format!("Thin: rendered; wide: direct sum in f64. At most {part:.1e} of the largest apart."));
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
    // Only whole powers: a mark between them would be told as one of its neighbours.
    let power = |value: f64| if value.fract().abs() < 1e-6 { format!("1e{value}") } else { String::new() };
    let chart = chart("convergence", "degree", "error".into(), power, Corner::LeftBottom);
    let shown = chart.show(ui, |plot| {
        plot.line(Line::new("truncation", points(|degree| degree.truncation)));
        plot.points(Points::new("all sources", points(|degree| degree.total)).radius(2.5));
        plot.hline(HLine::new("tolerance", decades(plan.tolerance)).style(LineStyle::dashed_loose()));
        if plan.terms() > 0 {
            let degree = f64::from(plan.degree()[0].max(plan.degree()[1]));
            plot.vline(VLine::new("planned", degree).style(LineStyle::dashed_loose()));
        }
    });
    explain(ui, "Degree plot", shown.response);
    hint(ui, "Bounds of a series with the whole rectangle of modes, by rows, in the plan's period.");
    Some(())
}

/// A chart; `numbers` tells a mark of its vertical axis.
fn chart(name: &'static str, x: &str, y: String, numbers: fn(f64) -> String, corner: Corner) -> Chart<'static> {
    let legend = Legend::default().position(corner).follow_insertion_order(true);
    // Of two lines of one name the thin one, drawn last, has the whole colour.
    let legend = legend.color_conflict_handling(ColorConflictHandling::PickLast);
    // Nearer than by default: there is not much room.
    let horizontal = AxisHints::new_x().label(x.to_owned()).label_spacing(Rangef::new(24.0, 30.0));
    let vertical = AxisHints::new_y().label(y).label_spacing(Rangef::new(12.0, 16.0));
    let vertical = vertical.formatter(move |mark, _| numbers(mark.value)).min_thickness(44.0);
    let chart = Chart::new(name).height(HEIGHT).allow_scroll(false).legend(legend);
    chart.custom_x_axes(vec![horizontal]).custom_y_axes(vec![vertical])
}

fn explain(ui: &mut Ui, name: &str, response: Response) {
    let about = "Drag to move it, drag with the secondary button to enlarge a part; a double click shows all of it.";
    done_by(ui, name.to_owned(), about, |_| response);
}
