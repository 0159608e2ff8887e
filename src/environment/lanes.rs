//! The veil of cells in a tile of directions at once, a lane for each.

use std::ops::{Add, AddAssign, Mul, Sub};

use glam::DVec3;

use super::tree::Cell;
use crate::veil::Tabled;

/// Directions along each side of a tile, and in it.
pub(super) const TILE: usize = 4;
pub(super) const LANES: usize = TILE * TILE;

/// Tolerances from which on 32-bit floats do.
const SINGLE: f64 = 1e-3;

/// Places in each octave of the square of a chord, as a power of 2: those of [`Tabled`].
const PLACES: u32 = 6;

/// The least square that is tabled, 2^-24, of a chord of 0.014 degrees, nearer than any light beyond a band; and the octaves up to 4,
/// that of opposite directions, which is in the last.
const LEAST: f64 = 1.0 / (1 << 24) as f64;
const OCTAVES: u32 = 27;

/// As many as there are, rounded up to a power of 2, which an index cannot leave.
const PIECES: usize = ((OCTAVES << PLACES) as usize).next_power_of_two();

/// Floats of one kind.
pub(super) trait Real:
    Copy + PartialOrd + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + AddAssign + Send + Sync
{
    const ZERO: Self;
    /// Rounding of a sum, relative to it: that of a chord's square, which is a difference, by the slope of a function that falls by its
    /// third power.
    const ROUNDING: f64;

    fn of(value: f64) -> Self;
    fn to_f64(self) -> f64;
    /// The number of the interval in which a value lies, counted from that of [`LEAST`], and how far it lies from the middle.
    fn placed(self) -> (usize, Self);
}

macro_rules! real {
    ($float:ty, $rounding:literal) => {
        impl Real for $float {
            const ZERO: Self = 0.0;
            const ROUNDING: f64 = $rounding;

            #[inline(always)]
            fn of(value: f64) -> Self {
                value as $float
            }

            #[inline(always)]
            fn to_f64(self) -> f64 {
                f64::from(self)
            }

            #[inline(always)]
            fn placed(self) -> (usize, Self) {
                const REST: u32 = <$float>::MANTISSA_DIGITS - 1 - PLACES;
                let least = LEAST as $float;
                let value = if self > least { self } else { least };
                let bits = value.to_bits();
                let middle = <$float>::from_bits((bits >> REST << REST) | (1 << (REST - 1)));
                let index = (bits >> REST) - (least.to_bits() >> REST);
                (index as usize % PIECES, value - middle)
            }
        }
    };
}

real!(f32, 2e-5);
real!(f64, 1e-13);

/// A function by the square of the chord: for each interval the coefficients of a cubic about its middle.
pub(super) struct Table<T>(Box<[[T; 4]; PIECES]>);

/// A function in the floats that a tolerance asks for.
pub(super) enum Summed {
    Single(Table<f32>),
    Double(Table<f64>),
}

impl Summed {
    pub fn new(scatter: &Tabled, tolerance: f64) -> Self {
        if tolerance >= SINGLE { Self::Single(Table::new(scatter)) } else { Self::Double(Table::new(scatter)) }
    }

    /// What rounding leaves, relative to the veil.
    pub fn rounding(&self) -> f64 {
        match self {
            Self::Single(_) => f32::ROUNDING,
            Self::Double(_) => f64::ROUNDING,
        }
    }
}

impl<T: Real> Table<T> {
    fn new(scatter: &Tabled) -> Self {
        let places = f64::from(1 << PLACES);
        let piece = |index: usize| {
            let octave = LEAST * 2f64.powi((index >> PLACES) as i32);
            let low = octave * (1.0 + (index % (1 << PLACES)) as f64 / places);
            let half = 0.5 * octave / places;
            scatter.cubic((low + half).min(4.0)).map(T::of)
        };
        let pieces: Vec<[T; 4]> = (0..PIECES).map(piece).collect();
        Self(pieces.try_into().unwrap_or_else(|_| unreachable!("there are as many")))
    }
}

/// Directions of a tile, and the veil there so far, RGB.
pub(super) struct Tile<'a, T> {
    table: &'a Table<T>,
    directions: [[T; LANES]; 3],
    veils: [[T; LANES]; 3],
}

impl<'a, T: Real> Tile<'a, T> {
    /// Of no more directions than there are lanes; the last stands for those that are missing.
    pub fn new(table: &'a Table<T>, directions: &[DVec3]) -> Self {
        let of = |lane: usize| directions[lane.min(directions.len() - 1)];
        let axis = |axis: usize| std::array::from_fn(|lane| T::of(of(lane)[axis]));
        Self { table, directions: [0, 1, 2].map(axis), veils: [[T::ZERO; LANES]; 3] }
    }

