//! What a run leaves behind.

use std::path::Path;

use serde_json::Value;
use vglare::photo;

use super::{Workplace, night};

fn bits(path: &Path) -> Vec<[u32; 4]> {
    photo::read(path).expect("a photo").pixels.iter().map(|pixel| pixel.map(f32::to_bits)).collect()
}

#[test]
fn every_format_can_be_written() {
    let place = Workplace::new();
    place.photo("in.exr");
    for name in ["out.exr", "out.hdr", "out.pfm", "out.tif", "out.png", "out.jpg"] {
        let ran = place.vglare(&["apply", "in.exr", "-o", name]).succeeded();
        assert!(ran.stdout().contains(name), "the summary says where: {}", ran.stdout());
        let picture = photo::read(&place.path(name)).expect("what was written can be read");
        assert_eq!((picture.width(), picture.height()), (96, 64), "{name}");
        // The glare reaches what was dark before, and most of all near the brightest lamp.
        let luminance = |column: usize, row: usize| picture.pixels[row * 96 + column][1];
        assert!(luminance(74, 14) > 2.0 * luminance(2, 62), "{name}: the veil is brightest near the lamp");
    }
}

#[test]
fn strength_0_returns_the_photo_bit_for_bit() {
    let place = Workplace::new();
    let mut photo = night();
    photo.pixels[100] = [f32::NAN, f32::NEG_INFINITY, -3.5, 1.0];
    for name in ["in.exr", "in.pfm", "in.tif"] {
        let input = place.write(name, &photo);
        let output = format!("out-{name}");
        place.vglare(&["apply", name, "-o", &output, "--strength", "0"]).succeeded();
        assert!(bits(&input) == bits(&place.path(&output)), "{name} changed");
    }
}

#[test]
fn one_bad_pixel_harms_one_pixel() {
    let place = Workplace::new();
    place.photo("good.exr");
    for (name, value) in [("nan", f32::NAN), ("inf", f32::INFINITY), ("minus-inf", f32::NEG_INFINITY)] {
        let mut photo = night();
        photo.pixels[30 * 96 + 40][1] = value;
        place.write("bad.exr", &photo);
        let apply = |name: &str, output: &str| {
            // A pixel that is no source any more would be missing in the ghosts of all pixels, and in a veil.
            let line = ["apply", name, "-o", output, "--force", "--sources", "lights", "--veil", "none"];
            place.vglare(&line).succeeded()
        };
        apply("good.exr", "good-out.exr");
        let ran = apply("bad.exr", "bad-out.exr");
        assert!(ran.stdout().contains("column 40, row 30"), "{name} is told: {}", ran.stdout());
        let (good, bad) = (bits(&place.path("good-out.exr")), bits(&place.path("bad-out.exr")));
        let changed: Vec<_> = (0..good.len()).filter(|&k| good[k] != bad[k]).collect();
        assert_eq!(changed, [30 * 96 + 40], "{name}");
    }
}

