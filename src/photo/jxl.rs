//! JPEG XL (ISO/IEC 18181), read by `jxl-oxide`.
//!
//! Lossless files of libjxl 0.11, of 8 bit and of floats, are read to the bit. Of some 4700 files that were cut short or had bytes changed none
//! made the decoder panic, or take more than 0.05 s (December 2026); damage that a coding without checksums cannot tell, it does not.
//!
//! Integers are meant for displays, floats are scene-linear light once their curve is undone, as in TIFF. The colour space is that of
//! the codestream, be it named or an ICC profile. Orientation is the codestream's, whatever Exif says; of an animation the
//! first picture is read.

use std::io::{BufRead, Cursor, Seek};

use image::metadata::Orientation;
use jxl_oxide::image::BitDepth;
use jxl_oxide::{AllocTracker, AuxBoxData, InitializeResult, JxlImage};
use rayon::prelude::*;

use super::camera::Camera;
use super::decode::{Encoding, Raster, divide_by_alpha};
use super::metadata::Metadata;
use super::read::check_size;
use super::transfer::Curve;
use super::{Alpha, Depth, Format, Photo, ReadOptions, Reason, cicp, icc, zeroed};

/// What a decoder may take besides a picture's planes, and for each of its pixels: planes of floats in several steps.
const AROUND: usize = 256 << 20;
const FOR_A_PIXEL: usize = 128;

/// Bytes that are handed over at a time, until the size is known.
const CHUNK: usize = 1 << 16;

pub(super) fn read(mut reader: impl BufRead + Seek, options: &ReadOptions) -> Result<Photo, Reason> {
    let mut file = Vec::new();
    reader.read_to_end(&mut file)?;
    let (width, height) = size(&file)?;
    let room = AROUND + FOR_A_PIXEL * check_size(width, height)?;
    let image =
        JxlImage::builder().alloc_tracker(AllocTracker::with_limit(room)).read(Cursor::new(&file)).map_err(damaged)?;
    if !image.is_loading_done() {
        return Err("the file is cut short".into());
    }
    let format = image.pixel_format();
    if format.has_black() {
        return Err("its colours are CMYK, which vglare does not read in JPEG XL".into());
    }
    let mut notes = Vec::new();
    if image.num_loaded_keyframes() > 1 {
        notes.push(format!("it is an animation of {} pictures; the first is read", image.num_loaded_keyframes()));
    }
    let metadata = &image.image_header().metadata;
    let (depth, is_float) = match metadata.bit_depth {
        BitDepth::FloatSample { .. } => (Depth::Float, true),
        BitDepth::IntegerSample { bits_per_sample: ..=8 } => (Depth::Eight, false),
        BitDepth::IntegerSample { .. } => (Depth::Sixteen, false),
    };
    let associated = metadata.ec_info.iter().find_map(|channel| channel.alpha_associated());
    let encoding = encoding(&image, format.is_grayscale(), options, &mut notes);
    let (mut samples, turn) = samples(&image)?;
    let channels = format.channels();
    // Codes of colours that are multiplied by alpha mean those that are not: see `tiff::light`.
    let divided = associated == Some(true) && !is_float;
    if divided {
        samples.par_chunks_exact_mut(channels).for_each(divide_by_alpha);
    }
    let alpha = if associated == Some(true) { Alpha::Premultiplied } else { Alpha::Straight };
    let (width, height) = (image.width(), image.height());
    let raster = Raster { width, height, channels, samples, planar: false };
    // It lies upright already.
    let mut photo = raster.into_photo(Format::JpegXl, alpha, &encoding, Orientation::NoTransforms)?;
    if divided {
        photo.pixels.par_iter_mut().for_each(|[r, g, b, a]| (*r, *g, *b) = (*r * *a, *g * *a, *b * *a));
    }
    photo.source.depth = depth;
    photo.source.display_referred = depth.is_display();
    photo.source.notes.append(&mut notes);
    beside(&image, turn, &mut photo);
    Ok(photo)
}

/// Columns and rows, as they are shown, by as little of the file as tells them.
fn size(file: &[u8]) -> Result<(u32, u32), Reason> {
    let mut image = JxlImage::builder().build_uninit();
    let mut waiting = Vec::new();
    for chunk in file.chunks(CHUNK) {
        waiting.extend(chunk);
        let taken = image.feed_bytes(&waiting).map_err(damaged)?;
        waiting.drain(..taken);
        image = match image.try_init().map_err(damaged)? {
            InitializeResult::NeedMoreData(image) => image,
            InitializeResult::Initialized(image) => return Ok((image.width(), image.height())),
        };
    }
    Err("the file is cut short".into())
}

/// All samples, pixel by pixel, and how the picture was turned for them.
fn samples(image: &JxlImage) -> Result<(Vec<f32>, Orientation), Reason> {
    let render = image.render_frame(0).map_err(damaged)?;
    let mut stream = render.stream();
    let count = stream.width() as usize * stream.height() as usize * stream.channels() as usize;
    let mut samples = zeroed::<f32>(count)?;
    if stream.write_to_buffer(&mut samples) != count {
        return Err("the file is damaged: some of its picture is missing".into());
    }
    let turn = u8::try_from(render.orientation()).ok().and_then(Orientation::from_exif);
    Ok((samples, turn.unwrap_or(Orientation::NoTransforms)))
}

