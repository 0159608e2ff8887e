//! An OpenEXR file into a photo.

use std::collections::HashMap;
use std::io::{BufRead, Seek};
use std::sync::Arc;

use exr::block::chunk::{Chunk, TileCoordinates};
use exr::block::reader::ChunksReader;
use exr::block::{self, UncompressedBlock};
use exr::math::Vec2;
use exr::meta::attribute::{Chromaticities, LevelMode, SampleType};
use exr::meta::header::Header;
use exr::meta::{BlockDescription, MetaData};
use glam::DVec2;
use rayon::prelude::*;

use super::super::read::check_size;
use super::super::{Alpha, Depth, Format, Photo, Primaries, ReadOptions, Reason, Source, zeroed};
use super::Rest;
use super::layer::{Layer, Role, choose};
use super::lines::Scratch;
use crate::frame::{Frame, Window};

/// Blocks that are decompressed together: enough to keep every thread busy, few enough to stay small.
const BLOCKS_A_THREAD: usize = 4;

/// Bytes that a block may claim to have: decompression takes the memory before it looks.
const LARGEST_BLOCK: usize = 1 << 32;

pub fn read(reader: impl BufRead + Seek, _options: &ReadOptions) -> Result<Photo, Reason> {
    let reader = block::read(reader, false).map_err(explain)?;
    let layer = choose(reader.headers())?;
    let header = reader.headers()[layer.part].clone();
    let mut picture = Picture::new(&layer, &header)?;
    let is_wanted = |tile: TileCoordinates| tile.level_index == Vec2(0, 0);
    let mut reader =
        reader.filter_chunks(false, |_, tile, block| block.layer != layer.part || is_wanted(tile)).map_err(explain)?;
    let meta = reader.meta_data().clone();
    let mut places = Places::new(&meta, layer.part);
    let mut chunks = Vec::new();
    let batch = BLOCKS_A_THREAD * rayon::current_num_threads();
    loop {
        let read: Vec<Chunk> = reader.by_ref().take(batch).collect::<Result<_, _>>().map_err(explain)?;
        if read.is_empty() {
            break;
        }
        let (main, others): (Vec<_>, Vec<_>) = read.into_iter().partition(|chunk| chunk.layer_index == layer.part);
        for chunk in others {
            chunks.push((places.take(&meta, &chunk)?, chunk));
        }
        main.iter().try_for_each(|chunk| places.take(&meta, chunk).map(drop))?;
        let blocks = main.into_par_iter().map(|chunk| UncompressedBlock::decompress_chunk(chunk, &meta, false));
        for block in blocks.collect::<Result<Vec<_>, _>>().map_err(explain)? {
            picture.insert(&block);
        }
    }
    if places.free() > 0 {
        return Err(format!("{} of its blocks are missing", places.free()).into());
    }
    let Picture { pixels, planes, .. } = picture;
    let mut headers = meta.headers;
    let source = source(&layer, &header);
    let frame = frame(&header)?;
    headers[layer.part] = largest_level(header);
    let rest = Rest { headers, layer, planes, chunks };
    Ok(Photo { frame, pixels, source: Source { exr: Some(Arc::new(rest)), ..source } })
}

/// The blocks that are still to come, so that none comes twice and none is missing.
struct Places(Vec<HashMap<TileCoordinates, usize>>);

impl Places {
    fn new(meta: &MetaData, main: usize) -> Self {
        let place = |(part, header): (usize, &Header)| {
            let blocks = header.blocks_increasing_y_order().enumerate().map(|(index, tile)| (tile.location, index));
            blocks.filter(|(tile, _)| part != main || tile.level_index == Vec2(0, 0)).collect()
        };
        Self(meta.headers.iter().enumerate().map(place).collect())
    }

    /// The index of a chunk within its part.
    fn take(&mut self, meta: &MetaData, chunk: &Chunk) -> Result<usize, Reason> {
        let header = meta.headers.get(chunk.layer_index).ok_or("a block is of no part")?;
        let tile = header.get_block_data_indices(&chunk.compressed_block).map_err(explain)?;
        Ok(self.0[chunk.layer_index].remove(&tile).ok_or("a block is there twice, or is where none belongs")?)
    }

    fn free(&self) -> usize {
        self.0.iter().map(HashMap::len).sum()
    }
}

/// The samples of the main part, as far as they are read.
struct Picture<'h> {
    header: &'h Header,
    layer: &'h Layer,
    pixels: Vec<[f32; 4]>,
    planes: Vec<Option<Vec<u8>>>,
    scratch: Scratch,
}

