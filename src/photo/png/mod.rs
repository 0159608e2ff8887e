//! PNG through the `png` crate, 8 and 16 bit.
//!
//! What the samples mean, in the order of the PNG specification (third edition, 4.3): cICP, then an ICC profile, then
//! sRGB, then gAMA and cHRM; without any of them sRGB. A gAMA of 1/2.2 means the sRGB curve, as everywhere. Of an
//! animation the still picture is read.

mod chunks;
mod texts;

use std::io::{BufRead, Seek, Write};
use std::sync::Arc;

use glam::DVec2;
use image::metadata::Orientation;
use png::chunk::ChunkType;
use png::{BitDepth, CodingIndependentCodePoints, ColorType, Info, SrgbRenderingIntent, Transformations};

use super::camera::Camera;
use super::decode::{Encoding, Raster};
use super::display::{self, Code, Look, Samples};
use super::metadata::{self, Metadata, Resolution, Unit};
use super::read::check_size;
use super::transfer::Curve;
use super::{Alpha, Format, Photo, Primaries, ReadOptions, Reason, cicp, icc, native, zeroed};
use chunks::Chunks;

/// What the chunks around the picture may take besides a profile: a palette, EXIF, a row.
const AROUND: usize = 16 << 20;

pub(super) fn read(mut reader: impl BufRead + Seek, options: &ReadOptions) -> Result<Photo, Reason> {
    let chunks = Chunks::scan(&mut reader)?;
    chunks.check()?;
    // The picture itself goes into our own memory; the limit is for the chunks around it.
    let limits = png::Limits { bytes: icc::LARGEST + AROUND + chunks.row()? };
    let mut decoder = png::Decoder::new_with_limits(reader, limits);
    decoder.set_ignore_text_chunk(true);
    decoder.set_ignore_iccp_chunk(chunks.profile > icc::LARGEST);
    decoder.set_transformations(Transformations::EXPAND);
    let (width, height) = decoder.read_header_info()?.size();
    check_size(width, height)?;
    let mut reader = decoder.read_info()?;
    let (colour, depth) = reader.output_color_type();
    let (mut notes, channels) = (Vec::new(), colour.samples());
    let info = reader.info();
    // The decoder indexes beyond a palette whose last colour is cut.
    if info.palette.as_ref().is_some_and(|palette| !palette.len().is_multiple_of(3)) {
        return Err("its palette is damaged".into());
    }
    if chunks.profile > 0 && info.icc_profile.is_none() {
        notes.push("its ICC profile is damaged or too large; its colours are taken as sRGB".into());
    }
    if let Some(animation) = info.animation_control.filter(|animation| animation.num_frames > 1) {
        notes.push(format!("it is an animation of {} pictures; its still picture is read", animation.num_frames));
    }
    let encoding = encoding(info, channels < 3, options, &mut notes);
    let size = reader.output_buffer_size().ok_or("the picture does not fit into memory")?;
    let alpha = Alpha::Straight;
    let (turn, camera, mut beside);
    let mut photo = if depth == BitDepth::Sixteen {
        let mut samples = zeroed::<u16>(size / 2)?;
        reader.next_frame(bytemuck::cast_slice_mut(&mut samples))?;
        (turn, camera, beside) = exif(&mut reader);
        samples.iter_mut().for_each(|code| *code = u16::from_be(*code));
        Raster { width, height, channels, samples, planar: false }.into_photo(Format::Png, alpha, &encoding, turn)?
    } else {
        let mut samples = zeroed::<u8>(size)?;
        reader.next_frame(&mut samples)?;
        (turn, camera, beside) = exif(&mut reader);
        Raster { width, height, channels, samples, planar: false }.into_photo(Format::Png, alpha, &encoding, turn)?
    };
    photo.source.camera = camera;
    photo.source.notes.append(&mut notes);
    let info = reader.info();
    if let Some(native) = photo.source.native.as_mut().and_then(Arc::get_mut) {
        native.code_points = info.coding_independent_code_points.filter(|_| options.primaries.is_none()).and_then(own);
    }
    beside.take_resolution(info.pixel_dims.and_then(resolution), turn);
    let (xmp, texts) = texts::split(chunks.texts);
    if let Some(xmp) = xmp {
        beside.take_xmp(&xmp, turn);
    }
    beside.texts = texts;
    beside.attach(&mut photo);
    Ok(photo)
}

