//! The modified Bessel function I_n, scaled so that it cannot overflow.

/// e^−κ I_n(κ) for 0 ≤ κ ≤ 1e8, between 0 and 1: mean coefficient n of the bell exp(κ (cos ωx − 1)).
///
/// As [`ive_all`]; the time grows with n + 10 √κ.
pub fn ive(n: u32, kappa: f64) -> f64 {
    *ive_all(n, kappa).last().expect("one for each order")
}

/// e^−κ I_n(κ) for n = 0 ..= `highest` and 0 ≤ κ ≤ 1e8, relatively within 1e-15 for κ up to 1000 and within
/// 1e-14 up to 1e8; what is below f64 becomes 0.
///
/// I_{n−1}(κ) − I_{n+1}(κ) = 2n/κ I_n(κ) (DLMF 10.29.1), downwards in ratios I_n/I_{n−1}, all of them between 0 and 1
/// (Gautschi 1967). e^−κ I_0 follows from I_0 + 2 Σ_{n≥1} I_n = e^κ (DLMF 10.35.2), a sum of positive terms: nothing
/// cancels, and nothing overflows.
///
/// Own code because libm has no I_n, and the crate that has all orders at once (`complex-bessel`) loses digits as its
/// argument grows.
pub fn ive_all(highest: u32, kappa: f64) -> Vec<f64> {
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
