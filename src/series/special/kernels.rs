//! Transforms of bells with an edge, each 1 at 0 and safe around it.

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
const END: u32 = 2048;

/// [`paraboloid_kernel`] for z ≥ 0 from a table, for whoever needs it by the million: off by 3e-9 of what its waves are at
/// most, which fall as z^(−5/2).
///
/// Hermite's cubics on cells of width h, with (J_2/z²)' = −J_3/z² (DLMF 10.6.6): h⁴/384 of the fourth derivative.
pub fn paraboloid_kernel_looked_up(z: f64) -> f64 {
    static CUBICS: OnceLock<Vec<[f64; 4]>> = OnceLock::new();
    let place = z * f64::from(FINE);
    match CUBICS.get_or_init(cubics).get(place as usize) {
        Some([a, b, c, d]) => {
            let t = place.fract();
            a + t * (b + t * (c + t * d))
        }
        None => paraboloid_kernel(z),
    }
}

/// Coefficients of 1, t, t², t³ with 0 ≤ t ≤ 1 along each cell.
fn cubics() -> Vec<[f64; 4]> {
    let step = f64::from(FINE).recip();
    let node = |i: u32| {
        let z = step * f64::from(i);
        let slope = if i == 0 { 0.0 } else { -8.0 * libm::jn(3, z) / (z * z) };
        [paraboloid_kernel(z), step * slope]
    };
    let nodes: Vec<[f64; 2]> = (0..=FINE * END).map(node).collect();
    let cubic = |pair: &[[f64; 2]]| {
        let ([from, out], [to, into]) = (pair[0], pair[1]);
        let rise = to - from;
        [from, out, 3.0 * rise - 2.0 * out - into, out + into - 2.0 * rise]
    };
    nodes.windows(2).map(cubic).collect()
}
