//! From the coded data to samples, grey or RGB, by `libjpeg-turbo-rs`.
//!
//! \[APP14\] Adobe Technical Note 5116, section 18: CMYK is stored inverted where Adobe's marker stands.

use libjpeg_turbo_rs::{
    ColorSpace, DecodeLimits, DecodeWarning, Decoder, JpegError, PixelFormat, decompress_12bit_with_limits,
    precision::decompress_lossless_arbitrary,
};

use super::super::{MAX_PIXELS, Reason, zeroed};
use super::planes::{self, Plane};
use super::walk::{self, Process, Scan, Walk};

/// The samples of a picture, pixel by pixel: grey or RGB.
pub(super) enum Samples {
    Eight(Vec<u8>),
    Sixteen(Vec<u16>),
}

/// What was decoded.
pub(super) struct Decoded {
    /// 1 or 3.
    pub channels: usize,
    pub samples: Samples,
}

/// Decodes a picture that [`Walk::check`] let pass; notes say what was amiss with it.
///
/// # Errors
/// Where the data are damaged, end early, or are of a kind that cannot be decoded.
pub(super) fn decode(walk: &Walk, notes: &mut Vec<String>) -> Result<Decoded, Reason> {
    let frame = &walk.frame;
    let samples = match (frame.process, frame.precision) {
        (Process::Lossless, 9..) => {
            let image = decompress_lossless_arbitrary(walk.picture).map_err(|error| reason(error, walk))?;
            Samples::Sixteen(spread(image.data, image.precision))
        }
        (_, 12) if frame.process != Process::Lossless => {
            let image = decompress_12bit_with_limits(walk.picture, &limits()).map_err(|error| reason(error, walk))?;
            Samples::Sixteen(spread(image.data.into_iter().map(|v| v.max(0) as u16).collect(), 12))
        }
        (Process::Lossless, _) | (_, 8) => Samples::Eight(eight(walk, notes)?),
        (_, bits) => return Err(format!("it has {bits} bits a sample; vglare reads JPEG of 8 or 12").into()),
    };
    if walk.missing() == walk::Missing::Detail {
        notes.push(
            "the file is unfinished: the last scans of a progressive JPEG are missing, and with them detail".into(),
        );
    }
    if !walk.ended {
        notes.push("the file has no end marker, but nothing of the picture is missing".into());
    }
    Ok(match (frame.components.len(), samples) {
        (4, Samples::Eight(cmyk)) => Decoded { channels: 3, samples: Samples::Eight(from_cmyk(&cmyk, walk, 255)?) },
        (4, Samples::Sixteen(cmyk)) => {
            Decoded { channels: 3, samples: Samples::Sixteen(from_cmyk(&cmyk, walk, 65535)?) }
        }
        (channels, samples) => Decoded { channels, samples },
    })
}

fn limits() -> DecodeLimits {
    DecodeLimits { max_width: 65535, max_height: 65535, max_pixels: MAX_PIXELS as u64, ..DecodeLimits::default() }
}

/// 8-bit samples with as many channels as there are components: grey, RGB, or CMYK.
fn eight(walk: &Walk, notes: &mut Vec<String>) -> Result<Vec<u8>, Reason> {
    let mut decoder = Decoder::new_with_limits(walk.picture, limits()).map_err(|error| reason(error, walk))?;
    let count = walk.frame.components.len();
    decoder.set_output_format(match count {
        1 => PixelFormat::Grayscale,
        3 => PixelFormat::Rgb,
        _ => PixelFormat::Cmyk,
    });
    if walk.frame.process == Process::Lossless || is_usual(walk) {
        let image = decoder.decode_image().map_err(|error| reason(error, walk))?;
        tell(&image.warnings, notes);
        return Ok(image.data);
    }
    let colours = decoder.jpeg_color_space();
    let planes = if in_parts(walk) { planes_by_scan(walk, notes)? } else { whole_planes(decoder, walk, notes)? };
    let mut pixels = zeroed(walk.frame.width as usize * walk.frame.height as usize * count)?;
    planes::interleave(&walk.frame, &planes, &mut pixels);
    drop(planes);
    if matches!(colours, ColorSpace::YCbCr | ColorSpace::Ycck) {
        planes::ycc_to_rgb(&mut pixels, count);
    }
    if colours == ColorSpace::Ycck {
        pixels.chunks_exact_mut(4).flat_map(|pixel| &mut pixel[..3]).for_each(|v| *v = 255 - *v);
    }
    Ok(pixels)
}

/// Whether the decoder makes pixels of the frame: the first component is sampled most, all factors divide its, and a
/// sequential frame's scans hold one component or all.
fn is_usual(walk: &Walk) -> bool {
    let (h, v) = walk.frame.most();
    let mut components = walk.frame.components.iter();
    let first = &walk.frame.components[0];
    let whole = components.all(|c| h.is_multiple_of(c.h) && v.is_multiple_of(c.v));
    (walk.frame.components.len() == 1 || (first.h, first.v) == (h, v) && whole) && !in_parts(walk)
}

/// Whether scans of a sequential frame hold some of the components, but more than one.
fn in_parts(walk: &Walk) -> bool {
    let all = walk.frame.components.len();
    let part = |scan: &Scan| scan.components.len() > 1 && scan.components.len() < all;
    walk.frame.process == Process::Sequential && walk.scans.iter().any(part)
}

