//! What counts as a light, and what is said where there is none.

use serde_json::json;
use vglare::photo::{Alpha, Photo, Primaries};

use super::{Workplace, night};

/// A grey picture of 96 × 54 with a lamp of 3 × 3 around column 72, row 22; its centre is at (49/54, 9/54).
fn room(level: f32) -> Photo {
    let mut pixels = vec![[level, level, level, 1.0]; 96 * 54];
    for (column, row) in (71..74).flat_map(|column| (21..24).map(move |row| (column, row))) {
        pixels[row * 96 + column] = [300.0, 250.0, 200.0, 1.0];
    }
    Photo::new(96, 54, pixels)
}

/// The room in a wide gamut, with noise whose luminance is negative.
fn noisy() -> Photo {
    let mut photo = room(0.1);
    photo.source.primaries = Some(Primaries::ACES2065_1);
    for (index, blue) in [(0, 0.5), (5, 2.0), (1000, 0.01), (5183, 0.4)] {
        photo.pixels[index] = [0.0, 0.0, blue, 1.0];
    }
    photo
}

#[test]
fn pixels_of_negative_luminance_are_black() {
    let place = Workplace::new();
    place.write("in.exr", &noisy());
    place.write("blue.exr", &Photo { pixels: vec![[0.0, 0.0, 3.0, 1.0]; 96 * 54], ..noisy() });
    let found = place.json(&["lights", "in.exr", "--json", "--by", "luminance"]);
    let lights = found["lights"].as_array().unwrap();
    assert_eq!(lights.len(), 1, "{found}");
    let at = [0, 1].map(|axis| lights[0]["position"][axis].as_f64().unwrap());
    assert!((at[0] - 49.0 / 54.0).abs() < 1e-9 && (at[1] - 9.0 / 54.0).abs() < 1e-9, "{at:?}");
    assert_eq!(place.json(&["lights", "blue.exr", "--json", "--by", "luminance"])["lights"], json!([]));
    for photo in ["in.exr", "blue.exr"] {
        for lights in [&["--sources", "lights"][..], &["--sources", "lights", "--by", "luminance"], &[]] {
            place.vglare(&[&["plan", photo][..], lights].concat()).succeeded();
            let apply = ["apply", photo, "-o", "out.exr", "--force"];
            place.vglare(&[&apply[..], lights, &["--strength", "0"]].concat()).succeeded();
            place.vglare(&[&apply[..], lights, &["--mix", "energy"]].concat()).succeeded();
        }
    }
    place.vglare(&["apply", "in.exr", "blue.exr", "-o", "shot/", "--sources", "lights"]).succeeded();
}

#[test]
fn what_is_invisible_does_not_shine_and_half_of_it_shines_by_half() {
    let place = Workplace::new();
    let flux = |alpha: f32| {
        let mut photo = room(0.1);
        // Or the PNG would be tone-mapped.
        (photo.source.alpha, photo.source.display_referred) = (Alpha::Straight, true);
        photo.pixels.iter_mut().filter(|pixel| pixel[0] > 100.0).for_each(|pixel| *pixel = [1.0, 1.0, 1.0, alpha]);
        for name in ["in.png", "in.tif"] {
            place.write(name, &photo);
        }
        let found =
            |name| place.json(&["lights", name, "--json", "--threshold", "0.3", "--recover", "none"])["lights"].clone();
        ["in.png", "in.tif"].map(found)
    };
    assert_eq!(flux(0.0), [json!([]), json!([])]);
    let [full, half] = [1.0, 0.5].map(|alpha| flux(alpha).map(|lights| lights[0]["flux"][1].as_f64().unwrap()));
    // 9 pixels of 1/27 a side; PNG rounds alpha to 128 of 255.
    let area = 9.0 / 27.0 / 27.0;
    assert!(full.iter().all(|flux| (flux / area - 1.0).abs() < 1e-6), "{full:?}");
    assert!((half[0] / area - 128.0 / 255.0).abs() < 1e-6 && (half[1] / area - 0.5).abs() < 1e-6, "{half:?}");
    // Premultiplied, as a flame: it shines without alpha.
    let mut flame = room(0.1);
    flame.source.alpha = Alpha::Premultiplied;
    flame.pixels.iter_mut().for_each(|pixel| pixel[3] = 0.0);
    place.write("flame.exr", &flame);
    assert_eq!(place.json(&["lights", "flame.exr", "--json"])["lights"].as_array().map(Vec::len), Some(1));
}

