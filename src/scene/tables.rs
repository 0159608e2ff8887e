//! Scene, light and lens files as they are written. Every table refuses keys that it does not know.

use std::path::Path;

use glam::DVec2;
use serde::Deserialize;
use serde::de::IgnoredAny;
use toml::{Spanned, Value};

use super::bells::{BellKeys, BellName, Bells, Fault, ProfileTable};
use super::number::{Degree, Finite, NotNegative, Number, Positive, Sizes, plain};
use super::sections::{AccuracyTable, FindSection, LookSection, Version};
use super::veil::{VeilTable, absolute};
use super::{Ghost, LensGhost, Light, Optical, OpticsSection};
use super::{lenses, presets};
use crate::choices::LengthUnit;

/// The version of a scene file, whatever else is in it: one that is not known may have other keys.
#[derive(Deserialize)]
pub(super) struct VersionTable {
    version: Option<Spanned<Value>>,
}

/// A scene file; also a file of lights alone.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SceneTable {
    /// See [`VersionTable`].
    #[serde(rename = "version")]
    _version: Option<IgnoredAny>,
    #[serde(default)]
    pub description: String,
    pub preset: Option<Spanned<String>>,
    pub axis: Option<[Finite; 2]>,
    pub period: Option<[Positive; 2]>,
    pub degree: Option<[Degree; 2]>,
    #[serde(default)]
    pub look: LookSection,
    #[serde(default)]
    pub find: FindSection,
    pub accuracy: Option<AccuracyTable>,
    pub optics: Option<Spanned<OpticsSection>>,
    pub veil: Option<Spanned<VeilTable>>,
    #[serde(default, rename = "profile")]
    pub profiles: Vec<ProfileTable>,
    #[serde(rename = "light")]
    pub lights: Option<Vec<LightTable>>,
    #[serde(default, rename = "ghost")]
    pub ghosts: Vec<GhostTable>,
    #[serde(default, rename = "lens_ghost")]
    pub lens_ghosts: Vec<LensGhostTable>,
}

/// A lens file, like the presets.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct LensTable {
    #[serde(default)]
    pub description: String,
    #[serde(default, rename = "profile")]
    pub profiles: Vec<ProfileTable>,
    #[serde(default, rename = "lens_ghost")]
    pub ghosts: Vec<LensGhostTable>,
    pub veil: Option<Spanned<VeilTable>>,
}

/// A file of lights in TOML.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct LightsTable {
    #[serde(rename = "light")]
    pub lights: Vec<LightTable>,
}

