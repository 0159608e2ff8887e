//! From the samples of a TIFF to a photo.

use std::io::{Read, Seek};

use half::f16;
use image::metadata::Orientation;
use rayon::prelude::*;

use super::super::decode::{Encoding, Raster, Sample, divide_by_alpha};
use super::super::icc;
use super::super::transfer::Curve;
use super::super::{Alpha, Depth, Format, Photo, ReadOptions, Reason};
use super::colour::{self, Cmyk, YCbCr};
use super::directory::{Directory, File, tag};
use super::layout::{Colour, Kind, Layout};
use super::pieces::Codes;

/// The largest ICC profile that is looked at.
const LARGEST_PROFILE: u64 = icc::LARGEST as u64;

/// What the tags say that the samples mean.
pub(super) struct Meaning {
    icc: Option<Vec<u8>>,
    /// Red, green and blue of all indices, 16 bit each, one colour after another.
    palette: Vec<u64>,
    ycbcr: YCbCr,
    orientation: Orientation,
    options: ReadOptions,
    notes: Vec<String>,
}

impl Meaning {
    pub fn of<R: Read + Seek>(
        file: &mut File<R>,
        page: &Directory,
        layout: &Layout,
        options: ReadOptions,
    ) -> Result<Self, Reason> {
        let mut notes = Vec::new();
        let size = file.size_of(page, tag::ICC_PROFILE);
        let icc = if size > LARGEST_PROFILE {
            let (size, limit) = (size >> 20, LARGEST_PROFILE >> 20);
            notes.push(format!("its ICC profile of {size} MiB is left aside: vglare reads those of up to {limit} MiB"));
            None
        } else {
            file.raw(page, tag::ICC_PROFILE)?.filter(|icc| !icc.is_empty())
        };
        let palette = match layout.colour {
            Colour::Palette => {
                let entries = 3 << layout.bits;
                let palette = file.numbers(page, tag::COLOR_MAP, entries)?.unwrap_or_default();
                if palette.len() < entries {
                    return Err(format!("its palette has {} numbers instead of {entries}", palette.len()).into());
                }
                palette
            }
            _ => Vec::new(),
        };
        let ycbcr = match layout.colour {
            Colour::YCbCr => YCbCr::new(
                file.reals(page, tag::YCBCR_COEFFICIENTS, 3)?,
                file.reals(page, tag::REFERENCE_BLACK_WHITE, 6)?,
                layout.bits,
            )?,
            _ => YCbCr::default(),
        };
        let orientation = file.number(page, tag::ORIENTATION).ok().flatten();
        let orientation = orientation.and_then(|turn| Orientation::from_exif(u8::try_from(turn).ok()?));
        match layout.spare() {
            0 => {}
            1 => notes.push("its pixels have a channel that is neither colour nor alpha: it is left out".into()),
            n => {
                notes.push(format!("its pixels have {n} channels that are neither colour nor alpha: they are left out"))
            }
        }
        if layout.kind == Kind::Signed && !matches!(layout.colour, Colour::CieLab | Colour::IccLab) {
            notes.push("its samples are signed integers: the largest is taken for white, negative ones stay so".into());
        }
        let orientation = orientation.unwrap_or(Orientation::NoTransforms);
        Ok(Self { icc, palette, ycbcr, orientation, options, notes })
    }

    /// How the picture is to be turned to be upright.
    pub fn orientation(&self) -> Orientation {
        self.orientation
    }

    /// What grey or RGB samples mean: by the profile, else light where they are floats, and sRGB where they are integers.
    fn encoding(&mut self, layout: &Layout, grey: bool) -> Encoding {
        let is_float = layout.kind == Kind::Float;
        let curve = if is_float { Curve::Linear } else { Curve::Srgb };
        match &self.icc {
            // Primaries that were named go with the photo and not with its encoding: it is scene-linear.
            Some(_) if is_float && self.options.primaries.is_some() => {
                self.notes
                    .push("its ICC profile is left out, since primaries were named: its numbers are light".into());
                Encoding::new(curve, None)
            }
            Some(icc) => icc::encoding(icc, grey, curve, &self.options, &mut self.notes),
            None => Encoding::new(curve, self.options.primaries.filter(|_| !is_float)),
        }
    }
}

