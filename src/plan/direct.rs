//! What floats cost the direct sum: unlike a series, each bell is off by no more than it is itself, or as steep, at the
//! nearest pixel.

use std::ops::Range;

use glam::DVec2;
use rayon::prelude::*;

use super::weigh::{Weighed, along};
use crate::frame::Frame;
use crate::problem::Problem;
use crate::scene::Ghost;
use crate::series::{Bell, Modes, Shape};

/// The floats in which ghosts are summed at every pixel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Precision {
    /// 32 bits: positions, bells and sums.
    #[default]
    Single,
    /// 64 bits: for flanks so steep, bells so small or light that so cancels that 32 would show.
    Double,
}

impl Precision {
    /// How many times as long as in 32 bits a bell takes on llvmpipe, which does half as many 64-bit floats at a time and
    /// has no exponential of them.
    pub(super) fn slower(self) -> f64 {
        match self {
            Self::Single => 1.0,
            Self::Double => 5.0,
        }
    }
}

/// What the direct sum is off by at any pixel, at most, in the floats of either precision.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Bounds {
    pub single: f64,
    pub double: f64,
}

impl Bounds {
    /// The precision that leaves a bound of at most so much, if only the larger one can; and its bound.
    pub fn within(self, budget: f64) -> (Precision, f64) {
        if self.single <= budget { (Precision::Single, self.single) } else { (Precision::Double, self.double) }
    }
}

/// Half a unit in the last place of an f32.
const HALF_A_UNIT: f64 = 0.5 * f32::EPSILON as f64;

/// The error, for each unit of weight, of a bell and its addition in f32 where its exponent is small: about twice the worst
/// that tests/suite/rounding.rs has seen on Mesa's software renderer.
const PER_WEIGHT: f64 = 4.5e-7;

/// What is left where all is f64: the field is stored in f32, and glare is its product with a scale that is rounded too.
const STORED: f64 = 3.0 * HALF_A_UNIT;

/// And in f64, where functions are off by some units of 2⁻⁵³, and for each addition.
const PER_WEIGHT_DOUBLE: f64 = 2e-15;
const PER_ADDITION_DOUBLE: f64 = 0.5 * f64::EPSILON;

/// What f32 may shift a pixel by, for each unit of its position: that is a product of two numbers that are rounded, and is
/// rounded itself.
const PER_POSITION: f64 = 2.0 * HALF_A_UNIT;
/// And the offset, for each unit of it: a difference, times one over the size, which is rounded.
const PER_OFFSET: f64 = 3.0 * HALF_A_UNIT;
/// The square of it as a profile's table has it, both rounded: half of that in the radius.
const PER_RADIUS: f64 = 1.5 * HALF_A_UNIT;
/// The sine that a sine-Gaussian's mean is taken from, absolutely.
const SINE: f64 = 3.0 * HALF_A_UNIT;

/// Ghosts that are looked at in every cell of the finer division, and in those of the coarser one.
const FEW: usize = 4096;
/// Cells along each side of the window.
const CELLS: [usize; 2] = [8, 4];

/// The bounds: the worst of some cells of the window, in each of which every ghost is as far away as the cell.
pub(super) fn bounds(problem: &Problem, weighed: &Weighed) -> Bounds {
    let (ghosts, frame) = (problem.ghosts(), problem.frame());
    let kept = weighed.weights.iter().filter(|&&weight| weight > 0.0).count();
    let cells = Cells::new(frame, CELLS[usize::from(kept > FEW)]);
    let chunk = ghosts.len().div_ceil(64).max(256);
    let sums: Vec<[Vec<f64>; 2]> = (0..ghosts.len().div_ceil(chunk))
        .into_par_iter()
        .map(|k| cells.sums(ghosts, weighed, k * chunk..((k + 1) * chunk).min(ghosts.len())))
        .collect();
    let largest = |kind: usize| {
        (0..cells.count * cells.count).map(|cell| sums.iter().map(|sums| sums[kind][cell]).sum()).fold(0.0, f64::max)
    };
    let additions = PER_WEIGHT_DOUBLE + PER_ADDITION_DOUBLE * kept as f64;
    Bounds {
        single: largest(0).max(PER_WEIGHT),
        double: STORED + additions * (1.0 + largest(1)) + turned(ghosts, weighed, frame),
    }
}

