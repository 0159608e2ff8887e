//! How a picture is looked at.

use glam::{DMat3, DVec2};

use crate::gpu::Region;
use crate::gpu::layout::{TONE_MAP_ACES, TONE_MAP_AGX, TONE_MAP_NONE, TONE_MAP_REINHARD};
use crate::gpu::shrink::Place;
use crate::gpu::view::{Layers, View as Uniforms};
use crate::photo::ToneMap;

/// What is looked at.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Part {
    /// The photo with its glare.
    Picture,
    /// The glare alone.
    Glare,
}

/// How a picture is looked at; the picture itself does not depend on it.
///
/// Magnified, a pixel of the photo is a square of the screen. Made smaller, a pixel of the screen shows the mean light
/// of all that fall on it, weighted by area; of more than 12 a side, rows and columns are left out evenly.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct View {
    /// Where the region's top left corner lies on the photo, in its pixels from its top left corner.
    pub origin: DVec2,
    /// The photo's pixels from one of the screen to the next; less than 1 magnifies.
    pub pitch: f64,
    /// Stops by which the light is raised first.
    pub exposure: f64,
    /// How light comes into the display's range next.
    pub tone_map: ToneMap,
    /// From the photo's primaries to Rec.709's, where they differ.
    pub gamut: Option<DMat3>,
    /// Columns of the region from this one on show what was drawn, those before it the photo as it was.
    pub wipe: f64,
    /// What surrounds the photo, RGB as it is shown, 0 to 1.
    pub surround: [f32; 3],
}

/// What part of a region shows the photo as it was.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Wiped {
    Nothing,
    Part,
    All,
}

impl View {
    pub(super) fn wiped(&self, region: Region) -> Wiped {
        match self.wipe {
            wipe if wipe <= 0.0 => Wiped::Nothing,
            wipe if wipe >= f64::from(region.width) => Wiped::All,
            _ => Wiped::Part,
        }
    }

    pub(super) fn place(&self, region: Region) -> Place {
        Place { origin: self.origin, pitch: self.pitch, size: [region.width, region.height] }
    }

    /// What the shader is specialised with for this view of these layers.
    pub(super) fn defines(&self, layers: &Layers<'_>, region: Region) -> Vec<(&'static str, &'static str)> {
        let tone_map = match self.tone_map {
            ToneMap::None => TONE_MAP_NONE,
            ToneMap::Reinhard => TONE_MAP_REINHARD,
            ToneMap::Aces => TONE_MAP_ACES,
            ToneMap::Agx => TONE_MAP_AGX,
        };
        let mut defines = vec![("TONE_MAP", tone_map.0)];
        if layers.picture.is_none() && layers.field.is_none() {
            defines.push(("BEFORE", "1"));
        } else if self.wiped(region) == Wiped::Part {
            defines.push(("WIPE", "1"));
        }
        if self.gamut.is_some() {
            // Not by the identity, which would spread what is not finite from one colour to all.
            defines.push(("GAMUT", "1"));
        }
        defines
    }

    /// The uniforms, without those that a field needs.
    pub(super) fn uniforms(&self, region: Region) -> Uniforms {
        // The shader counts from the screen's corner.
        let corner = DVec2::new(f64::from(region.x), f64::from(region.y));
        let gamut = self.gamut.unwrap_or(DMat3::IDENTITY).to_cols_array_2d();
        Uniforms {
            gamut: gamut.map(|[r, g, b]| [r as f32, g as f32, b as f32, 0.0]),
            origin: (self.origin - self.pitch * corner).as_vec2().to_array(),
            pitch: self.pitch as f32,
            surround: self.surround,
            gain: self.exposure.exp2() as f32,
            wipe: (self.wipe + corner.x) as f32,
            ..bytemuck::Zeroable::zeroed()
        }
    }
}
