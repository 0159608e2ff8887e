//! Scene, light and lens files as they are written. Every table refuses keys that it does not know.

use glam::DVec2;
use serde::Deserialize;

use super::number::{Degree, Finite, NotNegative, Number, Positive, Sizes, plain};
use super::{Ghost, LensGhost, Light};
use crate::series::Bell;

/// A scene file; also a file of lights alone.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SceneTable {
    #[serde(default)]
    pub description: String,
    pub period: Option<[Positive; 2]>,
    pub degree: Option<[Degree; 2]>,
    #[serde(default, rename = "light")]
    pub lights: Vec<LightTable>,
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
    #[serde(rename = "lens_ghost")]
    pub ghosts: Vec<LensGhostTable>,
}

/// A file of lights in TOML.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct LightsTable {
    #[serde(rename = "light")]
    pub lights: Vec<LightTable>,
}

/// What `vglare lights --json` prints. What it says besides the lights is not read, and may be missing or wrong.
#[derive(Deserialize)]
pub(super) struct LightsJson {
    pub lights: Vec<LightTable>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct LightTable {
    position: [Finite; 2],
    flux: [NotNegative; 3],
    #[serde(default = "zero")]
    size: NotNegative,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct GhostTable {
    #[serde(default = "gaussian")]
    bell: Bell,
    center: [Finite; 2],
    size: Sizes,
    radiance: [Finite; 3],
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct LensGhostTable {
    #[serde(default = "gaussian")]
    bell: Bell,
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

fn gaussian() -> Bell {
    Bell::Gaussian
}

impl From<LightTable> for Light {
    fn from(LightTable { position, flux, size }: LightTable) -> Self {
        Self { position: DVec2::from_array(plain(position)), flux: plain(flux), size: size.0 }
    }
}

impl From<GhostTable> for Ghost {
    fn from(GhostTable { bell, center, size, radiance }: GhostTable) -> Self {
        Self { bell, center: DVec2::from_array(plain(center)), size: size.0, radiance: plain(radiance) }
    }
}

impl From<LensGhostTable> for LensGhost {
    fn from(LensGhostTable { bell, along, size, tint, share }: LensGhostTable) -> Self {
        Self { bell, along: along.0, size: size.0, tint: plain(tint), share: share.0 }
    }
}
