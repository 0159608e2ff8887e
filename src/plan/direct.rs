//! What floats cost the direct sum: unlike a series, each bell is off by no more than it is itself, or as steep, at the
//! nearest pixel.

use std::f64::consts::{PI, SQRT_2, TAU};
use std::ops::Range;

use glam::DVec2;
use rayon::prelude::*;

use super::candidate::Survey;
use super::weigh::{Weighed, along};
use super::{Cost, Evaluator, Request, cost};
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

/// What the direct sum is off by at any pixel, at most, in the floats of either precision; with 64 bits, before that is stored.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Bounds {
    pub single: f64,
    pub double: f64,
}

impl Bounds {
    /// The precision that leaves a bound of at most so much, if only the larger one can; and its bound.
    pub fn within(self, budget: f64) -> (Precision, f64) {
        match self.single <= budget {
            true => (Precision::Single, self.single),
            false => (Precision::Double, STORED + self.double),
        }
    }
}

/// What an offset's own rounding and that of the radius shift a bell by, for each unit of the offset.
pub(super) fn per_offset(bell: &Bell) -> f64 {
    match bell {
        Bell::Profile(_) => PER_OFFSET + PER_RADIUS,
        Bell::Disc(_) | Bell::Iris(_) => PER_OFFSET + PER_RHO,
        _ => PER_OFFSET,
    }
}

/// Half a unit in the last place of an f32.
pub(super) const HALF_A_UNIT: f64 = 0.5 * f32::EPSILON as f64;

/// The error, for each unit of weight, of a bell and its addition in f32 where its exponent is small: about twice the worst
/// that tests/suite/rounding.rs has seen on Mesa's software renderer.
pub(super) const PER_WEIGHT: f64 = 4.5e-7;

/// What is left where all is f64: the field is rounded to f32, once, in units by which to multiply costs nothing. The field's
/// largest value may be a little above the largest that was found.
pub(super) const STORED: f64 = 1.25 * HALF_A_UNIT;

/// And in f64, where functions are off by some units of 2⁻⁵³, and for each addition.
const PER_WEIGHT_DOUBLE: f64 = 2e-15;
const PER_ADDITION_DOUBLE: f64 = 0.5 * f64::EPSILON;

/// What f32 may shift a pixel by, for each unit of its position: that is a product of two numbers that are rounded, and is
/// rounded itself.
const PER_POSITION: f64 = 2.0 * HALF_A_UNIT;
/// And the offset, for each unit of it: a difference, times one over the size, which is rounded.
pub(super) const PER_OFFSET: f64 = 3.0 * HALF_A_UNIT;
/// The square of it as a profile's table has it, both rounded: half of that in the radius.
const PER_RADIUS: f64 = 1.5 * HALF_A_UNIT;
/// A disc's radius, a sum of rounded products and its root, or for a polygon four such sums, one after the other: of each unit of
/// it.
const PER_RHO: f64 = 18.0 * HALF_A_UNIT;
/// The sine that a sine-Gaussian's mean is taken from, absolutely.
pub(super) const SINE: f64 = 3.0 * HALF_A_UNIT;

/// Cells along each side of the window, for at most so many ghosts; and for more.
const CELLS: [(usize, usize); 3] = [(64, 32), (512, 16), (4096, 8)];
const FEWEST_CELLS: usize = 4;

/// The bounds: the worst of some cells of the window, in each of which every ghost is as far away as the cell.
pub(super) fn bounds(problem: &Problem, weighed: &Weighed) -> Bounds {
    let (ghosts, frame) = (problem.ghosts(), problem.frame());
    let kept = weighed.weights.iter().filter(|&&weight| weight > 0.0).count();
    let along = CELLS.into_iter().find(|(ghosts, _)| kept <= *ghosts).map_or(FEWEST_CELLS, |(_, along)| along);
    let cells = Cells::new(frame, along, kept);
    let chunk = ghosts.len().div_ceil(64).max(256);
    let sums: Vec<[Vec<f64>; 2]> = (0..ghosts.len().div_ceil(chunk))
        .into_par_iter()
        .map(|k| cells.sums(ghosts, weighed, k * chunk..((k + 1) * chunk).min(ghosts.len())))
        .collect();
    let largest = |kind: usize| {
        (0..cells.count * cells.count).map(|cell| sums.iter().map(|sums| sums[kind][cell]).sum()).fold(0.0, f64::max)
    };
    let additions = PER_ADDITION_DOUBLE * kept as f64;
    Bounds { single: largest(0).max(PER_WEIGHT), double: additions + largest(1) }
}

