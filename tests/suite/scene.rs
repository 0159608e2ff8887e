//! From pixels to ghosts through the public interface: nothing of a light's flux is lost or made.

use glam::DVec2;
use vglare::frame::Frame;
use vglare::scene::{FindOptions, find, ghosts, presets, read_lens, read_lights, read_scene};

const REC709: [f64; 3] = [0.2126, 0.7152, 0.0722];

/// A dim room with a lamp top right, twice as wide as high, and a weaker one bottom left.
fn room() -> (Vec<[f32; 4]>, Frame) {
    let frame = Frame::full(320, 180);
    let pixel = |i: usize, j: usize| match (i, j) {
        (240..250, 30..35) => [900.0, 700.0, 400.0, 1.0],
        (40..44, 150..154) => [100.0, 150.0, 300.0, 1.0],
        _ => [0.2, 0.2, 0.25, 1.0],
    };
    ((0..320 * 180).map(|p| pixel(p % 320, p / 320)).collect(), frame)
}

#[test]
fn the_ghosts_of_every_preset_carry_its_share_of_the_photos_light() {
    let (pixels, frame) = room();
    let found = find(&pixels, &frame, REC709, &FindOptions::default());
    assert_eq!(found.lights.len(), 2);
    let (lamp, weak) = (found.lights[0], found.lights[1]);
    assert!(lamp.position.x > 0.0 && lamp.position.y > 0.0 && weak.position.x < 0.0 && weak.position.y < 0.0);
    let area = frame.pixel_size().powi(2);
    assert!((lamp.flux[0] / (50.0 * 900.0 * area) - 1.0).abs() < 1e-9);

    let luminance = |rgb: [f64; 3]| rgb.iter().zip(REC709).map(|(c, w)| c * w).sum::<f64>();
    for preset in presets::all() {
        let lens = preset.lens().unwrap();
        let all = ghosts(&found.lights, &lens, DVec2::ZERO);
        assert_eq!(all.len(), 2 * lens.ghosts.len());
        for c in 0..3 {
            let flux: f64 = all.iter().map(|ghost| ghost.flux()[c]).sum();
            let light: f64 = found.lights.iter().map(|light| light.flux[c]).sum();
            let share: f64 = lens.ghosts.iter().map(|ghost| ghost.share * ghost.tint[c]).sum();
            assert!((flux - light * share).abs() <= 1e-12 * light, "{} channel {c}", preset.name);
        }
        let share: f64 = lens.ghosts.iter().map(|ghost| ghost.share * luminance(ghost.tint)).sum();
        assert!((share - lens.veiling_share()).abs() < 1e-15);
    }
}

#[test]
fn a_scene_holds_lights_and_a_lens_that_the_other_readers_take_alone() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let lights = "[[light]]\nposition = [1.5, -0.25]\nflux = [3, 2, 1]\nsize = 0.1\n\n";
    let lens = presets::find(presets::DEFAULT_PRESET).unwrap().toml;
    std::fs::write(path("lights.toml"), lights).unwrap();
    std::fs::write(path("lens.toml"), lens).unwrap();
    std::fs::write(path("scene.toml"), format!("{lens}\n{lights}")).unwrap();
    let scene = read_scene(&path("scene.toml")).unwrap();
    let lights = scene.lights.unwrap();
    assert_eq!(lights, read_lights(&path("lights.toml")).unwrap());
    assert_eq!(lights[0].position, DVec2::new(1.5, -0.25));
    let lens = read_lens(&path("lens.toml")).unwrap();
    assert_eq!((scene.lens_ghosts, scene.description), (lens.ghosts, lens.description));

    let error = read_lens(&path("scene.toml")).unwrap_err().to_string();
    let line = std::fs::read_to_string(path("scene.toml")).unwrap().lines().position(|l| l == "[[light]]").unwrap() + 1;
    assert!(error.contains(&format!("line {line}, column 3: unknown field `light`")), "{error}");
}
