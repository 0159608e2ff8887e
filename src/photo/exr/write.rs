//! A photo into an OpenEXR file.

use std::io::{Seek, Write};

use exr::block::writer::{ChunkWriter, ChunksWriter};
use exr::block::{self, BlockIndex, UncompressedBlock};
use exr::compression::Compression;
use exr::error::UnitResult;
use exr::math::Vec2;
use exr::meta::attribute::{
    ChannelDescription, ChannelList, Chromaticities, IntegerBounds, LineOrder, SampleType, Text,
};
use exr::meta::header::{Header, ImageAttributes, LayerAttributes};
use exr::meta::{BlockDescription, Headers, MetaData};
use glam::DVec2;
use rayon::prelude::*;

use super::super::{Alpha, Depth, Photo, Primaries, Reason, display};
use super::Rest;
use super::layer::Role;
use super::lines::Scratch;
use super::read::{explain, frame};

/// Blocks that are compressed together.
const BLOCKS_A_THREAD: usize = 4;

/// What a channel of the main part is filled with.
#[derive(Clone, Copy)]
struct Fill<'p> {
    /// Component of the photo's pixels; none for a channel that is carried.
    component: Option<usize>,
    /// The bytes that the input had.
    was: Option<&'p [u8]>,
}

/// The main part of the file to be.
struct Main<'p> {
    photo: &'p Photo,
    part: usize,
    fills: Vec<Fill<'p>>,
    /// Straight colours have to be multiplied by alpha.
    premultiply: bool,
}

pub fn write(writer: impl Write + Seek, photo: &Photo, depth: Depth) -> Result<(), Reason> {
    let rest = photo.source.exr.as_deref();
    let (mut headers, part) = match rest {
        Some(rest) => (rest.headers.clone(), rest.layer.part),
        None => (Headers::from_elem(plain_header(photo), 1), 0),
    };
    check_window(photo, &headers[part])?;
    let channels = channels(photo, rest, depth);
    let (list, fills): (Vec<_>, _) = channels.into_iter().unzip();
    let main = Main { photo, part, fills, premultiply: photo.source.alpha == Alpha::Straight };
    headers[part].channels = ChannelList::new(list.into_iter().collect());
    let header = headers[part].clone();
    headers[part] = if photo.source.quick { quickly(header, depth) } else { without_loss(header) };
    block::write(writer, headers, false, |meta, writer| {
        for part in 0..meta.headers.len() {
            if part == main.part {
                main.write(&meta, writer)?;
            } else if let Some(rest) = rest {
                let chunks = rest.chunks.iter().filter(|(_, chunk)| chunk.layer_index == part);
                chunks.cloned().try_for_each(|(index, chunk)| writer.write_chunk(index, chunk))?;
            }
        }
        Ok(())
    })
    .map_err(explain)
}

/// The picture and its window must be those that the header describes.
fn check_window(photo: &Photo, header: &Header) -> Result<(), Reason> {
    if frame(header)? != photo.frame {
        return Err("the photo's window is not that of the file it came from".into());
    }
    Ok(())
}

/// A header for a photo that came from no OpenEXR file.
fn plain_header(photo: &Photo) -> Header {
    let (frame, window) = (photo.frame, photo.frame.window);
    let size = Vec2(window.width as usize, window.height as usize);
    let bounds = IntegerBounds::new((0, 0), (frame.width as usize, frame.height as usize));
    let chromaticities = photo.source.primaries.map(chromaticities);
    let place = LayerAttributes { layer_position: Vec2(window.x, window.y), ..LayerAttributes::default() };
    Header::new(Text::from("picture"), size, Default::default())
        .with_encoding(Compression::ZIP16, BlockDescription::ScanLines, LineOrder::Increasing)
        .with_attributes(place)
        .with_shared_attributes(ImageAttributes {
            chromaticities,
            pixel_aspect: photo.source.pixel_aspect as f32,
            ..ImageAttributes::new(bounds)
        })
}

pub(super) fn chromaticities(primaries: Primaries) -> Chromaticities {
    let point = |p: DVec2| Vec2(p.x as f32, p.y as f32);
    let Primaries { red, green, blue, white } = primaries;
    Chromaticities { red: point(red), green: point(green), blue: point(blue), white: point(white) }
}

/// For a picture that is smooth and was computed, so that the last bits of its floats are noise: at 1920 × 1080 on two
/// cores, ZIP makes 22.8 MB of 24.9 in 5.7 s, RLE as good as nothing in 0.2 s, but little of black. Of half floats, ZIPS
/// makes 1.5 MB of 12.4 in 0.7 s, and ZIP 1.3 MB in 1.9 s.
fn quickly(header: Header, depth: Depth) -> Header {
    let compression = if depth == Depth::Half { Compression::ZIP1 } else { Compression::RLE };
    header.with_encoding(compression, BlockDescription::ScanLines, LineOrder::Increasing)
}

