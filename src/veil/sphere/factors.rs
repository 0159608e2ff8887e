//! Factors between lattices: each has a power of 1 + |a|² of its own.
//!
//! The step from a lattice's power to the next one's is taken on that lattice, to moments on the way up and to sums on the way down. There a
//! moment is of sources around the lattice's point, whose own factors differ. To the second order,
//!
//!   Σ_a L(a) W(a) β(a − k) = W μ + W′ (μ′/3 − μ‴/180) + W″ μ/6,
//!
//! μ the moments, in points of the lattice and in both directions; as β's transform is sinc⁴, and t β(t) that one's slope. On the way down the
//! transpose is taken, W S − W′ (S′/3 − S‴/180) − W″ S/6.

use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

use super::model::Model;
use crate::veil::simd::{Into, Plane};
use crate::veil::sweep::Pyramid;

/// μ′/3 − μ‴/180 by differences over two and over four points, times half the difference of W over two points.
const SLOPES: [f32; 2] = [0.5 * (2.0 / 9.0 + 1.0 / 180.0), -0.5 * (1.0 / 36.0 + 1.0 / 360.0)];

/// W″/6 by the five-point difference.
const CURVED: f32 = 1.0 / 6.0;

/// Which way.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Way {
    /// Moments.
    Up,
    /// Sums.
    Down,
}

/// For each slot: its factor over that of the one that it has its moments from, at the points where it is applied: its own lattice's in the
/// chain, and the base's in all others. None where the factors are the same.
pub(super) fn factors(model: &Model) -> Vec<Option<Plane<f32>>> {
    let pyramid = Pyramid::<f32>::from_first(model.points(), model.lattices());
    let of = |slot: usize| {
        let [last, base] = model.chain;
        let (at, from) = if slot > last { (base, base) } else { (slot, slot.saturating_sub(1)) };
        let (power, plane) = (model.powers[slot] - model.powers[from], &pyramid.moments[at]);
        if power == 0.0 && slot <= last {
            return None;
        }
        let mut factor = Plane::new(plane.width(), plane.height());
        // The second point is at the first one of the picture.
        let pitch = (1u64 << at) as f64 * model.cell;
        factor.par_rows_mut().enumerate().for_each(|(y, row)| {
            let v = model.first[1] + (y as f64 - 1.0) * pitch;
            row.iter_mut().enumerate().for_each(|(x, out)| {
                let u = model.first[0] + (x as f64 - 1.0) * pitch;
                *out = (power * (1.0 + u * u + v * v).ln()).exp() as f32;
            });
        });
        Some(factor)
    };
    (0..model.slots.len()).map(of).collect()
}

/// `from` times the factor, with its slope; nothing is beyond.
pub(super) fn multiply(arch: Arch, factor: &Plane<f32>, way: Way, from: &Plane<f32>, into: Into, out: &mut Plane<f32>) {
    let (columns, rows) = (from.width(), from.height());
    let zeros = vec![0.0; from.stride()];
    let sign = if way == Way::Up { 1.0 } else { -1.0 };
    out.par_rows_mut().enumerate().for_each(|(y, out)| {
        let factors = [factor.row(y.saturating_sub(1)), factor.row(y), factor.row((y + 1).min(rows - 1))];
        let row = |offset: isize| from.get_row(y as isize + offset).unwrap_or(&zeros);
        let values = [-2, -1, 0, 1, 2].map(row);
        arch.dispatch(Multiply { factors, values, sign, into, out: &mut out[..columns] });
    });
}

