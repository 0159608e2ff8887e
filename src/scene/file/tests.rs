use super::*;
use crate::choices::{Beyond, Evaluator, LengthUnit, LightBy, LightShape, Mix, Normalize, Sources};
use crate::scene::{Goal, Recover};
use crate::series::Bell;

/// A file in a folder of its own; both are gone when it is dropped.
fn file(name: &str, content: impl AsRef<[u8]>) -> (tempfile::TempDir, std::path::PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    fs::write(&path, content).unwrap();
    (folder, path)
}

/// The reason why `content` is refused as a scene, after a check that the error names the file.
fn refused(content: impl AsRef<[u8]>) -> String {
    let (_folder, path) = file("bad.toml", content);
    match read_scene(&path) {
        Err(Error::SceneFile { path: named, reason }) if named == path => reason,
        other => panic!("{other:?}"),
    }
}

fn assert_refused(content: &str, expected: &[&str]) {
    let reason = refused(content);
    for part in expected {
        assert!(reason.contains(part), "{part:?} is not in:\n{reason}");
    }
}

const FULL: &str = r#"
period = [4.0, 3]
degree = [32, 24]
[[light]]
position = [0.3, -2]
flux = [12, 10.0, 8.0]
[[light]]
position = [0, 0]
flux = [0, 0, 0]
size = 1
[[ghost]]
bell = "gaussian"
center = [0.25, -0.5]
size = [0.2, 1]
radiance = [1.0, -0.8, 0]
[[lens_ghost]]
along = -0.7
size = 0.15
tint = [1.0, 0.9, 0.7]
share = 0.01
[[lens_ghost]]
along = 1
size = 2
share = 1
"#;

#[test]
fn a_full_scene_is_read_with_whole_numbers_and_defaults() {
    let (_folder, path) = file("full.toml", FULL);
    let scene = read_scene(&path).unwrap();
    assert_eq!((scene.period, scene.degree), (Some(DVec2::new(4.0, 3.0)), Some([32, 24])));
    let lights = scene.lights.unwrap();
    let first = Light { position: DVec2::new(0.3, -2.0), flux: [12.0, 10.0, 8.0], size: 0.0, muted: false };
    assert_eq!((lights[0], lights[1].size), (first, 1.0));
    let (bell, size) = (Bell::Gaussian, DVec2::new(0.2, 1.0));
    let ghost = Ghost { bell: bell.clone(), center: DVec2::new(0.25, -0.5), size, radiance: [1.0, -0.8, 0.0] };
    assert_eq!(scene.ghosts, [ghost]);
    let size = DVec2::splat(0.15);
    assert_eq!(scene.lens_ghosts[0], LensGhost { bell, along: -0.7, size, tint: [1.0, 0.9, 0.7], share: 0.01 });
    assert_eq!((scene.lens_ghosts[1].tint, scene.lens_ghosts[1].size), ([1.0; 3], DVec2::splat(2.0)));
}

#[test]
fn an_empty_file_is_an_empty_scene() {
    for (text, version) in [("", Version::One), ("version = 1", Version::One), ("version = 2\n", Version::Two)] {
        let (_folder, path) = file("empty.toml", text);
        assert_eq!(read_scene(&path).unwrap(), SceneFile { version, ..SceneFile::default() });
    }
}

#[test]
fn versions_that_there_are_not_are_refused_in_their_line() {
    for bad in ["0", "-1", "\"2\"", "2.0", "true"] {
        assert_refused(&format!("\nversion = {bad}"), &["line 2, column 11", "expected version 1 or 2, found", bad]);
    }
    let later = ["line 3, column 11", "of version 3", "knows versions 1 and 2", "a newer one", "in `version`"];
    assert_refused("# a look\n\nversion = 3\n[dust]\nspecks = 7\n", &later);
    // A preset of another version is called by its name.
    for (text, preset) in [
        ("preset = \"zoom\"", "v1/zoom"),
        ("preset = \"v1/zoom\"", "v1/zoom"),
        ("version = 2\npreset = \"zoom\"", "zoom"),
        ("version = 2\npreset = \"v1/zoom\"", "v1/zoom"),
        ("preset = \"none\"", "none"),
    ] {
        let (_folder, path) = file("look.toml", text);
        assert_eq!(read_scene(&path).unwrap().preset.as_deref(), Some(preset), "{text}");
    }
    assert_refused("version = 2\npreset = \"v2/zoom\"", &["line 2, column 10", "v2/zoom", "v1/NAME"]);
}

