//! Every bell: its coefficients and whole fields against numbers of fifty digits, its evaluators against the direct sum.

use std::f64::consts::TAU;

use glam::DVec2;
use vglare::frame::Frame;
use vglare::plan::{Evaluator, Request};
use vglare::reference;
use vglare::scene::Ghost;
use vglare::series::{Bell, Modes, SineGaussian, VonMises, windowed_gaussian};

use crate::golden::{cases, coefficient, count, number};
use crate::support::check::{Worst, within};
use crate::support::{on_one_backend, plan, scenes};

#[test]
fn windowed_gaussian_coefficients_are_the_golden_ones() {
    let (mut worst, mut seen) = (Worst::default(), 0);
    for case in cases(include_str!("../golden/gaussian_coeff.json")) {
        let Some(half) = case.get("half_range_exact") else { continue };
        let (sigma, period, n) = (number(&case["sigma"]), number(&case["T"]), count(&case["n"]));
        // The golden integral is over half the period.
        let error = (windowed_gaussian(n, sigma / period) - 2.0 * number(half) / period).abs();
        let limit = 4e-15 * sigma / period * (1.0 + f64::from(n) * sigma / period);
        assert!(error <= limit, "sigma {sigma}, T {period}, n {n}: {error:e} of {limit:e}");
        worst.take(error / limit, || format!("sigma {sigma}, T {period}, n {n}"));
        seen += 1;
    }
    assert!(seen > 20, "{seen}");
    println!("worst share of the limit {worst}");
}

#[test]
fn cosine_squared_coefficients_are_the_golden_ones() {
    let mut worst = Worst::default();
    for case in cases(include_str!("../golden/hann.json")) {
        let (half, period, n) = (number(&case["h"]), number(&case["T"]), count(&case["n"]));
        let error = (coefficient(&Bell::CosineSquared, n, half / period) - number(&case["alpha"])).abs();
        // 2nh/T is off by two roundings, and near its zeros the transform is as steep as a sine.
        let limit = 1e-15 * half / period;
        assert!(error <= limit, "h {half}, T {period}, n {n}: {error:e}");
        worst.take(error / limit, || format!("h {half}, T {period}, n {n}"));
    }
    println!("worst share of the limit {worst}");
}

#[test]
fn parabola_coefficients_are_the_golden_ones() {
    let mut worst = Worst::default();
    for case in cases(include_str!("../golden/parabola1d.json")) {
        let [a, b, period] = ["A", "B", "T"].map(|key| number(&case[key]));
        let n = count(&case["n"]);
        // The bell of this crate has the peak 1 and the half width h; A² and A/B are the general parabola's.
        let got = a * a * coefficient(&Bell::Parabola, n, a / b / period);
        let limit = 1e-15 * (4.0 / 3.0 * a * a * a / b / period);
        let error = (got - number(&case["alpha"])).abs();
        assert!(error <= limit, "{}: {error:e} of {limit:e}", case["id"]);
        worst.take(error / limit, || case["id"].to_string());
    }
    println!("worst share of the limit {worst}");
}

#[test]
fn paraboloid_coefficients_are_the_golden_ones() {
    let mut worst = Worst::default();
    for case in cases(include_str!("../golden/radial_paraboloid.json")) {
        let [a, b, t1, t2] = ["A", "B", "T1", "T2"].map(|key| number(&case[key]));
        let [n, m] = ["n", "m"].map(|key| count(&case[key]));
        let mut counts = vec![1; n as usize + 1];
        counts.fill(m + 1);
        let size = DVec2::splat((a / b).sqrt()) / DVec2::new(t1, t2);
        let got = a * Bell::Paraboloid.shape().modes().table(&counts, size).last().unwrap()[0];
        let limit = 1e-14 * a * std::f64::consts::FRAC_PI_2 * size.element_product();
        let error = (got - number(&case["E"])).abs();
        assert!(error <= limit, "{case}: {error:e} of {limit:e}");
        worst.take(error / limit, || case.to_string());
    }
    println!("worst share of the limit {worst}");
}