pub(super) fn into_photo(codes: Codes, layout: &Layout, meaning: Meaning) -> Result<Photo, Reason> {
    let plain = matches!(layout.colour, Colour::Grey | Colour::GreyInverted | Colour::Rgb);
    let codes_of_display = layout.kind == Kind::Unsigned && layout.alpha != Alpha::Premultiplied;
    let inverted = layout.colour == Colour::GreyInverted;
    match (codes, layout.bits) {
        (Codes::U8(mut codes), bits @ (1 | 2 | 4 | 8)) if plain && codes_of_display => {
            let scale = 255 / (u8::MAX >> (8 - bits));
            if scale > 1 {
                codes.par_iter_mut().for_each(|code| *code *= scale);
            }
            if inverted {
                invert(&mut codes, layout.kept.len(), |code| u8::MAX - code);
            }
            raster(codes, layout, layout.kept.len()).finish(layout, meaning)
        }
        (Codes::U16(mut codes), 16) if plain && codes_of_display => {
            if inverted {
                invert(&mut codes, layout.kept.len(), |code| u16::MAX - code);
            }
            raster(codes, layout, layout.kept.len()).finish(layout, meaning)
        }
        (codes, _) if layout.colour == Colour::Palette => by_palette(codes, layout, meaning),
        (codes, _) if matches!(layout.colour, Colour::LogL | Colour::LogLuv) => by_logarithm(codes, layout, meaning),
        (codes, _) if matches!(layout.colour, Colour::CieLab | Colour::IccLab) => by_lab(codes, layout, meaning),
        (codes, _) => by_values(codes, layout, meaning),
    }
}

/// Grey of which white is zero; alpha, where there is one, stays.
fn invert<T: Copy + Send + Sync>(samples: &mut [T], channels: usize, invert: impl Fn(T) -> T + Sync) {
    samples.par_chunks_exact_mut(channels).for_each(|pixel| pixel[0] = invert(pixel[0]));
}

/// A raster and the way from its samples to light, where that is not the file's own.
struct Decoded<T> {
    raster: Raster<T>,
    curve: Option<Curve>,
}

fn raster<T>(samples: Vec<T>, layout: &Layout, channels: usize) -> Decoded<T> {
    let raster = Raster { width: layout.width, height: layout.height, channels, samples, planar: false };
    Decoded { raster, curve: None }
}

impl<T: Sample> Decoded<T> {
    /// The photo; straight alpha.
    fn finish(self, layout: &Layout, mut meaning: Meaning) -> Result<Photo, Reason> {
        let encoding = match self.curve {
            Some(curve) => Encoding::new(curve, None),
            None => meaning.encoding(layout, self.raster.channels < 3),
        };
        // Colours that were converted have no codes of their own.
        let converted = matches!(layout.colour, Colour::Cmyk | Colour::CieLab | Colour::IccLab);
        let alpha = if layout.alpha == Alpha::None { Alpha::None } else { Alpha::Straight };
        let mut photo = self.raster.into_photo(Format::Tiff, alpha, &encoding, meaning.orientation)?;
        photo.source.depth = depth(layout);
        if converted {
            photo.source.native = None;
        }
        photo.source.display_referred = photo.source.depth.is_display();
        photo.source.notes = meaning.notes;
        Ok(photo)
    }
}

/// The depth of which the samples are nearest.
fn depth(layout: &Layout) -> Depth {
    match (layout.colour, layout.kind, layout.bits) {
        (Colour::LogL | Colour::LogLuv, ..) => Depth::Float,
        (_, Kind::Float, 16) => Depth::Half,
        (_, Kind::Float, _) => Depth::Float,
        (_, _, ..=8) => Depth::Eight,
        _ => Depth::Sixteen,
    }
}

