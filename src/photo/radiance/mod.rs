//! Radiance HDR: the header is read and written here, the pixels go through the `image` crate.
//!
//! \[FMT\] Greg Ward, "Radiance File Formats": radiance-online.org, refer/filefmts.pdf.
//!
//! Pixels stay as they are stored: the header's EXPOSURE and COLORCORR, which they have been multiplied by, are carried
//! like VIEW and all else, and written back to Radiance HDR; other formats get the pixels without it, and OpenEXR what is
//! white in cd/m² by it. Where a photo's white is known to be another, EXPOSURE is written by that. PRIMARIES are
//! honoured, and kept where a Radiance picture becomes one again. XYZE becomes Rec. 709 as it is read, by XYZ as they
//! stand: the white of D65 is white. Pictures are written upright, from the top left.

mod header;

use std::io::{self, BufRead, Cursor, Read, Seek, SeekFrom, Write};
use std::sync::Arc;

use image::codecs::hdr::{HdrDecoder, HdrEncoder};
use image::{ImageDecoder, Rgb};
use rayon::prelude::*;

use super::pfm::rec709;
use super::read::check_size;
use super::{Depth, Format, Photo, Primaries, ReadOptions, Reason, Source, zeroed};
use crate::frame::Frame;

pub(super) use header::Header;

/// The largest value: mantissa 255/256, exponent 127.
const LARGEST: f32 = 255.0 / 256.0 * 1.701_411_8e38;
/// What is darker is written as black: the encoder's exponent wraps around below 2^-127.
const SMALLEST: f32 = 1e-38;

pub(super) fn read(mut reader: impl BufRead + Seek, options: &ReadOptions) -> Result<Photo, Reason> {
    let header = Header::read(&mut reader)?;
    let order = header.order;
    let count = check_size(order.width, order.height)?;
    let (lines, length) = order.lines();
    check_length(&mut reader, lines, length)?;
    // The decoder knows one order, and headers of few kinds; it gets one that it knows. Not strict: `#?RGBE` is as
    // common a first line as `#?RADIANCE`.
    let plain = format!("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {lines} +X {length}\n");
    let decoder = HdrDecoder::new_nonstrict(Cursor::new(plain).chain(reader))?;
    let mut samples = zeroed::<[f32; 3]>(count)?;
    decoder.read_image(bytemuck::cast_slice_mut(&mut samples))?;
    // With primaries from elsewhere, XYZ are numbers like others.
    let xyz = (header.xyz && options.primaries.is_none()).then(Primaries::xyz_to_rec709);
    let mut pixels = zeroed::<[f32; 4]>(count)?;
    pixels.par_chunks_exact_mut(order.width as usize).enumerate().for_each(|(y, row)| {
        for (x, pixel) in row.iter_mut().enumerate() {
            let [r, g, b] = samples[order.index(x, y)];
            let rgb = rec709([r, g, b, 1.0], xyz.as_ref());
            *pixel = [rgb[0], rgb[1], rgb[2], 1.0];
        }
    });
    let mut notes = Vec::new();
    if header.lost_primaries && !header.xyz && options.primaries.is_none() {
        notes.push("its PRIMARIES span no colour space: its colours are taken as Rec. 709".to_owned());
    }
    let source = Source {
        format: Some(Format::Radiance),
        notes,
        depth: Depth::Float,
        primaries: header.primaries.filter(|_| !header.xyz).and_then(Primaries::other_than_rec709),
        knows_primaries: header.primaries.is_some() || header.xyz,
        pixel_aspect: header.pixel_aspect(),
        space: xyz.map(|_| "CIE XYZ".to_owned()),
        luminance: Some(header.luminance()),
        camera: header.camera(),
        radiance: Some(Arc::new(header)),
        ..Source::plain()
    };
    Ok(Photo { frame: Frame::full(order.width, order.height), pixels, source })
}

/// Whether what follows the header can hold so many scanlines: the shortest is a pixel, and a count of its repeats.
fn check_length(reader: &mut impl Seek, lines: u32, length: u32) -> Result<(), Reason> {
    let here = reader.stream_position()?;
    let end = reader.seek(SeekFrom::End(0))?;
    reader.seek(SeekFrom::Start(here))?;
    let shortest = if length > 1 { 8 } else { 4 };
    if end.saturating_sub(here) < u64::from(lines) * shortest {
        return Err("the file is cut short".into());
    }
    Ok(())
}

pub(super) fn write(mut writer: impl Write, photo: &Photo) -> Result<(), Reason> {
    let (width, height) = (photo.width() as usize, photo.height() as usize);
    // Only readers of Radiance pictures that name primaries are sure to look for them.
    let own = photo.source.primaries.filter(|_| photo.source.radiance.is_some() || photo.source.keeps_space);
    let gamut = if own.is_some() { None } else { photo.to_rec709() };
    let mut samples = zeroed::<[f32; 3]>(width * height)?;
    samples.par_chunks_exact_mut(width).enumerate().for_each(|(y, row)| {
        for (out, &pixel) in row.iter_mut().zip(photo.picture_row(y as u32).iter()) {
            *out = held(rec709(pixel, gamut.as_ref()));
        }
    });
    header::write(&mut writer, photo, own)?;
    let samples: Vec<Rgb<f32>> = samples.into_iter().map(Rgb).collect();
    Ok(HdrEncoder::new(Headless { writer, left: ENCODERS_HEADER }).encode(&samples, width, height)?)
}

/// Lines that the encoder begins with, up to the one of the resolution.
const ENCODERS_HEADER: usize = 5;

/// A writer to which the encoder's own header does not come through.
struct Headless<W> {
    writer: W,
    /// Lines of the header that are to come.
    left: usize,
}

impl<W: Write> Write for Headless<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if self.left == 0 {
            return self.writer.write(bytes);
        }
        let line = bytes.iter().position(|&byte| byte == b'\n');
        self.left -= usize::from(line.is_some());
        Ok(line.map_or(bytes.len(), |end| end + 1))
    }

    fn flush(&mut self) -> io::Result<()> {
        self.writer.flush()
    }
}

/// The nearest colour that the format can hold.
fn held(rgb: [f32; 3]) -> [f32; 3] {
    let rgb = rgb.map(|c| if c.is_nan() { 0.0 } else { c.clamp(0.0, LARGEST) });
    if rgb.iter().all(|&c| c < SMALLEST) { [0.0; 3] } else { rgb }
}

#[cfg(test)]
mod tests;
