//! What a bright field sends to a point of the sensor along a path: exact rays traced back from there, by Monte Carlo integration.
//!
//! The irradiance of a point that sees the radiance L is ∫ L cos θ dω over the directions from which light comes. A point r of the plane
//! of the last vertex, so many D before the sensor, is seen under dω cos θ = D² / (D² + |r − x|²)² dr from the point x. Along a path the
//! radiance is that of the scene in the direction where the ray back leaves the lens, times the power that surfaces leave of it:
//! the square of the index, which it goes with (Nicodemus, 1963), is the same for all paths.

use glam::DVec2;

use super::colour::Sensitivity;
use super::error::{OpticsError, Result};
use super::matrix::RayMatrix;
use super::path::{Path, Step};
use super::spot::{REPLICATES, SAMPLES, STUDENT_99, radical_inverse};
use super::system::System;
use super::trace::Tracer;
use crate::chance::Chance;

/// Cells to a side of the grid of rays that looks for the light.
const PILOT: usize = 48;
/// Rays of each place, of as many wavelengths that are spread evenly: colours weigh some of them negatively, and one alone says little.
const TOGETHER: usize = 4;
/// Of so many places one is anywhere, and not where the grid has found light.
const ANYWHERE: usize = 8;

/// A lens's rays at the wavelengths of a colour observer.
#[derive(Debug, Clone)]
pub struct BrightField<'a> {
    system: &'a System,
    tracers: Vec<Tracer<'a>>,
    weights: Vec<[f64; 3]>,
    /// How likely a ray has this wavelength or one before it.
    cumulative: Vec<f64>,
    /// Of the wavelength at which light is looked for.
    middle: usize,
}

/// Independent estimates of an irradiance, in linear Rec. 709.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Irradiance([[f64; 3]; REPLICATES]);

/// A rectangle of the plane of the last vertex.
#[derive(Debug, Clone, Copy)]
struct Rectangle {
    low: DVec2,
    high: DVec2,
}

impl Irradiance {
    /// Estimate by estimate.
    fn with(&self, other: &Self, of: impl Fn(f64, f64) -> f64) -> Self {
        Self(std::array::from_fn(|k| std::array::from_fn(|c| of(self.0[k][c], other.0[k][c]))))
    }

    /// Both together.
    #[must_use]
    pub fn plus(&self, other: &Self) -> Self {
        self.with(other, |one, other| one + other)
    }

    /// As a part of another; 0 of one that is 0.
    #[must_use]
    pub fn over(&self, whole: &Self) -> Self {
        self.with(whole, |part, whole| if whole == 0.0 { 0.0 } else { part / whole })
    }

    /// The mean of a number that is made of each estimate, and half the width of the interval about it that holds the truth with 99 %
    /// confidence, by Student's t.
    pub fn of(&self, number: impl Fn([f64; 3]) -> f64) -> [f64; 2] {
        let count = REPLICATES as f64;
        let all = self.0.map(number);
        let mean = all.iter().sum::<f64>() / count;
        let variance = all.iter().map(|one| (one - mean).powi(2)).sum::<f64>() / (count - 1.0);
        [mean, STUDENT_99 * (variance / count).sqrt()]
    }
}

impl<'a> BrightField<'a> {
    /// Rays of a lens in the colours of the standard observer.
    ///
    /// # Errors
    /// Those of [`Tracer::new`].
    pub fn new(system: &'a System) -> Result<Self> {
        let Sensitivity { wavelengths, weights, centres, .. } = Sensitivity::standard_observer();
        let tracers = wavelengths.iter().map(|&wavelength| Tracer::new(system, wavelength)).collect::<Result<_>>()?;
        let likely: Vec<f64> = weights.iter().map(|rgb| rgb.iter().map(|part| part.abs()).sum()).collect();
        let whole: f64 = likely.iter().sum();
        let cumulative = likely.iter().scan(0.0, |sum, part| {
            *sum += part / whole;
            Some(*sum)
        });
        let middle = wavelengths.partition_point(|wavelength| *wavelength < centres[1]).min(wavelengths.len() - 1);
        Ok(Self { system, tracers, weights, cumulative: cumulative.collect(), middle })
    }

