//! `vglare view`: photos in a window.

use std::path::PathBuf;

use crate::scene::presets::{self, DEFAULT_PRESET};
use crate::{Result, viewer};

/// Open photos in a window, where the glare can be set by hand and seen at once
///
/// Needs a display and OpenGL 4.3 on it; Mesa's software renderer will do. Drag a light to move it, turn the wheel to
/// magnify, double-click a control's name to put it back.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Photos to open, a tab each; more can be dropped onto the window
    #[arg(value_name = "PHOTO")]
    photos: Vec<PathBuf>,

    /// The lens that photos are opened with, one of `vglare presets`
    #[arg(long, value_name = "NAME", default_value = DEFAULT_PRESET)]
    preset: String,
}

/// Shows the window until it is closed.
///
/// # Errors
/// Those of [`viewer::run`], and that of an unknown preset.
pub fn run(args: &Args) -> Result<()> {
    viewer::run(&args.photos, presets::named(&args.preset)?)
}