#[test]
fn numbers_that_a_key_does_not_take_are_shown_in_their_line() {
    let ghost = |size: &str| format!("[[ghost]]\ncenter = [0, 0]\nsize = {size}\nradiance = [1, 1, 1]\n");
    for bad in ["0", "-1", "0.0", "nan", "inf", "-inf", "1e99", "[0.1, 0]", "[nan, 1]"] {
        assert_refused(&ghost(bad), &["line 3, column ", "ghost.size", "positive finite number", "3 | size = "]);
    }
    for bad in ["\"wide\"", "true", "[1]", "[1, 2, 3]", "[]", "{ x = 1 }"] {
        assert_refused(&ghost(bad), &["line 3, column ", "ghost.size", "a positive size or two, [x, y]"]);
    }
    let light = |flux: &str| format!("# lamps\n\n[[light]]\nposition = [0, 0]\nflux = {flux}\n");
    for bad in ["[1, -1, 1]", "[1, nan, 1]", "[1, 1, inf]"] {
        assert_refused(&light(bad), &["line 5, column ", "light.flux", "finite number that is not negative"]);
    }
    assert_refused(&light("[1, 1]"), &["line 5, column 8", "an array of length 3"]);
    assert_refused(&light("[\n  1,\n  \"a\",\n  1,\n]"), &["line 7, column 3", "not negative", "7 |   \"a\""]);
    assert_refused("[[light]]\nposition = [nan, 0]\nflux = [1, 1, 1]", &["line 2, column 13", "a finite number"]);
    assert_refused("period = [4, 0]", &["line 1, column 14", "a positive finite number", "period"]);
    assert_refused("[[lens_ghost]]\nalong = 1\nsize = 1\nshare = -0.1", &["line 4, column 9", "lens_ghost.share"]);
}

#[test]
fn the_mark_is_below_the_number() {
    let reason = refused("[[ghost]]\ncenter = [0, 0]\nradiance = [1, 1, 1]\n\tsize = -25 # é");
    let expected = "line 4, column 9: expected a positive finite number, found -25 in `ghost.size`\n  \
                    4 |  size = -25 # é\n    |         ^^^";
    assert_eq!(reason, expected);
}

#[test]
fn degrees_are_whole_numbers_up_to_4096() {
    for bad in ["[1, 4097]", "[-3, 1]", "[1.5, 1]", "[1, 99999999999]", "[1, \"2\"]"] {
        assert_refused(&format!("\ndegree = {bad}"), &["line 2, column ", "a whole number from 0 to 4096", "degree"]);
    }
    let (_folder, path) = file("degree.toml", "degree = [0, 4096]");
    assert_eq!(read_scene(&path).unwrap().degree, Some([0, 4096]));
}

#[test]
fn unknown_and_missing_keys_are_named() {
    let light = "[[light]]\nposition = [0, 0]\nflux = [1, 1, 1]\n";
    assert_refused(&format!("{light}colour = [1, 1, 1]"), &["line 4, column 1", "colour", "position", "flux", "size"]);
    assert_refused("[[lights]]\nposition = [0, 0]", &["line 1, column 3", "lights", "light", "lens_ghost"]);
    assert_refused("\n[[light]]\nposition = [0, 0]", &["line 2", "missing field `flux`"]);
    assert_refused(
        "[[ghost]]\nsize = 1\ncenter = [0, 0]\nradiance = [0, 0, 0]\n\n[[ghost]]\nsize = 1\ncenter = [0, 0]\n",
        &["line 6", "missing field `radiance`"],
    );
    assert_refused(
        "[[ghost]]\nbell = \"square\"\ncenter = [0, 0]\nsize = 1\nradiance = [1, 1, 1]",
        &["line 2, column 8", "square", "gaussian"],
    );
    assert_refused("light = 3", &["line 1, column 9", "light"]);
    assert_refused("[light]\nposition = [0, 0]", &["line 1", "light"]);
}