    /// The irradiance at the point `position` of the sensor, in mm from the axis, of light along a path, where the scene has the
    /// `radiance` in the direction of these tangents of its angle from the axis: by about `rays` of them, four
    /// of different wavelengths from each place of the last surface, in sixteen independent shifts of Halton's sequence over both (Cranley
    /// and Patterson, 1976).
    ///
    /// Most places are where a grid of 48 × 48 finds light, and a cell around; one of eight is anywhere, so that no light is left out
    /// on average, but of a part that is narrower than a cell the interval may be too narrow. Where the grid finds none it looks about the
    /// circle that the matrices give. `seed` decides the shifts.
    ///
    /// # Errors
    /// Fewer rays than 64, or more than 2³⁰.
    pub fn irradiance(
        &self,
        path: &Path,
        position: DVec2,
        radiance: impl Fn(DVec2) -> f64,
        rays: usize,
        seed: u64,
    ) -> Result<Irradiance> {
        if !(SAMPLES[0]..=SAMPLES[1]).contains(&rays) {
            return Err(OpticsError::Setup(format!("{rays} rays are not from {} to {}", SAMPLES[0], SAMPLES[1])));
        }
        let steps = path.steps_back();
        let seen = |wavelength: usize, from: DVec2| {
            let origin = self.tracers[wavelength].back_by(&steps, position, from)?;
            let given = radiance(origin.direction.truncate() / origin.direction.z);
            (given > 0.0).then_some(given * origin.weight)
        };
        let whole = self.last_surface(position);
        let is_lit = |from: DVec2| seen(self.middle, from).is_some();
        let lit = whole.lit(is_lit).or_else(|| self.by_matrices(path, position).lit(is_lit));
        let distance = self.system.first_order().sensor_distance.powi(2);
        let each = rays.div_ceil(REPLICATES * TOGETHER);
        let anywhere = if lit.is_some() { each.div_ceil(ANYWHERE) } else { each };
        // How dense places are about one.
        let density = |from: DVec2| {
            let found = lit.filter(|lit| lit.holds(from)).map_or(0.0, |lit| (each - anywhere) as f64 / lit.area());
            found + anywhere as f64 / whole.area()
        };
        let mut chance = Chance::new(seed);
        let replicates = std::array::from_fn(|_| {
            let mut sum = [0.0; 3];
            for (area, count) in [(lit.unwrap_or(whole), each - anywhere), (whole, anywhere)] {
                let shift: [f64; 3] = std::array::from_fn(|_| chance.between(0.0, 1.0));
                for k in 0..count {
                    let place = [2, 3, 5].map(|base| radical_inverse(k, base));
                    let [x, y, colour] = std::array::from_fn(|axis| (place[axis] + shift[axis]).fract());
                    let from = area.at(DVec2::new(x, y));
                    let solid = distance / (distance + from.distance_squared(position)).powi(2) / density(from);
                    for part in 0..TOGETHER {
                        let wavelength = self.wavelength((colour + part as f64 / TOGETHER as f64).fract());
                        let Some(power) = seen(wavelength, from) else { continue };
                        let value = power * solid / (self.likely(wavelength) * TOGETHER as f64);
                        sum.iter_mut().zip(self.weights[wavelength]).for_each(|(sum, weight)| *sum += weight * value);
                    }
                }
            }
            sum
        });
        Ok(Irradiance(replicates))
    }

    fn wavelength(&self, place: f64) -> usize {
        self.cumulative.partition_point(|upto| *upto <= place).min(self.tracers.len() - 1)
    }

    fn likely(&self, wavelength: usize) -> f64 {
        let before = wavelength.checked_sub(1).map_or(0.0, |before| self.cumulative[before]);
        self.cumulative[wavelength] - before
    }

