//! One Gaussian on one lattice: its kernel, and what of it arrives at the pixels.
//!
//! A source at x (in pitches) is seen by the lattice as β(x − k), β the cubic B-spline; a target at y sums β(y − m) times the
//! lattice's values. With the kernel h between, R(x, y) = Σ β(x − k) h(k − m) β(y − m) is realised where exp(−(x − y)² / 2s²) is
//! wanted, s the Gaussian's width in pitches.

use std::f64::consts::{PI, TAU};

/// Phases that are looked at between two lattice points; where there are more pixels than that, so many of them.
const PHASES: usize = 32;

/// What lies between phases that are looked at: with 32 in a period, an extremum of its first harmonics is passed by less
/// than (π / 32)² / 2 of the amplitude, of its second by four times that.
const BETWEEN: f64 = 1.02;

/// β at `t`.
fn spline(t: f64) -> f64 {
    let t = t.abs();
    if t < 1.0 {
        2.0 / 3.0 - t * t * (1.0 - 0.5 * t)
    } else if t < 2.0 {
        (2.0 - t).powi(3) / 6.0
    } else {
        0.0
    }
}

/// h(0) … h(`radius`) for a Gaussian `s` pitches wide.
///
/// Its transform is the Gaussian's over the square of the spline's, sinc⁸. Back in space, the path of integration is moved to the
/// saddle point ω + i n / s², where the exponential is exp(−n² / 2s²) by itself: so that far values, down to the smallest,
/// are as exact relative to themselves as near ones, and positive.
pub(crate) fn kernel(s: f64, radius: usize) -> Vec<f64> {
    // On either side: the real part is even.
    const NODES: usize = 48;
    let end = (PI * s).min(8.5);
    let step = end / NODES as f64;
    let weight = |index: usize| if index == 0 || index == NODES { 1.0 } else { 2.0 };
    let nodes: Vec<(f64, f64)> = (0..=NODES)
        .map(|index| {
            let t = step * index as f64;
            (0.5 * t / s, weight(index) * (-0.5 * t * t).exp())
        })
        .collect();
    let tap = |n: usize| {
        let n = n as f64;
        let sum: f64 = nodes.iter().map(|(x, weight)| weight * inverse_spline(*x, 0.5 * n / (s * s))).sum();
        (-0.5 * (n / s).powi(2)).exp() * step / TAU.sqrt() * sum
    };
    (0..=radius).map(tap).collect()
}

/// The real part of (z / sin z)⁸ at z = `x` + i `y`.
fn inverse_spline(x: f64, y: f64) -> f64 {
    if x == 0.0 && y == 0.0 {
        return 1.0;
    }
    // sin z = (sin x + i cos x tanh y) cosh y; the ratio is squared three times.
    let ((sin, cos), cosh) = (x.sin_cos(), y.cosh());
    let sine = (sin, cos * y.tanh());
    let square = (sine.0 * sine.0 + sine.1 * sine.1) * cosh;
    let ratio = ((x * sine.0 + y * sine.1) / square, (y * sine.0 - x * sine.1) / square);
    let (real, _) = (0..3).fold(ratio, |(re, im), _| (re * re - im * im, 2.0 * re * im));
    real
}

/// A lattice of `pitch` pixels, and a kernel on it.
pub(crate) struct Lattice<'a> {
    pub pitch: usize,
    /// h(0), h(1), …
    pub kernel: &'a [f64],
}

impl Lattice<'_> {
    /// R between pixels `phase` and `phase + offset`.
    pub fn realised(&self, phase: usize, offset: usize) -> f64 {
        let pitch = self.pitch as f64;
        let at = |pixel: usize| (pixel / self.pitch, weights((pixel % self.pitch) as f64 / pitch));
        let start = phase % self.pitch;
        let [(first, from), (second, to)] = [at(start), at(start + offset)];
        let mut sum = 0.0;
        for (k, from) in from.iter().enumerate() {
            for (m, to) in to.iter().enumerate() {
                let distance = (second + m).abs_diff(first + k);
                sum += from * to * self.kernel.get(distance).copied().unwrap_or(0.0);
            }
        }
        sum
    }

    /// What each point along a lattice of `points` counts for `pixel`: the first point that counts, and the values from there on.
    pub fn seen(&self, pixel: usize, points: usize) -> (usize, Vec<f64>) {
        let reach = self.kernel.len() - 1;
        // The lattice's first point lies one pitch before the first pixel.
        let (base, weights) = (pixel / self.pitch, weights((pixel % self.pitch) as f64 / self.pitch as f64));
        let (first, end) = (base.saturating_sub(reach), (base + 4 + reach).min(points));
        let value = |point: usize| {
            let each = weights.iter().enumerate();
            each.map(|(index, weight)| weight * self.kernel.get(point.abs_diff(base + index)).copied().unwrap_or(0.0))
                .sum()
        };
        (first, (first..end).map(value).collect())
    }

    /// The least and the largest R at `offset` over all phases.
    pub fn range(&self, offset: usize) -> [f64; 2] {
        let all = self.pitch <= PHASES;
        let phases = self.pitch.min(PHASES);
        let values = (0..phases).map(|index| self.realised(index * self.pitch / phases, offset));
        let [low, high] = values.fold([f64::INFINITY, 0f64], |[low, high], value| [low.min(value), high.max(value)]);
        if all {
            return [low, high];
        }
        let more = 0.5 * (high - low) * (BETWEEN - 1.0);
        [(low - more).max(0.0), high + more]
    }
}

/// β at the four lattice points around a point `t` of a pitch after the second of them.
pub(crate) fn weights(t: f64) -> [f64; 4] {
    [t + 1.0, t, 1.0 - t, 2.0 - t].map(spline)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What comes back at the pixels is the Gaussian, the closer the wider it is on the lattice: relative to itself out to
    /// where it is 1e-9.
    #[test]
    fn a_gaussian_is_realised_relative_to_itself() {
        for (s, most) in [(2.0, 0.6), (4.0, 5e-2), (6.0, 8e-3), (8.0, 3e-3)] {
            let pitch = 16;
            let kernel = kernel(s, (9.0 * s) as usize);
            let lattice = Lattice { pitch, kernel: &kernel };
            let sigma = s * pitch as f64;
            let worst = (0..(6.4 * sigma) as usize).map(|offset| {
                let wanted = (-0.5 * (offset as f64 / sigma).powi(2)).exp();
                let [low, high] = lattice.range(offset);
                (low / wanted - 1.0).abs().max((high / wanted - 1.0).abs())
            });
            let worst = worst.fold(0.0, f64::max);
            assert!(worst < most && worst > 0.01 * most, "s = {s}: {worst:e}");
        }
    }

    /// The weights of the spline sum to 1 and have no first moment.
    #[test]
    fn the_spline_is_the_cubic_one() {
        for t in [0.0, 0.1, 0.5, 0.93] {
            let [a, b, c, d] = weights(t);
            assert!((a + b + c + d - 1.0).abs() < 1e-15);
            assert!((-a + c + 2.0 * d - t).abs() < 1e-15);
        }
        assert_eq!([spline(0.0), spline(1.0), spline(2.0)], [2.0 / 3.0, 1.0 / 6.0, 0.0]);
    }
}
