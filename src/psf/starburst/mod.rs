//! The starburst of an iris: the light that its opening diffracts, by wavelengths, as a picture of the photo's own pixels.
//!
//! A lens in focus draws a point as the Fraunhofer pattern of its opening, |∫∫ e^(−2πi x·a/(λN)) da|² at x on the sensor, a over an
//! opening of diameter 1, with the f-number N. Blades throw spikes at right angles to themselves, which fall off with r⁻² and have no end.
//! Its size on the sensor is that of λN; how many pixels that is follows from the photo, so that the function has its picture
//! once that is known: [`Starburst::kernel`].
//!
//! | file | what |
//! | --- | --- |
//! | `aperture` | the opening, and its chords |
//! | `spectrum` | wavelengths as red, green and blue |
//! | `slices`, `pattern` | the pattern along a direction, and in all of them |
//! | `pixels` | what of it falls on each pixel |
//! | `rings` | its means over directions, and its transform, for plots |

mod aperture;
mod pattern;
mod pixels;
mod rings;
mod scattered;
mod slices;
mod spectrum;
#[cfg(test)]
mod tests;

use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use super::fault::within;
use super::{Fault, Kernel};
use aperture::Aperture;
use pattern::Pattern;
use pixels::Pixels;
use rings::Rings;
use scattered::Scattered;
use spectrum::UNIT;

/// The f-numbers that there are.
pub const FSTOPS: [f64; 2] = [0.5, 64.0];
/// How many blades an iris has that is not round.
pub const BLADES: [u32; 2] = [3, 16];
/// Widths of sensors, in millimetres.
pub const SENSORS: [f64; 2] = [1.0, 500.0];
/// The blades that are taken where nobody says.
pub const USUAL_BLADES: u32 = 6;
/// Likewise the sensor's width, in millimetres.
pub const USUAL_SENSOR: f64 = 36.0;

/// The pixels of a photo, for a function whose picture depends on them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grid {
    /// Columns and rows that are stored, 1 at least each.
    pub stored: [usize; 2],
    /// Columns of the whole photo, which the sensor's width spans.
    pub across: usize,
    /// The side of a pixel in the look's unit.
    pub pitch: f64,
}

/// An iris, and the sensor behind it.
#[derive(Debug, Clone)]
pub struct Starburst {
    fstop: f64,
    aperture: Aperture,
    /// Degrees against the clock from the right to the first corner.
    rotation: f64,
    /// Millimetres.
    sensor: f64,
    /// The share of the light that the lens scatters besides, as `camera` does.
    scatter: f64,
    /// Computed when it is asked for, and then for all copies.
    rings: Arc<OnceLock<Rings>>,
}

impl PartialEq for Starburst {
    fn eq(&self, other: &Self) -> bool {
        let numbers = |of: &Self| (of.fstop, of.aperture, of.rotation, of.sensor, of.scatter);
        numbers(self) == numbers(other)
    }
}

impl Starburst {
    /// An iris at an f-number of [`FSTOPS`], whose opening's corners lie on a circle of the focal length over that: with 3 to 16
    /// blades, or a round one with 0. `rotation`, in degrees, turns it against the clock, from a corner on the right; `roundness` bends its
    /// blades, from 0, straight, to 1, arcs of the circle through the corners; both are 0 of a round one. The sensor's width is in
    /// millimetres, one of [`SENSORS`].
    ///
    /// # Errors
    /// On a number out of its range, or one of blades that are not there, by its key.
    pub fn new(fstop: f64, blades: u32, rotation: f64, roundness: f64, sensor: f64) -> Result<Self, Fault> {
        let fstop = within("fstop", fstop, FSTOPS, "an f-number is from 0.5 to 64")?;
        let [least, most] = BLADES;
        if blades != 0 && !(least..=most).contains(&blades) {
            let reason = format!("an iris has from {least} to {most} blades, or 0 where it is round, and not {blades}");
            return Err(Fault::new("blades", reason));
        }
        let rotation = within("rotation", rotation, [f64::MIN, f64::MAX], "a rotation is a number of degrees")? % 360.0;
        let roundness = within("roundness", roundness, [0.0, 1.0], "the roundness of blades is from 0 to 1")?;
        for (key, value, what) in [("rotation", rotation, "turned"), ("roundness", roundness, "bent")] {
            if blades == 0 && value != 0.0 {
                return Err(Fault::new(key, format!("a round iris has no blades to be {what}")));
            }
        }
        let sensor = within("sensor", sensor, SENSORS, "a sensor is from 1 to 500 mm wide")?;
        let aperture = Aperture::new(blades, roundness);
        Ok(Self { fstop, aperture, rotation, sensor, scatter: 0.0, rings: Arc::default() })
    }

