//! The bytes of a block: how samples lie in it, and how it is decompressed and compressed, subsampled channels too.
//!
//! A block holds rows from top to bottom, in each the channels by name, in each the samples from left to right. A
//! channel that is subsampled by sx × sy has a sample in every sx-th column of every sy-th row. The crate knows none of
//! these; what is here presents such a block to its decoders as something that they know.

use std::ops::Range;

use exr::compression::Compression;
use exr::math::Vec2;
use exr::meta::attribute::{ChannelDescription, ChannelList, IntegerBounds, LineOrder, SampleType};
use exr::meta::header::Header;
use exr::meta::{BlockDescription, Headers};

use super::super::Reason;
use super::{explain, guard};

/// A row of a channel within a block.
pub(super) struct Line {
    /// Index of the channel.
    pub channel: usize,
    /// Which of the block's bytes.
    pub bytes: Range<usize>,
    /// Of the first sample, among those of the channel: column and row.
    pub at: (usize, usize),
    /// How many samples there are.
    pub count: usize,
}

/// The rows of a block that covers `area` of a part, in the order of their bytes.
pub(super) fn lines(channels: &ChannelList, area: IntegerBounds) -> impl Iterator<Item = Line> {
    let (left, top) = (area.position.x() as usize, area.position.y() as usize);
    let Vec2(width, height) = area.size;
    let mut end = 0;
    let rows = (top..top + height).flat_map(move |y| channels.list.iter().enumerate().map(move |(c, d)| (y, c, d)));
    rows.filter(|&(y, _, channel)| y.is_multiple_of(channel.sampling.y())).map(move |(y, channel, description)| {
        let Vec2(across, down) = description.sampling;
        let count = width / across;
        let start = end;
        end += count * description.sample_type.bytes_per_sample();
        Line { channel, bytes: start..end, at: (left / across, y / down), count }
    })
}

/// How many bytes a block has.
pub(super) fn size(channels: &ChannelList, area: IntegerBounds) -> usize {
    if is_plain(channels) {
        return area.size.area().saturating_mul(channels.bytes_per_pixel);
    }
    lines(channels, area).last().map_or(0, |line| line.bytes.end)
}

/// The columns and rows of a channel's samples in a part of `size` pixels.
pub(super) fn plane(channel: &ChannelDescription, Vec2(width, height): Vec2<usize>) -> (usize, usize) {
    (width / channel.sampling.x(), height / channel.sampling.y())
}

/// Whether no channel is subsampled.
pub(super) fn is_plain(channels: &ChannelList) -> bool {
    channels.list.iter().all(|channel| channel.sampling == Vec2(1, 1))
}

/// The headers as if no channel were subsampled and no part deep, which the crate's checks turn down.
pub(super) fn plain(headers: &Headers) -> Headers {
    let mut headers = headers.clone();
    for header in &mut headers {
        header.channels.list.iter_mut().for_each(|channel| channel.sampling = Vec2(1, 1));
        header.deep = false;
    }
    headers
}

/// Decompresses a block that covers `area` into bytes of the machine's order.
///
/// # Errors
/// Where it is damaged.
pub(super) fn unpack(header: &Header, area: IntegerBounds, packed: Vec<u8>) -> Result<Vec<u8>, Reason> {
    let channels = &header.channels;
    let expected = size(channels, area);
    guard::check(header, area.size, &packed, expected)?;
    if is_plain(&header.channels) {
        let bytes = header.compression.decompress_image_section_from_le(header, packed, area, false);
        return bytes.map_err(explain);
    }
    if packed.len() == expected {
        return Ok(swapped(packed, &header.channels, area));
    }
    match header.compression {
        Compression::RLE | Compression::ZIP1 | Compression::ZIP16 => {
            let (header, row) = as_one_row(header.compression, expected);
            let bytes = header.compression.decompress_image_section_from_le(&header, packed, row, false);
            Ok(swapped(halves_swapped(bytes.map_err(explain)?), channels, area))
        }
        Compression::B44 | Compression::B44A => by_channel(header, area, &packed, expected),
        compression => {
            // The crate reckons a block's bytes by its pixels; the decoders themselves know of subsampling.
            let pixels = area.size.area();
            if !expected.is_multiple_of(pixels) {
                return Err(format!(
                    "it has channels subsampled in a way that vglare does not read with {compression}"
                )
                .into());
            }
            let mut header = bare(compression, header.channels.clone(), header.layer_size);
            header.channels.bytes_per_pixel = expected / pixels;
            compression.decompress_image_section_from_le(&header, packed, area, false).map_err(explain)
        }
    }
}

