//! The photo with its glare: composited tile by tile, or drawn and left on the device.

use std::rc::Rc;

use super::exchange::Exchange;
use super::{Field, Pending, Settings, convert};
use crate::Result;
use crate::choices::Normalize;
use crate::frame::Frame;
use crate::gpu::Device;
use crate::gpu::composite::{Composite, CompositePass};
use crate::gpu::copy::CopyPass;

/// Lays a field's glare over photos.
pub struct Picture {
    /// The field whose glare it is.
    pub field: Field,
    pub(super) composite: CompositePass,
    copy: CopyPass,
    pub(super) exchange: Exchange,
}

impl Picture {
    /// A picture whose field has no scene.
    ///
    /// # Errors
    /// [`Error::Gl`](crate::Error::Gl) where the driver refuses an object.
    pub fn new(device: &Rc<Device>) -> Result<Self> {
        let field = Field::new(device)?;
        Ok(Self {
            composite: CompositePass::new(&field.runner)?,
            copy: CopyPass::default(),
            // The software renderer's memory is the photo's own: there a buffer is one more copy.
            exchange: Exchange::new(!device.info().software),
            field,
        })
    }

    /// Adds the glare to the pixels of the frame's window, row by row from the top.
    ///
    /// # Errors
    /// [`Error::Gl`](crate::Error::Gl) where the driver refuses, or where there is no scene.
    pub fn composite(&mut self, frame: Frame, pixels: &mut [[f32; 4]], settings: &Settings) -> Result<()> {
        let pending = self.submit(frame, pixels, settings)?;
        self.collect(pending, pixels)
    }

    /// Begins what [`Picture::composite`] does. Until [`Picture::collect`] has been given the same pixels, some of
    /// them may still be without glare: with pixel buffers, the last tile is on its way while the CPU goes on.
    ///
    /// # Errors
    /// [`Error::Gl`](crate::Error::Gl) where the driver refuses, or where there is no scene.
    pub fn submit(&mut self, frame: Frame, pixels: &mut [[f32; 4]], settings: &Settings) -> Result<Pending> {
        let uniforms = self.start(frame, settings)?;
        assert_eq!(pixels.len(), frame.window.pixels(), "as many pixels as the window has");
        let mut pending = Pending::default();
        for tile in self.field.tiles(frame) {
            let source = self.field.evaluate(frame, tile)?;
            self.upload(frame, tile, pixels)?;
            self.composite.draw(&self.field.runner, convert::variant(source, settings, 0), &uniforms)?;
            // The tile before this one has come back while this one was drawn.
            let before = std::mem::replace(&mut pending, self.read_back(frame, tile, pixels)?);
            self.collect(before, pixels)?;
            self.field.runner.device().check("compositing")?;
        }
        Ok(pending)
    }

    /// Draws the loaded photo with its glare and leaves the picture on the device. Does not wait for it.
    ///
    /// # Errors
    /// [`Error::Gl`](crate::Error::Gl) where the driver refuses, or where there is no scene.
    pub fn draw(&mut self, frame: Frame, settings: &Settings) -> Result<()> {
        let uniforms = self.start(frame, settings)?;
        let source = self.field.whole(frame)?;
        let variant = convert::variant(source, settings, self.layers(settings));
        self.composite.draw(&self.field.runner, variant, &uniforms)?;
        Ok(())
    }

    /// Copies the loaded photo on the device, and nothing else: the yardstick of the benches.
    ///
    /// # Errors
    /// [`Error::Gl`](crate::Error::Gl) where no photo is loaded, or the driver refuses.
    pub fn draw_copy(&mut self) -> Result<()> {
        self.copy.draw(&self.field.runner, self.composite.loaded()?)
    }

