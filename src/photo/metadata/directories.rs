//! Exif taken apart: a TIFF holds it in directories of its own, PNG and JPEG as a small TIFF.

use super::exif::{Bytes, Directory, Exif, Place, tag};

/// What a picture's main directory says of the photo, and not of how its samples are stored: TIFF 6.0, \[EXIF\] table 4, and
/// what Windows writes (Rating, XPTitle to XPSubject).
const DESCRIPTIVE: [u16; 16] =
    [269, 270, 271, 272, 305, 306, 315, 316, 18246, 18249, 33432, 40091, 40092, 40093, 40094, 40095];

/// The most bytes that it may take.
const LARGEST: usize = 16 << 20;

/// One entry: values in the machine's byte order.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(in super::super) struct Entry {
    pub tag: u16,
    /// The type of TIFF 6.0, section 2.
    pub kind: u16,
    pub values: Vec<u8>,
}

/// The directories of Exif.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(in super::super) struct Directories {
    pub main: Vec<Entry>,
    pub exif: Vec<Entry>,
    pub gps: Vec<Entry>,
    pub interop: Vec<Entry>,
}

impl Entry {
    /// Of values in a byte order; none where their kind is unknown, or they are no whole number of them.
    pub fn new(tag: u16, kind: u16, mut values: Vec<u8>, big_endian: bool) -> Option<Self> {
        if !values.len().is_multiple_of(size_of_kind(kind)?) || values.is_empty() {
            return None;
        }
        if big_endian != cfg!(target_endian = "big") {
            values.chunks_exact_mut(size_of_number(kind)).for_each(<[u8]>::reverse);
        }
        Some(Self { tag, kind, values })
    }
}

impl Directories {
    /// Whether an entry of the main directory tells of the photo.
    pub fn is_descriptive(tag: u16) -> bool {
        DESCRIPTIVE.contains(&tag)
    }

    /// Whether an entry of another directory means the same anywhere: it leads to no directory, and is no maker's note,
    /// whose offsets count from where it was.
    pub fn is_movable(tag: u16) -> bool {
        ![tag::EXIF_IFD, tag::GPS_IFD, tag::INTEROP_IFD, tag::MAKER_NOTE].contains(&tag)
    }

    /// Those of Exif from its byte order on, without what they say of how its picture is stored.
    pub fn of(raw: &[u8]) -> Option<Self> {
        let bytes = Bytes::new(raw.to_vec())?;
        let main = bytes.directory(bytes.first)?;
        let mut left = LARGEST;
        let mut entries = |directory: Option<&Directory>, wanted: fn(u16) -> bool| -> Vec<Entry> {
            let wanted = directory.into_iter().flat_map(|known| &known.entries).filter(|entry| wanted(entry.tag));
            let entry = |place: &Place| {
                let values = bytes.raw[bytes.value(*place)?].to_vec();
                left = left.checked_sub(values.len())?;
                Entry::new(place.tag, place.kind, values, bytes.big_endian)
            };
            wanted.filter_map(entry).collect()
        };
        let exif = bytes.sub_directory(&main, tag::EXIF_IFD);
        let gps = bytes.sub_directory(&main, tag::GPS_IFD);
        let interop = exif.as_ref().and_then(|exif| bytes.sub_directory(exif, tag::INTEROP_IFD));
        Some(Self {
            main: entries(Some(&main), Self::is_descriptive),
            exif: entries(exif.as_ref(), Self::is_movable),
            gps: entries(gps.as_ref(), Self::is_movable),
            interop: entries(interop.as_ref(), Self::is_movable),
        })
    }

    fn is_empty(&self) -> bool {
        let Self { main, exif, gps, interop } = self;
        [main, exif, gps, interop].iter().all(|entries| entries.is_empty())
    }

    /// Exif of them; none where they are empty.
    pub fn to_exif(&self) -> Option<Exif> {
        (!self.is_empty()).then(|| Exif::new(self.to_bytes()))
    }