#[test]
fn what_is_no_toml_is_shown_in_its_line() {
    assert_refused("period = [4, 3]\ndegree = [1, 2\n", &["line 2, column 15", "unclosed array"]);
    assert_refused("period = [4, 3]\nperiod = [4, 3]", &["line 2, column 1", "duplicate key"]);
    assert_refused("\n\nlight light", &["line 3, column 7"]);
    assert_refused("{\"lights\": []}", &["line 1, column 1"]);
    let reason = refused(b"# ok\nperiod = [1, 2]\n# caf\xe9\n");
    assert_eq!(reason, "line 3: this is not UTF-8 text");
    let long = format!("period = [{}, -1]", "0".repeat(5000));
    assert!(refused(&long).len() < 300);
}

#[test]
fn files_that_cannot_be_read_say_why() {
    let folder = tempfile::tempdir().unwrap();
    for path in [folder.path().to_owned(), folder.path().join("missing.toml")] {
        for error in [read_scene(&path).unwrap_err(), read_lights(&path).unwrap_err(), read_lens(&path).unwrap_err()] {
            let message = error.to_string();
            assert!(message.contains("cannot be read: ") && message.starts_with(path.to_str().unwrap()), "{message}");
        }
    }
}

#[test]
fn lights_are_read_from_toml_and_json() {
    let expected = [Light { position: DVec2::new(0.5, -0.25), flux: [1.0, 2.0, 3.0], size: 0.0, muted: false }];
    let toml = "[[light]]\nposition = [0.5, -0.25]\nflux = [1, 2, 3]\n";
    let json = "\u{feff} {\n \"threshold\": 2, \"lights\": [{\"position\": [0.5, -0.25], \"flux\": [1, 2, 3]}]}";
    for (name, content) in [("a.toml", toml), ("b.json", json), ("no-extension", json)] {
        let (_folder, path) = file(name, content);
        assert_eq!(read_lights(&path).unwrap(), expected, "{name}");
    }
    let (_folder, path) = file("none.json", "{\"lights\": []}");
    assert_eq!(read_lights(&path).unwrap(), []);
}

#[test]
fn errors_in_json_have_a_line_too() {
    let flux =
        |flux: &str| format!("{{\n  \"lights\": [\n    {{\"position\": [0, 0],\n     \"flux\": {flux}}}\n  ]\n}}");
    let cases = [
        (flux("[1, -2, 3]"), "line 4", "not negative, found -2"),
        (flux("[1, 2]"), "line 4", "an array of length 3"),
        (flux("[1, 2, \"é\"]"), "line 4", "not negative"),
        (flux("[1, 2, 3], \"colour\": 1"), "line 4", "unknown field `colour`"),
        ("{\n\"light\": []\n}".to_owned(), "line 3", "missing field `lights`"),
        ("{\n\"lights\": [".to_owned(), "line 2", "EOF"),
        ("{".to_owned(), "line 1", "EOF"),
    ];
    for (content, line, what) in cases {
        let (_folder, path) = file("bad.json", &content);
        let message = read_lights(&path).unwrap_err().to_string();
        assert!(message.contains(line) && message.contains(what), "{content}\n{message}");
    }
}

#[test]
fn a_lens_is_called_like_its_file_and_has_ghosts() {
    let preset = crate::scene::presets::all()[0];
    let (_folder, path) = file("my lens.v2.toml", preset.toml);
    let lens = read_lens(&path).unwrap();
    assert_eq!((lens.name.as_str(), &lens.ghosts), ("my lens.v2", &preset.lens().unwrap().ghosts));
    for (content, what) in [("lens_ghost = []", "no ghosts"), ("", "lens_ghost"), ("[[light]]", "light")] {
        let (_folder, path) = file("empty.toml", content);
        let message = read_lens(&path).unwrap_err().to_string();
        assert!(message.contains(what), "{message}");
    }
}