/// Colours of a table, of 8 bit where they are repeated in both bytes of the table's 16, as they are meant to be.
fn by_palette(codes: Codes, layout: &Layout, meaning: Meaning) -> Result<Photo, Reason> {
    let count = 1 << layout.bits;
    let palette = &meaning.palette;
    // Old writers put 8 bits into the lower byte, and Pillow and others into the upper one alone.
    let small = palette.iter().all(|&value| value < 256);
    let upper = palette.iter().all(|&value| value & 0xff == 0);
    let eight = small || upper || palette.iter().all(|&value| value >> 8 == value & 0xff);
    let shift = if eight && !small { 8 } else { 0 };
    let colour = |index: usize| [index, count + index, 2 * count + index].map(|at| palette[at] >> shift);
    let indices: Vec<u16> = match codes {
        Codes::U8(codes) => codes.into_iter().map(u16::from).collect(),
        Codes::U16(codes) => codes,
        _ => return Err("its palette is too large".into()),
    };
    let (kept, top) = (layout.kept.len(), (count - 1) as u64);
    // With a second channel, alpha follows the colour.
    let pixel = |pixel: &[u16], full: u64| {
        let [r, g, b] = colour(usize::from(pixel[0]));
        let alpha = pixel.get(1).map_or(0, |&alpha| u64::from(alpha) * full / top);
        [r, g, b, alpha]
    };
    let channels = 2 + kept;
    if eight {
        let pixels = indices.chunks_exact(kept).map(|index| pixel(index, 255).map(|value| value as u8));
        let samples = pixels.flat_map(|pixel| pixel.into_iter().take(channels)).collect();
        raster::<u8>(samples, layout, channels).finish(layout, meaning)
    } else {
        let pixels = indices.chunks_exact(kept).map(|index| pixel(index, 65535).map(|value| value as u16));
        let samples = pixels.flat_map(|pixel| pixel.into_iter().take(channels)).collect();
        raster::<u16>(samples, layout, channels).finish(layout, meaning)
    }
}

fn by_logarithm(codes: Codes, layout: &Layout, meaning: Meaning) -> Result<Photo, Reason> {
    let (samples, channels): (Vec<f32>, _) = match codes {
        Codes::U16(codes) => (codes.into_par_iter().map(|code| super::sgi_log::luminance(code) as f32).collect(), 1),
        Codes::U32(codes) => {
            let matrix = super::sgi_log::to_rec709();
            (codes.into_par_iter().flat_map_iter(|code| super::sgi_log::colour(code, &matrix)).collect(), 3)
        }
        _ => return Err("its LogLuv codes are of another depth".into()),
    };
    Decoded { curve: Some(Curve::Linear), ..raster(samples, layout, channels) }.finish(layout, meaning)
}

fn by_lab(codes: Codes, layout: &Layout, meaning: Meaning) -> Result<Photo, Reason> {
    let icc = layout.colour == Colour::IccLab;
    let kept = layout.kept.len();
    let samples = match codes {
        Codes::U8(codes) => colour::lab_to_light(
            &codes,
            kept,
            |code| f64::from(code) / 255.0,
            |code| match icc {
                true => f64::from(code) - 128.0,
                false => f64::from(code as i8),
            },
        ),
        Codes::U16(codes) => {
            let top = if icc { 65280.0 } else { 65535.0 };
            colour::lab_to_light(
                &codes,
                kept,
                |code| f64::from(code) / top,
                |code| match icc {
                    true => f64::from(code) / 256.0 - 128.0,
                    false => f64::from(code as i16) / 256.0,
                },
            )
        }
        _ => return Err("its Lab codes are of another depth".into()),
    };
    Decoded { curve: Some(Curve::Linear), ..raster(samples, layout, kept) }.finish(layout, meaning)
}