/// What the f64 of phases shifts periodic bells by, which others do not have: their offsets are those of the reference to
/// the last bit.
fn turned(ghosts: &[Ghost], weighed: &Weighed, frame: Frame) -> f64 {
    let (low, high) = frame.bounds();
    let one = |(ghost, &weight): (&Ghost, &f64)| {
        let shape = ghost.bell.shape();
        let Some(period) = shape.period().filter(|_| weight > 0.0) else { return 0.0 };
        let farthest = (ghost.center - low).abs().max((high - ghost.center).abs()) + period;
        let shift = 4.0 * f64::EPSILON * farthest / ghost.size;
        weight * (shape.steepest(0.0) * (shift.x + shift.y)).min(1.0)
    };
    ghosts.iter().zip(&weighed.weights).map(one).sum()
}

/// The window in as many parts along each side.
struct Cells {
    count: usize,
    low: DVec2,
    side: DVec2,
}

impl Cells {
    fn new(frame: Frame, count: usize) -> Self {
        let (low, high) = frame.bounds();
        Self { count, low, side: (high - low) / count as f64 }
    }

    /// What f32 costs, and what meets, in each cell, of a range of ghosts.
    fn sums(&self, ghosts: &[Ghost], weighed: &Weighed, range: Range<usize>) -> [Vec<f64>; 2] {
        let mut sums = [(); 2].map(|()| vec![0.0; self.count * self.count]);
        let mut places = Vec::with_capacity(self.count);
        for index in range.filter(|&index| weighed.weights[index] > 0.0) {
            let (ghost, weight) = (&ghosts[index], weighed.weights[index]);
            let bell = Steepness::new(ghost);
            places.clear();
            places.extend((0..self.count).map(|k| bell.places(self, k, weighed.nearest[index].abs())));
            for (row, [_, y]) in places.iter().enumerate() {
                for (column, [x, _]) in places.iter().enumerate() {
                    let (off, met) = bell.off(x, y);
                    sums[0][row * self.count + column] += weight * off;
                    sums[1][row * self.count + column] += weight * met;
                }
            }
        }
        sums
    }
}

/// What of a bell decides how much f32 is off.
struct Steepness<'a> {
    ghost: &'a Ghost,
    shape: &'a dyn Shape,
    /// Whether it depends on the radius alone.
    radial: bool,
    /// Half a period in sizes of a bell that has one lobe in it; infinite for a Gaussian.
    half_period: Option<DVec2>,
    /// How far its centre is moved, in sizes.
    moved: DVec2,
    /// What of it is at most off for each size that it is off along one axis: none where f32 has no room for one over the
    /// size.
    held: bool,
    /// What a sine-Gaussian is shifted by beside its offset, in sizes.
    beside: DVec2,
}

/// A bell along one axis, in a cell or farther: offsets in sizes.
#[derive(Debug, Clone, Copy)]
struct Place {
    /// The nearest offset, less what f32 shifts it by.
    near: f64,
    shift: f64,
    value: f64,
    steepest: f64,
    exponent: f64,
}

