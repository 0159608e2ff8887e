//! Pictures stay what they were: glare that an earlier program made is made again. `tests/golden-pictures` holds what the
//! program of 29 November 2026 made, before plans owned their problems, of the scene of [`Workplace::photo`] on Mesa's
//! software renderer.

use std::path::Path;

use super::Workplace;
use vglare::photo::{self, Photo};

fn before(name: &str) -> Photo {
    photo::read(&Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden-pictures").join(name)).unwrap()
}

/// The largest difference over all pixels, in units of the largest value before.
fn difference(before: &Photo, now: &Photo) -> f32 {
    assert_eq!(before.pixels.len(), now.pixels.len());
    let peak = before.pixels.iter().flat_map(|pixel| &pixel[..3]).fold(0.0f32, |peak, &value| peak.max(value));
    let colours = |photo: &Photo| photo.pixels.iter().flat_map(|pixel| pixel[..3].to_vec()).collect::<Vec<f32>>();
    let off = colours(before).into_iter().zip(colours(now)).map(|(before, now)| (before - now).abs());
    off.map(|off| if off.is_nan() { f32::INFINITY } else { off }).fold(0.0, f32::max) / peak
}

#[test]
fn glare_is_what_it_was() {
    let place = Workplace::new();
    place.photo("night.exr");
    let scene = include_str!("../../golden-pictures/mixed.toml");
    place.text("mixed.toml", scene);
    // What the plan computes of a spectrum has the rounding of f64, and had that of f32; and a direct sum adds up each kind of
    // bell by itself, and did so ghost by ghost. The nodes of a lattice lay elsewhere: that moves glare by what interpolation may cost.
    for (name, options, allowed) in [
        (
            "lens-grid.exr",
            &["--sources", "lights", "--preset", "v1/classic-prime", "--by", "luminance", "--evaluator", "grid"][..],
            7.5e-4,
        ),
        ("mixed-rows.exr", &["--scene", "mixed.toml", "--evaluator", "rows", "--tolerance", "1e-1"], 1e-6),
        ("mixed-direct.exr", &["--scene", "mixed.toml", "--evaluator", "direct"], 2e-7),
    ] {
        let outputs = ["apply", "night.exr", "--backend", "egl", "--glare", name, "-o", "out.exr", "--force"];
        place.vglare(&[&outputs[..], options].concat()).succeeded();
        let off = difference(&before(name), &photo::read(&place.path(name)).unwrap());
        assert!(off <= allowed, "{name} differs by {off:e} of its largest value");
    }
}
