//! Points spread over a lattice by B-splines, and one transform of that: what takes less where there are many harmonics.
//!
//! With R nodes a turn and τ = R x, the splines β of order p about the points have the transform
//!
//! ```text
//! Σ_j β(τ − j) e^{−2πi n j/R} = β̂(2πn/R) e^{−2πi n x} (1 + ε),    |ε| ≤ Σ_{l≠0} |n / (n + lR)|^p
//! ```
//!
//! by which the waves are divided (Dutt and Rokhlin, "Fast Fourier transforms for nonequispaced data", 1993, with a B-spline in place of the
//! Gaussian).

use pulp::Arch;
use rayon::prelude::*;
use realfft::RealFftPlanner;
use rustfft::FftPlanner;
use rustfft::num_complex::Complex;

use super::Sums;
use crate::fast_length::fast_length;
use crate::series::special::bspline;
use crate::series::spline_gains;

/// Nodes that a B-spline reaches along an axis.
const ORDER: usize = 12;

/// Points that one task spreads.
const CHUNK: usize = 1 << 12;

/// Nodes along each side of a tile, whose points are spread one after the other: what their splines reach a core has at hand.
const TILE: usize = 16;

type Wave = Complex<f64>;

/// Nodes a period, along x and y; even.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
pub struct Grid {
    /// How many.
    pub nodes: [u32; 2],
}

/// A point's place in nodes: the first that its spline reaches, and what the spline is there and at those that follow.
struct Spread {
    first: [usize; 2],
    weights: [[f64; ORDER]; 2],
}

/// Points of neighbouring tiles, spread: rows from the first on, each wider than a turn, of one plane for each set and colour.
struct Band {
    first: usize,
    planes: Vec<Vec<f64>>,
}

impl Grid {
    /// The fewest nodes that leave no more than `error` of any wave up to these harmonics, on each axis.
    pub fn within(degree: [u32; 2], error: f64) -> Self {
        // n over R − n.
        let ratio = (error / TWO_AND_OTHERS).powf((ORDER as f64).recip()).min(0.5);
        let nodes = |degree: u32| {
            let nodes = f64::from(degree.max(1)) * (1.0 + ratio.recip());
            fast_length((nodes.ceil() as usize).max(2 * ORDER)) as u32
        };
        Self { nodes: degree.map(nodes) }
    }

    /// A bound of what any product of two waves up to a degree is off by, for a point of weight 1.
    pub fn error(&self, degree: [u32; 2]) -> f64 {
        let [x, y] = [0, 1].map(|axis| {
            let (harmonic, nodes) = (f64::from(degree[axis]), f64::from(self.nodes[axis]));
            TWO_AND_OTHERS * (harmonic / (nodes - harmonic)).powi(ORDER as i32)
        });
        x + y + x * y
    }

    /// Moments that a point has to do, as one of a cell does them; and multiply-adds of a transform.
    pub(crate) fn work(&self) -> [f64; 2] {
        let nodes: f64 = self.nodes.iter().map(|&nodes| f64::from(nodes)).product();
        [(ORDER * ORDER) as f64, 3.0 * nodes * nodes.log2()]
    }

    /// The sums of modes n = 0 ..= N and m = 0 ..= M over `count` points, n running fastest; for each of `sets` of weights, of which
    /// `turns` gives each place, 0 to 1, and `weight` those of a point in a set. The same for any number of threads.
    ///
    /// # Panics
    /// For harmonics of which there are more than half of the nodes.
    pub fn sums(
        &self,
        [count, sets]: [usize; 2],
        turns: impl Fn(usize) -> [f64; 2] + Sync,
        weight: impl Fn(usize, usize) -> [f64; 3] + Sync,
        degree: [u32; 2],
    ) -> Vec<Vec<Sums>> {
        assert!((0..2).all(|axis| 2 * degree[axis] < self.nodes[axis]), "more nodes than waves can be told apart on");
        let planes = self.spread([count, sets], turns, weight);
        planes.chunks_exact(3).map(|planes| self.transformed(planes, degree)).collect()
    }

