//! What every bell of the registry promises.

use std::f64::consts::{SQRT_2, TAU};

use glam::DVec2;

use super::*;

/// The product bells of the registry, each with its factor.
fn with_factors(check: impl Fn(&Bell, &dyn Factor)) {
    for bell in Bell::examples() {
        if let Modes::Product(factor) = bell.shape().modes() {
            check(&bell, factor);
        }
    }
}

/// The radial ones.
fn with_radials(check: impl Fn(&Bell, &dyn Radial)) {
    for bell in Bell::examples() {
        if let Modes::Radial(radial) = bell.shape().modes() {
            check(&bell, radial);
        }
    }
}

fn magnitude([a, b]: [f64; 2]) -> f64 {
    a.hypot(b)
}

/// A product bell with the period 1 where it has one, and where its factor is 1.
fn in_one_period(bell: &Bell) -> (Bell, f64) {
    match bell {
        Bell::VonMises(_) => (Bell::VonMises(VonMises { period: DVec2::ONE }), 0.0),
        Bell::SineGaussian(SineGaussian { mean, .. }) => {
            (Bell::SineGaussian(SineGaussian { period: DVec2::ONE, mean: *mean }), mean.asin() / TAU)
        }
        _ => (bell.clone(), 0.0),
    }
}

/// a_n + i b_n of the periodised factor by the trapezium rule: exact to the last bits for smooth bells, and to the step
/// squared for those with a kink.
fn by_quadrature(bell: &Bell, n: u32, size: f64) -> [f64; 2] {
    let (bell, brightest) = in_one_period(bell);
    let samples = 1 << 15;
    let copies = if bell.shape().period().is_some() { 0 } else { (12.0 * size).ceil() as i32 + 1 };
    let mut sum = [0.0; 2];
    for i in 0..samples {
        let x = f64::from(i) / f64::from(samples);
        let at = |j: i32| bell.shape().value(DVec2::new(x + f64::from(j), brightest), DVec2::splat(size));
        let value: f64 = (-copies..=copies).map(at).sum();
        let (sin, cos) = (TAU * (f64::from(n) * x).fract()).sin_cos();
        sum[0] += value * cos;
        sum[1] += value * sin;
    }
    sum.map(|sum| sum / f64::from(samples))
}

#[test]
fn no_value_is_beyond_one_and_no_bell_is_lopsided() {
    let size = DVec2::new(0.4, 0.7);
    for bell in Bell::examples() {
        let shape = bell.shape();
        let mut largest = 0.0f64;
        for i in -60..=60 {
            for j in -60..=60 {
                let offset = DVec2::new(0.02 * f64::from(i), 0.03 * f64::from(j));
                let value = shape.value(offset, size);
                assert!(value.abs() <= 1.0, "{bell} at {offset}: {value}");
                largest = largest.max(value.abs());
                // The prototype's periodic bell is symmetric about a quarter of its period instead.
                let mirrored = match &bell {
                    Bell::SineGaussian(SineGaussian { period, .. }) => 0.5 * *period - offset,
                    // And a polygon of five sides about its centre by a fifth of a turn.
                    Bell::Disc(disc) if !disc.is_round() => {
                        DVec2::from_angle(TAU / f64::from(disc.blades())).rotate(offset / size) * size
                    }
                    Bell::Iris(iris) => DVec2::from_angle(TAU / f64::from(iris.blades())).rotate(offset / size) * size,
                    _ => -offset,
                };
                assert!((shape.value(mirrored, size) - value).abs() < 1e-12, "{bell} at {offset}");
            }
        }
        assert!(largest > 0.99, "{bell}: {largest}");
        if !matches!(bell, Bell::SineGaussian(_)) {
            assert!((shape.value(DVec2::ZERO, size) - 1.0).abs() < 1e-14, "{bell}");
        }
    }
}

#[test]
fn coefficients_of_factors_are_their_integrals() {
    with_factors(|bell, factor| {
        let limit = match bell {
            Bell::Parabola => 1e-8,
            Bell::CosineSquared => 1e-11,
            _ => 1e-14,
        };
        for size in [0.02, 0.1, 0.4] {
            let all = factor.coefficients(40, size);
            for n in [0, 1, 2, 5, 9, 20, 40] {
                let (closed, quadrature) = (all[n as usize], by_quadrature(bell, n, size));
                let error = magnitude([closed[0] - quadrature[0], closed[1] - quadrature[1]]);
                assert!(error < limit, "{bell} {n} at {size}: {closed:?} {quadrature:?}");
            }
        }
    });
}

#[test]
fn the_removable_singularity_is_removed() {
    let Modes::Product(factor) = Bell::CosineSquared.shape().modes() else { panic!("a product") };
    // 2nh/T = 1 for n = 4, exactly and an ulp to either side.
    for size in [0.125f64, 0.125f64.next_up(), 0.125f64.next_down()] {
        let coefficient = factor.coefficients(4, size)[4][0];
        assert!((coefficient - 0.5 * size).abs() < 1e-16, "{coefficient}");
    }
}

