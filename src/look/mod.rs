//! A look: everything that a person sets about a photo's glare, from a command line, a scene file, or by hand.

mod colours;
mod file;
mod gather;
mod made;
mod patches;
mod shared;
mod unit;
mod veil;

use std::borrow::Cow;
use std::path::PathBuf;
use std::sync::Arc;

use glam::DVec2;

use crate::choices::{Evaluator, LengthUnit, Mix, Normalize, Projection, Sources};
use crate::frame::Frame;
use crate::scene::presets::{self, DEFAULT_PRESET};
use crate::scene::{
    FindOptions, Ghost, Goal, Lens, LensGhost, LensVeil, Light, NamedLens, Optical, OpticsSection, lenses,
};
use crate::{Error, Result};

pub use gather::{Gathered, Search};
pub use shared::Shared;
pub use veil::Veil;

/// Everything that a person sets. The same look gives the same glare, whatever it was made from. A copy shares its lists,
/// so that it costs little even of 100,000 lights.
#[derive(Debug, Clone, PartialEq)]
pub struct Look {
    /// One line for people.
    pub description: String,
    /// What the lights are seen through.
    pub lens: LookLens,
    /// What lengths are counted in: sizes, and positions from the picture's centre.
    pub unit: LengthUnit,
    /// What the picture's width spans, in degrees, where somebody said so; else what its file says counts.
    pub fov: Option<f64>,
    /// Where the lens's axis meets the picture.
    pub axis: DVec2,
    /// What every ghost's size is multiplied by, > 0; its flux stays.
    pub size: f64,
    /// What every ghost's colour is multiplied by, RGB, 0 or more.
    pub tint: [f64; 3],
    /// What shines.
    pub lights: LookLights,
    /// Ghosts that no light makes.
    pub ghosts: Shared<Ghost>,
    /// What counts as a light in the photo.
    pub find: FindOptions,
    /// What the glare is multiplied by, 0 or more; 0 leaves the photo as it is.
    pub strength: f64,
    /// What every pixel scatters; nothing where it is `None`.
    pub veil: Option<Veil>,
    /// Where the ghosts' light comes from.
    pub mix: Mix,
    /// How the field's values become glare.
    pub normalize: Normalize,
    /// How exact the glare is, and how it is computed.
    pub accuracy: Accuracy,
}

/// Which lens, and where it is from.
#[derive(Debug, Clone, PartialEq)]
pub enum LookLens {
    /// One that comes with vglare, by its name.
    Preset(Arc<Lens>),
    /// That of a lens file.
    File(PathBuf, Arc<Lens>),
    /// One that is known by its surfaces; its table is that of the picture that it was fitted to last ([`Look::fitted`]).
    Optical(Optical),
    /// A table of the look's own; never empty.
    Own(Shared<LensGhost>),
}

/// Where the lights are from.
#[derive(Debug, Clone, PartialEq)]
pub enum LookLights {
    /// The photo is searched.
    Found,
    /// By hand, or from a file.
    Listed(Shared<Light>),
    /// The photo is searched, and these are added to what is found; never empty.
    FoundAnd(Shared<Light>),
    /// Every pixel of the photo is one, and these are added.
    Photo(Shared<Light>),
}

/// How exact the glare is, and how it is computed; what is `None` is planned.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Accuracy {
    /// What the plan is to reach.
    pub goal: Goal,
    /// Whether to be as exact as 32-bit floats can, where they cannot be as exact as asked.
    pub allow_floor: bool,
    /// Whether the error at each pixel is to be within the tolerance of photo and glare there, too.
    pub each_pixel: bool,
    /// Highest harmonic in x and y, 0 to 4096.
    pub degree: Option<[u32; 2]>,
    /// Period of the series in x and y, > 0, in the unit of lengths.
    pub period: Option<DVec2>,
    /// How the field is computed.
    pub evaluator: Option<Evaluator>,
}

impl Default for Look {
    /// Every pixel of the photo through [`DEFAULT_PRESET`], as it is, in a unit that stays the same when the photo is turned.
    fn default() -> Self {
        let lens = LookLens::preset(DEFAULT_PRESET).expect("the default preset is compiled in");
        let veil = lens.veil().map(|veil| Veil::new(&veil.section, false).expect("a test makes the veils of presets"));
        Self {
            description: String::new(),
            lens,
            unit: LengthUnit::ShortSide,
            fov: None,
            axis: DVec2::ZERO,
            size: 1.0,
            tint: [1.0; 3],
            lights: LookLights::Photo(Shared::default()),
            ghosts: Shared::default(),
            find: FindOptions::default(),
            strength: 1.0,
            veil,
            mix: Mix::default(),
            normalize: Normalize::default(),
            accuracy: Accuracy::default(),
        }
    }
}

impl From<NamedLens> for LookLens {
    fn from(lens: NamedLens) -> Self {
        match lens {
            NamedLens::Preset(lens) => Self::Preset(lens.into()),
            NamedLens::Table(path, lens) => Self::File(path, lens.into()),
            NamedLens::Optical(optical) => Self::Optical(optical),
        }
    }
}

impl LookLens {
    /// The preset that is called `name`, or the real lens, as its file has it; of two that are called alike, the preset.
    ///
    /// # Errors
    /// [`crate::Error::UnknownPreset`], which lists the names there are.
    pub fn preset(name: &str) -> Result<Self> {
        Self::preset_set(name, &OpticsSection::default())
    }

