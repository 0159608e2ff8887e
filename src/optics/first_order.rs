//! What paraxial optics says of a lens: focal length, pupils, f-number, field.

use serde::Serialize;

use super::error::{OpticsError, Result};
use super::matrix::RayMatrix;
use super::path::Step;
use super::setup::Setup;
use super::system::{OpticalSurface, indices, walk};

/// A lens with a longer focal length than this, in mm, has no power.
const LONGEST_FOCAL_LENGTH: f64 = 1e7;

/// By how much a lens may be asked to open wider than it does: what is engraved is rounded.
const ENGRAVED: f64 = 1.01;

/// First-order properties of a lens that is set up. Lengths in mm.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct FirstOrder {
    /// The effective focal length: a distant light at the angle θ is imaged at tan θ times it.
    pub focal_length: f64,
    /// From the last vertex to the focal point.
    pub back_focus: f64,
    /// From the last vertex to the sensor.
    pub sensor_distance: f64,
    /// How much further the sensor is from the lens than at infinity.
    pub focus_extension: f64,
    /// Focal length through the diameter of the entrance pupil, of distant light on the axis.
    pub f_number: f64,
    /// The same wide open.
    pub widest_f_number: f64,
    /// The image of the stop as the scene sees it; z is from the first vertex.
    pub entrance_pupil: Pupil,
    /// The radius in the entrance pupil of what all rims let through of distant light on the axis, by paraxial heights:
    /// the pupil's own, or a little less where rims are as narrow as real rays allow.
    pub axial_radius: f64,
    /// The image of the stop as the sensor sees it; z is from the last vertex. None where it is at infinity.
    pub exit_pupil: Option<Pupil>,
    /// The angle from the axis, in degrees, of a distant light whose image is in a corner of the sensor.
    pub half_field: f64,
}

/// An image of the stop.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Pupil {
    /// Its place on the axis, in mm.
    pub z: f64,
    /// In mm.
    pub radius: f64,
}

/// The matrices that everything follows from.
struct Matrices {
    /// From the first vertex to behind the last surface.
    whole: RayMatrix,
    /// From the first vertex to each surface.
    before: Vec<RayMatrix>,
    /// The index before the sensor.
    last_index: f64,
}

impl FirstOrder {
    /// Those of a lens, and the stop's semi-aperture in the setup. `sensor` is the distance of the sensor from the last
    /// vertex at infinity, where the lens states it.
    pub(super) fn of(
        name: &str,
        surfaces: &[OpticalSurface],
        stop: usize,
        sensor: Option<f64>,
        setup: &Setup,
    ) -> Result<(Self, f64)> {
        let matrices = Matrices::of(surfaces, setup.wavelength);
        let Matrices { whole, before, last_index } = &matrices;
        let focal_length = matrices.focal_length(name)?;
        let back_focus = -last_index * whole.a / whole.c;
        if focal_length < 0.0 || back_focus < 0.0 {
            return Err(OpticsError::NoRealImage { lens: name.to_owned(), focal_length, back_focus });
        }
        let to_stop = before[stop];
        if to_stop.a.abs() < 1e-9 {
            let reason = "the entrance pupil is at infinity: no distant light has a cone of its own";
            return Err(OpticsError::Lens { lens: name.to_owned(), reason: reason.to_owned() });
        }
        // A ray of height 1 that comes along the axis has these heights at the rims.
        let in_pupil = |(surface, matrix): (&OpticalSurface, &RayMatrix)| surface.semi_aperture / matrix.a.abs();
        let widest = in_pupil((&surfaces[stop], &to_stop));
        let radius = opened(name, focal_length, widest, to_stop.a, setup)?;
        let axial_radius = surfaces.iter().zip(before).map(in_pupil).fold(radius, f64::min);
        let semi_aperture = radius * to_stop.a.abs();
        let at_infinity = sensor.unwrap_or(back_focus);
        let focus_extension =
            setup.focus.map_or(Ok(0.0), |focus| matrices.extension(name, surfaces, at_infinity, focus))?;
        let sensor_distance = at_infinity + focus_extension;
        let entrance = Pupil { z: to_stop.b / to_stop.a, radius };
        let to_sensor = RayMatrix::translation(sensor_distance, *last_index) * *whole;
        let image_per_tangent = to_sensor.b - to_sensor.a * entrance.z;
        if image_per_tangent.abs() < 1e-9 * focal_length {
            let reason = "the sensor sees the stop sharply instead of the scene";
            return Err(OpticsError::Lens { lens: name.to_owned(), reason: reason.to_owned() });
        }
        let [width, height] = setup.sensor;
        let first_order = Self {
            focal_length,
            back_focus,
            sensor_distance,
            focus_extension,
            f_number: 0.5 * focal_length / radius,
            widest_f_number: 0.5 * focal_length / widest,
            entrance_pupil: entrance,
            axial_radius,
            exit_pupil: matrices.exit_pupil(to_stop, semi_aperture),
            half_field: (0.5 * width.hypot(height) / image_per_tangent.abs()).atan().to_degrees(),
        };
        Ok((first_order, semi_aperture))
    }
}

