//! What is measured against what.

use std::cell::RefCell;

use super::report::{Report, Table, Target};
use super::scenes;
use super::stage::{Arm, Stage};
use crate::Result;
use crate::measure::interleave;
use crate::plan::{Evaluator, Lattice, Plan, Transform};
use crate::scene::Ghost;

/// The bar of the default path: a spectrum and a frame, in copies.
const FRAME: f64 = 4.0;
/// The bar of `rows` against `series`.
const ROWS: f64 = 5.0;

const TOLERANCE: f64 = 1e-3;
/// Of series that are given by hand.
pub(super) const DEGREE: [u32; 2] = [10, 10];

/// A frame by `grid` at the usual tolerance, against a copy.
pub(super) fn default_path(stage: &Stage, report: &mut Report) -> Result<()> {
    grid(stage, report, &scenes::default_lens()?)?;
    grid(stage, report, &scenes::scattered(1000, 0.1, stage.frame))
}

fn grid(stage: &Stage, report: &mut Report, ghosts: &[Ghost]) -> Result<()> {
    let plan = scenes::by(Evaluator::Grid, ghosts, stage.frame, TOLERANCE)?;
    let mut actor = stage.actor(&plan)?;

    let shared = RefCell::new(&mut actor);
    let arms: [Arm<'_>; 4] = [
        &mut || shared.borrow_mut().copy(),
        &mut || shared.borrow_mut().spectrum(),
        &mut || shared.borrow_mut().frame(),
        &mut || shared.borrow_mut().everything(),
    ];
    let [copy, spectrum, frame, together] = interleave(stage.rounds, arms)?;
    let passes = actor.passes(stage.rounds, |actor| actor.copy().and_then(|()| actor.everything()))?;

    let count = ghosts.len();
    let mut table = Table::new(format!("grid against a copy: K = {count}, tolerance {TOLERANCE:e}"), "copy")
        .note(format!("{} Then pass by pass, the device idle before and after each.", described(&plan)));
    table.row("copy, as a whole", &copy, None);
    for (what, samples) in [("spectrum", &spectrum), ("field and composite", &frame), ("together", &together)] {
        table.row(format!("{what}, as a whole"), samples, Some(samples.over(&copy)));
    }
    for pass in &passes {
        table.pass(pass, passes.first());
    }
    report.table(table);
    report.bar(format!("grid, K = {count}: together / copy"), Target::AtMost(FRAME), together.over(&copy).paired);
    Ok(())
}

/// `rows` against `series`, which does the same sum without taking it apart.
pub(super) fn rows_and_series(stage: &Stage, report: &mut Report) -> Result<()> {
    let ghosts = scenes::scattered(45, 0.3, stage.frame);
    let actor = |evaluator| stage.actor(&scenes::by_hand(evaluator, &ghosts, stage.frame, DEGREE)?);
    let (mut rows, mut series) = (actor(Evaluator::Rows)?, actor(Evaluator::Series)?);
    let arms: [Arm<'_>; 2] = [&mut || rows.frame(), &mut || series.frame()];
    let [rows, series] = interleave(stage.rounds, arms)?;

    let mut table = Table::new("rows against series: N = M = 10", "rows");
    table.row("rows", &rows, None);
    table.row("series", &series, Some(series.over(&rows)));
    report.table(table);
    report.bar("series / rows, N = M = 10", Target::AtLeast(ROWS), series.over(&rows).paired);
    Ok(())
}

/// Each evaluator pass by pass: `series` at a degree by hand, because at a tolerance it takes minutes on a CPU.
pub(super) fn passes(stage: &Stage, report: &mut Report, quick: bool) -> Result<()> {
    let lens = scenes::default_lens()?;
    let at_tolerance = |evaluator| scenes::by(evaluator, lens.as_slice(), stage.frame, TOLERANCE);
    let by_hand = |evaluator| {
        let ghosts = scenes::scattered(lens.len(), 0.3, stage.frame);
        scenes::by_hand(evaluator, &ghosts, stage.frame, DEGREE)
    };
    let mut cases = vec![at_tolerance(Evaluator::Direct)?, at_tolerance(Evaluator::Rows)?, by_hand(Evaluator::Rows)?];
    if !quick {
        cases.push(by_hand(Evaluator::Series)?);
    }
    for plan in cases {
        let mut actor = stage.actor(&plan)?;
        let passes = actor.passes(stage.rounds, |actor| actor.copy().and_then(|()| actor.everything()))?;
        let title = format!("{} pass by pass: K = {}", plan.evaluator(), plan.problem().ghosts().len());
        let mut table = Table::new(title, "copy").note(described(&plan));
        passes.iter().for_each(|pass| table.pass(pass, passes.first()));
        report.table(table);
    }
    Ok(())
}

pub(super) fn described(plan: &Plan) -> String {
    if !plan.evaluator().is_series() {
        return format!("{} ghosts reach the picture.", plan.ghosts());
    }
    let [n, m] = plan.degree();
    let lattice = plan.lattice().map(|Lattice { nodes: [x, y], .. }| format!(", a lattice of {x} × {y} nodes"));
    let groups = plan.groups().count();
    let gathered = match plan.groups().filter(|group| matches!(group.transform, Transform::Gather(_))).count() {
        0 => String::new(),
        gathered => format!(", {gathered} of them gathered"),
    };
    format!("N = {n}, M = {m}, {} terms, {groups} groups{gathered}{}.", plan.terms(), lattice.unwrap_or_default())
}
