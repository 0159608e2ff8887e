//! `vglare apply`: the main job.

mod look;
mod report;
mod run;
mod summary;

use std::path::PathBuf;

use clap::ValueEnum;

use super::accuracy::AccuracyArgs;
use super::lights::FindArgs;
use super::numbers::finite;
use super::scene::SceneArgs;
use crate::certificate::Verify;
use crate::photo::{Depth, ToneMap};

use look::{LookArgs, Mix};

pub use run::run;

/// Lay glare over a photo
///
/// Finds the lights in the photo (or takes them from a file), makes the ghosts that the lens turns them into, computes
/// their sum to the tolerance, adds it to the photo and writes the picture in the format that OUTPUT's extension names.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// The photo: OpenEXR, Radiance HDR, PFM, TIFF, PNG or JPEG
    input: PathBuf,

    /// The picture: .exr .hdr .pfm .tif .tiff .png .jpg .jpeg
    #[arg(short, long)]
    output: PathBuf,

    /// Replace files that exist
    #[arg(long)]
    force: bool,

    /// Say nothing but errors and warnings
    #[arg(short, long, conflicts_with = "verbose")]
    quiet: bool,

    /// Say more: the plan, and the time of each pass
    #[arg(short, long)]
    verbose: bool,

    #[command(flatten)]
    scene: SceneArgs,

    #[command(flatten)]
    find: FindArgs,

    #[command(flatten)]
    look: LookArgs,

    #[command(flatten)]
    accuracy: AccuracyArgs,

    #[command(flatten)]
    proof: ProofArgs,

    #[command(flatten)]
    output_options: OutputArgs,
}

const EXAMPLES: &str = "\
Examples:
  vglare apply night.exr -o night.png
  vglare apply night.exr -o veiled.exr --preset vintage-uncoated --strength 1.5
  vglare apply night.exr -o veiled.exr --glare glare.exr --report report.json
  vglare apply night.exr -o veiled.exr --scene scene.toml --tolerance 1e-4 --strict
  vglare apply night.exr -o veiled.exr --budget 20 --verify full";

/// How the result is held against the truth.
#[derive(Debug, clap::Args)]
#[command(next_help_heading = "Accuracy")]
struct ProofArgs {
    /// Fail with exit code 3 where the measured error is beyond the tolerance, instead of warning
    #[arg(long)]
    strict: bool,

    /// Where the glare is compared with the direct sum in 64-bit floats: at some hundred pixels, or at every one
    #[arg(long, value_enum, default_value_t = Verify::Sample)]
    verify: Verify,
}

/// What is written beside the picture, and how.
#[derive(Debug, clap::Args)]
#[command(next_help_heading = "Output")]
struct OutputArgs {
    /// Write the glare alone as well, as it was added; scene-linear, in any format
    #[arg(long, value_name = "FILE")]
    glare: Option<PathBuf>,

    /// Write what was computed, how, how exactly and how fast, as JSON
    #[arg(long, value_name = "FILE")]
    report: Option<PathBuf>,

    /// Depth of the samples [default: the input's in the same format; otherwise float for OpenEXR and TIFF, 8 for PNG]
    #[arg(long, value_enum)]
    depth: Option<DepthArg>,

    /// Exposure in stops, for PNG, JPEG and integer TIFF
    #[arg(long, value_name = "STOPS", default_value_t = 0.0, allow_negative_numbers = true, value_parser = finite)]
    exposure: f64,

    /// Tone map, for PNG, JPEG and integer TIFF [default: none if the photo is display-referred, else agx]
    #[arg(long, value_enum)]
    tonemap: Option<ToneMapArg>,
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
