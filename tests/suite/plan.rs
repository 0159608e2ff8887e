//! Tolerance in, plan out: what a plan predicts holds, what is asked of it is respected, and what cannot be had is said.

mod search;

use glam::DVec2;
use vglare::Error;
use vglare::frame::{Frame, Window};
use vglare::plan::{Cost, Evaluator, HIGHEST_DEGREE, Plan, Request};
use vglare::reference::{direct_at, series};
use vglare::scene::Ghost;

use crate::support::check::{Worst, within};
use crate::support::scenes::{self, Chance};
use crate::support::{long, on_one_backend, plan, plan_with};

/// Scenes by chance, and those of the long form.
const SCENES: u64 = 80;
const LONG: u64 = 200;

/// A scene, a frame and a tolerance by chance; the frame's window may lie off the picture in part.
fn chosen(seed: u64) -> (Vec<Ghost>, Frame, f64) {
    let mut chance = Chance::new(seed);
    let (width, height) = (chance.octaves(1.0, 3000.0) as u32, chance.octaves(1.0, 2000.0) as u32);
    let mut frame = Frame::full(width, height.max(width / 4));
    if chance.up_to(3) == 0 {
        let (x, y) = (chance.up_to(width) as i32, chance.up_to(height) as i32);
        let window =
            Window { x: x - width as i32 / 3, y: y - height as i32 / 3, width: width / 2 + 1, height: height / 2 + 1 };
        frame = frame.with_window(window);
    }
    let count = chance.octaves(1.0, 60.0) as usize;
    let mut ghosts = scenes::sized(seed + 1, count, frame, 0.1, 2.0);
    for ghost in &mut ghosts {
        match chance.up_to(15) {
            0 => ghost.radiance = ghost.radiance.map(|value| -value),
            1 => ghost.radiance[1] = 0.0,
            2 => ghost.center *= 5.0,
            _ => {}
        }
    }
    (ghosts, frame, chance.octaves(1e-4, 1e-1))
}

fn series_at(ghosts: &[Ghost], plan: &Plan, points: &[DVec2]) -> Vec<[f64; 3]> {
    points.iter().map(|&at| series(ghosts, plan.period(), plan.counts(), at)).collect()
}

/// The ghosts that a plan keeps.
fn kept(ghosts: &[Ghost], plan: &Plan) -> Vec<Ghost> {
    plan.groups().flat_map(|group| group.members.iter()).map(|&index| ghosts[index as usize].clone()).collect()
}

#[test]
fn a_plan_predicts_no_more_than_was_asked_and_no_less_than_comes() {
    let (mut planned, mut dropped, mut refused, mut unseen) = (0, 0, 0, 0);
    let mut share = Worst::default();
    let count = if long() { LONG } else { SCENES };
    for seed in 0..count {
        let (ghosts, frame, tolerance) = chosen(seed);
        let evaluator = Evaluator::ALL[seed as usize % 4];
        let request = Request { evaluator: Some(evaluator), ..Request::new(tolerance) };
        let plan = match plan(&ghosts, frame, &request) {
            Ok(plan) => plan,
            Err(Error::ToleranceBelowFloor { floor, .. }) => {
                assert!(floor > tolerance, "seed {seed}");
                refused += 1;
                continue;
            }
            Err(error) => panic!("seed {seed}: {error}"),
        };
        planned += 1;
        dropped += u64::from(plan.dropped > 0);
        assert!(plan.predicted.total() <= tolerance, "seed {seed}: {:?} for {tolerance:e}", plan.predicted);
        assert_eq!(plan.ghosts() + plan.dropped, ghosts.len(), "seed {seed}: each ghost is kept or dropped");
        assert!(plan.counts().is_sorted_by(|a, b| a >= b), "seed {seed}: rows grow: {:?}", plan.counts());
        assert_eq!(plan.terms(), plan.counts().iter().map(|&count| count as usize).sum::<usize>());

        let pixels = scenes::probes(seed, &ghosts, &plan, frame);
        let points = scenes::positions(frame, &pixels);
        let exact = direct_at(&ghosts, &points);
        let kept = kept(&ghosts, &plan);
        let actual =
            if evaluator == Evaluator::Direct { direct_at(&kept, &points) } else { series_at(&kept, &plan, &points) };
        // What is below 1e-30 of the ghosts' own radiance is nothing to f32, and the plan may leave it out.
        let peak = ghosts.iter().flat_map(|ghost| ghost.radiance).fold(0.0, |a: f64, b| a.max(b.abs()));
        if exact.as_flattened().iter().all(|value| value.abs() <= 1e-30 * peak) {
            assert!(actual.as_flattened().iter().all(|value| value.abs() <= 1e-30 * peak), "seed {seed}");
            unseen += 1;
            continue;
        }
        let predicted = plan.predicted.dropped + plan.predicted.periodisation + plan.predicted.truncation;
        // f64 rounds, too, a little for each ghost.
        let weight: f64 = plan.groups().map(|group| group.weight).sum();
        let limit = predicted.max(0.0) + 1e-13 * (1.0 + weight);
        let error = within(limit, &format!("seed {seed}, {evaluator}: {:?}", plan.predicted), &pixels, &exact, &actual);
        share.take(error.relative / limit, || format!("seed {seed}, {evaluator}"));
    }
    println!(
        "{planned} planned, {dropped} of them drop ghosts, {unseen} see nothing, {refused} below the floor; worst share of the prediction {share}"
    );
    assert!(20 * dropped > count, "some scenes have ghosts to drop, or the promise was not tried");
    assert!(refused * 10 <= count, "{refused} are below the floor: the scenes are too hard");
}

