//! A panorama as cells of light: its pixels, fours of these, fours of those, and so on.

use std::f64::consts::PI;

use glam::DVec3;
use rayon::prelude::*;

use crate::photo::Photo;
use crate::series::sphere::Grid;

/// Rows of the finest cells, at most; pixels of a larger panorama are taken together, with where their light lies.
const ROWS: usize = 512;

/// Rows of the coarsest cells, at most.
const FEW: usize = 4;

/// Light of some directions, by its moments about one of them.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Cell {
    /// ∫ L dΩ, RGB.
    pub flux: [f64; 3],
    /// ∫ L (v − centre) dΩ, RGB.
    pub dipole: [DVec3; 3],
    /// ∫ L |v − centre|² dΩ, RGB.
    pub spread: [f64; 3],
    /// A unit vector in the middle of its light.
    pub centre: DVec3,
    /// No direction of it is farther from the centre, by the chord.
    pub radius: f64,
}

/// Cells of a panorama, the finest first; each next level has four of the one before in one.
pub(super) struct Tree {
    levels: Vec<Level>,
    /// Columns and rows of pixels in a finest cell.
    block: usize,
    pixels: Grid,
}

struct Level {
    grid: Grid,
    /// Columns and rows of the finest level in a cell.
    side: usize,
    cells: Vec<Cell>,
}

/// A cell's place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Place {
    pub level: usize,
    pub column: usize,
    pub row: usize,
}

impl Tree {
    /// Of a photo that is twice as wide as high. Negative light is none.
    pub fn new(photo: &Photo) -> Self {
        let mut levels = vec![finest(photo)];
        while levels.last().is_some_and(|level| level.grid.height > FEW) {
            let next = coarser(&levels);
            levels.push(next);
        }
        let [width, height] = [photo.width(), photo.height()].map(|side| side as usize);
        Self { levels, block: block(height), pixels: Grid { width, height } }
    }

    /// The panorama's pixels.
    pub fn pixels(&self) -> Grid {
        self.pixels
    }

    pub fn cell(&self, place: Place) -> &Cell {
        let level = &self.levels[place.level];
        &level.cells[place.row * level.grid.width + place.column]
    }

    /// The coarsest cells.
    pub fn roots(&self) -> impl Iterator<Item = Place> {
        let level = self.levels.len() - 1;
        let Grid { width, height } = self.levels[level].grid;
        (0..height).flat_map(move |row| (0..width).map(move |column| Place { level, column, row }))
    }

    /// The four cells that are in one, or fewer at an end; none in the finest.
    pub fn children(&self, place: Place) -> impl Iterator<Item = Place> {
        let below = place.level.checked_sub(1).map(|level| (level, self.levels[level].grid));
        below.into_iter().flat_map(move |(level, grid)| {
            let (columns, rows) = (2 * place.column..grid.width.min(2 * place.column + 2), 2 * place.row);
            (rows..grid.height.min(rows + 2))
                .flat_map(move |row| columns.clone().map(move |column| Place { level, column, row }))
        })
    }

    /// The pixels of a finest cell, by column and row.
    pub fn pixels_of(&self, place: Place) -> impl Iterator<Item = (usize, usize)> {
        let of = |at: usize, end: usize| self.block * at..end.min(self.block * (at + 1));
        let (columns, rows) = (of(place.column, self.pixels.width), of(place.row, self.pixels.height));
        rows.flat_map(move |row| columns.clone().map(move |column| (column, row)))
    }
}

/// Columns and rows of pixels in a finest cell of a panorama of so many rows.
fn block(rows: usize) -> usize {
    rows.div_ceil(ROWS)
}

/// Blocks of pixels.
fn finest(photo: &Photo) -> Level {
    let [width, height] = [photo.width(), photo.height()].map(|side| side as usize);
    let block = block(height);
    let pixels = Grid { width, height };
    let grid = Grid { width: width.div_ceil(block), height: height.div_ceil(block) };
    let cell = |at: usize| {
        let (column, row) = (at % grid.width, at / grid.width);
        let (columns, rows) =
            (block * column..width.min(block * (column + 1)), block * row..height.min(block * (row + 1)));
        let inside = rows.flat_map(|row| columns.clone().map(move |column| (column, row)));
        Cell::joined(inside.map(|(column, row)| Cell::pixel(photo, pixels, column, row)), || {
            edges(pixels, [block * column, block * row], block)
        })
    };
    let cells = (0..grid.width * grid.height).into_par_iter().with_min_len(512).map(cell).collect();
    Level { grid, side: 1, cells }
}

