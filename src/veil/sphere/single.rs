//! The veil at single pixels: what the lattices and the small kernels come to there, without the convolutions in between.

use rayon::prelude::*;

use super::Sphere;
use super::model::Placed;
use super::sum::Workspace;
use super::table::Entry;
use crate::veil::plan::weights;
use crate::veil::simd::Plane;

impl Sphere {
    /// A channel's veil at pixels that send no light themselves, but had `taken` before, in the scale of the sources. The workspace's moments are
    /// right but for these pixels and `others`.
    pub fn at(
        &self,
        light: &Plane<f32>,
        pixels: &[[usize; 2]],
        taken: &[f32],
        others: &[[usize; 2]],
        workspace: &mut Workspace,
        channel: usize,
    ) -> Vec<f64> {
        let changed: Vec<[usize; 2]> = pixels.iter().chain(others).copied().collect();
        if !self.kernels.is_empty() {
            self.reduce_again(light, &changed, workspace, channel);
        }
        // As they were added, so that they cancel.
        let sent = |([x, y], light): (&[usize; 2], &f32)| {
            let root = self.table.entry(*x, *y).root;
            f64::from(root * (root * light))
        };
        let rest = workspace.totals[channel] - pixels.iter().zip(taken).map(sent).sum::<f64>();
        let everywhere = self.model.constant * rest.max(0.0);
        let at = |[x, y]: &[usize; 2]| {
            let entry = self.table.entry(*x, *y);
            let near = self.tiles.at(*x, *y, |x, y| f64::from(light.row(y)[x] * self.table.entry(x, y).root));
            let growth = (-self.model.camera.point(*x as f64, *y as f64).depth).exp();
            everywhere + near / f64::from(entry.root) + self.image(&entry, growth, workspace, channel)
        };
        pixels.par_iter().map(at).collect()
    }

    /// What the lattices send to a pixel whose 1 + |a|² is `growth`.
    fn image(&self, entry: &Entry, growth: f64, workspace: &Workspace, channel: usize) -> f64 {
        let each = self.model.placed.iter().map(|placed| {
            let [last, base] = self.model.chain;
            let moments = match placed.slot.checked_sub(last + 1) {
                None => &workspace.pyramids[channel].moments[placed.level],
                Some(branch) => &workspace.branches[channel][branch].moments[placed.level - base],
            };
            placed.weight * growth.powf(self.model.powers[placed.slot]) * seen(placed, entry, moments)
        });
        each.sum()
    }
}

/// What a kernel and the splines make of a lattice's moments at a pixel.
fn seen(placed: &Placed, entry: &Entry, moments: &Plane<f32>) -> f64 {
    let [(left, across), (top, down)] = [(0, moments.width()), (1, moments.height())]
        .map(|(side, points)| along(placed, f64::from(entry.cell[side]) + f64::from(entry.phase[side]), points));
    let row = |(row, down): (usize, &f64)| {
        let values = across.iter().zip(&moments.row(top + row)[left..]);
        down * values.map(|(across, value)| across * f64::from(*value)).sum::<f64>()
    };
    down.iter().enumerate().map(row).sum()
}

/// What each point along a lattice counts at `cells` of the finest lattice: the first that counts, and the values from there on.
fn along(placed: &Placed, cells: f64, points: usize) -> (usize, Vec<f64>) {
    let at = cells / (1u64 << placed.level) as f64;
    let (base, weights, reach) = (at as usize, weights(at.fract()), placed.half.len() - 1);
    let (first, end) = (base.saturating_sub(reach), (base + 4 + reach).min(points));
    let value = |point: usize| {
        let each = weights.iter().enumerate();
        each.map(|(index, weight)| weight * placed.half.get(point.abs_diff(base + index)).copied().unwrap_or(0.0)).sum()
    };
    (first, (first..end).map(value).collect())
}
