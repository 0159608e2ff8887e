//! Coefficients of turned pictures without any rotation matrix, to hold [`Coefficients::rotated`] against.

use std::f64::consts::PI;

use glam::{DQuat, DVec3};
use rayon::prelude::*;

use super::quadrature::nodes_for;
use super::{Basis, Coefficients, Grid, Reading, gauss_legendre, project_panorama};

/// c_lm of f(R⁻¹v), where f is constant in each pixel of a picture: each pixel is carried to its turned place.
///
/// The integral of f(R⁻¹v) Y_lm(v) over v is that of f(u) Y_lm(Ru) over u = R⁻¹v, because a turn keeps solid angles. So
/// Y_lm(Ru) is integrated over each pixel, by enough Gauss–Legendre nodes for some 1e-13. Nothing is interpolated. About
/// W H (degree + 1)² times the nodes in a pixel, some 9 at low degrees.
pub fn project_turned(
    grid: Grid,
    degree: usize,
    rotation: DQuat,
    read: impl Fn(usize, &mut [[f64; 3]]) + Sync,
) -> Coefficients {
    let (rotation, basis) = (rotation.normalize(), Basis::new(degree));
    let step = PI / grid.height as f64;
    let along = |side: f64| gauss_legendre(nodes_for(0.5 * side * (degree + 1) as f64, 1e-13));
    let (rows, columns) = (along(step), along(2.0 * PI / grid.width as f64));
    // A few bands of rows, each with its own sums: memory is (degree + 1)² for each.
    let band = grid.height.div_ceil(16);
    let parts = (0..grid.height).into_par_iter().step_by(band).map(|first| {
        let mut part = Coefficients::zero(degree);
        let mut pixels = vec![[0.0; 3]; grid.width];
        let (mut harmonics, mut mean) = (vec![0.0; (degree + 1).pow(2)], vec![0.0; (degree + 1).pow(2)]);
        for row in first..grid.height.min(first + band) {
            read(row, &mut pixels);
            for (column, &pixel) in pixels.iter().enumerate() {
                mean.fill(0.0);
                for &(down, weight) in &rows {
                    let row = row as f64 + 0.5 * down;
                    let weight = weight * 0.5 * step * grid.theta(row).sin();
                    for &(right, share) in &columns {
                        let direction = rotation * grid.direction(column as f64 + 0.5 * right, row);
                        basis.fill(direction, &mut harmonics);
                        let weight = weight * share * PI / grid.width as f64;
                        mean.iter_mut().zip(&harmonics).for_each(|(sum, y)| *sum += weight * y);
                    }
                }
                part.add(&mean, pixel);
            }
        }
        part
    });
    Coefficients::total(degree, parts.collect())
}

/// c_lm of any function, from its values at the centres of a grid's pixels: exact where it is a sum of harmonics up to
/// H' with H' + degree < H rows and W ≥ 2H, and off by about a pixel's side squared where it has kinks.
pub fn project_samples(grid: Grid, degree: usize, f: impl Fn(DVec3) -> [f64; 3] + Sync) -> Coefficients {
    let equator: Vec<DVec3> =
        (0..grid.width).map(|k| grid.direction(k as f64, 0.5 * grid.height as f64 - 0.5)).collect();
    project_panorama(grid, degree, Reading::Samples, |row, pixels| {
        let (sin, cos) = grid.theta(row as f64).sin_cos();
        for (out, ahead) in pixels.iter_mut().zip(&equator) {
            *out = f(DVec3::new(sin * ahead.x, sin * ahead.y, cos));
        }
    })
}