/// What the sum costs at least, before it is planned.
pub(super) fn estimate(problem: &Problem, survey: &Survey, request: &Request) -> Cost {
    let nanoseconds = cost::direct(&survey.groups, Precision::Single, problem.frame(), &request.cost_model);
    let milliseconds = 1e-6 * (nanoseconds + request.cost_model.pass);
    Cost { evaluator: Evaluator::Direct, summed: survey.kept(), reaching: 0, milliseconds }
}

/// The window in as many parts along each side.
struct Cells {
    count: usize,
    /// What the f64 of one bell is off by, for each unit of it, and of its exponent: the sum of so many ghosts with it.
    per_double: f64,
    low: DVec2,
    side: DVec2,
}

impl Cells {
    fn new(frame: Frame, count: usize, ghosts: usize) -> Self {
        let (low, high) = frame.bounds();
        let per_double = PER_WEIGHT_DOUBLE + PER_ADDITION_DOUBLE * ghosts as f64;
        Self { count, per_double, low, side: (high - low) / count as f64 }
    }

    /// What f32 costs, and f64, in each cell, of a range of ghosts.
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
                    let [single, double] = bell.off(x, y, self.per_double);
                    sums[0][row * self.count + column] += weight * single;
                    sums[1][row * self.count + column] += weight * double;
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
    /// Whether it is no product, and bounded by the radius alone.
    radial: bool,
    /// Whether it is an exponential of the offset, or of a sine, as a Gaussian is, in which a rounding of the exponent counts
    /// as often as the exponent is large.
    exponential: bool,
    /// How far its centre is moved, in sizes.
    moved: DVec2,
    /// Whether f32 has room for one over the sizes.
    held: bool,
    /// What a sine-Gaussian is shifted by beside its offset, in sizes.
    beside: DVec2,
    /// And in f64, the larger of both.
    beside_double: f64,
}

/// A bell along one axis, in a cell or farther: offsets in sizes.
#[derive(Debug, Clone, Copy)]
struct Place {
    /// The nearest offset, less what f32 shifts it by.
    near: f64,
    shift: f64,
    shift_double: f64,
    /// What the offset's part of the position costs, where it is not in the shift.
    apart: f64,
    value: f64,
    steepest: f64,
    exponent: f64,
}

impl<'a> Steepness<'a> {
    fn new(ghost: &'a Ghost) -> Self {
        let shape = ghost.bell.shape();
        let moved = |center: f64| (center - f64::from(center as f32)).abs();
        let beside = match &ghost.bell {
            Bell::SineGaussian(bell) => SINE / TAU * bell.period / ghost.size,
            _ => DVec2::ZERO,
        };
        Self {
            ghost,
            shape,
            radial: !matches!(shape.modes(), Modes::Product(_)),
            exponential: matches!(ghost.bell, Bell::Gaussian | Bell::VonMises(_) | Bell::SineGaussian(_)),
            moved: DVec2::new(moved(ghost.center.x), moved(ghost.center.y)) / ghost.size,
            held: ghost.size.max_element() < 1.0 / f64::from(f32::MIN_POSITIVE),
            beside,
            beside_double: beside.max_element() * f64::EPSILON / f64::from(f32::EPSILON),
        }
    }

    /// The bell along both axes in the k-th row and column of cells; no pixel is nearer than `nearest`, in sizes.
    fn places(&self, cells: &Cells, k: usize, nearest: DVec2) -> [Place; 2] {
        let low = cells.low + cells.side * k as f64;
        let high = low + cells.side;
        let Ghost { center, size, .. } = *self.ghost;
        let near = ((center.clamp(low, high) - center) / size).abs().max(nearest);
        let far = ((low - center).abs().max((high - center).abs()) / size).max(near);
        // Beyond its end a bell is nothing, so no pixel farther than that matters.
        let farthest = low.abs().max(high.abs()).min(center.abs() + self.shape.ends() * size);
        let [x, y] = [0, 1].map(|axis| {
            // Of a periodic bell, whose offsets are many, the lobe decides.
            let lobe = self.lobe(axis, low[axis] - center[axis], high[axis] - center[axis]);
            // Within half a period a von Mises bell is what a Gaussian is, whose exponent has the offset's rounding already.
            let relative = match &self.ghost.bell {
                Bell::Gaussian => true,
                Bell::VonMises(bell) => far[axis] * size[axis] <= 0.5 * bell.period[axis],
                _ => false,
            };
            let scaled = if relative { 0.0 } else { self.scaled(far[axis]) };
            // A small Gaussian is steep near its centre: farther off the pixel's own rounding counts as the offset does.
            let small =
                matches!(self.ghost.bell, Bell::Gaussian) && center[axis].abs() + 4.0 * size[axis] < farthest[axis];
            let position = PER_POSITION * if small { center[axis].abs() } else { farthest[axis] } / size[axis];
            let shift = position + self.moved[axis] + self.beside[axis] + scaled;
            self.place(lobe.unwrap_or(near[axis]), shift, far[axis], small)
        });
        [x, y]
    }

