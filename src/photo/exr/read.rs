//! An OpenEXR file into a photo.

use std::io::{BufRead, Seek};
use std::sync::Arc;

use exr::block::chunk::{Chunk, CompressedBlock, TileCoordinates};
use exr::math::Vec2;
use exr::meta::attribute::{Chromaticities, LevelMode, SampleType};
use exr::meta::header::Header;
use exr::meta::{BlockDescription, Headers};
use glam::DVec2;
use rayon::prelude::*;

use super::super::luminance::Said;
use super::super::read::check_size;
use super::super::{Alpha, Depth, Format, Photo, Primaries, ReadOptions, Reason, Source};
use super::blocks::{Block, Blocks};
use super::colour::{self, Told};
use super::encoding;
use super::layer::{Choice, Colours, Layer, choose};
use super::picture::Picture;
use super::unpack::{is_plain, unpack};
use super::write::zero_chunk;
use super::{Rest, camera, explain};
use crate::frame::{Frame, Window};

/// Blocks that are decompressed together: enough to keep every thread busy, few enough to stay small.
const BLOCKS_A_THREAD: usize = 4;

/// Bytes of zeros that other parts' missing blocks may come to: so many for each pixel of the picture, and so many more.
const FILL_A_PIXEL: usize = 1 << 10;
const FILL: usize = 1 << 26;

/// The least share of green in luminance by which luminance and chroma give green.
const LEAST_GREEN: f64 = 1e-3;

pub fn read(reader: impl BufRead + Seek, options: &ReadOptions) -> Result<Photo, Reason> {
    let mut blocks = Blocks::open(reader)?;
    let headers = blocks.meta.headers.clone();
    let Choice { layer, name, mut notes } = choose(&headers, options)?;
    let (source, doubts) = source(&layer, &headers, options);
    notes.extend(doubts);
    let mut picture = Picture::new(&layer, &headers)?;
    let is_whole = |tile: TileCoordinates| tile.level_index == Vec2(0, 0);
    let gaps = blocks.find(|part, tile| layer.member(part).is_none() || is_whole(tile))?;
    let has_gaps = gaps.is_some();
    if let Some(gaps) = gaps {
        notes.push(gaps.answer(options.missing)?);
    }
    // Where it could not be written again as it is.
    let mut parts = layer.members.iter().map(|member| &headers[member.part]);
    let keeps = !has_gaps && (layer.colours == Colours::LumaChroma || parts.any(|header| !is_written_again(header)));
    let wanted = |part: usize, tile: TileCoordinates| keeps || layer.member(part).is_none() || is_whole(tile);
    let mut chunks = Vec::new();
    let batch = BLOCKS_A_THREAD * rayon::current_num_threads();
    loop {
        let next = (0..batch).map_while(|_| blocks.next(wanted).transpose());
        let read: Vec<Block> = next.collect::<Result<_, _>>()?;
        if read.is_empty() {
            break;
        }
        let (main, others): (Vec<_>, Vec<_>) =
            read.into_iter().partition(|block| layer.member(block.chunk.layer_index).is_some());
        chunks.extend(others.into_iter().map(|block| (block.index, block.chunk)));
        if keeps {
            chunks.extend(main.iter().map(|block| (block.index, block.chunk.clone())));
        }
        let main = main.into_iter().filter(|block| is_whole(block.tile));
        insert(&mut picture, &layer, &headers, main.map(|block| (block.tile, block.chunk)).collect())?;
    }
    chunks.extend(absent(&blocks, &layer, &headers, has_gaps)?);
    let is_kept = keeps && layer.members.iter().all(|member| blocks.absent(member.part).next().is_none());
    if !is_kept {
        chunks.retain(|(_, chunk)| layer.member(chunk.layer_index).is_none());
    }
    let weights = luminance_weights(source.primaries, options);
    let (pixels, planes) = picture.finish(weights, has_gaps);
    let frame = frame(&headers[layer.part()])?;
    let rest = Rest { headers, layer, planes, chunks, weights, is_kept };
    Ok(Photo { frame, pixels, source: Source { exr: Some(Arc::new(rest)), picture: name, notes, ..source } })
}

/// Blocks of zeros for those that the parts lack which ride along, so that they are whole in what is written.
fn absent<R: BufRead + Seek>(
    blocks: &Blocks<R>,
    layer: &Layer,
    headers: &Headers,
    may_lack: bool,
) -> Result<Vec<(usize, Chunk)>, Reason> {
    let mut budget = headers[layer.part()].layer_size.area().saturating_mul(FILL_A_PIXEL).saturating_add(FILL);
    let mut chunks = Vec::new();
    for part in 0..headers.len() {
        let is_main = layer.member(part).is_some();
        let absent = blocks.absent(part).filter(|&(_, tile)| !is_main || tile.level_index == Vec2(0, 0));
        for (index, tile) in absent {
            if !may_lack {
                return Err("the file is damaged: blocks are missing, though its table names them".into());
            }
            if !is_main {
                chunks.push((index, zero_chunk(headers, part, tile, &mut budget)?));
            }
        }
    }
    Ok(chunks)
}

