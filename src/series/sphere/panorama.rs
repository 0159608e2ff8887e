//! Equirectangular pictures to coefficients and back, in O(W H L + H L²).

use std::f64::consts::{PI, SQRT_2, TAU};

use glam::DVec3;
use rayon::prelude::*;

use super::quadrature::nodes_for;
use super::{Basis, Coefficients, fejer, gauss_legendre, index};

/// An equirectangular picture's pixels: rows are even steps of θ from the zenith down, columns even steps of φ.
///
/// The centre of the picture looks along +x, its left half to +y, its top to +z: φ falls from π at the left edge to −π
/// at the right one, as seen from inside. (The convention of OpenEXR's latitude-longitude environment maps, whose axes
/// z, x, y are these x, y, z.)
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Grid {
    /// Columns, at least 1.
    pub width: usize,
    /// Rows, at least 1.
    pub height: usize,
}

/// What a pixel's value says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Reading {
    /// The radiance is this all over the pixel. Harmonics are integrated over each pixel, to some 1e-15, so that the
    /// coefficients are those of a function that jumps at the edges of pixels.
    Areas,
    /// The radiance is this at the pixel's centre, of a smooth function; weights by Fejér. Exact where that function is
    /// a sum of harmonics up to H' with H' + degree < H rows, and W ≥ 2H: [`Coefficients::to_panorama`] undone.
    Samples,
}

impl Grid {
    /// The unit vector at a column and row, which may be fractional; whole ones are centres of pixels.
    pub fn direction(self, column: f64, row: f64) -> DVec3 {
        let (sin, cos) = self.theta(row).sin_cos();
        let (sin_phi, cos_phi) = (PI - TAU * (column + 0.5) / self.width as f64).sin_cos();
        DVec3::new(sin * cos_phi, sin * sin_phi, cos)
    }

    /// The column and row of the pixel that holds a direction.
    pub fn pixel(self, direction: DVec3) -> (usize, usize) {
        let (column, row) = self.place(direction);
        // Casts of floats stop at 0; the right edge is the left one.
        (column as usize % self.width, (row as usize).min(self.height - 1))
    }

    /// The picture at a direction, interpolated between the centres of the four pixels around it in φ and θ; across a
    /// pole stand the pixels half way round.
    pub fn interpolate(self, direction: DVec3, pixel: impl Fn(usize, usize) -> [f64; 3]) -> [f64; 3] {
        let (width, height) = (self.width, self.height);
        let (column, row) = self.place(direction);
        let (column, row) = (column - 0.5 + width as f64, row - 0.5);
        let (left, above) = (column.floor(), row.floor());
        let at = |right: usize, down: usize| {
            let (column, row) = (left as usize + right, above as isize + down as isize);
            match row {
                0.. if (row as usize) < height => pixel(column % width, row as usize),
                _ => pixel((column + width / 2) % width, if row < 0 { 0 } else { height - 1 }),
            }
        };
        let mix = |a: [f64; 3], b: [f64; 3], share: f64| [0, 1, 2].map(|i| a[i] + share * (b[i] - a[i]));
        let [upper, lower] = [0, 1].map(|down| mix(at(0, down), at(1, down), column - left));
        mix(upper, lower, row - above)
    }

    /// A direction's column and row, counted from the picture's edges: 0 to W and 0 to H.
    fn place(self, direction: DVec3) -> (f64, f64) {
        let turns = 0.5 - direction.y.atan2(direction.x) / TAU;
        let theta = direction.truncate().length().atan2(direction.z);
        (turns * self.width as f64, theta / PI * self.height as f64)
    }

    /// The angle from the zenith, at a row that may be fractional.
    pub(super) fn theta(self, row: f64) -> f64 {
        PI * (row + 0.5) / self.height as f64
    }

    /// The solid angle of a pixel in `row`: the difference of cos θ between its edges, times 2π / W.
    pub fn solid_angle(self, row: usize) -> f64 {
        let theta = self.theta(row as f64);
        TAU / self.width as f64 * 2.0 * theta.sin() * (PI / (2 * self.height) as f64).sin()
    }

