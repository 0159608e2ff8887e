//! Mixtures: how many Gaussians they take, and that they are what they say.

use super::*;

/// For every function: the range of angles that its mixture is tried over.
pub(super) fn functions() -> Vec<(Psf, [f64; 2])> {
    let mut all = Vec::new();
    for (age, pigment) in [(0.0, 0.0), (25.0, 0.5), (75.0, 0.5), (120.0, 1.2), (60.0, 1.2)] {
        all.push((Psf::cie(observer(age, pigment)), [0.1, 100.0]));
        all.push((Psf::cie135(observer(age, pigment)), [0.01, 90.0]));
    }
    all.extend(
        [Luminance::Photopic, Luminance::Mesopic, Luminance::Scotopic]
            .map(|luminance| (Psf::spencer(luminance), [0.01, 90.0])),
    );
    all.push((Psf::stiles_holladay(70.0).unwrap(), [1.0, 100.0]));
    all.push((Psf::camera(), [1e-3, 2.0]));
    all.push((Psf::abg(1e-3, 1e-4, 1.8, Some(2.0)).unwrap(), [1e-3, 2.0]));
    all
}

/// The largest relative error at angles that no fit has seen.
fn worst(psf: &Psf, mixture: &Mixture) -> f64 {
    let [from, to] = mixture.range;
    let angle = |i: i32| from * (to / from).powf(f64::from(i) / 9973.0);
    (0..=9973).map(angle).map(|angle| (mixture.value(angle) / psf.value(angle) - 1.0).abs()).fold(0.0, f64::max)
}

/// At 1 % and at 0.1 %: no more Gaussians than the best known fits of these functions have.
#[test]
fn mixtures_meet_their_tolerance_with_few_gaussians() {
    for (psf, range) in functions() {
        let most = match psf.name() {
            Name::Cie => [9, 12, 16],
            Name::Cie135 => [12, 15, 20],
            Name::Spencer => [10, 14, 19],
            Name::StilesHolladay => [6, 8, 11],
            _ => [7, 10, 14],
        };
        for (tolerance, most) in [0.05, 1e-2, 1e-3].into_iter().zip(most) {
            let mixture = psf.mixture(range, tolerance).unwrap();
            let off = worst(&psf, &mixture);
            assert!(mixture.error <= tolerance && mixture.is_positive(), "{psf:?}: {:.2e}", mixture.error);
            assert!(off <= mixture.error * 1.001, "{psf:?}: {off:.3e} and {:.3e}", mixture.error);
            assert!(mixture.terms.len() <= most, "{psf:?}: {} at {tolerance}", mixture.terms.len());
            assert!(mixture.terms.is_sorted_by(|a, b| a.sigma < b.sigma));
        }
    }
}

/// All tolerances and ranges, down to two neighbouring pixels and up to a pixel of a minute beside a half-circle.
#[test]
fn every_range_is_met() {
    let psfs = [
        Psf::cie135(observer(25.0, 0.5)),
        Psf::spencer(Luminance::Scotopic),
        Psf::cie(observer(90.0, 0.0)),
        Psf::camera(),
    ];
    let ranges = [
        [1e-5, 1e-3],
        [1e-4, 0.1],
        [1e-3, 180.0],
        [0.09, 0.11],
        [0.5, 0.5],
        [0.5, 0.500_001],
        [1.0, 3.0],
        [20.0, 179.0],
    ];
    for psf in psfs {
        for range in ranges {
            for tolerance in [0.3, 1e-2] {
                // Where the camera's last Gaussian has ended there is nothing that f64 could hold.
                let range = if psf.unit() == Unit::Look { range.map(|angle| angle * 0.01) } else { range };
                let mixture = psf.mixture(range, tolerance).unwrap();
                assert!(
                    mixture.error <= tolerance,
                    "{psf:?} over {range:?}: {} terms, {:.2e}",
                    mixture.terms.len(),
                    mixture.error
                );
                let off = worst(&psf, &mixture);
                assert!(
                    off <= mixture.error * 1.001 + 1e-12,
                    "{psf:?} over {range:?}: {off:.3e}, {:.3e}",
                    mixture.error
                );
            }
        }
    }
}

/// Ranges that no picture has, of functions that vanish or do not: a mixture of numbers, soon.
#[test]
fn no_range_is_too_much() {
    let mut psfs: Vec<Psf> = functions().into_iter().step_by(3).map(|(psf, _)| psf).collect();
    psfs.push(Psf::abg(1e18, 1e-18, 10.0, None).unwrap());
    psfs.push(Psf::table(Table::new(&[[0.1, 1e18], [0.2, 1e-18]]).unwrap()));
    psfs.push(Psf::table(Table::new(&[[0.0, 1.0], [1.0, 2.0], [2.0, 3.0]]).unwrap()));
    for psf in psfs {
        for range in [[1e-18, 1e18], [1e-3, 1e4], [1e4, 1e5], [1e-18, 1e-17]] {
            let mixture = psf.mixture(range, 0.2).unwrap();
            let numbers = mixture.terms.iter().all(|term| term.sigma > 0.0 && term.weight.is_finite());
            assert!(numbers && mixture.error.is_finite(), "{psf:?} over {range:?}: {mixture:?}");
            assert!(range[0] <= mixture.range[0] && mixture.range[0] <= mixture.range[1]);
        }
    }
}

