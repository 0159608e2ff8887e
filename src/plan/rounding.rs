//! What f32 costs.

use super::Evaluator;
use super::weigh::Weighed;

/// The error, for each unit of weight, that phases, tables and sums in f32 make at most. Measured by the tests of each
/// evaluator over all scenes there, and doubled; docs/accuracy.md has the figures.
const PER_WEIGHT: f64 = 4e-7;

/// A bound of the rounding error, relative to the field's largest value.
pub(super) fn bound(weighed: &Weighed, evaluator: Evaluator) -> f64 {
    let _ = evaluator;
    PER_WEIGHT * weighed.weights.iter().sum::<f64>().max(1.0)
}
