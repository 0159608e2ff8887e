//! The file as a container: headers, the table of where each block is, and the blocks, still compressed.
//!
//! The crate's own reader believes the table and the sizes that it meets. This one takes no memory for what the file
//! is too short to hold, and finds the blocks of a file whose table was never written, as OpenEXR does: one after
//! another.

use std::io::{BufRead, Read as _, Seek, SeekFrom};

use exr::block::chunk::{
    Chunk, CompressedBlock, CompressedDeepScanLineBlock, CompressedDeepTileBlock, CompressedScanLineBlock,
    CompressedTileBlock, TileCoordinates,
};
use exr::math::Vec2;
use exr::meta::header::Header;
use exr::meta::{BlockDescription, MetaData};
use rustc_hash::{FxHashMap, FxHashSet};

use super::super::{Missing, Reason};
use super::explain;
use super::unpack::plain;

/// Bytes of an entry of the table.
const ENTRY: u64 = 8;

/// Bytes within which the attributes of most files are.
const HEADERS: u64 = 1 << 16;

/// A file whose headers are read.
pub(super) struct Blocks<R> {
    reader: R,
    /// Where `reader` stands.
    position: u64,
    /// Bytes of the file.
    length: u64,
    /// Where the first block may begin.
    start: u64,
    pub meta: MetaData,
    /// For each part, its blocks' indices.
    places: Vec<FxHashMap<TileCoordinates, usize>>,
    /// For each part and index, whether the block has come.
    came: Vec<Vec<bool>>,
    /// Where the blocks are, sorted, the next one last.
    offsets: Vec<u64>,
}

/// What stands before a block's bytes.
struct Head {
    part: usize,
    tile: TileCoordinates,
    /// Of a scan line block.
    y: i32,
    /// Bytes that follow.
    size: usize,
    /// Of deep data: how many of these are the table of samples, and how many bytes the samples have once they are decompressed.
    deep: Option<(usize, usize)>,
}

/// A block of the file.
pub(super) struct Block {
    /// Its index within its part.
    pub index: usize,
    pub tile: TileCoordinates,
    pub chunk: Chunk,
}

/// The blocks that a file lacks.
pub(super) struct Gaps {
    /// How many of the wanted blocks are not there, and how many there should be.
    missing: usize,
    total: usize,
    /// Whether the file ends within its blocks; else they were never written.
    cut: bool,
}

impl<R: BufRead + Seek> Blocks<R> {
    /// Reads the headers.
    ///
    /// # Errors
    /// Where they are damaged, or describe more blocks than a file of this length has room for.
    pub fn open(mut reader: R) -> Result<Self, Reason> {
        let length = reader.seek(SeekFrom::End(0))?;
        reader.rewind()?;
        let meta = match MetaData::read_from_buffered(&mut reader, true) {
            Ok(meta) => meta,
            Err(error) => return Err(new_compression(reader).unwrap_or_else(|| explain(error))),
        };
        for header in &meta.headers {
            check_sampling(header)?;
        }
        MetaData::validate(&plain(&meta.headers), false).map_err(explain)?;
        let position = reader.stream_position()?;
        let mut table = 0;
        for header in &meta.headers {
            // Before the crate counts levels: what it multiplies there may overflow.
            if largest_level_blocks(header) > length / ENTRY {
                return Err("the file is cut short".into());
            }
            table += header.chunk_count as u64 * ENTRY;
        }
        if position + table > length {
            return Err("the file is cut short".into());
        }
        let index =
            |header: &Header| header.blocks_increasing_y_order().enumerate().map(|(i, t)| (t.location, i)).collect();
        let places = meta.headers.iter().map(index).collect();
        let came = meta.headers.iter().map(|header| vec![false; header.chunk_count]).collect();
        Ok(Self { reader, position, length, start: position + table, meta, places, came, offsets: Vec::new() })
    }

    /// Finds the blocks, of which `wanted` says which matter. None are missing, or there are gaps.
    pub fn find(&mut self, wanted: impl Fn(usize, TileCoordinates) -> bool) -> Result<Option<Gaps>, Reason> {
        let entries = (self.start - self.position) / ENTRY;
        let table = (0..entries).map(|_| self.number().map(u64::from_le_bytes)).collect::<Result<Vec<_>, _>>()?;
        let (start, length) = (self.start, self.length);
        let is_inside = |offset: &u64| (start..length).contains(offset);
        self.offsets = table.iter().copied().filter(is_inside).collect();
        self.offsets.sort_unstable_by(|a, b| b.cmp(a));
        self.offsets.dedup();
        let last = self.offsets.first().copied();
        let last_is_whole = last.is_some() && self.head(last.unwrap_or_default())?.is_some();
        if self.offsets.len() == table.len() && last_is_whole {
            return Ok(None);
        }
        let found = self.walk()?;
        let is_wanted = |(part, places): (usize, &FxHashMap<TileCoordinates, usize>)| {
            places.keys().filter(|&&tile| wanted(part, tile)).count()
        };
        let total = self.places.iter().enumerate().map(is_wanted).sum();
        let there = found.iter().filter(|&&(part, tile)| wanted(part, tile)).count();
        let cut = table.iter().any(|&offset| offset >= length) || last.is_some() && !last_is_whole;
        Ok((there < total).then_some(Gaps { missing: total - there, total, cut }))
    }

