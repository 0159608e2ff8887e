use super::*;
use crate::psf::{Name, Parameters};
use crate::scene::VeilSection;

const SIZE: [u32; 2] = [240, 160];
const FOV: f64 = 20.0;
/// Of the spot, in pixels at the middle.
const RADIUS: f64 = 8.0;
/// Of the veil, in pixels.
const SIGMA: f64 = 10.0;

fn look(scatter: f64, strength: f64) -> Look {
    // Half the shorter side is the unit.
    let width = Some(SIGMA / (0.5 * f64::from(SIZE[1])));
    let parameters = Parameters { width, scatter: Some(scatter), ..Parameters::new(Name::Gaussian) };
    let section = VeilSection { parameters, fov: None, projection: None, border: None, tolerance: Some(1e-4) };
    let look = Look::default()
        .through(LookLens::from(crate::scene::named_lens(Path::new("none"), &Default::default()).unwrap()), false)
        .unwrap();
    Look { veil: Some(crate::look::Veil::new(&section, false).unwrap()), strength, fov: Some(FOV), ..look }
}

fn measured(look: &Look, level: f32) -> Index {
    let field = Field::new(SIZE, FOV);
    let diameter = 2.0 * (RADIUS / field.focal).atan().to_degrees();
    let [x, y] = SIZE.map(|side| side as usize / 2);
    let place = Place { name: "centre", pixel: [x, y] };
    indices(look, &field, &[place], diameter, level, None).unwrap()[0]
}

/// The share of a Gaussian's light that falls within a disc whose middle is `far` from its own: by its definition, ring by ring.
fn within(radius: f64, far: f64) -> f64 {
    const STEPS: i32 = 600;
    let step = 2.0 * radius / f64::from(STEPS);
    let at = |k: i32| -radius + (f64::from(k) + 0.5) * step;
    let places = (0..STEPS).flat_map(|i| (0..STEPS).map(move |j| [at(i), at(j)]));
    let disc = places.filter(|[x, y]| x.hypot(*y) <= radius);
    let value = |[x, y]: [f64; 2]| (-0.5 * ((x - far).powi(2) + y * y) / (SIGMA * SIGMA)).exp();
    disc.map(value).sum::<f64>() * step * step / (std::f64::consts::TAU * SIGMA * SIGMA)
}

/// On an even field with one round spot a Gaussian veil f of width σ gives f e^(−a²/2σ²) in the middle of the spot.
#[test]
fn a_gaussian_veil_has_the_index_of_its_closed_form() {
    assert!((within(RADIUS, 0.0) - (1.0 - (-0.5 * (RADIUS / SIGMA).powi(2)).exp())).abs() < 1e-4);
    for (scatter, strength) in [(0.1, 1.0), (0.1, 2.5), (0.4, 1.0)] {
        let f = scatter * strength;
        let black = f * (-0.5 * (RADIUS / SIGMA).powi(2)).exp();
        let around = 1.0 - f * within(RADIUS, 3.0 * RADIUS);
        let Index { index, bound, .. } = measured(&look(scatter, strength), 1.0);
        for c in 0..3 {
            assert!((index[c] / (black / around) - 1.0).abs() < 5e-3, "{f}: {} for {}", index[c], black / around);
            assert!(bound[c] > 0.0 && bound[c] < 3e-4 * index[c], "{bound:?}");
        }
    }
}

#[test]
fn an_index_is_of_no_unit_and_without_glare_0() {
    let (one, other) = (measured(&look(0.2, 1.0), 1.0), measured(&look(0.2, 1.0), 4096.0));
    assert_eq!(one.index, other.index);
    let none = measured(&look(0.2, 0.0), 1.0);
    assert_eq!((none.index, none.bound), ([0.0; 3], [0.0; 3]));
}

#[test]
fn spots_are_in_the_picture_with_all_that_is_measured_about_them() {
    let field = Field::new([300, 200], 40.0);
    let places = field.places(2.0, 0.6).unwrap();
    let names: Vec<_> = places.iter().map(|place| place.name).collect();
    assert_eq!(names, ["centre", "side", "top", "corner"]);
    let photo = field.photo(&places, 2.0, 3.0);
    for place in &places {
        let read = |[x, y]: [usize; 2]| photo.pixels[y * 300 + x][0];
        assert_eq!(read(place.pixel), 0.0, "{place:?}");
        let ring = field.ring(place, 2.0);
        assert!(ring.len() > 60 && ring.iter().all(|at| read(*at) == 3.0), "{place:?}: {}", ring.len());
        let mean = [0, 1].map(|k| ring.iter().map(|at| at[k] as f64).sum::<f64>() / ring.len() as f64);
        assert!((0..2).all(|k| (mean[k] - place.pixel[k] as f64).abs() < 4.0), "all around {place:?}: {mean:?}");
    }
    assert!(places[3].pixel[0] > 250 && places[3].pixel[1] < 50, "{places:?}");
    // One of 2° has π square degrees.
    let black = photo.pixels.iter().map(|pixel| 1.0 - f64::from(pixel[0]) / 3.0).sum::<f64>();
    assert!(black > 4.0 * std::f64::consts::PI * (1.0f64.to_radians() * field.focal).powi(2));
    assert!(field.places(12.0, 1.0).is_err() && field.places(2.0, 0.1).is_err());
}

#[test]
fn a_photo_of_a_spot_has_its_index_and_what_noise_leaves_of_it() {
    let mut chance = crate::chance::Chance::new(5);
    let pixel = |at: usize| {
        let far = ((at % 100) as f64 - 50.0).hypot((at / 100) as f64 - 40.0);
        let level = if far < 10.0 { 0.02 } else { 0.8 };
        let noisy = (level * (1.0 + 0.1 * chance.between(-1.0, 1.0))) as f32;
        [noisy, 2.0 * noisy, 0.5, 1.0]
    };
    let photo = Photo::new(100, 80, (0..8000).map(pixel).collect());
    let spot: SpotArg = "50,40,20".parse().unwrap();
    let [found] = spots::measured(&photo, &[spot]).unwrap()[..] else { panic!("one spot") };
    for c in 0..2 {
        assert!((found.index[c] - 0.025).abs() < 4.0 * found.standard_error[c], "{found:?}");
        // Of 0.1/√3 of a value, by 81 pixels or so.
        assert!((found.standard_error[c] / 0.025 - 0.1 / 3f64.sqrt() / 9.0).abs() < 3e-3, "{found:?}");
    }
    assert_eq!((found.index[2], found.standard_error[2]), (1.0, 0.0));
    for (spot, why) in [("5,40,20", "not in the photo"), ("50.5,40.5,0.9", "no pixel")] {
        let refused = spots::measured(&photo, &[spot.parse().unwrap()]).unwrap_err().to_string();
        assert!(refused.contains(why), "{refused}");
    }
    assert!("1,2".parse::<SpotArg>().is_err() && "1,2,0".parse::<SpotArg>().is_err());
}
