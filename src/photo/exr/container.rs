//! The file to be, as a container: headers, the table of where each block is, and blocks.
//!
//! The crate's own writer turns down subsampled channels and deep data, whose blocks are copied as they are.

use std::io::{Seek, SeekFrom, Write};

use exr::block::chunk::{Chunk, CompressedBlock, TileCoordinates};
use exr::math::Vec2;
use exr::meta::attribute::{self, AttributeValue, BlockType};
use exr::meta::header::{Header, standard_names};
use exr::meta::{BlockDescription, Headers, MetaData, magic_number};

use super::super::Reason;
use super::unpack::plain;
use super::{attributes, explain};

/// A file whose headers are written.
pub(super) struct Container<W> {
    writer: W,
    pub headers: Headers,
    /// Where the table begins, and what it will hold.
    table: (u64, Vec<Vec<u64>>),
    position: u64,
}

impl<W: Write + Seek> Container<W> {
    /// Writes the headers.
    pub fn new(mut writer: W, mut headers: Headers) -> Result<Self, Reason> {
        headers.iter_mut().for_each(attributes::whole_key_codes);
        let mut requirements = MetaData::validate(&plain(&headers), false).map_err(explain)?;
        requirements.has_deep_data = headers.iter().any(|header| header.deep);
        magic_number::write(&mut writer).map_err(explain)?;
        requirements.write(&mut writer).map_err(explain)?;
        for header in &headers {
            write_header(&mut writer, header)?;
        }
        if requirements.has_multiple_layers {
            writer.write_all(&[0])?;
        }
        let start = writer.stream_position()?;
        let table: Vec<Vec<u64>> = headers.iter().map(|header| vec![0; header.chunk_count]).collect();
        let count: usize = table.iter().map(Vec::len).sum();
        writer.write_all(&vec![0; count * size_of::<u64>()])?;
        let position = start + (count * size_of::<u64>()) as u64;
        Ok(Self { writer, headers, table: (start, table), position })
    }

    /// Writes a block, which has this index within its part.
    pub fn put(&mut self, index: usize, chunk: &Chunk) -> Result<(), Reason> {
        self.table.1[chunk.layer_index][index] = self.position;
        let part = if self.headers.len() > 1 { 4 } else { 0 };
        let bytes = match &chunk.compressed_block {
            CompressedBlock::ScanLine(block) => 8 + block.compressed_pixels_le.len(),
            CompressedBlock::Tile(block) => 20 + block.compressed_pixels_le.len(),
            CompressedBlock::DeepScanLine(block) => {
                let sizes = (&block.compressed_pixel_offset_table[..], block.decompressed_sample_data_size);
                self.put_deep(chunk, &[block.y_coordinate], sizes, &block.compressed_sample_data_le)?
            }
            CompressedBlock::DeepTile(block) => {
                let TileCoordinates { tile_index: Vec2(x, y), level_index: Vec2(level_x, level_y) } = block.coordinates;
                let place = [x, y, level_x, level_y].map(|number| number as i32);
                let sizes = (&block.compressed_pixel_offset_table[..], block.decompressed_sample_data_size);
                self.put_deep(chunk, &place, sizes, &block.compressed_sample_data_le)?
            }
        };
        if !self.headers[chunk.layer_index].deep {
            chunk.write(&mut self.writer, self.headers.len()).map_err(explain)?;
        }
        self.position += (part + bytes) as u64;
        Ok(())
    }

    /// Writes a block of deep data, and says how many bytes it has without the number of its part. (The crate's own writer takes a block
    /// without any samples for an error.)
    fn put_deep(
        &mut self,
        chunk: &Chunk,
        place: &[i32],
        sizes: (&[i8], usize),
        samples: &[u8],
    ) -> Result<usize, Reason> {
        let (table, unpacked) = sizes;
        if self.headers.len() > 1 {
            self.writer.write_all(&i32::try_from(chunk.layer_index)?.to_le_bytes())?;
        }
        for number in place {
            self.writer.write_all(&number.to_le_bytes())?;
        }
        for size in [table.len(), samples.len(), unpacked] {
            self.writer.write_all(&(size as u64).to_le_bytes())?;
        }
        self.writer.write_all(bytemuck::cast_slice(table))?;
        self.writer.write_all(samples)?;
        Ok(4 * place.len() + 24 + table.len() + samples.len())
    }

    /// Writes the blocks, part by part: first those that `own` writes of a part, then those of `chunks`; and the table.
    pub fn finish(
        mut self,
        chunks: &[&(usize, Chunk)],
        own: impl Fn(&mut Self, usize) -> Result<(), Reason>,
    ) -> Result<(), Reason> {
        let mut chunks = chunks.to_vec();
        chunks.sort_by_key(|(_, chunk)| chunk.layer_index);
        let of_part = |part: usize| chunks.partition_point(|(_, chunk)| chunk.layer_index < part);
        for part in 0..self.headers.len() {
            own(&mut self, part)?;
            for (index, chunk) in &chunks[of_part(part)..of_part(part + 1)] {
                self.put(*index, chunk)?;
            }
        }
        self.writer.seek(SeekFrom::Start(self.table.0))?;
        for offset in self.table.1.iter().flatten() {
            self.writer.write_all(&offset.to_le_bytes())?;
        }
        self.writer.seek(SeekFrom::Start(self.position))?;
        Ok(())
    }
}

/// Writes a header, its attributes by their names, as OpenEXR does: the crate keeps them in no order, and calls deep parts flat.
fn write_header(writer: &mut impl Write, header: &Header) -> Result<(), Reason> {
    let mut attributes: Vec<_> = header.all_named_attributes().collect();
    attributes.sort_by_key(|(name, _)| *name);
    for (name, value) in attributes {
        let deep = match header.blocks {
            BlockDescription::ScanLines => BlockType::DeepScanLine,
            BlockDescription::Tiles(_) => BlockType::DeepTile,
        };
        let value =
            if header.deep && name == standard_names::BLOCK_TYPE { AttributeValue::BlockType(deep) } else { value };
        attribute::write(name, &value, writer).map_err(explain)?;
    }
    Ok(writer.write_all(&[0])?)
}
