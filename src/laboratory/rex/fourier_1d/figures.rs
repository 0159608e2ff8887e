//! The figures that the experiments on the CPU and on the GPU share.

use std::f64::consts::PI;

use image::RgbImage;

use super::bells::{Bells, Kind};
use crate::Result;
use crate::gpu::lines::LinesPass;
use crate::gpu::runner::Runner;
use crate::laboratory::rex::chart::{Along, COLOURS, Chart, Colour, Series, Stroke};
use crate::laboratory::rex::{Field, Figure};
use crate::series::numeric::{Coefficients, Rule, Slips};

/// Pixels of the prototype's framebuffer here, and its lines' width.
const PLOT: [u32; 2] = [1680, 880];
const WIDTH: f32 = 5.0;
/// Distance of the vertices along x, as in the plug-in.
const STEP: f64 = 0.001;
const GREY: Colour = [70, 70, 70];

/// A series that is drawn as a line strip.
pub(in crate::laboratory::rex) struct Curve<'a> {
    pub label: String,
    pub series: &'a Coefficients,
    pub colour: Colour,
}

/// Series drawn by OpenGL as the prototype draws them, and the exact sum and its bells over that picture.
pub(in crate::laboratory::rex) fn drawn(
    runner: &Runner,
    stem: &str,
    title: &str,
    bells: &Bells,
    curves: &[Curve<'_>],
) -> Result<Figure> {
    let ends = [-PI, PI];
    let exact = Series::function("exact sum", ends, 1601, |x| bells.value(x)).stroke(Stroke::Dashed).colour(GREY);
    let strips: Vec<Vec<[f64; 2]>> = curves.iter().map(|curve| vertices(curve.series, ends)).collect();
    let heights = || strips.iter().flatten().chain(&exact.points).map(|point| point[1]);
    let (low, high) = (heights().fold(0.0, f64::min), heights().fold(0.0, f64::max));
    let margin = 0.06 * (high - low).max(1e-6);
    let range = [low - margin, high + margin];

    let mut plot = LinesPass::new(runner, PLOT, ends.map(|x| x as f32), range.map(|y| y as f32))?;
    for (curve, strip) in curves.iter().zip(&strips) {
        let strip: Vec<[f32; 2]> = strip.iter().map(|point| point.map(|value| value as f32)).collect();
        plot.strip(runner, &strip, curve.colour.map(|channel| f32::from(channel) / 255.0), WIDTH)?;
    }
    let pixels = plot.read();
    let mut chart = Chart::new(title, "x", "f(x)").backdrop(picture(&pixels)).range_x(-PI, PI);
    chart.y.range = Some(range);
    for (curve, strip) in curves.iter().zip(strips) {
        let series = Series::new(curve.label.clone(), strip).stroke(Stroke::Legend).colour(curve.colour);
        chart = chart.with(series);
    }
    let caption = "The coloured curves are line strips that OpenGL has drawn into a framebuffer, a vertex every 0.001 \
                   as in the prototype's plug-in; the dashed one is the exact sum, drawn over that picture.";
    let field = Field { width: PLOT[0], height: PLOT[1], pixels };
    Ok(Figure::chart(stem, caption, &chart.with(exact))?.field(field))
}

fn vertices(series: &Coefficients, [from, to]: [f64; 2]) -> Vec<[f64; 2]> {
    let steps = ((to - from) / STEP).ceil() as u32;
    (0..=steps).map(|i| (from + STEP * f64::from(i)).min(to)).map(|x| [x, series.value(x)]).collect()
}

fn picture(pixels: &[[f32; 4]]) -> RgbImage {
    let byte = |value: f32| (255.0 * value.clamp(0.0, 1.0)).round() as u8;
    RgbImage::from_fn(PLOT[0], PLOT[1], |column, row| {
        let [red, green, blue, _] = pixels[(row * PLOT[0] + column) as usize];
        image::Rgb([red, green, blue].map(byte))
    })
}

/// Each bell, and its series of two degrees.
pub(in crate::laboratory::rex) fn parts(bells: &Bells, rule: Rule, degrees: [u32; 2]) -> Result<Figure> {
    let ends = [-PI, PI];
    let mut chart = Chart::new("Each bell and its series", "x", "f(x)").range_x(-PI, PI);
    for &bell in &bells.bells {
        let label = if chart.series.is_empty() { "bells" } else { "" };
        chart = chart.with(Series::function(label, ends, 1201, |x| bells.one(bell, x)).colour([150; 3]));
    }
    for (index, &bell) in bells.bells.iter().enumerate() {
        let alone = Bells { bells: vec![bell], ..bells.clone() };
        let series = alone.coefficients(rule, degrees[1]);
        let low = series.cut(degrees[0]);
        let colour = COLOURS[index % COLOURS.len()];
        let curve = |label: String, stroke, f: &dyn Fn(f64) -> f64| {
            Series::function(label, ends, 1201, f).stroke(stroke).colour(colour)
        };
        let label = |degree: u32| format!("μ = {}, N = {degree}", bell[0]);
        chart = chart.with(curve(label(degrees[0]), Stroke::Solid, &|x| low.value(x))).with(curve(
            label(degrees[1]),
            Stroke::Dotted,
            &|x| series.value(x),
        ));
    }
    let caption = "exp(−(sin x − μ)²/2σ²) has two lobes in each period, at arcsin μ and π − arcsin μ. Ten terms are \
                   far from enough for lobes this narrow; with the higher degree the series lies on the bell.";
    Figure::chart("parts", caption, &chart)
}

/// The largest error against the degree, for the notes' bells and for von Mises bells of the same means.
pub(in crate::laboratory::rex) fn convergence(bells: &Bells, rule: Rule, marked: [u32; 2]) -> Result<Figure> {
    let highest = marked[0].max(marked[1]).max(80) + 10;
    let samples = rule.samples.max(8 * highest);
    let meant = Bells { kind: Kind::VonMises, ..bells.clone() };
    let errors = |bells: &Bells| -> Vec<[f64; 2]> {
        let all = bells.coefficients(Rule { samples, slips: Slips::default(), ..rule }, highest);
        (0..=highest).map(|degree| [f64::from(degree), bells.error(&all.cut(degree))]).collect()
    };
    let mut chart = Chart::new("Error against degree", "degree N", "largest error over a period")
        .with(Series::new("the notes' bells", errors(bells)))
        .with(Series::new("von Mises bells", errors(&meant)).stroke(Stroke::Dashed))
        .log_y();
    for degree in marked {
        chart = chart.mark(format!("N = {degree}"), Along::Vertical, f64::from(degree));
    }
    let caption = "How fast the series of the sum converges. The notes stop at 10.";
    Figure::chart("degree", caption, &chart)
}

/// The notes' bell as its mean moves, beside the bell that it was meant to be.
pub(in crate::laboratory::rex) fn meant(sigma: f64) -> Result<Figure> {
    let mut chart = Chart::new("Moving the mean", "x", "f(x)").range_x(-PI, PI);
    for (&mean, &colour) in [0.0, 0.5, 0.9].iter().zip(&COLOURS) {
        for (kind, name, stroke) in
            [(Kind::Sine, "notes", Stroke::Solid), (Kind::VonMises, "von Mises", Stroke::Dashed)]
        {
            let bells = Bells { kind, sigma, bells: vec![[mean, 1.0]] };
            let curve = Series::function(format!("{name}, μ = {mean}"), [-PI, PI], 1601, |x| bells.value(x));
            chart = chart.with(curve.stroke(stroke).colour(colour));
        }
    }
    let caption = "In the notes' bell the mean draws two lobes together, which widen and merge near 1. The von Mises \
                   bell exp(κ (cos(x − μ) − 1)), κ = 1/σ², has one lobe, which the mean moves without changing it: \
                   what the notes looked for. At μ = 0 the two are nearly the same around 0. Its coefficients are exp(−κ) I_n(κ).";
    Figure::chart("meant", caption, &chart)
}
