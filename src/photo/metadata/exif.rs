//! Exif in place: what a program that turned and changed a picture has to set right, and nothing else moves, so that makers'
//! notes, whose offsets count from the start, stay readable.
//!
//! \[EXIF\] CIPA DC-008-2023: 4.5 for the structure, which is TIFF's, and 4.6 for the tags.

use std::ops::Range;

use image::metadata::Orientation;

use super::super::decode::is_quarter_turn;
use super::directories::size_of_kind;
use super::{Resolution, Unit};

pub(super) mod tag {
    pub const WIDTH: u16 = 0x100;
    pub const HEIGHT: u16 = 0x101;
    pub const STRIP_OFFSETS: u16 = 0x111;
    pub const ORIENTATION: u16 = 0x112;
    pub const STRIP_BYTE_COUNTS: u16 = 0x117;
    pub const X_RESOLUTION: u16 = 0x11a;
    pub const Y_RESOLUTION: u16 = 0x11b;
    pub const THUMBNAIL: u16 = 0x201;
    pub const THUMBNAIL_LENGTH: u16 = 0x202;
    pub const RESOLUTION_UNIT: u16 = 0x128;
    pub const EXIF_IFD: u16 = 0x8769;
    pub const GPS_IFD: u16 = 0x8825;
    pub const MAKER_NOTE: u16 = 0x927c;
    pub const COLOR_SPACE: u16 = 0xa001;
    pub const PIXEL_X: u16 = 0xa002;
    pub const PIXEL_Y: u16 = 0xa003;
    pub const INTEROP_IFD: u16 = 0xa005;
    pub const FOCAL_PLANE_X: u16 = 0xa20e;
    pub const FOCAL_PLANE_Y: u16 = 0xa20f;
    pub const INTEROP_INDEX: u16 = 1;
}

/// What two directions say changes places in a quarter turn.
const ACROSS_AND_DOWN: [(u16, u16); 4] = [
    (tag::WIDTH, tag::HEIGHT),
    (tag::X_RESOLUTION, tag::Y_RESOLUTION),
    (tag::PIXEL_X, tag::PIXEL_Y),
    (tag::FOCAL_PLANE_X, tag::FOCAL_PLANE_Y),
];

/// Exif from its byte order on, of a picture that lies upright, without a thumbnail.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(in super::super) struct Exif(Vec<u8>);

impl Exif {
    /// That of a picture which was turned so since; none where its first directory cannot be read.
    pub fn settled(raw: &[u8], turn: Orientation) -> Option<Self> {
        let mut bytes = Bytes::new(raw.to_vec())?;
        let main = bytes.directory(bytes.first)?;
        if let Some(entry) = main.find(tag::ORIENTATION) {
            bytes.set_short(entry, 1);
        }
        bytes.drop_thumbnail(&main);
        if is_quarter_turn(turn) {
            let exif = bytes.sub_directory(&main, tag::EXIF_IFD);
            for directory in [Some(main), exif].into_iter().flatten() {
                for (across, down) in ACROSS_AND_DOWN {
                    if let (Some(across), Some(down)) = (directory.find(across), directory.find(down)) {
                        // Kind, count, and value or its place.
                        (2..12).for_each(|k| bytes.raw.swap(across.at + k, down.at + k));
                    }
                }
            }
        }
        Some(Self(bytes.raw))
    }

    /// The resolution by its tags; inches where no unit is named.
    pub fn resolution(&self) -> Option<Resolution> {
        let bytes = Bytes::new(self.0.clone())?;
        let main = bytes.directory(bytes.first)?;
        let rational = |tag| {
            let entry = main.find(tag).filter(|entry| (entry.kind, entry.count) == (5, 1))?;
            let at = bytes.value(entry)?.start;
            Some(bytes.long(at)? as f64 / bytes.long(at + 4)? as f64)
        };
        let unit = match main.find(tag::RESOLUTION_UNIT).and_then(|entry| bytes.number(entry)) {
            Some(1) => Unit::None,
            Some(3) => Unit::Centimetre,
            _ => Unit::Inch,
        };
        Resolution::new([rational(tag::X_RESOLUTION)?, rational(tag::Y_RESOLUTION)?], unit)
    }

    /// Built of its bytes, which are known to be so.
    pub(super) fn new(bytes: Vec<u8>) -> Self {
        Self(bytes)
    }

    pub fn bytes(&self) -> &[u8] {
        &self.0
    }

    /// The same of a picture whose colours have become sRGB: ColorSpace 1, and by DCF "R98" where it was "R03", Adobe RGB.
    pub fn as_srgb(&self) -> Vec<u8> {
        let Some(mut bytes) = Bytes::new(self.0.clone()) else { return self.0.clone() };
        let exif = bytes.directory(bytes.first).and_then(|main| bytes.sub_directory(&main, tag::EXIF_IFD));
        if let Some(exif) = exif {
            if let Some(entry) = exif.find(tag::COLOR_SPACE) {
                bytes.set_short(entry, 1);
            }
            let interop = bytes.sub_directory(&exif, tag::INTEROP_IFD);
            let index = interop.and_then(|interop| interop.find(tag::INTEROP_INDEX));
            if let Some(value) = index.and_then(|entry| bytes.value(entry))
                && bytes.raw[value.clone()].starts_with(b"R03")
            {
                bytes.raw[value.start..][..3].copy_from_slice(b"R98");
            }
        }
        bytes.raw
    }
}

