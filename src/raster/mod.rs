//! A photo as light: sums of waves, or of anything that is a product along x and y, over all of its pixels.
//!
//! Wanted are Σ_p L(p) Ω A(x_p) B(y_p) over the pixels p, Ω a pixel's area, for many A and many B at once: two products of matrices.
//! Of waves, A = e^{−iqx}, no more is needed than the photo's moments against cubic B-splines on a lattice of pitch b
//! (`veil::sweep` has them, on pitches of 2, 4, 8, … pixels). With the spline's transform β̂(θ) = (sin(θ/2) / (θ/2))⁴ at θ = qb,
//!
//! ```text
//! Σ_j β(t − j) e^{−iθj} = Σ_l β̂(θ + 2πl) e^{−i(θ + 2πl)t} = β̂(θ) e^{−iθt} (1 + ε),    |ε| ≤ Σ_{l≠0} (θ / (θ + 2πl))⁴
//! ```
//!
//! (Poisson's sum; all of the β̂ share their sine), which `lattice::aliasing` has in closed form. So the moments' waves over β̂ are those of
//! the pixels, but for that.

mod lattice;
mod parts;

use std::f64::consts::TAU;
use std::ops::Range;
use std::sync::{Arc, OnceLock};

use glam::DVec2;
use ndarray::linalg::general_mat_mul;
use ndarray::parallel::prelude::*;
use ndarray::{Array2, ArrayView2, Axis, concatenate, s};
use pulp::Arch;

use crate::frame::Frame;
use crate::veil::{Photo, Sources};
use crate::{Error, Result};

use crate::series::frequencies::{self, Spectrum};
pub use lattice::Reduction;
use lattice::{Lattice, Places};
pub(crate) use lattice::{aliasing, spline};
pub(crate) use parts::Cell;

/// Rows of pixels that are taken at a time.
const ROWS: usize = 64;

/// The light of a photo's pixels. What is negative or no number gives none.
pub struct Raster {
    frame: Frame,
    /// Each in a scale of its own.
    channels: [Sources; 3],
    /// What a channel's values have to be multiplied by to be flux, as powers of two and an area.
    factors: [f64; 3],
    flux: [f64; 3],
    /// By reductions.
    lattices: [OnceLock<Lattice>; 2 * lattice::MOST],
    moments: [OnceLock<lattice::Moments>; 2],
    /// Of the pixels, then by reductions, as the lattices.
    spectra: [OnceLock<Spectrum>; 2 * lattice::MOST + 1],
}

impl Raster {
    /// Of a photo's pixels on its frame, row by row from the top; each gives all of its colour.
    ///
    /// # Errors
    /// [`Error::Usage`] where there are not as many as the frame's window has.
    pub fn new(pixels: &[[f32; 4]], frame: Frame) -> Result<Arc<Self>> {
        let size = size(frame);
        let photo = Photo::rgba(pixels.as_flattened(), size).map_err(|error| Error::Usage(error.to_string()))?;
        let channels = photo.channels();
        let area = frame.pixel_sides().element_product();
        let factors = channels.each_ref().map(|channel| area * 2f64.powi(-channel.exponent));
        let mut raster = Self {
            frame,
            channels,
            factors,
            flux: [0.0; 3],
            lattices: [const { OnceLock::new() }; 2 * lattice::MOST],
            moments: [const { OnceLock::new() }; 2],
            spectra: [const { OnceLock::new() }; 2 * lattice::MOST + 1],
        };
        raster.flux = [0, 1, 2].map(|channel| {
            let row = |y: usize| -> f64 {
                let row = &raster.channels[channel].plane.row(y)[..size[0]];
                row.iter().map(|light| f64::from(*light)).sum()
            };
            let rows: Vec<f64> = (0..size[1]).into_par_iter().map(row).collect();
            factors[channel] * rows.iter().sum::<f64>()
        });
        Ok(Arc::new(raster))
    }

    /// The pixels' frame.
    pub fn frame(&self) -> Frame {
        self.frame
    }

    fn size(&self) -> [usize; 2] {
        size(self.frame)
    }

    /// How many pixels there are.
    pub fn pixels(&self) -> usize {
        self.frame.window.pixels()
    }

    /// Radiance times area of all of them, RGB.
    pub fn flux(&self) -> [f64; 3] {
        self.flux
    }

    /// A row's pixels of a colour, and what makes flux of each.
    pub(crate) fn light(&self, row: usize, channel: usize) -> (&[f32], f64) {
        (&self.channels[channel].plane.row(row)[..self.size()[0]], self.factors[channel])
    }

    /// Σ of the flux of some of a row's pixels, by row and columns of the window, each times its factor.
    pub(crate) fn along_row(&self, row: usize, columns: Range<usize>, factors: &[f64]) -> [f64; 3] {
        [0, 1, 2].map(|c| {
            let light = &self.channels[c].plane.row(row)[columns.clone()];
            self.factors[c] * product(light, factors)
        })
    }