    /// ∫ over the sphere of a function that is constant in each pixel, from its sum along each row.
    pub fn integrate(self, row_sum: impl Fn(usize) -> f64 + Sync) -> f64 {
        let rows: Vec<f64> = (0..self.height).into_par_iter().map(|row| self.solid_angle(row) * row_sum(row)).collect();
        rows.iter().sum()
    }
}

/// Rows that are done together, a vector register's worth or two.
const ROWS: usize = 8;

type Lanes = [f64; ROWS];

/// For one m: the sums of RGB times cos mφ, then of RGB times sin mφ, along each row.
type Moments = [Lanes; 6];

/// c_lm for l ≤ degree of a picture, whose row k `read` copies into a slice of W pixels.
///
/// Along each row a Fourier sum, then for each m the recurrence in l over all rows at once. The same bits on every run.
pub fn project_panorama(
    grid: Grid,
    degree: usize,
    reading: Reading,
    read: impl Fn(usize, &mut [[f64; 3]]) + Sync,
) -> Coefficients {
    let basis = Basis::new(degree);
    let moments = moments(grid, degree, reading, read);
    let rings = rings(grid, degree, reading);
    let columns: Vec<Vec<[f64; 6]>> =
        (0..=degree).into_par_iter().map(|m| column(&basis, m, &rings, &moments)).collect();
    let mut result = Coefficients::zero(degree);
    for (m, column) in columns.iter().enumerate() {
        for (l, &[r, g, b, sine_r, sine_g, sine_b]) in (m..).zip(column) {
            result.values_mut()[index(l, m as isize)] = [r, g, b];
            if m > 0 {
                result.values_mut()[index(l, -(m as isize))] = [sine_r, sine_g, sine_b];
            }
        }
    }
    result
}

/// For each block of rows, for each m ≤ degree.
fn moments(
    grid: Grid,
    degree: usize,
    reading: Reading,
    read: impl Fn(usize, &mut [[f64; 3]]) + Sync,
) -> Vec<Vec<Moments>> {
    let circle = Circle::new(grid.width);
    let block = |block: usize| {
        let mut pixels = vec![[0.0; 3]; grid.width];
        let mut planes = vec![0.0; 3 * ROWS * grid.width];
        let first = block * ROWS;
        for (row, planes) in (first..grid.height.min(first + ROWS)).zip(planes.chunks_exact_mut(3 * grid.width)) {
            read(row, &mut pixels);
            for (colour, plane) in planes.chunks_exact_mut(grid.width).enumerate() {
                plane.iter_mut().zip(&pixels).for_each(|(value, pixel)| *value = pixel[colour]);
            }
        }
        let (mut cos, mut sin) = (vec![0.0; grid.width], vec![0.0; grid.width]);
        let one = |m: usize| {
            circle.fill(m, &mut cos, &mut sin);
            let width = pixel_width(grid, reading, m);
            let mut moments = [[0.0; ROWS]; 6];
            for (k, plane) in planes.chunks_exact(grid.width).enumerate() {
                moments[k % 3][k / 3] = width * dot(plane, &cos);
                moments[3 + k % 3][k / 3] = width * dot(plane, &sin);
            }
            moments
        };
        (0..=degree).map(one).collect()
    };
    (0..grid.height.div_ceil(ROWS)).into_par_iter().map(block).collect()
}

