//! What glares: lights, the lens that scatters them, and the ghosts that result.

use glam::DVec2;

use crate::series::Bell;

mod bells;
mod file;
mod find;
mod lens;
mod number;
pub mod presets;
mod regions;
mod tables;
pub mod threshold;

pub use file::{SceneFile, read_lens, read_lights, read_scene};
pub use find::{FindOptions, Found, find};
pub use lens::{Lens, ghosts};

/// A bright source.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Light {
    /// Its centre on the picture plane; may lie outside the picture.
    pub position: DVec2,
    /// Radiance times area, RGB, in the photo's unit times half picture heights squared.
    pub flux: [f64; 3],
    /// Root mean square distance of its light from its centre along one axis, in half picture heights; 0 is a point.
    pub size: f64,
}

/// How a lens turns any light into one ghost.
#[derive(Debug, Clone, PartialEq)]
pub struct LensGhost {
    /// The bell's profile.
    pub bell: Bell,
    /// The ghost's centre is `along` times the light's position: 1 is on the light, −1 opposite it across the axis.
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
    /// The ghost's flux, RGB: its integral over the plane.
    pub fn flux(&self) -> [f64; 3] {
        let volume = self.bell.shape().integral(self.size);
        self.radiance.map(|radiance| radiance * volume)
    }
}