    /// How near a periodic bell's lobe is at offsets from `low` to `high`, as the distance at which a Gaussian is as large.
    fn lobe(&self, axis: usize, low: f64, high: f64) -> Option<f64> {
        let size = self.ghost.size[axis];
        let least = |distance: &dyn Fn(f64) -> f64, zeros: &[f64], period: f64| {
            let (low, high) = (low / period, high / period);
            let held = |zero: &f64| (low - zero).ceil() <= high - zero;
            // Between zeros it rises and falls once.
            if zeros.iter().any(held) { 0.0 } else { distance(low).abs().min(distance(high).abs()) * period / size }
        };
        match &self.ghost.bell {
            Bell::VonMises(bell) => Some(least(&|turns| (PI * turns).sin() / PI, &[0.0], bell.period[axis])),
            Bell::SineGaussian(bell) => {
                let zero = bell.mean.clamp(-1.0, 1.0).asin() / TAU;
                let distance = |turns: f64| ((TAU * turns).sin() - bell.mean) / TAU;
                Some(least(&distance, &[zero, 0.5 - zero], bell.period[axis]))
            }
            _ => None,
        }
    }

    /// What the offset's own rounding shifts the bell by, where that goes as far as `far`.
    fn scaled(&self, far: f64) -> f64 {
        match &self.ghost.bell {
            Bell::VonMises(_) | Bell::SineGaussian(_) => PER_OFFSET * far,
            bell => per_offset(bell) * far.min(self.shape.ends()),
        }
    }

    /// What f64 shifts the bell by, where offsets go as far as `far`.
    fn shifted_double(&self, far: f64) -> f64 {
        // The reference takes whole periods off its own way, and a rim may be steep enough to show a root's last bit.
        match &self.ghost.bell {
            Bell::VonMises(_) | Bell::SineGaussian(_) => 4.0 * f64::EPSILON * far + self.beside_double,
            Bell::Disc(_) | Bell::Iris(_) => 4.0 * f64::EPSILON * far.min(self.shape.ends()),
            _ => 0.0,
        }
    }

    /// The bell at an offset or farther that f32 shifts by as much, and by the offset's own part of the position where that is
    /// not in it; none goes beyond `far`.
    fn place(&self, near: f64, shift: f64, far: f64, apart: bool) -> Place {
        let shape = if self.exponential { Bell::Gaussian.shape() } else { self.shape };
        let distance = (near - shift).max(0.0);
        // d² exp(−d²/2) is largest at √2, or where it begins.
        let peak = near.max(SQRT_2);
        Place {
            apart: if apart { PER_POSITION * peak * peak * (-0.5 * peak * peak).exp() } else { 0.0 },
            near: distance,
            shift,
            shift_double: self.shifted_double(far),
            value: along(shape, distance),
            steepest: if self.radial { 0.0 } else { shape.steepest(distance) },
            exponent: if self.exponential { 0.5 * near * near } else { 0.0 },
        }
    }

    /// What the bell of peak 1 is off by at most, in f32 and in f64.
    fn off(&self, x: &Place, y: &Place, per_double: f64) -> [f64; 2] {
        let met = x.value * y.value;
        if met == 0.0 {
            return [0.0; 2];
        }
        // A profile may fall from 1 to −1.
        let most = if self.radial { 2.0 } else { 1.0 } * met;
        let slope = |x_shift: f64, y_shift: f64| {
            if self.radial {
                // The radius is not below what both offsets make.
                return self.shape.steepest(x.near.hypot(y.near)) * x_shift.hypot(y_shift);
            }
            x_shift * x.steepest * y.value + y_shift * y.steepest * x.value
        };
        let shifted = if !self.held {
            f64::INFINITY
        } else {
            let falls = self.radial && x.near.hypot(y.near) <= self.shape.ends();
            slope(x.shift, y.shift) + if falls { self.shape.jump() } else { 0.0 }
        };
        let with_exponent = met * (1.0 + x.exponent + y.exponent);
        [
            PER_WEIGHT * with_exponent + (shifted + x.apart * y.value + y.apart * x.value).min(most),
            per_double * with_exponent + slope(x.shift_double, y.shift_double).min(most),
        ]
    }
}
