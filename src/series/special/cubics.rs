//! J_0 to J_M as piecewise cubics, for whoever needs them by the million.

use rayon::prelude::*;

use super::bessel_j_all;

/// J_m on the cells [i h, (i+1) h], i = 0 .. `cells`, as coefficients of 1, t, t², t³ with 0 ≤ t ≤ 1 along the cell and
/// h = `step`: cell after cell, and within each m = 0 ..= `highest`.
///
/// Hermite's cubics through J_m and J_m' = (J_{m−1} − J_{m+1})/2 (DLMF 10.6.1), computed in f64, so off by h⁴/384 at
/// most (no derivative of J_m exceeds 1) and by the rounding to f32: 4e-8 and 6e-8 for h = 1/16.
pub fn bessel_cubics(highest: u32, step: f64, cells: u32) -> Vec<[f32; 4]> {
    let nodes: Vec<Vec<f64>> =
        (0..=cells).into_par_iter().map(|node| bessel_j_all(f64::from(node) * step, highest + 1)).collect();
    let slope = |node: &[f64], m: usize| step * if m == 0 { -node[1] } else { 0.5 * (node[m - 1] - node[m + 1]) };
    let cubic = |pair: &[Vec<f64>], m: usize| {
        let (from, to) = (pair[0][m], pair[1][m]);
        let (out, into) = (slope(&pair[0], m), slope(&pair[1], m));
        let rise = to - from;
        [from, out, 3.0 * rise - 2.0 * out - into, out + into - 2.0 * rise].map(|coefficient| coefficient as f32)
    };
    nodes.windows(2).flat_map(|pair| (0..=highest as usize).map(move |m| cubic(pair, m))).collect()
}
