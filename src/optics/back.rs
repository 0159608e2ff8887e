//! Rays from the sensor back to the scene: the same surfaces in the reverse order, by which every ray keeps its weight (reciprocity).

use glam::{DVec2, DVec3};

use super::path::{Path, Step};
use super::trace::{Light, Ray, Tracer};

/// Where light of the sensor comes from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Origin {
    /// The direction in which it comes in, of length 1 and towards the sensor.
    pub direction: DVec3,
    /// The part of its power that arrives, of unpolarised light.
    pub weight: f64,
}

impl Tracer<'_> {
    /// Where the light is from that comes along a path to the point `position` of the sensor, as if straight from the point `from` of the
    /// plane of the last vertex; both in mm from the axis. None where no light does.
    pub fn back(&self, path: &Path, position: DVec2, from: DVec2) -> Option<Origin> {
        (path.surfaces() == self.system().surfaces().len()).then(|| self.back_by(&path.steps_back(), position, from))?
    }

    /// [`Tracer::back`] by the path's own steps, for many rays.
    pub(super) fn back_by(&self, steps: &[Step], position: DVec2, from: DVec2) -> Option<Origin> {
        let first_order = self.system().first_order();
        let way = (from - position).extend(-first_order.sensor_distance);
        let direction = way.try_normalize().filter(|direction| direction.z < 0.0)?;
        let origin = position.extend(self.system().sensor_z());
        let mut light = Light::unpolarised(Ray { origin, direction });
        for step in steps {
            light = self.step(step, &light)?;
        }
        let (direction, weight) = (-light.ray.direction, light.power());
        (direction.z > 0.0 && weight > 0.0).then_some(Origin { direction, weight })
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{double_gauss, singlet};
    use super::super::{Coating, GhostOptions, LINE_D, Prescription, Setup, System, direction};
    use super::*;

    /// A ray that is traced to the sensor and back comes from where it came, and loses as much light on the way.
    #[test]
    fn the_way_back_is_the_way_there() {
        let coated = Prescription { coating: Coating::MgF2, ..double_gauss() };
        for lens in [coated, singlet()] {
            let system = System::new(&lens, &Setup::default()).unwrap();
            let tracer = Tracer::new(&system, LINE_D).unwrap();
            let found = system.ghosts(&GhostOptions::default()).unwrap();
            let ghosts = found.ghosts.iter().map(|ghost| Path::new(&system, &ghost.reflections).unwrap());
            let (mut there, last) = (0, system.surfaces().last().unwrap().z);
            for path in ghosts.chain([Path::direct(&system)]) {
                for (angle, pupil) in [(0.0, DVec2::new(3.0, 1.0)), (5.0, DVec2::new(-1.0, 2.0)), (9.0, DVec2::ZERO)] {
                    let way = direction(angle);
                    let (Some(hit), Some(points)) = (tracer.trace(&path, way, pupil), tracer.way(&path, way, pupil))
                    else {
                        continue;
                    };
                    there += 1;
                    let [.., from, to] = points[..] else { panic!("a surface and the sensor") };
                    let at_vertex = to + (from - to) * ((last - to.z) / (from.z - to.z));
                    let back = tracer.back(&path, hit.position, at_vertex.truncate()).unwrap();
                    assert!((back.direction - way).length() < 1e-9, "{:?}: {back:?}", path.reflections());
                    assert!((back.weight / hit.weight - 1.0).abs() < 1e-9, "{:?}: {back:?}", path.reflections());
                }
            }
            assert!(there > 5, "{there} rays of {}", system.name());
        }
    }

    #[test]
    fn nothing_comes_from_beyond_the_rims_or_along_a_path_of_another_lens() {
        let (one, other) =
            [singlet(), double_gauss()].map(|lens| System::new(&lens, &Setup::default()).unwrap()).into();
        let tracer = Tracer::new(&one, LINE_D).unwrap();
        let direct = Path::direct(&one);
        assert!(tracer.back(&direct, DVec2::ZERO, DVec2::new(1.0, 0.0)).is_some());
        assert_eq!(tracer.back(&direct, DVec2::ZERO, DVec2::new(13.0, 0.0)), None);
        assert_eq!(tracer.back(&direct, DVec2::splat(f64::NAN), DVec2::ZERO), None);
        assert_eq!(tracer.back(&Path::direct(&other), DVec2::ZERO, DVec2::ZERO), None);
    }
}
