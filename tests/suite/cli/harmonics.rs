//! `vglare harmonics`: what it writes, which way it turns, and what it refuses.

use serde_json::Value;
use vglare::photo::{self, Photo};

use super::{Workplace, night};

const WIDTH: usize = 64;
const HEIGHT: usize = 32;

/// A dim panorama with a soft red light ahead, a little up, and a blue floor.
fn panorama() -> Photo {
    let pixel = |k: usize| {
        let (column, row) = ((k % WIDTH) as f32, (k / WIDTH) as f32);
        let distance = ((column - 31.5).powi(2) + (row - 11.5).powi(2)) / 30.0;
        [0.1 + 5.0 * (-distance).exp(), 0.2, if row > 16.0 { 1.0 } else { 0.1 }, 1.0]
    };
    Photo::new(WIDTH as u32, HEIGHT as u32, (0..WIDTH * HEIGHT).map(pixel).collect())
}

fn brightest(photo: &Photo, colour: usize) -> (usize, usize) {
    let most = (0..photo.pixels.len()).max_by(|&a, &b| photo.pixels[a][colour].total_cmp(&photo.pixels[b][colour]));
    (most.unwrap() % photo.width() as usize, most.unwrap() / photo.width() as usize)
}

fn written(place: &Workplace, args: &[&str]) -> (Photo, String) {
    let all = [&["harmonics", "in.exr", "-o", "out.exr", "--force"], args].concat();
    let said = place.vglare(&all).succeeded().stdout();
    (photo::read(&place.path("out.exr")).unwrap(), said)
}

#[test]
fn turns_go_the_way_they_say() {
    let place = Workplace::new();
    place.write("in.exr", &panorama());
    let red = |args: &[&str]| brightest(&written(&place, args).0, 0);
    let near = |at: (usize, usize), column: usize, row: usize| {
        assert!(at.0.abs_diff(column) <= 1 && at.1.abs_diff(row) <= 1, "{at:?} for {column}, {row}");
    };
    near(red(&["--degree", "16"]), 31, 11);
    // A quarter turn is a quarter of the picture, to the left.
    near(red(&["--degree", "16", "--rotate", "90,0,0"]), 15, 11);
    near(red(&["--degree", "16", "--rotate", "-90,0,0"]), 47, 11);
    // Up by 22.5 degrees is four rows.
    near(red(&["--degree", "16", "--rotate", "0,22.5,0"]), 31, 7);
    // Clockwise around what is ahead: what was above is to the right.
    near(red(&["--degree", "16", "--rotate", "0,0,90"]), 36, 16);
}

#[test]
fn a_whole_pixel_yaw_moves_every_pixel() {
    let place = Workplace::new();
    place.write("in.exr", &panorama());
    let (still, said) = written(&place, &["--degree", "12"]);
    assert!(said.contains("169 coefficients") && said.contains("9 to 12"), "{said}");
    let (turned, said) = written(&place, &["--degree", "12", "--rotate", "45,0,0", "--check"]);
    for row in 0..HEIGHT {
        for column in 0..WIDTH {
            let [was, is] = [still.pixels[row * WIDTH + (column + 8) % WIDTH], turned.pixels[row * WIDTH + column]];
            assert!(was.iter().zip(is).all(|(was, is)| (was - is).abs() < 1e-5), "{was:?} {is:?}");
        }
    }
    // The check's first number, from the program's own words.
    let carried = said.lines().find(|line| line.contains("carried")).unwrap();
    let carried: f64 = carried.split_whitespace().next().unwrap().parse().unwrap();
    assert!(carried < 1e-12, "{said}");
}

#[test]
fn irradiance_is_pi_for_light_all_round_and_comes_in_any_size() {
    let place = Workplace::new();
    place.write("in.exr", &Photo::new(64, 32, vec![[1.0, 0.5, 0.0, 1.0]; 64 * 32]));
    let (out, _) = written(&place, &["--irradiance", "--degree", "2", "--size", "40x20"]);
    assert_eq!((out.width(), out.height()), (40, 20));
    for pixel in &out.pixels {
        let expected = [std::f32::consts::PI, std::f32::consts::FRAC_PI_2, 0.0];
        assert!(pixel.iter().zip(expected).all(|(is, expected)| (is - expected).abs() < 1e-6), "{pixel:?}");
    }
    // A blue floor lights what faces down.
    place.write("in.exr", &panorama());
    let (out, said) = written(&place, &["--irradiance"]);
    assert!(out.pixels[31 * WIDTH][2] > 2.0 * out.pixels[0][2], "{said}");
    for name in ["out.png", "out.jpg", "out.hdr"] {
        place.vglare(&["harmonics", "in.exr", "-o", name, "-q"]).succeeded();
        assert_eq!(photo::read(&place.path(name)).unwrap().width(), 64);
    }
}

