//! A series at the nodes of its lattice, summed by the CPU's cores: a whole number of nodes makes a period, so that transforms of the
//! harmonics give all of them at once, where a device goes through every term of every node.

use ndarray::Array2;
use ndarray::parallel::prelude::*;
use rayon::slice::ParallelSliceMut;
use realfft::RealFftPlanner;
use rustfft::FftPlanner;

use super::tiles::{Nodes, Ring, Wave};

const ZERO: Wave = Wave::new(0.0, 0.0);
const I: Wave = Wave::new(0.0, 1.0);

/// The nodes' values, row by row in the order of the lattice's texture, what the B-spline makes of each harmonic divided out. Of the
/// spectrum there are `counts[n]` modes beside harmonic n of x, and of each mode A, B, C and D of three colours.
pub(super) fn values(counts: &[u32], terms: &[[f32; 4]], nodes: &Nodes, order: u32) -> Vec<[f32; 4]> {
    let degree = [counts.len() as u32 - 1, counts[0] - 1];
    let [across, down] = [0, 1].map(|axis| nodes.ring(axis, degree[axis], order));
    let [columns, rows] = [0, 1].map(|axis| nodes.count(axis));
    let transform = RealFftPlanner::new().plan_fft_inverse(across.nodes);
    let mut values = vec![[0.0f32; 4]; columns * rows];
    for colour in 0..3 {
        let profiles = profiles(counts, terms, colour, &down, rows);
        values.par_chunks_mut(columns).enumerate().for_each_init(
            || (transform.make_input_vec(), transform.make_output_vec(), transform.make_scratch_vec()),
            |(waves, sums, scratch), (row, values)| {
                waves.fill(ZERO);
                let profile = profiles.column(row);
                for ((wave, profile), turned) in waves.iter_mut().zip(profile).zip(&across.turned) {
                    *wave = profile.conj() * turned;
                }
                // The sine of nothing is nothing.
                waves[0].im = 0.0;
                transform.process_with_scratch(waves, sums, scratch).expect("buffers of the planner's lengths");
                values
                    .iter_mut()
                    .zip(sums.iter().cycle().skip(across.first % across.nodes))
                    .for_each(|(value, sum)| value[colour] = *sum);
            },
        );
    }
    values
}

/// For each harmonic of x, and each row of nodes, what its cosine has before it; and what its sine has, as an imaginary part.
///
/// A cos my + B sin my = ½ (A − iB) e^{imy} + ½ (A + iB) e^{−imy}, and so for C and D.
fn profiles(counts: &[u32], terms: &[[f32; 4]], colour: usize, down: &Ring, rows: usize) -> Array2<Wave> {
    let transform = FftPlanner::new().plan_fft_forward(down.nodes);
    let mut profiles = Array2::from_elem((counts.len(), rows), ZERO);
    let first = counts.iter().scan(0, |end, &count| {
        *end += count as usize;
        Some(*end - count as usize)
    });
    let harmonics: Vec<&[[f32; 4]]> =
        first.zip(counts).map(|(first, &count)| &terms[3 * first..3 * (first + count as usize)]).collect();
    profiles.outer_iter_mut().into_par_iter().zip(harmonics).for_each_init(
        || (vec![ZERO; down.nodes], vec![ZERO; transform.get_inplace_scratch_len()]),
        |(waves, scratch), (mut profile, terms)| {
            waves.fill(ZERO);
            for (m, (term, turned)) in terms.iter().skip(colour).step_by(3).zip(&down.turned).enumerate() {
                let [a, b, c, d] = *term;
                let (cosine, sine) = (Wave::new(a, c), Wave::new(b, d));
                let turned_sine = I * sine;
                if m == 0 {
                    waves[0] = cosine;
                } else {
                    waves[m] = (cosine - turned_sine) * turned;
                    waves[down.nodes - m] = (cosine + turned_sine) * turned.conj();
                }
            }
            transform.process_with_scratch(waves, scratch);
            profile
                .iter_mut()
                .zip(waves.iter().cycle().skip(down.first % down.nodes))
                .for_each(|(profile, wave)| *profile = *wave);
        },
    );
    profiles
}

#[cfg(test)]
mod tests {
    use glam::DVec2;

    use super::*;
    use crate::frame::{Frame, Window};
    use crate::plan::Lattice;
    use crate::series::CUBIC;

    /// Held against every term of every node, on a tile that is not the whole picture.
    #[test]
    fn transforms_have_the_values_of_sums_over_all_terms() {
        let (frame, tile) = (Frame::full(90, 60), Window { x: 31, y: 17, width: 40, height: 29 });
        let (period, around) = (DVec2::new(5.0, 3.6), [30, 24]);
        let step = period / DVec2::new(f64::from(around[0]), f64::from(around[1]));
        let lattice = Lattice { order: CUBIC, step, nodes: [0; 2], oversampling: DVec2::ONE, on_cpu: true, error: 0.0 };
        let nodes = Nodes::new(&lattice, period, frame, tile);
        let counts = [9, 9, 7, 4, 4, 1];
        let mut chance = crate::chance::Chance::new(5);
        let terms: Vec<[f32; 4]> =
            (0..3 * counts.iter().sum::<u32>()).map(|_| [0; 4].map(|_| chance.between(-1.0, 1.0) as f32)).collect();
        let found = values(&counts, &terms, &nodes, CUBIC);
        let [across, down] = [(0, 5), (1, 8)].map(|(axis, degree)| nodes.waves(axis, degree, CUBIC));
        let [columns, rows] = [0, 1].map(|axis| nodes.count(axis));
        assert!(columns > 5 && rows > 5, "{columns} x {rows}");
        for (at, found) in found.iter().enumerate() {
            let (column, row) = (at % columns, at / columns);
            for colour in 0..3 {
                let (mut sum, mut first) = (0.0, 0);
                for (n, &count) in counts.iter().enumerate() {
                    let [cos_x, sin_x] = across[n * columns + column];
                    for m in 0..count as usize {
                        let [cos_y, sin_y] = down[m * rows + row];
                        let [a, b, c, d] = terms[3 * (first + m) + colour].map(f64::from);
                        sum += cos_x * (a * cos_y + b * sin_y) + sin_x * (c * cos_y + d * sin_y);
                    }
                    first += count as usize;
                }
                assert!((f64::from(found[colour]) - sum).abs() < 1e-4, "{column} {row}: {} {sum}", found[colour]);
            }
        }
    }
}