/// Bytes in a byte order.
pub(super) struct Bytes {
    pub raw: Vec<u8>,
    pub big_endian: bool,
    /// Where the first directory stands.
    pub first: usize,
}

/// One directory: its entries, and where the place of the next one stands.
pub(super) struct Directory {
    pub entries: Vec<Place>,
    range: Range<usize>,
}

/// Where an entry stands.
#[derive(Debug, Clone, Copy)]
pub(super) struct Place {
    pub tag: u16,
    pub kind: u16,
    pub count: usize,
    at: usize,
}

impl Directory {
    pub fn find(&self, tag: u16) -> Option<Place> {
        self.entries.iter().find(|entry| entry.tag == tag).copied()
    }
}

impl Bytes {
    pub fn new(raw: Vec<u8>) -> Option<Self> {
        let big_endian = match raw.get(..4)? {
            b"II*\0" => false,
            b"MM\0*" => true,
            _ => return None,
        };
        let mut bytes = Self { raw, big_endian, first: 0 };
        bytes.first = bytes.long(4)?;
        Some(bytes)
    }

    fn short(&self, at: usize) -> Option<u16> {
        let bytes = *self.raw.get(at..)?.first_chunk()?;
        Some(if self.big_endian { u16::from_be_bytes(bytes) } else { u16::from_le_bytes(bytes) })
    }

    fn long(&self, at: usize) -> Option<usize> {
        let bytes = *self.raw.get(at..)?.first_chunk()?;
        Some(if self.big_endian { u32::from_be_bytes(bytes) } else { u32::from_le_bytes(bytes) } as usize)
    }

    /// The directory at an offset, if all of it is there.
    pub fn directory(&self, at: usize) -> Option<Directory> {
        let count = usize::from(self.short(at)?);
        let range = at..at + 2 + 12 * count;
        self.raw.get(range.clone())?;
        let entry = |k: usize| {
            let at = at + 2 + 12 * k;
            Some(Place { tag: self.short(at)?, kind: self.short(at + 2)?, count: self.long(at + 4)?, at })
        };
        Some(Directory { entries: (0..count).filter_map(entry).collect(), range })
    }

    /// The directory that an entry leads to.
    pub fn sub_directory(&self, directory: &Directory, tag: u16) -> Option<Directory> {
        self.directory(self.number(directory.find(tag)?)?)
    }

    /// Where the values of an entry stand.
    pub fn value(&self, entry: Place) -> Option<Range<usize>> {
        let length = entry.count.checked_mul(size_of_kind(entry.kind)?)?;
        let start = if length <= 4 { entry.at + 8 } else { self.long(entry.at + 8)? };
        let range = start..start.checked_add(length)?;
        self.raw.get(range.clone()).map(|_| range)
    }

    /// The number of an entry that holds one.
    fn number(&self, entry: Place) -> Option<usize> {
        match (entry.kind, entry.count) {
            (3, 1) => self.short(entry.at + 8).map(usize::from),
            (4 | 13, 1) => self.long(entry.at + 8),
            _ => None,
        }
    }

    /// Sets the number of an entry that holds one.
    fn set_short(&mut self, entry: Place, value: u16) {
        let at = entry.at + 8;
        match (entry.kind, entry.count) {
            (3, 1) => {
                let bytes = if self.big_endian { value.to_be_bytes() } else { value.to_le_bytes() };
                self.raw[at..at + 2].copy_from_slice(&bytes);
            }
            (4, 1) => {
                let value = u32::from(value);
                let bytes = if self.big_endian { value.to_be_bytes() } else { value.to_le_bytes() };
                self.raw[at..at + 4].copy_from_slice(&bytes);
            }
            _ => {}
        }
    }

