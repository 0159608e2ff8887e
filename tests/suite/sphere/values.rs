//! The basis, quadrature and convolution against fifty digits and closed forms.

use std::f64::consts::PI;

use glam::DVec3;
use vglare::series::sphere::{
    Basis, Coefficients, Phase, fejer, gauss_legendre, index, irradiance_of_nine, lambert, legendre_as_printed,
    norm_squared_as_printed, project, zonal,
};

use super::{directions, random};
use crate::golden::{cases, count, number};
use crate::support::check::Worst;

#[test]
fn harmonics_are_the_golden_ones() {
    let cases = cases(include_str!("../../golden/sh_values.json"));
    assert_eq!(cases.len(), 162);
    let highest = cases.iter().map(|case| count(&case["l"])).max().unwrap() as usize;
    let basis = Basis::new(highest);
    let mut worst = Worst::default();
    for theta_phi in [["0", "0"], ["1e-5", "0.7"], ["0.5", "0.3"], ["1.5707963267948966", "-2"], ["2.5", "3"]]
        .into_iter()
        .chain([["3.141592653589793", "1"]])
    {
        let [theta, phi]: [f64; 2] = theta_phi.map(|text| text.parse().unwrap());
        let direction = DVec3::new(theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos());
        let values = basis.at(direction);
        for case in cases.iter().filter(|case| [&case["theta"], &case["phi"]] == theta_phi) {
            let (l, m) = (count(&case["l"]) as usize, case["m"].as_i64().unwrap() as isize);
            let (got, expected) = (values[index(l, m)], number(&case["Y"]));
            // The direction itself is rounded, and Y_lm has l waves around: some l roundings, and a few more.
            let limit = 2e-15 * (1 + l) as f64;
            let error = (got - expected).abs();
            assert!(error <= limit, "l {l}, m {m} at {theta_phi:?}: {got:e} for {expected:e}");
            worst.take(error / limit, || format!("l {l}, m {m} at {theta_phi:?}"));
        }
    }
    println!("worst share of the limit {worst}");
}

#[test]
fn lambert_is_the_golden_one() {
    for case in cases(include_str!("../../golden/irradiance_A_l.json")) {
        let (l, expected) = (count(&case["l"]) as usize, number(&case["A_l"]));
        assert!((lambert(l) - expected).abs() <= 1e-15 * expected.abs(), "A_{l}: {} for {expected}", lambert(l));
    }
}

#[test]
fn zonal_kernels_have_the_golden_eigenvalues() {
    let mut worst = Worst::default();
    for case in cases(include_str!("../../golden/vmf_eigen.json")) {
        let (kappa, l) = (number(&case["kappa"]), count(&case["l"]) as usize);
        let expected = number(&case["lam"]);
        let got = zonal(l, 200, |t| (kappa * (t - 1.0)).exp())[l];
        let error = (got - expected).abs() / number(&cases(include_str!("../../golden/vmf_eigen.json"))[0]["lam"]);
        assert!(error <= 1e-14, "kappa {kappa}, l {l}: {got:e} for {expected:e}");
        worst.take(error, || format!("kappa {kappa}, l {l}"));
    }
    // The clamped cosine has a kink, which the nodes meet as a corner: convergence like 1/n².
    for (l, got) in zonal(8, 4000, |t| t.max(0.0)).into_iter().enumerate() {
        assert!((got - lambert(l)).abs() < 1e-6, "A_{l}: {got}");
    }
    println!("worst error {worst}");
}

#[test]
fn a_convolved_function_is_the_integral_against_the_kernel() {
    let (function, kernel) = (random(6, 3), |t: f64| (3.0 * (t - 1.0)).exp());
    let blurred = function.convolved(&zonal(6, 40, kernel));
    for normal in directions(5, 9) {
        // ∫ f(v) h(n · v) dv is √4π times c_00 of the product.
        let product = project(0, 40, |v| function.at(v).map(|value| value * kernel(normal.dot(v))));
        for (got, expected) in blurred.at(normal).into_iter().zip(product.values()[0]) {
            assert!((got - expected * (4.0 * PI).sqrt()).abs() < 1e-12, "{got} at {normal}");
        }
    }
}

