//! Past 32 bits: tolerances down to what the output's own floats hold, by every evaluator, held against the definition at every
//! pixel.

use vglare::Error;
use vglare::certificate::Certificate;
use vglare::frame::Frame;
use vglare::gpu::Backend;
use vglare::plan::{CostModel, Evaluator, Layer, Plan, Precision, Request};
use vglare::renderer::Picture;
use vglare::scene::Ghost;
use vglare::series::Bell;

use crate::support::check::Worst;
use crate::support::{bits, glare, on_each_backend, on_one_backend, plan, scenes};

const FRAME: Frame = Frame::full(97, 55);
const TOLERANCES: [f64; 3] = [1e-6, 3e-7, 1e-7];

/// Half a unit in the last place of an f32 at 1.
const HALF_A_UNIT: f64 = 0.5 * f32::EPSILON as f64;

fn asked(tolerance: f64, evaluator: Option<Evaluator>) -> Request {
    Request { evaluator, ..Request::new(tolerance) }
}

/// Measured at every pixel, predicted and asked, in this order or the test fails; and what of the prediction was measured.
fn hold(name: &str, plan: &Plan, renderer: &mut Picture) -> f64 {
    let found = Certificate::measure_all(&mut renderer.field, plan, |_| ()).unwrap();
    let (measured, predicted) = (found.measured, found.predicted);
    assert!(measured <= predicted && predicted <= plan.tolerance, "{name}: {found:?}, {:?}", plan.predicted);
    measured / predicted
}

/// Scenes of several numbers of Gaussians, and one of each other bell.
fn every_scene(frame: Frame) -> Vec<(String, Vec<Ghost>)> {
    let gaussians = [(1, 0.1, 0.5), (20, 0.05, 0.8), (300, 0.2, 0.5)];
    let mut all: Vec<_> = gaussians
        .into_iter()
        .map(|(count, smallest, largest)| {
            let ghosts = scenes::sized(count as u64, count, frame, smallest, largest);
            (format!("{count} Gaussians of {smallest} to {largest}"), ghosts)
        })
        .collect();
    for bell in Bell::examples() {
        let ghosts = scenes::sized(7, 12, frame, 0.3, 0.9);
        let ghosts = ghosts.into_iter().map(|ghost| Ghost { bell: bell.clone(), ..ghost }).collect();
        all.push((format!("12 of {bell}"), ghosts));
    }
    all
}

#[test]
fn tolerances_that_32_bits_cannot_give_are_kept() {
    let mut plans = Vec::new();
    for (name, ghosts) in every_scene(FRAME) {
        for evaluator in
            [None, Some(Evaluator::Grid), Some(Evaluator::Rows), Some(Evaluator::Direct), Some(Evaluator::Local)]
        {
            for tolerance in TOLERANCES {
                let name = format!("{name} by {evaluator:?} at {tolerance:e}");
                match plan(&ghosts, FRAME, &asked(tolerance, evaluator)) {
                    Ok(plan) => plans.push((name, plan)),
                    // A bell with a kink or a jump needs more harmonics than there are; then the series says so.
                    Err(error) => assert!(
                        evaluator.is_some_and(Evaluator::is_series) && ghosts[0].bell != Bell::Gaussian,
                        "{name}: {error}"
                    ),
                }
            }
        }
    }
    let series =
        plans.iter().filter(|(_, plan)| plan.series().is_some_and(|s| s.precision == Precision::Double)).count();
    assert!(series >= 20, "{series} series in 64-bit floats");
    let worst = on_each_backend(|_, renderer| {
        let mut worst = Worst::default();
        plans.iter().for_each(|(name, plan)| worst.take(hold(name, plan, renderer), || name.clone()));
        worst
    });
    println!("of {} plans the worst share of the prediction: {} and {}", plans.len(), worst[0], worst[1]);
}

#[test]
fn every_mode_at_every_pixel_is_kept_too() {
    let ghosts = scenes::sized(5, 6, FRAME, 0.4, 0.8);
    let plan = plan(&ghosts, FRAME, &asked(1e-7, Some(Evaluator::Series))).unwrap();
    assert_eq!(plan.series().unwrap().precision, Precision::Double);
    on_one_backend(|_, renderer| hold("series", &plan, renderer));
}

#[test]
fn no_tolerance_is_refused_above_what_the_output_holds() {
    let ghosts = scenes::sized(3, 10, FRAME, 0.2, 1.0);
    for evaluator in Evaluator::ALL.map(Some).into_iter().chain([None]) {
        let Err(Error::ToleranceBelowFloor { floor, .. }) = plan(&ghosts, FRAME, &asked(5e-8, evaluator)) else {
            panic!("{evaluator:?}: no f32 is as exact")
        };
        assert!((HALF_A_UNIT..1e-7).contains(&floor), "{evaluator:?}: {floor:e}");
        assert!(plan(&ghosts, FRAME, &asked(1e-7, evaluator)).is_ok(), "{evaluator:?}");
        // Without them there are floors of old.
        let single = Request { doubles: false, ..asked(1e-7, evaluator) };
        let Err(Error::ToleranceBelowFloor { floor, .. }) = plan(&ghosts, FRAME, &single) else {
            panic!("{evaluator:?}: 32-bit floats are not as exact")
        };
        assert!((4e-7..1e-4).contains(&floor), "{evaluator:?}: {floor:e}");
    }
}

