//! The field by definition, in f64: every term by its own sine and cosine, no recurrence, no table.

use std::f64::consts::TAU;

use glam::DVec2;
use rayon::prelude::*;

use crate::scene::Ghost;

/// The sum of the bells at a point.
pub fn direct(ghosts: &[Ghost], at: DVec2) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for ghost in ghosts {
        let value = ghost.bell.shape().value(at - ghost.center, ghost.size);
        for (sum, radiance) in sum.iter_mut().zip(ghost.radiance) {
            *sum += radiance * value;
        }
    }
    sum
}

/// [`direct`] at many points, on all cores.
pub fn direct_at(ghosts: &[Ghost], points: &[DVec2]) -> Vec<[f64; 3]> {
    points.par_iter().map(|&at| direct(ghosts, at)).collect()
}

/// The series of the periodised bells at a point: harmonic n of x with harmonics 0 .. `counts[n]` of y.
pub fn series(ghosts: &[Ghost], period: DVec2, counts: &[u32], at: DVec2) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for ghost in ghosts {
        let turns = (at - ghost.center) / period;
        let mut coefficients = ghost.bell.shape().modes().table(counts, ghost.size / period).into_iter();
        for (n, &count) in (0..).zip(counts) {
            let (s_n, c_n) = (TAU * f64::from(n) * turns.x).sin_cos();
            for ([a, b, p, r], m) in coefficients.by_ref().take(count as usize).zip(0..) {
                let (s_m, c_m) = (TAU * f64::from(m) * turns.y).sin_cos();
                let value = a * c_n * c_m + b * s_n * s_m + p * c_n * s_m + r * s_n * c_m;
                for (sum, radiance) in sum.iter_mut().zip(ghost.radiance) {
                    *sum += radiance * value;
                }
            }
        }
    }
    sum
}
