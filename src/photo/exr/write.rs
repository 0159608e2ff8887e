//! A photo into an OpenEXR file.

use std::io::{Seek, Write};

use exr::block::chunk::{Chunk, CompressedBlock, CompressedScanLineBlock, CompressedTileBlock, TileCoordinates};
use exr::compression::Compression;
use exr::math::Vec2;
use exr::meta::attribute::{ChannelDescription, ChannelList, IntegerBounds, LineOrder, SampleType, Text};
use exr::meta::header::{Header, ImageAttributes, LayerAttributes};
use exr::meta::{BlockDescription, Headers, TileIndices};
use rayon::prelude::*;

use super::super::luminance::Said;
use super::super::{Alpha, Depth, Photo, Primaries, Reason, display};
use super::container::Container;
use super::layer::{Member, Role};
use super::lines::Scratch;
use super::picture::{Picture, Planes};
use super::read::{frame, insert, largest_level};
use super::unpack::{self, lines, pack};
use super::{Rest, attributes, colour, encoding, explain, guard};
use crate::frame::Frame;

/// Blocks that are compressed together.
const BLOCKS_A_THREAD: usize = 4;

/// What a channel of the picture's parts is filled with.
#[derive(Clone, Copy)]
struct Fill<'p> {
    /// Component of the photo's pixels, or of a layer's; none for a channel that is carried.
    component: Option<usize>,
    /// Of which layer beside the picture; none for the picture itself.
    layer: Option<usize>,
    /// The bytes that the input had.
    was: Option<&'p [u8]>,
}

/// A part of the file to be that holds the photo's pixels.
struct Main<'p> {
    photo: &'p Photo,
    part: usize,
    fills: Vec<Fill<'p>>,
    /// Straight colours have to be multiplied by alpha.
    premultiply: bool,
}

pub fn write(writer: impl Write + Seek, photo: &Photo, depth: Depth) -> Result<(), Reason> {
    let Some(rest) = photo.source.exr.as_deref() else {
        let mut header = plain_header(photo);
        say_luminance(&mut header, photo);
        attributes::tell_origin(&mut header, photo.source.made.as_deref());
        let channels = beside(with_depth(plain_channels(photo), depth), photo);
        let main = Main::new(photo, 0, channels, &mut header);
        if photo.source.quick {
            header = quickly(header, depth);
        }
        return Container::new(writer, Headers::from_elem(header, 1))?
            .finish(&[], |container, _| main.write(container));
    };
    let mut headers = rest.headers.clone();
    check_window(photo, &headers[rest.layer.part()])?;
    colour::tag(&mut headers, &rest.layer, &photo.source);
    for member in &rest.layer.members {
        say_luminance(&mut headers[member.part], photo);
        attributes::tell_origin(&mut headers[member.part], photo.source.made.as_deref());
    }
    let is_main = |chunk: &Chunk| rest.layer.member(chunk.layer_index).is_some();
    if rest.is_kept && depth == photo.source.depth && photo.source.beside.is_empty() && is_unchanged(photo, rest)? {
        let chunks: Vec<_> = rest.chunks.iter().collect();
        return Container::new(writer, headers)?.finish(&chunks, |_, _| Ok(()));
    }
    let grey = display::is_grey(photo);
    let mut mains = Vec::new();
    for (index, (member, planes)) in rest.layer.members.iter().zip(&rest.planes).enumerate() {
        let header = &mut headers[member.part];
        *header = largest_level(header.clone());
        let mut channels = carried_channels(header, member, planes, grey);
        // Only a depth other than the input's changes a channel: the input's may differ among themselves.
        if depth != photo.source.depth {
            channels = with_depth(channels, depth);
        }
        if index == 0 {
            channels = beside(channels, photo);
        }
        mains.push(Main::new(photo, member.part, channels, header));
        if photo.source.quick {
            *header = quickly(header.clone(), depth);
        }
    }
    let chunks: Vec<_> = rest.chunks.iter().filter(|(_, chunk)| !is_main(chunk)).collect();
    Container::new(writer, headers)?.finish(&chunks, |container, part| {
        mains.iter().find(|main| main.part == part).map_or(Ok(()), |main| main.write(container))
    })
}