#[test]
fn the_addition_theorem_holds_up_to_the_highest_degree() {
    // Σ_m Y_lm(a) Y_lm(b) = (2l+1)/4π P_l(a · b), and P_l is √(4π/(2l+1)) Y_l0 along z.
    for (degree, limit) in [(10, 1e-14), (100, 5e-13), (1000, 3e-11), (1500, 5e-11)] {
        let basis = Basis::new(degree);
        let mut worst = Worst::default();
        let points = directions(if degree > 100 { 4 } else { 100 }, 5);
        for (a, b) in points.iter().zip(points.iter().cycle().skip(3)) {
            let (at_a, at_b) = (basis.at(*a), basis.at(*b));
            assert!(at_a.iter().all(|value| value.is_finite()), "degree {degree} at {a}");
            let along = DVec3::new((*a).cross(*b).length(), 0.0, a.dot(*b));
            let between = basis.at(along);
            for l in 0..=degree {
                let band = l * l..(l + 1) * (l + 1);
                let scale = (2 * l + 1) as f64 / (4.0 * PI);
                let sum = |x: &[f64], y: &[f64]| x.iter().zip(y).map(|(x, y)| x * y).sum::<f64>();
                let norm = (sum(&at_a[band.clone()], &at_a[band.clone()]) / scale - 1.0).abs();
                let product = sum(&at_a[band.clone()], &at_b[band]) / scale;
                let error = (product - between[index(l, 0)] / scale.sqrt()).abs().max(norm);
                assert!(error <= limit, "l {l} of {degree} at {a}: {error:e}");
                worst.take(error, || format!("l {l} at {a}"));
            }
        }
        println!("degree {degree}: worst error {worst}");
    }
}

/// Every θ, not only some: P̄_mm underflows where P̄_lm may not.
#[test]
fn degree_1500_is_normalised_all_the_way_to_the_poles() {
    let basis = Basis::new(1500);
    for k in 0..=90 {
        let (sin, cos) = (PI / 180.0 * f64::from(k)).sin_cos();
        let mut sums = vec![0.0; 1501];
        basis.legendre(cos, sin, |l, m, value| sums[l] += if m > 0 { 2.0 } else { 1.0 } * value * value);
        for (l, sum) in sums.iter().enumerate() {
            let error = (sum * 4.0 * PI / (2 * l + 1) as f64 - 1.0).abs();
            assert!(error < 1e-10, "l {l} at {k} degrees: {error:e}");
        }
    }
}

#[test]
fn projection_gives_back_what_was_made_of_harmonics() {
    for (degree, nodes) in [(0, 1), (3, 4), (6, 24), (20, 21), (60, 64)] {
        let coefficients = random(degree, degree as u64);
        let error = project(degree, nodes, |v| coefficients.at(v)).difference(&coefficients);
        assert!(error < 2e-14, "degree {degree}: {error:e}");
    }
    // A rule that is one node short of the function's own degree does not.
    let coefficients = random(6, 1);
    assert!(project(3, 4, |v| coefficients.at(v)).difference(&coefficients.truncated(3)) > 1e-3);
}

#[test]
fn rules_are_exact_for_polynomials() {
    for n in [1, 2, 3, 7, 24, 200, 2000] {
        let rule = gauss_legendre(n);
        assert!(rule.is_sorted_by(|a, b| a.0 < b.0), "{n} nodes rise");
        for power in [0, n.min(60) / 2 * 2, (2 * n - 2).min(400)] {
            let exact = 2.0 / (power + 1) as f64;
            let got: f64 = rule.iter().map(|(x, weight)| weight * x.powi(power as i32)).sum();
            assert!((got / exact - 1.0).abs() < 1e-12, "{n} nodes, x^{power}: {got} for {exact}");
        }
        let weights = fejer(n);
        for power in (0..n.min(50)).step_by(2) {
            let x = |j: usize| (PI * (j as f64 + 0.5) / n as f64).cos();
            let got: f64 = weights.iter().enumerate().map(|(j, weight)| weight * x(j).powi(power as i32)).sum();
            assert!((got - 2.0 / (power + 1) as f64).abs() < 1e-12, "Fejér, {n} nodes, x^{power}: {got}");
        }
    }
}

#[test]
fn the_sign_of_condon_and_shortley_is_minus_one_for_odd_m() {
    let plain = random(3, 8);
    let signed = plain.clone().in_phase(Phase::CondonShortley);
    for (l, m, sign) in [(0, 0, 1.0), (1, -1, -1.0), (1, 0, 1.0), (1, 1, -1.0), (2, 2, 1.0), (3, -3, -1.0)] {
        let at = index(l, m);
        assert_eq!(signed.values()[at], plain.values()[at].map(|c| sign * c), "l {l}, m {m}");
    }
    assert_eq!(signed.in_phase(Phase::CondonShortley), plain);
    assert_eq!(plain.clone().in_phase(Phase::Plain), plain);
}

