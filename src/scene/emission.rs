//! How much light a pixel of a photo gives: what everything goes by that tells light from the rest.

use std::borrow::Cow;

use rayon::prelude::*;

use crate::choices::LightBy;
use crate::photo::{Alpha, Photo};

/// How the numbers of a pixel become its brightness. `shared/emission.glsl` has the same.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Emission {
    /// The weights of linear R, G and B in luminance (Y of CIE 1931). They add up to 1, and one may be negative where a
    /// primary is no colour that can be seen, as the blue of ACES2065-1.
    pub weights: [f32; 3],
    /// Whether colour is not multiplied by alpha: then a pixel gives alpha's share of its colour, and nothing where alpha
    /// is 0. Otherwise alpha is not looked at: a flame may well have none.
    pub straight: bool,
    /// What a pixel's brightness is.
    pub by: LightBy,
}

impl Emission {
    /// That of a photo, by luminance.
    pub fn of(photo: &Photo) -> Self {
        Self { straight: photo.source.alpha == Alpha::Straight, ..photo.luminance_weights().into() }
    }

    /// The same by another brightness.
    #[must_use]
    pub fn by(self, by: LightBy) -> Self {
        Self { by, ..self }
    }

    /// The brightness of what a pixel gives, 0 or more and finite: what light is told by, and weighted by.
    ///
    /// Negative channels count as 0; a pixel with a channel that is not finite gives none, and neither does one whose luminance is not
    /// above 0: what no eye sees, as the blue of ACES2065-1 alone, is no lamp.
    #[inline]
    pub fn brightness(&self, pixel: &[f32; 4]) -> f32 {
        match self.by {
            LightBy::Luminance => self.luminance(pixel),
            LightBy::Brightest => {
                let [r, g, b, _] = *pixel;
                // A device may take what is below the smallest normal number for nothing, before a comparison as well as after.
                let seen = self.seen(pixel) >= f32::MIN_POSITIVE;
                let given = if seen { r.max(g).max(b) * self.share(pixel) } else { 0.0 };
                if given >= f32::MIN_POSITIVE { given } else { 0.0 }
            }
        }
    }

    /// Linear luminance of what a pixel gives, 0 or more and finite.
    ///
    /// Negative channels count as 0, and so does a sum that is negative by a negative weight; a pixel with a channel that
    /// is not finite gives none.
    #[inline]
    pub fn luminance(&self, pixel: &[f32; 4]) -> f32 {
        let sum = self.seen(pixel);
        // No number, where weights of both signs made infinities of large channels, is not above 0.
        let given = if sum > 0.0 { sum.min(f32::MAX) * self.share(pixel) } else { 0.0 };
        // A device may take what is below the smallest normal number for nothing.
        if given >= f32::MIN_POSITIVE { given } else { 0.0 }
    }

    /// The weighted sum of what is not negative of a colour's channels; 0 where one of them is not finite.
    #[inline]
    fn seen(&self, &[r, g, b, _]: &[f32; 4]) -> f32 {
        let sum = self.weights[0] * r.max(0.0) + self.weights[1] * g.max(0.0) + self.weights[2] * b.max(0.0);
        if r.is_finite() && g.is_finite() && b.is_finite() { sum } else { 0.0 }
    }

    /// Pixels by what they give of their colour.
    pub fn given<'a>(&self, pixels: &'a [[f32; 4]]) -> Cow<'a, [[f32; 4]]> {
        if !self.straight {
            return Cow::Borrowed(pixels);
        }
        let given = |&pixel: &[f32; 4]| {
            let share = self.share(&pixel);
            pixel.map(|value| value * share)
        };
        pixels.par_iter().map(given).collect::<Vec<_>>().into()
    }

    /// The share of a pixel's colour that it gives, 0 to 1.
    #[inline]
    pub fn share(&self, &[_, _, _, alpha]: &[f32; 4]) -> f32 {
        match self.straight {
            true if alpha.is_finite() => alpha.clamp(0.0, 1.0),
            true => 0.0,
            false => 1.0,
        }
    }
}

/// Whether a pixel that gives a brightness is light from a threshold on; black never is. `shared/emission.glsl` has the
/// same, and nothing else decides.
#[inline]
pub fn is_light(brightness: f32, threshold: f32) -> bool {
    brightness >= threshold && brightness > 0.0
}

