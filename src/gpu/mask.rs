//! A mark over every pixel of the photo that is light.

use bytemuck::{Pod, Zeroable};

use super::layout::{PASS, PHOTO};
use super::resource::{Buffer, Texture};
use super::runner::Runner;
use super::screen::{Region, Screen};
use crate::Result;

/// The mask's uniforms; as in `mask.frag`.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct Mask {
    /// Of linear R, G and B in luminance.
    pub weights: [f32; 3],
    /// From which brightness on a pixel is light.
    pub threshold: f32,
    /// Where the screen's top left corner lies on the photo, in its pixels from its top left corner.
    pub origin: [f32; 2],
    /// The photo's pixels from one of the screen to the next.
    pub pitch: f32,
    /// Rows of the screen; set by the pass.
    pub rows: f32,
    /// The colour of a mark, as shown.
    pub mark: [f32; 3],
    /// Rows and columns that a pixel of the screen looks at, at most.
    pub most: u32,
    /// How many times as bright as its brightest neighbour a pixel may be; 0 for whatever it likes.
    pub limit: f32,
    pub pad: [u32; 3],
}
const _: () = assert!(size_of::<Mask>() == 64);

/// Draws the mask.
pub(crate) struct MaskPass {
    uniforms: Buffer<Mask>,
}

impl MaskPass {
    pub fn new(runner: &Runner) -> Result<Self> {
        Ok(Self { uniforms: Buffer::new(runner.device(), 1)? })
    }

    /// Marks what is light in a region of the screen, as the defines of `shared/emission.glsl` tell it; the rest of it stays.
    pub fn draw(
        &mut self,
        runner: &Runner,
        photo: &Texture,
        mask: &Mask,
        defines: &[(&str, &str)],
        screen: &Screen,
        region: Region,
    ) -> Result<()> {
        self.uniforms.store(&[Mask { rows: screen.size()[1] as f32, ..*mask }])?;
        self.uniforms.bind_uniform(PASS);
        photo.bind(PHOTO);
        runner.draw_screen("mask.frag", defines, screen, region)
    }
}