/// What Exif says, which may stand behind the picture: third edition, 5.6.
fn exif(reader: &mut png::Reader<impl BufRead + Seek>) -> (Orientation, Option<Camera>, Metadata) {
    if reader.info().exif_metadata.is_none() && reader.info().animation_control.is_none() {
        // What is wrong behind the picture does it no harm.
        let _ = reader.finish();
    }
    let info = reader.info();
    let mut beside = Metadata::default();
    let Some(exif) = info.exif_metadata.as_deref() else { return (Orientation::NoTransforms, None, beside) };
    let turn = Orientation::from_exif_chunk(exif).unwrap_or(Orientation::NoTransforms);
    beside.take_exif(exif, turn);
    (turn, Camera::of_raw_exif(exif, turn), beside)
}

/// The code points that decoded the samples, if any did.
fn own(code: CodingIndependentCodePoints) -> Option<[u8; 2]> {
    code_points(code, &mut Vec::new()).map(|_| [code.color_primaries, code.transfer_function])
}

/// PNG, third edition, 11.3.4.3.
fn resolution(dimensions: png::PixelDimensions) -> Option<Resolution> {
    let unit = match dimensions.unit {
        png::Unit::Meter => Unit::Metre,
        png::Unit::Unspecified => Unit::None,
    };
    Resolution::new([dimensions.xppu.into(), dimensions.yppu.into()], unit)
}

fn encoding(info: &Info<'_>, grey: bool, options: &ReadOptions, notes: &mut Vec<String>) -> Encoding {
    if let Some(code) = info.coding_independent_code_points
        && let Some((curve, primaries)) = code_points(code, notes)
    {
        return Encoding::new(curve, options.primaries.or(Some(primaries)));
    }
    if let Some(icc) = &info.icc_profile {
        return icc::encoding(icc, grey, Curve::Srgb, options, notes);
    }
    let (Some(gamma), None) = (info.gama_chunk, info.srgb) else {
        return Encoding::new(Curve::Srgb, options.primaries);
    };
    let curve = match gamma.into_scaled() {
        0 => {
            notes.push("its gAMA is 0, so sRGB's curve is taken".into());
            Curve::Srgb
        }
        45_000..=46_000 => Curve::Srgb,
        gamma => Curve::Power(100_000.0 / f64::from(gamma)),
    };
    Encoding::new(curve, options.primaries.or(info.chrm_chunk.map(chromaticities)))
}

fn chromaticities(chunk: png::SourceChromaticities) -> Primaries {
    let point = |(x, y): (png::ScaledFloat, png::ScaledFloat)| {
        DVec2::new(f64::from(x.into_scaled()), f64::from(y.into_scaled())) / 100_000.0
    };
    Primaries { red: point(chunk.red), green: point(chunk.green), blue: point(chunk.blue), white: point(chunk.white) }
}

/// What cICP says; none, and a note, where it says nothing that is known here.
fn code_points(code: CodingIndependentCodePoints, notes: &mut Vec<String>) -> Option<(Curve, Primaries)> {
    let (primaries, transfer) = (code.color_primaries, code.transfer_function);
    let known = cicp::curve(transfer).zip(cicp::primaries(primaries));
    if known.is_none() && (primaries, transfer) != (2, 2) {
        notes.push(format!(
            "its cICP names colour primaries {primaries} and transfer function {transfer}, which vglare does not know \
             together, so it is passed over"
        ));
    }
    if known.is_some() && !code.is_video_full_range_image {
        notes.push("its cICP says that its codes are of narrow range; they are taken as full range".into());
    }
    known
}

