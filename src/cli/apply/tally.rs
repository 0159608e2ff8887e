//! What became of the photos of a sequence: told as they are done, and in sum.

use std::io::{self, Write};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::time::Instant;

use serde::Serialize;

use super::Args;
use super::outputs::Sequence;
use super::report::Run;
use super::sequence::Hears;
use super::spool::Spool;
use super::told::Told;
use crate::shot::ledger::Entry;
use crate::shot::{self, Measured};
use crate::terminal::progress::Progress;
use crate::terminal::{signals, stderr, stdout};
use crate::{Error, Result, panics, target};

/// What has become of the photos so far.
pub struct Tally<'a> {
    args: &'a Args,
    sequence: &'a Sequence,
    progress: &'a Progress,
    started: Instant,
    done: usize,
    written: usize,
    /// Photos that an earlier run has done.
    skipped: usize,
    failed: Vec<Failed>,
    first_error: Option<Error>,
    /// Photos with pixels that are no light.
    bad: usize,
    measured: usize,
    missed: usize,
    worst: Option<Worst>,
    renderer: Option<String>,
    /// A report a photo, once there is one and where it is asked for.
    reports: Option<Spool>,
}

impl Hears for Tally<'_> {
    fn skipped(&mut self, photo: &Path, entry: &Entry) {
        self.done += 1;
        self.skipped += 1;
        self.measure(photo, [entry.glare, entry.veil], entry.missed());
        self.show();
    }

    fn done(&mut self, photo: &Path, done: Result<Told>) -> ControlFlow<()> {
        let result = done.and_then(|told| panics::caught(|| self.written(photo, &told)));
        if let Err(error) = result {
            let error = error.in_frame(photo);
            self.failed.push(Failed { input: photo.display().to_string(), error: error.to_string() });
            if self.args.sequence.keep_going {
                self.progress.aside(|| stderr::tell(&error));
            }
            self.first_error.get_or_insert(error);
            if !self.args.sequence.keep_going {
                return ControlFlow::Break(());
            }
        }
        self.done += 1;
        self.show();
        ControlFlow::Continue(())
    }
}

/// The photo with the largest error.
struct Worst {
    photo: PathBuf,
    measured: f64,
    asked: f64,
    /// Whether it is one of the veil.
    veil: bool,
}

#[derive(Serialize)]
struct Failed {
    input: String,
    error: String,
}

/// The report of a sequence, as JSON.
#[derive(Serialize)]
struct SequenceReport<'a> {
    vglare: &'static str,
    #[serde(flatten)]
    run: Run,
    /// A report each.
    frames: Frames<'a>,
    failed: &'a [Failed],
    summary: Summary,
}

/// The reports of all photos.
#[derive(Serialize)]
#[serde(untagged)]
enum Frames<'a> {
    Some(&'a Spool),
    None([(); 0]),
}

#[derive(Serialize)]
struct Summary {
    photos: usize,
    written: usize,
    /// Of an earlier run, which are not among the frames here.
    skipped: usize,
    failed: usize,
    /// With an error above the tolerance.
    above_tolerance: usize,
    worst_error: Option<f64>,
    worst_photo: Option<String>,
    seconds: f64,
    /// Of those that were written.
    photos_per_second: Option<f64>,
    side_by_side: bool,
}

impl<'a> Tally<'a> {
    pub fn new(args: &'a Args, sequence: &'a Sequence, progress: &'a Progress) -> Self {
        let tally = Self {
            args,
            sequence,
            progress,
            started: Instant::now(),
            done: 0,
            written: 0,
            skipped: 0,
            failed: Vec::new(),
            first_error: None,
            bad: 0,
            measured: 0,
            missed: 0,
            worst: None,
            renderer: None,
            reports: None,
        };
        tally.show();
        tally
    }

    /// Tells of photos that were asked for and are not there.
    pub fn lack(&mut self, missing: &[(PathBuf, shot::Frames)]) {
        if missing.is_empty() {
            return;
        }
        let error = Error::MissingFrames { missing: missing.to_owned() };
        self.progress.aside(|| stderr::tell(&error));
        self.first_error = Some(error);
        for (pattern, frames) in missing {
            self.failed.extend(frames.iter().map(|frame| {
                let missing = vec![(pattern.clone(), [frame].into_iter().collect())];
                Failed { input: pattern.display().to_string(), error: Error::MissingFrames { missing }.to_string() }
            }));
        }
        self.done += self.failed.len();
        self.show();
    }

    /// Shows how far it is, here and to whoever ends the program by a signal.
    fn show(&self) {
        let total = self.sequence.asked();
        self.progress.counted("photos", [self.done, self.written, total], self.started.elapsed());
        let with = if self.args.sequence.resume { "" } else { " with --resume" };
        let there = self.written + self.skipped;
        signals::set_last_words(Some(format!(
            "{there} of {total} photos are done; the same command{with} does the others"
        )));
    }

