//! Our rays and matrices beside those of optiland, in `tests/golden-optics`, whose README.md says what is traced there.

use std::path::PathBuf;

use glam::{DVec2, DVec3};
use serde::Deserialize;

use super::*;

/// What optiland found for a lens.
#[derive(Deserialize)]
struct Golden {
    focal_length: f64,
    back_focus: f64,
    sensor: f64,
    entrance_pupil: f64,
    entrance_pupil_diameter: f64,
    f_number: f64,
    launched: usize,
    front_radius: f64,
    picture: Vec<Field>,
    pairs: Vec<Pair>,
}

#[derive(Deserialize)]
struct Pair {
    pair: [usize; 2],
    a: f64,
    b: f64,
    fields: Vec<Field>,
}

#[derive(Deserialize)]
struct Field {
    angle: f64,
    pupil: Rays,
    front: Rays,
}

#[derive(Deserialize)]
struct Rays {
    rays: usize,
    y: Option<f64>,
    rms: Option<[f64; 2]>,
    #[serde(default)]
    flux: f64,
}

/// How far ours are off at most.
#[derive(Debug, Default)]
struct Worst {
    /// Of the mean place and the standard deviations of equally many rays, in mm.
    place: f64,
    /// Of the flux of equally many rays, relative.
    flux: f64,
    /// Of the number of rays.
    rays: usize,
    /// The images that were compared, and those of them that have as many rays.
    images: usize,
    alike: usize,
}

const LENSES: [&str; 7] = ["double-gauss", "retrofocus", "singlet", "sonnar", "telephoto", "tessar", "triplet"];

fn file(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(name)
}

/// A lens without coatings, as it was traced, and what was found.
fn lens(name: &str) -> (System, Golden) {
    let mut lens = Prescription::read(&file(&format!("media/lenses/{name}.toml"))).unwrap();
    lens.coating = Coating::None;
    lens.surfaces.iter_mut().for_each(|surface| surface.coating = None);
    let text = std::fs::read_to_string(file(&format!("tests/golden-optics/{name}.json"))).unwrap();
    (System::new(&lens, &Setup::default()).unwrap(), serde_json::from_str(&text).unwrap())
}

/// The net of the golden files: a grid of 64 × 64 in a disc of radius 1.
fn net() -> Vec<DVec2> {
    let coordinate = |k: i32| f64::from(2 * k + 1) / 64.0 - 1.0;
    let grid = (0..64).flat_map(|i| (0..64).map(move |j| DVec2::new(coordinate(i), coordinate(j))));
    grid.filter(|place| place.length_squared() <= 1.0).collect()
}

#[test]
fn first_order_properties_are_those_of_optiland() {
    for name in LENSES {
        let (system, golden) = lens(name);
        let found = system.first_order();
        for (what, found, expected) in [
            ("focal length", found.focal_length, golden.focal_length),
            ("back focus", found.back_focus, golden.back_focus),
            ("sensor", system.sensor_z(), golden.sensor),
            ("entrance pupil", found.entrance_pupil.z, golden.entrance_pupil),
            ("its diameter", 2.0 * found.entrance_pupil.radius, golden.entrance_pupil_diameter),
            ("f-number", found.f_number, golden.f_number),
        ] {
            assert!((found - expected).abs() <= 1e-6 * expected.abs(), "{name}, {what}: {found}, not {expected}");
        }
    }
}

#[test]
fn near_the_axis_every_ghost_is_where_optiland_has_it() {
    let (mut worst, mut count) = (0.0_f64, 0);
    for name in LENSES {
        let (system, golden) = lens(name);
        let indices = system.indices(LINE_D);
        let ghosts = system.ghosts(&GhostOptions::default()).unwrap();
        assert_eq!(ghosts.ghosts.len(), golden.pairs.len(), "{name}");
        for Pair { pair: [near, far], a, b, .. } in golden.pairs {
            let path = Path::new(&system, &[far, near]).unwrap();
            let matrix = system.matrix(&path, &indices);
            let per_tangent = matrix.b - matrix.a * system.first_order().entrance_pupil.z;
            // optiland's slopes are of rays 1e-4 mm and 1e-5 rad off the axis, and printed in seven digits.
            let off = |found: f64, expected: f64| (found - expected).abs() / expected.abs().max(0.01);
            worst = worst.max(off(matrix.a, a)).max(off(per_tangent, b));
            count += 1;
        }
    }
    println!("{count} ghosts, at most {worst:.1e} off");
    assert!(count > 280 && worst < 1e-5, "{count} {worst}");
}

impl Worst {
    /// Our rays of an image by those that were traced.
    fn compare(
        &mut self,
        tracer: &Tracer,
        path: &Path,
        direction: DVec3,
        pupil: impl Fn(DVec2) -> DVec2,
        golden: &Rays,
    ) {
        let net = net();
        let steps = path.steps();
        let trace = |&place: &DVec2| tracer.trace_steps(&steps, path, direction, pupil(place));
        let hits: Vec<Hit> = net.iter().filter_map(trace).collect();
        self.images += 1;
        self.rays = self.rays.max(hits.len().abs_diff(golden.rays));
        if hits.len() != golden.rays {
            return;
        }
        self.alike += 1;
        let flux = hits.iter().map(|hit| hit.weight).sum::<f64>() / net.len() as f64;
        if hits.is_empty() {
            return;
        }
        match golden.flux {
            // Printed in so many digits.
            0.0 => assert!(flux < 1e-9),
            golden => self.flux = self.flux.max((flux / golden - 1.0).abs()),
        }
        let mean = hits.iter().map(|hit| hit.position).sum::<DVec2>() / hits.len() as f64;
        let square = |hit: &Hit| (hit.position - mean) * (hit.position - mean);
        let variance = hits.iter().map(square).sum::<DVec2>() / hits.len() as f64;
        let [x, y] = golden.rms.unwrap();
        for (found, expected) in
            [(mean.y, golden.y.unwrap()), (mean.x, 0.0), (variance.x.sqrt(), x), (variance.y.sqrt(), y)]
        {
            self.place = self.place.max((found - expected).abs() / (1.0 + expected.abs()));
        }
    }
}

