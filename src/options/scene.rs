//! Everything that glares in one run: from the photo, from files, from presets.

// The help says [[light]], as files do, and rustdoc takes that for a link.
#![allow(rustdoc::broken_intra_doc_links)]

use std::path::PathBuf;

use glam::DVec2;

use crate::choices::{LengthUnit, Mix, Sources};
use crate::look::{Look, LookLens, LookLights};
use crate::options::numbers::point;
use crate::options::{FindArgs, OpticsArgs, UnitArgs};
use crate::scene::{self, Optical};
use crate::{Error, Result};

/// What glares.
#[derive(Debug, clap::Args)]
#[command(next_help_heading = "Scene")]
pub struct SceneArgs {
    /// A scene file: lights, ghosts and lens ghosts by hand, a whole look, each part optional (docs/scenes.md). Options
    /// win over what the file says
    #[arg(long, value_name = "FILE")]
    scene: Option<PathBuf>,

    /// The lens, one of `vglare presets`, or v1/NAME, as it was in looks of version 1 [default: classic-prime]
    #[arg(long, value_name = "NAME", conflicts_with = "lens")]
    preset: Option<String>,

    /// The lens: a real one, of `vglare lens`; a file of its surfaces, or of [[lens_ghost]] tables, neither of which has a veil but its own;
    /// a preset; or `none`, for one without ghosts
    #[arg(long, value_name = "NAME|FILE")]
    lens: Option<PathBuf>,

    /// The lights, from a file instead of the photo: [[light]] tables, or what `vglare lights --json` printed
    #[arg(long, value_name = "FILE")]
    lights: Option<PathBuf>,

    /// More lights, from such a file, beside those of the photo (or of --lights, or of the scene file)
    #[arg(long, value_name = "FILE")]
    add_lights: Option<PathBuf>,

    /// What in the photo makes ghosts: every pixel, or what is found to be a light [default: photo; lights where --lights,
    /// --max-lights or a file of version 1 means them]
    #[arg(long, value_enum, value_name = "WHAT")]
    sources: Option<Sources>,

    /// Where the lens's axis meets the picture, in the look's unit (see --unit) from its centre: ghosts lie on lines through it
    /// [default: 0,0]
    #[arg(long, value_name = "X,Y", value_parser = point, allow_hyphen_values = true)]
    axis: Option<DVec2>,

    /// What lengths and angles are counted in.
    #[command(flatten)]
    pub unit: UnitArgs,

    /// How the lens is set.
    #[command(flatten)]
    pub optics: OpticsArgs,
}

impl SceneArgs {
    /// A lens or a look from a file, without lights of its own.
    pub fn of(
        scene: Option<PathBuf>,
        preset: Option<String>,
        lens: Option<PathBuf>,
        unit: UnitArgs,
        optics: OpticsArgs,
    ) -> Self {
        Self { scene, preset, lens, lights: None, add_lights: None, sources: None, axis: None, unit, optics }
    }

    /// The files that the scene is read from, those among them that others refer to.
    pub fn files(&self) -> Vec<PathBuf> {
        let given = [&self.scene, &self.lens, &self.lights, &self.add_lights].into_iter().flatten();
        given.flat_map(|path| std::iter::once(path.clone()).chain(scene::referred(path))).collect()
    }

    /// The option by which a lens was named, where one was.
    pub fn lens_option(&self) -> Option<&'static str> {
        match (&self.lens, &self.preset) {
            (Some(_), _) => Some("--lens"),
            (None, Some(_)) => Some("--preset"),
            (None, None) => None,
        }
    }

    /// The lens that is asked for.
    fn lens(&self) -> Result<Option<LookLens>> {
        let lens = match (&self.lens, &self.preset) {
            (Some(name), _) => self.optics.lens(name)?.into(),
            (None, Some(name)) => LookLens::preset_set(name, &self.optics.section())?,
            (None, None) => return Ok(None),
        };
        Ok(Some(lens))
    }

    /// The look that the files and options give, beside those that say what a light is; its files are read and checked before
    /// anything long begins.
    ///
    /// # Errors
    /// [`Error::SceneFile`] for a file that is not right, [`Error::UnknownPreset`], and [`Error::Usage`] for options of lights
    /// where every pixel is to be a source.
    pub fn look(&self, find: &FindArgs) -> Result<Look> {
        let counts = find.counts_lights();
        if self.sources == Some(Sources::Photo) && (self.lights.is_some() || counts) {
            let option = if counts { "--max-lights" } else { "--lights" };
            return Err(Error::Usage(format!(
                "--sources photo cannot be used with {option}: every pixel is a source, or there are lights (--sources lights); \
                 --add-lights are beside the pixels"
            )));
        }
        let file = self.scene.as_deref().map(scene::read_scene).transpose()?;
        let says_veil = file.as_ref().is_some_and(|file| file.veil.is_some() || file.no_veil);
        let adds = file.as_ref().is_some_and(|file| file.look.mix == Some(Mix::Add));
        let look = file.map(Look::from_scene).transpose()?;
        let names_unit = look.is_some() || self.unit.names_one();
        let mut look = self.unit.over(look.unwrap_or_default());
        if let Some(lens) = self.lens()? {
            // What a scene says of the veil is said of any lens.
            look = if says_veil { Look { lens, ..look } } else { look.through(lens, adds)? };
        } else if let LookLens::Optical(optical) = &look.lens {
            let mut section = optical.section().clone();
            section.set(&self.optics.section());
            look.lens = LookLens::Optical(Optical::new(section)?);
        } else {
            self.optics.without_lens()?;
        }
        if let Some(unit) = self.unit_of_lights()?.filter(|_| !names_unit) {
            look.unit = unit;
        }
        // What is counted is lights; those that a file lists are what they are.
        let meant = counts && matches!(look.lights, LookLights::Photo(_));
        if let Some(sources) = self.sources.or(meant.then_some(Sources::Lights)) {
            look.shine_by(sources);
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

    /// The unit of the lights that files list; of two that differ, that which no file can name.
    fn unit_of_lights(&self) -> Result<Option<LengthUnit>> {
        let files = [&self.lights, &self.add_lights].into_iter().flatten();
        let units = files.map(|path| scene::unit_of_lights(path)).collect::<Result<Vec<_>>>()?;
        let unnamed = units.contains(&None).then_some(LengthUnit::OF_FILES);
        Ok(unnamed.or(units.first().copied().flatten()))
    }
}
