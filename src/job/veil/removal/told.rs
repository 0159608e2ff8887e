//! What is told of a veil that was taken away.

use rayon::prelude::*;
use serde::Serialize;

use super::super::{NoSources, VeilSeen};
use super::bound::Bound;
use super::solve::Solution;
use crate::photo::Photo;
use crate::scene::{self, Emission};
use crate::{Error, Result};

/// How a veil was taken away, and how exactly.
#[derive(Debug, Clone, Serialize)]
pub struct Removal {
    /// What the veil is of.
    #[serde(flatten)]
    pub seen: VeilSeen,
    /// s: what the veil was multiplied by.
    pub strength: f64,
    /// f: the share of the light that is scattered where the strength is 1, RGB.
    pub scattered: [f64; 3],
    /// Whether the veil was added to a photo that kept all of its light.
    pub adds: bool,
    /// Gaussians of the mixture.
    pub terms: usize,
    /// How the veil was summed, as in [`super::super::Veiled`].
    pub summed_by: String,
    /// `series` or `conjugate gradients`.
    pub method: &'static str,
    /// Steps that were taken.
    pub steps: usize,
    /// How often the veil was summed, that of a white photo included, which bounds the answer.
    pub veils: usize,
    /// By how much each step of a series leaves less than the one before, RGB: at most so much of it; from 1 on there is no such series.
    pub contraction: [f64; 3],
    /// How exact the answer is.
    pub error: RemovalError,
    /// What becomes of noise.
    pub amplification: Amplification,
    /// What is darker than black.
    pub negative: Negative,
    /// Samples that are no light, and stay as they are, RGB; negative ones are light here.
    pub no_light: NoSources,
}

/// Errors relative to the brightest sample of the clean photo in the same channel.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct RemovalError {
    /// What was asked for.
    pub asked: f64,
    /// The bound of how far the answer is from the clean photo, at every sample.
    pub predicted: f64,
    /// The largest difference between the photo and the answer, veiled again by the definition in 64-bit floats, over the largest sum of
    /// a row of what a veil does.
    pub measured: f64,
    /// At how many pixels.
    pub pixels: usize,
}

impl RemovalError {
    /// An error where the answer, veiled again, is further from the photo than was asked.
    ///
    /// # Errors
    /// [`Error::RemovalMissed`].
    pub fn check(&self) -> Result<()> {
        // Written so that a NaN would be an error too; what was allowed to be further off is held to its own bound.
        if self.measured <= self.asked.max(self.predicted) {
            return Ok(());
        }
        Err(Error::RemovalMissed { asked: self.asked, measured: self.measured })
    }
}

/// What noise of the photo is multiplied by in the answer, at most.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct Amplification {
    /// The largest sample of any noise: 1/(1 − 2f) or less, by the sums of rows; none where they do not bound it.
    pub largest: Option<f64>,
    /// The root of the mean square of any noise: 1/(1 − f) or so; of a symmetric veil on a plane without a border alone.
    pub rms: Option<f64>,
}

impl Amplification {
    pub(super) fn of(bounds: &[Bound; 3]) -> Self {
        let worst = |of: &dyn Fn(&Bound) -> Option<f64>| {
            bounds.iter().map(of).try_fold(0.0, |worst, times| times.map(|times| f64::max(worst, times)))
        };
        let largest = |bound: &Bound| bound.dominance;
        Self { largest: worst(&largest), rms: worst(&|bound| bound.spectrum.map(|spectrum| 1.0 / spectrum.least)) }
    }
}

/// Samples of the answer that are negative, and were not in the photo.
#[derive(Debug, Clone, Copy, Default, Serialize)]
pub struct Negative {
    /// How many.
    pub samples: usize,
    /// How many are so whatever the answer may be off by: there the veil that was given is more than the photo holds.
    pub surely: usize,
    /// How deep the deepest is, over the brightest sample of its channel; 0 or more.
    pub deepest: f64,
    /// Whether negative samples were written as 0.
    pub clamped: bool,
}

impl Negative {
    pub(super) fn of(
        photo: &[[f32; 4]],
        clean: &[[f32; 4]],
        solution: &Solution,
        units: [f64; 3],
        clamped: bool,
    ) -> Self {
        let bounds = [0, 1, 2].map(|c| units[c] * solution.bounds[c]);
        let of = |(own, clean): (&[f32; 4], &[f32; 4])| {
            let mut found = (0, 0, 0.0f64);
            for c in 0..3 {
                let depth = -f64::from(clean[c]);
                if own[c] >= 0.0 && depth > 0.0 {
                    let over = depth / (units[c] * solution.peaks[c].max(f64::MIN_POSITIVE));
                    found = (found.0 + 1, found.1 + usize::from(depth > bounds[c]), found.2.max(over));
                }
            }
            found
        };
        let both = |a: (usize, usize, f64), b: (usize, usize, f64)| (a.0 + b.0, a.1 + b.1, a.2.max(b.2));
        let (samples, surely, deepest) = photo.par_iter().zip(clean).map(of).reduce(|| (0, 0, 0.0), both);
        Self { samples, surely, deepest, clamped }
    }

    /// What a person ought to know of it.
    pub(super) fn warning(&self) -> Option<String> {
        let Self { samples: _, surely, deepest, clamped } = *self;
        (surely > 0).then(|| {
            format!(
                "the veil is more than the photo holds: {surely} samples are negative without it, down to {deepest:.1e} of the brightest; {}",
                if clamped { "they are written as 0" } else { "they are kept as they are (--negative clamp writes 0)" }
            )
        })
    }
}

/// Pixels of which the photo does not say how bright they were.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct Clipped {
    /// From which value of the brightest channel on.
    pub level: f32,
    /// How many.
    pub pixels: usize,
    /// The share of all that are stored, 0 to 1.
    pub share: f64,
}

impl Clipped {
    /// What a person ought to know of it.
    pub(super) fn warning(&self) -> Option<String> {
        let Self { level, pixels, share } = *self;
        let which = if pixels == 1 { "1 pixel is".to_owned() } else { format!("{pixels} pixels are") };
        (pixels > 0).then(|| {
            format!(
                "{which} clipped, from {level} on ({:.2} % of them): how bright they were is not in the photo and cannot be recovered, and the \
                 veil that the light they lack made elsewhere stays there",
                100.0 * share
            )
        })
    }
}

/// Which pixels are clipped, and how many; nothing where nobody says from which value on.
pub(super) fn clipped(photo: &Photo, level: Option<f32>) -> (Vec<bool>, Option<Clipped>) {
    let level = match level {
        None if photo.source.display_referred => scene::DISPLAY_WHITE,
        Some(level) => level,
        None => return (vec![false; photo.pixels.len()], None),
    };
    let mask = scene::clipped(&photo.pixels, photo.frame.window.width as usize, Emission::of(photo), level);
    let pixels = mask.par_iter().filter(|clipped| **clipped).count();
    let share = pixels as f64 / mask.len().max(1) as f64;
    (mask, Some(Clipped { level, pixels, share }))
}