/// The way of all others: numbers of which 1 is white.
fn by_values(codes: Codes, layout: &Layout, mut meaning: Meaning) -> Result<Photo, Reason> {
    let mut values = values(codes, layout, &mut meaning.notes);
    let kept = layout.kept.len();
    if layout.colour == Colour::GreyInverted {
        invert(&mut values, kept, |value| 1.0 - value);
    }
    let integers = layout.kind != Kind::Float;
    let plain = matches!(layout.colour, Colour::Grey | Colour::GreyInverted | Colour::Rgb);
    let associated = layout.alpha == Alpha::Premultiplied && (plain || layout.colour == Colour::Cmyk);
    if associated && integers {
        values.par_chunks_exact_mut(kept).for_each(divide_by_alpha);
    }
    let mut photo = match layout.colour {
        Colour::Cmyk => {
            let cmyk = Cmyk::new(meaning.icc.as_deref(), &mut meaning.notes);
            let samples = cmyk.convert(&values, kept)?;
            Decoded { curve: Some(cmyk.curve()), ..raster(samples, layout, kept - 1) }.finish(layout, meaning)?
        }
        Colour::YCbCr => {
            values.par_chunks_exact_mut(kept).for_each(|pixel| meaning.ycbcr.convert(pixel));
            raster(values, layout, kept).finish(layout, meaning)?
        }
        _ => raster(values, layout, kept).finish(layout, meaning)?,
    };
    if associated {
        photo.source.alpha = Alpha::Premultiplied;
        if integers {
            photo.pixels.par_iter_mut().for_each(|[r, g, b, a]| (*r, *g, *b) = (*r * *a, *g * *a, *b * *a));
        }
    }
    Ok(photo)
}

/// The samples as numbers of which 1 is the largest integer; floats as they are.
fn values(codes: Codes, layout: &Layout, notes: &mut Vec<String>) -> Vec<f32> {
    let bits = layout.bits;
    let integer = move |code: u32| match layout.kind {
        Kind::Signed => {
            let signed = (code << (32 - bits)) as i32 >> (32 - bits);
            (f64::from(signed) / f64::from(i32::MAX >> (32 - bits))) as f32
        }
        _ => (f64::from(code) / f64::from(u32::MAX >> (32 - bits))) as f32,
    };
    match (codes, layout.kind) {
        (Codes::U16(codes), Kind::Float) => codes.into_par_iter().map(|code| f16::from_bits(code).to_f32()).collect(),
        (Codes::U32(codes), Kind::Float) if bits == 24 => codes.into_par_iter().map(float24).collect(),
        (Codes::U32(codes), Kind::Float) => bytemuck::allocation::cast_vec(codes),
        (Codes::U64(codes), _) => {
            let single = |code: u64| f64::from_bits(code) as f32;
            let beyond =
                codes.par_iter().filter(|&&code| f64::from_bits(code).is_finite() && single(code).is_infinite());
            match beyond.count() {
                0 => {}
                1 => notes.push("a sample is too large for a float of 32 bit: it is infinite".into()),
                n => notes.push(format!("{n} samples are too large for floats of 32 bit: they are infinite")),
            }
            codes.into_par_iter().map(single).collect()
        }
        (Codes::U8(codes), _) => codes.into_par_iter().map(|code| integer(code.into())).collect(),
        (Codes::U16(codes), _) => codes.into_par_iter().map(|code| integer(code.into())).collect(),
        (Codes::U32(codes), _) => codes.into_par_iter().map(integer).collect(),
    }
}

/// TIFF technical note 3: a sign, 7 bits of exponent with a bias of 63, 16 of mantissa.
fn float24(code: u32) -> f32 {
    let (exponent, mantissa) = (code >> 16 & 0x7f, code & 0xffff);
    let size = match exponent {
        0 => mantissa as f32 * (-78_f32).exp2(),
        0x7f if mantissa == 0 => f32::INFINITY,
        0x7f => f32::NAN,
        _ => f32::from_bits((exponent + 64) << 23 | mantissa << 7),
    };
    if code >> 23 & 1 == 1 { -size } else { size }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn floats_of_24_bit_are_those_of_the_note() {
        // Sign, exponent and mantissa by hand.
        for (code, value) in [
            (0x3f_0000, 1.0),
            (0xbf_8000, -1.5),
            (0x40_0000, 2.0),
            (0x7e_ffff, 2.0_f32.powi(63) * (2.0 - 2.0_f32.powi(-16))),
            (0x01_0000, 2.0_f32.powi(-62)),
            (0x00_0001, 2.0_f32.powi(-78)),
            (0x7f_0000, f32::INFINITY),
        ] {
            assert_eq!(float24(code), value, "{code:x}");
        }
        assert!(float24(0x7f_0001).is_nan());
    }
}
