//! The constant and the quadratic part of a kernel: moments of the whole picture.

use rayon::prelude::*;

use crate::veil::plan::Layers;
use crate::veil::simd::Plane;

/// Sums that are carried at a time, which need not wait for each other.
const LANES: usize = 16;

/// Moments of the sources about the middle of the picture.
pub(super) struct Moments {
    constant: f64,
    quadratic: f64,
    middle: [f64; 2],
    /// Σ L, Σ L x, Σ L y, Σ L (x² + y²).
    sums: [f64; 4],
}

impl Moments {
    pub fn new(layers: &Layers, sources: &Plane<f32>) -> Self {
        let middle = [sources.width(), sources.height()].map(|length| 0.5 * (length as f64 - 1.0));
        let mut moments = Self { constant: layers.constant, quadratic: layers.quadratic, middle, sums: [0.0; 4] };
        if layers.constant == 0.0 && layers.quadratic == 0.0 {
            return moments;
        }
        let row = |y: usize| {
            let (row, v) = (&sources.row(y)[..sources.width()], y as f64 - middle[1]);
            let all = total(row);
            if all == 0.0 || layers.quadratic == 0.0 {
                return [all, 0.0, 0.0, 0.0];
            }
            let across = row.iter().enumerate().map(|(x, light)| (f64::from(*light), x as f64 - middle[0]));
            let [first, second] =
                across.fold([0.0; 2], |[first, second], (light, u)| [first + light * u, second + light * u * u]);
            [all, first, all * v, second + all * v * v]
        };
        // Added in the order of the rows, so that the sum does not depend on the threads.
        let rows: Vec<[f64; 4]> = (0..sources.height()).into_par_iter().with_min_len(16).map(row).collect();
        for row in rows {
            moments.sums.iter_mut().zip(row).for_each(|(sum, row)| *sum += row);
        }
        moments
    }

    /// What they add to each pixel, where that is the same for all.
    pub fn everywhere(&self) -> Option<f32> {
        (self.quadratic == 0.0).then_some((self.constant * self.sums[0]) as f32)
    }

    /// What they add to a pixel, by its place (u, v) from the middle: a constant, and what is times u, v and u² + v².
    pub fn polynomial(&self) -> [f64; 4] {
        let [light, across, down, square] = self.sums;
        let quadratic = self.quadratic;
        let constant = self.constant * light + quadratic * square;
        [constant, -2.0 * quadratic * across, -2.0 * quadratic * down, quadratic * light]
    }

    /// What they add to a pixel.
    pub fn at(&self, x: usize, y: usize) -> f64 {
        let [u, v] = [x as f64 - self.middle[0], y as f64 - self.middle[1]];
        let [light, across, down, square] = self.sums;
        self.constant * light + self.quadratic * (square - 2.0 * (u * across + v * down) + (u * u + v * v) * light)
    }
}

/// The sum of a row.
fn total(row: &[f32]) -> f64 {
    let mut sums = [0.0; LANES];
    let (chunks, rest) = row.as_chunks::<LANES>();
    for chunk in chunks {
        for (sum, value) in sums.iter_mut().zip(chunk) {
            *sum += f64::from(*value);
        }
    }
    sums.iter().sum::<f64>() + rest.iter().map(|value| f64::from(*value)).sum::<f64>()
}
