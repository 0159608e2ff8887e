//! What a JPEG file says about its colours and its orientation: ICC profile, Exif, XMP.
//!
//! \[ICC\] ICC.1:2022 annex B.4: a profile in pieces. \[DCF\] JEITA CP-3461B (DCF 2.0), section 5.3: Adobe RGB by
//! "R03". \[EXIF\] CIPA DC-008, 4.6.5: ColorSpace. \[XMP\] XMP specification part 3, 1.1.3.

use exif::{Context, Exif, In, Reader, Tag, Value};
use image::metadata::Orientation;

use super::super::camera::Camera;
use super::super::decode::Encoding;
use super::super::icc;
use super::super::transfer::Curve;
use super::super::{Primaries, ReadOptions};
use super::walk::Walk;

/// Adobe RGB (1998), 4.3.1.2: 2 51/256.
const ADOBE_GAMMA: f64 = 563.0 / 256.0;

const APP1: u8 = 0xe1;
const APP2: u8 = 0xe2;

/// What a file's Exif says of how to show it.
pub(super) struct Shown {
    pub orientation: Orientation,
    /// What the picture was taken with, as it lies once it is upright.
    pub camera: Option<Camera>,
    space: Space,
}

/// The colour space by Exif.
#[derive(PartialEq)]
enum Space {
    /// sRGB, or nothing that would speak against it.
    Srgb,
    /// "Uncalibrated", and no word of what that is.
    Unknown,
    AdobeRgb,
}

impl Shown {
    pub fn of(walk: &Walk, notes: &mut Vec<String>) -> Self {
        let plain = Self { orientation: Orientation::NoTransforms, camera: None, space: Space::Srgb };
        let Some(raw) = walk.named(APP1, b"Exif\0").next() else { return plain };
        let raw = raw.get(1..).unwrap_or_default().to_vec();
        // What can be read of damaged Exif is better than nothing.
        let read = Reader::new().continue_on_error(true).read_raw(raw);
        match read.or_else(|error| error.distill_partial_result(|_| {})) {
            Ok(exif) => {
                let orientation = orientation(&exif);
                Self { orientation, camera: Camera::of_fields(&exif, orientation), space: space(&exif) }
            }
            Err(error) => {
                notes.push(format!(
                    "its Exif cannot be read, orientation and colour space are taken as the usual: {error}"
                ));
                plain
            }
        }
    }
}

fn orientation(exif: &Exif) -> Orientation {
    let value = exif.get_field(Tag::Orientation, In::PRIMARY).and_then(|field| field.value.get_uint(0));
    let value = value.and_then(|value| u8::try_from(value).ok());
    value.and_then(Orientation::from_exif).unwrap_or(Orientation::NoTransforms)
}

/// \[DCF\]: ColorSpace is 65535, and the interoperability index "R03". Some writers say 2.
fn space(exif: &Exif) -> Space {
    const ADOBE_RGB: u32 = 2;
    const UNCALIBRATED: u32 = 65535;
    let value = exif.get_field(Tag::ColorSpace, In::PRIMARY).and_then(|field| field.value.get_uint(0));
    let index = Tag(Context::Interop, 1);
    let index = exif.get_field(index, In::PRIMARY).is_some_and(|field| match &field.value {
        Value::Ascii(words) => words.iter().any(|word| word.starts_with(b"R03")),
        _ => false,
    });
    match value {
        Some(ADOBE_RGB) => Space::AdobeRgb,
        Some(UNCALIBRATED) | None if index => Space::AdobeRgb,
        Some(UNCALIBRATED) => Space::Unknown,
        _ => Space::Srgb,
    }
}

/// What the samples mean: by the ICC profile if there is one, else by Exif; `options` may name the primaries.
pub(super) fn encoding(walk: &Walk, shown: &Shown, options: &ReadOptions, notes: &mut Vec<String>) -> Encoding {
    let profile = embedded(walk).unwrap_or_else(|missing| {
        notes.push(format!("its ICC profile is in pieces, of which some are missing ({missing}); it is left out"));
        None
    });
    if walk.frame.components.len() == 4 {
        notes.push("its colours are CMYK, converted to RGB by the plain product of inks, without its profile".into());
        return Encoding::new(Curve::Srgb, options.primaries);
    }
    if let Some(profile) = profile {
        return icc::encoding(&profile, walk.frame.components.len() == 1, Curve::Srgb, options, notes);
    }
    let curve = if shown.space == Space::AdobeRgb { Curve::Power(ADOBE_GAMMA) } else { Curve::Srgb };
    if options.primaries.is_some() {
        return Encoding::new(curve, options.primaries);
    }
    if shown.space == Space::Unknown {
        notes.push("Exif calls its colours uncalibrated and names no colour space: they are taken as sRGB".into());
    }
    Encoding::new(curve, (shown.space == Space::AdobeRgb).then_some(Primaries::ADOBE_RGB))
}

/// \[ICC\] the profile, put together; the error says how many of its pieces are there.
fn embedded(walk: &Walk) -> Result<Option<Vec<u8>>, String> {
    let mut pieces: Vec<(u8, u8, &[u8])> = Vec::new();
    for piece in walk.named(APP2, b"ICC_PROFILE\0") {
        if let [number, count, data @ ..] = piece
            && !pieces.iter().any(|&(known, ..)| known == *number)
        {
            pieces.push((*number, *count, data));
        }
    }
    let Some(&(_, count, _)) = pieces.first() else { return Ok(None) };
    pieces.sort_by_key(|&(number, ..)| number);
    let there = pieces.iter().map(|&(number, ..)| number).eq(1..=count);
    if !there {
        return Err(format!("{} of {count} are there", pieces.len()));
    }
    Ok(Some(pieces.into_iter().flat_map(|(_, _, data)| data).copied().collect()))
}

/// \[XMP\] the main packet, if it is text.
pub(super) fn xmp<'a>(walk: &Walk<'a>) -> Option<&'a str> {
    let packet = walk.named(APP1, b"http://ns.adobe.com/xap/1.0/\0").next()?;
    std::str::from_utf8(packet).ok().map(|text| text.trim_end_matches('\0'))
}

/// The content of an APP2 segment of this name.
pub(super) fn app2<'a>(walk: &Walk<'a>, name: &'static [u8]) -> Option<&'a [u8]> {
    walk.named(APP2, name).next()
}
