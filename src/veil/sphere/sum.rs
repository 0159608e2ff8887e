//! A veil on the sphere, summed.

use pulp::Arch;
use rayon::prelude::*;

use super::Sphere;
use super::factors::{Way, multiply};
use super::scatter::{Cell, Gather, interleave, mend, scatter};
use crate::veil::photo::Sources;
use crate::veil::simd::{BLOCK, Into, Plane};
use crate::veil::sweep::{NEXT, Pyramid, Separable, convolve, expand};

/// What a sum needs besides its result; kept from one to the next.
pub(in crate::veil) struct Workspace {
    /// By channels: light for the small kernels.
    near: [Plane<f32>; 3],
    /// By channels.
    pub(super) pyramids: [Pyramid<f32>; 3],
    /// By channels, and by slots beyond the chain: from the base on.
    pub(super) branches: [Vec<Pyramid<f32>>; 3],
    /// By lattices.
    scratch: Vec<Plane<f32>>,
    /// The finest lattice, with its lanes side by side.
    lattice: Vec<Cell>,
    /// Its parts, one for each band of pixels.
    parts: Vec<Vec<Cell>>,
    /// By channels: all light times solid angle.
    pub(super) totals: [f64; 3],
    /// By channels: what comes out.
    pub veils: [Plane<f32>; 3],
}

impl Sphere {
    /// What [`Self::sum`] needs.
    pub fn workspace(&self) -> Workspace {
        let (points, [width, height]) = (self.model.points(), self.tiles.extent());
        let (count, picture) = (self.model.lattices().max(1), self.model.camera.size);
        let [last, base] = self.model.chain;
        let whole = Pyramid::<f32>::from_first(points, count);
        let fine = [whole.moments[base.min(count - 1)].width(), whole.moments[base.min(count - 1)].height()];
        let branch = |level: usize| Pyramid::from_first(fine, level - base + 1);
        Workspace {
            branches: [0, 1, 2].map(|_| self.model.slots.iter().skip(last + 1).map(|level| branch(*level)).collect()),
            // Vectors of the last tile read beyond it.
            near: [0, 1, 2].map(|_| Plane::new(width + BLOCK, height)),
            pyramids: [0, 1, 2].map(|_| Pyramid::from_first(points, count.min(last + 1))),
            scratch: whole.moments,
            lattice: Vec::new(),
            parts: Vec::new(),
            totals: [0.0; 3],
            veils: [0, 1, 2].map(|_| Plane::new(width.max(picture[0]) + BLOCK, picture[1])),
        }
    }

    /// The veil of three channels, in the scale of each, as the workspace's veils. Their rows begin with the picture's.
    pub fn sum(&self, sources: &[Sources; 3], workspace: &mut Workspace) {
        let arch = Arch::new();
        let lights = sources.each_ref().map(|sources| &sources.plane);
        workspace.totals = self.reduce(arch, lights, workspace);
        let everywhere = workspace.totals.map(|sum| (self.model.constant * sum) as f32);
        let Workspace { near, pyramids, branches, scratch, lattice, veils, .. } = workspace;
        if self.kernels.is_empty() {
            lattice.clear();
        } else {
            for (pyramid, branches) in pyramids.iter_mut().zip(branches) {
                self.sweep(arch, pyramid, branches, scratch);
            }
            interleave(arch, pyramids.each_ref().map(|pyramid| &pyramid.sums[0]), lattice);
        }
        let (stride, rows) = (veils[0].stride(), self.tiles.size[1]);
        let [red, green, blue] = veils;
        let bands = red.par_groups_mut(rows).zip(green.par_groups_mut(rows)).zip(blue.par_groups_mut(rows));
        bands.enumerate().for_each(|(band, ((red, green), blue))| {
            let mut out = [red, green, blue];
            self.tiles.sum(arch, near.each_ref(), band, stride, out.each_mut().map(|out| &mut **out));
            for row in 0..out[0].len() / stride {
                let y = band * rows + row;
                arch.dispatch(Gather {
                    table: &self.table,
                    y,
                    lights: lights.map(|light| light.row(y)),
                    everywhere,
                    lattice,
                    columns: self.model.points()[0],
                    out: out.each_mut().map(|out| &mut out[row * stride..][..stride]),
                });
            }
        });
    }