#[test]
fn every_bell_has_a_name_in_files() {
    let (_folder, path) = file(
        "bells.toml",
        r#"
period = [4.0, 3.0]
[[profile]]
name = "spot"
rows = [[0, 2], [0.5, 1], [1, 0]]
[[ghost]]
bell = "cosine-squared"
center = [0, 0]
size = 1
radiance = [1, 1, 1]
[[ghost]]
bell = "parabola"
center = [0, 0]
size = 1
radiance = [1, 1, 1]
[[ghost]]
bell = "paraboloid"
center = [0, 0]
size = 1
radiance = [1, 1, 1]
[[ghost]]
bell = "von-mises"
center = [0, 0]
size = 1
radiance = [1, 1, 1]
[[ghost]]
bell = "sine-gaussian"
mean = 0.25
center = [0, 0]
size = 1
radiance = [1, 1, 1]
[[ghost]]
bell = "disc"
center = [0, 0]
size = 1
radiance = [1, 1, 1]
[[ghost]]
bell = "disc"
rim = 0
blades = 6
rotation = 15
center = [0, 0]
size = 1
radiance = [1, 1, 1]
[[lens_ghost]]
bell = "profile"
profile = "spot"
along = 1
size = 0.5
share = 0.1
"#,
    );
    let scene = read_scene(&path).unwrap();
    let names: Vec<_> = scene.ghosts.iter().map(|ghost| ghost.bell.to_string()).collect();
    assert_eq!(names, ["cosine-squared", "parabola", "paraboloid", "von-mises", "sine-gaussian", "disc", "disc"]);
    let disc = |index: usize| match &scene.ghosts[index].bell {
        Bell::Disc(disc) => (disc.rim(), disc.blades(), disc.rotation()),
        other => panic!("{other:?}"),
    };
    assert_eq!([disc(5), disc(6)], [(0.1, 0, 0.0), (0.0, 6, 15.0)]);
    let Bell::SineGaussian(bell) = &scene.ghosts[4].bell else { panic!("{:?}", scene.ghosts[4].bell) };
    assert_eq!((bell.mean, bell.period), (0.25, DVec2::new(4.0, 3.0)));
    let shape = scene.lens_ghosts[0].bell.shape();
    // The values are divided by the largest, and linear in r² between the rows.
    let half_way = DVec2::new(0.5f64.sqrt() * 0.5, 0.0);
    assert_eq!(shape.value(DVec2::ZERO, DVec2::ONE), 1.0);
    assert!((shape.value(half_way, DVec2::ONE) - 0.75).abs() < 1e-12);
}

#[test]
fn a_profile_may_stand_in_a_csv_file_beside() {
    let (folder, path) = file("lens.toml", CSV_LENS);
    fs::write(folder.path().join("spot.csv"), "# measured\nradius, value\n0.1, 4\n0.2, 1\n").unwrap();
    let lens = read_lens(&path).unwrap();
    let shape = lens.ghosts[0].bell.shape();
    assert_eq!(shape.value(DVec2::new(0.05, 0.0), DVec2::ONE), 1.0);
    assert_eq!(shape.value(DVec2::new(0.0, 0.2), DVec2::ONE), 0.25);
    assert_eq!(shape.value(DVec2::new(0.0, 0.201), DVec2::ONE), 0.0);
    for (rows, expected) in [
        ("0, 1\nx, 2\n", "has no two numbers in line 2"),
        ("0, 1\n", "this one has 1"),
        ("0, 1\n1, 0.5\n1, 0\n", "do not ascend at row 3"),
        ("0, 1\n1, nan\n", "row 2"),
        ("0, 0\n1, 0\n", "zero everywhere"),
        ("0, -1\n1, 0\n", "not positive"),
    ] {
        fs::write(folder.path().join("spot.csv"), rows).unwrap();
        let reason = read_lens(&path).unwrap_err().to_string();
        assert!(reason.contains(expected) && reason.contains("line "), "{expected:?} is not in {reason}");
    }
    fs::remove_file(folder.path().join("spot.csv")).unwrap();
    let reason = read_lens(&path).unwrap_err().to_string();
    assert!(reason.contains("spot.csv cannot be read"), "{reason}");
}

