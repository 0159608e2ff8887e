//! cos nωx and sin nωx of a light's position: computed anew, by rotation, or from a table over positions.

use std::f64::consts::TAU;
use std::ops::{Add, AddAssign, Mul, Sub};

/// f32 or f64.
pub(super) trait Real:
    Copy + Default + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + AddAssign
{
    fn of(value: f64) -> Self;
    fn wide(self) -> f64;
}

impl Real for f32 {
    fn of(value: f64) -> Self {
        value as f32
    }

    fn wide(self) -> f64 {
        f64::from(self)
    }
}

impl Real for f64 {
    fn of(value: f64) -> Self {
        value
    }

    fn wide(self) -> f64 {
        self
    }
}

/// A light: its place in the period along x and y, each from 0 to 1, and its weight.
#[derive(Debug, Clone, Copy)]
pub(super) struct Light {
    pub turn: [f64; 2],
    pub weight: f64,
}

/// (cos, sin) of harmonics 0 to N at each of `entries` places of a period, place after place.
pub(super) struct Table<R> {
    entries: usize,
    modes: usize,
    values: Vec<[R; 2]>,
}

impl<R: Real> Table<R> {
    pub fn new(entries: u32, degree: u32) -> Self {
        let cis = |place: u32, n: u32| {
            // The phase is reduced as a whole number of entries.
            let turn = u64::from(place) * u64::from(n) % u64::from(entries);
            let (sin, cos) = (TAU * turn as f64 / f64::from(entries)).sin_cos();
            [R::of(cos), R::of(sin)]
        };
        let values = (0..entries).flat_map(|place| (0..=degree).map(move |n| cis(place, n))).collect();
        Self { entries: entries as usize, modes: degree as usize + 1, values }
    }

    pub fn bytes(&self) -> usize {
        size_of_val(self.values.as_slice())
    }

    fn row(&self, place: usize) -> &[[R; 2]] {
        let place = place % self.entries;
        &self.values[place * self.modes..][..self.modes]
    }
}

/// Where harmonics come from.
pub(super) enum Source<'a, R> {
    /// cos and sin of each harmonic.
    Compute,
    /// cos and sin of the first, then a rotation from each to the next.
    Rotate,
    /// The nearest entry of a table.
    Nearest(&'a Table<R>),
    /// Between the two nearest entries.
    Linear(&'a Table<R>),
}

impl<R: Real> Source<'_, R> {
    /// The harmonics at a place in the period, 0 to 1.
    pub fn fill(&self, turn: f64, harmonics: &mut [[R; 2]]) {
        match self {
            Self::Compute => {
                for (n, harmonic) in (0u32..).zip(harmonics) {
                    let (sin, cos) = (TAU * (f64::from(n) * turn)).sin_cos();
                    *harmonic = [R::of(cos), R::of(sin)];
                }
            }
            Self::Rotate => {
                let (sin, cos) = (TAU * turn).sin_cos();
                let mut at = [1.0, 0.0];
                for harmonic in harmonics {
                    *harmonic = at.map(R::of);
                    at = [at[0] * cos - at[1] * sin, at[0] * sin + at[1] * cos];
                }
            }
            Self::Nearest(table) => {
                let place = (turn * table.entries as f64 + 0.5) as usize;
                harmonics.copy_from_slice(table.row(place));
            }
            Self::Linear(table) => {
                let place = turn * table.entries as f64;
                let (first, fraction) = (place as usize, R::of(place.fract()));
                let rows = table.row(first).iter().zip(table.row(first + 1));
                for (harmonic, (a, b)) in harmonics.iter_mut().zip(rows) {
                    *harmonic = [a[0] + fraction * (b[0] - a[0]), a[1] + fraction * (b[1] - a[1])];
                }
            }
        }
    }
}

