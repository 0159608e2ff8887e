//! The diffraction pattern of an aperture in red, green and blue, in polar coordinates.
//!
//! Lengths on the sensor are in λ₀N, λ₀ = 0.55 µm times the f-number, so that a pattern is of the aperture's shape alone. Of
//! directions there is half of the angle between spikes, closer the nearer they are to one: at any distance a spike is as wide
//! as it is near the centre. How a direction is computed stands in `slices`.

use std::f64::consts::TAU;

use rayon::prelude::*;

use super::aperture::Aperture;
use super::slices::{LAST, NEAR, ROWS, ROWS_A_DOUBLING, Slices};

/// Directions near a spike lie `GROWTH` times as far apart as they are from it, `CLOSEST` at least, a tenth of λ₀N in the last row,
/// and `FARTHEST` at most, in radians.
const GROWTH: f64 = 0.04;
const CLOSEST: f64 = 0.1 / LAST;
const FARTHEST: f64 = 0.012;
/// Up to this angle from a straight blade's spike, in radians, it is continued beyond the last row at its width.
const SPIKE: f64 = 0.05;

/// Light for each square of λ₀N, of a point whose light is 1 in each channel.
#[derive(Debug)]
pub(super) struct Pattern {
    aperture: Aperture,
    directions: Directions,
    /// Radii of the rows from [`NEAR`] on.
    radii: Vec<f64>,
    /// Row by row, each of all directions.
    near: Vec<[f32; 3]>,
    /// Likewise, times the cubed radius.
    far: Vec<[f32; 3]>,
    /// ∫ S r dr from the radius of each row on, near and far.
    tails: Vec<[f32; 3]>,
    /// Of a bent blade's pattern, by which power of the radius each direction falls beyond the last row.
    powers: Vec<[f32; 3]>,
}

/// Angles from a spike.
#[derive(Debug)]
struct Directions {
    angles: Vec<f64>,
    /// The first of those that are equally far apart, and how far.
    even: usize,
    step: f64,
}

impl Directions {
    fn new(aperture: Aperture) -> Self {
        if aperture.is_round() {
            return Self { angles: vec![0.0], even: 0, step: 1.0 };
        }
        let base = CLOSEST / GROWTH;
        let all = aperture.sector();
        let most = (all / base).asinh() / GROWTH - 1.0;
        let even = ((FARTHEST / CLOSEST).acosh() / GROWTH).min(most) as usize;
        let mut angles: Vec<f64> = (0..=even).map(|k| base * (GROWTH * k as f64).sinh()).collect();
        let rest = ((all - angles[even]) / FARTHEST).ceil().max(1.0);
        let step = (all - angles[even]) / rest;
        let begin = angles[even];
        angles.extend((1..=rest as usize).map(|k| begin + step * k as f64));
        Self { angles, even, step }
    }

    /// Between which two an angle from a spike lies: the first, and how far it is on the way to the second.
    fn place(&self, angle: f64) -> (usize, f32) {
        let count = self.angles.len();
        if count == 1 {
            return (0, 0.0);
        }
        let at = if angle < self.angles[self.even] {
            // The inverse of the sine above, without the care that small numbers would take.
            let x = angle * (GROWTH / CLOSEST);
            (x + (x * x + 1.0).sqrt()).ln() / GROWTH
        } else {
            self.even as f64 + (angle - self.angles[self.even]) / self.step
        };
        let at = at.clamp(0.0, (count - 1) as f64);
        let first = (at as usize).min(count - 2);
        (first, (at - first as f64) as f32)
    }

    /// The angles, and the part of the whole turn's radians that each stands for.
    fn weights(&self, aperture: Aperture) -> Vec<f64> {
        let last = self.angles.len() - 1;
        if last == 0 {
            return vec![TAU];
        }
        let copies = TAU / aperture.sector();
        let gap = |k: usize| self.angles[(k + 1).min(last)] - self.angles[k.saturating_sub(1)];
        (0..=last).map(|k| 0.5 * copies * gap(k)).collect()
    }
}

