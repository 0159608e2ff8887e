//! The run itself: one photo after the other, or a single one.

use std::thread;

use super::job::{self, Job};
use super::outputs::{self, Paths, Work};
use super::report::Report;
use super::{Args, sequence, summary};
use crate::job::{Computer, Stages, Step, Watch as _};
use crate::look::Look;
use crate::photo::{self, Photo};
use crate::terminal::progress::Progress;
use crate::{Result, limits, panics, target};

/// Lays glare over photos.
///
/// # Errors
/// Whatever keeps a picture from being written; nothing is left half-written then.
pub fn run(args: &Args) -> Result<()> {
    match outputs::work(args)? {
        Work::Sequence(frames) => sequence::run(args, &frames),
        Work::Single(paths) => single(args, &paths),
    }
}

fn single(args: &Args, paths: &Paths) -> Result<()> {
    let progress = Progress::start(args.quiet);
    let look = args.look()?;
    progress.step(Step::Reading);
    let mut stages = Stages::default();
    let (photo, mut computer) = stages.time("read", || read(args, paths, &look))?;

    progress.step(Step::Finding);
    let job = Job::found(args, paths, &look, photo, stages)?.compute(computer.as_mut(), &progress)?;

    progress.step(Step::Writing);
    let job = job.write()?;
    if let Some(path) = &args.output_options.report {
        target::write_json(path, &Report::new(&job), args.force)?;
    }
    drop(progress);
    summary::print(&job)?;
    if args.proof.strict { job.work.check() } else { Ok(()) }
}

/// Reads the photo while the GL context opens: neither needs the other, and both take a while. Where memory is limited,
/// one after the other: a driver does not survive it that another takes what it was just told to be there.
fn read(args: &Args, paths: &Paths, look: &Look) -> Result<(Photo, Option<Computer>)> {
    let read = || photo::read_with(&paths.input, &args.reading.options());
    let open = || look.renders().then(|| job::computer(args)).transpose();
    if limits::memory_is_limited() {
        return Ok((read()?, open()?));
    }
    thread::scope(|scope| {
        let reading = thread::Builder::new().name("read".into()).spawn_scoped(scope, read);
        let computer = open();
        let photo = match reading {
            Ok(thread) => thread.join().unwrap_or_else(|panic| Err(panics::error(&*panic))),
            // Where the system gives no thread, this one has time now.
            Err(_) => read(),
        };
        Ok((photo?, computer?))
    })
}
