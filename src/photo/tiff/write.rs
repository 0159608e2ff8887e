//! Writes TIFF through the `tiff` crate: uncompressed, and in BigTIFF where 4 GiB do not suffice.

use std::io::{Seek, Write};

use rayon::prelude::*;
use tiff::encoder::{TiffEncoder, TiffKind, TiffKindBig, TiffKindStandard, TiffValue, colortype};
use tiff::tags::{ExtraSamples, Tag};

use super::super::display::{self, Code, Look};
use super::super::icc;
use super::super::pfm::rec709;
use super::super::{Alpha, Depth, Format, Photo, Reason, metadata, native, zeroed};
use super::metadata::{exif_of, write_beside, write_within};

pub(in super::super) fn write(
    writer: impl Write + Seek,
    photo: &Photo,
    depth: Depth,
    look: Look,
) -> Result<(), Reason> {
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
    let samples = display::encode(photo, look, alpha, native::of(photo, Format::Tiff))?;
    Ok((samples.channels, samples.data))
}

fn floats(photo: &Photo, alpha: bool) -> Result<(usize, Vec<f32>), Reason> {
    let colours = if display::is_grey(photo) { 1 } else { 3 };
    let channels = colours + usize::from(alpha);
    let row = photo.width() as usize * channels;
    let gamut = photo.to_file();
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
    let grey = *channels < 3;
    let native = native::of(photo, Format::Tiff).and_then(|native| native.profile(grey)).filter(|_| display);
    let profile = match &native {
        Some(profile) => Some(&**profile),
        None => display.then(|| icc::srgb_profile(grey)).transpose()?,
    };
    let beside = metadata::of(photo);
    let exif = beside.and_then(|metadata| exif_of(metadata, display && native.is_none()));
    let led = exif.as_ref().map_or(Ok(Vec::new()), |exif| write_beside(&mut encoder, exif))?;
    let extra = if channels.is_multiple_of(2) { &[alpha][..] } else { &[] };
    macro_rules! write_as {
        ($colour:ty) => {{
            let mut image = encoder.new_image::<$colour>(photo.width(), photo.height())?;
            image.extra_samples(extra)?;
            if let Some(profile) = profile {
                image.encoder().write_tag(Tag::IccProfile, profile)?;
            }
            if let Some(metadata) = beside {
                write_within(image.encoder(), metadata, exif.as_ref())?;
            }
            for (tag, offset) in led {
                image.encoder().write_tag(Tag::from_u16_exhaustive(tag), offset)?;
            }
            image.write_data(samples)?;
        }};
    }
    if grey {
        write_as!(Grey)
    } else {
        write_as!(Rgb)
    }
    Ok(())
}
