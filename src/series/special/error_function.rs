//! The error function, of a real and of a complex argument.

use errorfunctions::ComplexErrorFunctions as _;
use num_complex::Complex64;

/// erf(x) to the last digit, by libm.
pub fn erf(x: f64) -> f64 {
    libm::erf(x)
}

/// e^(−b²) Re erf(a + ib) for finite a and b, within 1e-15; between −1 and 1.
///
/// Times √(2π)σ/2 it is ∫₀^{T/2} exp(−x²/2σ²) cos(qx) dx, with a = T/(2√2σ) and b = qσ/√2. erf(a + ib) itself overflows
/// as e^(b²) does, so it is taken as e^(−b²) − Re[e^(−a²−2iab) w(−b + ia)] with
/// Faddeeva's w (DLMF 7.2.3), which stays within 1 for a ≥ 0. w is that of the crate `errorfunctions`, a port of the
/// package by S. G. Johnson (MIT).
pub fn re_erf_scaled(a: f64, b: f64) -> f64 {
    // Odd in a, even in b.
    let (size, sign) = (a.abs(), if a < 0.0 { -1.0 } else { 1.0 });
    let w = Complex64::new(-b.abs(), size).w();
    let turned = Complex64::from_polar((-size * size).exp(), -2.0 * size * b.abs());
    sign * ((-b * b).exp() - (turned * w).re)
}
