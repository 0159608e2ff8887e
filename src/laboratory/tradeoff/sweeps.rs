//! The sweeps: each varies one thing and measures what comes of it.

use std::sync::Arc;

use glam::DVec2;

use super::Watch;
use super::bench::Arm;
use super::point::{Point, Storage, Sweep};
use super::study::Study;
use crate::certificate::Certificate;
use crate::chance::Chance;
use crate::frame::Frame;
use crate::plan::{Evaluator, Plan, Request, plan};
use crate::problem::Problem;
use crate::scene::Ghost;
use crate::series::Bell;
use crate::{Error, Result, job};

/// The tolerance of what is swept over ghosts: vglare's default.
const USUAL: f64 = 1e-3;
/// Highest degree of the degree's sweep: beyond, the whole rectangle of modes takes long and shows nothing new.
const HIGHEST: u32 = 256;
/// The most pixels of a picture that is timed.
const LARGEST: f64 = 33_177_600.0;
const SEED: u64 = 0x5eed;

/// Every evaluator, and the planner's own choice, from coarse to fine.
///
/// # Errors
/// [`Error::Gl`] where the driver refuses.
pub(super) fn tolerance(study: &mut Study<'_>, watch: Watch<'_>) -> Result<Vec<Point>> {
    let exponents: &[f64] = match study.quick {
        true => &[1., 2., 3., 4., 5., 6., 7.],
        false => &[1., 1.5, 2., 2.5, 3., 3.5, 4., 4.5, 5., 5.5, 6., 6.5, 7.],
    };
    let (frame, ghosts) = (study.frame(), study.subject.ghosts());
    let (mut plans, mut refused) = (Vec::new(), Vec::new());
    let mut chosen = Vec::new();
    for tolerance in exponents.iter().map(|exponent| rounded(10f64.powf(-exponent))) {
        match plan(&study.problem, &study.request(tolerance)) {
            Ok(plan) => {
                chosen.push((tolerance, plan.evaluator()));
                // By no evaluator's name alone, since a series may be beside it.
                if plan.plate().is_some() {
                    plans.push((Some(tolerance), plan));
                }
            }
            Err(reason) => {
                let point = Point::refused(Sweep::Tolerance, frame, ghosts, Some(tolerance), &reason);
                refused.push(Point { planner: true, ..point });
            }
        }
        for evaluator in Evaluator::ALL {
            let request = Request { evaluator: Some(evaluator), ..study.request(tolerance) };
            match plan(&study.problem, &request) {
                Ok(plan) => plans.push((Some(tolerance), plan)),
                Err(reason) => {
                    let point = Point::refused(Sweep::Tolerance, frame, ghosts, Some(tolerance), &reason);
                    refused.push(Point { evaluator: Some(evaluator), ..point });
                }
            }
        }
    }
    let mut points = study.measured(Sweep::Tolerance, &plans, watch)?;
    for point in &mut points {
        // The planner chooses among these very plans.
        point.planner = point.asked.zip(point.evaluator).is_some_and(|pair| chosen.contains(&pair));
    }
    points.extend(refused);
    Ok(points)
}

/// A number of two digits: 3.2e-3 instead of 3.1622776e-3.
fn rounded(value: f64) -> f64 {
    format!("{value:.1e}").parse().unwrap_or(value)
}

/// Degrees up to beyond what the planner takes, in its period, by `rows` in 32-bit floats, which adds nothing to the series' own
/// error.
///
/// # Errors
/// [`Error::Gl`] where the driver refuses.
pub(super) fn degree(study: &mut Study<'_>, watch: Watch<'_>) -> Result<Vec<Point>> {
    let rows = |request: Request| Request { evaluator: Some(Evaluator::Rows), doubles: false, ..request };
    let Some((_, tight)) = study.tightest(rows) else { return Ok(Vec::new()) };
    let last = f64::from(tight.degree()[0].clamp(2, HIGHEST)) * 1.15;
    let count = if study.quick { 12 } else { 24 };
    let mut degrees: Vec<u32> =
        (0..count).map(|k| (1.0 + (last - 1.0) * f64::from(k) / f64::from(count - 1)).round() as u32).collect();
    degrees.dedup();
    let across = f64::from(tight.degree()[1]) / f64::from(tight.degree()[0].max(1));
    let mut plans = Vec::new();
    for n in degrees {
        let m = ((f64::from(n) * across).round() as u32).clamp(1, HIGHEST);
        let request = Request { period: Some(tight.period()), degree: Some([n, m]), ..rows(study.request(USUAL)) };
        plans.extend(plan(&study.problem, &request).ok().map(|plan| (None, plan)));
    }
    study.measured(Sweep::Degree, &plans, watch)
}

