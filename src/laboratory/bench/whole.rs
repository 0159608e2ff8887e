//! Ghosts of the whole photo: what their spectrum takes, from the photo's pixels on, and their field, beside a copy.

use std::cell::RefCell;
use std::hint::black_box;
use std::sync::Arc;

use glam::DVec2;

use super::report::{Report, Table, Target};
use super::stage::{Arm, Stage};
use super::veil;
use crate::Result;
use crate::chance::Chance;
use crate::measure::interleave;
use crate::plan::plan;
use crate::problem::{Images, Problem};
use crate::raster::Raster;
use crate::scene::LensGhost;
use crate::series::Bell;

/// Ghosts of a lens, and how many milliseconds their spectrum may take.
const CASES: [(u64, f64); 2] = [(20, 40.0), (400, 500.0)];

/// How many copies the field may take.
const FIELD: f64 = 4.0;

/// The tolerance.
const ASKED: f64 = 1e-3;

/// Measures the spectrum, the field and a copy in turns.
pub(super) fn against_a_copy(stage: &Stage, report: &mut Report) -> Result<()> {
    let frame = stage.frame;
    let pixels = veil::photo([frame.width as usize, frame.height as usize]);
    let mut table = Table::new("Every pixel makes every ghost", "copy");
    for (ghosts, most) in CASES {
        let lens = lens(ghosts);
        let request = stage.request(ASKED);
        let planned = || {
            let raster = Raster::new(&pixels, frame)?;
            let images = Images::new(raster, &lens, DVec2::ZERO, 1.0, [1.0; 3]);
            plan(&Problem::with_images([], Arc::new(images), frame), &request)
        };
        let known = planned()?;
        let actor = RefCell::new(stage.actor(&known)?);
        let arms: [Arm<'_>; 3] =
            [&mut || actor.borrow_mut().copy(), &mut || planned().map(|plan| drop(black_box(plan))), &mut || {
                actor.borrow_mut().field()
            }];
        let [copy, spectrum, field] = interleave(stage.rounds, arms)?;
        let what = format!("{ghosts} ghosts, {} at {ASKED:e}", known.evaluator());
        table.row(format!("copy, for {what}"), &copy, None);
        table.row(format!("{what}: plan and spectrum, from pixels on"), &spectrum, Some(spectrum.over(&copy)));
        let ratio = field.over(&copy);
        table.row(format!("{what}: field"), &field, Some(ratio));
        report.bar(format!("{ghosts} ghosts of every pixel: spectrum, ms"), Target::AtMost(most), spectrum.median());
        report.bar(format!("{ghosts} ghosts of every pixel: field / copy"), Target::AtMost(FIELD), ratio.paired);
    }
    report.table(table);
    Ok(())
}

/// Gaussians from 0.06 on, the same every time.
pub(super) fn lens(ghosts: u64) -> Vec<LensGhost> {
    let mut chance = Chance::new(ghosts);
    let mut ghost = |_| LensGhost {
        bell: Bell::Gaussian,
        along: chance.between(-1.5, 1.5),
        size: DVec2::splat(0.06 * 2f64.powf(chance.between(0.0, 3.0))),
        tint: [0; 3].map(|_| chance.between(0.3, 1.0)),
        share: chance.between(1e-5, 1e-3),
    };
    (0..ghosts).map(&mut ghost).collect()
}
