//! At the extremes: whatever is asked, what is measured is at most what is predicted, and that at most what was asked, or
//! an error says why not. Never NaN, and nothing that matters is lost without a word.

mod chance;
mod colours;
mod numbers;
mod sizes;
mod terms;

use vglare::Error;
use vglare::compare::compare_in;
use vglare::frame::Frame;
use vglare::plan::{Evaluator, Plan, Request};
use vglare::reference::direct_at;
use vglare::renderer::{Picture, Settings};
use vglare::scene::Ghost;

use crate::support::{plan, scenes};

/// A request that leaves everything but the tolerance to the plan, with what the software renderer can do.
fn request(tolerance: f64) -> Request {
    Request { loop_rounds: 65535, ..Request::new(tolerance) }
}

/// The evaluator that is asked for: each of them, and the plan's own choice.
fn every_choice() -> impl Iterator<Item = Option<Evaluator>> {
    Evaluator::ALL.into_iter().map(Some).chain([None])
}

/// What a plan and a renderer made of a scene.
struct Outcome {
    plan: Plan,
    /// In units of the field's largest value, like the tolerance.
    measured: f64,
}

/// A plan as asked for. Where there is none, the error is checked to be an honest one, and printed.
#[track_caller]
fn planned(what: &str, ghosts: &[Ghost], frame: Frame, request: &Request) -> Option<Plan> {
    match plan(ghosts, frame, request) {
        Ok(plan) => {
            let total = plan.predicted.total();
            // What is given by hand is predicted as it comes.
            let given = request.period.is_some() || request.degree.is_some();
            assert!(given || total <= request.tolerance, "{what}: {:?} for {:e}", plan.predicted, request.tolerance);
            assert!(!total.is_nan(), "{what}: {:?}", plan.predicted);
            Some(plan)
        }
        Err(error) => {
            println!("{what}: {error}");
            match error {
                Error::ToleranceBelowFloor { asked, floor } => assert!(floor > asked, "{what}: no reason: {floor:e}"),
                Error::Plan(_) => {}
                other => panic!("{what}: {other}"),
            }
            None
        }
    }
}

/// Renders a scene and measures it: at every pixel of small pictures, else at probes.
#[track_caller]
fn measured(renderer: &mut Picture, what: &str, ghosts: &[Ghost], frame: Frame, plan: &Plan) -> f64 {
    renderer.field.set_scene(plan).unwrap_or_else(|error| panic!("{what}: {error}"));
    let pixels = match frame.window.pixels() * ghosts.len() {
        ..=2_000_000 => scenes::every_pixel(frame),
        _ => scenes::probes(7, ghosts, plan, frame),
    };
    let exact = direct_at(ghosts, &scenes::positions(frame, &pixels));
    let difference = compare_in(&exact, &renderer.field.probe(frame, &pixels).unwrap(), plan.scale);
    let total = plan.predicted.total();
    let (pixel, colour) = difference.worst;
    assert!(
        difference.not_finite == 0 && difference.relative <= total,
        "{what}: {:.2e}, {total:.2e} predicted: {:?}; at pixel {:?}, colour {colour}; {} values are not finite",
        difference.relative,
        plan.predicted,
        pixels.get(pixel),
        difference.not_finite,
    );
    if frame.window.pixels() <= 100_000 && plan.evaluator() != Evaluator::Series {
        let glare = renderer.glare(frame, &Settings::default()).unwrap();
        assert!(glare.as_flattened().iter().all(|value| value.is_finite()), "{what}: the picture is not finite");
    }
    difference.relative
}

/// Plans, renders, measures and prints a line; `None` where an error said why not.
#[track_caller]
fn look(renderer: &mut Picture, what: &str, ghosts: &[Ghost], frame: Frame, request: &Request) -> Option<Outcome> {
    let plan = planned(what, ghosts, frame, request)?;
    let measured = measured(renderer, what, ghosts, frame, &plan);
    let [n, m] = plan.degree();
    println!(
        "{what}: {}, degree {n} x {m}, period {:.3e} x {:.3e}, {} dropped: measured {measured:.1e}, predicted {:.1e}, \
         asked {:.1e}",
        plan.evaluator(),
        plan.period().x,
        plan.period().y,
        plan.dropped,
        plan.predicted.total(),
        request.tolerance,
    );
    Some(Outcome { plan, measured })
}
