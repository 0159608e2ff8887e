//! What is steep, small, far for its size, periodic or cancels is as exact as is promised, by the direct sum at least.

use std::sync::Arc;

use glam::DVec2;
use vglare::certificate::Certificate;
use vglare::frame::Frame;
use vglare::gpu::Backend;
use vglare::plan::{Evaluator, Plan, Precision, Request};
use vglare::scene::Ghost;
use vglare::series::{Bell, Profile, SineGaussian, VonMises};

use crate::support::scenes::Chance;
use crate::support::{on_backend, plan};

fn profile(rows: &[[f64; 2]]) -> Bell {
    Bell::Profile(Arc::new(Profile::new(rows).unwrap()))
}

fn ghost(bell: Bell, center: [f64; 2], size: f64) -> Ghost {
    Ghost { bell, center: center.into(), size: DVec2::splat(size), radiance: [1.0, 0.8, 0.5] }
}

fn by_direct(ghosts: &[Ghost], frame: Frame, tolerance: f64) -> Plan {
    let request = Request { evaluator: Some(Evaluator::Direct), ..Request::new(tolerance) };
    plan(ghosts, frame, &request).unwrap_or_else(|error| panic!("{tolerance:e}: {error}"))
}

/// Holds the plans' fields against the definition at every pixel.
fn hold(plans: &[(&str, Plan)]) {
    on_backend(Backend::OsMesa, |renderer| {
        for (name, plan) in plans {
            let found = Certificate::measure_all(&mut renderer.field, plan, |_| ()).unwrap();
            let (measured, predicted) = (found.measured, found.predicted);
            println!("{name}: {:?}, {measured:.1e} measured, {predicted:.1e} predicted", plan.precision);
            assert!(measured <= predicted && predicted <= plan.tolerance, "{name}: {found:?}");
        }
    });
}

#[test]
fn rims_noise_and_jumps_are_as_exact_as_predicted() {
    let frame = Frame::full(240, 135);
    let hard = profile(&[[0.0, 1.0], [0.99999, 1.0], [1.0, 0.0]]);
    let soft = profile(&[[0.0, 1.0], [0.99, 1.0], [1.0, 0.0]]);
    let jump = profile(&[[0.0, 1.0], [1.0, 0.7]]);
    let mut chance = Chance::new(3);
    let row = |i: u32| [f64::from(i) / 499.0, if i == 499 { 0.0 } else { chance.between(0.0, 1.0) }];
    let noise = profile(&(0..500).map(row).collect::<Vec<_>>());
    // The rims of the last two go exactly through pixels: 27 and 40 of them from a pixel.
    let (center, pixel) = (frame.position(60.0, 40.0).to_array(), frame.pixel_size());
    let scenes = [
        ("a rim a hundred-thousandth wide", ghost(hard.clone(), [0.0, 0.0], 1.7)),
        ("such a rim far away", ghost(hard, [900.0, 0.3], 899.3)),
        ("a rim a hundredth wide", ghost(soft, [0.3, -0.2], 1.1)),
        ("500 rows of noise", ghost(noise, [-0.4, 0.1], 0.9)),
        ("a jump on pixels", ghost(jump.clone(), center, 27.0 * pixel)),
        ("another", ghost(jump, center, 40.0 * pixel)),
    ];
    let plans = scenes.iter().flat_map(|(name, ghost)| {
        [1e-3, 1e-6].map(|tolerance| (*name, by_direct(std::slice::from_ref(ghost), frame, tolerance)))
    });
    let plans: Vec<_> = plans.collect();
    assert_eq!((plans[0].1.precision, plans[8].1.precision), (Precision::Double, Precision::Double));
    hold(&plans);
}

#[test]
fn every_bell_is_exact_in_64_bits() {
    let frame = Frame::full(60, 40);
    let mut chance = Chance::new(8);
    let mut at = || [chance.between(-1.5, 1.5), chance.between(-1.0, 1.0)];
    let mut ghosts: Vec<Ghost> = Bell::examples().into_iter().map(|bell| ghost(bell, at(), 0.3)).collect();
    let each: Vec<_> =
        ghosts.iter().map(|ghost| ("one", by_direct(std::slice::from_ref(ghost), frame, 3e-7))).collect();
    assert!(each.iter().all(|(_, plan)| plan.precision == Precision::Double));
    hold(&each);
    ghosts.iter_mut().for_each(|ghost| ghost.radiance = [0.3, -1.0, 2.0]);
    // More than a uniform block holds.
    let many: Vec<Ghost> =
        (0..1100).map(|k| Ghost { center: at().into(), ..ghosts[k % ghosts.len()].clone() }).collect();
    hold(&[("all", by_direct(&ghosts, frame, 3e-7)), ("many", by_direct(&many, Frame::full(25, 15), 3e-7))]);
}

