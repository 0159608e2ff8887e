//! The photo with its glare, or the glare alone.

use bytemuck::{Pod, Zeroable};

use super::field::Source;
use super::layout::{Binding, OVERLAY_LAYERS, PASS, PHOTO};
use super::overlay::{self, Overlay};
use super::resource::{Buffer, Scratch, Texel, Texture};
use super::runner::Runner;
use crate::{Error, Result};

/// The composite's uniforms; as in `composite.frag`.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct Composite {
    /// The field's unit, RGB.
    pub scale: [f32; 4],
    /// What is subtracted from the field, RGB.
    pub constant: [f32; 4],
    /// What a light keeps of itself, RGB.
    pub light_gain: [f32; 4],
    /// Weights of R, G, B in luminance, then the brightness from which on a pixel is a light.
    pub luminance: [f32; 4],
    /// What the normalised glare is multiplied by.
    pub strength: f32,
    /// A range of values that is no wider is rounding, and no contrast to stretch.
    pub flat: f32,
    /// A soft threshold, and how far about it is the transition.
    pub knee: [f32; 2],
    /// What each layer that is laid over the photo is multiplied by, RGB.
    pub overlay: [[f32; 4]; OVERLAY_LAYERS],
}
const _: () = assert!(size_of::<Composite>() == 144);

/// What the composite's shader is specialised with: what it leaves out costs nothing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Variant {
    /// Where the field comes from.
    pub source: Source,
    /// One of `NORMALIZE_NONE` and so on in [`super::layout`].
    pub normalize: Binding,
    /// Whether the photo's lights are multiplied by `light_gain`.
    pub take_light: bool,
    /// By a soft threshold.
    pub soft: bool,
    /// Whether the photo's colours are not multiplied by alpha, which tells its lights.
    pub straight: bool,
    /// Whether its lights are told by the brightest channel instead of by luminance.
    pub brightest: bool,
    /// How many layers are laid over the photo; 0, or as many as are loaded.
    pub layers: usize,
}

impl Variant {
    fn defines(self) -> Vec<(&'static str, &'static str)> {
        let mut defines = self.source.defines();
        defines.push(("NORMALIZE", self.normalize.0));
        defines.extend(overlay::defines(self.layers));
        if self.take_light {
            defines.push(("TAKE_LIGHT", "1"));
            if self.soft {
                defines.push(("SOFT", "1"));
            }
            if self.straight {
                defines.push(("STRAIGHT", "1"));
            }
            if self.brightest {
                defines.push(("BRIGHTEST", "1"));
            }
        }
        defines
    }
}

/// Draws the picture.
pub(crate) struct CompositePass {
    photo: Scratch,
    picture: Scratch,
    /// How often each of the two was drawn or filled.
    stamps: [u64; 2],
    uniforms: Buffer<Composite>,
    /// What is laid over the photo, of a picture that is one tile.
    pub overlay: Overlay,
}

impl CompositePass {
    pub fn new(runner: &Runner) -> Result<Self> {
        Ok(Self {
            photo: Scratch::default(),
            picture: Scratch::default(),
            stamps: [0; 2],
            uniforms: Buffer::new(runner.device(), 1)?,
            overlay: Overlay::default(),
        })
    }

    /// A tile of the photo on the device, to be filled and then composited.
    pub fn photo(&mut self, runner: &Runner, width: u32, height: u32) -> Result<&Texture> {
        self.stamps[0] += 1;
        self.photo.get(runner.device(), Texel::Rgba, width, height)
    }

    /// Frees the photo and what was drawn.
    pub fn unload(&mut self) {
        self.photo = Scratch::default();
        self.picture = Scratch::default();
        self.overlay.unload();
    }

    /// The tile of the photo as it was last made.
    pub fn loaded(&self) -> Result<&Texture> {
        self.photo.current().ok_or_else(|| Error::Gl("no photo is loaded".into()))
    }

    /// The photo's columns and rows.
    pub fn size(&self) -> Result<[u32; 2]> {
        self.loaded().map(|photo| [photo.level_width(0), photo.level_height(0)])
    }

    /// What was last drawn.
    pub fn drawn(&self) -> Result<&Texture> {
        self.picture.current().ok_or_else(|| Error::Gl("nothing is drawn".into()))
    }

    /// What tells the photo, and what was last drawn, from any others before.
    pub fn stamps(&self) -> [u64; 2] {
        self.stamps
    }

    /// The tile that [`CompositePass::photo`] holds, with its glare.
    pub fn draw(&mut self, runner: &Runner, variant: Variant, settings: &Composite) -> Result<&Texture> {
        self.stamps[1] += 1;
        let photo = self.loaded()?;
        photo.bind(PHOTO);
        self.overlay.bind();
        let (width, height) = (photo.level_width(0), photo.level_height(0));
        Self::run(&mut self.picture, &mut self.uniforms, runner, &variant.defines(), settings, [width, height])
    }

    /// What [`CompositePass::draw`] would add to the photo.
    pub fn draw_glare(
        &mut self,
        runner: &Runner,
        variant: Variant,
        settings: &Composite,
        size: [u32; 2],
    ) -> Result<&Texture> {
        let mut defines = variant.defines();
        defines.push(("GLARE_ALONE", "1"));
        self.stamps[1] += 1;
        self.overlay.bind();
        Self::run(&mut self.picture, &mut self.uniforms, runner, &defines, settings, size)
    }

    fn run<'a>(
        picture: &'a mut Scratch,
        uniforms: &mut Buffer<Composite>,
        runner: &Runner,
        defines: &[(&str, &str)],
        settings: &Composite,
        size: [u32; 2],
    ) -> Result<&'a Texture> {
        uniforms.store(&[*settings])?;
        uniforms.bind_uniform(PASS);
        let picture = picture.get(runner.device(), Texel::Rgba, size[0], size[1])?;
        runner.draw("composite.frag", defines, picture, 0)?;
        Ok(picture)
    }
}
