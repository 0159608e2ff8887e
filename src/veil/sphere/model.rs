//! What is summed on the stereographic image and what near the source, by formula: the plan's side of it.
//!
//! The chord is c = 2 |a − b| exp(y/2), y = y_a + y_b the sum of two points' depths −ln(1 + |a|²). Were the kernel a power c^−s, the
//! depth would be a factor (1 + |a|²)^(s/2) of the source and one of the target, and nothing else. Other kernels are nearly powers
//! over the distances that one lattice serves: so each lattice has an exponent of its own ([`super::powers`]), and what
//! remains is of second order in the depths' differences.

use super::camera::{Camera, Point, angle};
use super::powers::{FLAT, Pairs, SLOTS, Steps, deal_slots};
use crate::veil::plan::{Lattice, kernel};

/// Steps of a cell by which lattice kernels are enclosed.
pub(super) const STEPS: usize = 16;

/// Steps of a cell by which the image's profile is tabled: of a Gaussian at least 1.6 cells wide, straight lines between them
/// miss 10⁻⁵.
const FINE: usize = 64;

/// Cells that the table reaches at most.
const PROFILE: usize = 96;

/// Terms of Taylor's series by which the table depends on the depth.
const SERIES: usize = 5;

/// So many of the finest lattices are their own mirror images.
pub(super) const FINEST: usize = 4;

/// The pitch of the coarsest of them, in cells of the finest.
pub(super) const MIRRORED: usize = 1 << (FINEST - 1);

/// Steps of the depth by which own light is tabled.
const DEPTHS: usize = 1024;

/// A Gaussian of the chord: weight · exp(−c² / 2 width²).
#[derive(Debug, Clone, Copy)]
pub(super) struct Term {
    pub width: f64,
    pub weight: f64,
}

/// It on its lattice.
#[derive(Debug, Clone)]
pub(in crate::veil) struct Placed {
    /// 0 for the finest lattice, each next of twice the pitch.
    pub level: usize,
    /// With which others it shares the power of the depth: those of its lattice, or none.
    pub slot: usize,
    /// Value at 0, in the middle of the depths.
    pub weight: f64,
    /// Its width, in cells of the finest lattice.
    pub width: f64,
    /// The same by its chord.
    pub chord: f64,
    /// The kernel on its lattice, from 0 on.
    pub half: Vec<f64>,
    /// Least and largest of what is realised at offsets of `1 / STEPS` of the finest cell each.
    range: Vec<[f64; 2]>,
    /// What is realised at offset 0 along one dimension, as a polynomial of the phase.
    own: [f64; 7],
}

/// What the image returns of a pixel's own light.
pub(super) struct Own<'a> {
    model: &'a Model,
    /// By steps of the depth: what coarse lattices return, and the factors of the others, which depend on the phase.
    factors: Vec<[f64; 1 + FINEST]>,
}

impl Own<'_> {
    /// Per solid angle, at a depth and so many cells from the first column and row.
    pub fn at(&self, depth: f64, cells: [f64; 2]) -> f64 {
        let least = self.model.camera.corner().depth;
        let place = if least < 0.0 { (depth / least).clamp(0.0, 1.0) * DEPTHS as f64 } else { 0.0 };
        let (index, share) = (place as usize, place.fract());
        let [one, other] = [self.factors[index], self.factors[index + 1]];
        let factor = |which: usize| one[which] + share * (other[which] - one[which]);
        let fine = self.model.placed.iter().filter(|placed| placed.level < FINEST);
        let each = fine.map(|placed| {
            let pitch = (1usize << placed.level) as f64;
            let [x, y] = cells.map(|at| {
                let t = (at / pitch).fract();
                placed.own.iter().rev().fold(0.0, |sum, value| sum * t + value)
            });
            factor(1 + placed.level) * placed.weight * x * y
        });
        factor(0) + each.sum::<f64>()
    }
}

