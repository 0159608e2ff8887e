//! The run itself: one photo after the other, or a single one.

use std::thread;

use super::job::{self, Job};
use super::outputs::{self, Paths, Work};
use super::report::Report;
use super::{Args, sequence, summary};
use crate::choices::Projection;
use crate::cli::surroundings::{Seen, Surroundings};
use crate::job::{Computer, Stages, Step, Watch as _};
use crate::look::Look;
use crate::motion::VIEW_FOV;
use crate::photo::{self, Photo, ReadOptions};
use crate::scene::check_fov;
use crate::terminal::progress::Progress;
use crate::{Error, Result, limits, panics, target};

/// What a run has before it begins to compute.
struct Ready {
    photo: Option<Photo>,
    surroundings: Option<Surroundings>,
    computer: Option<Computer>,
}

/// Lays glare over photos.
///
/// # Errors
/// Whatever keeps a picture from being written; nothing is left half-written then.
pub fn run(args: &Args) -> Result<()> {
    match outputs::work(args)? {
        Work::Sequence(_) if args.surroundings.environment.is_some() => {
            Err(Error::Usage("--environment is around one photo: give one, and files without a pattern".into()))
        }
        Work::Sequence(frames) => sequence::run(args, &frames),
        Work::Single(paths) => single(args, &paths),
    }
}

fn single(args: &Args, paths: &Paths) -> Result<()> {
    let progress = Progress::start(args.quiet);
    let look = args.look()?;
    progress.step(Step::Reading);
    let mut stages = Stages::default();
    let Ready { photo, surroundings, mut computer } = stages.time("read", || read(args, paths, &look))?;
    progress.step(Step::Finding);
    let laid = Laying { args, paths, computer: computer.as_mut(), progress };
    match (photo, &surroundings) {
        (photo, Some(surroundings)) => {
            let mut seen = stages.time("view", || seen(args, &look, surroundings, photo))?;
            let (look, photo) = (seen.look(&look)?, seen.take());
            laid.over(photo, &look, stages, Some(&seen))
        }
        (Some(photo), None) => laid.over(photo, &look, stages, None),
        (None, None) => unreachable!("without surroundings there is a photo"),
    }
}

/// What the camera sees, or the photo amid it.
fn seen<'a>(args: &Args, look: &Look, surroundings: &'a Surroundings, photo: Option<Photo>) -> Result<Seen<'a>> {
    let fov = match &photo {
        Some(photo) => {
            look.view(photo, "what is around a photo is in degrees")?.across(&photo.frame, Projection::Rectilinear)
        }
        None => look.fov.unwrap_or(VIEW_FOV),
    };
    check_fov(fov, Some(Projection::Rectilinear)).map_err(|fault| Error::Usage(format!("--fov: {}", fault.reason)))?;
    let sides = photo.as_ref().map_or_else(|| args.surroundings.sides(), |photo| [photo.width(), photo.height()]);
    surroundings.seen(&args.surroundings.camera(), fov, sides, [0; 2], photo)
}

/// What lays glare over one photo.
struct Laying<'a> {
    args: &'a Args,
    paths: &'a Paths,
    computer: Option<&'a mut Computer>,
    progress: Progress,
}

impl Laying<'_> {
    /// Does it, writes what is asked for, and tells of it.
    fn over(self, photo: Photo, look: &Look, stages: Stages, seen: Option<&Seen<'_>>) -> Result<()> {
        let Self { args, paths, computer, progress } = self;
        let mut job = Job::found(args, paths, look, photo, stages)?.compute(computer, &progress)?;
        if let Some(seen) = seen {
            job = job.surrounded(seen);
        }
        progress.step(Step::Writing);
        let job = job.write()?;
        if let Some(path) = &args.output_options.report {
            target::write_json(path, &Report::new(&job).alone(), args.overwrites())?;
        }
        drop(progress);
        summary::print(&job)?;
        if args.proof.strict { job.check() } else { Ok(()) }
    }
}

/// Reads the photo and its surroundings while the GL context opens: neither needs the other, and both take a while. Where memory is
/// limited, one after the other: a driver does not survive it that another takes what it was just told to be there.
fn read(args: &Args, paths: &Paths, look: &Look) -> Result<Ready> {
    let read = || {
        let options = args.reading.of_white(args.veil.white_luminance());
        let photo = (!args.inputs.is_empty()).then(|| photo::read_with(&paths.input, &options)).transpose()?;
        // A part or a layer is named of the photo, where there is one.
        let options = if photo.is_some() { ReadOptions { part: None, layer: None, ..options } } else { options };
        let around = args.surroundings.environment.as_ref();
        let around = around.map(|path| Surroundings::read(path, &options, args.surroundings.hood, look)).transpose()?;
        Ok((photo, around))
    };
    let open = || look.renders().then(|| job::computer(args)).transpose();
    if limits::memory_is_limited() {
        let (photo, surroundings) = read()?;
        return Ok(Ready { photo, surroundings, computer: open()? });
    }
    thread::scope(|scope| {
        let reading = thread::Builder::new().name("read".into()).spawn_scoped(scope, read);
        let computer = open();
        let read = match reading {
            Ok(thread) => thread.join().unwrap_or_else(|panic| Err(panics::error(&*panic))),
            // Where the system gives no thread, this one has time now.
            Err(_) => read(),
        };
        let (photo, surroundings) = read?;
        Ok(Ready { photo, surroundings, computer: computer? })
    })
}