#[test]
fn transforms_are_their_hankel_integrals() {
    with_radials(|bell, radial| {
        for z in [0.0, 1e-3, 0.4, 1.0, 5.0, 17.3, 60.0] {
            let samples = 200_000;
            let step = radial.end() / f64::from(samples);
            let integral: f64 = (0..samples)
                .map(|i| {
                    let r = (f64::from(i) + 0.5) * step;
                    TAU * r * bell.shape().value(DVec2::new(r, 0.0), DVec2::ONE) * libm::j0(z * r) * step
                })
                .sum();
            let error = (radial.transform(z) - integral).abs();
            assert!(error < 1e-9, "{bell} at {z}: {} for {integral}", radial.transform(z));
        }
    });
}

#[test]
fn tails_are_never_below_the_truth_and_not_far_above() {
    with_factors(|bell, factor| {
        for size in [0.01, 0.05, 0.2, 0.45] {
            let sizes = if bell.shape().tabulated() { vec![size] } else { vec![size, 1.2 * size, SQRT_2 * size] };
            let tails = factor.tails(60, size);
            for &held in &sizes {
                let all = factor.coefficients(6000, held);
                let mut truth: f64 = all[61..].iter().map(|&c| 2.0 * magnitude(c)).sum();
                for highest in (0..=60).rev() {
                    let bound = tails[highest];
                    assert!(
                        bound >= truth * (1.0 - 1e-12) - 1e-12,
                        "{bell} tail at {highest}, {size}, {held}: {bound} {truth}"
                    );
                    if held == size && truth > 1e-12 {
                        let loose = if matches!(bell, Bell::CosineSquared | Bell::Parabola) { 9.0 } else { 1.01 };
                        assert!(bound <= truth * loose, "{bell} tail {highest} at {size}: {bound} {truth}");
                    }
                    truth += if highest > 0 { 2.0 } else { 1.0 } * magnitude(all[highest]);
                }
                let total = factor.mean(size) + tails[0];
                assert!(total >= truth * (1.0 - 1e-12), "{bell} in all at {size}, {held}: {total} {truth}");
            }
        }
    });
}

#[test]
fn the_degree_that_a_factor_names_leaves_what_it_says() {
    with_factors(|bell, factor| {
        for size in [0.02, 0.1, 0.3] {
            for error in [0.1, 1e-2, 1e-3] {
                let degree = factor.degree(error, size).ceil() as u32;
                let left = factor.tails(degree, size)[degree as usize];
                assert!(left <= error, "{bell} at {size}: {left} of {error} beyond {degree}");
            }
        }
    });
}

#[test]
fn wraps_are_never_below_the_copies_and_nothing_is_beyond_what_the_axes_allow() {
    for bell in Bell::examples() {
        let shape = bell.shape();
        for size in [0.01, 0.05, 0.2, 0.7] {
            if shape.period().is_none() {
                for distance in [0.0, 0.3, 0.5, 0.8, 0.99] {
                    let others = (-40..=40).filter(|&j| j != 0);
                    let truth: f64 = others.map(|j| shape.along(distance - f64::from(j), size)).sum();
                    let bound = shape.wrap(1.0, distance, size);
                    assert!(bound >= truth * (1.0 - 1e-12), "{bell} wrap at {distance}, {size}: {bound} {truth}");
                }
            }
            for i in 0..30 {
                for j in 0..30 {
                    let offset = DVec2::new(0.07 * f64::from(i), 0.05 * f64::from(j)) * size;
                    let value = shape.value(offset, DVec2::splat(size)).abs();
                    let allowed = shape.along(0.9 * offset.x, size) * shape.along(0.9 * offset.y, size);
                    assert!(value <= allowed * (1.0 + 1e-12), "{bell} at {offset}: {value} {allowed}");
                }
            }
        }
    }
}

#[test]
fn no_bell_is_steeper_than_it_says() {
    for bell in Bell::examples() {
        let shape = bell.shape();
        for i in 0..400 {
            let (x, step) = (0.005 * f64::from(i), 1e-6);
            let at = |x: f64| shape.value(DVec2::new(x, 0.0), DVec2::ONE);
            let slope = ((at(x + step) - at(x)) / step).abs();
            let limit = shape.steepest(x);
            assert!(slope <= limit + 1e-4, "{bell} at {x}: {slope} {limit}");
        }
    }
}

