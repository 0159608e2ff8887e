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
fn a_real_lens_has_its_closed_form_beside_the_chart() {
    let place = Workplace::new();
    // In so small a field and stopped down no rim cuts ghosts: one of light from anywhere looks like another.
    let narrow = "--lens double-gauss --coating none --fstop 8 --blades 0 --sensor 6x4 --veil none";
    let wide = "--lens triplet --coating none --veil none";
    for (lens, diameter, close) in [(narrow, "0.5", 0.02), (wide, "3", 0.2)] {
        let line = format!("measure {lens} --pixels 240x160 --diameters {diameter} --json");
        let told = place.json(&line.split(' ').collect::<Vec<_>>());
        let [spots, closed] = ["spots", "closed"].map(|key| told[key].as_array().unwrap());
        assert!(spots.len() == 4 && closed.len() == 4, "{told}");
        for (spot, closed) in spots.iter().zip(closed) {
            assert_eq!(spot["place"], closed["place"]);
            for c in 0..3 {
                let [rendered, bound, wanted] =
                    [&spot["index"][c], &spot["bound"][c], &closed["index"][c]].map(|value| value.as_f64().unwrap());
                // A chart's light is cut in four patches, in each as in its middle.
                assert!((rendered - wanted).abs() < bound + close * wanted, "{spot} {closed}");
                let parts = ["ghosts", "veil"].map(|part| closed[part][c].as_f64().unwrap());
                assert!((parts[0] / wanted - 1.0).abs() < 1e-12 && wanted > 0.0 && parts[1] == 0.0, "{closed}");
            }
        }
    }
}

#[test]
fn f_numbers_and_angles_are_a_table_and_rays_have_an_interval() {
    let place = Workplace::new();
    let line = "measure --lens tessar --coating none --fstops 4,8 --angles 0,12 --diameters 1 --rays 256 --json";
    let told = place.json(&line.split(' ').collect::<Vec<_>>());
    let closed = told["closed"].as_array().unwrap();
    assert!(told.get("spots").is_none() && closed.len() == 4, "{told}");
    let number = |row: usize, key: &str| closed[row][key].as_f64().unwrap();
    for (row, (fstop, angle)) in [(4.0, 0.0), (4.0, 12.0), (8.0, 0.0), (8.0, 12.0)].into_iter().enumerate() {
        assert!(
            (number(row, "f_number") - fstop).abs() < 1e-9 && (number(row, "off_axis_degrees") - angle).abs() < 1e-9
        );
        let rays = &closed[row]["rays"];
        let [mean, interval] = [0, 1].map(|k| rays["luminance"][k].as_f64().unwrap());
        assert!(mean > 0.002 && interval > 0.0 && interval < 0.3 * mean, "{rays}");
        assert_eq!(rays["paths"].as_array().unwrap().len(), 21, "seven surfaces reflect");
    }
    let text = place.vglare(&line.trim_end_matches(" --json").split(' ').collect::<Vec<_>>()).succeeded().stdout();
    assert!(text.contains("f/4.0") && text.contains("12.0°") && text.contains("by rays"), "{text}");
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
        ("measure --lens tessar --angles 0,30", 2, "angles from 0 to"),
        ("measure --lens tessar --fstops 2,8", 1, "opens to f/3.5"),
        ("measure --lens tessar --fstop 8 --fstops 4", 2, "cannot be used with"),
        ("measure --lens tessar --method rendered --angles 3", 2, "--method closed"),
        ("measure --lens tessar --method rendered --rays 100", 2, "--method closed or both"),
        ("measure --lens tessar --method closed -o index.svg", 2, "--method both"),
        ("measure --lens tessar --rays 63", 2, "63"),
        ("measure --method closed", 2, "known by their surfaces"),
        ("measure --lens none --veil cie --fstops 4", 2, "known by its surfaces"),
        ("measure --lens none --veil cie --method closed --rays 100", 2, "known by its surfaces"),
        ("measure --lens tessar --axis 0.1,0 --method closed", 2, "--axis"),
        ("measure in.exr --spot 9,9,4 --method closed", 2, "cannot be used with"),
        ("measure in.exr", 2, "--spot"),
        ("measure in.exr --spot 4,4,10", 2, "not in the photo"),
        ("measure in.exr --spot 4,4", 2, "column, row"),
        ("measure none.exr --spot 4,4,1", 1, "none.exr"),
    ] {
        place.vglare(&line.split(' ').collect::<Vec<_>>()).failed(code, &[word]);
        assert_eq!(place.files(), before, "{line}");
    }
}
