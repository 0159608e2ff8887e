//! Small bells, each where it reaches, against a copy of the picture.

use super::report::{Report, Table, Target};
use super::scenes;
use super::stage::{Actor, Stage, Steps};
use crate::Result;
use crate::plan::{Evaluator, Request, plan};
use crate::problem::Problem;
use crate::scene::Ghost;
use crate::series::Bell;

const TOLERANCE: f64 = 1e-3;

/// How many, of which bell and size, in half picture heights; and how many copies upload and field may take.
const CASES: [(usize, Bell, f64, f64); 4] = [
    (1000, Bell::Gaussian, 0.005, 3.0),
    (10_000, Bell::Gaussian, 0.005, 6.0),
    (100_000, Bell::Gaussian, 0.003, 30.0),
    (500, Bell::Paraboloid, 0.1, 10.0),
];

/// Plans them for `local`, and measures plan, upload, field and picture.
pub(super) fn against_a_copy(stage: &Stage, report: &mut Report) -> Result<()> {
    for (count, bell, size, most) in CASES {
        let ghosts = scenes::alike(count, size, stage.frame).into_iter();
        let ghosts: Vec<Ghost> = ghosts.map(|ghost| Ghost { bell: bell.clone(), ..ghost }).collect();
        let problem = Problem::new(ghosts, stage.frame);
        let request = Request { evaluator: Some(Evaluator::Local), ..stage.request(TOLERANCE) };
        let planned = plan(&problem, &request)?;
        let Steps { certificate, copy, plan, spectrum: upload, drawing: field, together } =
            stage.steps(&planned, &request, Actor::field)?;
        let reached = planned.local().map_or(0.0, |local| local.reached) / stage.frame.window.pixels() as f64;
        let title = format!("local against a copy: K = {count}, {bell} of {size}, tolerance {TOLERANCE:e}");
        let mut table = Table::new(title, "copy").note(format!(
            "{reached:.2} bells at a pixel. Off by {:.1e}, {:.1e} predicted.",
            certificate.measured, certificate.predicted
        ));
        table.row("copy", &copy, None);
        let rows = [("plan", &plan), ("upload", &upload), ("upload and field", &field), ("together", &together)];
        for (what, samples) in rows {
            table.row(what, samples, Some(samples.over(&copy)));
        }
        report.table(table);
        let ratio = field.over(&copy).paired;
        report.bar(format!("local, K = {count} of {size}: upload and field / copy"), Target::AtMost(most), ratio);
    }
    Ok(())
}
