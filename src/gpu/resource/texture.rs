//! Textures, as they are drawn into, filled and read back.

use std::rc::Rc;

use glow::{HasContext as _, PixelPackData, PixelUnpackData};

use super::refused;
use crate::gpu::context::Device;
use crate::gpu::layout::{Binding, WORKBENCH};
use crate::gpu::pixels::PixelBuffer;
use crate::{Error, Result, limits};

/// What a texture's texels are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Texel {
    /// Two f32.
    Rg,
    /// Four f32.
    Rgba,
}

impl Texel {
    fn internal_format(self) -> u32 {
        match self {
            Self::Rg => glow::RG32F,
            Self::Rgba => glow::RGBA32F,
        }
    }

    fn format(self) -> u32 {
        match self {
            Self::Rg => glow::RG,
            Self::Rgba => glow::RGBA,
        }
    }

    fn channels(self) -> usize {
        match self {
            Self::Rg => 2,
            Self::Rgba => 4,
        }
    }
}

/// A texture without filtering, each of its levels with a framebuffer to draw into.
///
/// Row 0 is the picture's top row throughout vglare: textures are filled, drawn and read top row first, and each
/// row's place on the picture plane comes from [`crate::frame::Frame`]. Nothing is ever flipped off screen.
pub(crate) struct Texture {
    device: Rc<Device>,
    raw: glow::Texture,
    framebuffers: Vec<glow::Framebuffer>,
    texel: Texel,
    width: u32,
    height: u32,
}

impl Texture {
    /// A texture of one level.
    pub fn new(device: &Rc<Device>, texel: Texel, width: u32, height: u32) -> Result<Self> {
        Self::with_levels(device, texel, width, height, 1)
    }

    /// A texture whose sides are halved, rounded down, from each of its `levels` to the next.
    ///
    /// # Errors
    /// [`Error::Gl`] where the driver cannot hold it.
    pub fn with_levels(device: &Rc<Device>, texel: Texel, width: u32, height: u32, levels: u32) -> Result<Self> {
        let most = device.info().limits.texture_size;
        if width == 0 || height == 0 || width > most || height > most {
            return Err(Error::Gl(format!("a texture of {width}x{height} is not within 1 to {most}")));
        }
        // The smaller levels add a third.
        let bytes = (16 * u64::from(width) * u64::from(height)).saturating_mul(if levels > 1 { 4 } else { 3 }) / 3;
        limits::room(bytes, "a texture")?;
        let gl = device.gl();
        // SAFETY: the device keeps its context current on this thread.
        let raw = unsafe { gl.create_texture() }.map_err(refused("texture"))?;
        // Whole before anything can fail, so that an early return frees what there is.
        let mut texture = Self { device: device.clone(), raw, framebuffers: Vec::new(), texel, width, height };
        texture.bind(WORKBENCH);
        // SAFETY: the device keeps its context current on this thread, and numbers are all that it is given.
        unsafe {
            for (name, value) in [
                (glow::TEXTURE_MIN_FILTER, glow::NEAREST_MIPMAP_NEAREST),
                (glow::TEXTURE_MAG_FILTER, glow::NEAREST),
                (glow::TEXTURE_WRAP_S, glow::CLAMP_TO_EDGE),
                (glow::TEXTURE_WRAP_T, glow::CLAMP_TO_EDGE),
            ] {
                gl.tex_parameter_i32(glow::TEXTURE_2D, name, value as i32);
            }
            gl.tex_storage_2d(glow::TEXTURE_2D, levels as i32, texel.internal_format(), width as i32, height as i32);
        }
        for level in 0..levels {
            // SAFETY: the device keeps its context current on this thread.
            let framebuffer = unsafe { gl.create_framebuffer() }.map_err(refused("framebuffer"))?;
            texture.framebuffers.push(framebuffer);
            // SAFETY: the device keeps its context current on this thread, and what is bound is its own.
            let status = unsafe {
                gl.bind_framebuffer(glow::FRAMEBUFFER, Some(framebuffer));
                let (target, attachment) = (glow::FRAMEBUFFER, glow::COLOR_ATTACHMENT0);
                gl.framebuffer_texture_2d(target, attachment, glow::TEXTURE_2D, Some(raw), level as i32);
                gl.check_framebuffer_status(glow::FRAMEBUFFER)
            };
            if status != glow::FRAMEBUFFER_COMPLETE {
                device.check(&format!("making a texture of {width}x{height}"))?;
                return Err(Error::Gl(format!(
                    "a {texel:?} texture of {width}x{height} cannot be drawn into: {status:#x}"
                )));
            }
        }
        Ok(texture)
    }

    /// Width of a level.
    pub fn level_width(&self, level: u32) -> u32 {
        (self.width >> level).max(1)
    }

    /// Height of a level.
    pub fn level_height(&self, level: u32) -> u32 {
        (self.height >> level).max(1)
    }

