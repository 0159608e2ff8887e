//! What a lens scatters besides, by `camera`, on the same pixels.

use std::f64::consts::{FRAC_PI_2, PI};

use rayon::prelude::*;

use crate::psf::function::Function;
use crate::psf::plane::Camera;

/// Within so many pixels their means are taken, by as many samples along each axis.
const CLOSE: usize = 4;
const SAMPLES: usize = 8;
/// Directions in a quarter of a turn in which the light beyond a rectangle is looked for.
const DIRECTIONS: usize = 48;

/// `camera` with another share of the light.
pub(super) struct Scattered {
    /// By what its values are taken for those of a pixel, and its energies.
    scale: f64,
    /// The side of a pixel in the look's unit.
    pitch: f64,
}

impl Scattered {
    pub fn new(share: f64, pitch: f64) -> Self {
        Self { scale: share / Camera.energy(), pitch }
    }

    /// Adds it to the pixels around a middle one, which stays 0, each of which is first multiplied by `by`.
    pub fn add(&self, pixels: &mut [[f64; 3]], [across, up]: [usize; 2], by: f64) {
        let columns = 2 * across + 1;
        pixels.par_chunks_mut(columns).enumerate().for_each(|(row, pixels)| {
            let above = row.abs_diff(up);
            let half: Vec<f64> = (0..=across).map(|right| self.pixel(right, above)).collect();
            for (column, pixel) in pixels.iter_mut().enumerate() {
                let light = half[column.abs_diff(across)];
                *pixel = pixel.map(|value| by * value + light);
            }
        });
    }

    /// What falls on a pixel so many to the side and above; nothing counts on the middle one.
    fn pixel(&self, right: usize, above: usize) -> f64 {
        if right.max(above) == 0 {
            return 0.0;
        }
        let value = |x: f64, y: f64| Camera.value(self.pitch * x.hypot(y));
        let [x, y] = [right, above].map(|side| side as f64);
        let area = self.scale * self.pitch * self.pitch;
        if right.max(above) >= CLOSE {
            return area * value(x, y);
        }
        let off = |sample: usize| (sample as f64 + 0.5) / SAMPLES as f64 - 0.5;
        let row = |above: usize| (0..SAMPLES).map(|right| value(x + off(right), y + off(above))).sum::<f64>();
        area * (0..SAMPLES).map(row).sum::<f64>() / (SAMPLES * SAMPLES) as f64
    }

    /// The light beyond the rectangle of so many pixels to either side of the middle one, and above and below.
    pub fn outside(&self, reach: [usize; 2]) -> f64 {
        let [across, up] = reach.map(|reach| (reach as f64 + 0.5) * self.pitch);
        let corner = up.atan2(across);
        // On either side of the corner the edge's distance is smooth.
        let part = |from: f64, to: f64| {
            let direction = |index: usize| from + (to - from) * (index as f64 + 0.5) / DIRECTIONS as f64;
            let edge = |direction: f64| (across / direction.cos()).min(up / direction.sin());
            let beyond = |index: usize| Camera.energy() - Function::Camera.energy_within(edge(direction(index)));
            (to - from) * (0..DIRECTIONS).map(beyond).sum::<f64>() / DIRECTIONS as f64
        };
        self.scale * (part(0.0, corner) + part(corner, FRAC_PI_2)) * 4.0 / (2.0 * PI)
    }
}