#[test]
fn integrals_and_variances_are_those_of_the_values() {
    for bell in Bell::examples() {
        let shape = bell.shape();
        let size = DVec2::new(0.3, 0.2);
        let period = shape.period().unwrap_or(DVec2::new(4.0, 3.0));
        let (mut integral, mut moment) = (0.0, 0.0);
        let steps = 600;
        for i in 0..steps {
            for j in 0..steps {
                let offset = (DVec2::new(f64::from(i), f64::from(j)) / f64::from(steps) - 0.5) * period;
                let part = shape.value(offset, size) * period.element_product() / f64::from(steps * steps);
                integral += part;
                moment += part * (offset.x / size.x).powi(2);
            }
        }
        assert!((integral / shape.integral(size) - 1.0).abs() < 1e-3, "{bell}: {integral}");
        if shape.period().is_none() {
            assert!((moment / integral / shape.variance() - 1.0).abs() < 5e-3, "{bell}: {}", moment / integral);
        }
    }
}

/// How far the series of the kept modes is off from the periodised bell, at most, along an axis and a diagonal.
fn measured(bell: &Bell, counts: &[u32], size: DVec2) -> f64 {
    let table = bell.shape().modes().table(counts, size);
    let mut worst = 0.0f64;
    for direction in [DVec2::new(1.0, 0.0), DVec2::new(0.0, 1.0), DVec2::new(1.0, 1.0), DVec2::new(0.4, 1.0)] {
        for i in 0..=120 {
            let at = 0.5 * f64::from(i) / 120.0 * direction;
            let mut sum = 0.0;
            let mut coefficients = table.iter();
            for (n, &count) in (0..).zip(counts) {
                let x = (TAU * f64::from(n) * at.x).cos();
                for (m, coefficient) in (0..count).zip(coefficients.by_ref()) {
                    sum += coefficient[0] * x * (TAU * f64::from(m) * at.y).cos();
                }
            }
            let copies = (-1..=1).flat_map(|j| (-1..=1).map(move |k| DVec2::new(f64::from(j), f64::from(k))));
            let value: f64 = copies.map(|copy| bell.shape().value(at - copy, size)).sum();
            worst = worst.max((sum - value).abs());
        }
    }
    worst
}

#[test]
fn radial_series_are_never_further_off_than_their_bound() {
    with_radials(|bell, radial| {
        let (mut tightest, mut loosest) = (0.0f64, 1.0f64);
        for size in [DVec2::splat(0.4), DVec2::splat(0.15), DVec2::new(0.1, 0.2), DVec2::splat(0.05)] {
            for highest in [3, 8, 20, 50] {
                // The whole rectangle, and the ellipse in it.
                let turn = TAU * size;
                let z = (turn * (f64::from(highest) + 1.0)).min_element();
                let row = |n: u32| {
                    let across = (z / turn.x).powi(2) - f64::from(n * n);
                    (turn.x / turn.y * across.max(0.0).sqrt()).ceil().max(1.0) as u32
                };
                let rectangle = vec![highest + 1; highest as usize + 1];
                let ellipse: Vec<u32> = (0..(z / turn.x).ceil() as u32).map(row).collect();
                let bound = radial.beyond(z, 0.5 * turn.length());
                for counts in [rectangle, ellipse] {
                    let error = measured(bell, &counts, size);
                    assert!(error <= bound, "{bell} of {size}, degree {highest}: {error} beyond {bound}");
                    tightest = tightest.max(error / bound);
                    loosest = loosest.min(error / bound);
                }
            }
        }
        println!("{bell}: the error is {loosest:.2} to {tightest:.2} of its bound");
        assert!(tightest > 0.2, "{bell}: a bound that is never near is none: {tightest}");
    });
}

#[test]
fn the_shader_with_every_bell_counts_them_as_the_registry_does() {
    let any = include_str!("../../shaders/bells/any.glsl");
    let mut from = 0;
    assert_eq!(Bell::examples().len(), Bell::KINDS as usize);
    assert_eq!(any.matches("(RUN) RUN(").count(), Bell::KINDS as usize);
    for (kind, bell) in (0..).zip(Bell::examples()) {
        assert_eq!(bell.kind(), kind);
        let include = format!("#include \"{}\"", bell.shape().shader());
        from += any[from..].find(&include).unwrap_or_else(|| panic!("{include} in its place"));
        // A file for each, and some bells have two.
        let name = bell.shape().shader().trim_start_matches("bells/").trim_end_matches(".glsl");
        let loops = format!("#ifdef HAS_{kind}\n#define RUN_{kind}(RUN) RUN({kind}, {name})\n");
        assert!(any.contains(&loops) && any.contains(&format!(" RUN_{kind}(RUN)")), "{name} is {kind}");
    }
}

#[test]
fn phases_wrap() {
    assert_eq!(phase(0.0, 3.0), 0);
    assert_eq!(phase(0.75, 3.0), 1 << 30);
    assert_eq!(phase(-0.75, 3.0), 3 << 30);
    assert_eq!(phase(3.0 * 1e6, 3.0), 0);
    assert_eq!(phase(-1e-30, 3.0), 0);
}

#[test]
fn kappa_is_two_where_exactly_one_index_is_zero() {
    assert_eq!([kappa(0, 0), kappa(0, 3), kappa(7, 0), kappa(2, 2)], [1.0, 2.0, 2.0, 4.0]);
}
