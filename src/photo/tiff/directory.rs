//! The header of a TIFF, its directories and their tags. Nothing is read that the file is too short for.

use std::collections::HashMap;
use std::io::{Read, Seek, SeekFrom};

use super::super::metadata::{self, size_of_kind};
use super::super::{Reason, zeroed};

/// The numbers of the tags that are looked at: TIFF 6.0, its supplements, and the registered ones of others.
pub(super) mod tag {
    pub const NEW_SUBFILE_TYPE: u16 = 254;
    pub const SUBFILE_TYPE: u16 = 255;
    pub const WIDTH: u16 = 256;
    pub const HEIGHT: u16 = 257;
    pub const BITS_PER_SAMPLE: u16 = 258;
    pub const COMPRESSION: u16 = 259;
    pub const PHOTOMETRIC: u16 = 262;
    pub const FILL_ORDER: u16 = 266;
    pub const MAKE: u16 = 271;
    pub const STRIP_OFFSETS: u16 = 273;
    pub const ORIENTATION: u16 = 274;
    pub const SAMPLES_PER_PIXEL: u16 = 277;
    pub const ROWS_PER_STRIP: u16 = 278;
    pub const STRIP_BYTE_COUNTS: u16 = 279;
    pub const PLANAR_CONFIGURATION: u16 = 284;
    pub const T4_OPTIONS: u16 = 292;
    pub const PREDICTOR: u16 = 317;
    pub const COLOR_MAP: u16 = 320;
    pub const TILE_WIDTH: u16 = 322;
    pub const TILE_LENGTH: u16 = 323;
    pub const TILE_OFFSETS: u16 = 324;
    pub const TILE_BYTE_COUNTS: u16 = 325;
    pub const SUB_IFDS: u16 = 330;
    pub const INK_SET: u16 = 332;
    pub const EXTRA_SAMPLES: u16 = 338;
    pub const SAMPLE_FORMAT: u16 = 339;
    pub const JPEG_TABLES: u16 = 347;
    pub const YCBCR_COEFFICIENTS: u16 = 529;
    pub const YCBCR_SUBSAMPLING: u16 = 530;
    pub const REFERENCE_BLACK_WHITE: u16 = 532;
    pub const EXIF_IFD: u16 = 34665;
    pub const ICC_PROFILE: u16 = 34675;
    pub const DNG_VERSION: u16 = 50706;
}

/// A file of which the header has been read.
pub(super) struct File<R> {
    reader: R,
    length: u64,
    /// Whether numbers stand with their highest byte first.
    pub big_endian: bool,
    /// Whether this is a BigTIFF, whose offsets have 64 bits.
    big: bool,
    /// Where the first directory stands.
    pub first: u64,
    /// Whether it is a Canon CR2, told by the header.
    pub canon_raw: bool,
}

/// One directory: the tags of a picture.
pub(super) struct Directory {
    entries: HashMap<u16, Entry>,
    /// Where the next one stands; 0 if this is the last.
    pub next: u64,
    /// Bytes that it takes in the file.
    pub size: u64,
}

struct Entry {
    kind: u16,
    count: u64,
    /// The values themselves where they fit in, else their offset.
    value: [u8; 8],
}

impl Directory {
    pub fn has(&self, tag: u16) -> bool {
        self.entries.contains_key(&tag)
    }
}

impl<R: Read + Seek> File<R> {
    pub fn open(mut reader: R) -> Result<Self, Reason> {
        let length = reader.seek(SeekFrom::End(0))?;
        let mut file = Self { reader, length, big_endian: false, big: false, first: 0, canon_raw: false };
        let head = file.bytes(0, 8)?;
        file.big_endian = head[0] == b'M';
        file.big = file.number_in(&head[2..4]) == 43;
        file.first = if file.big {
            let head = file.bytes(4, 12)?;
            if file.number_in(&head[..2]) != 8 {
                return Err("its BigTIFF header is damaged".into());
            }
            file.number_in(&head[4..])
        } else {
            file.number_in(&head[4..])
        };
        file.canon_raw = file.bytes(8, 2).is_ok_and(|mark| mark == b"CR") && !file.big;
        Ok(file)
    }

    /// Bytes of the file.
    pub fn length(&self) -> u64 {
        self.length
    }

    /// `count` bytes from `at`.
    pub fn bytes(&mut self, at: u64, count: u64) -> Result<Vec<u8>, Reason> {
        if at.checked_add(count).is_none_or(|end| end > self.length) {
            return Err("the file is cut short".into());
        }
        let mut bytes = zeroed(usize::try_from(count)?)?;
        self.reader.seek(SeekFrom::Start(at))?;
        self.reader.read_exact(&mut bytes)?;
        Ok(bytes)
    }

