//! What the points say: the front of the best, where evaluators meet, what to recommend.

use serde::Serialize;

use super::point::{Point, Sweep};
use crate::measure::crossover;
use crate::plan::Evaluator;

/// ΔE2000 below which a difference is not seen: about what a trained eye tells apart side by side (CIE 142:2001).
pub const VISIBLE: f64 = 1.0;
/// How much longer something may take and still be as fast: what medians of a few rounds cannot tell apart.
const SAME: f64 = 1.15;

/// Where one evaluator becomes faster than the direct sum.
#[derive(Debug, Clone, Serialize)]
pub struct Crossover {
    /// The evaluator that meets the direct sum.
    pub evaluator: Evaluator,
    /// The number of ghosts; none where it happens nowhere in the sweep, or before it begins.
    pub ghosts: Option<f64>,
    /// Whether the evaluator is the faster one with the fewest ghosts already.
    pub always: bool,
}

/// What to use for this photo here.
#[derive(Debug, Clone, Serialize)]
pub struct Recommendation {
    /// The tolerance to ask for.
    pub tolerance: f64,
    /// What the planner takes at it.
    pub evaluator: Evaluator,
    /// At the photo's own size where that was timed, else at the sweeps'.
    pub width: u32,
    /// Rows of that picture.
    pub height: u32,
    /// Spectrum, field and composite, milliseconds.
    pub ms: f64,
    /// The largest error of any picture at this tolerance, where all pixels of the timed one were measured, or a sample.
    pub measured: f64,
    /// Whether all of them were.
    pub everywhere: bool,
    /// At the sample's pixels and, where pictures of it were drawn, at all of theirs.
    pub delta_e_max: f64,
    /// Of the tone-mapped composite, in dB.
    pub psnr_db: f64,
    /// Whether its largest ΔE2000 is below `VISIBLE`.
    pub invisible: bool,
}

/// Indices of a sweep's points that no other of it beats in both time and error, the fastest first.
pub(super) fn front(points: &[Point], sweep: Sweep) -> Vec<usize> {
    let mut swept: Vec<(usize, f64, f64)> = (points.iter().enumerate())
        .filter(|(_, point)| point.sweep == sweep)
        .filter_map(|(index, point)| Some((index, point.ms?, point.measured?)))
        .collect();
    // Of tolerances that one plan does for, the finest says what it is.
    let asked = |index: usize| points[index].asked.unwrap_or(1.0);
    swept.sort_by(|a, b| a.1.total_cmp(&b.1).then(a.2.total_cmp(&b.2)).then(asked(a.0).total_cmp(&asked(b.0))));
    let mut least = f64::INFINITY;
    swept.retain(|&(_, _, error)| {
        let better = error < least;
        least = least.min(error);
        better
    });
    swept.into_iter().map(|(index, ..)| index).collect()
}

/// The points that an evaluator has in a sweep, as x and milliseconds.
pub(super) fn times(points: &[Point], sweep: Sweep, evaluator: Evaluator, x: fn(&Point) -> f64) -> Vec<[f64; 2]> {
    let mine = points.iter().filter(|point| point.sweep == sweep && point.evaluator == Some(evaluator));
    mine.filter_map(|point| Some([x(point), point.ms?])).collect()
}

/// The number of ghosts of a point.
pub(super) fn ghosts(point: &Point) -> f64 {
    point.ghosts as f64
}

pub(super) fn crossovers(points: &[Point]) -> Vec<Crossover> {
    let direct = times(points, Sweep::Ghosts, Evaluator::Direct, ghosts);
    let against = |evaluator| {
        let mine = times(points, Sweep::Ghosts, evaluator, ghosts);
        let both = mine.iter().filter_map(|&[count, ms]| {
            direct.iter().find(|point| point[0] == count).map(|point| [count, point[1] / ms])
        });
        let ratios: Vec<[f64; 2]> = both.collect();
        let always = ratios.first().is_some_and(|first| first[1] >= 1.0);
        Crossover { evaluator, ghosts: crossover(&ratios), always }
    };
    [Evaluator::Series, Evaluator::Rows, Evaluator::Grid].map(against).to_vec()
}

