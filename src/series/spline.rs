//! How well B-splines carry a sinusoid between the nodes of a lattice: cubic ones in 32-bit floats, those of eight nodes in 64.

use std::f64::consts::PI;

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

/// Nodes that a cubic B-spline has at a point.
pub const CUBIC: u32 = 4;

/// The same as [`spline_error`] of a B-spline that has an even number of nodes at a point, `order` of them, 4 at least.
///
/// Its response is (sin(θ/2)/(θ/2))^order, so that an alias at θ + 2πj is (θ/(θ + 2πj))^order of it: here they are added up.
pub fn spline_error_of(order: u32, theta: f64) -> f64 {
    const ALIASES: i32 = 8;
    if order == CUBIC {
        return spline_error(theta);
    }
    let part = theta / (2.0 * PI);
    let alias = |j: i32| (part / (part + f64::from(j))).powi(order as i32);
    let near: f64 = (1..=ALIASES).map(|j| alias(j) + alias(-j)).sum();
    // All that are farther, by the integral of the nearer side.
    let beyond = 2.0 * part.powi(order as i32) * (f64::from(ALIASES) - part).powi(1 - order as i32);
    near + beyond / f64::from(order - 1)
}

/// What a B-spline of some nodes is to be divided by for each harmonic 0 to `degree`, where the first of them turns by
/// `step` periods from one node to the next: (sin(θ/2)/(θ/2))^order; one over that.
pub fn spline_gains(order: u32, degree: u32, step: f64) -> Vec<f64> {
    let gain = |n: u32| {
        let half = PI * step * f64::from(n);
        if half == 0.0 { 1.0 } else { (half / half.sin()).powi(order as i32) }
    };
    (0..=degree).map(gain).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

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

    /// The weights of a B-spline's nodes at a fraction, by the truncated powers that define it.
    fn weights(order: u32, t: f64) -> Vec<f64> {
        let factorial = |n: u32| (1..=n).map(f64::from).product::<f64>();
        let value = |x: f64| {
            let term = |k: u32| {
                let sign = if k.is_multiple_of(2) { 1.0 } else { -1.0 };
                let binomial = factorial(order) / factorial(k) / factorial(order - k);
                sign * binomial * (x - f64::from(k)).max(0.0).powi(order as i32 - 1)
            };
            (0..=order).map(term).sum::<f64>() / factorial(order - 1)
        };
        (0..order).map(|k| value(f64::from(order - 1 - k) + t)).collect()
    }

    #[test]
    fn the_bound_of_more_nodes_holds_and_is_tight() {
        for order in [4, 6, 8] {
            for s in [1.2, 1.5, 2.0, 3.0, 4.0] {
                let theta = PI / s;
                let gain = spline_gains(order, 1, theta / (2.0 * PI))[1];
                let mut worst = 0.0f64;
                for place in 0..40 {
                    let (t, weights) = (f64::from(place) / 40.0, weights(order, f64::from(place) / 40.0));
                    for turn in 0..64 {
                        let shift = PI * f64::from(turn) / 32.0;
                        let node = |k: usize| gain * (theta * (k as f64 + 1.0 - f64::from(order / 2)) + shift).cos();
                        let value: f64 = weights.iter().enumerate().map(|(k, weight)| weight * node(k)).sum();
                        worst = worst.max((value - (theta * t + shift).cos()).abs());
                    }
                }
                let bound = spline_error_of(order, theta);
                assert!(bound + 1e-12 >= worst * (1.0 - 1e-9), "order {order}, s = {s}: {bound} {worst}");
                assert!(bound <= 1.25 * worst + 1e-12, "order {order}, s = {s}: {bound} {worst}");
            }
        }
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
