//! Several photos: the next is read and the last written while one is computed.

use super::Args;
use super::job::Job;
use super::outputs::{Paths, Sequence};
use super::pipeline;
use super::tally::Tally;
use crate::Result;
use crate::cli::progress::Progress;
use crate::gpu::Device;
use crate::job::Computer;

/// A photo on its way, or why it is not.
struct Item<'a> {
    paths: &'a Paths,
    job: Result<Job<'a>>,
}

fn compute<'a>(item: Item<'a>, computer: Option<&mut Computer>, progress: &Progress) -> Item<'a> {
    let job = item.job.and_then(|mut job| job.compute(computer, progress).map(|()| job));
    Item { paths: item.paths, job }
}

/// Lays glare over the photos of a sequence.
///
/// # Errors
/// That of the first photo that could not be done; with --keep-going [`crate::Error::Frames`] after the others; with
/// --strict [`crate::Error::FramesMissed`].
pub fn run(args: &Args, sequence: &Sequence) -> Result<()> {
    let frames = &sequence.frames;
    let progress = Progress::start(args.quiet);
    progress.part(format!("0 of {} photos", frames.len()), 0.0);
    // The bar is the sequence's: what goes on within a photo is not shown.
    let hidden = Progress::start(true);
    let look = args.look()?;
    let mut tally = Tally::new(args, sequence, &progress);
    let read = |index: usize| {
        let paths = &frames[index];
        let job = paths.make_folders().and_then(|()| Job::read(args, paths, &look));
        Item { paths, job }
    };
    let open = || {
        let device = look.renders().then(|| Device::open(args.accuracy.backend.backends()));
        Ok(device.transpose()?.map(Computer::new))
    };
    let compute = |computer: &mut Option<Computer>, item| compute(item, computer.as_mut(), &hidden);
    let write = |item: Item<'_>| {
        let done = item.job.and_then(|mut job| job.write().map(|()| job));
        tally.add(item.paths, done)
    };
    pipeline::run(frames.len(), !args.sequence.one_by_one, read, open, compute, write)?;
    let result = tally.finish();
    drop(progress);
    result
}
