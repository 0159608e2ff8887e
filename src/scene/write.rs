//! Scene files as vglare writes them: what they say in the order of docs/scenes.md, profiles in the file itself.

use std::path::Path;
use std::sync::Arc;

use glam::DVec2;
use serde::Serialize;

use super::file::parse_scene;
use super::sections::{AccuracySection, FindSection, Goal, LookSection};
use super::veil::NO_VEIL;
use super::{Ghost, LensGhost, Light, OpticsSection, SceneFile, VeilSection};
use crate::choices::Evaluator;
use crate::series::{Bell, Profile};
use crate::{Error, Result, target};

/// Writes a scene file, beside its target and then renamed. What could not be read again, and mean the same, is not
/// written.
///
/// # Errors
/// [`Error::SceneFile`] for a scene that no file can say: a number out of range, or periodic bells of another period
/// than the scene's; [`Error::Exists`] where the file is there and must not be replaced; [`Error::Write`] where the
/// system refuses.
pub fn write_scene(path: &Path, scene: &SceneFile, overwrite: bool) -> Result<()> {
    target::write_text(path, &checked_toml(path, scene)?, overwrite)
}

/// The text of a scene file that is to be at `path`, which has been read again.
///
/// # Errors
/// [`Error::SceneFile`] where it would not mean the same.
pub(crate) fn checked_toml(path: &Path, scene: &SceneFile) -> Result<String> {
    let text = to_toml(scene);
    if parse_scene(path, &text)? != *scene {
        return Err(Error::scene_file(path, "a file cannot say this: the scene's period is not that of its bells"));
    }
    Ok(text)
}

/// The text of a scene file. Every number is the shortest that is read as the same one again.
pub fn to_toml(scene: &SceneFile) -> String {
    let mut profiles = Profiles::default();
    let out = SceneOut {
        version: scene.version.number(),
        description: &scene.description,
        preset: scene.preset.as_deref(),
        optics: scene.optics.as_ref(),
        axis: scene.axis,
        period: scene.period,
        degree: scene.degree,
        light: scene.lights.as_ref().map(|lights| lights.iter().map(LightOut::from).collect()),
        look: (scene.look != LookSection::default()).then_some(scene.look),
        find: (scene.find != FindSection::default()).then_some(scene.find),
        accuracy: AccuracyOut::of(scene),
        veil: match &scene.veil {
            Some(veil) => Some(VeilOut::Some(veil)),
            None => scene.no_veil.then_some(VeilOut::None { psf: NO_VEIL }),
        },
        lens_ghost: scene.lens_ghosts.iter().map(|ghost| LensGhostOut::new(ghost, &mut profiles)).collect(),
        ghost: scene.ghosts.iter().map(|ghost| GhostOut::new(ghost, &mut profiles)).collect(),
        profile: profiles.tables(),
    };
    toml::to_string(&out).expect("these tables have text keys and numbers, which TOML has too")
}

#[derive(Serialize)]
struct SceneOut<'a> {
    version: u32,
    #[serde(skip_serializing_if = "str::is_empty")]
    description: &'a str,
    #[serde(skip_serializing_if = "Option::is_none")]
    preset: Option<&'a str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    axis: Option<DVec2>,
    #[serde(skip_serializing_if = "Option::is_none")]
    period: Option<DVec2>,
    #[serde(skip_serializing_if = "Option::is_none")]
    degree: Option<[u32; 2]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    look: Option<LookSection>,
    #[serde(skip_serializing_if = "Option::is_none")]
    find: Option<FindSection>,
    #[serde(skip_serializing_if = "Option::is_none")]
    accuracy: Option<AccuracyOut>,
    #[serde(skip_serializing_if = "Option::is_none")]
    optics: Option<&'a OpticsSection>,
    #[serde(skip_serializing_if = "Option::is_none")]
    veil: Option<VeilOut<'a>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    light: Option<Vec<LightOut>>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    lens_ghost: Vec<LensGhostOut>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    ghost: Vec<GhostOut>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    profile: Vec<ProfileOut>,
}