#[test]
fn a_firefly_is_no_light_and_is_told_wherever_lights_are() {
    let place = Workplace::new();
    let mut photo = room(0.3);
    place.write("clean.exr", &photo);
    photo.pixels[40 * 96 + 10] = [6e4, 6e4, 6e4, 1.0];
    place.write("in.exr", &photo);
    let [clean, found] = ["clean.exr", "in.exr"].map(|name| place.json(&["lights", name, "--json"]));
    assert_eq!((&found["lights"], &found["threshold"]), (&clean["lights"], &clean["threshold"]));
    assert_eq!(clean["fireflies"], json!({ "count": 0, "first": null }));
    assert_eq!(found["fireflies"], json!({ "count": 1, "first": [10, 40] }));
    let words = ["firefly", "column 10, row 40", "--firefly-limit 0"];
    let files = ["apply", "in.exr", "-o", "out.exr", "--force", "--report", "report.json"];
    let apply = [&files[..], &["--sources", "lights"]].concat();
    for args in [&["lights", "in.exr"][..], &["plan", "in.exr", "--sources", "lights"], &apply] {
        let said = place.vglare(args).succeeded().stdout();
        assert!(words.iter().all(|word| said.contains(word)), "{said}");
    }
    assert_eq!(place.read_json("report.json")["scene"]["fireflies"], found["fireflies"]);
    let all = place.json(&["lights", "in.exr", "--json", "--firefly-limit", "0"]);
    assert_eq!(all["fireflies"]["count"], 0);
    assert!(all["threshold"].as_f64() > found["threshold"].as_f64(), "{all}");
    // The same in a look; in an old one there are none unless it says so.
    let old = [&files[..], &["--scene", "old.toml"]].concat();
    for (limit, told) in [("", false), ("firefly_limit = 1000\n", true)] {
        place.text("old.toml", &format!("[find]\n{limit}"));
        assert_eq!(place.vglare(&old).succeeded().stdout().contains("firefly"), told);
    }
    place.text("look.toml", "version = 2\n[find]\nfirefly_limit = 0\n");
    let said = place.vglare(&[&apply[..], &["--scene", "look.toml"]].concat()).succeeded().stdout();
    assert!(!said.contains("firefly"), "{said}");
}

#[test]
fn where_there_are_no_lights_it_says_why_and_what_to_do() {
    let place = Workplace::new();
    place.write("black.png", &Photo::new(8, 8, vec![[0.0, 0.0, 0.0, 1.0]; 64]));
    place.write("flat.png", &Photo::new(8, 8, vec![[0.3, 0.3, 0.3, 1.0]; 64]));
    for (photo, words) in [
        ("black.png", &["the photo is black", "--lights"][..]),
        ("flat.png", &["nothing stands out", "4 times the mean", "--threshold", "--lights"]),
    ] {
        let sources = ["--sources", "lights"];
        let apply = [&["apply", photo, "-o", "out.exr", "--force"][..], &sources].concat();
        for args in [&["lights", photo][..], &["plan", photo, sources[0], sources[1]], &apply] {
            let said = place.vglare(args).succeeded().stdout();
            assert!(words.iter().all(|word| said.contains(word)), "{args:?}: {said}");
        }
    }
    let said = place.vglare(&["lights", "flat.png", "--threshold", "7"]).succeeded().stdout();
    assert!(said.contains("7.000") && said.contains("lower --threshold"), "{said}");
}

