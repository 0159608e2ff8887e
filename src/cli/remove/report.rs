//! The report: what was taken away, how, how exactly and how fast.

use serde::Serialize;

use super::Args;
use crate::cli::luminance::Extent;
use crate::cli::photo_told::PhotoTold;
use crate::job::{Clipped, Removal, Removed, Stages};
use crate::photo::{Facts, LuminanceScale};

/// What there is to tell.
pub struct Report<'a> {
    pub args: &'a Args,
    /// Of the photo.
    pub facts: &'a Facts,
    pub removed: &'a Removed,
    pub stages: &'a Stages,
    /// Nothing where the photo's numbers are not known to be any luminance.
    pub luminance: Option<&'a Luminance>,
}

/// A photo before and after, in cd/m².
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Luminance {
    /// What makes that of their numbers.
    #[serde(flatten)]
    pub scale: LuminanceScale,
    /// Of the photo as it was read.
    pub photo: Option<Extent>,
    /// Of the clean one.
    pub clean: Option<Extent>,
}

/// As JSON, one object.
#[derive(Serialize)]
pub struct Json<'a> {
    vglare: &'static str,
    input: PhotoTold,
    output: Option<String>,
    mask: Option<String>,
    /// Nothing where there was no veil.
    removal: Option<&'a Removal>,
    clipped: Option<Clipped>,
    #[serde(skip_serializing_if = "Option::is_none")]
    luminance: Option<&'a Luminance>,
    warnings: &'a [String],
    milliseconds: Vec<StageJson>,
}

#[derive(Serialize)]
struct StageJson {
    stage: &'static str,
    wall_ms: f64,
}

impl<'a> Report<'a> {
    pub fn json(&self) -> Json<'a> {
        let Self { args, facts, removed, stages, luminance } = *self;
        let shown = |path: &Option<std::path::PathBuf>| path.as_ref().map(|path| path.display().to_string());
        Json {
            vglare: env!("CARGO_PKG_VERSION"),
            input: PhotoTold::new(&args.input, facts),
            output: shown(&args.output),
            mask: shown(&args.mask),
            removal: removed.removal.as_ref(),
            clipped: removed.clipping,
            luminance,
            warnings: &removed.warnings,
            milliseconds: stages.0.iter().map(|&(stage, wall_ms)| StageJson { stage, wall_ms }).collect(),
        }
    }
}
