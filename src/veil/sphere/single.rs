//! The veil at single pixels: what the lattices and the small kernels come to there, without the convolutions in between.

use pulp::Arch;
use rayon::prelude::*;

use super::Sphere;
use super::model::Placed;
use super::scatter::Entry;
use crate::veil::photo::Sources;
use crate::veil::plan::weights;
use crate::veil::simd::Plane;
use crate::veil::sweep::Pyramid;

impl Sphere {
    /// By channels: the veil at pixels that send no light themselves, in the scale of the sources.
    pub fn at(&self, sources: &[Sources; 3], pixels: [&[[usize; 2]]; 3]) -> [Vec<f64>; 3] {
        let mut workspace = self.pool.take(|| self.workspace());
        let lights = sources.each_ref().map(|sources| &sources.plane);
        if !self.kernels.is_empty() {
            match self.model.depths.count() {
                1 => self.reduce::<4>(Arch::new(), lights, &mut workspace),
                2 => self.reduce::<8>(Arch::new(), lights, &mut workspace),
                _ => self.reduce::<12>(Arch::new(), lights, &mut workspace),
            }
        }
        let veils = [0, 1, 2].map(|channel| {
            let (light, pyramids) = (lights[channel], &workspace.pyramids[channel]);
            let everywhere = f64::from(self.everywhere(light));
            let at = |[x, y]: &[usize; 2]| {
                let entry = self.table.entry(*x, *y);
                let near = self.tiles.at(*x, *y, |x, y| f64::from(light.row(y)[x] * self.table.entry(x, y).root));
                everywhere + near / f64::from(entry.root) + self.image(&entry, pyramids)
            };
            pixels[channel].par_iter().map(at).collect()
        });
        self.pool.give_back(workspace);
        veils
    }

    /// What the lattices send to a pixel.
    fn image(&self, entry: &Entry, pyramids: &[Pyramid<f32>]) -> f64 {
        let depth = f64::from(entry.depth);
        let nodes = self.model.placed.iter().enumerate().map(|(node, placed)| {
            let far: Vec<f64> =
                (0..pyramids.len()).map(|source| self.model.depths.target(node, source, depth)).collect();
            let local: f64 =
                self.model.depths.polynomials[node].iter().rev().fold(0.0, |sum, value| sum * 2.0 * depth + value);
            let each = placed.iter().map(|placed| {
                let factors = if placed.level < self.model.local { &[local][..] } else { &far };
                let planes = pyramids.iter().map(|pyramid| &pyramid.moments[placed.level]).zip(factors.iter().copied());
                placed.weight * seen(placed, entry, &planes.collect::<Vec<_>>())
            });
            each.sum::<f64>()
        });
        f64::from(entry.growth()) * nodes.sum::<f64>()
    }
}

/// What a kernel and the splines make of planes times factors at a pixel.
fn seen(placed: &Placed, entry: &Entry, planes: &[(&Plane<f32>, f64)]) -> f64 {
    let (columns, rows) = (planes[0].0.width(), planes[0].0.height());
    let [(left, across), (top, down)] =
        [(entry.at[0], columns), (entry.at[1], rows)].map(|(at, points)| along(placed, f64::from(at), points));
    let row = |(row, down): (usize, &f64)| {
        let plane = |(plane, factor): &(&Plane<f32>, f64)| {
            let values = across.iter().zip(&plane.row(top + row)[left..]);
            factor * values.map(|(across, value)| across * f64::from(*value)).sum::<f64>()
        };
        down * planes.iter().map(plane).sum::<f64>()
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
