//! The colour space that a display's picture was in, in which it is written again: its curves and its matrix the other
//! way round, and the profile or the code points that name it.

use std::borrow::Cow;

use glam::Mat3A;

use super::decode::{Encoding, Shaper};
use super::display::Code;
use super::icc::{self, Way};
use super::{Format, Photo};

/// How far light may be off by rounding, as a share of the pixel's brightest channel: from f32 to Rec. 709 and back.
const ROUNDING: f32 = 4e-7;

/// The space of a picture for displays, other than sRGB as it is written by default.
#[derive(Debug)]
pub(super) struct Native {
    shaper: Shaper,
    /// The file's own profile, or one made of the shaper; none of curves that a profile of curves cannot hold.
    profile: Option<Vec<u8>>,
    /// Whether that profile is one for grey.
    grey: bool,
    /// PNG's cICP: colour primaries and transfer function.
    pub code_points: Option<[u8; 2]>,
}

impl Native {
    /// What codes of an encoding were in; none where that is sRGB without a word, or has no way back.
    pub fn of(encoding: &Encoding) -> Option<Self> {
        let (shaper, profile) = match encoding {
            Encoding::Curves(shaper) if shaper.is_srgb() => return None,
            Encoding::Curves(shaper) => (shaper, icc::profile_of(shaper)),
            Encoding::Icc(profile) => match profile.way() {
                Way::Shaper(shaper) => (shaper, Some(profile.bytes().to_vec())),
                Way::Tables(_) => return None,
            },
        };
        let grey = profile.as_deref().is_some_and(icc::is_grey);
        shaper.has_inverse().then(|| Self { shaper: (**shaper).clone(), profile, grey, code_points: None })
    }

    /// The ICC profile of a picture that is grey or of three colours, where there is one.
    pub fn profile(&self, grey: bool) -> Option<Cow<'_, [u8]>> {
        match &self.profile {
            // Glare has coloured it.
            Some(_) if self.grey && !grey => icc::profile_of(&self.shaper).map(Cow::Owned),
            profile => profile.as_deref().map(Cow::Borrowed),
        }
    }
}

/// The space in which a file of this format is written, if not sRGB.
pub(super) fn of(photo: &Photo, format: Format) -> Option<&Native> {
    let native = photo.source.native.as_deref().filter(|_| photo.source.display_referred)?;
    (native.profile.is_some() || format == Format::Png && native.code_points.is_some()).then_some(native)
}

/// From light of Rec. 709 to the codes of a space.
pub(super) struct Codes<'a> {
    shaper: &'a Shaper,
    from_rec709: Mat3A,
    /// The light of every code of each channel.
    lights: [Vec<f32>; 3],
}

impl<'a> Codes<'a> {
    pub fn new<T: Code>(native: &'a Native) -> Self {
        let shaper = &native.shaper;
        let lights = shaper.curves.each_ref().map(|curve| {
            let light = |code: u32| curve.light(f64::from(code) / f64::from(T::MAX)) as f32;
            (0..=T::MAX as u32).map(light).collect()
        });
        let from_rec709 = shaper.matrix.map_or(Mat3A::IDENTITY, |matrix| Mat3A::from(matrix.inverse().as_mat3()));
        Self { shaper, from_rec709, lights }
    }

