//! `vglare apply`: the main job, for one photo or for the photos of a shot.

mod job;
mod look;
mod names;
mod outputs;
mod pipeline;
mod report;
mod run;
mod sequence;
mod summary;
mod tally;

use std::path::PathBuf;

use clap::ValueEnum;

use super::accuracy::AccuracyArgs;
use super::lights::FindArgs;
use super::numbers::finite;
use super::scene::SceneArgs;
use crate::Result;
use crate::certificate::Verify;
use crate::look::Look;
use crate::photo::{Depth, ToneMap};

use look::LookArgs;

pub use run::run;

/// Lay glare over a photo
///
/// Finds the lights in the photo (or takes them from a file), makes the ghosts that the lens turns them into, computes
/// their sum to the tolerance, adds it to the photo and writes the picture in the format that OUTPUT's extension names.
///
/// Several photos, as the frames of a shot, are done in one run, in which the next is read and the last written while one
/// is computed. OUTPUT then is a folder, which is made if need be, or a pattern. Each photo has lights, a plan and a
/// measured error of its own. What is found in each photo for itself can change from frame to frame more than the scene
/// does, and flicker: --threshold, --lights or --scene says for all what glares, and --normalize minmax stretches each
/// photo by its own glare.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// The photo, or several: OpenEXR, Radiance HDR, PFM, TIFF, PNG or JPEG
    #[arg(value_name = "INPUT", required = true)]
    inputs: Vec<PathBuf>,

    /// The picture: .exr .hdr .pfm .tif .tiff .png .jpg .jpeg; for several photos, a folder or a pattern
    ///
    /// A folder, as out/, is made if need be; each picture in it is called as its photo. A pattern has fields in its file
    /// name: #### or %04d becomes the frame number, the last number in the photo's name, with at least four digits (so do
    /// ## or %02d with two, and %d with as many as it has); {name} becomes the photo's name without its extension. One #
    /// alone stays what it is.
    #[arg(short, long)]
    output: PathBuf,

    /// Replace files that exist
    #[arg(long)]
    force: bool,

    /// Say nothing but errors and warnings
    #[arg(short, long, conflicts_with = "verbose")]
    quiet: bool,

    /// Say more: the plan, and the time of each pass; for several photos, a line each
    #[arg(short, long)]
    verbose: bool,

    #[command(flatten)]
    sequence: SequenceArgs,

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
  vglare apply night.exr -o veiled.exr --budget 20 --verify full
  vglare apply shot.*.exr -o veiled/ --threshold 20
  vglare apply shot.*.exr -o 'veiled.####.exr' --glare 'glare.####.exr' --report report.json
  vglare apply shot.*.exr -o 'previews/{name}.png' --keep-going --quiet";

impl Args {
    /// The look that the files and options give.
    ///
    /// # Errors
    /// Those of [`SceneArgs::look`].
    pub fn look(&self) -> Result<Look> {
        let look = self.look.over(self.scene.look()?);
        let (find, accuracy) = (self.find.over(look.find), self.accuracy.over(look.accuracy));
        Ok(Look { find, accuracy, ..look })
    }
}

/// How several photos are gone through.
#[derive(Debug, clap::Args)]
#[command(next_help_heading = "Several photos")]
struct SequenceArgs {
    /// Where a photo cannot be done, go on with the others and fail at the end, instead of stopping there
    #[arg(long)]
    keep_going: bool,

    /// Finish each photo before the next is read: with one photo in memory at a time instead of up to three
    #[arg(long)]
    one_by_one: bool,
}

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
    /// Write the glare alone as well, as it was added; scene-linear, in any format. For several photos a folder or a
    /// pattern, like OUTPUT
    #[arg(long, value_name = "FILE")]
    glare: Option<PathBuf>,

    /// Write what was computed, how, how exactly and how fast, as JSON; one file for all photos
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
