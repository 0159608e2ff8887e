//! PNG through the `png` crate, 8 and 16 bit.
//!
//! What the samples mean, in the order of the PNG specification (third edition, 4.3): cICP, then an ICC profile, then
//! sRGB, then gAMA and cHRM; without any of them sRGB. A gAMA of 1/2.2 means the sRGB curve, as everywhere.

use std::io::{BufRead, Seek, Write};

use glam::DVec2;
use image::metadata::Orientation;
use png::{BitDepth, ColorType, Info, SrgbRenderingIntent, Transformations};

use super::decode::{Encoding, Raster};
use super::display::{self, Code, Look, Samples};
use super::icc::Profile;
use super::read::check_size;
use super::transfer::Curve;
use super::{Alpha, Format, Photo, Primaries, ReadOptions, Reason, zeroed};

pub(super) fn read(reader: impl BufRead + Seek, _options: &ReadOptions) -> Result<Photo, Reason> {
    // The picture itself goes into our own memory; the limit is for the chunks around it.
    let mut decoder = png::Decoder::new_with_limits(reader, png::Limits { bytes: 1 << 30 });
    decoder.set_ignore_text_chunk(true);
    decoder.set_transformations(Transformations::EXPAND);
    let (width, height) = decoder.read_header_info()?.size();
    check_size(width, height)?;
    let mut reader = decoder.read_info()?;
    let (colour, depth) = reader.output_color_type();
    let channels = colour.samples();
    let encoding = encoding(reader.info(), channels < 3)?;
    let size = reader.output_buffer_size().ok_or("the picture does not fit into memory")?;
    let mut bytes = zeroed::<u8>(size)?;
    reader.next_frame(&mut bytes)?;
    let exif = reader.info().exif_metadata.as_deref();
    let orientation = exif.and_then(Orientation::from_exif_chunk).unwrap_or(Orientation::NoTransforms);
    if depth == BitDepth::Sixteen {
        let samples = bytes.as_chunks::<2>().0.iter().map(|&code| u16::from_be_bytes(code)).collect();
        let raster = Raster { width, height, channels, samples, planar: false };
        raster.into_photo(Format::Png, Alpha::Straight, &encoding, orientation)
    } else {
        let raster = Raster { width, height, channels, samples: bytes, planar: false };
        raster.into_photo(Format::Png, Alpha::Straight, &encoding, orientation)
    }
}

fn encoding(info: &Info<'_>, grey: bool) -> Result<Encoding, Reason> {
    if let Some(code) = info.coding_independent_code_points {
        return cicp(code.color_primaries, code.transfer_function);
    }
    if let Some(icc) = &info.icc_profile
        && let Some(profile) = Profile::new(icc, grey)?
    {
        return Ok(Encoding::Icc(profile));
    }
    let (Some(gamma), None) = (info.gama_chunk, info.srgb) else {
        return Ok(Encoding::new(Curve::Srgb, None));
    };
    let curve = match gamma.into_scaled() {
        0 => return Err("its gAMA is 0".into()),
        45_000..=46_000 => Curve::Srgb,
        gamma => Curve::Power(100_000.0 / f64::from(gamma)),
    };
    let point = |(x, y): (png::ScaledFloat, png::ScaledFloat)| {
        DVec2::new(f64::from(x.into_scaled()), f64::from(y.into_scaled())) / 100_000.0
    };
    let primaries = info.chrm_chunk.map(|c| Primaries {
        red: point(c.red),
        green: point(c.green),
        blue: point(c.blue),
        white: point(c.white),
    });
    Ok(Encoding::new(curve, primaries))
}

/// Code points of ITU-T H.273, tables 2 and 3.
fn cicp(primaries: u8, transfer: u8) -> Result<Encoding, Reason> {
    let primaries = match primaries {
        1 | 2 => Primaries::REC709,
        9 => Primaries::REC2020,
        12 => Primaries::P3_D65,
        other => return Err(format!("its cICP names colour primaries {other}, which vglare does not know").into()),
    };
    let curve = match transfer {
        1 | 6 | 14 | 15 => Curve::Rec709,
        2 | 13 => Curve::Srgb,
        4 => Curve::Power(2.2),
        5 => Curve::Power(2.8),
        8 => Curve::Linear,
        16 => Curve::Pq,
        18 => Curve::Hlg,
        other => return Err(format!("its cICP names transfer function {other}, which vglare does not know").into()),
    };
    Ok(Encoding::new(curve, Some(primaries)))
}

pub(super) fn write<T: Code>(writer: impl Write, photo: &Photo, look: Look) -> Result<(), Reason> {
    let Samples { channels, data } = display::encode::<T>(photo, look, display::has_straight_alpha(photo))?;
    let colours = [ColorType::Grayscale, ColorType::GrayscaleAlpha, ColorType::Rgb, ColorType::Rgba];
    let mut encoder = png::Encoder::new(writer, photo.width(), photo.height());
    encoder.set_color(colours[channels - 1]);
    encoder.set_depth(if size_of::<T>() == 2 { BitDepth::Sixteen } else { BitDepth::Eight });
    // A quarter of the default's time for half as much again of its size.
    encoder.set_compression(png::Compression::Fast);
    encoder.set_source_srgb(SrgbRenderingIntent::RelativeColorimetric);
    let mut writer = encoder.write_header()?;
    if size_of::<T>() == 2 {
        let codes: Vec<u16> = bytemuck::allocation::cast_vec(data);
        let bytes: Vec<[u8; 2]> = codes.into_iter().map(u16::to_be_bytes).collect();
        writer.write_image_data(bytes.as_flattened())?;
    } else {
        writer.write_image_data(bytemuck::cast_slice(&data))?;
    }
    Ok(writer.finish()?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn code_points_that_are_unknown_say_so() {
        assert!(cicp(9, 16).is_ok() && cicp(12, 13).is_ok() && cicp(1, 8).is_ok());
        assert!(cicp(200, 1).err().unwrap().to_string().contains("primaries 200"));
        assert!(cicp(1, 200).err().unwrap().to_string().contains("function 200"));
    }
}
