//! A few small ghosts beside many wide ones: the small ones are summed, the others are a series, and the sum of both is as
//! exact as predicted.

use vglare::frame::Frame;
use vglare::gpu::Backend;
use vglare::plan::{CostModel, Evaluator, Layer, Plan, Request};
use vglare::reference::direct_at;
use vglare::renderer::{Normalize, Settings};
use vglare::scene::Ghost;
use vglare::series::Bell;

use crate::support::check::within;
use crate::support::{bits, glare, on_backend, on_one_backend, plan, scenes};

const FRAME: Frame = Frame::full(160, 90);

/// 300 wide Gaussians, and a few small ghosts of some bell.
fn mixed(seed: u64, small: usize, bell: &Bell) -> Vec<Ghost> {
    let mut ghosts = scenes::sized(seed, 300, FRAME, 0.3, 0.6);
    let few = scenes::sized(seed + 1, small, FRAME, 0.02, 0.04);
    // Inside the picture, so that none of them is dropped.
    ghosts.extend(few.into_iter().map(|ghost| Ghost { bell: bell.clone(), center: 0.5 * ghost.center, ..ghost }));
    ghosts
}

/// A cost model to which bells are cheap, and a series of few terms by one evaluator cheaper still; of a machine so slow
/// that any planning is worth its while.
fn in_favour_of(evaluator: Evaluator) -> CostModel {
    let mut model = CostModel { bell: 0.1, pass: 1.0, quad: 2e4, ..CostModel::default() };
    match evaluator {
        Evaluator::Direct => model.bell = 1e-3,
        // For photos alone.
        Evaluator::Plate => {}
        Evaluator::Local => (model.splat, model.quad, model.canvas) = (1e-3, 1e-3, 1e-3),
        Evaluator::Series => model.term = 0.01,
        Evaluator::Rows => (model.profile, model.harmonic) = (1.0, 0.05),
        Evaluator::Grid => {
            (model.profile, model.harmonic, model.strip, model.interpolation) = (1.0, 0.5, 0.01, 0.01);
        }
    }
    CostModel::from_values(model.values().map(|nanoseconds| 1e4 * nanoseconds))
}

fn planned(ghosts: &[Ghost], cost_model: CostModel, tolerance: f64) -> Plan {
    plan(ghosts, FRAME, &Request { cost_model, ..Request::new(tolerance) }).unwrap()
}

#[test]
fn a_series_and_a_sum_beside_it_are_as_exact_as_predicted() {
    let pixels = scenes::every_pixel(FRAME);
    let points = scenes::positions(FRAME, &pixels);
    for bell in [Bell::Gaussian, Bell::Parabola, Bell::CosineSquared] {
        let ghosts = mixed(5, 3, &bell);
        let exact = direct_at(&ghosts, &points);
        for evaluator in [Evaluator::Series, Evaluator::Rows, Evaluator::Grid] {
            for tolerance in [1e-2, 1e-3] {
                let plan = planned(&ghosts, in_favour_of(evaluator), tolerance);
                assert_eq!(plan.evaluator(), evaluator, "{bell}: {:?}", plan.costs);
                assert!((3..200).contains(&plan.summed()), "{bell}: {:?}", plan.costs);
                assert!(plan.predicted.total() <= tolerance, "{:?}", plan.predicted);
                on_one_backend(|backend, renderer| {
                    renderer.field.set_scene(&plan).unwrap();
                    let actual = renderer.field.probe(FRAME, &pixels).unwrap();
                    let name = format!("{backend}, {evaluator} beside {bell} at {tolerance:e}");
                    within(plan.predicted.total(), &name, &pixels, &exact, &actual);
                });
            }
        }
    }
}