    /// Takes the directory of the thumbnail from the list, and its picture from the file.
    fn drop_thumbnail(&mut self, main: &Directory) {
        let next = main.range.end;
        let second = self.long(next).filter(|&at| at > 0);
        let Some(link) = self.raw.get_mut(next..next + 4) else { return };
        link.fill(0);
        let Some(second) = second.and_then(|at| self.directory(at)) else { return };
        let pictures = [(tag::THUMBNAIL, tag::THUMBNAIL_LENGTH), (tag::STRIP_OFFSETS, tag::STRIP_BYTE_COUNTS)];
        for (start, length) in pictures {
            let number = |tag| second.find(tag).and_then(|entry| self.number(entry));
            let Some((start, length)) = number(start).zip(number(length)) else { continue };
            let range = start..start.saturating_add(length).min(self.raw.len());
            // What lies about its place must not take the first directory with it.
            if range.is_empty() || range.start < main.range.end + 4 && range.end > main.range.start || range.start < 8 {
                continue;
            }
            if range.end == self.raw.len() {
                self.raw.truncate(range.start);
            } else {
                self.raw[range].fill(0);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::directories::{Directories, Entry};
    use super::*;

    /// Orientation 6, 6000 × 4000, uncalibrated, "R03", and a thumbnail in the second directory.
    fn raw() -> Vec<u8> {
        let short = |tag, value: u16| Entry { tag, kind: 3, values: value.to_ne_bytes().to_vec() };
        let long = |tag, value: u32| Entry { tag, kind: 4, values: value.to_ne_bytes().to_vec() };
        let text = |tag, value: &[u8]| Entry { tag, kind: 2, values: value.to_vec() };
        let directories = Directories {
            main: vec![text(0x10f, b"A maker of cameras\0"), short(tag::ORIENTATION, 6)],
            exif: vec![short(tag::COLOR_SPACE, 65535), long(tag::PIXEL_X, 6000), long(tag::PIXEL_Y, 4000)],
            interop: vec![text(tag::INTEROP_INDEX, b"R03\0")],
            gps: Vec::new(),
        };
        let mut raw = directories.to_bytes();
        let bytes = Bytes::new(raw.clone()).unwrap();
        let link = bytes.directory(bytes.first).unwrap().range.end;
        let second = raw.len();
        raw[link..link + 4].copy_from_slice(&(second as u32).to_ne_bytes());
        raw.extend(2_u16.to_ne_bytes());
        for (tag, value) in [(tag::THUMBNAIL, second + 30), (tag::THUMBNAIL_LENGTH, 9)] {
            raw.extend(tag.to_ne_bytes());
            raw.extend(4_u16.to_ne_bytes());
            raw.extend(1_u32.to_ne_bytes());
            raw.extend((value as u32).to_ne_bytes());
        }
        raw.extend([0; 4]);
        raw.extend(b"thumbnail");
        raw
    }

    fn number(raw: &[u8], tag: u16) -> Option<usize> {
        let bytes = Bytes::new(raw.to_vec()).unwrap();
        let main = bytes.directory(bytes.first).unwrap();
        let exif = bytes.sub_directory(&main, tag::EXIF_IFD).unwrap();
        main.find(tag).or_else(|| exif.find(tag)).and_then(|entry| bytes.number(entry))
    }

    #[test]
    fn what_was_turned_says_so_and_shows_no_thumbnail() {
        let settled = Exif::settled(&raw(), Orientation::Rotate90).unwrap();
        assert_eq!(number(settled.bytes(), tag::ORIENTATION), Some(1));
        assert_eq!(number(settled.bytes(), tag::PIXEL_X), Some(4000));
        assert_eq!(number(settled.bytes(), tag::PIXEL_Y), Some(6000));
        assert!(!settled.bytes().windows(9).any(|word| word == b"thumbnail"));
        assert!(settled.bytes().windows(9).any(|word| word == b"A maker o"));
        // In the middle it leaves a gap, so that nothing moves.
        let longer = [raw(), b"behind it".to_vec()].concat();
        let settled = Exif::settled(&longer, Orientation::NoTransforms).unwrap();
        assert_eq!(settled.bytes().len(), longer.len());
        assert!(!settled.bytes().windows(9).any(|word| word == b"thumbnail"));
        assert_eq!(number(settled.bytes(), tag::PIXEL_X), Some(6000));
        let directories = Directories::of(settled.bytes()).unwrap();
        assert_eq!(directories.main.len(), 1, "the maker, without what the picture's own tags say");
    }

    #[test]
    fn what_has_become_srgb_says_so() {
        let settled = Exif::settled(&raw(), Orientation::NoTransforms).unwrap();
        let srgb = settled.as_srgb();
        assert_eq!(number(&srgb, tag::COLOR_SPACE), Some(1));
        assert!(srgb.windows(4).any(|word| word == b"R98\0") && !srgb.windows(3).any(|word| word == b"R03"));
        assert_eq!(number(settled.bytes(), tag::COLOR_SPACE), Some(65535));
    }

    #[test]
    fn damaged_exif_is_left_or_settled_but_never_trusted() {
        let whole = raw();
        for cut in 0..whole.len() {
            let _ = Exif::settled(&whole[..cut], Orientation::Rotate90).map(|exif| exif.as_srgb());
            let _ = Directories::of(&whole[..cut]);
        }
        // Every byte wrong in turn.
        for at in 0..whole.len() {
            for value in [0, 1, 0x7f, 0xff] {
                let mut bad = whole.clone();
                bad[at] = value;
                let _ = Exif::settled(&bad, Orientation::Rotate270).map(|exif| exif.as_srgb());
                let _ = Directories::of(&bad);
            }
        }
        assert!(Exif::settled(b"", Orientation::NoTransforms).is_none());
    }
}
