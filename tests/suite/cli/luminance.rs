//! Photos in cd/m²: `--luminance`, `--map`, and what is told of both.

use serde_json::Value;
use vglare::photo::{self, Photo, ReadOptions, WhiteLuminance};

use super::Workplace;

const VEIL: [&str; 8] = ["--lens", "none", "--veil", "gaussian", "--width", "0.1", "--scatter", "0.1"];

/// Mean and largest luminance by Rec. 709's weights, in the photo's numbers.
fn luminances(photo: &Photo) -> [f64; 2] {
    let luminance = |[r, g, b, _]: &[f32; 4]| 0.2126 * f64::from(*r) + 0.7152 * f64::from(*g) + 0.0722 * f64::from(*b);
    let all: Vec<f64> = photo.pixels.iter().map(luminance).collect();
    [all.iter().sum::<f64>() / all.len() as f64, all.into_iter().fold(0.0, f64::max)]
}

fn close(told: &Value, wanted: f64) -> bool {
    told.as_f64().is_some_and(|told| (told / wanted - 1.0).abs() < 1e-6)
}

#[test]
fn photo_and_glare_are_told_and_drawn_in_candelas() {
    let place = Workplace::new();
    place.photo("in.exr");
    let line = ["apply", "in.exr", "-o", "out.exr", "--glare", "glare.exr", "--report", "r.json", "--luminance", "250"];
    let said = place.vglare(&[&line[..], &["--map", "map.png"], &VEIL].concat()).succeeded().stdout();
    assert!(said.contains("cd/m²    250.0 of white, as given; photo"), "{said}");
    let report = place.read_json("r.json");
    assert_eq!((&report["map"], &report["luminance"]["from"]), (&"map.png".into(), &"as given".into()));
    for (name, file) in [("photo", "in.exr"), ("glare", "glare.exr")] {
        let [mean, max] = luminances(&photo::read(&place.path(file)).unwrap());
        let told = &report["luminance"][name];
        assert!(close(&told["mean"], 250.0 * mean) && close(&told["max"], 250.0 * max), "{name}: {told}");
    }
    let map = image::open(place.path("map.png")).unwrap();
    assert!(map.width() > 480 && map.height() > 320, "96 × 64 pixels, enlarged");
    // What was given is kept, and is then what the file says, of picture and glare.
    for name in ["out.exr", "glare.exr"] {
        let scale = photo::read(&place.path(name)).unwrap().luminance_scale().unwrap();
        assert_eq!((scale.cd_m2_per_unit, &*scale.from), (250.0, "its whiteLuminance of 250"), "{name}");
    }
    let told = place.json(&["info", "out.exr", "--json"]);
    assert_eq!(told["luminance"]["cd_m2_per_unit"], 250.0);
    assert!(place.vglare(&["info", "out.exr"]).succeeded().stdout().contains("250.0 of white, its whiteLuminance"));
    // A clean photo has the same white; the veil that is taken away is as bright as what was laid over it.
    let line = ["remove", "out.exr", "-o", "clean.hdr", "--report", "clean.json"];
    place.vglare(&[&line[..], &VEIL[2..]].concat()).succeeded();
    let clean = &place.read_json("clean.json")["luminance"];
    let mean = report["luminance"]["photo"]["mean"].as_f64().unwrap();
    assert!((clean["clean"]["mean"].as_f64().unwrap() / mean - 1.0).abs() < 5e-3, "{clean}");
    let hdr = photo::read(&place.path("clean.hdr")).unwrap().luminance_scale().unwrap();
    assert!((hdr.cd_m2_per_unit - 250.0).abs() < 1e-9 && hdr.from.contains("EXPOSURE of 0.716"), "{}", hdr.from);
}

