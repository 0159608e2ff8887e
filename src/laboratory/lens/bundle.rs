//! Bundles of exact rays in the plane of a section through the axis, as lines to draw.

use glam::DVec2;

use crate::Result;
use crate::optics::{GhostPath, Path, Prescription, System, Tracer, direction};

/// Rays that look for the light in a bundle.
const PILOT: u32 = 81;

/// A bundle's field angle has to let at least this part of them through, of those that come through on the axis.
const LEAST: f64 = 0.1;

/// A ray: z along the axis and the height over it, in mm, at each surface and at the sensor.
pub(super) type Ray = Vec<[f64; 2]>;

/// A lens whose rays are drawn.
pub(super) struct Bundles<'a> {
    lens: &'a Prescription,
    system: &'a System,
    tracer: Tracer<'a>,
}

impl<'a> Bundles<'a> {
    /// Of light at the wavelength at which the lens is set up.
    ///
    /// # Errors
    /// Those of [`Tracer::new`].
    pub fn new(lens: &'a Prescription, system: &'a System) -> Result<Self> {
        Ok(Self { lens, system, tracer: Tracer::new(system, system.setup().wavelength)? })
    }

    /// So many rays of light at this angle from the axis, in degrees, straight through: evenly spread over what arrives.
    pub fn direct(&self, angle: f64, count: u32) -> Vec<Ray> {
        let Some((first, last)) = self.ends(angle) else { return Vec::new() };
        let path = Path::direct(self.system);
        let place = |k: u32| first + (last - first) * f64::from(k) / f64::from(count.max(2) - 1);
        (0..count.max(2)).filter_map(|k| self.ray(&path, angle, self.at_front(angle, place(k)))).collect()
    }

    /// So many rays by a ghost's path, of those that arrive.
    ///
    /// # Errors
    /// A path that the lens does not have.
    pub fn ghost(&self, ghost: &GhostPath, angle: f64, count: u32) -> Result<Vec<Ray>> {
        let path = Path::new(self.system, &ghost.reflections)?;
        let Some(rim) = ghost.clips.first() else { return Ok(Vec::new()) };
        let centre = rim.center_per_tangent * angle.to_radians().tan();
        let place = |k: u32| centre + rim.radius * (2.0 * f64::from(k) / f64::from(PILOT - 1) - 1.0);
        let arrived: Vec<Ray> = (0..PILOT).filter_map(|k| self.ray(&path, angle, place(k))).collect();
        let last = arrived.len().saturating_sub(1);
        let spread =
            (0..count.max(2)).map(|k| (last as f64 * f64::from(k) / f64::from(count.max(2) - 1)).round() as usize);
        let mut picked: Vec<usize> = spread.collect();
        picked.dedup();
        Ok(picked.into_iter().filter_map(|k| arrived.get(k).cloned()).collect())
    }

    /// The angle of the light at the edge of the field, in degrees: that whose image is in the sensor's corner, by exact
    /// rays, or the one that the lens's source states, if that is less, or the last at which light comes through.
    pub fn edge(&self) -> f64 {
        let [width, height] = self.system.setup().sensor;
        let corner = 0.5 * width.hypot(height);
        let axial = self.lit(0.0).len() as f64;
        let path = Path::direct(self.system);
        let is_inside = |angle: f64| {
            let lit = self.lit(angle);
            let Some(&middle) = lit.get(lit.len() / 2) else { return false };
            let ray = self.ray(&path, angle, self.at_front(angle, middle));
            let image = ray.and_then(|ray| ray.last().map(|point| point[1].abs()));
            lit.len() as f64 >= LEAST * axial && image.is_some_and(|image| image <= corner)
        };
        let (mut inside, mut outside) = (0.0, self.lens.field.unwrap_or(89.0).min(89.0));
        if is_inside(outside) {
            return outside;
        }
        // To a fiftieth of a degree.
        for _ in 0..13 {
            let middle = 0.5 * (inside + outside);
            *(if is_inside(middle) { &mut inside } else { &mut outside }) = middle;
        }
        inside
    }

    /// The height on the first surface of the first and of the last ray that arrive.
    fn ends(&self, angle: f64) -> Option<(f64, f64)> {
        let lit = self.lit(angle);
        let (&first, &last) = lit.first().zip(lit.last())?;
        let path = Path::direct(self.system);
        let arrives = |height: f64| self.ray(&path, angle, self.at_front(angle, height)).is_some();
        // Outwards as far as light arrives, by halves of the step.
        let outwards = |mut end: f64, sign: f64| {
            let mut step = self.step();
            for _ in 0..8 {
                step *= 0.5;
                end += if arrives(end + sign * step) { sign * step } else { 0.0 };
            }
            end
        };
        Some((outwards(first, -1.0), outwards(last, 1.0)))
    }

