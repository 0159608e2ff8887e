//! From the bytes of a strip or tile to the bytes of its samples.

use std::io::{Read, Seek};

use weezl::{BitOrder, LzwError};

use super::super::Reason;
use super::directory::{Directory, File, tag};
use super::fax;

/// How strips and tiles are packed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Compression {
    None,
    Lzw,
    /// zlib streams.
    Deflate,
    PackBits,
    Zstd,
    /// ITU-T T.4 in one dimension; `aligned` where each row begins a byte and none has a mark at its end.
    FaxGroup3 {
        aligned: bool,
    },
    /// ITU-T T.6.
    FaxGroup4,
    Jpeg,
    WebP,
    /// The runs of LogL and 32-bit LogLuv.
    SgiLog,
}

impl Compression {
    pub fn of<R: Read + Seek>(file: &mut File<R>, page: &Directory) -> Result<Self, Reason> {
        let name = match file.number(page, tag::COMPRESSION)?.unwrap_or(1) {
            1 => return Ok(Self::None),
            2 => return Ok(Self::FaxGroup3 { aligned: true }),
            3 if file.number(page, tag::T4_OPTIONS)?.unwrap_or(0) & 1 == 0 => {
                return Ok(Self::FaxGroup3 { aligned: false });
            }
            4 => return Ok(Self::FaxGroup4),
            5 => return Ok(Self::Lzw),
            7 => return Ok(Self::Jpeg),
            8 | 32946 => return Ok(Self::Deflate),
            32773 => return Ok(Self::PackBits),
            34676 => return Ok(Self::SgiLog),
            50000 => return Ok(Self::Zstd),
            50001 => return Ok(Self::WebP),
            3 => "CCITT group 3 in two dimensions",
            6 => "old-style JPEG",
            32766 => "NeXT runs",
            32809 => "ThunderScan",
            33003 | 33004 | 33005 | 34712 => "JPEG 2000",
            34661 => "JBIG",
            34677 => "24-bit LogLuv",
            34887 => "LERC",
            34892 => "a raw file's lossy JPEG",
            34925 => "LZMA",
            50002 | 52546 => "JPEG XL",
            other => return Err(format!("it is compressed by the unknown scheme {other}").into()),
        };
        Err(format!("it is compressed by {name}, which vglare does not read").into())
    }

    /// Whether a strip or tile is a picture of its own that knows its size.
    pub fn is_picture(self) -> bool {
        matches!(self, Self::Jpeg | Self::WebP)
    }

    /// Whether it holds pixels of one bit.
    pub fn is_fax(self) -> bool {
        matches!(self, Self::FaxGroup3 { .. } | Self::FaxGroup4)
    }

    /// Whether a predictor may stand behind it.
    pub fn is_predicted(self) -> bool {
        matches!(self, Self::Lzw | Self::Deflate | Self::Zstd)
    }

    /// Whether `pieces` strips can be found without their sizes.
    pub fn may_lack_sizes(self, pieces: usize) -> bool {
        self == Self::None || pieces == 1
    }

    /// The most bytes that one byte can become, roughly: a file that needs more has been cut.
    pub fn most(self) -> u64 {
        match self {
            Self::None => 1,
            // A run of 128 in two bytes.
            Self::PackBits | Self::SgiLog => 130,
            // 258 bytes in two bits.
            Self::Deflate => 1040,
            // Strings one longer each up to 3838, in codes of 9 to 12 bits.
            Self::Lzw => 1700,
            // Whole blocks of 128 KiB, rows, or pictures in a few bits.
            Self::Zstd | Self::FaxGroup3 { .. } | Self::FaxGroup4 | Self::Jpeg | Self::WebP => 1 << 17,
        }
    }

    /// The `wanted` bytes that `packed` holds, of rows of `width` pixels of one bit for faxes. What follows is left.
    pub fn unpack(self, packed: Vec<u8>, wanted: usize, width: usize) -> Result<Vec<u8>, Reason> {
        let mut bytes = match self {
            Self::None => packed,
            Self::Lzw => lzw(&packed, wanted)?,
            Self::Deflate => stream(flate2::read::ZlibDecoder::new(&packed[..]), wanted)?,
            Self::PackBits => pack_bits(&packed, wanted),
            Self::Zstd => stream(ruzstd::decoding::StreamingDecoder::new(&packed[..])?, wanted)?,
            Self::FaxGroup3 { aligned } => fax::group3(&packed, width, wanted, aligned)?,
            Self::FaxGroup4 => fax::group4(&packed, width, wanted)?,
            Self::Jpeg | Self::WebP | Self::SgiLog => return Err("it is no stream of bytes".into()),
        };
        if bytes.len() < wanted {
            return Err(format!("it is cut short: {} of {wanted} bytes", bytes.len()).into());
        }
        bytes.truncate(wanted);
        Ok(bytes)
    }
}

/// At most `wanted` bytes of what a decoder delivers.
fn stream(decoder: impl Read, wanted: usize) -> Result<Vec<u8>, Reason> {
    let mut bytes = Vec::new();
    bytes.try_reserve_exact(wanted.min(1 << 24))?;
    decoder.take(wanted as u64).read_to_end(&mut bytes)?;
    Ok(bytes)
}

fn lzw(packed: &[u8], wanted: usize) -> Result<Vec<u8>, Reason> {
    // Before TIFF 6.0 the bits came in the other order, and codes grew one later; both begin with code 256.
    let old = packed.len() > 1 && packed[0] == 0 && packed[1] & 1 == 1;
    let mut decoder = match old {
        true => weezl::decode::Decoder::new(BitOrder::Lsb, 8),
        false => weezl::decode::Decoder::with_tiff_size_switch(BitOrder::Msb, 8),
    };
    let mut bytes = super::super::zeroed(wanted)?;
    let (mut read, mut written) = (0, 0);
    while written < wanted {
        let step = decoder.decode_bytes(&packed[read..], &mut bytes[written..]);
        (read, written) = (read + step.consumed_in, written + step.consumed_out);
        match step.status {
            Ok(weezl::LzwStatus::Ok) if step.consumed_in + step.consumed_out > 0 => {}
            Ok(_) => break,
            Err(LzwError::InvalidCode) => return Err("its LZW codes are damaged".into()),
        }
    }
    bytes.truncate(written);
    Ok(bytes)
}

/// TIFF 6.0, section 9.
fn pack_bits(packed: &[u8], wanted: usize) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut rest = packed;
    while let [count, tail @ ..] = rest
        && bytes.len() < wanted
    {
        rest = match *count as i8 {
            -128 => tail,
            repeats @ ..0 => {
                let Some((&byte, tail)) = tail.split_first() else { break };
                bytes.resize(bytes.len() + usize::from(repeats.unsigned_abs()) + 1, byte);
                tail
            }
            literals => {
                let (copied, tail) = tail.split_at(tail.len().min(literals as usize + 1));
                bytes.extend_from_slice(copied);
                tail
            }
        };
    }
    bytes
}