    /// The same in a lens that scatters this share of the light besides, by the function `camera`.
    ///
    /// # Errors
    /// On one that is not from 0 to 1.
    pub fn scattering(self, scatter: f64) -> Result<Self, Fault> {
        let scatter = within("scatter", scatter, [0.0, 1.0], "the share that the lens scatters is from 0 to 1")?;
        Ok(Self { scatter, ..self })
    }

    /// What each pixel of a photo takes of the light of one, RGB, as far as the photo reaches, 0 at the centre, which keeps what the others
    /// do not take. What falls beyond is in the energies alone: they are the share of the light that leaves its pixel.
    pub fn kernel(&self, grid: &Grid) -> Kernel {
        let pattern = pattern_of(self.aperture);
        let pixels = self.pixels(&pattern, grid);
        // Of a single pixel, too, there is a neighbour.
        let reach = grid.stored.map(|side| side.saturating_sub(1).max(1));
        let (mut around, mut beyond) = (pixels.around(reach), pixels.outside(reach));
        if self.scatter > 0.0 {
            let diffracted = 1.0 - self.scatter;
            let scattered = Scattered::new(self.scatter, grid.pitch);
            scattered.add(&mut around, reach, diffracted);
            beyond = beyond.map(|beyond| diffracted * beyond + scattered.outside(reach));
        }
        let [columns, rows] = reach.map(|reach| 2 * reach + 1);
        Kernel::of_light(rows, columns, around, beyond)
    }

    /// The energies of [`Starburst::kernel`], within a thousandth of what the lens scatters besides, without its picture.
    pub fn energies(&self, grid: &Grid) -> [f64; 3] {
        let pattern = pattern_of(self.aperture);
        let leaving = self.pixels(&pattern, grid).outside([0, 0]);
        let scattered = if self.scatter > 0.0 { Scattered::new(self.scatter, grid.pitch).outside([0, 0]) } else { 0.0 };
        leaving.map(|leaving| (1.0 - self.scatter) * leaving + scattered)
    }

    /// Pixels of the photo for its pattern.
    fn pixels<'a>(&self, pattern: &'a Pattern, grid: &Grid) -> Pixels<'a> {
        let side = 1e3 * self.sensor / grid.across.max(1) as f64;
        Pixels::new(pattern, side / self.unit(), self.rotation.to_radians())
    }

    /// λ₀N in micrometres.
    pub(super) fn unit(&self) -> f64 {
        UNIT * self.fstop
    }

    /// The light for each square micrometre at a distance in micrometres, as a mean over directions and channels; without what is
    /// scattered besides.
    pub(super) fn ring(&self, r: f64) -> f64 {
        let unit = self.unit();
        self.diffracted() * self.rings().value(r / unit) / (unit * unit)
    }

    /// The light within a distance in micrometres, likewise.
    pub(super) fn within(&self, r: f64) -> f64 {
        self.diffracted() * self.rings().within(r / self.unit())
    }

    /// Its transform at a frequency in cycles for each micrometre, likewise.
    pub(super) fn transform(&self, frequency: f64) -> f64 {
        self.diffracted() * self.rings().transform(frequency * self.unit())
    }

    /// The share of the light that is not scattered.
    fn diffracted(&self) -> f64 {
        1.0 - self.scatter
    }

    fn rings(&self) -> &Rings {
        self.rings.get_or_init(|| Rings::new(&pattern_of(self.aperture)))
    }
}

/// The pattern of an opening. The last one is kept: whoever changes an f-number or turns an iris asks for it again and again.
fn pattern_of(aperture: Aperture) -> Arc<Pattern> {
    static LAST: Mutex<Option<Arc<Pattern>>> = Mutex::new(None);
    let last = || LAST.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(pattern) = last().as_ref().filter(|pattern| pattern.aperture() == aperture) {
        return pattern.clone();
    }
    // Not while it is locked: threads that wait for each other's work might wait for ever.
    let pattern = Arc::new(Pattern::new(aperture));
    *last() = Some(pattern.clone());
    pattern
}
