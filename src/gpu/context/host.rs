//! The context of a program that has one of its own: a host.

use std::rc::Rc;
use std::sync::Arc;

use glow::HasContext as _;

use super::{Backend, Device, Platform};
use crate::gpu::layout::LAST_UNIT;
use crate::{Error, Result};

/// Nothing to keep alive: the context is the host's.
struct Hosted;

impl Platform for Hosted {
    fn route(&self) -> String {
        "a host's context".into()
    }
}

/// Errors that a host has left behind, at most: GL keeps one of each kind, and a lost context tells its own for ever.
const ERRORS: usize = 16;
/// Clip distances that every driver has (`GL_MAX_CLIP_DISTANCES` is 8 at least).
const CLIP_DISTANCES: u32 = 8;

impl Device {
    /// A device on a context of the host, which is current on this thread. Opens nothing, and destroys nothing of the
    /// host's: what is made on the device is freed with it, and the context stays.
    ///
    /// What the passes draw with is set by themselves or by [`Device::settle`], and is not put back: the host sets what it
    /// depends on again before it draws, as it does beside any other painter.
    ///
    /// # Errors
    /// [`Error::NoContext`] where the context is one of OpenGL below 4.3, or of OpenGL ES.
    ///
    /// # Safety
    /// `gl` has the functions of the context that is current on this thread. That context stays so whenever the device, or
    /// anything made on it, is used or dropped; or, where it cannot, as after it was lost, [`Device::abandon`] is called
    /// before. And [`Device::settle`] is called whenever the host has drawn in between: pixels are read and written by how
    /// rows and buffers are said to lie, and memory beside them would be, where the host has said otherwise.
    pub unsafe fn adopt(gl: Arc<glow::Context>) -> Result<Rc<Self>> {
        let device = Self::new(gl, Backend::Host, Box::new(Hosted), None)
            .map_err(|reason| Error::NoContext { reasons: vec![format!("the host's context {reason}")] })?;
        device.settle();
        Ok(Rc::new(device))
    }

    /// Puts state of GL that passes rely on, without setting it each time, to what it is in a new context, and takes errors
    /// away that nobody has asked for. To be called whenever the host has drawn in between.
    pub fn settle(&self) {
        let gl = self.gl();
        // SAFETY: the device keeps its context current on this thread, and numbers of OpenGL 4.3 are all that it is given.
        unsafe {
            for _ in 0..ERRORS {
                if gl.get_error() == glow::NO_ERROR {
                    break;
                }
            }
            for target in [glow::PIXEL_PACK_BUFFER, glow::PIXEL_UNPACK_BUFFER] {
                gl.bind_buffer(target, None);
            }
            for (name, value) in [
                (glow::PACK_ALIGNMENT, 4),
                (glow::PACK_ROW_LENGTH, 0),
                (glow::PACK_SKIP_ROWS, 0),
                (glow::PACK_SKIP_PIXELS, 0),
                (glow::UNPACK_ALIGNMENT, 4),
                (glow::UNPACK_ROW_LENGTH, 0),
                (glow::UNPACK_SKIP_ROWS, 0),
                (glow::UNPACK_SKIP_PIXELS, 0),
                (glow::PACK_SWAP_BYTES, 0),
                (glow::UNPACK_SWAP_BYTES, 0),
            ] {
                gl.pixel_store_i32(name, value);
            }
            for unit in 0..=LAST_UNIT {
                gl.bind_sampler(unit, None);
            }
            for capability in [
                glow::COLOR_LOGIC_OP,
                glow::PRIMITIVE_RESTART,
                glow::RASTERIZER_DISCARD,
                glow::SAMPLE_ALPHA_TO_COVERAGE,
                glow::SAMPLE_ALPHA_TO_ONE,
                glow::SAMPLE_COVERAGE,
                glow::SAMPLE_MASK,
                glow::POLYGON_OFFSET_FILL,
            ] {
                gl.disable(capability);
            }
            for distance in 0..CLIP_DISTANCES {
                gl.disable(glow::CLIP_DISTANCE0 + distance);
            }
            gl.polygon_mode(glow::FRONT_AND_BACK, glow::FILL);
            gl.blend_equation(glow::FUNC_ADD);
        }
    }
}
