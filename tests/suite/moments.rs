//! A spectrum that is gathered from the moments of cells is the one that every ghost's own waves add up to.

use std::f64::consts::TAU;

use glam::DVec2;
use vglare::frame::Frame;
use vglare::gpu::Backend;
use vglare::plan::{CostModel, Evaluator, Plan, Request, Transform};
use vglare::reference::direct_at;
use vglare::scene::Ghost;
use vglare::series::Bell;
use vglare::series::moments::{Cells, Point, Sums, order_within};

use crate::support::check::{Worst, within};
use crate::support::scenes::{self, Chance};
use crate::support::{bits, glare, on_backend, on_one_backend, plan};

/// What f64 may leave of weights that add up to 1.
const ROUNDING: f64 = 1e-14;

/// The sums by definition.
fn trigonometric(points: &[Point], degree: [u32; 2]) -> Vec<Sums> {
    let modes = (0..=degree[1]).flat_map(|m| (0..=degree[0]).map(move |n| (n, m)));
    let sum = |(n, m): (u32, u32)| {
        let mut sums = Sums::default();
        for Point { turns: [x, y], weight } in points {
            let ((sx, cx), (sy, cy)) = ((TAU * f64::from(n) * x).sin_cos(), (TAU * f64::from(m) * y).sin_cos());
            for (sums, weight) in sums.iter_mut().zip(weight) {
                let waves = [cx * cy, cx * sy, sx * cy, sx * sy];
                sums.iter_mut().zip(waves).for_each(|(sum, wave)| *sum += weight * wave);
            }
        }
        sums
    };
    modes.map(sum).collect()
}

/// The largest difference, in units of the weights' sum.
fn off(points: &[Point], cells: Cells, degree: [u32; 2]) -> f64 {
    let actual = cells.sums(points.len(), |k| points[k], degree);
    let exact = trigonometric(points, degree);
    assert_eq!(actual.len(), exact.len());
    let heaviest = |colour: usize| points.iter().map(|point| point.weight[colour].abs()).sum::<f64>();
    let weight: f64 = [0, 1, 2].map(heaviest).into_iter().fold(f64::MIN_POSITIVE, f64::max);
    let values = |sums: &[Sums]| sums.as_flattened().as_flattened().to_vec();
    let differences = values(&actual).into_iter().zip(values(&exact)).map(|(a, b)| (a - b).abs() / weight);
    differences.fold(0.0, |worst, difference| if difference.is_nan() { f64::NAN } else { worst.max(difference) })
}

fn cells(counts: [u32; 2], degree: [u32; 2], error: f64) -> Cells {
    Cells { counts, orders: [0, 1].map(|axis| order_within(degree[axis], counts[axis], error)) }
}

/// Points anywhere, weights of both signs.
fn points(seed: u64, count: usize) -> Vec<Point> {
    let mut chance = Chance::new(seed);
    let point = |_| Point {
        turns: [chance.between(0.0, 1.0), chance.between(0.0, 1.0)],
        weight: [0; 3].map(|_| chance.between(-1.0, 1.0)),
    };
    (0..count).map(point).collect()
}

#[test]
fn sums_are_within_their_bound() {
    let mut share = Worst::default();
    for (seed, (count, degree, counts)) in [
        (1, [7, 5], [3, 4]),
        (2, [0, 0], [1, 1]),
        (50, [0, 9], [5, 8]),
        (300, [18, 12], [36, 24]),
        (300, [18, 12], [5, 3]),
        (1000, [3, 40], [1, 100]),
        (40_000, [6, 4], [2, 1]),
    ]
    .into_iter()
    .enumerate()
    {
        let points = points(seed as u64, count);
        for error in [1e-1, 1e-4, 1e-9, 1e-13] {
            let cells = cells(counts, degree, error);
            let (off, bound) = (off(&points, cells, degree), cells.error(degree));
            let name = format!("{count} points, degree {degree:?}, {cells:?}");
            assert!(off <= bound + ROUNDING, "{name}: {off:e} of {bound:e}");
            share.take(off / (bound + ROUNDING), || name);
        }
    }
    println!("worst share of the bound {share}");
}

#[test]
fn the_bound_is_nearly_reached_at_the_edge_of_a_cell() {
    for (degree, counts) in [([18, 0], [36, 1]), ([0, 12], [1, 12]), ([30, 30], [20, 30])] {
        for error in [1e-3, 1e-6, 1e-9] {
            let cells = cells(counts, degree, error);
            // All along the cell, the edge included.
            let place = |k: u32, count: u32| f64::from(k) / 64.0 / f64::from(count);
            let worst = (0..64).map(|k| {
                let turns = [place(k, counts[0]), place(k, counts[1])];
                off(&[Point { turns, weight: [1.0, -0.5, 0.0] }], cells, degree)
            });
            let (worst, bound) = (worst.fold(0.0, f64::max), cells.error(degree));
            assert!((0.2..1.0).contains(&(worst / bound)), "{degree:?}, {cells:?}: {worst:e} of {bound:e}");
        }
    }
}