/// Σ w (cos, sin) over the lights, for each harmonic of x.
pub(super) fn line<R: Real>(lights: &[Light], source: &Source<'_, R>, degree: u32) -> Vec<[R; 2]> {
    let modes = degree as usize + 1;
    let (mut sums, mut harmonics) = (vec![[R::default(); 2]; modes], vec![[R::default(); 2]; modes]);
    for light in lights {
        source.fill(light.turn[0], &mut harmonics);
        let weight = R::of(light.weight);
        for (sum, harmonic) in sums.iter_mut().zip(&harmonics) {
            sum[0] += weight * harmonic[0];
            sum[1] += weight * harmonic[1];
        }
    }
    sums
}

/// The same in two dimensions: Σ w (cC, cS, sC, sS) for each pair of harmonics, the notes' A, B, C, D.
pub(super) fn plane<R: Real>(lights: &[Light], source: &Source<'_, R>, degree: u32) -> Vec<[R; 4]> {
    let modes = degree as usize + 1;
    let mut sums = vec![[R::default(); 4]; modes * modes];
    let (mut x, mut y) = (vec![[R::default(); 2]; modes], vec![[R::default(); 2]; modes]);
    for light in lights {
        source.fill(light.turn[0], &mut x);
        source.fill(light.turn[1], &mut y);
        let weight = R::of(light.weight);
        for (row, x) in sums.chunks_exact_mut(modes).zip(&x) {
            let x = x.map(|value| weight * value);
            for (sum, y) in row.iter_mut().zip(&y) {
                sum[0] += x[0] * y[0];
                sum[1] += x[0] * y[1];
                sum[2] += x[1] * y[0];
                sum[3] += x[1] * y[1];
            }
        }
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::*;

    fn worst(source: &Source<'_, f64>, degree: u32) -> f64 {
        let mut harmonics = vec![[0.0; 2]; degree as usize + 1];
        let mut worst: f64 = 0.0;
        for i in 0..1000 {
            let turn = (0.618_033_988_749_894_9 * f64::from(i)).fract();
            source.fill(turn, &mut harmonics);
            for (n, [cos, sin]) in harmonics.iter().enumerate() {
                let phase = TAU * (n as f64 * turn);
                worst = worst.max((cos - phase.cos()).abs()).max((sin - phase.sin()).abs());
            }
        }
        worst
    }

    #[test]
    fn tables_are_off_by_what_their_spacing_says() {
        const DEGREE: u32 = 16;
        for entries in [64, 256, 1024] {
            let table = Table::new(entries, DEGREE);
            // The steepest harmonic within half a step; and its curvature over a whole one.
            let step = TAU * f64::from(DEGREE) / f64::from(entries);
            let (nearest, linear) = (worst(&Source::Nearest(&table), DEGREE), worst(&Source::Linear(&table), DEGREE));
            assert!((0.8..=1.0).contains(&(nearest / (0.5 * step).min(2.0))), "{entries}: {nearest}");
            assert!((0.7..=1.01).contains(&(linear / (step * step / 8.0))), "{entries}: {linear}");
        }
        // The phase 2π n x is itself off by n roundings.
        assert!(worst(&Source::Rotate, DEGREE) < 5e-14);
    }

    #[test]
    fn places_beside_the_end_of_the_period_wrap() {
        let table = Table::<f64>::new(8, 2);
        let mut harmonics = [[0.0; 2]; 3];
        Source::Nearest(&table).fill(0.99, &mut harmonics);
        assert_eq!(harmonics, [[1.0, 0.0]; 3]);
        Source::Linear(&table).fill(15.0 / 16.0, &mut harmonics);
        assert!((harmonics[1][0] - 0.5 * (1.0 + 0.5f64.sqrt())).abs() < 1e-15);
    }

    #[test]
    fn the_plane_of_lights_on_the_axis_holds_the_line() {
        let lights = [0.1, 0.4, 0.77].map(|x| Light { turn: [x, 0.0], weight: 2.0 * x });
        let (line, plane) = (line::<f64>(&lights, &Source::Compute, 3), plane::<f64>(&lights, &Source::Compute, 3));
        for (n, [cos, sin]) in line.into_iter().enumerate() {
            for m in 0..4 {
                let [a, b, c, d] = plane[4 * n + m];
                assert!((a - cos).abs() < 1e-15 && (c - sin).abs() < 1e-15 && b == 0.0 && d == 0.0);
            }
        }
    }
}