#[test]
fn coefficients_are_written_as_csv_and_json() {
    let place = Workplace::new();
    place.write("in.exr", &Photo::new(8, 4, vec![[1.0, 2.0, 4.0, 1.0]; 32]));
    written(&place, &["--degree", "1", "--coefficients", "c.csv"]);
    super::tables::tidy(&place.path("."), 1);
    let text = std::fs::read_to_string(place.path("c.csv")).unwrap();
    let rows: Vec<Vec<f64>> =
        text.lines().skip(1).map(|line| line.split(',').map(|field| field.parse().unwrap()).collect()).collect();
    assert!(text.starts_with("l,m,red,green,blue\n") && rows.len() == 4, "{text}");
    assert_eq!([&rows[1][..2], &rows[3][..2]], [[1.0, -1.0], [1.0, 1.0]]);
    let root = (4.0 * std::f64::consts::PI).sqrt();
    assert!((rows[0][2] - root).abs() < 1e-14 && (rows[0][4] - 4.0 * root).abs() < 1e-14, "{text}");

    place.write("in.exr", &panorama());
    let json = |more: &[&str]| -> Value {
        written(&place, &[&["--degree", "3", "--coefficients", "c.json", "--rotate", "10,20,30"], more].concat());
        serde_json::from_str(&std::fs::read_to_string(place.path("c.json")).unwrap()).unwrap()
    };
    let (plain, signed) = (json(&[]), json(&["--condon-shortley"]));
    assert_eq!((&plain["phase"], &signed["phase"]), (&"plain".into(), &"condon-shortley".into()));
    assert_eq!(plain["rotation"], serde_json::json!([10.0, 20.0, 30.0]));
    assert_eq!(plain["coefficients"].as_array().map(Vec::len), Some(16));
    let red = |file: &Value, k: usize| file["coefficients"][k][0].as_f64().unwrap();
    assert!(red(&plain, 1) != 0.0 && red(&plain, 1) == -red(&signed, 1) && red(&plain, 2) == red(&signed, 2));
}

#[test]
fn pixels_that_are_no_light_count_as_nothing_and_are_told() {
    let place = Workplace::new();
    let mut black = panorama();
    black.pixels[700] = [0.0, 0.0, -2.0, 1.0];
    black.pixels[701] = [0.0, 0.0, 0.0, 1.0];
    place.write("in.exr", &black);
    let (expected, _) = written(&place, &[]);
    let mut bad = black.clone();
    bad.pixels[700] = [f32::NAN, 0.0, -2.0, 1.0];
    bad.pixels[701] = [0.0, f32::INFINITY, f32::NEG_INFINITY, 1.0];
    place.write("in.exr", &bad);
    let (out, said) = written(&place, &[]);
    assert!(said.contains("1 NaN, 1 infinite, 1 negative") && said.contains("column 60, row 10"), "{said}");
    assert_eq!(out.pixels, expected.pixels);
    // Nothing but NaN is darkness, not an error.
    place.write("in.exr", &Photo::new(8, 4, vec![[f32::NAN; 4]; 32]));
    let (out, said) = written(&place, &["--degree", "3"]);
    assert!(out.pixels.iter().all(|pixel| pixel[..3] == [0.0; 3]), "{said}");
    assert!(!said.contains("NaN %"), "{said}");
}

#[test]
fn what_cannot_be_is_refused_and_nothing_is_written() {
    let place = Workplace::new();
    place.write("in.exr", &panorama());
    place.write("night.exr", &night());
    place.text("text.exr", "this is no picture");
    place.text("taken.exr", "precious");
    let before = place.files();
    let refused = |input: &str, options: &[&str], code: i32, words: &[&str]| {
        place.vglare(&[&["harmonics", input], options].concat()).failed(code, words);
        assert_eq!(place.files(), before, "{input} {options:?}");
    };
    refused("night.exr", &["-o", "out.exr"], 1, &["night.exr", "96 x 64", "twice as wide"]);
    refused("text.exr", &["-o", "out.exr"], 1, &["text.exr"]);
    refused("missing.exr", &["-o", "out.exr"], 1, &["missing.exr"]);
    refused("in.exr", &["-o", "taken.exr"], 1, &["taken.exr", "--force"]);
    refused("in.exr", &["-o", "out.gif"], 1, &["out.gif"]);
    refused("in.exr", &["-o", "nowhere/out.exr"], 1, &["nowhere"]);
    refused("in.exr", &["-o", "out.exr", "--coefficients", "c.txt"], 1, &["c.txt", ".csv"]);
    refused("in.exr", &["-o", "out.exr", "--coefficients", "nowhere/c.csv"], 1, &["nowhere"]);
    refused("in.exr", &["-o", "out.exr", "--degree", "32"], 2, &["32", "in.exr", "0 to 31"]);
    refused("in.exr", &["-o", "out.exr", "--degree", "1501"], 2, &["1500"]);
    refused("in.exr", &["-o", "out.exr", "--rotate", "1,2"], 2, &["three angles"]);
    refused("in.exr", &["-o", "out.exr", "--size", "64x64"], 2, &["1024x512"]);
    refused("in.exr", &["-o", "out.exr", "--check"], 2, &["--rotate"]);
    refused("in.exr", &["-o", "out.exr", "--condon-shortley"], 2, &["--coefficients"]);
    refused("in.exr", &["-o", "out.exr", "--exposure", "1"], 1, &["out.exr"]);
    assert_eq!(std::fs::read_to_string(place.path("taken.exr")).unwrap(), "precious");
}
