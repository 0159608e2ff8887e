//! A veil by the parts of its function, for those who change what these weigh.

use rayon::prelude::*;

use super::planning::{Channel, Held};
use super::{check, computed, failed, predicted, seated, weighed};
use crate::Result;
use crate::choices::Border;
use crate::frame::Frame;
use crate::look::{Look, Veil};
use crate::photo::Photo;
use crate::psf::Psf;
use crate::veil::{self, Geometry};

/// How the veils of the parts of a look's function would be summed on a photo: V = Σ w_i V_i, by [`crate::psf::Basis`].
///
/// A change of age, pigment, light or scattered share changes the weights w_i, and the veils V_i are what they were. Each is
/// held to the look's tolerance relative to itself; as no weight is negative, so is V, whatever they are.
pub struct VeilParts {
    parts: Vec<Psf>,
    /// Plans of each.
    channels: Vec<Vec<Channel>>,
    /// The tolerance that each is held to.
    held: Vec<f64>,
    seat: Seat,
}

/// All that is to stay as it is for a change of weights to be all.
#[derive(PartialEq)]
struct Seat {
    geometry: Geometry,
    size: [usize; 2],
    border: Border,
    tolerance: f64,
    allow_floor: bool,
}

impl Seat {
    fn new(look: &Look, wanted: &Veil, photo: &Photo, frame: &Frame) -> Result<Self> {
        let (_, geometry, size) = seated(look, wanted, photo, frame)?;
        let (border, allow_floor) = (wanted.border, look.accuracy.allow_floor || !wanted.is_held());
        Ok(Self { geometry, size, border, tolerance: wanted.tolerance(), allow_floor })
    }
}

impl VeilParts {
    /// Plans the parts of a look's veil for the pixels of a frame, which is the photo's, or that of a photo made larger or smaller;
    /// none without a veil. A function of more parts than `most` is one part. The look's strength does not matter.
    ///
    /// # Errors
    /// Those of [`super::plan_veil`]: also where one of the parts cannot be had to the tolerance.
    pub fn new(look: &Look, photo: &Photo, frame: &Frame, most: usize) -> Result<Option<Self>> {
        let Some(wanted) = look.veil.as_ref() else { return Ok(None) };
        let seat = Seat::new(look, wanted, photo, frame)?;
        let parts = wanted.psf().basis(most).parts;
        let task = Held::new(look, wanted, &seat.geometry, seat.size);
        let planned = parts.iter().map(|part| task.channels(part)).collect::<Result<Vec<_>>>()?;
        let (channels, held) = planned.into_iter().unzip();
        Ok(Some(Self { parts, channels, held, seat }))
    }

    /// The parts, each of unit energy.
    pub fn parts(&self) -> &[Psf] {
        &self.parts
    }

    /// What the parts weigh in a look, RGB, times its strength: what is to be known after a change. None where more than weights
    /// is another than in the look that was planned for, so that the parts are to be planned again.
    ///
    /// # Errors
    /// On a look that contradicts itself or the photo.
    pub fn weights(&self, look: &Look, photo: &Photo, frame: &Frame) -> Result<Option<Vec<[f64; 3]>>> {
        let Some(wanted) = look.veil.as_ref() else { return Ok(None) };
        check(look, wanted)?;
        if Seat::new(look, wanted, photo, frame)? != self.seat {
            return Ok(None);
        }
        // What is one part because it has too many may have as few as there are.
        let bases = [self.parts.len(), 1].map(|most| wanted.psf().basis(most));
        let alike = bases.into_iter().find(|basis| basis.parts == self.parts);
        Ok(alike.map(|basis| basis.weights.iter().map(|rgb| rgb.map(|weight| look.strength * weight)).collect()))
    }

    /// The bound of the error of V relative to itself, for all weights.
    pub fn predicted(&self) -> f64 {
        self.channels.iter().map(|channels| predicted(channels).bound).fold(0.0, f64::max)
    }

    /// The error relative to itself that V is held to: the look's tolerance, or the lowest that can be had where that will do.
    pub fn held(&self) -> f64 {
        self.held.iter().copied().fold(0.0, f64::max)
    }

    /// V_i of one part, in planes of rows.
    ///
    /// # Errors
    /// On a photo of another size than was planned.
    pub fn veil(&self, part: usize, photo: &Photo) -> Result<[Vec<f32>; 3]> {
        let weighed = weighed(photo);
        let pixels = weighed.as_ref().map_or(&photo.pixels, |pixels| pixels);
        let sources = veil::Photo::rgba(pixels.as_flattened(), self.seat.size).map_err(failed)?;
        Ok(computed(&self.channels[part], &sources)?.planes)
    }

    /// What a pixel at a column and row weighs as a source: its solid angle in steradians, or its area. It keeps the part
    /// 1 − s (f − k(0) Ω) of its light.
    pub fn solid_angle(&self, pixel: [usize; 2]) -> f64 {
        self.seat.geometry.solid_angle(self.seat.size, pixel)
    }

    /// Σ w_i V_i, of the veils that are there: what weighs nothing need not be.
    pub fn laid_together(&self, veils: &[Option<[Vec<f32>; 3]>], weights: &[[f64; 3]]) -> [Vec<f32>; 3] {
        let all = self.seat.size[0] * self.seat.size[1];
        [0, 1, 2].map(|channel| {
            let given: Vec<(&[f32], f64)> = veils
                .iter()
                .zip(weights)
                .filter_map(|(planes, weights)| Some((planes.as_ref()?[channel].as_slice(), weights[channel])))
                .collect();
            let at = |pixel: usize| given.iter().map(|(plane, weight)| f64::from(plane[pixel]) * weight).sum::<f64>();
            (0..all).into_par_iter().map(|pixel| at(pixel) as f32).collect()
        })
    }
}
