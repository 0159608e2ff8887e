//! The image of a distant light along a path, summed from exact rays with an interval for what chance leaves open.

use glam::{DVec2, DVec3};

use super::error::{OpticsError, Result};
use super::ghosts::clipped;
use super::path::Path;
use super::trace::Tracer;
use crate::chance::Chance;

/// Independent estimates from which an interval is made.
pub(super) const REPLICATES: usize = 16;
/// Student's t for 15 degrees of freedom, of which 99 % are within (Abramowitz & Stegun, table 26.10).
pub(super) const STUDENT_99: f64 = 2.947;
/// Cells to a side of the grid of rays that looks for the light.
const PILOT: usize = 64;
/// Rays that may be asked for.
pub(super) const SAMPLES: [usize; 2] = [REPLICATES * 4, 1 << 30];

/// The image of a distant light along a path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spot {
    /// The centre of its light on the sensor, in mm from the axis. At 0 without light.
    pub centroid: DVec2,
    /// The root mean square of its light's distance from there, in mm.
    pub rms: f64,
    /// Its light, as the area in mm², across the axis, whose light it would be if nothing were lost.
    pub flux: f64,
    /// Half the width of the interval about the flux in which it is with 99 % confidence.
    pub flux_error: f64,
    /// How many of the rays arrived.
    pub hits: usize,
}

/// Sums of rays, each by its weight.
#[derive(Debug, Clone, Copy, Default)]
struct Sums {
    weight: f64,
    position: DVec2,
    square: f64,
    hits: usize,
}

/// A rectangle of the entrance pupil's plane, along the light's direction and across it.
struct Rectangle {
    low: DVec2,
    high: DVec2,
    /// The unit vector in which light leaves the axis.
    along: DVec2,
}

impl Tracer<'_> {
    /// The image of a distant light along a path, by about `samples` rays: randomised quasi-Monte Carlo, with sixteen
    /// independent shifts of Halton's sequence (Cranley and Patterson, 1976), from which the interval is.
    ///
    /// Rays fall where a grid of 64 × 64 over all that the first surface lets in finds light, and a cell around, and
    /// where it finds none, about the circle that the matrices give; a part of the light that is narrower than a cell,
    /// and apart from the rest, may be missed. `seed` decides the shifts, and nothing else is by chance.
    ///
    /// # Errors
    ///
    /// A direction that does not lead towards the sensor, or fewer rays than 64.
    pub fn spot(&self, path: &Path, direction: DVec3, samples: usize, seed: u64) -> Result<Spot> {
        let fault = |reason: String| Err(OpticsError::Setup(reason));
        let Some(direction) = direction.try_normalize().filter(|direction| direction.z > 0.0) else {
            return fault(format!("light in the direction {direction} does not come from before the lens"));
        };
        if !(SAMPLES[0]..=SAMPLES[1]).contains(&samples) {
            return fault(format!("{samples} rays are not from {} to {}", SAMPLES[0], SAMPLES[1]));
        }
        let steps = path.steps();
        let trace = |pupil: DVec2| self.trace_steps(&steps, path, direction, pupil);
        let rectangle = self.lit(path, direction, |pupil| trace(pupil).is_some());
        let mut chance = Chance::new(seed);
        let each = samples.div_ceil(REPLICATES);
        let replicates: [Sums; REPLICATES] = std::array::from_fn(|_| {
            let shift = DVec2::new(chance.between(0.0, 1.0), chance.between(0.0, 1.0));
            let mut sums = Sums::default();
            for k in 0..each {
                let place = (shift + DVec2::new(radical_inverse(k, 2), radical_inverse(k, 3))).fract();
                if let Some(hit) = trace(rectangle.at(place)) {
                    sums.add(hit.position, hit.weight);
                }
            }
            sums
        });
        Ok(spot(&replicates, each, rectangle.area()))
    }

    /// A rectangle of the entrance pupil's plane around the light that arrives; all of the entrance where there is none.
    fn lit(&self, path: &Path, direction: DVec3, is_lit: impl Fn(DVec2) -> bool) -> Rectangle {
        let entrance = self.entrance(direction);
        let near_matrices = || self.by_matrices(path, direction).and_then(|rectangle| rectangle.around_light(&is_lit));
        let Some(mut found) = entrance.around_light(&is_lit).or_else(near_matrices) else { return entrance };
        // Again within a few cells, until it is more than those.
        while let Some(closer) = found.around_light(&is_lit).filter(|closer| closer.area() < 0.25 * found.area()) {
            found = closer;
        }
        found
    }

    /// About the smallest circle by which a rim bounds the light paraxially.
    fn by_matrices(&self, path: &Path, direction: DVec3) -> Option<Rectangle> {
        let (_, clips) = clipped(self.system(), path, &self.system().indices(self.system().setup().wavelength));
        let smallest = clips.into_iter().min_by(|a, b| a.radius.total_cmp(&b.radius))?;
        let tangent = direction.truncate() / direction.z;
        let (centre, reach) =
            (DVec2::X * smallest.center_per_tangent * tangent.length(), DVec2::splat(2.0 * smallest.radius));
        let along = tangent.try_normalize().unwrap_or(DVec2::X);
        Some(Rectangle { low: centre - reach, high: centre + reach, along })
    }

    /// What of the entrance pupil's plane light in a direction comes from that meets the first surface within its rim.
    fn entrance(&self, direction: DVec3) -> Rectangle {
        let tangent = direction.truncate() / direction.z;
        let along = tangent.try_normalize().unwrap_or(DVec2::X);
        let pupil = self.system().first_order().entrance_pupil.z;
        let (radius, sag) = self.system().surfaces().first().map_or((0.0, 0.0), |first| {
            let bulge =
                (1.0 + (1.0 - (1.0 + first.conic) * (first.curvature * first.semi_aperture).powi(2)).sqrt()).recip();
            (first.semi_aperture, first.curvature * first.semi_aperture.powi(2) * bulge)
        });
        // The surface is between its vertex and its rim.
        let [at_vertex, at_rim] = [pupil, pupil - sag].map(|way| tangent.length() * way);
        Rectangle {
            low: DVec2::new(at_vertex.min(at_rim) - radius, -radius),
            high: DVec2::new(at_vertex.max(at_rim) + radius, radius),
            along,
        }
    }
}

