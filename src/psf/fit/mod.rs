//! Mixtures of Gaussians of the least largest relative error, found when they are asked for.
//!
//! | file | what |
//! | --- | --- |
//! | `samples` | the angles of a fit, and sums of Gaussians there |
//! | `squares` | from a rough start to the least squares, in widths and weights |
//! | `exchange` | from there to the least largest error |
//! | `linear` | the weights alone, of widths that are given |
//! | `search` | how many Gaussians a tolerance takes |
//! | `observers` | one set of widths for all ages |
//! | `powers` | |d|^−s and |d|^q |

mod dense;
mod exchange;
mod linear;
mod observers;
mod powers;
mod samples;
mod search;
mod squares;

use super::Fault;
use super::plane::Term;
use samples::{Samples, Sum};

pub(super) use linear::least_largest;
pub(super) use observers::AllAges;
pub use powers::{growing_power, power};
pub(super) use samples::{Profile, even_in_logarithm};

/// Most Gaussians of a fit.
pub const MOST_TERMS: usize = 48;
/// The tolerances of a fit: below the first, 64-bit normal equations tell neighbouring Gaussians no longer apart.
pub const TOLERANCES: [f64; 2] = [1e-6, 0.5];

/// Gaussians whose sum, with a constant and a term in the squared angle, is a radial function within a stated relative
/// error.
#[derive(Debug, Clone, PartialEq)]
pub struct Mixture {
    /// The Gaussians, from narrow to wide.
    pub terms: Vec<Term>,
    /// What is added everywhere, exactly: on the sphere and in the plane a moment of the picture (rank 1).
    pub constant: f64,
    /// What the squared angle is taken by and added, exactly: per squared unit, likewise a moment (rank 4).
    pub quadratic: f64,
    /// The largest |sum − function| / function over `range`, measured at 64 angles for each Gaussian and by the
    /// parabolas through three neighbours; above the tolerance where [`MOST_TERMS`] do not meet it.
    pub error: f64,
    /// The angles between which `error` holds. Nearer to 0 the sum is bounded by its own value at 0, which for a power
    /// law is far below the law; beyond, it falls as its widest Gaussian does.
    pub range: [f64; 2],
}

impl Mixture {
    /// A constant alone.
    pub(super) fn of_constant(constant: f64, range: [f64; 2]) -> Self {
        Self { terms: Vec::new(), constant, quadratic: 0.0, error: 0.0, range }
    }

    /// The sum at an angle, without tints.
    pub fn value(&self, angle: f64) -> f64 {
        let square = angle * angle;
        self.terms.iter().map(|term| term.value(square)).sum::<f64>() + self.constant + self.quadratic * square
    }

    /// Whether all weights are 0 or more, as they are unless the function is none that falls as mixtures do (completely
    /// monotone in the squared angle): then sums may cancel.
    pub fn is_positive(&self) -> bool {
        self.terms.iter().all(|term| term.weight >= 0.0)
    }

    /// The largest Σ |terms| over the function's size within the range: by what rounding is multiplied; 1 of a positive
    /// mixture.
    pub fn cancellation(&self) -> f64 {
        if self.is_positive() && self.constant >= 0.0 && self.quadratic >= 0.0 {
            return 1.0;
        }
        let at = |angle: f64| {
            let square = angle * angle;
            let sizes: f64 = self.terms.iter().map(|term| term.value(square).abs()).sum();
            (sizes + self.constant.abs() + self.quadratic.abs() * square) / self.value(angle).abs()
        };
        even_in_logarithm(self.range, 16 * self.terms.len() + 2).map(at).fold(1.0, f64::max)
    }

    /// All of it times a factor.
    #[must_use]
    pub(super) fn scaled(mut self, factor: f64) -> Self {
        self.terms.iter_mut().for_each(|term| term.weight *= factor);
        self.constant *= factor;
        self.quadratic *= factor;
        self
    }
}

/// A fit: standard deviations and heights, from narrow to wide, and the largest error.
#[derive(Debug, Clone)]
pub(super) struct Fitted {
    pub gaussians: Vec<[f64; 2]>,
    pub error: f64,
}

/// The range and the tolerance of a fit, if they are such.
pub(super) fn checked(range: [f64; 2], tolerance: f64) -> Result<([f64; 2], f64), Fault> {
    let [from, to] = range;
    if !(1e-18..=1e18).contains(&from) || !(from..=1e18).contains(&to) {
        return Err(Fault::new(
            "range",
            format!("a range is from an angle above 0 to one not below it, and not from {from} to {to}"),
        ));
    }
    let [least, most] = TOLERANCES;
    let rule = "a tolerance is from 1e-6 to 0.5";
    Ok((range, super::fault::within("tolerance", tolerance, [least, most], rule)?))
}

