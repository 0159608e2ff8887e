//! Ghosts of a real lens, of lamps on a ring; and many lights through many Gaussians: what their spectrum takes, and that their field does
//! not depend on how many they are.

use std::f64::consts::TAU;
use std::hint::black_box;
use std::sync::Arc;

use glam::DVec2;

use super::report::{Report, Table, Target};
use super::scenes;
use super::stage::{Actor, Arm, Stage, Steps};
use super::whole;
use crate::Result;
use crate::frame::Frame;
use crate::look::Look;
use crate::measure::{Samples, interleave};
use crate::plan::{Evaluator, Plan, Request, plan};
use crate::problem::Problem;
use crate::scene::{Ghost, Light, NamedLens, OpticsSection, named_lens};

/// The lens, and how it is open.
const LENS: &str = "double-gauss";
const FSTOP: f64 = 2.8;

/// Lamps, and how far off the axis they are.
const LAMPS: u32 = 20;
const OFF_AXIS: f64 = 10.0;

/// Tolerances, and how many copies plan, spectrum and field of the ring may take.
const RING: [(f64, f64); 2] = [(1e-2, 25.0), (1e-3, 60.0)];

/// Where bells are drawn without a plan: a software renderer needs half a minute for the whole picture.
const SMALL: [u32; 2] = [192, 108];

/// Lights and Gaussian ghosts of each: few, and many; how far the ratio of their fields may be from 1, and how many milliseconds the
/// spectrum of many may take.
const FEW: [u32; 2] = [5, 9];
const MANY: [u32; 2] = [1000, 400];
const FIELD: f64 = 0.05;
const SPECTRUM: f64 = 500.0;

/// Measures the ring and the crowd.
pub(super) fn against_a_copy(stage: &Stage, report: &mut Report) -> Result<()> {
    ring(stage, report)?;
    crowd(stage, report)
}

fn ring(stage: &Stage, report: &mut Report) -> Result<()> {
    let ghosts: Arc<[Ghost]> = ghosts_of_ring(stage.frame)?.into();
    let problem = Problem::new(ghosts.clone(), stage.frame);
    for (tolerance, most) in RING {
        let request = stage.request(tolerance);
        let planned = plan(&problem, &request)?;
        let Steps { certificate, copy, plan, spectrum, drawing: field, .. } =
            stage.steps(&planned, &request, Actor::field)?;
        let by_hand = without_a_plan(stage, ghosts.clone(), tolerance)?;
        let title =
            format!("{LAMPS} lamps through {LENS} at f/{FSTOP}: {} ghosts, tolerance {tolerance:e}", ghosts.len());
        let mut table = Table::new(title, "copy").note(format!(
            "By {}, {} terms. Off by {:.1e}, {:.1e} predicted. Every ghost drawn was measured on {} × {} pixels and scaled to the \
             picture's size.",
            planned.evaluator(),
            planned.terms(),
            certificate.measured,
            certificate.predicted,
            SMALL[0],
            SMALL[1],
        ));
        table.row("copy", &copy, None);
        let all = plan.plus(&field);
        let rows = [
            ("plan", &plan),
            ("spectrum", &spectrum),
            ("spectrum and field", &field),
            ("plan, spectrum and field", &all),
            ("every ghost drawn, without a plan", &by_hand),
        ];
        for (what, samples) in rows {
            table.row(what, samples, Some(samples.over(&copy)));
        }
        report.table(table);
        let ratio = all.over(&copy).paired;
        report.bar(format!("{LAMPS} lamps through {LENS} at {tolerance:e} / copy"), Target::AtMost(most), ratio);
    }
    Ok(())
}

/// What it takes to draw each ghost where it reaches.
fn without_a_plan(stage: &Stage, ghosts: Arc<[Ghost]>, tolerance: f64) -> Result<Samples> {
    let [width, height] = SMALL.map(|side| side.min(stage.frame.width.min(stage.frame.height)));
    let small = stage.frame.resized(width, height);
    let drawn = scenes::by(Evaluator::Local, ghosts, small, tolerance)?;
    let mut actor = stage.actor(&drawn)?;
    let arm: Arm<'_> = &mut || actor.field();
    let [samples] = interleave(stage.rounds, [arm])?;
    Ok(samples.scaled(stage.frame.window.pixels() as f64 / small.window.pixels() as f64))
}

