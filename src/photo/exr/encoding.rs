//! How the parts of a picture are compressed that has changed.

use exr::compression::Compression;
use exr::meta::attribute::{ChannelDescription, SampleType};
use exr::meta::header::Header;

use super::names::{split, text};
use super::unpack::is_plain;

/// Whether a compression changes any samples.
pub(super) fn may_lose(compression: Compression) -> bool {
    use Compression::{B44, B44A, DWAA, DWAB, PXR24};
    matches!(compression, B44 | B44A | DWAA(_) | DWAB(_) | PXR24)
}

/// The header with the compression of the part's new blocks: its own, unless samples would lose once more that are to stay as they are, of
/// which `stays` tells by the index of a channel; then ZIP.
pub(super) fn of_changed(header: Header, stays: impl Fn(usize) -> bool) -> Header {
    let mut channels = header.channels.list.iter().enumerate();
    let keeps = !channels.any(|(index, channel)| stays(index) && loses_again(header.compression, channel));
    // What sees a block as bytes alone does not mind subsampling.
    let by_bytes = [Compression::Uncompressed, Compression::RLE, Compression::ZIP1, Compression::ZIP16];
    if keeps && (is_plain(&header.channels) || by_bytes.contains(&header.compression)) {
        return header;
    }
    let (blocks, order) = (header.blocks, header.line_order);
    header.with_encoding(Compression::ZIP16, blocks, order)
}

/// Whether a channel's samples, which have been through this compression, change once more in it. PXR24 takes the last eight bits of
/// floats, which are gone by then.
fn loses_again(compression: Compression, channel: &ChannelDescription) -> bool {
    use Compression::{B44, B44A, DWAA, DWAB};
    match compression {
        B44 | B44A => channel.sample_type == SampleType::F16,
        // By the last part of the name, as OpenEXR's rules for it have it (ImfDwaCompressor.cpp, classifiers).
        DWAA(_) | DWAB(_) => {
            let name = text(&channel.name);
            let own = split(&name).1.to_ascii_uppercase();
            let own = own.as_str();
            channel.sample_type != SampleType::U32 && ["R", "G", "B", "Y", "RY", "BY"].contains(&own)
        }
        _ => false,
    }
}
