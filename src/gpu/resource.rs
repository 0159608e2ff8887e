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

/// What a draw call reads its vertices by.
pub(super) struct VertexArray {
    device: Rc<Device>,
    raw: glow::VertexArray,
}

impl VertexArray {
    /// One without attributes.
    ///
    /// # Errors
    /// [`Error::Gl`] where the driver refuses.
    pub fn new(device: &Rc<Device>) -> Result<Self> {
        // SAFETY: the device keeps its context current on this thread.
        let raw = unsafe { device.gl().create_vertex_array() }.map_err(refused("vertex array"))?;
        Ok(Self { device: device.clone(), raw })
    }

    /// Makes it what draw calls and attributes are of.
    pub fn bind(&self) {
        // SAFETY: the device keeps its context current on this thread, and the array is its own.
        unsafe { self.device.gl().bind_vertex_array(Some(self.raw)) }
    }
}

impl Drop for VertexArray {
    fn drop(&mut self) {
        if let Some(gl) = self.device.to_free() {
            // SAFETY: the device's context is there and current, and nothing uses what is freed from here on.
            unsafe { gl.delete_vertex_array(self.raw) }
        }
    }
}

/// The empty vertex array that core profiles want bound for a draw call.
pub(crate) struct Triangle(VertexArray);

impl Triangle {
    pub fn new(device: &Rc<Device>) -> Result<Self> {
        VertexArray::new(device).map(Self)
    }

    /// Runs the current program's fragment shader once for each texel of the current target.
    pub fn draw(&self) {
        self.0.bind();
        // SAFETY: the device keeps its context current on this thread; the array has no attributes, so that nothing is read.
        unsafe { self.0.device.gl().draw_arrays(glow::TRIANGLES, 0, 3) }
    }
}