#[test]
fn a_plan_is_the_same_every_time() {
    for seed in (0..LONG).step_by(20) {
        let (ghosts, frame, tolerance) = chosen(seed);
        let request = Request::new(tolerance);
        match (plan(&ghosts, frame, &request), plan(&ghosts, frame, &request)) {
            (Ok(first), Ok(second)) => assert!(first == second, "seed {seed}"),
            (first, second) => assert_eq!(first.is_err(), second.is_err(), "seed {seed}"),
        }
    }
}

const FRAME: Frame = Frame::full(64, 36);

#[test]
fn what_is_given_is_kept() {
    let ghosts = scenes::sized(3, 10, FRAME, 0.2, 1.0);
    let (period, degree) = (DVec2::new(17.0, 15.0), [23, 19]);
    for evaluator in Evaluator::ALL {
        let asked = Request { evaluator: Some(evaluator), ..Request::new(1e-3) };
        assert_eq!(plan(&ghosts, FRAME, &asked).unwrap().evaluator(), evaluator);
        if !evaluator.is_series() {
            continue;
        }
        let by_period = plan(&ghosts, FRAME, &Request { period: Some(period), ..asked }).unwrap();
        assert_eq!(by_period.period(), period);
        let by_degree = plan(&ghosts, FRAME, &Request { degree: Some(degree), ..asked }).unwrap();
        assert_eq!((by_degree.degree(), by_degree.counts()), (degree, &[20; 24][..]), "the whole rectangle");
        assert_eq!(by_degree.terms(), 24 * 20);
        let both = plan(&ghosts, FRAME, &Request { period: Some(period), degree: Some(degree), ..asked }).unwrap();
        assert_eq!((both.period(), both.degree()), (period, degree));
    }
    // So large that the passes of no series alone take longer than the sum.
    let cheapest = plan(&ghosts, Frame::full(1280, 720), &Request::new(1e-3)).unwrap();
    let whole = |cost: &&Cost| cost.beside().is_none();
    assert_eq!(cheapest.costs.iter().filter(whole).count(), 5, "the costs of all are told");
    assert!(cheapest.costs.is_sorted_by(|a, b| a.milliseconds <= b.milliseconds));
    assert_eq!(cheapest.evaluator(), cheapest.costs[0].evaluator);
}

