//! The pattern along a direction from its centre.
//!
//! At the wavelength λ the light at r is |A(ρ)|²/area =: I(ρ), ρ = rλ₀/λ, with the transform A of an aperture of diameter 1
//! (Goodman, *Introduction to Fourier Optics*, 4.4); along a direction that is the transform of the chords across it (the
//! projection-slice theorem), one FFT. Over wavelengths, with sensitivities w, it adds up to
//!
//! S(r) = ∫ w(λ) (λ₀/λ)² I(rλ₀/λ) dλ = (λ₀/r) ∫ w(rλ₀/ρ) I(ρ) dρ,
//!
//! the first as a sum over wavelengths near the centre, the second farther off as one over all samples of the FFT. I has no
//! frequency above that of the diameter, so that two samples for each λN miss nothing, and nothing is left to chance where
//! thousands of fringes fall into one channel. It is one way for blades straight or bent: sums over edges in closed form would take
//! tens of edges for each arc, and every fringe of every wavelength.
//!
//! As radii and wavelengths only scale each other, samples are first gathered in bins of like ρ, each doubling of ρ in as many; all
//! rows then have the same weights.

use std::f64::consts::PI;
use std::sync::Arc;

use realfft::{RealFftPlanner, RealToComplex};

use super::aperture::Aperture;
use super::spectrum::{PARTS, Sensitivities, UNIT, VISIBLE};

/// Where sums over wavelengths end, and how many rows there are for each unit to there.
pub(super) const NEAR: f64 = 8.0;
pub(super) const ROWS: usize = 64;
/// Rows for each doubling of the radius from there on, about to the radius `LAST`.
pub(super) const ROWS_A_DOUBLING: f64 = 32.0;
pub(super) const LAST: f64 = 1400.0;
/// Bins of ρ for each row.
const BINS_A_ROW: usize = 4;
/// Cells of the diameter, and how often that fits into the period of the FFT: samples of ρ are one over that apart. The fine ones count
/// up to `FINE_TO`, the coarse ones to a sixteenth of the FFT's frequencies: what is folded to there of a straight edge's transform,
/// the worst, changes I by 1 % at most.
const FINE: [usize; 2] = [1 << 10, 16];
const COARSE: [usize; 2] = [1 << 15, 2];
const FINE_TO: usize = 32;

/// S in the directions of an aperture.
pub(super) struct Slices {
    /// λ₀/λ, and w (λ₀/λ)² dλ.
    wavelengths: Vec<(f64, [f64; 3])>,
    fine: Transform,
    coarse: Transform,
    /// How many rows there are from [`NEAR`] on.
    rows: usize,
    /// λ₀ w of the bins from a row's first one on, which is that of the longest wavelength.
    weights: Vec<[f64; 3]>,
}

impl Slices {
    pub fn new() -> Self {
        let sensitivities = Sensitivities::new();
        let mut wavelengths = Vec::with_capacity(PARTS);
        for (wavelength, part) in sensitivities.parts() {
            let scale = UNIT / wavelength;
            wavelengths.push((scale, part.map(|part| part * scale * scale)));
        }
        let bins = BINS_A_ROW as f64 * ROWS_A_DOUBLING;
        let count = ((VISIBLE[1] / VISIBLE[0]).log2() * bins) as usize;
        let of = |bin: usize| {
            let wavelength = VISIBLE[1] * (-(bin as f64) / bins).exp2();
            (wavelength, sensitivities.at(wavelength))
        };
        // ∫ w dλ is 1, and made so of the sum.
        let mut whole = [0.0; 3];
        for (wavelength, seen) in (0..=count).map(of) {
            (0..3).for_each(|k| whole[k] += seen[k] * wavelength * std::f64::consts::LN_2 / bins);
        }
        let weights = (0..=count).map(of).map(|(_, seen)| [0, 1, 2].map(|k| UNIT * seen[k] / whole[k])).collect();
        let rows = (ROWS_A_DOUBLING * (LAST / NEAR).log2()) as usize + 1;
        Self { wavelengths, fine: Transform::new(FINE), coarse: Transform::new(COARSE), rows, weights }
    }

    /// The radii of the rows from [`NEAR`] on.
    pub fn radii(&self) -> Vec<f64> {
        (0..self.rows).map(|row| NEAR * (row as f64 / ROWS_A_DOUBLING).exp2()).collect()
    }

