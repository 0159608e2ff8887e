//! A field of Gaussians of one size, step by step: what benches/peers compares with other programs.

use super::cases::described;
use super::report::{Report, Table};
use super::scenes;
use super::stage::{Actor, Stage, Steps};
use crate::Result;
use crate::plan::plan;
use crate::problem::Problem;

/// Plans, then measures the spectrum and the field, each as a whole.
pub(super) fn of_one_size(stage: &Stage, report: &mut Report, count: usize, sigma: f64, tolerance: f64) -> Result<()> {
    let width = 2.0 * f64::from(stage.frame.width) / f64::from(stage.frame.height);
    let problem = Problem::new(scenes::alike(count, sigma * width, stage.frame), stage.frame);
    let request = stage.request(tolerance);
    let planned = plan(&problem, &request)?;
    let Steps { certificate, copy, plan, spectrum, drawing: field, together } =
        stage.steps(&planned, &request, Actor::frame)?;
    let note = format!(
        "By {}. {} Off by {:.1e}, {:.1e} predicted.",
        planned.evaluator(),
        described(&planned),
        certificate.measured,
        certificate.predicted
    );
    let title = format!("{count} Gaussians, sigma {sigma} of the width, tolerance {tolerance:e}");
    let mut table = Table::new(title, "copy").note(note);
    table.row("copy", &copy, None);
    for (what, samples) in [("plan", &plan), ("spectrum", &spectrum), ("field", &field), ("together", &together)] {
        table.row(what, samples, Some(samples.over(&copy)));
    }
    report.table(table);
    Ok(())
}
