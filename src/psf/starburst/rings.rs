//! A pattern's means over directions and channels, as plots and tables have them.

use std::f64::consts::{FRAC_PI_2, TAU};

use super::aperture::Aperture;
use super::pattern::Pattern;
use super::spectrum::{Sensitivities, UNIT};

/// Directions, cells of the diameter and lags that the transform is computed by.
const DIRECTIONS: usize = 32;
const CELLS: usize = 2048;
const LAGS: usize = 512;

/// The means of a pattern, in λ₀N.
#[derive(Debug)]
pub(super) struct Rings {
    /// Radii, light for each square there, and the light beyond.
    rows: Vec<[f64; 3]>,
    /// By how much the opening covers itself, moved by so many parts of its diameter.
    covered: Vec<f64>,
    /// λ/λ₀, and what the channels have of it, their mean.
    wavelengths: Vec<(f64, f64)>,
}

impl Rings {
    pub fn new(pattern: &Pattern) -> Self {
        let parts = Sensitivities::new();
        let mean = |(wavelength, part): (f64, [f64; 3])| (wavelength / UNIT, part.iter().sum::<f64>() / 3.0);
        Self {
            rows: pattern.rings(),
            covered: covered(pattern.aperture()),
            wavelengths: parts.parts().map(mean).collect(),
        }
    }

    /// The mean light for each square at a radius.
    pub fn value(&self, r: f64) -> f64 {
        let [last, value, _] = self.rows[self.rows.len() - 1];
        if r >= last {
            return value * (last / r).powi(3);
        }
        let ([from, a, _], [to, b, _]) = self.between(r);
        a + (b - a) * (r - from) / (to - from)
    }

    /// The light within a radius.
    pub fn within(&self, r: f64) -> f64 {
        let all = self.rows[0][2];
        let [last, _, beyond] = self.rows[self.rows.len() - 1];
        if r >= last {
            return 1.0 - beyond / all * last / r;
        }
        let ([from, _, a], [to, _, b]) = self.between(r);
        // Even over the ring's area.
        let part = (r * r - from * from) / (to * to - from * from);
        1.0 - (a + (b - a) * part) / all
    }

    /// The rows before and after a radius that is less than the last one's.
    fn between(&self, r: f64) -> ([f64; 3], [f64; 3]) {
        let next = self.rows.partition_point(|[radius, _, _]| *radius <= r).clamp(1, self.rows.len() - 1);
        (self.rows[next - 1], self.rows[next])
    }

    /// The transform at a frequency for each λ₀N: for each wavelength the part of the opening that covers itself when it is moved by
    /// that times λ/λ₀ (the optical transfer function).
    pub fn transform(&self, frequency: f64) -> f64 {
        let at = |lag: f64| {
            let at = lag * LAGS as f64;
            let first = at as usize;
            let value = |index: usize| self.covered.get(index).copied().unwrap_or(0.0);
            value(first) + (value(first.saturating_add(1)) - value(first)) * (at - first as f64)
        };
        self.wavelengths.iter().map(|&(scale, part)| part * at(frequency * scale)).sum()
    }
}

/// The parts of the opening that it covers when it is moved by 0, 1/512, … of its diameter, as a mean over directions: of
/// each chord along the way what is longer than that.
fn covered(aperture: Aperture) -> Vec<f64> {
    let directions = if aperture.is_round() { 1 } else { DIRECTIONS };
    let mut sums = vec![0.0; LAGS + 1];
    for direction in 0..directions {
        // All are the same once more beyond the middle between two spikes.
        let angle = aperture.sector() * (direction as f64 + 0.5) / directions as f64;
        let chords = aperture.chords(angle + FRAC_PI_2, CELLS);
        for (lag, sum) in sums.iter_mut().enumerate() {
            let moved = lag as f64 / LAGS as f64;
            *sum += chords.iter().map(|chord| (chord - moved).max(0.0)).sum::<f64>();
        }
    }
    let all = sums[0];
    sums.iter().map(|sum| sum / all).collect()
}

impl Pattern {
    /// Radii of all rows, with the mean light for each square there and the light beyond, over directions and channels.
    fn rings(&self) -> Vec<[f64; 3]> {
        let mean = |values: [f64; 3]| values.iter().sum::<f64>() / 3.0;
        let row = |radius: f64| [radius, mean(self.ring(radius)) / TAU, mean(self.outside(0.0, |_| radius))];
        self.all_radii().into_iter().map(row).collect()
    }
}
