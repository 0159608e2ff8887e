//! Reads the strips or tiles of a picture and puts their samples where they belong.

use std::io::{Read, Seek};

use rayon::prelude::*;

use super::super::read::MAX_PIXELS;
use super::super::{Reason, zeroed};
use super::compression::Compression;
use super::directory::File;
use super::layout::Layout;
use super::samples::{self, Code, stored_bytes};
use super::{picture, sgi_log};

/// The samples that are kept of all pixels, pixel by pixel, as they are stored.
pub(super) enum Codes {
    /// Up to 8 bits.
    U8(Vec<u8>),
    /// 9 to 16.
    U16(Vec<u16>),
    /// 17 to 32.
    U32(Vec<u32>),
    /// 64.
    U64(Vec<u64>),
}

/// What is read and unpacked at a time: enough for all cores, little beside the picture.
const BATCH_BYTES: u64 = 1 << 26;
const BATCH_PIECES: usize = 4096;
/// Plain strips are cut into rows of about so many bytes, so that they can be unpacked side by side.
const PLAIN_BYTES: u64 = 1 << 20;

/// A strip, a tile, or some rows of a plain strip.
struct Piece {
    /// Its number in the file.
    index: usize,
    offset: u64,
    bytes: u64,
    /// Where it stands in the picture.
    at: (u32, u32),
    /// Columns and rows that are stored.
    size: (u32, u32),
    plane: usize,
    /// Bytes that it unpacks to.
    unpacked: u64,
}

pub(super) fn read<R: Read + Seek>(
    file: &mut File<R>,
    layout: &Layout,
    tables: Option<&[u8]>,
) -> Result<Codes, Reason> {
    Ok(match layout.bits {
        ..=8 => Codes::U8(read_as(file, layout, tables)?),
        9..=16 => Codes::U16(read_as(file, layout, tables)?),
        17..=32 => Codes::U32(read_as(file, layout, tables)?),
        _ => Codes::U64(read_as(file, layout, tables)?),
    })
}

fn read_as<R: Read + Seek, C: Code>(
    file: &mut File<R>,
    layout: &Layout,
    tables: Option<&[u8]>,
) -> Result<Vec<C>, Reason> {
    let pieces = pieces(layout, file.length())?;
    let count = layout.width as usize * layout.height as usize * layout.kept.len();
    let mut picture = zeroed::<C>(count)?;
    let mut rest = &pieces[..];
    while !rest.is_empty() {
        let mut sum = 0;
        let fits = |piece: &&Piece| {
            sum += piece.unpacked + piece.bytes;
            sum <= BATCH_BYTES
        };
        let length = rest.iter().take(BATCH_PIECES).take_while(fits).count().max(1);
        let (batch, later) = rest.split_at(length);
        rest = later;
        let packed = batch.iter().map(|piece| file.bytes(piece.offset, piece.bytes)).collect::<Result<Vec<_>, _>>()?;
        let unpacked: Vec<Block<C>> = (batch.par_iter().zip(packed))
            .map(|(piece, packed)| {
                let name = |reason| format!("{}: {reason}", layout.grid.name(piece.index)).into();
                decode(layout, tables, piece, packed).map_err(name)
            })
            .collect::<Result<_, Reason>>()?;
        batch.iter().zip(unpacked).for_each(|(piece, block)| place(layout, &mut picture, piece, &block));
    }
    Ok(picture)
}

/// Where all pieces are that hold samples which are kept, checked against the size of the file.
fn pieces(layout: &Layout, length: u64) -> Result<Vec<Piece>, Reason> {
    let grid = &layout.grid;
    let in_plane = grid.count.0 as usize * grid.count.1 as usize;
    let mut pieces = Vec::new();
    for (index, &(offset, bytes)) in grid.pieces.iter().enumerate() {
        let plane = index / in_plane;
        if layout.planar && !layout.kept.contains(&plane) {
            continue;
        }
        let (column, row) = (index % in_plane % grid.count.0 as usize, index % in_plane / grid.count.0 as usize);
        let at = (column as u32 * grid.size.0, row as u32 * grid.size.1);
        let rows = if grid.tiled { grid.size.1 } else { grid.size.1.min(layout.height - at.1) };
        let unpacked = unpacked_bytes(layout, grid.size.0, rows)?;
        let bytes = match bytes {
            _ if offset == 0 => return Err(format!("the file is cut short: {} is missing", grid.name(index)).into()),
            0 if layout.compression == Compression::None => unpacked,
            0 => length.saturating_sub(offset),
            _ => bytes,
        };
        if bytes.saturating_mul(layout.compression.most()).saturating_add(1 << 12) < unpacked
            || layout.compression == Compression::None && bytes < unpacked
        {
            let name = grid.name(index);
            return Err(format!("the file is cut short: {name} has {bytes} bytes for {unpacked}").into());
        }
        let piece = Piece { index, offset, bytes, at, size: (grid.size.0, rows), plane, unpacked };
        if layout.compression == Compression::None && layout.subsampling == (1, 1) {
            add_rows(&mut pieces, &piece, unpacked / u64::from(rows));
        } else {
            pieces.push(piece);
        }
    }
    Ok(pieces)
}

