//! What a photo's numbers are in cd/m².
//!
//! | where it is from | what a unit of white, (1, 1, 1), is |
//! | --- | --- |
//! | who reads it | what they say |
//! | OpenEXR | `whiteLuminance`, a standard attribute: cd/m² of white |
//! | Radiance, RGBE | \[FMT\] numbers over all EXPOSURE and COLORCORR are W/(sr m²) of white light: 179 lm/W, as Radiance has it |
//! | Radiance, XYZE | the same, but Y is in lm/(sr m²) already: ra_xyze(1) of Radiance |
//!
//! A Radiance picture means that by its format, but many programs write the format with numbers of any unit. One that names an
//! EXPOSURE is taken at its word, any other where that is asked for: [`WhiteLuminance::File`].
//!
//! \[FMT\] Greg Ward, "Radiance File Formats": radiance-online.org, refer/filefmts.pdf.

use serde::Serialize;

use super::{Photo, Reason};

/// The luminous efficacy of white light in Radiance, `WHTEFFICACY` of its color.h, in lm/W.
pub(super) const RADIANCE_EFFICACY: f64 = 179.0;

/// What a photo's white is to be in cd/m², whatever else is known of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum WhiteLuminance {
    /// So many cd/m², above 0 and finite.
    Given(f64),
    /// What the file says, a Radiance picture by its format, too; a file that says nothing is refused.
    File,
}

/// What turns a photo's linear numbers into luminance, and where that is from.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LuminanceScale {
    /// cd/m² of (1, 1, 1).
    pub cd_m2_per_unit: f64,
    /// Where it is from, in words.
    pub from: String,
    /// cd/m² of (1, 0, 0), (0, 1, 0) and (0, 0, 1); these add up to that of white.
    #[serde(skip)]
    pub weights: [f64; 3],
}

impl LuminanceScale {
    /// The luminance of a pixel in cd/m².
    pub fn of(&self, &[red, green, blue, _]: &[f32; 4]) -> f64 {
        self.of_colour([red, green, blue].map(f64::from))
    }

    /// The luminance of a colour in cd/m².
    pub fn of_colour(&self, rgb: [f64; 3]) -> f64 {
        self.weights.iter().zip(rgb).map(|(weight, part)| weight * part).sum()
    }
}

/// What a file says of its numbers.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Said {
    /// cd/m² of a unit of white, as each channel has it: they differ where a Radiance picture's colours were corrected.
    pub channels: [f64; 3],
    /// By what the file says it.
    pub from: String,
    /// Whether it says so itself, and not by its format alone.
    pub explicit: bool,
}

impl Said {
    /// By one number for all channels.
    pub(super) fn of_white(cd_m2: f64, from: String) -> Self {
        Self { channels: [cd_m2; 3], from, explicit: true }
    }

    /// cd/m² of white, where that is all that there is to say.
    pub(super) fn white(&self) -> Option<f64> {
        let [red, green, blue] = self.channels;
        (red == green && green == blue).then_some(red)
    }

    fn is_sound(&self) -> bool {
        self.channels.iter().all(|channel| channel.is_finite() && *channel > 0.0)
    }
}

/// Settles what is known of a photo that was just read: by what is asked for, or else by what its file said.
///
/// # Errors
/// Where its file is asked for and says nothing, or nothing that makes sense; the latter is a note where nobody asked.
pub(super) fn settle(photo: &mut Photo, asked: Option<WhiteLuminance>) -> Result<(), Reason> {
    let said = photo.source.luminance.take();
    photo.source.luminance = match (asked, said) {
        (Some(WhiteLuminance::Given(cd_m2)), _) => Some(Said::of_white(cd_m2, "as given".to_owned())),
        (Some(WhiteLuminance::File), None) => {
            return Err(
                "it does not say what its numbers are in cd/m²: OpenEXR does by whiteLuminance, and Radiance HDR"
                    .into(),
            );
        }
        (Some(WhiteLuminance::File), Some(said)) if !said.is_sound() => {
            return Err(format!("{} makes no luminance of its numbers", said.from).into());
        }
        (None, Some(said)) if !said.is_sound() => {
            photo.source.notes.push(format!("{} makes no luminance of its numbers: none is told", said.from));
            None
        }
        (None, said) => said.filter(|said| said.explicit),
        (Some(WhiteLuminance::File), said) => said,
    };
    Ok(())
}

