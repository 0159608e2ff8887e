//! How well a cubic B-spline carries a sinusoid between the nodes of a lattice.

/// A bound of |interpolated − true| for cos θu sampled at the integers, prefiltered exactly; 0 ≤ θ < π.
///
/// The spline answers a sinusoid with itself, b̂(θ)/b(θ) strong, and with its aliases at θ + 2πj, where b̂(θ) =
/// (sin(θ/2)/(θ/2))⁴ and b(θ) = Σ_j b̂(θ + 2πj) = (2 + cos θ)/3. What the first lacks, the aliases hold: twice that
/// bounds the error.
pub fn spline_error(theta: f64) -> f64 {
    let half = 0.5 * theta;
    if half < 0.02 {
        // 1 − b̂/b = θ⁴/720 + O(θ⁶); the closed form cancels here.
        return theta.powi(4) / 360.0 * (1.0 + 0.1 * theta * theta);
    }
    let sinc = half.sin() / half;
    2.0 * (1.0 - 3.0 * sinc.powi(4) / (2.0 + theta.cos()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    fn measured(theta: f64) -> f64 {
        let weights = |t: f64| {
            let u: f64 = 1.0 - t;
            [u.powi(3), 4.0 - 3.0 * t * t * (2.0 - t), 4.0 - 3.0 * u * u * (2.0 - u), t.powi(3)].map(|w| w / 6.0)
        };
        let gain = 3.0 / (2.0 + theta.cos());
        let error = |t: f64, shift: f64| {
            let node = |k: f64| gain * (theta * k + shift).cos();
            let w = weights(t);
            let value = w[0] * node(-1.0) + w[1] * node(0.0) + w[2] * node(1.0) + w[3] * node(2.0);
            (value - (theta * t + shift).cos()).abs()
        };
        let worst_at = |t: f64| (0..64).map(|i| error(t, PI * f64::from(i) / 32.0)).fold(0.0, f64::max);
        (0..=100).map(|i| worst_at(f64::from(i) / 100.0)).fold(0.0, f64::max)
    }

    #[test]
    fn the_bound_holds_and_is_tight() {
        for s in [1.2, 1.5, 2.0, 3.0, 4.0, 8.0, 30.0, 100.0] {
            let theta = PI / s;
            let (bound, truth) = (spline_error(theta), measured(theta));
            assert!(bound >= truth, "s = {s}: {bound} {truth}");
            assert!(bound <= 1.25 * truth + 1e-15, "s = {s}: {bound} {truth}");
        }
    }
}
