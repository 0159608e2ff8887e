//! The power of the depth that each lattice has, and the Gaussians' weights that go with them.

use super::camera::{Point, angle};
use super::fit::{exponents, fit_columns};
use super::model::{FINEST, Mixture, Placed, Term};

/// More slots than there are.
pub(super) const SLOTS: usize = 64;

/// The coarsest lattice is shared by many Gaussians. From this one on, each of them has a slot of its own.
const SPLIT: usize = FINEST;

/// The share of the tolerance that a change of the exponent from a lattice to the next may cost.
const STEP: f64 = 0.03;

/// Depths that differ by less need no fit of their own.
pub(super) const FLAT: f64 = 0.005;

/// Rounds of a fit to one layout.
const REFITS: usize = 24;

/// What remains where a factor is applied on a lattice and not at the pixels: of the first order, whose slopes are off by ω⁵/80 at the
/// frequency ω, over the slope of the factor, where a Gaussian 1.6 pitches wide shows (ω ≤ 1.2); and of the second order.
const DRIFT: [f64; 2] = [0.03, 0.1];

/// Deals slots out to Gaussians; returns the lattice of each.
pub(super) fn deal_slots(placed: &mut [Placed]) -> Vec<usize> {
    let coarsest = placed.iter().map(|placed| placed.level).max();
    let mut slots: Vec<usize> = (0..coarsest.map_or(0, |coarsest| coarsest + 1)).collect();
    let mut taken = false;
    for placed in placed {
        placed.slot = placed.level;
        if placed.level >= SPLIT && Some(placed.level) == coarsest {
            if taken && slots.len() < SLOTS {
                placed.slot = slots.len();
                slots.push(placed.level);
            }
            taken = true;
        }
    }
    slots
}

/// Pairs of pixels by their chord. Far ones are at the edges: the depth of a pair is between that of two corners and that of a pair about the
/// axis.
pub(super) struct Pairs<'a> {
    pub mixture: &'a Mixture<'a>,
    /// The middle of all depths.
    pub middle: f64,
}

impl Pairs<'_> {
    /// The middle of the depths that pairs of a chord can have, from the middle of all.
    fn depth(&self, chord: f64) -> f64 {
        let quarter = 0.25 * angle(chord).to_radians();
        0.5 * (-2.0 * (1.0 + quarter.tan().powi(2)).ln()).max(2.0 * self.middle)
    }

    /// A Gaussian there.
    fn value(&self, width: f64, power: f64, chord: f64) -> f64 {
        let depth = self.depth(chord);
        (-0.5 * (chord / width).powi(2) * (-depth).exp() - power * depth).exp()
    }

    /// The power of each slot, by what `known` ones make of the Gaussians.
    pub fn powers(&self, placed: &[Placed], slots: &[usize], known: &[f64]) -> Vec<f64> {
        let shares = |chord: f64| {
            let mut values = vec![0.0; slots.len()];
            for placed in placed {
                let power = known.get(placed.slot);
                values[placed.slot] += placed.weight
                    * match power {
                        Some(power) => self.value(placed.chord, *power, chord),
                        None => (-0.5 * (chord / placed.chord).powi(2)).exp(),
                    };
            }
            values
        };
        let mut used = vec![false; slots.len()];
        placed.iter().for_each(|placed| used[placed.slot] |= placed.weight > 0.0);
        let exponents = exponents(shares, &used, self.mixture.wanted, self.mixture.range);
        exponents.into_iter().map(|exponent| 0.5 * exponent).collect()
    }

    /// Fits the weights anew, where depths are in the middle for their chords; `narrow` is what no lattice takes.
    pub fn refit(&self, placed: &mut [Placed], powers: &[f64], narrow: f64) {
        let rest: Vec<&Term> = self.mixture.terms.iter().filter(|term| term.width < narrow).collect();
        let first = powers.first().copied().unwrap_or(1.0);
        let value = |chord: f64, index: usize| match placed.get(index) {
            Some(placed) => self.value(placed.chord, powers[placed.slot], chord),
            None => self.value(rest[index - placed.len()].width, first, chord),
        };
        let count = placed.len() + rest.len();
        let weights = fit_columns(count, value, self.mixture.wanted, self.mixture.range, REFITS);
        placed.iter_mut().zip(weights).for_each(|(placed, weight)| placed.weight = weight);
    }
}

/// Where the steps between powers are taken.
pub(super) struct Steps {
    pub chain: [usize; 2],
    pub drift: [f64; 2],
}

impl Steps {
    /// A step on a lattice costs the more the coarser it is: so the first few lattices take theirs in turn, and the others directly
    /// from a fine one.
    pub fn new(slots: &[usize], powers: &[f64], tolerance: f64, cell: f64, corner: &Point) -> Self {
        let square = (corner.at[0] * corner.at[0] + corner.at[1] * corner.at[1]).min(1.0);
        // The largest d ln(1 + |a|²) / d|a|.
        let slope = 2.0 * square.sqrt() / (1.0 + square);
        // At both ends.
        let step = |level: usize, change: f64| {
            let (pitch, change) = (cell * (1u64 << level) as f64, change.abs());
            let second = DRIFT[1] * change * (1.0 + change) * pitch * pitch;
            [2.0 * (DRIFT[0] * change * slope * pitch + second), 2.0 * second]
        };
        let (most, mut drift) = (STEP * tolerance, [0.0; 2]);
        let (mut last, lattices) = (0, slots.last().map_or(0, |coarsest| coarsest + 1));
        for level in 1..lattices {
            let step = step(level, powers[level] - powers[level - 1]);
            if step[0] > most {
                break;
            }
            (last, drift) = (level, [drift[0] + step[0], drift[1] + step[1]]);
        }
        let dearest = |base: usize| {
            let steps = powers.iter().skip(last + 1).map(|power| step(base, power - powers[base]));
            steps.fold([0.0f64; 2], |most, step| [most[0].max(step[0]), most[1].max(step[1])])
        };
        let mut base = last;
        while base > 1.min(last) && dearest(base)[0] > most {
            base -= 1;
        }
        if last + 1 < powers.len() {
            let step = dearest(base);
            drift = [drift[0] + step[0], drift[1] + step[1]];
        }
        Self { chain: [last, base], drift }
    }
}
