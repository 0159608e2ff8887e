//! The veil of a whole sphere, of an equirectangular picture: rows of pixels are rings about the poles.
//!
//! A pixel is even all over its area: what one sends to the centre of another, or to its own, is L ∫ k dΩ over it ([`pixel`]). That
//! depends on two rows, and on how far apart two columns are, all the way round: so along each ring the veil is a circular
//! convolution,
//!
//! ```text
//! V̂_b(m) = Σ_a K̂_ba(m) L̂_a(m)
//! ```
//!
//! for each wave number m of the rings' transforms, a sum over all rows a for each row b. There is no seam and no pole in that, and
//! no mixture of Gaussians. Of two rings that are far apart K_ba is smooth, and few of its samples tell all of it: with
//! sin θ the larger of the two, and d their distance, its transform falls off like exp(−m d / sin θ). So the cost is that of the pairs of
//! rows, and not of all pairs of rows and columns.
//!
//! # The bound
//!
//! No source is negative, so that the largest relative error of K is one of the veil. The plan looks for it, by the
//! transforms as they are and by integrals that are finer, between rows everywhere and at columns near and far.

mod pixel;
mod tabled;

use std::collections::BTreeMap;
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use num_complex::Complex;
use rayon::prelude::*;
use realfft::{ComplexToReal, RealFftPlanner, RealToComplex};

use super::FLOOR;
use super::evaluate::Veil;
use super::kernel::Kernel;
use super::photo::{Photo, light};
use pixel::{Fineness, Rows};
pub(crate) use tabled::Tabled;

/// Rows between two pixels up to which integrals go over each pixel by itself: of rings that are closer than [`FALLS`] of their rows the
/// picture's columns are too few samples.
const NEAR: usize = 7;

/// e^(−π · this) is what is left out of the transform of K between two rings, over its peak.
const FALLS: f64 = 6.0;

/// The fewest samples of K along a ring.
const FEWEST: usize = 16;

/// Rows that are looked at for the bound, and how much worse those may be that are not.
const LOOKED_AT: usize = 6;
const WORSE: f64 = 1.5;

/// A veil of panoramas of one size.
#[derive(Debug)]
pub(in crate::veil) struct Rings {
    size: [usize; 2],
    kernel: Tabled,
    /// The error of K relative to itself, and of that what is rounding.
    pub bound: f64,
}

/// The error of numbers that are rounded to 32 bits.
pub(in crate::veil) const ROUNDING: f64 = 1e-7;

/// The veil by its definition, at pixels of a panorama, each a column and a row: every pixel's light times the integral of `k` over
/// it, RGB. `k` is of the angle in degrees, per steradian.
pub(in crate::veil) fn reference(photo: &Photo, k: impl Fn(f64) -> f64, pixels: &[[usize; 2]]) -> Vec<[f64; 3]> {
    let size = photo.size();
    let kernel = Tabled::new(k);
    let at = |&[column, to]: &[usize; 2]| {
        let row = |from: usize| {
            let rows = Rows::new(size, to, from);
            let mut sum = [0.0; 3];
            for source in 0..size[0] {
                let apart = source.abs_diff(column);
                let value = rows.over_pixel(&kernel, apart.min(size[0] - apart), Fineness::Finer);
                (0..3).for_each(|colour| sum[colour] += value * light(photo.value(colour, source, from)));
            }
            sum
        };
        let rows: Vec<[f64; 3]> = (0..size[1]).into_par_iter().map(row).collect();
        rows.into_iter().fold([0.0; 3], |sum, row| [0, 1, 2].map(|colour| sum[colour] + row[colour]))
    };
    pixels.iter().map(at).collect()
}

/// Transforms along rings, by how many samples they take.
struct Transforms(BTreeMap<usize, Arc<dyn RealToComplex<f64>>>);

impl Rings {
    /// For a kernel of the angle in degrees, per steradian.
    pub fn new(kernel: &Kernel, [width, height]: [usize; 2]) -> Self {
        let rings = Self { size: [width, height], kernel: Tabled::new(|angle| kernel.at(angle)), bound: 0.0 };
        let bound = rings.looked_for() + ROUNDING;
        Self { bound, ..rings }
    }

