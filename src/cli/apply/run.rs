//! The run itself: one photo after the other, or a single one.

use std::thread;

use super::job::Job;
use super::outputs::{self, Paths, Work};
use super::report::Report;
use super::{Args, sequence, summary};
use crate::gpu::Device;
use crate::job::{Computer, Stages};
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
    progress.step("reading the photo");
    let mut stages = Stages::default();
    let (photo, mut computer) = stages.time("read", || read(args, paths, &look))?;

    progress.step("finding the lights");
    let mut job = Job::found(args, paths, &look, photo, stages)?;
    job.compute(computer.as_mut(), &progress)?;

    progress.step("writing");
    job.write()?;
    if let Some(path) = &args.output_options.report {
        target::write_json(path, &Report::new(&job), args.force)?;
    }
    drop(progress);
    summary::print(&job)?;
    match &job.work.certificate {
        Some(certificate) if args.proof.strict => certificate.check(),
        _ => Ok(()),
    }
}

/// Reads the photo while the GL context opens: neither needs the other, and both take a while. Where memory is limited,
/// one after the other: a driver does not survive it that another takes what it was just told to be there.
fn read(args: &Args, paths: &Paths, look: &Look) -> Result<(Photo, Option<Computer>)> {
    let read = || photo::read_with(&paths.input, &args.reading.options());
    let open = || look.renders().then(|| Device::open(args.accuracy.backend.backends())).transpose();
    if limits::memory_is_limited() {
        return Ok((read()?, open()?.map(Computer::new)));
    }
    thread::scope(|scope| {
        let reading = thread::Builder::new().name("read".into()).spawn_scoped(scope, read);
        let device = open();
        let photo = match reading {
            Ok(thread) => thread.join().unwrap_or_else(|panic| Err(panics::error(&*panic))),
            // Where the system gives no thread, this one has time now.
            Err(_) => read(),
        };
        Ok((photo?, device?.map(Computer::new)))
    })
}
