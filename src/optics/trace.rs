//! Rays traced through a lens one surface after the other, exactly: spheres and conics, Snell's law in vectors.
//!
//! What lies between two surfaces is a straight line, in whichever order surfaces meet beyond their rims. A ray is lost
//! where it misses a surface or its rim, and where all of it is reflected that should go through. Its power is that of
//! unpolarised light, as two crossed polarisations whose fields are followed as vectors: surfaces that light meets
//! at an angle polarise it for those that follow (Chipman, "Polarization ray tracing", Optical Engineering 34(6), 1995).

use glam::{DVec2, DVec3};
use num_complex::Complex64;

use super::error::Result;
use super::path::{Path, Step};
use super::setup::check_wavelength;
use super::system::{OpticalSurface, System};
use super::thin_film::{Layer, amplitudes};

/// Traces light of one wavelength.
#[derive(Debug, Clone)]
pub struct Tracer<'a> {
    system: &'a System,
    wavelength: f64,
    indices: Vec<f64>,
    /// Each surface's films as light from behind meets them.
    from_behind: Vec<Vec<Layer>>,
}

/// Where a ray meets the sensor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hit {
    /// From the axis, in mm.
    pub position: DVec2,
    /// The part of its power that arrives, of unpolarised light.
    pub weight: f64,
}

/// A ray, by a point of it and its direction, which has the length 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Ray {
    pub origin: DVec3,
    pub direction: DVec3,
}

/// A complex electric field; of power 1 where its square is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Field {
    re: DVec3,
    im: DVec3,
}

/// A ray, and the fields along it of light that came in two crossed polarisations.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Light {
    pub ray: Ray,
    fields: [Field; 2],
}

/// The direction, of length 1, of light that comes in at `angle` degrees from the axis and makes its image on the side of
/// positive x.
pub fn direction(angle: f64) -> DVec3 {
    let (sine, cosine) = angle.to_radians().sin_cos();
    DVec3::new(sine, 0.0, cosine)
}

impl<'a> Tracer<'a> {
    /// A tracer of light of a wavelength in nm.
    ///
    /// # Errors
    ///
    /// A wavelength that is not from 300 to 1200 nm.
    pub fn new(system: &'a System, wavelength: f64) -> Result<Self> {
        check_wavelength(wavelength)?;
        let reversed = |surface: &OpticalSurface| surface.layers.iter().rev().copied().collect();
        let from_behind = system.surfaces().iter().map(reversed).collect();
        Ok(Self { system, wavelength, indices: system.indices(wavelength), from_behind })
    }

    /// The lens.
    pub fn system(&self) -> &System {
        self.system
    }

    /// Where light of a distant source goes along a path: it comes in `direction`, of any length and towards the sensor,
    /// and would meet the plane of the entrance pupil at `pupil`, in mm from the axis. None where it is lost.
    pub fn trace(&self, path: &Path, direction: DVec3, pupil: DVec2) -> Option<Hit> {
        self.trace_steps(&path.steps(), path, direction, pupil)
    }

    /// The way of such a ray: where it meets each surface, in the light's order, and the sensor; in mm, z from the first
    /// vertex. None where it is lost.
    pub fn way(&self, path: &Path, direction: DVec3, pupil: DVec2) -> Option<Vec<DVec3>> {
        let mut points = Vec::new();
        let hit = self.follow(&path.steps(), path, direction, pupil, |point| points.push(point))?;
        points.push(hit.position.extend(self.system.sensor_z()));
        Some(points)
    }

    /// [`Tracer::trace`] by the path's own steps, for many rays.
    pub(super) fn trace_steps(&self, steps: &[Step], path: &Path, direction: DVec3, pupil: DVec2) -> Option<Hit> {
        self.follow(steps, path, direction, pupil, |_| {})
    }

    /// [`Tracer::trace_steps`], telling where the ray meets each surface.
    fn follow(
        &self,
        steps: &[Step],
        path: &Path,
        direction: DVec3,
        pupil: DVec2,
        mut tell: impl FnMut(DVec3),
    ) -> Option<Hit> {
        let direction = direction.try_normalize().filter(|direction| direction.z > 0.0)?;
        if path.surfaces() != self.system.surfaces().len() {
            return None;
        }
        let at_pupil = pupil.extend(self.system.first_order().entrance_pupil.z);
        let origin = at_pupil - direction * (at_pupil.z / direction.z);
        let mut light = Light::unpolarised(Ray { origin, direction });
        for step in steps {
            light = self.step(step, &light)?;
            tell(light.ray.origin);
        }
        let Ray { origin, direction } = light.ray;
        let position = (origin + direction * ((self.system.sensor_z() - origin.z) / direction.z)).truncate();
        let weight = light.power();
        (direction.z > 0.0 && position.is_finite() && weight > 0.0).then_some(Hit { position, weight })
    }

