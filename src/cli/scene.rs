//! Everything that glares in one run: from the photo, from files, from presets.

use std::path::PathBuf;

use glam::DVec2;

use super::lights::FindArgs;
use crate::photo::Photo;
use crate::scene::presets::{self, DEFAULT_PRESET};
use crate::scene::{self, Found, Ghost, Lens, Light, SceneFile};
use crate::{Error, Result};

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

/// The scene of one run.
pub struct Gathered {
    /// What was found in the photo, if it was searched.
    pub found: Option<Found>,
    /// The lights, found or listed.
    pub lights: Vec<Light>,
    /// The lens, if there are lights.
    pub lens: Option<Lens>,
    /// Ghosts of the lights, then those that the scene file lists.
    pub ghosts: Vec<Ghost>,
    /// What the scene file sets of the series.
    pub period: Option<DVec2>,
    pub degree: Option<[u32; 2]>,
}

/// Files that the run names, read and checked before anything long begins.
pub struct Files {
    scene: Option<SceneFile>,
    lights: Option<Vec<Light>>,
    lens: Lens,
}

impl Files {
    /// Reads them.
    ///
    /// # Errors
    /// [`Error::SceneFile`] for a file that is not right, [`Error::UnknownPreset`], [`Error::Usage`] where two of them
    /// say the same thing.
    pub fn read(args: &SceneArgs) -> Result<Self> {
        let named = args.preset.is_some() || args.lens.is_some();
        let scene = args.scene.as_deref().map(scene::read_scene).transpose()?;
        let lights = args.lights.as_deref().map(scene::read_lights).transpose()?;
        if let Some(scene) = &scene {
            if named && !scene.lens_ghosts.is_empty() {
                return Err(Error::Usage(
                    "the scene file has lens ghosts of its own; --preset and --lens do not go with it".into(),
                ));
            }
            if lights.is_some() && !scene.lights.is_empty() {
                return Err(Error::Usage("the scene file has lights of its own; --lights does not go with it".into()));
            }
        }
        let lens = match (&scene, &args.lens, &args.preset) {
            (Some(scene), _, _) if !scene.lens_ghosts.is_empty() => Lens {
                name: "scene file".into(),
                description: scene.description.clone(),
                ghosts: scene.lens_ghosts.clone(),
            },
            (_, Some(path), _) => scene::read_lens(path)?,
            (_, None, name) => presets::named(name.as_deref().unwrap_or(DEFAULT_PRESET))?,
        };
        Ok(Self { scene, lights, lens })
    }

    /// The scene of a photo. The photo is searched for lights where neither file lists any, unless the scene file lists
    /// ghosts only; or where the search is needed anyway, for the threshold.
    pub fn gather(&self, photo: &Photo, args: &FindArgs, anyway: bool) -> Gathered {
        let nothing = SceneFile::default();
        let scene = self.scene.as_ref().unwrap_or(&nothing);
        let listed = self.lights.as_ref().or((!scene.lights.is_empty()).then_some(&scene.lights));
        let ghosts_only = !scene.ghosts.is_empty() && scene.lens_ghosts.is_empty();
        let search = listed.is_none() && !ghosts_only;
        let found = (search || anyway).then(|| find(photo, args));
        let lights = match (listed, &found) {
            (Some(listed), _) => listed.clone(),
            (None, Some(found)) if search => found.lights.clone(),
            _ => Vec::new(),
        };
        let mut ghosts = scene::ghosts(&lights, &self.lens);
        ghosts.extend_from_slice(&scene.ghosts);
        let lens = (!lights.is_empty()).then(|| self.lens.clone());
        Gathered { found, lights, lens, ghosts, period: scene.period, degree: scene.degree }
    }
}

fn find(photo: &Photo, args: &FindArgs) -> Found {
    scene::find(&photo.pixels, &photo.frame, photo.luminance_weights(), &args.into())
}