    /// Σ_x L(x, y) Ω A_k(x) for each colour, a row for each row of pixels and a column for each A; `across` has a row for each column
    /// of pixels. The same for any number of threads.
    pub(crate) fn along_rows(&self, across: ArrayView2<f64>) -> [Array2<f64>; 3] {
        let [width, height] = self.size();
        [0, 1, 2].map(|channel| {
            let mut sums = Array2::zeros((height, across.ncols()));
            let bands = sums.axis_chunks_iter_mut(Axis(0), ROWS).into_par_iter().enumerate();
            bands.for_each(|(band, mut sums)| {
                let row = |y: usize| &self.channels[channel].plane.row(band * ROWS + y)[..width];
                let light = (0..sums.nrows()).flat_map(|y| row(y).iter().map(|light| f64::from(*light)));
                let light = Array2::from_shape_vec((sums.nrows(), width), light.collect());
                let light = light.expect("as many values as rows and columns");
                general_mat_mul(self.factors[channel], &light, &across, 0.0, &mut sums);
            });
            sums
        })
    }

    /// Σ_p L(p) Ω A_k(x_p) B_l(y_p) for each colour, as rows k and columns l; `down` has a row for each row of pixels, and a column for
    /// each B.
    pub(crate) fn over_pixels(&self, across: ArrayView2<f64>, down: ArrayView2<f64>) -> [Array2<f64>; 3] {
        self.along_rows(across).map(|sums| sums.t().dot(&down))
    }

    /// Σ L Ω over cos cos, sin cos, cos sin and sin sin of q·(x − middle), for each colour, over the points of a reduction or over the
    /// pixels: as rows and columns so many harmonics of x and of y, from none on, of the first along either axis. Of colours that are
    /// not wanted there may be nothing.
    pub(crate) fn waves(
        &self,
        reduction: Reduction,
        first: DVec2,
        harmonics: [usize; 2],
        wanted: [bool; 3],
    ) -> [[Array2<f64>; 4]; 3] {
        if let Some(spectrum) = self.spectrum(reduction) {
            let turned = first * reduction.pitch() * self.frame.pixel_sides() * DVec2::new(1.0, -1.0);
            return [0, 1, 2].map(|channel| {
                if !wanted[channel] {
                    return [0; 4].map(|_| Array2::zeros((harmonics[0], harmonics[1])));
                }
                let mut waves = spectrum.waves(channel, turned.to_array(), harmonics);
                waves.iter_mut().for_each(|waves| *waves *= self.factors[channel]);
                waves
            });
        }
        let Some(lattice) = self.lattice(reduction) else { return self.waves_of_pixels(first, harmonics) };
        let [across, down] = [0, 1].map(|axis| tables(&lattice.places.from_middle[axis], first[axis], harmonics[axis]));
        let rows = lattice.half_rows();
        let along = [0, 1].map(|parity| lattice.folded[parity].dot(&across[parity]));
        [0, 1, 2].map(|channel| {
            [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(x, y)| {
                let from = (3 * y + channel) * rows;
                let mut sums = Array2::zeros((harmonics[0], harmonics[1]));
                let along = along[x].slice(s![from..from + rows, ..]);
                general_mat_mul(self.factors[channel], &along.t(), &down[y], 0.0, &mut sums);
                sums
            })
        })
    }

    fn waves_of_pixels(&self, first: DVec2, harmonics: [usize; 2]) -> [[Array2<f64>; 4]; 3] {
        let places = self.places();
        let [across, down] = [0, 1].map(|axis| {
            let [cosines, sines] = tables(&places.from_middle[axis], first[axis], harmonics[axis]);
            concatenate![Axis(1), cosines, sines]
        });
        let [n, m] = harmonics;
        self.over_pixels(across.view(), down.view()).map(|sums| {
            [(0, 0), (1, 0), (0, 1), (1, 1)]
                .map(|(x, y)| sums.slice(s![x * n..(x + 1) * n, y * m..(y + 1) * m]).to_owned())
        })
    }

    /// The middle of what a reduction has, from which its waves are counted.
    pub(crate) fn middle(&self, reduction: Reduction) -> DVec2 {
        if reduction.transformed {
            let middle = reduction.points.map(|points| frequencies::middle(points as usize) as f64);
            return lattice::position(self.frame, reduction.level, middle);
        }
        self.lattice(reduction).map_or_else(|| self.places().middle, |lattice| lattice.places.middle)
    }

    /// Has the moments of a reduction ready. What makes them is parallel itself, so that tasks must not be the first to ask.
    pub(crate) fn prepare(&self, reduction: Reduction) {
        if self.spectrum(reduction).is_none() {
            self.lattice(reduction);
        }
    }

