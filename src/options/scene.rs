//! Everything that glares in one run: from the photo, from files, from presets.

// The help says [[light]], as files do, and rustdoc takes that for a link.
#![allow(rustdoc::broken_intra_doc_links)]

use std::path::PathBuf;

use glam::DVec2;

use crate::Result;
use crate::look::{Look, LookLens, LookLights};
use crate::options::UnitArgs;
use crate::options::numbers::point;
use crate::scene;
use crate::scene::presets::NO_LENS;

/// What glares.
#[derive(Debug, clap::Args)]
#[command(next_help_heading = "Scene")]
pub struct SceneArgs {
    /// A scene file: lights, ghosts and lens ghosts by hand, a whole look, each part optional (docs/scenes.md). Options
    /// win over what the file says
    #[arg(long, value_name = "FILE")]
    scene: Option<PathBuf>,

    /// The lens, one of `vglare presets` [default: classic-prime]
    #[arg(long, value_name = "NAME", conflicts_with = "lens")]
    preset: Option<String>,

    /// The lens, from a file of [[lens_ghost]] tables; `none` for one without ghosts
    #[arg(long, value_name = "FILE")]
    lens: Option<PathBuf>,

    /// The lights, from a file instead of the photo: [[light]] tables, or what `vglare lights --json` printed
    #[arg(long, value_name = "FILE")]
    lights: Option<PathBuf>,

    /// More lights, from such a file, beside those of the photo (or of --lights, or of the scene file)
    #[arg(long, value_name = "FILE")]
    add_lights: Option<PathBuf>,

    /// Where the lens's axis meets the picture, in half picture heights from its centre: ghosts lie on lines through it
    /// [default: 0,0]
    #[arg(long, value_name = "X,Y", value_parser = point, allow_hyphen_values = true)]
    axis: Option<DVec2>,

    /// What lengths and angles are counted in.
    #[command(flatten)]
    pub unit: UnitArgs,
}

impl SceneArgs {
    /// The files that the scene is read from, those among them that others refer to.
    pub fn files(&self) -> Vec<PathBuf> {
        let given = [&self.scene, &self.lens, &self.lights, &self.add_lights].into_iter().flatten();
        given.flat_map(|path| std::iter::once(path.clone()).chain(scene::referred(path))).collect()
    }

    /// The look that the files and options give; its files are read and checked before anything long begins.
    ///
    /// # Errors
    /// [`crate::Error::SceneFile`] for a file that is not right, [`crate::Error::UnknownPreset`].
    pub fn look(&self) -> Result<Look> {
        let mut look = match &self.scene {
            Some(path) => Look::from_scene(scene::read_scene(path)?)?,
            None => Look::default(),
        };
        look = self.unit.over(look);
        if let Some(path) = &self.lens
            && path.as_os_str() == NO_LENS
        {
            look.lens = LookLens::preset(NO_LENS)?;
        } else if let Some(path) = &self.lens {
            look.lens = LookLens::File(path.clone(), scene::read_lens(path)?.into());
        } else if let Some(name) = &self.preset {
            look.lens = LookLens::preset(name)?;
        }
        if let Some(path) = &self.lights {
            look.lights = LookLights::Listed(scene::read_lights_in(path, look.unit)?.into());
        }
        if let Some(path) = &self.add_lights {
            look.add_lights(scene::read_lights_in(path, look.unit)?);
        }
        look.axis = self.axis.unwrap_or(look.axis);
        Ok(look)
    }
}
