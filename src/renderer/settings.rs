//! What a person sets about the picture.

use crate::choices::Normalize;
use crate::scene::Emission;

/// What a person sets about the picture; the field does not depend on it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// What the glare is multiplied by; 0 leaves the photo as it is.
    pub strength: f64,
    /// How the field's values become glare.
    pub normalize: Normalize,
    /// What is subtracted from the field's values first, RGB: 0, or the constant term of its series, to see the others.
    /// Stretched values stay as they are, because their range moves with them.
    pub constant: [f64; 3],
    /// What a light keeps of itself, RGB; 1 unless light is taken from the photo.
    pub light_gain: [f64; 3],
    /// The luminance from which on a pixel is a light.
    pub threshold: f64,
    /// How a pixel of the photo gives light.
    pub emission: Emission,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            strength: 1.0,
            normalize: Normalize::None,
            constant: [0.0; 3],
            light_gain: [1.0; 3],
            threshold: f64::INFINITY,
            emission: [0.2126, 0.7152, 0.0722].into(),
        }
    }
}

impl Settings {
    /// Whether a mean of the picture's pixels is the photo's mean and what the field's mean becomes: a view of the
    /// picture made smaller needs no picture then.
    pub fn is_affine(&self) -> bool {
        self.normalize != Normalize::Clamp && self.light_gain == [1.0; 3]
    }
}