    /// Places between the codes, 0..=MAX. Light that is a code's but for rounding is at that code.
    pub fn places(&self, rec709: [f32; 3]) -> [f32; 3] {
        let light = (self.from_rec709 * glam::Vec3A::from(rec709)).to_array();
        let rounding = ROUNDING * rec709.into_iter().fold(0.0, |most, c| c.abs().max(most));
        std::array::from_fn(|channel| {
            let lights = &self.lights[channel];
            let most = lights.len() - 1;
            let light = light[channel].clamp(lights[0], lights[most]);
            let place = self.shaper.curves[channel].encoded(light.into()) as f32 * most as f32;
            let near = place.round().clamp(0.0, most as f32);
            let known = lights[near as usize];
            if (known - light).abs() <= rounding.max(f32::EPSILON * known.abs()) { near } else { place }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::display::{self, Look};
    use super::super::transfer::Curve;
    use super::super::{Primaries, ToneMap};
    use super::*;

    const PLAIN: Look = Look { gain: 1.0, tone_map: ToneMap::None };

    fn spaces() -> Vec<(&'static str, Encoding)> {
        vec![
            ("Display P3", Encoding::new(Curve::Srgb, Some(Primaries::P3_D65))),
            ("Adobe RGB", Encoding::new(Curve::Power(563.0 / 256.0), Some(Primaries::ADOBE_RGB))),
            ("ProPhoto", Encoding::new(Curve::Power(1.8), Some(Primaries::PROPHOTO))),
            ("Rec. 2020", Encoding::new(Curve::Rec709, Some(Primaries::REC2020))),
            ("gamma 2.2", Encoding::new(Curve::Power(2.2), None)),
            ("a table", Encoding::new(Curve::Table([0.0, 0.01, 0.2, 1.0].into()), Some(Primaries::P3_D65))),
            ("PQ", Encoding::new(Curve::Pq, Some(Primaries::REC2020))),
        ]
    }

    #[test]
    fn every_8_bit_code_survives_in_every_space() {
        let codes: Vec<[u8; 3]> = (0..256 * 64_u32)
            .map(|i| [i % 256, (i * 37 + i / 256) % 256, (255 - i % 256) * (i / 256 % 2)].map(|code| code as u8))
            .collect();
        for (name, encoding) in spaces() {
            let raster = super::super::decode::Raster {
                width: 256,
                height: 64,
                channels: 3,
                samples: codes.as_flattened().to_vec(),
                planar: false,
            };
            let turn = image::metadata::Orientation::NoTransforms;
            let mut photo = raster.into_photo(Format::Png, super::super::Alpha::None, &encoding, turn).unwrap();
            let native = photo.source.native.take().expect(name);
            let got = display::encode::<u8>(&photo, PLAIN, false, Some(&native)).unwrap();
            let wrong = got.data.as_chunks::<3>().0.iter().zip(&codes).filter(|(a, b)| a != b).collect::<Vec<_>>();
            assert!(wrong.is_empty(), "{name}: {} of {}, as {:?}", wrong.len(), codes.len(), wrong[0]);
        }
    }

    #[test]
    fn what_is_written_by_default_has_no_space_of_its_own() {
        assert!(Native::of(&Encoding::new(Curve::Srgb, None)).is_none());
        // A curve that falls tells two codes for one light.
        assert!(Native::of(&Encoding::new(Curve::Table([0.0, 0.6, 0.5, 1.0].into()), None)).is_none());
    }

    #[test]
    fn a_profile_that_was_made_says_what_the_shaper_does() {
        for (name, encoding) in spaces() {
            let native = Native::of(&encoding).expect(name);
            let Some(profile) = native.profile(false) else {
                assert_eq!(name, "PQ", "no profile of curves holds it");
                continue;
            };
            let (mut notes, options) = (Vec::new(), super::super::ReadOptions::default());
            let again = icc::encoding(&profile, false, Curve::Srgb, &options, &mut notes);
            assert!(notes.is_empty(), "{name}: {notes:?}");
            let again = Native::of(&again).expect(name).shaper;
            for k in 0..=100 {
                let v = f64::from(k) / 100.0;
                let [got, want] = [&again, &native.shaper].map(|shaper| shaper.curves[1].light(v));
                assert!((got - want).abs() < 2e-4, "{name}: {got} for {want} at {v}");
            }
            let [got, want] = [&again, &native.shaper].map(|shaper| shaper.matrix.unwrap_or_default());
            assert!(got.abs_diff_eq(want, 1e-3), "{name}: {got} for {want}");
        }
    }
}
