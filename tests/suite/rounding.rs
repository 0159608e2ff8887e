//! What f32 costs is what the plan says: measured where everything else is far below it, at most six tenths of the bound.

use glam::DVec2;
use vglare::Error;
use vglare::compare::compare;
use vglare::frame::Frame;
use vglare::plan::{Evaluator, Plan, Request};
use vglare::reference::direct_at;
use vglare::scene::Ghost;
use vglare::series::Bell;

use crate::support::check::Worst;
use crate::support::{long, on_one_backend, plan, plan_with, scenes};

/// The plan's constants are about twice the worst that was seen; what a change of driver adds may use up some of that.
const SHARE: f64 = 0.6;

struct Case {
    name: String,
    plan: Plan,
    pixels: Vec<[i32; 2]>,
    exact: Vec<[f64; 3]>,
}

/// A plan whose error is rounding alone: a period and a degree that leave nothing to periodisation and truncation and,
/// since the lattice follows the tolerance, the lowest tolerance that f32 allows.
fn exact_but_for_rounding(ghosts: &[Ghost], frame: Frame, largest: f64, smallest: f64, evaluator: Evaluator) -> Plan {
    let half = DVec2::new(f64::from(frame.width) / f64::from(frame.height), 1.0);
    let period = 2.6 * half + 7.5 * largest;
    let degree = (period / smallest).ceil().as_uvec2().to_array();
    let (period, degree) = (Some(period), Some(degree));
    let request =
        |tolerance| Request { evaluator: Some(evaluator), period, degree, doubles: false, ..Request::new(tolerance) };
    match plan(ghosts, frame, &request(1e-9)) {
        Err(Error::ToleranceBelowFloor { floor, .. }) => plan(ghosts, frame, &request(1.001 * floor)).unwrap(),
        plan => plan.unwrap(),
    }
}

#[test]
fn rounding_stays_below_its_bound() {
    let frame = Frame::full(640, 480);
    let mut cases = Vec::new();
    for (smallest, largest) in [(0.05, 1.0), (0.3, 1.0), (1.0, 3.0), (0.02, 0.1)] {
        for (count, seeds) in [(1, 5), (5, 2), (100, 1), (20_000, 1)] {
            // All modes of 20000 ghosts of any size, and of small ones, would be minutes of work.
            if count == 20_000 && smallest < 1.0 {
                continue;
            }
            for seed in 0..if long() { seeds } else { seeds.min(2) } {
                let ghosts = scenes::sized(1000 * seed + count as u64, count, frame, smallest, largest);
                for evaluator in Evaluator::ALL {
                    // It looks at every pixel, and where all ghosts reach all of them that is the direct sum of all pixels.
                    if evaluator == Evaluator::Local && count == 20_000 {
                        continue;
                    }
                    // What so many add to the spectrum's rounding is the same to all that sum one.
                    let summed_alike = matches!(evaluator, Evaluator::Series | Evaluator::Grid);
                    if count == 20_000 && summed_alike && !long() {
                        continue;
                    }
                    let plan = exact_but_for_rounding(&ghosts, frame, largest, smallest, evaluator);
                    let pixels = scenes::probes(7, &ghosts, &plan, frame);
                    let exact = direct_at(&ghosts, &scenes::positions(frame, &pixels));
                    let name = format!("K = {count}, sizes {smallest} to {largest}");
                    cases.push(Case { name, plan, pixels, exact });
                }
            }
        }
    }
    let measured = on_one_backend(|_, renderer| -> Vec<f64> {
        let measure = |case: &Case| {
            renderer.field.set_scene(&case.plan).unwrap();
            compare(&case.exact, &renderer.field.probe(frame, &case.pixels).unwrap()).relative
        };
        cases.iter().map(measure).collect()
    });
    for evaluator in Evaluator::ALL {
        let (mut per_weight, mut share) = (Worst::default(), Worst::default());
        for (error, Case { name, plan, .. }) in measured.iter().zip(&cases) {
            if plan.evaluator() == evaluator {
                let weight: f64 = plan.groups().map(|group| group.weight).sum();
                per_weight.take(error / weight, || name.clone());
                // A lattice that is planned for a series by hand costs about what rounding does.
                share.take(error / (plan.predicted.single() + plan.predicted.interpolation), || name.clone());
            }
        }
        println!("{evaluator}: worst error for each unit of weight {per_weight}, share of the bound {share}");
        assert!(share.value <= SHARE, "{evaluator}: rounding makes {share} of its bound");
    }
}

#[test]
fn the_spectrum_that_the_plan_has_computed_is_the_one_that_the_device_computes() {
    let frame = Frame::full(320, 180);
    let mut chance = scenes::Chance::new(3);
    let ghosts: Vec<Ghost> = (0..12)
        .map(|k| {
            // Round bells need many modes, but where they are faint.
            let (bell, size, radiance) = match k % 3 {
                0 => (Bell::Gaussian, chance.octaves(0.3, 0.9), 1.0),
                1 => (Bell::CosineSquared, chance.octaves(0.6, 1.2), 0.3),
                _ => (Bell::Paraboloid, 0.8, 0.02),
            };
            let center = [chance.between(-1.7, 1.7), chance.between(-0.9, 0.9)];
            Ghost { bell, ..scenes::one(center, size, [radiance, 0.7 * radiance, 0.4 * radiance]) }
        })
        .collect();
    let planned = plan_with(&ghosts, frame, 2e-1, Evaluator::Rows);
    assert!(planned.series().unwrap().modes.is_some(), "looked at");
    let pixels = scenes::probes(7, &ghosts, &planned, frame);
    let [uploaded, dispatched] = on_one_backend(|_, renderer| {
        [planned.clone(), planned.clone().without_modes()].map(|plan| {
            renderer.field.set_scene(&plan).unwrap();
            renderer.field.probe(frame, &pixels).unwrap()
        })
    });
    let difference = compare(&dispatched, &uploaded).relative;
    println!("uploaded against dispatched: {difference:.1e}");
    // Each is off by f32's rounding; the device's has phases and coefficients in f32, too.
    assert!(difference > 0.0 && difference < 2e-6, "{difference:e}");
}

#[test]
fn ghosts_of_all_sizes_are_planned_by_what_their_modes_are_and_not_by_their_weights() {
    let frame = Frame::full(640, 360);
    let ghosts = scenes::sized(5, 300, frame, 0.03, 0.5);
    let planned = plan_with(&ghosts, frame, 1e-5, Evaluator::Grid);
    let weight: f64 = planned.groups().map(|group| group.weight).sum();
    assert!(1.6e-6 * weight > 1e-5, "by weights there is none: {weight}");
    let pixels = scenes::probes(7, &ghosts, &planned, frame);
    let exact = direct_at(&ghosts, &scenes::positions(frame, &pixels));
    let measured = on_one_backend(|_, renderer| {
        renderer.field.set_scene(&planned).unwrap();
        compare(&exact, &renderer.field.probe(frame, &pixels).unwrap()).relative
    });
    println!("measured {measured:.1e}, predicted {:.1e}", planned.predicted.total());
    assert!(measured <= planned.predicted.total() && planned.predicted.total() <= 1e-5, "{measured:e}");
    assert!(planned.predicted.single() < 1e-5 && measured < 1e-5);
}
