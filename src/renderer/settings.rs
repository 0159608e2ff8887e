//! What a person sets about the picture.

use crate::choices::Normalize;
use crate::scene::{Emission, Knee};
use crate::{Error, Result};

/// The brightest glare: some way below what f32 ends at, because a field's largest value is known at some pixels only.
const BRIGHTEST: f64 = 1e37;

/// What a person sets about the picture; the field does not depend on it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// What the glare is multiplied by; 0 leaves the photo as it is.
    pub strength: f64,
    /// How the field's values become glare.
    pub normalize: Normalize,
    /// Between which values stretched ones are stretched, instead of the least and the largest of this field.
    pub range: Option<[f32; 2]>,
    /// What is subtracted from the field's values first, RGB: 0, or the constant term of its series, to see the others.
    /// Stretched values stay as they are, because their range moves with them.
    pub constant: [f64; 3],
    /// What a light keeps of itself, RGB; 1 unless light is taken from the photo.
    pub light_gain: [f64; 3],
    /// The brightness from which on a pixel is a light.
    pub threshold: f64,
    /// Where every pixel is a light, what of it is, instead of all from a threshold on.
    pub knee: Option<Knee>,
    /// How a pixel of the photo gives light.
    pub emission: Emission,
    /// What each layer that [`Picture::lay_over`](super::Picture::lay_over) was given is multiplied by, RGB; 0 where there is none.
    pub overlay: [[f64; 3]; 4],
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            strength: 1.0,
            normalize: Normalize::None,
            range: None,
            constant: [0.0; 3],
            light_gain: [1.0; 3],
            threshold: f64::INFINITY,
            knee: None,
            emission: [0.2126, 0.7152, 0.0722].into(),
            overlay: [[0.0; 3]; 4],
        }
    }
}

impl Settings {
    /// Whether f32 holds the glare that these settings make of a field in units of `scale`, RGB.
    ///
    /// # Errors
    /// [`Error::Usage`], which names the number that is too large.
    pub fn check(&self, scale: [f64; 3]) -> Result<()> {
        let single = |value: f64| value.abs() <= f64::from(f32::MAX);
        if !single(self.strength) {
            let Self { strength, .. } = self;
            return Err(Error::Usage(format!(
                "a strength of {strength:e} is beyond {:.1e}, what 32-bit floats hold",
                f32::MAX
            )));
        }
        let unit = match self.normalize {
            Normalize::None => scale.into_iter().fold(0.0, f64::max),
            Normalize::Clamp | Normalize::Minmax => 1.0,
        };
        let reached = self.strength.abs() * unit;
        if reached.is_nan() || reached > BRIGHTEST {
            return Err(Error::Usage(format!(
                "a strength of {:e} makes glare of {reached:.1e}, and {BRIGHTEST:e} is the brightest that vglare renders",
                self.strength
            )));
        }
        match self
            .constant
            .into_iter()
            .chain(self.light_gain)
            .chain(self.overlay.into_iter().flatten())
            .find(|&value| !single(value))
        {
            Some(value) => Err(Error::Usage(format!("a factor of {value:e} is beyond what 32-bit floats hold"))),
            None => Ok(()),
        }
    }

    /// Whether a mean of the picture's pixels is the photo's mean and what the field's mean becomes: a view of the
    /// picture made smaller needs no picture then.
    pub fn is_affine(&self) -> bool {
        // All fields by name: one that is added has to say what it does to means.
        let Self {
            strength: _,
            normalize,
            range: _,
            constant: _,
            light_gain,
            threshold: _,
            knee: _,
            emission: _,
            overlay: _,
        } = *self;
        normalize != Normalize::Clamp && light_gain == [1.0; 3]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_f32_does_not_hold_is_refused_by_its_number() {
        let with = |strength, normalize| Settings { strength, normalize, ..Settings::default() };
        let refused =
            |strength, normalize, scale| with(strength, normalize).check([scale, 1.0, 0.0]).map_err(|e| e.to_string());
        assert_eq!(refused(1e37, Normalize::None, 1.0), Ok(()));
        assert_eq!(refused(1e30, Normalize::Minmax, 1e30), Ok(()), "stretched values have no unit");
        for (strength, scale, said) in [
            (1e39, 1.0, "a strength of 1e39 is beyond 3.4e38"),
            (1e20, 1e20, "a strength of 1e20 makes glare of 1.0e40"),
            (f64::NAN, 1.0, "a strength of NaN"),
        ] {
            let reason = refused(strength, Normalize::None, scale).unwrap_err();
            assert!(reason.contains(said), "{reason}");
        }
        assert!(refused(2e37, Normalize::Clamp, 1.0).is_err());
        let constant = Settings { constant: [0.0, 1e39, 0.0], ..Settings::default() };
        assert!(constant.check([1.0; 3]).is_err());
    }
}