impl<'a> Steepness<'a> {
    fn new(ghost: &'a Ghost) -> Self {
        let shape = ghost.bell.shape();
        let moved = |center: f64| (center - f64::from(center as f32)).abs();
        let beside = match &ghost.bell {
            Bell::SineGaussian(bell) => SINE / std::f64::consts::TAU * bell.period / ghost.size,
            _ => DVec2::ZERO,
        };
        Self {
            ghost,
            shape,
            radial: matches!(shape.modes(), Modes::Radial(_)),
            half_period: match &ghost.bell {
                Bell::Gaussian => Some(DVec2::INFINITY),
                Bell::VonMises(bell) => Some(0.5 * bell.period / ghost.size),
                _ => None,
            },
            moved: DVec2::new(moved(ghost.center.x), moved(ghost.center.y)) / ghost.size,
            held: ghost.size.max_element() < 1.0 / f64::from(f32::MIN_POSITIVE),
            beside,
        }
    }

    /// The bell along both axes in the k-th row and column of cells; no pixel is nearer than `nearest`, in sizes.
    fn places(&self, cells: &Cells, k: usize, nearest: DVec2) -> [Place; 2] {
        let low = cells.low + cells.side * k as f64;
        let high = low + cells.side;
        let Ghost { center, size, .. } = *self.ghost;
        let near = ((center.clamp(low, high) - center) / size).abs().max(nearest);
        let far = ((low - center).abs().max((high - center).abs()) / size).max(near);
        let position = PER_POSITION * low.abs().max(high.abs()) / size;
        let [x, y] = [0, 1].map(|axis| {
            // Within half a period, a von Mises bell is what a Gaussian is at the chord, which is shorter.
            let chord = self.half_period.map(|half| half[axis]).filter(|half| far[axis] <= *half);
            let near = chord.map_or(near[axis], |half| {
                let turn = std::f64::consts::FRAC_PI_2 / half;
                if turn > 0.0 { (turn * near[axis]).sin() / turn } else { near[axis] }
            });
            // The exponent has it already, which is where an exponential is off.
            let scaled = if chord.is_some() { 0.0 } else { self.scaled(far[axis]) };
            let shift = position[axis] + self.moved[axis] + self.beside[axis] + scaled;
            self.place(near, shift, chord.is_some())
        });
        [x, y]
    }

    /// What the offset's own rounding shifts the bell by, where that goes as far as `far`.
    fn scaled(&self, far: f64) -> f64 {
        match &self.ghost.bell {
            Bell::VonMises(_) | Bell::SineGaussian(_) => PER_OFFSET * far,
            Bell::Profile(_) => (PER_OFFSET + PER_RADIUS) * far.min(self.shape.ends()),
            _ => PER_OFFSET * far.min(self.shape.ends()),
        }
    }

    /// The bell at an offset or farther that f32 shifts by as much; `gaussian` where it is no farther up than a Gaussian.
    fn place(&self, near: f64, shift: f64, gaussian: bool) -> Place {
        let shape = if gaussian { Bell::Gaussian.shape() } else { self.shape };
        let shifted = (near - shift).max(0.0);
        // A periodic bell is near again farther on, and its value bounded by 1; exp(−E) (1 + E) is below 1 for every E.
        let distance = if shape.period().is_some() { 0.0 } else { shifted };
        Place {
            near: distance,
            shift,
            value: along(shape, distance),
            steepest: if self.radial { 0.0 } else { shape.steepest(distance) },
            exponent: if gaussian { 0.5 * near * near } else { 0.0 },
        }
    }

    /// What the bell of peak 1 is off by in f32, and what it is, at most.
    fn off(&self, x: &Place, y: &Place) -> (f64, f64) {
        let met = x.value * y.value;
        if met == 0.0 {
            return (0.0, 0.0);
        }
        // A profile may fall from 1 to −1.
        let most = if self.radial { 2.0 } else { 1.0 } * met;
        let shifted = if !self.held {
            f64::INFINITY
        } else if self.radial {
            // The radius is not below what both offsets make.
            self.shape.steepest(x.near.hypot(y.near)) * x.shift.hypot(y.shift)
        } else {
            x.shift * x.steepest * y.value + y.shift * y.steepest * x.value
        };
        (PER_WEIGHT * met * (1.0 + x.exponent + y.exponent) + shifted.min(most), met)
    }
}