    /// The heights on the first surface at which light arrives that goes straight through.
    fn lit(&self, angle: f64) -> Vec<f64> {
        let path = Path::direct(self.system);
        let reach = 0.5 * f64::from(PILOT - 1);
        let heights = (0..PILOT).map(|k| (f64::from(k) - reach) * self.step());
        heights.filter(|&height| self.ray(&path, angle, self.at_front(angle, height)).is_some()).collect()
    }

    fn step(&self) -> f64 {
        let semi_aperture = self.lens.surfaces.first().map_or(0.0, |first| first.semi_aperture);
        // Just within the rim.
        1.999 * semi_aperture / f64::from(PILOT - 1)
    }

    /// Where a ray would meet the plane of the entrance pupil that meets the first surface at a height.
    fn at_front(&self, angle: f64, height: f64) -> f64 {
        let sag = self.lens.surfaces.first().map_or(0.0, |first| first.sag(height));
        height + (self.system.first_order().entrance_pupil.z - sag) * angle.to_radians().tan()
    }

    fn ray(&self, path: &Path, angle: f64, pupil: f64) -> Option<Ray> {
        let way = self.tracer.way(path, direction(angle), DVec2::new(pupil, 0.0))?;
        Some(way.into_iter().map(|point| [point.z, point.x]).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::optics::{GhostOptions, Setup};
    use crate::scene::lenses;

    #[test]
    fn every_lens_has_a_bundle_on_the_axis_and_one_at_the_edge() {
        for lens in lenses::all() {
            let read = lens.prescription().unwrap();
            let system = System::new(&read, &Setup::default()).unwrap();
            let bundles = Bundles::new(&read, &system).unwrap();
            let edge = bundles.edge();
            let field = system.first_order().half_field;
            assert!(edge > 0.5 * field.min(read.field.unwrap()), "{}: {edge}°, {field}°", lens.name);
            for angle in [0.0, edge] {
                let rays = bundles.direct(angle, 5);
                assert!(rays.len() >= 4, "{}, {angle}°: {}", lens.name, rays.len());
                assert!(rays.iter().all(|ray| ray.len() == read.surfaces.len() + 1), "{}", lens.name);
                // A fraction of the field's size, which a fast lens's edge blurs.
                let [low, high] =
                    [f64::min, f64::max].map(|pick| rays.iter().map(|ray| ray[ray.len() - 1][1]).reduce(pick).unwrap());
                assert!(high - low < 3.0, "{}, {angle}°: {low} to {high}", lens.name);
            }
        }
    }

    #[test]
    fn a_bundle_on_the_axis_fills_the_stop() {
        let read = lenses::find("tessar").unwrap().prescription().unwrap();
        let system = System::new(&read, &Setup { fstop: Some(8.0), ..Setup::default() }).unwrap();
        let bundles = Bundles::new(&read, &system).unwrap();
        let (stop, rays) = (system.stop_number() - 1, bundles.direct(0.0, 7));
        assert_eq!(rays.len(), 7);
        let semi_aperture = system.surfaces()[stop].semi_aperture;
        for (ray, sign) in [(&rays[0], -1.0), (&rays[6], 1.0)] {
            assert!((ray[stop][1] - sign * semi_aperture).abs() < 0.02 * semi_aperture, "{}", ray[stop][1]);
        }
    }

    #[test]
    fn a_ghosts_rays_turn_at_its_surfaces() {
        let read = lenses::find("double-gauss").unwrap().prescription().unwrap();
        let system = System::new(&read, &Setup::default()).unwrap();
        let ghosts = system.ghosts(&GhostOptions::default()).unwrap();
        let bundles = Bundles::new(&read, &system).unwrap();
        let ghost = ghosts.ghosts.iter().find(|ghost| ghost.reflections == [8, 3]).unwrap();
        for ray in bundles.ghost(ghost, 0.0, 5).unwrap() {
            // To the eighth surface, back to the third, and through all that follow.
            assert_eq!(ray.len(), 8 + 5 + (read.surfaces.len() - 3) + 1);
            let back = ray.windows(2).filter(|pair| pair[1][0] < pair[0][0]).count();
            assert_eq!(back, 5);
        }
    }
}