fn whole_planes(decoder: Decoder, walk: &Walk, notes: &mut Vec<String>) -> Result<Vec<Plane>, Reason> {
    let (image, warnings) = decoder.decode_raw_with_warnings().map_err(|error| reason(error, walk))?;
    tell(&warnings, notes);
    let plane = |(samples, stride)| Plane { stride, samples };
    Ok(image.planes.into_iter().zip(image.plane_widths).map(plane).collect())
}

/// The planes of a sequential frame whose scans hold some of the components each: every scan becomes a picture of its
/// own, with the tables that were set before it.
fn planes_by_scan(walk: &Walk, notes: &mut Vec<String>) -> Result<Vec<Plane>, Reason> {
    let mut planes: Vec<Option<Plane>> = walk.frame.components.iter().map(|_| None).collect();
    for (number, scan) in walk.scans.iter().enumerate() {
        let file = alone(walk, number);
        let decoder = Decoder::new_with_limits(&file, limits()).map_err(|error| reason(error, walk))?;
        for (plane, &component) in whole_planes(decoder, walk, notes)?.into_iter().zip(&scan.components) {
            planes[component] = Some(plane);
        }
    }
    let missing = || Reason::from("the file is damaged: some of its colours have no data");
    planes.into_iter().map(|plane| plane.ok_or_else(missing)).collect()
}

/// A picture of one scan's components alone: of their size, since the decoder takes it from the largest factors.
fn alone(walk: &Walk, number: usize) -> Vec<u8> {
    let scan = &walk.scans[number];
    let parts: Vec<_> = scan.components.iter().map(|&component| walk.frame.components[component]).collect();
    let (most_h, most_v) = walk.frame.most();
    // A scan of one component has blocks of that component only, row by row: T.81 A.2.2.
    let single = parts.len() == 1;
    let (h, v) = match single {
        true => (parts[0].h, parts[0].v),
        false => (parts.iter().map(|c| c.h).max().unwrap_or(1), parts.iter().map(|c| c.v).max().unwrap_or(1)),
    };
    let size =
        |length: u32, factor: usize, most: usize| ((length as usize * factor).div_ceil(most) as u16).to_be_bytes();
    let [w1, w0] = size(walk.frame.width, h, most_h);
    let [h1, h0] = size(walk.frame.height, v, most_v);
    let count = parts.len() as u8;
    let mut file = vec![0xff, 0xd8];
    let tables = |marker| matches!(marker, walk::DQT | walk::DHT | walk::DRI);
    for segment in walk.segments.iter().filter(|s| tables(s.marker) && s.scans_before <= number) {
        file.extend(segment.whole);
    }
    file.extend([0xff, walk.frame.marker, 0, 8 + 3 * count, walk.frame.precision, h1, h0, w1, w0, count]);
    for part in &parts {
        let factors = if single { 0x11 } else { (part.h << 4 | part.v) as u8 };
        file.extend([part.id, factors, part.table]);
    }
    file.extend(scan.whole);
    file.extend([0xff, 0xd9]);
    file
}

/// 65535 for full light, whatever the samples' bits.
fn spread(mut samples: Vec<u16>, bits: u8) -> Vec<u16> {
    let most = (1_u32 << bits) - 1;
    samples.iter_mut().for_each(|v| *v = ((u32::from(*v).min(most) * 65535 + most / 2) / most) as u16);
    samples
}

/// RGB of CMYK by the plain product, which is what is left where no CMYK profile is honoured.
fn from_cmyk<T>(cmyk: &[T], walk: &Walk, full: u32) -> Result<Vec<T>, Reason>
where
    T: Copy + Into<u32> + TryFrom<u32> + bytemuck::Zeroable,
{
    // [APP14]
    let inverted = walk.named(0xee, b"Adobe").next().is_some();
    let mut rgb = zeroed::<T>(cmyk.len() / 4 * 3)?;
    for (rgb, pixel) in rgb.chunks_exact_mut(3).zip(cmyk.chunks_exact(4)) {
        let light = |ink: T| if inverted { ink.into() } else { full - ink.into() };
        let key = light(pixel[3]);
        for (rgb, &ink) in rgb.iter_mut().zip(pixel) {
            // At most 65535², which a u32 holds.
            *rgb = T::try_from((light(ink) * key + full / 2) / full).unwrap_or(ink);
        }
    }
    Ok(rgb)
}

fn tell(warnings: &[DecodeWarning], notes: &mut Vec<String>) {
    for warning in warnings {
        let note = match warning {
            DecodeWarning::ExtraneousData { bytes: 1 } => "a stray byte between its markers was passed over".into(),
            DecodeWarning::ExtraneousData { bytes } => {
                format!("{bytes} stray bytes between its markers were passed over")
            }
            other => format!("the file is damaged: {other}"),
        };
        if !notes.contains(&note) {
            notes.push(note);
        }
    }
}

fn reason(error: JpegError, walk: &Walk) -> Reason {
    match error {
        JpegError::UnexpectedEof if walk.ended => "the file is damaged: its data end before the picture does".into(),
        JpegError::UnexpectedEof => "the file is cut short".into(),
        JpegError::AllocationFailed { bytes, .. } => format!("not enough memory: {bytes} bytes to decode it").into(),
        JpegError::Unsupported(what) => format!("it is a JPEG that cannot be decoded: {what}").into(),
        JpegError::CorruptData(what) => format!("the file is damaged: {what}").into(),
        other => format!("the file is damaged: {other}").into(),
    }
}
