//! Runs passes: programs compiled when first needed, a debug group and, where asked for, a time for each.

use std::cell::RefCell;
use std::collections::HashMap;
use std::rc::Rc;

use glow::HasContext as _;

use super::context::Device;
use super::resource::{Texture, Triangle};
use super::screen::{Region, Screen};
use super::shader::{Define, Program};
use super::timer::{PassTime, Timer};
use crate::Result;

/// What every pass needs to run.
pub(crate) struct Runner {
    device: Rc<Device>,
    triangle: Triangle,
    programs: RefCell<HashMap<String, Rc<Program>>>,
    timer: RefCell<Timer>,
}

impl Runner {
    pub fn new(device: &Rc<Device>) -> Result<Self> {
        Ok(Self {
            device: device.clone(),
            triangle: Triangle::new(device)?,
            programs: RefCell::default(),
            timer: RefCell::new(Timer::new(device)?),
        })
    }

    /// The device that the passes run on.
    pub fn device(&self) -> &Rc<Device> {
        &self.device
    }

    /// Whether each pass is timed from now on. Timing waits for the device before and after each pass.
    pub fn set_timing(&self, timing: bool) {
        self.timer.borrow_mut().set_enabled(timing);
    }

    /// The times gathered since they were last taken.
    pub fn take_times(&self) -> Vec<PassTime> {
        self.timer.borrow_mut().take()
    }

    /// Draws a level of `target` with a fragment shader of `shaders/`.
    pub fn draw(&self, path: &str, defines: &[Define<'_>], target: &Texture, level: u32) -> Result<()> {
        let program = self.program(path, defines, Program::fragment)?;
        self.run(label(path), || {
            target.target(level);
            program.bind();
            self.triangle.draw();
        });
        Ok(())
    }

    /// Draws all of `target` by several draws, one band of rows each.
    pub fn draw_in_bands(&self, path: &str, defines: &[Define<'_>], target: &Texture, bands: u32) -> Result<()> {
        if bands <= 1 {
            return self.draw(path, defines, target, 0);
        }
        let program = self.program(path, defines, Program::fragment)?;
        let (gl, width, height) = (self.device.gl(), target.level_width(0) as i32, target.level_height(0));
        let edge = |band: u32| (u64::from(height) * u64::from(band) / u64::from(bands)) as i32;
        self.run(label(path), || {
            target.target(0);
            program.bind();
            // SAFETY: the device keeps its context current on this thread, and numbers are all that it is given.
            unsafe { gl.enable(glow::SCISSOR_TEST) };
            for band in 0..bands {
                // SAFETY: the device keeps its context current on this thread, and numbers are all that it is given.
                unsafe { gl.scissor(0, edge(band), width, edge(band + 1) - edge(band)) };
                self.triangle.draw();
                // SAFETY: the device keeps its context current on this thread, and numbers are all that it is given.
                unsafe { gl.flush() };
            }
            // SAFETY: the device keeps its context current on this thread, and numbers are all that it is given.
            unsafe { gl.disable(glow::SCISSOR_TEST) };
        });
        Ok(())
    }

    /// Lets what passes have written to buffers be read by those that follow.
    pub fn written(&self) {
        // SAFETY: the device keeps its context current on this thread, and numbers are all that it is given.
        unsafe { self.device.gl().memory_barrier(glow::SHADER_STORAGE_BARRIER_BIT) }
    }

    /// Draws a region of the screen with a fragment shader of `shaders/`.
    pub fn draw_screen(&self, path: &str, defines: &[Define<'_>], screen: &Screen, region: Region) -> Result<()> {
        let program = self.program(path, defines, Program::fragment)?;
        self.run(label(path), || {
            screen.target(region);
            program.bind();
            self.triangle.draw();
        });
        Ok(())
    }

    /// Draws a level of `target`, keeping the smaller of what is there and what is drawn.
    pub fn draw_minimum(&self, path: &str, defines: &[Define<'_>], target: &Texture, level: u32) -> Result<()> {
        let program = self.program(path, defines, Program::fragment)?;
        let gl = self.device.gl();
        self.run(label(path), || {
            target.target(level);
            // SAFETY: the device keeps its context current on this thread, and numbers are all that it is given.
            unsafe {
                gl.enable(glow::BLEND);
                gl.blend_equation(glow::MIN);
            }
            program.bind();
            self.triangle.draw();
            // SAFETY: the device keeps its context current on this thread, and numbers are all that it is given.
            unsafe {
                gl.blend_equation(glow::FUNC_ADD);
                gl.disable(glow::BLEND);
            }
        });
        Ok(())
    }

    /// Runs a compute shader of `shaders/`.
    pub fn dispatch(&self, path: &str, defines: &[Define<'_>], groups: [u32; 3]) -> Result<()> {
        let program = self.program(path, defines, Program::compute)?;
        self.run(label(path), || program.dispatch(groups));
        Ok(())
    }

    /// The program of a vertex and a fragment shader of `shaders/`.
    pub(super) fn drawn_by(&self, vertex: &str, fragment: &str, defines: &[Define<'_>]) -> Result<Rc<Program>> {
        self.program(fragment, defines, |device, fragment, defines| Program::drawing(device, vertex, fragment, defines))
    }

    /// Runs `work` as a part of the frame with a name and, while timing is on, a time.
    pub fn run<T>(&self, label: &str, work: impl FnOnce() -> T) -> T {
        let gl = self.device.gl();
        // SAFETY: the device keeps its context current on this thread, and numbers are all that it is given.
        unsafe { gl.push_debug_group(glow::DEBUG_SOURCE_APPLICATION, 0, label) };
        self.timer.borrow_mut().begin();
        let result = work();
        self.timer.borrow_mut().end(label);
        // SAFETY: the device keeps its context current on this thread, and numbers are all that it is given.
        unsafe { gl.pop_debug_group() };
        result
    }

    fn program(
        &self,
        path: &str,
        defines: &[Define<'_>],
        link: impl FnOnce(&Rc<Device>, &str, &[Define<'_>]) -> Result<Program>,
    ) -> Result<Rc<Program>> {
        let mut key = path.to_owned();
        for (name, value) in defines {
            key.push_str(&format!(" {name}={value}"));
        }
        if let Some(program) = self.programs.borrow().get(&key) {
            return Ok(program.clone());
        }
        let program = Rc::new(link(&self.device, path, defines)?);
        self.programs.borrow_mut().insert(key, program.clone());
        Ok(program)
    }
}

/// A pass goes by the stem of its shader's name everywhere.
fn label(path: &str) -> &str {
    path.split('.').next().unwrap_or(path)
}
