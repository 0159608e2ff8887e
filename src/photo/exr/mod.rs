//! OpenEXR: half, float and uint; RGB(A), Y(A), luminance and chroma, XYZ; scan lines and tiles.
//!
//! | module | what |
//! | --- | --- |
//! | `names`, `candidates`, `pick`, `layer` | which channels are the picture |
//! | `blocks` | the file as a container: where its compressed blocks are, and which are missing |
//! | `guard` | whether a block can be what it says |
//! | `unpack` | a block's bytes, by the decoders of the `exr` crate |
//! | `picture` | blocks into pixels and kept channels; with `lines` and `chroma` |
//! | `attributes`, `camera`, `colour` | what attributes say: of how the file was made, the field of view, the colour space |
//! | `encoding` | how a picture that has changed is compressed |
//! | `read`, `write`, `container` | a file into a photo, and back |
//!
//! One layer becomes the photo's pixels ([`layer`]). The other channels of its part are kept as bytes, the other parts
//! as the compressed chunks that they are in the file, and the headers whole, so that [`write()`] can put all of it
//! back. A picture that is compressed with loss, subsampled or in levels goes back as the chunks that it came in if it is
//! still the same. Once it has changed, it is compressed as it was, unless other channels of its part would lose by it; colours
//! become R, G, B of full resolution, and of levels only the largest is left: the others would show the picture without its glare.
//! Parts of deep data are no picture, and copied as they are.

mod attributes;
mod blocks;
mod camera;
mod candidates;
mod chroma;
mod colour;
mod container;
mod encoding;
mod guard;
mod layer;
mod lines;
mod names;
mod pick;
mod picture;
mod read;
mod unpack;
mod write;

use std::fmt;

use exr::block::chunk::Chunk;
use exr::compression::Compression;
use exr::math::Vec2;
use exr::meta::attribute::{ChannelDescription, ChannelList, LineOrder, SampleType};
use exr::meta::header::Header;
use exr::meta::{BlockDescription, Headers};
use rustc_hash::FxHashSet;

pub(super) use read::read;
pub(super) use write::write;

use super::{Part, Reason};
use layer::{Colours, Layer, Member, Role};
use picture::Planes;

/// What an OpenEXR file holds beside the photo's pixels.
pub(super) struct Rest {
    /// Every part's header; those of the picture are of their largest level only.
    headers: Headers,
    /// Which parts, and which of their channels, the photo's pixels are.
    layer: Layer,
    /// For each member of the layer, the channels that are carried.
    planes: Vec<Planes>,
    /// The other parts' chunks, each with its index within its part; also the picture's, if they are kept.
    chunks: Vec<(usize, Chunk)>,
    /// Whether the picture's chunks are kept: some of its channels are subsampled, or luminance and chroma.
    is_kept: bool,
    /// The shares of red, green and blue in luminance that chroma was read with.
    weights: [f64; 3],
}

impl Rest {
    /// What the file's parts are called, and their channels.
    pub fn parts(&self) -> Vec<Part> {
        let of = |header: &Header| {
            let channels: Vec<String> =
                header.channels.list.iter().map(|channel| names::text(&channel.name).into_owned()).collect();
            let (mut layers, mut known) = (Vec::new(), FxHashSet::default());
            for name in &channels {
                let layer = names::split(name).0.trim_end_matches('.');
                if known.insert(layer) {
                    layers.push(layer.to_owned());
                }
            }
            let name = header.own_attributes.layer_name.as_ref().map(|name| names::text(name).into_owned());
            Part { name, layers, channels }
        };
        self.headers.iter().map(of).collect()
    }

    /// Whether the picture is CIE XYZ.
    pub fn is_xyz(&self) -> bool {
        self.layer.colours == Colours::Xyz
    }

    /// Leaves so many columns and rows at each edge out of the display window, which they do not fill.
    pub fn overscan(&mut self, [columns, rows]: [u32; 2]) {
        for header in &mut self.headers {
            let display = &mut header.shared_attributes.display_window;
            display.position = display.position + Vec2(columns as i32, rows as i32);
            display.size = display.size - Vec2(2 * columns as usize, 2 * rows as usize);
        }
    }

    /// What a picture beside the photo, of the same frame, three colours and no alpha, takes over: the attributes of the
    /// photo's part and of its file. Not its other channels and parts, nor what is said of those or shows the photo.
    pub fn attributes_only(&self) -> Self {
        let mut header = self.headers[self.layer.part()].clone();
        let colour = |name| ChannelDescription::named(name, SampleType::F32);
        header.channels = ChannelList::new(["B", "G", "R"].into_iter().map(colour).collect());
        (header.own_attributes.preview, header.own_attributes.multi_view_names) = (None, None);
        let header = header.with_encoding(Compression::RLE, BlockDescription::ScanLines, LineOrder::Increasing);
        let roles = [2, 1, 0].map(Role::Component).to_vec();
        let member = Member { part: 0, prefix: String::new(), roles };
        Self {
            headers: Headers::from_elem(header, 1),
            layer: Layer { members: vec![member], colours: Colours::Rgb },
            planes: vec![vec![None; 3]],
            chunks: Vec::new(),
            is_kept: false,
            weights: self.weights,
        }
    }
}

impl fmt::Debug for Rest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let channels: usize = self.headers.iter().map(|header| header.channels.list.len()).sum();
        write!(f, "Rest {{ {} parts, {channels} channels, {:?} }}", self.headers.len(), self.layer)
    }
}

/// The crate's reasons, in words that stand alone.
fn explain(error: exr::error::Error) -> Reason {
    match error {
        exr::error::Error::Io(error) => error.into(),
        exr::error::Error::Invalid(text) if text.contains("missing bytes") => "the file is cut short".into(),
        exr::error::Error::Invalid(text) => format!("the file is damaged: {text}").into(),
        exr::error::Error::NotSupported(text) if text == "unknown compression method" => {
            "it is compressed in a way that vglare does not know".into()
        }
        exr::error::Error::NotSupported(text) => format!("it needs what vglare cannot do: {text}").into(),
        aborted @ exr::error::Error::Aborted => aborted.to_string().into(),
    }
}
