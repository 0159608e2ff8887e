//! The run itself: one photo after the other, or a single one.

use super::job::Job;
use super::outputs::{self, Paths, Work};
use super::report::Report;
use super::{Args, sequence, summary};
use crate::cli::progress::Progress;
use crate::gpu::Device;
use crate::job::{Computer, Stages};
use crate::look::Look;
use crate::photo::{self, Photo};
use crate::{Error, Result, target};

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

/// Reads the photo while the GL context opens: neither needs the other, and both take a while.
fn read(args: &Args, paths: &Paths, look: &Look) -> Result<(Photo, Option<Computer>)> {
    std::thread::scope(|scope| {
        let photo = scope.spawn(|| photo::read_with(&paths.input, &args.reading.options()));
        let device = look.renders().then(|| Device::open(args.accuracy.backend.backends()));
        let photo = photo.join().unwrap_or_else(|_| Err(Error::read_photo(&paths.input, "the reader failed")))?;
        Ok((photo, device.transpose()?.map(Computer::new)))
    })
}