impl Pattern {
    pub fn new(aperture: Aperture) -> Self {
        let directions = Directions::new(aperture);
        let slices = Slices::new();
        let radii = slices.radii();
        let columns: Vec<[Vec<[f32; 3]>; 2]> =
            directions.angles.par_iter().map(|&angle| slices.along(aperture, angle)).collect();
        let rows = |of: usize| {
            let count = columns[0][of].len();
            (0..count).flat_map(|row| columns.iter().map(move |column| column[of][row])).collect::<Vec<_>>()
        };
        let (near, far) = (rows(0), rows(1));
        let mut pattern = Self { aperture, directions, radii, near, far, tails: Vec::new(), powers: Vec::new() };
        (pattern.tails, pattern.powers) = (pattern.tails(), pattern.powers());
        pattern
    }

    /// What it is of.
    pub fn aperture(&self) -> Aperture {
        self.aperture
    }

    /// S at a radius and an angle from the nearest spike, both at least 0, the angle at most [`Aperture::sector`].
    pub fn at(&self, radius: f64, angle: f64) -> [f32; 3] {
        let last = self.radii[self.radii.len() - 1];
        if radius < NEAR {
            let at = radius * ROWS as f64;
            let row = at as usize;
            return self.between(&self.near, row, (at - row as f64) as f32, self.directions.place(angle));
        }
        if radius < last {
            let at = ROWS_A_DOUBLING * (radius / NEAR).log2();
            let row = (at as usize).min(self.radii.len() - 2);
            let value = self.between(&self.far, row, (at - row as f64) as f32, self.directions.place(angle));
            let by = (radius * radius * radius).recip() as f32;
            return value.map(|value| value * by);
        }
        self.beyond(radius, angle)
    }

    /// The same beyond the last row, by powers of the radius: of a straight blade r⁻² at the same distance from its spike's middle, and
    /// r⁻⁴ apart from it; of a bent one the power that the last doubling of the radius has in that direction.
    fn beyond(&self, radius: f64, angle: f64) -> [f32; 3] {
        let row = self.radii.len() - 1;
        let last = self.radii[row];
        let by = last / radius;
        let of = |angle: f64| self.between(&self.far, row - 1, 1.0, self.directions.place(angle));
        if self.aperture.is_straight() {
            // An angle this small is its sine.
            let off = angle / by;
            let (angle, power) = if off < SPIKE { (off, by * by) } else { (angle, by.powi(4)) };
            let by = (power / last.powi(3)) as f32;
            return of(angle).map(|value| value * by);
        }
        let powers = self.between(&self.powers, 0, 0.0, self.directions.place(angle));
        let (value, by) = (of(angle), by.log2() as f32);
        let last = last.powi(3) as f32;
        [0, 1, 2].map(|k| value[k] / last * (powers[k] * by).exp2())
    }

    /// By which power of the radius each direction falls over the last doubling of it, twice, as of two rows.
    fn powers(&self) -> Vec<[f32; 3]> {
        let count = self.directions.angles.len();
        let end = &self.far[(self.radii.len() - 1) * count..];
        let before = &self.far[(self.radii.len() - 1 - ROWS_A_DOUBLING as usize) * count..];
        let power = |(before, end): (&[f32; 3], &[f32; 3])| {
            [0, 1, 2].map(|k| (3.0 + (before[k] / end[k]).log2()).clamp(2.0, 4.0))
        };
        let once: Vec<[f32; 3]> = before.iter().zip(end).map(power).take(count).collect();
        once.repeat(2)
    }

    /// Radii of all rows.
    pub fn all_radii(&self) -> Vec<f64> {
        let near = (0..ROWS * NEAR as usize).map(|row| row as f64 / ROWS as f64);
        near.chain(self.radii.iter().copied()).collect()
    }

