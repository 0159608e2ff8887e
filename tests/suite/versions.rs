//! Looks of version 1, those of files that name none, look as they did. `tests/golden-looks/version-1.json` holds, of one look
//! for each lens of then, some pixels of the glare and of the picture, as the program drew them before looks had versions, of
//! `media/courtyard.exr`; firefly limit and veils, which it had beside them, left out.

use std::path::{Path, PathBuf};

use glam::DVec2;
use serde_json::Value;
use vglare::choices::{Beyond, LengthUnit, LightBy, LightShape};
use vglare::gpu::Backend;
use vglare::job::{Computer, Found, Known, Stages, Unwatched, Wanted};
use vglare::look::{Look, LookLens, LookLights};
use vglare::photo::{self, Photo};
use vglare::scene::{FindOptions, Recover, presets, read_scene, write_scene};

use crate::support::on_device;

const LOOKS: &str = include_str!("../golden-looks/version-1.json");

/// One of them.
struct Before {
    name: String,
    look: Look,
    lights: usize,
    /// Column, row, glare and picture.
    pixels: Vec<(usize, [f64; 3], [f64; 3])>,
}

fn courtyard() -> Photo {
    photo::read(&Path::new(env!("CARGO_MANIFEST_DIR")).join("media/courtyard.exr")).expect("a bundled photo")
}

fn text(folder: &Path, text: &str) -> PathBuf {
    let path = folder.join("look.toml");
    std::fs::write(&path, text).expect("a file");
    path
}

fn read(path: &Path) -> Look {
    read_scene(path).and_then(Look::from_scene).unwrap_or_else(|error| panic!("{error}"))
}

fn all() -> Vec<Before> {
    let folder = tempfile::tempdir().expect("a folder");
    let width = courtyard().width() as usize;
    let rgb = |value: &Value| [0, 1, 2].map(|colour| value[colour].as_f64().expect("a number"));
    let place = |value: &Value| value.as_u64().expect("a place") as usize;
    let one = |look: &Value| Before {
        name: look["name"].as_str().expect("a name").to_owned(),
        look: read(&text(folder.path(), look["look"].as_str().expect("a file"))),
        lights: place(&look["lights"]),
        pixels: look["pixels"]
            .as_array()
            .expect("pixels")
            .iter()
            .map(|pixel| (place(&pixel[1]) * width + place(&pixel[0]), rgb(&pixel[2]), rgb(&pixel[3])))
            .collect(),
    };
    let looks: Value = serde_json::from_str(LOOKS).expect("JSON");
    looks.as_array().expect("looks").iter().map(one).collect()
}

/// The picture and the glare of some looks.
fn drawn<'a>(looks: impl Iterator<Item = &'a Look>) -> Vec<[Vec<[f32; 4]>; 2]> {
    let looks: Vec<&Look> = looks.collect();
    let photo = courtyard();
    on_device(Backend::Egl, |device| {
        let mut computer = Computer::new(device.clone(), Known::default());
        let draw = |look| {
            let found = Found::new(look, photo.clone(), Stages::default()).expect("a look");
            let wanted = Wanted { picture: true, glare: true, ..Wanted::default() };
            let done = found.compute(Some(&mut computer), wanted, &Unwatched).expect("a picture");
            [done.picture, done.glare].map(|photo| photo.expect("it is wanted").pixels)
        };
        looks.into_iter().map(draw).collect()
    })
}

