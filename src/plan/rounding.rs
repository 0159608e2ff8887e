//! What f32 costs.

use super::Evaluator;
use super::weigh::Weighed;
use crate::scene::Ghost;

/// The error, for each unit of weight, that phases, tables and sums in f32 make at most: about twice the worst that
/// tests/suite/rounding.rs has seen on Mesa's software renderer, for K from 1 to 20000 and N up to 220. A single bell
/// is the worst case: the errors of many average out.
fn per_weight(evaluator: Evaluator) -> f64 {
    match evaluator {
        Evaluator::Direct => 6e-7, // seen: 2.7e-7
        Evaluator::Series => 8e-7, // seen: 3.5e-7
        Evaluator::Rows => 1.2e-6, // seen: 6.0e-7
        Evaluator::Grid => 1.6e-6, // seen: 8.3e-7, with some interpolation in it
    }
}

/// `direct` has positions in f32, so a bell far from the origin shifts by some roundings of its centre: the bell's
/// steepest slope, exp(-1/2) of its size, times half a rounding of the centre and two and a half of the pixel's, which
/// is what a division in GLSL may be off by.
const PER_CENTER: f64 = 0.607 * 3.0 * f32::EPSILON as f64;

/// A bound of the rounding error, relative to the field's largest value.
pub(super) fn bound(ghosts: &[Ghost], weighed: &Weighed, evaluator: Evaluator) -> f64 {
    let weight = weighed.weights.iter().sum::<f64>().max(1.0);
    let shifts: f64 = if evaluator == Evaluator::Direct {
        let shift = |ghost: &Ghost| (PER_CENTER * (ghost.center / ghost.size).abs().element_sum()).min(1.0);
        ghosts.iter().zip(&weighed.weights).filter(|(_, w)| **w > 0.0).map(|(ghost, w)| w * shift(ghost)).sum()
    } else {
        0.0
    };
    per_weight(evaluator) * weight + shifts
}
