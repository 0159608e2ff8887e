//! How well a cubic B-spline carries a sinusoid between the nodes of a lattice.

/// A bound of |interpolated − true| for cos θu that is sampled at the integers, divided by β(θ) and carried by the cubic
/// B-spline; 0 ≤ θ < π.
///
/// The spline answers a sinusoid with itself, β(θ) = (sin(θ/2)/(θ/2))⁴ strong, and with its aliases at θ + 2πj, which
/// are β(θ + 2πj) strong. Dividing by β(θ) makes the first exact; what is left are the aliases, and as all of them
/// together are b(θ) = Σ_j β(θ + 2πj) = (2 + cos θ)/3 they add up to b(θ)/β(θ) − 1 at most. That is half of what the
/// spline through the samples is off by.
pub fn spline_error(theta: f64) -> f64 {
    let half = 0.5 * theta;
    if half < 0.02 {
        // The closed form cancels here; these are the first terms of its power series.
        let t = theta * theta;
        return t * t / 720.0 * (1.0 + t * (5.0 / 21.0 + t / 48.0));
    }
    let sinc = half.sin() / half;
    (2.0 + theta.cos()) / (3.0 * sinc.powi(4)) - 1.0
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
        let gain = (0.5 * theta / (0.5 * theta).sin()).powi(4);
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
            assert!(bound + 1e-15 >= truth * (1.0 - 1e-12), "s = {s}: {bound} {truth}");
            assert!(bound <= 1.25 * truth + 1e-15, "s = {s}: {bound} {truth}");
        }
    }
}
