//! `vglare view`: photos in a window.

use std::path::PathBuf;

use super::{Harness, replay};
use crate::gpu::Device;
use crate::look::{Look, LookLens};
use crate::options::BackendChoice;
use crate::options::ReadArgs;
use crate::scene::presets::DEFAULT_PRESET;
use crate::scene::{OpticsSection, named_lens, read_scene};
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
    #[arg(long, value_name = "NAME", default_value = DEFAULT_PRESET, conflicts_with_all = ["scene", "lens"])]
    preset: String,

    /// The lens that photos are opened with: the name of a real lens or a preset, or a file, of surfaces or of ghosts
    #[arg(long, value_name = "NAME|FILE", conflicts_with = "scene")]
    lens: Option<PathBuf>,

    /// The look that photos are opened with, as a scene file; see docs/scenes.md
    #[arg(long, value_name = "FILE")]
    scene: Option<PathBuf>,

    #[command(flatten)]
    reading: ReadArgs,

    /// Play a script without a window; see src/viewer/replay.rs
    #[arg(long, value_name = "FILE", hide = true, requires = "script_output")]
    script: Option<PathBuf>,

    /// The folder for what came of each of its steps
    #[arg(long, value_name = "FOLDER", hide = true, requires = "script")]
    script_output: Option<PathBuf>,

    /// Keep what the window shows in a JSON file, for a test that drives it; see src/viewer/status.rs
    #[arg(long, value_name = "FILE", hide = true, conflicts_with = "script")]
    status: Option<PathBuf>,

    /// Take the window's context for lost after so many frames, to test that it goes on
    #[arg(long, value_name = "FRAMES", hide = true, conflicts_with = "script")]
    lose_after: Option<u64>,

    /// Where its OpenGL comes from
    #[arg(long, value_enum, hide = true, default_value_t = BackendChoice::Auto, requires = "script")]
    backend: BackendChoice,
}

/// Shows the window until it is closed.
///
/// # Errors
/// Those of [`viewer::run`], that of an unknown preset, and those of [`read_scene`].
pub fn run(args: &Args) -> Result<()> {
    let look = match (&args.scene, &args.lens) {
        (Some(path), _) => Look::from_scene(read_scene(path)?)?,
        // A lens brings its veil along.
        (None, Some(name)) => Look::default().through(named_lens(name, &OpticsSection::default())?.into(), false)?,
        (None, None) => Look::default().through(LookLens::preset(&args.preset)?, false)?,
    };
    if let (Some(script), Some(output)) = (&args.script, &args.script_output) {
        let device = Device::open(args.backend.backends())?;
        return replay::play(&device, &args.photos, look, args.reading.options(), script, output);
    }
    let harness = Harness { status: args.status.clone(), lose_after: args.lose_after };
    viewer::run(&args.photos, look, args.reading.options(), harness)
}