#[test]
fn where_nothing_says_it_nothing_is_in_candelas() {
    let place = Workplace::new();
    place.photo("in.exr");
    let line = ["apply", "in.exr", "--report", "r.json", "--map", "map.svg", "--map-range", "0.001,10"];
    let said = place.vglare(&[&line[..], &VEIL].concat()).succeeded().stdout();
    assert!(!said.contains("cd/m²") && place.read_json("r.json").get("luminance").is_none(), "{said}");
    let map = std::fs::read_to_string(place.path("map.svg")).unwrap();
    assert!(map.contains("units of the photo") && !map.contains("cd/m²") && map.contains("0.01"));
    assert!(place.vglare(&["info", "in.exr"]).succeeded().stdout().contains("not known"));
    // Drawings of several photos.
    place.photo("b.exr");
    place.vglare(&[&["apply", "in.exr", "b.exr", "--map", "{name}.map.png"][..], &VEIL].concat()).succeeded();
    assert!(["in.map.png", "b.map.png"].iter().all(|name| place.path(name).is_file()));
}

#[test]
fn luminances_and_maps_that_cannot_be_are_refused() {
    let place = Workplace::new();
    place.photo("in.exr");
    let before = place.files();
    for (line, code, words) in [
        ("apply in.exr -o o.exr --luminance 0", 2, &["--luminance", "positive"][..]),
        ("apply in.exr -o o.exr --luminance nan", 2, &["--luminance", "positive"]),
        ("apply in.exr -o o.exr --luminance -1", 2, &["--luminance", "positive"]),
        ("apply in.exr -o o.exr --luminance file", 1, &["in.exr", "whiteLuminance"]),
        ("apply in.exr -o o.exr --luminance scotopic --lens none", 2, &["there is no veil"]),
        ("apply in.exr -o o.exr --veil cie --adaptation scotopic --fov 40", 2, &["--adaptation", "does not take it"]),
        ("apply in.exr --map map.txt", 1, &["map.txt", ".svg or .png"]),
        ("apply in.exr -o o.png --map o.png", 2, &["o.png would be two of them"]),
        ("apply in.exr -o o.exr --map in.exr", 1, &[".svg or .png"]),
        ("apply in.exr -o o.exr --map-range 1,2", 2, &["--map"]),
        ("apply in.exr --map map.png --map-range 2,1", 2, &["smaller one first"]),
        ("measure --luminance file", 2, &["--luminance file", "no file"]),
        ("psf cie --luminance 100", 2, &["--luminance", "of a photo"]),
        ("psf cie --fov 50", 2, &["--fov", "per steradian already"]),
        ("psf camera --fov 200", 2, &["--fov", "179"]),
        ("info none.exr", 1, &["none.exr"]),
    ] {
        place.vglare(&line.split(' ').collect::<Vec<_>>()).failed(code, words);
        assert_eq!(place.files(), before, "{line}");
    }
}

#[test]
fn a_chart_and_its_photo_have_the_same_luminances() {
    let place = Workplace::new();
    let line = ["measure", "--pixels", "300x200", "--diameters", "2", "--chart", "chart.exr", "--json"];
    let told = place.json(&[&line[..], &["--luminance", "2000"], &VEIL].concat());
    let spot = &told["spots"][0];
    let number = |value: &Value| value.as_f64().unwrap();
    let (dark, field) = (number(&spot["spot_cd_m2"]), number(&spot["field_cd_m2"]));
    assert!(told["field_cd_m2"] == 2000.0 && (1500.0..2000.0).contains(&field), "{spot}");
    assert!((dark / field / number(&spot["index"][1]) - 1.0).abs() < 1e-6, "{spot}");
    assert!(
        place.json(&[&line[..3], &["--diameters", "2", "--json"], &VEIL].concat()[..])["spots"][0]
            .get("spot_cd_m2")
            .is_none()
    );
    place.vglare(&[&["apply", "chart.exr", "-o", "seen.exr", "--luminance", "2000"][..], &VEIL].concat()).succeeded();
    let diameter = 2f64.to_radians() * 150.0 / 20f64.to_radians().tan();
    let at = format!("{},{},{diameter}", spot["pixel"][0], spot["pixel"][1]);
    let seen = place.json(&["measure", "seen.exr", "--spot", &at, "--json"]);
    assert!((number(&seen["spots"][0]["field_cd_m2"]) / field - 1.0).abs() < 0.02, "{seen}");
    assert!((number(&seen["spots"][0]["spot_cd_m2"]) / dark - 1.0).abs() < 0.05, "{seen}");
    let table = place.vglare(&["measure", "seen.exr", "--spot", &at]).succeeded().stdout();
    assert!(table.contains("field, cd/m²") && table.contains("White of the photo: 2000 cd/m²"), "{table}");
}