impl<'h> Picture<'h> {
    fn new(layer: &'h Layer, header: &'h Header) -> Result<Self, Reason> {
        if let Some(channel) = header.channels.list.iter().find(|c| c.sampling != Vec2(1, 1)) {
            return Err(format!("the channel {} is subsampled, which vglare does not read", channel.name).into());
        }
        if header.max_block_byte_size() > LARGEST_BLOCK {
            return Err("its blocks are too large to be true".into());
        }
        let Vec2(width, height) = header.layer_size;
        let count = check_size(u32::try_from(width)?, u32::try_from(height)?)?;
        let planes = header.channels.list.iter().enumerate().map(|(index, channel)| {
            let bytes = count * channel.sample_type.bytes_per_sample();
            layer.carries(index, channel).then(|| zeroed(bytes)).transpose()
        });
        let planes = planes.collect::<Result<_, _>>()?;
        Ok(Self { header, layer, pixels: zeroed(count)?, planes, scratch: Scratch::default() })
    }

    fn insert(&mut self, block: &UncompressedBlock) {
        let width = self.header.layer_size.width();
        let opaque = !self.layer.has_alpha();
        for line in block.lines(&self.header.channels) {
            let at = line.location;
            let kind = self.header.channels.list[at.channel].sample_type;
            let start = at.position.y() * width + at.position.x();
            if let Some(plane) = &mut self.planes[at.channel] {
                plane[start * kind.bytes_per_sample()..][..line.value.len()].copy_from_slice(line.value);
            }
            let pixels = &mut self.pixels[start..start + at.sample_count];
            match self.layer.roles[at.channel] {
                Role::Other => continue,
                Role::Component(component) => {
                    self.scratch.load(line.value, kind);
                    pixels.iter_mut().zip(&self.scratch.float).for_each(|(pixel, &v)| pixel[component] = v);
                }
                Role::Luminance => {
                    self.scratch.load(line.value, kind);
                    pixels.iter_mut().zip(&self.scratch.float).for_each(|(pixel, &v)| pixel[..3].fill(v));
                }
            }
            if opaque {
                pixels.iter_mut().for_each(|pixel| pixel[3] = 1.0);
            }
        }
    }
}

/// The picture and the window that a header describes.
pub(super) fn frame(header: &Header) -> Result<Frame, Reason> {
    let display = header.shared_attributes.display_window;
    let offset = header.own_attributes.layer_position;
    let (width, height) = (u32::try_from(display.size.width())?, u32::try_from(display.size.height())?);
    check_size(width, height)?;
    let apart = |data: i32, display: i32| data.checked_sub(display).ok_or("its windows are too far apart");
    let window = Window {
        x: apart(offset.x(), display.position.x())?,
        y: apart(offset.y(), display.position.y())?,
        width: u32::try_from(header.layer_size.width())?,
        height: u32::try_from(header.layer_size.height())?,
    };
    Ok(Frame::full(width, height).with_window(window))
}

fn source(layer: &Layer, header: &Header) -> Source {
    // Channels may differ; the best of them tells.
    let depth = |kind: SampleType| match kind {
        SampleType::F16 => (1, Depth::Half),
        SampleType::U32 => (0, Depth::Uint),
        SampleType::F32 => (2, Depth::Float),
    };
    let best = layer.colours(header).map(|c| depth(c.sample_type)).max_by_key(|(rank, _)| *rank);
    Source {
        format: Some(Format::OpenExr),
        depth: best.map_or(Depth::Float, |(_, depth)| depth),
        alpha: if layer.has_alpha() { Alpha::Premultiplied } else { Alpha::None },
        grey: layer.is_grey(),
        primaries: header.shared_attributes.chromaticities.and_then(primaries),
        pixel_aspect: header.shared_attributes.pixel_aspect.into(),
        ..Source::plain()
    }
}

fn primaries(c: Chromaticities) -> Option<Primaries> {
    let point = |Vec2(x, y): Vec2<f32>| DVec2::new(x.into(), y.into());
    let all = Primaries { red: point(c.red), green: point(c.green), blue: point(c.blue), white: point(c.white) };
    all.other_than_rec709()
}

fn largest_level(header: Header) -> Header {
    match header.blocks {
        BlockDescription::Tiles(mut tiles) if tiles.level_mode != LevelMode::Singular => {
            tiles.level_mode = LevelMode::Singular;
            let (compression, order) = (header.compression, header.line_order);
            header.with_encoding(compression, BlockDescription::Tiles(tiles), order)
        }
        _ => header,
    }
}

/// The crate's reasons, in words that stand alone.
pub(super) fn explain(error: exr::error::Error) -> Reason {
    match error {
        exr::error::Error::Io(error) => error.into(),
        exr::error::Error::Invalid(text) if text.contains("missing bytes") => "the file is cut short".into(),
        exr::error::Error::Invalid(text) => format!("the file is damaged: {text}").into(),
        exr::error::Error::NotSupported(text) => format!("it needs what vglare cannot do: {text}").into(),
        aborted @ exr::error::Error::Aborted => aborted.to_string().into(),
    }
}