    /// S at radii from 0 to [`NEAR`], [`ROWS`] for each unit; and, times the cubed radius, at those of [`Slices::radii`]. The direction is
    /// `angle` radians from a spike.
    pub fn along(&self, aperture: Aperture, angle: f64) -> [Vec<[f32; 3]>; 2] {
        let fine = self.fine.along(aperture, angle, FINE_TO * FINE[1] + 1);
        let near = (0..=ROWS * NEAR as usize).map(|row| {
            let radius = row as f64 / ROWS as f64;
            let mut sum = [0.0; 3];
            for (scale, part) in &self.wavelengths {
                let light = cubic(&fine, radius * scale * FINE[1] as f64);
                (0..3).for_each(|k| sum[k] += light * part[k]);
            }
            sum.map(|sum| sum as f32)
        });
        let coarse = self.coarse.along(aperture, angle, COARSE[0] * COARSE[1] / 16);
        let bins = self.bins(&fine, &coarse);
        let far = (0..self.rows).zip(self.radii()).map(|(row, radius)| {
            let mut sum = [0.0; 3];
            for (light, weights) in bins[row * BINS_A_ROW..].iter().zip(&self.weights) {
                (0..3).for_each(|k| sum[k] += light * weights[k]);
            }
            sum.map(|sum| (sum * radius * radius) as f32)
        });
        [near.collect(), far.collect()]
    }

    /// ∫ I dρ about each bin's ρ; what lies between two is shared so that its mean stays where it is.
    fn bins(&self, fine: &[f64], coarse: &[f64]) -> Vec<f64> {
        let mut bins = vec![0.0; BINS_A_ROW * (self.rows - 1) + self.weights.len() + 1];
        let begin = NEAR * UNIT / VISIBLE[1];
        let mut take = |rho: f64, light: f64| {
            let at = BINS_A_ROW as f64 * ROWS_A_DOUBLING * (rho / begin).log2();
            if at > -1.0 && at < (bins.len() - 1) as f64 {
                let bin = at.floor();
                let part = at - bin;
                if bin >= 0.0 {
                    bins[bin as usize] += (1.0 - part) * light;
                }
                bins[(bin + 1.0) as usize] += part * light;
            }
        };
        let switch = [FINE, COARSE].map(|[_, times]| FINE_TO * times);
        for (samples, times, range) in
            [(fine, FINE[1], 1..=switch[0]), (coarse, COARSE[1], switch[1]..=coarse.len() - 1)]
        {
            for sample in range {
                // Where they meet, either stands for its own side.
                let half = if sample == FINE_TO * times { 0.5 } else { 1.0 };
                take(sample as f64 / times as f64, half * samples[sample] / times as f64);
            }
        }
        bins
    }
}

/// The transform of chords.
struct Transform {
    cells: usize,
    period: usize,
    fft: Arc<dyn RealToComplex<f64>>,
}

impl Transform {
    fn new([cells, times]: [usize; 2]) -> Self {
        let period = cells * times;
        Self { cells, period, fft: RealFftPlanner::new().plan_fft_forward(period) }
    }

    /// I at so many samples of ρ, from 0 on; two more for what lies between them.
    fn along(&self, aperture: Aperture, angle: f64, samples: usize) -> Vec<f64> {
        let mut chords = aperture.chords(angle, self.cells);
        chords.resize(self.period, 0.0);
        let mut spectrum = self.fft.make_output_vec();
        if self.fft.process(&mut chords, &mut spectrum).is_err() {
            unreachable!("lengths are the plan's own");
        }
        let light = |sample: usize| {
            // The mean over a cell takes the transform by sin(x)/x.
            let x = PI * sample as f64 / self.period as f64;
            let cell = if sample > 0 { x.sin() / x } else { 1.0 } * self.cells as f64;
            spectrum[sample].norm_sqr() / (cell * cell * aperture.area())
        };
        (0..samples + 2).map(light).collect()
    }
}

/// Between samples, of which those before the first are as those after it (Catmull & Rom).
fn cubic(samples: &[f64], at: f64) -> f64 {
    let first = at as usize;
    let t = at - first as f64;
    let before = if first > 0 { first - 1 } else { 1 };
    let [a, b, c, d] = [before, first, first + 1, first + 2].map(|i| samples[i]);
    b + 0.5 * t * (c - a + t * (2.0 * a - 5.0 * b + 4.0 * c - d + t * (3.0 * (b - c) + d - a)))
}
