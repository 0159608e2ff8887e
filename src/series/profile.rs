//! A radial profile that someone measured or drew, as a table.
//!
//! Between its rows the profile is linear in r², so that it is smooth at the centre, and a sum of paraboloids: every row
//! at which the slope b = dg/d(r²) changes by κ is a paraboloid of that radius, κ (rᵢ² − r²). The Hankel transform is
//! therefore a sum of theirs, exact for the profile as it is understood here.

use std::f64::consts::PI;
use std::sync::OnceLock;

use glam::DVec2;

use super::bell::{Modes, Radial as _, Shape};
use super::tails::copies;

mod transform;

/// Radii, but for 0, in sizes: their squares, and one over these, are f32 on the GPU.
const RADII: [f64; 2] = [1e-15, 1e15];

/// A radial profile. Its radii are in sizes; beyond the last it is 0.
#[derive(Debug, Clone)]
pub struct Profile {
    /// From 0 on, ascending.
    radii: Vec<f64>,
    /// The largest absolute value is 1.
    values: Vec<f64>,
    /// dg/d(r²) from each row to the next; 0 after the last.
    slopes: Vec<f64>,
    /// The largest absolute value from each row on, and the steepest that it is.
    reach: Vec<f64>,
    steepest: Vec<f64>,
    /// Radius and weight of the paraboloids' kernels in ĝ/2π, one for each row after the first.
    kernels: Vec<[f64; 2]>,
    /// ĝ(0), and the mean square distance from the centre along an axis.
    volume: f64,
    variance: f64,
    /// ∫ |ĝ|, and ∫ z |ĝ|, from each step on, with the largest |ĝ| from there on: only a series needs it, and it takes its
    /// time.
    beyond: OnceLock<Vec<[f64; 3]>>,
}

/// Everything else follows from the rows.
impl PartialEq for Profile {
    fn eq(&self, other: &Self) -> bool {
        std::ptr::eq(self, other) || (self.radii == other.radii && self.values == other.values)
    }
}

impl Profile {
    /// Most rows of a table.
    pub const MOST_ROWS: usize = 4096;

    /// A profile from rows of radius and value. Where the first radius is not 0, the profile is flat up to it. The values
    /// are divided by the largest of them.
    ///
    /// # Errors
    /// What is wrong with the rows, for people: radii that do not ascend, that are beyond 1e15 or, but for 0, below 1e-15,
    /// fewer than two rows or more than [`Profile::MOST_ROWS`], numbers that are not finite, nothing but zeros.
    pub fn new(rows: &[[f64; 2]]) -> Result<Self, String> {
        let most = Self::MOST_ROWS;
        if rows.len() < 2 || rows.len() > most {
            return Err(format!("a profile has 2 to {most} rows, and this one has {}", rows.len()));
        }
        if let Some(row) = rows.iter().position(|row| !row.iter().all(|x| x.is_finite()) || row[0] < 0.0) {
            let [radius, value] = rows[row];
            return Err(format!("row {} of the profile has the radius {radius} and the value {value}", row + 1));
        }
        if let Some(row) = rows.windows(2).position(|pair| pair[1][0] <= pair[0][0]) {
            return Err(format!("the profile's radii do not ascend at row {}", row + 2));
        }
        let [least, most] = RADII;
        let held = |radius: f64| radius == 0.0 || (least..=most).contains(&radius);
        if let Some(row) = rows.iter().position(|row| !held(row[0])) {
            let radius = rows[row][0];
            return Err(format!(
                "row {} of the profile has the radius {radius:e}, and radii go from {least:e} to {most:e}",
                row + 1
            ));
        }
        // Squares of radii that are too close to each other are the same to the last bit.
        if let Some(row) = rows.windows(2).position(|pair| (pair[1][0] - pair[0][0]) < 1e-7 * pair[1][0]) {
            return Err(format!("the profile's radii are closer than 1e-7 of themselves at row {}", row + 2));
        }
        let peak = rows.iter().fold(0.0f64, |peak, row| peak.max(row[1].abs()));
        if peak == 0.0 {
            return Err("the profile is zero everywhere".into());
        }
        let mut rows = rows.to_vec();
        if rows[0][0] > 0.0 {
            rows.insert(0, [0.0, rows[0][1]]);
        }
        Ok(Self::from_rows(&rows, peak))
    }

