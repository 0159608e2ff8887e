//! JPEG through the `image` crate: 8 bit, written at quality 95 without chroma subsampling.

use std::io::{BufRead, Cursor, Seek, Write};

use image::codecs::jpeg::{JpegDecoder, JpegEncoder};
use image::{ExtendedColorType, ImageDecoder, ImageEncoder};

use super::decode::{Encoding, Raster};
use super::display::{self, Look};
use super::icc::{self, Profile};
use super::read::check_size;
use super::transfer::Curve;
use super::{Alpha, Format, Photo, ReadOptions, Reason, zeroed};

const QUALITY: u8 = 95;
/// The format counts columns and rows in 16 bits.
pub(super) const LONGEST_SIDE: u32 = 65535;

pub(super) fn read(mut reader: impl BufRead + Seek, _options: &ReadOptions) -> Result<Photo, Reason> {
    let mut file = Vec::new();
    reader.read_to_end(&mut file)?;
    check_complete(&file)?;
    let mut decoder = JpegDecoder::new(Cursor::new(file))?;
    let (width, height) = decoder.dimensions();
    check_size(width, height)?;
    let channels = usize::from(decoder.color_type().channel_count());
    let profile = match decoder.icc_profile()? {
        Some(icc) => Profile::new(&icc, channels == 1)?,
        None => None,
    };
    let orientation = decoder.orientation()?;
    let mut samples = zeroed::<u8>(usize::try_from(decoder.total_bytes())?)?;
    decoder.read_image(&mut samples)?;
    let encoding = profile.map_or(Encoding::new(Curve::Srgb, None), Encoding::Icc);
    let raster = Raster { width, height, channels, samples, planar: false };
    raster.into_photo(Format::Jpeg, Alpha::None, &encoding, orientation)
}

/// The decoder fills a picture that is cut short with grey; the end marker must follow the last scan.
fn check_complete(file: &[u8]) -> Result<(), Reason> {
    let last = |marker: u8| file.windows(2).rposition(|pair| pair == [0xff, marker]);
    match (last(0xda), last(0xd9)) {
        (Some(scan), Some(end)) if scan < end => Ok(()),
        _ => Err("the file is cut short".into()),
    }
}

pub(super) fn write(writer: impl Write, photo: &Photo, look: Look) -> Result<(), Reason> {
    let samples = display::encode::<u8>(photo, look, false)?;
    let colour = if samples.channels == 1 { ExtendedColorType::L8 } else { ExtendedColorType::Rgb8 };
    let mut encoder = JpegEncoder::new_with_quality(writer, QUALITY);
    encoder.set_icc_profile(icc::srgb_profile(samples.channels == 1)?.to_vec())?;
    Ok(encoder.write_image(&samples.data, photo.width(), photo.height(), colour)?)
}
