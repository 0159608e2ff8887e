//! The paraboloid by Fourier-Bessel series: golden coefficients, Graf's theorem, and what cutting it off costs.

use glam::DVec2;
use vglare::series::fourier_bessel::{
    Chain, FourierBessel, Graf, Kappa, Paraboloid, Spot, angular_terms, exact, graf_j0, truncation,
};
use vglare::series::special::j0_zeros;

use crate::golden::{cases, count, number};
use crate::support::check::Worst;
use crate::support::scenes::Chance;

const COEFFICIENTS: &str = include_str!("../golden/fourier_bessel.json");
const GRAF: &str = include_str!("../golden/graf.json");

const BELL: Paraboloid = Paraboloid { peak: 1.0, curvature: 4.0 };
const SPOTS: [Spot; 3] = [
    Spot { center: DVec2::new(0.35, 0.2), weight: 0.5 },
    Spot { center: DVec2::new(-0.3, 0.1), weight: 0.5 },
    Spot { center: DVec2::ZERO, weight: -0.25 },
];

#[test]
fn coefficients_are_the_golden_ones_and_the_printed_chain_is_right_only_within_the_disc() {
    let (mut worst, mut same, mut beyond) = (Worst::default(), 0, 0);
    for case in cases(COEFFICIENTS) {
        let bell = Paraboloid { peak: number(&case["A"]), curvature: number(&case["B"]) };
        let (radius, k, expected) = (number(&case["L"]), count(&case["k"]), number(&case["a_k"]));
        let name = format!("{bell:?}, L = {radius}, k = {k}");
        let [got, printed] = [Chain::Whole, Chain::Printed]
            .map(|chain| FourierBessel::new(bell, radius, k, chain).terms[k as usize - 1].coefficient);
        let error = (got - expected).abs() / bell.peak;
        assert!(error <= 1e-15, "{name}: {got:e} for {expected:e}");
        worst.take(error, || name.clone());
        if bell.edge() <= radius {
            assert_eq!(printed, got, "{name}");
            same += 1;
        } else {
            // 0.89, -0.21 and 0.02 of the truth for k = 1, 3, 10.
            assert!((printed / got - 1.0).abs() > 0.1, "{name}: printed {printed:e} for {got:e}");
            beyond += 1;
        }
    }
    assert!(same > 0 && beyond > 0, "both kinds are in the file");
    println!("worst error of the peak {worst}");
}

#[test]
fn grafs_sum_is_the_golden_one() {
    let (mut worst, mut whole) = (Worst::default(), Worst::default());
    for case in cases(GRAF) {
        let [r, dr, theta, expected, j0] = ["r", "dr", "theta", "truncated", "J0_exact"].map(|key| number(&case[key]));
        let highest = count(&case["M"]);
        let name = || format!("r = {r}, dr = {dr}, theta = {theta}, M = {highest}");
        let got = graf_j0(r, dr, theta, highest, Kappa::Right);
        let error = (got - expected).abs();
        assert!(error <= 1e-15, "{}: {got:e} for {expected:e}", name());
        worst.take(error, name);
        let needed = angular_terms(r.min(dr), 1e-12);
        let error = (graf_j0(r, dr, theta, needed, Kappa::Right) - j0).abs();
        assert!(error <= 1e-12, "{} with {needed}: {error:e}", name());
        whole.take(error, name);
    }
    println!("worst error {worst}; to the whole J_0 {whole}");
}

#[test]
fn the_printed_weights_of_grafs_sum_are_wrong_either_way() {
    let (r, dr, theta) = (3.0, 2.0, 0.5);
    let right = graf_j0(r, dr, theta, 40, Kappa::Right);
    for (zeroth, off) in [(2.0, -0.23), (0.0, -0.11)] {
        let printed = graf_j0(r, dr, theta, 40, Kappa::Printed { zeroth });
        assert!((printed - right - off).abs() < 0.005, "κ_0 = {zeroth}: off by {}", printed - right);
    }
}