/// The fastest of the points that were measured for the same request as this one.
pub(super) fn fastest<'a>(points: &'a [Point], of: &Point) -> Option<&'a Point> {
    let request = |point: &Point| (point.sweep, point.asked, point.width, point.height, point.ghosts);
    let same = points.iter().filter(|point| request(point) == request(of) && point.ms.is_some());
    same.min_by(|a, b| a.ms.unwrap_or(f64::INFINITY).total_cmp(&b.ms.unwrap_or(f64::INFINITY)))
}

/// How many times as long as the fastest the planner's choices of a sweep take, at worst.
pub(super) fn regret(points: &[Point], sweep: Sweep) -> Option<f64> {
    let own = points.iter().filter(|point| point.sweep == sweep && point.planner);
    let ratios = own.filter_map(|point| Some(point.ms? / fastest(points, point)?.ms?));
    ratios.reduce(f64::max)
}

/// Among the planner's own choices: the most exact one of those that take no longer than the fastest invisible one; where
/// none is invisible, the one that differs least.
pub(super) fn choice(points: &[Point]) -> Option<&Point> {
    let own = || points.iter().filter(|point| point.sweep == Sweep::Tolerance && point.planner && point.ms.is_some());
    let seen = |point: &&Point| point.delta_e_max.unwrap_or(f64::INFINITY);
    let ms = |point: &&Point| point.ms.unwrap_or(f64::INFINITY);
    let fastest = own().filter(|point| seen(point) < VISIBLE).min_by(|a, b| ms(a).total_cmp(&ms(b)));
    match fastest {
        Some(fastest) => own()
            .filter(|point| seen(point) < VISIBLE && ms(point) <= SAME * ms(&fastest))
            .min_by(|a, b| a.asked.unwrap_or(1.0).total_cmp(&b.asked.unwrap_or(1.0))),
        None => own().min_by(|a, b| seen(a).total_cmp(&seen(b))),
    }
}

/// The choice in figures: time and error at the largest picture that was timed with it.
pub(super) fn recommend(points: &[Point]) -> Option<Recommendation> {
    let chosen = choice(points)?;
    let largest = points.iter().rfind(|point| point.sweep == Sweep::Size && point.planner && point.ms.is_some());
    let timed = largest.unwrap_or(chosen);
    let same = points.iter().filter(|point| point.planner && point.asked == chosen.asked);
    Some(Recommendation {
        tolerance: chosen.asked?,
        evaluator: timed.evaluator?,
        width: timed.width,
        height: timed.height,
        ms: timed.ms?,
        measured: same.filter_map(|point| point.measured).fold(timed.measured?, f64::max),
        everywhere: false,
        delta_e_max: chosen.delta_e_max?,
        psnr_db: chosen.psnr_db?,
        invisible: chosen.delta_e_max? < VISIBLE,
    })
}

impl Recommendation {
    /// The same, where a larger difference was seen elsewhere.
    pub(super) fn seen(self, delta_e: f64) -> Self {
        let delta_e_max = self.delta_e_max.max(delta_e);
        Self { delta_e_max, invisible: delta_e_max < VISIBLE, ..self }
    }

    /// In a sentence.
    pub fn sentence(&self) -> String {
        let seen = if self.invisible { "invisible" } else { "visible where it is worst" };
        let where_measured = if self.everywhere { "over all pixels" } else { "at a sample of the pixels" };
        format!(
            "Use --tolerance {}: glare for {} × {} pixels costs {} ms by {}; the largest error measured {where_measured} is \
             {:.1e} of the largest glare, which is {seen} (ΔE2000 up to {}).",
            exponent(self.tolerance),
            self.width,
            self.height,
            short(self.ms),
            self.evaluator,
            self.measured,
            short(self.delta_e_max),
        )
    }
}

/// A tolerance as one writes it: 1e-3, 3.2e-4.
pub fn exponent(value: f64) -> String {
    format!("{value:e}")
}