/// A period and a degree that are bad choices are still predicted, and the prediction still holds.
#[test]
fn a_poor_choice_of_period_and_degree_is_predicted_as_it_comes() {
    // The series is summed in f64 at every pixel.
    let frame = Frame::full(32, 18);
    let ghosts = scenes::sized(3, 10, frame, 0.2, 1.0);
    let pixels = scenes::every_pixel(frame);
    let points = scenes::positions(frame, &pixels);
    let exact = direct_at(&ghosts, &points);
    for (period, degree) in [(2.0, 3), (3.0, 40), (5.0, 5), (8.0, 60), (40.0, 10)] {
        let (given, degree) = (Some(DVec2::splat(period)), Some([degree; 2]));
        let request = Request { evaluator: Some(Evaluator::Rows), period: given, degree, ..Request::new(1e-3) };
        let plan = plan(&ghosts, frame, &request).unwrap();
        let name = format!("period {period}, degree {degree:?}");
        let error = within(plan.predicted.total(), &name, &pixels, &exact, &series_at(&ghosts, &plan, &points));
        println!("{name}: {:.1e} of {:.1e} predicted", error.relative, plan.predicted.total());
    }
}

#[test]
fn a_tolerance_that_f32_cannot_meet_names_the_one_that_it_can() {
    let ghosts = scenes::sized(3, 10, FRAME, 0.2, 1.0);
    for evaluator in Evaluator::ALL.map(Some).into_iter().chain([None]) {
        let request = |tolerance| Request { evaluator, ..Request::new(tolerance) };
        let Err(Error::ToleranceBelowFloor { asked, floor }) = plan(&ghosts, FRAME, &request(1e-9)) else {
            panic!("{evaluator:?}: 1e-9 cannot be had")
        };
        assert_eq!(asked, 1e-9);
        assert!((1e-8..1e-3).contains(&floor), "{evaluator:?}: {floor:e}");
        let plan = plan(&ghosts, FRAME, &request(1.0001 * floor)).unwrap();
        assert!(plan.predicted.total() <= 1.0001 * floor, "the floor itself can be had");
    }
}

#[test]
fn tolerances_that_are_none_are_refused() {
    for tolerance in [0.0, -1e-3, f64::NAN, 1.0, 2.0, f64::INFINITY] {
        let error = plan(&[], FRAME, &Request::new(tolerance)).unwrap_err();
        assert!(matches!(error, Error::Plan(_)) && error.to_string().contains("tolerance"), "{tolerance}: {error}");
    }
}

#[test]
fn ghosts_far_away_are_dropped_and_counted() {
    let near = scenes::sized(3, 5, FRAME, 0.2, 1.0);
    let far = scenes::sized(4, 7, FRAME, 0.1, 0.5);
    let far: Vec<Ghost> =
        far.iter().map(|ghost| Ghost { center: ghost.center + DVec2::new(20.0, 0.0), ..ghost.clone() }).collect();
    let plan = plan(&[near.clone(), far.clone()].concat(), FRAME, &Request::new(1e-3)).unwrap();
    assert_eq!((plan.dropped, plan.ghosts()), (7, 5));
    assert!((0.0..2e-5).contains(&plan.predicted.dropped), "{:?}", plan.predicted);
    // Alone they are nothing: 1e-280 of what they are at their centres.
    for evaluator in Evaluator::ALL {
        assert_eq!(plan_with(&far, FRAME, 1e-3, evaluator).dropped, 7);
    }
}

// A light that leaves the picture must not end in an error: a series cannot tell its flank from rounding, but the
// direct sum can.
#[test]
fn flanks_of_ghosts_off_the_picture_are_for_the_direct_sum() {
    let pixels = scenes::every_pixel(FRAME);
    let points = scenes::positions(FRAME, &pixels);
    for distance in [3.0, 4.0, 6.0, 9.0] {
        let ghosts = [scenes::one([FRAME.x(63.0) + 0.4 * distance, 0.2], 0.4, [1.0, 2.0, 3.0])];
        let chosen = plan(&ghosts, FRAME, &Request::new(1e-3)).unwrap();
        let exact = direct_at(&ghosts, &points);
        let error = on_one_backend(|backend, renderer| {
            renderer.field.set_scene(&chosen).unwrap();
            let name = format!("{backend}, {distance} sizes away");
            within(chosen.predicted.total(), &name, &pixels, &exact, &renderer.field.probe(FRAME, &pixels).unwrap())
                .relative
        });
        println!("{distance} sizes away, {}: {error:.1e} of {:e}", chosen.evaluator(), chosen.predicted.total());
    }
}