/// Says what white is in cd/m², where that is known and one number says it: `whiteLuminance`.
fn say_luminance(header: &mut Header, photo: &Photo) {
    let white = photo.source.luminance.as_ref().and_then(Said::white).map(|white| white as f32);
    if let Some(white) = white.filter(|white| white.is_normal()) {
        header.own_attributes.white_luminance = Some(white);
    }
}

/// Whether the pixels are still those of the chunks that the picture came in.
fn is_unchanged(photo: &Photo, rest: &Rest) -> Result<bool, Reason> {
    let mut picture = Picture::new(&rest.layer, &rest.headers)?;
    let of_picture = rest.chunks.iter().filter(|(_, chunk)| rest.layer.member(chunk.layer_index).is_some());
    let mut blocks = Vec::new();
    for (_, chunk) in of_picture {
        let tile = rest.headers[chunk.layer_index].get_block_data_indices(&chunk.compressed_block).map_err(explain)?;
        if tile.level_index == Vec2(0, 0) {
            blocks.push((tile, chunk.clone()));
        }
    }
    insert(&mut picture, &rest.layer, &rest.headers, blocks)?;
    let (pixels, _) = picture.finish(rest.weights, false);
    let same = |a: &[f32; 4], b: &[f32; 4]| a.map(f32::to_bits) == b.map(f32::to_bits);
    Ok(pixels.len() == photo.pixels.len() && pixels.par_iter().zip(&photo.pixels).all(|(a, b)| same(a, b)))
}

/// The picture and its window must be those that the header describes; how wide its pixels are shown is another attribute.
fn check_window(photo: &Photo, header: &Header) -> Result<(), Reason> {
    if (Frame { pixel_aspect: photo.frame.pixel_aspect, unit: photo.frame.unit, ..frame(header)? }) != photo.frame {
        return Err("the photo's window is not that of the file it came from".into());
    }
    Ok(())
}

/// A header for a photo that came from no OpenEXR file.
fn plain_header(photo: &Photo) -> Header {
    let (frame, window) = (photo.frame, photo.frame.window);
    let size = Vec2(window.width as usize, window.height as usize);
    let bounds = IntegerBounds::new((0, 0), (frame.width as usize, frame.height as usize));
    let pixel_aspect = photo.source.pixel_aspect as f32;
    let place = LayerAttributes { layer_position: Vec2(window.x, window.y), ..LayerAttributes::default() };
    let mut header = Header::new(Text::from("picture"), size, Default::default())
        .with_encoding(Compression::ZIP16, BlockDescription::ScanLines, LineOrder::Increasing)
        .with_attributes(place)
        .with_shared_attributes(ImageAttributes { pixel_aspect, ..ImageAttributes::new(bounds) });
    if photo.source.knows_primaries || photo.source.primaries.is_some() {
        colour::say(&mut header, photo.source.primaries.unwrap_or(Primaries::REC709));
    }
    header
}

/// For a picture that is smooth and was computed, so that the last bits of its floats are noise: at 1920 × 1080 on two
/// cores, ZIP makes 22.8 MB of 24.9 in 5.7 s, RLE as good as nothing in 0.2 s, but little of black. Of half floats, ZIPS
/// makes 1.5 MB of 12.4 in 0.7 s, and ZIP 1.3 MB in 1.9 s.
fn quickly(header: Header, depth: Depth) -> Header {
    let compression = if depth == Depth::Half { Compression::ZIP1 } else { Compression::RLE };
    header.with_encoding(compression, BlockDescription::ScanLines, LineOrder::Increasing)
}

