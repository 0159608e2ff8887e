//! The lattices: up by the splines' refinement, a few Gaussians on each, and down again.
//!
//! Lattice 1 has a point at every second pixel, lattice l + 1 at every second point of lattice l. Each begins one point
//! before the first pixel and ends where no pixel's spline reaches on, so that nothing outside matters.

mod convolve;
mod resample;

pub(super) use convolve::{Scratch, Separable, convolve, convolve_rows};
pub(super) use resample::{Expansion, expand, expand_row};

use resample::reduce;

use pulp::Arch;

use super::simd::{Into, Plane, Real};

/// Rows that a thread takes at a time: with a kernel's reach above and below, they fit into its cache.
pub(super) const GROUP: usize = 48;

/// From a lattice to the next, by splines of pitch 1 and 2: which taps, and how many points before the first are read.
pub(crate) struct Step {
    /// Up: moments against the wide spline from those against the narrow one.
    pub up: &'static [f64],
    /// Points before the first that its first value reads.
    pub before: usize,
    /// Down: what a point with an even index takes from the coarse lattice's points, from half its index on.
    pub even: &'static [f64],
    /// One with an odd index likewise.
    pub odd: &'static [f64],
}

/// From pixels to lattice 1: the spline at its halves.
pub(crate) const FIRST: Step = Step {
    up: &[1.0 / 48.0, 8.0 / 48.0, 23.0 / 48.0, 32.0 / 48.0, 23.0 / 48.0, 8.0 / 48.0, 1.0 / 48.0],
    before: 5,
    even: &[1.0 / 6.0, 4.0 / 6.0, 1.0 / 6.0],
    odd: &[1.0 / 48.0, 23.0 / 48.0, 23.0 / 48.0, 1.0 / 48.0],
};

/// From a lattice to the next: β(x / 2) = Σ [1, 4, 6, 4, 1] / 8 β(x − j).
pub(crate) const NEXT: Step =
    Step { up: &[0.125, 0.5, 0.75, 0.5, 0.125], before: 3, even: &[0.5, 0.5], odd: &[0.125, 0.75, 0.125] };

/// How many points each lattice has along a side of `pixels`, from lattice 1 on.
pub(crate) fn points(pixels: usize, lattices: usize) -> Vec<usize> {
    let mut points = Vec::with_capacity(lattices);
    let mut inner = pixels;
    for _ in 0..lattices {
        inner = (inner + 2) / 2;
        points.push(inner + 2);
    }
    points
}

/// All lattices over pictures of one size, used again and again.
pub(crate) struct Pyramid<T> {
    /// The photo's moments, from lattice 1 on.
    pub moments: Vec<Plane<T>>,
    /// What each lattice and those above it sum to.
    pub sums: Vec<Plane<T>>,
}

impl<T: Real> Pyramid<T> {
    /// The moments of a photo on `lattices` of them.
    pub fn moments_of(photo: &Plane<T>, lattices: usize) -> Vec<Plane<T>> {
        let [columns, rows] = [photo.width(), photo.height()].map(|pixels| points(pixels, lattices));
        let moments = columns.iter().zip(&rows).map(|(width, height)| Plane::new(*width, *height)).collect();
        let mut pyramid = Self { moments, sums: Vec::new() };
        pyramid.reduce(Arch::new(), photo);
        pyramid.moments
    }

    /// `lattices` of them.
    pub fn new(size: [usize; 2], lattices: usize) -> Self {
        let [columns, rows] = size.map(|pixels| points(pixels, lattices));
        let planes = || columns.iter().zip(&rows).map(|(width, height)| Plane::new(*width, *height)).collect();
        Self { moments: planes(), sums: planes() }
    }

    /// `lattices` of them, the first of which has so many points.
    pub fn from_first(first: [usize; 2], lattices: usize) -> Self {
        // What has that many points on lattice 1.
        Self::new(first.map(|points| 2 * (points - 3)), lattices)
    }

    /// From lattice 1 on.
    pub fn moments(&self) -> &[Plane<T>] {
        &self.moments
    }

    /// What the last sweep came to on lattice 1; none if there is no lattice.
    pub fn finest(&self) -> Option<&Plane<T>> {
        self.sums.first()
    }

    /// The moments of a photo.
    pub fn reduce(&mut self, arch: Arch, photo: &Plane<T>) {
        if let Some(first) = self.moments.first_mut() {
            reduce(arch, photo, &FIRST, first);
        }
        self.reduce_further(arch);
    }

    /// Those of all lattices from the first.
    pub fn reduce_further(&mut self, arch: Arch) {
        (1..self.moments.len()).for_each(|level| self.reduce_to(arch, level));
    }

    /// Those of a lattice from the one before it.
    pub fn reduce_to(&mut self, arch: Arch, level: usize) {
        let (below, above) = self.moments.split_at_mut(level);
        reduce(arch, &below[level - 1], &NEXT, &mut above[0]);
    }

    /// What the Gaussians of all lattices sum to, for each lattice's terms from lattice 1 on.
    pub fn sweep(&mut self, arch: Arch, photo: &Plane<T>, lattices: &[Vec<Separable<T>>]) {
        self.reduce(arch, photo);
        for level in (0..self.sums.len()).rev() {
            let (fine, coarse) = self.sums.split_at_mut(level + 1);
            let sum = &mut fine[level];
            let mut into = Into::Set;
            if let Some(coarse) = coarse.first() {
                expand(arch, coarse, &NEXT, sum);
                into = Into::Add;
            }
            for term in &lattices[level] {
                convolve(arch, &self.moments[level], term, sum, into);
                into = Into::Add;
            }
        }
    }
}