#[test]
fn as_many_angular_terms_as_the_rule_says_are_enough() {
    let mut worst = Worst::default();
    let mut chance = Chance::new(11);
    for error in [1e-2, 1e-3, 1e-5, 1e-6, 1e-9, 1e-12] {
        for z in [0.1, 1.0, 7.0, 30.0, 100.0, 314.0] {
            let highest = angular_terms(z, error);
            for _ in 0..20 {
                // The nearer of the two sets the need; the worst angles are those of vectors in line.
                let (r, theta) = (z * chance.between(1.0, 1.5), chance.between(0.0, 0.3));
                let truth = libm::j0((r * r + z * z - 2.0 * r * z * theta.cos()).sqrt());
                let got = (graf_j0(r, z, theta, highest, Kappa::Right) - truth).abs() / error;
                assert!(got <= 1.0, "z = {z}, r = {r}, theta = {theta}, M = {highest}: {got} of {error:e}");
                worst.take(got, || format!("z = {z}, {error:e}"));
            }
        }
    }
    println!("worst share of the error {worst}");
}

#[test]
fn a_cut_series_is_off_by_what_the_law_says() {
    for radius in [1.0, 2.0] {
        for terms in [20, 50, 100, 200] {
            let series = FourierBessel::new(BELL, radius, terms, Chain::Whole);
            let error = |i: u32| {
                let distance = f64::from(i) / 4000.0 * radius;
                (series.value(distance) - BELL.value(distance)).abs()
            };
            let measured = (0..=4000).map(error).fold(0.0, f64::max);
            let law = truncation(BELL, radius, terms);
            println!("L = {radius}, N = {terms}: {measured:.3e}, the law says {law:.3e}");
            assert!((measured / law - 1.0).abs() < 0.05, "L = {radius}, N = {terms}: {measured:e} {law:e}");
        }
    }
}

#[test]
fn a_bell_wider_than_the_disc_converges_within_it() {
    // ρ = 0.5 on a disc of 0.4: the bell jumps to 0 at the rim, by 0.36. The terms alternate, and at the centre, where
    // that jump is seen in focus, half of the last one is left: 0.36 √(π/2 α_N), 6e-3. Elsewhere less is.
    let series = FourierBessel::new(BELL, 0.4, 2000, Chain::Whole);
    let printed = FourierBessel::new(BELL, 0.4, 2000, Chain::Printed);
    for i in 0..30 {
        let distance = 0.01 * f64::from(i);
        let error = (series.value(distance) - BELL.value(distance)).abs();
        assert!(error < 6e-3, "r = {distance}: {error:e}");
    }
    // The printed coefficients fold what lies beyond the rim back: wrong from 2L − ρ = 0.3 on.
    let [near, far] = [0.2, 0.37].map(|distance| (printed.value(distance) - BELL.value(distance)).abs());
    assert!(near < 5e-3 && far > 0.1, "{near:e} {far:e}");
    assert!((series.value(0.37) - BELL.value(0.37)).abs() < 0.02);
}

#[test]
fn graf_separates_what_the_series_of_each_ghost_gives() {
    const RADIUS: f64 = 1.5;
    const TERMS: u32 = 40;
    let series = FourierBessel::new(BELL, RADIUS, TERMS, Chain::Whole);
    let reach = SPOTS.iter().map(|spot| spot.center.length()).fold(0.0, f64::max);
    let z = j0_zeros(TERMS)[TERMS as usize - 1].alpha * reach / RADIUS;
    let whole = Graf::new(&series, &SPOTS, angular_terms(z, 1e-12), Kappa::Right);
    let cut = Graf::new(&series, &SPOTS, 10, Kappa::Right);
    let printed = Graf::new(&series, &SPOTS, angular_terms(z, 1e-12), Kappa::Printed { zeroth: 0.0 });
    let (mut worst, mut canaries, mut chance) = (Worst::default(), [0.0f64; 2], Chance::new(7));
    for _ in 0..200 {
        let at = DVec2::new(chance.between(-0.8, 0.8), chance.between(-0.8, 0.8));
        let unseparated = series.unseparated(&SPOTS, at);
        let error = (whole.value(at) - unseparated).abs();
        assert!(error < 1e-12, "{at}: {error:e}");
        worst.take(error, || at.to_string());
        let law = 1.25 * truncation(BELL, RADIUS, TERMS);
        assert!((unseparated - exact(BELL, &SPOTS, at)).abs() < law, "{at}: beyond {law}");
        canaries[0] = canaries[0].max((cut.value(at) - unseparated).abs());
        canaries[1] = canaries[1].max((printed.value(at) - unseparated).abs());
    }
    println!("worst difference {worst}; too few orders {:.1e}, printed weights {:.1e}", canaries[0], canaries[1]);
    assert!(canaries[0] > 1e-3 && canaries[1] > 0.1, "{canaries:?}");
}