    /// About the smallest circle of that plane by which a rim bounds, paraxially, what comes along a path.
    fn by_matrices(&self, path: &Path, position: DVec2) -> Rectangle {
        let indices = self.system.indices(self.system.setup().wavelength);
        let mut rims = Vec::new();
        let tell =
            |step: &Step, matrix: &RayMatrix| rims.push((self.system.surfaces()[step.surface].semi_aperture, *matrix));
        let RayMatrix { a, b, c, d } = self.system.walk(&path.steps(), &indices, tell);
        // A ray of the reduced angle v at the sensor has the height (m.a d − m.b c) x + (m.b a − m.a b) v at a rim.
        let circle = |(radius, m): &(f64, RayMatrix)| {
            let of_angle = m.b * a - m.a * b;
            (-(m.a * d - m.b * c) / of_angle * position, radius / of_angle.abs())
        };
        let smallest = rims.iter().map(circle).min_by(|one, other| one.1.total_cmp(&other.1));
        let (angle, radius) = smallest.unwrap_or((DVec2::ZERO, 0.0));
        let reach = self.system.first_order().sensor_distance / indices.last().copied().unwrap_or(1.0);
        let (centre, half) = (position - reach * angle, DVec2::splat(2.0 * reach * radius));
        Rectangle { low: centre - half, high: centre + half }
    }

    /// What of the plane of the last vertex is seen from a point of the sensor through the last rim.
    fn last_surface(&self, position: DVec2) -> Rectangle {
        let distance = self.system.first_order().sensor_distance;
        let (radius, sag) = self.system.surfaces().last().map_or((0.0, 0.0), |last| {
            let square = (last.curvature * last.semi_aperture).powi(2);
            let bulge = 1.0 + (1.0 - (1.0 + last.conic) * square).max(0.0).sqrt();
            (last.semi_aperture, last.curvature * last.semi_aperture.powi(2) / bulge)
        });
        // The surface is between its vertex and its rim.
        let discs = [0.0, sag].map(|sag| {
            let scale = distance / (distance - sag);
            (position * (1.0 - scale), radius * scale)
        });
        let low = discs.map(|(centre, radius)| centre - radius).into_iter().fold(DVec2::INFINITY, DVec2::min);
        let high = discs.map(|(centre, radius)| centre + radius).into_iter().fold(DVec2::NEG_INFINITY, DVec2::max);
        Rectangle { low, high }
    }
}

impl Rectangle {
    fn at(&self, place: DVec2) -> DVec2 {
        self.low + (self.high - self.low) * place
    }

    fn area(&self) -> f64 {
        (self.high - self.low).element_product()
    }

    fn holds(&self, point: DVec2) -> bool {
        point.cmpge(self.low).all() && point.cmple(self.high).all()
    }

    /// What of it is lit, with a cell around; again within few cells, until it is more than those.
    fn lit(&self, is_lit: impl Fn(DVec2) -> bool) -> Option<Self> {
        let mut found = self.around_light(&is_lit)?;
        while let Some(closer) = found.around_light(&is_lit).filter(|closer| closer.area() < 0.25 * found.area()) {
            found = closer;
        }
        Some(found)
    }

    fn around_light(&self, is_lit: impl Fn(DVec2) -> bool) -> Option<Self> {
        let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for cell in 0..PILOT * PILOT {
            let corner = DVec2::new((cell % PILOT) as f64, (cell / PILOT) as f64);
            if is_lit(self.at((corner + 0.5) / PILOT as f64)) {
                low = low.min(corner - 1.0);
                high = high.max(corner + 2.0);
            }
        }
        let place = |cell: DVec2| self.at((cell / PILOT as f64).clamp(DVec2::ZERO, DVec2::ONE));
        (low.x < high.x).then(|| Self { low: place(low), high: place(high) })
    }
}

#[cfg(test)]
mod tests;