/// Of opaque or premultiplied pixels, by luminance.
impl From<[f64; 3]> for Emission {
    fn from(weights: [f64; 3]) -> Self {
        Self { weights: weights.map(|weight| weight as f32), straight: false, by: LightBy::Luminance }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const REC709: Emission = Emission { weights: [0.2126, 0.7152, 0.0722], straight: false, by: LightBy::Luminance };

    #[test]
    fn pixels_that_are_not_finite_have_no_luminance_and_negative_channels_count_as_0() {
        for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
            assert_eq!(REC709.luminance(&[9.0, bad, 9.0, 1.0]), 0.0);
        }
        assert_eq!(REC709.luminance(&[-5.0, 1.0, -5.0, f32::NAN]), 0.7152);
        let halves = Emission { weights: [0.5; 3], ..REC709 };
        assert_eq!(halves.luminance(&[f32::MAX; 4]), f32::MAX);
    }

    #[test]
    fn a_negative_sum_counts_as_0() {
        // Y of ACES2065-1 (SMPTE ST 2065-1, annex A): its blue is darker than black.
        let ap0 = Emission { weights: [0.343_966_46, 0.728_166_1, -0.072_132_55], ..REC709 };
        assert_eq!(ap0.luminance(&[0.0, 0.0, 1.0, 1.0]).to_bits(), 0);
        assert_eq!(ap0.luminance(&[0.01, 0.001, 0.3, 1.0]), 0.0);
        // Nor is it bright in any other way.
        let brightest = ap0.by(LightBy::Brightest);
        assert_eq!([[0.0, 0.0, 1.0, 1.0], [0.01, 0.001, 0.3, 1.0]].map(|pixel| brightest.brightness(&pixel)), [0.0; 2]);
        assert_eq!(brightest.brightness(&[0.1, 0.001, 0.3, 1.0]), 0.3);
        // A sum that a device may have flushed to 0, of a channel that it has not.
        assert_eq!(REC709.by(LightBy::Brightest).brightness(&[0.0, f32::MIN_POSITIVE, 0.0, 1.0]), 0.0);
        assert!(ap0.luminance(&[0.1, 0.001, 0.3, 1.0]) > 0.0);
        let wide = Emission { weights: [4.0, -5.0, 2.0], ..REC709 };
        assert_eq!(wide.luminance(&[f32::MAX; 4]), 0.0);
    }

    #[test]
    fn the_brightest_channel_is_the_same_for_a_lamp_of_any_colour() {
        let by = REC709.by(LightBy::Brightest);
        for lamp in [[9.0, 1.0, 0.0], [0.0, 9.0, -5.0], [2.0, 1.0, 9.0], [9.0; 3]] {
            assert_eq!(by.brightness(&[lamp[0], lamp[1], lamp[2], 0.0]), 9.0);
        }
        assert_eq!(REC709.brightness(&[0.0, 1.0, 0.0, 1.0]), 0.7152);
        for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
            assert_eq!(by.brightness(&[9.0, bad, 9.0, 1.0]), 0.0);
        }
        assert_eq!((by.brightness(&[-1.0, -2.0, -0.0, 1.0]), by.brightness(&[1e-40; 4])), (0.0, 0.0));
        let straight = Emission { straight: true, ..by };
        assert_eq!(straight.brightness(&[8.0, 2.0, 1.0, 0.25]), 2.0);
        assert_eq!(by.brightness(&[f32::MAX; 4]), f32::MAX);
    }

    #[test]
    fn straight_colours_give_alphas_share() {
        let straight = Emission { straight: true, ..REC709 };
        for (alpha, share) in [(0.0, 0.0), (0.5, 0.5), (1.0, 1.0), (-3.0, 0.0), (7.0, 1.0), (f32::NAN, 0.0)] {
            assert_eq!(straight.luminance(&[2.0, 2.0, 2.0, alpha]), 2.0 * share, "{alpha}");
        }
        assert_eq!(REC709.luminance(&[2.0, 2.0, 2.0, 0.0]), 2.0, "a flame may be premultiplied by 0");
    }
}