type Channels<'p> = Vec<(ChannelDescription, Fill<'p>)>;

/// The picture's channels by another depth.
fn with_depth(mut channels: Channels, depth: Depth) -> Channels {
    let kind = match depth {
        Depth::Half => SampleType::F16,
        _ => SampleType::F32,
    };
    for (channel, fill) in channels.iter_mut().filter(|(_, fill)| fill.component.is_some() && fill.layer.is_none()) {
        (channel.sample_type, fill.was) = (kind, None);
    }
    channels
}

/// The same with the layers beside the picture, in place of channels that are called as theirs.
fn beside<'p>(mut channels: Channels<'p>, photo: &Photo) -> Channels<'p> {
    for (layer, of) in photo.source.beside.iter().enumerate() {
        for (component, colour) in ["R", "G", "B"].into_iter().enumerate() {
            let channel = ChannelDescription::named(&*format!("{}.{colour}", of.name), SampleType::F32);
            channels.retain(|(known, _)| known.name != channel.name);
            channels.push((channel, Fill { component: Some(component), layer: Some(layer), was: None }));
        }
    }
    channels
}

fn plain_channels<'p>(photo: &Photo) -> Channels<'p> {
    let colours: &[(&str, usize)] = if display::is_grey(photo) { &[("Y", 0)] } else { &[("B", 2), ("G", 1), ("R", 0)] };
    let alpha = (photo.source.alpha != Alpha::None).then_some(("A", 3));
    let fill = |component| Fill { component: Some(component), layer: None, was: None };
    let named = alpha.into_iter().chain(colours.iter().copied());
    named.map(|(name, component)| (ChannelDescription::named(name, SampleType::F32), fill(component))).collect()
}

/// The channels of a part of the picture, where all that is of the picture gets its pixels' full resolution.
fn carried_channels<'p>(header: &Header, member: &Member, planes: &'p Planes, grey: bool) -> Channels<'p> {
    let fill = |component, was| Fill { component, layer: None, was };
    let mut channels = Vec::new();
    for ((channel, &role), plane) in header.channels.list.iter().zip(&member.roles).zip(planes) {
        let was = plane.as_deref();
        let full = ChannelDescription { sampling: Vec2(1, 1), ..channel.clone() };
        match role {
            Role::Other => channels.push((channel.clone(), fill(None, was))),
            Role::Component(component) => channels.push((full, fill(Some(component), was))),
            Role::Luminance if grey => channels.push((full, fill(Some(0), was))),
            // Luminance that has got a colour becomes three channels.
            Role::Luminance => {
                for (component, name) in ["R", "G", "B"].iter().enumerate() {
                    let name = Text::from(format!("{}{name}", member.prefix).as_str());
                    let quantize_linearly = false;
                    let channel = ChannelDescription { name, quantize_linearly, ..full.clone() };
                    channels.push((channel, fill(Some(component), None)));
                }
            }
            Role::Chroma(_) => {}
        }
    }
    channels
}

impl<'p> Main<'p> {
    /// A part whose header gets these channels, sorted by name as the format wants it.
    fn new(photo: &'p Photo, part: usize, mut channels: Channels<'p>, header: &mut Header) -> Self {
        channels.sort_by(|(a, _), (b, _)| a.name.as_slice().cmp(b.name.as_slice()));
        let (list, fills): (Vec<_>, Vec<Fill>) = channels.into_iter().unzip();
        let was_subsampled = !unpack::is_plain(&header.channels);
        header.channels = ChannelList::new(list.into_iter().collect());
        // Carried channels, alpha, layers that are to add up, and colours that have been compressed in another form.
        let stays = |fill: &Fill| was_subsampled || fill.layer.is_some() || matches!(fill.component, None | Some(3));
        *header = encoding::of_changed(header.clone(), |channel| stays(&fills[channel]));
        Self { photo, part, fills, premultiply: photo.source.alpha == Alpha::Straight }
    }

