//! The first frame: what is paid once, before anything can be fast.

use std::time::{Duration, Instant};

use super::report::{Report, Table};
use super::scenes;
use super::stage::{Stage, sums};
use crate::Result;
use crate::gpu::PassTime;
use crate::measure::Samples;
use crate::plan::{Request, plan};
use crate::problem::Problem;
use crate::renderer::{Picture, Settings};

/// A frame of the default path from photo to photo, twice: the second needs no shader compiled.
pub(super) fn frame(stage: &Stage, opened: Duration, report: &mut Report) -> Result<()> {
    let problem = Problem::new(scenes::default_lens()?, stage.frame);
    let mut pixels = vec![[0.5; 4]; stage.frame.window.pixels()];
    let started = Instant::now();
    let plan = plan(&problem, &Request { cost_model: stage.cost_model, ..Request::new(1e-3) })?;
    let planned = started.elapsed();

    let started = Instant::now();
    let mut renderer = stage.renderer()?;
    renderer.field.set_timing(true);
    let ready = started.elapsed();
    let mut frame = |renderer: &mut Picture| -> Result<(Duration, Vec<PassTime>)> {
        let started = Instant::now();
        renderer.field.forget_scene();
        renderer.field.set_scene(&plan)?;
        renderer.composite(stage.frame, &mut pixels, &Settings::default())?;
        Ok((started.elapsed(), sums(renderer.field.take_times())))
    };
    let (first, first_passes) = frame(&mut renderer)?;
    let (second, second_passes) = frame(&mut renderer)?;

    let title = format!("The first frame, with {} ghosts by {}", problem.ghosts().len(), plan.evaluator());
    let mut table = Table::new(title, "second").note(
        "Measured once; \"frame\" is from photo to photo, and what its passes do not add up to is compiling. A driver\n\
         may have kept shaders from an earlier run: Mesa does, unless MESA_SHADER_CACHE_DISABLE is true.",
    );
    let one = |milliseconds: f64| [milliseconds].into_iter().collect::<Samples>();
    let time = |duration: Duration| one(duration.as_secs_f64() * 1e3);
    table.row("open the device", &time(opened), None);
    table.row("plan", &time(planned), None);
    table.row("make the renderer", &time(ready), None);
    table.row("frame", &time(first), Some(time(first).over(&time(second))));
    for pass in &first_passes {
        let again = second_passes.iter().find(|again| again.pass == pass.pass).map(|again| one(again.wall_ms));
        let wall = one(pass.wall_ms);
        table.row(&pass.pass, &wall, again.map(|again| wall.over(&again)));
    }
    report.table(table);
    Ok(())
}
