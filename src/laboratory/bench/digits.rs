//! What the last digits cost: the same field at a tolerance that 32-bit floats give, and at one that asks for 64.

use super::cases::described;
use super::report::{Report, Table, Target};
use super::scenes;
use super::stage::{Actor, Arm, Stage};
use crate::Result;
use crate::certificate::Certificate;
use crate::measure::interleave;
use crate::plan::plan;
use crate::problem::Problem;
use crate::{chance::Chance, scene::Ghost};

/// How many Gaussians, and of which sizes.
const COUNT: usize = 300;
const SIZES: [f64; 2] = [0.03, 0.5];
const SEED: u64 = 0x5eed;

const TOLERANCES: [f64; 2] = [1e-5, 1e-7];
/// How many times as long the finer of them may take.
const BAR: f64 = 4.0;

/// Spectrum and picture at both tolerances, in turns.
pub(super) fn in_doubles(stage: &Stage, report: &mut Report) -> Result<()> {
    let problem = Problem::new(gaussians(stage), stage.frame);
    let plans = TOLERANCES.map(|tolerance| plan(&problem, &stage.request(tolerance)));
    let [coarse, fine] = plans;
    let (coarse, fine) = (coarse?, fine?);
    let (mut coarsely, mut finely) = (stage.actor(&coarse)?, stage.actor(&fine)?);
    let mut note = String::new();
    for (plan, actor) in [(&coarse, &mut coarsely), (&fine, &mut finely)] {
        let found = certified(actor, plan)?;
        let (measured, predicted) = (found.measured, found.predicted);
        let sentence = format!(
            "At {:e} by {}. {} Off by {measured:.1e}, {predicted:.1e} predicted. ",
            plan.tolerance,
            plan.evaluator(),
            described(plan)
        );
        note.push_str(&sentence);
    }
    let arms: [Arm<'_>; 2] = [&mut || coarsely.everything(), &mut || finely.everything()];
    let [coarse, fine] = interleave(stage.rounds, arms)?;
    let ratio = fine.over(&coarse);
    let title = format!("{COUNT} Gaussians of {} to {}, in 32-bit floats and in 64", SIZES[0], SIZES[1]);
    let mut table = Table::new(title, "1e-5").note(note.trim_end().to_owned());
    table.row("tolerance 1e-5", &coarse, None);
    table.row("tolerance 1e-7", &fine, Some(ratio));
    report.table(table);
    report.bar("tolerance 1e-7 / tolerance 1e-5".to_owned(), Target::AtMost(BAR), ratio.paired);
    Ok(())
}

fn certified(actor: &mut Actor, plan: &crate::plan::Plan) -> Result<Certificate> {
    Certificate::measure(&mut actor.renderer().field, plan)
}

/// Gaussians anywhere in the picture, as many in each octave of sizes.
fn gaussians(stage: &Stage) -> Vec<Ghost> {
    let mut chance = Chance::new(SEED);
    let aspect = stage.frame.half_width();
    let one = |_| {
        let center = glam::DVec2::new(chance.between(-aspect, aspect), chance.between(-1.0, 1.0));
        let size = (chance.between(SIZES[0].ln(), SIZES[1].ln())).exp();
        scenes::gaussian(center, size, [0; 3].map(|_| chance.between(0.2, 1.0)))
    };
    (0..COUNT).map(one).collect()
}
