//! A series at the nodes of its lattice, summed by the CPU's cores from modes that the plan has computed: two products of matrices,
//! where a renderer in software would go through every term of every node.

use ndarray::linalg::general_mat_mul;
use ndarray::parallel::prelude::*;
use ndarray::{Array2, ArrayView2, Axis, concatenate};
use rayon::slice::ParallelSliceMut;

use super::tiles::Nodes;
use crate::plan::{Modes, Series};

/// Rows of nodes that a task goes through.
const ROWS: usize = 32;

/// The nodes' values, row by row in the order of the lattice's texture; in the units of the modes, what the B-spline makes of each
/// harmonic divided out.
pub(super) fn values(series: &Series, modes: &Modes, nodes: &Nodes, order: u32) -> Vec<[f32; 4]> {
    let degree = series.degree();
    let [across, down] = [0, 1].map(|axis| waves(&nodes.waves(axis, degree[axis], order), nodes.count(axis)));
    let terms = terms(series, modes);
    let mut values = vec![[0.0f32; 4]; nodes.count(0) * nodes.count(1)];
    let bands = values.par_chunks_mut(ROWS * nodes.count(0)).zip(down.axis_chunks_iter(Axis(1), ROWS).into_par_iter());
    bands.for_each(|(values, down)| {
        for (colour, terms) in terms.iter().enumerate() {
            let along = profiles(down.t(), terms);
            let mut sums = Array2::<f32>::zeros((down.ncols(), across.ncols()));
            general_mat_mul(1.0, &along, &across, 0.0, &mut sums);
            values.iter_mut().zip(&sums).for_each(|(value, sum)| value[colour] = *sum);
        }
    });
    values
}

/// For each row of nodes what the cosine of each harmonic of x has before it, then what the sine has.
fn profiles(down: ArrayView2<f32>, [cosines, sines]: &[Array2<f32>; 2]) -> Array2<f32> {
    concatenate![Axis(1), down.dot(cosines), down.dot(sines)]
}

/// Of each colour, A above B and C above D: a row for the cosine and one for the sine of each harmonic of y, a column for each harmonic
/// of x.
fn terms(series: &Series, modes: &Modes) -> [[Array2<f32>; 2]; 3] {
    let [columns, rows] = series.degree().map(|degree| degree as usize + 1);
    let mut terms = [0; 3].map(|_| [0; 2].map(|_| Array2::zeros((2 * rows, columns))));
    let places = series.counts.iter().enumerate().flat_map(|(n, &count)| (0..count as usize).map(move |m| (n, m)));
    for ((n, m), mode) in places.zip(modes.kept(&series.counts)) {
        for (terms, [a, b, c, d]) in terms.iter_mut().zip(mode) {
            (terms[0][(m, n)], terms[0][(rows + m, n)]) = (a as f32, b as f32);
            (terms[1][(m, n)], terms[1][(rows + m, n)]) = (c as f32, d as f32);
        }
    }
    terms
}

/// A row for the cosine of each harmonic and then for its sine, a column for each node.
fn waves(waves: &[[f64; 2]], nodes: usize) -> Array2<f32> {
    let harmonics = waves.len() / nodes.max(1);
    let part = |row: usize, node: usize| waves[row % harmonics * nodes + node][row / harmonics] as f32;
    Array2::from_shape_fn((2 * harmonics, nodes), |(row, node)| part(row, node))
}