/// What `vglare lights --json` prints. What it says besides the lights and their unit is not read, and may be missing or wrong.
#[derive(Deserialize)]
pub(super) struct LightsJson {
    pub unit: Option<LengthUnit>,
    pub lights: Vec<LightTable>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct LightTable {
    position: [Finite; 2],
    flux: [NotNegative; 3],
    #[serde(default = "zero")]
    size: NotNegative,
    #[serde(default)]
    muted: bool,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct GhostTable {
    bell: Option<Spanned<BellName>>,
    profile: Option<Spanned<String>>,
    mean: Option<Spanned<Finite>>,
    rim: Option<Spanned<Finite>>,
    edge: Option<Spanned<Finite>>,
    blades: Option<Spanned<u32>>,
    rotation: Option<Spanned<Finite>>,
    center: [Finite; 2],
    size: Sizes,
    radiance: [Finite; 3],
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct LensGhostTable {
    bell: Option<Spanned<BellName>>,
    profile: Option<Spanned<String>>,
    mean: Option<Spanned<Finite>>,
    rim: Option<Spanned<Finite>>,
    edge: Option<Spanned<Finite>>,
    blades: Option<Spanned<u32>>,
    rotation: Option<Spanned<Finite>>,
    along: Finite,
    size: Sizes,
    #[serde(default = "white")]
    tint: [NotNegative; 3],
    share: NotNegative,
}

fn zero() -> NotNegative {
    Number::new(0.0)
}

fn white() -> [NotNegative; 3] {
    [1.0; 3].map(Number::new)
}

impl From<LightTable> for Light {
    fn from(LightTable { position, flux, size, muted }: LightTable) -> Self {
        Self { position: DVec2::from_array(plain(position)), flux: plain(flux), size: size.0, muted }
    }
}

impl VersionTable {
    /// What the file means by what it does not say.
    pub fn version(&self) -> Result<Version, Fault> {
        let Some(version) = &self.version else { return Ok(Version::One) };
        let newest = Version::default().number();
        let message = match version.as_ref() {
            Value::Integer(1) => return Ok(Version::One),
            Value::Integer(2) => return Ok(Version::Two),
            Value::Integer(later) if *later > newest.into() => format!(
                "this file is of version {later}, and this vglare knows versions 1 and {newest}: a newer one may read it"
            ),
            other => format!("expected version 1 or {newest}, found {other}"),
        };
        Err(Fault { span: version.span(), message: format!("{message} in `version`") })
    }
}

impl SceneTable {
    /// The lens by its surfaces, if it is one; its file, which lies beside the scene's at `path`, by an absolute path. It has been read, and
    /// can be set as the file says.
    pub fn optics(&self, path: &Path) -> Result<Option<OpticsSection>, Fault> {
        let Some(optics) = &self.optics else { return Ok(None) };
        let fault = |message: String| Fault { span: optics.span(), message };
        if self.preset.is_some() || !self.lens_ghosts.is_empty() {
            let other = if self.preset.is_some() { "`preset`" } else { "[[lens_ghost]]" };
            return Err(fault(format!("expected either [optics] or {other}, found both")));
        }
        let mut section = optics.as_ref().clone();
        section.file = section.file.map(|file| absolute(&path.parent().unwrap_or(Path::new("")).join(file)));
        Optical::new(section.clone()).map_err(|error| fault(error.to_string()))?;
        Ok(Some(section))
    }

    /// The preset that the lens is, if it is one.
    pub fn preset(&self, version: Version) -> Result<Option<String>, Fault> {
        let Some(preset) = &self.preset else { return Ok(None) };
        let fault = |message: String| Fault { span: preset.span(), message };
        if !self.lens_ghosts.is_empty() {
            return Err(fault("expected either `preset` or [[lens_ghost]], found both".into()));
        }
        if version == Version::Two && presets::named(preset.as_ref()).is_err() && lenses::find(preset.as_ref()).is_ok()
        {
            return Ok(Some(preset.as_ref().clone()));
        }
        let found = presets::named_in(version, preset.as_ref()).map_err(|error| fault(error.to_string()))?;
        Ok(Some(found.name))
    }
}

impl GhostTable {
    /// The ghost, if its bell is to be had.
    pub fn ghost(self, bells: &Bells) -> Result<Ghost, Fault> {
        let Self { bell, profile, mean, rim, edge, blades, rotation, center, size, radiance } = self;
        let bell = bells.bell(&BellKeys { bell, profile, mean, rim, edge, blades, rotation })?;
        Ok(Ghost { bell, center: DVec2::from_array(plain(center)), size: size.0, radiance: plain(radiance) })
    }
}

impl LensGhostTable {
    /// The lens ghost, if its bell is to be had and can carry light.
    pub fn lens_ghost(self, bells: &Bells) -> Result<LensGhost, Fault> {
        let Self { bell, profile, mean, rim, edge, blades, rotation, along, size, tint, share } = self;
        let span = profile.as_ref().map_or(0..0, Spanned::span);
        let bell = bells.bell(&BellKeys { bell, profile, mean, rim, edge, blades, rotation })?;
        if bell.shape().integral(size.0) <= 0.0 {
            return Err(Fault {
                span,
                message: "this profile's integral is not positive: it cannot carry a share".into(),
            });
        }
        Ok(LensGhost { bell, along: along.0, size: size.0, tint: plain(tint), share: share.0 })
    }
}