impl Rectangle {
    /// The point of the plane at a place of the unit square.
    fn at(&self, place: DVec2) -> DVec2 {
        let DVec2 { x, y } = self.low + (self.high - self.low) * place;
        x * self.along + y * self.along.perp()
    }

    fn area(&self) -> f64 {
        let DVec2 { x, y } = self.high - self.low;
        x * y
    }

    /// What of it is lit, with a cell of the grid around; none where no ray of the grid arrives.
    fn around_light(&self, is_lit: impl Fn(DVec2) -> bool) -> Option<Self> {
        let (mut low, mut high) = (DVec2::splat(f64::INFINITY), DVec2::splat(f64::NEG_INFINITY));
        for j in 0..PILOT {
            for i in 0..PILOT {
                let corner = DVec2::new(i as f64, j as f64);
                if is_lit(self.at((corner + 0.5) / PILOT as f64)) {
                    low = low.min(corner - 1.0);
                    high = high.max(corner + 2.0);
                }
            }
        }
        let place =
            |cell: DVec2| self.low + (self.high - self.low) * (cell / PILOT as f64).clamp(DVec2::ZERO, DVec2::ONE);
        (low.x < high.x).then(|| Self { low: place(low), high: place(high), along: self.along })
    }
}

impl Sums {
    fn add(&mut self, position: DVec2, weight: f64) {
        self.weight += weight;
        self.position += weight * position;
        self.square += weight * position.length_squared();
        self.hits += 1;
    }
}

/// The image of which so many rays each fell on an area of the pupil's plane.
fn spot(replicates: &[Sums; REPLICATES], each: usize, area: f64) -> Spot {
    let total = replicates.iter().fold(Sums::default(), |sum, next| Sums {
        weight: sum.weight + next.weight,
        position: sum.position + next.position,
        square: sum.square + next.square,
        hits: sum.hits + next.hits,
    });
    let count = REPLICATES as f64;
    let flux = |weight: f64| area * weight / each as f64;
    let mean = flux(total.weight) / count;
    if total.hits == 0 {
        // Of rays that all miss, as many as this part might hit, once in a hundred times: (1 − part)^rays = 0.01.
        let part = 1.0 - 0.01_f64.powf(1.0 / (count * each as f64));
        return Spot { centroid: DVec2::ZERO, rms: 0.0, flux: 0.0, flux_error: area * part, hits: 0 };
    }
    let variance = replicates.iter().map(|sums| (flux(sums.weight) - mean).powi(2)).sum::<f64>() / (count - 1.0);
    let centroid = total.position / total.weight;
    let rms = (total.square / total.weight - centroid.length_squared()).max(0.0).sqrt();
    Spot { centroid, rms, flux: mean, flux_error: STUDENT_99 * (variance / count).sqrt(), hits: total.hits }
}

