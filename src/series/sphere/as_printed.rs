//! Associated Legendre functions as textbooks print them: kept to show where they fail.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// f32 or f64.
pub trait Real:
    Copy
    + From<u16>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
}

impl Real for f32 {}
impl Real for f64 {}

/// P_lm(cos θ), not normalised and without the Condon–Shortley sign, by double factorials and three terms:
///
/// ```text
/// P_mm = (2m−1)!! sin^m θ      P_m+1,m = (2m+1) cos θ P_mm
/// (l−m) P_lm = (2l−1) cos θ P_l−1,m − (l+m−1) P_l−2,m
/// ```
///
/// (Green, "Spherical Harmonic Lighting: The Gritty Details", 2003, with its sign left out.) (2m−1)!! leaves f32 at
/// m = 29 and f64 at m = 151; use [`super::Basis`] for anything but comparison.
///
/// # Panics
/// If m > l, or l > 30000.
pub fn legendre_as_printed<T: Real>(l: u16, m: u16, cos: T, sin: T) -> T {
    assert!(m <= l && l <= 30_000, "0 ≤ m ≤ l ≤ 30000");
    let one = T::from(1);
    let factorial = (1..=m).fold(one, |product, k| product * T::from(2 * k - 1));
    let seed = factorial * (0..m).fold(one, |power, _| power * sin);
    let mut before = T::from(0);
    let mut value = seed;
    for k in m + 1..=l {
        let next = (T::from(2 * k - 1) * cos * value - T::from(k + m - 1) * before) / T::from(k - m);
        (before, value) = (value, next);
    }
    value
}

/// K² = (2l+1) (l−m)! / (4π (l+m)!), what P_lm² is multiplied by to be P̄_lm², with both factorials in full.
///
/// (l+m)! leaves f32 at 35! and f64 at 171!: K² is then 0, or 0/0 further on.
pub fn norm_squared_as_printed<T: Real>(l: u16, m: u16, pi: T) -> T {
    let factorial = |n: u16| (1..=n).fold(T::from(1), |product, k| product * T::from(k));
    T::from(2 * l + 1) / (T::from(4) * pi) * (factorial(l - m) / factorial(l + m))
}
