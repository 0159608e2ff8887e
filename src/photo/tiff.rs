//! TIFF through the `tiff` crate: 8 and 16 bit integers, and 32-bit floats; grey or RGB, with or without alpha.
//!
//! Integers are display-referred (an ICC profile decodes them, else sRGB), floats scene-linear unless a profile says
//! otherwise. Written uncompressed, in BigTIFF where 4 GiB do not suffice.

use std::io::{BufRead, Seek, Write};

use image::metadata::Orientation;
use rayon::prelude::*;
use tiff::decoder::{Decoder, DecodingResult, Limits};
use tiff::encoder::{TiffEncoder, TiffKind, TiffKindBig, TiffKindStandard, TiffValue, colortype};
use tiff::tags::{ExtraSamples, Tag};

use super::decode::{Encoding, Raster, Sample};
use super::display::{self, Code, Look};
use super::icc::{self, Profile};
use super::pfm::rec709;
use super::read::{MAX_PIXELS, check_size};
use super::transfer::Curve;
use super::{Alpha, Depth, Format, Photo, ReadOptions, Reason, zeroed};

pub(super) fn read(reader: impl BufRead + Seek, _options: &ReadOptions) -> Result<Photo, Reason> {
    // The picture's size is checked below; this bounds what a single tag or strip may ask for.
    let bytes = MAX_PIXELS.saturating_mul(16);
    let mut limits = Limits::default();
    (limits.decoding_buffer_size, limits.intermediate_buffer_size, limits.ifd_value_size) = (bytes, bytes, 1 << 26);
    let mut decoder = Decoder::new(reader)?.with_limits(limits);
    let (width, height) = decoder.dimensions()?;
    check_size(width, height)?;
    let channels = channels(decoder.colortype()?)?;
    let extra = decoder.find_tag_unsigned_vec::<u16>(Tag::ExtraSamples)?.unwrap_or_default();
    let associated = extra.first() == Some(&ExtraSamples::AssociatedAlpha.to_u16());
    let icc = decoder.find_tag(Tag::IccProfile)?.map(|value| value.into_u8_vec()).transpose()?;
    let orientation = decoder.find_tag_unsigned::<u8>(Tag::Orientation).ok().flatten();
    let profile = icc.map(|icc| Profile::new(&icc, channels < 3)).transpose()?.flatten();
    let mut samples = DecodingResult::U8(Vec::new());
    // The decoder aborts where memory is short; ask for it first.
    drop(zeroed::<u8>(decoder.image_buffer_layout()?.complete_len)?);
    let layout = decoder.read_image_to_buffer(&mut samples)?;
    let picture = Picture {
        size: (width, height),
        channels,
        planar: layout.planes > 1,
        alpha: if associated { Alpha::Premultiplied } else { Alpha::Straight },
        profile,
        orientation: orientation.and_then(Orientation::from_exif).unwrap_or(Orientation::NoTransforms),
    };
    match samples {
        DecodingResult::U8(samples) => picture.into_photo(samples, Curve::Srgb),
        DecodingResult::U16(samples) => picture.into_photo(samples, Curve::Srgb),
        DecodingResult::F32(samples) => picture.into_photo(samples, Curve::Linear),
        _ => Err("its samples are neither 8 or 16 bit unsigned integers nor 32-bit floats".into()),
    }
}

struct Picture {
    size: (u32, u32),
    channels: usize,
    planar: bool,
    alpha: Alpha,
    profile: Option<Profile>,
    orientation: Orientation,
}

impl Picture {
    fn into_photo<T: Sample>(self, samples: Vec<T>, curve: Curve) -> Result<Photo, Reason> {
        let (width, height) = self.size;
        let raster = Raster { width, height, channels: self.channels, samples, planar: self.planar };
        let encoding = self.profile.map_or(Encoding::new(curve, None), Encoding::Icc);
        raster.into_photo(Format::Tiff, self.alpha, &encoding, self.orientation)
    }
}

