//! Fields of several layers: a series, ghosts that are summed where they reach, and ghosts that are summed at every pixel.

use vglare::certificate::Certificate;
use vglare::frame::Frame;
use vglare::plan::{CostModel, Evaluator, Layer, Plan, Request};
use vglare::scene::Ghost;
use vglare::series::Bell;

use crate::support::{bits, glare, on_each_backend, on_one_backend, plan, scenes};

const FRAME: Frame = Frame::full(160, 90);

/// Nanoseconds so long that any planning is worth its while, and parts of them so short that a few ghosts decide.
const SLOW: f64 = 1e4;

fn model(bell: f64, grid: f64) -> CostModel {
    let reaching = CostModel { splat: 1.0, quad: 20.0, canvas: 0.5, ..CostModel::default() };
    let model = CostModel { bell, interpolation: grid, strip: grid, harmonic: grid, profile: grid, ..reaching };
    let model = CostModel { pass: 1.0, spectrum: 0.1 * grid, term: 100.0, ..model };
    CostModel::from_values(model.values().map(|nanoseconds| SLOW * nanoseconds))
}

/// Wide ghosts, and small ones of some bell.
fn mixed(wide: usize, small: usize, bell: &Bell) -> Vec<Ghost> {
    let mut ghosts = scenes::sized(3, wide, FRAME, 0.3, 0.6);
    let few = scenes::sized(4, small, FRAME, 0.02, 0.06);
    ghosts.extend(few.into_iter().map(|ghost| Ghost { bell: bell.clone(), center: 0.7 * ghost.center, ..ghost }));
    ghosts
}

fn planned(ghosts: &[Ghost], cost_model: CostModel, tolerance: f64) -> Plan {
    plan(ghosts, FRAME, &Request { cost_model, ..Request::new(tolerance) }).unwrap()
}

/// Which layers there are.
fn kinds(plan: &Plan) -> Vec<Evaluator> {
    let mut kinds: Vec<Evaluator> = plan.layers().iter().map(Layer::evaluator).collect();
    kinds.sort_by_key(|kind| Evaluator::ALL.iter().position(|other| other == kind));
    kinds
}

/// Holds a plan against the definition at every pixel.
fn hold(name: &str, plan: &Plan) {
    let found = on_one_backend(|_, renderer| Certificate::measure_all(&mut renderer.field, plan, |_| ()).unwrap());
    let (measured, predicted) = (found.measured, found.predicted);
    println!("{name}: {measured:.1e} measured, {predicted:.1e} predicted, {:?}", plan.costs[0]);
    assert!(measured <= predicted && predicted <= plan.tolerance, "{name}: {found:?}, {:?}", plan.predicted);
}

#[test]
fn small_ghosts_reach_beside_a_series_of_wide_ones() {
    for bell in [Bell::Gaussian, Bell::Parabola, Bell::Paraboloid] {
        let ghosts = mixed(300, 200, &bell);
        for tolerance in [1e-2, 1e-3, 1e-5] {
            let plan = planned(&ghosts, model(5.0, 1.0), tolerance);
            let name = format!("{bell} at {tolerance:e}");
            assert_eq!(kinds(&plan), [Evaluator::Grid, Evaluator::Local], "{name}: {:?}", plan.costs);
            assert_eq!(plan.evaluator(), Evaluator::Grid, "the series names the plan");
            assert!(plan.costs[0].reaching + plan.dropped >= 200, "{:?}", plan.costs);
            assert_eq!(plan.ghosts() + plan.dropped, ghosts.len(), "every ghost has one layer");
            hold(&name, &plan);
        }
    }
}

#[test]
fn small_ghosts_reach_beside_wide_ones_that_are_summed_everywhere() {
    let ghosts = mixed(40, 400, &Bell::CosineSquared);
    for tolerance in [1e-2, 1e-4] {
        let plan = planned(&ghosts, model(0.2, 1e4), tolerance);
        assert_eq!(kinds(&plan), [Evaluator::Direct, Evaluator::Local], "{:?}", plan.costs);
        assert!(plan.summed() >= 30 && plan.costs[0].reaching >= 300, "{:?}", plan.costs);
        hold(&format!("at {tolerance:e}"), &plan);
    }
}

#[test]
fn all_three_kinds_stand_beside_each_other() {
    let period = glam::DVec2::new(6.0, 4.0);
    let mut ghosts = mixed(300, 200, &Bell::Gaussian);
    // Rectangles as wide as the picture: sharp, so no series, and everywhere, so nowhere to be left out.
    ghosts.extend(mixed(3, 0, &Bell::Gaussian).into_iter().map(|ghost| Ghost {
        bell: Bell::Parabola,
        size: period,
        ..ghost
    }));
    let plan = planned(&ghosts, model(0.3, 0.1), 1e-4);
    assert_eq!(kinds(&plan), [Evaluator::Direct, Evaluator::Grid, Evaluator::Local], "{:?}", plan.costs);
    hold("all three", &plan);
}

/// Layers meet at tiles, and leave no trace for the next scene.
#[test]
fn layers_are_the_same_bits_in_tiles_and_after_another_scene() {
    let (mine, theirs) = (mixed(300, 200, &Bell::Gaussian), mixed(40, 400, &Bell::CosineSquared));
    let (mine, theirs) = (planned(&mine, model(5.0, 1.0), 1e-3), planned(&theirs, model(0.2, 1e4), 1e-3));
    on_each_backend(|backend, renderer| {
        let once = bits(&glare(renderer, &mine, FRAME));
        glare(renderer, &theirs, FRAME);
        renderer.field.set_tile_pixels(1000);
        assert!(bits(&glare(renderer, &mine, FRAME)) == once, "{backend}");
    });
}

/// What is planned is no more than what was looked at: a layer is cheaper than the best single evaluator, or not taken.
#[test]
fn layers_are_taken_where_they_are_cheaper() {
    let ghosts = mixed(300, 200, &Bell::Gaussian);
    let plan = planned(&ghosts, model(5.0, 1.0), 1e-3);
    let whole = plan.costs.iter().filter(|cost| cost.beside().is_none()).map(|cost| cost.milliseconds);
    let whole = whole.fold(f64::INFINITY, f64::min);
    assert!(plan.cost().unwrap() < whole, "{:?}", plan.costs);
    let wide = planned(&mixed(300, 0, &Bell::Gaussian), model(5.0, 1.0), 1e-3);
    assert_eq!(kinds(&wide), [Evaluator::Grid], "{:?}", wide.costs);
}

/// A renderer that ends loops early is not asked to sum at every pixel more than it goes through.
#[test]
fn layers_keep_to_the_rounds_that_a_renderer_has() {
    let ghosts = mixed(40, 400, &Bell::CosineSquared);
    let request = Request { cost_model: model(0.2, 1e4), loop_rounds: 2, ..Request::new(1e-2) };
    let plan = plan(&ghosts, FRAME, &request).unwrap();
    assert!(plan.summed() <= 7 * request.loop_rounds, "{:?}", plan.costs);
}
