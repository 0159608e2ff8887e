//! Cells of light → their veil in some directions, and how far that may be off.
//!
//! A cell's light f at directions v about its centre c gives Σ f k(|u − v|²), and with q = |u − c|² and Δ = |u − v|² − q = −2 u·(v − c)
//!
//! ```text
//! Σ f k = k(q) F − 2 k'(q) u·D + ½ k''(q) Σ f Δ² + …      F = Σ f,  D = Σ f (v − c)
//! ```
//!
//! Of Σ f Δ² the spread S = Σ f |v − c|² knows the half that light spread alike in all directions has: 2 q (1 − q/4) S. It is between
//! nothing and twice that.

use glam::DVec3;
use rayon::prelude::*;

use super::cut::{Cut, Kept};
use super::tree::{Cell, Tree};
use crate::veil::Tabled;

/// Light, and how it is summed.
pub(super) struct Sum<'a> {
    pub tree: &'a Tree,
    pub cut: &'a Cut,
    pub scatter: &'a Tabled,
    /// A cell counts at once where its radius is at most so many times its distance, both by the chord.
    pub opening: f64,
}

/// Directions that are summed together.
const TOGETHER: usize = 4;

impl Sum<'_> {
    /// The veil in each direction, RGB.
    pub fn at(&self, directions: &[DVec3]) -> Vec<[f64; 3]> {
        directions.par_chunks(TOGETHER).flat_map_iter(|directions| self.together(directions)).collect()
    }

    /// The veil in neighbouring directions.
    fn together(&self, directions: &[DVec3]) -> Vec<[f64; 3]> {
        let middle = directions.iter().sum::<DVec3>() / directions.len() as f64;
        let reach = directions.iter().map(|direction| direction.distance(middle)).fold(0.0, f64::max);
        let mut veils = vec![[0.0; 3]; directions.len()];
        self.each(middle, reach, |cell| {
            for (veil, direction) in veils.iter_mut().zip(directions) {
                let of = self.of(cell, *direction);
                (0..3).for_each(|k| veil[k] += of[k]);
            }
        });
        veils
    }

    /// What the veil of one direction may be off by, RGB, beside rounding.
    pub fn bound(&self, direction: DVec3) -> [f64; 3] {
        let mut bound = [0.0; 3];
        self.each(direction, 0.0, |cell| {
            let square = direction.distance_squared(cell.centre);
            let slopes = self.scatter.at(square);
            // Of the second order what is not known, and the third where the cell is nearest.
            let nearest = (square.sqrt() - cell.radius).max(0.1 * square.sqrt());
            let second = slopes.second.abs() * square * (1.0 - 0.25 * square).max(0.0);
            let third = self.scatter.at(nearest * nearest).third * square.powf(1.5) * cell.radius * (4.0 / 3.0);
            (0..3).for_each(|k| bound[k] += (second + third) * cell.spread[k]);
        });
        bound
    }

    /// Hands the cells that count at once about a direction to `take`.
    fn each(&self, middle: DVec3, reach: f64, mut take: impl FnMut(&Cell)) {
        let mut open: Vec<Kept> = self.cut.roots().to_vec();
        while let Some(kept) = open.pop() {
            let cell = self.cut.cell(self.tree, kept);
            let distance = middle.distance(cell.centre) - reach;
            let is_far = cell.radius <= self.opening * distance;
            if is_far || !self.cut.each(self.tree, kept, |child| open.push(child)) {
                take(cell);
            }
        }
    }

    fn of(&self, cell: &Cell, direction: DVec3) -> [f64; 3] {
        let square = direction.distance_squared(cell.centre);
        let slopes = self.scatter.at(square);
        let second = slopes.second * square * (1.0 - 0.25 * square);
        [0, 1, 2].map(|k| {
            let first = -2.0 * direction.dot(cell.dipole[k]);
            slopes.value * cell.flux[k] + slopes.first * first + second * cell.spread[k]
        })
    }
}
