//! A radial profile that someone measured or drew, as a table.
//!
//! Between its rows the profile is linear in r², so that it is smooth at the centre, and a sum of paraboloids: every row
//! at which the slope b = dg/d(r²) changes by κ is a paraboloid of that radius, κ (rᵢ² − r²). The Hankel transform is
//! therefore a sum of theirs, exact for the profile as it is understood here.

use std::f64::consts::{PI, TAU};
use std::sync::OnceLock;

use glam::DVec2;
use rayon::prelude::*;

use super::bell::{Modes, Radial, Shape};
use super::nodes::between_nodes;
use super::paraboloid::cut_off;
use super::special::{bessel_j, paraboloid_kernel_looked_up};
use super::tails::copies;

/// Most rows of a table.
pub const MOST_ROWS: usize = 4096;

/// Radii, but for 0, in sizes: their squares, and one over these, are f32 on the GPU.
const RADII: [f64; 2] = [1e-15, 1e15];

/// Rows from which on kernels are looked up: every mode of a series asks for those of all rows.
const FEW_ROWS: usize = 64;

/// Steps of the table of what lies beyond a frequency: their width times the profile's radius, and how many there are.
const STEP: f64 = 0.25;
const STEPS: usize = 4000;

/// What one paraboloid's kernel costs, about, in nanoseconds.
const KERNEL: f64 = 20.0;

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
    /// A profile from rows of radius and value. Where the first radius is not 0, the profile is flat up to it. The values
    /// are divided by the largest of them.
    ///
    /// # Errors
    /// What is wrong with the rows, for people: radii that do not ascend, that are beyond 1e15 or, but for 0, below 1e-15,
    /// fewer than two rows or more than `MOST_ROWS`, numbers that are not finite, nothing but zeros.
    pub fn new(rows: &[[f64; 2]]) -> Result<Self, String> {
        if rows.len() < 2 || rows.len() > MOST_ROWS {
            return Err(format!("a profile has 2 to {MOST_ROWS} rows, and this one has {}", rows.len()));
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

    /// ∫ M dz and ∫ z M dz from each step of z on, where M is the largest |ĝ| from there on; and M.
    fn integrals(&self) -> Vec<[f64; 3]> {
        let width = STEP / self.radius();
        let sampled = self.sampled();
        let mut largest = sampled[STEPS];
        let mut beyond = vec![[0.0, 0.0, largest]; STEPS + 1];
        for i in (0..STEPS).rev() {
            largest = largest.max(sampled[i]);
            let next = beyond[i + 1];
            beyond[i] = [next[0] + width * largest, next[1] + width * (i as f64 + 1.0) * width * largest, largest];
        }
        beyond
    }

    /// A bound of |ĝ| at each step of z and as far as the middle of the next.
    fn sampled(&self) -> Vec<f64> {
        // What looking the kernels up may be off by: a part of what they are, which falls as t^(−5/2).
        let off = if self.looks_up() { 1e-8 } else { 0.0 };
        let weights: f64 = self.kernels.iter().map(|[_, weight]| weight.abs()).sum();
        let falling = self.kernels.iter().map(|[radius, weight]| weight.abs() * (radius / self.radius()).powf(-2.5));
        let falling: f64 = 8.0 * falling.sum::<f64>();
        let bound = |i: usize| {
            let end = STEP * i as f64;
            let off = off * weights.min(falling * end.powf(-2.5));
            // ĝ has nothing faster than the radius in it, so between steps it is hardly larger than at them.
            1.05 * (self.transform(end / self.radius()).abs() + TAU * off)
        };
        (0..=STEPS).into_par_iter().map(bound).collect()
    }

    /// Whether the kernels of so many rows are looked up and not computed.
    fn looks_up(&self) -> bool {
        self.kernels.len() > FEW_ROWS
    }

    /// What the step at the end adds to ĝ/2π, as a disc; `end` is z times the radius.
    fn stepped(&self, end: f64) -> f64 {
        let disc = if end < 1e-4 { 0.5 } else { bessel_j(1, end) / end };
        self.step() * self.radius() * self.radius() * disc
    }

    /// What the kinks and the step leave beyond z.
    fn cut_off(&self, z: f64) -> f64 {
        let kinks: f64 = self.kinks().map(|(radius, kink)| kink.abs() * radius * radius * cut_off(z * radius)).sum();
        kinks + self.step().abs() * (0.6 + 1.0 / (z * self.radius()).sqrt())
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

impl Radial for Profile {
    /// Twice by parts, with ∫ r² J1(qr) dr = r² J2(qr)/q: the step at the end as a disc, every kink as a paraboloid.
    fn transform(&self, z: f64) -> f64 {
        let kinks = self.kernels.iter().map(|&[radius, weight]| weight * paraboloid_kernel_looked_up(z * radius));
        let kinks: f64 = kinks.sum();
        TAU * (self.stepped(z * self.radius()) + kinks)
    }

    fn transforms(&self, at: &[f64]) -> Vec<f64> {
        between_nodes(at, self.radius(), |z| self.transform(z))
    }

    /// The smaller of what the kinks leave, which falls slowly, and of all that is left, which falls fast where the
    /// table is smooth and ends where its rows show.
    fn beyond(&self, z: f64, cell: f64) -> f64 {
        let kinks = self.cut_off(z);
        let width = STEP / self.radius();
        // A mode stands for its cell, in which |ĝ| may be as large as half a diagonal further in.
        let first = ((z - 2.0 * cell) / width).floor().max(0.0) as usize;
        let Some([constant, linear, _]) = self.beyond.get_or_init(|| self.integrals()).get(first) else { return kinks };
        let all = (linear + cell * constant) / TAU + self.cut_off(width * STEPS as f64);
        kinks.min(all)
    }

    fn envelope(&self, z: f64) -> f64 {
        let step = (z * self.radius() / STEP) as usize;
        match self.beyond.get_or_init(|| self.integrals()).get(step) {
            Some(&[_, _, largest]) => largest,
            None => {
                let kinks = self.kernels.iter().map(|[radius, weight]| weight.abs() * (z * radius).powf(-2.5));
                let disc = self.step().abs() * self.radius().powi(2) * (z * self.radius()).powf(-1.5);
                TAU * (8.0 * 0.86 * kinks.sum::<f64>() + 0.83 * disc)
            }
        }
    }

    fn end(&self) -> f64 {
        self.radius()
    }

    /// The table of what lies beyond each frequency, on two cores.
    fn preparation(&self) -> f64 {
        0.5 * KERNEL * STEPS as f64 * self.kernels.len() as f64
    }

    fn work(&self) -> f64 {
        KERNEL * self.kernels.len() as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::series::nodes::nodes;
    use crate::series::special::paraboloid_kernel;

    /// Of 300 rows that fall and tremble, so that kinks of both signs nearly cancel.
    fn trembling() -> Profile {
        let row = |i: u32| {
            let r = f64::from(i) / 300.0;
            [3.0 * r, (1.0 - r * r).powi(2) + 0.01 * f64::from(i * 7919 % 13)]
        };
        Profile::new(&(0..=300).map(row).collect::<Vec<_>>()).unwrap()
    }

    #[test]
    fn what_a_series_needs_is_made_when_one_asks_and_once() {
        let profile = trembling();
        assert!(profile.variance() > 0.0 && profile.integral(DVec2::ONE) > 0.0);
        assert!(profile.beyond.get().is_none(), "made though only the direct sum was asked for");
        let shared = std::sync::Arc::new(profile);
        let first = Radial::beyond(&*shared, 20.0, 0.1);
        let made = shared.beyond.get().unwrap().as_ptr();
        assert_eq!((Radial::beyond(&*shared, 20.0, 0.1), shared.beyond.get().unwrap().as_ptr()), (first, made));
        assert_eq!(*shared, trembling(), "the same profile, whatever has been made of it");
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
    fn kernels_that_are_looked_up_are_those_that_are_computed() {
        let profile = trembling();
        assert!(profile.looks_up());
        for z in [0.0, 1e-3, 0.7, 12.3, 456.7, 2345.6] {
            let kinks: f64 =
                profile.kernels.iter().map(|[radius, weight]| weight * paraboloid_kernel(z * radius)).sum();
            let exact = TAU * (profile.stepped(z * profile.radius()) + kinks);
            let off = (profile.transform(z) - exact).abs();
            assert!(off < 1e-8 * profile.volume, "{z}: {off:e}");
        }
    }

    #[test]
    fn transforms_between_nodes_are_those_that_are_summed() {
        let profile = trembling();
        let last = 40.0;
        let at: Vec<f64> = (0..4000).map(|i| last * f64::from(i) / 3999.0).collect();
        assert!(nodes(last, profile.radius()) < 0.5 * at.len() as f64, "few enough nodes");
        for (z, read) in at.iter().zip(profile.transforms(&at)) {
            let kinks: f64 =
                profile.kernels.iter().map(|[radius, weight]| weight * paraboloid_kernel(z * radius)).sum();
            let off = (read - TAU * (profile.stepped(z * profile.radius()) + kinks)).abs();
            assert!(off < 2e-8 * profile.volume, "{z}: {off:e}");
        }
    }

    #[test]
    fn the_bound_from_looked_up_kernels_holds_between_its_steps_and_is_close() {
        let profile = trembling();
        let (bounds, width) = (profile.sampled(), STEP / profile.radius());
        let (mut largest, mut sum) = (0.0f64, [0.0; 2]);
        for (i, bound) in bounds.iter().enumerate() {
            let exact = [0.0, 0.5].map(|between| profile.transform(width * (i as f64 + between)).abs());
            let next = bounds.get(i + 1).copied().unwrap_or(f64::INFINITY);
            assert!(exact[0] <= *bound && exact[1] <= bound.max(next) + 0.03 * largest.max(exact[1]), "step {i}");
            largest = largest.max(exact[0]);
            sum = [sum[0] + bound, sum[1] + exact[0]];
        }
        assert!(sum[0] < 1.06 * sum[1], "{sum:?}");
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