    fn written(&mut self, photo: &Path, told: &Told) -> Result<()> {
        self.written += 1;
        self.bad += usize::from(told.bad);
        if self.renderer.is_none() {
            self.renderer = told.renderer.clone();
        }
        self.measure(photo, told.errors, told.missed);
        if let (Some(path), Some(report)) = (&self.args.output_options.report, &told.report) {
            let add = |reports: &mut Option<Spool>| {
                let reports = match reports {
                    Some(reports) => reports,
                    none => none.insert(Spool::new(target::folder(path))?),
                };
                reports.add(report)
            };
            add(&mut self.reports).map_err(|error| Error::write(path, error))?;
        }
        self.progress.aside(|| {
            stderr::warn(told.warnings.iter().map(|warning| format!("{}: {warning}", photo.display())));
            match &told.line {
                Some(line) => stdout::print(|out| out.write_all(line.as_bytes())),
                None => Ok(()),
            }
        })
    }

    /// Takes in how far the ghosts of a photo and its veil are from the truth, and whether that is further than was asked.
    fn measure(&mut self, photo: &Path, errors: [Option<Measured>; 2], missed: bool) {
        self.measured += usize::from(errors.iter().any(Option::is_some));
        self.missed += usize::from(missed);
        for (error, veil) in errors.into_iter().zip([false, true]) {
            let Some(Measured { measured, asked, .. }) = error else { continue };
            // Not a number is worse than any, in this order.
            let worse = |worst: &Worst| measured.abs().total_cmp(&worst.measured.abs()).is_gt();
            if self.worst.as_ref().is_none_or(worse) {
                self.worst = Some(Worst { photo: photo.to_owned(), measured, asked, veil });
            }
        }
    }

    /// Writes the report, prints the sum and gives the sequence's own error, if there is one.
    ///
    /// # Errors
    /// The first photo's that could not be done; [`Error::Frames`] where the others were; [`Error::FramesMissed`] under
    /// --strict; those of writing the report.
    pub fn finish(mut self) -> Result<()> {
        let seconds = self.started.elapsed().as_secs_f64();
        signals::set_last_words(None);
        if let Some(path) = &self.args.output_options.report {
            target::write_json(path, &self.report(seconds), self.args.overwrites())?;
        }
        if !self.args.quiet {
            self.progress.aside(|| stdout::print(|out| self.print(out, seconds)))?;
        }
        let frames = self.sequence.asked();
        match (self.first_error.take(), &self.worst) {
            (Some(first), _) if self.args.sequence.keep_going => {
                Err(Error::Frames { failed: self.failed.len(), frames, first: Box::new(first) })
            }
            (Some(first), _) => Err(first),
            (None, Some(worst)) if self.args.proof.strict && self.missed > 0 => Err(Error::FramesMissed {
                missed: self.missed,
                frames,
                worst: worst.photo.clone(),
                veil: worst.veil,
                measured: worst.measured,
                asked: worst.asked,
            }),
            _ => Ok(()),
        }
    }

    fn report(&self, seconds: f64) -> SequenceReport<'_> {
        SequenceReport {
            vglare: env!("CARGO_PKG_VERSION"),
            run: Run::now(),
            frames: self.reports.as_ref().map_or(Frames::None([]), Frames::Some),
            failed: &self.failed,
            summary: Summary {
                photos: self.sequence.asked(),
                written: self.written,
                skipped: self.skipped,
                failed: self.failed.len(),
                above_tolerance: self.missed,
                worst_error: self.worst.as_ref().map(|worst| worst.measured),
                worst_photo: self.worst.as_ref().map(|worst| worst.photo.display().to_string()),
                seconds,
                photos_per_second: (self.written > 0).then(|| self.written as f64 / seconds),
                side_by_side: self.args.sequence.side_by_side(),
            },
        }
    }

    fn print(&self, out: &mut dyn Write, seconds: f64) -> io::Result<()> {
        if self.bad > 0 {
            writeln!(out, "pixels   NaN, infinite or negative ones in {} photos; none counts as light", self.bad)?;
        }
        if let Some(worst) = &self.worst {
            let (measured, missed, all) = (worst.measured, self.missed, self.measured);
            let photo = worst.photo.display();
            writeln!(out, "error    {measured:.1e} at worst, in {photo}; {missed} of {all} above what was asked")?;
        }
        if let Some(renderer) = &self.renderer {
            writeln!(out, "renderer {renderer}")?;
        }
        if self.skipped > 0 {
            let skipped = self.skipped;
            writeln!(out, "resumed  {skipped} photos were done already")?;
        }
        let (written, all) = (self.written, self.sequence.asked() - self.skipped);
        match &self.sequence.place {
            Some(place) => {
                write!(out, "wrote    {written} of {all} pictures into {} in {seconds:.2} s", place.display())?
            }
            None => write!(out, "done     {written} of {all} photos, without pictures, in {seconds:.2} s")?,
        }
        if written > 1 { writeln!(out, ", {:.2} s each", seconds / written as f64) } else { writeln!(out) }
    }
}