    /// Goes from block to block, and to those that the table knows.
    fn walk(&mut self) -> Result<FxHashSet<(usize, TileCoordinates)>, Reason> {
        let (mut found, mut offsets) = (FxHashSet::default(), Vec::new());
        let mut at = self.start;
        while let Some(head) = self.head(at)? {
            found.insert((head.part, head.tile));
            offsets.push(at);
            at = self.position + head.size as u64;
        }
        for offset in std::mem::take(&mut self.offsets) {
            if let Some(head) = self.head(offset)?
                && found.insert((head.part, head.tile))
            {
                offsets.push(offset);
            }
        }
        offsets.sort_unstable_by(|a, b| b.cmp(a));
        self.offsets = offsets;
        Ok(found)
    }

    /// The next block that is wanted.
    pub fn next(&mut self, wanted: impl Fn(usize, TileCoordinates) -> bool) -> Result<Option<Block>, Reason> {
        while let Some(offset) = self.offsets.pop() {
            let head = self.head(offset)?.ok_or("the file is damaged: a block is not where its table says")?;
            let index = self.places[head.part][&head.tile];
            if std::mem::replace(&mut self.came[head.part][index], true) {
                return Err("the file is damaged: a block is there twice".into());
            }
            if !wanted(head.part, head.tile) {
                continue;
            }
            let mut compressed_pixels_le = vec![0; head.size];
            self.reader.read_exact(&mut compressed_pixels_le)?;
            self.position += head.size as u64;
            let blocks = self.meta.headers[head.part].blocks;
            let compressed_block = match (blocks, head.deep) {
                (_, Some(deep)) => deep_block(&head, blocks, deep, &compressed_pixels_le),
                (BlockDescription::ScanLines, None) => {
                    CompressedBlock::ScanLine(CompressedScanLineBlock { y_coordinate: head.y, compressed_pixels_le })
                }
                (BlockDescription::Tiles(_), None) => {
                    CompressedBlock::Tile(CompressedTileBlock { coordinates: head.tile, compressed_pixels_le })
                }
            };
            let chunk = Chunk { layer_index: head.part, compressed_block };
            return Ok(Some(Block { index, tile: head.tile, chunk }));
        }
        Ok(None)
    }

    /// The blocks of a part that have not come.
    pub fn absent(&self, part: usize) -> impl Iterator<Item = (usize, TileCoordinates)> {
        let places = self.places[part].iter().map(|(&tile, &index)| (index, tile));
        places.filter(move |&(index, _)| !self.came[part][index])
    }

    /// What stands before the block at `offset`, if one of this file's is there, and whole.
    fn head(&mut self, offset: u64) -> Result<Option<Head>, Reason> {
        let is_multipart = self.meta.requirements.has_multiple_layers;
        // The least head: part, row, size.
        if offset + if is_multipart { 12 } else { 8 } > self.length {
            return Ok(None);
        }
        self.go(offset)?;
        let part = if is_multipart { i32::from_le_bytes(self.number()?) } else { 0 };
        let Some(header) = usize::try_from(part).ok().and_then(|part| self.meta.headers.get(part)) else {
            return Ok(None);
        };
        let (blocks, top) = (header.blocks, header.own_attributes.layer_position.y());
        let lines = header.compression.scan_lines_per_block();
        let is_deep = header.deep;
        let place = if blocks == BlockDescription::ScanLines { 4 } else { 16 };
        if self.position + place + if is_deep { 24 } else { 4 } > self.length {
            return Ok(None);
        }
        let mut y = 0;
        let tile = if blocks == BlockDescription::ScanLines {
            y = i32::from_le_bytes(self.number()?);
            let row = usize::try_from(i64::from(y) - i64::from(top)).ok().map(|row| row / lines);
            row.map(|row| TileCoordinates { tile_index: Vec2(0, row), level_index: Vec2(0, 0) })
        } else {
            let mut numbers = [None; 4];
            for number in &mut numbers {
                *number = usize::try_from(i32::from_le_bytes(self.number()?)).ok();
            }
            match numbers {
                [Some(x), Some(y), Some(level_x), Some(level_y)] => {
                    Some(TileCoordinates { tile_index: Vec2(x, y), level_index: Vec2(level_x, level_y) })
                }
                _ => None,
            }
        };
        let (size, deep) = if is_deep {
            let [table, samples, unpacked] = [self.number()?, self.number()?, self.number()?].map(u64::from_le_bytes);
            (table.saturating_add(samples), Some((table as usize, unpacked as usize)))
        } else {
            (u64::try_from(i32::from_le_bytes(self.number()?)).unwrap_or(u64::MAX), None)
        };
        let is_whole = size > 0 && size <= self.length - self.position;
        let part = part as usize;
        let tile = tile.filter(|tile| is_whole && self.places[part].contains_key(tile));
        Ok(tile.map(|tile| Head { part, tile, y, size: size as usize, deep }))
    }