    fn from_rows(rows: &[[f64; 2]], peak: f64) -> Self {
        let radii: Vec<f64> = rows.iter().map(|row| row[0]).collect();
        let values: Vec<f64> = rows.iter().map(|row| row[1] / peak).collect();
        let mut slopes: Vec<f64> = (1..rows.len())
            .map(|i| (values[i] - values[i - 1]) / (radii[i] * radii[i] - radii[i - 1] * radii[i - 1]))
            .collect();
        slopes.push(0.0);
        let reach = from_each_on(values.iter().map(|value| value.abs()).collect());
        let last = rows.len() - 1;
        let steepest = (0..last).map(|i| 2.0 * slopes[i].abs() * radii[i + 1]);
        let steepest = from_each_on(steepest.chain([0.0]).collect());
        let mut profile = Self {
            radii,
            values,
            slopes,
            reach,
            steepest,
            kernels: Vec::new(),
            volume: 0.0,
            variance: 0.0,
            beyond: OnceLock::new(),
        };
        profile.kernels = profile.kinks().map(|(radius, kink)| [radius, 0.25 * kink * radius.powi(4)]).collect();
        profile.volume = profile.transform(0.0);
        profile.variance = profile.mean_square();
        profile
    }

    /// A soft disc, for tests.
    pub(super) fn example() -> Self {
        let rows = [[0.0, 1.0], [0.3, 0.9], [0.6, 0.45], [0.85, 0.1], [1.0, 0.0]];
        let peak = 1.0;
        Self::from_rows(&rows, peak)
    }

    /// Radius and value, row by row; [`Profile::new`] makes the same profile of them.
    pub fn rows(&self) -> impl Iterator<Item = [f64; 2]> {
        self.radii.iter().zip(&self.values).map(|(&radius, &value)| [radius, value])
    }

    fn radius(&self) -> f64 {
        self.radii[self.radii.len() - 1]
    }

    /// The row at or before a radius.
    fn row(&self, radius: f64) -> usize {
        self.radii.partition_point(|&r| r <= radius).max(1) - 1
    }

    fn at(&self, radius: f64) -> f64 {
        if radius > self.radius() {
            return 0.0;
        }
        let row = self.row(radius);
        self.values[row] + self.slopes[row] * (radius * radius - self.radii[row] * self.radii[row])
    }

    /// How much the slope changes at each row, after the first.
    fn kinks(&self) -> impl Iterator<Item = (f64, f64)> {
        (1..self.radii.len()).map(|i| (self.radii[i], self.slopes[i] - self.slopes[i - 1]))
    }

    /// The step that profile falls by at its end.
    fn step(&self) -> f64 {
        self.values[self.values.len() - 1]
    }

    /// π ∫ r³ g dr over the integral; 0 where that is negative, which no light that spreads has.
    fn mean_square(&self) -> f64 {
        let part = |i: usize| {
            let [near, far] = [self.radii[i], self.radii[i + 1]];
            let constant = self.values[i] - self.slopes[i] * near * near;
            constant * (far.powi(4) - near.powi(4)) / 4.0 + self.slopes[i] * (far.powi(6) - near.powi(6)) / 6.0
        };
        let moment: f64 = (0..self.radii.len() - 1).map(part).sum();
        (PI * moment / self.volume).max(0.0)
    }
}

/// The largest of the values from each on.
fn from_each_on(mut values: Vec<f64>) -> Vec<f64> {
    for i in (1..values.len()).rev() {
        values[i - 1] = values[i - 1].max(values[i]);
    }
    values
}