fn encoding(image: &JxlImage, grey: bool, options: &ReadOptions, notes: &mut Vec<String>) -> Encoding {
    if let Some([primaries, transfer, ..]) = image.rendered_cicp()
        && let Some((curve, primaries)) = cicp::curve(transfer).zip(cicp::primaries(primaries))
    {
        return Encoding::new(curve, options.primaries.or(Some(primaries)));
    }
    icc::encoding(&image.rendered_icc(), grey, Curve::Srgb, options, notes)
}

/// What stands in the file's other boxes.
fn beside(image: &JxlImage, turn: Orientation, photo: &mut Photo) {
    let mut metadata = Metadata::default();
    match image.aux_boxes().first_exif() {
        Ok(AuxBoxData::Data(exif)) => {
            let raw = exif.payload().get(exif.tiff_header_offset() as usize..).unwrap_or_default();
            photo.source.camera = Camera::of_raw_exif(raw, turn);
            metadata.take_exif(raw, turn);
        }
        Ok(_) => (),
        // It does not say where it begins.
        Err(_) => metadata.take_exif(&[], turn),
    }
    if let AuxBoxData::Data(xml) = image.aux_boxes().first_xml()
        && let Ok(packet) = std::str::from_utf8(xml)
    {
        metadata.take_xmp(packet, turn);
    }
    metadata.attach(photo);
}

fn damaged(error: Reason) -> Reason {
    let text = error.to_string();
    if error.downcast_ref::<std::io::Error>().is_some() || text.contains("reader ended") {
        return "the file is cut short".into();
    }
    format!("the file is damaged, or of a kind of JPEG XL that is not read: {text}").into()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn input(name: &str) -> Vec<u8> {
        std::fs::read(format!("{}/tests/inputs/{name}", env!("CARGO_MANIFEST_DIR"))).unwrap()
    }

    fn photo(name: &str) -> Photo {
        read(Cursor::new(input(name)), &ReadOptions::default()).unwrap()
    }

    /// Red, green and blue at column and row: what the files were made of.
    fn code(x: usize, y: usize) -> [u8; 3] {
        [8 * x, (10 * y).min(255), 255 - 5 * x - y].map(|code| code as u8)
    }

    #[test]
    fn lossless_pictures_are_read_to_the_bit() {
        let eight = photo("jxl-8-bit-lossless.jxl");
        let float = photo("jxl-float-linear.jxl");
        assert_eq!((eight.width(), eight.height(), eight.source.depth), (32, 24, Depth::Eight));
        assert!(eight.source.display_referred && !float.source.display_referred);
        for (i, (eight, float)) in eight.pixels.iter().zip(&float.pixels).enumerate() {
            let code = code(i % 32, i / 32);
            let light = code.map(|code| Curve::Srgb.light(f64::from(code) / 255.0) as f32);
            assert!((0..3).all(|c| (eight[c] - light[c]).abs() < 1e-6), "{i}: {eight:?} for {light:?}");
            let wanted = code.map(|code| (f64::from(code) / 255.0 * 4.0) as f32);
            assert!((0..3).all(|c| (float[c] - wanted[c]).abs() < 1e-6), "{i}: {float:?} for {wanted:?}");
        }
    }

    #[test]
    fn grey_and_alpha_are_told() {
        let grey = photo("jxl-grey-lossy.jxl");
        assert!(grey.source.grey && grey.source.alpha == Alpha::None);
        // At quality 90 codes are off by a few.
        for (i, pixel) in grey.pixels.iter().enumerate() {
            let wanted = Curve::Srgb.light(f64::from(code(i % 32, 0)[0]) / 255.0) as f32;
            assert!((pixel[0] - wanted).abs() < 0.03, "{i}: {pixel:?} for {wanted}");
        }
        let alpha = photo("jxl-alpha-exif.jxl");
        assert_eq!(alpha.source.alpha, Alpha::Straight);
        assert!(
            alpha.pixels.iter().enumerate().all(|(i, pixel)| (pixel[3] - (i % 32) as f32 * 8.0 / 255.0).abs() < 1e-6)
        );
        let beside = alpha.source.metadata.as_ref().expect("Exif and XMP");
        assert!(beside.exif.as_ref().unwrap().bytes().windows(9).any(|word| word == b"The maker"));
        assert!(beside.xmp.as_ref().unwrap().contains("xmpmeta"), "{:?}", beside.xmp);
    }

    #[test]
    fn damaged_files_are_refused_or_read_but_never_more() {
        for name in ["jxl-8-bit-lossless.jxl", "jxl-grey-lossy.jxl", "jxl-alpha-exif.jxl"] {
            let whole = input(name);
            for cut in 0..whole.len() - 1 {
                let read = read(Cursor::new(&whole[..cut]), &ReadOptions::default());
                assert!(read.is_err(), "{name} cut at {cut}");
            }
            for at in 0..whole.len() {
                let mut bad = whole.clone();
                bad[at] = bad[at].wrapping_add(0x55);
                let _ = read(Cursor::new(bad), &ReadOptions::default());
            }
        }
    }
}
