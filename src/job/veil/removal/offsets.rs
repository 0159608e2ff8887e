//! A radial veil on a plane without a border, which depends on the offset between two pixels alone.

use std::sync::Arc;

use rayon::prelude::*;

use super::super::{Channel, Definition};
use super::operator::Operator;
use super::ranked::Ranked;
use crate::choices::Border;
use crate::veil::{Geometry, Kernel};

/// s k Ω over all offsets between two pixels of a picture.
pub struct Offsets {
    /// Its sum over all sources, for each pixel as the target, row by row.
    pub sums: Vec<f32>,
    /// Its largest value.
    pub largest: f64,
    /// Its values by their size.
    pub ranked: Arc<Ranked>,
    /// Of a sum of positive Gaussians m: s m(0) Ω, and by how much s k Ω is not that, as a sum over all offsets.
    pub of_mixture: Option<f64>,
}

impl Offsets {
    /// One for all channels, or one for each; none in place of each that does not depend on offsets alone.
    pub fn all(operator: &Operator) -> Vec<Option<Self>> {
        let (seat, border) = (operator.seat(), operator.wanted().border);
        let of = |(_, definition): &Channel| match (seat.geometry, definition) {
            (Geometry::Planar { pitch, solid_angle }, Definition::Radial(kernel)) if border == Border::None => {
                let unit = operator.strength() * solid_angle;
                Some(Self::of(kernel, seat.stored, pitch, unit, operator.is_symmetric()))
            }
            _ => None,
        };
        operator.channels().iter().map(of).collect()
    }

    fn of(kernel: &Kernel, [width, height]: [usize; 2], pitch: f64, unit: f64, symmetric: bool) -> Self {
        let mixture = kernel.mixture();
        // The square of a distance is no kernel of positive eigenvalues.
        let positive = symmetric && mixture.quadratic == 0.0 && !mixture.terms.is_empty();
        let mut values = vec![0.0f64; width * height];
        let row = |(y, values): (usize, &mut [f64])| {
            let (mut misfit, mut largest) = (0.0, 0.0f64);
            for (x, of_offset) in values.iter_mut().enumerate().skip(usize::from(y == 0)) {
                let distance = pitch * (x as f64).hypot(y as f64);
                let value = kernel.at(distance);
                *of_offset = unit * value;
                largest = largest.max(unit * value);
                if positive {
                    // As often as there are signs.
                    let times = f64::from(1 + u8::from(x > 0)) * f64::from(1 + u8::from(y > 0));
                    misfit += times * unit * (value - mixture.at(distance)).abs();
                }
            }
            [misfit, largest]
        };
        let rows: Vec<_> = values.par_chunks_exact_mut(width).enumerate().map(row).collect();
        let [misfit, largest] = rows.into_iter().fold([0.0, 0.0], |all, row| [all[0] + row[0], row[1].max(all[1])]);
        let of_mixture = positive.then(|| unit * mixture.at(0.0) + misfit);
        let times =
            |at: usize| f64::from(1 + u8::from(!at.is_multiple_of(width))) * f64::from(1 + u8::from(at >= width));
        let ranked = Ranked::new(values.iter().enumerate().skip(1).map(|(at, value)| [*value, times(at)]), largest);
        Self { sums: sums(values, [width, height]), largest, ranked: ranked.into(), of_mixture }
    }
}

/// For each pixel, the sum of values by offsets over all pixels of the picture, from above.
fn sums(mut values: Vec<f64>, [width, height]: [usize; 2]) -> Vec<f32> {
    // Over the rectangle from the offset 0 on: of a column or row through it half, since two quadrants have it.
    for (at, value) in values.iter_mut().enumerate() {
        *value *= if at < width { 0.5 } else { 1.0 } * if at % width == 0 { 0.5 } else { 1.0 };
    }
    values.par_chunks_exact_mut(width).for_each(|row| {
        row.iter_mut().fold(0.0, |sum, value| {
            *value += sum;
            *value
        });
    });
    for at in width..values.len() {
        values[at] += values[at - width];
    }
    let rounding = 1.0 + 4.0 * (width + height) as f64 * f64::EPSILON;
    let sum = |at: usize| {
        let (x, y) = (at % width, at / width);
        let quadrants = [(x, y), (width - 1 - x, y), (x, height - 1 - y), (width - 1 - x, height - 1 - y)];
        let sum: f64 = quadrants.iter().map(|&(x, y)| values[y * width + x]).sum();
        ((rounding * sum) as f32).next_up()
    };
    (0..values.len()).into_par_iter().map(sum).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_over_quadrants_are_those_over_all_pixels() {
        let [width, height] = [5, 4];
        let value = |x: usize, y: usize| if x + y == 0 { 0.0 } else { 1.0 / (1 + 3 * x + 7 * y * y) as f64 };
        let values = (0..width * height).map(|at| value(at % width, at / width)).collect();
        for (at, sum) in sums(values, [width, height]).into_iter().enumerate() {
            let all = (0..width * height)
                .map(|from| value((from % width).abs_diff(at % width), (from / width).abs_diff(at / width)));
            let all: f64 = all.sum();
            assert!(f64::from(sum) >= all && f64::from(sum) < all * (1.0 + 1e-6), "{at}: {sum} for {all}");
        }
    }
}