/// The digits of `k` in a base, behind the point in reverse order: Halton's sequence.
pub(super) fn radical_inverse(mut k: usize, base: usize) -> f64 {
    let (mut value, mut digit) = (0.0, 1.0);
    while k > 0 {
        digit /= base as f64;
        value += digit * (k % base) as f64;
        k /= base;
    }
    value
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::super::tests::{double_gauss, singlet};
    use super::super::{Coating, GhostOptions, LINE_D, Prescription, Setup, System, direction};
    use super::*;

    fn system(lens: &Prescription, fstop: Option<f64>) -> System {
        System::new(lens, &Setup { fstop, ..Setup::default() }).unwrap()
    }

    /// The weight of a ray along the axis through the singlet.
    fn on_axis(system: &System) -> f64 {
        let tracer = Tracer::new(system, LINE_D).unwrap();
        tracer.trace(&Path::direct(system), DVec3::Z, DVec2::ZERO).unwrap().weight
    }

    #[test]
    fn haltons_sequence_is_evenly_spread() {
        assert_eq!([1, 2, 3, 4].map(|k| radical_inverse(k, 2)), [0.5, 0.25, 0.75, 0.125]);
        assert!((radical_inverse(5, 3) - 7.0 / 9.0).abs() < 1e-15);
        let below = (0..3000).filter(|&k| radical_inverse(k, 3) < 0.3).count();
        assert!((897..=903).contains(&below), "{below}");
    }

    #[test]
    fn the_flux_of_the_direct_image_is_that_of_the_pupil() {
        // The stop is the first surface, so that its own area is known; at f/20 rays are near enough to the axis.
        let system = system(&singlet(), Some(20.0));
        let tracer = Tracer::new(&system, LINE_D).unwrap();
        let radius = system.surfaces()[0].semi_aperture;
        for angle in [0.0, 2.0] {
            let spot = tracer.spot(&Path::direct(&system), direction(angle), 40_000, 1).unwrap();
            let expected = PI * radius * radius * on_axis(&system);
            assert!((spot.flux / expected - 1.0).abs() < 1e-3, "{angle}: {} {expected}", spot.flux);
            assert!(spot.flux_error < 2e-3 * expected && spot.flux_error > 0.0, "{spot:?}");
            let image = system.first_order().focal_length * angle.to_radians().tan();
            assert!((spot.centroid.x - image).abs() < 2e-3 && spot.centroid.y.abs() < 1e-4, "{spot:?}");
        }
    }

    #[test]
    fn the_interval_holds_what_it_says() {
        let system = system(&singlet(), Some(20.0));
        let tracer = Tracer::new(&system, LINE_D).unwrap();
        let path = Path::direct(&system);
        let truth = tracer.spot(&path, direction(1.0), 1 << 20, 99).unwrap().flux;
        let within = (0..200)
            .filter(|&seed| {
                let spot = tracer.spot(&path, direction(1.0), 512, seed).unwrap();
                (spot.flux - truth).abs() <= spot.flux_error
            })
            .count();
        // 198 of 200 are meant; fewer than 190, or all by a wide margin, would be another confidence.
        assert!((190..=200).contains(&within), "{within}");
        let close = (0..200)
            .filter(|&seed| {
                let spot = tracer.spot(&path, direction(1.0), 512, seed).unwrap();
                (spot.flux - truth).abs() <= 0.2 * spot.flux_error
            })
            .count();
        assert!(close < 150, "{close}: the interval is far wider than the error");
    }

    #[test]
    fn ghosts_on_the_axis_have_the_shares_of_the_matrices() {
        // Stopped down, so that rays are near the axis; bare, so that they are reflected alike.
        let system = system(&Prescription { coating: Coating::None, ..double_gauss() }, Some(32.0));
        let tracer = Tracer::new(&system, LINE_D).unwrap();
        let direct = tracer.spot(&Path::direct(&system), DVec3::Z, 20_000, 5).unwrap();
        let found = system.ghosts(&GhostOptions::default()).unwrap();
        let (mut shares, mut sizes, mut near) = (0.0_f64, 0.0_f64, 0);
        for ghost in &found.ghosts {
            let spot = tracer.spot(&Path::new(&system, &ghost.reflections).unwrap(), DVec3::Z, 20_000, 7).unwrap();
            let share = (spot.flux / direct.flux / ghost.share[1] - 1.0).abs();
            // The root mean square over an even disc.
            let disc = ghost.radius_mm[1] / 2.0_f64.sqrt();
            shares = shares.max(share);
            sizes = sizes.max((spot.rms - disc).abs() / (disc + 0.01));
            near += usize::from(share < 0.004);
        }
        println!("{near} of {} within 0.4 %; shares {shares:.1e}, sizes {sizes:.1e} off at most", found.ghosts.len());
        // Three that pass the stop only on their way back are wide enough for aberrations even so.
        assert!(near >= 42 && shares < 0.06 && sizes < 0.04);
    }

    #[test]
    fn off_the_axis_a_ghost_is_the_circle_of_its_narrowest_rim() {
        // So little off that no other rim bites, and aberrations are small.
        let (system, angle) = (system(&double_gauss(), Some(22.0)), 0.5_f64);
        let tangent = angle.to_radians().tan();
        let tracer = Tracer::new(&system, LINE_D).unwrap();
        let found = system.ghosts(&GhostOptions::default()).unwrap();
        let (mut compared, mut elsewhere) = (0, 0);
        for ghost in &found.ghosts {
            let path = Path::new(&system, &ghost.reflections).unwrap();
            let spot = tracer.spot(&path, direction(angle), 2000, 7).unwrap();
            let (centre, radius) = ghost.on_sensor(&ghost.clips[0], tangent, found.image_per_tangent * tangent);
            if (ghost.vignetting(tangent) - 1.0).abs() > 1e-9 {
                continue;
            }
            compared += 1;
            assert!((spot.centroid.x - centre).abs() < 0.1 * radius + 0.02, "{ghost:?}: {spot:?}");
            assert!((spot.rms * 2.0_f64.sqrt() - radius).abs() < 0.06 * radius + 0.02, "{ghost:?}: {spot:?}");
            let from_pupil = ghost.scale[1] * ghost.clips[0].center_per_tangent * tangent;
            elsewhere += usize::from(from_pupil.abs() > 0.2 * radius + 0.04);
        }
        println!("{compared} compared, of which {elsewhere} are not about the ray through the pupil's centre");
        assert!(compared > 35 && elsewhere > 3, "{compared} {elsewhere}");
    }

    #[test]
    fn the_same_seed_gives_the_same_spot_and_another_one_near_it() {
        let system = system(&double_gauss(), None);
        let tracer = Tracer::new(&system, LINE_D).unwrap();
        let path = Path::new(&system, &[8, 3]).unwrap();
        let at = |seed| tracer.spot(&path, direction(5.0), 4000, seed).unwrap();
        assert_eq!(at(3), at(3));
        assert!(at(3) != at(4) && (at(3).flux - at(4).flux).abs() < at(3).flux_error + at(4).flux_error);
    }

    #[test]
    fn turning_the_light_about_the_axis_turns_the_spot() {
        let system = system(&double_gauss(), Some(4.0));
        let tracer = Tracer::new(&system, LINE_D).unwrap();
        let path = Path::new(&system, &[4, 1]).unwrap();
        let turned = DVec3::new(0.0, direction(6.0).x, direction(6.0).z);
        let [one, other] = [direction(6.0), turned].map(|way| tracer.spot(&path, way, 4000, 3).unwrap());
        assert!((one.flux - other.flux).abs() < 1e-9 * one.flux, "{one:?} {other:?}");
        // By a quarter turn, from x to y.
        assert!((one.centroid.perp() - other.centroid).length() < 1e-9, "{one:?} {other:?}");
    }

    #[test]
    fn light_that_never_arrives_has_a_bound_and_nonsense_is_refused() {
        let system = system(&double_gauss(), None);
        let tracer = Tracer::new(&system, LINE_D).unwrap();
        let path = Path::direct(&system);
        let dark = tracer.spot(&path, direction(80.0), 1000, 1).unwrap();
        assert_eq!((dark.hits, dark.flux), (0, 0.0));
        assert!(dark.flux_error > 0.0);
        for (way, samples) in [(-DVec3::Z, 1000), (DVec3::X, 1000), (DVec3::ZERO, 1000), (DVec3::Z, 63)] {
            assert!(tracer.spot(&path, way, samples, 1).is_err(), "{way} {samples}");
        }
    }
}
