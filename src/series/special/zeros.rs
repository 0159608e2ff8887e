//! The zeros of J_0.

use std::f64::consts::PI;

/// A positive zero of J_0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct J0Zero {
    /// α with J_0(α) = 0, to the last digit or two.
    pub alpha: f64,
    /// J_1(α), which is −J_0'(α).
    pub j1: f64,
}

/// The first `count` positive zeros of J_0, in order.
///
/// McMahon's expansion (DLMF 10.21.19) is within 2e-3 from the first zero on; three steps of Newton's method, with
/// J_0' = −J_1, then leave rounding alone.
pub fn j0_zeros(count: u32) -> Vec<J0Zero> {
    (1..=count).map(zero).collect()
}

fn zero(k: u32) -> J0Zero {
    let beta = (f64::from(k) - 0.25) * PI;
    let e = 1.0 / (8.0 * beta);
    let mut alpha = beta + e * (1.0 - e * e * (124.0 / 3.0 - e * e * (120_928.0 / 15.0)));
    for _ in 0..3 {
        alpha += libm::j0(alpha) / libm::j1(alpha);
    }
    J0Zero { alpha, j1: libm::j1(alpha) }
}
