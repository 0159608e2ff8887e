//! Several photos: the next is read and the last written while one is computed.

use super::Args;
use super::fault::Fault;
use super::job::{self, Job};
use super::outputs::{Paths, Sequence};
use super::pipeline;
use super::tally::Tally;
use crate::job::{Computer, Done, Found};
use crate::terminal::progress::Progress;
use crate::{Error, Result, panics};

/// A photo on its way, or why it is not.
struct Item<'a, Work> {
    index: usize,
    paths: &'a Paths,
    job: Result<Job<'a, Work>>,
}

impl<'a, Work> Item<'a, Work> {
    /// A photo that is worked on in a step; a panic there is its error, and no one else's.
    fn through<Next>(self, step: &str, work: impl FnOnce(Job<'a, Work>) -> Result<Job<'a, Next>>) -> Item<'a, Next> {
        let Self { index, paths, job } = self;
        let job = job.and_then(|job| {
            panics::caught(|| {
                Fault::strike(job.args.sequence.panic_in.as_ref(), step, index);
                work(job)
            })
        });
        Item { index, paths, job }
    }
}

fn compute<'a>(
    item: Item<'a, Found<'a>>,
    mut computer: Option<&mut Computer>,
    progress: &Progress,
) -> Item<'a, Done<'a>> {
    let item = item.through("compute", |job| job.compute(computer.as_deref_mut(), progress));
    if let (Err(Error::Internal { .. }), Some(computer)) = (&item.job, computer) {
        // What it left half done must not get into the next.
        computer.start_over();
    }
    item
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
        let job = panics::caught(|| {
            Fault::strike(args.sequence.panic_in.as_ref(), "read", index);
            paths.make_folders()?;
            Job::read(args, paths, &look)
        });
        Item { index, paths, job }
    };
    let open = || look.renders().then(|| job::computer(args)).transpose();
    let compute = |computer: &mut Option<Computer>, item| compute(item, computer.as_mut(), &hidden);
    let write = |item: Item<'_, Done<'_>>| {
        let item = item.through("write", Job::write);
        tally.add(item.paths, item.job)
    };
    pipeline::run(frames.len(), args.sequence.side_by_side(), read, open, compute, write)?;
    let result = tally.finish();
    drop(progress);
    result
}