/// Lattices from barely enough to plenty, and the planner's, in 32-bit floats.
///
/// # Errors
/// [`Error::Gl`] where the driver refuses.
pub(super) fn oversampling(study: &mut Study<'_>, watch: Watch<'_>) -> Result<Vec<Point>> {
    let grid = |request: Request| Request { evaluator: Some(Evaluator::Grid), doubles: false, ..request };
    let Some((tolerance, planned)) = study.tightest(grid) else { return Ok(Vec::new()) };
    let mut plans = vec![(Some(tolerance), planned.clone())];
    for nodes in [1.1, 1.35, 1.7, 2.0, 2.5, 3.0, 4.0, 6.0, 8.0, 12.0] {
        let request = Request {
            period: Some(planned.period()),
            degree: Some(planned.degree()),
            oversampling: Some(nodes),
            ..grid(study.request(tolerance))
        };
        // A lattice beyond the device's textures is no plan; the sweep ends there.
        plans.extend(plan(&study.problem, &request).ok().map(|plan| (None, plan)));
    }
    let mut points = study.measured(Sweep::Oversampling, &plans, watch)?;
    if let Some(first) = points.first_mut() {
        first.planner = true;
    }
    Ok(points)
}

/// The spectrum's terms in 32 bits and in 16: errors only, since nothing here stores them in 16.
///
/// # Errors
/// [`Error::Gl`] where the driver refuses.
pub(super) fn storage(study: &mut Study<'_>, watch: Watch<'_>) -> Result<Vec<Point>> {
    let frame = study.frame();
    let mut points = Vec::new();
    for (done, tolerance) in [1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6].into_iter().enumerate() {
        let request = Request { evaluator: Some(Evaluator::Rows), doubles: false, ..study.request(tolerance) };
        let Ok(plan) = plan(&study.problem, &request) else { continue };
        let renderer = &mut study.bench.renderer;
        for storage in [Storage::Float, Storage::Half] {
            renderer.field.forget_scene();
            renderer.field.set_scene(&plan)?;
            if storage == Storage::Half {
                renderer.field.round_spectrum()?;
            }
            let quality = study.sample.judge(&renderer.field.probe(frame, &study.sample.pixels)?);
            let point = Point::planned(Sweep::Storage, frame, Some(tolerance), &plan).with_quality(&quality);
            // No bound of the plan holds for rounded terms.
            let predicted = point.predicted.filter(|_| storage == Storage::Float);
            points.push(Point { storage, predicted, ..point });
        }
        renderer.field.forget_scene();
        watch((done + 1) as f64 / 6.0);
    }
    Ok(points)
}

/// From one ghost to ten thousand: Gaussians by chance, always the same.
///
/// # Errors
/// [`Error::Gl`] where the driver refuses.
pub(super) fn ghosts(study: &mut Study<'_>, watch: Watch<'_>) -> Result<Vec<Point>> {
    let counts: &[usize] =
        if study.quick { &[1, 10, 100, 1000, 10_000] } else { &[1, 3, 10, 30, 100, 300, 1000, 3000, 10_000] };
    let frame = study.frame();
    let problems: Vec<_> = counts.iter().map(|&count| Problem::new(scattered(count, frame), frame)).collect();
    certified(study, Sweep::Ghosts, USUAL, &problems, watch)
}

/// From a small picture to the photo's own size, at one tolerance.
///
/// # Errors
/// [`Error::Gl`] where the driver refuses.
pub(super) fn size(study: &mut Study<'_>, tolerance: f64, watch: Watch<'_>) -> Result<Vec<Point>> {
    let whole = study.subject.photo.frame;
    let (width, height) = (whole.width, whole.height);
    let side = study.bench.device().info().limits.texture_size;
    let factors: &[f64] = if study.quick { &[0.125, 0.25, 0.5, 1.0] } else { &[0.0625, 0.125, 0.25, 0.5, 0.707, 1.0] };
    let frames = factors.iter().filter_map(|factor| {
        let [width, height] = [width, height].map(|side| (f64::from(side) * factor).round() as u32);
        let fits = width.min(height) >= 1 && width.max(height) <= side;
        (fits && f64::from(width) * f64::from(height) <= LARGEST).then(|| whole.resized(width, height))
    });
    let mut frames: Vec<Frame> = frames.collect();
    frames.dedup();
    let problems: Vec<_> = frames.iter().map(|&frame| study.problem.on(frame)).collect();
    let mut points = certified(study, Sweep::Size, tolerance, &problems, watch)?;
    for point in &mut points {
        let problem = study.problem.on(whole.resized(point.width, point.height));
        point.planner =
            plan(&problem, &study.request(tolerance)).is_ok_and(|plan| Some(plan.evaluator()) == point.evaluator);
    }
    Ok(points)
}

