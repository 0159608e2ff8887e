//! Radiance HDR through the `image` crate. The header's EXPOSURE is left alone.

use std::io::{BufRead, Seek, Write};

use image::codecs::hdr::{HdrDecoder, HdrEncoder};
use image::{ImageDecoder, Rgb};
use rayon::prelude::*;

use super::pfm::rec709;
use super::read::check_size;
use super::{Depth, Format, Photo, Reason, Source, zeroed};
use crate::frame::Frame;

/// The largest value: mantissa 255/256, exponent 127.
const LARGEST: f32 = 255.0 / 256.0 * 1.701_411_8e38;
/// What is darker is written as black: the encoder's exponent wraps around below 2^-127.
const SMALLEST: f32 = 1e-38;

pub(super) fn read(reader: impl BufRead + Seek) -> Result<Photo, Reason> {
    // Not strict: `#?RGBE` is as common a first line as `#?RADIANCE`.
    let decoder = HdrDecoder::new_nonstrict(reader)?;
    let (width, height) = decoder.dimensions();
    let count = check_size(width, height)?;
    let mut samples = zeroed::<[f32; 3]>(count)?;
    decoder.read_image(bytemuck::cast_slice_mut(&mut samples))?;
    let pixels = samples.into_par_iter().map(|[r, g, b]| [r, g, b, 1.0]).collect();
    let source = Source { format: Some(Format::Radiance), depth: Depth::Float, ..Source::plain() };
    Ok(Photo { frame: Frame::full(width, height), pixels, source })
}

pub(super) fn write(writer: impl Write, photo: &Photo) -> Result<(), Reason> {
    let (width, height) = (photo.width() as usize, photo.height() as usize);
    let gamut = photo.to_rec709();
    let mut samples = zeroed::<[f32; 3]>(width * height)?;
    samples.par_chunks_exact_mut(width).enumerate().for_each(|(y, row)| {
        for (out, &pixel) in row.iter_mut().zip(photo.picture_row(y as u32).iter()) {
            *out = held(rec709(pixel, gamut.as_ref()));
        }
    });
    let samples: Vec<Rgb<f32>> = samples.into_iter().map(Rgb).collect();
    Ok(HdrEncoder::new(writer).encode(&samples, width, height)?)
}

/// The nearest colour that the format can hold.
fn held(rgb: [f32; 3]) -> [f32; 3] {
    let rgb = rgb.map(|c| if c.is_nan() { 0.0 } else { c.clamp(0.0, LARGEST) });
    if rgb.iter().all(|&c| c < SMALLEST) { [0.0; 3] } else { rgb }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn round_trip(pixels: Vec<[f32; 4]>) -> Vec<[f32; 4]> {
        let mut file = Vec::new();
        write(&mut file, &Photo::new(pixels.len() as u32, 1, pixels)).unwrap();
        read(std::io::Cursor::new(file)).unwrap().pixels
    }

    #[test]
    fn extremes_stay_in_place() {
        let values = [f32::NAN, f32::NEG_INFINITY, -1.0, 1e-45, 1e-39, f32::INFINITY, f32::MAX, LARGEST, 1e38, 0.75];
        let got = round_trip(values.iter().map(|&v| [v, v, v, 1.0]).collect());
        let got: Vec<f32> = got.iter().map(|p| p[1]).collect();
        assert_eq!(got[..5], [0.0; 5]);
        assert_eq!(got[5..8], [LARGEST; 3]);
        assert!((got[8] / 1e38 - 1.0).abs() < 0.01 && got[9] == 0.75, "{got:?}");
    }

    #[test]
    fn what_was_read_is_written_the_same() {
        let once =
            round_trip((0..500).map(|i| [i as f32 * 0.37, (i % 7) as f32 * 1e-3, 2e4 / i as f32, 1.0]).collect());
        assert_eq!(round_trip(once.clone()), once);
    }
}