#[test]
fn the_report_says_what_was_done() {
    let place = Workplace::new();
    place.photo("in.exr");
    let outputs = ["apply", "in.exr", "-o", "out.exr", "--report", "report.json", "--glare", "glare.exr"];
    let said = place.vglare(&[&outputs[..], &["--max-lights", "1", "--force"]].concat()).succeeded().stdout();
    let report = place.read_json("report.json");
    assert!(said.contains("1 fainter one joined its nearest, "), "{said}");
    let count = |name: &str| report["scene"][name].as_u64();
    assert_eq!((count("lights_joined"), count("lights_dropped")), (Some(1), Some(0)));
    let share = report["scene"]["joined_share"].as_f64().expect("a share");
    assert!((0.05..0.2).contains(&share) && report["scene"]["dropped_share"] == 0.0, "{share}");
    place.vglare(&[&outputs[..], &["--sources", "lights", "--force"]].concat()).succeeded();
    let text = std::fs::read_to_string(place.path("report.json")).expect("a report");
    let report: Value = serde_json::from_str(&text).expect("JSON");
    assert_eq!(report["input"]["picture"], serde_json::json!([96, 64]));
    assert_eq!(report["scene"]["lights"].as_array().map(Vec::len), Some(2), "{text}");
    let ghosts = report["scene"]["ghosts"].as_u64().expect("a count");
    let planned: u64 = report["plan"]["groups"]
        .as_array()
        .expect("groups")
        .iter()
        .map(|g| g["ghosts"].as_u64().expect("a count"))
        .sum();
    assert_eq!(ghosts, planned + report["plan"]["dropped"].as_u64().expect("a count"), "{text}");
    for path in ["/plan/period", "/plan/degree", "/plan/terms", "/plan/evaluator", "/renderer/renderer", "/vglare"] {
        assert!(report.pointer(path).is_some_and(|value| !value.is_null()), "{path} of {text}");
    }
    let error = |name: &str| report["error"][name].as_f64().expect("a number");
    assert!(error("measured") <= error("predicted") && error("predicted") <= error("asked"), "{text}");
    assert!(
        report["passes"].as_array().is_some_and(|passes| passes.iter().any(|p| p["pass"] == "composite")),
        "{text}"
    );
}

#[test]
fn the_glare_alone_is_what_was_added() {
    let place = Workplace::new();
    let photo = night();
    place.write("in.exr", &photo);
    // A veil takes its light from the photo, unless it is added.
    for (options, veil) in [(&[][..], true), (&["--mix", "add"], true), (&["--veil", "none"], false)] {
        let line = "apply in.exr -o out.exr --glare glare.exr --strength 0.7 --report report.json --force";
        place.vglare(&[&line.split(' ').collect::<Vec<_>>(), options].concat()).succeeded();
        let ledger = place.read_json("report.json")["veil"]["ledger"].clone();
        assert_eq!(ledger.is_object(), veil, "{options:?}");
        let part = |name: &str, colour: usize| ledger[name][colour].as_f64().unwrap();
        let (out, glare) =
            (photo::read(&place.path("out.exr")).unwrap(), photo::read(&place.path("glare.exr")).unwrap());
        for colour in 0..3 {
            let keeps = if veil { part("kept", colour) / part("light", colour) } else { 1.0 };
            // What is taken is what goes elsewhere: less than none where pixels are as coarse as these.
            assert_eq!((keeps - 1.0).abs() > 0.01, options.is_empty(), "{options:?}: {keeps}");
            for ((before, after), added) in photo.pixels.iter().zip(&out.pixels).zip(&glare.pixels) {
                let sum = keeps * f64::from(before[colour]) + f64::from(added[colour]);
                let off = (f64::from(after[colour]) - sum).abs();
                assert!(off <= 1e-6 * sum, "{options:?}: {keeps} {before:?} + {added:?} = {after:?}");
            }
        }
    }
}

#[test]
fn energy_is_taken_from_the_lights() {
    let place = Workplace::new();
    let photo = night();
    place.write("in.exr", &photo);
    // Of a lens some of whose ghosts lie about the light itself, and that has no veil, which every pixel pays for.
    let line = "apply in.exr -o out.exr --preset v1/classic-prime --mix energy --threshold 10 --sources lights";
    place.vglare(&line.split(' ').collect::<Vec<_>>()).succeeded();
    let out = photo::read(&place.path("out.exr")).unwrap();
    let at = 12 * 96 + 70;
    assert!(out.pixels[at][0] < photo.pixels[at][0], "the lamp is weaker by what it scatters");
    let dark = 12 * 96 + 60;
    assert!(out.pixels[dark][0] > photo.pixels[dark][0], "what is no light keeps its own and gains glare");
}

