use clap::Parser;
use serde_json::Value;

use super::*;
use crate::scene::lenses;

#[derive(Debug, Parser)]
struct Line {
    #[command(flatten)]
    args: Args,
}

fn parsed(line: &[&str]) -> std::result::Result<Args, String> {
    Line::try_parse_from([&["lens"], line].concat()).map(|line| line.args).map_err(|error| error.to_string())
}

fn shown(line: &[&str]) -> Result<Report> {
    let args = parsed(line).unwrap();
    show(&args, args.name.as_deref().unwrap())
}

/// What is refused, by the parser or the command.
fn refused(line: &[&str]) -> String {
    match parsed(line) {
        Err(error) => error,
        Ok(args) => show(&args, args.name.as_deref().unwrap()).unwrap_err().to_string(),
    }
}

fn golden(name: &str) -> String {
    format!("{}/tests/golden-optics/{name}", env!("CARGO_MANIFEST_DIR"))
}

fn json(report: &Report) -> Value {
    serde_json::to_value(report).unwrap()
}

#[test]
fn a_lens_is_told_as_its_file_has_it() {
    let report = shown(&["double-gauss"]).unwrap();
    let text = text::text(&report);
    for said in ["US 2,673,491", "focal length    50.", "wide open 2.0", "mgf2", "stop", "36 × 24 mm", "25 more ghosts"]
    {
        assert!(text.contains(said), "{said:?} is not in\n{text}");
    }
    let all = json(&shown(&["double-gauss", "--json"]).unwrap());
    for key in [
        "name",
        "patent",
        "focal_length_mm",
        "f_number",
        "back_focus_mm",
        "entrance_pupil_mm",
        "half_field_degrees",
        "surfaces",
        "ghosts",
        "share",
    ] {
        assert!(!all[key].is_null(), "{key}");
    }
    let ghosts = all["ghosts"].as_array().unwrap();
    assert_eq!((ghosts.len(), all["surfaces"].as_array().unwrap().len()), (45, 11));
    for key in ["pair", "magnification", "radius_mm", "tint", "share", "focus_mm", "vignetting"] {
        assert!(ghosts.iter().all(|ghost| !ghost[key].is_null()), "{key}");
    }
    for c in 0..3 {
        let sum: f64 = ghosts.iter().map(|ghost| ghost["share"][c].as_f64().unwrap()).sum();
        assert!((sum - all["share"][c].as_f64().unwrap()).abs() < 1e-12);
    }
    assert!((all["focal_length_mm"].as_f64().unwrap() - 50.0).abs() < 0.5);
}

#[test]
fn every_lens_that_ships_is_listed_and_shown() {
    let entries = list::entries().unwrap();
    let mut listed = Vec::new();
    list::text(&mut listed, &entries).unwrap();
    let listed = String::from_utf8(listed).unwrap();
    for lens in lenses::all() {
        assert!(listed.lines().any(|line| line.split_whitespace().next() == Some(lens.name)), "{listed}");
        let text = text::text(&shown(&[lens.name, "--ghosts", "3"]).unwrap());
        assert!(text.contains("focal length") && text.contains("together"), "{text}");
        assert!(!text.contains("NaN") && !text.contains("inf "), "{text}");
    }
    let mut json = Vec::new();
    list::json(&mut json, &entries).unwrap();
    let json: Vec<Value> = serde_json::from_slice(&json).unwrap();
    assert_eq!(json.len(), lenses::all().len());
    assert!(json.iter().all(|lens| lens["pairs"].as_u64().unwrap() >= 1));
}

#[test]
fn settings_change_what_they_should() {
    let f_number = |line: &[&str]| shown(line).unwrap().f_number;
    assert!((f_number(&["tessar", "--fstop", "8"]) - 8.0).abs() < 1e-9);
    let zoom = shown(&["zoom"]).unwrap();
    let [first, .., last] = &zoom.settings[..] else { panic!("{:?}", zoom.settings) };
    let length = |setting: &str| shown(&["zoom", "--setting", setting]).unwrap().focal_length_mm;
    assert!(length(last) > 2.0 * length(first));
    let [bare, coated] = ["none", "multi"].map(|coating| shown(&["tessar", "--coating", coating]).unwrap().share[1]);
    assert!(bare > 20.0 * coated, "{bare} {coated}");
    let near = shown(&["tessar", "--focus", "1", "--sensor", "24x16", "--blades", "5"]).unwrap();
    assert_eq!((near.sensor_mm, near.blades), ([24.0, 16.0], Some(5)));
    assert!(near.sensor_distance_mm > near.back_focus_mm + 2.0);
}

#[test]
fn files_of_other_programs_are_shown_and_what_they_leave_open_is_told() {
    let ours = shown(&["double-gauss"]).unwrap();
    for name in ["double-gauss.zmx", "double-gauss-utf8.zmx", "double-gauss.dat"] {
        let theirs = shown(&[&golden(name)]).unwrap();
        assert!((theirs.focal_length_mm / ours.focal_length_mm - 1.0).abs() < 1e-3, "{name}");
        assert_eq!(theirs.ghosts_in_all, ours.ghosts_in_all, "{name}");
    }
    let text = text::text(&shown(&[&golden("double-gauss.dat")]).unwrap());
    assert!(text.contains("note") && text.contains("Abbe"), "{text}");
    for (name, reason) in [("aspheric.zmx", "PARM 2"), ("tilted.zmx", "COORDBRK")] {
        let said = refused(&[&golden(name)]);
        assert!(said.contains(name) && said.contains(reason) && said.contains("surface 2"), "{said}");
    }
}

