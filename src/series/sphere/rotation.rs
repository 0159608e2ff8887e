//! Turned functions: each band is multiplied by a matrix of its own.

use glam::{DMat3, DQuat};
use rayon::prelude::*;

use super::Coefficients;

/// The turn that tips by `roll`, then by `pitch`, then by `yaw`, all in radians.
///
/// For the picture of [`super::Grid`]: `yaw` turns about z, from x to y, so that what is ahead moves left; `pitch` lifts
/// what is ahead (from x to z); `roll` turns about x, clockwise for who looks along it (from y to z).
pub fn turn(yaw: f64, pitch: f64, roll: f64) -> DQuat {
    DQuat::from_rotation_z(yaw) * DQuat::from_rotation_y(-pitch) * DQuat::from_rotation_x(roll)
}

/// The matrix M of band l of a turn R: Y_l(Rv) = M Y_l(v), and the coefficients of f(R⁻¹v) are M times those of f(v).
#[derive(Debug, Clone)]
pub struct Band {
    l: usize,
    /// (2l + 1)² entries, row by row.
    values: Vec<f64>,
}

impl Band {
    /// The band's degree.
    pub fn l(&self) -> usize {
        self.l
    }

    /// The entry of row m and column n, both from −l to l.
    pub fn at(&self, m: isize, n: isize) -> f64 {
        self.row(m)[(n + self.l as isize) as usize]
    }

    /// Row m: columns −l to l.
    fn row(&self, m: isize) -> &[f64] {
        let columns = 2 * self.l + 1;
        &self.values[(m + self.l as isize) as usize * columns..][..columns]
    }

    /// M times the coefficients of the band.
    fn apply(&self, band: &[[f64; 3]], out: &mut [[f64; 3]]) {
        for (row, out) in self.values.chunks_exact(2 * self.l + 1).zip(out) {
            *out = row.iter().zip(band).fold([0.0; 3], |sum, (m, c)| [0, 1, 2].map(|i| sum[i] + m * c[i]));
        }
    }
}

/// Hands the matrices of bands 0 ..= degree of a turn to `take`, one after the other; `rotation` need not be of unit
/// length. O(degree³) time, O(degree²) memory.
///
/// The recursion of Ivanic and Ruedenberg, "Rotation matrices for real spherical harmonics: direct determination by
/// recursion", Journal of Physical Chemistry 100, 1996, with the corrections of 102, 1998, p. 9099. Rounding grows with
/// the band: 3e-15 at l = 20 and 2e-12 at l = 50 are the worst that was seen, 1e-7 at l = 100, and at l = 200
/// nothing is right. See [`RECURSION_LIMIT`].
pub fn each_band(rotation: DQuat, degree: usize, mut take: impl FnMut(&Band)) {
    take(&Band { l: 0, values: vec![1.0] });
    let turn = DMat3::from_quat(rotation.normalize());
    // Y_1,−1, Y_10, Y_11 are y, z, x.
    let axes = [1, 2, 0];
    let first: Vec<f64> = axes.iter().flat_map(|&row| axes.map(|column| turn.col(column)[row])).collect();
    let first = Band { l: 1, values: first };
    let mut band = first.clone();
    for l in 1..=degree {
        if l > 1 {
            band = next(&first, &band);
        }
        take(&band);
    }
}

/// The band above.
fn next(first: &Band, below: &Band) -> Band {
    let l = below.l + 1;
    let columns = 2 * l + 1;
    let mut values = vec![0.0; columns * columns];
    values.par_chunks_exact_mut(columns).with_min_len(16).enumerate().for_each(|(row, values)| {
        for (i, a, factor) in terms(l, row as isize - l as isize) {
            let [minus, zero, plus] = [-1, 0, 1].map(|n| factor * first.at(i, n));
            let below = below.row(a);
            let (left, right) = (below[0], below[below.len() - 1]);
            values[0] += plus * left + minus * right;
            values[columns - 1] += plus * right - minus * left;
            for (value, below) in values[1..columns - 1].iter_mut().zip(below) {
                *value += zero * below;
            }
        }
        for (column, value) in values.iter_mut().enumerate() {
            // (l + n) (l − n), and 2l (2l − 1) at both ends.
            let inner = (column * (columns - 1 - column)) as f64;
            *value /= if inner == 0.0 { (2 * l * (2 * l - 1)) as f64 } else { inner }.sqrt();
        }
    });
    Band { l, values }
}

/// What row m of band l is made of: (i, a, factor) for each P(i, a), u U + v V + w W in the paper's letters with the
/// column's share of u, v, w left out. Terms that are nothing are left out, because their rows may not exist.
fn terms(l: usize, m: isize) -> impl Iterator<Item = (isize, isize, f64)> {
    let (above, below) = (l as f64 + m.unsigned_abs() as f64, l as f64 - m.unsigned_abs() as f64);
    let u = (above * below).sqrt();
    let v = 0.5 * ((above - 1.0) * above).sqrt();
    let w = if m == 0 { 0.0 } else { -0.5 * ((below - 1.0) * below).max(0.0).sqrt() };
    let edge = 2f64.sqrt();
    let [first, second] = match m {
        0 => [(1, 1, -edge * v), (-1, -1, -edge * v)],
        1 => [(1, 0, edge * v), (-1, 0, 0.0)],
        -1 => [(1, 0, 0.0), (-1, 0, edge * v)],
        2.. => [(1, m - 1, v), (-1, 1 - m, -v)],
        _ => [(1, m + 1, v), (-1, -m - 1, v)],
    };
    let [third, fourth] = if m > 0 { [(1, m + 1, w), (-1, -m - 1, w)] } else { [(1, m - 1, w), (-1, 1 - m, -w)] };
    [(0, m, u), first, second, third, fourth].into_iter().filter(|&(_, _, factor)| factor != 0.0)
}

/// The highest degree that [`Coefficients::rotated`] leaves to [`each_band`], whose rounding grows.
pub const RECURSION_LIMIT: usize = 32;

impl Coefficients {
    /// The coefficients of f(R⁻¹v): what f shows at v, this shows at Rv. `rotation` need not be of unit length.
    pub fn rotated(&self, rotation: DQuat) -> Self {
        if self.degree <= RECURSION_LIMIT {
            self.rotated_by_matrices(rotation)
        } else {
            self.rotated_by_angles(rotation)
        }
    }

    /// [`Coefficients::rotated`] by the matrices of [`each_band`].
    pub fn rotated_by_matrices(&self, rotation: DQuat) -> Self {
        let mut result = Self::zero(self.degree);
        each_band(rotation, self.degree, |band| {
            let places = band.l * band.l..(band.l + 1) * (band.l + 1);
            band.apply(&self.values[places.clone()], &mut result.values[places]);
        });
        result
    }
}