    /// The light behind a surface.
    pub(super) fn step(&self, step: &Step, light: &Light) -> Option<Light> {
        let surface = &self.system.surfaces()[step.surface];
        let incident = light.ray.direction;
        let (origin, normal) = surface.meet(light.ray, step.forward)?;
        let indices = [self.indices[step.surface], self.indices[step.surface + 1]];
        let ([before, behind], layers) = match step.forward {
            true => (indices, &surface.layers),
            false => ([indices[1], indices[0]], &self.from_behind[step.surface]),
        };
        let cosine = normal.dot(incident);
        let [s, p] = amplitudes(before, layers, behind, self.wavelength, cosine);
        let (direction, [s, p]) = match step.reflects {
            // Of p, the part along the surface is turned against the vector of p.
            true => (incident - 2.0 * cosine * normal, [s.reflected, -p.reflected]),
            false => (refract(incident, normal, before / behind)?, [s.transmitted, p.transmitted]),
        };
        let direction = direction.normalize();
        let across = incident.cross(normal).try_normalize().unwrap_or_else(|| incident.any_orthonormal_vector());
        let [old, new] = [incident, direction].map(|way| across.cross(way));
        let fields = light.fields.map(|field| field.turned([across, old], [across, new], [s, p]));
        Some(Light { ray: Ray { origin, direction }, fields })
    }
}

impl Light {
    /// Unpolarised light of power 1.
    pub fn unpolarised(ray: Ray) -> Self {
        Self { ray, fields: <[DVec3; 2]>::from(ray.direction.any_orthonormal_pair()).map(Field::real) }
    }

    /// What is left of its power.
    pub fn power(&self) -> f64 {
        0.5 * self.fields.iter().map(Field::power).sum::<f64>()
    }
}

impl Field {
    fn real(re: DVec3) -> Self {
        Self { re, im: DVec3::ZERO }
    }

    fn along(&self, axis: DVec3) -> Complex64 {
        Complex64::new(self.re.dot(axis), self.im.dot(axis))
    }

    fn power(&self) -> f64 {
        self.re.length_squared() + self.im.length_squared()
    }

    /// The field whose parts along `from` become so many times themselves along `to`.
    fn turned(&self, from: [DVec3; 2], to: [DVec3; 2], by: [Complex64; 2]) -> Self {
        let [s, p] = [by[0] * self.along(from[0]), by[1] * self.along(from[1])];
        Self { re: s.re * to[0] + p.re * to[1], im: s.im * to[0] + p.im * to[1] }
    }
}

/// Snell's law in vectors, for a normal that points the way of the light; none where all of it is reflected.
fn refract(direction: DVec3, normal: DVec3, ratio: f64) -> Option<DVec3> {
    let cosine = normal.dot(direction);
    let square = 1.0 - ratio * ratio * (1.0 - cosine * cosine);
    (square >= 0.0).then(|| ratio * direction + (square.sqrt() - ratio * cosine) * normal)
}