/// Scenes at the edges of what numbers can be, which every evaluator has to render within what it predicts.
fn odd_scenes() -> Vec<(&'static str, Vec<Ghost>)> {
    let plain = || scenes::sized(9, 4, FRAME, 0.3, 1.0);
    let with = |radiance: fn([f64; 3]) -> [f64; 3]| -> Vec<Ghost> {
        plain().into_iter().map(|ghost| Ghost { radiance: radiance(ghost.radiance), ..ghost }).collect()
    };
    vec![
        ("no ghost", Vec::new()),
        ("no radiance", with(|_| [0.0; 3])),
        ("negative", with(|radiance| radiance.map(|value| -value))),
        ("no green", with(|[r, _, b]| [r, 0.0, b])),
        ("only blue", with(|[_, _, b]| [0.0, 0.0, b])),
        ("faint", with(|radiance| radiance.map(|value| 1e-30 * value))),
        ("blinding", with(|radiance| radiance.map(|value| 1e30 * value))),
        ("faint beside blinding", with(|[r, g, b]| [1e-10 * r, g, 1e10 * b])),
        ("very wide", vec![scenes::one([0.3, 0.1], 1e4, [1.0, 2.0, 3.0])]),
    ]
}

#[test]
fn odd_scenes_are_planned_and_rendered() {
    let pixels = scenes::every_pixel(FRAME);
    let points = scenes::positions(FRAME, &pixels);
    on_one_backend(|backend, renderer| {
        for (name, ghosts) in odd_scenes() {
            let exact = direct_at(&ghosts, &points);
            for evaluator in Evaluator::ALL {
                let name = format!("{backend}, {name}, {evaluator}");
                let plan = plan_with(&ghosts, FRAME, 1e-3, evaluator);
                assert!(plan.predicted.total() <= 1e-3, "{name}: {:?}", plan.predicted);
                renderer.field.set_scene(&plan).unwrap();
                let actual = renderer.field.probe(FRAME, &pixels).unwrap();
                within(plan.predicted.total(), &name, &pixels, &exact, &actual);
            }
        }
    });
}

#[test]
fn a_tiny_ghost_is_for_the_direct_sum_only() {
    let frame = Frame::full(65, 37);
    let ghosts = [scenes::one([0.0, 0.0], 1e-6, [1.0, 2.0, 3.0])];
    for evaluator in [Evaluator::Series, Evaluator::Rows, Evaluator::Grid] {
        let request = Request { evaluator: Some(evaluator), ..Request::new(1e-3) };
        let refusal = plan(&ghosts, frame, &request).unwrap_err().to_string();
        assert!(refusal.contains("degree") && refusal.contains(&HIGHEST_DEGREE.to_string()), "{refusal}");
    }
    let chosen = plan(&ghosts, frame, &Request::new(1e-3)).unwrap();
    assert_eq!(chosen.evaluator(), Evaluator::Direct);
    let pixels = scenes::every_pixel(frame);
    let exact = direct_at(&ghosts, &scenes::positions(frame, &pixels));
    on_one_backend(|backend, renderer| {
        renderer.field.set_scene(&chosen).unwrap();
        let actual = renderer.field.probe(frame, &pixels).unwrap();
        within(chosen.predicted.total(), &backend.to_string(), &pixels, &exact, &actual);
    });
    // Off every pixel's centre nothing sees it.
    let between = [Ghost { center: DVec2::splat(0.3 * frame.pixel_size()), ..ghosts[0].clone() }];
    assert_eq!(plan(&between, frame, &Request::new(1e-3)).unwrap().dropped, 1);
}

#[test]
fn a_hundred_thousand_ghosts_are_planned() {
    let frame = Frame::full(1920, 1080);
    let ghosts = scenes::random(1, 100_000, frame);
    let plan = plan(&ghosts, frame, &Request::new(1e-3)).unwrap();
    assert_eq!(plan.ghosts() + plan.dropped, ghosts.len());
}
