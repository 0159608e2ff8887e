//! The sum over all taps, for small kernels and small photos.

use pulp::Arch;
use rayon::prelude::*;

use super::evaluate::Light;
use super::taps::Taps;
use super::{Channel, Transform};
use crate::veil::simd::{Into, Plane, padded, slide};

/// A row of taps, turned over, and where its first stands in a row of sources.
struct Row {
    offset: isize,
    first: usize,
    taps: Vec<f64>,
}

impl Transform {
    /// Every pixel's sum goes to `take` in rows, with a row of `out`.
    pub(super) fn slide(&self, light: Light, out: &mut [f32], take: impl Fn(usize, &[f64], &mut [f32]) + Sync) {
        let Channel { taps, .. } = self.channel(light.channel);
        let [width, height] = self.task.size;
        let border = self.task.border;
        let mut sources = Plane::<f64>::new(padded(width) + taps.columns.offsets(), height);
        let after = taps.columns.after;
        sources.par_rows_mut().take(height).enumerate().for_each(|(y, row)| {
            light.photo.lights(light.channel, y, border, after, row);
        });
        let (arch, rows) = (Arch::new(), rows(taps));
        let row = |sums: &mut Vec<f64>, (y, out): (usize, &mut [f32])| {
            sums.fill(0.0);
            for row in &rows {
                let from = y as isize - row.offset;
                let seen = from >= -(height as isize) && from < 2 * height as isize;
                if let Some(from) = border.source(from, height).filter(|_| seen) {
                    slide(arch, &sources.row(from)[row.first..], &row.taps, sums, Into::Add);
                }
            }
            take(y, sums, out);
        };
        out.par_chunks_exact_mut(width).enumerate().for_each_init(|| vec![0.0; padded(width)], row);
    }
}

/// The rows that have something.
fn rows(taps: &Taps) -> Vec<Row> {
    let [left, right] = [taps.columns.before as isize, taps.columns.after as isize];
    let offsets = -(taps.rows.before as isize)..=taps.rows.after as isize;
    let row = |offset: isize| {
        let values: Vec<f64> = (-left..=right).rev().map(|x| taps.at([x, offset])).collect();
        let first = values.iter().position(|value| *value != 0.0)?;
        let last = values.iter().rposition(|value| *value != 0.0)?;
        Some(Row { offset, first, taps: values[first..=last].to_vec() })
    };
    offsets.filter_map(row).collect()
}