/// Constants by which small ghosts pay where they reach, and a few at every pixel.
fn model(quad: f64) -> CostModel {
    let base = CostModel { bell: 0.05, quad, canvas: 0.5, pass: 1.0, spectrum: 0.1, ..CostModel::default() };
    let model = CostModel { harmonic_double: 1.0, profile_double: 1.0, strip_double: 1.0, term_double: 1e3, ..base };
    CostModel::from_values(CostModel { interpolation_double: 1.0, ..model }.values().map(|value| 1e4 * value))
}

/// Wide ghosts and small ones.
fn mixed(wide: usize, small: usize) -> Vec<Ghost> {
    let mut ghosts = scenes::sized(3, wide, FRAME, 0.3, 0.6);
    let few = scenes::sized(4, small, FRAME, 0.02, 0.06);
    ghosts.extend(few.into_iter().map(|ghost| Ghost { center: 0.7 * ghost.center, ..ghost }));
    ghosts
}

/// A plan at 1e-7 of a series and what is summed beside it.
fn layered(kind: Evaluator) -> Plan {
    let (ghosts, quad) = if kind == Evaluator::Local { (mixed(300, 200), 20.0) } else { (mixed(300, 3), 1e6) };
    let plan = plan(&ghosts, FRAME, &Request { cost_model: model(quad), ..Request::new(1e-7) }).unwrap();
    assert!(plan.series().is_some_and(|series| series.precision == Precision::Double), "{:?}", plan.costs);
    assert!(plan.layers().iter().any(|layer| layer.evaluator() == kind), "{kind}: {:?}", plan.costs);
    assert!(plan.is_exact() && plan.local().is_none_or(|local| local.precision == Precision::Double));
    plan
}

#[test]
fn layers_are_summed_in_64_bit_floats_and_rounded_once() {
    for kind in [Evaluator::Local, Evaluator::Direct] {
        let plan = layered(kind);
        assert!(plan.predicted.storage < 1.5 * HALF_A_UNIT, "one rounding: {:?}", plan.predicted);
        on_each_backend(|_, renderer| hold(&format!("beside {kind}"), &plan, renderer));
    }
}

#[test]
fn tiles_in_64_bit_floats_meet_bit_for_bit() {
    let gaussians = scenes::sized(20, 20, FRAME, 0.1, 0.8);
    let mut plans: Vec<Plan> = [Evaluator::Grid, Evaluator::Rows, Evaluator::Local]
        .into_iter()
        .map(|evaluator| plan(&gaussians, FRAME, &asked(1e-7, Some(evaluator))).unwrap())
        .collect();
    plans.push(layered(Evaluator::Local));
    on_each_backend(|_, renderer| {
        for plan in &plans {
            let whole = bits(&glare(renderer, plan, FRAME));
            for pixels in [1000, 61] {
                renderer.field.set_tile_pixels(pixels);
                assert_eq!(bits(&glare(renderer, plan, FRAME)), whole, "{}, {pixels} pixels", plan.evaluator());
            }
            renderer.field.set_tile_pixels(4 << 20);
        }
    });
}

#[test]
fn spectra_that_the_plan_has_not_computed_are_as_exact() {
    let ghosts = scenes::sized(9, 40, FRAME, 0.15, 0.8);
    let plan = plan(&ghosts, FRAME, &asked(1e-7, Some(Evaluator::Rows))).unwrap();
    on_one_backend(|_, renderer| hold("without modes", &plan.without_modes(), renderer));
}

#[test]
fn anisotropic_ghosts_in_a_window_of_a_wider_picture_are_kept() {
    let mut chance = scenes::Chance::new(11);
    let frame = Frame::full(300, 200).with_window(vglare::frame::Window { x: 41, y: 103, width: 77, height: 50 });
    let mut ghosts = scenes::sized(2, 30, frame, 0.1, 0.6);
    for ghost in &mut ghosts {
        ghost.size.x *= chance.between(0.5, 2.0);
    }
    let plans = [Evaluator::Grid, Evaluator::Rows, Evaluator::Direct, Evaluator::Local]
        .map(|evaluator| plan(&ghosts, frame, &asked(1e-7, Some(evaluator))).unwrap());
    on_one_backend(|_: Backend, renderer| {
        for plan in &plans {
            hold(&plan.evaluator().to_string(), plan, renderer);
        }
    });
    assert!(plans.iter().all(|plan| plan.layers().iter().all(|layer| !matches!(layer, Layer::Series(series)
        if series.precision == Precision::Single))));
}
