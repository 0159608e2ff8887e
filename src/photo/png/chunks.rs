//! A PNG's chunks, looked over before a decoder sees them: whether the file can hold what its header says.

use std::io::{Read, Seek, SeekFrom};

use super::super::read::check_size;
use super::super::{Reason, zeroed};
use super::texts::Chunk;

/// The most bytes that one byte of zlib's can become: zlib.net/zlib_tech.html, "Maximum Compression Factor".
const EXPANSION: u64 = 1032;

/// The most bytes of text that are kept.
const LARGEST_TEXTS: u64 = 16 << 20;

/// What the chunks amount to; sizes are those of what is there, whatever the chunks say.
pub struct Chunks {
    width: u32,
    height: u32,
    /// Of a pixel.
    bits: u64,
    /// Bytes of the picture.
    picture: u64,
    /// Bytes of the ICC profile's chunk, 0 without one.
    pub profile: usize,
    /// Those of text, as far as there are not too many.
    pub texts: Vec<Chunk>,
}

impl Chunks {
    /// Goes over a file from chunk to chunk, and back to its start.
    ///
    /// # Errors
    /// Where the file does not begin as a PNG does.
    pub fn scan(mut reader: impl Read + Seek) -> Result<Self, Reason> {
        let length = reader.seek(SeekFrom::End(0))?;
        reader.rewind()?;
        let mut head = [0; 33];
        reader.read_exact(&mut head)?;
        let number = |at: usize| u32::from_be_bytes([head[at], head[at + 1], head[at + 2], head[at + 3]]);
        if head[12..16] != *b"IHDR" {
            return Err("it does not begin with a header".into());
        }
        let samples = [1, 0, 3, 1, 2, 0, 4].get(usize::from(head[25])).copied().unwrap_or(0);
        let (width, height, bits) = (number(16), number(20), samples * u64::from(head[24]));
        let mut chunks = Self { width, height, bits, picture: 0, profile: 0, texts: Vec::new() };
        let mut left = LARGEST_TEXTS;
        let mut at = head.len() as u64;
        while at + 8 <= length {
            let mut head = [0; 8];
            reader.read_exact(&mut head)?;
            let says = u64::from(u32::from_be_bytes([head[0], head[1], head[2], head[3]]));
            let holds = says.min(length - at - 8);
            match &head[4..] {
                b"IDAT" => chunks.picture += holds,
                b"iCCP" => chunks.profile = holds as usize,
                b"tEXt" | b"zTXt" | b"iTXt" if holds == says && says <= left => {
                    left -= says;
                    chunks.texts.extend(text(&mut reader, head)?);
                    // As far as if it had been passed over.
                    reader.seek(SeekFrom::Start(at + 8))?;
                }
                b"IEND" => break,
                _ => {}
            }
            // A checksum follows.
            at += 8 + says + 4;
            reader.seek_relative(says as i64 + 4)?;
        }
        reader.rewind()?;
        Ok(chunks)
    }

    /// Bytes of a row of the picture, as it is read: 8 or 16 bit, with alpha.
    ///
    /// # Errors
    /// Where there is no memory for so many.
    pub fn row(&self) -> Result<usize, Reason> {
        Ok(usize::try_from(u64::from(self.width) * 8 + 64)?)
    }

    /// Whether the bytes that are there can become the picture that the header speaks of.
    ///
    /// # Errors
    /// Where they cannot.
    pub fn check(&self) -> Result<(), Reason> {
        check_size(self.width, self.height)?;
        let bytes = (u64::from(self.width) * self.bits).div_ceil(8) * u64::from(self.height);
        if bytes > self.picture * EXPANSION {
            let (width, height, there) = (self.width, self.height, self.picture);
            return Err(format!(
                "it says that it has {width} × {height} pixels, and its {there} bytes of picture cannot hold them: \
                 the file is cut short"
            )
            .into());
        }
        Ok(())
    }
}

/// A chunk behind its length and name; none where its checksum is wrong, or cut off.
fn text(reader: &mut impl Read, head: [u8; 8]) -> Result<Option<Chunk>, Reason> {
    let [l3, l2, l1, l0, name @ ..] = head;
    let mut content = zeroed(u32::from_be_bytes([l3, l2, l1, l0]) as usize)?;
    reader.read_exact(&mut content)?;
    let mut sum = [0; 4];
    let mut crc = flate2::Crc::new();
    crc.update(&name);
    crc.update(&content);
    let sound = reader.read_exact(&mut sum).is_ok() && u32::from_be_bytes(sum) == crc.sum();
    Ok(sound.then_some((name, content)))
}
