//! Moving lights by a look-up table of their harmonics: the notes' third contribution (001).

mod cost;
mod table;

use std::f64::consts::TAU;

use super::chart::{Along, COLOURS, Chart, Series, Stroke};
use super::{Figure, Lab, Report};
use crate::series::wrapped_gaussian;
use crate::{Error, Result};
use table::{Light, Real, Source, Table, line};

/// Moving lights by a look-up table instead of cos and sin
///
/// When lights move, only the harmonics of their positions change. The notes propose to look these up in a table over
/// positions. Measured here on the CPU: how long an update of the spectrum takes with tables of different sizes and with
/// cos and sin computed anew, and how far off the glare is.
#[derive(Debug, Clone, clap::Args)]
pub struct Args {
    /// Lights that move
    #[arg(long, value_name = "K", default_value_t = 1000, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    pub lights: u32,

    /// Degree of the series
    #[arg(long, value_name = "N", default_value_t = 20, value_parser = clap::value_parser!(u32).range(1..=200))]
    pub degree: u32,

    /// T: the period
    #[arg(long, value_name = "T", default_value_t = 16.0)]
    pub period: f64,

    /// σ of each light's Gaussian
    #[arg(long, value_name = "σ", default_value_t = 1.0)]
    pub sigma: f64,

    /// Entries of the tables in a period
    #[arg(long, value_name = "P,…", value_delimiter = ',', default_values_t = [64, 256, 1024, 4096, 16384, 65536],
        value_parser = clap::value_parser!(u32).range(2..=1 << 20))]
    pub entries: Vec<u32>,

    /// How often each thing is timed; made even
    #[arg(long, value_name = "N", default_value_t = 60, value_parser = clap::value_parser!(u16).range(1..=1000))]
    pub rounds: u16,
}

/// Runs the experiment.
///
/// # Errors
/// [`Error::Usage`] for parameters that make no bell or tables beyond reason.
pub fn run(_lab: &mut Lab, args: &Args) -> Result<Report> {
    check(args)?;
    let lights = lights(args.lights);
    let mut report = Report::new("Moving lights by a look-up table");
    describe(&mut report, args);
    let exact = Field::new(args, &line::<f64>(&lights, &Source::Compute, args.degree));
    report.figures.push(fields(args, &lights, &exact)?);
    let errors = errors(args, &lights, &exact);
    report.figures.push(error_chart(&errors, &alone(args, &lights))?);
    cost::measure(&mut report, args, &lights, &errors)?;
    Ok(report)
}

fn check(args: &Args) -> Result<()> {
    for (name, value) in [("--period", args.period), ("--sigma", args.sigma)] {
        if !(value.is_finite() && value > 0.0) {
            return Err(Error::Usage(format!("{name} must be a positive number, not {value}")));
        }
    }
    if args.entries.iter().any(|&entries| u64::from(entries) * u64::from(args.degree + 1) > 1 << 25) {
        return Err(Error::Usage("a table of more than half a GiB; ask for fewer entries or a lower degree".into()));
    }
    Ok(())
}

fn describe(report: &mut Report, args: &Args) {
    report.say(
        "The third contribution that the notes name: when lights or the camera move, take cos nωx_k and sin nωx_k of \
         every light from a table over positions instead of computing them. The table has P entries in a period, each \
         with all harmonics; the nearest entry is taken, or two are interpolated.",
    );
    report.say(
        "Against it stand cos and sin of every harmonic, and one cos and sin for each light with a rotation from each \
         harmonic to the next, which needs no table. Nothing here runs on a graphics card: what is measured is the \
         update of the spectrum on one core. In one dimension a light adds two products a harmonic, so the harmonics are \
         most of the cost; in two it adds 4 (N+1)² products beside 4 (N+1) harmonics, and no table can save more than \
         the share of these.",
    );
    report.parameter("processor", processor());
    report.parameter("lights K", args.lights);
    report.parameter("degree N", args.degree);
    report.parameter("period T", args.period);
    report.parameter("σ", args.sigma);
    let entries: Vec<_> = args.entries.iter().map(u32::to_string).collect();
    report.parameter("entries P", entries.join(", "));
    report.parameter("rounds", args.rounds);
}

