//! Whether a block can be what it says that it is, before a decoder takes memory for it.
//!
//! A decoder that believes a size of gigabytes does not fail where there is no memory: it ends the process.

use exr::compression::Compression;
use exr::math::Vec2;
use exr::meta::attribute::{ChannelDescription, SampleType};
use exr::meta::header::Header;

use super::super::Reason;

/// Bytes that a block may unfold to.
const LARGEST_BLOCK: usize = 1 << 31;

/// Deflate turns one byte into 1032 at most (zlib's technical details: 258 bytes by two bits).
const DEFLATE: usize = 1032;

/// OpenEXR's run lengths: two bytes for up to 128.
const RUN_LENGTH: usize = 64;

/// PIZ's Huffman code: at best 9 bits for 255 more numbers of two bytes.
const HUFFMAN: usize = 512;

/// PXR24 stores a float's four bytes as three, within Deflate.
const PXR24: usize = DEFLATE * 4 / 3;

/// Memory that decoders take, in bytes a byte of the block: what comes out, and what lies between.
const WORKING_MEMORY: usize = 4;

/// The same for DWA, which holds each sample as an f32 of three colours.
const DWA_WORKING_MEMORY: usize = 16;

/// Prefixes times channels beyond which the crate's DWA decoder, which compares each with each, takes seconds a block.
const MOST_DWA_NAMES: usize = 1 << 20;

/// Checks that a block of `width` × `height` pixels can hold the `expected` bytes.
///
/// # Errors
/// Where it cannot, or there is no memory for it.
pub(super) fn check(header: &Header, size: Vec2<usize>, packed: &[u8], expected: usize) -> Result<(), Reason> {
    if expected > LARGEST_BLOCK {
        return Err(format!("it says that a block has {expected} bytes, more than {LARGEST_BLOCK}").into());
    }
    if packed.is_empty() {
        return Err("the file is damaged: a block is empty".into());
    }
    let memory = match header.compression {
        Compression::HTJ2K32 | Compression::HTJ2K256 => {
            return Err("it is compressed by HTJ2K, which vglare does not read".into());
        }
        // What did not shrink stands as it is.
        _ if packed.len() == expected => expected,
        Compression::DWAA(_) | Compression::DWAB(_) => expected.saturating_mul(DWA_WORKING_MEMORY),
        _ => expected.saturating_mul(WORKING_MEMORY),
    };
    if packed.len() != expected {
        let most = match header.compression {
            Compression::Uncompressed => 0,
            Compression::RLE => packed.len().saturating_mul(RUN_LENGTH),
            Compression::ZIP1 | Compression::ZIP16 => packed.len().saturating_mul(DEFLATE),
            Compression::PXR24 => packed.len().saturating_mul(PXR24),
            Compression::PIZ => packed.len().saturating_mul(HUFFMAN),
            Compression::B44 | Compression::B44A if least_b44(header, size) > packed.len() => 0,
            Compression::DWAA(_) | Compression::DWAB(_) => dwa(header, size, packed, expected)?,
            // The crate turns down what it does not know by name.
            _ => usize::MAX,
        };
        if most < expected {
            let got = packed.len();
            return Err(format!("the file is damaged: {got} bytes cannot be a block of {expected}").into());
        }
    }
    affordable(memory)
}

/// Whether the system would give so much memory now.
pub(super) fn affordable(bytes: usize) -> Result<(), Reason> {
    let mut memory: Vec<u8> = Vec::new();
    memory
        .try_reserve_exact(bytes)
        .map_err(|_| format!("not enough memory for a block of the file ({bytes} bytes)"))?;
    Ok(())
}

fn samples(channel: &ChannelDescription, Vec2(width, height): Vec2<usize>) -> (usize, usize) {
    let Vec2(across, down) = channel.sampling;
    (width / across.max(1), height / down.max(1))
}

/// Bytes of a B44 block whose every 4 × 4 half samples are of one value; other types stand as they are.
fn least_b44(header: &Header, size: Vec2<usize>) -> usize {
    let least = |channel: &ChannelDescription| match (samples(channel, size), channel.sample_type) {
        ((width, height), SampleType::F16) => width.div_ceil(4) * height.div_ceil(4) * 3,
        ((width, height), _) => width * height * 4,
    };
    header.channels.list.iter().map(least).sum()
}

/// The most bytes that a DWA block can unfold to, by the counters at its start.
fn dwa(header: &Header, size: Vec2<usize>, packed: &[u8], expected: usize) -> Result<usize, Reason> {
    let damaged = || Reason::from("the file is damaged: the counters of a DWA block contradict its bytes");
    let channels = &header.channels.list;
    let mut prefixes: Vec<_> = channels.iter().map(|c| super::names::text(&c.name)).collect();
    prefixes.sort_unstable_by(|a, b| super::names::split(a).0.cmp(super::names::split(b).0));
    prefixes.dedup_by(|a, b| super::names::split(a).0 == super::names::split(b).0);
    if prefixes.len() * channels.len() > MOST_DWA_NAMES {
        return Err(format!("it has {} layers in one DWA compressed part, too many to be true", prefixes.len()).into());
    }
    let (counters, body) = packed.split_at_checked(11 * 8).ok_or_else(damaged)?;
    let counters = counters.as_chunks().0.iter().map(|&bytes| usize::try_from(u64::from_le_bytes(bytes)));
    let counters: Vec<usize> = counters.collect::<Result<_, _>>().map_err(|_| damaged())?;
    let [_version, unknown, unknown_packed, ac_packed, dc_packed, rle_packed, rle, rle_raw, ac, dc, ac_kind] =
        counters[..].try_into().map_err(|_| damaged())?;
    let parts = [unknown_packed, ac_packed, dc_packed, rle_packed];
    let sum = parts.iter().try_fold(0_usize, |sum, &part| sum.checked_add(part));
    // A block of 8 × 8 samples has one DC number and up to 63 AC numbers, with an end mark.
    let of_channel = |channel| samples(channel, size);
    let blocks: usize = channels.iter().map(of_channel).map(|(w, h)| w.div_ceil(8) * h.div_ceil(8)).sum();
    let within = |count: usize, packed: usize, ratio: usize| count <= packed.saturating_mul(ratio);
    let sound = sum.is_some_and(|sum| sum <= body.len())
        && unknown <= expected
        && within(unknown, unknown_packed, DEFLATE)
        && ac <= blocks.saturating_mul(64)
        && within(ac.saturating_mul(2), ac_packed, if ac_kind == 1 { DEFLATE } else { HUFFMAN })
        && dc <= blocks
        && within(dc.saturating_mul(2), dc_packed, DEFLATE)
        && within(rle, rle_packed, DEFLATE)
        && rle_raw <= expected
        && within(rle_raw, rle, RUN_LENGTH);
    if !sound {
        return Err(damaged());
    }
    Ok(unknown + rle_raw + dc.saturating_mul(64 * 4))
}
