//! The cheapest of several ways to deal out the Gaussians.

use std::collections::HashMap;
use std::rc::Rc;

use rayon::prelude::*;

use super::super::error::Error;
use super::super::kernel::Gaussian;
use super::super::simd::Real;
use super::lattice::{Lattice, kernel};
use super::samples::{NEAR, STEP, Sample, Samples};
use super::{Layers, Near, OWN_SHARE, Own, Placed, Predicted};

/// Least widths of a Gaussian on its lattice, in pitches, that are tried: a larger one costs more and is more exact.
const WIDTHS: [f64; 11] = [1.25, 1.5, 1.75, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0, 11.0];

/// Shares of the tolerance below which the tail of a Gaussian is cut off, that are tried.
const TAILS: [f64; 2] = [0.15, 0.02];

/// The widest small kernel, in pixels: all offsets as far as that are looked at.
const WIDEST: usize = NEAR;

/// A lattice has at least so many points along the longer side.
const FEWEST: usize = 4;

/// The share of the tolerance that offsets below the floor may take.
const BELOW_FLOOR: f64 = 0.2;

/// The least and the largest realised value at each offset of one dimension.
type Ranges = Rc<Vec<[f64; 2]>>;

pub(super) struct Chooser<'a> {
    samples: &'a Samples,
    /// In increasing order of width, in pixels.
    terms: &'a [Gaussian],
    constant: f64,
    quadratic: f64,
    most: [usize; 2],
    tolerance: f64,
    /// Where a term ends, for each share of [`TAILS`], in pixels.
    reaches: Vec<[f64; 2]>,
    /// By term, level and radius.
    known: HashMap<[usize; 3], (Rc<Vec<f64>>, Ranges)>,
}

pub(super) struct Chosen {
    pub layers: Layers,
    pub predicted: Predicted,
    pub placed: usize,
    pub roundings: f64,
}

/// Where a term goes.
struct Place {
    weight: f64,
    level: usize,
    half: Rc<Vec<f64>>,
    ranges: Ranges,
}

/// A way to deal, and what it comes to.
struct Deal {
    places: Vec<Place>,
    /// The square of the small kernel's reach, in pixels.
    square: usize,
    bound: f64,
    rounding: f64,
    roundings: f64,
    operations: f64,
    /// Where it is worst, in pixels.
    distance: f64,
}

impl<'a> Chooser<'a> {
    pub fn new(
        samples: &'a Samples,
        terms: &'a [Gaussian],
        moments: [f64; 2],
        most: [usize; 2],
        tolerance: f64,
    ) -> Self {
        let [constant, quadratic] = moments;
        let mut chooser =
            Self { samples, terms, constant, quadratic, most, tolerance, reaches: Vec::new(), known: HashMap::new() };
        chooser.reaches = terms.iter().map(|term| TAILS.map(|share| chooser.reach(term, share * tolerance))).collect();
        chooser
    }

    /// The largest distance at which a term is more than `share` of what is wanted, in pixels; 0 if there is none, and infinite
    /// if there is no pixel further apart.
    fn reach(&self, term: &Gaussian, share: f64) -> f64 {
        let shows = |sample: &&Sample| {
            let square = (sample.offset[0].pow(2) + sample.offset[1].pow(2)) as f64;
            let value = term.weight * (-0.5 * square / term.sigma.powi(2)).exp();
            value > share * sample.wanted.max(self.samples.floor)
        };
        let reach = self.samples.pairs.iter().filter(shows).map(Sample::distance).fold(0.0, f64::max);
        let end = (self.most[0] as f64).hypot(self.most[1] as f64);
        if reach * STEP < end { reach } else { f64::INFINITY }
    }