#[test]
fn without_the_sum_beside_it_the_field_is_wrong() {
    let ghosts = mixed(5, 3, &Bell::Gaussian);
    let whole = planned(&ghosts, CostModel::default(), 1e-3);
    let series = whole.layers().iter().filter(|layer| matches!(layer, Layer::Series(_))).cloned();
    let mut series = Plan::by_hand(whole.problem().clone(), series.collect());
    series.scale = whole.scale;
    let [with, without] = [&whole, &series].map(|plan| on_backend(Backend::Egl, |r| glare(r, plan, FRAME)));
    let off = with.iter().zip(&without).map(|(a, b)| (a[0] - b[0]).abs()).fold(0.0f32, f32::max);
    assert!(f64::from(off) > 0.05 * whole.scale[0], "{off} of {:?}", whole.scale);
}

#[test]
fn what_costs_the_least_decides_who_is_summed() {
    let request = Request::new(1e-3);
    let of = |ghosts: &[Ghost]| plan(ghosts, FRAME, &request).unwrap();
    let wide = scenes::sized(5, 300, FRAME, 0.3, 0.6);
    assert_eq!(of(&wide).summed(), 0, "nothing is small");
    let few = of(&mixed(5, 3, &Bell::Gaussian));
    let beside = few.layers().iter().filter(|layer| !layer.evaluator().is_series()).flat_map(Layer::groups);
    let beside: Vec<_> = beside.collect();
    assert_eq!(beside.iter().map(|group| group.ghosts).sum::<usize>(), 3);
    let whole = few.costs.iter().find(|cost| cost.evaluator == few.evaluator() && cost.beside().is_none()).unwrap();
    assert!(few.cost().unwrap() < 0.7 * whole.milliseconds, "{:?}", few.costs);
    assert_eq!(beside.iter().map(|group| group.largest.max_element()).fold(0.0, f64::max).max(0.04), 0.04);
    let none = of(&mixed(5, 0, &Bell::Gaussian));
    assert_eq!(
        (none.evaluator(), none.degree()),
        (few.evaluator(), few.degree()),
        "the series is that of the wide ghosts"
    );
    // Many are summed where they reach.
    let many = of(&mixed(5, 2500, &Bell::Gaussian));
    assert!(many.summed() == 0 && many.costs[0].reaching >= 2000, "{:?}", many.costs);
    let all = planned(&mixed(5, 3, &Bell::Gaussian), in_favour_of(Evaluator::Direct), 1e-3);
    assert_eq!((all.evaluator(), all.summed(), all.terms()), (Evaluator::Direct, all.ghosts(), 0));
}

#[test]
fn what_is_asked_for_by_hand_is_not_split() {
    let ghosts = mixed(5, 3, &Bell::Gaussian);
    let request = Request::new(1e-2);
    let chosen = plan(&ghosts, FRAME, &request).unwrap();
    for by_hand in [
        Request { evaluator: Some(Evaluator::Rows), ..request },
        Request { period: Some(3.0 * chosen.period()), ..request },
        Request { degree: Some([64, 64]), ..request },
    ] {
        let plan = plan(&ghosts, FRAME, &by_hand).unwrap();
        assert!(plan.summed() == 0 && plan.terms() > 0, "{by_hand:?}: {:?}", plan.costs);
    }
}

#[test]
fn split_fields_meet_at_tiles_bit_for_bit_and_leave_no_trace() {
    let (ghosts, others) = (mixed(5, 3, &Bell::Gaussian), mixed(8, 2, &Bell::Parabola));
    for evaluator in [Evaluator::Series, Evaluator::Rows, Evaluator::Grid] {
        let [mine, theirs] = [&ghosts, &others].map(|ghosts| planned(ghosts, in_favour_of(evaluator), 1e-2));
        let settings = Settings { normalize: Normalize::Minmax, ..Settings::default() };
        on_backend(Backend::Egl, |renderer| {
            let once = bits(&glare(renderer, &mine, FRAME));
            let stretched = bits(&renderer.glare(FRAME, &settings).unwrap());
            glare(renderer, &theirs, FRAME);
            renderer.field.set_tile_pixels(1000);
            assert!(bits(&glare(renderer, &mine, FRAME)) == once, "{evaluator}");
            assert!(bits(&renderer.glare(FRAME, &settings).unwrap()) == stretched, "{evaluator}, stretched");
        });
    }
}