/// A row of it; the rows around it.
struct Multiply<'a> {
    factors: [&'a [f32]; 3],
    values: [&'a [f32]; 5],
    sign: f32,
    into: Into,
    out: &'a mut [f32],
}

impl WithSimd for Multiply<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { factors, values, sign, into, out } = self;
        let old = if into == Into::Add { 1.0 } else { 0.0 };
        let count = out.len();
        let [above, factor, below] = factors.map(|row| &row[..count]);
        let [first, before, value, after, last] = values.map(|row| &row[..count]);
        let [near, far] = SLOPES.map(|slope| sign * slope);
        let curved = sign * CURVED;
        for x in 0..count {
            let slope = near * (after[x] - before[x]) + far * (last[x] - first[x]);
            let middle = factor[x] + curved * (above[x] + below[x] - 2.0 * factor[x]);
            out[x] = old * out[x] + middle * value[x] + (below[x] - above[x]) * slope;
        }
        for x in 2..count.saturating_sub(2) {
            let slope = near * (value[x + 1] - value[x - 1]) + far * (value[x + 2] - value[x - 2]);
            let second = factor[x + 1] + factor[x - 1] - 2.0 * factor[x];
            out[x] += curved * second * value[x] + (factor[x + 1] - factor[x - 1]) * slope;
        }
        for x in (0..2.min(count)).chain(count.saturating_sub(2).max(2)..count) {
            let at = |offset: isize| x.checked_add_signed(offset).and_then(|x| value.get(x)).copied().unwrap_or(0.0);
            let slope = near * (at(1) - at(-1)) + far * (at(2) - at(-2));
            let [left, right] = [x.saturating_sub(1), (x + 1).min(count - 1)];
            let steps = (right - left).max(1) as f32;
            out[x] += 2.0 / steps * (factor[right] - factor[left]) * slope;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Moments of a source between points, times its own factor; a plain product at the points would be off by a hundred times as much.
    #[test]
    fn a_factor_on_the_lattice_is_that_of_the_source() {
        let (count, slope) = (24, 0.02f64);
        let weight = |x: f64, y: f64| (slope * x - 0.7 * slope * y).exp();
        let plane = |value: &dyn Fn(f64, f64) -> f64| {
            let mut plane = Plane::new(count, count);
            for y in 0..count {
                (0..count).for_each(|x| plane.row_mut(y)[x] = value(x as f64, y as f64) as f32);
            }
            plane
        };
        let factor = plane(&weight);
        // Moments of sources that are spread around a place, against β at the points.
        let spread = |x: f64, y: f64| (-((x - 11.3).powi(2) + (y - 11.6).powi(2)) / 18.0).exp();
        let sum = |of: &dyn Fn(f64, f64) -> f64, x: f64, y: f64| {
            let steps = |at: f64| (0..16).map(move |step| at - 2.0 + (step as f64 + 0.5) / 4.0);
            let each =
                |v: f64| steps(x).map(move |u| of(u, v) * spread(u, v) * spline(u - x) * spline(v - y)).sum::<f64>();
            steps(y).map(each).sum::<f64>()
        };
        let moments = plane(&|x, y| sum(&|_, _| 1.0, x, y));
        let wanted = plane(&|x, y| sum(&weight, x, y));
        let mut out = Plane::new(count, count);
        multiply(Arch::new(), &factor, Way::Up, &moments, Into::Set, &mut out);
        let largest = (4..20).flat_map(|y| (4..20).map(move |x| (x, y)));
        let mut worst = [0.0f64; 2];
        for (x, y) in largest {
            let truth = f64::from(wanted.row(y)[x]);
            let plain = f64::from(factor.row(y)[x] * moments.row(y)[x]);
            worst[0] = worst[0].max((f64::from(out.row(y)[x]) / truth - 1.0).abs());
            worst[1] = worst[1].max((plain / truth - 1.0).abs());
        }
        assert!(worst[0] < 2e-4 && worst[1] > 20.0 * worst[0], "{:e} {:e}", worst[0], worst[1]);
    }

    fn spline(t: f64) -> f64 {
        let t = t.abs();
        if t < 1.0 { 2.0 / 3.0 - t * t * (1.0 - 0.5 * t) } else { (2.0 - t).max(0.0).powi(3) / 6.0 }
    }
}