    /// The directory at an offset.
    pub fn directory(&mut self, at: u64) -> Result<Directory, Reason> {
        let (count_size, entry_size) = if self.big { (8, 20) } else { (2, 12) };
        let word = if self.big { 8 } else { 4 };
        let head = self.bytes(at, count_size)?;
        let count = self.number_in(&head);
        let size = count.checked_mul(entry_size as u64).and_then(|size| size.checked_add(word as u64));
        let body = self.bytes(at + count_size, size.ok_or("its directory is damaged")?)?;
        let (entries, next) = body.split_at(body.len() - word);
        let next = self.number_in(next);
        let entry = |bytes: &[u8]| {
            let mut value = [0; 8];
            value[..word].copy_from_slice(&bytes[4 + word..]);
            let count = self.number_in(&bytes[4..4 + word]);
            (self.number_in(&bytes[..2]) as u16, Entry { kind: self.number_in(&bytes[2..4]) as u16, count, value })
        };
        // Where a tag is there twice, the first holds, as in libtiff.
        let mut found = HashMap::new();
        for (tag, entry) in entries.chunks_exact(entry_size).map(entry) {
            found.entry(tag).or_insert(entry);
        }
        Ok(Directory { entries: found, next, size: count_size + body.len() as u64 })
    }

    /// The bytes of a tag's values and the size of one, of at most `most` values.
    fn values(&mut self, entry: &Entry, most: usize) -> Result<(usize, Vec<u8>), Reason> {
        let size = size_of_kind(entry.kind).ok_or("a tag is of an unknown kind")?;
        let whole = entry.count.checked_mul(size as u64).ok_or("a tag is damaged")?;
        let wanted = entry.count.min(most as u64) * size as u64;
        let inline = if self.big { 8 } else { 4 };
        if whole <= inline as u64 {
            return Ok((size, entry.value[..wanted as usize].to_vec()));
        }
        let at = self.number_in(&entry.value[..inline]);
        Ok((size, self.bytes(at, wanted)?))
    }

    /// The integers of a tag, the first `most` of them.
    pub fn numbers(&mut self, directory: &Directory, tag: u16, most: usize) -> Result<Option<Vec<u64>>, Reason> {
        let Some(entry) = directory.entries.get(&tag) else { return Ok(None) };
        if matches!(entry.kind, 2 | 5 | 10 | 11 | 12) {
            return Err(format!("its tag {tag} holds no integers").into());
        }
        let (size, bytes) = self.values(entry, most)?;
        Ok(Some(bytes.chunks_exact(size).map(|value| self.number_in(value)).collect()))
    }

    /// The first integer of a tag.
    pub fn number(&mut self, directory: &Directory, tag: u16) -> Result<Option<u64>, Reason> {
        Ok(self.numbers(directory, tag, 1)?.and_then(|values| values.first().copied()))
    }

    /// The numbers of a tag that holds rationals or floats, the first `most` of them.
    pub fn reals(&mut self, directory: &Directory, tag: u16, most: usize) -> Result<Option<Vec<f64>>, Reason> {
        let Some(entry) = directory.entries.get(&tag) else { return Ok(None) };
        let (size, bytes) = self.values(entry, most)?;
        let real = |value: &[u8]| match entry.kind {
            5 => self.number_in(&value[..4]) as f64 / self.number_in(&value[4..]) as f64,
            10 => f64::from(self.number_in(&value[..4]) as i32) / f64::from(self.number_in(&value[4..]) as i32),
            11 => f64::from(f32::from_bits(self.number_in(value) as u32)),
            12 => f64::from_bits(self.number_in(value)),
            _ => self.number_in(value) as f64,
        };
        Ok(Some(bytes.chunks_exact(size).map(real).collect()))
    }

    /// How many bytes a tag's values have; 0 if it is not there.
    pub fn size_of(&self, directory: &Directory, tag: u16) -> u64 {
        let size = |entry: &Entry| entry.count.saturating_mul(size_of_kind(entry.kind).unwrap_or(1) as u64);
        directory.entries.get(&tag).map_or(0, size)
    }

    /// The bytes of a tag as they stand.
    pub fn raw(&mut self, directory: &Directory, tag: u16) -> Result<Option<Vec<u8>>, Reason> {
        let Some(entry) = directory.entries.get(&tag) else { return Ok(None) };
        Ok(Some(self.values(entry, usize::MAX)?.1))
    }

    /// The entries that are `wanted`, those of them that can be read, of at most `most` bytes each.
    pub fn entries(&mut self, directory: &Directory, wanted: fn(u16) -> bool, most: u64) -> Vec<metadata::Entry> {
        let wanted =
            directory.entries.iter().filter(|(tag, _)| wanted(**tag) && self.size_of(directory, **tag) <= most);
        let mut wanted: Vec<_> = wanted.collect();
        wanted.sort_by_key(|(tag, _)| **tag);
        let read = |(&tag, entry): (&u16, &Entry)| {
            let (_, values) = self.values(entry, usize::MAX).ok()?;
            metadata::Entry::new(tag, entry.kind, values, self.big_endian)
        };
        wanted.into_iter().filter_map(read).collect()
    }

    /// The number that up to eight bytes are in the file's order.
    fn number_in(&self, bytes: &[u8]) -> u64 {
        let add = |number: u64, &byte: &u8| number << 8 | u64::from(byte);
        if self.big_endian { bytes.iter().fold(0, add) } else { bytes.iter().rev().fold(0, add) }
    }
}