pub(super) fn write<T: Code>(writer: impl Write, photo: &Photo, look: Look) -> Result<(), Reason> {
    let native = native::of(photo, Format::Png);
    let Samples { channels, mut data } = display::encode::<T>(photo, look, display::has_straight_alpha(photo), native)?;
    let colours = [ColorType::Grayscale, ColorType::GrayscaleAlpha, ColorType::Rgb, ColorType::Rgba];
    let beside = metadata::of(photo);
    let mut info = Info::with_size(photo.width(), photo.height());
    info.icc_profile = native.and_then(|native| native.profile(channels < 3));
    info.exif_metadata = beside.and_then(|metadata| metadata.exif_of(native.is_none())).map(Into::into);
    info.pixel_dims = beside.and_then(|metadata| metadata.resolution).map(dimensions);
    let mut encoder = png::Encoder::with_info(writer, info)?;
    encoder.set_color(colours[channels - 1]);
    encoder.set_depth(if size_of::<T>() == 2 { BitDepth::Sixteen } else { BitDepth::Eight });
    // A quarter of the default's time for half as much again of its size.
    encoder.set_compression(png::Compression::Fast);
    if native.is_none() {
        encoder.set_source_srgb(SrgbRenderingIntent::RelativeColorimetric);
    }
    let mut writer = encoder.write_header()?;
    if let Some([primaries, transfer]) = native.and_then(|native| native.code_points) {
        // RGB, full range.
        writer.write_chunk(ChunkType(*b"cICP"), &[primaries, transfer, 0, 1])?;
    }
    if let Some(metadata) = beside {
        let xmp = metadata.xmp.iter().map(|xmp| (*b"iTXt", texts::xmp_chunk(xmp)));
        for (name, content) in xmp.chain(metadata.texts.iter().cloned()) {
            writer.write_chunk(ChunkType(name), &content)?;
        }
    }
    if size_of::<T>() == 2 {
        bytemuck::cast_slice_mut::<_, u16>(&mut data).iter_mut().for_each(|code| *code = code.to_be());
    }
    writer.write_image_data(bytemuck::cast_slice(&data))?;
    Ok(writer.finish()?)
}

/// PNG, third edition, 11.3.4.3: to a metre, or of no unit.
fn dimensions(resolution: Resolution) -> png::PixelDimensions {
    let [xppu, yppu] = resolution.in_unit(Unit::Metre).map(|pixels| pixels.round().max(1.0) as u32);
    let unit = if resolution.unit == Unit::None { png::Unit::Unspecified } else { png::Unit::Meter };
    png::PixelDimensions { xppu, yppu, unit }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exif_turns_the_picture_from_before_and_from_behind_it() {
        // Big-endian, one entry: orientation 6, a quarter turn clockwise.
        let exif = b"eXIfMM\0*\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0\x06\0\0\0\0\0\0";
        let mut crc = flate2::Crc::new();
        crc.update(exif);
        let length = (exif.len() as u32 - 4).to_be_bytes();
        let chunk = [&length, exif.as_slice(), &crc.sum().to_be_bytes()].concat();
        for name in [b"IDAT", b"IEND"] {
            let mut file = Vec::new();
            let mut encoder = png::Encoder::new(&mut file, 2, 1);
            encoder.set_color(ColorType::Grayscale);
            encoder.write_header().unwrap().write_image_data(&[0, 255]).unwrap();
            let at = file.windows(4).position(|word| word == name).unwrap() - 4;
            file.splice(at..at, chunk.iter().copied());
            let photo = super::read(std::io::Cursor::new(file), &ReadOptions::default()).unwrap();
            assert_eq!((photo.width(), photo.height()), (1, 2), "{}", String::from_utf8_lossy(name));
            assert_eq!((photo.pixels[0][0], photo.pixels[1][0]), (0.0, 1.0));
        }
    }

    #[test]
    fn code_points_that_are_unknown_are_passed_over_with_a_note() {
        let read = |color_primaries, transfer_function| {
            let mut notes = Vec::new();
            let code = CodingIndependentCodePoints {
                color_primaries,
                transfer_function,
                matrix_coefficients: 0,
                is_video_full_range_image: true,
            };
            (code_points(code, &mut notes), notes.concat())
        };
        assert_eq!(read(9, 16), (Some((Curve::Pq, Primaries::REC2020)), String::new()));
        assert_eq!(read(2, 2), (None, String::new()), "unspecified");
        let (known, note) = read(200, 1);
        assert!(known.is_none() && note.contains("primaries 200"), "{note}");
        let (known, note) = read(1, 200);
        assert!(known.is_none() && note.contains("function 200"), "{note}");
    }
}