    /// Multiply-adds for each pixel and channel, about.
    pub fn operations(&self) -> f64 {
        let [width, height] = self.size.map(|side| side as f64);
        // Samples of K, their transforms and products, for all pairs of rows.
        let samples = TAU * FALLS * height * (height.ln() + 1.0) + width * (2 * NEAR) as f64;
        20.0 * samples / width
    }

    /// The veil of a photo.
    pub fn evaluate(&self, photo: &Photo) -> Veil {
        let spectra = self.spectra(photo);
        let [width, height] = self.size;
        let transforms = Transforms::new(width);
        let inverse = RealFftPlanner::<f64>::new().plan_fft_inverse(width);
        let upper = height.div_ceil(2);
        let pairs: Vec<[[Vec<f32>; 3]; 2]> = (0..upper)
            .into_par_iter()
            .map(|row| self.sums(&transforms, &spectra, row).map(|sums| sums.map(|sum| real(&*inverse, sum))))
            .collect();
        let row = |row: usize| &pairs[row.min(height - 1 - row)][usize::from(row >= upper)];
        let planes =
            [0, 1, 2].map(|colour| (0..height).flat_map(|at| row(at)[colour].iter().copied()).collect::<Vec<f32>>());
        let dark = planes.each_ref().map(|plane| {
            let floor = FLOOR * f64::from(plane.iter().copied().fold(0.0, f32::max));
            plane.iter().filter(|value| f64::from(**value) < floor).count()
        });
        Veil { planes, bad: photo.bad(), dark, lonely: [0; 3], certified: [self.bound; 3] }
    }

    /// The transforms of the veil in a row and in its mirror image about the equator, which have the same kernels, RGB each.
    fn sums(
        &self,
        transforms: &Transforms,
        spectra: &[Vec<[Complex<f64>; 3]>],
        row: usize,
    ) -> [[Vec<Complex<f64>>; 3]; 2] {
        let [width, height] = self.size;
        let mut sums = [0, 1].map(|_| [0, 1, 2].map(|_| vec![Complex::ZERO; width / 2 + 1]));
        for from in 0..height {
            let kernel = self.transformed(transforms, row, from);
            for (sums, from) in sums.iter_mut().zip([from, height - 1 - from]) {
                for (colour, sum) in sums.iter_mut().enumerate() {
                    let waves = sum.iter_mut().zip(&kernel).zip(&spectra[from]);
                    waves.for_each(|((sum, kernel), wave)| *sum += wave[colour] * *kernel);
                }
            }
        }
        sums
    }

    /// The transform of each row of a photo, RGB.
    fn spectra(&self, photo: &Photo) -> Vec<Vec<[Complex<f64>; 3]>> {
        let [width, height] = self.size;
        let forward = RealFftPlanner::<f64>::new().plan_fft_forward(width);
        let row = |row: usize| {
            let mut spectrum = vec![[Complex::ZERO; 3]; width / 2 + 1];
            for colour in 0..3 {
                let mut lights: Vec<f64> = (0..width).map(|column| light(photo.value(colour, column, row))).collect();
                let mut waves = forward.make_output_vec();
                forward.process(&mut lights, &mut waves).expect("buffers are of the lengths that were planned");
                spectrum.iter_mut().zip(waves).for_each(|(all, wave)| all[colour] = wave);
            }
            spectrum
        };
        (0..height).into_par_iter().map(row).collect()
    }