#[test]
fn older_words_of_adaptation_are_understood() {
    let place = Workplace::new();
    place.photo("in.exr");
    let spencer = ["--lens", "none", "--veil", "spencer", "--fov", "40"];
    for (name, more) in [
        ("older.exr", &["--luminance", "scotopic"][..]),
        ("newer.exr", &["--adaptation", "scotopic"]),
        ("both.exr", &["--adaptation", "scotopic", "--luminance", "120"]),
    ] {
        place.vglare(&[&["apply", "in.exr", "-o", name][..], &spencer, more].concat()).succeeded();
    }
    let read = |name: &str| photo::read(&place.path(name)).unwrap();
    assert_eq!(read("older.exr").pixels, read("newer.exr").pixels);
    assert_eq!(read("older.exr").pixels, read("both.exr").pixels);
    let whites = ["older.exr", "both.exr"].map(|name| read(name).luminance_scale().map(|scale| scale.cd_m2_per_unit));
    assert_eq!(whites, [None, Some(120.0)]);
    let centre = |more: &[&str]| place.json(&[&["psf", "spencer", "--json"], more].concat())["centre"].clone();
    assert_eq!(centre(&["--luminance", "scotopic"]), centre(&["--adaptation", "scotopic"]));
    assert_ne!(centre(&["--adaptation", "scotopic"]), centre(&[]));
}

/// The unit of a picture of 3 × 2 that spans 50° is tan(25°) / 1.5 of a focal length, and a steradian so many squares of it.
#[test]
fn functions_in_the_looks_unit_are_told_per_steradian() {
    let place = Workplace::new();
    let line = ["psf", "gaussian", "--width", "0.1", "--json", "--csv", "psf.csv", "--force"];
    let (plain, axis) = (place.json(&line), place.json(&[&line[..], &["--fov", "50"]].concat()));
    let unit = 25f64.to_radians().tan() / 1.5;
    assert_eq!((&plain["fov"], &axis["fov"], &axis["per"]), (&Value::Null, &50.0.into(), &"steradian".into()));
    assert!(close(&axis["unit_degrees"], unit.to_degrees()));
    let number = |value: &Value| value.as_f64().unwrap();
    for of in [
        |told: &Value| told["centre"].clone(),
        |told: &Value| told["rows"][100]["value"].clone(),
        |told: &Value| told["mixture"]["terms"][0]["value"].clone(),
    ] {
        assert!(close(&of(&axis), number(&of(&plain)) / (unit * unit)));
    }
    let row = std::fs::read_to_string(place.path("psf.csv")).unwrap();
    let value: f64 = row.lines().nth(101).unwrap().split(',').nth(1).unwrap().parse().unwrap();
    assert!(close(&axis["rows"][100]["value"], value));
    let said = place.vglare(&["psf", "gaussian", "--width", "0.1", "--fov", "50"]).succeeded().stdout();
    assert!(said.contains("per steradian at the centre") && said.contains("50° across"), "{said}");
}

#[test]
fn a_radiance_picture_is_taken_at_its_word_where_that_is_asked_for() {
    let place = Workplace::new();
    place.photo("in.hdr");
    let read = |white_luminance| {
        let photo = photo::read_with(&place.path("in.hdr"), &ReadOptions { white_luminance, ..Default::default() });
        photo.unwrap().luminance_scale().map(|scale| scale.cd_m2_per_unit)
    };
    assert_eq!([read(None), read(Some(WhiteLuminance::File))], [None, Some(179.0)]);
    let line = ["apply", "in.hdr", "-o", "out.exr", "--luminance", "file"];
    place.vglare(&[&line[..], &VEIL].concat()).succeeded();
    let scale = photo::read(&place.path("out.exr")).unwrap().luminance_scale().unwrap();
    assert_eq!(scale.cd_m2_per_unit, 179.0);
}
