//! Which way each image goes: the cheapest whose error is within its part of the tolerance.

use rayon::prelude::*;

use super::envelope::{DOUBLES, Envelope};
use super::kernel::{self, Kernel};
use super::lattice::Lattice;
use super::seat::Seat;
use super::{Part, Way, lattice, pairs, products, spans};
use crate::frame::Frame;
use crate::problem::{Images, NOTHING};
use crate::series::{Bell, Modes};
use crate::{Result, limits};

/// Points a pixel that are tried.
const FINER: [u32; 4] = [1, 2, 4, 8];

/// What summing the brightest pixels by themselves may cost, over what the coarsest lattice does.
const ALONE: [f64; 5] = [0.0, 0.1, 0.5, 2.0, 8.0];

/// Nanoseconds for which it is not worth to look for anything quicker.
const QUICK: f64 = 3e8;

/// What trying a lattice takes, over what the lattice itself does.
const TRIED: f64 = 0.5;

/// Bells that reach no farther than this, in pixels, are too sharp for any lattice.
const SMALL: f64 = 4.0;

/// What was chosen.
pub(crate) struct Chosen {
    pub parts: Vec<Part>,
    /// What interpolation is off by, and bells that are left out beyond their reach, in units of the field's scale.
    pub error: f64,
    pub cut: f64,
    /// What 64-bit floats lose.
    pub rounding: f64,
    /// What it takes one core.
    pub nanoseconds: f64,
}

/// Chooses a way for each of some images, so that all of them are off by no more than a budget, in units of the field's scale.
///
/// # Errors
/// [`crate::Error::Memory`] where memory is limited and that is too little.
pub(crate) fn choose(images: &Images, members: &[usize], frame: Frame, scale: [f64; 3], budget: f64) -> Result<Chosen> {
    let mut chosen = Chosen { parts: Vec::new(), error: 0.0, cut: 0.0, rounding: 0.0, nanoseconds: 0.0 };
    for (number, &member) in members.iter().enumerate() {
        let image = &images.all()[member];
        let seat = Seat::new(images, image, frame);
        let weights = [0, 1, 2].map(|colour| (image.ghost.radiance[colour] / scale[colour]).abs());
        let flux = images.raster_of(image).flux();
        let all = [0, 1, 2].map(|colour| weights[colour] * flux[colour]).into_iter().fold(0.0, f64::max);
        // What others did not need is left to those that follow.
        let left = (budget - chosen.error) / (members.len() - number) as f64;
        limits::room(lattice::memory(images, image, frame), "planning the plate of sharp ghosts")?;
        let Found { way, error, nanoseconds } = Choice { seat: &seat, weights }.cheapest(left);
        chosen.error += error;
        chosen.nanoseconds += nanoseconds;
        chosen.cut += if image.ghost.bell.shape().ends().is_finite() { 0.0 } else { 2.0 * NOTHING * all };
        chosen.rounding += DOUBLES * all;
        chosen.parts.push(Part { image: member, way, weights });
    }
    Ok(chosen)
}

/// A way with what it is off by and what it takes.
struct Found {
    way: Way,
    error: f64,
    nanoseconds: f64,
}

/// An image whose way is to be chosen.
struct Choice<'a> {
    seat: &'a Seat<'a>,
    weights: [f64; 3],
}

impl Choice<'_> {
    fn cheapest(&self, budget: f64) -> Found {
        let exact = self.exactly();
        if exact.nanoseconds <= QUICK || self.seat.reach_in_pixels().min_element() < SMALL {
            return exact;
        }
        let lattices: Vec<Lattice> = FINER.iter().filter_map(|finer| Lattice::new(self.seat, *finer)).collect();
        let Some(coarsest) = lattices.first() else { return exact };
        let step = kernel::step(&self.seat.image.ghost).map_or(0.0, |_| spans::cost(self.seat));
        let brightest = self.brightest(lattice::cost(self.seat, coarsest));
        // Each with what of it is summed by itself, the cheapest first.
        let mut ways: Vec<(f64, usize, f64)> = Vec::new();
        for (number, lattice) in lattices.iter().enumerate() {
            let of_lattice = step + lattice::cost(self.seat, lattice);
            ways.extend(brightest.iter().map(|(cost, above)| (of_lattice + cost, number, *above)));
        }
        ways.retain(|way| way.0 < exact.nanoseconds);
        ways.sort_by(|one, other| one.0.total_cmp(&other.0));
        let mut envelopes: Vec<Option<Envelope>> = lattices.iter().map(|_| None).collect();
        let mut tried = 0.0;
        for (cost, number, alone_above) in ways {
            // Where looking takes as long as the sum that needs no looking.
            if tried > exact.nanoseconds {
                break;
            }
            let envelope = envelopes[number].get_or_insert_with(|| Envelope::new(self.seat, &lattices[number]));
            let error = envelope.largest(self.seat, self.weights, alone_above);
            if error <= budget {
                let way = Way::Lattice { finer: lattices[number].finer as u32, alone_above };
                return Found { way, error, nanoseconds: cost };
            }
            tried += TRIED * lattice::cost(self.seat, coarsest);
        }
        exact
    }

    /// The cheapest way that is off by nothing.
    fn exactly(&self) -> Found {
        let (seat, ghost) = (self.seat, &self.seat.image.ghost);
        let shining = pairs::shining(seat, self.weights, 0.0) as f64;
        let mut ways = vec![(pairs::cost(seat, shining), Way::Pairs)];
        if let Modes::Product(_) = ghost.bell.shape().modes() {
            ways.push((products::cost(seat), Way::Products));
        }
        if matches!(ghost.bell, Bell::Disc(_)) || Kernel::is_nothing(ghost) {
            ways.push((spans::cost(seat), Way::Spans));
        }
        let cheapest = ways.into_iter().min_by(|one, other| one.0.total_cmp(&other.0));
        let (nanoseconds, way) = cheapest.unwrap_or((0.0, Way::Pairs));
        Found { way, error: 0.0, nanoseconds }
    }

    /// How many of the brightest pixels there is time for, as a few choices: what they cost, and the weight that they are above.
    fn brightest(&self, lattice: f64) -> Vec<(f64, f64)> {
        let [columns, rows] = pairs::reaching(self.seat);
        let row = |row: usize| self.seat.weights(row, self.weights)[columns.clone()].to_vec();
        let mut all: Vec<f64> = rows.into_par_iter().flat_map_iter(row).filter(|weight| *weight > 0.0).collect();
        all.par_sort_unstable_by(|one, other| other.total_cmp(one));
        let each = pairs::cost(self.seat, 1.0);
        let mut choices: Vec<(f64, f64)> = Vec::new();
        for part in ALONE {
            let count = (part * lattice / each) as usize;
            // All of those that are brighter than the next.
            let above = if count == 0 { f64::INFINITY } else { all.get(count).copied().unwrap_or(0.0) };
            let count = all.partition_point(|weight| *weight > above);
            if choices.iter().all(|(_, other)| *other != above) && above > 0.0 {
                choices.push((pairs::cost(self.seat, count as f64), above));
            }
        }
        choices
    }
}