#[test]
fn edges_of_cells_and_of_the_period_are_places_like_any_other() {
    let (counts, degree) = ([6, 4], [9, 7]);
    let below = |x: f64| f64::from_bits(x.to_bits() - 1);
    let mut places = vec![0.0, f64::MIN_POSITIVE, below(1.0)];
    for edge in (1..6).map(|k| f64::from(k) / 6.0).chain((1..4).map(|k| f64::from(k) / 4.0)) {
        places.extend([edge, below(edge), edge + f64::EPSILON]);
    }
    // A place that rounding has put one turn on.
    places.push(1.0);
    for &x in &places {
        for &y in &places {
            let off = off(&[Point { turns: [x, y], weight: [1.0, 2.0, -3.0] }], cells(counts, degree, 1e-13), degree);
            assert!(off <= 2.0 * ROUNDING + 2e-13, "{x}, {y}: {off:e}");
        }
    }
}

#[test]
fn moments_grow_with_each_digit_by_about_one() {
    let orders: Vec<u32> = (1..=12).map(|digits| order_within(18, 72, 10f64.powi(-digits))).collect();
    assert!(orders.is_sorted() && orders[11] <= orders[0] + 12, "{orders:?}");
    assert_eq!(order_within(0, 5, 1e-15), 1, "a constant has one moment");
    // Neither few cells nor many harmonics leave it without a bound.
    assert!((100..200).contains(&order_within(40, 1, 1e-12)));
}

#[test]
fn sums_do_not_depend_on_the_threads() {
    let points = points(5, 50_000);
    let cells = cells([3, 2], [8, 6], 1e-6);
    let by = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| cells.sums(points.len(), |k| points[k], [8, 6]))
    };
    let (one, two) = (by(1), by(2));
    assert_eq!(one, two);
    assert_eq!(one, by(2));
}

const FRAME: Frame = Frame::full(64, 36);

/// Ghosts of one size, some far outside the picture and some dark.
fn alike(bell: &Bell, count: usize, size: f64) -> Vec<Ghost> {
    let mut ghosts = scenes::random(count as u64, count, FRAME);
    for (k, ghost) in ghosts.iter_mut().enumerate() {
        (ghost.bell, ghost.size) = (bell.clone(), DVec2::new(size, 0.8 * size));
        match k % 7 {
            0 => ghost.center *= 2.5,
            1 => ghost.radiance = ghost.radiance.map(|radiance| -0.3 * radiance),
            _ => {}
        }
    }
    ghosts
}

fn cheap(change: impl FnOnce(&mut CostModel)) -> CostModel {
    let mut model = CostModel::default();
    change(&mut model);
    model
}

fn gathers(plan: &Plan) -> bool {
    plan.groups().any(|group| matches!(group.transform, Transform::Gather(_)))
}

/// A plan of an evaluator that gathers where it can, or that does not.
fn planned(ghosts: &[Ghost], evaluator: Evaluator, gather: bool) -> Plan {
    let cost_model = if gather {
        cheap(|model| (model.moment, model.pass) = (1e-6, 1e-3))
    } else {
        cheap(|model| model.moment = 1e9)
    };
    let request = Request { evaluator: Some(evaluator), cost_model, ..Request::new(1e-3) };
    let plan = plan(ghosts, FRAME, &request).unwrap();
    assert_eq!(gathers(&plan), gather, "{evaluator}: {:?}", plan.layers());
    assert!(plan.predicted.total() <= 1e-3 && (plan.predicted.gathering > 0.0) == gather, "{:?}", plan.predicted);
    // What the plan has computed on its way would be neither.
    plan.without_modes()
}

#[test]
fn a_gathered_field_is_the_dispatched_one_and_both_are_as_exact_as_predicted() {
    let pixels = scenes::every_pixel(FRAME);
    let points = scenes::positions(FRAME, &pixels);
    for bell in Bell::examples() {
        let ghosts = alike(&bell, 40, 0.7);
        let exact = direct_at(&ghosts, &points);
        for evaluator in [Evaluator::Series, Evaluator::Rows, Evaluator::Grid] {
            // A periodic bell's copies, or a sharp bell's degree, may leave no plan at all.
            let request = Request { evaluator: Some(evaluator), ..Request::new(1e-3) };
            // And a software renderer does not go through as many terms for each pixel.
            if !plan(&ghosts, FRAME, &request).is_ok_and(|plan| plan.terms() < 60_000) {
                continue;
            }
            let plans = [true, false].map(|gather| planned(&ghosts, evaluator, gather));
            on_one_backend(|backend, renderer| {
                for plan in &plans {
                    renderer.field.set_scene(plan).unwrap();
                    let actual = renderer.field.probe(FRAME, &pixels).unwrap();
                    let name = format!("{backend}, {bell}, {evaluator}, {:?}", plan.groups().next().unwrap().transform);
                    within(plan.predicted.total(), &name, &pixels, &exact, &actual);
                }
            });
        }
    }
}

