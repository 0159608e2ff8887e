//! What f32 costs is what the plan says: measured where everything else is far below it, at most six tenths of the bound.

use glam::DVec2;
use vglare::Error;
use vglare::compare::compare;
use vglare::frame::Frame;
use vglare::plan::{Evaluator, Plan, Request};
use vglare::reference::direct_at;
use vglare::scene::Ghost;

use crate::support::check::Worst;
use crate::support::{on_one_backend, plan, scenes};

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
    let request = |tolerance| Request { evaluator: Some(evaluator), period, degree, ..Request::new(tolerance) };
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
            for seed in 0..seeds {
                let ghosts = scenes::sized(1000 * seed + count as u64, count, frame, smallest, largest);
                for evaluator in Evaluator::ALL {
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
                share.take(error / plan.predicted.single(), || name.clone());
            }
        }
        println!("{evaluator}: worst error for each unit of weight {per_weight}, share of the bound {share}");
        assert!(share.value <= SHARE, "{evaluator}: rounding makes {share} of its bound");
    }
}
