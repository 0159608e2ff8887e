//! The field by definition, in f64: every term by its own sine and cosine, no recurrence, no table.

use std::f64::consts::TAU;

use glam::DVec2;
use rayon::prelude::*;

use crate::scene::Ghost;
use crate::series::kappa;

/// The sum of the bells at a point.
pub fn direct(ghosts: &[Ghost], at: DVec2) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for ghost in ghosts {
        let value = ghost.bell.shape().value((at - ghost.center) / ghost.size);
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
        let shape = ghost.bell.shape();
        let (turns, size) = ((at - ghost.center) / period, ghost.size / period);
        for (n, &count) in (0..).zip(counts) {
            let x = shape.coefficient(n, size.x) * (TAU * f64::from(n) * turns.x).cos();
            for m in 0..count {
                let y = shape.coefficient(m, size.y) * (TAU * f64::from(m) * turns.y).cos();
                for (sum, radiance) in sum.iter_mut().zip(ghost.radiance) {
                    *sum += radiance * kappa(n, m) * x * y;
                }
            }
        }
    }
    sum
}