    /// The sums of what is spread, of each colour.
    fn transformed(&self, planes: &[Vec<f64>], degree: [u32; 2]) -> Vec<Sums> {
        let gains = [0, 1].map(|axis| spline_gains(ORDER as u32, degree[axis], f64::from(self.nodes[axis]).recip()));
        let [columns, rows] = degree.map(|degree| degree as usize + 1);
        let mut sums = vec![Sums::default(); columns * rows];
        for (colour, plane) in planes.iter().enumerate() {
            let waves = self.waves(plane, columns);
            for (n, waves) in waves.iter().enumerate() {
                for m in 0..rows {
                    // At n and m, and at n and −m.
                    let (plus, minus) = (waves[m], waves[(waves.len() - m) % waves.len()]);
                    let (sum, difference) = (plus + minus, plus - minus);
                    let gain = 0.5 * gains[0][n] * gains[1][m];
                    sums[m * columns + n][colour] =
                        [sum.re, -difference.im, -sum.im, -difference.re].map(|part| gain * part);
                }
            }
        }
        sums
    }

    /// All points, of each set and colour, row by row of nodes.
    fn spread(
        &self,
        [count, sets]: [usize; 2],
        turns: impl Fn(usize) -> [f64; 2] + Sync,
        weight: impl Fn(usize, usize) -> [f64; 3] + Sync,
    ) -> Vec<Vec<f64>> {
        let [columns, rows] = self.nodes.map(|nodes| nodes as usize);
        let points: Vec<Spread> = (0..count).into_par_iter().map(|k| self.place(turns(k))).collect();
        let order = by_tiles(&points, [columns, rows]);
        let bands: Vec<Band> =
            order.par_chunks(CHUNK).map(|chunk| Band::new(&points, chunk, columns, sets, &weight)).collect();
        let mut planes = vec![vec![0.0; columns * rows]; 3 * sets];
        for band in bands {
            for (plane, wide) in planes.iter_mut().zip(&band.planes) {
                for (at, row) in wide.chunks_exact(columns + ORDER).enumerate() {
                    let to = &mut plane[(band.first + at) % rows * columns..][..columns];
                    to.iter_mut().zip(row).for_each(|(to, value)| *to += value);
                    to.iter_mut().zip(&row[columns..]).for_each(|(to, value)| *to += value);
                }
            }
        }
        planes
    }

    fn place(&self, turns: [f64; 2]) -> Spread {
        let axis = |axis: usize| {
            let nodes = self.nodes[axis] as usize;
            let place = turns[axis] * nodes as f64;
            let below = place.floor();
            ((below as usize + nodes - (ORDER / 2 - 1)) % nodes, bspline::<ORDER>(place - below))
        };
        let [(column, across), (row, down)] = [axis(0), axis(1)];
        Spread { first: [column, row], weights: [across, down] }
    }

    /// For each harmonic of x its waves with all frequencies of y.
    fn waves(&self, plane: &[f64], columns: usize) -> Vec<Vec<Wave>> {
        let [width, height] = self.nodes.map(|nodes| nodes as usize);
        let along = RealFftPlanner::<f64>::new().plan_fft_forward(width);
        let down = FftPlanner::<f64>::new().plan_fft_forward(height);
        let rows: Vec<Vec<Wave>> = plane
            .par_chunks_exact(width)
            .map_init(
                || (along.make_input_vec(), along.make_output_vec(), along.make_scratch_vec()),
                |(input, output, scratch), row| {
                    input.copy_from_slice(row);
                    along.process_with_scratch(input, output, scratch).expect("buffers of the planner's lengths");
                    output[..columns].to_vec()
                },
            )
            .collect();
        let column = |n: usize| {
            let mut waves: Vec<Wave> = rows.iter().map(|row| row[n]).collect();
            down.process(&mut waves);
            waves
        };
        (0..columns).into_par_iter().map(column).collect()
    }
}

/// 1 + 1 of the nearest two frequencies, and others that are smaller by far where n is no more than a third of the nodes.
const TWO_AND_OTHERS: f64 = 2.1;

impl Spread {
    /// The tile of the first node that it reaches.
    fn tile(&self) -> [usize; 2] {
        self.first.map(|first| first / TILE)
    }

    /// Adds so many times the spline to a plane from the first node that it reaches on.
    #[inline(always)]
    fn add(&self, times: f64, stride: usize, plane: &mut [f64]) {
        let [across, down] = &self.weights;
        for (down, row) in down.iter().zip(plane.chunks_mut(stride)) {
            let weight = times * down;
            row[..ORDER].iter_mut().zip(across).for_each(|(to, across)| *to += weight * across);
        }
    }
}