/// Compresses a block's bytes, without loss where channels are subsampled.
///
/// # Errors
/// Where the compression is none that the crate can write.
pub(super) fn pack(header: &Header, area: IntegerBounds, bytes: Vec<u8>) -> Result<Vec<u8>, Reason> {
    if is_plain(&header.channels) {
        return header.compression.compress_image_section_to_le(header, bytes, area).map_err(explain);
    }
    let (row_header, row) = as_one_row(header.compression, bytes.len());
    let bytes = halves_swapped(swapped(bytes, &header.channels, area));
    row_header.compression.compress_image_section_to_le(&row_header, bytes, row).map_err(explain)
}

/// A header of nothing but an encoding.
fn bare(compression: Compression, channels: ChannelList, size: Vec2<usize>) -> Header {
    let header = Header { channels, ..Header::new("".into(), size, Default::default()) };
    header.with_encoding(compression, BlockDescription::ScanLines, LineOrder::Increasing)
}

/// A header of one row of half samples, and its area: for compressions that see a block as bytes alone.
fn as_one_row(compression: Compression, bytes: usize) -> (Header, IntegerBounds) {
    let row = Vec2(bytes / 2, 1);
    let half = ChannelDescription::named("", SampleType::F16);
    let channels = ChannelList::new([half].into_iter().collect());
    (bare(compression, channels, row), IntegerBounds::from_dimensions(row))
}

/// B44 packs each channel by itself, in blocks of 4 × 4 samples of 3 or 14 bytes: each is decoded as a picture of its
/// own, filled up to whole blocks, which the decoder cannot take for one that did not shrink.
fn by_channel(header: &Header, area: IntegerBounds, packed: &[u8], expected: usize) -> Result<Vec<u8>, Reason> {
    let short = || Reason::from("the file is damaged: a block ends early");
    let mut rest = packed;
    let mut planes = Vec::new();
    for channel in &header.channels.list {
        let (width, height) = plane(channel, area.size);
        if channel.sample_type != SampleType::F16 {
            let (raw, after) = rest.split_at_checked(width * height * 4).ok_or_else(short)?;
            planes.push(raw.as_chunks().0.iter().flat_map(|&b| u32::from_le_bytes(b).to_ne_bytes()).collect());
            rest = after;
            continue;
        }
        let whole = Vec2(width.next_multiple_of(4), height.next_multiple_of(4));
        let mut length = 0;
        for _ in 0..whole.area() / 16 {
            // A shift that no block of 14 bytes has marks one of 3 bytes.
            length += if *rest.get(length + 2).ok_or_else(short)? >= 13 << 2 { 3 } else { 14 };
        }
        let (blocks, after) = rest.split_at_checked(length).ok_or_else(short)?;
        rest = after;
        let alone = ChannelDescription { sampling: Vec2(1, 1), ..channel.clone() };
        let alone = bare(header.compression, ChannelList::new([alone].into_iter().collect()), Vec2(whole.x(), 32));
        let bounds = IntegerBounds::from_dimensions(whole);
        let bytes = header.compression.decompress_image_section_from_le(&alone, blocks.to_vec(), bounds, false);
        let bytes = bytes.map_err(explain)?;
        planes
            .push(bytes.chunks_exact(whole.x() * 2).take(height).flat_map(|row| &row[..width * 2]).copied().collect());
    }
    let mut out = vec![0; expected];
    let mut rows: Vec<std::slice::Iter<u8>> = planes.iter().map(|plane: &Vec<u8>| plane.iter()).collect();
    for line in lines(&header.channels, area) {
        out[line.bytes].iter_mut().zip(&mut rows[line.channel]).for_each(|(out, &byte)| *out = byte);
    }
    Ok(out)
}

/// Samples between the file's order of bytes and the machine's.
fn swapped(mut bytes: Vec<u8>, channels: &ChannelList, area: IntegerBounds) -> Vec<u8> {
    if cfg!(target_endian = "big") {
        for line in lines(channels, area) {
            let size = channels.list[line.channel].sample_type.bytes_per_sample();
            bytes[line.bytes].chunks_exact_mut(size).for_each(<[u8]>::reverse);
        }
    }
    bytes
}

/// The same for bytes that the crate takes for half samples.
fn halves_swapped(mut bytes: Vec<u8>) -> Vec<u8> {
    if cfg!(target_endian = "big") {
        bytes.chunks_exact_mut(2).for_each(<[u8]>::reverse);
    }
    bytes
}