/// The fewest Gaussians that meet `tolerance` over `range`, or the best that were found.
pub(super) fn fitted(profile: &impl Profile, range: [f64; 2], tolerance: f64) -> Fitted {
    let shape = search::Shape::new(profile, range, tolerance);
    let positive = search::fewest(&shape, tolerance, |count, last| free(profile, &shape, count, last));
    if positive.error <= tolerance { positive } else { search::signed(profile, &shape, tolerance, positive) }
}

/// By how much ln of a function lies above the largest convex function of the squared angle below it, at `places` (angles that
/// grow). Infinite where it vanishes before the last.
///
/// A sum of positive Gaussians is completely monotone in the squared angle, and the logarithm of such a function is convex (D. V. Widder,
/// *The Laplace transform*, 1941, ch. IV): of one that is within ε of such a sum this is at most ln((1 + ε)/(1 − ε)).
pub(super) fn above_convex(value: impl Fn(f64) -> f64, places: &[f64]) -> f64 {
    let points: Vec<[f64; 2]> = places.iter().map(|&angle| [angle * angle, value(angle).ln()]).collect();
    if points.iter().any(|[_, logarithm]| !logarithm.is_finite()) {
        return f64::INFINITY;
    }
    // The lower hull (A. M. Andrew, 1979): its slopes grow.
    let slope = |a: [f64; 2], b: [f64; 2]| (b[1] - a[1]) / (b[0] - a[0]);
    let mut hull: Vec<[f64; 2]> = Vec::new();
    for &point in &points {
        while let [.., before, last] = hull[..]
            && slope(before, last) >= slope(last, point)
        {
            hull.pop();
        }
        hull.push(point);
    }
    // Nor does it ever rise.
    let rise =
        points.iter().fold([f64::INFINITY, 0.0f64], |[least, most], [_, y]| [least.min(*y), most.max(y - least)]);
    let below = |point: &[f64; 2]| {
        let next = hull.partition_point(|corner| corner[0] < point[0]).clamp(1, hull.len().max(2) - 1);
        match hull.get(next) {
            Some(&corner) => hull[next - 1][1] + slope(hull[next - 1], corner) * (point[0] - hull[next - 1][0]),
            None => point[1],
        }
    };
    points.iter().map(|point| point[1] - below(point)).fold(rise[1], f64::max)
}

/// The best of `count` Gaussians from some starts, the first of which is the `last` fit, stretched.
fn free(profile: &impl Profile, shape: &search::Shape, count: usize, last: Option<&Fitted>) -> Fitted {
    let samples = shape.samples(profile, count);
    let mut best: Option<Sum> = None;
    for widths in shape.starts(count, last) {
        let weights = widths.iter().map(|width| profile(shape.within(width.exp()))[0].ln()).collect();
        let level = levelled(&samples, Sum::new(&samples, widths, weights));
        // No other start leads to less than the least.
        let done = exchange::is_level(&level);
        if best.as_ref().is_none_or(|best| level.largest() < best.largest()) {
            best = Some(level);
        }
        if done {
            break;
        }
    }
    let mut gaussians: Vec<[f64; 2]> = best
        .map(|sum| sum.widths.iter().zip(&sum.weights).map(|(width, weight)| [width.exp(), weight.exp()]).collect())
        .unwrap_or_default();
    gaussians.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let error = measured(profile, shape.range, &gaussians);
    Fitted { gaussians, error }
}

/// Least squares until the exchange can begin; where that stops short, once more from closer by.
fn levelled(samples: &Samples, start: Sum) -> Sum {
    let near = squares::least_squares(samples, start, 30, true);
    let level = exchange::levelled(samples, near.clone(), 20);
    if exchange::is_level(&level) {
        return level;
    }
    let nearer = exchange::levelled(samples, squares::least_squares(samples, near, 30, false), 20);
    if nearer.largest() < level.largest() { nearer } else { level }
}

/// The largest error of a sum over `range`.
fn measured(profile: &impl Profile, range: [f64; 2], gaussians: &[[f64; 2]]) -> f64 {
    let inverse: Vec<[f64; 2]> = gaussians.iter().map(|[sigma, height]| [-0.5 / (sigma * sigma), *height]).collect();
    let off = |angle: f64| {
        let [wanted, unit] = profile(angle);
        let square = angle * angle;
        let sum: f64 = inverse.iter().map(|[inverse, height]| height * (inverse * square).exp()).sum();
        (sum - wanted) / unit
    };
    let errors: Vec<f64> = even_in_logarithm(range, 64 * (gaussians.len() + 2)).map(off).collect();
    let between = errors.windows(3).map(|near| summit(near[0], near[1], near[2])).fold(0.0, f64::max);
    samples::largest(&errors).max(between)
}

/// The size of the extremum of the parabola through three even neighbours, where it lies between them.
fn summit(before: f64, here: f64, after: f64) -> f64 {
    let (slope, bend) = (0.5 * (after - before), before - 2.0 * here + after);
    if slope.abs() < bend.abs() { (here - 0.5 * slope * slope / bend).abs() } else { 0.0 }
}