/// Three digits or so.
pub fn short(value: f64) -> String {
    match value.abs() {
        100.0.. => format!("{value:.0}"),
        10.0.. => format!("{value:.1}"),
        1.0.. => format!("{value:.2}"),
        0.001.. => format!("{value:.3}"),
        0.0 => "0".to_owned(),
        _ => format!("{value:.1e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Error;
    use crate::frame::Frame;

    fn point(sweep: Sweep, asked: f64, ms: f64, measured: f64, delta_e: f64) -> Point {
        let empty = Point::refused(sweep, Frame::full(4, 3), 1, Some(asked), &Error::Plan(String::new()));
        Point {
            refused: None,
            planner: true,
            evaluator: Some(Evaluator::Grid),
            ms: Some(ms),
            measured: Some(measured),
            delta_e_max: Some(delta_e),
            psnr_db: Some(60.0),
            ..empty
        }
    }

    #[test]
    fn the_front_holds_what_nothing_beats_in_both() {
        let points = [
            point(Sweep::Tolerance, 1e-1, 1.0, 1e-2, 3.0),
            point(Sweep::Tolerance, 1e-2, 3.0, 1e-3, 0.5),
            point(Sweep::Tolerance, 1e-2, 4.0, 2e-3, 0.5),
            point(Sweep::Degree, 1e-2, 0.1, 1e-9, 0.5),
            point(Sweep::Tolerance, 1e-3, 3.2, 1e-4, 0.1),
        ];
        assert_eq!(front(&points, Sweep::Tolerance), [0, 1, 4]);
    }

    #[test]
    fn the_most_exact_of_the_fast_invisible_ones_is_recommended() {
        let mut points = vec![
            point(Sweep::Tolerance, 1e-1, 1.0, 1e-2, 3.0),
            point(Sweep::Tolerance, 1e-2, 3.0, 1e-3, 0.5),
            point(Sweep::Tolerance, 1e-3, 3.2, 1e-4, 0.1),
            point(Sweep::Tolerance, 1e-4, 9.0, 1e-5, 0.0),
        ];
        assert_eq!(recommend(&points).unwrap().tolerance, 1e-3);
        points.push(point(Sweep::Size, 1e-3, 50.0, 3e-4, 0.0));
        let found = recommend(&points).unwrap();
        assert_eq!((found.ms, found.measured, found.invisible), (50.0, 3e-4, true));
        assert!(found.sentence().contains("--tolerance 1e-3") && found.sentence().contains("50.0 ms"));
        assert!(found.clone().seen(0.9).invisible && !found.seen(1.1).invisible);
        let visible = recommend(&points[..1]).unwrap();
        assert!(!visible.invisible && visible.sentence().contains("visible where"));
        assert!(recommend(&[]).is_none());
    }

    #[test]
    fn the_planner_is_held_against_the_fastest_of_the_same_request() {
        let other = |asked, ms| Point { planner: false, ..point(Sweep::Tolerance, asked, ms, 1e-3, 0.0) };
        let points = [point(Sweep::Tolerance, 1e-2, 3.0, 1e-3, 0.0), other(1e-2, 2.0), other(1e-3, 1.0)];
        assert_eq!(fastest(&points, &points[0]).unwrap().ms, Some(2.0));
        assert_eq!(regret(&points, Sweep::Tolerance), Some(1.5));
        assert_eq!(regret(&points, Sweep::Size), None);
    }

    #[test]
    fn crossovers_are_where_times_meet() {
        let at = |evaluator, count: usize, ms| Point {
            ghosts: count,
            evaluator: Some(evaluator),
            ..point(Sweep::Ghosts, 1e-3, ms, 1e-4, 0.0)
        };
        let counts = [1, 10, 100];
        let direct = counts.map(|count| at(Evaluator::Direct, count, count as f64));
        let grid = counts.map(|count| at(Evaluator::Grid, count, 20.0));
        let rows = counts.map(|count| at(Evaluator::Rows, count, 0.5));
        let points: Vec<_> = direct.into_iter().chain(grid).chain(rows).collect();
        let found = crossovers(&points);
        assert!((found[2].ghosts.unwrap() - 20.0).abs() < 1e-9 && !found[2].always);
        assert!(found[1].ghosts.is_none() && found[1].always);
        assert!(found[0].ghosts.is_none() && !found[0].always);
    }

    #[test]
    fn numbers_are_short() {
        assert_eq!(
            [0.0, 123.4, 12.34, 1.234, 0.1234, 1.2e-5].map(short),
            ["0", "123", "12.3", "1.23", "0.123", "1.2e-5"]
        );
        assert_eq!([1e-3, 3.2e-4].map(exponent), ["1e-3", "3.2e-4"]);
    }
}