impl Shape for Profile {
    fn name(&self) -> &'static str {
        "profile"
    }

    fn shader(&self) -> &'static str {
        "bells/profile.glsl"
    }

    fn value(&self, offset: DVec2, size: DVec2) -> f64 {
        self.at((offset / size).length())
    }

    /// The radius is not below either offset, so the root of what both allow bounds the profile.
    fn along(&self, distance: f64, size: f64) -> f64 {
        let radius = (distance / size).abs();
        if radius > self.radius() {
            return 0.0;
        }
        let later = self.reach.get(self.row(radius) + 1).copied().unwrap_or(0.0);
        self.at(radius).abs().max(later).sqrt()
    }

    fn wrap(&self, period: f64, distance: f64, size: f64) -> f64 {
        copies(period, distance, size * self.radius(), |x| self.along(x, size))
    }

    fn steepest(&self, distance: f64) -> f64 {
        if distance > self.radius() {
            return 0.0;
        }
        self.steepest[self.radii[1..].partition_point(|&radius| radius <= distance)]
    }

    /// The radius of the first row from which on no value is above it: between rows the profile rises or falls all the way.
    fn reach(&self, share: f64) -> f64 {
        let row = self.reach.partition_point(|&largest| largest > share);
        self.radii[row.min(self.radii.len() - 1)]
    }

    fn ends(&self) -> f64 {
        self.radius()
    }

    fn jump(&self) -> f64 {
        self.step().abs()
    }

    /// Both ends of the steepest part and its middle, the sharpest kink, and where the profile ends.
    fn edges(&self) -> Vec<f64> {
        let steep = |&i: &usize| self.slopes[i].abs() * self.radii[i + 1];
        let steepest = (0..self.radii.len() - 1).max_by(|a, b| steep(a).total_cmp(&steep(b))).unwrap_or(0);
        let sharp = |(radius, kink): &(f64, f64)| kink.abs() * radius;
        let sharpest = self.kinks().max_by(|a, b| sharp(a).total_cmp(&sharp(b))).map_or(0.0, |(radius, _)| radius);
        let [near, far] = [self.radii[steepest], self.radii[steepest + 1]];
        let mut edges = vec![near, 0.5 * (near + far), far, sharpest, self.radius()];
        edges.sort_unstable_by(f64::total_cmp);
        edges.dedup();
        edges
    }

    fn integral(&self, size: DVec2) -> f64 {
        self.volume * size.element_product()
    }

    fn variance(&self) -> f64 {
        self.variance
    }

    fn modes(&self) -> Modes<'_> {
        Modes::Radial(self)
    }

    /// How many rows there are; then for each its r², its value, the slope to the next, and r.
    fn parameters(&self) -> Vec<[f64; 4]> {
        let mut table = vec![[self.radii.len() as f64, 0.0, 0.0, 0.0]];
        let rows = self.radii.iter().zip(&self.values).zip(&self.slopes);
        table.extend(rows.map(|((r, value), slope)| [r * r, *value, *slope, *r]));
        table
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of 300 rows that fall and tremble, so that kinks of both signs nearly cancel.
    pub(super) fn trembling() -> Profile {
        let row = |i: u32| {
            let r = f64::from(i) / 300.0;
            [3.0 * r, (1.0 - r * r).powi(2) + 0.01 * f64::from(i * 7919 % 13)]
        };
        Profile::new(&(0..=300).map(row).collect::<Vec<_>>()).unwrap()
    }

    #[test]
    fn a_profile_is_as_steep_as_its_rows_from_a_distance_on() {
        let profile = Profile::new(&[[0.0, 1.0], [0.5, 0.9], [1.0, 0.0], [2.0, -0.1], [3.0, 0.0]]).unwrap();
        // 2 r dg/d(r²) at the outer row: 0.9/0.75 of r = 1, and so on.
        let expected =
            [(0.0, 2.4), (0.99, 2.4), (1.0, 2.0 * 2.0 * 0.1 / 3.0), (2.5, 2.0 * 3.0 * 0.1 / 5.0), (3.0, 0.0)];
        for (distance, steepest) in expected {
            assert!(
                (profile.steepest(distance) - steepest).abs() < 1e-12,
                "{distance}: {}",
                profile.steepest(distance)
            );
        }
    }

    #[test]
    fn radii_that_the_device_cannot_tell_apart_are_refused() {
        for (rows, expected) in [
            ([[0.0, 1.0], [1e16, 0.0]], "the radius 1e16, and radii go from 1e-15 to 1e15"),
            ([[0.0, 1.0], [1e-300, 0.0]], "the radius 1e-300"),
            ([[1.0, 1.0], [1.0 + 1e-9, 0.0]], "closer than 1e-7 of themselves at row 2"),
        ] {
            let reason = Profile::new(&rows).unwrap_err();
            assert!(reason.contains(expected), "{reason}");
        }
        assert!(Profile::new(&[[0.0, 1.0], [1e12, 0.0]]).is_ok());
    }
}