/// What computes: the processor by its name where the system tells it.
fn processor() -> String {
    let told = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = told.lines().find_map(|line| line.strip_prefix("model name")?.split_once(':'));
    model.map_or(std::env::consts::ARCH, |(_, name)| name.trim()).to_owned()
}

/// Lights all over the period, the same in every run.
fn lights(count: u32) -> Vec<Light> {
    // Three irrational steps fill the cube evenly (the plastic number's powers, Roberts 2018).
    const STEPS: [f64; 3] = [0.819_172_513_396_164_4, 0.671_043_606_703_789_2, 0.549_700_477_901_970_3];
    let one = |k: u32| {
        let [x, y, w] = STEPS.map(|step| (0.5 + step * f64::from(k)).fract());
        Light { turn: [x, y], weight: 0.5 + w }
    };
    (0..count).map(one).collect()
}

/// The glare along x.
struct Field {
    period: f64,
    values: Vec<f64>,
}

impl Field {
    const POINTS: u32 = 1000;

    fn new<R: Real>(args: &Args, sums: &[[R; 2]]) -> Self {
        let terms: Vec<[f64; 2]> = (0u32..)
            .zip(sums)
            .map(|(n, sum)| {
                let weight = wrapped_gaussian(n, args.sigma / args.period) * if n == 0 { 1.0 } else { 2.0 };
                sum.map(|value| weight * value.wide())
            })
            .collect();
        let value = |i: u32| {
            let term = |(n, [a, b]): (u64, &[f64; 2])| {
                let turn = n * u64::from(i) % u64::from(Self::POINTS);
                let (sin, cos) = (TAU * turn as f64 / f64::from(Self::POINTS)).sin_cos();
                a * cos + b * sin
            };
            (0u64..).zip(&terms).map(term).sum()
        };
        Self { period: args.period, values: (0..Self::POINTS).map(value).collect() }
    }

    /// The largest difference in parts of the largest value of `exact`; NaN is not lost.
    fn error(&self, exact: &Self) -> f64 {
        let largest = exact.values.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
        let differences = self.values.iter().zip(&exact.values).map(|(a, b)| (a - b).abs() / largest);
        differences.fold(0.0, |worst, error| if error.is_nan() || error > worst { error } else { worst })
    }

    fn points(&self) -> Vec<[f64; 2]> {
        let x = |i: usize| self.period * i as f64 / f64::from(Self::POINTS);
        self.values.iter().enumerate().map(|(i, &value)| [x(i), value]).collect()
    }
}

/// The four ways to use a table.
const WAYS: [&str; 4] = ["nearest, f64", "linear, f64", "nearest, f32", "linear, f32"];

/// For each table size the error of each of [`WAYS`].
type Errors = Vec<(u32, [f64; 4])>;

/// The tables of one size.
struct Tables {
    entries: u32,
    wide: Table<f64>,
    narrow: Table<f32>,
}

impl Tables {
    fn all(args: &Args) -> impl Iterator<Item = Self> {
        let one = |&entries: &u32| {
            let (wide, narrow) = (Table::new(entries, args.degree), Table::new(entries, args.degree));
            Self { entries, wide, narrow }
        };
        args.entries.iter().map(one)
    }

    /// The error of each of [`WAYS`].
    fn errors(&self, args: &Args, lights: &[Light], exact: &Field) -> [f64; 4] {
        let (wide, narrow, degree) = (&self.wide, &self.narrow, args.degree);
        [
            Field::new(args, &line(lights, &Source::Nearest(wide), degree)).error(exact),
            Field::new(args, &line(lights, &Source::Linear(wide), degree)).error(exact),
            Field::new(args, &line(lights, &Source::Nearest(narrow), degree)).error(exact),
            Field::new(args, &line(lights, &Source::Linear(narrow), degree)).error(exact),
        ]
    }
}

fn errors(args: &Args, lights: &[Light], exact: &Field) -> Errors {
    Tables::all(args).map(|tables| (tables.entries, tables.errors(args, lights, exact))).collect()
}

/// The errors of a light alone, the worst of some: those of many lights partly cancel.
fn alone(args: &Args, lights: &[Light]) -> Errors {
    const SOME: usize = 32;
    let one = |tables: Tables| {
        let mut worst = [0.0; 4];
        for light in lights.iter().take(SOME).map(std::slice::from_ref) {
            let exact = Field::new(args, &line::<f64>(light, &Source::Compute, args.degree));
            for (worst, error) in worst.iter_mut().zip(tables.errors(args, light, &exact)) {
                *worst = if error.is_nan() || error > *worst { error } else { *worst };
            }
        }
        (tables.entries, worst)
    };
    Tables::all(args).map(one).collect()
}