fn unpacked_bytes(layout: &Layout, width: u32, rows: u32) -> Result<u64, Reason> {
    let bytes = stored_bytes(layout, width, rows).filter(|&bytes| bytes <= MAX_PIXELS as u64 * 16);
    bytes.ok_or_else(|| format!("its strips or tiles are of more than {} bytes", MAX_PIXELS as u64 * 16).into())
}

/// Cuts a plain piece into rows.
fn add_rows(pieces: &mut Vec<Piece>, whole: &Piece, row_bytes: u64) {
    let step = (PLAIN_BYTES / row_bytes.max(1)).clamp(1, u64::from(whole.size.1)) as usize;
    for first in (0..whole.size.1).step_by(step) {
        let rows = (step as u32).min(whole.size.1 - first);
        let bytes = u64::from(rows) * row_bytes;
        pieces.push(Piece {
            offset: whole.offset.saturating_add(u64::from(first) * row_bytes),
            bytes,
            at: (whole.at.0, whole.at.1 + first),
            size: (whole.size.0, rows),
            unpacked: bytes,
            ..*whole
        });
    }
}

/// The samples of a piece, row by row.
pub(super) struct Block<C> {
    /// Pixels of a row.
    pub width: usize,
    pub samples: Vec<C>,
}

fn decode<C: Code>(
    layout: &Layout,
    tables: Option<&[u8]>,
    piece: &Piece,
    mut packed: Vec<u8>,
) -> Result<Block<C>, Reason> {
    let (width, rows) = (piece.size.0 as usize, piece.size.1 as usize);
    if layout.compression.is_picture() {
        let needed = (piece.size.0.min(layout.width - piece.at.0), piece.size.1.min(layout.height - piece.at.1));
        return picture::decode(layout, tables, packed, piece.size, needed);
    }
    if layout.lowest_bit_first {
        packed.iter_mut().for_each(|byte| *byte = byte.reverse_bits());
    }
    if layout.compression == Compression::SgiLog {
        return Ok(Block { width, samples: sgi_log::unpack(&packed, width, rows, layout.bits)? });
    }
    let bytes = layout.compression.unpack(packed, usize::try_from(piece.unpacked)?, width)?;
    Ok(Block { width, samples: samples::unpack(layout, bytes, width, rows) })
}

/// Copies the samples that are kept into the picture; tiles may reach beyond it.
fn place<C: Code>(layout: &Layout, picture: &mut [C], piece: &Piece, block: &Block<C>) {
    let (width, kept, together) = (layout.width as usize, layout.kept.len(), layout.together());
    let (x, y) = (piece.at.0 as usize, piece.at.1 as usize);
    let columns = block.width.min(width - x);
    let rows = (piece.size.1 as usize).min((layout.height as usize).saturating_sub(y));
    let whole = !layout.planar && kept == layout.samples;
    let channel = layout.kept.iter().position(|&kept| kept == piece.plane).unwrap_or(0);
    for (row, samples) in block.samples.chunks_exact(block.width * together).take(rows).enumerate() {
        let out = &mut picture[((y + row) * width + x) * kept..][..columns * kept];
        let pixels = samples.chunks_exact(together);
        if whole {
            out.copy_from_slice(&samples[..columns * kept]);
        } else if layout.planar {
            out.chunks_exact_mut(kept).zip(samples).for_each(|(out, &sample)| out[channel] = sample);
        } else {
            for (out, pixel) in out.chunks_exact_mut(kept).zip(pixels) {
                out.iter_mut().zip(&layout.kept).for_each(|(out, &sample)| *out = pixel[sample]);
            }
        }
    }
}