    /// Levels that there are.
    pub fn levels(&self) -> u32 {
        self.framebuffers.len() as u32
    }

    /// Whether the texture has this kind of texel and these sides.
    pub fn is(&self, texel: Texel, width: u32, height: u32) -> bool {
        (self.texel, self.width, self.height) == (texel, width, height)
    }

    /// Binds the texture to a unit.
    pub fn bind(&self, (_, unit): Binding) {
        let gl = self.device.gl();
        // SAFETY: the device keeps its context current on this thread, and what is bound is its own.
        unsafe {
            gl.active_texture(glow::TEXTURE0 + unit);
            gl.bind_texture(glow::TEXTURE_2D, Some(self.raw));
        }
    }

    /// Binds one level to a unit, as the only one that a shader can see: another may then be drawn into meanwhile.
    pub fn bind_level(&self, binding: Binding, level: u32) {
        self.bind(binding);
        let gl = self.device.gl();
        // SAFETY: the device keeps its context current on this thread, and numbers are all that it is given.
        unsafe {
            gl.tex_parameter_i32(glow::TEXTURE_2D, glow::TEXTURE_BASE_LEVEL, level as i32);
            gl.tex_parameter_i32(glow::TEXTURE_2D, glow::TEXTURE_MAX_LEVEL, level as i32);
        }
    }

    /// Sets every channel of level 0 to one value.
    pub fn clear(&self, value: f32) {
        self.fill([value; 4]);
    }

    /// Sets all texels of the first level to one.
    pub fn fill(&self, texel: [f32; 4]) {
        self.target(0);
        // SAFETY: the device keeps its context current on this thread, and a colour has four numbers.
        unsafe { self.device.gl().clear_buffer_f32_slice(glow::COLOR, 0, &texel) }
    }

    /// Makes a level the target of drawing, all of it. Sets all state that drawing depends on.
    pub fn target(&self, level: u32) {
        let gl = self.device.gl();
        // SAFETY: the device keeps its context current on this thread, and what is bound is its own.
        unsafe {
            gl.bind_framebuffer(glow::FRAMEBUFFER, Some(self.framebuffers[level as usize]));
            gl.viewport(0, 0, self.level_width(level) as i32, self.level_height(level) as i32);
            for capability in [glow::BLEND, glow::DEPTH_TEST, glow::SCISSOR_TEST, glow::CULL_FACE, glow::STENCIL_TEST] {
                gl.disable(capability);
            }
            gl.color_mask(true, true, true, true);
        }
    }

    /// Copies level 0 of a texture of the same kind to a place of this one, which has to hold it.
    pub fn place(&self, from: &Self, [x, y]: [u32; 2]) {
        assert!(self.texel == from.texel && x + from.width <= self.width && y + from.height <= self.height);
        self.target(0);
        let [x, y, width, height] = [x, y, from.width, from.height].map(|side| side as i32);
        let gl = self.device.gl();
        // SAFETY: the device keeps its context current on this thread, and the framebuffers are of textures of that device.
        unsafe {
            gl.bind_framebuffer(glow::READ_FRAMEBUFFER, Some(from.framebuffers[0]));
            let (colour, filter) = (glow::COLOR_BUFFER_BIT, glow::NEAREST);
            gl.blit_framebuffer(0, 0, width, height, x, y, x + width, y + height, colour, filter);
        }
    }

    /// Fills the top left of the texture from rows of `stride` RGBA pixels.
    pub fn write(&self, pixels: &[[f32; 4]], stride: usize, width: u32, height: u32) {
        assert!(pixels.len() >= (height as usize - 1) * stride + width as usize && width as usize <= stride);
        let gl = self.device.gl();
        // SAFETY: the device keeps its context current on this thread, no buffer is bound to read from, and the slice holds all
        // rows, as was asserted.
        unsafe {
            gl.bind_buffer(glow::PIXEL_UNPACK_BUFFER, None);
            gl.pixel_store_i32(glow::UNPACK_ROW_LENGTH, stride as i32);
            self.write_raw(PixelUnpackData::Slice(Some(bytemuck::cast_slice(pixels))), width, height);
            gl.pixel_store_i32(glow::UNPACK_ROW_LENGTH, 0);
        }
    }

    /// Fills the top left of the texture from rows of RGBA pixels in a buffer, some time from now.
    pub fn write_from(&self, buffer: &PixelBuffer, width: u32, height: u32) {
        buffer.unpack(|| self.write_raw(PixelUnpackData::BufferOffset(0), width, height));
    }

    fn write_raw(&self, pixels: PixelUnpackData<'_>, width: u32, height: u32) {
        assert_eq!(self.texel, Texel::Rgba);
        let (width, height) = (width as i32, height as i32);
        self.bind(WORKBENCH);
        let (target, format) = (glow::TEXTURE_2D, glow::RGBA);
        // SAFETY: the device keeps its context current on this thread; the callers give a slice that holds all rows, or
        // a buffer that does.
        unsafe { self.device.gl().tex_sub_image_2d(target, 0, 0, 0, width, height, format, glow::FLOAT, pixels) }
    }

