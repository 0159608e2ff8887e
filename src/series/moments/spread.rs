//! From moments to sums: along x for each row of cells, then along y.

use std::f64::consts::TAU;

use rayon::prelude::*;

use super::collect::{LANES, Lanes, Moments, row_lanes};
use super::{Cells, Sums, argument};
use crate::series::special::bessel_j_all;

/// The waves of an axis, seen from its cells.
struct Axis {
    /// (2 − δ_j0) J_j(z_n) with the sign of i^j or of i^(j−1), harmonic by harmonic: real where j is even, else imaginary.
    factors: Vec<Vec<f64>>,
    /// cos and sin of k/2C turns, k = 0 .. 2C; the centre of cell c is at (2c + 1)/2C.
    turns: Vec<[f64; 2]>,
}

impl Axis {
    fn new(cells: &Cells, axis: usize, degree: u32) -> Self {
        let (count, order) = (cells.counts[axis], cells.orders[axis]);
        let factors = |n: u32| {
            let sign = |j: usize| if j % 4 < 2 { 1.0 } else { -1.0 };
            let doubled = |j: usize| if j == 0 { 1.0 } else { 2.0 };
            let bessel = bessel_j_all(argument(n, count), order - 1).into_iter().enumerate();
            bessel.map(|(j, value)| doubled(j) * sign(j) * value).collect()
        };
        let turn = |k: u32| {
            let (sin, cos) = (TAU * f64::from(k) / f64::from(2 * count)).sin_cos();
            [cos, sin]
        };
        Self { factors: (0..=degree).map(factors).collect(), turns: (0..2 * count).map(turn).collect() }
    }

    /// The wave of harmonic n at the centre of a cell.
    fn wave(&self, n: usize, cell: u32) -> [f64; 2] {
        let place = n as u64 * u64::from(2 * cell + 1) % self.turns.len() as u64;
        self.turns[place as usize]
    }
}

/// For each harmonic of x the moments along y of a row of cells: times the cosine, and times the sine.
struct Row {
    cell: u32,
    waves: Vec<[Vec<Lanes>; 2]>,
}

pub(super) fn spread(cells: &Cells, moments: &[Moments], degree: [u32; 2]) -> Vec<Sums> {
    let [x, y] = [0, 1].map(|axis| Axis::new(cells, axis, degree[axis]));
    let rows: Vec<&[Moments]> = moments.chunk_by(|a, b| a.cell[1] == b.cell[1]).collect();
    let rows: Vec<Row> = rows.par_iter().map(|row| along_x(&x, row_lanes(cells), row)).collect();
    let columns: Vec<Vec<Sums>> =
        (0..=degree[0] as usize).into_par_iter().map(|n| along_y(&y, cells.orders[1] as usize, n, &rows)).collect();
    (0..=degree[1] as usize).flat_map(|m| columns.iter().map(move |column| column[m])).collect()
}

fn along_x(axis: &Axis, lanes: usize, row: &[Moments]) -> Row {
    let mut waves = vec![[vec![[0.0; LANES]; lanes], vec![[0.0; LANES]; lanes]]; axis.factors.len()];
    let mut parts = [vec![[0.0; LANES]; lanes], vec![[0.0; LANES]; lanes]];
    for moments in row {
        for (n, [cosines, sines]) in waves.iter_mut().enumerate() {
            let [cos, sin] = axis.wave(n, moments.cell[0]);
            parts.iter_mut().for_each(|part| part.fill([0.0; LANES]));
            for (i, (&factor, row)) in axis.factors[n].iter().zip(moments.rows.chunks_exact(lanes)).enumerate() {
                add(factor, row, &mut parts[i % 2]);
            }
            let [real, imaginary] = &parts;
            add(cos, real, cosines);
            add(-sin, imaginary, cosines);
            add(sin, real, sines);
            add(cos, imaginary, sines);
        }
    }
    Row { cell: row[0].cell[1], waves }
}

fn add(factor: f64, row: &[Lanes], to: &mut [Lanes]) {
    for (to, from) in to.iter_mut().zip(row) {
        for lane in 0..LANES {
            to[lane] += factor * from[lane];
        }
    }
}

/// The sums of harmonic n of x with each of y.
fn along_y(axis: &Axis, order: usize, n: usize, rows: &[Row]) -> Vec<Sums> {
    let mut sums = vec![Sums::default(); axis.factors.len()];
    for row in rows {
        for (m, sum) in sums.iter_mut().enumerate() {
            let [cos, sin] = axis.wave(m, row.cell);
            for (part, moments) in row.waves[n].iter().enumerate() {
                for (colour, moments) in moments.as_flattened().chunks_exact(order).take(3).enumerate() {
                    let (mut real, mut imaginary) = (0.0, 0.0);
                    for (pair, factors) in moments.chunks(2).zip(axis.factors[m].chunks(2)) {
                        real += factors[0] * pair[0];
                        if let ([_, odd], [_, factor]) = (pair, factors) {
                            imaginary += factor * odd;
                        }
                    }
                    sum[colour][2 * part] += cos * real - sin * imaginary;
                    sum[colour][2 * part + 1] += sin * real + cos * imaginary;
                }
            }
        }
    }
    sums
}
