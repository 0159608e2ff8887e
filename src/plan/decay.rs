//! How a group's coefficients fall off: what any set of kept modes leaves out, at most.
//!
//! Everything is for a bell of peak 1, and holds for every size of the group.

use std::f64::consts::TAU;

use glam::DVec2;

use super::{Group, HIGHEST_DEGREE};
use crate::series::{Bell, Bounded, Factor, Modes};
use crate::{Error, Result};

/// What the coefficients of a group's bell are at most.
pub(super) enum Decay<'a> {
    Product {
        factor: &'a dyn Factor,
        size: DVec2,
    },
    /// What is no product, by a bound of its transform.
    Whole {
        modes: Modes<'a>,
        bounds: &'a dyn Bounded,
        size: DVec2,
    },
    /// There is no series.
    None {
        bell: &'a Bell,
    },
}

/// What a factor has beyond each harmonic along one axis.
struct Axis {
    tails: Vec<f64>,
    mean: f64,
}

impl Axis {
    fn new(factor: &dyn Factor, highest: u32, size: f64) -> Self {
        Self { tails: factor.tails(highest, size), mean: factor.mean(size) }
    }

    /// The same, looked at up to a harmonic.
    fn up_to(mut self, highest: usize) -> Self {
        self.tails.truncate(highest + 1);
        self
    }

    /// A bound of the sum of all coefficients.
    fn total(&self) -> f64 {
        self.mean + self.tails[0]
    }

    /// A bound of |a_n + i b_n|.
    fn coefficient(&self, n: usize) -> f64 {
        if n == 0 { self.mean } else { 0.5 * (self.tails[n - 1] - self.tails[n]) }
    }
}

impl<'a> Decay<'a> {
    /// Of a group, in a period.
    pub fn new(group: &'a Group, period: DVec2) -> Self {
        let size = group.smallest / period;
        match group.bell.shape().modes() {
            Modes::Product(factor) => Self::Product { factor, size },
            modes @ Modes::Radial(radial) => Self::Whole { modes, bounds: radial, size },
            modes @ Modes::Plane(plane) => Self::Whole { modes, bounds: plane, size },
            Modes::None => Self::None { bell: &group.bell },
        }
    }

    /// What finding the fewest modes costs about, in nanoseconds, where so many harmonics are found along either axis.
    pub fn work(&self, harmonics: [f64; 2]) -> f64 {
        let [n, m] = harmonics.map(|harmonics| harmonics.min(f64::from(HIGHEST_DEGREE)));
        match *self {
            // Once to find them, and once to bound what they leave out.
            Self::Product { factor, size } => 2.0 * (factor.work(n, size.x) + factor.work(m, size.y)) + 3000.0,
            Self::Whole { bounds, .. } => 40.0 * bounds.work() + 10.0 * (n + m),
            Self::None { .. } => 0.0,
        }
    }

    /// What finding the fewest modes is expected to cost at least, before it is tried.
    pub fn expected_work(&self, error: f64) -> f64 {
        match *self {
            Self::Product { factor, size } => self.work([factor.degree(error, size.x), factor.degree(error, size.y)]),
            Self::Whole { .. } | Self::None { .. } => self.work([0.0; 2]),
        }
    }

    /// What [`Decay::marginals`] of a group cost about, in nanoseconds.
    pub fn held_work(&self, group: &Group) -> f64 {
        let [n, m] = group.degree.map(|degree| f64::from(degree + 1));
        match *self {
            Self::Product { factor, size } => factor.work(n, size.x) + factor.work(m, size.y),
            Self::Whole { bounds, .. } if n * m > f64::from(MANY) => ACROSS * bounds.work() * (steps(n) + steps(m)),
            Self::Whole { bounds, .. } => bounds.work() * n * m,
            Self::None { .. } => 0.0,
        }
    }

    /// The fewest modes found that leave out at most `error`: for each harmonic of x how many of y, never growing.
    ///
    /// # Errors
    /// [`Error::Plan`] where a degree beyond [`HIGHEST_DEGREE`] would be needed.
    pub fn kept(&self, error: f64) -> Result<Vec<u32>> {
        // As much as there is of it.
        if error >= 1.0 && self.beyond(&[1]) <= error {
            return Ok(vec![1]);
        }
        match *self {
            Self::Product { factor, size } => kept_product(factor, size, error),
            Self::Whole { bounds, size, .. } => kept_whole(bounds, size, error),
            Self::None { bell } => Err(no_series(bell)),
        }
    }

    /// A bound of what the kept modes leave out at any point.
    pub fn beyond(&self, counts: &[u32]) -> f64 {
        match *self {
            Self::Product { factor, size } => {
                let x = Axis::new(factor, counts.len() as u32 - 1, size.x);
                let y = Axis::new(factor, counts[0] - 1, size.y);
                beyond_product(&x, &y, counts)
            }
            Self::Whole { bounds, size, .. } => {
                let turn = TAU * size;
                let rows = (0..).zip(counts.iter().copied().chain([0]));
                // The nearest mode that is not there: at the end of a row, or where there is no row.
                let nearest = rows.map(|(n, m)| (turn * DVec2::new(f64::from(n), f64::from(m))).length());
                copies(size) * bounds.beyond(nearest.fold(f64::INFINITY, f64::min), 0.5 * turn.length())
            }
            Self::None { .. } => f64::INFINITY,
        }
    }