    /// The glare alone, as [`Picture::composite`] would add it, row by row from the top; alpha is 1.
    ///
    /// # Errors
    /// [`Error::Gl`](crate::Error::Gl) where the driver refuses, or where there is no scene.
    pub fn glare(&mut self, frame: Frame, settings: &Settings) -> Result<Vec<[f32; 4]>> {
        let uniforms = self.start(frame, settings)?;
        let stride = frame.window.width as usize;
        let mut pixels = vec![[0.0; 4]; frame.window.pixels()];
        for tile in self.field.tiles(frame) {
            let source = self.field.evaluate(frame, tile)?;
            let size = [tile.width, tile.height];
            let glare = self.composite.draw_glare(
                &self.field.runner,
                convert::variant(source, settings, 0),
                &uniforms,
                size,
            )?;
            let at = super::offset(frame.window, tile);
            self.field.runner.run("readback", || glare.read(&mut pixels[at..], stride, tile.width, tile.height));
            self.field.runner.device().check("drawing the glare")?;
        }
        Ok(pixels)
    }

    /// Draws the glare alone and leaves it on the device in the picture's place. Does not wait for it.
    ///
    /// # Errors
    /// [`crate::Error::Gl`] where the driver refuses, or where there is no scene.
    pub fn draw_glare(&mut self, frame: Frame, settings: &Settings) -> Result<()> {
        let uniforms = self.start(frame, settings)?;
        let source = self.field.whole(frame)?;
        let size = [frame.window.width, frame.window.height];
        let variant = convert::variant(source, settings, self.layers(settings));
        self.composite.draw_glare(&self.field.runner, variant, &uniforms, size)?;
        Ok(())
    }

    /// Takes layers of the size of the loaded photo, at most four, each row by row from the top, in place of those before. What
    /// is drawn and left on the device, or viewed, has them added, each multiplied by its factor in [`Settings::overlay`]: the
    /// picture and the glare alike. What is composited for the CPU has not.
    ///
    /// # Errors
    /// [`Error::Gl`](crate::Error::Gl) where no photo is loaded, or the driver refuses; there are none then.
    ///
    /// # Panics
    /// If there are too many, or one is of another size.
    pub fn lay_over(&mut self, layers: &[Vec<[f32; 4]>]) -> Result<()> {
        let size = self.composite.size()?;
        let pixels = size[0] as usize * size[1] as usize;
        assert!(layers.iter().all(|layer| layer.len() == pixels), "as many pixels as the photo has");
        self.composite.overlay.load(&self.field.runner, size, layers)
    }

    /// How many layers are laid over what is drawn.
    pub(super) fn layers(&self, settings: &Settings) -> usize {
        if settings.overlay == [[0.0; 3]; 4] { 0 } else { self.composite.overlay.layers().len() }
    }

    /// A pixel of the photo and of what was drawn last, linear; none where it is not on the device.
    pub fn pixel(&self, column: u32, row: u32) -> Option<[[f32; 4]; 2]> {
        let (photo, picture) = (self.composite.loaded().ok()?, self.composite.drawn().ok()?);
        let there = |width: u32, height: u32| column < width && row < height;
        let both = [photo, picture].iter().all(|texture| there(texture.level_width(0), texture.level_height(0)));
        both.then(|| [photo, picture].map(|texture| texture.read_texel([column, row])))
    }

    /// Forgets the photo, what is laid over it, and the picture on the device.
    pub fn unload(&mut self) {
        self.composite.unload();
    }

    /// Finds the range where the settings ask for it, and gives the composite's uniforms.
    pub(super) fn start(&mut self, frame: Frame, settings: &Settings) -> Result<Composite> {
        let plan = self.field.plan()?;
        settings.check(plan.scale)?;
        let uniforms = convert::uniforms(plan, settings);
        match settings.range {
            Some(range) if settings.normalize == Normalize::Minmax => self.field.set_range(range),
            None if settings.normalize == Normalize::Minmax => self.field.reduce(frame)?,
            _ => {}
        }
        self.field.range.bind();
        Ok(uniforms)
    }
}
