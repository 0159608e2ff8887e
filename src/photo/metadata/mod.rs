//! What PNG, TIFF and JPEG say beside their pixels, and what of it the picture that is made of them says again.
//!
//! Kept are Exif, XMP, IPTC and the resolution; texts of a PNG in a PNG, and comments of a JPEG in a JPEG. The photo was
//! turned upright when it was read, and no preview shows the picture that is written: so orientations become 1, and
//! thumbnails are left out. What describes other parts of the file (gain maps, films, signatures) is left out, too.
//!
//! \[XMP3\] XMP specification part 3 (2020), 1.1: how it stands in files. \[IIM\] IPTC-NAA Information Interchange Model 4.2.

mod directories;
mod exif;
mod xmp;

use std::sync::Arc;

use image::metadata::Orientation;

use super::decode::is_quarter_turn;
use super::{Format, Photo};

pub(super) use directories::{Directories, Entry, size_of_kind};
pub(super) use exif::Exif;

/// The most bytes of a JPEG's segment, without its length.
const LARGEST_SEGMENT: usize = 65533;
/// What begins a JPEG's segment of Exif, and \[XMP3\] 1.1.3 one of XMP.
pub(super) const EXIF_NAME: &[u8] = b"Exif\0\0";
pub(super) const XMP_NAME: &[u8] = b"http://ns.adobe.com/xap/1.0/\0";

/// What a file says beside its pixels, of a picture that lies upright.
#[derive(Debug, Default)]
pub(super) struct Metadata {
    pub exif: Option<Exif>,
    /// A packet of XMP.
    pub xmp: Option<String>,
    /// Records of \[IIM\].
    pub iptc: Option<Vec<u8>>,
    pub resolution: Option<Resolution>,
    /// A PNG's chunks of text.
    pub texts: Vec<([u8; 4], Vec<u8>)>,
    /// A JPEG's comments.
    pub comments: Vec<Vec<u8>>,
    /// What else there was, and is not kept, a sentence each.
    pub left_out: Vec<String>,
}

/// Pixels to a length.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Resolution {
    /// Across and down, above 0.
    pub pixels: [f64; 2],
    pub unit: Unit,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Unit {
    /// None: the numbers tell a pixel's shape alone.
    None,
    Inch,
    Centimetre,
    Metre,
}

impl Resolution {
    /// None where the numbers say nothing.
    pub fn new(pixels: [f64; 2], unit: Unit) -> Option<Self> {
        let sound = pixels.iter().all(|&n| n.is_finite() && n > 0.0);
        (sound && (unit != Unit::None || pixels[0] != pixels[1])).then_some(Self { pixels, unit })
    }

    /// In another unit, in which a whole number stands for what is one but for its rounding (11811 to a metre are 300 to an inch).
    pub fn in_unit(self, unit: Unit) -> [f64; 2] {
        let metres = |unit: Unit| match unit {
            Unit::None => 1.0,
            Unit::Inch => 0.0254,
            Unit::Centimetre => 0.01,
            Unit::Metre => 1.0,
        };
        if self.unit == unit || self.unit == Unit::None {
            return self.pixels;
        }
        self.pixels.map(|pixels| {
            let there = pixels / metres(self.unit) * metres(unit);
            // Half a pixel to a metre.
            if (there - there.round()).abs() <= 0.5 * metres(unit) { there.round() } else { there }
        })
    }
}

impl Metadata {
    /// Takes in Exif as it stands in a file, from the byte order on, of a picture that was turned so.
    pub fn take_exif(&mut self, raw: &[u8], turn: Orientation) {
        match Exif::settled(raw, turn) {
            Some(exif) => self.exif = Some(exif),
            None => self.left_out.push("its Exif is damaged, and left out".into()),
        }
    }

    /// Takes in a packet of XMP, likewise.
    pub fn take_xmp(&mut self, packet: &str, turn: Orientation) {
        match xmp::settled(packet, is_quarter_turn(turn)) {
            Ok(packet) => self.xmp = Some(packet),
            Err(reason) => self.left_out.push(format!("its XMP {reason}, and is left out")),
        }
    }

    /// Takes in a resolution, likewise.
    pub fn take_resolution(&mut self, resolution: Option<Resolution>, turn: Orientation) {
        self.resolution = resolution.map(|resolution| {
            let [x, y] = resolution.pixels;
            Resolution { pixels: if is_quarter_turn(turn) { [y, x] } else { [x, y] }, ..resolution }
        });
    }

    /// Whether there is nothing of it.
    pub fn is_empty(&self) -> bool {
        let Self { exif, xmp, iptc, resolution, texts, comments, left_out } = self;
        let alone = exif.is_none() && xmp.is_none() && iptc.is_none() && resolution.is_none();
        alone && texts.is_empty() && comments.is_empty() && left_out.is_empty()
    }

    /// What a photo has of it.
    pub fn attach(self, photo: &mut Photo) {
        photo.source.metadata = (!self.is_empty()).then(|| Arc::new(self));
    }

    /// Exif for a file in the photo's own colour space, or in sRGB.
    pub fn exif_of(&self, srgb: bool) -> Option<Vec<u8>> {
        let exif = self.exif.as_ref()?;
        Some(if srgb { exif.as_srgb() } else { exif.bytes().to_vec() })
    }

