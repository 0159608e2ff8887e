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
use pulp::Arch;
use rayon::prelude::*;

use super::cut::{Cut, Kept};
use super::lanes::{Real, Summed, TILE, Table, Tile};
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

impl Sum<'_> {
    /// The veil in directions of rows that are so long, RGB.
    pub fn at(&self, summed: &Summed, directions: &[DVec3], columns: usize) -> Vec<[f64; 3]> {
        match summed {
            Summed::Single(table) => self.tiled(table, directions, columns),
            Summed::Double(table) => self.tiled(table, directions, columns),
        }
    }

    fn tiled<T: Real>(&self, table: &Table<T>, directions: &[DVec3], columns: usize) -> Vec<[f64; 3]> {
        let rows = directions.len() / columns;
        let across = columns.div_ceil(TILE);
        let members = |tile: usize| {
            let (left, top) = (TILE * (tile % across), TILE * (tile / across));
            let rows = top..rows.min(top + TILE);
            rows.flat_map(move |row| (left..columns.min(left + TILE)).map(move |column| row * columns + column))
        };
        let tile = |tile: usize| {
            let directions: Vec<DVec3> = members(tile).map(|member| directions[member]).collect();
            let mut veils = Tile::new(table, &directions);
            let middle = directions.iter().sum::<DVec3>() / directions.len() as f64;
            let reach = directions.iter().map(|direction| direction.distance(middle)).fold(0.0, f64::max);
            Arch::new().dispatch(
                #[inline(always)]
                || {
                    self.each(
                        middle,
                        reach,
                        #[inline(always)]
                        |cell| veils.add(cell),
                    )
                },
            );
            veils.veils(directions.len()).collect::<Vec<_>>()
        };
        let tiles: Vec<Vec<[f64; 3]>> = (0..across * rows.div_ceil(TILE)).into_par_iter().map(tile).collect();
        let mut all = vec![[0.0; 3]; directions.len()];
        for (tile, veils) in tiles.iter().enumerate() {
            members(tile).zip(veils).for_each(|(member, veil)| all[member] = *veil);
        }
        all
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
    #[inline(always)]
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
}

/// The veil of a cell in a direction, to the second order.
#[cfg(test)]
pub(super) fn second_order(cell: &Cell, direction: DVec3, scatter: &Tabled) -> [f64; 3] {
    let square = direction.distance_squared(cell.centre);
    let [value, first, half, _] = scatter.cubic(square);
    let second = 2.0 * half * square * (1.0 - 0.25 * square);
    [0, 1, 2].map(|k| value * cell.flux[k] - 2.0 * first * direction.dot(cell.dipole[k]) + second * cell.spread[k])
}