#[test]
fn egl_and_osmesa_agree() {
    let place = Workplace::new();
    place.photo("in.exr");
    for backend in ["egl", "osmesa"] {
        place.vglare(&["apply", "in.exr", "-o", &format!("{backend}.exr"), "--backend", backend]).succeeded();
    }
    let (egl, osmesa) = (photo::read(&place.path("egl.exr")).unwrap(), photo::read(&place.path("osmesa.exr")).unwrap());
    for (a, b) in egl.pixels.as_flattened().iter().zip(osmesa.pixels.as_flattened()) {
        assert!((a - b).abs() <= 1e-5 * a.abs().max(1e-3), "{a} {b}");
    }
}

#[test]
fn found_lights_can_be_edited_and_used_again() {
    let place = Workplace::new();
    place.photo("in.exr");
    let listed = place.vglare(&["lights", "in.exr", "--json"]).succeeded().stdout();
    place.text("lights.json", &listed);
    place.vglare(&["apply", "in.exr", "-o", "found.exr", "--sources", "lights"]).succeeded();
    place.vglare(&["apply", "in.exr", "-o", "listed.exr", "--lights", "lights.json"]).succeeded();
    assert!(bits(&place.path("found.exr")) == bits(&place.path("listed.exr")));
}

#[test]
fn a_preset_can_be_taken_as_a_file_of_ones_own() {
    let place = Workplace::new();
    place.photo("in.exr");
    let lens = place.vglare(&["presets", "anamorphic"]).succeeded().stdout();
    place.text("mine.toml", &lens);
    place.vglare(&["apply", "in.exr", "-o", "named.exr", "--preset", "anamorphic"]).succeeded();
    place.vglare(&["apply", "in.exr", "-o", "mine.exr", "--lens", "mine.toml"]).succeeded();
    assert!(bits(&place.path("named.exr")) == bits(&place.path("mine.exr")));
}

#[test]
fn the_shell_and_the_manual_are_served() {
    let place = Workplace::new();
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        assert!(place.vglare(&["completions", shell]).succeeded().stdout().contains("apply"), "{shell}");
    }
    assert!(place.vglare(&["man"]).succeeded().stdout().contains(".TH"));
    place.vglare(&["man", "--folder", "man"]).succeeded();
    assert!(place.path("man/vglare-apply.1").is_file());
    let help = place.vglare(&["apply", "--help"]).succeeded().stdout();
    assert!(help.contains("Examples:") && help.contains("--tolerance"), "{help}");
}

#[test]
fn info_tells_of_both_backends() {
    let place = Workplace::new();
    let text = place.vglare(&["info", "--json"]).succeeded().stdout();
    let info: Value = serde_json::from_str(&text).expect("JSON");
    let backends = info["backends"].as_array().expect("a list");
    assert_eq!(backends.len(), 2);
    for backend in backends {
        assert_eq!(backend["works"], true, "{text}");
        assert!(backend["info"]["limits"]["texture_size"].as_u64() >= Some(16384), "{text}");
    }
}

#[test]
fn colours_that_are_clipped_are_told() {
    let place = Workplace::new();
    let input = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/inputs/png-icc-gamma18.png");
    let ran = place.vglare(&["apply", input, "-o", "out.hdr", "--strength", "0", "--report", "r.json"]).succeeded();
    assert!(ran.stderr().contains("ProPhoto RGB, are written as Rec. 709"), "{}", ran.stderr());
    let report: Value = serde_json::from_slice(&std::fs::read(place.path("r.json")).unwrap()).unwrap();
    assert!(report["warnings"][0].as_str().unwrap().contains("ProPhoto RGB"), "{}", report["warnings"]);
    for name in ["out.exr", "out.png"] {
        let ran = place.vglare(&["apply", input, "-o", name, "--strength", "0"]).succeeded();
        assert!(!ran.stderr().contains("written as"), "{}", ran.stderr());
    }
    // In its own space every code is what it was.
    let codes = |path: &std::path::Path| {
        let file = std::io::BufReader::new(std::fs::File::open(path).unwrap());
        let mut reader = png::Decoder::new(file).read_info().unwrap();
        let mut codes = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut codes).unwrap();
        codes
    };
    assert!(codes(std::path::Path::new(input)) == codes(&place.path("out.png")));
}
