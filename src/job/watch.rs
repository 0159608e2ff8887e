//! What goes on in a job, for someone who watches it.

use std::fmt;

use crate::{Error, Result};

/// What is done one after the other; how long each takes is not known beforehand.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Step {
    /// The photo is read.
    Reading,
    /// Its lights are looked for.
    Finding,
    /// The plan is made.
    Planning,
    /// Spectrum, field and picture are computed.
    Computing,
    /// The field is held against the direct sum.
    Measuring,
    /// The picture is written.
    Writing,
}

impl fmt::Display for Step {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Reading => "reading the photo",
            Self::Finding => "finding the lights",
            Self::Planning => "planning",
            Self::Computing => "computing the glare",
            Self::Measuring => "measuring the error",
            Self::Writing => "writing",
        })
    }
}

/// Someone who watches a job, and may call it off.
pub trait Watch {
    /// What goes on now.
    fn step(&self, step: Step);

    /// From now on, so many pixels are to be measured.
    fn measured(&self, pixels: usize);

    /// So many more pixels have been measured.
    fn advance(&self, pixels: usize);

    /// Whether to stop: asked between the steps.
    fn cancelled(&self) -> bool {
        false
    }

    /// Says what begins, unless the job is called off.
    ///
    /// # Errors
    /// [`Error::Cancelled`] then.
    fn begin(&self, step: Step) -> Result<()> {
        if self.cancelled() {
            return Err(Error::Cancelled);
        }
        self.step(step);
        Ok(())
    }
}

/// No one.
pub struct Unwatched;

impl Watch for Unwatched {
    fn step(&self, _: Step) {}

    fn measured(&self, _: usize) {}

    fn advance(&self, _: usize) {}
}