    /// Fills the workspace's moments, and the light for the small kernels. Returns the sums of light times solid angle.
    fn reduce(&self, arch: Arch, lights: [&Plane<f32>; 3], workspace: &mut Workspace) -> [f64; 3] {
        let Workspace { near, pyramids, branches, scratch, parts, .. } = workspace;
        let reach = self.tiles.reach;
        let stride = near[0].stride();
        let near = near.each_mut().map(|near| near.rows_from_mut(reach));
        let first = pyramids.each_mut().map(|pyramid| &mut pyramid.moments[0]);
        let sums = scatter(arch, &self.table, lights, parts, first, (near, stride, reach));
        for (pyramid, branches) in pyramids.iter_mut().zip(branches) {
            self.reduce_further(arch, pyramid, branches, scratch);
        }
        sums
    }

    /// One channel's moments, where the light of some pixels has changed.
    pub(super) fn reduce_again(
        &self,
        light: &Plane<f32>,
        pixels: &[[usize; 2]],
        workspace: &mut Workspace,
        channel: usize,
    ) {
        let Workspace { pyramids, branches, scratch, .. } = workspace;
        mend(&self.table, light, pixels, &mut pyramids[channel].moments[0]);
        self.reduce_further(Arch::new(), &mut pyramids[channel], &mut branches[channel], scratch);
    }

    /// One channel's moments from the second lattice on.
    fn reduce_further(
        &self,
        arch: Arch,
        pyramid: &mut Pyramid<f32>,
        branches: &mut [Pyramid<f32>],
        scratch: &mut [Plane<f32>],
    ) {
        let [last, base] = self.model.chain;
        let chain = scratch.iter_mut().zip(&self.factors).enumerate().take(last + 1).skip(1);
        for (level, (scratch, factor)) in chain {
            pyramid.reduce_to(arch, level);
            if let Some(factor) = factor {
                multiply(arch, factor, Way::Up, &pyramid.moments[level], Into::Set, scratch);
                std::mem::swap(&mut pyramid.moments[level], scratch);
            }
        }
        for (branch, factor) in branches.iter_mut().zip(self.factors.iter().skip(last + 1).flatten()) {
            multiply(arch, factor, Way::Up, &pyramid.moments[base], Into::Set, &mut branch.moments[0]);
            branch.reduce_further(arch);
        }
    }

    /// One channel's convolutions.
    fn sweep(&self, arch: Arch, pyramid: &mut Pyramid<f32>, branches: &mut [Pyramid<f32>], scratch: &mut [Plane<f32>]) {
        let [last, base] = self.model.chain;
        for level in (0..self.kernels.len().min(last + 1)).rev() {
            let (fine, coarse) = pyramid.sums.split_at_mut(level + 1);
            let sum = &mut fine[level];
            let mut into = Into::Set;
            if let Some(coarse) = coarse.first().filter(|_| level < last) {
                expand(arch, coarse, &NEXT, sum);
                into = Into::Add;
            }
            for kernel in &self.kernels[level] {
                convolve(arch, &pyramid.moments[level], kernel, sum, into);
                into = Into::Add;
            }
            let factors = self.factors.iter().enumerate().skip(last + 1).filter(|_| level == base);
            for (branch, (number, factor)) in branches.iter_mut().zip(factors) {
                let Some(factor) = factor else { continue };
                branch_out(arch, &self.kernels[number], branch);
                multiply(arch, factor, Way::Down, &branch.sums[0], into, sum);
                into = Into::Add;
            }
            if into == Into::Set {
                sum.par_rows_mut().for_each(|row| row.fill(0.0));
            }
            if let Some(factor) = &self.factors[level] {
                multiply(arch, factor, Way::Down, sum, Into::Set, &mut scratch[level]);
                std::mem::swap(sum, &mut scratch[level]);
            }
        }
    }
}

/// What kernels on a branch's coarsest lattice come to on its finest.
fn branch_out(arch: Arch, kernels: &[Separable<f32>], branch: &mut Pyramid<f32>) {
    let Some(top) = branch.sums.len().checked_sub(1) else { return };
    let mut into = Into::Set;
    for kernel in kernels {
        convolve(arch, &branch.moments[top], kernel, &mut branch.sums[top], into);
        into = Into::Add;
    }
    if into == Into::Set {
        branch.sums[top].par_rows_mut().for_each(|row| row.fill(0.0));
    }
    for level in (0..top).rev() {
        let (fine, coarse) = branch.sums.split_at_mut(level + 1);
        expand(arch, &coarse[0], &NEXT, &mut fine[level]);
    }
}
