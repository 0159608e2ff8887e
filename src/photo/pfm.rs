//! Portable float maps: Paul Debevec's format, pauldebevec.com/Research/HDR/PFM.
//!
//! `PF` for RGB or `Pf` for grey, columns and rows, a number whose sign tells the byte order (negative: little-endian),
//! then rows from the bottom. The number's magnitude is ignored, as other programs do. No crate that is kept up reads
//! it: the format is smaller than a dependency.

use std::io::{BufRead, Read, Write};

use glam::DMat3;

use super::read::check_size;
use super::{Depth, Format, Photo, Reason, Source, display, zeroed};
use crate::frame::Frame;

/// A header longer than this is no header.
const LONGEST_WORD: usize = 32;

pub(super) fn read(mut reader: impl BufRead) -> Result<Photo, Reason> {
    let channels = match word(&mut reader)?.as_str() {
        "PF" => 3,
        "Pf" => 1,
        other => return Err(format!("a PFM file begins with PF or Pf, not {other}").into()),
    };
    let width: u32 = number(&mut reader, "width")?;
    let height: u32 = number(&mut reader, "height")?;
    let scale: f64 = number(&mut reader, "scale")?;
    if !scale.is_finite() || scale == 0.0 {
        return Err(format!("its scale is {scale}, which tells no byte order").into());
    }
    let count = check_size(width, height)?;
    let mut pixels = zeroed::<[f32; 4]>(count)?;
    let mut line = zeroed::<[u8; 4]>(width as usize * channels)?;
    let read = if scale < 0.0 { f32::from_le_bytes } else { f32::from_be_bytes };
    for row in pixels.chunks_exact_mut(width as usize).rev() {
        reader.read_exact(line.as_flattened_mut())?;
        for (pixel, sample) in row.iter_mut().zip(line.chunks_exact(channels)) {
            // A grey file repeats its one sample.
            *pixel = [read(sample[0]), read(sample[channels / 2]), read(sample[channels - 1]), 1.0];
        }
    }
    let source = Source { format: Some(Format::Pfm), depth: Depth::Float, grey: channels == 1, ..Source::plain() };
    Ok(Photo { frame: Frame::full(width, height), pixels, source })
}

/// The next word; one blank after it is consumed.
fn word(reader: &mut impl BufRead) -> Result<String, Reason> {
    let mut text = String::new();
    for byte in reader.by_ref().bytes() {
        match byte? {
            b if b.is_ascii_whitespace() && text.is_empty() => {}
            b if b.is_ascii_whitespace() => return Ok(text),
            b if b.is_ascii_graphic() && text.len() < LONGEST_WORD => text.push(char::from(b)),
            _ => return Err("its header is not that of a PFM file".into()),
        }
    }
    Err("the file is cut short in its header".into())
}

fn number<T: std::str::FromStr>(reader: &mut impl BufRead, what: &str) -> Result<T, Reason> {
    let text = word(reader)?;
    text.parse().map_err(|_| format!("its {what} is {text:?}, which is no such number").into())
}

pub(super) fn write(mut writer: impl Write, photo: &Photo) -> Result<(), Reason> {
    let grey = display::is_grey(photo);
    let kind = if grey { "Pf" } else { "PF" };
    write!(writer, "{kind}\n{} {}\n-1.0\n", photo.width(), photo.height())?;
    let mut line = Vec::with_capacity(photo.width() as usize * 12);
    let gamut = photo.to_file();
    for y in (0..photo.height()).rev() {
        line.clear();
        for &pixel in photo.picture_row(y).iter() {
            let rgb = rec709(pixel, gamut.as_ref());
            line.extend(rgb.iter().take(if grey { 1 } else { 3 }).flat_map(|c| c.to_le_bytes()));
        }
        writer.write_all(&line)?;
    }
    Ok(())
}

/// The colour of a pixel in Rec.709, untouched where it is already.
pub(super) fn rec709([r, g, b, _]: [f32; 4], gamut: Option<&DMat3>) -> [f32; 3] {
    match gamut {
        None => [r, g, b],
        Some(matrix) => (*matrix * glam::DVec3::from([r, g, b].map(f64::from))).to_array().map(|c| c as f32),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(header: &str, samples: &[[u8; 4]]) -> Vec<u8> {
        [header.as_bytes(), samples.as_flattened()].concat()
    }

    #[test]
    fn both_byte_orders_and_rows_from_the_bottom() {
        let values = [1.5_f32, -2.0, f32::from_bits(0x7fa0_1234), 4.0];
        let little = file("Pf\n1 4\n-1\n", &values.map(f32::to_le_bytes));
        let big = file("Pf 1 4 2.5\n", &values.map(f32::to_be_bytes));
        for bytes in [little, big] {
            let photo = read(&bytes[..]).unwrap();
            let got: Vec<_> = photo.pixels.iter().map(|p| p[2].to_bits()).collect();
            assert_eq!(got, [4.0_f32, values[2], -2.0, 1.5].map(f32::to_bits));
        }
    }

    #[test]
    fn bad_headers_say_why() {
        let cases = [
            ("PG\n1 1\n-1\n", "begins with"),
            ("PF\n0 1\n-1\n", "no pixels"),
            ("PF\n1 x\n-1\n", "height"),
            ("PF\n1 -1\n-1\n", "height"),
            ("PF\n1 1\n0\n", "byte order"),
            ("PF\n1 1\nnan\n", "byte order"),
            ("PF\n99999 99999\n-1\n", "more than"),
            ("PF\n1", "cut short"),
            ("PF\n1 1\n-1\n", "buffer"),
        ];
        for (text, why) in cases {
            let error = read(text.as_bytes()).unwrap_err().to_string();
            assert!(error.contains(why), "{text:?}: {error}");
        }
    }
}