#[test]
fn von_mises_coefficients_are_the_golden_ones() {
    let bell = Bell::VonMises(VonMises { period: DVec2::ONE });
    let mut worst = Worst::default();
    for case in cases(include_str!("../golden/von_mises.json")) {
        let (kappa, n) = (number(&case["kappa"]), count(&case["n"]));
        // κ = 1/(ωσ)²
        let got = coefficient(&bell, n, 1.0 / (TAU * kappa.sqrt()));
        let error = (got - number(&case["alpha"])).abs();
        assert!(error <= 2e-15, "kappa {kappa}, n {n}: {error:e}");
        worst.take(error, || format!("kappa {kappa}, n {n}"));
    }
    println!("worst error {worst}");
}

#[test]
fn sine_gaussian_coefficients_are_the_golden_ones() {
    let mut worst = Worst::default();
    for case in cases(include_str!("../golden/sin_gaussian.json")) {
        let (mean, sigma, n) = (number(&case["mu"]), number(&case["sigma"]), count(&case["n"]));
        let bell = Bell::SineGaussian(SineGaussian { period: DVec2::splat(TAU), mean });
        let Modes::Product(factor) = bell.shape().modes() else { panic!("a product") };
        let [a, b] = factor.coefficients(n, sigma / TAU)[n as usize];
        let tau = if n == 0 { 1.0 } else { 2.0 };
        let error = (tau * a - number(&case["a_n"])).abs().max((tau * b - number(&case["b_n"])).abs());
        assert!(error <= 1e-15, "mu {mean}, sigma {sigma}, n {n}: {error:e}");
        worst.take(error, || format!("mu {mean}, sigma {sigma}, n {n}"));
    }
    println!("worst error {worst}");
}

/// Direct sum, series, and the bounds between them and the periodised field.
fn whole_fields(bell: &Bell, file: &str) {
    let shape = bell.shape();
    let mut worst = [Worst::default(), Worst::default()];
    let mut wrapped_share = Worst::default();
    for case in cases(file) {
        let period = DVec2::new(number(&case["T1"]), number(&case["T2"]));
        let (degree_x, degree_y) = (count(&case["N"]), count(&case["M"]));
        let counts = vec![degree_y + 1; degree_x as usize + 1];
        let ghosts: Vec<Ghost> = (case["ghosts"].as_array().unwrap().iter())
            .map(|ghost| {
                let center = [number(&ghost["x"]), number(&ghost["y"])];
                let radiance = [number(&ghost["w"]), 0.0, 2.0 * number(&ghost["w"])];
                Ghost { bell: bell.clone(), ..scenes::one(center, number(&ghost["s"]), radiance) }
            })
            .collect();
        let weights: f64 = ghosts.iter().map(|ghost| ghost.radiance[0]).sum();
        let name = format!("{bell}, K = {}", ghosts.len());
        for point in case["points"].as_array().unwrap() {
            let at = DVec2::new(number(&point["x"]), number(&point["y"]));
            let [direct, periodised, series] = ["direct", "periodised", "series"].map(|key| number(&point[key]));
            let ours = [reference::direct(&ghosts, at), reference::series(&ghosts, period, &counts, at)];
            for (which, (got, expected)) in ours.into_iter().zip([direct, series]).enumerate() {
                let error = (got[0] - expected).abs();
                // Some hundred terms of some roundings each.
                assert!(error <= 1e-13 * weights, "{name} at {at}: {} for {expected}", got[0]);
                assert_eq!([got[1], got[2]], [0.0, 2.0 * got[0]], "each colour on its own");
                worst[which].take(error / weights.max(1.0), || name.clone());
            }
            let wrapped: f64 = (ghosts.iter())
                .map(|ghost| {
                    let distance = (at - ghost.center).abs();
                    let wrap_x = shape.wrap(period.x, distance.x, ghost.size.x);
                    let wrap_y = shape.wrap(period.y, distance.y, ghost.size.y);
                    let own_x = shape.along(distance.x, ghost.size.x);
                    let own_y = shape.along(distance.y, ghost.size.y);
                    ghost.radiance[0] * (wrap_x * own_y + wrap_y * own_x + wrap_x * wrap_y)
                })
                .sum();
            let error = (periodised - direct).abs();
            assert!(error <= wrapped + 1e-15 * weights, "{name} at {at}: {error:e} beyond {wrapped:e}");
            if wrapped > 1e-14 {
                wrapped_share.take(error / wrapped, || name.clone());
            }
        }
    }
    println!("{bell}: direct, series: worst error for each unit of weight {} , {}", worst[0], worst[1]);
    println!("{bell}: periodisation: worst share of the bound {wrapped_share}");
}