/// The entrance pupil's radius in a setup.
fn opened(name: &str, focal_length: f64, widest: f64, to_stop: f64, setup: &Setup) -> Result<f64> {
    let radius = setup.fstop.map_or(widest, |fstop| 0.5 * focal_length / fstop);
    if radius > widest * ENGRAVED {
        let [asked, opens] = [radius, widest].map(|radius| 0.5 * focal_length / radius);
        return Err(OpticsError::Setup(format!("{name} opens to f/{opens:.2}, and f/{asked} was asked")));
    }
    let radius = radius.min(widest);
    if radius * to_stop.abs() < setup.wavelength * 1e-6 {
        let fstop = 0.5 * focal_length / radius;
        return Err(OpticsError::Setup(format!(
            "f/{fstop} closes the stop of {name} to less than a wavelength: no light goes in rays through it"
        )));
    }
    Ok(radius)
}

impl Matrices {
    fn of(surfaces: &[OpticalSurface], wavelength: f64) -> Self {
        let indices = indices(surfaces, wavelength);
        let step = |surface| Step { surface, forward: true, reflects: false };
        let steps: Vec<_> = (0..surfaces.len()).map(step).collect();
        let mut before = Vec::with_capacity(surfaces.len());
        let whole = walk(surfaces, &steps, &indices, |_, matrix| before.push(*matrix));
        Self { whole, before, last_index: indices.last().copied().unwrap_or(1.0) }
    }

    fn focal_length(&self, name: &str) -> Result<f64> {
        let focal_length = -1.0 / self.whole.c;
        if !focal_length.is_finite() || focal_length.abs() > LONGEST_FOCAL_LENGTH {
            return Err(OpticsError::Afocal { lens: name.to_owned() });
        }
        Ok(focal_length)
    }

    /// How much further from the sensor the whole lens has to go for a focus at so many metres from the sensor.
    ///
    /// Newton's equation x x′ = n′ f² for the distances from the focal points, whose sum with what is between them is the
    /// distance that was asked; the lesser root is that of a camera.
    fn extension(&self, name: &str, surfaces: &[OpticalSurface], at_infinity: f64, focus: f64) -> Result<f64> {
        let Self { whole, last_index, .. } = self;
        let length = surfaces.last().map_or(0.0, |surface| surface.z);
        // From the front focal point to the sensor at infinity.
        let between = length + at_infinity - whole.d / whole.c;
        let product = last_index / whole.c.powi(2);
        let sum = 1000.0 * focus - between;
        let square = sum * sum - 4.0 * product;
        if sum <= 0.0 || square < 0.0 {
            let nearest = (between + 2.0 * product.sqrt()) / 1000.0;
            return Err(OpticsError::Setup(format!(
                "{name} focuses no nearer than {nearest:.3} m from the sensor, and {focus} m was asked"
            )));
        }
        Ok(2.0 * product / (sum + square.sqrt()))
    }