/// The veil at tolerances from coarse to fine, where there is one.
///
/// # Errors
/// Where the veil cannot be computed; a tolerance that cannot be had is a point without numbers.
pub(super) fn veil(study: &Study<'_>) -> Result<Vec<Point>> {
    let Some(look) = study.subject.veil else { return Ok(Vec::new()) };
    let tolerances: &[f64] =
        if study.quick { &[1e-1, 1e-2, 1e-3] } else { &[1e-1, 3e-2, 1e-2, 3e-3, 1e-3, 3e-4, 1e-4, 1e-5] };
    let frame = study.frame();
    let trials = job::trials(look, &study.photo, &frame, tolerances, study.bench.rounds)?;
    let point = |(&asked, trial): (&f64, Result<job::Trial>)| match trial {
        Ok(trial) => Point::of_veil(frame, asked, &trial),
        Err(reason) => Point::refused(Sweep::Veil, frame, 0, Some(asked), &reason),
    };
    Ok(tolerances.iter().zip(trials).map(point).collect())
}

/// Problems by every evaluator, timed in turns and held against the direct sum at a certificate's pixels.
fn certified(
    study: &mut Study<'_>,
    sweep: Sweep,
    tolerance: f64,
    problems: &[Arc<Problem>],
    watch: Watch<'_>,
) -> Result<Vec<Point>> {
    let wanted = || problems.iter().flat_map(|problem| Evaluator::ALL.map(|evaluator| (problem, evaluator)));
    let planned: Vec<Result<Plan, Error>> = wanted()
        .map(|(problem, evaluator)| plan(problem, &Request { evaluator: Some(evaluator), ..study.request(tolerance) }))
        .collect();
    let arms: Vec<_> = planned.iter().flatten().map(|plan| Arm { plan }).collect();
    let mut timings = study.bench.time(&arms, watch)?.into_iter();
    let mut points = Vec::new();
    for ((problem, evaluator), plan) in wanted().zip(&planned) {
        let (frame, asked) = (problem.frame(), Some(tolerance));
        match plan {
            Ok(plan) => {
                let renderer = &mut study.bench.renderer;
                let certificate = Certificate::measure(&mut renderer.field, plan)?;
                let point = Point::planned(sweep, frame, asked, plan);
                let timing = timings.next().expect("a timing for each plan");
                points.push(Point { measured: Some(certificate.measured), ..point.with_timing(&timing) });
            }
            Err(reason) => {
                let point = Point::refused(sweep, frame, problem.ghosts().len(), asked, reason);
                points.push(Point { evaluator: Some(evaluator), ..point });
            }
        }
    }
    Ok(points)
}

/// Gaussians of σ 0.15 to 0.45 anywhere in the picture.
fn scattered(count: usize, frame: Frame) -> Vec<Ghost> {
    let mut chance = Chance::new(SEED);
    let (across, down) = (frame.half_width(), frame.half_height());
    let ghost = |_| Ghost {
        bell: Bell::Gaussian,
        center: DVec2::new(chance.between(-across, across), chance.between(-down, down)),
        size: DVec2::splat(chance.between(0.15, 0.45)),
        radiance: [1.0; 3].map(|_: f64| chance.between(0.1, 1.0)),
    };
    (0..count).map(ghost).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_decades_have_two_digits() {
        assert_eq!([1.0, 1.5, 5.5].map(|exponent| rounded(10f64.powf(-exponent))), [0.1, 0.032, 3.2e-6]);
    }

    #[test]
    fn more_ghosts_are_the_same_ones_and_others() {
        let frame = Frame::full(300, 200);
        let (few, many) = (scattered(3, frame), scattered(10, frame));
        assert_eq!(few[..], many[..3]);
        assert!(many.iter().all(|ghost| ghost.center.x.abs() <= 1.5 && ghost.center.y.abs() <= 1.0));
    }
}