/// The tightest tolerance is met too, and what is no range or tolerance is refused.
#[test]
fn limits_are_limits() {
    let psf = Psf::cie(observer(25.0, 0.5));
    let mixture = psf.mixture([0.1, 100.0], 1e-5).unwrap();
    assert!(mixture.error <= 1e-5 && mixture.terms.len() <= 26, "{} terms, {:.1e}", mixture.terms.len(), mixture.error);
    for range in [[0.0, 1.0], [2.0, 1.0], [f64::NAN, 1.0], [1.0, f64::INFINITY], [-1.0, 1.0]] {
        assert_eq!(psf.mixture(range, 0.01).unwrap_err().key, "range");
    }
    for tolerance in [0.0, f64::NAN, 1.0, 1e-7] {
        assert_eq!(psf.mixture([0.1, 1.0], tolerance).unwrap_err().key, "tolerance");
    }
}

/// A change of age keeps the widths, and the mixture is the one that the age has by itself.
#[test]
fn one_set_of_widths_does_for_all_ages() {
    for (build, range) in [(Psf::cie as fn(Observer) -> Psf, [0.05, 100.0]), (Psf::cie135, [0.02, 100.0])] {
        for pigment in [0.0, 0.5, 1.2] {
            let observers = build(observer(33.0, pigment)).observers(range, 1e-2).unwrap().unwrap();
            for age in [0.0, 20.0, 45.0, 70.0, 95.0, 120.0] {
                let psf = build(observer(age, pigment)).scattering(0.2).unwrap();
                let mixture = observers.mixture(&psf).unwrap();
                assert_eq!(mixture, psf.mixture(range, 1e-2).unwrap());
                let off = worst(&psf, &mixture);
                assert!(off <= mixture.error * 1.001 && off <= 1e-2, "{psf:?}: {off:.2e}");
            }
            assert!(observers.mixture(&build(observer(33.0, 0.7))).is_none());
            assert!(observers.mixture(&Psf::camera()).is_none());
        }
    }
}

/// The mixture of one age alone has no more Gaussians, and fewer where the core matters.
#[test]
fn one_age_alone_takes_no_more() {
    for (psf, range) in [(Psf::cie(observer(60.0, 0.5)), [0.1, 60.0]), (Psf::cie135(observer(25.0, 0.5)), [0.003, 5.0])]
    {
        let [alone, shared] = [psf.mixture_alone(range, 2e-3), psf.mixture(range, 2e-3)].map(Result::unwrap);
        assert!(alone.error <= 2e-3 && worst(&psf, &alone) <= 1.001 * alone.error, "{:.1e}", alone.error);
        let fewer = if psf.name() == Name::Cie135 { 3 } else { 0 };
        assert!(alone.terms.len() + fewer <= shared.terms.len(), "{} and {}", alone.terms.len(), shared.terms.len());
        assert_eq!([alone.constant, alone.quadratic], [shared.constant, shared.quadratic]);
    }
}

/// Within its flat part `cie` is a constant; across the rim, the mixture is of what lies outside.
#[test]
fn the_flat_part_is_left_out() {
    let psf = Psf::cie(observer(25.0, 0.5));
    let inside = psf.mixture([1e-4, 0.1], 1e-3).unwrap();
    assert!(inside.terms.is_empty() && inside.constant == psf.centre() && inside.error == 0.0);
    let across = psf.mixture([0.01, 100.0], 1e-2).unwrap();
    assert_eq!(across.range, [0.1, 100.0]);
    assert_eq!(across, Mixture { range: [0.1, 100.0], ..psf.mixture([0.1, 100.0], 1e-2).unwrap() });
}

/// Functions that are no positive mixtures are met by weights of both signs as far as they can be, and the error is
/// told.
#[test]
fn other_functions_tell_how_far_they_are_met() {
    let steep = Psf::abg(1.0, 1e-4, 3.0, None).unwrap();
    let mixture = steep.mixture([1e-3, 2.0], 1e-2).unwrap();
    assert!(!mixture.is_positive() && mixture.error <= 1e-2, "{:.2e}, {}", mixture.error, mixture.terms.len());
    assert!(worst(&steep, &mixture) <= 1.001 * mixture.error && mixture.cancellation() <= 100.0);
    // A step, which no Gaussians follow.
    let step = Psf::table(Table::new(&[[0.01, 1.0], [0.1, 1.0], [0.11, 0.01], [1.0, 0.01]]).unwrap());
    let mixture = step.mixture([0.01, 1.0], 1e-2).unwrap();
    let off = worst(&step, &mixture);
    assert!(mixture.error > 1e-2 && (off / mixture.error - 1.0).abs() < 0.05, "{off} and {}", mixture.error);
}