    pub fn choose(mut self) -> Result<Chosen, Error> {
        let narrow = self.terms.iter().filter(|term| term.sigma < WIDEST as f64 / 2.0).count();
        let (mut best, mut closest): (Option<Deal>, Option<Deal>) = (None, None);
        for width in WIDTHS {
            for tail in 0..TAILS.len() {
                for left_out in 0..=narrow {
                    let places: Vec<Place> =
                        (left_out..self.terms.len()).filter_map(|index| self.place(index, width, tail)).collect();
                    // Whatever its small kernel, it would cost more.
                    if best.as_ref().is_some_and(|best| operations(&places, 0) >= best.operations) {
                        continue;
                    }
                    let deal = self.deal(places);
                    let meets = deal.bound <= self.tolerance * (1.0 - OWN_SHARE);
                    if meets && best.as_ref().is_none_or(|best| deal.operations < best.operations) {
                        best = Some(deal);
                    } else if closest.as_ref().is_none_or(|closest| deal.bound < closest.bound) {
                        closest = Some(deal);
                    }
                }
            }
        }
        match (best, closest) {
            (Some(best), _) => Ok(self.finish(best)),
            (None, Some(closest)) => Err(Error::OutOfReach {
                asked: self.tolerance,
                best: closest.bound / (1.0 - OWN_SHARE),
                distance: closest.distance,
            }),
            (None, None) => Err(Error::Tolerance(self.tolerance)),
        }
    }

    /// The lattice of the largest pitch, by its number.
    fn coarsest(&self) -> usize {
        let longest = self.most[0].max(self.most[1]) + 1;
        (longest / FEWEST).checked_ilog2().unwrap_or(0) as usize
    }

    /// The coarsest lattice on which a Gaussian is `width` pitches wide.
    fn place(&mut self, index: usize, width: f64, tail: usize) -> Option<Place> {
        let Gaussian { sigma, weight } = self.terms[index];
        let reach = self.reaches[index][tail];
        if reach == 0.0 {
            return None;
        }
        let octave = (sigma / width).log2().floor();
        let level = if octave < 1.0 { 0 } else { (octave as usize).min(self.coarsest()) };
        let pitch = 1usize << level;
        // No two points of a lattice are further apart than the picture's pixels and the splines at both.
        let farthest = self.most[0].max(self.most[1]) / pitch + if level == 0 { 0 } else { 4 };
        let radius = if level == 0 { reach } else { (reach / pitch as f64).ceil() + 1.0 };
        let radius = (radius as usize).min(farthest);
        let s = sigma / pitch as f64;
        let offsets = &self.samples.offsets;
        let (half, ranges) = self.known.entry([index, level, radius]).or_insert_with(|| {
            if level == 0 {
                let half: Vec<f64> = (0..=radius).map(|n| (-0.5 * (n as f64 / s).powi(2)).exp()).collect();
                let ranges = offsets.iter().map(|offset| [half.get(*offset).copied().unwrap_or(0.0); 2]).collect();
                return (Rc::new(half), Rc::new(ranges));
            }
            let half = kernel(s, radius);
            let lattice = Lattice { pitch, kernel: &half };
            let ranges = offsets.par_iter().map(|offset| lattice.range(*offset)).collect();
            (Rc::new(half), Rc::new(ranges))
        });
        Some(Place { weight, level, half: half.clone(), ranges: ranges.clone() })
    }

    /// Gaussians on their lattices; what is missing near by is left to the small kernel.
    fn deal(&self, places: Vec<Place>) -> Deal {
        let roundings = roundings(&places);
        let unit = roundings * <f32 as Real>::UNIT;
        let mut deal = Deal { places, square: 0, bound: 0.0, rounding: 0.0, roundings, operations: 0.0, distance: 0.0 };
        let limit = self.tolerance * (1.0 - OWN_SHARE);
        let mut errors = Vec::with_capacity(self.samples.pairs.len());
        for sample in &self.samples.pairs {
            let [low, high] = self.range(&deal.places, sample);
            let unit_of = sample.wanted.max(self.samples.floor);
            let outside = (high - sample.wanted).max(sample.wanted - low) / unit_of;
            // The small kernel's value, and what the others sum to.
            let inside = [0.5 * (high - low) / unit_of, (high + (sample.wanted - 0.5 * (high + low)).abs()) / unit_of];
            let share = if sample.wanted < self.samples.floor { BELOW_FLOOR } else { 1.0 - BELOW_FLOOR };
            let square = sample.offset[0].pow(2) + sample.offset[1].pow(2);
            if outside + unit * high / unit_of > share * limit && square <= WIDEST * WIDEST {
                deal.square = deal.square.max(square);
            }
            errors.push((outside, inside, high / unit_of));
        }
        // The small kernel's taps are summed in a row, after the others.
        deal.roundings += Near::operations(deal.square);
        let unit = deal.roundings * <f32 as Real>::UNIT;
        // The parts of the bound: above the floor and below it.
        let mut parts = [0.0f64; 2];
        let mut worst = 0.0;
        for (sample, (outside, [inside, near], far)) in self.samples.pairs.iter().zip(errors) {
            let within = sample.offset[0].pow(2) + sample.offset[1].pow(2) <= deal.square;
            let (error, magnitude) = if within { (inside, near) } else { (outside, far) };
            let part = &mut parts[usize::from(sample.wanted < self.samples.floor)];
            *part = part.max(error + unit * magnitude);
            deal.rounding = deal.rounding.max(unit * magnitude);
            if error > worst {
                (worst, deal.distance) = (error, sample.distance());
            }
        }
        deal.bound = parts[0] + parts[1];
        deal.operations = operations(&deal.places, deal.square);
        deal
    }

