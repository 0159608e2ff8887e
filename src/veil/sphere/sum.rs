//! A veil on the sphere, summed.

use pulp::Arch;
use rayon::prelude::*;

use super::Sphere;
use super::scatter::{Entry, Gather, interleave, scatter};
use crate::veil::photo::Sources;
use crate::veil::simd::{BLOCK, Into, Plane, blend};
use crate::veil::sweep::{NEXT, Pyramid, convolve, expand};

/// What a sum needs besides its result; kept from one to the next.
pub(in crate::veil) struct Workspace {
    /// By channels: light for the small kernels.
    near: [Plane<f32>; 3],
    /// By channels and powers of the depth.
    pub(super) pyramids: [Vec<Pyramid<f32>>; 3],
    /// By lattices: what a node's kernels are convolved with.
    combined: Vec<Plane<f32>>,
    /// The finest lattice, with its lanes side by side.
    lattice: Vec<f32>,
    /// Its parts, one for each band of pixels.
    parts: Vec<Vec<f32>>,
}

impl Sphere {
    /// The veil of three channels, in the scale of each.
    pub fn sum(&self, sources: &[Sources; 3]) -> [Plane<f32>; 3] {
        let mut workspace = self.pool.take(|| self.workspace());
        // As many lanes as fill vectors, for three channels by the powers of the depth.
        let veils = match self.model.depths.count() {
            1 => self.sum_lanes::<4>(sources, &mut workspace),
            2 => self.sum_lanes::<8>(sources, &mut workspace),
            _ => self.sum_lanes::<12>(sources, &mut workspace),
        };
        self.pool.give_back(workspace);
        veils
    }

    pub(super) fn workspace(&self) -> Workspace {
        let (points, [width, height]) = (self.model.points(), self.tiles.extent());
        let pyramid = || Pyramid::<f32>::from_first(points, self.kernels.len());
        Workspace {
            // Vectors of the last tile read beyond it.
            near: [0, 1, 2].map(|_| Plane::new(width + BLOCK, height)),
            pyramids: [0, 1, 2].map(|_| (0..self.model.depths.count()).map(|_| pyramid()).collect()),
            combined: pyramid().moments,
            lattice: Vec::new(),
            parts: Vec::new(),
        }
    }

    fn sum_lanes<const N: usize>(&self, sources: &[Sources; 3], workspace: &mut Workspace) -> [Plane<f32>; 3] {
        let arch = Arch::new();
        let lights = sources.each_ref().map(|sources| &sources.plane);
        let everywhere = lights.map(|light| self.everywhere(light));
        for (light, near) in lights.into_iter().zip(&mut workspace.near) {
            self.near_sources(light, near);
        }
        if !self.kernels.is_empty() {
            self.convolve::<N>(arch, lights, workspace);
        }
        let lattice = workspace.lattice.as_chunks::<N>().0;
        let [width, height] = self.model.camera.size;
        let mut veils = lights.map(|_| Plane::new(width, height));
        let (stride, rows) = (veils[0].stride(), self.tiles.size[1]);
        let wide = stride.max(self.tiles.extent()[0] + BLOCK);
        let [red, green, blue] = &mut veils;
        let groups = red.par_groups_mut(rows).zip(green.par_groups_mut(rows)).zip(blue.par_groups_mut(rows));
        groups.enumerate().for_each_init(
            || (vec![0.0; rows * wide], Vec::new()),
            |(sums, entries), (group, ((red, green), blue))| {
                let mut out = [red, green, blue];
                for (near, out) in workspace.near.iter().zip(&mut out) {
                    self.tiles.sum(arch, near, group, wide, sums);
                    for (sums, out) in sums.chunks_exact(wide).zip(out.chunks_exact_mut(stride)) {
                        out[..width].copy_from_slice(&sums[..width]);
                    }
                }
                for row in 0..out[0].len() / stride {
                    let y = group * rows + row;
                    self.table.row(y, entries);
                    let mut out = out.each_mut().map(|out| &mut out[row * stride..][..width]);
                    for (channel, out) in out.iter_mut().enumerate() {
                        finish(out, lights[channel].row(y), entries, everywhere[channel]);
                    }
                    if !lattice.is_empty() {
                        let out = out.each_mut().map(|out| &mut **out);
                        arch.dispatch(Gather { entries, lattice, columns: self.model.points()[0], out });
                    }
                    out.into_iter().flatten().for_each(|out| *out = out.max(0.0));
                }
            },
        );
        veils
    }

    /// Fills the workspace's lattice.
    fn convolve<const N: usize>(&self, arch: Arch, lights: [&Plane<f32>; 3], workspace: &mut Workspace) {
        self.reduce::<N>(arch, lights, workspace);
        let Workspace { pyramids, combined, lattice, .. } = workspace;
        for pyramids in pyramids.iter_mut() {
            self.sweep(arch, pyramids, combined);
        }
        let sums = pyramids.each_ref().map(|pyramids| pyramids.iter().map(|each| &each.sums[0]).collect::<Vec<_>>());
        interleave::<N>(sums.each_ref().map(Vec::as_slice), lattice);
    }

