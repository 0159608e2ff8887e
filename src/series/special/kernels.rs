//! Transforms of bells with an edge, each 1 at 0 and safe around it.

use std::f64::consts::{FRAC_2_PI, PI};
use std::sync::OnceLock;

/// Φ(z) = 3 (sin z − z cos z)/z³: the transform of the parabola 1 − x²/h² at z = qh, over its integral. Within 1e-15.
///
/// Below |z| = 0.7 the closed form cancels; its power series has the factors z²/(2j(2j+3)).
pub fn parabola_kernel(z: f64) -> f64 {
    if z.abs() < 0.7 {
        let squared = z * z;
        return (1..=8).rev().fold(1.0, |sum, j| 1.0 - squared / f64::from(2 * j * (2 * j + 3)) * sum);
    }
    let (sin, cos) = z.sin_cos();
    3.0 * (sin - z * cos) / (z * z * z)
}

/// 8 J_2(z)/z²: the two-dimensional transform of the paraboloid 1 − r²/ρ² at z = qρ, over its integral. Within 1e-15.
///
/// Below |z| = 1, by the power series 2 Σ_k (−z²/4)^k/(k! (k+2)!) (DLMF 10.2.2), where the quotient would be 0/0.
pub fn paraboloid_kernel(z: f64) -> f64 {
    let squared = z * z;
    if z.abs() < 1.0 {
        return (1..=10).rev().fold(1.0, |sum, k| 1.0 - 0.25 * squared / f64::from(k * (k + 2)) * sum);
    }
    8.0 * libm::jn(2, z) / squared
}

/// Cells of the table of [`paraboloid_kernel_looked_up`] from one whole number to the next, and where it ends.
const FINE: u32 = 32;
const END: u32 = 24;

/// [`paraboloid_kernel`] for z ≥ 0, for whoever needs it by the million: within 1e-12.
///
/// Up to z = 24 by Hermite's quintics on cells of width h, which are off by h⁶/46080 of the sixth derivative; beyond by
/// Hankel's expansion of J_2 (DLMF 10.17.3), whose terms fall below that.
pub fn paraboloid_kernel_looked_up(z: f64) -> f64 {
    static QUINTICS: OnceLock<Vec<[f64; 6]>> = OnceLock::new();
    let place = z * f64::from(FINE);
    match QUINTICS.get_or_init(quintics).get(place as usize) {
        Some([a, b, c, d, e, f]) => {
            let t = place.fract();
            a + t * (b + t * (c + t * (d + t * (e + t * f))))
        }
        None => 8.0 * far_bessel(z) / (z * z),
    }
}

/// J_2(z) for z ≥ 24.
fn far_bessel(z: f64) -> f64 {
    // Π (16 − (2j − 1)²) / (k! 8ᵏ), every second of them with the other sign.
    const P: [f64; 5] = [1.0, -0.8203125, 0.317230224609375, -1.1276543140411377, 10.061105468776077];
    const Q: [f64; 4] = [1.875, 0.3076171875, -0.5154991149902344, 3.0809126794338226];
    let square = (z * z).recip();
    let even = P.iter().rev().fold(0.0, |sum, p| sum * square + p);
    let odd = Q.iter().rev().fold(0.0, |sum, q| sum * square + q) / z;
    let (sin, cos) = (z - 1.25 * PI).sin_cos();
    (FRAC_2_PI / z).sqrt() * (even * cos - odd * sin)
}

/// Coefficients of 1, t, … t⁵ with 0 ≤ t ≤ 1 along each cell, by (J_n/zⁿ)' = −J_{n+1}/zⁿ (DLMF 10.6.6).
fn quintics() -> Vec<[f64; 6]> {
    let step = f64::from(FINE).recip();
    let node = |i: u32| {
        let z = step * f64::from(i);
        if i == 0 {
            return [1.0, 0.0, -step * step / 6.0];
        }
        let (third, fourth) = (libm::jn(3, z), libm::jn(4, z));
        let [slope, bend] = [-8.0 * third / (z * z), 8.0 * (fourth - third / z) / (z * z)];
        [paraboloid_kernel(z), step * slope, step * step * bend]
    };
    let nodes: Vec<[f64; 3]> = (0..=FINE * END).map(node).collect();
    let quintic = |pair: &[[f64; 3]]| {
        let ([from, out, bend], [to, into, bent]) = (pair[0], pair[1]);
        let rise = to - from - out - 0.5 * bend;
        let (slope, curve) = (into - out - bend, bent - bend);
        let third = 10.0 * rise - 4.0 * slope + 0.5 * curve;
        let fourth = -15.0 * rise + 7.0 * slope - curve;
        [from, out, 0.5 * bend, third, fourth, 6.0 * rise - 3.0 * slope + 0.5 * curve]
    };
    nodes.windows(2).map(quintic).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_looked_up_is_what_is_computed() {
        for i in 0..40_000 {
            let z = 0.007 * f64::from(i);
            let off = (paraboloid_kernel_looked_up(z) - paraboloid_kernel(z)).abs();
            assert!(off < 1e-12, "{z}: {off:e}");
        }
    }
}
