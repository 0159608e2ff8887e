//! What f32 costs.

use glam::DVec2;

use super::Evaluator;
use super::slots::by_chunks;
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

/// `direct` has positions in f32, so a bell far from the origin shifts: by half a rounding of its centre, and two and a
/// half of the pixel's, which is what a division in GLSL may be off by.
const PER_CENTER: f64 = 3.0 * f32::EPSILON as f64;

/// Harmonics that [`per_weight`] was seen with. Beyond them it grows, by itself for each `PER_DEGREE`: a phase's rounding
/// is multiplied by the harmonic, and there are more terms to add up.
pub(super) const SEEN_DEGREE: u32 = 100;
const PER_DEGREE: f64 = 200.0;

/// A bound of the rounding error of series up to a degree, relative to the field's largest value.
pub(super) fn bound(ghosts: &[Ghost], weighed: &Weighed, evaluator: Evaluator, degree: u32) -> f64 {
    if evaluator != Evaluator::Direct {
        let growth = 1.0 + f64::from(degree.saturating_sub(SEEN_DEGREE)) / PER_DEGREE;
        return per_weight(evaluator) * growth * weighed.weight.max(1.0);
    }
    let sums = by_chunks(ghosts, &weighed.weights, |ghosts| -> f64 {
        let one = |(index, ghost, weight): (u32, &Ghost, f64)| {
            let index = index as usize;
            weight * direct(ghost, weighed.nearest[index].abs(), weighed.shares[index])
        };
        ghosts.map(one).sum()
    });
    sums.iter().sum::<f64>().max(per_weight(evaluator))
}

/// What one bell of peak 1 is off by in the direct sum, at most: unlike a series, it is as small as the bell itself at
/// the nearest pixel, its `share`, in which a rounding of the exponent counts as often as the exponent is large.
fn direct(ghost: &Ghost, nearest: DVec2, share: f64) -> f64 {
    let shape = ghost.bell.shape();
    let along = |distance: f64| shape.along(distance, 1.0);
    let shift = PER_CENTER * (ghost.center / ghost.size).abs();
    let shifted =
        shift.x * shape.steepest(nearest.x) * along(nearest.y) + shift.y * shape.steepest(nearest.y) * along(nearest.x);
    per_weight(Evaluator::Direct) * share * (1.0 + 0.5 * nearest.length_squared()) + shifted.min(1.0)
}
