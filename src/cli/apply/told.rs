//! What is told of a photo that was written, by the process that did it.

use std::io::{self, Write};

use serde::{Deserialize, Serialize};

use super::Args;
use super::job::Job;
use super::report::Report;
use super::shot;
use crate::job::{Computed, Done};
use crate::shot::Measured;

/// All that a sequence wants to know of a photo that was written.
#[derive(Debug, Serialize, Deserialize)]
pub struct Told {
    /// Whether it has pixels that are no light.
    pub bad: bool,
    /// Of the ghosts and of the veil.
    pub errors: [Option<Measured>; 2],
    /// Whether one of them is further off than was asked.
    pub missed: bool,
    pub warnings: Vec<String>,
    /// What it was rendered by, and how.
    pub renderer: Option<String>,
    /// Where more is to be said.
    pub line: Option<String>,
    /// Where there is to be a report: its own, as JSON in a line.
    pub report: Option<String>,
}

impl Told {
    /// What the options ask for.
    ///
    /// # Errors
    /// None but those of JSON.
    pub fn new(args: &Args, job: &Job<'_, Done<'_>>) -> io::Result<Self> {
        let work = &job.work;
        let report =
            args.output_options.report.is_some().then(|| serde_json::to_string(&Report::new(job))).transpose()?;
        let mut text = Vec::new();
        if args.verbose {
            line(&mut text, job)?;
        }
        Ok(Self {
            bad: work.bad.first.is_some(),
            errors: shot::measured(work),
            missed: work.check().is_err(),
            warnings: work.warnings.clone(),
            renderer: work.computed.as_ref().map(|Computed { info, .. }| format!("{}, {}", info.renderer, info.route)),
            line: args.verbose.then(|| String::from_utf8_lossy(&text).into_owned()),
            report,
        })
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
