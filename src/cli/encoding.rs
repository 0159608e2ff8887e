//! How pictures are written: what the commands that write some have in common.

use std::path::Path;

use clap::ValueEnum;

use crate::options::numbers::finite;
use crate::photo::{self, Depth, Format, Primaries, ToneMap, WriteOptions};

/// How pictures are written.
#[derive(Debug, clap::Args)]
#[command(next_help_heading = "Output")]
pub struct EncodingArgs {
    /// The format, where a file's name does not tell it, as that of standard output, -
    #[arg(long, value_enum)]
    format: Option<FormatArg>,

    /// Depth of the samples [default: the input's in the same format; otherwise, and for --glare, float for OpenEXR and
    /// TIFF, 8 for PNG]
    #[arg(long, value_enum)]
    depth: Option<DepthArg>,

    /// Exposure in stops, for PNG, JPEG and integer TIFF
    #[arg(long, value_name = "STOPS", default_value_t = 0.0, allow_hyphen_values = true, value_parser = finite)]
    exposure: f64,

    /// The colour space that scene-linear pictures are written in, white to white: OpenEXR, float TIFF, PFM and Radiance HDR [default: the
    /// photo's in OpenEXR, and in Radiance HDR of Radiance HDR; otherwise rec709]
    #[arg(long, value_enum, value_name = "NAME")]
    colorspace: Option<ColorSpaceArg>,

    /// Tone map, for PNG, JPEG and integer TIFF [default: none if the photo is display-referred, else agx]
    #[arg(long, value_enum)]
    tonemap: Option<ToneMapArg>,
}

impl EncodingArgs {
    /// How a picture is written.
    pub fn picture(&self, overwrite: bool) -> WriteOptions {
        WriteOptions {
            format: self.format(),
            depth: self.depth.map(Into::into),
            exposure: self.exposure,
            tone_map: self.tonemap.map(Into::into),
            primaries: self.colorspace.map(Into::into),
            overwrite,
        }
    }

    /// How the glare is written: as it is, and as exact as its format allows unless another depth is asked for. Beside a
    /// picture, that is a depth which the glare's format may not have.
    pub fn glare(&self, path: &Path, beside_picture: bool, overwrite: bool) -> WriteOptions {
        let asked: Option<Depth> = self.depth.map(Into::into);
        let depth = asked.filter(|&depth| !beside_picture || photo::holds(path, self.format(), depth));
        let primaries = self.colorspace.map(Into::into);
        WriteOptions { depth, primaries, ..self.other(overwrite) }
    }

    /// How something else than the picture is written.
    pub fn other(&self, overwrite: bool) -> WriteOptions {
        WriteOptions { format: self.format(), depth: None, exposure: 0.0, tone_map: None, primaries: None, overwrite }
    }

    /// The same beside another file: `--format` is for names that do not tell, and where there is one, for that alone.
    pub fn beside(options: WriteOptions, path: Option<&Path>, other: Option<&Path>) -> WriteOptions {
        let tells = |path: &Path| photo::check_name(path, None).is_ok();
        let is_for_other = path.is_some_and(tells) && other.is_some_and(|other| !tells(other));
        WriteOptions { format: options.format.filter(|_| !is_for_other), ..options }
    }

    /// The format of files whose names do not tell theirs.
    pub fn format(&self) -> Option<Format> {
        self.format.map(Into::into)
    }
}

/// `--format`.
#[derive(Debug, Clone, Copy, ValueEnum)]
enum FormatArg {
    /// OpenEXR
    Exr,
    /// Radiance HDR
    Hdr,
    /// Portable float map
    Pfm,
    /// TIFF
    Tiff,
    /// PNG
    Png,
    /// JPEG
    Jpeg,
}

impl From<FormatArg> for Format {
    fn from(format: FormatArg) -> Self {
        match format {
            FormatArg::Exr => Self::OpenExr,
            FormatArg::Hdr => Self::Radiance,
            FormatArg::Pfm => Self::Pfm,
            FormatArg::Tiff => Self::Tiff,
            FormatArg::Png => Self::Png,
            FormatArg::Jpeg => Self::Jpeg,
        }
    }
}

/// `--depth`.
#[derive(Debug, Clone, Copy, ValueEnum)]
enum DepthArg {
    /// 8-bit integer
    #[value(name = "8")]
    Eight,
    /// 16-bit integer
    #[value(name = "16")]
    Sixteen,
    /// 16-bit float
    Half,
    /// 32-bit float
    Float,
}

impl From<DepthArg> for Depth {
    fn from(depth: DepthArg) -> Self {
        match depth {
            DepthArg::Eight => Self::Eight,
            DepthArg::Sixteen => Self::Sixteen,
            DepthArg::Half => Self::Half,
            DepthArg::Float => Self::Float,
        }
    }
}

/// `--colorspace`.
#[derive(Debug, Clone, Copy, ValueEnum)]
enum ColorSpaceArg {
    /// ITU-R BT.709
    Rec709,
    /// Display P3
    P3d65,
    /// ITU-R BT.2020
    Rec2020,
    /// ACES2065-1
    Ap0,
    /// ACEScg
    Ap1,
    /// Adobe RGB (1998)
    Adobergb,
}

impl From<ColorSpaceArg> for Primaries {
    fn from(space: ColorSpaceArg) -> Self {
        match space {
            ColorSpaceArg::Rec709 => Self::REC709,
            ColorSpaceArg::P3d65 => Self::P3_D65,
            ColorSpaceArg::Rec2020 => Self::REC2020,
            ColorSpaceArg::Ap0 => Self::ACES2065_1,
            ColorSpaceArg::Ap1 => Self::ACESCG,
            ColorSpaceArg::Adobergb => Self::ADOBE_RGB,
        }
    }
}

/// `--tonemap`.
#[derive(Debug, Clone, Copy, ValueEnum)]
enum ToneMapArg {
    /// Clip
    None,
    /// v / (1 + v), colour by colour
    Reinhard,
    /// The contrasty, film-like curve of ACES
    Aces,
    /// A soft, wide curve: AgX
    Agx,
}

impl From<ToneMapArg> for ToneMap {
    fn from(map: ToneMapArg) -> Self {
        match map {
            ToneMapArg::None => Self::None,
            ToneMapArg::Reinhard => Self::Reinhard,
            ToneMapArg::Aces => Self::Aces,
            ToneMapArg::Agx => Self::Agx,
        }
    }
}