/// All that is summed on the image.
#[derive(Debug, Clone)]
pub(in crate::veil) struct Model {
    pub camera: Camera,
    /// In the middle of the pairs' depths: widths are right there.
    pub middle: f64,
    /// A cell of the finest lattice, in stereographic coordinates.
    pub cell: f64,
    /// Stereographic coordinates of the first pixel's column and row, negative.
    pub first: [f64; 2],
    pub placed: Vec<Placed>,
    /// By slots: the lattice. Each lattice has its slot, and after them may be more of the coarsest.
    pub slots: Vec<usize>,
    /// By slots: the power of 1 + |a|² that sources and targets count by.
    pub powers: Vec<f64>,
    /// The last slot that takes its moments from the one before it, and the lattice from which all later ones have theirs.
    pub chain: [usize; 2],
    /// What is wanted of the image at distances of `1 / FINE` of a cell each, as far as a small kernel reaches: a polynomial of the depth
    /// from the middle, times exp(−depth · first power).
    profile: Vec<[f64; SERIES]>,
    /// What each source adds everywhere, per solid angle.
    pub constant: f64,
    /// By how much factors that are applied on lattices may be off, over the kernel; and at offset 0.
    pub drift: [f64; 2],
}

/// How to lay a model out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Layout {
    /// A cell of the finest lattice over a pixel in the middle of the picture.
    pub pitch: f64,
    /// Least width of a Gaussian on its lattice, in pitches.
    pub width: f64,
}

/// The mixture that a model is made of.
pub(super) struct Mixture<'a> {
    pub terms: &'a [Term],
    /// Where each term ends, by its chord.
    pub reaches: &'a [f64],
    pub constant: f64,
    /// The kernel less its constant.
    pub wanted: &'a (dyn Fn(f64) -> f64 + Sync),
    /// Chords between which it is.
    pub range: [f64; 2],
    pub tolerance: f64,
}

impl Model {
    /// Of those terms that are wide enough for the finest lattice.
    pub fn new(camera: Camera, mixture: &Mixture, layout: Layout) -> Self {
        let corner = camera.corner();
        let (middle, cell) = (corner.depth, 0.5 * layout.pitch / camera.focal);
        // The corner is farthest in both directions on a rectilinear picture, and the edges' middles are on a round one.
        let edges = [
            camera.point(0.0, 0.5 * (camera.size[1] as f64 - 1.0)),
            camera.point(0.5 * (camera.size[0] as f64 - 1.0), 0.0),
        ];
        // A whole number of cells of the first lattices from end to end, so that their halves are mirror images.
        let first = [0, 1].map(|side| {
            let half = -corner.at[side].min(edges[side].at[side]) / cell;
            -0.5 * cell * (2.0 * half / MIRRORED as f64).ceil().max(1.0) * MIRRORED as f64
        });
        let longest = first.iter().fold(0.0f64, |longest, first| longest.max(-2.0 * first / cell));
        let coarsest = (longest / 6.0).max(1.0).log2() as usize;
        let terms = mixture.terms.iter().zip(mixture.reaches).filter(|(_, reach)| **reach > 0.0);
        let mut placed: Vec<Placed> = terms
            .filter_map(|(term, reach)| place(term, *reach, middle, cell, layout.width, coarsest, longest))
            .collect();
        let slots = deal_slots(&mut placed);
        let pairs = Pairs { mixture, middle };
        let narrow = layout.width * 2.0 * cell * (0.5 * middle).exp();
        let mut powers = pairs.powers(&placed, &slots, &[]);
        if middle < -FLAT {
            pairs.refit(&mut placed, &powers, narrow);
            powers = pairs.powers(&placed, &slots, &powers);
            pairs.refit(&mut placed, &powers, narrow);
        }
        let Steps { chain, drift } = Steps::new(&slots, &powers, mixture.tolerance, cell, &corner);
        for placed in &mut placed {
            placed.weight *= (powers[placed.slot] * middle).exp();
        }
        let constant = mixture.constant;
        let mut model =
            Self { camera, middle, cell, first, placed, slots, powers, chain, profile: Vec::new(), constant, drift };
        model.profile = model.tabled(PROFILE.min(longest as usize + 4) * FINE);
        model
    }

