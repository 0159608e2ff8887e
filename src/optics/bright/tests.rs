use std::f64::consts::PI;

use super::super::tests::{double_gauss, singlet};
use super::super::{Coating, GhostOptions, Glass, Prescription, Setup, Surface};
use super::*;

fn system(lens: &Prescription, fstop: f64) -> System {
    System::new(lens, &Setup { fstop: Some(fstop), ..Setup::default() }).unwrap()
}

fn green(irradiance: &Irradiance) -> [f64; 2] {
    irradiance.of(|[_, green, _]| green)
}

/// Illumination is π L T sin²θ′ of the cone in which it comes (Abbe), and a bare surface of the index n reflects ((n − 1)/(n + 1))².
#[test]
fn direct_light_on_the_axis_is_that_of_its_cone() {
    let glass = Glass::model(1.5, None);
    let front = Surface { radius: Some(25.0), glass, ..Surface::plane(Some(2.0), 9.0) };
    let stop = Surface { stop: true, ..Surface::plane(None, 4.0) };
    let lens = Prescription { surfaces: vec![front, Surface::plane(Some(1.0), 9.0), stop], ..singlet() };
    let system = system(&lens, 8.0);
    let rays = BrightField::new(&system).unwrap();
    let stop = system.surfaces()[2].semi_aperture;
    let sine = (stop / system.first_order().sensor_distance).atan().sin();
    let wanted = PI * sine * sine * 0.96 * 0.96;
    let found = rays.irradiance(&Path::direct(&system), DVec2::ZERO, |_| 1.0, 1 << 16, 1).unwrap();
    let [mean, interval] = green(&found);
    assert!((mean / wanted - 1.0).abs() < 2e-3 && interval < 1e-2 * wanted, "{mean} ± {interval} for {wanted}");
    // Twice as bright, twice as much light.
    let twice = rays.irradiance(&Path::direct(&system), DVec2::ZERO, |_| 2.0, 1 << 16, 1).unwrap();
    assert!((green(&twice)[0] / mean - 2.0).abs() < 1e-12);
    assert_eq!(green(&found.over(&twice)), [0.5, 0.0]);
}

/// A plate before a lens: light that it reflects twice is an image over the first, of R² times its light.
#[test]
fn a_plate_before_the_lens_sends_what_it_reflects_twice() {
    let glass = Glass::model(1.5, None);
    let plate = [Surface { glass: glass.clone(), ..Surface::plane(Some(3.0), 15.0) }, Surface::plane(Some(10.0), 15.0)];
    let front = Surface { radius: Some(50.0), stop: true, glass, ..Surface::plane(Some(0.0), 5.0) };
    let back = Surface { radius: Some(-50.0), ..Surface::plane(None, 9.0) };
    let surfaces = plate.into_iter().chain([front, back]).collect();
    let system = system(&Prescription { surfaces, ..singlet() }, 16.0);
    let rays = BrightField::new(&system).unwrap();
    let ghost = Path::new(&system, &[2, 1]).unwrap();
    for (position, seed) in [(DVec2::ZERO, 3), (DVec2::new(1.0, 0.5), 4)] {
        let of = |path: &Path| rays.irradiance(path, position, |_| 1.0, 1 << 13, seed).unwrap();
        let [share, interval] = green(&of(&ghost).over(&of(&Path::direct(&system))));
        assert!((share - 0.0016).abs() <= interval.max(4e-6) && interval < 4e-5, "{share} ± {interval}");
    }
    // A field that the point does not see sends nothing there, and no more is known of that.
    let beside = |tangent: DVec2| f64::from(u8::from(tangent.x > 0.3));
    let none = rays.irradiance(&ghost, DVec2::ZERO, beside, 1 << 10, 5).unwrap();
    assert_eq!(green(&none), [0.0, 0.0]);
}

/// Stopped down and on the axis, wide ghosts have the light that their discs spread: share · (solid field) over the disc.
#[test]
fn the_interval_holds_the_ghosts_of_the_matrices() {
    let lens = Prescription { coating: Coating::None, ..double_gauss() };
    let system = system(&lens, 32.0);
    let (rays, found) = (BrightField::new(&system).unwrap(), system.ghosts(&GhostOptions::default()).unwrap());
    let direct = rays.irradiance(&Path::direct(&system), DVec2::ZERO, |_| 1.0, 1 << 16, 1).unwrap();
    // A round field so small that all of it is about the axis.
    let field = 0.02;
    let (mut held, mut all) = (0, 0);
    for ghost in found.ghosts.iter().filter(|ghost| ghost.clips.len() == 1) {
        let path = Path::new(&system, &ghost.reflections).unwrap();
        let even =
            |tangent: DVec2| if tangent.length() < field { (1.0 + tangent.length_squared()).powi(2) } else { 0.0 };
        let light = rays.irradiance(&path, DVec2::ZERO, even, 1 << 12, 7).unwrap();
        let [part, interval] = green(&light.over(&direct));
        // Discs of the ghost's radius about the field's image, of which the origin sees that part that is within a radius of it.
        let (reach, radius) =
            (ghost.magnification[1].abs() * field * found.image_per_tangent.abs(), ghost.radius_mm[1]);
        let seen = (field * found.image_per_tangent).powi(2) * (radius / reach).min(1.0).powi(2);
        let wanted = ghost.share[1] * seen / (radius * radius);
        all += 1;
        held += usize::from((part - wanted).abs() <= interval.max(0.01 * wanted));
    }
    // Of those that pass the stop on their way back aberrations are not small.
    assert!(all > 15 && held * 10 >= all * 8, "{held} of {all}");
}

#[test]
fn the_same_seed_gives_the_same_and_nonsense_is_refused() {
    let system = system(&double_gauss(), 4.0);
    let rays = BrightField::new(&system).unwrap();
    let path = Path::new(&system, &[8, 3]).unwrap();
    let at = |seed| rays.irradiance(&path, DVec2::new(2.0, 1.0), |_| 1.0, 2048, seed).unwrap();
    assert_eq!(at(3), at(3));
    let ([one, half], [other, its]) = (green(&at(3)), green(&at(4)));
    assert!(one != other && (one - other).abs() < half + its, "{one} ± {half}, {other} ± {its}");
    assert!(rays.irradiance(&path, DVec2::ZERO, |_| 1.0, 63, 1).is_err());
}