#[test]
fn lights_of_a_file_are_added_to_those_found() {
    let place = Workplace::new();
    place.write("in.exr", &night());
    place.text("more.toml", "[[light]]\nposition = [0.1, 0.2]\nflux = [3, 2, 1]\n");
    place.text("adds.toml", "version = 2\n[look]\nsources = \"lights\"\nunit = \"short-side\"\n[find]\nadd = true\n[[light]]\nposition = [0.1, 0.2]\nflux = [3, 2, 1]\n");
    let lights = |more: &[&str]| {
        let args = ["apply", "in.exr", "-o", "out.exr", "--force", "--report", "report.json", "--sources", "lights"];
        let said = place.vglare(&[&args[..], more].concat()).succeeded().stdout();
        (place.read_json("report.json")["scene"]["lights"].as_array().unwrap().clone(), said)
    };
    let (found, _) = lights(&[]);
    assert_eq!(found.len(), 2);
    for more in [["--add-lights", "more.toml"], ["--scene", "adds.toml"]] {
        let (added, said) = lights(&more);
        assert_eq!((&added[..2], &added[2]["flux"]), (&found[..], &json!([3.0, 2.0, 1.0])));
        assert!(said.contains("lights   2 at") && said.contains("1 more, as listed"), "{said}");
    }
    assert_eq!(lights(&["--lights", "more.toml"]).0.len(), 1);
    assert_eq!(lights(&["--lights", "more.toml", "--add-lights", "more.toml"]).0.len(), 2);
    place.vglare(&["plan", "in.exr", "--add-lights", "no.toml"]).failed(1, &["no.toml"]);
}

#[test]
fn glare_that_is_out_of_all_proportion_is_warned_of() {
    let place = Workplace::new();
    place.photo("in.exr");
    let apply = |more: &[&str]| {
        // Gaussians, which reach every pixel.
        let args = ["apply", "in.exr", "--force", "--report", "report.json", "--sources", "lights"];
        place.vglare(&[&args[..], &["--preset", "v1/classic-prime"], more].concat())
    };
    // A veil of that strength would scatter more than all the light there is; openings are glare as any other.
    let openings = ["apply", "in.exr", "-o", "out.exr", "--force", "--strength", "1e30", "--sources", "lights"];
    place.vglare(&openings).failed(2, &["a strength of 1", "all of it"]);
    let said = place.vglare(&[&openings[..], &["--veil", "none"]].concat()).succeeded().stderr();
    assert!(said.contains("times as bright as the photo's brightest pixel"), "{said}");
    let said = apply(&["-o", "out.exr", "--strength", "1e30"]).succeeded().stderr();
    assert!(
        said.contains("times as bright as the photo's brightest pixel") && said.contains("strength of 1e30"),
        "{said}"
    );
    assert_eq!(place.read_json("report.json")["warnings"].as_array().map(Vec::len), Some(1));
    let said = apply(&["-o", "out.exr", "--strength", "1e30", "--depth", "half"]).succeeded().stderr();
    assert!(said.contains("6144 pixels of the picture are beyond 6.5504e4"), "{said}");
    apply(&["-o", "new.exr", "--strength", "3e38"]).failed(2, &["strength of 3e38"]);
    assert!(!place.path("new.exr").exists());
    apply(&["-o", "out.exr", "--strength", "1e39"]).failed(2, &["--strength", "finite"]);
    assert_eq!(apply(&["-o", "out.exr", "--strength", "3"]).succeeded().stderr(), "");
}

#[test]
fn refusals_name_what_can_be_had() {
    let place = Workplace::new();
    place.photo("in.exr");
    let lights = ["plan", "in.exr", "--sources", "lights", "--tolerance"];
    let said = place.vglare(&[&lights[..], &["1e-9"]].concat()).failed(3, &["--allow-floor", "--tolerance "]);
    let said = said.stderr();
    let (_, named) = said.split_once("ask for --tolerance ").expect("a tolerance");
    let named = named.split(',').next().unwrap();
    place.vglare(&[&lights[..], &[named]].concat()).succeeded();
    place.vglare(&["presets", "vintage"]).failed(2, &["did you mean vintage-uncoated?", "classic-prime"]);
    place.vglare(&["plan", "in.exr", "--preset", "annamorphic"]).failed(2, &["did you mean anamorphic?"]);
    place.text("look.toml", "preset = \"zom\"\n");
    place.vglare(&["plan", "in.exr", "--scene", "look.toml"]).failed(1, &["line 1", "did you mean zoom?"]);
}

#[test]
fn a_mistyped_option_gets_the_right_one_and_no_tip_that_makes_it_a_photo() {
    let place = Workplace::new();
    let said = place.vglare(&["apply", "in.exr", "-o", "out.exr", "--strenght", "2"]).failed(2, &["'--strength'"]);
    assert!(!said.stderr().contains("-- --strenght"), "{}", said.stderr());
    let said = place.vglare(&["apply", "in.exr", "-o", "out.exr", "--qqqqq"]).failed(2, &["--qqqqq", "--help"]);
    assert!(!said.stderr().contains("as a value"), "{}", said.stderr());
}
