//! Buffers for what shaders read and write.

use std::marker::PhantomData;
use std::rc::Rc;

use bytemuck::Pod;
use glow::HasContext as _;

use super::refused;
use crate::gpu::context::Device;
use crate::gpu::layout::Binding;
use crate::{Error, Result, limits};

/// A buffer of `T` on the device, for shader storage or uniforms.
pub(crate) struct Buffer<T> {
    device: Rc<Device>,
    raw: glow::Buffer,
    length: usize,
    element: PhantomData<T>,
}

impl<T: Pod> Buffer<T> {
    /// A buffer for `length` elements, of no defined content. One element is kept even for none: GL has no empty block.
    pub fn new(device: &Rc<Device>, length: usize) -> Result<Self> {
        let gl = device.gl();
        let bytes = length.max(1).checked_mul(size_of::<T>()).and_then(|bytes| i32::try_from(bytes).ok());
        let bytes = bytes.ok_or_else(|| Error::Gl(format!("a buffer of {length} elements is beyond 2 GiB")))?;
        limits::room(bytes as u64, "a buffer")?;
        // SAFETY: the device keeps its context current on this thread.
        let raw = unsafe { gl.create_buffer() }.map_err(refused("buffer"))?;
        let buffer = Self { device: device.clone(), raw, length, element: PhantomData };
        // SAFETY: the device keeps its context current on this thread, and the buffer is its own.
        unsafe {
            gl.bind_buffer(glow::SHADER_STORAGE_BUFFER, Some(raw));
            gl.buffer_data_size(glow::SHADER_STORAGE_BUFFER, bytes, glow::DYNAMIC_DRAW);
        }
        // One that has no memory must not be drawn from.
        device.check("making a buffer")?;
        Ok(buffer)
    }

    /// A buffer that holds a copy of `data`.
    pub fn from_slice(device: &Rc<Device>, data: &[T]) -> Result<Self> {
        let buffer = Self::new(device, data.len())?;
        buffer.write(data);
        Ok(buffer)
    }

    /// Puts `data` in, growing the buffer where it is too small.
    pub fn store(&mut self, data: &[T]) -> Result<()> {
        if data.len() > self.length {
            *self = Self::new(&self.device.clone(), data.len())?;
        }
        self.write(data);
        Ok(())
    }

    fn write(&self, data: &[T]) {
        let gl = self.device.gl();
        // SAFETY: the device keeps its context current on this thread, and the slice says how long it is; GL refuses one that
        // is longer than the buffer.
        unsafe {
            gl.bind_buffer(glow::SHADER_STORAGE_BUFFER, Some(self.raw));
            gl.buffer_sub_data_u8_slice(glow::SHADER_STORAGE_BUFFER, 0, bytemuck::cast_slice(data));
        }
    }

    /// The first `length` elements, after waiting for the device.
    pub fn read(&self, length: usize) -> Vec<T> {
        let mut data = vec![T::zeroed(); length.min(self.length)];
        let gl = self.device.gl();
        // SAFETY: the device keeps its context current on this thread, and the buffer holds as much as the slice takes.
        unsafe {
            gl.memory_barrier(glow::BUFFER_UPDATE_BARRIER_BIT);
            gl.bind_buffer(glow::SHADER_STORAGE_BUFFER, Some(self.raw));
            gl.get_buffer_sub_data(glow::SHADER_STORAGE_BUFFER, 0, bytemuck::cast_slice_mut(&mut data));
        }
        data
    }

    /// How many elements there is room for.
    pub fn length(&self) -> usize {
        self.length
    }

    /// Binds the whole buffer as a shader storage block.
    pub fn bind_storage(&self, (_, index): Binding) {
        // SAFETY: the device keeps its context current on this thread, and what is bound is its own.
        unsafe { self.device.gl().bind_buffer_base(glow::SHADER_STORAGE_BUFFER, index, Some(self.raw)) }
    }

    /// Makes the buffer the vertex attribute `location` of the current vertex array: f32s, as many as a `T` holds.
    pub fn bind_vertices(&self, location: u32) {
        let (gl, floats) = (self.device.gl(), size_of::<T>() / size_of::<f32>());
        // SAFETY: the device keeps its context current on this thread; the buffer that is bound has these floats one after the
        // other, from offset 0 on.
        unsafe {
            gl.bind_buffer(glow::ARRAY_BUFFER, Some(self.raw));
            gl.enable_vertex_attrib_array(location);
            gl.vertex_attrib_pointer_f32(location, floats as i32, glow::FLOAT, false, 0, 0);
        }
    }

    /// Makes its elements the attributes of the current vertex array, one after `divisor` instances or, with 0, one a vertex.
    pub(in crate::gpu) fn bind_attributes(&self, attributes: &[Attribute], divisor: u32) {
        let (gl, stride) = (self.device.gl(), size_of::<T>() as i32);
        let ends = attributes.iter().map(|attribute| (attribute.first + attribute.count) * size_of::<f32>() as i32);
        assert!(ends.max().unwrap_or(0) <= stride, "attributes are words of an element");
        // SAFETY: the device keeps its context current on this thread, and the offsets are into each element of the buffer that
        // is bound, as was asserted.
        unsafe {
            gl.bind_buffer(glow::ARRAY_BUFFER, Some(self.raw));
            for &Attribute { location, kind, count, first } in attributes {
                let offset = first * size_of::<f32>() as i32;
                gl.enable_vertex_attrib_array(location);
                if kind == glow::FLOAT {
                    gl.vertex_attrib_pointer_f32(location, count, kind, false, stride, offset);
                } else {
                    gl.vertex_attrib_pointer_i32(location, count, kind, stride, offset);
                }
                gl.vertex_attrib_divisor(location, divisor);
            }
        }
    }

    /// Binds the whole buffer as a uniform block.
    pub fn bind_uniform(&self, (_, index): Binding) {
        // SAFETY: the device keeps its context current on this thread, and what is bound is its own.
        unsafe { self.device.gl().bind_buffer_base(glow::UNIFORM_BUFFER, index, Some(self.raw)) }
    }
}

impl<T> Drop for Buffer<T> {
    fn drop(&mut self) {
        if let Some(gl) = self.device.to_free() {
            // SAFETY: the device's context is there and current, and nothing uses what is freed from here on.
            unsafe { gl.delete_buffer(self.raw) }
        }
    }
}

/// Some words of a buffer's element, as a vertex shader has them.
#[derive(Debug, Clone, Copy)]
pub(in crate::gpu) struct Attribute {
    pub location: u32,
    /// `GL_FLOAT`, `GL_INT` or `GL_UNSIGNED_INT`.
    pub kind: u32,
    /// How many words, and which is the first.
    pub count: i32,
    pub first: i32,
}
