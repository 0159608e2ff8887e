//! What a budget buys, what f32 can give at best, what was refused, and what the cost model decides.

use glam::DVec2;
use vglare::Error;
use vglare::frame::Frame;
use vglare::plan::{CostModel, Evaluator, Request};

use super::FRAME;
use crate::support::check::Worst;
use crate::support::{plan, plan_at_least, plan_within, scenes};

/// What a tolerance costs, step by step from loose to tight.
fn ladder() -> impl Iterator<Item = f64> {
    (0..44).map(|step| 0.4 * 0.8f64.powi(step))
}

#[test]
fn a_tighter_tolerance_hardly_ever_costs_less() {
    let mut steps = 0;
    let mut dip = Worst::default();
    for seed in 0..12 {
        let frame = Frame::full(480, 270);
        let ghosts = scenes::sized(seed, 10 + 30 * seed as usize, frame, 0.1, 1.5);
        let costs: Vec<f64> = ladder()
            .map_while(|tolerance| plan(&ghosts, frame, &Request::new(tolerance)).ok().and_then(|plan| plan.cost()))
            .collect();
        assert!(costs.last() > costs.first(), "seed {seed}: {costs:?}");
        for pair in costs.windows(2) {
            steps += 1;
            dip.take(1.0 - pair[1] / pair[0], || format!("seed {seed}: {} ms after {} ms", pair[1], pair[0]));
        }
    }
    println!("{steps} steps; the largest dip {dip}");
    // Layers, and whether to look at the modes, are chosen by estimates.
    assert!(dip.value < 0.1, "a bisection over the cost would be lost: {dip}");
    assert!(steps > 300, "{steps} steps are too few to say so");
}

#[test]
fn a_budget_buys_the_tightest_plan_that_it_can() {
    let frame = Frame::full(480, 270);
    for seed in 0..6 {
        let ghosts = scenes::sized(seed, 40, frame, 0.1, 1.5);
        let request = Request::new(1e-3);
        let cost = |tolerance| plan(&ghosts, frame, &Request { tolerance, ..request }).unwrap().cost().unwrap();
        let (cheap, dear) = (cost(0.5), cost(1e-4));
        for part in [0.0, 0.2, 0.5, 0.9] {
            let budget = cheap + part * (dear - cheap);
            let bought = plan_within(&ghosts, frame, &request, budget).unwrap();
            assert!(bought.cost().unwrap() <= budget, "seed {seed}: {bought:?}");
            assert!(bought.predicted.total() <= bought.tolerance, "seed {seed}: {:?}", bought.predicted);
            // What is tighter by more than a step of the search costs more, unless there is nothing tighter.
            match plan(&ghosts, frame, &Request { tolerance: bought.tolerance / 1.1, ..request }) {
                Ok(tighter) => assert!(tighter.cost().unwrap() > budget, "seed {seed}, {part}: {}", bought.tolerance),
                Err(error) => assert!(matches!(error, Error::ToleranceBelowFloor { .. }), "{error}"),
            }
        }
        let Err(Error::BudgetTooSmall { asked, least }) = plan_within(&ghosts, frame, &request, 0.5 * cheap) else {
            panic!("seed {seed}: half of the least cost bought something")
        };
        assert_eq!((asked, least), (0.5 * cheap, cheap));
        // With all the time in the world, what f32 can give.
        let finest = plan_within(&ghosts, frame, &request, 1e9).unwrap();
        let floor = plan_at_least(&ghosts, frame, &Request { tolerance: 1e-9, ..request }).unwrap();
        assert_eq!(finest.tolerance, floor.tolerance);
    }
}

#[test]
fn a_budget_is_spent_on_what_was_given_by_hand_too() {
    let ghosts = scenes::sized(3, 10, FRAME, 0.2, 1.0);
    let (period, degree) = (Some(DVec2::splat(8.0)), Some([7, 7]));
    let request = Request { evaluator: Some(Evaluator::Rows), period, degree, ..Request::new(1e-3) };
    let plan = plan_within(&ghosts, FRAME, &request, 1e6).unwrap();
    assert_eq!(plan.degree(), [7, 7]);
    assert!(plan.predicted.total() <= plan.tolerance && plan.tolerance > 1e-3, "{:?}", plan.predicted);
}

