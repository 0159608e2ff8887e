//! Curves as the prototype draws them: a line strip of vertices (x, y) into a framebuffer.

use std::rc::Rc;

use bytemuck::{Pod, Zeroable};
use glow::HasContext as _;

use super::context::Device;
use super::layout::PASS;
use super::resource::{Buffer, Texel, Texture, VertexArray};
use super::runner::Runner;
use crate::Result;

/// One curve's uniforms; as in `lines.vert`.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(super) struct Uniforms {
    pub window: [f32; 4],
    pub colour: [f32; 4],
}
const _: () = assert!(size_of::<Uniforms>() == 32);

/// A plot, white, that curves are drawn into.
pub(crate) struct LinesPass {
    device: Rc<Device>,
    array: VertexArray,
    vertices: Buffer<[f32; 2]>,
    uniforms: Buffer<Uniforms>,
    target: Texture,
    window: [f32; 4],
    widest: f32,
}

impl LinesPass {
    /// A plot of `width` × `height` pixels that shows `x` and `y` from their first to their second number.
    ///
    /// # Errors
    /// [`Error::Gl`](crate::Error::Gl) where the driver cannot hold it.
    pub fn new(runner: &Runner, [width, height]: [u32; 2], x: [f32; 2], y: [f32; 2]) -> Result<Self> {
        let device = runner.device();
        let target = Texture::new(device, Texel::Rgba, width, height)?;
        target.clear(1.0);
        let (vertices, uniforms) = (Buffer::new(device, 0)?, Buffer::new(device, 1)?);
        let array = VertexArray::new(device)?;
        let window = [x[0], y[0], x[1] - x[0], y[1] - y[0]];
        let widest = widest_line(device.gl());
        Ok(Self { device: device.clone(), array, vertices, uniforms, target, window, widest })
    }

    /// Draws the curve through `vertices` in `colour`, `width` pixels wide or as wide as the driver can.
    pub fn strip(&mut self, runner: &Runner, vertices: &[[f32; 2]], colour: [f32; 3], width: f32) -> Result<()> {
        if vertices.len() < 2 {
            return Ok(());
        }
        self.vertices.store(vertices)?;
        let [red, green, blue] = colour;
        self.uniforms.store(&[Uniforms { window: self.window, colour: [red, green, blue, 1.0] }])?;
        self.uniforms.bind_uniform(PASS);
        let program = runner.drawn_by("lines.vert", "lines.frag", &[])?;
        runner.run("lines", || {
            self.target.target(0);
            program.bind();
            let gl = self.device.gl();
            self.array.bind();
            self.vertices.bind_vertices(0);
            // SAFETY: the device keeps its context current on this thread; the array's one attribute is the buffer of these
            // vertices, and no more of them are drawn than it was given.
            unsafe {
                gl.line_width(width.min(self.widest));
                gl.draw_arrays(glow::LINE_STRIP, 0, vertices.len() as i32);
                gl.line_width(1.0);
            }
        });
        self.device.check("drawing a line strip")
    }

    /// The picture so far, RGBA row by row from the top, after waiting for the device.
    pub fn read(&self) -> Vec<[f32; 4]> {
        let values = self.target.read_level(0);
        values.chunks_exact(4).map(|pixel| [pixel[0], pixel[1], pixel[2], pixel[3]]).collect()
    }
}

/// The widest line: in a forward-compatible context anything above 1 is an error.
fn widest_line(gl: &glow::Context) -> f32 {
    let mut range = [1.0; 2];
    // SAFETY: the context is a device's, which keeps it current on this thread; the range is of two numbers.
    unsafe {
        let flags = gl.get_parameter_i32(glow::CONTEXT_FLAGS) as u32;
        if flags & glow::CONTEXT_FLAG_FORWARD_COMPATIBLE_BIT != 0 {
            return 1.0;
        }
        gl.get_parameter_f32_slice(glow::ALIASED_LINE_WIDTH_RANGE, &mut range);
    }
    range[1].max(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::tests::turn;
    use crate::gpu::{Backend, Device};

    #[test]
    fn a_rising_line_runs_from_the_lower_left_to_the_upper_right() {
        const SIDE: u32 = 64;
        let _turn = turn();
        for backend in Backend::ALL {
            let runner = Runner::new(&Device::open(&[backend]).expect("these tests need GL")).unwrap();
            let mut plot = LinesPass::new(&runner, [SIDE, SIDE], [-1.0, 1.0], [0.0, 10.0]).unwrap();
            let vertices: Vec<[f32; 2]> = (0..=20u8).map(|i| [-1.0 + 0.1 * f32::from(i), 0.5 * f32::from(i)]).collect();
            plot.strip(&runner, &vertices, [1.0, 0.0, 0.0], 1.0).unwrap();
            let picture = plot.read();
            let red = |column: u32, row: u32| picture[(row * SIDE + column) as usize] == [1.0, 0.0, 0.0, 1.0];
            for column in 2..SIDE - 2 {
                let rows: Vec<u32> = (0..SIDE).filter(|&row| red(column, row)).collect();
                let on_the_line = rows.iter().all(|&row| (SIDE - 1 - column).abs_diff(row) <= 1);
                assert!(!rows.is_empty() && on_the_line, "{backend}: column {column} is red in rows {rows:?}");
            }
        }
    }
}