/// Gaussians of as many sizes, all with one ratio of their axes.
fn mixed(count: usize, smallest: f64, largest: f64) -> Vec<Ghost> {
    let mut ghosts = alike(&Bell::Gaussian, count, 1.0);
    for (k, ghost) in ghosts.iter_mut().enumerate() {
        ghost.size *= smallest * (largest / smallest).powf(k as f64 / count as f64);
    }
    ghosts
}

#[test]
fn gaussians_of_mixed_sizes_are_gathered_as_those_of_a_few() {
    let pixels = scenes::every_pixel(FRAME);
    let points = scenes::positions(FRAME, &pixels);
    let ghosts = mixed(400, 0.3, 0.9);
    let exact = direct_at(&ghosts, &points);
    for evaluator in [Evaluator::Rows, Evaluator::Grid] {
        // On the device, and by the plan that looks at the modes.
        let looked = plan(&ghosts, FRAME, &Request { evaluator: Some(evaluator), ..Request::new(1e-3) }).unwrap();
        let plans = [planned(&ghosts, evaluator, true), planned(&ghosts, evaluator, false), looked];
        let several = |plan: &Plan| {
            plan.groups().any(|group| matches!(group.transform, Transform::Gather(gathering) if gathering.sizes > 3))
        };
        assert!(several(&plans[0]) && !several(&plans[1]), "{evaluator}");
        on_one_backend(|backend, renderer| {
            for plan in &plans {
                renderer.field.set_scene(plan).unwrap();
                let actual = renderer.field.probe(FRAME, &pixels).unwrap();
                within(plan.predicted.total(), &format!("{backend}, {evaluator}"), &pixels, &exact, &actual);
            }
        });
    }
}

#[test]
fn very_many_gaussians_of_mixed_sizes_are_gathered() {
    let ghosts = mixed(60_000, 0.11, 0.15);
    let pixels = scenes::probes(3, &ghosts, &plan(&ghosts, FRAME, &Request::new(1e-3)).unwrap(), FRAME);
    let exact = direct_at(&ghosts, &scenes::positions(FRAME, &pixels));
    for tolerance in [1e-3, 1e-4] {
        let request = Request { evaluator: Some(Evaluator::Grid), ..Request::new(tolerance) };
        let plan = plan(&ghosts, FRAME, &request).unwrap();
        assert!(gathers(&plan) && plan.predicted.gathering > 0.0, "{:?}", plan.predicted);
        on_one_backend(|backend, renderer| {
            renderer.field.set_scene(&plan).unwrap();
            let actual = renderer.field.probe(FRAME, &pixels).unwrap();
            within(plan.predicted.total(), &format!("{backend}, {tolerance}"), &pixels, &exact, &actual);
        });
    }
}

#[test]
fn a_gathered_spectrum_is_the_same_every_time() {
    let ghosts = alike(&Bell::Gaussian, 2000, 0.4);
    let plan = planned(&ghosts, Evaluator::Rows, true);
    let [first, second] = [(); 2].map(|()| on_backend(Backend::Egl, |r| bits(&glare(r, &plan, FRAME))));
    assert!(first == second);
}

#[test]
fn few_ghosts_are_dispatched_and_many_of_one_size_are_gathered() {
    let transform = |ghosts: &[Ghost]| gathers(&plan(ghosts, FRAME, &Request::new(1e-3)).unwrap());
    for evaluator in [Evaluator::Rows, Evaluator::Grid] {
        let of = |count| {
            let ghosts = alike(&Bell::Gaussian, count, 0.3);
            plan(&ghosts, FRAME, &Request { evaluator: Some(evaluator), ..Request::new(1e-2) }).unwrap()
        };
        assert!(!gathers(&of(300)), "{evaluator}: few");
        let many = of(60_000);
        assert!(gathers(&many), "{evaluator}: many");
        assert!((0.0..=0.005 * 1e-2).contains(&many.predicted.gathering), "{:?}", many.predicted);
    }
    // Sizes that differ along both axes have coefficients of their own.
    assert!(!transform(&scenes::sized(1, 60_000, FRAME, 0.3, 0.4)));
    assert!(transform(&mixed(60_000, 0.3, 0.4)));
}
