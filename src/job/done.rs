//! The last step: the picture, and how it came about.

use std::sync::Arc;

use rayon::prelude::*;

use super::{EachPixel, Planning, Stages, Veiled};
use crate::Result;
use crate::certificate::Certificate;
use crate::frame::Frame;
use crate::gpu::{Info, PassTime};
use crate::look::{Gathered, Look};
use crate::photo::{BadPixels, Facts, Photo};

/// A photo that has its glare.
pub struct Done<'a> {
    /// What was laid over it.
    pub look: &'a Look,
    /// The photo's frame, with lengths in the look's unit.
    pub frame: Frame,
    /// What is told of the photo.
    pub facts: Facts,
    /// The photo's pixels that are no light.
    pub bad: BadPixels,
    /// What glares in it.
    pub scene: Gathered,
    /// The photo with its glare, where that is wanted.
    pub picture: Option<Photo>,
    /// The glare alone, where that is wanted.
    pub glare: Option<Photo>,
    /// How the glare was computed, where there is any.
    pub computed: Option<Computed>,
    /// The veil, where there is one.
    pub veiled: Option<Veiled>,
    /// How long each stage took, from reading on.
    pub stages: Stages,
    /// What a person ought to know.
    pub warnings: Vec<String>,
}

/// How glare was computed.
pub struct Computed {
    /// On what.
    pub info: Arc<Info>,
    /// How.
    pub planning: Planning,
    /// How exactly.
    pub certificate: Certificate,
    /// And over photo and glare at each pixel, where that is asked for, and there is a picture.
    pub each_pixel: Option<EachPixel>,
    /// How long each pass took, where that is wanted.
    pub passes: Vec<PassTime>,
    /// Milliseconds that spectrum, field and composite took, without upload and readback; where passes were timed.
    pub measured_ms: Option<f64>,
}

impl Done<'_> {
    /// An error where the glare, or the veil, is further from the truth than was asked.
    ///
    /// # Errors
    /// [`Error::ToleranceMissed`](crate::Error::ToleranceMissed), [`Error::EachPixelMissed`](crate::Error::EachPixelMissed),
    /// [`Error::VeilMissed`](crate::Error::VeilMissed).
    pub fn check(&self) -> Result<()> {
        if let Some(Computed { certificate, each_pixel, .. }) = &self.computed {
            certificate.check()?;
            each_pixel.as_ref().map_or(Ok(()), EachPixel::check)?;
        }
        self.veiled.as_ref().map_or(Ok(()), |veiled| veiled.error.check())
    }

    /// Says so where the picture has values beyond `largest`, which is what its file holds.
    pub fn beyond(&self, largest: f32) -> Option<String> {
        let beyond = |pixel: &&[f32; 4]| pixel[..3].iter().any(|value| value.abs() > largest || value.is_nan());
        // Those that the photo had have been told.
        let before = self.bad.nan + self.bad.infinite;
        let count = self.picture.as_ref()?.pixels.par_iter().filter(beyond).count().saturating_sub(before);
        let pixels = if count == 1 { "pixel of the picture is" } else { "pixels of the picture are" };
        (count > 0).then(|| format!("{count} {pixels} beyond {largest:.4e}, the largest value that its file holds"))
    }
}
