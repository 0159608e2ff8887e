//! Strips and tiles that are pictures of their own: JPEG and WebP.

use std::io::Cursor;

use image_webp::WebPDecoder;
use zune_jpeg::JpegDecoder;
use zune_jpeg::zune_core::bytestream::ZCursor;
use zune_jpeg::zune_core::colorspace::ColorSpace;
use zune_jpeg::zune_core::options::DecoderOptions;

use super::super::{Reason, zeroed};
use super::compression::Compression;
use super::layout::Layout;
use super::pieces::Block;
use super::samples::Code;

/// Columns and rows by which such a picture may be larger than it says outside: the rest of a block.
const MARGIN: u32 = 64;
/// Scans of a progressive JPEG; each costs the time of a whole picture, and encoders write about ten.
const MOST_SCANS: usize = 32;

/// The samples of a strip or tile of `size` pixels, of which the picture needs the first `needed`.
pub(super) fn decode<C: Code>(
    layout: &Layout,
    tables: Option<&[u8]>,
    packed: Vec<u8>,
    size: (u32, u32),
    needed: (u32, u32),
) -> Result<Block<C>, Reason> {
    let check = |(width, height): (u32, u32), samples: usize| {
        if samples != layout.together() {
            return Err(format!("it holds {samples} samples a pixel instead of {}", layout.together()).into());
        }
        if width < needed.0 || height < needed.1 || width > size.0 + MARGIN || height > size.1 + MARGIN {
            return Err(format!("it is {width} × {height} instead of {} × {}", size.0, size.1).into());
        }
        Ok::<_, Reason>(width as usize)
    };
    let (width, bytes) = match layout.compression {
        Compression::Jpeg => jpeg(layout, tables, packed, check)?,
        _ => webp(packed, layout.together(), check)?,
    };
    Ok(Block { width, samples: bytes.into_iter().map(|code| C::cut(u64::from(code))).collect() })
}

type Check<T> = Result<T, Reason>;

fn jpeg(
    layout: &Layout,
    tables: Option<&[u8]>,
    packed: Vec<u8>,
    check: impl Fn((u32, u32), usize) -> Check<usize>,
) -> Result<(usize, Vec<u8>), Reason> {
    if !packed.windows(2).any(|pair| pair == [0xff, 0xd9]) {
        return Err("it is cut short".into());
    }
    // TIFF technical note 2: tables stand in a stream of their own, from the start marker to the end marker.
    let stream = match tables {
        Some([head @ .., 0xff, 0xd9]) if head.len() > 2 => [head, packed.get(2..).unwrap_or_default()].concat(),
        _ => packed,
    };
    let options = DecoderOptions::default().set_strict_mode(true).jpeg_set_max_scans(MOST_SCANS);
    let options = options.set_max_width(65535).set_max_height(65535);
    let mut decoder = JpegDecoder::new_with_options(ZCursor::new(stream), options);
    decoder.decode_headers()?;
    let stored = decoder.input_colorspace().ok_or("it has no colours")?;
    // Without a conversion the samples are those that the TIFF's own tags describe.
    let colours = if layout.converted { ColorSpace::RGB } else { stored };
    decoder.set_options(options.jpeg_set_out_colorspace(colours));
    let info = decoder.info().ok_or("it has no header")?;
    let width = check((info.width.into(), info.height.into()), colours.num_components())?;
    Ok((width, decoder.decode()?))
}

fn webp(
    packed: Vec<u8>,
    wanted: usize,
    check: impl Fn((u32, u32), usize) -> Check<usize>,
) -> Result<(usize, Vec<u8>), Reason> {
    let mut decoder = WebPDecoder::new(Cursor::new(packed))?;
    let stored = if decoder.has_alpha() { 4 } else { 3 };
    // A tile that is opaque throughout may hold no alpha, and one without alpha an opaque one.
    let width = check(decoder.dimensions(), if matches!(wanted, 3 | 4) { wanted } else { stored })?;
    let mut bytes = zeroed(decoder.output_buffer_size().ok_or("it is too large")?)?;
    decoder.read_image(&mut bytes)?;
    if stored != wanted {
        let pixels = bytes.chunks_exact(stored);
        bytes = pixels.flat_map(|pixel| pixel.iter().copied().chain([u8::MAX]).take(wanted)).collect();
    }
    Ok((width, bytes))
}