    fn tabled(&self, end: usize) -> Vec<[f64; SERIES]> {
        let at = |index: usize| {
            let mut series = [0.0; SERIES];
            for placed in &self.placed {
                let power = self.powers[placed.slot];
                let mut term = placed.value(index as f64 / FINE as f64, 0.0) * (-power * self.middle).exp();
                for (order, sum) in series.iter_mut().enumerate() {
                    *sum += term;
                    term *= (self.first_power() - power) / (order + 1) as f64;
                }
            }
            series
        };
        (0..=end).map(at).collect()
    }

    /// As [`Self::between`], not enclosed, by tables.
    fn near(&self, source: &Point, target: &Point) -> f64 {
        let [u, v] = [0, 1].map(|side| source.at[side] - target.at[side]);
        let at = (u * u + v * v).sqrt() / self.cell * FINE as f64;
        let (index, share) = (at as usize, at.fract());
        let Some([one, other]) = self.profile.get(index..index + 2).and_then(|pair| pair.as_chunks().0.first()) else {
            return self.between(source, target, false)[0];
        };
        let depth = source.depth + target.depth - self.middle;
        let sum =
            (0..SERIES).rev().fold(0.0, |sum, order| sum * depth + one[order] + share * (other[order] - one[order]));
        sum * (-depth * self.first_power()).exp() + self.constant
    }

    /// Points of the finest lattice along each side.
    pub fn points(&self) -> [usize; 2] {
        self.first.map(|first| (-2.0 * first / self.cell) as usize + 4)
    }

    /// The power that counts at the pixels.
    pub fn first_power(&self) -> f64 {
        self.powers.first().copied().unwrap_or(1.0)
    }

    pub fn lattices(&self) -> usize {
        self.placed.iter().map(|placed| placed.level + 1).max().unwrap_or(0)
    }

    /// From a source to a target, per solid angle: what is wanted of the image, or, where `enclosed`, the least and the largest of
    /// what comes.
    pub fn between(&self, source: &Point, target: &Point, enclosed: bool) -> [f64; 2] {
        let depth = source.depth + target.depth;
        let [u, v] = [0, 1].map(|side| (source.at[side] - target.at[side]).abs() / self.cell);
        let mut factors = [0.0; SLOTS];
        factors.iter_mut().zip(&self.powers).for_each(|(factor, power)| *factor = (-power * depth).exp());
        let mut sum = [self.constant; 2];
        for placed in &self.placed {
            let factor = factors[placed.slot];
            let [low, high] = if enclosed { placed.enclosed(u, v) } else { [placed.value(u, v); 2] };
            sum = [sum[0] + factor * low, sum[1] + factor * high];
        }
        sum
    }

    /// What the image returns to pixels of their own light, by their depths.
    pub fn own(&self) -> Own<'_> {
        let at = |index: usize| {
            let depth = self.camera.corner().depth * index as f64 / DEPTHS as f64;
            let mut factors = [self.constant, 0.0, 0.0, 0.0, 0.0];
            for placed in &self.placed {
                let factor = (-2.0 * self.powers[placed.slot] * depth).exp();
                if placed.level < FINEST {
                    factors[1 + placed.level] = factor;
                } else {
                    // Lattices that are not their own mirror image count by their mean.
                    let [low, high] = placed.enclosed(0.0, 0.0);
                    factors[0] += factor * 0.5 * (low + high);
                }
            }
            factors
        };
        Own { model: self, factors: (0..=DEPTHS + 1).map(at).collect() }
    }

    /// By how much that can be wrong, over its value at the middle.
    pub fn own_spread(&self) -> f64 {
        let [mut all, mut wrong] = [0.0; 2];
        for placed in &self.placed {
            let [low, high] = placed.enclosed(0.0, 0.0);
            all += low;
            wrong += if placed.level >= FINEST { 0.5 * (high - low) } else { 0.0 };
        }
        if all > 0.0 { wrong / all + self.drift[1] } else { 0.0 }
    }
}

