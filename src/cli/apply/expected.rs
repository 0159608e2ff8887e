//! A shot that is to be done later, or elsewhere: what can be known of it now.

use std::path::PathBuf;

use super::inputs::Inputs;
use super::{Args, outputs};
use crate::photo::{self, Photo, ReadOptions};
use crate::shot::Frames;
use crate::{Error, Result};

/// A shot by its pattern; its frames may not be there yet.
pub struct Expected {
    pub frames: Frames,
    /// How many of them are not there.
    pub missing: usize,
    pattern: PathBuf,
    /// The first that is there.
    first: Option<PathBuf>,
    reading: ReadOptions,
}

impl Expected {
    /// The first frame that is there.
    ///
    /// # Errors
    /// Those of [`photo::read_with`].
    pub fn first(&self) -> Result<Option<Photo>> {
        self.first.as_ref().map(|path| photo::read_with(path, &self.reading)).transpose()
    }

    /// The pattern's file name.
    pub fn name(&self) -> String {
        self.pattern.file_name().unwrap_or_default().to_string_lossy().into_owned()
    }
}

impl Args {
    /// The shot, where each of its frames could be done by a run of its own.
    ///
    /// # Errors
    /// [`Error::Usage`] where they could not; those of [`Args::look`], and of names that cannot be.
    pub(in crate::cli) fn shot(&self) -> Result<Expected> {
        self.look()?;
        if self.output_options.report.is_some() {
            let reason = "each of a job's runs would replace the report of the one before";
            return Err(Error::Usage(format!("--report is of one run: {reason}")));
        }
        let (frames, inputs) = Inputs::expected(&self.inputs, self.sequence.frames.as_ref())?;
        let photos = inputs.photos.clone();
        outputs::of(self, inputs, true)?;
        let there: Vec<&PathBuf> = photos.iter().filter(|path| path.is_file()).collect();
        Ok(Expected {
            missing: photos.len() - there.len(),
            frames,
            pattern: self.inputs[0].clone(),
            first: there.first().map(|path| (*path).clone()),
            reading: self.reading.of_white(self.veil.white_luminance()),
        })
    }

    /// Whether files that are there may be replaced by force.
    pub(in crate::cli) fn replaces(&self) -> bool {
        self.force
    }
}
