//! The notes' cos²x cos²y (000, 001): two ghosts in a period of 6, with and without the mean.

use std::f64::consts::FRAC_PI_2;

use glam::DVec2;
use image::{Rgb, RgbImage};

use super::chart::{Axis, Chart, Map, Scalar, Series, Stroke, side_by_side};
use super::plane::{Canvas, Drawn, SIDE, Scene};
use super::{Figure, Lab, Report};
use crate::Result;
use crate::renderer::Picture;
use crate::series::Bell;
use crate::series::printed::{Slips, Zeroth, cosine_table};

/// cos²x cos²y twice, with and without the mean, in the notes' red
///
/// Two ghosts in one series, as the prototype first drew them. With --as-printed also by its C++ with all slips: what
/// spreads there, and made its author delete the 0-th terms, is a wrong κ.
#[derive(Debug, Clone, clap::Args)]
pub struct Args {
    /// Highest harmonic along both axes; as printed, the loops end one before it
    #[arg(long, value_name = "N", default_value_t = 10, value_parser = clap::value_parser!(u32).range(1..=200))]
    pub degree: u32,

    /// Pixels across; the window is 16 : 9, and shows x and y from −3 to 3
    #[arg(long, value_name = "PIXELS", default_value_t = 640, value_parser = clap::value_parser!(u32).range(16..=4096))]
    pub size: u32,

    /// Draw what the notes' C++ gives, slips included, beside the right series
    #[arg(long)]
    pub as_printed: bool,
}

/// The notes' period.
const PERIOD: f64 = 6.0;
/// Where the two ghosts are; the notes do not say.
const CENTERS: [DVec2; 2] = [DVec2::new(-1.2, -0.8), DVec2::new(1.2, 1.0)];

/// One way to compute the bell's coefficients.
struct Variant {
    stem: &'static str,
    name: &'static str,
    caption: &'static str,
    table: Vec<[f64; 4]>,
}

/// Runs the experiment.
///
/// # Errors
/// [`crate::Error::NoContext`] and [`crate::Error::Gl`] from OpenGL.
pub fn run(lab: &mut Lab, args: &Args) -> Result<Report> {
    let mut renderer = Picture::new(&lab.device()?)?;
    let mut report = Report::new("cos²x cos²y, two ghosts");
    describe(&mut report, args);
    let scene = Scene {
        bell: Bell::CosineSquared,
        size: FRAC_PI_2,
        centers: CENTERS.to_vec(),
        period: DVec2::splat(PERIOD),
        degree: [args.degree; 2],
    };
    let variants = variants(&scene, args.as_printed);
    let canvas = Canvas::new([args.size, (args.size * 9 / 16).max(1)], [-3.0, 3.0], [-3.0, 3.0]);
    let mut drawn = Vec::new();
    for variant in &variants {
        let field = scene.draw_table(&mut renderer, canvas, &variant.table)?;
        measure(&mut report, variant, &scene, &field);
        drawn.push(field);
    }
    pictures(&mut report, &variants, &drawn)?;
    report.figures.push(cut(&variants, &scene, &mut renderer)?);
    Ok(report)
}

fn describe(report: &mut Report, args: &Args) {
    report.say(
        "cos²x cos²y within π/2 of its centre has coefficients in closed form. Two of them stand in one series of period \
         6; the notes do not say where, so these are at (−1.2, −0.8) and (1.2, 1). The window is 16 : 9 and shows x and y \
         from −3 to 3, so that bells become ellipses. The notes' colouring is twice the value, in red.",
    );
    report.say(
        "The notes find that values spread when the 0-th terms are in, and leave them out. With the right weights \
         κ = 1, 2, 4 nothing spreads; without its mean the field falls below 0 between the bells, by the bells' mean, \
         0.0685 for each, and what was black stays black only because a screen clips it.",
    );
    if args.as_printed {
        report.say(
            "The C++ as printed sets κ to 4 for every mode. Each ghost is then (u + α_0)(v + α_0) instead of u v, \
             α_0 = 0.262: a cross of streaks and a haze all over the plane. Its ω⁴ for ω³ moves the second harmonic by \
             −35 %, and its loops end one harmonic early. Without mode (0, 0) the haze falls below 0 and the notes' two \
             ellipses stand out again.",
        );
    }
    report.parameter("T", PERIOD);
    report.parameter("N = M", args.degree);
    report.parameter("ghosts", CENTERS.map(|at| format!("({}, {})", at.x, at.y)).join(", "));
    report.parameter("coefficients", if args.as_printed { "right, and as printed" } else { "right" });
}