#[test]
fn periodic_bells_are_exact_whatever_their_period() {
    let frame = Frame::full(80, 45);
    let mut plans = Vec::new();
    for period in [4.0, 30.0, 1000.0, 1e4] {
        let period = DVec2::splat(period);
        let sizes = [0.05f64, 0.5].map(|size| size.max(3e-5 * period.x));
        for (size, mean) in sizes.into_iter().zip([0.0, 0.3]) {
            for bell in [Bell::VonMises(VonMises { period }), Bell::SineGaussian(SineGaussian { period, mean })] {
                for (tolerance, far) in [(1e-4, 0.0), (1e-6, 1.5)] {
                    let center = [0.3 + far * period.x, 0.2];
                    plans.push(("periodic", by_direct(&[ghost(bell.clone(), center, size)], frame, tolerance)));
                }
            }
        }
    }
    hold(&plans);
}

#[test]
fn periodic_bells_have_no_copies_and_auto_may_sum_them_in_their_own_period() {
    let frame = Frame::full(64, 36);
    let period = DVec2::splat(4.0);
    let (von_mises, sine) =
        (Bell::VonMises(VonMises { period }), Bell::SineGaussian(SineGaussian { period, mean: 0.4 }));
    let far = [ghost(von_mises.clone(), [3.5, 0.0], 0.3)];
    let request = Request { evaluator: Some(Evaluator::Rows), period: Some(period), ..Request::new(1e-3) };
    let plan_of_far = plan(&far, frame, &request).unwrap();
    assert!(plan_of_far.predicted.periodisation == 0.0 && plan_of_far.predicted.total() <= 1e-3);
    let mut plans = vec![("far", plan_of_far)];
    for own in [von_mises, sine] {
        for bell in Bell::examples().into_iter().filter(|bell| bell.shape().period().is_none()) {
            let both = [ghost(own.clone(), [0.0, 0.0], 0.5), ghost(bell, [1.6, 0.2], 0.3)];
            for named in [None, Some(period)] {
                let request = Request { period: named, ..Request::new(1e-5) };
                let found = plan(&both, frame, &request).unwrap_or_else(|error| panic!("{}: {error}", both[1].bell));
                plans.push(("both", found));
            }
            let other = Request { period: Some(2.0 * period), ..Request::new(1e-5) };
            assert!(plan(&both, frame, &other).is_err(), "two periods");
        }
    }
    hold(&plans);
}

#[test]
fn a_jump_counts_for_what_it_is() {
    let frame = Frame::full(240, 135);
    let bound = |last: f64| {
        let bell = profile(&[[0.0, 1.0], [0.5, 0.4], [1.0, last]]);
        let plan = by_direct(&[ghost(bell, [0.2, 0.1], 0.8)], frame, 1e-3);
        (plan.precision, plan.predicted.total())
    };
    let (precision, predicted) = bound(0.0);
    // What a cosine leaves at its end in f64.
    assert_eq!(bound(3.7e-33), (precision, predicted));
    assert!(precision == Precision::Single && bound(1e-5).1 > 1e-5 && bound(1e-2).0 == Precision::Double);
}

#[test]
fn the_unit_of_a_profile_does_not_matter() {
    let frame = Frame::full(240, 135);
    let rows: Vec<[f64; 2]> = (0..=12).map(|i| [f64::from(i) / 12.0, (1.0 - f64::from(i) / 12.0).powi(2)]).collect();
    let bound = |unit: f64| {
        let bell = profile(&rows.iter().map(|[r, value]| [r * unit, *value]).collect::<Vec<_>>());
        by_direct(&[ghost(bell, [0.2, 0.1], 2.0 / unit)], frame, 1e-3).predicted.total()
    };
    let (own, pixels, tiny) = (bound(1.0), bound(1200.0), bound(1e-6));
    assert!(
        own < 2e-6 && (pixels / own - 1.0).abs() < 1e-6 && (tiny / own - 1.0).abs() < 1e-6,
        "{own} {pixels} {tiny}"
    );
}

#[test]
fn light_that_cancels_small_bells_and_huge_ones_are_summed_within_a_small_floor() {
    let frame = Frame::full(60, 34);
    let mut cancelling = [ghost(Bell::Gaussian, [0.0, 0.0], 0.3), ghost(Bell::Gaussian, [0.0, 0.0], 0.3000003)];
    cancelling[1].radiance = cancelling[0].radiance.map(|radiance| -radiance);
    let mut chance = Chance::new(5);
    let mut small = || {
        let center = [chance.between(-1.7, 1.7), chance.between(-1.0, 1.0)];
        ghost(Bell::Gaussian, center, 2.7 * frame.pixel_size())
    };
    let small: Vec<Ghost> = (0..600).map(|_| small()).collect();
    let huge = [ghost(Bell::Gaussian, [2e38, -2e38], 2e38)];
    // Each far below what f32 would cost them: 1.8 once, 4.5e-3, and 1.7 that nobody told of.
    hold(&[
        ("cancelling", by_direct(&cancelling, frame, 1e-6)),
        ("small", by_direct(&small, frame, 1e-6)),
        ("small in 32 bits", by_direct(&small, frame, 1e-3)),
        ("huge", by_direct(&huge, frame, 1e-6)),
    ]);
}