    /// What of it a file of this format cannot hold, a sentence each.
    pub fn lost(&self, format: Format) -> Vec<String> {
        if !matches!(format, Format::Png | Format::Tiff | Format::Jpeg) {
            return Vec::new();
        }
        let mut lost: Vec<_> = self.left_out.iter().map(|what| format!("of the photo's file: {what}")).collect();
        if format == Format::Png && self.iptc.is_some() {
            lost.push("PNG has no place for the photo's IPTC, which is left out".into());
        }
        if format == Format::Jpeg {
            let sizes = [
                ("Exif", self.exif.as_ref().map(|exif| (exif.bytes().len(), EXIF_NAME.len()))),
                ("XMP", self.xmp.as_ref().map(|xmp| (xmp.len(), XMP_NAME.len()))),
                ("IPTC", self.iptc.as_ref().map(|iptc| (iptc.len(), IPTC_HEAD))),
            ];
            let too_large = sizes.into_iter().filter_map(|(name, size)| Some((name, size?)));
            let too_large = too_large.filter(|(_, (bytes, head))| bytes + head > LARGEST_SEGMENT);
            lost.extend(too_large.map(|(name, (bytes, _))| {
                format!("a JPEG has no place for the photo's {name} of {bytes} bytes, which is left out")
            }));
        }
        lost
    }

    /// The segments that a JPEG says it in, marker and length included, Exif apart.
    pub fn segments(&self) -> Vec<u8> {
        let mut segments = Vec::new();
        let mut segment = |marker: u8, parts: &[&[u8]]| {
            let length = parts.iter().map(|part| part.len()).sum::<usize>();
            if length <= LARGEST_SEGMENT {
                segments.extend([0xff, marker]);
                segments.extend((length as u16 + 2).to_be_bytes());
                parts.iter().for_each(|part| segments.extend(*part));
            }
        };
        if let Some(xmp) = &self.xmp {
            segment(0xe1, &[XMP_NAME, xmp.as_bytes()]);
        }
        if let Some(iptc) = &self.iptc {
            // A resource has a number, no name, and an even length.
            let length = (iptc.len() as u32).to_be_bytes();
            let even = &[0][..iptc.len() % 2];
            segment(0xed, &[PHOTOSHOP, b"8BIM\x04\x04\0\0", &length, iptc, even]);
        }
        self.comments.iter().for_each(|comment| segment(0xfe, &[comment]));
        segments
    }

    /// Exif, if a segment of a JPEG holds it.
    pub fn exif_segment(&self, srgb: bool) -> Option<Vec<u8>> {
        self.exif_of(srgb).filter(|exif| exif.len() + EXIF_NAME.len() <= LARGEST_SEGMENT)
    }
}

/// What begins a JPEG's segment of Photoshop's resources, and the bytes of such a segment beside \[IIM\]'s.
pub(super) const PHOTOSHOP: &[u8] = b"Photoshop 3.0\0";
const IPTC_HEAD: usize = PHOTOSHOP.len() + 13;

/// The records of \[IIM\] among Photoshop's resources: number 0x0404.
pub(super) fn iptc_of_resources(mut resources: &[u8]) -> Option<Vec<u8>> {
    while let Some(rest) = resources.strip_prefix(b"8BIM") {
        let (number, rest) = rest.split_first_chunk::<2>()?;
        // A name with its length, together even.
        let name = 1 + usize::from(*rest.first()?);
        let rest = rest.get(name + name % 2..)?;
        let (length, rest) = rest.split_first_chunk::<4>()?;
        let length = u32::from_be_bytes(*length) as usize;
        let content = rest.get(..length)?;
        if *number == [0x04, 0x04] {
            return Some(content.to_vec());
        }
        resources = rest.get(length + length % 2..).unwrap_or_default();
    }
    None
}

/// What a photo says beside its pixels in a file of this format.
pub(super) fn of(photo: &Photo) -> Option<&Metadata> {
    photo.source.metadata.as_deref()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_resolution_survives_from_unit_to_unit() {
        for dpi in [72.0, 96.0, 240.0, 300.0, 350.0, 600.0] {
            let metre = Resolution::new([(dpi / 0.0254_f64).round(); 2], Unit::Metre).unwrap();
            assert_eq!(metre.in_unit(Unit::Inch), [dpi; 2]);
            let inch = Resolution::new([dpi; 2], Unit::Inch).unwrap();
            assert_eq!(inch.in_unit(Unit::Metre).map(f64::round), metre.pixels);
        }
        assert_eq!(Resolution::new([1.0, 1.0], Unit::None), None);
        assert_eq!(Resolution::new([0.0, 1.0], Unit::Inch), None);
        let shape = Resolution::new([2.0, 1.0], Unit::None).unwrap();
        assert_eq!(shape.in_unit(Unit::Inch), [2.0, 1.0]);
    }

    #[test]
    fn iptc_is_found_among_other_resources() {
        let resource = |number: [u8; 2], name: &[u8], content: &[u8]| {
            let mut bytes = b"8BIM".to_vec();
            bytes.extend(number);
            bytes.push(name.len() as u8);
            bytes.extend(name);
            bytes.extend(&[0][..(1 + name.len()) % 2]);
            bytes.extend((content.len() as u32).to_be_bytes());
            bytes.extend(content);
            bytes.extend(&[0][..content.len() % 2]);
            bytes
        };
        let wanted = b"\x1c\x02\x05\0\x05Title";
        let all = [resource([4, 5], b"odd", b"x"), resource([4, 9], b"even", b"xy"), resource([4, 4], b"", wanted)];
        assert_eq!(iptc_of_resources(&all.concat()).as_deref(), Some(&wanted[..]));
        // As it is written, it is read.
        let metadata = Metadata { iptc: Some(wanted.to_vec()), ..Metadata::default() };
        let segments = metadata.segments();
        assert_eq!(iptc_of_resources(&segments[4 + PHOTOSHOP.len()..]).as_deref(), Some(&wanted[..]));
        for cut in 0..all.concat().len() - 1 {
            assert_eq!(iptc_of_resources(&all.concat()[..cut]), None, "cut at {cut}");
        }
    }
}
