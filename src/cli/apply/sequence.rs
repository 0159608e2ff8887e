//! Several photos: the next is read and the last written while one is computed.

use std::ops::ControlFlow;
use std::path::Path;

use rayon::prelude::*;

use super::Args;
use super::fault::Fault;
use super::job::{self, Job};
use super::lock::Locking;
use super::outputs::{Paths, Sequence};
use super::tally::Tally;
use super::told::Told;
use super::workers::{self, Part, Worker};
use super::{pipeline, shot};
use crate::job::{Computer, Done, Found};
use crate::shot::ledger::{self, Entry};
use crate::shot::{Ledger, Stamp};
use crate::terminal::progress::Progress;
use crate::{Error, Result, panics};

/// A photo on its way, or why it is not.
struct Item<'a, Work> {
    index: usize,
    paths: &'a Paths,
    /// How the photo's file was before it was read.
    stamp: Option<Stamp>,
    job: Result<Job<'a, Work>>,
}

impl<'a, Work> Item<'a, Work> {
    /// A photo that is worked on in a step; a panic there is its error, and no one else's.
    fn through<Next>(self, step: &str, work: impl FnOnce(Job<'a, Work>) -> Result<Job<'a, Next>>) -> Item<'a, Next> {
        let Self { index, paths, stamp, job } = self;
        let job = job.and_then(|job| {
            panics::caught(|| {
                Fault::strike(job.args.sequence.panic_in.as_ref(), step, index);
                work(job)
            })
        });
        Item { index, paths, stamp, job }
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

/// Lays glare over the photos of a sequence, but for those that are done.
///
/// # Errors
/// That of the first photo that could not be done; with --keep-going [`crate::Error::Frames`] after the others; with
/// --strict [`crate::Error::FramesMissed`].
pub fn run(args: &Args, sequence: &Sequence) -> Result<()> {
    match args.sequence.among {
        Some(_) => return go_through(args, sequence, &mut Worker::new(args)),
        None if args.sequence.jobs > 1 => workers::run(args, sequence)?,
        None => {
            let progress = Progress::start(args.quiet);
            let mut tally = Tally::new(args, sequence, &progress);
            tally.lack(&sequence.missing);
            go_through(args, sequence, &mut tally)?;
            tally.finish()?;
        }
    }
    if !args.keeps_ledger() {
        sequence.frames.iter().for_each(|paths| ledger::forget(&shot::outputs(paths)));
    }
    Ok(())
}

/// Who hears what becomes of photos.
pub trait Hears: Send {
    /// One is done already.
    fn skipped(&mut self, photo: &Path, entry: &Entry);

    /// One was written, or why it was not; says whether to go on.
    fn done(&mut self, photo: &Path, told: Result<Told>) -> ControlFlow<()>;
}

/// Does all photos but those that are done.
fn go_through(args: &Args, sequence: &Sequence, heard: &mut impl Hears) -> Result<()> {
    let Locking { locked, mut computer } = Locking::new(args, sequence, args.look()?)?;
    let ledger = shot::ledger(args, &locked)?;
    let frames = remaining(args, sequence, &ledger, heard);
    // The bar is the sequence's: what goes on within a photo is not shown.
    let hidden = Progress::start(true);
    let read = |index: usize| {
        let paths = frames[index];
        let stamp = Stamp::of(&paths.input);
        let job = panics::caught(|| {
            Fault::strike(args.sequence.panic_in.as_ref(), "read", index);
            paths.make_folders()?;
            Job::read(args, paths, &locked)
        });
        Item { index, paths, stamp, job }
    };
    let open = || match computer.take() {
        None if locked.look.renders() => job::computer(args).map(Some),
        computer => Ok(computer),
    };
    let compute = |computer: &mut Option<Computer>, item| compute(item, computer.as_mut(), &hidden);
    let write = |item: Item<'_, Done<'_>>| {
        let mut item = item.through("write", Job::write);
        if let Ok(job) = &mut item.job {
            let noted = ledger.note(
                item.stamp.as_ref(),
                &item.paths.input,
                &shot::outputs(item.paths),
                shot::measured(&job.work),
            );
            // The picture is there; it is done again where a later run finds no word of it.
            job.work.warnings.extend(noted.err().map(|error| error.to_string()));
        }
        let told = |job| Told::new(args, &job).map_err(|error| Error::write(&item.paths.input, error));
        heard.done(&item.paths.input, item.job.and_then(told))
    };
    if frames.is_empty() {
        return Ok(());
    }
    pipeline::run(frames.len(), args.sequence.side_by_side(), read, open, compute, write)
}

/// The photos that are to be done by this process; those that are done already are told.
fn remaining<'a>(args: &Args, sequence: &'a Sequence, ledger: &Ledger, heard: &mut impl Hears) -> Vec<&'a Paths> {
    let part = args.sequence.among.unwrap_or(Part::ALL);
    let mine: Vec<_> = part.of(&sequence.frames).collect();
    if !args.sequence.resume {
        return mine;
    }
    // Many small files, which may be far away: the looks at them overlap.
    let done: Vec<_> = mine.par_iter().map(|paths| ledger.done(&paths.input, &shot::outputs(paths))).collect();
    let mut frames = Vec::new();
    for (paths, done) in mine.into_iter().zip(done) {
        match done {
            Some(entry) => heard.skipped(&paths.input, &entry),
            None => frames.push(paths),
        }
    }
    frames
}