impl OpticalSurface {
    /// Where a ray meets it within its rim, and the normal there that points the way of the light.
    ///
    /// The surface is c (x² + y² + (1 + k) z²) = 2 z about its vertex. Of the two places on a line, it is the one at which
    /// light goes through the surface from the side that it is on.
    fn meet(&self, ray: Ray, forward: bool) -> Option<(DVec3, DVec3)> {
        let stretched = DVec3::new(1.0, 1.0, 1.0 + self.conic);
        let (from, along) = (ray.origin - DVec3::new(0.0, 0.0, self.z), ray.direction);
        let square = self.curvature * along.dot(stretched * along);
        let half = along.z - self.curvature * from.dot(stretched * along);
        let constant = self.curvature * from.dot(stretched * from) - 2.0 * from.z;
        let root = (half * half - square * constant).sqrt();
        let distance = constant / (half + if forward { root } else { -root });
        let point = from + along * distance;
        // Towards the sensor on the sheet of the vertex; away from it on the other, of a sphere's back or a hyperboloid.
        let gradient = DVec3::new(0.0, 0.0, 1.0) - self.curvature * stretched * point;
        let within = point.truncate().length() <= self.semi_aperture;
        let on_sheet = gradient.z > 0.0;
        if !(within && on_sheet) {
            return None;
        }
        let normal = gradient.normalize();
        Some((point + DVec3::new(0.0, 0.0, self.z), if forward { normal } else { -normal }))
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{double_gauss, singlet};
    use super::super::{Coating, GhostOptions, Glass, LINE_D, Prescription, Setup, Surface};
    use super::*;

    fn system(lens: &Prescription) -> System {
        System::new(lens, &Setup::default()).unwrap()
    }

    fn surface(curvature: f64, conic: f64, semi_aperture: f64) -> OpticalSurface {
        OpticalSurface { z: 3.0, curvature, conic, semi_aperture, glass: Glass::air(), layers: Vec::new() }
    }

    #[test]
    fn a_ray_meets_conics_where_their_sag_is() {
        for (curvature, conic) in [(0.0, 0.0), (0.05, 0.0), (-0.05, 0.0), (0.05, -1.0), (-0.04, -2.5), (0.04, 0.8)] {
            let surface = surface(curvature, conic, 10.0);
            let shape = Surface { radius: Some(1.0 / curvature), conic, ..Surface::plane(None, 10.0) };
            for forward in [true, false] {
                let z: f64 = if forward { -20.0 } else { 20.0 };
                let direction = DVec3::new(0.1, -0.05, -z.signum()).normalize();
                let ray = Ray { origin: DVec3::new(1.0, 2.0, z), direction };
                let (point, normal) = surface.meet(ray, forward).unwrap();
                let height = point.truncate().length();
                assert!((point.z - 3.0 - shape.sag(height)).abs() < 1e-12, "{curvature} {conic}: {point}");
                assert!(normal.dot(direction) > 0.9 && (normal.length() - 1.0).abs() < 1e-15);
                let along = (point - ray.origin).normalize();
                assert!((along - direction).length() < 1e-12, "it is on the ray");
            }
        }
    }

    #[test]
    fn rays_that_miss_a_surface_or_its_rim_are_lost() {
        let along = |height: f64| Ray { origin: DVec3::new(height, 0.0, 0.0), direction: DVec3::Z };
        let sphere = surface(0.1, 0.0, 9.0);
        assert!(sphere.meet(along(8.99), true).is_some());
        assert!(sphere.meet(along(9.01), true).is_none(), "beyond the rim");
        assert!(surface(0.1, 0.0, 20.0).meet(along(10.01), true).is_none(), "beyond the sphere");
        // Through the sphere's back only.
        let steep = Ray { origin: DVec3::new(0.0, 0.0, 22.0), direction: DVec3::new(1.0, 0.0, -0.5).normalize() };
        assert!(sphere.meet(steep, true).is_none());
    }

    #[test]
    fn snells_law_holds_and_total_reflection_loses_the_ray() {
        let normal = DVec3::new(0.2, -0.1, 1.0).normalize();
        let incident = direction(30.0);
        let refracted = refract(incident, normal, 1.0 / 1.5).unwrap();
        assert!((1.5 * normal.cross(refracted) - normal.cross(incident)).length() < 1e-15);
        assert!((refracted.length() - 1.0).abs() < 1e-15);
        assert!(refract(direction(41.0), DVec3::Z, 1.5).is_some());
        assert!(refract(direction(42.0), DVec3::Z, 1.5).is_none(), "41.8° is the critical angle");
    }

    #[test]
    fn a_hyperboloid_focuses_parallel_light_in_a_point() {
        // Descartes: light in glass of index n, parallel to the axis, and a back surface of the conic constant −n².
        let index = 1.5;
        let glass = Glass::model(index, None);
        let front = Surface { stop: true, glass, ..Surface::plane(Some(10.0), 9.0) };
        let back = Surface { radius: Some(-25.0), conic: -index * index, ..Surface::plane(None, 12.0) };
        let system = system(&Prescription { surfaces: vec![front, back], ..singlet() });
        let tracer = Tracer::new(&system, LINE_D).unwrap();
        for height in [1.0, 5.0, 8.9] {
            let hit = tracer.trace(&Path::direct(&system), DVec3::Z, DVec2::new(0.0, height)).unwrap();
            assert!(hit.position.length() < 1e-12, "{height}: {hit:?}");
            assert!((0.8..0.93).contains(&hit.weight), "two bare surfaces: {hit:?}");
        }
    }

    #[test]
    fn near_the_axis_rays_go_where_the_matrices_say() {
        for lens in [double_gauss(), singlet()] {
            let system = system(&lens);
            let indices = system.indices(LINE_D);
            let tracer = Tracer::new(&system, LINE_D).unwrap();
            let found = system.ghosts(&GhostOptions { four_bounces: Some(1e-7), ..GhostOptions::default() }).unwrap();
            let paths = found.ghosts.iter().map(|ghost| Path::new(&system, &ghost.reflections).unwrap());
            let mut worst = 0.0_f64;
            for path in paths.chain([Path::direct(&system)]) {
                let matrix = system.matrix(&path, &indices);
                let per_tangent = matrix.b - matrix.a * system.first_order().entrance_pupil.z;
                let (small, degrees) = (1e-4, 1e-4_f64);
                let by_pupil = tracer.trace(&path, DVec3::Z, DVec2::new(small, 0.0)).unwrap().position.x;
                let by_angle = tracer.trace(&path, direction(degrees), DVec2::ZERO).unwrap().position.x;
                let off = |found: f64, expected: f64| (found - expected).abs() / (expected.abs() + 1e-9);
                worst = worst.max(off(by_pupil, matrix.a * small));
                worst = worst.max(off(by_angle, per_tangent * degrees.to_radians().tan()));
            }
            println!("{} ghosts of {}: at most {worst:.1e} off", found.ghosts.len(), system.name());
            assert!(worst < 1e-5, "{}: {worst}", system.name());
        }
    }

    #[test]
    fn the_way_of_a_ray_is_by_its_paths_surfaces_to_where_it_is_traced() {
        let system = system(&double_gauss());
        let tracer = Tracer::new(&system, LINE_D).unwrap();
        let (from, pupil) = (direction(3.0), DVec2::new(2.0, 1.0));
        for (reflections, numbers) in [
            (vec![], (1..=11).collect()),
            (vec![3, 1], [1, 2, 3, 2, 1].into_iter().chain(2..=11).collect::<Vec<usize>>()),
        ] {
            let path = Path::new(&system, &reflections).unwrap();
            let way = tracer.way(&path, from, pupil).unwrap();
            let (sensor, points) = way.split_last().unwrap();
            assert_eq!(points.len(), numbers.len());
            for (point, number) in points.iter().zip(numbers) {
                let OpticalSurface { z, curvature, .. } = system.surfaces()[number - 1];
                let off = curvature * (point - DVec3::new(0.0, 0.0, z)).length_squared() - 2.0 * (point.z - z);
                assert!(off.abs() < 1e-12, "surface {number}: {point}");
            }
            assert_eq!(sensor.truncate(), tracer.trace(&path, from, pupil).unwrap().position);
            assert_eq!(sensor.z, system.sensor_z());
        }
        assert_eq!(tracer.way(&Path::direct(&system), from, DVec2::new(90.0, 0.0)), None);
    }

    #[test]
    fn the_axial_rays_weight_is_the_share_of_the_matrices() {
        let system = system(&Prescription { coating: Coating::MgF2, ..double_gauss() });
        let tracer = Tracer::new(&system, 500.0).unwrap();
        let indices = system.indices(500.0);
        let at = |k: usize| system.surfaces()[k - 1].reflectance(indices[k - 1], indices[k], 500.0);
        let hit = tracer.trace(&Path::new(&system, &[4, 2]).unwrap(), DVec3::Z, DVec2::ZERO).unwrap();
        // Through every surface once, and 3 twice more.
        let through: f64 = (1..=11).map(|k| 1.0 - at(k)).product();
        assert!((hit.weight / (at(4) * at(2) * through * (1.0 - at(3)).powi(2)) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn light_from_behind_and_paths_of_other_lenses_give_nothing() {
        let (one, other) = (system(&singlet()), system(&double_gauss()));
        let tracer = Tracer::new(&one, LINE_D).unwrap();
        let path = Path::direct(&one);
        assert!(tracer.trace(&path, DVec3::Z, DVec2::ZERO).is_some());
        for direction in [-DVec3::Z, DVec3::X, DVec3::ZERO, DVec3::splat(f64::NAN), direction(179.0)] {
            assert_eq!(tracer.trace(&path, direction, DVec2::ZERO), None, "{direction}");
        }
        assert_eq!(tracer.trace(&path, DVec3::Z, DVec2::splat(f64::NAN)), None);
        assert_eq!(tracer.trace(&Path::direct(&other), DVec3::Z, DVec2::ZERO), None);
        assert!(Tracer::new(&one, 0.0).is_err());
    }
}