    /// For each harmonic of x, and for each of y, a bound of what it holds together with all kept ones of the other
    /// axis.
    pub fn marginals(&self, degree: [u32; 2]) -> [Vec<f64>; 2] {
        match *self {
            Self::Product { factor, size } => {
                let [x, y] =
                    [(degree[0], size.x), (degree[1], size.y)].map(|(degree, size)| Axis::new(factor, degree, size));
                let held = |axis: &Axis, other: &Axis, degree: u32| {
                    let doubled = |n: usize| if n == 0 { 1.0 } else { 2.0 };
                    (0..=degree as usize).map(|n| doubled(n) * axis.coefficient(n) * other.total()).collect()
                };
                [held(&x, &y, degree[0]), held(&y, &x, degree[1])]
            }
            Self::Whole { bounds, size, .. } if (degree[0] + 1) * (degree[1] + 1) > MANY => {
                envelopes(bounds, size, degree)
            }
            Self::Whole { modes, size, .. } => {
                let counts = vec![degree[1] + 1; degree[0] as usize + 1];
                let table = modes.table(&counts, size);
                let mut held = [vec![0.0; degree[0] as usize + 1], vec![0.0; degree[1] as usize + 1]];
                for (index, coefficient) in table.iter().enumerate() {
                    let coefficient: f64 = coefficient.iter().map(|part| part.abs()).sum();
                    held[0][index / (degree[1] as usize + 1)] += coefficient;
                    held[1][index % (degree[1] as usize + 1)] += coefficient;
                }
                held
            }
            Self::None { .. } => degree.map(|degree| vec![f64::INFINITY; degree as usize + 1]),
        }
    }
}

/// More modes than this are bounded, and not looked at one by one.
const MANY: u32 = 20_000;
/// How many envelopes it takes to bound what lies across a harmonic.
const ACROSS: f64 = 66.0;
/// From this harmonic on not each of them is bounded: but those that are a little farther than the last by as much as the last.
const CLOSELY: u32 = 16;
const FARTHER: f64 = 1.06;

/// About how many of so many harmonics are bounded.
fn steps(harmonics: f64) -> f64 {
    let closely = f64::from(CLOSELY);
    harmonics.min(closely) + (harmonics / closely).max(1.0).ln() / FARTHER.ln()
}

/// What the modes of each harmonic of x, and of y, hold at most, by a bound m of |ĝ| that never grows: beside harmonic n
/// at z = a, Σ_m κ_m m(√(a² + b²m²)) is no more than m(a) and twice the integral.
fn envelopes(bounds: &dyn Bounded, size: DVec2, degree: [u32; 2]) -> [Vec<f64>; 2] {
    let turn = TAU * size;
    let volume = size.element_product();
    let axis = |degree: u32, along: f64, across: f64| -> Vec<f64> {
        let doubled = |n: u32| if n == 0 { 1.0 } else { 2.0 };
        let bound = |n: u32| {
            let a = along * f64::from(n);
            volume * (bounds.envelope(a) + 2.0 / across * bounds.envelope_across(a))
        };
        // No envelope grows.
        let (mut last, mut held) = (0, bound(0));
        let at = |n: u32| {
            if n < CLOSELY || f64::from(n) >= FARTHER * f64::from(last) {
                (last, held) = (n, bound(n));
            }
            doubled(n) * held
        };
        (0..=degree).map(at).collect()
    };
    [axis(degree[0], turn.x, turn.y), axis(degree[1], turn.y, turn.x)]
}

/// The modes whose coefficients are largest: all above a threshold, found by bisection. For a Gaussian they are an
/// ellipse, for a bell whose coefficients fall like powers of n and of m a hyperbolic cross.
fn kept_product(factor: &dyn Factor, size: DVec2, error: f64) -> Result<Vec<u32>> {
    let (x, y) = axes_within(factor, size, error)?;
    let columns: Vec<f64> = (0..x.tails.len()).map(|n| x.coefficient(n)).collect();
    let rows: Vec<f64> = (0..y.tails.len()).map(|m| y.coefficient(m)).collect();
    let largest = columns[0] * rows[0];
    let smallest = 1e-3 * error / (columns.len() * rows.len()) as f64;
    let (mut high, mut low) = (0.0, (smallest / largest).ln());
    for _ in 0..16 {
        let middle = 0.5 * (low + high);
        let counts = above(&columns, &rows, largest * f64::exp(middle));
        if beyond_product(&x, &y, &counts) > error { high = middle } else { low = middle }
    }
    let counts = above(&columns, &rows, largest * f64::exp(low));
    Ok(if beyond_product(&x, &y, &counts) > error { above(&columns, &rows, 0.0) } else { counts })
}

/// Parts of the error that may lie beyond either axis; and by what the degree of a smooth bell grows at most from the first to the
/// last of them.
const PARTS: [f64; 4] = [0.3, 0.15, 0.07, 0.03];
const SMOOTH: f64 = 1.8;