/// Decompresses blocks of the picture into it.
pub(super) fn insert(
    picture: &mut Picture,
    layer: &Layer,
    headers: &[Header],
    blocks: Vec<(TileCoordinates, Chunk)>,
) -> Result<(), Reason> {
    let unpacked = blocks.into_par_iter().map(|(tile, chunk)| {
        let header = &headers[chunk.layer_index];
        let area = header.get_absolute_block_pixel_coordinates(tile).map_err(explain)?;
        let member = layer.member(chunk.layer_index).ok_or("a block is of another part")?;
        let bytes = match chunk.compressed_block {
            CompressedBlock::ScanLine(block) => block.compressed_pixels_le,
            CompressedBlock::Tile(block) => block.compressed_pixels_le,
            _ => return Err("it holds deep data, which vglare does not read".into()),
        };
        Ok((member, area, unpack(header, area, bytes)?))
    });
    for (member, area, bytes) in unpacked.collect::<Result<Vec<_>, Reason>>()? {
        picture.insert(member, area, &bytes);
    }
    Ok(())
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

/// What the headers say of the picture, and what is to be told of it.
fn source(layer: &Layer, headers: &[Header], options: &ReadOptions) -> (Source, Vec<String>) {
    // Channels may differ; the best of them tells.
    let depth = |kind: SampleType| match kind {
        SampleType::F16 => (1, Depth::Half),
        SampleType::U32 => (0, Depth::Uint),
        SampleType::F32 => (2, Depth::Float),
    };
    let channels = layer.colour_channels(headers);
    let best = channels.iter().map(|c| depth(c.sample_type)).max_by_key(|(rank, _)| *rank);
    let mut notes = Vec::new();
    let header = &headers[layer.part()];
    let aspect = f64::from(header.shared_attributes.pixel_aspect);
    // The limits of OpenEXR's own sanity check.
    let pixel_aspect = if (1e-6..=1e6).contains(&aspect) {
        aspect
    } else {
        notes.push(format!("its pixelAspectRatio, {aspect}, makes no sense: its pixels are taken for square"));
        1.0
    };
    let (primaries, known) = colours(layer, headers, options, &mut notes);
    if layer.colours == Colours::LumaChroma {
        notes.push(
            "it holds luminance and chroma (Y, RY, BY), which are written as R, G, B once they change".to_owned(),
        );
    }
    let source = Source {
        format: Some(Format::OpenExr),
        depth: best.map_or(Depth::Float, |(_, depth)| depth),
        alpha: if layer.has_alpha() { Alpha::Premultiplied } else { Alpha::None },
        grey: layer.colours == Colours::Grey,
        primaries,
        knows_primaries: known,
        pixel_aspect,
        luminance: luminance(header),
        camera: camera::of(header),
        ..Source::plain()
    };
    (source, notes)
}

/// The primaries, where they are not Rec.709's, and whether the file says what they are.
fn colours(
    layer: &Layer,
    headers: &[Header],
    options: &ReadOptions,
    notes: &mut Vec<String>,
) -> (Option<Primaries>, bool) {
    if layer.colours == Colours::Xyz {
        return (Some(Primaries::XYZ), true);
    }
    let main = std::iter::once(&headers[layer.part()]);
    let doubt = match colour::told(&main.chain(headers).collect::<Vec<_>>()) {
        Told::Nothing => return (None, false),
        Told::Primaries(primaries) if primaries.sound().is_some() => return (primaries.other_than_rec709(), true),
        Told::Primaries(_) => "its chromaticities span no colour space".to_owned(),
        Told::Unknown(id) => format!("its colorInteropID, {id}, is no linear space that vglare knows"),
    };
    if options.primaries.is_none() {
        notes.push(format!("{doubt}: its colours are taken for Rec.709's, scene-linear"));
    }
    (None, false)
}

/// cd/m² of (1, 1, 1) by `whiteLuminance`, one of OpenEXR's standard attributes, where the part has it.
fn luminance(header: &Header) -> Option<Said> {
    let white = header.own_attributes.white_luminance?;
    Some(Said::of_white(white.into(), format!("its whiteLuminance of {white}")))
}

pub(super) fn primaries(c: Chromaticities) -> Primaries {
    let point = |Vec2(x, y): Vec2<f32>| DVec2::new(x.into(), y.into());
    Primaries { red: point(c.red), green: point(c.green), blue: point(c.blue), white: point(c.white) }
}

/// The shares in luminance that chroma was reckoned with.
fn luminance_weights(primaries: Option<Primaries>, options: &ReadOptions) -> [f64; 3] {
    let weights = options.primaries.or(primaries).unwrap_or(Primaries::REC709).luminance_weights();
    if weights[1] < LEAST_GREEN { Primaries::REC709.luminance_weights() } else { weights }
}

/// Whether blocks that are decompressed and compressed again are the same: nothing is lost by it, subsampled, or of another level.
fn is_written_again(header: &Header) -> bool {
    let one_level = match header.blocks {
        BlockDescription::Tiles(tiles) => tiles.level_mode == LevelMode::Singular,
        BlockDescription::ScanLines => true,
    };
    one_level && is_plain(&header.channels) && !encoding::may_lose(header.compression)
}

/// The header of a part's largest level alone: the others would show the picture without its glare.
pub(super) fn largest_level(header: Header) -> Header {
    match header.blocks {
        BlockDescription::Tiles(mut tiles) if tiles.level_mode != LevelMode::Singular => {
            tiles.level_mode = LevelMode::Singular;
            let (compression, order) = (header.compression, header.line_order);
            header.with_encoding(compression, BlockDescription::Tiles(tiles), order)
        }
        _ => header,
    }
}
