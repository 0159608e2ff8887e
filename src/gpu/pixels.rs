//! Pixel buffers: the driver's own memory, through which pixels go to a texture and come back from one while the device
//! does something else.

use std::rc::Rc;

use glow::HasContext as _;

use super::context::Device;
use crate::{Error, Result, limits};

/// How long one wait for a fence lasts, in nanoseconds, before the next one begins.
const PATIENCE: i32 = 1_000_000_000;

/// Memory of the driver for one tile of RGBA f32, on its way in or out.
pub(crate) struct PixelBuffer {
    device: Rc<Device>,
    raw: glow::Buffer,
    fence: Option<glow::Fence>,
}

impl PixelBuffer {
    /// A buffer that holds nothing yet.
    ///
    /// # Errors
    /// [`Error::Gl`] where the driver refuses.
    pub fn new(device: &Rc<Device>) -> Result<Self> {
        // SAFETY: the device keeps its context current on this thread.
        let raw = unsafe { device.gl().create_buffer() }.map_err(|reason| Error::Gl(format!("buffer: {reason}")))?;
        Ok(Self { device: device.clone(), raw, fence: None })
    }

    /// Copies rows of `stride` pixels into the buffer, for a texture to take.
    ///
    /// # Errors
    /// [`Error::Gl`] where the driver gives no memory.
    pub fn fill(&mut self, pixels: &[[f32; 4]], stride: usize, width: u32, height: u32) -> Result<()> {
        let target = glow::PIXEL_UNPACK_BUFFER;
        self.renew(target, width, height, glow::STREAM_DRAW)?;
        let write = glow::MAP_WRITE_BIT | glow::MAP_INVALIDATE_BUFFER_BIT;
        self.mapped(target, width, height, write, |mapped| {
            for (to, from) in mapped.chunks_exact_mut(width as usize).zip(pixels.chunks(stride)) {
                to.copy_from_slice(&from[..width as usize]);
            }
        })
    }

    /// Lets `work` read what [`PixelBuffer::fill`] left; within it, offset 0 of the bound buffer is the first pixel.
    pub fn unpack(&self, work: impl FnOnce()) {
        let gl = self.device.gl();
        // SAFETY: the device keeps its context current on this thread, and what is bound is its own.
        unsafe { gl.bind_buffer(glow::PIXEL_UNPACK_BUFFER, Some(self.raw)) };
        work();
        // SAFETY: the device keeps its context current on this thread, and what is bound is its own.
        unsafe { gl.bind_buffer(glow::PIXEL_UNPACK_BUFFER, None) };
    }

    /// Lets `work` ask the device to write a tile into the buffer, from offset 0 on, and marks when that is done.
    ///
    /// # Errors
    /// [`Error::Gl`] where the driver gives no memory or no fence.
    pub fn pack(&mut self, width: u32, height: u32, work: impl FnOnce()) -> Result<()> {
        self.renew(glow::PIXEL_PACK_BUFFER, width, height, glow::STREAM_READ)?;
        let gl = self.device.gl();
        work();
        // SAFETY: the device keeps its context current on this thread.
        let fence = unsafe {
            gl.bind_buffer(glow::PIXEL_PACK_BUFFER, None);
            let fence = gl.fence_sync(glow::SYNC_GPU_COMMANDS_COMPLETE, 0);
            // What is only queued would not be done while the CPU is busy elsewhere.
            gl.flush();
            fence
        };
        self.forget();
        self.fence = Some(fence.map_err(|reason| Error::Gl(format!("fence: {reason}")))?);
        Ok(())
    }

