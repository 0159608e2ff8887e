//! Pixels that are far brighter than their own veil.
//!
//! The lattices cannot leave a pixel's own light out; it is subtracted, and what rounding leaves of it can be more than the
//! veil of such a pixel bears. So its veil is summed anew: the photo without these pixels goes up the lattices once more, where it is
//! looked at from these pixels alone, and what they send each other is added pair by pair.

use pulp::Arch;
use rayon::prelude::*;

use super::moments::Moments;
use super::{Finished, OwnLight};
use crate::veil::photo::{Scale, Sources, exp2};
use crate::veil::plan::{Lattice, Layers, Placed, Planar};
use crate::veil::simd::Plane;
use crate::veil::sweep::Pyramid;

/// Pixels that are taken at a time: more of them make more pairs than the lattices cost.
const BATCH: usize = 2048;

impl Planar {
    /// Sums the veil of lonely pixels anew, where own light is more than its share of their veil or of the channel's floor. Returns
    /// how many there are.
    pub(super) fn mend(
        &self,
        sources: &mut Sources,
        rows: &[Finished],
        (floor, own): (f64, OwnLight),
        pyramid: &mut Pyramid<f32>,
        plane: &mut [f32],
    ) -> usize {
        let lonely = self.lonely(sources, rows, (floor, own), plane);
        let scale = Scale::new(-sources.exponent);
        for batch in lonely.chunks(BATCH) {
            let lights = batch.iter().map(|[x, y]| std::mem::take(&mut sources.plane.row_mut(*y)[*x]));
            let batch: Vec<([usize; 2], f32)> = batch.iter().copied().zip(lights.collect::<Vec<f32>>()).collect();
            pyramid.reduce(Arch::new(), &sources.plane);
            let moments = Moments::new(&self.layers, &sources.plane);
            let at = |(at, _): &([usize; 2], f32)| {
                let [x, y] = *at;
                let rest = lattices(&self.layers, pyramid, x, y) + near(&self.layers, &sources.plane, x, y);
                rest + moments.at(x, y) + self.pairs(&batch, *at)
            };
            let values: Vec<f64> = batch.par_iter().map(at).collect();
            for (([x, y], light), value) in batch.iter().zip(values) {
                sources.plane.row_mut(*y)[*x] = *light;
                plane[(y - self.margin[1]) * self.size[0] + x - self.margin[0]] = scale.of(value as f32);
            }
        }
        lonely.len()
    }

    /// Where they are, by the sources' columns and rows.
    fn lonely(
        &self,
        sources: &Sources,
        rows: &[Finished],
        (floor, OwnLight { rest, share }): (f64, OwnLight),
        plane: &[f32],
    ) -> Vec<[usize; 2]> {
        let scale = exp2(sources.exponent);
        let some =
            plane.chunks_exact(self.size[0]).zip(rows).enumerate().filter(|(_, (_, finished))| finished.lonely > 0);
        let of_row = |(y, (veil, _)): (usize, (&[f32], &Finished))| {
            let y = y + self.margin[1];
            let light = &sources.plane.row(y)[self.margin[0]..][..self.size[0]];
            let pixels = light.iter().zip(veil).enumerate();
            let lonely = pixels
                .filter(|(_, (light, veil))| f64::from(**light) * rest > share * scale * f64::from(**veil).max(floor));
            lonely.map(|(x, _)| [x + self.margin[0], y]).collect::<Vec<_>>()
        };
        some.flat_map(of_row).collect()
    }

    /// What the others of a batch send to one of it.
    fn pairs(&self, batch: &[([usize; 2], f32)], at: [usize; 2]) -> f64 {
        let others = batch.iter().filter(|(other, _)| *other != at);
        let sent = others.map(|(other, light)| {
            let [u, v] = [0, 1].map(|side| at[side].abs_diff(other[side]) as f64);
            f64::from(*light) * self.wanted(u.hypot(v))
        });
        sent.sum()
    }
}

/// What the lattices send to a pixel.
fn lattices(layers: &Layers, pyramid: &Pyramid<f32>, x: usize, y: usize) -> f64 {
    let each = layers.lattices.iter().zip(pyramid.moments()).flat_map(|(terms, moments)| {
        terms.iter().map(move |placed| {
            let lattice = Lattice { pitch: placed.pitch, kernel: &placed.half };
            let [(left, across), (top, down)] =
                [(x, moments.width()), (y, moments.height())].map(|(pixel, points)| lattice.seen(pixel, points));
            let rows = down.iter().enumerate().map(|(row, down)| {
                let values = &moments.row(top + row)[left..];
                down * across.iter().zip(values).map(|(across, value)| across * f64::from(*value)).sum::<f64>()
            });
            placed.weight * rows.sum::<f64>()
        })
    });
    each.sum()
}

/// What the kernels on the pixels send to one.
fn near(layers: &Layers, sources: &Plane<f32>, x: usize, y: usize) -> f64 {
    let separable = |placed: &Placed| {
        let rows = placed.half.iter().enumerate();
        placed.weight * rows.map(|(distance, value)| value * both(sources, x, y, distance, &placed.half)).sum::<f64>()
    };
    let direct: f64 = layers.direct.iter().map(separable).sum();
    let rows = layers.near.rows.iter().enumerate();
    direct + rows.map(|(distance, values)| both(sources, x, y, distance, values)).sum::<f64>()
}

/// Σ over the rows at `distance` from `y`, of `half` from `x` outwards on both sides.
fn both(sources: &Plane<f32>, x: usize, y: usize, distance: usize, half: &[f64]) -> f64 {
    let along = |row: &[f32]| {
        let each = half.iter().enumerate();
        let sides = each.flat_map(|(distance, value)| {
            mirrored(x, distance, sources.width()).map(move |x| f64::from(row[x]) * value)
        });
        sides.sum::<f64>()
    };
    mirrored(y, distance, sources.height()).map(|y| along(sources.row(y))).sum()
}

/// The one or two places at `distance` from `middle`, where they are.
fn mirrored(middle: usize, distance: usize, length: usize) -> impl Iterator<Item = usize> {
    let before = middle.checked_sub(distance);
    let after = Some(middle + distance).filter(|after| distance > 0 && *after < length);
    before.into_iter().chain(after)
}