    /// Reads the top left of level 0 into rows of `stride` RGBA pixels, after waiting for the device.
    pub fn read(&self, pixels: &mut [[f32; 4]], stride: usize, width: u32, height: u32) {
        assert_eq!(self.texel, Texel::Rgba);
        assert!(pixels.len() >= (height as usize - 1) * stride + width as usize && width as usize <= stride);
        let gl = self.device.gl();
        // SAFETY: the device keeps its context current on this thread, no buffer is bound to read into, and the slice has room
        // for all rows, as was asserted.
        unsafe {
            gl.bind_buffer(glow::PIXEL_PACK_BUFFER, None);
            gl.pixel_store_i32(glow::PACK_ROW_LENGTH, stride as i32);
            self.read_raw(0, PixelPackData::Slice(Some(bytemuck::cast_slice_mut(pixels))), width, height);
            gl.pixel_store_i32(glow::PACK_ROW_LENGTH, 0);
        }
    }

    /// One texel of level 0, after waiting for the device; it must be there.
    pub fn read_texel(&self, [x, y]: [u32; 2]) -> [f32; 4] {
        assert!(self.texel == Texel::Rgba && x < self.width && y < self.height);
        let mut texel = [[0.0f32; 4]];
        let gl = self.device.gl();
        // SAFETY: the device keeps its context current on this thread, no buffer is bound to read into, and the slice
        // holds the one texel.
        unsafe {
            gl.bind_buffer(glow::PIXEL_PACK_BUFFER, None);
            gl.bind_framebuffer(glow::FRAMEBUFFER, Some(self.framebuffers[0]));
            let into = PixelPackData::Slice(Some(bytemuck::cast_slice_mut(&mut texel)));
            gl.read_pixels(x as i32, y as i32, 1, 1, glow::RGBA, glow::FLOAT, into);
        }
        texel[0]
    }

    /// Reads the top left of level 0 into a buffer, some time from now.
    ///
    /// # Errors
    /// [`Error::Gl`] where the driver gives no memory.
    pub fn read_to(&self, buffer: &mut PixelBuffer, width: u32, height: u32) -> Result<()> {
        assert_eq!(self.texel, Texel::Rgba);
        buffer.pack(width, height, || self.read_raw(0, PixelPackData::BufferOffset(0), width, height))
    }

    /// A whole level, its channels one after the other, after waiting for the device.
    pub fn read_level(&self, level: u32) -> Vec<f32> {
        let (width, height) = (self.level_width(level), self.level_height(level));
        let mut values = vec![0.0; width as usize * height as usize * self.texel.channels()];
        // SAFETY: the device keeps its context current on this thread, and what is bound is its own.
        unsafe { self.device.gl().bind_buffer(glow::PIXEL_PACK_BUFFER, None) };
        self.read_raw(level, PixelPackData::Slice(Some(bytemuck::cast_slice_mut(&mut values))), width, height);
        values
    }

    fn read_raw(&self, level: u32, pixels: PixelPackData<'_>, width: u32, height: u32) {
        let gl = self.device.gl();
        let (width, height, format) = (width as i32, height as i32, self.texel.format());
        // SAFETY: the device keeps its context current on this thread; the callers give a slice with room for all rows,
        // or a buffer with it.
        unsafe {
            gl.bind_framebuffer(glow::FRAMEBUFFER, Some(self.framebuffers[level as usize]));
            gl.read_pixels(0, 0, width, height, format, glow::FLOAT, pixels);
        }
    }
}

impl Drop for Texture {
    fn drop(&mut self) {
        let Some(gl) = self.device.to_free() else { return };
        // SAFETY: the device's context is there and current, and nothing uses what is freed from here on.
        unsafe {
            for &framebuffer in &self.framebuffers {
                gl.delete_framebuffer(framebuffer);
            }
            gl.delete_texture(self.raw);
        }
    }
}

/// A texture that is made when it is first needed and again when its size changes.
#[derive(Default)]
pub(crate) struct Scratch(Option<Texture>);

impl Scratch {
    /// The texture, of this kind and size; its content is kept only while these stay.
    pub fn get(&mut self, device: &Rc<Device>, texel: Texel, width: u32, height: u32) -> Result<&Texture> {
        if !self.0.as_ref().is_some_and(|texture| texture.is(texel, width, height)) {
            // The old one is freed first, so that both never stand in memory together.
            self.0 = None;
            self.0 = Some(Texture::new(device, texel, width, height)?);
        }
        Ok(self.0.as_ref().expect("made above"))
    }

    /// The texture as it was last made.
    pub fn current(&self) -> Option<&Texture> {
        self.0.as_ref()
    }
}
