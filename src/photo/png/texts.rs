//! A PNG's chunks of text: XMP among them, and those that are kept as they stand.
//!
//! \[PNG\] PNG specification, third edition, 11.3.3; \[XMP3\] XMP specification part 3, 1.1.5.

use std::io::Read;

use flate2::read::ZlibDecoder;

const XMP: &[u8] = b"XML:com.adobe.xmp";
/// What ImageMagick puts other formats' metadata in, as they were before the picture was turned.
const RAW_PROFILE: &[u8] = b"Raw profile type ";
/// The most bytes of a packet.
const LARGEST: u64 = 16 << 20;

/// A chunk: its name and its content.
pub type Chunk = ([u8; 4], Vec<u8>);

/// Splits chunks of text into a packet of XMP, where there is one that can be read, and all others.
pub fn split(chunks: Vec<Chunk>) -> (Option<String>, Vec<Chunk>) {
    let mut xmp = None;
    let mut others = Vec::new();
    for (name, content) in chunks {
        let (keyword, _) = cut(&content).unwrap_or((&content, &[]));
        if keyword == XMP && name == *b"iTXt" {
            xmp = xmp.or(packet(&content));
        } else if !keyword.starts_with(RAW_PROFILE) {
            others.push((name, content));
        }
    }
    (xmp, others)
}

/// The chunk that holds a packet of XMP, uncompressed as \[XMP3\] wants it.
pub fn xmp_chunk(packet: &str) -> Vec<u8> {
    // Keyword; no compression, and its method; neither language nor translated keyword.
    [XMP, &[0, 0, 0, 0, 0], packet.as_bytes()].concat()
}

fn packet(content: &[u8]) -> Option<String> {
    let (_, rest) = cut(content)?;
    let (&[compressed, _], rest) = rest.split_first_chunk()?;
    let (_, rest) = cut(rest)?;
    let (_, text) = cut(rest)?;
    if compressed == 0 {
        return String::from_utf8(text.to_vec()).ok();
    }
    let mut packet = String::new();
    ZlibDecoder::new(text).take(LARGEST).read_to_string(&mut packet).ok()?;
    Some(packet)
}

/// What stands before the first zero, and behind it.
fn cut(bytes: &[u8]) -> Option<(&[u8], &[u8])> {
    let zero = bytes.iter().position(|&byte| byte == 0)?;
    Some((&bytes[..zero], &bytes[zero + 1..]))
}

#[cfg(test)]
mod tests {
    use std::io::Write;

    use super::*;

    #[test]
    fn xmp_is_found_plain_and_compressed_and_texts_stay() {
        let mut packed = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::default());
        packed.write_all(b"<x/>").unwrap();
        let packed = [XMP, b"\0\x01\0en\0XMP\0", &packed.finish().unwrap()].concat();
        let text = (*b"tEXt", b"Author\0Somebody".to_vec());
        for xmp in [packed, xmp_chunk("<x/>")] {
            let raw = (*b"zTXt", b"Raw profile type exif\0\0...".to_vec());
            let (packet, others) = split(vec![text.clone(), (*b"iTXt", xmp), raw]);
            assert_eq!((packet.as_deref(), &others[..]), (Some("<x/>"), &[text.clone()][..]));
        }
        assert_eq!(split(vec![(*b"iTXt", XMP.to_vec())]), (None, Vec::new()));
    }
}