#[test]
fn all_ghosts_together_have_nearly_the_light_of_optilands() {
    for name in LENSES {
        let (system, golden) = lens(name);
        let ours: f64 =
            system.ghosts(&GhostOptions::default()).unwrap().ghosts.iter().map(|ghost| ghost.share[1]).sum();
        let rays: f64 = golden.pairs.iter().map(|pair| pair.fields[0].front.flux).sum();
        let ratio = ours * golden.picture[0].front.flux / rays;
        println!("{name}: {ratio:.3}");
        assert!((0.99..1.25).contains(&ratio), "{name}: {ratio}");
    }
}

#[test]
fn off_the_axis_every_ray_goes_where_optiland_has_it() {
    std::thread::scope(|scope| {
        for name in LENSES {
            scope.spawn(move || compare_rays(name));
        }
    });
}

fn compare_rays(name: &str) {
    let (system, golden) = lens(name);
    let tracer = Tracer::new(&system, LINE_D).unwrap();
    let mut worst = Worst::default();
    assert_eq!(net().len(), golden.launched);
    let pupil = system.first_order().entrance_pupil;
    let mut compare = |path: &Path, field: &Field| {
        let tangent = field.angle.to_radians().tan();
        let direction = DVec3::new(0.0, tangent, 1.0);
        worst.compare(&tracer, path, direction, |place| pupil.radius * place, &field.pupil);
        // From the first vertex's plane to the pupil's.
        let to_pupil = DVec2::new(0.0, tangent * pupil.z);
        worst.compare(&tracer, path, direction, |place| golden.front_radius * place + to_pupil, &field.front);
    };
    golden.picture.iter().for_each(|field| compare(&Path::direct(&system), field));
    for Pair { pair: [near, far], fields, .. } in &golden.pairs {
        let path = Path::new(&system, &[*far, *near]).unwrap();
        fields.iter().for_each(|field| compare(&path, field));
    }
    println!("{name}: {worst:?}");
    assert!(worst.place < 1e-6 && worst.flux < 1e-6, "{name}");
    // A ray at a rim itself may be lost to a rounding.
    assert!(worst.rays <= 2 && worst.images - worst.alike <= worst.images / 100, "{name}");
}

#[test]
fn every_lens_that_ships_is_as_long_and_as_fast_as_its_source_says() {
    let mut count = 0;
    for entry in std::fs::read_dir(file("media/lenses")).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|extension| extension != "toml") || path.ends_with("glass.toml") {
            continue;
        }
        let lens = Prescription::read(&path).unwrap();
        let settings = lens.settings.iter().map(|setting| lens.setting(&setting.name).unwrap()).collect::<Vec<_>>();
        for lens in settings.iter().chain([&lens]) {
            let found = *System::new(lens, &Setup::default()).unwrap().first_order();
            let near = |found: f64, stated: Option<f64>| (found / stated.unwrap() - 1.0).abs() < 0.01;
            assert!(near(found.focal_length, lens.focal_length), "{}: {found:?}", path.display());
            assert!(near(found.f_number, lens.f_number), "{}: {found:?}", path.display());
        }
        count += 1;
    }
    assert!(count >= 12, "{count}");
}

#[test]
fn files_of_other_programs_are_the_same_lens_or_refused() {
    let read = |name: &str| Prescription::read(&file(&format!("tests/golden-optics/{name}")));
    for (ours, theirs) in [
        ("double-gauss", "double-gauss.zmx"),
        ("double-gauss", "double-gauss-utf8.zmx"),
        ("double-gauss", "double-gauss.dat"),
        ("singlet", "singlet.zmx"),
    ] {
        let (system, _) = lens(ours);
        let found = System::new(&read(theirs).unwrap(), &Setup::default()).unwrap();
        assert_eq!(found.surfaces().len(), system.surfaces().len(), "{theirs}");
        for (found, expected) in found.surfaces().iter().zip(system.surfaces()) {
            let same = |found: f64, expected: f64| (found - expected).abs() <= 1e-9 * expected.abs();
            assert!(same(found.z, expected.z) && same(found.curvature, expected.curvature), "{theirs}: {found:?}");
            assert!(same(found.semi_aperture, expected.semi_aperture), "{theirs}: {found:?}");
            assert!(same(found.glass.index(LINE_D), expected.glass.index(LINE_D)), "{theirs}: {found:?}");
        }
        assert!((found.sensor_z() - system.sensor_z()).abs() < 1e-6, "{theirs}");
    }
    for (name, said) in [("aspheric.zmx", "PARM 2"), ("tilted.zmx", "TYPE COORDBRK")] {
        let error = read(name).unwrap_err().to_string();
        assert!(error.contains("surface 2") && error.contains(said), "{error}");
    }
}