/// Σ β(k) h(k − m) β(m) for a point t of a pitch after a lattice point, by the powers of t.
fn own_along(half: &[f64]) -> [f64; 7] {
    // β at the four points around t, from the first on, by the powers of t.
    const SIXTH: f64 = 1.0 / 6.0;
    const SPLINES: [[f64; 4]; 4] =
        [[SIXTH, -0.5, 0.5, -SIXTH], [4.0 * SIXTH, 0.0, -1.0, 0.5], [SIXTH, 0.5, 0.5, -0.5], [0.0, 0.0, 0.0, SIXTH]];
    let mut own = [0.0; 7];
    for (k, one) in SPLINES.iter().enumerate() {
        for (m, other) in SPLINES.iter().enumerate() {
            let value = half.get(k.abs_diff(m)).copied().unwrap_or(0.0);
            for (i, a) in one.iter().enumerate() {
                for (j, b) in other.iter().enumerate() {
                    own[i + j] += value * a * b;
                }
            }
        }
    }
    own
}

impl Placed {
    fn value(&self, u: f64, v: f64) -> f64 {
        self.weight * (-0.5 * (u * u + v * v) / (self.width * self.width)).exp()
    }

    /// Between two offsets that are tabled, both count.
    fn enclosed(&self, u: f64, v: f64) -> [f64; 2] {
        let [x, y] = [u, v].map(|offset| {
            let at = offset * STEPS as f64;
            let (index, share) = (at as usize, at.fract());
            match self.range.get(index..index + 2) {
                Some([one, other]) => [0, 1].map(|end| one[end] + share * (other[end] - one[end])),
                _ => [0.0; 2],
            }
        });
        [self.weight * x[0] * y[0], self.weight * x[1] * y[1]]
    }
}

/// A term, if it is wide enough.
fn place(term: &Term, reach: f64, depth: f64, cell: f64, least: f64, coarsest: usize, longest: f64) -> Option<Placed> {
    // From chords to cells at this depth.
    let cells = 0.5 * (-0.5 * depth).exp() / cell;
    let width = term.width * cells;
    let octave = (width / least).log2();
    if octave < 0.0 {
        return None;
    }
    let level = (octave as usize).min(coarsest);
    let pitch = (1usize << level) as f64;
    let radius = ((reach * cells / pitch).ceil() + 1.0).min(longest / pitch + 4.0) as usize;
    let half = kernel(width / pitch, radius);
    let lattice = Lattice { pitch: STEPS << level, kernel: &half };
    let end = ((reach * cells).min(longest) * STEPS as f64) as usize + ((3 * STEPS) << level);
    // Where the lattice is coarse, offsets are read at as many places of a pitch as on the finest.
    let every = 1usize << level;
    let coarse: Vec<[f64; 2]> = (0..=end / every + 1).map(|index| lattice.range(index * every)).collect();
    let range = (0..=end).map(|index| {
        let share = (index % every) as f64 / every as f64;
        let [low, high] = [coarse[index / every], coarse[index / every + 1]];
        [0, 1].map(|end| low[end] + share * (high[end] - low[end]))
    });
    let range = range.collect();
    Some(Placed {
        level,
        slot: level,
        weight: term.weight,
        width,
        chord: term.width,
        own: own_along(&half),
        half,
        range,
    })
}

/// The wanted kernel per solid angle, and the small kernel around a target.
pub(super) struct Wanted<'a> {
    pub profile: &'a (dyn Fn(f64) -> f64 + Sync),
    /// The chord up to which the small kernel reaches.
    pub near: f64,
}

impl Wanted<'_> {
    pub fn at(&self, chord: f64) -> f64 {
        (self.profile)(angle(chord))
    }

    /// The value of the small kernel around `target` at `source`, over √ of the ratio of their solid angles, which is taken from
    /// each pixel instead; beyond its reach as well.
    pub fn missing(&self, model: &Model, target: &Point, source: &Point) -> f64 {
        let chord = target.chord(source);
        if chord == 0.0 {
            return 0.0;
        }
        (self.at(chord) - model.near(source, target)) * (source.solid_angle * target.solid_angle).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The polynomial against the sum over splines.
    #[test]
    fn own_light_is_a_polynomial_of_the_phase() {
        let half = kernel(1.9, 12);
        let lattice = Lattice { pitch: 64, kernel: &half };
        for phase in [0, 1, 17, 40, 63] {
            let t = phase as f64 / 64.0;
            let own = own_along(&half).iter().rev().fold(0.0, |sum, value| sum * t + value);
            assert!((own / lattice.realised(phase, 0) - 1.0).abs() < 1e-13);
        }
    }
}
