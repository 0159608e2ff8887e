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
use exr::meta::Headers;

pub(super) use read::read;
pub(super) use write::write;

use layer::Layer;

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

impl fmt::Debug for Rest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let channels: usize = self.headers.iter().map(|header| header.channels.list.len()).sum();
        write!(f, "Rest {{ {} parts, {channels} channels, {:?} }}", self.headers.len(), self.layer)
    }
}
