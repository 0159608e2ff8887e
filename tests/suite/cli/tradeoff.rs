//! `vglare tradeoff`: what it writes, whether its numbers keep their promises, and what it refuses.

use std::collections::HashMap;

use vglare::photo::Photo;

use super::Workplace;
use super::tables::tidy;

type Row = HashMap<String, String>;

fn rows(place: &Workplace, name: &str) -> Vec<Row> {
    let mut reader = csv::Reader::from_path(place.path(name)).expect("a CSV file");
    reader.deserialize().map(|row| row.expect("a row")).collect()
}

#[track_caller]
fn number(row: &Row, column: &str) -> f64 {
    row[column].parse().unwrap_or_else(|_| panic!("{column} of {row:?}"))
}

fn of<'a>(rows: &'a [Row], sweep: &str) -> Vec<&'a Row> {
    rows.iter().filter(|row| row["sweep"] == sweep && row["refused"].is_empty()).collect()
}

#[test]
fn a_small_photo_gets_tables_plots_pictures_and_a_page_whose_numbers_keep_their_promises() {
    let place = Workplace::new();
    place.photo("night.exr");
    // Wide ghosts have few terms.
    place.text("wide.toml", "[look]\nsize = 2.5\n");
    let wide = ["tradeoff", "night.exr", "--quick", "--scene", "wide.toml", "-o", "trade"];
    let ran = place.vglare(&wide).succeeded();
    let said = ran.stdout();
    assert!(said.contains("--tolerance") && said.contains("predicted") && said.contains("index.html"), "{said}");

    let rows = rows(&place, "trade/results.csv");
    let tolerance = of(&rows, "tolerance");
    let own: Vec<_> = tolerance.iter().filter(|row| row["planner"] == "true").collect();
    assert!(own.len() >= 4, "one for each tolerance that f32 can reach: {own:?}");
    for row in &own {
        let [measured, predicted, asked] = ["measured", "predicted", "asked"].map(|column| number(row, column));
        assert!(measured > 0.0 && measured <= predicted && predicted <= asked, "{row:?}");
    }
    for row in &tolerance {
        let [least, median, most] = ["least_ms", "ms", "most_ms"].map(|column| number(row, column));
        assert!(0.0 < least && least <= median && median <= most, "{row:?}");
        assert!(number(row, "rms") <= number(row, "measured"), "{row:?}");
        assert!(number(row, "delta_e_mean") <= number(row, "delta_e_max"), "{row:?}");
    }
    // A finer tolerance does not look worse.
    let seen: Vec<f64> = own.iter().map(|row| number(row, "delta_e_max")).collect();
    assert!(seen.last() < seen.first(), "{seen:?}");

    let degree = of(&rows, "degree");
    assert!(degree.len() >= 5, "{}", degree.len());
    assert!(degree.iter().all(|row| number(row, "predicted") >= number(row, "measured")), "{degree:?}");
    let [first, last] = [degree[0], degree[degree.len() - 1]].map(|row| number(row, "measured"));
    assert!(last < 1e-2 * first, "the error falls with the degree: {first} to {last}");

    let lattices = of(&rows, "oversampling");
    assert!(lattices.iter().all(|row| number(row, "predicted") >= number(row, "measured")), "{lattices:?}");
    let counts: Vec<f64> = of(&rows, "ghosts").iter().map(|row| number(row, "ghosts")).collect();
    assert!(counts.contains(&1.0) && counts.contains(&10_000.0), "{counts:?}");
    let sizes = of(&rows, "size");
    assert!(sizes.iter().any(|row| number(row, "width") == 96.0 && row["planner"] == "true"), "the photo's own size");
}