    fn exit_pupil(&self, to_stop: RayMatrix, semi_aperture: f64) -> Option<Pupil> {
        let RayMatrix { b, d, .. } = self.whole * to_stop.inverse();
        (d.abs() > 1e-9).then(|| Pupil { z: -self.last_index * b / d, radius: semi_aperture / d.abs() })
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{double_gauss, singlet};
    use super::super::{Dispersion, Glass, LINE_D, Prescription, Surface, System};
    use super::*;

    fn first_order(lens: &Prescription, setup: Setup) -> FirstOrder {
        *System::new(lens, &setup).unwrap().first_order()
    }

    /// A thin lens of this focal length at its own stop.
    fn thin(focal_length: f64, semi_aperture: f64) -> Prescription {
        let radius = Some(focal_length);
        let front =
            Surface { radius, stop: true, glass: Glass::model(1.5, None), ..Surface::plane(Some(0.0), semi_aperture) };
        let back = Surface { radius: radius.map(|radius| -radius), ..Surface::plane(None, semi_aperture) };
        Prescription { surfaces: vec![front, back], ..singlet() }
    }

    #[test]
    fn a_thick_lens_has_the_focal_length_of_the_lensmakers_equation() {
        let [n, r1, r2, d] = [1.6_f64, 40.0, -70.0, 9.0];
        let glass = Glass::model(n, None);
        let front = Surface { radius: Some(r1), stop: true, glass, ..Surface::plane(Some(d), 5.0) };
        let lens = Prescription {
            surfaces: vec![front, Surface { radius: Some(r2), ..Surface::plane(None, 9.0) }],
            ..singlet()
        };
        let power = (n - 1.0) * (1.0 / r1 - 1.0 / r2 + (n - 1.0) * d / (n * r1 * r2));
        let found = first_order(&lens, Setup::default());
        assert!((found.focal_length - 1.0 / power).abs() < 1e-12);
        assert!((found.back_focus - (1.0 - (n - 1.0) * d / (n * r1)) / power).abs() < 1e-12);
        assert!((found.f_number - found.focal_length / 10.0).abs() < 1e-12);
        assert_eq!(found.entrance_pupil, Pupil { z: 0.0, radius: 5.0 });
    }

    #[test]
    fn a_double_gauss_is_what_its_patent_says() {
        let found = first_order(&double_gauss(), Setup::default());
        assert!((found.focal_length - 100.0).abs() < 1.0, "{found:?}");
        // The last thickness of the table, which was not read.
        assert!((found.back_focus - 72.228).abs() < 0.02, "{found:?}");
        assert!((found.f_number - 2.0).abs() < 0.1, "{found:?}");
    }

    #[test]
    fn pupils_are_the_images_of_the_stop() {
        // A stop 20 mm behind a thin lens of 50 mm: 1/(20) − 1/50 is seen from the front.
        let mut lens = thin(50.0, 10.0);
        lens.surfaces[0].stop = false;
        lens.surfaces[1].thickness = Some(20.0);
        lens.surfaces.push(Surface { stop: true, ..Surface::plane(None, 3.0) });
        let found = first_order(&lens, Setup::default());
        let place = 1.0 / (1.0 / 20.0 - 1.0 / 50.0);
        assert!((found.entrance_pupil.z - place).abs() < 1e-12, "{found:?}");
        assert!((found.entrance_pupil.radius - 3.0 * place / 20.0).abs() < 1e-12);
        assert_eq!(found.exit_pupil, Some(Pupil { z: 0.0, radius: 3.0 }));
        assert!((found.sensor_distance - 30.0).abs() < 1e-12);
    }

    #[test]
    fn the_exit_pupil_of_a_stop_in_front_is_seen_through_the_lens() {
        // 20 mm before a thin lens of 50 mm: a virtual image at 1/(1/50 − 1/20), larger by the quotient of the distances.
        let mut lens = thin(50.0, 20.0);
        lens.surfaces[0].stop = false;
        lens.surfaces.insert(0, Surface { stop: true, ..Surface::plane(Some(20.0), 3.0) });
        let Pupil { z, radius } = first_order(&lens, Setup::default()).exit_pupil.unwrap();
        let place = 1.0 / (1.0 / 50.0 - 1.0 / 20.0);
        assert!((z - place).abs() < 1e-12 && (radius + 3.0 * place / 20.0).abs() < 1e-12, "{z} {radius}");
    }

    #[test]
    fn a_stop_in_the_front_focus_is_telecentric_behind() {
        let mut lens = thin(50.0, 10.0);
        lens.surfaces[0].stop = false;
        lens.surfaces.insert(0, Surface { stop: true, ..Surface::plane(Some(50.0), 3.0) });
        assert_eq!(first_order(&lens, Setup::default()).exit_pupil, None);
        lens.surfaces.remove(0);
        lens.surfaces[1].thickness = Some(50.0);
        lens.surfaces.push(Surface { stop: true, ..Surface::plane(Some(1.0), 3.0) });
        let error = System::new(&lens, &Setup::default()).unwrap_err().to_string();
        assert!(error.contains("entrance pupil is at infinity"), "{error}");
    }

    #[test]
    fn the_stop_closes_to_the_f_number_and_no_further_open_than_it_is() {
        let lens = thin(50.0, 10.0);
        let at = |fstop| System::new(&lens, &Setup { fstop: Some(fstop), ..Setup::default() });
        let closed = at(8.0).unwrap();
        assert!((closed.first_order().f_number - 8.0).abs() < 1e-12);
        assert!((closed.surfaces()[0].semi_aperture - 50.0 / 16.0).abs() < 1e-12);
        assert!((closed.first_order().widest_f_number - 2.5).abs() < 1e-12);
        assert!((at(2.48).unwrap().first_order().f_number - 2.5).abs() < 1e-12, "as it is engraved");
        for (fstop, said) in [
            (2.0, "opens to f/2.50, and f/2 was asked"),
            (1e6, "less than a wavelength"),
            (0.0, "not above 0"),
            (-2.0, "not above 0"),
            (f64::NAN, "not above 0"),
            (f64::INFINITY, "not above 0"),
        ] {
            let error = at(fstop).unwrap_err().to_string();
            assert!(error.contains(said), "{error}");
        }
    }

    #[test]
    fn a_rim_that_is_narrower_than_the_pupil_bounds_the_light_on_the_axis() {
        let mut lens = singlet();
        lens.surfaces[1].semi_aperture = 4.0;
        let found = first_order(&lens, Setup::default());
        assert_eq!((found.entrance_pupil, found.axial_radius), (Pupil { z: 0.0, radius: 5.0 }, 4.0));
        assert!((found.f_number - found.focal_length / 10.0).abs() < 1e-12);
    }

    #[test]
    fn a_near_focus_moves_the_lens_as_the_thin_lens_equation_says() {
        // Object and image at 1:1 are 4 f apart, and the image is a focal length further back.
        let lens = thin(50.0, 10.0);
        let found = |focus| System::new(&lens, &Setup { focus: Some(focus), ..Setup::default() });
        assert!((found(0.2).unwrap().first_order().focus_extension - 50.0).abs() < 1e-6);
        let FirstOrder { sensor_distance, .. } = *found(1.0).unwrap().first_order();
        assert!((1.0 / sensor_distance + 1.0 / (1000.0 - sensor_distance) - 1.0 / 50.0).abs() < 1e-15);
        assert!(found(0.19).unwrap_err().to_string().contains("no nearer than 0.200 m"));
        assert!(found(-1.0).is_err() && found(f64::NAN).is_err());
    }

    #[test]
    fn the_field_is_what_the_sensor_sees() {
        let half = (0.5 * 36.0_f64.hypot(24.0) / 50.0).atan().to_degrees();
        assert!((first_order(&thin(50.0, 10.0), Setup::default()).half_field - half).abs() < 1e-12);
        for sensor in [[0.0, 24.0], [36.0, f64::NAN], [-1.0, 1.0]] {
            assert!(System::new(&singlet(), &Setup { sensor, ..Setup::default() }).is_err());
        }
        assert!(System::new(&singlet(), &Setup { wavelength: 100.0, ..Setup::default() }).is_err());
    }

    #[test]
    fn lenses_that_make_no_image_are_refused_by_name() {
        let refused = |lens: &Prescription| System::new(lens, &Setup::default()).unwrap_err();
        let mut lens = thin(50.0, 10.0);
        lens.surfaces[0].glass = Glass::model(1.0, None);
        assert!(matches!(refused(&lens), OpticsError::Afocal { .. }));
        let plate = Prescription {
            surfaces: vec![
                Surface { stop: true, glass: Glass::model(1.5, None), ..Surface::plane(Some(5.0), 9.0) },
                Surface::plane(None, 9.0),
            ],
            ..singlet()
        };
        assert!(matches!(refused(&plate), OpticsError::Afocal { .. }));
        lens = thin(-50.0, 10.0);
        assert!(matches!(refused(&lens), OpticsError::NoRealImage { .. }));
    }

    #[test]
    fn one_surface_images_within_its_own_glass() {
        let glass = Glass { name: String::new(), dispersion: Dispersion::Constant(1.5) };
        let lens = Prescription {
            surfaces: vec![Surface { radius: Some(10.0), stop: true, glass, ..Surface::plane(None, 2.0) }],
            ..singlet()
        };
        let found = first_order(&lens, Setup { wavelength: LINE_D, ..Setup::default() });
        // n R/(n − 1), and R/(n − 1) of it is the focal length.
        assert!((found.back_focus - 30.0).abs() < 1e-12 && (found.focal_length - 20.0).abs() < 1e-12);
    }
}
