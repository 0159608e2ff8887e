//! The notes' normalisation (003): a hundred ghosts, stretched from least to largest, beside clamped.

use glam::DVec2;

use super::chance::Chance;
use super::chart::{Map, Scalar, side_by_side};
use super::plane::{Canvas, Drawn, Scene};
use super::{Figure, Lab, Report};
use crate::Result;
use crate::renderer::{Normalize, Picture, Settings};
use crate::series::Bell;
use crate::series::printed::last_mip;

/// A hundred ghosts, normalised by least and largest value, beside clamped
///
/// Where ghosts overlap, their sum exceeds 1: clamped, it is a white patch; stretched, the bells are told apart.
#[derive(Debug, Clone, clap::Args)]
pub struct Args {
    /// K: how many ghosts
    #[arg(long, value_name = "K", default_value_t = 100, value_parser = clap::value_parser!(u32).range(1..=100_000))]
    pub ghosts: u32,

    /// Highest harmonic along both axes
    #[arg(long, value_name = "N", default_value_t = 15, value_parser = clap::value_parser!(u32).range(1..=200))]
    pub degree: u32,

    /// σ, in the notes' units
    #[arg(long, value_name = "S", default_value_t = 0.7)]
    pub sigma: f64,

    /// T: the period along both axes; the picture shows all of it along x
    #[arg(long, value_name = "T", default_value_t = 20.0)]
    pub period: f64,

    /// Where the centres come from: the same number gives the same ones
    #[arg(long, value_name = "SEED", default_value_t = 3)]
    pub seed: u64,

    /// Pixels across; the picture is 4 : 3, as the notes'
    #[arg(long, value_name = "PIXELS", default_value_t = 480, value_parser = clap::value_parser!(u32).range(16..=4096))]
    pub size: u32,
}

/// Runs the experiment.
///
/// # Errors
/// [`crate::Error::NoContext`] and [`crate::Error::Gl`] from OpenGL; [`crate::Error::Usage`] for a σ or a period that is
/// no size.
pub fn run(lab: &mut Lab, args: &Args) -> Result<Report> {
    for (name, value) in [("σ", args.sigma), ("the period", args.period)] {
        if !(value > 0.0 && value.is_finite()) {
            return Err(crate::Error::Usage(format!("{name} has to be positive, and {value} is not")));
        }
    }
    let mut renderer = Picture::new(&lab.device()?)?;
    let half = 0.5 * args.period * DVec2::new(1.0, 0.75);
    let scene = scene(args, half);
    let canvas = Canvas::new([args.size, (args.size * 3 / 4).max(1)], [-half.x, half.x], [-half.y, half.y]);
    let with = |normalize| Settings { normalize, ..Settings::default() };

    let mut report = Report::new("Normalised beside clamped");
    describe(&mut report, args);
    let [plain, stretched, clamped] = {
        let mut draw = |normalize| scene.draw(&mut renderer, canvas, &with(normalize));
        [draw(Normalize::None)?, draw(Normalize::Minmax)?, draw(Normalize::Clamp)?]
    };
    let range = renderer.field.range(canvas.frame)?;
    pictures(&mut report, &stretched, &clamped);
    measure(&mut report, &scene, &plain, range, [&stretched, &clamped]);
    Ok(report)
}

fn describe(report: &mut Report, args: &Args) {
    report.say(
        "The field's least value becomes 0 and its largest 1; beside it the same field cut off at 0 and 1. The notes \
         normalise by the last level of a mip chain. A plain chain ends in the mean, so vglare reduces to least and \
         largest in a chain of its own.",
    );
    report.say(
        "The notes do not say where the ghosts are. Here they are even over the picture, by SplitMix64 from the seed.",
    );
    report.parameter("K", args.ghosts);
    report.parameter("N = M", args.degree);
    report.parameter("σ", args.sigma);
    report.parameter("T", args.period);
    report.parameter("seed", args.seed);
}

fn scene(args: &Args, half: DVec2) -> Scene {
    let mut chance = Chance::new(args.seed);
    let mut place = || DVec2::new(chance.between(-half.x, half.x), chance.between(-half.y, half.y));
    Scene {
        bell: Bell::Gaussian,
        size: args.sigma,
        centers: (0..args.ghosts).map(|_| place()).collect(),
        period: DVec2::splat(args.period),
        degree: [args.degree; 2],
    }
}

fn pictures(report: &mut Report, stretched: &Drawn, clamped: &Drawn) {
    let grey = |field: &Scalar| field.colours(Map::Grey, [0.0, 1.0]);
    let beside = side_by_side(&[grey(&stretched.scalar), grey(&clamped.scalar)]);
    report.figures.push(Figure::new("beside", "Left normalised, right clamped, as in the notes.", beside));
    for (stem, caption, field) in
        [("normalised", "From least to largest.", stretched), ("clamped", "Cut off at 0 and 1.", clamped)]
    {
        report.figures.push(Figure::new(stem, caption, grey(&field.scalar)).field(field.field()));
    }
}

fn measure(
    report: &mut Report,
    scene: &Scene,
    plain: &Drawn,
    [low, high]: [f32; 2],
    [stretched, clamped]: [&Drawn; 2],
) {
    let pixels = plain.scalar.values.len() as f64;
    report.measure("least and largest value, by the reduction", format!("{low:.4}, {high:.4}"));
    let [least, largest] = plain.scalar.range();
    report.measure("least and largest value, pixel by pixel", format!("{least:.4}, {largest:.4}"));
    let values: Vec<f32> = plain.pixels.iter().map(|pixel| pixel[0]).collect();
    let last = last_mip(&values, plain.scalar.width as usize, plain.scalar.height as usize);
    report.measure("last level of a plain mip chain", format!("{last:.4}"));
    report.measure("mean", format!("{:.4}", plain.scalar.values.iter().sum::<f64>() / pixels));
    let [low, high] = stretched.scalar.range();
    report.measure("normalised: least and largest", format!("{low:.4}, {high:.4}"));
    let white = clamped.scalar.values.iter().filter(|&&value| value >= 1.0).count() as f64;
    report.measure("clamped: pixels cut off at 1", format!("{:.1} %", 100.0 * white / pixels));
    let error = plain.worst(|at| scene.periodised(at)) / largest;
    report.measure("largest error of the series, of the largest value", format!("{error:.1e}"));
}