#[test]
fn only_regular_files_that_are_not_too_long_are_read() {
    let (folder, path) = file("lens.toml", "");
    let refused = |read: &dyn Fn() -> Error, expected: &str| {
        let reason = read().to_string();
        assert!(reason.contains(expected), "{expected:?} is not in {reason}");
    };
    for device in ["/dev/zero", "/dev/stdin"] {
        fs::write(&path, CSV_LENS.replace("spot.csv", device)).unwrap();
        refused(&|| read_lens(&path).unwrap_err(), "is a pipe or a device, and vglare reads regular files only");
    }
    let pipe = folder.path().join("pipe.toml");
    if std::process::Command::new("mkfifo").arg(&pipe).status().is_ok_and(|status| status.success()) {
        refused(&|| read_lights(&pipe).unwrap_err(), "pipe.toml: cannot be read: it is a pipe or a device");
        refused(&|| read_scene(&pipe).unwrap_err(), "pipe.toml: cannot be read: it is a pipe or a device");
    }
    refused(&|| read_scene(folder.path()).unwrap_err(), "is a folder");
    let comment = |bytes: usize| {
        fs::write(&path, format!("#{}\n[[light]]\nposition = [0, 0]\nflux = [1, 1, 1]", " ".repeat(bytes)))
    };
    comment(32 << 20).unwrap();
    refused(&|| read_lights(&path).unwrap_err(), "is larger than 32 MiB");
    comment((32 << 20) - 100).unwrap();
    let link = folder.path().join("link.toml");
    #[cfg(unix)]
    std::os::unix::fs::symlink(&path, &link).unwrap();
    assert_eq!(read_lights(if cfg!(unix) { &link } else { &path }).unwrap().len(), 1);
}

const CSV_LENS: &str = r#"
[[profile]]
name = "spot"
file = "spot.csv"
[[lens_ghost]]
bell = "profile"
profile = "spot"
along = 1
size = 1
share = 0.1
"#;

#[test]
fn bells_that_cannot_be_had_are_refused_in_their_line() {
    let ghost = |bell: &str| format!("[[ghost]]\n{bell}\ncenter = [0, 0]\nsize = 1\nradiance = [1, 1, 1]");
    let refusals: [(&str, &[&str]); 17] = [
        ("bell = \"von-mises\"", &["line 2, column 8", "a von-mises bell is periodic", "`period`"]),
        ("bell = \"sine-gaussian\"", &["line 2, column 8", "a sine-gaussian bell is periodic"]),
        ("bell = \"profile\"", &["line 2, column 8", "needs `profile`"]),
        ("bell = \"profile\"\nprofile = \"x\"", &["line 3, column 11", "no [[profile]] called \"x\""]),
        ("profile = \"x\"", &["line 2, column 11", "belongs to"]),
        ("bell = \"parabola\"\nmean = 0.5", &["line 3, column 8", "belongs to"]),
        ("bell = \"sine-gaussian\"\nmean = 1.5", &["line 3, column 8", "from -1 to 1"]),
        ("bell = \"sine-gaussian\"\nmean = inf", &["line 3, column 8", "finite"]),
        ("rim = 0.5", &["line 2, column 7", "`rim` belongs to a bell = \"disc\""]),
        ("bell = \"gaussian\"\nblades = 6", &["line 3, column 10", "`blades` belongs to"]),
        ("bell = \"profile\"\nprofile = \"x\"\nrotation = 6", &["line 4, column 12", "`rotation` belongs to"]),
        ("bell = \"disc\"\nrim = 2.1", &["line 3, column 7", "from 1e-6 to 2 sizes wide, and not 2.1"]),
        ("bell = \"disc\"\nrim = -0.1", &["line 3, column 7", "and not -0.1"]),
        (
            "bell = \"disc\"\nblades = 2",
            &["line 3, column 10", "from 3 to 16 blades, or 0 where it is round, and not 2"],
        ),
        ("bell = \"disc\"\nrim = 0.2\nblades = 17", &["line 4, column 10", "and not 17"]),
        ("bell = \"disc\"\nblades = 5.5", &["line 3, column 10", "expected u32"]),
        ("bell = \"disc\"\nrotation = 30", &["line 3, column 12", "a round disc has no rotation"]),
    ];
    for (bell, expected) in refusals {
        assert_refused(&ghost(bell), expected);
    }
    let both = "[[profile]]\nname = \"x\"\nrows = [[0, 1], [1, 0]]\nfile = \"x.csv\"";
    assert_refused(both, &["line 2, column 8", "either `rows` or a `file`"]);
    let twice = "[[profile]]\nname = \"x\"\nrows = [[0, 1], [1, 0]]\n".repeat(2);
    assert_refused(&twice, &["line 5, column 8", "of that name already"]);
}

