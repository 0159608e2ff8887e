//! egui's shapes, by egui's own painter, which shares the device with the passes.
//!
//! Neither may see what the other left behind. The passes set what they depend on where they choose their target; the
//! painter does so too, but for what is set here before and after it.

use std::rc::Rc;

use glow::HasContext as _;

use super::context::Device;
use super::screen::Screen;
use crate::{Error, Result};

/// Paints what egui made of a frame.
pub(crate) struct Painter {
    device: Rc<Device>,
    painter: egui_glow::Painter,
}

impl Painter {
    /// A painter on a device.
    ///
    /// # Errors
    /// [`Error::Gl`] where the driver refuses.
    pub fn new(device: &Rc<Device>) -> Result<Self> {
        let painter = egui_glow::Painter::new(device.shared_gl(), "", None, false)
            .map_err(|error| Error::Gl(format!("the painter of the window: {error}")))?;
        Ok(Self { device: device.clone(), painter })
    }

    /// What it paints on.
    pub fn device(&self) -> &Device {
        &self.device
    }

    /// Lays shapes over what is on the screen.
    pub fn paint(
        &mut self,
        screen: &Screen,
        pixels_per_point: f32,
        shapes: &[egui::ClippedPrimitive],
        textures: &mut egui::TexturesDelta,
    ) {
        let gl = self.device.gl();
        screen.target(screen.whole());
        // SAFETY: the device keeps its context current on this thread, and what is bound is its own.
        unsafe {
            // A pixel buffer that is bound would be taken for the source of the painter's textures.
            gl.bind_buffer(glow::PIXEL_UNPACK_BUFFER, None);
            gl.pixel_store_i32(glow::UNPACK_ROW_LENGTH, 0);
            gl.active_texture(glow::TEXTURE0);
        }
        self.painter.paint_and_update_textures(screen.size(), pixels_per_point, shapes, textures);
        // SAFETY: the device keeps its context current on this thread, and numbers are all that it is given.
        unsafe {
            gl.disable(glow::SCISSOR_TEST);
            gl.disable(glow::BLEND);
            // Its rows of bytes are packed; rows of floats are whole words either way.
            gl.pixel_store_i32(glow::UNPACK_ALIGNMENT, 4);
        }
    }

    /// Takes egui's fonts as they are, for a painter that has not seen them made.
    pub fn set_fonts(&mut self, image: egui::ColorImage) {
        // SAFETY: the device keeps its context current on this thread, and what is bound is its own.
        unsafe {
            self.device.gl().bind_buffer(glow::PIXEL_UNPACK_BUFFER, None);
            self.device.gl().active_texture(glow::TEXTURE0);
        }
        let options = egui::epaint::TextureAtlas::texture_options();
        let image = egui::epaint::ImageDelta::full(image, options);
        self.painter.set_texture(egui::TextureId::default(), &image);
    }

    /// The largest side of a texture that the painter can take.
    pub fn max_texture_side(&self) -> usize {
        self.painter.max_texture_side()
    }
}

impl Drop for Painter {
    fn drop(&mut self) {
        if self.device.to_free().is_some() {
            self.painter.destroy();
        }
    }
}
