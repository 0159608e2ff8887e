//! The photo and the picture as a display shows them: moved, magnified or made smaller, exposed, tone-mapped, encoded.

use bytemuck::{Pod, Zeroable};

use super::layout::{Binding, FIELD, OVERLAY_LAYERS, PASS, PHOTO, PICTURE};
use super::overlay;
use super::resource::{Buffer, Texture};
use super::runner::Runner;
use super::screen::{Region, Screen};
use super::shader::Define;
use super::shrink::{Means, Place, ShrinkPass};
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
    /// The field's unit, RGB.
    pub scale: [f32; 3],
    /// What the normalised glare is multiplied by.
    pub strength: f32,
    /// What is subtracted from the field, RGB.
    pub constant: [f32; 3],
    /// A range of the field's values that is no wider is rounding.
    pub flat: f32,
    /// The photo's sides; set by the pass.
    pub size: [f32; 2],
    /// The region's corner on the screen; set by the pass.
    pub corner: [f32; 2],
    /// Columns of the screen from this one on show the picture, those before it the photo.
    pub wipe: f32,
    /// Whether the textures hold means; set by the pass.
    pub means: u32,
    /// Texels of the field to a pixel of the photo, where it has fewer, else 0; set by the pass.
    pub coarse: [f32; 2],
    /// What each layer that is laid over the photo is multiplied by, RGB.
    pub overlay: [[f32; 4]; OVERLAY_LAYERS],
}
const _: () = assert!(size_of::<View>() == 208);

/// A texture and what tells its content from any other before.
pub(crate) type Layer<'a> = (&'a Texture, u64);

/// What a view is of. Photo and picture are of one size.
pub(crate) struct Layers<'a> {
    /// Columns and rows of the photo.
    pub size: [u32; 2],
    /// The photo as it was, where it is seen.
    pub photo: Option<Layer<'a>>,
    /// The photo with its glare, or the glare alone, as it was drawn.
    pub picture: Option<Layer<'a>>,
    /// The field in its place, which becomes glare here; it may be coarser than the photo.
    pub field: Option<Layer<'a>>,
    /// What is laid over the photo, or is glare, beside the field.
    pub overlay: Vec<Layer<'a>>,
}

/// Draws the view.
pub(crate) struct ViewPass {
    uniforms: Buffer<View>,
    shrink: ShrinkPass,
    /// Of photo, picture and field.
    means: [Means; 3],
    /// Of the layers that are laid over the photo.
    overlay: [Means; OVERLAY_LAYERS],
}

impl ViewPass {
    pub fn new(runner: &Runner) -> Result<Self> {
        let uniforms = Buffer::new(runner.device(), 1)?;
        let (means, overlay) = Default::default();
        Ok(Self { uniforms, shrink: ShrinkPass::new(runner)?, means, overlay })
    }

    /// Draws a region of the screen that lies at `place` of the layers.
    pub fn draw(
        &mut self,
        runner: &Runner,
        layers: &Layers<'_>,
        defines: &[Define<'_>],
        view: &View,
        place: &Place,
        (screen, region): (&Screen, Region),
    ) -> Result<()> {
        let size = layers.size.map(|side| side as f32);
        let smaller = place.pitch > 1.0;
        let coarse = layers.field.map_or([0.0; 2], |(field, _)| {
            let sides = [field.level_width(0), field.level_height(0)];
            if sides == layers.size { [0.0; 2] } else { [0, 1].map(|axis| sides[axis] as f32 / size[axis]) }
        });
        let fine = smaller && coarse == [0.0; 2];
        let single: [(_, _, Binding); 3] =
            [(layers.photo, smaller, PHOTO), (layers.picture, smaller, PICTURE), (layers.field, fine, FIELD)];
        let laid = layers.overlay.iter().enumerate().map(|(at, &layer)| (Some(layer), smaller, overlay::binding(at)));
        let means = self.means.iter_mut().chain(&mut self.overlay);
        // Those that are not there have their places all the same.
        for ((layer, shrinks, binding), means) in single.into_iter().chain(laid).zip(means) {
            let Some((texture, stamp)) = layer else { continue };
            if shrinks {
                self.shrink.draw(runner, (texture, stamp), place, means)?.bind(binding);
            } else {
                texture.bind(binding);
            }
        }
        let (rows, corner) = (screen.size()[1] as f32, [region.x as f32, region.y as f32]);
        self.uniforms.store(&[View { rows, size, corner, means: smaller.into(), coarse, ..*view }])?;
        self.uniforms.bind_uniform(PASS);
        runner.draw_screen("view.frag", defines, screen, region)
    }

    /// Frees the means.
    pub fn unload(&mut self) {
        (self.means, self.overlay) = Default::default();
    }
}