    /// K̂ from one row to another, for the wave numbers at which it is anything.
    fn transformed(&self, transforms: &Transforms, to: usize, from: usize) -> Vec<f64> {
        let rows = Rows::new(self.size, to, from);
        let [width, _] = self.size;
        let near = to.abs_diff(from) < NEAR;
        let count = if near { width } else { transforms.enough(rows.samples(FALLS)) };
        let sample = |k: usize| {
            if near {
                rows.over_pixel(&self.kernel, k, Fineness::Usual)
            } else {
                rows.over_height(&self.kernel, TAU * k as f64 / count as f64)
            }
        };
        // The same to both sides.
        let half: Vec<f64> = (0..=count / 2).map(sample).collect();
        let mut samples: Vec<f64> = (0..count).map(|k| half[k.min(count - k)]).collect();
        let transform = transforms.of(count);
        let mut waves = transform.make_output_vec();
        transform.process(&mut samples, &mut waves).expect("buffers are of the lengths that were planned");
        let scale = width as f64 / count as f64;
        // The mean over the width of a pixel takes each wave by a sinc; half of the last one is the next turn's.
        let spread = |m: usize| {
            let x = PI * m as f64 / width as f64;
            if near || m == 0 { 1.0 } else { x.sin() / x }
        };
        let last = if count == width { 1.0 } else { 0.5 };
        let kept = waves.len();
        waves
            .iter()
            .enumerate()
            .map(|(m, wave)| scale * spread(m) * wave.re * if m + 1 == kept { last } else { 1.0 })
            .collect()
    }

    /// The largest error that is found of K relative to itself.
    fn looked_for(&self) -> f64 {
        let [width, height] = self.size;
        let transforms = Transforms::new(width);
        let inverse = RealFftPlanner::<f64>::new().plan_fft_inverse(width);
        let rows: Vec<usize> = (0..LOOKED_AT).map(|k| k * (height / 2) / LOOKED_AT).collect();
        // Next to the row, and farther and farther away.
        let offsets = [0isize, 1, -1, 2, -2, 4, 6, 7, -7, 9, 14, 22, 35, 60, 100];
        let mut pairs: Vec<[usize; 2]> = rows
            .iter()
            .flat_map(|&to| offsets.iter().map(move |offset| [to, to.wrapping_add_signed(*offset)]))
            .chain(rows.iter().flat_map(|&to| [[to, height - 1], [to, height / 2], [to, height - 1 - to]]))
            .filter(|[_, from]| *from < height)
            .collect();
        pairs.dedup();
        let worst = |&[to, from]: &[usize; 2]| {
            let kernel = self.transformed(&transforms, to, from);
            let mut waves = vec![Complex::ZERO; width / 2 + 1];
            waves.iter_mut().zip(&kernel).for_each(|(wave, k)| wave.re = *k);
            let mut realised = vec![0.0; width];
            inverse.process(&mut waves, &mut realised).expect("buffers are of the lengths that were planned");
            let exact = Rows::new(self.size, to, from);
            let columns = [0, 1, 2, 3, 5, 8, 13, 21, 34, 55, width / 8, width / 4, width / 3, width / 2];
            let error = |&column: &usize| {
                let wanted = exact.over_pixel(&self.kernel, column, Fineness::Finer);
                (realised[column] / width as f64 / wanted - 1.0).abs()
            };
            columns.iter().filter(|column| **column <= width / 2).map(error).fold(0.0, f64::max)
        };
        WORSE * pairs.par_iter().map(worst).reduce(|| 0.0, f64::max)
    }
}

/// A row by its transform, whose first and last waves are real but for rounding.
fn real(inverse: &dyn ComplexToReal<f64>, mut waves: Vec<Complex<f64>>) -> Vec<f32> {
    let count = inverse.len();
    waves[0].im = 0.0;
    // A panorama is twice as wide as high.
    waves[count / 2].im = 0.0;
    let mut row = inverse.make_output_vec();
    inverse.process(&mut waves, &mut row).expect("buffers are of the lengths that were planned");
    row.iter().map(|value| (value / count as f64).max(0.0) as f32).collect()
}

impl Transforms {
    /// Of so many columns, and of powers of two below that.
    fn new(width: usize) -> Self {
        let mut planner = RealFftPlanner::<f64>::new();
        let powers = (0..usize::BITS).map(|power| 1usize << power).skip_while(|count| *count < FEWEST);
        let counts = powers.take_while(|count| *count < width).chain([width]);
        Self(counts.map(|count| (count, planner.plan_fft_forward(count))).collect())
    }

    /// At least so many samples, or all.
    fn enough(&self, samples: f64) -> usize {
        let all = *self.0.keys().next_back().expect("there is one of all columns");
        self.0.keys().copied().find(|count| *count as f64 >= samples).unwrap_or(all)
    }

    fn of(&self, count: usize) -> &Arc<dyn RealToComplex<f64>> {
        &self.0[&count]
    }
}
