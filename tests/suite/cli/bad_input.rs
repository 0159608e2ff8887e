//! Photos and scenes that are not right: a clear error, nothing written, no panic.

use super::{Workplace, night};

/// Runs `apply` on a file that is no photo, and holds the program to its promise.
#[track_caller]
fn refused(place: &Workplace, name: &str, words: &[&str]) {
    let before = place.files();
    let mut all = vec![name];
    all.extend(words);
    place.vglare(&["apply", name, "-o", "out.png", "--report", "report.json"]).failed(1, &all);
    assert_eq!(place.files(), before, "{name} left something behind");
}

#[test]
fn files_that_are_no_photo_are_refused_by_name() {
    let place = Workplace::new();
    place.text("empty.exr", "");
    place.text("text.exr", "this is no picture");
    place.text("short.png", "\u{89}PNG");
    std::fs::create_dir(place.path("folder.exr")).unwrap();
    refused(&place, "empty.exr", &["empty"]);
    refused(&place, "text.exr", &[]);
    refused(&place, "short.png", &[]);
    refused(&place, "folder.exr", &[]);
    refused(&place, "missing.exr", &[]);
}

#[test]
fn truncated_photos_are_refused() {
    let place = Workplace::new();
    for name in ["in.exr", "in.hdr", "in.pfm", "in.tif", "in.png"] {
        let whole = std::fs::read(place.write(name, &night())).unwrap();
        for part in [1, 7, whole.len() / 4, whole.len() / 2, whole.len() - 9] {
            std::fs::write(place.path(name), &whole[..part]).unwrap();
            refused(&place, name, &[]);
        }
    }
}

#[test]
fn absurd_sizes_are_refused_without_the_memory() {
    let place = Workplace::new();
    place.text("zero.pfm", "PF\n0 0\n-1.0\n");
    place.text("huge.pfm", "PF\n1000000 1000000\n-1.0\n");
    place.text("huge.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 900000 +X 900000\n");
    for name in ["zero.pfm", "huge.pfm", "huge.hdr"] {
        refused(&place, name, &[]);
    }
}

#[test]
fn a_photo_of_nothing_but_nan_comes_back_as_it_is() {
    let place = Workplace::new();
    let mut photo = night();
    photo.pixels.iter_mut().for_each(|pixel| *pixel = [f32::NAN, f32::NAN, f32::NAN, 1.0]);
    place.write("in.exr", &photo);
    let ran = place.vglare(&["apply", "in.exr", "-o", "out.exr"]).succeeded();
    assert!(ran.stdout().contains("6144 NaN"), "{}", ran.stdout());
    let out = vglare::photo::read(&place.path("out.exr")).unwrap();
    assert!(out.pixels.iter().all(|pixel| pixel[0].is_nan() && pixel[3] == 1.0));
}

#[test]
fn a_photo_of_one_pixel_works() {
    let place = Workplace::new();
    place.write("in.exr", &vglare::photo::Photo::new(1, 1, vec![[5.0, 4.0, 3.0, 1.0]]));
    place.vglare(&["apply", "in.exr", "-o", "out.exr"]).succeeded();
    place.text("scene.toml", "[[ghost]]\ncenter = [0, 0]\nsize = 0.2\nradiance = [1, 2, 3]\n");
    place.vglare(&["apply", "in.exr", "-o", "lit.exr", "--scene", "scene.toml"]).succeeded();
    let out = vglare::photo::read(&place.path("lit.exr")).unwrap();
    for (value, expected) in out.pixels[0].iter().zip([6.0, 6.0, 6.0, 1.0]) {
        assert!((value - expected).abs() < 3e-3, "{:?}", out.pixels[0]);
    }
}

#[test]
fn scene_files_are_refused_with_their_line() {
    let place = Workplace::new();
    place.photo("in.exr");
    let good = "center = [0.0, 0.0]\nsize = 0.2\nradiance = [1, 1, 1]\n";
    for (text, words) in [
        (format!("[[ghost]]\n{good}colour = 3\n"), &["line 5", "colour"][..]),
        (format!("[[ghost]]\n{}", good.replace("0.2", "-0.2")), &["line 3"]),
        (format!("[[ghost]]\n{}", good.replace("0.2", "nan")), &["line 3"]),
        (format!("[[ghost]]\n{}", good.replace("[1, 1, 1]", "\"white\"")), &["line 4"]),
        ("[[ghost]]\nsize = 0.1\n".into(), &["center"]),
        ("period = [4.0, 0.0]\n".into(), &["line 1"]),
        ("degree = [5000, 2]\n".into(), &["line 1"]),
        ("this is no TOML".into(), &["line 1"]),
    ] {
        place.text("scene.toml", &text);
        let before = place.files();
        let mut all = vec!["scene.toml"];
        all.extend(words);
        place.vglare(&["apply", "in.exr", "-o", "out.png", "--scene", "scene.toml"]).failed(1, &all);
        assert_eq!(place.files(), before, "{text}");
    }
}
