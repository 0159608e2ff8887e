//! Which pixels of the photo are light, over what is on the screen.

use glam::DVec2;

use super::Live;
use crate::Result;
use crate::choices::LightBy;
use crate::gpu::mask::Mask as Uniforms;
use crate::gpu::{Region, Screen};
use crate::scene::Emission;

/// The colour of a mark, as shown: of no tone map, and not that of an error beyond the tolerance.
const MARK: [f32; 3] = [1.0, 0.1, 0.15];

/// At most so many rows and columns of the photo are looked at for a pixel of the screen.
const MOST: u32 = 12;

/// What counts as light, and where the photo lies on the screen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mask {
    /// Linear brightness, in the photo's unit, from which on a pixel is light.
    pub threshold: f64,
    /// How many times as bright as its brightest neighbour a single pixel may be, and still is light; 0 for whatever it
    /// likes.
    pub firefly_limit: f64,
    /// How a pixel gives light.
    pub emission: Emission,
    /// Where the region's top left corner lies on the photo, in its pixels from its top left corner.
    pub origin: DVec2,
    /// The photo's pixels from one of the screen to the next; less than 1 magnifies.
    pub pitch: f64,
}

impl Live {
    /// Marks the pixels of the photo that are light in a region of the screen, and leaves the others as they are.
    ///
    /// # Errors
    /// [`crate::Error::Gl`] where no photo is loaded, or the driver refuses.
    pub fn mask(&mut self, mask: &Mask, screen: &Screen, region: Region) -> Result<()> {
        let photo = self.picture.composite.loaded()?;
        // The shader counts from the screen's corner.
        let corner = DVec2::new(f64::from(region.x), f64::from(region.y));
        let uniforms = Uniforms {
            weights: mask.emission.weights,
            threshold: mask.threshold as f32,
            origin: (mask.origin - mask.pitch * corner).as_vec2().to_array(),
            pitch: mask.pitch as f32,
            rows: 0.0,
            mark: MARK,
            most: MOST,
            limit: mask.firefly_limit as f32,
            pad: [0; 3],
        };
        let by = [("STRAIGHT", mask.emission.straight), ("BRIGHTEST", mask.emission.by == LightBy::Brightest)];
        let defines: Vec<_> = by.into_iter().filter(|(_, is)| *is).map(|(name, _)| (name, "1")).collect();
        self.mask.draw(&self.picture.field.runner, photo, &uniforms, &defines, screen, region)
    }
}
