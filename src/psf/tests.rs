//! Against golden files of 50 digits, published energies, and closed forms.

use std::f64::consts::TAU;

use super::eye::{self, Moffat};
use super::*;

#[path = "fit/tests.rs"]
mod fit_tests;

/// A golden file's cases.
fn golden(name: &str) -> Vec<serde_json::Value> {
    let path = format!("{}/tests/golden/{name}.json", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(&path).unwrap();
    let file: serde_json::Value = serde_json::from_str(&text).unwrap();
    let cases = file["cases"].as_array().unwrap().clone();
    assert!(!cases.is_empty());
    cases
}

/// A number of a case, which is written as text.
fn number(case: &serde_json::Value, key: &str) -> f64 {
    case[key].as_str().unwrap_or_else(|| panic!("{key} of {case}")).parse().unwrap()
}

fn observer(age: f64, pigment: f64) -> Observer {
    Observer::new(age, pigment).unwrap()
}

fn close(x: f64, known: f64, tolerance: f64, what: &str) {
    assert!((x / known - 1.0).abs() <= tolerance, "{what}: {x} for {known}, off by {:.1e}", (x / known - 1.0).abs());
}

#[test]
fn cie_functions_are_the_golden_ones() {
    for case in golden("cie_glare") {
        let angle = number(&case, "theta_deg");
        let observer = observer(number(&case, "age"), number(&case, "p"));
        close(Psf::cie(observer).value(angle), number(&case, "cie146"), 1e-14, "cie");
        let total = Psf::cie135(observer).value(angle);
        close(total, number(&case, "cie135_norm"), 1e-14, "cie135");
        close(total * eye::cie135_normaliser(observer), number(&case, "cie135_raw"), 1e-14, "cie135 as it is");
    }
}

#[test]
fn spencers_functions_are_the_golden_ones_without_the_ring() {
    for case in golden("spencer") {
        let angle = number(&case, "theta_deg");
        let ring = number(&case, "f3");
        for (luminance, key, share) in [
            (Luminance::Photopic, "photopic", 0.0),
            (Luminance::Mesopic, "mesopic", 0.016),
            (Luminance::Scotopic, "scotopic", 0.033),
        ] {
            let known = number(&case, key);
            let off = Psf::spencer(luminance).value(angle) + share * ring - known;
            assert!(off.abs() <= 4e-15 * known, "{key} at {angle}: off by {off:e} of {known}");
        }
    }
}

/// The transforms by lobes and Euler's summation, and those in closed form, of all kinds that there are.
#[test]
fn transforms_are_the_golden_ones() {
    let mut counted = 0;
    for case in golden("hankel") {
        let (kind, q) = (case["kind"].as_str().unwrap(), number(&case, "k"));
        if q == 0.0 {
            continue;
        }
        let known = number(&case, "F");
        let (scale, value): (f64, Box<dyn Fn(f64) -> f64>) = match kind {
            "gaussian" => {
                let sigma = number(&case, "sigma");
                let closed = Psf::gaussian(sigma).unwrap().transform(q / TAU) * TAU * sigma * sigma;
                close(closed.max(1e-300), known.max(1e-300), 1e-9, "a Gaussian in closed form");
                (sigma, Box::new(move |r| (-0.5 * (r / sigma) * (r / sigma)).exp()))
            }
            "moffat" => {
                let moffat = Moffat { factor: 1.0, core: number(&case, "a"), exponent: number(&case, "beta") };
                if [0.5, 1.0, 1.5].contains(&moffat.exponent) {
                    close(moffat.transform(q), known, 1e-13, "a Moffat in closed form");
                }
                (moffat.core, Box::new(move |r| moffat.value(r)))
            }
            "shifted_inverse_square" | "shifted_inverse_cube" => {
                let (a, power) = (number(&case, "a"), if kind.ends_with("cube") { -3 } else { -2 });
                (a, Box::new(move |r| (r + a).powi(power)))
            }
            other => panic!("{other} is not known"),
        };
        let found = hankel::transform(&value, 0.3 * scale, 3.0 * scale, q);
        // Relative to the whole where the transform has all but vanished.
        let all = TAU * scale * scale;
        assert!((found - known).abs() <= 1e-9 * known + 1e-10 * all, "{case}: {found} for {known}");
        counted += 1;
    }
    assert!(counted > 40, "{counted}");
}

/// The energies that CIE 146 has, and the shares of CIE 135's beyond an angle, by trapezoids on 400 000 angles.
#[test]
fn energies_are_the_published_ones() {
    for (age, known) in [(25.0, 0.375), (75.0, 0.532)] {
        let energy = Psf::cie(observer(age, 0.5)).energy();
        assert!((energy - known).abs() < 6e-4, "{age}: {energy}");
    }
    let angles = [0.0278, 0.1, 0.3, 1.0, 3.0, 10.0, 30.0];
    let shares = [
        (25.0, [0.6145, 0.3195, 0.1505, 0.0771, 0.0499, 0.0336, 0.0211]),
        (75.0, [0.6686, 0.4051, 0.2381, 0.1518, 0.1097, 0.0754, 0.0448]),
    ];
    for (age, shares) in shares {
        let psf = Psf::cie135(observer(age, 0.5));
        for (angle, share) in angles.into_iter().zip(shares) {
            let beyond = 1.0 - psf.energy_within(angle) / psf.energy();
            assert!((beyond - share).abs() < 7e-5, "age {age}, {angle}: {beyond} for {share}");
        }
    }
    let totals = [
        (0.0, 0.0, 1.006),
        (25.0, 0.0, 1.006),
        (25.0, 0.5, 1.013),
        (70.0, 0.0, 1.013),
        (70.0, 1.2, 1.033),
        (80.0, 1.2, 1.040),
    ];
    for (age, pigment, known) in totals {
        let energy = Psf::cie135(observer(age, pigment)).energy();
        assert!((energy - known).abs() < 6e-4, "{age}, {pigment}: {energy}");
    }
    for (luminance, known) in [(Luminance::Photopic, 1.0), (Luminance::Mesopic, 0.984), (Luminance::Scotopic, 0.967)] {
        let energy = Psf::spencer(luminance).energy();
        assert!((energy - known).abs() < 1e-3, "{luminance:?}: {energy}");
    }
}

/// Energies whose integrals are known: the plane's by quadrature, the sphere's of powers.
#[test]
fn energies_are_those_of_closed_forms() {
    // 2π ∫ 10/θ² sin θ dθ over 1..100° and a cap of 1°, by ∫ sin θ/θ² dθ = ln θ − θ²/12 + θ⁴/480 − …, θ in radians.
    let psf = Psf::stiles_holladay(0.0).unwrap();
    let [one, end] = [1.0, 100.0].map(f64::to_radians);
    let series = |x: f64| {
        let square = x * x;
        let (mut term, mut sum) = (1.0, x.ln());
        for k in 1..12 {
            // (−1)^k x^2k / ((2k + 1)! 2k).
            let k = 2.0 * f64::from(k);
            term *= -square / (k * (k + 1.0));
            sum += term / k;
        }
        sum
    };
    // Ten per squared degree, of a square degree in steradians.
    let known = TAU * 10.0 * (one.recip().powi(-2) * (series(end) - series(one)) + (1.0 - one.cos()));
    close(psf.energy(), known, 1e-9, "Stiles and Holladay");
    let [finite, whole] = [Some(1e7), None].map(|end| Psf::abg(0.3, 0.02, 3.0, end).unwrap().energy());
    close(finite, whole, 1e-5, "ABg");
    let psf = Psf::camera();
    let numeric = integral::integral_from_zero(&|r| TAU * r * psf.value(r), 0.003, 10.0);
    close(numeric, psf.energy(), 1e-10, "camera");
    close(psf.energy(), 0.03, 1e-15, "camera");
    let patch = psf.energy() - psf.energy_within(0.05);
    assert!((patch - 0.01).abs() < 5e-4, "a black patch of a tenth of the height: {patch}");
    assert!((psf.energy_within(1e9) / psf.energy() - 1.0).abs() < 1e-9);
}

/// Values, energies and transforms at what is no angle, and far out: numbers, or not a number for what is none.
#[test]
fn extremes_are_numbers() {
    for (psf, _) in fit_tests::functions() {
        for at in [0.0, 1e-300, 1e-9, 180.0, 1e9, 1e300, f64::INFINITY] {
            let [value, within] = [psf.value(at), psf.energy_within(at)];
            assert!(
                value >= 0.0 && !within.is_nan() && within <= psf.energy() * (1.0 + 1e-9),
                "{psf:?} at {at}: {value}, {within}"
            );
        }
        assert!(psf.value(f64::NAN).is_nan() && psf.energy_within(f64::NAN).is_nan());
        assert_eq!(psf.transform(0.0), psf.energy());
        assert!(psf.transform(1e4).abs() < psf.transform(0.5).abs(), "{psf:?}");
    }
}

/// A transform is an integral over the plane: at a few frequencies, by quadrature with a cut that is far out.
#[test]
fn transforms_are_those_of_the_functions() {
    let psf = Psf::camera();
    for frequency in [0.05_f64, 1.0, 20.0] {
        let slices = 400_000;
        let step = 4.0 / f64::from(slices);
        let sum: f64 = (0..slices)
            .map(|i| (f64::from(i) + 0.5) * step)
            .map(|r| TAU * r * psf.value(r) * libm::j0(TAU * frequency * r) * step)
            .sum();
        assert!((psf.transform(frequency) - sum).abs() < 1e-7, "{frequency}: {} for {sum}", psf.transform(frequency));
    }
    // Of the same function as a table, whose rows are dense.
    let rows: Vec<[f64; 2]> = (0..400).map(|i| 1e-4 * 1.025_f64.powi(i)).map(|r| [r, psf.value(r)]).collect();
    let table = Psf::table(Table::new(&rows).unwrap()).scattering(psf.energy()).unwrap();
    for frequency in [1.0, 20.0, 100.0] {
        close(table.transform(frequency), psf.transform(frequency), 2e-3, "a table of the camera's");
    }
    // cie135 has closed transforms, and the plane's integral by lobes is the same.
    let psf = Psf::cie135(observer(40.0, 0.7));
    let parts = eye::cie135(observer(40.0, 0.7));
    for frequency in [0.3, 5.0, 60.0] {
        let value = |angle: f64| parts.iter().map(|part| part.value(angle)).sum::<f64>();
        let lobes = hankel::transform(&value, 0.001, 0.3, TAU * frequency) * 1.0_f64.to_radians().powi(2);
        close(lobes, psf.transform(frequency), 1e-7, "cie135 by lobes");
    }
}

/// The powers of the tail are the function, and those of the chord are they again.
#[test]
fn tails_are_powers() {
    for (psf, _) in fit_tests::functions().into_iter().filter(|(psf, _)| psf.unit() == Unit::Degrees) {
        let psf = psf.scattering(0.3).unwrap();
        let tail = psf.tail(2.0).unwrap();
        assert!(tail.error < 1e-6, "{psf:?}: {:.1e}", tail.error);
        for angle in [2.0, 5.0, 30.0, 90.0] {
            close(tail.value(angle), psf.value(angle), tail.error * 1.001 + 1e-14, "a tail");
        }
        let widest = 95.0_f64;
        let series: Vec<ChordSeries> = (1..=tail.powers.len())
            .map(|s| {
                if s > 6 { ChordSeries::taylor(6.0, 1) } else { ChordSeries::even(s as f64, 6, widest.to_radians()) }
                    .unwrap()
            })
            .collect();
        for angle in [2.0_f64, 20.0, 95.0] {
            let radian = 1.0_f64.to_radians();
            let sum: f64 = tail
                .powers
                .iter()
                .zip(&series)
                .enumerate()
                .take(6)
                .map(|(i, (power, series))| power * radian.powi(i as i32 + 1) * series.value(angle * radian))
                .sum();
            let known = tail.value(angle) - tail.constant - tail.quadratic * angle * angle;
            close(sum, known, 1e-4, "by chords");
        }
    }
    assert!(Psf::camera().tail(1.0).is_none());
}

/// A row of a profile says what the function says, and modes begin where the widest angle ends.
#[test]
fn profiles_are_rows_of_the_function() {
    let psf = Psf::cie(observer(60.0, 0.5));
    let mixture = psf.mixture([0.1, 100.0], 1e-2).unwrap();
    let profile = psf.profile([0.1, 100.0], Some(&mixture), 31).unwrap();
    assert_eq!((profile.rows.len(), profile.modes.len()), (31, 31));
    close(profile.rows[10].angle, 1.0, 1e-12, "angle");
    assert!(profile.rows.iter().all(|row| row.error.abs() <= mixture.error && row.value == psf.value(row.angle)));
    close(profile.rows[30].encircled, 1.0, 1e-12, "all of it");
    assert!(profile.rows.is_sorted_by(|a, b| a.encircled < b.encircled));
    close(profile.modes[0].frequency, 0.005, 1e-12, "lowest frequency");
    assert!(profile.modes.is_sorted_by(|a, b| a.transform > b.transform), "{:?}", profile.modes);
    assert!(psf.profile([0.1, 100.0], None, 1).is_err() && psf.profile([1.0, 0.1], None, 5).is_err());
}