fn coarser(levels: &[Level]) -> Level {
    let (first, below) = (levels[0].grid, &levels[levels.len() - 1]);
    let side = 2 * below.side;
    let grid = Grid { width: below.grid.width.div_ceil(2), height: below.grid.height.div_ceil(2) };
    let cell = |at: usize| {
        let (column, row) = (at % grid.width, at / grid.width);
        let rows = 2 * row..below.grid.height.min(2 * row + 2);
        let columns = 2 * column..below.grid.width.min(2 * column + 2);
        let inside =
            rows.flat_map(|row| columns.clone().map(move |column| below.cells[row * below.grid.width + column]));
        Cell::joined(inside, || edges(first, [side * column, side * row], side))
    };
    let cells = (0..grid.width * grid.height).into_par_iter().with_min_len(64).map(cell).collect();
    Level { grid, side, cells }
}

/// Directions on the rim of a block of pixels: no others of it are farther from a direction within, but for a little.
fn edges(grid: Grid, [column, row]: [usize; 2], side: usize) -> [DVec3; 9] {
    let end = |first: usize, length: usize| (first + side).min(length) as f64;
    let (left, right) = (column as f64, end(column, grid.width));
    let (top, low) = (row as f64, end(row, grid.height));
    let [across, down] = [[left, 0.5 * (left + right), right], [top, 0.5 * (top + low), low]];
    std::array::from_fn(|k| grid.direction(across[k % 3] - 0.5, down[k / 3] - 0.5))
}

impl Cell {
    /// Of a pixel, which shines evenly.
    pub fn pixel(photo: &Photo, grid: Grid, column: usize, row: usize) -> Self {
        let centre = grid.direction(column as f64, row as f64);
        let side = PI / grid.height as f64;
        // ∫ |v − centre|² over it, and how far inside the sphere its middle lies by that.
        let across = side * centre.truncate().length();
        let spread = (side * side + across * across) / 12.0;
        let pixel = photo.pixels[row * grid.width + column];
        let flux = [0, 1, 2].map(|k| grid.solid_angle(row) * f64::from(pixel[k]).max(0.0));
        let radius = 0.5 * side.hypot(across);
        Self {
            flux,
            dipole: flux.map(|flux| -0.5 * spread * flux * centre),
            spread: flux.map(|flux| spread * flux),
            centre,
            radius,
        }
    }

    /// Several in one, whose rim is `edges`.
    fn joined(cells: impl Iterator<Item = Self> + Clone, edges: impl Fn() -> [DVec3; 9]) -> Self {
        let joined = Self::sum(cells, edges()[4]);
        let radius = edges().iter().map(|edge| edge.distance(joined.centre)).fold(0.0, f64::max);
        // Between those that were looked at.
        Self { radius: 1.02 * radius, ..joined }
    }

    /// The moments of several; `middle` is the centre where there is no light. Its radius is that of those that shine.
    pub fn sum(cells: impl Iterator<Item = Self> + Clone, middle: DVec3) -> Self {
        let mut weighted = DVec3::ZERO;
        let mut flux = [0.0; 3];
        for cell in cells.clone() {
            weighted += cell.flux.iter().sum::<f64>() * cell.centre;
            (0..3).for_each(|k| flux[k] += cell.flux[k]);
        }
        let centre = weighted.try_normalize().unwrap_or(middle);
        let mut joined = Self { flux, centre, ..Self::default() };
        for cell in cells.filter(|cell| cell.flux != [0.0; 3]) {
            let way = cell.centre - centre;
            for k in 0..3 {
                joined.dipole[k] += cell.dipole[k] + cell.flux[k] * way;
                joined.spread[k] +=
                    cell.spread[k] + 2.0 * way.dot(cell.dipole[k]) + cell.flux[k] * way.length_squared();
            }
            joined.radius = joined.radius.max(way.length() + cell.radius);
        }
        joined
    }

    /// So many times its light.
    pub fn times(&self, share: f64) -> Self {
        Self {
            flux: self.flux.map(|flux| share * flux),
            dipole: self.dipole.map(|dipole| share * dipole),
            spread: self.spread.map(|spread| share * spread),
            ..*self
        }
    }

    /// A share of its light in a part of it, of some radius about a direction; no more than evenly spread there.
    pub fn part(&self, share: f64, middle: DVec3, radius: f64) -> Self {
        let flux = self.flux.map(|flux| share * flux);
        // Of a square of that half diagonal.
        let spread = radius * radius / 3.0;
        Self {
            flux,
            dipole: flux.map(|flux| -0.5 * spread * flux * middle),
            spread: flux.map(|flux| spread * flux),
            centre: middle,
            radius,
        }
    }

    /// Whether it gives no light.
    pub fn is_dark(&self) -> bool {
        self.flux == [0.0; 3]
    }
}
