//! JPEG, read by `libjpeg-turbo-rs` and written by the `image` crate: 8 bit, at quality 95 without chroma subsampling.
//!
//! # Reading
//!
//! Before anything is decoded the file's markers are walked (`walk`): what stands behind the picture's end marker (a
//! film, a preview, a maker's data) is no part of it, and a picture that lacks an end, a scan, or the least data that
//! its size needs is refused as cut short. The decoder then refuses codes that do not exist and data that end early;
//! it never fills up with grey.
//!
//! All codes are read once before (`check`), since decoders let pass what no encoder writes: a photo is then garbage
//! from some row on without a word. That is 0.14 s for a photo of 24 megapixels in 4:2:0, of 0.6 s in all. Data that
//! happen to fill the picture exactly cannot be told; so arithmetic coding is refused, where that is always so.
//!
//! Of the decoders that were compared with libjpeg-turbo's `djpeg` over 482 files (22 ways of sampling, scans together
//! and apart, restart markers, progressive; November 2026), zune-jpeg 0.5.15 differed by more than 8 codes or failed in
//! 202, and jpeg-decoder 0.3.2 fills missing data with grey. libjpeg-turbo-rs 0.9.0 refused 112 and was equal in all
//! others; the 112 (luma sampled less than chroma, scans of two of three components) are decoded by it to planes, which
//! `planes` puts together, to 3 codes. It is built without its SIMD code, of which most of its `unsafe` is.
//!
//! # Colours
//!
//! An ICC profile wins, then Exif: sRGB, or Adobe RGB (1998) as DCF 2.0 marks it (`tags`). CMYK is converted without
//! its profile. A gain map (Ultra HDR, ISO 21496-1) is applied in full: the photo is then scene-linear (`gain`).

mod check;
mod codes;
mod decode;
mod gain;
mod metadata;
mod planes;
mod recipe;
mod tags;
mod walk;

use std::io::{BufRead, Seek, Write};

use image::codecs::jpeg::JpegEncoder;
use image::metadata::Orientation;
use image::{ExtendedColorType, ImageEncoder};

use super::decode::{Encoding, Raster};
use super::display::{self, Look};
use super::{Alpha, Format, Photo, ReadOptions, Reason, icc, native};
use decode::{Decoded, Samples};
use walk::Walk;

const QUALITY: u8 = 95;
/// The format counts columns and rows in 16 bits.
pub(super) const LONGEST_SIDE: u32 = 65535;

pub(super) fn read(mut reader: impl BufRead + Seek, options: &ReadOptions) -> Result<Photo, Reason> {
    let mut file = Vec::new();
    reader.read_to_end(&mut file)?;
    let walk = Walk::new(&file)?;
    walk.check()?;
    let mut notes = Vec::new();
    check::check(&walk, &mut notes)?;
    let decoded = decode::decode(&walk, &mut notes)?;
    let shown = tags::Shown::of(&walk, &mut notes);
    let encoding = tags::encoding(&walk, &shown, options, &mut notes);
    let mut photo = into_photo(decoded, &walk, &encoding, shown.orientation)?;
    photo.source.notes.append(&mut notes);
    photo.source.camera = shown.camera;
    metadata::read(&walk, shown.orientation).attach(&mut photo);
    gain::apply(&walk, shown.orientation, encoding.to_rec709(), &mut photo);
    Ok(photo)
}

fn into_photo(decoded: Decoded, walk: &Walk, encoding: &Encoding, turn: Orientation) -> Result<Photo, Reason> {
    let (width, height, channels) = (walk.frame.width, walk.frame.height, decoded.channels);
    match decoded.samples {
        Samples::Eight(samples) => Raster { width, height, channels, samples, planar: false }.into_photo(
            Format::Jpeg,
            Alpha::None,
            encoding,
            turn,
        ),
        Samples::Sixteen(samples) => Raster { width, height, channels, samples, planar: false }.into_photo(
            Format::Jpeg,
            Alpha::None,
            encoding,
            turn,
        ),
    }
}

pub(super) fn write(mut writer: impl Write, photo: &Photo, look: Look) -> Result<(), Reason> {
    let native = native::of(photo, Format::Jpeg);
    let samples = display::encode::<u8>(photo, look, false, native)?;
    let grey = samples.channels == 1;
    let colour = if grey { ExtendedColorType::L8 } else { ExtendedColorType::Rgb8 };
    let profile = match native.and_then(|native| native.profile(grey)) {
        Some(profile) => profile.into_owned(),
        None => icc::srgb_profile(grey)?.to_vec(),
    };
    let mut file = Vec::new();
    let mut encoder = JpegEncoder::new_with_quality(&mut file, QUALITY);
    encoder.set_icc_profile(profile)?;
    let beside = super::metadata::of(photo);
    if let Some(exif) = beside.and_then(|metadata| metadata.exif_segment(native.is_none())) {
        encoder.set_exif_metadata(exif)?;
    }
    if let Some(density) = beside.and_then(|metadata| metadata.resolution).and_then(metadata::density_of) {
        encoder.set_pixel_density(density);
    }
    encoder.write_image(&samples.data, photo.width(), photo.height(), colour)?;
    // What the encoder does not know of goes behind its first segment, which has to be JFIF's.
    let (head, rest) = file.split_at(2 + 2 + usize::from(u16::from_be_bytes([file[4], file[5]])));
    writer.write_all(head)?;
    writer.write_all(&beside.map_or(Vec::new(), |metadata| metadata.segments()))?;
    Ok(writer.write_all(rest)?)
}