/// Gaussians given are Gaussians taken, with their tints.
#[test]
fn known_mixtures_are_not_fitted() {
    let psf = Psf::gaussians(&[0.2, 0.1], Some(&[3.0, 1.0]), Some(&[[1.0, 0.5, 0.0], [1.0; 3]]))
        .unwrap()
        .scattering(0.1)
        .unwrap();
    let mixture = psf.mixture([0.001, 1.0], 1e-3).unwrap();
    assert!(mixture.error == 0.0 && mixture.terms[0].sigma == 0.1 && mixture.terms[1].tint == [1.0, 0.5, 0.0]);
    close(mixture.value(0.15), psf.value(0.15), 1e-14, "sum");
    for (energy, known) in psf.energies().into_iter().zip([0.1, 0.0625, 0.025]) {
        close(energy, known, 1e-14, "energy");
    }
    close(psf.centres()[2], 0.025 / (TAU * 0.01), 1e-14, "centre");
    close(psf.energy_within(f64::INFINITY), 0.1, 1e-14, "all of it");
}

/// Powers of the distance, falling and growing.
#[test]
fn powers_are_met() {
    for exponent in [1.0, 2.0, 3.0, 5.0] {
        for (range, tolerance) in [([1e-4, 2.0], 1e-2), ([1e-3, 1.0], 1e-3)] {
            let mixture = power(exponent, range, tolerance).unwrap();
            assert!(mixture.error <= tolerance && mixture.is_positive());
            for i in 0..=3000 {
                let x = range[0] * (range[1] / range[0]).powf(f64::from(i) / 3000.0);
                close(mixture.value(x), x.powf(-exponent), mixture.error * 1.001, "a power");
            }
        }
    }
    for (exponent, against) in [(1, 1.0), (1, 3.0), (3, 1.0), (3, 2.0)] {
        for tolerance in [1e-2, 1e-3] {
            let range = [1e-4, 2.0];
            let mixture = growing_power(exponent, against, range, tolerance).unwrap();
            assert!(
                mixture.error <= tolerance,
                "{exponent} against {against}: {:.1e} by {}",
                mixture.error,
                mixture.terms.len()
            );
            assert!(mixture.terms.len() <= 3, "{exponent} against {against}: {} terms", mixture.terms.len());
            for i in 0..=3000 {
                let x = range[0] * (range[1] / range[0]).powf(f64::from(i) / 3000.0);
                let power = f64::from(exponent);
                let allowed = mixture.error * x.powf(-against) * range[1].powf(power + against);
                assert!(
                    (mixture.value(x) - x.powf(power)).abs() <= 1.01 * allowed,
                    "{exponent} against {against} at {x}"
                );
            }
        }
    }
    assert!(power(0.0, [0.1, 1.0], 0.1).is_err() && growing_power(2, 1.0, [0.1, 1.0], 0.1).is_err());
}

/// What falls faster than a Gaussian of its height, steps, rises or ends is no mixture, and is known as none at once; powers,
/// what a mixture is within its error, and what is close to one are not ruled out.
#[test]
fn what_no_gaussians_follow_is_known_before_a_fit() {
    let range = [0.01, 1.0];
    let table = |rows: &[[f64; 2]]| Psf::table(Table::new(rows).unwrap());
    let of = |value: fn(f64) -> f64| {
        let rows: Vec<[f64; 2]> = (0..200).map(|i| 0.009 * 1.025_f64.powi(i)).map(|r| [r, value(r)]).collect();
        table(&rows)
    };
    let none = [
        table(&[[0.01, 1.0], [0.1, 1.0], [0.11, 0.01], [1.0, 0.01]]),
        table(&[[0.01, 1.0], [0.02, 0.1], [0.03, 0.2], [1.0, 1e-3]]),
        table(&[[0.01, 1.0], [0.5, 0.1]]),
        Psf::abg(1.0, 1e-4, 3.0, None).unwrap(),
        Psf::abg(1.0, 1e-4, 1.5, Some(0.9)).unwrap(),
        of(|r| (-15.0 * r.powi(3)).exp()),
    ];
    for psf in none {
        assert!(!psf.may_be_mixture(range, 0.01), "{psf:?}");
    }
    let some = [
        of(|r| r.powf(-2.5)),
        of(|r| (-3.0 * r * r).exp()),
        of(|r| (-3.0 * r).exp()),
        Psf::abg(1.0, 1e-4, 1.9, Some(1.0)).unwrap(),
        Psf::camera(),
        Psf::cie(observer(25.0, 0.5)),
    ];
    for psf in some {
        assert!(psf.may_be_mixture(range, 0.01), "{psf:?}");
        assert!(psf.mixture(range, 0.01).unwrap().is_positive(), "{psf:?}");
    }
    // A ripple of 1 % is within 2 %, and not within 0.1 %.
    let ripple = of(|r| (-3.0 * r * r).exp() * (1.0 + 0.01 * (8.0 * r.ln()).sin()));
    assert!(ripple.may_be_mixture(range, 0.02) && !ripple.may_be_mixture(range, 1e-3));
}
