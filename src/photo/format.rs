//! The formats, and the depths that each can hold.

use std::path::Path;

use super::{Reason, foreign};

/// A file format that vglare reads, and writes but for the last.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Format {
    /// OpenEXR, `.exr`.
    OpenExr,
    /// Radiance HDR, `.hdr`.
    Radiance,
    /// Portable float map, `.pfm`.
    Pfm,
    /// TIFF, `.tif` or `.tiff`.
    Tiff,
    /// PNG, `.png`.
    Png,
    /// JPEG, `.jpg` or `.jpeg`.
    Jpeg,
    /// JPEG XL, which is read and not written.
    JpegXl,
}

/// How one sample is stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Depth {
    /// 8-bit integer.
    Eight,
    /// 16-bit integer.
    Sixteen,
    /// 16-bit float; finite values beyond ±65504 are written as ±65504.
    Half,
    /// 32-bit float.
    Float,
    /// 32-bit unsigned integer; OpenEXR only, and only kept where the input had it.
    Uint,
}

const NAMES: &str = "OpenEXR, Radiance HDR, PFM, TIFF, PNG, JPEG or JPEG XL";
const EXTENSIONS: &str = ".exr, .hdr, .pfm, .tif, .tiff, .png, .jpg or .jpeg";

impl Format {
    /// The format's name.
    pub fn name(self) -> &'static str {
        match self {
            Self::OpenExr => "OpenEXR",
            Self::Radiance => "Radiance HDR",
            Self::Pfm => "PFM",
            Self::Tiff => "TIFF",
            Self::Png => "PNG",
            Self::Jpeg => "JPEG",
            Self::JpegXl => "JPEG XL",
        }
    }

    /// The depths that the format holds, the one it is written in by default last.
    pub fn depths(self) -> &'static [Depth] {
        match self {
            Self::OpenExr => &[Depth::Half, Depth::Float],
            Self::Radiance | Self::Pfm => &[Depth::Float],
            Self::Tiff => &[Depth::Eight, Depth::Sixteen, Depth::Float],
            Self::Png => &[Depth::Sixteen, Depth::Eight],
            Self::Jpeg | Self::JpegXl => &[Depth::Eight],
        }
    }

    /// The format that a file's first bytes tell.
    pub(super) fn from_magic(head: &[u8]) -> Result<Self, Reason> {
        match head {
            [] => Err("the file is empty".into()),
            [0x76, 0x2f, 0x31, 0x01, ..] => Ok(Self::OpenExr),
            [b'#', b'?', ..] => Ok(Self::Radiance),
            [b'P', b'F' | b'f', b'\n' | b'\r' | b' ' | b'\t', ..] => Ok(Self::Pfm),
            [b'I', b'I', 42 | 43, 0, ..] | [b'M', b'M', 0, 42 | 43, ..] => Ok(Self::Tiff),
            [0x89, b'P', b'N', b'G', b'\r', b'\n', 0x1a, b'\n', ..] => Ok(Self::Png),
            [0xff, 0xd8, 0xff, ..] => Ok(Self::Jpeg),
            [0xff, 0x0a, ..] | [0, 0, 0, 12, b'J', b'X', b'L', b' ', ..] => Ok(Self::JpegXl),
            _ => {
                let unknown = || format!("it is not a picture of a known kind; vglare reads {NAMES}");
                Err(foreign::refusal(head).unwrap_or_else(unknown).into())
            }
        }
    }

    /// The format that a file's name asks for.
    pub(super) fn from_extension(path: &Path) -> Result<Self, Reason> {
        let extension = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
        match extension.as_str() {
            "exr" => Ok(Self::OpenExr),
            "hdr" => Ok(Self::Radiance),
            "pfm" => Ok(Self::Pfm),
            "tif" | "tiff" => Ok(Self::Tiff),
            "png" => Ok(Self::Png),
            "jpg" | "jpeg" => Ok(Self::Jpeg),
            "" => Err(format!("its name has no extension; vglare writes {EXTENSIONS}, or what --format says").into()),
            other => Err(format!("vglare writes {EXTENSIONS}, not .{other}").into()),
        }
    }

    /// The format that a file's name asks for, or that is asked for where the name does not tell.
    pub(super) fn of_name(path: &Path, asked: Option<Self>) -> Result<Self, Reason> {
        match (Self::from_extension(path), asked) {
            (Ok(named), Some(asked)) if named != asked => {
                Err(format!("its name says {}, and --format {}", named.name(), asked.name()).into())
            }
            (_, Some(Self::JpegXl)) => Err("vglare reads JPEG XL, and does not write it".into()),
            (Err(_), Some(asked)) => Ok(asked),
            (named, _) => named,
        }
    }
}

impl Depth {
    /// The depth in words.
    pub fn name(self) -> &'static str {
        match self {
            Self::Eight => "8 bit",
            Self::Sixteen => "16 bit",
            Self::Half => "half float",
            Self::Float => "float",
            Self::Uint => "32 bit integer",
        }
    }

    /// Whether this is an integer meant for a display.
    pub(super) fn is_display(self) -> bool {
        matches!(self, Self::Eight | Self::Sixteen)
    }
}