impl Photo {
    /// What its numbers are in cd/m², where that is known: by its primaries' own shares in luminance.
    pub fn luminance_scale(&self) -> Option<LuminanceScale> {
        let said = self.source.luminance.as_ref()?;
        let shares = self.luminance_weights();
        let weights = [0, 1, 2].map(|c| said.channels[c] * shares[c]);
        let cd_m2_per_unit = said.white().unwrap_or_else(|| weights.iter().sum());
        Some(LuminanceScale { cd_m2_per_unit, from: said.from.clone(), weights })
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::super::{Primaries, ReadOptions, WriteOptions, read, read_with, write};
    use super::*;

    fn settled(said: Option<Said>, asked: Option<WhiteLuminance>) -> Result<Photo, String> {
        let mut photo = Photo::new(1, 1, vec![[1.0, 2.0, 4.0, 1.0]]);
        photo.source.luminance = said;
        settle(&mut photo, asked).map_err(|reason| reason.to_string())?;
        Ok(photo)
    }

    #[test]
    fn what_is_asked_for_wins_over_what_a_file_says() {
        let said = || Some(Said::of_white(50.0, "its whiteLuminance of 50".into()));
        let implied = || said().map(|said| Said { explicit: false, ..said });
        let white = |said, asked| settled(said, asked).unwrap().luminance_scale().map(|scale| scale.cd_m2_per_unit);
        let given = Some(WhiteLuminance::Given(250.0));
        let file = Some(WhiteLuminance::File);
        assert_eq!([white(None, None), white(None, given)], [None, Some(250.0)]);
        assert_eq!(
            [white(said(), None), white(said(), given), white(said(), file)],
            [Some(50.0), Some(250.0), Some(50.0)]
        );
        assert_eq!([white(implied(), None), white(implied(), file)], [None, Some(50.0)]);
        assert!(settled(None, file).unwrap_err().contains("whiteLuminance"));
    }

    #[test]
    fn what_makes_no_luminance_is_told_and_never_used() {
        for white in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            let said = || Some(Said::of_white(white, format!("its whiteLuminance of {white}")));
            let photo = settled(said(), None).unwrap();
            assert_eq!(photo.luminance_scale(), None, "{white}");
            assert!(photo.source.notes[0].contains(&format!("whiteLuminance of {white}")), "{:?}", photo.source.notes);
            assert!(settled(said(), Some(WhiteLuminance::File)).is_err(), "{white}");
            let given = settled(said(), Some(WhiteLuminance::Given(2.0))).unwrap();
            assert!(given.source.notes.is_empty() && given.luminance_scale().is_some());
        }
    }

    /// An OpenEXR file whose part says that.
    fn file_of_white(path: &Path, white: Option<f32>) {
        use exr::prelude::{Encoding, Image, Layer, LayerAttributes, SpecificChannels, WritableImage as _};
        let attributes = LayerAttributes { white_luminance: white, ..LayerAttributes::default() };
        let channels = SpecificChannels::rgb(|_| (1.0_f32, 2.0_f32, 4.0_f32));
        let layer = Layer::new((2, 1), attributes, Encoding::FAST_LOSSLESS, channels);
        Image::from_layer(layer).write().to_file(path).unwrap();
    }

    #[test]
    fn openexr_says_what_white_is_and_keeps_it() {
        let folder = tempfile::tempdir().unwrap();
        let [from, to] = ["from.exr", "to.exr"].map(|name| folder.path().join(name));
        let overwrite = WriteOptions { overwrite: true, ..WriteOptions::default() };
        let white = |photo: &Photo| photo.luminance_scale().map(|scale| scale.cd_m2_per_unit);
        let given =
            |cd_m2| ReadOptions { white_luminance: Some(WhiteLuminance::Given(cd_m2)), ..ReadOptions::default() };
        for (said, options, wanted) in [
            (None, ReadOptions::default(), None),
            (Some(80.5), ReadOptions::default(), Some(80.5)),
            (Some(80.5), given(250.0), Some(250.0)),
            (None, given(250.0), Some(250.0)),
        ] {
            file_of_white(&from, said);
            let photo = read_with(&from, &options).unwrap();
            assert_eq!(white(&photo), wanted);
            // As it is, with other pixels, beside it, and without a file's header of its own.
            let mut brighter = photo.clone();
            brighter.pixels.iter_mut().for_each(|pixel| pixel[1] *= 2.0);
            let mut plain = Photo::new(2, 1, photo.pixels.clone());
            plain.source.luminance = photo.source.luminance.clone();
            for photo in [photo.clone(), brighter, photo.companion(photo.pixels.clone()), plain] {
                write(&to, &photo, &overwrite).unwrap();
                assert_eq!(white(&read(&to).unwrap()), wanted);
            }
        }
        for said in [0.0, -80.0, f32::NAN, f32::INFINITY] {
            file_of_white(&from, Some(said));
            let photo = read(&from).unwrap();
            assert!(white(&photo).is_none() && photo.source.notes[0].contains("whiteLuminance"), "{said}");
            let file = ReadOptions { white_luminance: Some(WhiteLuminance::File), ..ReadOptions::default() };
            let refused = read_with(&from, &file).unwrap_err().to_string();
            assert!(refused.contains("from.exr") && refused.contains("whiteLuminance"), "{refused}");
        }
    }

    /// 100 cd/m² of white: 100 (0.2126 · 1 + 0.7152 · 2 + 0.0722 · 4), and of a photo of XYZ 100 Y.
    #[test]
    fn luminance_is_by_the_weights_of_the_primaries() {
        let mut photo = settled(None, Some(WhiteLuminance::Given(100.0))).unwrap();
        let of = |photo: &Photo| photo.luminance_scale().unwrap().of(&photo.pixels[0]);
        assert!((of(&photo) - 193.18).abs() < 1e-9, "{}", of(&photo));
        photo.source.primaries = Some(Primaries::XYZ);
        assert!((of(&photo) - 200.0).abs() < 1e-9, "{}", of(&photo));
    }
}
