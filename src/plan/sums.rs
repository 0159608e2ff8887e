//! What ghosts add to each mode, before it is one.

use std::f64::consts::TAU;

use super::amplitudes::{Rgb, rows};
use super::bands::Folded;
use super::modes::Mode;
use crate::series::{Factor, kappa};

/// A ghost's coefficients along one axis, turned to its place.
pub(super) struct Axis {
    /// What they are about the bell's centre, and for which size.
    centred: Vec<[f64; 2]>,
    size: f64,
    turned: Vec<[f64; 2]>,
}

impl Axis {
    pub fn new(degree: u32) -> Self {
        Self {
            centred: vec![[1.0, 0.0]; degree as usize + 1],
            size: f64::NAN,
            turned: vec![[0.0; 2]; degree as usize + 1],
        }
    }

    pub fn turn(&mut self, factor: Option<&dyn Factor>, size: f64, turns: f64) {
        // Equal sizes come one after the other more often than not.
        if let Some(factor) = factor.filter(|_| self.size != size) {
            self.centred = factor.coefficients(self.centred.len() as u32 - 1, size);
            self.size = size;
        }
        let (sin, cos) = (TAU * (turns - turns.round())).sin_cos();
        let mut phase = [1.0, 0.0];
        for (turned, [a, b]) in self.turned.iter_mut().zip(&self.centred) {
            // (a − ib) (cos − i sin)
            *turned = [a * phase[0] - b * phase[1], -a * phase[1] - b * phase[0]];
            phase = [phase[0] * cos - phase[1] * sin, phase[1] * cos + phase[0] * sin];
        }
    }
}

/// For each mode the sums of the products of real and imaginary parts: re·re and im·re, then re·im and im·im, each for
/// three colours.
pub(super) struct Sums(pub Vec<[f64; 12]>);

impl Sums {
    pub fn zero(modes: usize) -> Self {
        Self(vec![[0.0; 12]; modes])
    }

    pub fn add(&mut self, other: &Self) {
        for (mine, theirs) in self.0.as_flattened_mut().iter_mut().zip(other.0.as_flattened()) {
            *mine += theirs;
        }
    }

    pub fn add_ghost(&mut self, counts: &[u32], weight: Rgb, [x, y]: &[Axis; 2]) {
        let mut rest = &mut self.0[..];
        for ([re, im], &count) in x.turned.iter().zip(counts) {
            let (row, others) = rest.split_at_mut(count as usize);
            let [r, g, b] = weight;
            let across = [r * re, g * re, b * re, r * im, g * im, b * im];
            for (sums, [re, im]) in row.iter_mut().zip(&y.turned) {
                for (k, across) in across.into_iter().enumerate() {
                    sums[k] += across * re;
                    sums[6 + k] += across * im;
                }
            }
            rest = others;
        }
    }

    /// Adds the modes of another series of this period.
    pub fn add_folded(&mut self, counts: &[u32], folded: &Folded) {
        let [columns, height] = folded.harmonics;
        for ((n, row), terms) in rows(counts).enumerate().zip(folded.terms.chunks(height)).take(columns) {
            for (m, (sums, mode)) in self.0[row].iter_mut().zip(terms).enumerate() {
                let weight = kappa(n as u32, m as u32).recip();
                for (colour, [a, b, c, d]) in mode.iter().enumerate() {
                    for (part, value) in [a, &-c, &-b, d].into_iter().enumerate() {
                        sums[3 * part + colour] += weight * value;
                    }
                }
            }
        }
    }

    /// Adds what others have for some of the modes, which are counted one row after the other.
    pub fn add_some(&mut self, counts: &[u32], some: &[u32], other: impl Fn(usize) -> [f64; 12]) {
        let mut at = 0;
        for (row, &some) in rows(counts).zip(some) {
            for mine in self.0[row].iter_mut().take(some as usize) {
                mine.iter_mut().zip(other(at)).for_each(|(mine, theirs)| *mine += theirs);
                at += 1;
            }
        }
    }
}

/// A mode times a factor.
pub(super) fn times(sums: &[f64; 12], factor: f64) -> [f64; 12] {
    sums.map(|sum| factor * sum)
}

/// A mode through a bell that has these parts.
pub(super) fn through(sums: &[f64; 12], parts: [f64; 4]) -> [f64; 12] {
    let mut through = [0.0; 12];
    for colour in 0..3 {
        let turned = turned([0, 3, 6, 9].map(|part| sums[part + colour]), parts);
        for (part, value) in turned.into_iter().enumerate() {
            through[3 * part + colour] = value;
        }
    }
    through
}

/// What the products of real and imaginary parts along x and y, re·re, im·re, re·im and im·im, become in a bell that has these parts, as
/// [`crate::series::Plane`] gives them: Z₊ and Z₋ each times the bell's own, (cc ∓ ss) − i(±cs + sc).
pub(super) fn turned([re_re, im_re, re_im, im_im]: [f64; 4], [cc, ss, cs, sc]: [f64; 4]) -> [f64; 4] {
    let times = |[a, b]: [f64; 2], [c, d]: [f64; 2]| [a * c - b * d, a * d + b * c];
    let plus = times([re_re - im_im, im_re + re_im], [cc - ss, -(sc + cs)]);
    let minus = times([re_re + im_im, im_re - re_im], [cc + ss, cs - sc]);
    [plus[0] + minus[0], plus[1] + minus[1], plus[1] - minus[1], minus[0] - plus[0]].map(|part| 0.5 * part)
}

/// A, B, C and D of a mode for each colour, and (|Z₊| + |Z₋|) κ/2.
pub(super) fn mode(sums: &[f64; 12], kappa: f64) -> (Mode, Rgb) {
    let part = |colour: usize| [0, 3, 6, 9].map(|part| sums[part + colour]);
    let term = |[re_re, im_re, re_im, im_im]: [f64; 4]| [re_re, -re_im, -im_re, im_im].map(|value| kappa * value);
    let bound = |[re_re, im_re, re_im, im_im]: [f64; 4]| {
        let length = |x: f64, y: f64| (x * x + y * y).sqrt();
        let (sum, difference) = (length(re_re - im_im, re_im + im_re), length(re_re + im_im, im_re - re_im));
        0.5 * kappa * (sum + difference)
    };
    ([0, 1, 2].map(|colour| term(part(colour))), [0, 1, 2].map(|colour| bound(part(colour))))
}
