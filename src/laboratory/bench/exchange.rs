//! The photo's way to the device and the picture's way back, straight and through pixel buffers.

use super::report::{Report, Table};
use super::scenes;
use super::stage::{Arm, Stage};
use crate::Result;
use crate::measure::interleave;
use crate::plan::Evaluator;
use crate::renderer::Settings;

/// Upload, read-back and a whole frame from photo to photo, each in both ways.
pub(super) fn ways(stage: &Stage, report: &mut Report) -> Result<()> {
    let plan = scenes::by(Evaluator::Grid, scenes::default_lens()?, stage.frame, 1e-3)?;
    let mut table = Table::new("To the device and back", "straight")
        .note("Pixel buffers cost the CPU one more copy; while the device fills or empties them, it need not wait.");
    let actor = |buffers| {
        let mut actor = stage.actor(&plan)?;
        actor.renderer().set_pixel_buffers(buffers);
        actor.frame()?;
        Ok::<_, crate::Error>(actor)
    };
    let (mut straight, mut buffered) = (actor(false)?, actor(true)?);
    let (frame, settings) = (stage.frame, Settings::default());
    let mut pixels = [(); 2].map(|()| vec![[0.5; 4]; frame.window.pixels()]);
    let [mine, its] = &mut pixels;

    let arms: [Arm<'_>; 2] =
        [&mut || straight.renderer().load(frame, mine).and_then(|()| straight.finish()), &mut || {
            buffered.renderer().load(frame, its).and_then(|()| buffered.finish())
        }];
    pair(stage, &mut table, "upload", arms)?;
    let arms: [Arm<'_>; 2] =
        [&mut || straight.renderer().fetch(frame, mine), &mut || buffered.renderer().fetch(frame, its)];
    pair(stage, &mut table, "read-back", arms)?;
    let arms: [Arm<'_>; 2] = [&mut || straight.renderer().composite(frame, mine, &settings), &mut || {
        buffered.renderer().composite(frame, its, &settings)
    }];
    pair(stage, &mut table, "from photo to picture", arms)?;
    report.table(table);
    Ok(())
}

fn pair(stage: &Stage, table: &mut Table, what: &str, arms: [Arm<'_>; 2]) -> Result<()> {
    let [straight, buffered] = interleave(stage.rounds, arms)?;
    table.row(format!("{what}, straight"), &straight, None);
    table.row(format!("{what}, through buffers"), &buffered, Some(buffered.over(&straight)));
    Ok(())
}
