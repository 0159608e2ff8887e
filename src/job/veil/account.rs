//! What is told of a veil: how it was computed, how exactly, and what became of the light.

use rayon::prelude::*;
use serde::Serialize;

use super::{Seat, VeilSeen, light};
use crate::choices::Processor;
use crate::look::Veil as Wanted;
use crate::veil::{self, BadSources};
use crate::{Error, Result};

/// How a veil was computed, and how exactly.
#[derive(Debug, Clone, Serialize)]
pub struct Veiled {
    /// What it is of.
    #[serde(flatten)]
    pub seen: VeilSeen,
    /// s: what the veil was multiplied by.
    pub strength: f64,
    /// f: the share of the light that is scattered where the strength is 1, RGB.
    pub scattered: [f64; 3],
    /// k(0), per steradian or square of the function's unit, RGB.
    pub centre: [f64; 3],
    /// Whether the photo keeps all of its own light.
    pub adds: bool,
    /// Gaussians of the mixture.
    pub terms: usize,
    /// How it was summed: by a `pyramid` of Gaussians, on the `sphere`, by a `transform`, or by a `sum` of every source at every pixel.
    pub summed_by: String,
    /// What summed it.
    pub computed_by: Processor,
    /// How exact it is, relative to the local veil.
    pub error: VeilError,
    /// What a person ought to know: of a tolerance that could not be had.
    pub notes: Vec<String>,
    /// What became of the light.
    pub ledger: Ledger,
    /// Pixels whose veil is below a billionth of their channel's largest, RGB: they are held to that.
    pub dark: [usize; 3],
    /// Samples that are no source, RGB.
    pub no_sources: NoSources,
}

/// Errors relative to the local veil.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct VeilError {
    /// What was asked for.
    pub asked: f64,
    /// The plan's bound.
    pub predicted: f64,
    /// What was found against the direct sum in 64-bit floats.
    pub measured: f64,
    /// At how many pixels.
    pub pixels: usize,
}

impl VeilError {
    /// An error where the veil is further from the truth than was asked.
    ///
    /// # Errors
    /// [`Error::VeilMissed`].
    pub fn check(&self) -> Result<()> {
        // Written so that a NaN would be an error too.
        if self.measured <= self.asked {
            return Ok(());
        }
        Err(Error::VeilMissed { asked: self.asked, measured: self.measured })
    }
}

/// Where the light is, RGB: radiance times steradians, or times the square of the function's unit.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct Ledger {
    /// What the photo holds; a negative sample holds none.
    pub light: [f64; 3],
    /// What its pixels keep.
    pub kept: [f64; 3],
    /// What falls on its other pixels.
    pub inside: [f64; 3],
    /// What leaves it; negative where there is more than there was.
    pub lost: [f64; 3],
    /// How much more there is than there was, 0 or more: of a veil that is added, of pixels that are coarser than the function's core
    /// and are brighter by its definition, from beyond a border, or within the veil's error.
    pub gained: [f64; 3],
}

impl Ledger {
    /// What becomes of `light`, of which so much is kept, and so much falls on other pixels.
    pub(super) fn of(light: [f64; 3], kept: [f64; 3], inside: [f64; 3]) -> Self {
        let lost = [0, 1, 2].map(|channel| light[channel] - kept[channel] - inside[channel]);
        Self { light, kept, inside, lost, gained: lost.map(|lost| (-lost).max(0.0)) }
    }
}

/// Samples that count as black, RGB.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct NoSources {
    /// NaN.
    pub nan: [usize; 3],
    /// Infinite.
    pub infinite: [usize; 3],
    /// Negative.
    pub negative: [usize; 3],
}

/// What each pixel loses of its own light: s (f − k(0) Ω).
pub(super) struct Loss {
    /// s f and s k(0), RGB.
    shares: [[f64; 3]; 2],
    seat: Seat,
}

impl Loss {
    pub fn new(wanted: &Wanted, seat: Seat, strength: f64) -> Self {
        let strength = if wanted.adds { 0.0 } else { strength };
        // Even pixels keep nothing: what falls on them of their own light is in their veil.
        let evenly = matches!(seat.geometry, veil::Geometry::Equirectangular);
        let centres = if evenly { [0.0; 3] } else { wanted.psf().centres() };
        let shares = [wanted.psf().energies(), centres].map(|shares| shares.map(|share| strength * share));
        Self { shares, seat }
    }

    /// The solid angle, or the area, of a pixel, and what it loses, RGB.
    pub fn at(&self, pixel: usize) -> (f64, [f64; 3]) {
        let columns = self.seat.stored[0];
        let area = self.seat.solid_angle([pixel % columns, pixel / columns]);
        let [energies, centres] = self.shares;
        (area, [0, 1, 2].map(|channel| energies[channel] - centres[channel] * area))
    }

    /// What the pixel in the middle of those that are stored loses, RGB.
    pub fn in_the_middle(&self) -> [f64; 3] {
        let [width, height] = self.seat.stored;
        self.at(height / 2 * width + width / 2).1
    }
}

/// Adds up where the light is.
pub(super) fn ledger(sources: &veil::Photo<'_>, planes: &[Vec<f32>; 3], loses: &Loss) -> Ledger {
    let [width, height] = sources.size();
    let row = |y: usize| {
        let mut sums = [[0.0; 3]; 3];
        for x in 0..width {
            let (area, lost) = loses.at(y * width + x);
            for channel in 0..3 {
                let held = area * light(sources.value(channel, x, y));
                sums[0][channel] += held;
                sums[1][channel] += (1.0 - lost[channel]) * held;
                sums[2][channel] += area * f64::from(planes[channel][y * width + x]);
            }
        }
        sums
    };
    let add =
        |a: [[f64; 3]; 3], b: [[f64; 3]; 3]| [0, 1, 2].map(|k| [0, 1, 2].map(|channel| a[k][channel] + b[k][channel]));
    // Row by row in their order, so that a sum is the same every time.
    let rows: Vec<_> = (0..height).into_par_iter().map(row).collect();
    let [light, kept, inside] = rows.into_iter().fold([[0.0; 3]; 3], add);
    Ledger::of(light, kept, inside)
}

/// What of a photo was no source.
pub(super) fn no_sources(BadSources { undefined, infinite, negative }: BadSources) -> NoSources {
    NoSources { nan: undefined, infinite, negative }
}