fn error_chart(errors: &Errors, alone: &Errors) -> Result<Figure> {
    let mut chart = Chart::new("What a table costs in accuracy", "entries P in a period", "error of the glare")
        .log_x()
        .log_y()
        .mark("1e-3, the default tolerance", Along::Horizontal, 1e-3);
    let points = |errors: &Errors, way: usize| errors.iter().map(|&(p, errors)| [f64::from(p), errors[way]]).collect();
    for (way, colour) in COLOURS.into_iter().enumerate().take(2) {
        let name = |what: &str| format!("{}{what}", WAYS[way]);
        chart = chart
            .with(Series::new(name(""), points(errors, way)).colour(colour))
            .with(Series::new(WAYS[way + 2], points(errors, way + 2)).colour(colour).stroke(Stroke::Points))
            .with(Series::new(name(", one light"), points(alone, way)).colour(colour).stroke(Stroke::Dotted));
    }
    let caption = "The largest error of the glare, in parts of its largest value, of all lights and of one alone, the worst of 32: those \
                   of many lights partly cancel. The error of the nearest entry falls like 1/P, that of the interpolation \
                   like 1/P², until f32 ends it.";
    Figure::chart("error", caption, &chart)
}

/// What a coarse table makes of a few lights.
fn fields(args: &Args, lights: &[Light], exact: &Field) -> Result<Figure> {
    let entries = args.entries.iter().copied().min().unwrap_or(64);
    let few = &lights[..lights.len().min(3)];
    let table = Table::<f64>::new(entries, args.degree);
    let field = |source: Source<'_, f64>| Field::new(args, &line(few, &source, args.degree));
    let [right, nearest, linear] = [Source::Compute, Source::Nearest(&table), Source::Linear(&table)].map(field);
    let chart = Chart::new(format!("{} lights by a table of {entries} entries", few.len()), "x", "glare")
        .with(Series::new("computed", right.points()).colour([150; 3]))
        .with(Series::new("nearest entry", nearest.points()).stroke(Stroke::Dashed))
        .with(Series::new("interpolated", linear.points()).stroke(Stroke::Dotted))
        .range_x(0.0, exact.period);
    Figure::chart("field", "The glare of the first lights by the smallest of the tables.", &chart)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn args(lights: u32) -> Args {
        Args { lights, degree: 20, period: 16.0, sigma: 1.0, entries: vec![64, 256, 1024], rounds: 2 }
    }

    #[test]
    fn errors_fall_like_the_size_and_its_square() {
        let (args, lights) = (args(50), lights(50));
        let exact = Field::new(&args, &line::<f64>(&lights, &Source::Compute, args.degree));
        let errors = errors(&args, &lights, &exact);
        for pair in errors.windows(2) {
            let ratio = |way: usize| pair[0].1[way] / pair[1].1[way];
            assert!((2.0..9.0).contains(&ratio(0)), "nearest: {}", ratio(0));
            assert!((12.0..20.0).contains(&ratio(1)), "linear: {}", ratio(1));
        }
        let rotated = Field::new(&args, &line::<f64>(&lights, &Source::Rotate, args.degree));
        assert!(rotated.error(&exact) < 1e-14);
    }

    #[test]
    fn a_light_alone_is_further_off_than_many_together() {
        let (args, lights) = (args(500), lights(500));
        let exact = Field::new(&args, &line::<f64>(&lights, &Source::Compute, args.degree));
        for ((_, many), (_, one)) in errors(&args, &lights, &exact).iter().zip(alone(&args, &lights)) {
            assert!(one[0] > 3.0 * many[0] && one[1] > many[1], "{one:?} {many:?}");
        }
    }

    #[test]
    fn lights_lie_all_over_the_period() {
        let lights = lights(1000);
        for cell in 0..100 {
            let here =
                lights.iter().filter(|light| light.turn.map(|turn| (10.0 * turn) as u32) == [cell % 10, cell / 10]);
            assert!((4..=20).contains(&here.count()), "cell {cell}");
        }
    }
}