#[derive(Serialize)]
#[serde(untagged)]
enum VeilOut<'a> {
    Some(&'a VeilSection),
    None { psf: &'static str },
}

#[derive(Serialize, Default, PartialEq)]
struct AccuracyOut {
    #[serde(skip_serializing_if = "Option::is_none")]
    tolerance: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    budget: Option<f64>,
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    allow_floor: bool,
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    each_pixel: bool,
    #[serde(skip_serializing_if = "Option::is_none")]
    evaluator: Option<Evaluator>,
}

impl AccuracyOut {
    /// What the scene says, if it says anything.
    fn of(scene: &SceneFile) -> Option<Self> {
        let section = scene.accuracy;
        let (tolerance, budget) = match section.goal {
            Some(Goal::Tolerance(tolerance)) => (Some(tolerance), None),
            Some(Goal::Budget(budget)) => (None, Some(budget)),
            None => (None, None),
        };
        let AccuracySection { allow_floor, each_pixel, evaluator, .. } = section;
        let out = Self { tolerance, budget, allow_floor, each_pixel, evaluator };
        (out != Self::default()).then_some(out)
    }
}

#[derive(Serialize)]
struct LightOut {
    position: DVec2,
    flux: [f64; 3],
    size: f64,
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    muted: bool,
}

impl From<&Light> for LightOut {
    fn from(&Light { position, flux, size, muted }: &Light) -> Self {
        Self { position, flux, size, muted }
    }
}

/// A bell, as the keys that name it.
#[derive(Serialize, Default)]
struct BellOut {
    bell: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    profile: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    mean: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    rim: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    edge: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    blades: Option<u32>,
    #[serde(skip_serializing_if = "Option::is_none")]
    rotation: Option<f64>,
}

impl BellOut {
    fn new(bell: &Bell, profiles: &mut Profiles) -> Self {
        let mut out = Self { bell: bell.shape().name(), ..Self::default() };
        match bell {
            Bell::Profile(table) => out.profile = Some(profiles.name(table)),
            Bell::SineGaussian(bell) => out.mean = Some(bell.mean),
            Bell::Disc(disc) => {
                out.rim = Some(disc.rim());
                let bladed = !disc.is_round();
                (out.blades, out.rotation) = (bladed.then(|| disc.blades()), bladed.then(|| disc.rotation()));
            }
            Bell::Iris(iris) => {
                out.edge = Some(iris.edge());
                let bladed = !iris.is_round();
                (out.blades, out.rotation) = (bladed.then(|| iris.blades()), bladed.then(|| iris.rotation()));
            }
            _ => {}
        }
        out
    }
}

#[derive(Serialize)]
struct LensGhostOut {
    #[serde(flatten)]
    bell: BellOut,
    along: f64,
    size: SizeOut,
    tint: [f64; 3],
    share: f64,
}

impl LensGhostOut {
    fn new(ghost: &LensGhost, profiles: &mut Profiles) -> Self {
        let &LensGhost { ref bell, along, size, tint, share } = ghost;
        Self { bell: BellOut::new(bell, profiles), along, size: size.into(), tint, share }
    }
}

#[derive(Serialize)]
struct GhostOut {
    #[serde(flatten)]
    bell: BellOut,
    center: DVec2,
    size: SizeOut,
    radiance: [f64; 3],
}

impl GhostOut {
    fn new(ghost: &Ghost, profiles: &mut Profiles) -> Self {
        let &Ghost { ref bell, center, size, radiance } = ghost;
        Self { bell: BellOut::new(bell, profiles), center, size: size.into(), radiance }
    }
}

/// One size for both axes, or one for each.
#[derive(Serialize)]
#[serde(untagged)]
enum SizeOut {
    Both(f64),
    Each(DVec2),
}

impl From<DVec2> for SizeOut {
    fn from(size: DVec2) -> Self {
        if size.x == size.y { Self::Both(size.x) } else { Self::Each(size) }
    }
}

#[derive(Serialize)]
struct ProfileOut {
    name: String,
    rows: Vec<[f64; 2]>,
}

/// The profiles that a scene's bells have, each once.
#[derive(Default)]
struct Profiles(Vec<Arc<Profile>>);

impl Profiles {
    /// The name that a profile has in the file.
    fn name(&mut self, profile: &Arc<Profile>) -> String {
        let known = self.0.iter().position(|known| Arc::ptr_eq(known, profile) || known == profile);
        let index = known.unwrap_or_else(|| {
            self.0.push(profile.clone());
            self.0.len() - 1
        });
        format!("profile-{}", index + 1)
    }

    fn tables(&self) -> Vec<ProfileOut> {
        let table = |(number, profile): (usize, &Arc<Profile>)| ProfileOut {
            name: format!("profile-{number}"),
            rows: profile.rows().collect(),
        };
        (1..).zip(&self.0).map(table).collect()
    }
}

#[cfg(test)]
mod tests;