    /// Fills the workspace's moments.
    pub(super) fn reduce<const N: usize>(&self, arch: Arch, lights: [&Plane<f32>; 3], workspace: &mut Workspace) {
        let Workspace { pyramids, parts, .. } = workspace;
        let first = pyramids.each_mut().map(|pyramids| pyramids.iter_mut().map(|each| &mut each.moments[0]).collect());
        scatter::<N>(arch, &self.table, lights, parts, first);
        pyramids.iter_mut().flatten().for_each(|pyramid| pyramid.reduce_further(arch));
    }

    /// One channel's convolutions: for each power of the target's depth, sums of powers of the source's.
    fn sweep(&self, arch: Arch, pyramids: &mut [Pyramid<f32>], scratch: &mut [Plane<f32>]) {
        for level in (0..self.kernels.len()).rev() {
            for pyramid in pyramids.iter_mut() {
                let (fine, coarse) = pyramid.sums.split_at_mut(level + 1);
                match coarse.first() {
                    Some(coarse) => expand(arch, coarse, &NEXT, &mut fine[level]),
                    None => fine[level].par_rows_mut().for_each(|row| row.fill(0.0)),
                }
            }
            let nodes = self.kernels[level].iter().enumerate().filter(|(_, kernels)| !kernels.is_empty());
            for (node, kernels) in nodes {
                if level < self.model.local {
                    self.convolve_local(arch, pyramids, level, node, &mut scratch[level]);
                    continue;
                }
                for target in 0..pyramids.len() {
                    combine(arch, pyramids, level, &self.model.depths.sources(node, target), &mut scratch[level]);
                    for kernel in kernels {
                        convolve(arch, &scratch[level], kernel, &mut pyramids[target].sums[level], Into::Add);
                    }
                }
            }
        }
    }

    /// A node's kernels where the source's depth is taken to be the target's: one convolution, for all powers of the depth.
    fn convolve_local(
        &self,
        arch: Arch,
        pyramids: &mut [Pyramid<f32>],
        level: usize,
        node: usize,
        scratch: &mut Plane<f32>,
    ) {
        let mut into = Into::Set;
        for kernel in &self.kernels[level][node] {
            convolve(arch, &pyramids[0].moments[level], kernel, scratch, into);
            into = Into::Add;
        }
        for (power, pyramid) in pyramids.iter_mut().enumerate() {
            let factor = self.model.depths.polynomials[node][power] * f64::from(1u32 << power);
            let rows = pyramid.sums[level].par_rows_mut().enumerate();
            rows.for_each(|(y, out)| blend(arch, &[(scratch.row(y), factor as f32)], out, Into::Add));
        }
    }

    /// Light times √ of the solid angle, with the small kernels' reach as its margin.
    fn near_sources(&self, light: &Plane<f32>, near: &mut Plane<f32>) {
        let reach = self.tiles.reach;
        near.par_rows_mut().enumerate().for_each_init(Vec::new, |entries, (row, out)| {
            let Some(y) = row.checked_sub(reach).filter(|y| *y < light.height()) else { return };
            self.table.row(y, entries);
            let each = out[reach..].iter_mut().zip(light.row(y)).zip(entries.iter());
            each.for_each(|((out, light), entry)| *out = light * entry.root);
        });
    }

    /// What all sources add everywhere.
    pub(super) fn everywhere(&self, light: &Plane<f32>) -> f32 {
        if self.model.constant == 0.0 {
            return 0.0;
        }
        let row = |entries: &mut Vec<Entry>, y: usize| {
            self.table.row(y, entries);
            // In several sums, which need not wait for each other.
            let mut sums = [0.0; 8];
            for (light, entries) in light.row(y).chunks(8).zip(entries.chunks(8)) {
                for ((sum, light), entry) in sums.iter_mut().zip(light).zip(entries) {
                    *sum += f64::from(light * entry.root * entry.root);
                }
            }
            sums.iter().sum::<f64>()
        };
        let rows: Vec<f64> = (0..light.height()).into_par_iter().map_init(Vec::new, row).collect();
        (self.model.constant * rows.iter().sum::<f64>()) as f32
    }
}

/// The small kernels' sums along a row with the target's factor and what all sources add, less the pixels' own light.
fn finish(out: &mut [f32], light: &[f32], entries: &[Entry], everywhere: f32) {
    for ((out, light), entry) in out.iter_mut().zip(light).zip(entries) {
        *out = *out / entry.root + everywhere - entry.own * light;
    }
}

/// Σ factor · moments over the powers of the depth.
fn combine(arch: Arch, pyramids: &[Pyramid<f32>], level: usize, factors: &[f64], out: &mut Plane<f32>) {
    let planes = || pyramids.iter().map(|pyramid| &pyramid.moments[level]).zip(factors);
    out.par_rows_mut().enumerate().for_each(|(y, out)| {
        let rows: Vec<(&[f32], f32)> = planes().map(|(plane, factor)| (plane.row(y), *factor as f32)).collect();
        blend(arch, &rows, out, Into::Set);
    });
}
