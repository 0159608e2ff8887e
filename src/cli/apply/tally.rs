//! What became of the photos of a sequence: told as they are done, and in sum.

use std::io::{self, Write};
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;

use serde::Serialize;

use super::Args;
use super::job::Job;
use super::outputs::{Paths, Sequence};
use super::report::Report;
use super::spool::Spool;
use crate::gpu::Info;
use crate::job::{Computed, Done};
use crate::terminal::progress::Progress;
use crate::terminal::{stderr, stdout};
use crate::{Error, Result, panics, target};

/// What has become of the photos so far.
pub struct Tally<'a> {
    args: &'a Args,
    sequence: &'a Sequence,
    progress: &'a Progress,
    started: Instant,
    done: usize,
    written: usize,
    failed: Vec<Failed>,
    first_error: Option<Error>,
    /// Photos with pixels that are no light.
    bad: usize,
    measured: usize,
    missed: usize,
    worst: Option<Worst>,
    info: Option<Arc<Info>>,
    /// A report a photo, once there is one and where it is asked for.
    reports: Option<Spool>,
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
    failed: usize,
    /// With an error above the tolerance.
    above_tolerance: usize,
    worst_error: Option<f64>,
    worst_photo: Option<String>,
    seconds: f64,
    side_by_side: bool,
}

impl<'a> Tally<'a> {
    pub fn new(args: &'a Args, sequence: &'a Sequence, progress: &'a Progress) -> Self {
        Self {
            args,
            sequence,
            progress,
            started: Instant::now(),
            done: 0,
            written: 0,
            failed: Vec::new(),
            first_error: None,
            bad: 0,
            measured: 0,
            missed: 0,
            worst: None,
            info: None,
            reports: None,
        }
    }

    /// Counts a photo that was written, or why it was not; says whether to go on.
    pub fn add(&mut self, paths: &Paths, done: Result<Job<'_, Done<'_>>>) -> ControlFlow<()> {
        let result = done.and_then(|job| panics::caught(|| self.written(&job)));
        let total = self.sequence.frames.len();
        if let Err(error) = result {
            let error = error.in_frame(&paths.input);
            self.failed.push(Failed { input: paths.input.display().to_string(), error: error.to_string() });
            if self.args.sequence.keep_going {
                self.progress.aside(|| stderr::tell(&error));
            }
            self.first_error.get_or_insert(error);
            if !self.args.sequence.keep_going {
                return ControlFlow::Break(());
            }
        }
        self.done += 1;
        self.progress.part(format!("{} of {total} photos", self.done), self.done as f64 / total as f64);
        ControlFlow::Continue(())
    }

    fn written(&mut self, job: &Job<'_, Done<'_>>) -> Result<()> {
        self.written += 1;
        self.bad += usize::from(job.work.bad.first.is_some());
        let Done { computed, veiled, .. } = &job.work;
        let glare = computed.as_ref().map(|computed| (computed.certificate.measured, computed.certificate.asked));
        let veil = veiled.as_ref().map(|veiled| (veiled.error.measured, veiled.error.asked));
        if let Some(Computed { info, .. }) = computed {
            self.info.get_or_insert_with(|| info.clone());
        }
        self.measured += usize::from(glare.or(veil).is_some());
        self.missed += usize::from(job.work.check().is_err());
        let of = |error: Option<(f64, f64)>, veil| error.map(|(measured, asked)| (measured, asked, veil));
        for (measured, asked, veil) in of(glare, false).into_iter().chain(of(veil, true)) {
            // Not a number is worse than any, in this order.
            let worse = |worst: &Worst| measured.abs().total_cmp(&worst.measured.abs()).is_gt();
            if self.worst.as_ref().is_none_or(worse) {
                self.worst = Some(Worst { photo: job.paths.input.clone(), measured, asked, veil });
            }
        }
        if let Some(path) = &self.args.output_options.report {
            let add = |reports: &mut Option<Spool>| {
                let reports = match reports {
                    Some(reports) => reports,
                    none => none.insert(Spool::new(target::folder(path))?),
                };
                reports.add(&Report::new(job))
            };
            add(&mut self.reports).map_err(|error| Error::write(path, error))?;
        }
        self.progress.aside(|| {
            let input = job.paths.input.display();
            stderr::warn(job.work.warnings.iter().map(|warning| format!("{input}: {warning}")));
            if self.args.verbose { stdout::print(|out| line(out, job)) } else { Ok(()) }
        })
    }

    /// Writes the report, prints the sum and gives the sequence's own error, if there is one.
    ///
    /// # Errors
    /// The first photo's that could not be done; [`Error::Frames`] where the others were; [`Error::FramesMissed`] under
    /// --strict; those of writing the report.
    pub fn finish(mut self) -> Result<()> {
        let seconds = self.started.elapsed().as_secs_f64();
        if let Some(path) = &self.args.output_options.report {
            target::write_json(path, &self.report(seconds), self.args.force)?;
        }
        if !self.args.quiet {
            self.progress.aside(|| stdout::print(|out| self.print(out, seconds)))?;
        }
        let frames = self.sequence.frames.len();
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
            frames: self.reports.as_ref().map_or(Frames::None([]), Frames::Some),
            failed: &self.failed,
            summary: Summary {
                photos: self.sequence.frames.len(),
                written: self.written,
                failed: self.failed.len(),
                above_tolerance: self.missed,
                worst_error: self.worst.as_ref().map(|worst| worst.measured),
                worst_photo: self.worst.as_ref().map(|worst| worst.photo.display().to_string()),
                seconds,
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
        if let Some(info) = &self.info {
            writeln!(out, "renderer {}, {}", info.renderer, info.route)?;
        }
        let (written, all) = (self.written, self.sequence.frames.len());
        match &self.sequence.place {
            Some(place) => {
                write!(out, "wrote    {written} of {all} pictures into {} in {seconds:.2} s", place.display())?
            }
            None => write!(out, "done     {written} of {all} photos, without pictures, in {seconds:.2} s")?,
        }
        if written > 1 { writeln!(out, ", {:.2} s each", seconds / written as f64) } else { writeln!(out) }
    }
}

/// A photo that was written, in a line.
fn line(out: &mut dyn Write, job: &Job<'_, Done<'_>>) -> io::Result<()> {
    let (frame, scene) = (job.work.facts.frame, &job.work.scene);
    let path = job.paths.files().next().unwrap_or(&job.paths.input);
    write!(out, "photo    {}: {} x {}, ", path.display(), frame.width, frame.height)?;
    if let Some(found) = &scene.found {
        write!(out, "{} lights at {:.4} and above, ", scene.lights.len(), found.threshold)?;
    }
    match &scene.images {
        Some(images) => write!(out, "{} ghosts of each pixel, ", images.of_each())?,
        None => write!(out, "{} ghosts, ", scene.ghosts.len())?,
    }
    if let Some(Computed { planning, certificate, .. }) = &job.work.computed {
        write!(out, "{}, error {:.1e}, ", planning.plan.evaluator(), certificate.measured)?;
    }
    let total: f64 = job.work.stages.0.iter().map(|(_, ms)| ms).sum();
    writeln!(out, "{:.2} s", total * 1e-3)?;
    let notes = job.work.computed.iter().flat_map(|computed| &computed.planning.notes);
    notes.into_iter().try_for_each(|note| writeln!(out, "note     {note}"))
}