#[test]
fn whole_fields_are_the_golden_ones() {
    whole_fields(&Bell::Gaussian, include_str!("../golden/field_gaussian.json"));
    whole_fields(&Bell::CosineSquared, include_str!("../golden/field_hann.json"));
    whole_fields(&Bell::Parabola, include_str!("../golden/field_parabola_product.json"));
    whole_fields(&Bell::Paraboloid, include_str!("../golden/field_radial_paraboloid.json"));
}

/// A few ghosts of one bell, or of each in turn; some beyond the picture's edge.
fn ghosts(bells: &[Bell]) -> Vec<Ghost> {
    let places = [
        [0.1, 0.2],
        [-0.9, -0.4],
        [1.5, 0.7],
        [0.6, -0.95],
        [-1.4, 0.5],
        [0.0, 0.0],
        [0.95, 0.1],
        [-0.5, 0.6],
        [0.4, -0.3],
    ];
    let ghost = |(k, bell): (usize, &Bell)| Ghost {
        bell: bell.clone(),
        center: places[k].into(),
        size: DVec2::new(0.25 + 0.03 * k as f64, 0.4 - 0.02 * k as f64),
        radiance: [1.0, 0.5 + 0.1 * k as f64, 2.0 - 0.2 * k as f64],
    };
    bells.iter().cycle().take(places.len()).enumerate().map(ghost).collect()
}

/// Every evaluator at a tolerance that the bell's series can be had for; what is measured stays within the prediction.
fn keeps_its_promise(name: &str, ghosts: &[Ghost], tolerances: &[f64]) {
    let frame = Frame::full(181, 97);
    let mut cases = Vec::new();
    let has_series = |ghost: &Ghost| !matches!(ghost.bell.shape().modes(), Modes::None);
    for evaluator in Evaluator::ALL {
        for &tolerance in tolerances {
            // Where some have no series, that of the others.
            let of_series: Vec<Ghost> = ghosts.iter().filter(|ghost| has_series(ghost)).cloned().collect();
            let ghosts = if evaluator.is_series() { &of_series } else { ghosts };
            if ghosts.is_empty() {
                continue;
            }
            let request = Request { evaluator: Some(evaluator), ..Request::new(tolerance) };
            let plan = plan(ghosts, frame, &request).unwrap_or_else(|error| panic!("{name}, {evaluator}: {error}"));
            assert!(plan.predicted.total() <= tolerance, "{name}: {:?}", plan.predicted);
            let pixels = scenes::probes(11, ghosts, &plan, frame);
            let exact = reference::direct_at(ghosts, &scenes::positions(frame, &pixels));
            cases.push((evaluator, plan, pixels, exact));
        }
    }
    let measured = on_one_backend(|backend, renderer| -> Vec<f64> {
        let one = |(evaluator, plan, pixels, exact): &(Evaluator, _, Vec<_>, Vec<_>)| {
            renderer.field.set_scene(plan).unwrap();
            let actual = renderer.field.probe(frame, pixels).unwrap();
            let case = format!("{backend}, {evaluator}, {name}, degree {:?}, {:?}", plan.degree(), plan.predicted);
            within(plan.predicted.total(), &case, pixels, exact, &actual).relative
        };
        cases.iter().map(one).collect()
    });
    for ((evaluator, plan, ..), error) in cases.iter().zip(&measured) {
        println!(
            "{name}, {evaluator}, degree {:?}: predicted {:.1e}, measured {error:.1e}",
            plan.degree(),
            plan.predicted.total()
        );
    }
}

#[test]
fn every_bell_on_every_evaluator_stays_within_its_prediction() {
    for bell in Bell::examples() {
        // Bells with a kink need a degree like 1 / tolerance.
        let tolerances: &[f64] = match bell {
            Bell::Gaussian | Bell::VonMises(_) | Bell::SineGaussian(_) => &[1e-2, 1e-4],
            Bell::CosineSquared | Bell::Iris(_) => &[3e-2, 3e-3],
            Bell::Parabola => &[0.45],
            Bell::Paraboloid | Bell::Profile(_) | Bell::Disc(_) => &[0.2, 0.1],
        };
        keeps_its_promise(&bell.to_string(), &ghosts(std::slice::from_ref(&bell)), tolerances);
    }
}

#[test]
fn bells_may_be_mixed() {
    keeps_its_promise("all bells", &ghosts(&Bell::examples()), &[0.3]);
}