    fn number<const N: usize>(&mut self) -> Result<[u8; N], Reason> {
        let mut bytes = [0; N];
        self.reader.read_exact(&mut bytes)?;
        self.position += N as u64;
        Ok(bytes)
    }

    fn go(&mut self, to: u64) -> Result<(), Reason> {
        if self.position != to {
            self.position = self.reader.seek(SeekFrom::Start(to))?;
        }
        Ok(())
    }
}

impl Gaps {
    /// Whether they may be filled: the note to give, or the refusal.
    pub fn answer(&self, missing: Missing) -> Result<String, Reason> {
        let Self { missing: count, total, cut } = self;
        let state = if *cut { "the file is cut short" } else { "the file is unfinished" };
        if count == total {
            return Err(format!("{state}: all of its {total} blocks are missing").into());
        }
        let are = if *count == 1 { "is" } else { "are" };
        let lack = format!("{state}: {count} of its {total} blocks {are} missing");
        match missing {
            Missing::Refuse => Err(format!("{lack}; --missing zero reads the rest").into()),
            Missing::Zero => Ok(format!("{lack}, and their pixels are 0")),
        }
    }
}

/// The refusal of a compression that has a name, and that the crate does not know.
fn new_compression(mut reader: impl BufRead + Seek) -> Option<Reason> {
    const ATTRIBUTE: &[u8] = b"compression\0compression\0\x01\0\0\0";
    // By OpenEXR 3.5's ImfCompression.h.
    const NAMES: [(u8, &str); 2] = [(12, "LJ2K"), (13, "Zstandard")];
    let mut head = Vec::new();
    reader.rewind().ok()?;
    reader.take(HEADERS).read_to_end(&mut head).ok()?;
    let values = head.windows(ATTRIBUTE.len() + 1).filter_map(|bytes| bytes.strip_prefix(ATTRIBUTE));
    let mut names = values.filter_map(|value| NAMES.iter().find(|(code, _)| *code == value[0]));
    names.next().map(|(_, name)| format!("it is compressed by {name}, which vglare does not read").into())
}

/// A block of deep data: the table of how many samples each pixel has, then the samples, both compressed.
fn deep_block(
    head: &Head,
    blocks: BlockDescription,
    (table, unpacked): (usize, usize),
    bytes: &[u8],
) -> CompressedBlock {
    let (table, samples) = bytes.split_at(table);
    let compressed_pixel_offset_table = bytemuck::cast_slice(table).to_vec();
    let (compressed_sample_data_le, decompressed_sample_data_size) = (samples.to_vec(), unpacked);
    match blocks {
        BlockDescription::ScanLines => CompressedBlock::DeepScanLine(CompressedDeepScanLineBlock {
            y_coordinate: head.y,
            decompressed_sample_data_size,
            compressed_pixel_offset_table,
            compressed_sample_data_le,
        }),
        BlockDescription::Tiles(_) => CompressedBlock::DeepTile(CompressedDeepTileBlock {
            coordinates: head.tile,
            decompressed_sample_data_size,
            compressed_pixel_offset_table,
            compressed_sample_data_le,
        }),
    }
}

/// Blocks of a part's largest level; at most 2^62.
fn largest_level_blocks(header: &Header) -> u64 {
    let Vec2(width, height) = header.layer_size;
    let Vec2(across, down) = header.max_block_pixel_size();
    width.div_ceil(across.max(1)) as u64 * height.div_ceil(down.max(1)) as u64
}

/// Subsampled channels as the format allows them: in scan lines, in step with the window.
fn check_sampling(header: &Header) -> Result<(), Reason> {
    let (at, size) = (header.own_attributes.layer_position, header.layer_size);
    for channel in header.channels.list.iter().filter(|channel| channel.sampling != Vec2(1, 1)) {
        let in_step = |at: i32, size: usize, step: usize| {
            step > 0 && size.is_multiple_of(step) && i64::from(at) % step as i64 == 0
        };
        let Vec2(across, down) = channel.sampling;
        let fits = in_step(at.x(), size.width(), across) && in_step(at.y(), size.height(), down);
        if !fits || header.blocks.has_tiles() {
            let name = super::names::text(&channel.name);
            return Err(
                format!("the file is damaged: the channel {name} cannot be subsampled by {across} × {down}").into()
            );
        }
    }
    Ok(())
}
