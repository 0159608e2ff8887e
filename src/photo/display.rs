//! From linear light to the integer samples of PNG, JPEG and TIFF.
//!
//! \[IGN\] Jorge Jimenez, "Next generation post processing in Call of Duty: Advanced Warfare", SIGGRAPH 2014:
//! interleaved gradient noise.

use glam::{Mat3A, Vec3A};
use rayon::prelude::*;

use super::native::{Codes, Native};
use super::tone::sound;
use super::transfer::srgb_encode;
use super::{Alpha, Photo, Reason, ToneMap, zeroed};

/// How light becomes what a display shows.
#[derive(Debug, Clone, Copy)]
pub(super) struct Look {
    /// Multiplies the light first; 2 to the exposure in stops.
    pub gain: f32,
    /// Applied next.
    pub tone_map: ToneMap,
}

impl Look {
    /// Where light of Rec. 709 lies between the codes 0..=MAX of a space, or of sRGB.
    fn encoded<T: Code>(self, light: [f32; 3], codes: Option<&Codes<'_>>) -> [f32; 3] {
        let light = light.map(|c| c * self.gain);
        match codes {
            // Without a tone map, what is beyond sRGB stays where the space holds it.
            Some(codes) if self.tone_map == ToneMap::None => codes.places(sound(light)),
            Some(codes) => codes.places(self.tone_map.apply(light)),
            None => self.tone_map.apply(light).map(|c| srgb_encode(c) * T::MAX),
        }
    }
}

/// The samples of a picture, ready for an encoder.
pub(super) struct Samples<T> {
    /// 1 grey, 2 grey and alpha, 3 RGB, 4 RGBA.
    pub channels: usize,
    /// Pixel by pixel, row by row from the top.
    pub data: Vec<T>,
}

/// An integer sample.
pub(super) trait Code: bytemuck::Pod + Send + Sync {
    /// The code of full light.
    const MAX: f32;
    /// Half the width of the dither, in codes.
    const DITHER: f32;
    /// The code of a number in 0..=MAX.
    fn new(value: f32) -> Self;
    /// The code as a number.
    fn number(self) -> f32;
}

impl Code for u8 {
    const MAX: f32 = 255.0;
    // Inside ±0.5, with room for the rounding of the transfer function: light that sits on a code keeps it.
    const DITHER: f32 = 0.48;

    fn new(value: f32) -> Self {
        value as Self
    }

    fn number(self) -> f32 {
        self.into()
    }
}

impl Code for u16 {
    const MAX: f32 = 65535.0;
    const DITHER: f32 = 0.0;

    fn new(value: f32) -> Self {
        value as Self
    }

    fn number(self) -> f32 {
        self.into()
    }
}

/// Whether the photo was grey and still is.
pub(super) fn is_grey(photo: &Photo) -> bool {
    let same = |p: &[f32; 4]| p[0].to_bits() == p[1].to_bits() && p[0].to_bits() == p[2].to_bits();
    photo.source.grey && photo.pixels.par_iter().all(same)
}

/// The samples of the whole picture, in the `native` space or in sRGB; alpha goes along where `alpha` says so.
pub(super) fn encode<T: Code>(
    photo: &Photo,
    look: Look,
    alpha: bool,
    native: Option<&Native>,
) -> Result<Samples<T>, Reason> {
    let codes = native.map(Codes::new::<T>);
    let grey = is_grey(photo);
    let channels = if grey { 1 } else { 3 } + usize::from(alpha);
    let width = photo.width() as usize;
    let mut data = zeroed::<T>(width * photo.height() as usize * channels)?;
    let gamut = photo.to_rec709().map_or(Mat3A::IDENTITY, |m| Mat3A::from(m.as_mat3()));
    let same_gamut = photo.to_rec709().is_none();
    // Integers of associated alpha are codes of the colour itself, times alpha: see `tiff::light`.
    let associated = alpha && photo.source.alpha == Alpha::Premultiplied;
    data.par_chunks_exact_mut(width * channels).enumerate().for_each(|(y, row)| {
        let pixels = photo.picture_row(y as u32);
        for (x, (out, &[r, g, b, a])) in row.chunks_exact_mut(channels).zip(pixels.iter()).enumerate() {
            let light = if same_gamut { [r, g, b] } else { (gamut * Vec3A::new(r, g, b)).to_array() };
            let covered = T::new((a.max(0.0) * T::MAX).round().min(T::MAX));
            let cover = if associated { a.clamp(0.0, 1.0) } else { 1.0 };
            let light = light.map(|c| if cover > 0.0 { c / cover } else { 0.0 });
            let top = if associated { covered.number() } else { T::MAX };
            let encoded = look.encoded::<T>(light, codes.as_ref());
            // The same noise for all three colours: grey stays grey.
            let noise = T::DITHER * (2.0 * gradient_noise(x as f32, y as f32) - 1.0);
            let code = |c: f32| T::new((c * (top / T::MAX) + noise).round().clamp(0.0, top));
            out[0] = code(encoded[0]);
            if !grey {
                (out[1], out[2]) = (code(encoded[1]), code(encoded[2]));
            }
            if alpha {
                out[channels - 1] = covered;
            }
        }
    });
    Ok(Samples { channels, data })
}