    /// The bytes of Exif, in the machine's byte order.
    pub(super) fn to_bytes(&self) -> Vec<u8> {
        let mut bytes = if cfg!(target_endian = "big") { b"MM\0*".to_vec() } else { b"II*\0".to_vec() };
        bytes.extend([0; 4]);
        let pointer = |tag, at: usize| Entry { tag, kind: 4, values: (at as u32).to_ne_bytes().to_vec() };
        let mut exif = self.exif.clone();
        if !self.interop.is_empty() {
            exif.push(pointer(tag::INTEROP_IFD, append(&mut bytes, &self.interop)));
        }
        let mut main = self.main.clone();
        for (tag, entries) in [(tag::EXIF_IFD, &exif), (tag::GPS_IFD, &self.gps)] {
            if !entries.is_empty() {
                main.push(pointer(tag, append(&mut bytes, entries)));
            }
        }
        let first = append(&mut bytes, &main) as u32;
        bytes[4..8].copy_from_slice(&first.to_ne_bytes());
        bytes
    }
}

/// Puts a directory and its values behind `bytes`; where it stands.
fn append(bytes: &mut Vec<u8>, entries: &[Entry]) -> usize {
    // In the order of their tags, each once: TIFF 6.0, section 2.
    let mut entries: Vec<&Entry> = entries.iter().collect();
    entries.sort_by_key(|entry| entry.tag);
    entries.dedup_by_key(|entry| entry.tag);
    let mut directory = (entries.len() as u16).to_ne_bytes().to_vec();
    for Entry { tag, kind, values } in entries {
        let count = values.len() / size_of_kind(*kind).unwrap_or(1);
        directory.extend(tag.to_ne_bytes());
        directory.extend(kind.to_ne_bytes());
        directory.extend((count as u32).to_ne_bytes());
        if values.len() <= 4 {
            directory.extend(values);
            directory.extend(&[0; 4][values.len()..]);
        } else {
            directory.extend((bytes.len() as u32).to_ne_bytes());
            bytes.extend(values);
            bytes.extend(&[0][..values.len() % 2]);
        }
    }
    let at = bytes.len();
    bytes.extend(directory);
    bytes.extend([0; 4]);
    at
}

/// Bytes of one value of a kind: TIFF 6.0 page 15, IFD of the first supplement, the 64-bit ones of BigTIFF.
pub(in super::super) fn size_of_kind(kind: u16) -> Option<usize> {
    match kind {
        1 | 2 | 6 | 7 => Some(1),
        3 | 8 => Some(2),
        4 | 9 | 11 | 13 => Some(4),
        5 | 10 | 12 | 16..=18 => Some(8),
        _ => None,
    }
}

/// Bytes that change places with the byte order: a rational is two numbers.
fn size_of_number(kind: u16) -> usize {
    match kind {
        5 | 10 => 4,
        _ => size_of_kind(kind).unwrap_or(1),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directories_survive_being_put_together_and_taken_apart() {
        let entry = |tag, kind, values: &[u8]| Entry::new(tag, kind, values.to_vec(), true).unwrap();
        let directories = Directories {
            main: vec![entry(271, 2, b"Maker\0"), entry(305, 2, b"Sw\0")],
            exif: vec![entry(0x829a, 5, &[0, 0, 0, 1, 0, 0, 0, 60]), entry(0x8827, 3, &[0, 100])],
            gps: vec![entry(0, 1, &[2, 3, 0, 0]), entry(1, 2, b"N\0")],
            interop: vec![entry(1, 2, b"R98\0")],
        };
        let exif = directories.to_exif().unwrap();
        assert_eq!(Directories::of(exif.bytes()), Some(directories));
        // Another reader finds what was meant.
        let read = ::exif::Reader::new().read_raw(exif.bytes().to_vec()).unwrap();
        let field = |tag| read.get_field(tag, ::exif::In::PRIMARY).unwrap().display_value().to_string();
        assert_eq!(field(::exif::Tag::ExposureTime), "1/60");
        assert_eq!(field(::exif::Tag::Make), "\"Maker\"");
        assert_eq!(field(::exif::Tag::InteroperabilityIndex), "\"R98\"");
        assert_eq!(Directories::default().to_exif(), None);
        assert_eq!(Entry::new(1, 5, vec![0; 4], true), None, "half a rational");
    }
}
