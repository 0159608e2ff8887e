//! What a person looks at: a window's own framebuffer, or one of the same kind without a window.
//!
//! Here alone rows count from the bottom, as GL counts a window's. [`Region`] counts from the top, like all else.

use std::rc::Rc;

use glow::{HasContext as _, PixelPackData};

use super::context::Device;
use super::layout::WORKBENCH;
use crate::{Error, Result};

/// A rectangle of the screen's pixels, counted from its top left.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Region {
    /// Its first column.
    pub x: u32,
    /// Its top row.
    pub y: u32,
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
}

/// A framebuffer of 8-bit RGBA.
pub struct Screen {
    device: Rc<Device>,
    own: Option<(glow::Framebuffer, glow::Texture)>,
    size: [u32; 2],
}

impl Screen {
    /// That of the device's window, of `size` pixels.
    pub fn of_window(device: &Rc<Device>, size: [u32; 2]) -> Self {
        Self { device: device.clone(), own: None, size }
    }

    /// One of `size` pixels that nobody sees.
    ///
    /// # Errors
    /// [`Error::Gl`] where the driver refuses.
    pub fn hidden(device: &Rc<Device>, size: [u32; 2]) -> Result<Self> {
        let most = device.info().limits.texture_size;
        if size.iter().any(|side| !(1..=most).contains(side)) {
            return Err(Error::Gl(format!("a screen of {}x{} is not within 1 to {most}", size[0], size[1])));
        }
        let refused = |reason| Error::Gl(format!("screen: {reason}"));
        let gl = device.gl();
        // SAFETY: the device keeps its context current on this thread.
        let texture = unsafe { gl.create_texture() }.map_err(refused)?;
        // SAFETY: the device keeps its context current on this thread, and the texture is its own.
        let framebuffer =
            unsafe { gl.create_framebuffer().inspect_err(|_| gl.delete_texture(texture)) }.map_err(refused)?;
        let (width, height) = (size[0] as i32, size[1] as i32);
        // SAFETY: the device keeps its context current on this thread, and what is bound is its own.
        let status = unsafe {
            gl.active_texture(glow::TEXTURE0 + WORKBENCH.1);
            gl.bind_texture(glow::TEXTURE_2D, Some(texture));
            gl.tex_storage_2d(glow::TEXTURE_2D, 1, glow::RGBA8, width, height);
            gl.bind_framebuffer(glow::FRAMEBUFFER, Some(framebuffer));
            let (target, attachment) = (glow::FRAMEBUFFER, glow::COLOR_ATTACHMENT0);
            gl.framebuffer_texture_2d(target, attachment, glow::TEXTURE_2D, Some(texture), 0);
            gl.check_framebuffer_status(glow::FRAMEBUFFER)
        };
        let screen = Self { device: device.clone(), own: Some((framebuffer, texture)), size };
        match status {
            glow::FRAMEBUFFER_COMPLETE => Ok(screen),
            other => Err(Error::Gl(format!("a screen of {width}x{height} cannot be drawn into: {other:#x}"))),
        }
    }

    /// Columns and rows.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Takes note of the window's new size.
    pub fn set_size(&mut self, size: [u32; 2]) {
        self.size = size;
    }

    /// Makes a region the target of drawing. Sets all state that drawing depends on: nothing that another painter left
    /// behind matters, and fragments are counted from the bottom left of the screen.
    pub(in crate::gpu) fn target(&self, region: Region) {
        let gl = self.device.gl();
        let bottom = self.size[1] as i32 - (region.y + region.height) as i32;
        let (x, width, height) = (region.x as i32, region.width as i32, region.height as i32);
        // SAFETY: the device keeps its context current on this thread, and what is bound is its own.
        unsafe {
            gl.bind_framebuffer(glow::FRAMEBUFFER, self.own.map(|(framebuffer, _)| framebuffer));
            gl.viewport(x, bottom, width, height);
            for capability in [
                glow::BLEND,
                glow::DEPTH_TEST,
                glow::SCISSOR_TEST,
                glow::CULL_FACE,
                glow::STENCIL_TEST,
                glow::FRAMEBUFFER_SRGB,
            ] {
                gl.disable(capability);
            }
            gl.color_mask(true, true, true, true);
        }
    }

    /// All of it.
    pub fn whole(&self) -> Region {
        Region { x: 0, y: 0, width: self.size[0], height: self.size[1] }
    }

    /// Fills the screen with a colour as it is shown, 0 to 1.
    pub fn clear(&self, [red, green, blue]: [f32; 3]) {
        self.target(self.whole());
        let gl = self.device.gl();
        // SAFETY: the device keeps its context current on this thread, and a colour has four numbers.
        unsafe { gl.clear_buffer_f32_slice(glow::COLOR, 0, &[red, green, blue, 1.0]) }
    }

    /// Copies all of it to a region of another screen; the two are of one size.
    pub fn copy_to(&self, screen: &Self, region: Region) {
        screen.target(region);
        let (left, right) = (region.x as i32, (region.x + region.width) as i32);
        let bottom = screen.size[1] as i32 - (region.y + region.height) as i32;
        let top = bottom + region.height as i32;
        let [width, height] = self.size.map(|side| side as i32);
        let gl = self.device.gl();
        // SAFETY: the device keeps its context current on this thread, and what is bound is its own.
        unsafe {
            gl.bind_framebuffer(glow::READ_FRAMEBUFFER, self.own.map(|(framebuffer, _)| framebuffer));
            let (colour, filter) = (glow::COLOR_BUFFER_BIT, glow::NEAREST);
            gl.blit_framebuffer(0, 0, width, height, left, bottom, right, top, colour, filter);
        }
    }

    /// What is on the screen, row by row from the top, after waiting for the device.
    pub fn read(&self) -> Vec<[u8; 4]> {
        self.target(self.whole());
        let [width, height] = self.size;
        let mut pixels = vec![[0; 4]; width as usize * height as usize];
        let gl = self.device.gl();
        // SAFETY: the device keeps its context current on this thread, no buffer is bound to read into, and the slice
        // holds all of the screen's pixels.
        unsafe {
            gl.bind_buffer(glow::PIXEL_PACK_BUFFER, None);
            let bytes = bytemuck::cast_slice_mut(&mut pixels);
            let into = PixelPackData::Slice(Some(bytes));
            gl.read_pixels(0, 0, width as i32, height as i32, glow::RGBA, glow::UNSIGNED_BYTE, into);
        }
        let rows = pixels.chunks_exact(width.max(1) as usize).rev();
        rows.flatten().copied().collect()
    }
}

impl Drop for Screen {
    fn drop(&mut self) {
        if let (Some((framebuffer, texture)), Some(gl)) = (self.own, self.device.to_free()) {
            // SAFETY: the device's context is there and current, and nothing uses what is freed from here on.
            unsafe {
                gl.delete_framebuffer(framebuffer);
                gl.delete_texture(texture);
            }
        }
    }
}