#[test]
fn at_the_floor_is_as_exact_as_it_gets() {
    let ghosts = scenes::sized(3, 10, FRAME, 0.2, 1.0);
    for evaluator in Evaluator::ALL.map(Some).into_iter().chain([None]) {
        let request = |tolerance| Request { evaluator, ..Request::new(tolerance) };
        let Err(Error::ToleranceBelowFloor { floor, .. }) = plan(&ghosts, FRAME, &request(1e-9)) else {
            panic!("{evaluator:?}: 1e-9 cannot be had")
        };
        let clamped = plan_at_least(&ghosts, FRAME, &request(1e-9)).unwrap();
        assert!((floor..1.01 * floor).contains(&clamped.tolerance), "{evaluator:?}: {} {floor}", clamped.tolerance);
        assert!(clamped.predicted.total() <= clamped.tolerance, "{evaluator:?}: {:?}", clamped.predicted);
        // What can be had is left alone.
        assert_eq!(
            plan_at_least(&ghosts, FRAME, &request(1e-3)).unwrap(),
            plan(&ghosts, FRAME, &request(1e-3)).unwrap()
        );
    }
    let floors = |evaluator| match plan(&ghosts, FRAME, &Request { evaluator, ..Request::new(1e-9) }) {
        Err(Error::ToleranceBelowFloor { floor, .. }) => floor,
        other => panic!("{other:?}"),
    };
    let least = Evaluator::ALL.map(|evaluator| floors(Some(evaluator))).into_iter().fold(f64::INFINITY, f64::min);
    assert_eq!(floors(None), least, "of all evaluators the lowest floor is named");
}

#[test]
fn what_is_refused_is_named_with_the_reason() {
    // So large that the passes of `series` alone take less than a single bell, whose degree it has not.
    let frame = Frame::full(1921, 1081);
    let tiny = [scenes::one([0.0, 0.0], 1e-6, [1.0, 2.0, 3.0])];
    let chosen = plan(&tiny, frame, &Request::new(1e-3)).unwrap();
    let refused: Vec<_> = chosen.refused.iter().map(|refusal| refusal.evaluator).collect();
    assert_eq!(refused, [Evaluator::Series, Evaluator::Rows, Evaluator::Grid]);
    let says = ["degree", "the passes of rows alone", "the passes of grid alone"];
    let said = chosen.refused.iter().zip(says).all(|(refusal, says)| refusal.reason.contains(says));
    assert!(said, "{:?}", chosen.refused);
    // A renderer that ends loops early can neither sum many bells nor many terms.
    let ghosts = scenes::sized(3, 40, FRAME, 0.2, 1.0);
    let chosen = plan(&ghosts, frame, &Request { loop_rounds: 4, ..Request::new(1e-3) }).unwrap();
    let refused: Vec<_> = chosen.refused.iter().map(|refusal| refusal.evaluator).collect();
    assert_eq!(refused, [Evaluator::Direct, Evaluator::Series]);
    assert!(chosen.refused.iter().all(|refusal| refusal.reason.contains("loop")), "{:?}", chosen.refused);
    let whole = chosen.costs.iter().filter(|cost| cost.beside().is_none());
    assert_eq!(whole.count() + chosen.refused.len(), 5);
    assert_eq!(plan(&ghosts, frame, &Request::new(1e-3)).unwrap().refused, []);
}

#[test]
fn the_cost_model_decides() {
    let ghosts = scenes::sized(3, 10, FRAME, 0.2, 1.0);
    let with = |cost_model| plan(&ghosts, FRAME, &Request { cost_model, ..Request::new(1e-3) }).unwrap();
    let built_in = CostModel::default();
    assert!(built_in.is_sound());
    let cheap_bells = with(CostModel { bell: 1e-9, pass: 1.0, ..built_in });
    assert_eq!(cheap_bells.evaluator(), Evaluator::Direct);
    let dear = CostModel { bell: 1e9, splat: 1e9, term: 1e9, harmonic: 1e9, ..built_in };
    assert_eq!(with(dear).evaluator(), Evaluator::Grid);
    // Twice as slow a machine, twice the cost, the same plan.
    let (once, twice) = (with(built_in), with(CostModel::from_values(built_in.values().map(|value| 2.0 * value))));
    assert_eq!(once.evaluator(), twice.evaluator());
    for (once, twice) in once.costs.iter().zip(&twice.costs) {
        assert!((twice.milliseconds / once.milliseconds - 2.0).abs() < 1e-12);
    }
    for value in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(!CostModel { strip: value, ..built_in }.is_sound(), "{value}");
    }
}