    fn write<W: Write + Seek>(&self, container: &mut Container<W>) -> Result<(), Reason> {
        let header = container.headers[self.part].clone();
        let tiles: Vec<_> = header.enumerate_ordered_blocks().collect();
        for batch in tiles.chunks(BLOCKS_A_THREAD * rayon::current_num_threads()) {
            let compress = |&(index, indices): &(usize, TileIndices)| {
                let area = header.get_absolute_block_pixel_coordinates(indices.location).map_err(explain)?;
                let packed = pack(&header, area, self.block(&header, area))?;
                Ok((index, chunk(&header, self.part, indices.location, area, packed)))
            };
            for (index, chunk) in batch.par_iter().map(compress).collect::<Result<Vec<_>, Reason>>()? {
                container.put(index, &chunk)?;
            }
        }
        Ok(())
    }

    fn block(&self, header: &Header, area: IntegerBounds) -> Vec<u8> {
        let mut scratch = Scratch::default();
        let mut bytes = vec![0; unpack::size(&header.channels, area)];
        for line in lines(&header.channels, area) {
            let channel = &header.channels.list[line.channel];
            let (kind, columns) = (channel.sample_type, unpack::plane(channel, header.layer_size).0);
            let start = line.at.1 * columns + line.at.0;
            let value = &mut bytes[line.bytes];
            let fill = self.fills[line.channel];
            let was = fill.was.map(|was| &was[start * kind.bytes_per_sample()..][..value.len()]);
            match (fill.component, was) {
                (Some(component), was) => {
                    let own = &self.photo.pixels[start..][..line.count];
                    let layer = fill.layer.map(|layer| &self.photo.source.beside[layer].pixels[start..][..line.count]);
                    let pixels = layer.unwrap_or(own).iter().zip(own);
                    scratch.float.clear();
                    scratch.float.extend(pixels.map(|(pixel, own)| self.sample(pixel, component, own[3])));
                    scratch.store(value, kind, was);
                }
                (None, Some(was)) => value.copy_from_slice(was),
                (None, None) => {}
            }
        }
        bytes
    }

    fn sample(&self, pixel: &[f32; 4], component: usize, alpha: f32) -> f32 {
        if self.premultiply && component < 3 { pixel[component] * alpha } else { pixel[component] }
    }
}

/// A block of nothing but zeros, for a part that lacks it; its bytes are taken from `budget`.
///
/// # Errors
/// Where it is too large, or its compression none that can be written.
pub(super) fn zero_chunk(
    headers: &[Header],
    part: usize,
    tile: TileCoordinates,
    budget: &mut usize,
) -> Result<Chunk, Reason> {
    let header = &headers[part];
    if header.deep {
        return Err("the file is unfinished, and its deep data cannot be filled".into());
    }
    let area = header.get_absolute_block_pixel_coordinates(tile).map_err(explain)?;
    let bytes = unpack::size(&header.channels, area);
    *budget =
        budget.checked_sub(bytes).ok_or("the file is unfinished, and its other parts lack too much to be filled")?;
    guard::affordable(bytes.saturating_mul(4))?;
    let packed = pack(header, area, vec![0; bytes])?;
    Ok(chunk(header, part, tile, area, packed))
}

fn chunk(header: &Header, part: usize, tile: TileCoordinates, area: IntegerBounds, packed: Vec<u8>) -> Chunk {
    let compressed_block = match header.blocks {
        BlockDescription::ScanLines => CompressedBlock::ScanLine(CompressedScanLineBlock {
            y_coordinate: area.position.y() + header.own_attributes.layer_position.y(),
            compressed_pixels_le: packed,
        }),
        BlockDescription::Tiles(_) => {
            CompressedBlock::Tile(CompressedTileBlock { coordinates: tile, compressed_pixels_le: packed })
        }
    };
    Chunk { layer_index: part, compressed_block }
}
