//! The photo and the picture as a display shows them: moved, magnified, exposed, tone-mapped, encoded.

use bytemuck::{Pod, Zeroable};

use super::layout::{PASS, PHOTO, PICTURE};
use super::resource::{Buffer, Texture};
use super::runner::Runner;
use super::screen::{Region, Screen};
use super::shader::Define;
use crate::Result;

/// The view's uniforms; as in `view.frag`.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct View {
    /// From the photo's primaries to Rec.709's, column by column.
    pub gamut: [[f32; 4]; 3],
    /// Where the screen's top left corner lies on the photo, in its pixels from its top left corner.
    pub origin: [f32; 2],
    /// The photo's pixels from one of the screen to the next.
    pub pitch: f32,
    /// Rows of the screen; set by the pass.
    pub rows: f32,
    /// What surrounds the photo, as shown.
    pub surround: [f32; 3],
    /// Multiplies the light.
    pub gain: f32,
    /// Columns of the screen from this one on show the picture, those before it the photo.
    pub wipe: f32,
    /// Rows and columns of the photo from one that is looked at to the next, where it is made smaller.
    pub stride: u32,
    pub pad: [u32; 2],
}
const _: () = assert!(size_of::<View>() == 96);

/// Draws the view.
pub(crate) struct ViewPass {
    uniforms: Buffer<View>,
}

impl ViewPass {
    pub fn new(runner: &Runner) -> Result<Self> {
        Ok(Self { uniforms: Buffer::new(runner.device(), 1)? })
    }

    /// Draws a region of the screen, with the map of `shared/tone.glsl` whose number `TONE_MAP` is.
    pub fn draw(
        &mut self,
        runner: &Runner,
        [photo, picture]: [&Texture; 2],
        defines: &[Define<'_>],
        view: &View,
        screen: &Screen,
        region: Region,
    ) -> Result<()> {
        self.uniforms.store(&[View { rows: screen.size()[1] as f32, ..*view }])?;
        self.uniforms.bind_uniform(PASS);
        photo.bind(PHOTO);
        picture.bind(PICTURE);
        runner.draw_screen("view.frag", defines, screen, region)
    }
}