/// Whether the photo's alpha is one that a format of straight alpha can hold.
pub(super) fn has_straight_alpha(photo: &Photo) -> bool {
    photo.source.alpha == Alpha::Straight
}

/// \[IGN\]: noise in 0..1 without large lumps.
fn gradient_noise(x: f32, y: f32) -> f32 {
    (52.982_918 * (0.067_110_56 * x + 0.005_837_15 * y).fract()).fract()
}

#[cfg(test)]
mod tests {
    use super::super::transfer::Curve;
    use super::*;

    const PLAIN: Look = Look { gain: 1.0, tone_map: ToneMap::None };

    #[test]
    fn every_8_bit_code_survives_wherever_it_stands() {
        let light = |c: usize| Curve::Srgb.light(c as f64 / 255.0) as f32;
        let codes = (0..256 * 64).map(|i| (i % 256 + i / 256 * 37) % 256).collect::<Vec<_>>();
        let pixels = codes.iter().map(|&c| [light(c), light(255 - c), light(c / 2), 1.0]).collect();
        let got = encode::<u8>(&Photo::new(256, 64, pixels), PLAIN, false, None).unwrap();
        for (&c, got) in codes.iter().zip(got.data.chunks_exact(3)) {
            assert_eq!(got, [c as u8, 255 - c as u8, c as u8 / 2]);
        }
    }

    #[test]
    fn codes_of_associated_alpha_survive() {
        let (mut want, mut pixels) = (Vec::new(), Vec::new());
        for alpha in 0..256_usize {
            for code in (0..=alpha).step_by(5) {
                // The colour is the code's share of alpha.
                let colour = |code: usize| if alpha == 0 { 0.0 } else { Curve::Srgb.light(code as f64 / alpha as f64) };
                let light = [code, alpha - code, code / 2].map(|code| (colour(code) * alpha as f64 / 255.0) as f32);
                want.push([code, alpha - code, code / 2, alpha].map(|code| code as u8));
                pixels.push([light[0], light[1], light[2], alpha as f32 / 255.0]);
            }
        }
        // Glare upon what covers nothing is not seen, and nowhere more than is covered.
        want.extend([[0, 0, 0, 0], [128, 128, 128, 128]]);
        pixels.extend([[0.7, 0.7, 0.7, 0.0], [9.0, 9.0, 9.0, 128.0 / 255.0]]);
        let mut photo = Photo::new(pixels.len() as u32, 1, pixels);
        photo.source.alpha = Alpha::Premultiplied;
        let got = encode::<u8>(&photo, PLAIN, true, None).unwrap();
        assert!(got.data.chunks_exact(4).eq(want), "a code changed");
    }

    #[test]
    fn dither_keeps_the_mean_of_light_between_two_codes() {
        let between = (Curve::Srgb.light(100.0 / 255.0) * 0.7 + Curve::Srgb.light(101.0 / 255.0) * 0.3) as f32;
        let got = encode::<u8>(&Photo::new(200, 200, vec![[between; 4]; 40_000]), PLAIN, false, None).unwrap();
        let mean = got.data.iter().map(|&c| f64::from(c)).sum::<f64>() / got.data.len() as f64;
        assert!(got.data.iter().all(|c| (100..=101).contains(c)));
        assert!((mean - 100.3).abs() < 0.03, "{mean}");
    }

    #[test]
    fn exposure_is_in_stops_and_bad_pixels_have_a_place() {
        let bad = [f32::NAN, f32::NEG_INFINITY, f32::INFINITY, f32::NAN];
        let photo = Photo::new(2, 1, vec![[0.25, 0.25, 0.5, 1.0], bad]);
        let got = encode::<u16>(&photo, Look { gain: 2.0, tone_map: ToneMap::None }, true, None).unwrap();
        let half = (srgb_encode(0.5) * 65535.0).round() as u16;
        assert_eq!(got.data, [half, half, 65535, 65535, 0, 0, 65535, 0]);
    }
}