    /// The same, a real lens set as `settings` says.
    ///
    /// # Errors
    /// [`crate::Error::UnknownPreset`]; [`Error::Optics`] and [`Error::Usage`] for settings that cannot be, and of a preset that is none.
    pub fn preset_set(name: &str, settings: &OpticsSection) -> Result<Self> {
        let lens = match presets::named(name) {
            Err(unknown) if lenses::find(name).is_err() => return Err(unknown),
            Err(_) => {
                NamedLens::Optical(Optical::new(OpticsSection { lens: Some(name.to_owned()), ..settings.clone() })?)
            }
            Ok(lens) => NamedLens::preset(lens, settings)?,
        };
        Ok(lens.into())
    }

    /// What it makes of a light.
    pub fn ghosts(&self) -> &[LensGhost] {
        match self {
            Self::Preset(lens) | Self::File(_, lens) => &lens.ghosts,
            Self::Optical(optical) => &optical.lens().ghosts,
            Self::Own(ghosts) => ghosts,
        }
    }

    /// What every pixel scatters in it, if it says so.
    pub fn veil(&self) -> Option<&LensVeil> {
        match self {
            Self::Preset(lens) | Self::File(_, lens) => lens.veil.as_ref(),
            Self::Optical(optical) => optical.lens().veil.as_ref(),
            Self::Own(_) => None,
        }
    }
}

impl Look {
    /// The lens, with its name for people.
    pub fn lens(&self) -> Lens {
        match &self.lens {
            LookLens::Preset(lens) | LookLens::File(_, lens) => Lens::clone(lens),
            LookLens::Optical(optical) => Lens::clone(optical.lens()),
            LookLens::Own(ghosts) => {
                let (name, description) = ("scene file".to_owned(), self.description.clone());
                Lens { name, description, ghosts: ghosts.to_vec(), veil: None }
            }
        }
    }

    /// The same on a picture's frame, as [`Look::frame`] gives it: a lens that is known by its surfaces has its ghosts in millimetres, and
    /// how many of those are a unit of lengths the picture's shape tells.
    pub fn fitted(&self, frame: &Frame) -> Cow<'_, Self> {
        let LookLens::Optical(optical) = &self.lens else { return Cow::Borrowed(self) };
        let fitted = optical.fitted(frame);
        if Arc::ptr_eq(fitted.lens(), optical.lens()) {
            return Cow::Borrowed(self);
        }
        Cow::Owned(Self { lens: LookLens::Optical(fitted), ..self.clone() })
    }

    /// Whether the photo is of all directions, as no lens shows them.
    pub fn is_panorama(&self) -> bool {
        self.projection() == Projection::Equirectangular
    }

    /// What the lens makes of a light: nothing where its ghosts stand for a veil, and there is one, and nothing in a panorama, which
    /// has no axis.
    pub fn lens_ghosts(&self) -> &[LensGhost] {
        if self.is_panorama() {
            return &[];
        }
        if self.veil.is_some() && self.lens.veil().is_some_and(|veil| veil.replaces_ghosts) {
            return &[];
        }
        self.lens.ghosts()
    }

    /// The veil on a picture, where the look has one and any strength. One that no more than the lens brings along is left out where
    /// no veil can be: where glare is normalised, and on pixels that are not square.
    pub fn veil_on(&self, frame: &Frame) -> Option<&Veil> {
        let veil = self.veil.as_ref().filter(|_| self.strength != 0.0)?;
        let fits = self.normalize == Normalize::None && frame.pixel_aspect == 1.0;
        let brought = self.lens.veil().is_some_and(|of_lens| veil.is_of(&of_lens.section));
        (fits || !brought).then_some(veil)
    }

    /// The same through another lens, with its veil, if it has one, in place of the one before.
    ///
    /// # Errors
    /// [`Error::Usage`] for a veil that cannot be had, as where a file that it names is gone.
    pub fn through(self, lens: LookLens, adds: bool) -> Result<Self> {
        let veil = lens.veil().map(|veil| Veil::new(&veil.section, adds)).transpose();
        let veil = veil.map_err(|fault| Error::Usage(format!("the lens's veil: {fault}")))?;
        let fov = self.fov.or(lens.veil().and_then(|veil| veil.section.fov));
        Ok(Self { lens, veil, fov, ..self })
    }

    /// The lights, of which `found` are the photo's; they come first.
    pub fn lights<'a>(&'a self, found: &'a [Light]) -> Cow<'a, [Light]> {
        match &self.lights {
            LookLights::Found => found.into(),
            LookLights::Listed(lights) | LookLights::Photo(lights) => lights.as_slice().into(),
            LookLights::FoundAnd(lights) => [found, lights.as_slice()].concat().into(),
        }
    }

    /// Adds lights to those that are found or listed.
    pub fn add_lights(&mut self, more: Vec<Light>) {
        match &mut self.lights {
            LookLights::Found if more.is_empty() => {}
            LookLights::Found => self.lights = LookLights::FoundAnd(more.into()),
            LookLights::Listed(lights) | LookLights::FoundAnd(lights) | LookLights::Photo(lights) => {
                lights.extend(more)
            }
        }
    }

    /// Makes the photo's pixels, or what is found in it, the source; lights that are listed stay, beside the one or the other.
    pub fn shine_by(&mut self, sources: Sources) {
        let listed = match std::mem::replace(&mut self.lights, LookLights::Found) {
            LookLights::Found => Shared::default(),
            LookLights::Listed(lights) | LookLights::FoundAnd(lights) | LookLights::Photo(lights) => lights,
        };
        self.lights = match sources {
            Sources::Photo => LookLights::Photo(listed),
            Sources::Lights if listed.is_empty() => LookLights::Found,
            Sources::Lights => LookLights::FoundAnd(listed),
        };
    }

    /// Whether every pixel of the photo makes ghosts.
    pub fn takes_photo(&self) -> bool {
        matches!(self.lights, LookLights::Photo(_)) && !self.lens_ghosts().is_empty()
    }
}