/// Lamps on a ring about the middle of the picture.
fn ghosts_of_ring(frame: Frame) -> Result<Vec<Ghost>> {
    let section = OpticsSection { fstop: Some(FSTOP), ..OpticsSection::default() };
    let NamedLens::Optical(optical) = named_lens(LENS.as_ref(), &section)? else {
        unreachable!("the lens has surfaces");
    };
    let optical = optical.fitted(&frame);
    let radius = optical.place(OFF_AXIS.to_radians().tan());
    let lamp = |k: u32| Light {
        position: DVec2::from_angle(TAU * (f64::from(k) + 0.3) / f64::from(LAMPS)) * radius,
        flux: [1.0, 0.9, 0.8],
        size: 0.004,
        muted: false,
    };
    Ok(optical.ghosts_of(&(0..LAMPS).map(lamp).collect::<Vec<_>>(), Look::default().axis))
}

fn crowd(stage: &Stage, report: &mut Report) -> Result<()> {
    const TOLERANCE: f64 = 1e-3;
    let [few, many] = [FEW, MANY].map(|[lights, ghosts]| crowded(lights, ghosts, stage.frame));
    let of = |[lights, ghosts]: [u32; 2]| format!("{lights} lights, {ghosts} Gaussian ghosts of each");
    let mut table = Table::new(format!("{}; and {}", of(FEW), of(MANY)), "few");
    let request = stage.request(TOLERANCE);
    let many_planned = plan(&Problem::new(many, stage.frame), &request)?;
    // Of as many terms, whatever the plan thinks of the error.
    let few_planned = alike(few, &many_planned, stage.frame)?;
    let (mut once, mut often) = (stage.actor(&few_planned)?, stage.actor(&many_planned)?);
    let arms: [Arm<'_>; 2] = [&mut || once.frame(), &mut || often.frame()];
    let [few, many] = interleave(stage.rounds, arms)?;
    let ratio = many.over(&few);
    table.row("field, few", &few, None);
    table.row("field, many", &many, Some(ratio));
    report.bar(format!("field of {} / of {}", of(MANY), of(FEW)), Target::Equal(FIELD), ratio.paired);
    let problem = many_planned.problem().clone();
    let arms: [Arm<'_>; 2] =
        [&mut || plan(&problem, &request).map(|plan| drop(black_box(plan))), &mut || often.spectrum()];
    let [plan, spectrum] = interleave(stage.rounds, arms)?;
    table.row("plan, many", &plan, None);
    table.row("spectrum, many", &spectrum, None);
    report.bar(format!("spectrum of {}, ms", of(MANY)), Target::AtMost(SPECTRUM), spectrum.median());
    report.table(table);
    Ok(())
}

/// A series of the same evaluator, period, modes and lattice, for other ghosts.
fn alike(ghosts: Vec<Ghost>, other: &Plan, frame: Frame) -> Result<Plan> {
    let request = Request {
        evaluator: Some(other.evaluator()),
        period: Some(other.period()),
        degree: Some(other.degree()),
        ..Request::new(1e-2)
    };
    let planned = plan(&Problem::new(ghosts, frame), &request)?;
    Ok(planned.with_series(|series| {
        series.counts = other.counts().to_vec().into();
        series.lattice = other.lattice().copied();
    }))
}

/// Lights all over the picture, through Gaussians.
fn crowded(lights: u32, ghosts: u32, frame: Frame) -> Vec<Ghost> {
    let lens = whole::lens(u64::from(ghosts));
    let light = |ghost: Ghost| Light { position: ghost.center, flux: ghost.radiance, size: 0.0, muted: false };
    let lights: Vec<Light> = scenes::scattered(lights as usize, 0.1, frame).into_iter().map(light).collect();
    lights.iter().flat_map(|light| lens.iter().map(|ghost| ghost.of(light, DVec2::ZERO))).collect()
}
