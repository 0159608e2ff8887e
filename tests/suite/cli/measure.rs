//! `measure`: a veiling glare index.

use super::Workplace;

const VEIL: [&str; 8] = ["--lens", "none", "--veil", "gaussian", "--width", "0.1", "--scatter", "0.1"];

#[test]
fn a_chart_that_is_seen_through_a_look_has_the_index_of_the_look() {
    let place = Workplace::new();
    let line =
        ["measure", "--pixels", "300x200", "--diameters", "2,4", "--chart", "chart.exr", "-o", "i.svg", "--json"];
    let told = place.json(&[&line[..], &VEIL].concat());
    let spots = told["spots"].as_array().unwrap();
    assert!(spots.len() == 8 && told["fov"] == 40.0, "{told}");
    let number = |spot: usize, key: &str, channel: usize| spots[spot][key][channel].as_f64().unwrap();
    for spot in 0..8 {
        let (index, bound) = (number(spot, "index", 1), number(spot, "bound", 1));
        assert!(index > 0.01 && index < 0.1 && bound > 0.0 && bound < 0.02 * index, "{told}");
    }
    assert!(number(0, "index", 1) > number(4, "index", 1), "a larger spot is blacker");
    assert!(std::fs::read_to_string(place.path("i.svg")).unwrap().contains("glare index"));
    // The same by a photo of the chart: its centre is read over a quarter of the diameter about it.
    place.vglare(&[&["apply", "chart.exr", "-o", "seen.exr"][..], &VEIL].concat()).succeeded();
    let focal = 150.0 / 20f64.to_radians().tan();
    let spot = format!("{},{},{}", number(0, "pixel", 0), number(0, "pixel", 1), 2f64.to_radians() * focal);
    let seen = place.json(&["measure", "seen.exr", "--spot", &spot, "--json"]);
    let found = seen["spots"][0]["index"][1].as_f64().unwrap();
    assert!((found / number(0, "index", 1) - 1.0).abs() < 0.03, "{found} for {}", number(0, "index", 1));
}

#[test]
fn charts_and_spots_that_cannot_be_are_refused() {
    let place = Workplace::new();
    place.photo("in.exr");
    let before = place.files();
    for (line, code, word) in [
        ("measure --diameters 0.05", 2, "pixels across"),
        ("measure --diameters 30", 2, "more than the picture shows"),
        ("measure --diameters 0", 2, "positive"),
        ("measure --veil cie --projection fisheye --lens none", 2, "fisheye"),
        ("measure -o index.txt", 1, ".svg or .png"),
        ("measure in.exr", 2, "--spot"),
        ("measure in.exr --spot 4,4,10", 2, "not in the photo"),
        ("measure in.exr --spot 4,4", 2, "column, row"),
        ("measure none.exr --spot 4,4,1", 1, "none.exr"),
    ] {
        place.vglare(&line.split(' ').collect::<Vec<_>>()).failed(code, &[word]);
        assert_eq!(place.files(), before, "{line}");
    }
}
