//! What glares: lights, the lens that scatters them, and the ghosts that result.

use glam::DVec2;

use crate::series::Bell;

mod bells;
mod emission;
mod file;
mod find;
mod knee;
mod lens;
pub mod lenses;
mod lit;
mod nearest;
mod number;
mod optical;
pub(crate) mod patches;
pub mod presets;
mod recover;
mod referred;
mod regions;
mod sections;
mod shape;
mod tables;
pub mod threshold;
mod veil;
mod write;

pub use emission::{Emission, is_light};
pub(crate) use file::contents;
pub use file::{SceneFile, read_lens, read_lights, read_lights_in, read_scene, unit_of_lights};
pub use find::{FindOptions, Found, find, find_shining};
pub use knee::{Knee, brightest};
pub use lens::{Lens, LensVeil, ghosts};
pub(crate) use optical::Rimmed;
pub use optical::{NamedLens, Optical, OpticsSection, SENSOR, named_lens};
pub use recover::{END as DISPLAY_WHITE, Recover, Recovered, Recovery, clipped, recover, stops as recovery_stops};
pub(crate) use referred::referred;
pub use sections::{AccuracySection, FindSection, Goal, LookSection, Version};
pub use veil::{NO_VEIL, VeilFunction, VeilSection, absolute, check_fov};
pub(crate) use write::checked_toml;
pub use write::{to_toml, write_scene};

/// A bright source.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Light {
    /// Its centre on the picture plane; may lie outside the picture.
    pub position: DVec2,
    /// Radiance times area, RGB, in the photo's unit times half picture heights squared.
    pub flux: [f64; 3],
    /// Root mean square distance of its light from its centre along one axis, in half picture heights; 0 is a point.
    pub size: f64,
    /// Whether it is kept but makes no ghosts.
    pub muted: bool,
}

/// How a lens turns any light into one ghost.
#[derive(Debug, Clone, PartialEq)]
pub struct LensGhost {
    /// The bell's profile.
    pub bell: Bell,
    /// The ghost's centre is `along` times as far from the axis as the light: 1 is on the light, −1 opposite it.
    pub along: f64,
    /// Sizes in x and y, for a light that is a point: σ of a Gaussian, half the width of a bell that ends.
    pub size: DVec2,
    /// Colour, RGB; multiplies the light's.
    pub tint: [f64; 3],
    /// Share of the light's flux that the ghost carries.
    pub share: f64,
}

/// One bell on the picture plane.
#[derive(Debug, Clone, PartialEq)]
pub struct Ghost {
    /// The bell's profile.
    pub bell: Bell,
    /// Its centre.
    pub center: DVec2,
    /// Sizes in x and y: σ of a Gaussian, half the width of a bell that ends.
    pub size: DVec2,
    /// Radiance where it is brightest, RGB: at its centre, for a bell that has its largest value there.
    pub radiance: [f64; 3],
}

impl Ghost {
    /// The ghost made `factor` times as large, > 0, with the same flux: so much wider, so much fainter.
    pub fn scaled(self, factor: f64) -> Self {
        let (shape, size) = (self.bell.shape(), factor * self.size);
        // The integral of a bell that is not periodic goes with the area of its sizes; that of a profile may be 0.
        let fainter = match shape.period() {
            Some(_) => shape.integral(self.size) / shape.integral(size),
            None => factor.powi(-2),
        };
        Self { size, radiance: self.radiance.map(|radiance| radiance * fainter), ..self }
    }

    /// The ghost's flux, RGB: its integral over the plane.
    pub fn flux(&self) -> [f64; 3] {
        let volume = self.bell.shape().integral(self.size);
        self.radiance.map(|radiance| radiance * volume)
    }
}
