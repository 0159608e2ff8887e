//! What a person sets of a photo's glare.

use glam::DVec2;

use crate::renderer::Settings;
use crate::scene::{self, Ghost, Lens, Light};

/// The tolerance that a photo is opened with.
pub const TOLERANCE: f64 = 1e-3;

/// A light, and whether it glares.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lamp {
    /// The light.
    pub light: Light,
    /// Whether it makes no ghosts for now.
    pub muted: bool,
}

/// Everything that the glare of a photo is made from.
#[derive(Debug, Clone, PartialEq)]
pub struct Look {
    /// The lights.
    pub lamps: Vec<Lamp>,
    /// The lens.
    pub lens: Lens,
    /// Where the lens's axis meets the picture plane: ghosts lie on the lines through it and their lights.
    pub axis: DVec2,
    /// Largest error at any pixel, relative to the largest glare of the same colour; above 0, below 1.
    pub tolerance: f64,
    /// How the glare is laid over the photo.
    pub settings: Settings,
}

/// The part of a look that the field depends on.
#[derive(Debug, Clone, PartialEq)]
pub struct Optics {
    lights: Vec<Light>,
    lens: Lens,
    axis: DVec2,
}

impl Look {
    /// The look of lights that were found, none of them muted, through a lens.
    pub fn new(lights: &[Light], lens: Lens, settings: Settings) -> Self {
        let lamps = lights.iter().map(|&light| Lamp { light, muted: false }).collect();
        Self { lamps, lens, axis: DVec2::ZERO, tolerance: TOLERANCE, settings }
    }

    /// What the field depends on.
    pub fn optics(&self) -> Optics {
        let lights = self.lamps.iter().filter(|lamp| !lamp.muted).map(|lamp| lamp.light).collect();
        Optics { lights, lens: self.lens.clone(), axis: self.axis }
    }
}

impl Optics {
    /// The ghosts, light by light.
    pub fn ghosts(&self) -> Vec<Ghost> {
        scene::ghosts(&self.lights, &self.lens, self.axis)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::presets;

    #[test]
    fn ghosts_keep_to_the_line_through_their_light_and_the_axis() {
        let light = Light { position: DVec2::new(0.5, 0.25), flux: [1.0; 3], size: 0.0, muted: false };
        let lens = presets::named(presets::DEFAULT_PRESET).unwrap();
        let mut look = Look::new(&[light, light], lens, Settings::default());
        look.axis = DVec2::new(0.1, -0.2);
        look.lamps[1].muted = true;
        let ghosts = look.optics().ghosts();
        assert_eq!(ghosts.len(), look.lens.ghosts.len());
        for (ghost, of_lens) in ghosts.iter().zip(&look.lens.ghosts) {
            let wanted = look.axis + of_lens.along * (light.position - look.axis);
            assert!((ghost.center - wanted).length() < 1e-12, "{ghost:?}");
        }
    }
}