    /// Adds the veil of a cell, to the second order: as `sum` says.
    #[inline(always)]
    pub fn add(&mut self, cell: &Cell) {
        let [x, y, z] = &self.directions;
        let centre = cell.centre.to_array().map(T::of);
        let mut square = [T::ZERO; LANES];
        for lane in 0..LANES {
            let way = [x[lane] - centre[0], y[lane] - centre[1], z[lane] - centre[2]];
            square[lane] = way[0] * way[0] + way[1] * way[1] + way[2] * way[2];
        }
        let mut off = [T::ZERO; LANES];
        let mut cubic = [[T::ZERO; LANES]; 4];
        for lane in 0..LANES {
            let (index, rest) = square[lane].placed();
            off[lane] = rest;
            let piece = self.table.0[index];
            (0..4).for_each(|k| cubic[k][lane] = piece[k]);
        }
        let [a, b, c, d] = &cubic;
        let [two, three, six, quarter] = [2.0, 3.0, 6.0, 0.25].map(T::of);
        let (mut value, mut first, mut second) = (square, square, square);
        for lane in 0..LANES {
            let (q, x) = (square[lane], off[lane]);
            value[lane] = a[lane] + x * (b[lane] + x * (c[lane] + x * d[lane]));
            first[lane] = T::of(-2.0) * (b[lane] + x * (two * c[lane] + three * x * d[lane]));
            second[lane] = (two * c[lane] + six * x * d[lane]) * (q - quarter * q * q);
        }
        for (colour, veils) in self.veils.iter_mut().enumerate() {
            let [flux, spread] = [cell.flux[colour], cell.spread[colour]].map(T::of);
            let dipole = cell.dipole[colour].to_array().map(T::of);
            for lane in 0..LANES {
                let along = x[lane] * dipole[0] + y[lane] * dipole[1] + z[lane] * dipole[2];
                veils[lane] += value[lane] * flux + first[lane] * along + second[lane] * spread;
            }
        }
    }

    /// The veil in so many directions from the first on, RGB.
    pub fn veils(&self, count: usize) -> impl Iterator<Item = [f64; 3]> {
        (0..count).map(|lane| self.veils.each_ref().map(|veils| veils[lane].to_f64()))
    }
}

#[cfg(test)]
mod tests {
    use super::super::sum::second_order;
    use super::*;
    use crate::chance::Chance;
    use crate::psf::{Observer, Psf};

    /// Cells near and far, in both floats, against the sum in 64-bit floats by the function's own table.
    #[test]
    fn a_tile_is_its_directions_one_by_one() {
        let psf = Psf::cie(Observer::new(25.0, 0.5).unwrap());
        let scatter = Tabled::new(|angle| psf.value(angle));
        let mut chance = Chance::new(11);
        let directions: Vec<DVec3> =
            (0..13).map(|k| DVec3::new(0.01 * f64::from(k % 4), 0.01 * f64::from(k / 4), 1.0).normalize()).collect();
        for _ in 0..300 {
            let away = 0.1 * 30f64.powf(chance.between(0.0, 1.0));
            let turn = chance.between(0.0, 6.3);
            let centre = DVec3::new(away.sin() * turn.cos(), away.sin() * turn.sin(), away.cos());
            let size = 0.1 * away;
            let cell = Cell {
                flux: [1.0, 3.0, 0.0],
                dipole: [DVec3::X * size * 0.1, DVec3::ZERO, DVec3::ZERO],
                spread: [size * size * 0.3, size * size, 0.0],
                centre,
                radius: size,
            };
            let wanted: Vec<[f64; 3]> =
                directions.iter().map(|direction| second_order(&cell, *direction, &scatter)).collect();
            let off = |veils: Vec<[f64; 3]>| {
                let pairs = veils.iter().flatten().zip(wanted.iter().flatten());
                pairs.map(|(veil, wanted)| (veil - wanted).abs() / wanted.max(1e-30)).fold(0.0, f64::max)
            };
            let single = Table::<f32>::new(&scatter);
            let mut tile = Tile::new(&single, &directions);
            tile.add(&cell);
            let singles = off(tile.veils(13).collect());
            let double = Table::<f64>::new(&scatter);
            let mut tile = Tile::new(&double, &directions);
            tile.add(&cell);
            let doubles = off(tile.veils(13).collect());
            assert!(singles < f32::ROUNDING && doubles < 1e-12, "{away}: {singles:e} {doubles:e}");
        }
    }

    /// From the least square to that of opposite directions no index is taken for another.
    #[test]
    fn every_square_has_its_interval() {
        for square in [0.0, LEAST, 1e-3, 0.7, 1.0, 3.999, 4.0, 4.000_001] {
            let (single, double) = ((square as f32).placed(), square.placed());
            let index = ((square.max(LEAST) / LEAST).log2() * f64::from(1 << PLACES)) as usize;
            assert!(
                single.0.abs_diff(double.0) <= 1 && single.0.abs_diff(index) <= 8,
                "{square}: {single:?} {double:?}"
            );
            assert!(single.0 < PIECES && double.1.abs() <= square.max(LEAST) / f64::from(1 << PLACES), "{square}");
        }
    }
}
