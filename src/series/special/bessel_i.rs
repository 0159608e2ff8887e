//! The modified Bessel function I_n, scaled so that it cannot overflow.

/// e^−κ I_n(κ) for finite κ ≥ 0, between 0 and 1: mean coefficient n of the bell exp(κ (cos ωx − 1)).
///
/// As [`ive_all`]; the time grows with n, and for κ up to 1e8 with 10 √κ.
pub fn ive(n: u32, kappa: f64) -> f64 {
    *ive_all(n, kappa).last().expect("one for each order")
}

/// e^−κ I_n(κ) for n = 0 ..= `highest` and finite κ ≥ 0, relatively within 1e-15 for κ up to 1000 and within
/// 1e-14 up to 1e8; what is below f64 becomes 0. Beyond 1e8 the exponent is rounded as well: within 1e-14 as long as the
/// value is above 1e-8, and within 1e-12 everywhere.
///
/// I_{n−1}(κ) − I_{n+1}(κ) = 2n/κ I_n(κ) (DLMF 10.29.1), downwards in ratios I_n/I_{n−1}, all of them between 0 and 1
/// (Gautschi 1967). e^−κ I_0 follows from I_0 + 2 Σ_{n≥1} I_n = e^κ (DLMF 10.35.2), a sum of positive terms: nothing
/// cancels, and nothing overflows.
///
/// Own code because libm has no I_n, and the crate that has all orders at once (`complex-bessel`) loses digits as its
/// argument grows.
pub fn ive_all(highest: u32, kappa: f64) -> Vec<f64> {
    if kappa > LARGEST || (highest == 0 && kappa > 1e5) {
        return (0..=highest).map(|n| uniform(f64::from(n), kappa)).collect();
    }
    let last = highest as usize;
    let mut values = vec![0.0; last + 1];
    // I_n/I_0 is about exp(−n²/2κ), so 1e-19 is left after √(90 κ) orders; small κ need a few dozen.
    let begin = (f64::from(highest).powi(2) + 90.0 * kappa).sqrt() as usize + 40;
    let (mut ratio, mut sum) = (0.0, 0.0);
    for n in (1..=begin).rev() {
        ratio = kappa / (2.0 * n as f64 + kappa * ratio);
        // Σ_{j≥n} I_j / I_{n−1}.
        sum = ratio * (1.0 + sum);
        if n <= last {
            values[n] = ratio;
        }
    }
    values[0] = 1.0 / (1.0 + 2.0 * sum);
    for n in 1..=last {
        values[n] *= values[n - 1];
    }
    values
}

/// From here on the recurrence would take too long, and [`uniform`] leaves nothing to be desired.
const LARGEST: f64 = 1e8;

/// e^−κ I_n(κ) by Debye's expansion for large orders (DLMF 10.41.3 with p = n/r, U_1 and U_2 of 10.41.10), which for n = 0
/// is Hankel's (10.40.1): with r = √(n² + κ²)
///
/// ```text
/// exp(r − κ − n arsinh(n/κ)) / √(2πr) (1 + (3 − 5p²)/24r + (81 − 462p² + 385p⁴)/1152r²)
/// ```
///
/// The next term is below 1e-15 of it from κ = 1e5 on.
fn uniform(n: f64, kappa: f64) -> f64 {
    let r = n.hypot(kappa);
    let squared = (n / r).powi(2);
    let first = (3.0 - 5.0 * squared) / (24.0 * r);
    let second = (81.0 - squared * (462.0 - 385.0 * squared)) / (1152.0 * r * r);
    // r − κ without cancellation.
    let exponent = n * (n / (r + kappa)) - n * (n / kappa).asinh();
    exponent.exp() / (std::f64::consts::TAU * r).sqrt() * (1.0 + first + second)
}