    /// The least and the largest that is realised at an offset, without the small kernel.
    fn range(&self, places: &[Place], sample: &Sample) -> [f64; 2] {
        let square = (sample.offset[0].pow(2) + sample.offset[1].pow(2)) as f64;
        let mut range = [self.constant + self.quadratic * square; 2];
        for place in places {
            let [x, y] = sample.index.map(|index| place.ranges[index]);
            range[0] += place.weight * x[0] * y[0];
            range[1] += place.weight * x[1] * y[1];
        }
        range
    }

    fn finish(&self, deal: Deal) -> Chosen {
        let levels = deal.places.iter().map(|place| place.level).max().unwrap_or(0);
        let placed =
            |place: &Place| Placed { weight: place.weight, pitch: 1 << place.level, half: place.half.to_vec() };
        let at = |level: usize| deal.places.iter().filter(move |place| place.level == level).map(placed).collect();
        let direct: Vec<Placed> = at(0);
        let lattices: Vec<Vec<Placed>> = (1..=levels).map(at).collect();
        let missing: HashMap<[usize; 2], f64> = self
            .samples
            .pairs
            .iter()
            .filter_map(|sample| {
                let [x, y] = sample.offset;
                let [low, high] = self.range(&deal.places, sample);
                (x * x + y * y <= deal.square).then_some(([x, y], sample.wanted - 0.5 * (low + high)))
            })
            .collect();
        let near = Near::new(deal.square, self.most, |x, y| missing.get(&[x, y]).copied().unwrap_or(0.0));
        let own = Own::new(deal.places.iter().map(placed), self.constant);
        let predicted = Predicted {
            bound: deal.bound + OWN_SHARE * self.tolerance,
            rounding: deal.rounding,
            operations: deal.operations,
            direct: direct.len(),
            lattices: lattices.iter().map(Vec::len).collect(),
            dropped: 0,
            reach: (deal.square as f64).sqrt(),
        };
        let layers = Layers { direct, lattices, near, own, constant: self.constant, quadratic: self.quadratic };
        Chosen { layers, predicted, placed: deal.places.len(), roundings: deal.roundings }
    }
}

/// The longest chain of roundings from a pixel to another: each tap of a kernel may be one, and the taps and pixels are rounded themselves.
fn roundings(places: &[Place]) -> f64 {
    let taps = |place: &Place| 2 * place.half.len() + 1;
    let chain = |place: &Place| {
        // Those of one lattice are added to what is there, tap by tap.
        let added: usize = places.iter().filter(|other| other.level == place.level).map(taps).sum();
        let kernel = taps(place) + added;
        let lattices = if place.level == 0 { 0 } else { 2 * (7 + 4) + (place.level - 1) * 2 * (5 + 3) };
        kernel + lattices
    };
    let longest = places.iter().map(chain).max().unwrap_or(0);
    (longest + places.len() + 8) as f64
}

/// Multiply-adds for each pixel.
fn operations(places: &[Place], square: usize) -> f64 {
    let levels = places.iter().map(|place| place.level).max().unwrap_or(0);
    let kernels = places.iter().map(|place| 2.0 * (2 * place.half.len() - 1) as f64 * 0.25f64.powi(place.level as i32));
    // Up and down between two lattices, for each point of the finer.
    let steps = (0..levels).map(|level| 12.0 * 0.25f64.powi(level as i32));
    2.0 + kernels.sum::<f64>() + steps.sum::<f64>() + Near::operations(square)
}