fn variants(scene: &Scene, as_printed: bool) -> Vec<Variant> {
    let right = scene.table();
    let mut without = right.clone();
    without[0] = [0.0; 4];
    let mut variants = vec![
        Variant { stem: "with-mean", name: "right", caption: "The series.", table: right },
        Variant {
            stem: "without-mean",
            name: "right, without the mean",
            caption: "The series without its mean, mode (0, 0).",
            table: without,
        },
    ];
    if as_printed {
        let printed = |stem, name, caption, zeroth| Variant {
            stem,
            name,
            caption,
            table: cosine_table(Slips::ALL, zeroth, PERIOD, scene.degree),
        };
        variants.extend([
            printed("printed", "as printed", "The C++ as it is printed: the veil is its κ.", Zeroth::Kept),
            printed(
                "printed-without-mean",
                "as printed, without the mean",
                "The C++ as it is printed, without mode (0, 0).",
                Zeroth::MeanDropped,
            ),
            printed(
                "printed-without-edges",
                "as printed, without all 0-th modes",
                "The C++ as it is printed, without any mode of index 0: if that is what the note left out.",
                Zeroth::EdgesDropped,
            ),
        ]);
    }
    variants
}

/// The notes' colouring: red, twice the value, clipped as a screen does.
fn red(field: &Scalar) -> RgbImage {
    RgbImage::from_fn(field.width, field.height, |column, row| {
        let value = field.values[(row * field.width + column) as usize];
        Rgb([(255.0 * (2.0 * value).clamp(0.0, 1.0)).round() as u8, 0, 0])
    })
}

fn pictures(report: &mut Report, variants: &[Variant], drawn: &[Drawn]) -> Result<()> {
    // One scale for all, or the pictures could not be compared.
    let range = [-0.4, 1.6];
    for (variant, field) in variants.iter().zip(drawn) {
        let caption = format!("{} In the notes' red, 2.0 times the value.", variant.caption);
        report.figures.push(Figure::new(variant.stem, caption, red(&field.scalar)).field(field.field()));
        let value = Axis { label: "value".into(), range: Some(range), log: false };
        let chart = field.canvas.chart(&field.scalar, variant.name, value, Map::Viridis, SIDE);
        report.figures.push(Figure::chart(format!("{}-values", variant.stem), variant.caption, &chart)?);
    }
    let row = |fields: &[Drawn]| side_by_side(&fields.iter().map(|field| red(&field.scalar)).collect::<Vec<_>>());
    report.figures.push(Figure::new("mean", "The right series with and without its mean.", row(&drawn[..2])));
    if drawn.len() > 2 {
        let caption = "As printed: with the 0-th terms, without the mean, without all 0-th modes.";
        report.figures.push(Figure::new("printed-mean", caption, row(&drawn[2..])));
    }
    Ok(())
}

/// The values along y of the first ghost.
fn cut(variants: &[Variant], scene: &Scene, renderer: &mut Picture) -> Result<Figure> {
    let y = CENTERS[0].y;
    let line = Canvas::along_x(600, [-3.0, 3.0], y);
    let points = |values: &mut dyn Iterator<Item = f64>| -> Vec<[f64; 2]> {
        line.positions().map(|at| at.x).zip(values).map(|(x, value)| [x, value]).collect()
    };
    let bells = points(&mut line.positions().map(|at| scene.direct(at)));
    let mut chart = Chart::new(format!("Cut at y = {y}"), "x", "value").with(Series::new("the bells", bells));
    for variant in variants {
        let field = scene.draw_table(renderer, line, &variant.table)?;
        let values = points(&mut field.scalar.values.iter().copied());
        chart = chart.with(Series::new(variant.name, values).stroke(Stroke::Dashed));
    }
    Figure::chart("cut", "Along a line through the first ghost's centre.", &chart)
}

fn measure(report: &mut Report, variant: &Variant, scene: &Scene, field: &Drawn) {
    let name = variant.name;
    report.measure(format!("{name}: largest error"), format!("{:.2e}", field.worst(|at| scene.direct(at))));
    let places = field.canvas.positions().zip(&field.scalar.values);
    let outside: Vec<f64> = places.filter(|(at, _)| scene.direct(*at) == 0.0).map(|(_, &value)| value).collect();
    let mean = outside.iter().sum::<f64>() / outside.len().max(1) as f64;
    report.measure(format!("{name}: mean where there is no bell"), format!("{mean:.4}"));
}
