//! The parabola A² − B²(x − t)² of 001, whose coefficients are right and lose their digits for narrow bells.

use std::f64::consts::TAU;

/// a_0 of 001: 4A³/(3BT), the mean.
pub fn parabola_mean(a: f64, b: f64, period: f64) -> f64 {
    4.0 * a.powi(3) / (3.0 * b * period)
}

/// a_n of 001: 8/(BT) cos(2πnt/T) · [sin(pA)/p³ − A cos(pA)/p²] with p = 2πn/(BT), for n ≥ 1.
///
/// Right. The bracket is the difference of two terms that grow as p falls, so for pA ≪ 1 it loses its digits; at n = 0
/// it is NaN.
pub fn parabola_cosine(a: f64, b: f64, t: f64, period: f64, n: u32) -> f64 {
    let turn = TAU * f64::from(n) / period * t;
    8.0 / (b * period) * turn.cos() * bracket(a, TAU * f64::from(n) / (b * period))
}

/// b_n of 001, as a_n with a sine. Printed for n ≥ 0, but at n = 0 it is 0/0, for 0.
pub fn parabola_sine(a: f64, b: f64, t: f64, period: f64, n: u32) -> f64 {
    let turn = TAU * f64::from(n) / period * t;
    8.0 / (b * period) * turn.sin() * bracket(a, TAU * f64::from(n) / (b * period))
}

fn bracket(a: f64, p: f64) -> f64 {
    (p * a).sin() / p.powi(3) - a * (p * a).cos() / p.powi(2)
}

/// The bracket of a_n for A = 1: sin z/z³ − cos z/z², which is 1/3 at z = 0. Relatively off by up to 8·10⁻⁸ at z = 10⁻⁴.
pub fn parabola_kernel(z: f64) -> f64 {
    z.sin() / (z * z * z) - z.cos() / (z * z)
}

/// [`parabola_kernel`] in f32, as a shader would: at z = 10⁻⁴ not a digit is right, at 10⁻² not three.
pub fn parabola_kernel_f32(z: f32) -> f32 {
    z.sin() / (z * z * z) - z.cos() / (z * z)
}

/// A − B(x − t)², the bell that the title of 001's formulas names, 0 outside: its peak is A and its half-width √(A/B),
/// where the bell that is integrated has A² and A/B.
pub fn parabola_titled(a: f64, b: f64, t: f64, x: f64) -> f64 {
    (a - b * (x - t) * (x - t)).max(0.0)
}
