//! Where results may go: never over what is read, never two into one file, through links, with the old permissions.

use std::path::Path;

use vglare::photo;

use super::{Workplace, night};

const SCENE: &str = "\
[[profile]]
name = \"spot\"
file = \"spot.csv\"

[[ghost]]
bell = \"profile\"
profile = \"spot\"
center = [0.1, 0.1]
size = 0.3
radiance = [1.0, 1.0, 1.0]
";

fn bytes(path: &Path) -> Vec<u8> {
    std::fs::read(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// A photo, a scene, a lens and lights, with other names for some of them.
fn place() -> Workplace {
    let place = Workplace::new();
    place.photo("in.exr");
    place.text("scene.toml", SCENE);
    place.text("spot.csv", "radius,value\n0,1\n1,0\n");
    place.text("lens.toml", &place.vglare(&["presets", "zoom"]).succeeded().stdout());
    place.text("lights.toml", "[[light]]\nposition = [0.1, 0.1]\nflux = [1.0, 1.0, 1.0]\n");
    std::fs::create_dir(place.path("real")).unwrap();
    #[cfg(unix)]
    {
        use std::os::unix::fs::symlink;
        symlink("in.exr", place.path("soft.exr")).unwrap();
        std::fs::hard_link(place.path("in.exr"), place.path("hard.exr")).unwrap();
        symlink("real", place.path("folder")).unwrap();
        symlink("scene.toml", place.path("soft.exr.json")).unwrap();
    }
    place
}

/// What an input holds, by name.
fn inputs(place: &Workplace) -> Vec<Vec<u8>> {
    ["in.exr", "scene.toml", "spot.csv", "lens.toml", "lights.toml"].map(|name| bytes(&place.path(name))).into()
}

#[test]
fn no_result_replaces_an_input_or_another_even_by_force() {
    let place = place();
    let (before, files) = (inputs(&place), place.files());
    for (options, words) in [
        (&["-o", "o.exr", "--report", "in.exr"][..], &["--report", "in.exr"][..]),
        (&["-o", "o.exr", "--glare", "in.exr"], &["--glare", "in.exr"]),
        (&["--glare", "./in.exr"], &["--glare", "in.exr"]),
        (&["-o", "o.exr", "--report", "real/../in.exr"], &["--report", "in.exr"]),
        (&["-o", "o.exr", "--report", "scene.toml", "--scene", "scene.toml"], &["--report", "scene.toml"]),
        (&["-o", "o.exr", "--report", "spot.csv", "--scene", "scene.toml"], &["--report", "spot.csv"]),
        (&["-o", "o.exr", "--report", "./lens.toml", "--lens", "lens.toml"], &["--report", "lens.toml"]),
        (&["-o", "o.exr", "--report", "lights.toml", "--lights", "lights.toml"], &["--report", "lights.toml"]),
        (&["-o", "o.exr", "--report", "lights.toml", "--add-lights", "lights.toml"], &["--report", "lights.toml"]),
        (&["-o", "same.exr", "--glare", "./same.exr"], &["each", "same.exr"]),
        (&["-o", "same.exr", "--glare", "real/../same.exr"], &["each", "same.exr"]),
        (&["--report", "same.exr", "--glare", "same.exr"], &["each", "same.exr"]),
        (&["-o", "in.exr", "--glare", "in.exr"], &["each", "in.exr"]),
    ] {
        let all = [&["apply", "in.exr", "--force"], options].concat();
        place.vglare(&all).failed(2, words);
        assert_eq!(place.files(), files, "{options:?}");
        assert!(inputs(&place) == before, "{options:?} changed an input");
    }
    // A photo is replaced by its own picture where that is asked for.
    place.vglare(&["apply", "in.exr", "-o", "in.exr"]).failed(1, &["in.exr", "--force"]);
    place.vglare(&["apply", "in.exr", "-o", "./in.exr", "--force"]).succeeded();
    assert!(inputs(&place)[0] != before[0]);
}

#[test]
#[cfg(unix)]
fn links_do_not_hide_which_file_is_which() {
    let place = place();
    let before = inputs(&place);
    for (options, words) in [
        (&["-o", "o.exr", "--report", "soft.exr"][..], &["--report", "in.exr"][..]),
        (&["-o", "o.exr", "--report", "hard.exr"], &["--report", "in.exr"]),
        (&["-o", "o.exr", "--glare", "hard.exr"], &["--glare", "in.exr"]),
        (&["-o", "o.exr", "--report", "soft.exr.json", "--scene", "scene.toml"], &["--report", "scene.toml"]),
        (&["-o", "real/a.exr", "--glare", "folder/a.exr"], &["each", "a.exr"]),
        (&["-o", "/dev/fd/1", "--report", "/dev/stdout"], &["each"]),
    ] {
        let all = [&["apply", "in.exr", "--force"], options].concat();
        place.vglare(&all).failed(2, words);
        assert!(inputs(&place) == before, "{options:?} changed an input");
    }
}

#[test]
fn in_a_sequence_neither() {
    let place = place();
    place.photo("two.1.exr");
    place.photo("two.2.exr");
    let before = inputs(&place);
    for (options, words) in [
        (&["-o", "real/", "--report", "scene.toml", "--scene", "scene.toml"][..], &["--report", "scene.toml"][..]),
        (&["-o", "real/", "--glare", "two.%d.exr"], &["--glare", "two.1.exr"]),
        (&["--glare", "{name}.exr"], &["--glare", "two.1.exr"]),
        (&["-o", "real/", "--report", "real/../two.2.exr"], &["--report", "two.2.exr"]),
    ] {
        let all = [&["apply", "two.1.exr", "two.2.exr", "--force"], options].concat();
        place.vglare(&all).failed(2, words);
        assert!(inputs(&place) == before, "{options:?} changed an input");
    }
}

#[test]
fn other_commands_do_not_replace_what_they_read_either() {
    let place = place();
    let photo = bytes(&place.path("in.exr"));
    std::fs::copy(place.path("in.exr"), place.path("photo.json")).unwrap();
    let twice = ["harmonics", "in.exr", "-o", "o.exr", "--coefficients", "./o.exr", "--force"];
    place.vglare(&twice).failed(2, &["each", "o.exr"]);
    let over = ["harmonics", "photo.json", "-o", "o.exr", "--coefficients", "real/../photo.json", "--force"];
    place.vglare(&over).failed(2, &["--coefficients", "photo.json"]);
    place.vglare(&["bench", "--quick", "--csv", "b.csv", "--json", "./b.csv"]).failed(2, &["each", "b.csv"]);
    std::fs::create_dir_all(place.path("trade/pictures")).unwrap();
    std::fs::rename(place.path("in.exr"), place.path("trade/pictures/exact.png")).unwrap();
    let trade = ["tradeoff", "trade/pictures/exact.png", "-o", "trade", "--quick", "--force"];
    place.vglare(&trade).failed(2, &["trade", "exact.png"]);
    assert!(bytes(&place.path("trade/pictures/exact.png")) == photo);
}

#[test]
#[cfg(unix)]
fn a_report_follows_links_and_keeps_permissions_as_pictures_do() {
    use std::os::unix::fs::{PermissionsExt, symlink};
    let place = Workplace::new();
    place.photo("in.exr");
    for (real, link) in [("r.json", "link.json"), ("o.exr", "link.exr")] {
        std::fs::set_permissions(place.text(real, "old"), PermissionsExt::from_mode(0o600)).unwrap();
        symlink(real, place.path(link)).unwrap();
    }
    symlink("new.json", place.path("to-be.json")).unwrap();
    let run = |report: &str| place.vglare(&["apply", "in.exr", "-o", "link.exr", "--report", report, "--force"]);
    run("link.json").succeeded();
    for (real, link) in [("r.json", "link.json"), ("o.exr", "link.exr")] {
        assert!(std::fs::symlink_metadata(place.path(link)).unwrap().is_symlink(), "{link} stays a link");
        assert_eq!(std::fs::metadata(place.path(real)).unwrap().permissions().mode() & 0o777, 0o600, "{real}");
    }
    assert_eq!(place.read_json("r.json")["input"]["file"], "in.exr");
    run("to-be.json").succeeded();
    assert_eq!(place.read_json("new.json")["input"]["file"], "in.exr", "it is made where the link leads");
    assert!(!place.files().iter().any(|name| name.starts_with(".vglare")), "{:?}", place.files());
}

/// A report goes to standard output without being forced to, be that a pipe or a file, before the summary.
#[test]
#[cfg(unix)]
fn a_report_can_be_printed() {
    let place = Workplace::new();
    place.photo("in.exr");
    let args = ["apply", "in.exr", "-o", "out.exr", "--report", "/dev/stdout", "--force"];
    let piped = place.vglare(&args).succeeded().stdout();
    let file = std::fs::File::create(place.path("said")).unwrap();
    assert!(place.command(&args).stdout(file).status().unwrap().success());
    let filed = std::fs::read_to_string(place.path("said")).unwrap();
    for said in [piped, filed] {
        let (report, summary) = said.split_once("\n}\n").expect("both are there");
        let report: serde_json::Value = serde_json::from_str(&format!("{report}\n}}")).expect("JSON");
        assert_eq!(report["input"]["file"], "in.exr");
        assert!(summary.contains("wrote    out.exr"), "{summary}");
    }
}

#[test]
fn the_glare_can_be_had_alone() {
    let place = Workplace::new();
    place.photo("in.exr");
    place.vglare(&["apply", "in.exr", "-o", "out.exr", "--glare", "beside.exr"]).succeeded();
    let before = place.files();
    let ran = place.vglare(&["apply", "in.exr", "--glare", "alone.exr", "--report", "r.json"]).succeeded();
    assert!(ran.stdout().contains("wrote    alone.exr in"), "{}", ran.stdout());
    assert!(bytes(&place.path("beside.exr")) == bytes(&place.path("alone.exr")));
    assert_eq!(place.files().len(), before.len() + 2);
    let report = place.read_json("r.json");
    assert_eq!((&report["output"], &report["glare"]), (&serde_json::Value::Null, &"alone.exr".into()));
    let passes = report["passes"].as_array().expect("passes");
    assert!(report["cost"]["measured_ms"].as_f64() > Some(0.0) && !passes.iter().any(|pass| pass["pass"] == "upload"));

    place.vglare(&["apply", "in.exr", "--report", "only.json"]).succeeded();
    assert_eq!(place.read_json("only.json")["error"]["asked"], 1e-3);
    place.vglare(&["apply", "in.exr"]).failed(2, &["--output"]);
    std::fs::copy(place.path("in.exr"), place.path("in.2.exr")).unwrap();
    let ran = place.vglare(&["apply", "in.exr", "in.2.exr", "--glare", "light/{name}.exr"]).succeeded();
    assert!(ran.stdout().contains("2 of 2 pictures into light"), "{}", ran.stdout());
    assert!(bytes(&place.path("light/in.exr")) == bytes(&place.path("alone.exr")));
}

#[test]
fn the_glare_is_float_unless_another_depth_is_asked_for() {
    let place = Workplace::new();
    place.write("in.exr", &night());
    let glare = |more: &[&str]| {
        let all = [&["apply", "in.exr", "--glare", "g.exr", "--force"], more].concat();
        place.vglare(&all).succeeded();
        let picture = photo::read(&place.path("g.exr")).unwrap();
        (picture.depth_name(), picture.pixels)
    };
    let (float, exact) = glare(&[]);
    let (half, rounded) = glare(&["--depth", "half"]);
    assert_eq!((float, half), ("float", "half float"));
    for (exact, rounded) in exact.as_flattened().iter().zip(rounded.as_flattened()) {
        // Half a unit in the last of eleven places, or of the smallest there is.
        assert!((exact - rounded).abs() <= (exact.abs() * 2f32.powi(-11)).max(2f32.powi(-25)), "{exact} {rounded}");
    }
    // A depth that only the picture's format has is the picture's.
    assert_eq!(glare(&["-o", "o.png", "--depth", "16"]).0, "float");
    place.vglare(&["apply", "in.exr", "--glare", "g.exr", "--depth", "16", "--force"]).failed(1, &["16 bit"]);
}
