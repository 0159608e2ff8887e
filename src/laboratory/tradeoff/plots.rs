//! The points as charts.

use super::Results;
use super::captions as say;
use super::front::{exponent, ghosts, times};
use super::point::{Point, Storage, Sweep};
use crate::chart::{Along, COLOURS, Chart, Colour, Series, Stroke};
use crate::plan::Evaluator;

/// A chart, the name of its files, and what to see in it.
pub(super) struct Plot {
    pub stem: &'static str,
    pub caption: String,
    pub chart: Chart,
}

const FRONT: Colour = [90, 90, 90];

/// The plots that there are points for.
pub(super) fn plots(results: &Results) -> Vec<Plot> {
    let all = [tolerance, veil, degree, oversampling, storage, many, size, phases];
    all.iter().filter_map(|plot| plot(results)).collect()
}

fn of(results: &Results, sweep: Sweep) -> impl Iterator<Item = &Point> {
    results.points.iter().filter(move |point| point.sweep == sweep && point.measured.is_some())
}

fn pairs<'a>(
    points: impl Iterator<Item = &'a Point>,
    x: impl Fn(&Point) -> Option<f64>,
    y: impl Fn(&Point) -> Option<f64>,
) -> Vec<[f64; 2]> {
    points.filter_map(|point| Some([x(point)?, y(point)?])).collect()
}

/// The same colour for an evaluator in every plot.
fn colour(evaluator: Evaluator) -> Colour {
    let index = Evaluator::ALL.iter().position(|&other| other == evaluator).unwrap_or(0);
    COLOURS[[1, 3, 2, 0, 4][index]]
}

fn logarithmic(title: &str, x: &str, y: &str) -> Chart {
    Chart::new(title, x, y).log_x().log_y()
}

fn tolerance(results: &Results) -> Option<Plot> {
    let swept = || of(results, Sweep::Tolerance);
    swept().next()?;
    let mut chart = logarithmic(
        "Error against time, from tolerance 1e-1 to 1e-7",
        "spectrum, field and composite, ms",
        "largest error, relative",
    );
    for evaluator in Evaluator::ALL {
        let mine = swept().filter(|point| point.evaluator == Some(evaluator));
        let points = pairs(mine, |point| point.ms, |point| point.measured);
        if !points.is_empty() {
            chart =
                chart.with(Series::new(evaluator.to_string(), points).stroke(Stroke::Joined).colour(colour(evaluator)));
        }
    }
    let front = stairs(pairs(results.front.iter().map(|&i| &results.points[i]), |p| p.ms, |p| p.measured));
    let chosen = pairs(swept().filter(|point| point.planner), |point| point.ms, |point| point.measured);
    let chart = chart
        .with(
            Series::new("the front: nothing is both faster and more exact", front).stroke(Stroke::Dashed).colour(FRONT),
        )
        .with(Series::new("the planner’s choices", chosen).stroke(Stroke::Rings).colour([0, 0, 0]));
    Some(Plot { stem: "error-against-time", caption: say::tolerance(results), chart })
}

fn veil(results: &Results) -> Option<Plot> {
    let swept = || of(results, Sweep::Veil);
    swept().next()?;
    let title = "The veil: error against time, from a coarse tolerance to a fine one";
    let front = stairs(pairs(results.veil_front.iter().map(|&i| &results.points[i]), |p| p.ms, |p| p.measured));
    let chart =
        logarithmic(title, "sum of three colours on the processor, ms", "error, relative to the veil at each pixel")
            .with(Series::new("predicted", pairs(swept(), |p| p.ms, |p| p.predicted)).stroke(Stroke::Dashed))
            .with(Series::new("measured, largest", pairs(swept(), |p| p.ms, |p| p.measured)).stroke(Stroke::Joined))
            .with(Series::new("the front", front).stroke(Stroke::Dashed).colour(FRONT));
    Some(Plot { stem: "veil-error-against-time", caption: say::veil(results), chart })
}

/// A front as stairs: what is had at least until the next better one.
fn stairs(points: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    let mut stairs: Vec<[f64; 2]> = Vec::new();
    for point in points {
        if let Some(&[_, error]) = stairs.last() {
            stairs.push([point[0], error]);
        }
        stairs.push(point);
    }
    stairs
}

fn degree(results: &Results) -> Option<Plot> {
    let n = |point: &Point| point.degree_x.map(f64::from);
    let swept = || of(results, Sweep::Degree);
    swept().next()?;
    let mut chart = Chart::new("Error against the degree, beside its bound", "degree N along x", "error, relative")
        .log_y()
        .with(Series::new("predicted", pairs(swept(), n, |point| point.predicted)).stroke(Stroke::Dashed))
        .with(Series::new("measured, largest", pairs(swept(), n, |point| point.measured)).stroke(Stroke::Joined))
        .with(Series::new("measured, root mean square", pairs(swept(), n, |point| point.rms)).stroke(Stroke::Dotted));
    let last = swept().filter_map(n).fold(0.0, f64::max);
    let planned =
        |point: &&Point| point.planner && point.asked.is_some_and(|asked| [1e-1, 1e-2, 1e-3, 1e-4].contains(&asked));
    for point in of(results, Sweep::Tolerance).filter(planned) {
        if let Some((at, asked)) = n(point).filter(|&at| at <= last).zip(point.asked) {
            chart = chart.mark(exponent(asked), Along::Vertical, at);
        }
    }
    // Room for the marks' labels above the curves.
    let values = chart.series.iter().flat_map(|series| &series.points).map(|point| point[1]);
    let least = values.filter(|&error| error > 0.0).fold(1.0, f64::min);
    let chart = chart.range_y(0.5 * least, 20.0);
    Some(Plot { stem: "error-against-degree", caption: say::degree(), chart })
}