#[test]
fn a_look_is_read_key_by_key() {
    let (_folder, path) = file(
        "look.toml",
        "preset = \"zoom\"\naxis = [0.1, -2]\nlight = []\n[look]\nstrength = 0\nsize = 2\ntint = [1, 0, 2.5]\n\
         mix = \"energy\"\nnormalize = \"minmax\"\nunit = \"short-side\"\nfov = 40\nsources = \"photo\"\nrecover = 3\n[find]\nthreshold = 20\nmerge = 0\nmax_lights = 3\n\
         by = \"luminance\"\nbeyond = \"drop\"\nshape = \"ball\"\nfirefly_limit = 0\nknee = 0.5\nadd = true\n\
         [accuracy]\nbudget = 20\nallow_floor = true\nevaluator = \"rows\"\n",
    );
    let scene = read_scene(&path).unwrap();
    assert_eq!((scene.preset.as_deref(), scene.axis), (Some("v1/zoom"), Some(DVec2::new(0.1, -2.0))));
    assert_eq!(scene.lights, Some(Vec::new()));
    let look = LookSection {
        strength: Some(0.0),
        size: Some(2.0),
        tint: Some([1.0, 0.0, 2.5]),
        mix: Some(Mix::Energy),
        normalize: Some(Normalize::Minmax),
        unit: Some(LengthUnit::ShortSide),
        fov: Some(40.0),
        sources: Some(Sources::Photo),
        recover: Some(Recover::Stops(3.0)),
    };
    assert_eq!(scene.look, look);
    let find = FindSection {
        by: Some(LightBy::Luminance),
        shape: Some(LightShape::Ball),
        beyond: Some(Beyond::Drop),
        threshold: Some(20.0),
        merge: Some(0.0),
        max_lights: Some(3),
        firefly_limit: Some(0.0),
        knee: Some(0.5),
        add: true,
    };
    assert_eq!(scene.find, find);
    let (goal, evaluator) = (Some(Goal::Budget(20.0)), Some(Evaluator::Rows));
    assert_eq!(scene.accuracy, AccuracySection { goal, allow_floor: true, each_pixel: false, evaluator });
}

#[test]
fn a_look_that_makes_no_sense_is_shown_in_its_line() {
    let refusals: [(&str, &[&str]); 21] = [
        ("[find]\nfirefly_limit = 0.5", &["line 2, column 17", "0, or a finite number of at least 1, found 0.5"]),
        ("[look]\nstrength = -1", &["line 2, column 12", "not negative, found -1", "look.strength"]),
        ("[look]\nsize = 0", &["line 2, column 8", "a positive finite number, found 0"]),
        ("[look]\ntint = [1, 1]", &["line 2, column 8", "an array of length 3"]),
        ("[look]\ntint = [1, -1, 1]", &["line 2, column 12", "not negative, found -1"]),
        ("[look]\nmix = \"subtract\"", &["line 2, column 7", "subtract", "energy"]),
        ("[look]\nnormalize = 1", &["line 2, column 13"]),
        ("[look]\nglow = 1", &["line 2, column 1", "unknown field `glow`", "strength"]),
        ("[find]\nthreshold = nan", &["line 2, column 13", "not negative"]),
        ("[find]\nmerge = -0.1", &["line 2, column 9", "not negative"]),
        ("[find]\nmax_lights = -1", &["line 2, column 14", "-1"]),
        ("[find]\nlights = 3", &["line 2, column 1", "unknown field `lights`", "max_lights"]),
        ("[accuracy]\ntolerance = 1", &["line 2, column 13", "a number between 0 and 1, found 1"]),
        ("[accuracy]\nbudget = 0", &["line 2, column 10", "a positive finite number"]),
        ("[accuracy]\ntolerance = 0.1\nbudget = 5", &["line 3, column 10", "either `tolerance` or `budget`"]),
        ("[accuracy]\nevaluator = \"fast\"", &["line 2, column 13", "fast", "direct"]),
        ("[accuracy]\ndegree = 3", &["line 2, column 1", "unknown field `degree`"]),
        ("\npreset = \"fish-eye\"", &["line 2, column 10", "no lens preset is called \"fish-eye\"", "zoom"]),
        (
            "preset = \"zoom\"\n[[lens_ghost]]\nalong = 1\nsize = 1\nshare = 1",
            &["line 1, column 10", "either `preset` or [[lens_ghost]]"],
        ),
        ("axis = [0, nan]", &["line 1, column 12", "a finite number"]),
        ("[[light]]\nposition = [0, 0]\nflux = [1, 1, 1]\nmuted = 1", &["line 4, column 9", "boolean"]),
    ];
    for (content, expected) in refusals {
        assert_refused(content, expected);
    }
}
