//! Small bells, each where it reaches, against a copy of the picture.

use super::report::{Report, Table, Target};
use super::scenes;
use super::stage::{Actor, Stage, Steps};
use crate::Result;
use crate::plan::{Evaluator, Request, plan};
use crate::problem::Problem;
use crate::scene::Ghost;
use crate::series::{Bell, Disc};

const TOLERANCE: f64 = 1e-3;

/// The rims of the discs, in sizes, and the blades of those that are no circles.
const RIM: f64 = 0.05;
const BLADES: u32 = 6;

/// How many, of which bell, from which size to which, in half picture heights; and how many copies upload and field may take.
fn cases() -> Vec<(usize, Bell, [f64; 2], f64)> {
    let discs =
        [0, BLADES].map(|blades| Disc::new(RIM, blades, 0.0).map(|disc| (200, Bell::Disc(disc), [0.02, 0.3], 12.0)));
    let others = [
        (1000, Bell::Gaussian, [0.005; 2], 3.0),
        (10_000, Bell::Gaussian, [0.005; 2], 6.0),
        (100_000, Bell::Gaussian, [0.003; 2], 30.0),
        (500, Bell::Paraboloid, [0.1; 2], 10.0),
    ];
    others.into_iter().chain(discs.into_iter().flatten()).collect()
}

/// Plans them for `local`, and measures plan, upload, field and picture.
pub(super) fn against_a_copy(stage: &Stage, report: &mut Report) -> Result<()> {
    for (count, bell, sizes, most) in cases() {
        let ghosts = scenes::between(count, sizes, stage.frame).into_iter();
        let ghosts: Vec<Ghost> = ghosts.map(|ghost| Ghost { bell: bell.clone(), ..ghost }).collect();
        let [smallest, largest] = sizes;
        let what = match &bell {
            Bell::Disc(disc) if !disc.is_round() => format!("{bell} with {} blades", disc.blades()),
            bell => bell.to_string(),
        };
        let size = if smallest == largest { smallest.to_string() } else { format!("{smallest} to {largest}") };
        let problem = Problem::new(ghosts, stage.frame);
        let request = Request { evaluator: Some(Evaluator::Local), ..stage.request(TOLERANCE) };
        let planned = plan(&problem, &request)?;
        let Steps { certificate, copy, plan, spectrum: upload, drawing: field, together } =
            stage.steps(&planned, &request, Actor::field)?;
        let reached = planned.local().map_or(0.0, |local| local.reached) / stage.frame.window.pixels() as f64;
        let title = format!("local against a copy: K = {count}, {what} of {size}, tolerance {TOLERANCE:e}");
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
        report.bar(
            format!("local, K = {count}, {what} of {size}: upload and field / copy"),
            Target::AtMost(most),
            ratio,
        );
    }
    Ok(())
}