#[test]
fn exact_rays_are_told_beside_the_matrices() {
    let line = ["tessar", "--exact", "512", "--angle", "5", "--ghosts", "2"];
    let report = shown(&line).unwrap();
    let text = text::text(&report);
    assert!(text.contains("Exact rays") && text.contains("5° off it"), "{text}");
    let report = json(&report);
    for ghost in report["ghosts"].as_array().unwrap() {
        let exact = &ghost["exact"];
        let [low, share, high] = [&exact["share_interval"][0], &exact["share"], &exact["share_interval"][1]]
            .map(|part| part.as_f64().unwrap());
        assert!(0.0 <= low && low < share && share < high, "{exact}");
        assert!(exact["rms_mm"].as_f64().unwrap() > 0.0);
        assert!(exact["off_axis"]["centroid_mm"].is_f64() && exact["off_axis"]["paraxial_centroid_mm"].is_f64());
    }
    assert_eq!(parsed(&["tessar", "--exact"]).unwrap().exact, Some(4096));
    assert!(json(&shown(&["tessar"]).unwrap())["ghosts"][0].get("exact").is_none());
}

#[test]
fn drawings_are_written_once() {
    let place = tempfile::tempdir().unwrap();
    let path = |name: &str| place.path().join(name).display().to_string();
    for end in ["svg", "png"] {
        let [section, coatings, lamp] = ["section", "coatings", "lamp"].map(|name| path(&format!("{name}.{end}")));
        let line = ["tessar", "--section", &section, "--coatings", &coatings, "--lamp", &lamp, "--ghost", "3,1"];
        shown(&line).unwrap();
        for file in [&section, &coatings, &lamp] {
            let bytes = std::fs::read(file).unwrap();
            match end {
                "svg" => {
                    let text = String::from_utf8(bytes).unwrap();
                    roxmltree::Document::parse(&text).unwrap();
                }
                _ => assert!(image::load_from_memory(&bytes).unwrap().width() > 900),
            }
        }
        let said = refused(&line);
        assert!(said.contains("exists already"), "{said}");
        shown(&[&line[..], &["--force"]].concat()).unwrap();
    }
    assert_eq!(std::fs::read_dir(place.path()).unwrap().count(), 6);
}

#[test]
fn what_cannot_be_is_refused_by_name_and_nothing_is_written() {
    let place = tempfile::tempdir().unwrap();
    let path = |name: &str| place.path().join(name).display().to_string();
    let (svg, pdf) = (path("a.svg"), path("a.pdf"));
    for (line, said) in [
        (&["tesar", "--section", &svg][..], "did you mean tessar?"),
        (&["classic-prime", "--section", &svg], "classic-prime is a table of ghosts"),
        (&[&path("none.zmx"), "--section", &svg], "none.zmx"),
        (&["tessar", "--section", &pdf], "written as .svg or .png"),
        (&["tessar", "--section", &svg, "--lamp", &svg], "a.svg"),
        (&["tessar", "--lamp", &svg, "--coatings", &path("no/folder.svg")], "no folder"),
        (&["tessar", "--section", &svg, "--ghost", "3,9"], "has no ghost 9,3; the surfaces that reflect are 1, 2"),
        (&["tessar", "--section", &svg, "--ghost", "4,4"], "has no ghost 4,4"),
        (&["tessar", "--section", &svg, "--ghost", "3"], "as 8,3"),
        (&["tessar", "--section", &svg, "--ghost", "3,x"], "as 8,3"),
        (&["tessar", "--ghost", "3,1"], "--section"),
        (&["tessar", "--section", &svg, "--fstop", "1"], "opens to f/3.5"),
        (&["tessar", "--section", &svg, "--setting", "long"], "no setting \"long\""),
        (&["tessar", "--section", &svg, "--exact", "10"], "10 rays are not from 64"),
        (&["tessar", "--section", &svg, "--exact", "--angle", "90"], "90° from the axis"),
        (&["tessar", "--section", &svg, "--angle", "5"], "--exact or for --ghost"),
        (&["--section", &svg], "NAME|FILE"),
    ] {
        let error = refused(line);
        assert!(error.contains(said), "{line:?}: {error:?} does not say {said:?}");
        assert_eq!(std::fs::read_dir(place.path()).unwrap().count(), 0, "{line:?}");
    }
    let listed = parsed(&["--fstop", "4"]).unwrap();
    assert!(run(&listed).unwrap_err().to_string().contains("name the lens"));
}

#[test]
fn a_lens_is_not_drawn_over() {
    let place = tempfile::tempdir().unwrap();
    let lens = place.path().join("lens.svg").display().to_string();
    let text = lenses::find("singlet").unwrap().toml;
    std::fs::write(&lens, text).unwrap();
    let said = refused(&[&lens, "--section", &lens, "--force"]);
    assert!(said.contains("lens.svg"), "{said}");
    assert_eq!(std::fs::read_to_string(&lens).unwrap(), text);
}