#[test]
fn the_page_names_files_that_are_there_and_nothing_from_elsewhere() {
    let place = Workplace::new();
    place.photo("night.exr");
    place.text("lamp.toml", "[[ghost]]\ncenter = [0.2, 0.1]\nsize = 0.4\nradiance = [2.0, 1.5, 1.0]\n");
    let scene = ["tradeoff", "night.exr", "--quick", "-q", "--scene", "lamp.toml", "-o", "trade"];
    let veil = ["--veil", "gaussian", "--width", "0.1", "--scatter", "0.1", "--unit", "diagonal"];
    let scene: Vec<&str> = scene.into_iter().filter(|word| *word != "-q").collect();
    let said = place.vglare(&[&scene[..], &veil].concat()).succeeded().stdout();
    assert!(said.contains("The planner's choices") && said.contains("The veil at"), "{said}");
    let veil = rows(&place, "trade/results.csv").into_iter().filter(|row| row["sweep"] == "veil").collect::<Vec<_>>();
    assert_eq!(veil.iter().map(|row| number(row, "asked")).collect::<Vec<_>>(), [1e-1, 1e-2, 1e-3]);
    for row in &veil {
        let [measured, predicted, asked] = ["measured", "predicted", "asked"].map(|column| number(row, column));
        assert!(measured > 0.0 && measured <= predicted && predicted <= asked, "{row:?}");
        assert!(number(row, "least_ms") <= number(row, "ms") && number(row, "ms") <= number(row, "most_ms"), "{row:?}");
    }
    let page = std::fs::read_to_string(place.path("trade/index.html")).unwrap();
    assert!(!page.contains("http") && page.contains("prefers-color-scheme"), "self-contained, light and dark");
    let named =
        page.split(['"']).filter(|part| [".png", ".svg", ".csv", ".json"].iter().any(|end| part.ends_with(end)));
    let named: Vec<_> = named.filter(|part| !part.contains(' ')).collect();
    assert!(named.len() > 20, "{named:?}");
    for name in named {
        assert!(place.path("trade").join(name).metadata().unwrap_or_else(|_| panic!("{name}")).len() > 100, "{name}");
    }
    let json: serde_json::Value =
        serde_json::from_str(&std::fs::read_to_string(place.path("trade/results.json")).unwrap()).unwrap();
    assert_eq!(json["ghosts"], 1);
    assert!(json["recommendation"]["tolerance"].as_f64().is_some_and(|tolerance| tolerance <= 0.1), "{json}");
    assert_eq!(json["phases"].as_array().map(Vec::len), Some(5));
    tidy(&place.path("trade"), 6);
    assert!(page.contains("<span class=\"unbroken\">") && page.contains(".unbroken { white-space: nowrap }"));
}

#[test]
fn folders_that_hold_other_files_and_lights_that_are_not_there_are_refused() {
    let place = Workplace::new();
    place.photo("night.exr");
    std::fs::create_dir(place.path("mine")).unwrap();
    std::fs::write(place.path("mine/precious.txt"), "precious").unwrap();
    let into = |folder: &str| place.vglare(&["tradeoff", "night.exr", "--quick", "-o", folder]);
    into("mine").failed(1, &["mine", "--force"]);
    assert_eq!(std::fs::read_dir(place.path("mine")).unwrap().count(), 1, "nothing is written");
    into("night.exr").failed(1, &["night.exr"]);
    place.vglare(&["tradeoff", "no.exr", "-o", "new"]).failed(1, &["no.exr"]);
    place.vglare(&["tradeoff", "night.exr", "--preset", "no-such-lens", "-o", "new"]).failed(2, &["no-such-lens"]);
    let none = ["--sources", "lights", "--threshold", "1e9", "--veil", "none"];
    place.vglare(&[&["tradeoff", "night.exr", "-o", "new"][..], &none].concat()).failed(2, &["night.exr", "glares"]);
    place.vglare(&["tradeoff", "night.exr"]).failed(2, &["--output"]);
    assert!(!place.path("new").exists(), "no folder where nothing is to be written");
}

#[test]
fn a_photo_without_lights_has_the_ghosts_of_its_pixels() {
    let place = Workplace::new();
    let (width, height) = (12, 8);
    place.write("dim.exr", &Photo::new(width, height, vec![[0.2, 0.3, 0.1, 1.0]; (width * height) as usize]));
    // Of few ghosts, of few terms.
    place.text("wide.toml", "[[lens_ghost]]\nalong = -0.5\nsize = 0.6\nshare = 0.01\n");
    place.vglare(&["tradeoff", "dim.exr", "--quick", "--lens", "wide.toml", "-o", "trade"]).succeeded();
    assert_eq!(place.read_json("trade/results.json")["ghosts"], width * height);
    let rows = rows(&place, "trade/results.csv");
    let own = of(&rows, "tolerance").into_iter().filter(|row| row["planner"] == "true").collect::<Vec<_>>();
    assert!(!own.is_empty());
    for row in own {
        let [measured, predicted, asked] = ["measured", "predicted", "asked"].map(|column| number(row, column));
        assert!(measured <= predicted && predicted <= asked, "{row:?}");
    }
}
