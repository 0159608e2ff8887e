//! Sums of waves over very many points, by the moments of cells: a non-uniform Fourier transform of type 1 whose error
//! has a bound in closed form.
//!
//! Wanted are Σ_k w_k e^{2πi n x_k} e^{2πi m y_k}, places in turns. A turn is cut into cells; a point that lies u, between
//! −1 and 1, from the centre c of its cell of half width h has the wave
//!
//! ```text
//! e^{2πi n (c + hu)} = e^{2πi n c} Σ_j (2 − δ_j0) i^j J_j(z) T_j(u),     z = 2πnh
//! ```
//!
//! (Jacobi and Anger, DLMF 10.12.2 with u = cos θ). So a point adds w T_i(u) T_j(v) to the moments of its cell, which has
//! nothing to do with n and m; only the moments meet the waves. What is left out from order p on is, since
//! |J_j(z)| ≤ (z/2)^j / j! (DLMF 10.14.4), at most
//!
//! ```text
//! 2 Σ_{j≥p} |J_j(z)| ≤ 2 (z/2)^p / p! / (1 − z / (2p + 2))
//! ```
//!
//! for this harmonic and all lower ones. All is in f64.

mod collect;
mod grid;
mod sizes;
mod spread;

use std::f64::consts::PI;

pub use grid::Grid;
pub use sizes::{Sizes, sizes_within};

/// A place in turns, in the period [0, 1) along each axis, and a weight for each colour.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Point {
    /// The place.
    pub turns: [f64; 2],
    /// The weight.
    pub weight: [f64; 3],
}

/// How a period is cut, and how many moments a cell has, along x and y.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
pub struct Cells {
    /// Cells a period, 1 or more.
    pub counts: [u32; 2],
    /// Moments a cell: Chebyshev polynomials T_0 to T_order−1.
    pub orders: [u32; 2],
}

/// Σ w over cos cos, cos sin, sin cos and sin sin of the points' phases, for each colour.
pub type Sums = [[f64; 4]; 3];

impl Cells {
    /// The sums of modes n = 0 ..= N and m = 0 ..= M over `count` points, n running fastest. The same for any number of
    /// threads.
    pub fn sums(&self, count: usize, point: impl Fn(usize) -> Point + Sync, degree: [u32; 2]) -> Vec<Sums> {
        spread::spread(self, &collect::collect(self, count, point), degree)
    }

    /// A bound of what any product of two waves up to a degree is off by, for a point of weight 1.
    pub fn error(&self, degree: [u32; 2]) -> f64 {
        let [x, y] = [0, 1].map(|axis| truncation(self.orders[axis], argument(degree[axis], self.counts[axis])));
        x + y + x * y
    }
}

/// The fewest moments along an axis that leave no more than `error` of any wave up to a harmonic.
pub fn order_within(harmonic: u32, count: u32, error: f64) -> u32 {
    let z = argument(harmonic, count);
    // Below z/2 − 1 there is no bound.
    let first = (0.5 * z) as u32 + 1;
    (first..).find(|&order| truncation(order, z) <= error).unwrap_or(u32::MAX)
}

/// z = 2πnh, where 2h is one over the number of cells.
fn argument(harmonic: u32, count: u32) -> f64 {
    PI * f64::from(harmonic) / f64::from(count)
}

/// A bound of 2 Σ_{j≥p} |J_j(z')| for every z' from 0 to z; infinite where there is none.
fn truncation(order: u32, z: f64) -> f64 {
    let ratio = 0.5 * z / (f64::from(order) + 1.0);
    if ratio >= 1.0 {
        return f64::INFINITY;
    }
    let term: f64 = (1..=order).map(|j| 0.5 * z / f64::from(j)).product();
    2.0 * term / (1.0 - ratio)
}