    /// ∫ S over all directions at a radius.
    pub fn ring(&self, radius: f64) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for (&angle, weight) in self.directions.angles.iter().zip(self.directions.weights(self.aperture)) {
            let light = self.at(radius, angle);
            (0..3).for_each(|k| sum[k] += weight * f64::from(light[k]));
        }
        sum
    }

    /// What lies beyond a line around the centre, `edge` being its distance in a direction: of each channel's light 1, with `first` the
    /// direction of a spike. Directions are in radians.
    pub fn outside(&self, first: f64, edge: impl Fn(f64) -> f64) -> [f64; 3] {
        let sector = self.aperture.sector();
        let copies = (TAU / sector).round() as usize;
        let mut sum = [0.0; 3];
        // A circle's only direction stands for all.
        let turns = if self.aperture.is_round() { 720 } else { copies };
        for (&angle, weight) in self.directions.angles.iter().zip(self.directions.weights(self.aperture)) {
            for copy in 0..turns {
                let direction = if self.aperture.is_round() {
                    TAU * (copy as f64 + 0.5) / turns as f64
                } else {
                    first + sector * (copy.div_ceil(2) * 2) as f64 + if copy % 2 == 0 { angle } else { -angle }
                };
                let tail = self.tail(edge(direction), angle);
                (0..3).for_each(|k| sum[k] += weight / turns as f64 * f64::from(tail[k]));
            }
        }
        sum
    }

    /// ∫ S r dr from a radius on.
    fn tail(&self, radius: f64, angle: f64) -> [f32; 3] {
        let place = self.directions.place(angle);
        let (near, last) = (ROWS * NEAR as usize, self.radii[self.radii.len() - 1]);
        let at = if radius < NEAR {
            radius * ROWS as f64
        } else {
            near as f64 + ROWS_A_DOUBLING * (radius.min(last) / NEAR).log2()
        };
        let row = (at as usize).min(near + self.radii.len() - 2);
        let by = (last / radius.max(last)) as f32;
        self.between(&self.tails, row, (at - row as f64) as f32, place).map(|tail| tail * by)
    }

    fn between(&self, rows: &[[f32; 3]], row: usize, down: f32, (first, across): (usize, f32)) -> [f32; 3] {
        let count = self.directions.angles.len();
        let next = usize::from(count > 1);
        let [above, below] = [row, row + 1].map(|row| {
            let [left, right] = [rows[row * count + first], rows[row * count + first + next]];
            [0, 1, 2].map(|k| left[k] + across * (right[k] - left[k]))
        });
        [0, 1, 2].map(|k| above[k] + down * (below[k] - above[k]))
    }

    /// From the last row, beyond which a ring's light falls with the cubed radius, inwards.
    fn tails(&self) -> Vec<[f32; 3]> {
        let count = self.directions.angles.len();
        let (rows, far) = (ROWS * NEAR as usize, self.radii.len());
        let mut tails = vec![[0.0; 3]; (rows + far) * count];
        for direction in 0..count {
            let scaled = |row: usize| self.far[row * count + direction].map(f64::from);
            let mut sum = scaled(far - 1).map(|value| value / self.radii[far - 1]);
            tails[(rows + far - 1) * count + direction] = sum.map(|sum| sum as f32);
            for row in (0..far - 1).rev() {
                let part = self.radii[row].recip() - self.radii[row + 1].recip();
                let [a, b] = [scaled(row), scaled(row + 1)];
                (0..3).for_each(|k| sum[k] += 0.5 * (a[k] + b[k]) * part);
                tails[(rows + row) * count + direction] = sum.map(|sum| sum as f32);
            }
            for row in (0..rows).rev() {
                let step = 1.0 / ROWS as f64;
                // Of S that is linear in r.
                let part = |at: usize, by: usize| self.near[at * count + direction].map(|x| f64::from(x) * by as f64);
                let [a, b] = [part(row, 3 * row + 1), part(row + 1, 3 * row + 2)];
                (0..3).for_each(|k| sum[k] += (a[k] + b[k]) * step * step / 6.0);
                tails[row * count + direction] = sum.map(|sum| sum as f32);
            }
        }
        tails
    }
}
