//! What experiments run on.

use std::rc::Rc;

use crate::Result;
use crate::gpu::runner::Runner;
use crate::gpu::{Backend, Device, Info};

/// A device that is opened when an experiment first asks for it, so that those on the CPU alone need none.
pub struct Lab {
    backends: Vec<Backend>,
    runner: Option<Runner>,
}

impl Lab {
    /// A lab that will take the first of `backends` that gives OpenGL 4.3.
    pub fn new(backends: &[Backend]) -> Self {
        Self { backends: backends.to_vec(), runner: None }
    }

    /// Runs passes.
    ///
    /// # Errors
    /// [`crate::Error::NoContext`] where there is no OpenGL 4.3.
    pub(crate) fn runner(&mut self) -> Result<&Runner> {
        if self.runner.is_none() {
            self.runner = Some(Runner::new(&Device::open(&self.backends)?)?);
        }
        Ok(self.runner.as_ref().expect("made above"))
    }

    /// The device.
    ///
    /// # Errors
    /// [`crate::Error::NoContext`] where there is no OpenGL 4.3.
    pub fn device(&mut self) -> Result<Rc<Device>> {
        Ok(self.runner()?.device().clone())
    }

    /// What the device says of itself, once it is open.
    pub fn info(&self) -> Option<&Info> {
        self.runner.as_ref().map(|runner| runner.device().info())
    }
}
