//! `vglare apply`: the main job.

mod gather;
mod report;
mod run;
mod summary;

use std::path::PathBuf;

use clap::ValueEnum;
use glam::DVec2;

use super::BackendChoice;
use super::lights::FindArgs;
use super::numbers::{finite, not_negative};
use crate::photo::{Depth, ToneMap};
use crate::plan::Evaluator;
use crate::renderer::Normalize;

pub use gather::Files;
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
    output_options: OutputArgs,
}

const EXAMPLES: &str = "\
Examples:
  vglare apply night.exr -o night.png
  vglare apply night.exr -o veiled.exr --preset vintage-uncoated --strength 1.5
  vglare apply night.exr -o veiled.exr --glare glare.exr --report report.json
  vglare apply night.exr -o veiled.exr --scene scene.toml --tolerance 1e-4 --strict";

/// What glares.
#[derive(Debug, clap::Args)]
#[command(next_help_heading = "Scene")]
pub struct SceneArgs {
    /// A scene file: lights, ghosts and lens ghosts by hand, each optional (docs/scenes.md)
    #[arg(long, value_name = "FILE")]
    scene: Option<PathBuf>,

    /// The lens, one of `vglare presets` [default: classic-prime]
    #[arg(long, value_name = "NAME", conflicts_with = "lens")]
    preset: Option<String>,

    /// The lens, from a file of [[lens_ghost]] tables
    #[arg(long, value_name = "FILE")]
    lens: Option<PathBuf>,

    /// The lights, from a file: [[light]] tables, or what `vglare lights --json` printed
    #[arg(long, value_name = "FILE")]
    lights: Option<PathBuf>,
}

/// How the glare is laid over the photo.
#[derive(Debug, clap::Args)]
#[command(next_help_heading = "Look")]
struct LookArgs {
    /// What the glare is multiplied by, 0 or more; 0 writes the photo as it is
    #[arg(long, value_name = "S", default_value_t = 1.0, value_parser = not_negative)]
    strength: f64,

    /// Whether the glare's light is added, or taken from the photo's lights
    #[arg(long, value_enum, default_value_t = Mix::Add)]
    mix: Mix,

    /// What becomes of the glare's values before they are added: nothing, clamped to 0..1, or stretched to 0..1 by the
    /// smallest and the largest in the picture
    #[arg(long, value_enum, default_value_t = Normalize::None)]
    normalize: Normalize,
}

/// Where the glare's light comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum, serde::Serialize)]
#[serde(rename_all = "lowercase")]
enum Mix {
    /// From nowhere: the photo keeps its own
    Add,
    /// From the pixels that are lights: what scatters is missing there
    Energy,
}

/// How exact the glare is, and how it is computed.
#[derive(Debug, clap::Args)]
#[command(next_help_heading = "Accuracy")]
struct AccuracyArgs {
    /// Largest error at any pixel, relative to the largest glare of the same colour
    #[arg(long, value_name = "E", default_value_t = 1e-3, value_parser = tolerance)]
    tolerance: f64,

    /// Fail with exit code 3 where the measured error is beyond the tolerance, instead of warning
    #[arg(long)]
    strict: bool,

    /// Highest harmonic in x and y, 0 to 4096 [default: planned]
    #[arg(long, value_name = "N,M", value_parser = degree)]
    degree: Option<Degree>,

    /// Period of the series in x and y, in half picture heights [default: planned]
    #[arg(long, value_name = "X,Y", value_parser = period)]
    period: Option<DVec2>,

    /// How the field is computed [default: planned]
    #[arg(long, value_enum)]
    evaluator: Option<Evaluator>,

    /// Where OpenGL comes from
    #[arg(long, value_enum, default_value_t = BackendChoice::Auto)]
    backend: BackendChoice,
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

/// `--degree`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Degree([u32; 2]);

fn tolerance(text: &str) -> Result<f64, String> {
    finite(text).ok().filter(|&x| x > 0.0 && x < 1.0).ok_or_else(|| "expected a number between 0 and 1".to_owned())
}

fn pair(text: &str) -> Option<(&str, &str)> {
    text.split_once(',').map(|(a, b)| (a.trim(), b.trim()))
}

fn degree(text: &str) -> Result<Degree, String> {
    let one = |text: &str| text.parse::<u32>().ok().filter(|&n| n <= crate::plan::HIGHEST_DEGREE);
    pair(text)
        .and_then(|(n, m)| Some(Degree([one(n)?, one(m)?])))
        .ok_or_else(|| format!("expected two whole numbers from 0 to {}, like 32,24", crate::plan::HIGHEST_DEGREE))
}

fn period(text: &str) -> Result<DVec2, String> {
    let one = |text: &str| finite(text).ok().filter(|&t| t > 0.0);
    pair(text)
        .and_then(|(x, y)| Some(DVec2::new(one(x)?, one(y)?)))
        .ok_or_else(|| "expected two positive numbers, like 4.5,3".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_that_make_no_sense_are_refused() {
        for bad in ["0", "1", "-1e-3", "nan", "inf", "x"] {
            assert!(tolerance(bad).is_err(), "{bad}");
        }
        assert_eq!(tolerance("1e-4"), Ok(1e-4));
        for bad in ["3", "3,", "-1,2", "3,5000", "1.5,2", "a,b"] {
            assert!(degree(bad).is_err(), "{bad}");
        }
        assert_eq!(degree("32, 24"), Ok(Degree([32, 24])));
        for bad in ["3", "0,1", "1,-1", "nan,1", "inf,1"] {
            assert!(period(bad).is_err(), "{bad}");
        }
        assert_eq!(period("4.5,3"), Ok(DVec2::new(4.5, 3.0)));
    }
}