fn oversampling(results: &Results) -> Option<Plot> {
    let nodes = |point: &Point| point.oversampling;
    let forced = || of(results, Sweep::Oversampling).filter(|point| !point.planner);
    forced().next()?;
    let mut chart = logarithmic(
        "Error against the oversampling of grid’s lattice",
        "nodes a half wave of the highest harmonic",
        "error, relative",
    )
    .with(Series::new("predicted", pairs(forced(), nodes, |point| point.predicted)).stroke(Stroke::Dashed))
    .with(Series::new("measured, largest", pairs(forced(), nodes, |point| point.measured)).stroke(Stroke::Joined));
    if let Some((at, asked)) = of(results, Sweep::Oversampling)
        .find(|point| point.planner)
        .and_then(|point| point.oversampling.zip(point.asked))
    {
        chart = chart.mark(format!("planned for {}", exponent(asked)), Along::Vertical, at);
    }
    Some(Plot { stem: "error-against-oversampling", caption: say::oversampling(), chart })
}

fn storage(results: &Results) -> Option<Plot> {
    let stored = |storage| of(results, Sweep::Storage).filter(move |point| point.storage == storage);
    stored(Storage::Half).next()?;
    let asked = |point: &Point| point.asked;
    let chart =
        logarithmic("The spectrum’s terms in 32 and in 16 bits", "tolerance asked for", "largest error, relative")
            .with(Series::new("32 bits", pairs(stored(Storage::Float), asked, |p| p.measured)).stroke(Stroke::Joined))
            .with(Series::new("16 bits", pairs(stored(Storage::Half), asked, |p| p.measured)).stroke(Stroke::Joined))
            .with(
                Series::new("what was asked", pairs(stored(Storage::Float), asked, asked))
                    .stroke(Stroke::Dashed)
                    .colour(FRONT),
            );
    Some(Plot { stem: "error-against-storage", caption: say::storage(), chart })
}

/// Milliseconds of each evaluator against something.
fn evaluators(results: &Results, mut chart: Chart, sweep: Sweep, x: fn(&Point) -> f64) -> Chart {
    for evaluator in Evaluator::ALL {
        let points = times(&results.points, sweep, evaluator, x);
        if !points.is_empty() {
            chart =
                chart.with(Series::new(evaluator.to_string(), points).stroke(Stroke::Joined).colour(colour(evaluator)));
        }
    }
    chart
}

fn many(results: &Results) -> Option<Plot> {
    of(results, Sweep::Ghosts).next()?;
    let chart = logarithmic("Time against the number of ghosts", "ghosts K", "spectrum, field and composite, ms");
    let mut chart = evaluators(results, chart, Sweep::Ghosts, ghosts);
    for crossover in &results.crossovers {
        if let Some(count) = crossover.ghosts {
            chart = chart.mark(format!("{} from K = {count:.0}", crossover.evaluator), Along::Vertical, count);
        }
    }
    Some(Plot { stem: "time-against-ghosts", caption: say::ghosts(results), chart })
}

fn size(results: &Results) -> Option<Plot> {
    let pixels = |point: &Point| f64::from(point.width) * f64::from(point.height);
    of(results, Sweep::Size).next()?;
    let chart = logarithmic("Time against the picture’s size", "pixels", "spectrum, field and composite, ms");
    let chart = evaluators(results, chart, Sweep::Size, pixels);
    let chosen = of(results, Sweep::Size).filter(|point| point.planner);
    let chosen = pairs(chosen, |point| Some(pixels(point)), |point| point.ms);
    let chart = chart.with(Series::new("the planner’s choices", chosen).stroke(Stroke::Rings).colour([0, 0, 0]));
    Some(Plot { stem: "time-against-size", caption: say::size_plot(results), chart })
}

fn phases(results: &Results) -> Option<Plot> {
    results.phases.first()?;
    let mut chart = logarithmic(
        "Stability of phases: cos(n·2πx/T) by what computes it",
        "n·x/T at the picture’s border, turns",
        "largest error of the cosine",
    )
    .range_y(1e-8, 1.0);
    for (curve, colour) in results.phases.iter().zip([COLOURS[1], COLOURS[4], COLOURS[0], COLOURS[3], COLOURS[2]]) {
        chart = chart.with(Series::new(curve.way, curve.points.clone()).colour(colour));
    }
    if let Some(reach) = results.phase_reach {
        chart = chart.mark("this photo’s plans end here", Along::Vertical, reach);
    }
    Some(Plot { stem: "stability-of-phases", caption: say::phases(results), chart })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stairs_go_right_and_then_down() {
        let front = stairs(vec![[1.0, 1e-2], [3.0, 1e-4]]);
        assert_eq!(front, [[1.0, 1e-2], [3.0, 1e-2], [3.0, 1e-4]]);
    }

    #[test]
    fn every_evaluator_has_a_colour_of_its_own() {
        let colours = Evaluator::ALL.map(colour);
        assert!((1..colours.len()).all(|k| !colours[..k].contains(&colours[k])), "{colours:?}");
    }
}