/// Both axes up to degrees whose rectangle leaves out less than the error.
fn axes_within(factor: &dyn Factor, size: DVec2, error: f64) -> Result<(Axis, Axis)> {
    // Beyond either axis a part of the error is left out; a smaller part makes the degree higher, and leaves more of
    // the error to modes within the rectangle, where n and m are both high.
    let degrees = |part: f64| [size.x, size.y].map(|size| factor.degree(part * error, size));
    // Of a smooth bell the degree hardly grows, and one look at its coefficients does for all parts.
    let [all, most] = [PARTS[0], PARTS[PARTS.len() - 1]].map(|part| degrees(part)[0].max(degrees(part)[1]));
    let mut looked_at = None;
    let mut least = f64::INFINITY;
    for part in PARTS {
        let wanted = degrees(part);
        if wanted[0].max(wanted[1]) > f64::from(HIGHEST_DEGREE) {
            least = least.min(wanted[0].max(wanted[1]));
            break;
        }
        let highest = wanted.map(|degree| degree.ceil() as usize);
        let (x, y) = looked_at.take().unwrap_or_else(|| {
            let [n, m] = if most <= SMOOTH * all { degrees(PARTS[PARTS.len() - 1]) } else { wanted };
            let axis = |degree: f64, size: f64| Axis::new(factor, degree.ceil() as u32, size);
            (axis(n, size.x), axis(m, size.y))
        });
        if x.tails[highest[0]] * y.total() + y.tails[highest[1]] * x.total() < 0.8 * error {
            return Ok((x.up_to(highest[0]), y.up_to(highest[1])));
        }
        looked_at = Some((x, y)).filter(|(x, y)| x.tails.len() > highest[0] + 1 || y.tails.len() > highest[1] + 1);
    }
    Err(too_high(least))
}

/// For each column how many rows have a product of at least the threshold; one at least. Both fall.
fn above(columns: &[f64], rows: &[f64], threshold: f64) -> Vec<u32> {
    let mut count = rows.len();
    let mut counts = Vec::with_capacity(columns.len());
    for column in columns {
        while count > 0 && column * rows[count - 1] < threshold {
            count -= 1;
        }
        if count == 0 {
            break;
        }
        counts.push(count as u32);
    }
    if counts.is_empty() { vec![1] } else { counts }
}

/// The sum of all coefficients outside the kept modes: the largest error, for a Gaussian reached at its centre.
///
/// By summation by parts it is a sum of tails in x and in y with factors that are not negative, as long as the rows get
/// no longer with n; so a bound of the tails bounds it, also one that holds for all sizes of a group.
fn beyond_product(x: &Axis, y: &Axis, counts: &[u32]) -> f64 {
    let doubled = |n: usize| if n == 0 { 1.0 } else { 2.0 };
    let rows = counts.iter().enumerate();
    let within: f64 = rows.map(|(n, &count)| doubled(n) * x.coefficient(n) * y.tails[count as usize - 1]).sum();
    within + x.tails[counts.len() - 1] * y.total()
}

/// How many copies of a bell that ends, of a size in periods, may have their rims at one point. Each of them leaves out
/// what one bell does.
fn copies(size: DVec2) -> f64 {
    let along = |size: f64| 1.0 + 2.0 * (size + 0.5).floor();
    along(size.x) * along(size.y)
}

/// The modes within an ellipse, found by bisection.
fn kept_whole(bounds: &dyn Bounded, size: DVec2, error: f64) -> Result<Vec<u32>> {
    let turn = TAU * size;
    let cell = 0.5 * turn.length();
    let highest = turn.min_element() * f64::from(HIGHEST_DEGREE);
    let (mut low, mut high) = (0.0, highest);
    let error = error / copies(size);
    if bounds.beyond(highest, cell) > error {
        return Err(too_high(f64::INFINITY));
    }
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        if bounds.beyond(middle, cell) > error { low = middle } else { high = middle }
    }
    // No mode below the radius may be missing.
    let axes = high / turn;
    let rows = axes.x.floor() as u32;
    let row = |n: u32| {
        let across = 1.0 - (f64::from(n) / axes.x.max(f64::MIN_POSITIVE)).powi(2);
        (axes.y * across.max(0.0).sqrt()).floor() as u32 + 1
    };
    Ok((0..=rows).map(row).collect())
}

/// Why a bell has no series at any degree.
pub(super) fn no_series(bell: &Bell) -> Error {
    let what = match bell {
        Bell::Disc(_) => "a disc with blades".to_owned(),
        bell => format!("a {bell}"),
    };
    Error::Plan(format!(
        "{what} has no series here: the evaluators local and direct sum it, and the plan puts it beside the series of other \
         ghosts by itself"
    ))
}

fn too_high(degree: f64) -> Error {
    let needed = if degree.is_finite() { format!("need one of about {degree:.0}") } else { "need more".to_owned() };
    Error::Plan(format!(
        "the highest degree of a series is {HIGHEST_DEGREE}, and these ghosts {needed}; the evaluator direct has no degree \
         (--evaluator direct, or By hand)"
    ))
}