#[test]
fn a_lit_half_space_irradiates_by_the_cosine() {
    // Radiance 1 above the horizon: E = π (1 + cos θ) / 2, in which no band above 1 takes part.
    let sky = project(8, 2000, |v| if v.z > 0.0 { [1.0, 2.0, 0.0] } else { [0.0; 3] });
    let irradiance = sky.irradiance();
    for normal in directions(20, 4) {
        let expected = PI * (1.0 + normal.z) / 2.0;
        let [r, g, b] = irradiance.at(normal);
        // An even number of nodes leaves ∫ over a half exact in even bands and to 1/n² in odd ones.
        assert!((r - expected).abs() < 1e-6 && (g - 2.0 * expected).abs() < 1e-6, "{r} at {normal}");
        assert!(b.abs() < 1e-15, "{b}");
    }
}

#[test]
fn nine_coefficients_as_a_polynomial_are_nine_coefficients_as_harmonics() {
    let light = random(5, 12);
    let irradiance = light.truncated(2).irradiance();
    for normal in directions(50, 6) {
        for (got, expected) in irradiance_of_nine(&light, normal).into_iter().zip(irradiance.at(normal)) {
            assert!((got - expected).abs() < 1e-14, "{got} for {expected} at {normal}");
        }
    }
    // One point of light of irradiance 1: max(0, t) is missed by 3/32 at most, sideways.
    let harmonics = Basis::new(2).at(DVec3::Z);
    let point = Coefficients::new(2, harmonics.into_iter().map(|y| [y; 3]).collect());
    let error = |t: f64| irradiance_of_nine(&point, DVec3::new((1.0 - t * t).sqrt(), 0.0, t))[0] - t.max(0.0);
    let worst = (-100..=100).map(|k| error(f64::from(k) / 100.0).abs()).fold(0.0, f64::max);
    assert!((error(0.0) - 3.0 / 32.0).abs() < 1e-15 && worst <= error(0.0), "{worst}");
    // The rounded constants of the paper.
    let mut one = Coefficients::zero(2);
    one.values_mut()[index(2, 2)] = [1.0; 3];
    assert!((irradiance_of_nine(&one, DVec3::X)[0] - 0.429_043).abs() < 5e-7);
    let mut one = Coefficients::zero(2);
    one.values_mut()[index(1, 0)] = [1.0; 3];
    assert!((irradiance_of_nine(&one, DVec3::Z)[0] - 2.0 * 0.511_664).abs() < 2e-6);
}

#[test]
fn the_printed_formula_agrees_while_it_lasts_and_breaks_where_factorials_do() {
    let (sin, cos) = 1f64.sin_cos();
    let basis = Basis::new(20);
    basis.legendre(cos, sin, |l, m, value| {
        let (l, m) = (l as u16, m as u16);
        let printed = legendre_as_printed(l, m, cos, sin) * norm_squared_as_printed(l, m, PI).sqrt();
        assert!((printed - value).abs() < 1e-13, "l {l}, m {m}: {printed} for {value}");
    });
    // (2m−1)!! for m = 150 and 151, and for 28 and 29.
    assert!(legendre_as_printed(150, 150, 0.0, 1.0f64).is_finite());
    assert_eq!(legendre_as_printed(151, 151, 0.0, 1.0f64), f64::INFINITY);
    assert!(legendre_as_printed(28, 28, 0.0, 1.0f32).is_finite());
    assert_eq!(legendre_as_printed(29, 29, 0.0, 1.0f32), f32::INFINITY);
    // (l+m)! breaks sooner: from l = m = 86 and 18 on nothing is left of a harmonic that is about 1.
    let pi = std::f32::consts::PI;
    assert!(norm_squared_as_printed(85, 85, PI) > 0.0 && norm_squared_as_printed(17, 17, pi) > 0.0);
    assert_eq!((norm_squared_as_printed(86, 86, PI), norm_squared_as_printed(18, 18, pi)), (0.0, 0.0));
    assert!(Basis::new(86).at(DVec3::X)[index(86, 86)] > 0.5);
}