fn without_loss(header: Header) -> Header {
    let lossless = |c: &ChannelDescription| header.compression.is_lossless_for(c.sample_type);
    // PXR24 and B44A keep some types, but not every NaN.
    if header.channels.list.iter().all(lossless) && header.compression.preserves_nan_bits() {
        return header;
    }
    let (blocks, order) = (header.blocks, header.line_order);
    header.with_encoding(Compression::ZIP16, blocks, order)
}

/// The channels of the main part, sorted by name as the format wants it, and what fills them.
fn channels<'p>(photo: &Photo, rest: Option<&'p Rest>, depth: Depth) -> Vec<(ChannelDescription, Fill<'p>)> {
    let grey = display::is_grey(photo);
    let mut channels = match rest {
        Some(rest) => carried_channels(rest, grey),
        None => plain_channels(photo, grey),
    };
    let kind = match depth {
        Depth::Half => SampleType::F16,
        _ => SampleType::F32,
    };
    // Only a depth other than the input's changes a channel: the input's may differ among themselves.
    if rest.is_none() || depth != photo.source.depth {
        for (channel, fill) in channels.iter_mut().filter(|(_, fill)| fill.component.is_some()) {
            (channel.sample_type, fill.was) = (kind, None);
        }
    }
    channels.sort_by(|(a, _), (b, _)| a.name.as_slice().cmp(b.name.as_slice()));
    channels
}

fn plain_channels<'p>(photo: &Photo, grey: bool) -> Vec<(ChannelDescription, Fill<'p>)> {
    let colours: &[(&str, usize)] = if grey { &[("Y", 0)] } else { &[("B", 2), ("G", 1), ("R", 0)] };
    let alpha = (photo.source.alpha != Alpha::None).then_some(("A", 3));
    let fill = |component| Fill { component: Some(component), was: None };
    let named = alpha.into_iter().chain(colours.iter().copied());
    named.map(|(name, component)| (ChannelDescription::named(name, SampleType::F32), fill(component))).collect()
}

fn carried_channels(rest: &Rest, grey: bool) -> Vec<(ChannelDescription, Fill<'_>)> {
    let layer = &rest.layer;
    let list = rest.headers[layer.part].channels.list.iter();
    let mut channels = Vec::new();
    for ((channel, &role), plane) in list.zip(&layer.roles).zip(&rest.planes) {
        let was = plane.as_deref();
        match role {
            Role::Other => channels.push((channel.clone(), Fill { component: None, was })),
            Role::Component(component) => channels.push((channel.clone(), Fill { component: Some(component), was })),
            Role::Luminance if grey => channels.push((channel.clone(), Fill { component: Some(0), was })),
            // Luminance that has got a colour becomes three channels.
            Role::Luminance => {
                for (component, name) in ["R", "G", "B"].iter().enumerate() {
                    let name = Text::from(format!("{}{name}", layer.prefix).as_str());
                    let fill = Fill { component: Some(component), was: None };
                    channels.push((ChannelDescription { name, ..channel.clone() }, fill));
                }
            }
        }
    }
    channels
}

impl Main<'_> {
    fn write<W: Write + Seek>(&self, meta: &MetaData, writer: &mut ChunkWriter<W>) -> UnitResult {
        let blocks: Vec<(usize, BlockIndex)> =
            meta.enumerate_ordered_header_block_indices().filter(|(_, block)| block.layer == self.part).collect();
        for batch in blocks.chunks(BLOCKS_A_THREAD * rayon::current_num_threads()) {
            let compress = |&(index, block): &(usize, BlockIndex)| {
                self.block(&meta.headers[self.part], block).compress_to_chunk(&meta.headers).map(|chunk| (index, chunk))
            };
            let chunks = batch.par_iter().map(compress).collect::<Result<Vec<_>, _>>()?;
            chunks.into_iter().try_for_each(|(index, chunk)| writer.write_chunk(index, chunk))?;
        }
        Ok(())
    }

    fn block(&self, header: &Header, block: BlockIndex) -> UncompressedBlock {
        let mut scratch = Scratch::default();
        let width = header.layer_size.width();
        UncompressedBlock::from_lines(&header.channels, block, |line| {
            let at = line.location;
            let kind = header.channels.list[at.channel].sample_type;
            let start = at.position.y() * width + at.position.x();
            let fill = self.fills[at.channel];
            let was = fill.was.map(|was| &was[start * kind.bytes_per_sample()..][..line.value.len()]);
            match (fill.component, was) {
                (Some(component), was) => {
                    let pixels = &self.photo.pixels[start..start + at.sample_count];
                    scratch.float.clear();
                    scratch.float.extend(pixels.iter().map(|pixel| self.sample(pixel, component)));
                    scratch.store(line.value, kind, was);
                }
                (None, Some(was)) => line.value.copy_from_slice(was),
                (None, None) => {}
            }
        })
    }

    fn sample(&self, pixel: &[f32; 4], component: usize) -> f32 {
        if self.premultiply && component < 3 { pixel[component] * pixel[3] } else { pixel[component] }
    }
}
