//! What a JPEG says beside its picture: \[XMP3\] XMP specification part 3, 1.1.3, and \[JFIF\] ITU-T T.871, 10.1.

use image::codecs::jpeg::{PixelDensity, PixelDensityUnit};
use image::metadata::Orientation;

use super::super::metadata::{self, EXIF_NAME, Metadata, PHOTOSHOP, Resolution, Unit};
use super::tags;
use super::walk::Walk;

const APP0: u8 = 0xe0;
const APP1: u8 = 0xe1;
const APP13: u8 = 0xed;
const COM: u8 = 0xfe;
/// The most bytes of comments that are kept.
const LARGEST_COMMENTS: usize = 1 << 20;

/// Of a picture that was turned so.
pub(super) fn read(walk: &Walk, turn: Orientation) -> Metadata {
    let mut metadata = Metadata::default();
    if let Some(exif) = walk.named(APP1, EXIF_NAME).next() {
        metadata.take_exif(exif, turn);
    }
    if let Some(packet) = tags::xmp(walk) {
        metadata.take_xmp(packet, turn);
    }
    if walk.named(APP1, b"http://ns.adobe.com/xmp/extension/\0").next().is_some() {
        metadata.left_out.push("its extended XMP is left out".into());
    }
    // Resources may go on from segment to segment.
    let resources: Vec<u8> = walk.named(APP13, PHOTOSHOP).flatten().copied().collect();
    metadata.iptc = metadata::iptc_of_resources(&resources);
    let resolution = walk.named(APP0, b"JFIF\0").next().and_then(density);
    match (resolution, &metadata.exif) {
        (None, Some(exif)) => metadata.resolution = exif.resolution(),
        (resolution, _) => metadata.take_resolution(resolution, turn),
    }
    let mut left = LARGEST_COMMENTS;
    for comment in walk.named(COM, b"").take_while(|comment| {
        left = left.saturating_sub(comment.len());
        left > 0
    }) {
        metadata.comments.push(comment.to_vec());
    }
    metadata
}

/// \[JFIF\] version, unit, and the density both ways.
fn density(header: &[u8]) -> Option<Resolution> {
    let &[_, _, unit, x1, x0, y1, y0, ..] = header else { return None };
    let unit = match unit {
        1 => Unit::Inch,
        2 => Unit::Centimetre,
        _ => Unit::None,
    };
    Resolution::new([[x1, x0], [y1, y0]].map(|n| u16::from_be_bytes(n).into()), unit)
}

/// A resolution as \[JFIF\] holds it, in 16 bits; none where they do not suffice.
pub(super) fn density_of(resolution: Resolution) -> Option<PixelDensity> {
    let (pixels, unit) = match resolution.unit {
        Unit::None => (resolution.pixels, PixelDensityUnit::PixelAspectRatio),
        Unit::Centimetre => (resolution.pixels, PixelDensityUnit::Centimeters),
        Unit::Inch | Unit::Metre => (resolution.in_unit(Unit::Inch), PixelDensityUnit::Inches),
    };
    let [x, y] = pixels.map(|pixels| (1.0..=65535.0).contains(&pixels.round()).then(|| pixels.round() as u16));
    Some(PixelDensity { density: (x?, y?), unit })
}
