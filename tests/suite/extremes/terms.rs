//! Degrees from 0 to the highest, counts of ghosts from 0 to a million, and the harmonics at which formulas are 0/0.

use glam::DVec2;
use vglare::Error;
use vglare::compare::compare;
use vglare::frame::Frame;
use vglare::gpu::Backend;
use vglare::plan::{Evaluator, HIGHEST_DEGREE, Request};
use vglare::reference::series;
use vglare::scene::Ghost;
use vglare::series::{Bell, Modes};

use super::{look, measured, request};
use crate::support::check::Worst;
use crate::support::{long, on_backend, on_one_backend, plan, scenes};

/// Rounding may use this part of its bound, as in the suite's `rounding`.
const SHARE: f64 = 0.6;

/// A ridge on a pixel, narrow along one axis and wide along the other, so that a high degree has few terms.
fn ridge(narrow: f64, along: usize, frame: Frame) -> Ghost {
    let mut size = DVec2::splat(2.0);
    size[along] = narrow;
    Ghost { size, ..scenes::one(frame.position(41.0, 11.0).to_array(), 1.0, [1.0, 2.0, 0.5]) }
}

#[test]
fn degrees_up_to_the_highest_round_as_predicted() {
    let frame = Frame::full(47, 27);
    let degrees: &[u32] = &[0, 1, 16, 250, 1000, HIGHEST_DEGREE, 500, 2000, 3000];
    let degrees = if long() { degrees } else { &degrees[..6] };
    let share = on_backend(Backend::ALL[0], |renderer| {
        let mut worst = Worst::default();
        for &degree in degrees {
            for along in 0..2 {
                // A period that leaves nothing to copies, and a size that leaves nothing to truncation.
                let mut period = DVec2::splat(20.0);
                period[along] = 5.0;
                let ghosts = [ridge((1.05 * period[along] / f64::from(degree.max(1))).min(0.25), along, frame)];
                let mut degrees = [12; 2];
                degrees[along] = degree;
                for evaluator in [Evaluator::Series, Evaluator::Rows, Evaluator::Grid] {
                    let what = format!("degree {degrees:?}, {evaluator}");
                    let (period, degree) = (Some(period), Some(degrees));
                    let asked =
                        |tolerance| Request { period, degree, evaluator: Some(evaluator), ..request(tolerance) };
                    // The lattice follows the tolerance: the lowest one there is.
                    let plan = match plan(&ghosts, frame, &asked(1e-9)) {
                        Err(Error::ToleranceBelowFloor { floor, .. }) => plan(&ghosts, frame, &asked(1.001 * floor)),
                        plan => plan,
                    };
                    let plan = match plan {
                        Ok(plan) => plan,
                        Err(error) => {
                            println!("{what}: {error}");
                            continue;
                        }
                    };
                    let error = measured(renderer, &what, &ghosts, frame, &plan);
                    println!(
                        "{what}: measured {error:.1e}, predicted {:.1e}, {:?}",
                        plan.predicted.total(),
                        plan.predicted
                    );
                    if degrees[along] > 16 {
                        worst.take(error / plan.predicted.single(), || what);
                    }
                }
            }
        }
        worst
    });
    println!("worst share of the bound of rounding: {share}");
    assert!(share.value <= SHARE, "{share}");
}

#[test]
fn many_terms_at_a_high_degree_along_both_axes() {
    // A square of 1001 x 1001 modes, about all that a device holds at once.
    let frame = Frame::full(65, 37);
    let ghosts = [scenes::one(frame.position(41.0, 11.0).to_array(), 5.0 / 950.0, [1.0, 2.0, 0.5])];
    let (period, degree, evaluator) = (Some(DVec2::splat(5.0)), Some([1000; 2]), Some(Evaluator::Rows));
    let asked_for = Request { period, degree, evaluator, ..request(1e-2) };
    on_backend(Backend::ALL[0], |renderer| {
        let outcome = look(renderer, "1001 x 1001 modes", &ghosts, frame, &asked_for).unwrap();
        assert!(outcome.measured < 1e-5, "{:e}", outcome.measured);
    });
    let highest = Request { degree: Some([HIGHEST_DEGREE; 2]), ..asked_for };
    let refusal = plan(&ghosts, frame, &highest).unwrap_err().to_string();
    assert!(refusal.contains("terms") && refusal.contains("fit on the device"), "{refusal}");
    let beyond = Request { degree: Some([HIGHEST_DEGREE + 1, 1]), ..asked_for };
    let refusal = plan(&ghosts, frame, &beyond).unwrap_err().to_string();
    assert!(refusal.contains("4097") && refusal.contains("highest"), "{refusal}");
}

