//! Few ghosts against many: only the spectrum and `direct` may take longer.

use super::cases::DEGREE;
use super::report::{Report, Table, Target};
use super::scenes;
use super::stage::{Arm, Stage};
use crate::Result;
use crate::frame::{Frame, Window};
use crate::measure::{Samples, interleave};
use crate::plan::Evaluator;
use crate::scene::Ghost;

const FEW: usize = 5;
const MANY: usize = 100_000;
/// How far the ratio may be from 1.
const BAR: f64 = 0.05;
/// Where `direct` sums many ghosts: a software renderer would need minutes for the whole picture.
const SMALL: [u32; 2] = [64, 36];

/// A frame's time at both numbers, with the same period, degree, lattice and evaluator.
pub(super) fn ghosts(stage: &Stage, report: &mut Report, quick: bool) -> Result<()> {
    let [few, many] = [FEW, MANY].map(|count| scenes::scattered(count, 0.3, stage.frame));
    let mut table = Table::new(format!("Few ghosts against many: K = {FEW} and {MANY}, N = M = 10"), "few");
    for evaluator in [Evaluator::Grid, Evaluator::Rows, Evaluator::Series] {
        if quick && evaluator == Evaluator::Series {
            continue;
        }
        let by_hand = |ghosts: &[Ghost]| scenes::by_hand(evaluator, ghosts, stage.frame, DEGREE);
        let [few, many] = [by_hand(&few)?, by_hand(&many)?];
        // The same work, whatever the plan thinks of its error.
        let few = few.with_series(|series| series.lattice = many.lattice().copied());
        let (mut once, mut often) = (stage.actor(&few)?, stage.actor(&many)?);
        let ratio = pair(stage, &mut table, &evaluator.to_string(), [&mut || once.frame(), &mut || often.frame()])?;
        report.bar(format!("{evaluator}, K = {MANY} / K = {FEW}"), Target::Equal(BAR), ratio);
        if evaluator == Evaluator::Grid {
            pair(stage, &mut table, "spectrum", [&mut || once.spectrum(), &mut || often.spectrum()])?;
        }
    }
    direct(stage, &mut table, &few, &many)?;
    let [width, height] = SMALL;
    report.table(table.note(format!(
        "direct with many ghosts was measured on {width} × {height} pixels and scaled to the picture's size."
    )));
    Ok(())
}

/// Measures few and many in turns, and gives the ratio.
fn pair(stage: &Stage, table: &mut Table, what: &str, arms: [Arm<'_>; 2]) -> Result<f64> {
    let [few, many] = interleave(stage.rounds, arms)?;
    let ratio = many.over(&few);
    table.row(format!("{what}, few"), &few, None);
    table.row(format!("{what}, many"), &many, Some(ratio));
    Ok(ratio.paired)
}

fn direct(stage: &Stage, table: &mut Table, few: &[Ghost], many: &[Ghost]) -> Result<()> {
    let small = middle(stage.frame, SMALL);
    let by_direct = |ghosts: &[Ghost], frame| scenes::by(Evaluator::Direct, ghosts, frame, 1e-3);
    let mut once = stage.actor(&by_direct(few, stage.frame)?)?;
    let mut often = stage.actor(&by_direct(many, small)?)?;
    let [once, often] = interleave(stage.rounds, [&mut || once.frame(), &mut || often.frame()] as [Arm<'_>; 2])?;
    let often: Samples = often.scaled(stage.frame.window.pixels() as f64 / small.window.pixels() as f64);
    table.row("direct, few", &once, None);
    table.row("direct, many (scaled)", &often, Some(often.over(&once)));
    Ok(())
}

/// The picture's middle, or all of it where it is no larger.
fn middle(frame: Frame, [width, height]: [u32; 2]) -> Frame {
    let (width, height) = (width.min(frame.width), height.min(frame.height));
    let (x, y) = ((frame.width - width) / 2, (frame.height - height) / 2);
    frame.with_window(Window { x: x as i32, y: y as i32, width, height })
}
