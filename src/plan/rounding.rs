//! What f32 costs.

use std::f64::consts::TAU;

use super::amplitudes::{Rgb, largest};
use super::weigh::Weighed;
use super::{Evaluator, Group};
use crate::series::Bell;

/// The error, for each unit of weight, that phases, tables and sums in f32 make at most: about twice the worst that
/// tests/suite/rounding.rs has seen on Mesa's software renderer, for K from 1 to 20000 and N up to 220. A single bell
/// is the worst case: the errors of many average out.
fn per_weight(evaluator: Evaluator) -> f64 {
    match evaluator {
        Evaluator::Direct | Evaluator::Local | Evaluator::Plate => 0.0, // see `direct`, `local` and `plate`
        Evaluator::Series => 8e-7,                                      // seen: 3.5e-7
        Evaluator::Rows => 1.2e-6,                                      // seen: 6.0e-7
        Evaluator::Grid => 1.6e-6,                                      // seen: 8.3e-7, with some interpolation in it
    }
}

/// What f32 computes with, where the modes of the field are known: bounds of what they add at any point, for each colour.
pub(super) struct Strength {
    /// Of all modes together.
    pub total: Rgb,
    /// The root of the sum of squares over the harmonics of x, each with all that it holds; and over those of y.
    pub across: [Rgb; 2],
    /// Of all modes, each times the sum of its harmonics.
    pub turning: Rgb,
}

/// The error of f32, storage included, of a series whose modes are known; relative to the field's largest value.
///
/// A phase is off by half of 2⁻³² of a turn, times the harmonic, which shifts every wave of a pixel alike: that is a bound.
/// Everything else, the roundings of terms, tables and sums, has nothing to do with each other: those of the tables go
/// with the root of the sum of squares over the harmonics, and those of the sums with what is added up, which is no more
/// than the field and a few times what the harmonics still to come may hold by chance. Their factors are fitted:
/// docs/accuracy.md, "Rounding".
pub(super) fn of_modes(evaluator: Evaluator, strength: &Strength, degree: [u32; 2]) -> f64 {
    const UNIT: f64 = 0.5 * f32::EPSILON as f64;
    let [tables, sums] = match evaluator {
        Evaluator::Direct | Evaluator::Local | Evaluator::Plate => [0.0; 2],
        Evaluator::Series => [0.5, 2.2],
        Evaluator::Rows => [0.5, 2.7],
        Evaluator::Grid => [3.0, 1.8],
    };
    let added = (2.0 + f64::from(degree[0]) + f64::from(degree[1])).sqrt();
    let one = |colour: usize| {
        let [x, y] = strength.across.map(|across| across[colour]);
        let partial = strength.total[colour].min(1.0 + 2.0 * (x + y));
        let turned = TAU * 2f64.powi(-33) * strength.turning[colour];
        turned + UNIT * (tables * (x + y) + sums * added * partial)
    };
    largest([0, 1, 2].map(one))
}

/// What f64 loses of the modes of some groups, with every ghost's waves by one rotation after the other; it matters where
/// nearly all of the ghosts' light cancels.
pub(super) fn of_doubles(groups: &[Group], degree: [u32; 2]) -> f64 {
    // What a profile's transform is off by where it is read between nodes, and any other where it is looked up.
    const READ: f64 = 3e-9;
    const LOOKED_UP: f64 = 1e-11;
    let turned = f64::EPSILON * (8.0 + 2.0 * f64::from(degree[0] + degree[1]));
    let one = |group: &Group| match group.bell {
        Bell::Profile(_) | Bell::Disc(_) => group.weight * (turned + READ),
        Bell::Paraboloid | Bell::Iris(_) => group.weight * (turned + LOOKED_UP),
        _ => group.weight * turned,
    };
    groups.iter().map(one).sum()
}

/// What f64 loses of a series, from the groups' modes to the sum, before it is stored.
///
/// Phases, waves and sums are off by some units of 2⁻⁵³ for each harmonic that they go through, of what the coefficients of
/// each bell add up to at most; interpolating adds a few.
pub(super) fn of_exact(groups: &[Group], degree: [u32; 2]) -> f64 {
    const UNIT: f64 = 0.5 * f64::EPSILON;
    let [n, m] = degree.map(f64::from);
    let steps = 60.0 + 12.0 * (n + m);
    // For a bell that ends in a jump the coefficients add up to ever more, with the root of the degree.
    let gain = |group: &Group| match group.bell {
        Bell::Gaussian | Bell::VonMises(_) | Bell::SineGaussian(_) => 1.5,
        Bell::Iris(_) => 8.0,
        Bell::CosineSquared | Bell::Parabola | Bell::Paraboloid => 4.0,
        _ => 4.0 + 2.0 * (n + m).sqrt(),
    };
    of_doubles(groups, degree) + groups.iter().map(|group| UNIT * steps * gain(group) * group.weight).sum::<f64>()
}

/// Of that, what comes of storing alone: half a unit in the last place of each result that one pass leaves to the next. For
/// `direct` these are the ghosts; for a series its terms and the harmonics of both axes; then the profiles of `rows`; and
/// then `grid`'s lattice, cells and strips.
pub(super) fn stored(weighed: &Weighed, evaluator: Evaluator) -> f64 {
    const HALF_A_UNIT: f64 = 0.5 * f32::EPSILON as f64;
    let results = match evaluator {
        Evaluator::Direct | Evaluator::Local | Evaluator::Plate => 1.0,
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