/// Their numbers, tile by tile along its row of tiles, by counting.
fn by_tiles(points: &[Spread], [columns, rows]: [usize; 2]) -> Vec<u32> {
    let across = columns.div_ceil(TILE);
    let tile = |point: &Spread| point.tile()[1] * across + point.tile()[0];
    let tiles = across * rows.div_ceil(TILE);
    let mut starts = vec![0u32; tiles + 1];
    points.iter().for_each(|point| starts[tile(point) + 1] += 1);
    for tile in 0..tiles {
        starts[tile + 1] += starts[tile];
    }
    let mut order = vec![0; points.len()];
    for (index, point) in (0..).zip(points) {
        let next = &mut starts[tile(point)];
        order[*next as usize] = index;
        *next += 1;
    }
    order
}

impl Band {
    /// Of some points, one or more, by their numbers in the order of their tiles.
    fn new(
        points: &[Spread],
        chosen: &[u32],
        columns: usize,
        sets: usize,
        weight: impl Fn(usize, usize) -> [f64; 3],
    ) -> Self {
        let of = |index: &u32| &points[*index as usize];
        let rows = || chosen.iter().map(|index| of(index).first[1]);
        let (first, last) = rows().fold((usize::MAX, 0), |(first, last), row| (first.min(row), last.max(row)));
        let stride = columns + ORDER;
        let mut planes = vec![vec![0.0; stride * (last - first + ORDER)]; 3 * sets];
        let mut weights = Vec::new();
        for tile in chosen.chunk_by(|one, other| of(one).tile() == of(other).tile()) {
            for (set, planes) in planes.chunks_exact_mut(3).enumerate() {
                weights.clear();
                weights.extend(tile.iter().map(|&index| weight(index as usize, set)));
                for (colour, plane) in planes.iter_mut().enumerate() {
                    Arch::new().dispatch(
                        #[inline(always)]
                        || {
                            for (point, weight) in tile.iter().map(of).zip(&weights) {
                                let [column, row] = point.first;
                                point.add(weight[colour], stride, &mut plane[(row - first) * stride + column..]);
                            }
                        },
                    );
                }
            }
        }
        Self { first, planes }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::super::Point;
    use super::*;
    use crate::chance::Chance;

    /// Held against each point's own waves, points at both ends of a turn among them, within the bound; and the bound is no more than some
    /// ten times what is found.
    #[test]
    fn sums_are_those_of_all_points_within_the_bound() {
        let mut chance = Chance::new(3);
        let mut points: Vec<Point> = (0..700)
            .map(|_| Point {
                turns: [0; 2].map(|_| chance.between(0.0, 1.0)),
                weight: [0; 3].map(|_| chance.between(-1.0, 1.0)),
            })
            .collect();
        (points[0].turns, points[1].turns) = ([0.0, 0.0], [1.0 - f64::EPSILON, 0.999_999]);
        let degree = [9, 23];
        for asked in [1e-3, 1e-5, 1e-8] {
            let grid = Grid::within(degree, asked);
            let bound = grid.error(degree);
            assert!(bound < 2.5 * asked, "{asked}: {bound}");
            // Of one point: what others add hides behind it.
            let alone = &grid.sums([1, 1], |_| points[5].turns, |_, _| points[5].weight, degree)[0];
            // The second of two sets.
            let weight = |k: usize, set: usize| points[k].weight.map(|weight| if set == 0 { 1.0 } else { weight });
            let all = &grid.sums([points.len(), 2], |k| points[k].turns, weight, degree)[1];
            let (mut worst, mut worst_of_all) = (0.0f64, 0.0f64);
            for m in 0..=degree[1] {
                for n in 0..=degree[0] {
                    let at = (m * (degree[0] + 1) + n) as usize;
                    let own = |point: &Point| {
                        let [(sin_x, cos_x), (sin_y, cos_y)] =
                            [(n, 0), (m, 1)].map(|(k, axis)| (TAU * f64::from(k) * point.turns[axis]).sin_cos());
                        [cos_x * cos_y, cos_x * sin_y, sin_x * cos_y, sin_x * sin_y]
                    };
                    for part in 0..4 {
                        let wanted = points[5].weight[1] * own(&points[5])[part];
                        worst = worst.max((alone[at][1][part] - wanted).abs() / points[5].weight[1].abs());
                        let wanted: f64 = points.iter().map(|point| point.weight[1] * own(point)[part]).sum();
                        worst_of_all = worst_of_all.max((all[at][1][part] - wanted).abs() / points.len() as f64);
                    }
                }
            }
            assert!(worst <= bound + 1e-13 && worst > 0.05 * bound, "{asked}: {worst:e} of {bound:e}");
            assert!(worst_of_all <= bound + 1e-13, "{asked}: {worst_of_all:e} of {bound:e}");
        }
    }
}