#[test]
fn counts_from_none_to_a_million() {
    let frame = Frame::full(32, 18);
    on_backend(Backend::ALL[0], |renderer| {
        for count in [0, 1, 10, 1000, 100_000, 1_000_000] {
            let ghosts = scenes::sized(count as u64, count, frame, 1.0, 1.3);
            let what = format!("{count} ghosts");
            let started = std::time::Instant::now();
            let outcome = look(renderer, &what, &ghosts, frame, &request(1e-2)).unwrap();
            println!("{what}: {:.1} s, the reference included", started.elapsed().as_secs_f64());
            assert_eq!(outcome.plan.ghosts() + outcome.plan.dropped, count);
        }
    });
}

/// Half widths at which harmonic 4 of a period of 4 meets s = 2nh/T = 1, exactly and some f32 beside it.
fn around_the_singularity() -> Vec<f64> {
    let ulp = f64::from(f32::EPSILON) * 0.25;
    let beside = [-1e6, -3.0, -2.0, -1.0, -0.5, 0.0, 0.5, 1.0, 2.0, 3.0, 1e6];
    beside.iter().map(|ulps| 0.5 + ulps * ulp).chain([0.5 - f64::EPSILON * 0.25, 0.5 + f64::EPSILON * 0.5]).collect()
}

#[test]
fn the_singularity_of_cosine_squared_is_none_in_f64() {
    let Modes::Product(factor) = Bell::CosineSquared.shape().modes() else { panic!("a product") };
    let mut worst = Worst::default();
    for half in around_the_singularity() {
        for (n, period) in [(4, 4.0), (1, 1.0), (1000, 1000.0)] {
            let size = half / period;
            let [actual, _] = factor.coefficients(n, size)[n as usize];
            // To first order about s = 1, where the limit is h/2T: sinc(δ)/((1+δ)(2+δ)) = (1 − 3δ/2 + …)/2.
            let delta = 2.0 * f64::from(n) * size - 1.0;
            let expected =
                0.5 * size * (1.0 - 1.5 * delta + (1.75 - std::f64::consts::PI.powi(2) / 6.0) * delta * delta);
            let error = (actual / expected - 1.0).abs() - 4.0 * delta.abs().powi(3);
            worst.take(error, || format!("n = {n}, half width {half}"));
        }
    }
    println!("worst relative error of the coefficient about s = 1: {worst}");
    assert!(worst.value < 1e-14, "{worst}");
}

#[test]
fn the_singularity_of_cosine_squared_is_none_on_the_gpu() {
    let frame = Frame::full(65, 37);
    let pixels = scenes::every_pixel(frame);
    let points = scenes::positions(frame, &pixels);
    let worst = on_one_backend(|_, renderer| {
        let mut worst = Worst::default();
        for half in around_the_singularity() {
            for bell in [Bell::CosineSquared, Bell::Parabola] {
                let ghosts = [Ghost { bell, ..scenes::one([0.1, 0.05], half, [1.0, 2.0, 0.5]) }];
                let (period, degree) = (Some(DVec2::splat(4.0)), Some([5; 2]));
                let asked_for = Request { period, degree, evaluator: Some(Evaluator::Rows), ..request(1e-1) };
                let plan = plan(&ghosts, frame, &asked_for).unwrap();
                renderer.field.set_scene(&plan).unwrap();
                // Against the same terms in f64: the harmonic at the singularity is a tenth of the field.
                let exact: Vec<_> =
                    points.iter().map(|&at| series(&ghosts, plan.period(), plan.counts(), at)).collect();
                let difference = compare(&exact, &renderer.field.probe(frame, &pixels).unwrap());
                worst.take(difference.relative, || format!("{}, half width {half}", ghosts[0].bell));
            }
        }
        worst
    });
    println!("worst error of the terms about s = 1: {worst}");
    assert!(worst.value < 1e-6, "{worst}");
}