/// A pixel's width in φ, for areas times the mean of cos mφ over it relative to that at its centre.
fn pixel_width(grid: Grid, reading: Reading, m: usize) -> f64 {
    match (reading, m) {
        (Reading::Samples, _) | (_, 0) => TAU / grid.width as f64,
        (Reading::Areas, m) => 2.0 / m as f64 * (PI * m as f64 / grid.width as f64).sin(),
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    let (a, a_rest) = a.as_chunks::<8>();
    let (b, b_rest) = b.as_chunks::<8>();
    let mut sums = [0.0; 8];
    for (a, b) in a.iter().zip(b) {
        for k in 0..8 {
            sums[k] += a[k] * b[k];
        }
    }
    sum(sums) + a_rest.iter().zip(b_rest).map(|(a, b)| a * b).sum::<f64>()
}

fn sum([a, b, c, d, e, f, g, h]: [f64; 8]) -> f64 {
    ((a + e) + (c + g)) + ((b + f) + (d + h))
}

/// One place in θ for each row of a block, and its weight.
struct Ring {
    cos: Lanes,
    sin: Lanes,
    weight: Lanes,
}

/// For each block of rows, the places in θ that stand for them.
fn rings(grid: Grid, degree: usize, reading: Reading) -> Vec<Vec<Ring>> {
    let step = PI / grid.height as f64;
    // Offsets from the row's centre, in rows, and weights.
    let places = match reading {
        // The integrand's highest frequency is degree + 1, because of sin θ.
        Reading::Areas => gauss_legendre(nodes_for(0.5 * step * (degree + 1) as f64, 1e-15)),
        Reading::Samples => vec![(0.0, 2.0)],
    };
    let fejer = if reading == Reading::Samples { fejer(grid.height) } else { Vec::new() };
    let ring = |block: usize, offset: f64, weight: f64| {
        let mut ring = Ring { cos: [0.0; ROWS], sin: [0.0; ROWS], weight: [0.0; ROWS] };
        // Lanes beyond the last row keep the weight 0.
        for lane in 0..ROWS.min(grid.height - block * ROWS) {
            let row = block * ROWS + lane;
            (ring.sin[lane], ring.cos[lane]) = grid.theta(row as f64 + 0.5 * offset).sin_cos();
            ring.weight[lane] = match reading {
                Reading::Areas => 0.5 * step * weight * ring.sin[lane],
                Reading::Samples => fejer[row],
            };
        }
        ring
    };
    let block = |block| places.iter().map(|&(offset, weight)| ring(block, offset, weight)).collect();
    (0..grid.height.div_ceil(ROWS)).map(block).collect()
}

/// c_lm and c_l,−m for one m and l = m ..= degree: Σ over all rows.
fn column(basis: &Basis, m: usize, rings: &[Vec<Ring>], moments: &[Vec<Moments>]) -> Vec<[f64; 6]> {
    let (seed, steps) = basis.column(m);
    let seed = if m > 0 { SQRT_2 * seed } else { seed };
    let mut sums = vec![[0.0; 6]; steps.len() + 1];
    for (rings, moments) in rings.iter().zip(moments) {
        // The recurrence is linear, so that it may carry the weight along.
        let start = |ring: &Ring| Legendre::start(seed, m, &ring.sin, &ring.cos, &ring.weight);
        let mut states: Vec<Legendre> = rings.iter().map(start).collect();
        for (l, sums) in sums.iter_mut().enumerate() {
            if l > 0 {
                states.iter_mut().for_each(|state| state.step(steps[l - 1]));
            }
            let mut total = [0.0; ROWS];
            for state in &states {
                total.iter_mut().zip(&state.value).for_each(|(total, value)| *total += value);
            }
            for (part, moments) in sums.iter_mut().zip(&moments[m]) {
                *part += sum(std::array::from_fn(|lane| total[lane] * moments[lane]));
            }
        }
    }
    sums
}

/// The recurrence of P̄_lm in l, for some rows at once.
struct Legendre {
    cos: Lanes,
    before: Lanes,
    value: Lanes,
}

impl Legendre {
    fn start(seed: f64, m: usize, sin: &Lanes, cos: &Lanes, weight: &Lanes) -> Self {
        let value = std::array::from_fn(|lane| weight[lane] * seed * sin[lane].powi(m as i32));
        Self { cos: *cos, before: [0.0; ROWS], value }
    }

    fn step(&mut self, [a, b]: [f64; 2]) {
        for lane in 0..ROWS {
            let next = a * self.cos[lane] * self.value[lane] - b * self.before[lane];
            self.before[lane] = self.value[lane];
            self.value[lane] = next;
        }
    }
}

impl Coefficients {
    /// The function at the centre of each pixel, row by row from the top, each value made a pixel by `pixel`.
    pub fn to_panorama<T: Copy + Default + Send>(&self, grid: Grid, pixel: impl Fn([f64; 3]) -> T + Sync) -> Vec<T> {
        let (basis, circle) = (Basis::new(self.degree), Circle::new(grid.width));
        let mut result = vec![T::default(); grid.width * grid.height];
        result.par_chunks_mut(ROWS * grid.width).enumerate().for_each(|(block, result)| {
            let (mut cos, mut sin) = (vec![0.0; grid.width], vec![0.0; grid.width]);
            let mut planes = vec![0.0; 3 * ROWS * grid.width];
            let angles: [_; ROWS] = std::array::from_fn(|lane| grid.theta((block * ROWS + lane) as f64).sin_cos());
            for m in 0..=self.degree {
                circle.fill(m, &mut cos, &mut sin);
                let waves = self.waves(&basis, m, &angles);
                for (k, plane) in planes.chunks_exact_mut(grid.width).enumerate() {
                    let (a, b) = (waves[k % 3][k / 3], waves[3 + k % 3][k / 3]);
                    for ((value, cos), sin) in plane.iter_mut().zip(&cos).zip(&sin) {
                        *value += a * cos + b * sin;
                    }
                }
            }
            for (row, planes) in result.chunks_exact_mut(grid.width).zip(planes.chunks_exact(3 * grid.width)) {
                for (i, result) in row.iter_mut().enumerate() {
                    *result = pixel([0, 1, 2].map(|colour| planes[colour * grid.width + i]));
                }
            }
        });
        result
    }

    /// What cos mφ and sin mφ are multiplied by in some rows.
    fn waves(&self, basis: &Basis, m: usize, angles: &[(f64, f64); ROWS]) -> Moments {
        let (seed, steps) = basis.column(m);
        let seed = if m > 0 { SQRT_2 * seed } else { seed };
        let mut legendre = Legendre::start(seed, m, &angles.map(|(s, _)| s), &angles.map(|(_, c)| c), &[1.0; ROWS]);
        let mut waves = [[0.0; ROWS]; 6];
        for l in m..=self.degree {
            if l > m {
                legendre.step(steps[l - m - 1]);
            }
            let [cosine, sine] = [m as isize, -(m as isize)].map(|m| self.values[index(l, m)]);
            for (waves, share) in waves.chunks_exact_mut(3).zip([cosine, if m > 0 { sine } else { [0.0; 3] }]) {
                for (wave, share) in waves.iter_mut().zip(share) {
                    wave.iter_mut().zip(&legendre.value).for_each(|(wave, value)| *wave += share * value);
                }
            }
        }
        waves
    }
}

/// cos mφ and sin mφ at the centres of columns, from a table of half steps: m times the angle wraps in integers.
struct Circle {
    width: usize,
    table: Vec<(f64, f64)>,
}

impl Circle {
    fn new(width: usize) -> Self {
        let half = PI / width as f64;
        Self { width, table: (0..2 * width).map(|k| (k as f64 * half).sin_cos()).collect() }
    }

    fn fill(&self, m: usize, cos: &mut [f64], sin: &mut [f64]) {
        let period = 2 * self.width;
        // φ is W − 1 half steps in the first column, and two fewer in each that follows.
        let mut k = (m * (self.width - 1)) % period;
        let step = period - (2 * m) % period;
        for (cos, sin) in cos.iter_mut().zip(sin) {
            (*sin, *cos) = self.table[k];
            k += step;
            if k >= period {
                k -= period;
            }
        }
    }
}
