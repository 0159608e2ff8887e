//! OpenEXR through the `exr` crate's blocks: half, float and uint; RGB(A) and Y(A); scan lines and tiles.
//!
//! One layer becomes the photo's pixels ([`layer`]). The other channels of its part are kept as bytes, the other parts
//! as the compressed chunks that they are in the file, and the headers whole, so that [`write()`] can put all of it
//! back. Of a part with resolution levels only the largest level is kept: the others would show the picture without
//! its glare. A lossy compression becomes ZIP: the pixels would suffer twice. The crate knows no deep data.

mod layer;
mod lines;
mod read;
mod write;

use std::fmt;

use exr::block::chunk::Chunk;
use exr::compression::Compression;
use exr::meta::attribute::{ChannelDescription, ChannelList, LineOrder, SampleType};
use exr::meta::{BlockDescription, Headers};

pub(super) use read::read;
pub(super) use write::write;

use super::Primaries;
use layer::{Layer, Role};

/// What an OpenEXR file holds beside the photo's pixels.
pub(super) struct Rest {
    /// Every part's header; the main one is of its largest level only.
    headers: Headers,
    /// Which part, and which of its channels, the photo's pixels are.
    layer: Layer,
    /// For each channel of the main part, its samples in the machine's byte order, row by row, if they are carried.
    planes: Vec<Option<Vec<u8>>>,
    /// The other parts' chunks, each with its index within its part.
    chunks: Vec<(usize, Chunk)>,
}

impl Rest {
    /// What a picture beside the photo, of the same frame, three colours and no alpha, takes over: the attributes of the
    /// photo's part and of its file. Not its other channels and parts, nor what is said of those or shows the photo.
    pub fn attributes_only(&self, primaries: Option<Primaries>) -> Self {
        let mut header = self.headers[self.layer.part].clone();
        let colour = |name| ChannelDescription::named(name, SampleType::F32);
        header.channels = ChannelList::new(["B", "G", "R"].into_iter().map(colour).collect());
        // Pixels may have been taken for other primaries than the file names.
        let named = header.shared_attributes.chromaticities.and_then(read::primaries);
        if named != primaries {
            header.shared_attributes.chromaticities = primaries.map(write::chromaticities);
        }
        (header.own_attributes.preview, header.own_attributes.multi_view_names) = (None, None);
        let header = header.with_encoding(Compression::RLE, BlockDescription::ScanLines, LineOrder::Increasing);
        let roles = [2, 1, 0].map(Role::Component).to_vec();
        let layer = Layer { part: 0, prefix: String::new(), roles };
        Self { headers: Headers::from_elem(header, 1), layer, planes: vec![None; 3], chunks: Vec::new() }
    }
}

impl fmt::Debug for Rest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let channels: usize = self.headers.iter().map(|header| header.channels.list.len()).sum();
        write!(f, "Rest {{ {} parts, {channels} channels, {:?} }}", self.headers.len(), self.layer)
    }
}
