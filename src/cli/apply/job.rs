//! What is done with one photo: read, lay the look over it, write.

use std::sync::Arc;

use serde::Serialize;

use super::lock::Locked;
use super::outputs::{Paths, glare_options, picture_options};
use super::{Args, map};
use crate::Result;
use crate::cli::luminance::Extent;
use crate::cli::surroundings::{Seen, StrayTold};
use crate::frame::Frame;
use crate::gpu::Device;
use crate::job::{Computer, Done, Found, Stages, Wanted};
use crate::look::Look;
use crate::photo::{self, LuminanceScale, Photo};
use crate::terminal::progress::Progress;

/// A photo, its files, and what a run has come to know of it: [`Found`], then [`Done`].
pub struct Job<'a, Work> {
    pub args: &'a Args,
    pub paths: &'a Paths,
    pub work: Work,
    /// What light from outside the frame did.
    pub outside: Option<StrayTold>,
    /// What the photo's numbers are in cd/m², where that is known.
    pub luminance: Option<Luminance>,
}

/// A photo and its glare in cd/m².
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Luminance {
    /// What makes that of their numbers.
    #[serde(flatten)]
    pub scale: LuminanceScale,
    /// Of the photo as it was read.
    pub photo: Option<Extent>,
    /// Of all that was added.
    pub glare: Option<Extent>,
}

impl Luminance {
    fn new(photo: &Photo) -> Option<Self> {
        let scale = photo.luminance_scale()?;
        Some(Self { photo: Extent::of(photo, &scale), glare: None, scale })
    }
}

impl<'a> Job<'a, Found<'a>> {
    /// Reads a photo and finds what glares in it.
    ///
    /// # Errors
    /// Those of [`photo::read`] and [`Job::found`].
    pub fn read(args: &'a Args, paths: &'a Paths, locked: &'a Locked) -> Result<Self> {
        let mut stages = Stages::default();
        let photo = stages
            .time("read", || photo::read_with(&paths.input, &args.reading.of_white(args.veil.white_luminance())))?;
        let job = Self::found(args, paths, &locked.look, photo, stages)?;
        Ok(Self { work: job.work.stretched_by(locked.range), ..job })
    }

    /// Finds what glares in a photo that has been read.
    ///
    /// # Errors
    /// Those of [`Paths::check`] and [`Found::new`].
    pub fn found(args: &'a Args, paths: &'a Paths, look: &'a Look, photo: Photo, stages: Stages) -> Result<Self> {
        paths.check(args, &photo)?;
        let luminance = Luminance::new(&photo);
        Ok(Self { args, paths, work: Found::new(look, photo, stages)?, outside: None, luminance })
    }

    /// Lays the glare over the photo; without a computer there is none.
    ///
    /// # Errors
    /// Those of [`Found::compute`].
    pub fn compute(self, computer: Option<&mut Computer>, progress: &Progress) -> Result<Job<'a, Done<'a>>> {
        let Self { args, paths, work, outside, luminance } = self;
        let wanted = Wanted {
            // A report alone tells of a picture that nobody keeps.
            picture: paths.output.is_some() || paths.glare.is_none(),
            // What comes from outside is told as a share of it, and all of it in cd/m².
            glare: paths.glare.is_some()
                || paths.map.is_some()
                || args.surroundings.environment.is_some()
                || luminance.is_some() && (args.output_options.report.is_some() || !args.quiet),
            layers: args.output_options.layers,
            times: args.verbose || args.output_options.report.is_some() || work.look.accuracy.goal.budget().is_some(),
            verify: args.proof.verify,
        };
        Ok(Job { args, paths, work: work.compute(computer, wanted, progress)?, outside, luminance })
    }
}

impl Job<'_, Done<'_>> {
    /// Adds what comes from outside the frame, and leaves the picture alone of what was stored.
    #[must_use]
    pub fn surrounded(mut self, seen: &Seen<'_>) -> Self {
        let Done { look, picture, glare, frame, facts, stages, warnings, .. } = &mut self.work;
        let told = seen.lay(look, picture.as_mut(), glare.as_mut());
        for photo in [picture, glare] {
            *photo = photo.take().map(Photo::cropped);
        }
        *frame = Frame { window: Frame::full(frame.width, frame.height).window, ..*frame };
        facts.frame.window = frame.window;
        stages.0.push(("outside", told.milliseconds));
        warnings.extend(told.error.and_then(|error| Some(error.check().err()?.to_string())));
        self.outside = Some(told);
        self
    }

    /// An error where the glare, or a veil, is further from the truth than was asked.
    ///
    /// # Errors
    /// Those of [`Done::check`] and of the veil from outside.
    pub fn check(&self) -> Result<()> {
        self.work.check()?;
        self.outside.as_ref().and_then(|outside| outside.error).map_or(Ok(()), |error| error.check())
    }

    /// Writes what is asked for: the picture, the glare alone and its map.
    ///
    /// # Errors
    /// Those of [`photo::write`] and [`map::write`].
    pub fn write(mut self) -> Result<Self> {
        let (args, paths) = (self.args, self.paths);
        let picture = paths.output.as_ref().zip(self.work.picture.as_ref());
        if let Some((path, picture)) = picture {
            let options = picture_options(args);
            let largest = photo::largest_value(path, picture, &options)?;
            let lost = photo::lost(path, picture, &options);
            let beyond = self.work.beyond(largest);
            self.work.warnings.extend(lost.into_iter().chain(beyond));
        }
        let Done { look, picture, glare, stages, .. } = &mut self.work;
        let made = Arc::new(look.made());
        picture.iter_mut().chain(glare.iter_mut()).for_each(|photo| photo.source.made = Some(made.clone()));
        if let (Some(Luminance { scale, glare: told, .. }), Some(glare)) = (&mut self.luminance, glare.as_ref()) {
            *told = Extent::of(glare, scale);
        }
        stages.time("write", || {
            if let (Some(path), Some(glare)) = (&paths.map, glare.as_ref()) {
                map::write(path, &paths.input, glare, args.output_options.map_range, args.overwrites())?;
            }
            if let (Some(path), Some(glare)) = (&paths.glare, glare.take()) {
                photo::write(path, &glare, &glare_options(args, path))?;
            }
            match (&paths.output, picture) {
                (Some(path), Some(picture)) => photo::write(path, picture, &picture_options(args)),
                _ => Ok(()),
            }
        })?;
        Ok(self)
    }
}

/// Opens what pictures are computed with.
///
/// # Errors
/// Those of [`Device::open`].
pub fn computer(args: &Args) -> Result<Computer> {
    let device = Device::open(args.accuracy.backend.backends())?;
    let known = args.accuracy.known(Some(device.info()));
    Ok(Computer::new(device, known))
}