fn channels(colour: tiff::ColorType) -> Result<usize, Reason> {
    use tiff::ColorType::{CMYK, CMYKA, Gray, GrayA, Lab, Multiband, Palette, RGB, RGBA, YCbCr};
    let (name, bits, channels) = match colour {
        Gray(bits) => ("grey", bits, 1),
        // What the decoder calls two bands is grey with alpha.
        GrayA(bits) | Multiband { bit_depth: bits, num_samples: 2 } => ("grey with alpha", bits, 2),
        RGB(bits) => ("RGB", bits, 3),
        RGBA(bits) => ("RGBA", bits, 4),
        Palette(bits) => ("palette", bits, 0),
        CMYK(bits) | CMYKA(bits) => ("CMYK", bits, 0),
        YCbCr(bits) => ("YCbCr", bits, 0),
        Lab(bits) => ("Lab", bits, 0),
        Multiband { bit_depth, .. } => ("many bands", bit_depth, 0),
        _ => ("an unknown colour", 0, 0),
    };
    match (channels, bits) {
        (1.., 8 | 16 | 32) => Ok(channels),
        _ => Err(format!("it holds {name} of {bits} bit; vglare reads grey and RGB of 8, 16 and 32 bit").into()),
    }
}

pub(super) fn write(writer: impl Write + Seek, photo: &Photo, depth: Depth, look: Look) -> Result<(), Reason> {
    let size = u64::from(photo.width()) * u64::from(photo.height()) * 16;
    // Offsets of a classic TIFF have 32 bits; a little is left for the directory.
    if size < u64::from(u32::MAX) - (1 << 20) {
        write_kind::<_, TiffKindStandard>(TiffEncoder::new(writer)?, photo, depth, look)
    } else {
        write_kind::<_, TiffKindBig>(TiffEncoder::new_big(writer)?, photo, depth, look)
    }
}

fn write_kind<W: Write + Seek, K: TiffKind>(
    encoder: TiffEncoder<W, K>,
    photo: &Photo,
    depth: Depth,
    look: Look,
) -> Result<(), Reason> {
    use colortype::{Gray8, Gray16, Gray32Float, RGB8, RGB16, RGB32Float};
    let alpha = photo.source.alpha != Alpha::None;
    match depth {
        Depth::Eight => encode::<_, _, Gray8, RGB8, u8>(encoder, photo, true, &codes(photo, look, alpha)?),
        Depth::Sixteen => encode::<_, _, Gray16, RGB16, u16>(encoder, photo, true, &codes(photo, look, alpha)?),
        _ => encode::<_, _, Gray32Float, RGB32Float, f32>(encoder, photo, false, &floats(photo, alpha)?),
    }
}

fn codes<T: Code>(photo: &Photo, look: Look, alpha: bool) -> Result<(usize, Vec<T>), Reason> {
    let samples = display::encode(photo, look, alpha)?;
    Ok((samples.channels, samples.data))
}

fn floats(photo: &Photo, alpha: bool) -> Result<(usize, Vec<f32>), Reason> {
    let colours = if display::is_grey(photo) { 1 } else { 3 };
    let channels = colours + usize::from(alpha);
    let row = photo.width() as usize * channels;
    let gamut = photo.to_rec709();
    let mut samples = zeroed::<f32>(row * photo.height() as usize)?;
    samples.par_chunks_exact_mut(row).enumerate().for_each(|(y, row)| {
        for (out, &pixel) in row.chunks_exact_mut(channels).zip(photo.picture_row(y as u32).iter()) {
            out[..colours].copy_from_slice(&rec709(pixel, gamut.as_ref())[..colours]);
            out[colours..].copy_from_slice(&pixel[3..][..channels - colours]);
        }
    });
    Ok((channels, samples))
}

/// Writes samples of type `T`, as the colour `Grey` or `Rgb`, with what is beyond as alpha; for displays, with a profile.
fn encode<W, K, Grey, Rgb, T>(
    mut encoder: TiffEncoder<W, K>,
    photo: &Photo,
    display: bool,
    (channels, samples): &(usize, Vec<T>),
) -> Result<(), Reason>
where
    W: Write + Seek,
    K: TiffKind,
    Grey: colortype::ColorType<Inner = T>,
    Rgb: colortype::ColorType<Inner = T>,
    [T]: TiffValue,
{
    let alpha = match photo.source.alpha {
        Alpha::Premultiplied => ExtraSamples::AssociatedAlpha,
        _ => ExtraSamples::UnassociatedAlpha,
    };
    let profile = display.then(|| icc::srgb_profile(*channels < 3)).transpose()?;
    let extra = if channels.is_multiple_of(2) { &[alpha][..] } else { &[] };
    macro_rules! write_as {
        ($colour:ty) => {{
            let mut image = encoder.new_image::<$colour>(photo.width(), photo.height())?;
            image.extra_samples(extra)?;
            if let Some(profile) = profile {
                image.encoder().write_tag(Tag::IccProfile, profile)?;
            }
            image.write_data(samples)?;
        }};
    }
    if *channels < 3 {
        write_as!(Grey)
    } else {
        write_as!(Rgb)
    }
    Ok(())
}
