//! How long an update of the spectrum takes.

use std::hint::black_box;

use super::table::{Light, Real, Source, Table, line, plane};
use super::{Args, Errors, WAYS};
use crate::Result;
use crate::laboratory::rex::chart::{Along, Chart, Series, Stroke};
use crate::laboratory::rex::{Figure, Report};
use crate::measure::{Rounds, Samples, interleave};

/// An update should take this many additions at least, to be timed by a clock.
const WORK: u64 = 300_000;

/// One of the things that are timed in turns.
type Arm<'a> = &'a mut dyn FnMut() -> Result<()>;

/// Each arm's times, in the order of [`ARMS`].
type Times = [Samples; 6];
const ARMS: [&str; 6] = ["cos and sin, f64", "rotation, f64", WAYS[0], WAYS[1], WAYS[2], WAYS[3]];

/// Times the updates in one and two dimensions with every table, and reports them.
///
/// # Errors
/// [`crate::Error::Chart`] where the chart cannot be drawn.
pub(super) fn measure(report: &mut Report, args: &Args, lights: &[Light], errors: &Errors) -> Result<()> {
    let mut table = crate::laboratory::rex::Table::new(
        "updates",
        "One update of the spectrum of all lights: the least and the median time of rounds in turns, the ratio of the \
         least to that of computing cos and sin, the size of the table and the error of the glare along x",
        &["dimensions", "entries P", "harmonics", "least ms", "median ms", "ratio", "table KiB", "error"],
    );
    let mut curves: [[Vec<[f64; 2]>; 2]; 6] = Default::default();
    for &(entries, error) in errors {
        let tables = (Table::<f64>::new(entries, args.degree), Table::<f32>::new(entries, args.degree));
        for (dimension, curve) in [(1, 0), (2, 1)] {
            let times = times(args, lights, &tables, dimension)?;
            for (arm, name) in ARMS.into_iter().enumerate() {
                // Whatever else the machine does only adds time, so the least of many rounds is the truest.
                let ratio = times[arm].min() / times[0].min();
                curves[arm][curve].push([f64::from(entries), ratio]);
                let bytes = match arm {
                    0 | 1 => None,
                    2 | 3 => Some(tables.0.bytes()),
                    _ => Some(tables.1.bytes()),
                };
                let error = arm.checked_sub(2).map(|way| error[way]);
                table.row(row(dimension, entries, name, &times[arm], ratio, bytes, error));
            }
        }
    }
    for (dimension, curve) in [(1, 0), (2, 1)] {
        let points: Vec<_> = curves.iter().map(|arm| arm[curve].clone()).collect();
        summary(report, dimension, &points);
        report.figures.push(chart(dimension, args, &points)?);
    }
    report.tables.push(table);
    Ok(())
}

fn row(
    dimension: u32,
    entries: u32,
    name: &str,
    times: &Samples,
    ratio: f64,
    bytes: Option<usize>,
    error: Option<f64>,
) -> [String; 8] {
    let kib = bytes.map_or(String::new(), |bytes| format!("{:.0}", bytes as f64 / 1024.0));
    let error = error.map_or(String::new(), |error| format!("{error:.1e}"));
    let ms = |value: f64| format!("{value:.3}");
    let (dimension, entries) = (dimension.to_string(), entries.to_string());
    let [least, median, ratio] = [ms(times.min()), ms(times.median()), format!("{ratio:.2}")];
    [dimension, entries, name.to_owned(), least, median, ratio, kib, error]
}

/// The six arms of one table size, in turns; milliseconds an update.
fn times(args: &Args, lights: &[Light], tables: &(Table<f64>, Table<f32>), dimension: u32) -> Result<Times> {
    let modes = u64::from(args.degree + 1);
    let additions = lights.len() as u64 * if dimension == 1 { 2 * modes } else { 4 * modes * modes };
    let repeats = WORK.div_ceil(additions).max(1) as u32;
    let rounds = Rounds::new(2, usize::from(args.rounds));
    let (wide, narrow) = tables;
    let arms: [Arm<'_>; 6] = [
        &mut || update::<f64>(lights, &Source::Compute, args.degree, dimension, repeats),
        &mut || update::<f64>(lights, &Source::Rotate, args.degree, dimension, repeats),
        &mut || update(lights, &Source::Nearest(wide), args.degree, dimension, repeats),
        &mut || update(lights, &Source::Linear(wide), args.degree, dimension, repeats),
        &mut || update(lights, &Source::Nearest(narrow), args.degree, dimension, repeats),
        &mut || update(lights, &Source::Linear(narrow), args.degree, dimension, repeats),
    ];
    let times = interleave(rounds, arms)?;
    Ok(times.map(|samples| samples.scaled(1.0 / f64::from(repeats))))
}

fn update<R: Real>(lights: &[Light], source: &Source<'_, R>, degree: u32, dimension: u32, repeats: u32) -> Result<()> {
    for _ in 0..repeats {
        if dimension == 1 {
            black_box(line(black_box(lights), source, degree));
        } else {
            black_box(plane(black_box(lights), source, degree));
        }
    }
    Ok(())
}

fn summary(report: &mut Report, dimension: u32, curves: &[Vec<[f64; 2]>]) {
    for (arm, name) in ARMS.into_iter().enumerate().skip(1) {
        let ratios: Vec<f64> = curves[arm].iter().map(|point| point[1]).collect();
        let ends = ratios.iter().fold([f64::INFINITY, 0.0_f64], |[low, high], &r| [low.min(r), high.max(r)]);
        let what = format!("{dimension}-D update by {name}, against cos and sin");
        report.measure(what, format!("{:.2} to {:.2} times as long", ends[0], ends[1]));
    }
}

fn chart(dimension: u32, args: &Args, curves: &[Vec<[f64; 2]>]) -> Result<Figure> {
    let title = format!("Time of an update in {dimension} dimension{}", if dimension == 1 { "" } else { "s" });
    let mut chart = Chart::new(title, "entries P in a period", "time / time with cos and sin").log_x();
    for (points, name) in curves.iter().zip(ARMS).skip(1) {
        chart = chart.with(Series::new(name, points.clone()).stroke(Stroke::Joined));
    }
    let most = curves.iter().flatten().map(|point| point[1]).fold(1.0, f64::max);
    let chart = chart.mark("cos and sin of every harmonic", Along::Horizontal, 1.0).range_y(0.0, 1.15 * most);
    let caption = format!(
        "The spectrum of {} lights at N = {} on one core, against computing cos and sin of every harmonic of every light \
         in f64. A table that no longer fits the caches is read from memory.",
        args.lights, args.degree
    );
    Figure::chart(format!("time-{dimension}d"), caption, &chart)
}
