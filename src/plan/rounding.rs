//! What f32 costs.

use super::Evaluator;
use super::weigh::Weighed;

/// The error, for each unit of weight, that phases, tables and sums in f32 make at most: about twice the worst that
/// tests/suite/rounding.rs has seen on Mesa's software renderer, for K from 1 to 20000 and N up to 220. A single bell
/// is the worst case: the errors of many average out.
fn per_weight(evaluator: Evaluator) -> f64 {
    match evaluator {
        Evaluator::Direct => 0.0,  // see `direct`
        Evaluator::Series => 8e-7, // seen: 3.5e-7
        Evaluator::Rows => 1.2e-6, // seen: 6.0e-7
        Evaluator::Grid => 1.6e-6, // seen: 8.3e-7, with some interpolation in it
    }
}

/// Of that, what comes of storing alone: half a unit in the last place of each result that one pass leaves to the next. For
/// `direct` these are the ghosts; for a series its terms and the harmonics of both axes; then the profiles of `rows`; and
/// then `grid`'s lattice, cells and strips.
pub(super) fn stored(weighed: &Weighed, evaluator: Evaluator) -> f64 {
    const HALF_A_UNIT: f64 = 0.5 * f32::EPSILON as f64;
    let results = match evaluator {
        Evaluator::Direct => 1.0,
        Evaluator::Series => 3.0,
        Evaluator::Rows => 4.0,
        Evaluator::Grid => 7.0,
    };
    // A single bell's direct sum is bounded by what reaches the picture, however bright it is elsewhere.
    let weight = if evaluator == Evaluator::Direct { 1.0 } else { weighed.weight.max(1.0) };
    HALF_A_UNIT * results * weight
}

/// Harmonics that [`per_weight`] was seen with. Beyond them it grows, by itself for each `PER_DEGREE`: a phase's rounding
/// is multiplied by the harmonic, and there are more terms to add up.
pub(super) const SEEN_DEGREE: u32 = 100;
const PER_DEGREE: f64 = 200.0;

/// A bound of the error of f32, storage included, for series up to a degree; relative to the field's largest value.
pub(super) fn bound(weighed: &Weighed, evaluator: Evaluator, degree: u32) -> f64 {
    let growth = 1.0 + f64::from(degree.saturating_sub(SEEN_DEGREE)) / PER_DEGREE;
    per_weight(evaluator) * growth * weighed.weight.max(1.0)
}
