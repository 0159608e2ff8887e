//! What is done with one photo: read, lay the look over it, write.

use super::Args;
use super::outputs::{Paths, glare_options, picture_options};
use crate::Result;
use crate::job::{self, Computer, Stages, Wanted};
use crate::look::Look;
use crate::photo::{self, Photo};
use crate::terminal::progress::Progress;

/// A photo, and what a run has come to know of it.
pub struct Job<'a> {
    pub args: &'a Args,
    pub paths: &'a Paths,
    pub work: job::Job<'a>,
}

impl<'a> Job<'a> {
    /// Reads a photo and finds what glares in it.
    ///
    /// # Errors
    /// Those of [`photo::read`] and [`Job::found`].
    pub fn read(args: &'a Args, paths: &'a Paths, look: &'a Look) -> Result<Self> {
        let mut stages = Stages::default();
        let photo = stages.time("read", || photo::read_with(&paths.input, &args.reading.options()))?;
        Self::found(args, paths, look, photo, stages)
    }

    /// Finds what glares in a photo that has been read.
    ///
    /// # Errors
    /// Those of [`Paths::check`] and [`job::Job::new`].
    pub fn found(args: &'a Args, paths: &'a Paths, look: &'a Look, photo: Photo, stages: Stages) -> Result<Self> {
        paths.check(args, &photo)?;
        Ok(Self { args, paths, work: job::Job::new(look, photo, stages)? })
    }

    /// Lays the glare over the photo; without a computer there is none.
    ///
    /// # Errors
    /// Those of [`job::Job::compute`].
    pub fn compute(&mut self, computer: Option<&mut Computer>, progress: &Progress) -> Result<()> {
        let (args, look) = (self.args, self.work.look);
        let wanted = Wanted {
            // A report alone tells of a picture that nobody keeps.
            picture: self.paths.output.is_some() || self.paths.glare.is_none(),
            glare: self.paths.glare.is_some(),
            times: args.verbose || args.output_options.report.is_some() || look.accuracy.goal.budget().is_some(),
            verify: args.proof.verify,
            calibrated: args.accuracy.calibrated(),
        };
        self.work.compute(computer, wanted, progress)
    }

    /// Writes what is asked for: the picture, the glare alone.
    ///
    /// # Errors
    /// Those of [`photo::write`].
    pub fn write(&mut self) -> Result<()> {
        let (args, paths, photo) = (self.args, self.paths, &self.work.photo);
        let glare = self.work.glare.take();
        if let Some(path) = &paths.output {
            let options = picture_options(args);
            let largest = photo::largest_value(path, photo, &options)?;
            self.work.warnings.extend(photo::lost(path, photo, &options));
            self.work.warnings.extend(self.work.beyond(largest));
        }
        self.work.stages.time("write", || {
            if let (Some(path), Some(pixels)) = (&paths.glare, glare) {
                photo::write(path, &photo.companion(pixels), &glare_options(args, path))?;
            }
            match &paths.output {
                Some(path) => photo::write(path, photo, &picture_options(args)),
                None => Ok(()),
            }
        })
    }
}