    /// The transform of the moments of a reduction, computed once; none of what is not transformed.
    fn spectrum(&self, reduction: Reduction) -> Option<&Spectrum> {
        let Reduction { level, doubles, transformed, .. } = reduction;
        if !transformed {
            return None;
        }
        let place = (2 * level as usize + usize::from(doubles)).saturating_sub(1);
        Some(self.spectra[place].get_or_init(|| match level {
            0 => Spectrum::new(3, self.size(), |channel, x, y| f64::from(self.channels[channel].plane.row(y)[x])),
            _ => self.moments(doubles).spectrum(level),
        }))
    }

    fn moments(&self, doubles: bool) -> &lattice::Moments {
        self.moments[usize::from(doubles)].get_or_init(|| {
            let planes = self.channels.each_ref().map(|channel| &channel.plane);
            lattice::Moments::new(planes, self.levels() as usize, doubles)
        })
    }

    /// The moments of a reduction, computed once; none of what is not reduced.
    fn lattice(&self, reduction: Reduction) -> Option<&Lattice> {
        let Reduction { level, doubles, .. } = reduction;
        let place = (2 * level as usize + usize::from(doubles)).checked_sub(2)?;
        Some(self.lattices[place].get_or_init(|| self.moments(doubles).lattice(level, self.frame)))
    }

    /// Where the pixels lie.
    pub(crate) fn places(&self) -> Places {
        let (low, high) = self.frame.bounds();
        let (window, middle) = (self.frame.window, 0.5 * (low + high));
        let columns = (0..window.width as i32).map(|i| self.frame.x(f64::from(window.x + i)) - middle.x);
        let rows = (0..window.height as i32).map(|j| self.frame.y(f64::from(window.y + j)) - middle.y);
        Places { middle, from_middle: [columns.collect(), rows.collect()] }
    }

    /// To a lattice of a level from 1 to [`Raster::levels`], or to none.
    pub(crate) fn reduction(&self, level: u32, doubles: bool) -> Reduction {
        let level = level.min(self.levels());
        Reduction { level, doubles, points: lattice::points(self.frame, level), transformed: false }
    }

    /// How many lattices there are.
    pub(crate) fn levels(&self) -> u32 {
        lattice::levels(self.frame)
    }
}

/// The sum of products, some of them at a time, by the widest vectors that the processor has.
fn product(light: &[f32], factors: &[f64]) -> f64 {
    const LANES: usize = 16;
    let ((light, rest), (factors, others)) = (light.as_chunks::<LANES>(), factors.as_chunks::<LANES>());
    let sums = Arch::new().dispatch(
        #[inline(always)]
        || {
            let mut sums = [0.0; LANES];
            for (light, factors) in light.iter().zip(factors) {
                (0..LANES).for_each(|lane| sums[lane] += f64::from(light[lane]) * factors[lane]);
            }
            sums
        },
    );
    let rest: f64 = rest.iter().zip(others).map(|(light, factor)| f64::from(*light) * factor).sum();
    sums.iter().sum::<f64>() + rest
}

/// Cosines and sines of some harmonics of a frequency, at some places: a row each.
fn tables(places: &[f64], first: f64, harmonics: usize) -> [Array2<f64>; 2] {
    let mut tables = [0, 1].map(|_| Array2::zeros((places.len(), harmonics)));
    for (row, place) in places.iter().enumerate() {
        let turns = first * place / TAU;
        let (sin, cos) = (TAU * (turns - turns.round())).sin_cos();
        let mut wave = [1.0, 0.0];
        for n in 0..harmonics {
            (tables[0][(row, n)], tables[1][(row, n)]) = (wave[0], wave[1]);
            wave = [wave[0] * cos - wave[1] * sin, wave[1] * cos + wave[0] * sin];
        }
    }
    tables
}

/// Columns and rows of pixels.
fn size(frame: Frame) -> [usize; 2] {
    [frame.window.width as usize, frame.window.height as usize]
}

impl PartialEq for Raster {
    /// By what is in them, since looks are compared by what they make.
    fn eq(&self, other: &Self) -> bool {
        let [width, height] = self.size();
        let same = |(one, other): (&Sources, &Sources)| {
            let row = |y: usize| one.plane.row(y)[..width] == other.plane.row(y)[..width];
            one.exponent == other.exponent && (0..height).all(row)
        };
        let alike = self.frame == other.frame && self.flux == other.flux;
        std::ptr::eq(self, other) || alike && self.channels.iter().zip(&other.channels).all(same)
    }
}

impl std::fmt::Debug for Raster {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Raster").field("frame", &self.frame).field("flux", &self.flux).finish_non_exhaustive()
    }
}

#[cfg(test)]
mod tests;