#[test]
fn looks_of_version_1_look_as_they_did() {
    let before = all();
    let names: Vec<_> = before.iter().map(|before| &*before.name).collect();
    let known: Vec<_> = presets::of_version_1().iter().filter_map(|preset| preset.name.strip_prefix("v1/")).collect();
    assert!(names.len() == 7 && known.iter().all(|name| names.contains(name) || *name == "classic-veil"), "{names:?}");
    let photo = courtyard();
    for Before { name, look, lights, .. } in &before {
        assert_eq!((look.lens().name, look.unit, &look.veil), (format!("v1/{name}"), LengthUnit::Height, &None));
        let scene = look.gather(&photo, &look.frame(&photo).expect("a unit"));
        assert_eq!((scene.lights.len(), scene.images.is_none()), (*lights, true), "{name}");
    }
    for (Before { name, look, pixels, .. }, [picture, glare]) in
        before.iter().zip(drawn(before.iter().map(|b| &b.look)))
    {
        let peak = glare.iter().fold(0.0f32, |peak, [r, g, b, _]| peak.max(*r).max(*g).max(*b));
        // What another plan may change, and another driver.
        let vglare::scene::Goal::Tolerance(tolerance) = look.accuracy.goal else { panic!("{name} has a tolerance") };
        let allowed = tolerance * f64::from(peak) * look.strength.max(1.0);
        assert_eq!(pixels.len(), 44, "{name}");
        for &(at, was_glare, was_picture) in pixels {
            for colour in 0..3 {
                let off = (f64::from(glare[at][colour]) - was_glare[colour]).abs();
                assert!(off <= allowed, "{name}, {at}: glare off by {off:e} of {:?}", glare[at]);
                let off = (f64::from(picture[at][colour]) - was_picture[colour]).abs();
                let allowed = allowed + 1e-6 * was_picture[colour].abs();
                assert!(off <= allowed, "{name}, {at}: picture off by {off:e} of {:?}", picture[at]);
            }
        }
    }
}

/// Read, and written as one of today's version: the same picture, bit for bit.
#[test]
fn an_old_look_that_is_written_anew_is_the_same() {
    let folder = tempfile::tempdir().expect("a folder");
    let again: Vec<(Look, Look)> = all()
        .into_iter()
        .map(|Before { look, .. }| {
            let path = folder.path().join("new.toml");
            write_scene(&path, &look.to_scene(), true).expect("a file");
            let written = std::fs::read_to_string(&path).expect("it");
            assert!(written.starts_with("version = 2\npreset = \"v1/"), "{written}");
            let same = read(&path);
            assert_eq!(same, look, "{written}");
            (look, same)
        })
        .collect();
    // Equal looks give equal pictures; of two of them it is seen.
    let some = &again[3..5];
    let [old, new] = [drawn(some.iter().map(|(old, _)| old)), drawn(some.iter().map(|(_, new)| new))]
        .map(|pictures| pictures.into_iter().flatten().flatten().flatten().map(f32::to_bits).collect::<Vec<_>>());
    assert!(old == new);
}

#[test]
fn what_a_file_without_a_version_does_not_say_is_as_it_was() {
    let folder = tempfile::tempdir().expect("a folder");
    let look = read(&text(folder.path(), ""));
    let FindOptions { by, threshold, merge, shape, max_lights, beyond, firefly_limit, knee, recover } = look.find;
    assert_eq!((by, shape), (LightBy::Luminance, LightShape::Ball));
    assert_eq!((beyond, recover), (Beyond::Drop, Recover::None));
    assert_eq!((threshold, merge, max_lights, firefly_limit, knee), (None, 0.02, 64, 0.0, 0.0));
    assert_eq!((look.lens, look.lights), (LookLens::preset("v1/classic-prime").expect("a lens"), LookLights::Found));
    assert_eq!((look.unit, look.veil, look.axis), (LengthUnit::Height, None, DVec2::ZERO));
    // A lens that had a veil then has it still.
    let veiled = read(&text(folder.path(), "preset = \"classic-veil\"\n"));
    assert!(veiled.veil.is_some_and(|veil| (veil.psf().energy() - 0.02).abs() < 1e-9));
    let named =
        read(&text(folder.path(), "preset = \"eye\"\n[veil]\npsf = \"gaussian\"\nwidth = 0.1\nscatter = 0.1\n"));
    assert_eq!((named.lens_ghosts().len(), named.veil.is_some()), (9, true), "its ghosts were no veil's");
}