    /// Waits for what [`PixelBuffer::pack`] asked for, and copies it into rows of `stride` pixels.
    ///
    /// # Errors
    /// [`Error::Gl`] where the device fails meanwhile.
    pub fn drain(&mut self, pixels: &mut [[f32; 4]], stride: usize, width: u32, height: u32) -> Result<()> {
        self.wait()?;
        let target = glow::PIXEL_PACK_BUFFER;
        // SAFETY: the device keeps its context current on this thread, and what is bound is its own.
        unsafe { self.device.gl().bind_buffer(target, Some(self.raw)) };
        self.mapped(target, width, height, glow::MAP_READ_BIT, |mapped| {
            for (from, to) in mapped.chunks_exact(width as usize).zip(pixels.chunks_mut(stride)) {
                to[..width as usize].copy_from_slice(from);
            }
        })
    }

    /// Binds the buffer with new memory, so that nothing waits until the device has done with the old.
    fn renew(&self, target: u32, width: u32, height: u32, usage: u32) -> Result<()> {
        let bytes = bytes(width, height)?;
        limits::room(bytes as u64, "a tile of pixels")?;
        let gl = self.device.gl();
        // SAFETY: the device keeps its context current on this thread, and the buffer is its own.
        unsafe {
            gl.bind_buffer(target, Some(self.raw));
            gl.buffer_data_size(target, bytes, usage);
        }
        Ok(())
    }

    /// Lets `work` at the memory of the buffer that is bound, and unbinds it.
    fn mapped(
        &self,
        target: u32,
        width: u32,
        height: u32,
        access: u32,
        work: impl FnOnce(&mut [[f32; 4]]),
    ) -> Result<()> {
        let bytes = bytes(width, height)?;
        let gl = self.device.gl();
        // SAFETY: the device keeps its context current on this thread; GL gives null where the buffer that is bound has fewer
        // bytes.
        let memory = unsafe { gl.map_buffer_range(target, 0, bytes, access) };
        if !memory.is_null() {
            let pixels = width as usize * height as usize;
            // SAFETY: the mapped memory holds as many pixels, GL 4.2 and later align it to 64 bytes, and any bits are an f32.
            // Nothing else has it until it is unmapped; `drain` only reads what it maps for reading, and `fill` only writes
            // what it maps for writing.
            work(unsafe { std::slice::from_raw_parts_mut(memory.cast(), pixels) });
            // SAFETY: the buffer is bound and mapped, and nobody keeps the memory.
            unsafe { gl.unmap_buffer(target) };
        }
        // SAFETY: the device keeps its context current on this thread, and what is bound is its own.
        unsafe { gl.bind_buffer(target, None) };
        if memory.is_null() { Err(Error::Gl("the driver gives no memory for pixels".into())) } else { Ok(()) }
    }

    fn wait(&mut self) -> Result<()> {
        let Some(fence) = self.fence else { return Ok(()) };
        let gl = self.device.gl();
        let done = loop {
            // SAFETY: the device keeps its context current on this thread, and the fence is not deleted yet.
            match unsafe { gl.client_wait_sync(fence, glow::SYNC_FLUSH_COMMANDS_BIT, PATIENCE) } {
                glow::TIMEOUT_EXPIRED => {}
                other => break other != glow::WAIT_FAILED,
            }
        };
        self.forget();
        if done { Ok(()) } else { Err(Error::Gl("the wait for the picture failed".into())) }
    }

    fn forget(&mut self) {
        if let (Some(fence), Some(gl)) = (self.fence.take(), self.device.to_free()) {
            // SAFETY: the device's context is there and current, and nothing uses what is freed from here on.
            unsafe { gl.delete_sync(fence) }
        }
    }
}

/// What a tile takes.
fn bytes(width: u32, height: u32) -> Result<i32> {
    i32::try_from(u64::from(width) * u64::from(height) * size_of::<[f32; 4]>() as u64)
        .map_err(|_| Error::Gl(format!("a pixel buffer of {width}x{height} is beyond 2 GiB")))
}

impl Drop for PixelBuffer {
    fn drop(&mut self) {
        self.forget();
        if let Some(gl) = self.device.to_free() {
            // SAFETY: the device's context is there and current, and nothing uses what is freed from here on.
            unsafe { gl.delete_buffer(self.raw) }
        }
    }
}
