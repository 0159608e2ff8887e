//! The kinds of GL object that vglare uses. Each frees itself, and keeps the device alive until then.

use std::rc::Rc;

use glow::HasContext as _;

use super::context::Device;
use crate::{Error, Result};

mod buffer;
mod texture;

pub(super) use buffer::Attribute;
pub(crate) use buffer::Buffer;
pub(crate) use texture::{Scratch, Texel, Texture};

fn refused(what: &str) -> impl FnOnce(String) -> Error {
    move |reason| Error::Gl(format!("{what}: {reason}"))
}

/// The empty vertex array that core profiles want bound for a draw call.
pub(crate) struct Triangle {
    device: Rc<Device>,
    raw: glow::VertexArray,
}

impl Triangle {
    pub fn new(device: &Rc<Device>) -> Result<Self> {
        // SAFETY: the device keeps its context current on this thread.
        let raw = unsafe { device.gl().create_vertex_array() }.map_err(refused("vertex array"))?;
        Ok(Self { device: device.clone(), raw })
    }

    /// Runs the current program's fragment shader once for each texel of the current target.
    pub fn draw(&self) {
        let gl = self.device.gl();
        // SAFETY: the device keeps its context current on this thread; the array has no attributes, so that nothing is read.
        unsafe {
            gl.bind_vertex_array(Some(self.raw));
            gl.draw_arrays(glow::TRIANGLES, 0, 3);
        }
    }
}

impl Drop for Triangle {
    fn drop(&mut self) {
        if let Some(gl) = self.device.to_free() {
            // SAFETY: the device's context is there and current, and nothing uses what is freed from here on.
            unsafe { gl.delete_vertex_array(self.raw) }
        }
    }
}
