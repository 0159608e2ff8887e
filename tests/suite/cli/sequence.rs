//! Several photos in one run.

use std::path::Path;

use serde_json::json;
use vglare::photo::Photo;

use super::{Workplace, night};

/// The night scene, brighter from photo to photo and of another size.
fn shot(index: usize) -> Photo {
    let mut photo = night();
    photo.pixels[12 * 96 + 70][0] += 300.0 * index as f32;
    let rows = 64 - 4 * (index % 3);
    photo.pixels.truncate(96 * rows);
    Photo::new(96, rows as u32, photo.pixels)
}

/// A place with `count` photos, `shot.0001.exr` and so on.
fn place(count: usize) -> (Workplace, Vec<String>) {
    let place = Workplace::new();
    let names: Vec<_> = (1..=count).map(|number| format!("shot.{number:04}.exr")).collect();
    for (index, name) in names.iter().enumerate() {
        place.write(name, &shot(index));
    }
    (place, names)
}

/// The arguments for the photos and what follows.
fn apply<'a>(names: &'a [String], more: &[&'a str]) -> Vec<&'a str> {
    let mut args = vec!["apply"];
    args.extend(names.iter().map(String::as_str));
    args.extend(more);
    args
}

/// The files in a folder of the place, by name, without what is kept of those that are done.
fn listed(place: &Workplace, folder: &str) -> Vec<String> {
    let entries = std::fs::read_dir(place.path(folder)).expect("a folder");
    let mut names: Vec<_> = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.retain(|name| name != ".vglare");
    names.sort();
    names
}

fn bytes(path: &Path) -> Vec<u8> {
    std::fs::read(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

#[test]
fn a_sequence_is_what_single_runs_are_bit_for_bit() {
    let (place, names) = place(5);
    let look = ["--mix", "energy", "--preset", "vintage-uncoated"];
    for name in &names {
        let (output, glare) = (format!("one-{name}"), format!("glare-one-{name}"));
        let mut args = vec!["apply", name, "-o", &output, "--glare", &glare];
        args.extend(look);
        place.vglare(&args).succeeded();
    }
    let both = ["-o", "out/", "--glare", "light/g.####.exr"];
    for more in [&["--force"][..], &["--force", "--one-by-one"], &["--force", "--report", "report.json"]] {
        let more: Vec<_> = both.iter().chain(&look).chain(more).copied().collect();
        place.vglare(&apply(&names, &more)).succeeded();
        assert_eq!(listed(&place, "out"), names, "{more:?}");
        for (number, name) in (1..).zip(&names) {
            let single = bytes(&place.path(&format!("one-{name}")));
            assert!(bytes(&place.path(&format!("out/{name}"))) == single, "{name}, {more:?}");
            let single = bytes(&place.path(&format!("glare-one-{name}")));
            assert!(bytes(&place.path(&format!("light/g.{number:04}.exr"))) == single, "glare of {name}, {more:?}");
        }
    }
    let first = |folder: &str| bytes(&place.path(&format!("{folder}/{}", names[0])));
    assert!(first("out") != first("."), "there is glare, or this test could not fail");
}

#[test]
fn without_strength_all_photos_stay_as_they_are() {
    let (place, names) = place(3);
    place.vglare(&apply(&names, &["-o", "out", "--strength", "0"])).succeeded();
    for name in &names {
        // A file says besides how it was made.
        let read = |path: &str| vglare::photo::read(&place.path(path)).unwrap().pixels;
        assert!(read(name) == read(&format!("out/{name}")), "{name}");
    }
}

#[test]
fn patterns_name_the_pictures() {
    let (place, names) = place(2);
    for (pattern, expected) in [
        ("a/v.####.png", ["v.0001.png", "v.0002.png"]),
        ("b/v_%02d.hdr", ["v_01.hdr", "v_02.hdr"]),
        ("c/{name}.jpg", ["shot.0001.jpg", "shot.0002.jpg"]),
        ("d/{name}_%d.tif", ["shot.0001_1.tif", "shot.0002_2.tif"]),
    ] {
        place.vglare(&apply(&names, &["-o", pattern])).succeeded();
        assert_eq!(listed(&place, &pattern[..1]), expected, "{pattern}");
    }
    // A glob may find one photo only.
    place.vglare(&["apply", &names[0], "-o", "e/"]).succeeded();
    place.vglare(&["apply", &names[1], "-o", "e/{name}.exr"]).succeeded();
    assert_eq!(listed(&place, "e"), names);
}

#[test]
fn frames_before_the_first_are_frames_of_their_own() {
    let place = Workplace::new();
    let names = ["n.-001.exr", "n.0001.exr", "take-2.exr"].map(String::from);
    names.iter().enumerate().for_each(|(index, name)| drop(place.write(name, &shot(index))));
    place.vglare(&apply(&names, &["-o", "o/x.####.exr"])).succeeded();
    assert_eq!(listed(&place, "o"), ["x.-001.exr", "x.0001.exr", "x.0002.exr"]);
}

#[test]
fn names_that_do_not_work_are_refused_before_anything_is_read() {
    let (place, mut names) = place(2);
    place.photo("lamp.exr");
    place.text("file", "precious");
    names.push("lamp.exr".into());
    let (all, two) = (&names[..], &names[..2]);
    let before = place.files();
    for (names, options, code, words) in [
        (all, &["-o", "v.####.exr"][..], 2, &["lamp.exr", "number", "v.####.exr"][..]),
        (two, &["-o", "v.exr"], 2, &["v.exr", "folder", "pattern"]),
        (two, &["-o", "take#.exr"], 2, &["take#.exr", "pattern"]),
        (two, &["-o", "o/", "--glare", "g.exr"], 2, &["g.exr", "--glare"]),
        (two, &["-o", "o/", "--glare", "o/"], 2, &["each", "shot.0001.exr"]),
        (two, &["-o", "o_##.exr", "--report", "o_01.exr"], 2, &["each", "o_01.exr"]),
        (two, &["-o", "shot.000%d.exr", "--force", "--report", "shot.0002.exr"], 2, &["each"]),
        (two, &["-o", "{name}.gif"], 1, &["shot.0001.gif", ".exr"]),
        (two, &["-o", "file"], 1, &["file", "folder"]),
        (two, &["-o", "file/"], 1, &["file", "folder"]),
        (two, &["-o", "nowhere/out/"], 1, &["nowhere"]),
        (two, &["-o", "."], 1, &["shot.0001.exr", "--force"]),
        (two, &["-o", "o/", "--report", "file"], 1, &["file", "--force"]),
        (two, &["-o", "o/", "--preset", "no-such-lens"], 2, &["no-such-lens"]),
    ] {
        place.vglare(&apply(names, options)).failed(code, words);
        assert_eq!(place.files(), before, "{options:?}");
    }
    let twice = [names[0].clone(), names[0].clone()];
    place.vglare(&apply(&twice, &["-o", "o/"])).failed(2, &["shot.0001.exr", "both"]);
    std::fs::create_dir(place.path("b")).unwrap();
    std::fs::copy(place.path("lamp.exr"), place.path("b/shot.0001.exr")).unwrap();
    let alike = [names[0].clone(), "b/shot.0001.exr".into()];
    place.vglare(&apply(&alike, &["-o", "o/"])).failed(2, &["shot.0001.exr", "both", "o/shot.0001.exr"]);
    place.vglare(&apply(&alike, &["-o", "b/{name}.exr", "--force"])).failed(2, &["both"]);
    // The output of the one is the photo of the other.
    let [first, second] = ["b/shot.0001.exr".to_owned(), "shot.0002.exr".to_owned()];
    place.vglare(&apply(&[second, first], &["-o", "b/shot.000%d.exr", "--force"])).succeeded();
    std::fs::copy(place.path("lamp.exr"), place.path("b/other1.exr")).unwrap();
    let crossed = ["b/other1.exr".to_owned(), "shot.0001.exr".to_owned()];
    place.vglare(&apply(&crossed[..1], &["-o", "shot.####.exr", "--force"])).succeeded();
    place
        .vglare(&apply(&[crossed[0].clone(), names[0].clone()], &["-o", "shot.####.exr", "--force"]))
        .failed(2, &["both"]);
}

#[test]
fn photos_may_be_replaced_by_force() {
    let (place, names) = place(3);
    let before = bytes(&place.path(&names[1]));
    place.vglare(&apply(&names, &["-o", "{name}.exr"])).failed(1, &["shot.0001.exr", "--force"]);
    place.vglare(&apply(&names, &["-o", ".", "--force"])).succeeded();
    assert!(bytes(&place.path(&names[1])) != before);
    assert_eq!(place.files(), names);
}

#[test]
fn a_file_that_is_there_keeps_all_from_being_written() {
    let (place, names) = place(3);
    std::fs::create_dir(place.path("out")).unwrap();
    place.text("out/shot.0003.exr", "precious");
    place.vglare(&apply(&names, &["-o", "out/", "--keep-going"])).failed(1, &["out/shot.0003.exr", "--force"]);
    assert_eq!(listed(&place, "out"), ["shot.0003.exr"]);
    place.vglare(&apply(&names, &["-o", "out/", "--force"])).succeeded();
    assert_eq!(listed(&place, "out"), names);
}

#[test]
fn a_bad_photo_stops_the_sequence_or_is_left_out() {
    let (place, names) = place(5);
    let whole = bytes(&place.path(&names[2]));
    std::fs::write(place.path(&names[2]), &whole[..whole.len() / 2]).unwrap();
    for more in [&[][..], &["--one-by-one"]] {
        let mut args = apply(&names, &["-o", "out/", "--force", "--report", "report.json"]);
        args.extend(more);
        place.vglare(&args).failed(1, &["shot.0003.exr", "cut short"]);
        // What was before the bad one is there and whole, and nothing of what comes after.
        assert_eq!(listed(&place, "out"), names[..2], "{more:?}");
        let report = place.read_json("report.json");
        assert_eq!(report["frames"].as_array().map(Vec::len), Some(2), "{report}");
        assert_eq!(report["failed"][0]["input"], "shot.0003.exr");

        args.push("--keep-going");
        let ran = place.vglare(&args).failed(1, &["shot.0003.exr", "cut short", "1 of 5"]);
        assert!(ran.stdout().contains("wrote    4 of 5"), "{}", ran.stdout());
        let others: Vec<_> = names.iter().filter(|name| *name != "shot.0003.exr").cloned().collect();
        assert_eq!(listed(&place, "out"), others, "{more:?}");
        let report = place.read_json("report.json");
        assert_eq!(report["summary"]["written"], 4, "{report}");
        assert_eq!(report["summary"]["failed"], 1, "{report}");
        std::fs::remove_dir_all(place.path("out")).unwrap();
    }
}

#[test]
fn an_error_that_knows_no_file_gets_the_photos_name() {
    let (place, names) = place(2);
    place
        .vglare(&apply(&names, &["-o", "out/", "--tolerance", "1e-12"]))
        .failed(3, &["shot.0001.exr: ", "below what can be had here"]);
    let ran = place.vglare(&apply(&names, &["-o", "out/", "--tolerance", "1e-12", "--keep-going"]));
    ran.failed(3, &["shot.0001.exr: ", "shot.0002.exr: ", "2 of 2"]);
    assert_eq!(listed(&place, "out"), [""; 0]);
}

/// The disk is full only for one picture: the errors of the last step are heard by the others.
#[test]
#[cfg(unix)]
fn a_picture_that_cannot_be_written_stops_the_sequence() {
    let (place, names) = place(6);
    std::fs::create_dir(place.path("out")).unwrap();
    std::os::unix::fs::symlink("/dev/full", place.path("out/shot.0002.exr")).unwrap();
    for more in [&["--force"][..], &["--force", "--one-by-one"]] {
        let mut args = apply(&names, &["-o", "out/"]);
        args.extend(more);
        place.vglare(&args).failed(1, &["out/shot.0002.exr"]);
        assert_eq!(listed(&place, "out"), names[..2], "{more:?}");
        std::fs::remove_file(place.path("out/shot.0001.exr")).unwrap();
    }
    let going = apply(&names, &["-o", "out/", "--force", "--keep-going"]);
    place.vglare(&going).failed(1, &["out/shot.0002.exr", "1 of 6"]);
    assert_eq!(listed(&place, "out"), names);
}

#[test]
fn an_output_that_is_a_folder_is_refused() {
    let (place, names) = place(3);
    std::fs::create_dir_all(place.path("out/shot.0002.exr")).unwrap();
    place.vglare(&apply(&names, &["-o", "out/", "--force"])).failed(1, &["out/shot.0002.exr", "folder"]);
    assert_eq!(listed(&place, "out"), names[..2]);
}

#[test]
fn the_report_has_all_photos() {
    let (place, names) = place(4);
    place.vglare(&apply(&names, &["-o", "out/", "--report", "report.json"])).succeeded();
    let report = place.read_json("report.json");
    let frames = report["frames"].as_array().expect("an array");
    assert_eq!(frames.len(), 4);
    for (index, (frame, name)) in frames.iter().zip(&names).enumerate() {
        assert_eq!(frame["input"]["file"], json!(name));
        assert_eq!(frame["input"]["picture"], json!([96, 64 - 4 * (index % 3)]));
        assert_eq!(frame["output"], json!(format!("out/{name}")));
        assert!(frame["error"]["measured"].as_f64() <= frame["error"]["predicted"].as_f64(), "{frame}");
    }
    let worst = frames.iter().filter_map(|frame| frame["error"]["measured"].as_f64()).fold(0.0, f64::max);
    let summary = &report["summary"];
    assert_eq!(summary["worst_error"].as_f64(), Some(worst));
    assert_eq!(
        (&summary["photos"], &summary["written"], &summary["above_tolerance"]),
        (&json!(4), &json!(4), &json!(0))
    );
    // A report of a single photo is what it always was.
    place.vglare(&["apply", &names[0], "-o", "one.exr", "--report", "one.json"]).succeeded();
    assert_eq!(place.read_json("one.json")["input"], frames[0]["input"]);
}

#[test]
fn strict_fails_where_any_photo_is_above_the_tolerance() {
    let (place, names) = place(3);
    let rough = apply(&names, &["-o", "out/", "--degree", "2,2", "--force"]);
    let ran = place.vglare(&rough).succeeded();
    assert!(ran.stderr().contains("warning: shot.0002.exr: "), "{}", ran.stderr());
    assert!(ran.stdout().contains("3 of 3 above what was asked"), "{}", ran.stdout());
    let mut strict = rough.clone();
    strict.push("--strict");
    place.vglare(&strict).failed(3, &["3 of 3", "shot.000", "1.0e-3"]);
    assert_eq!(listed(&place, "out"), names, "they are written all the same");
    place.vglare(&apply(&names, &["-o", "out/", "--force", "--strict"])).succeeded();
}

#[test]
fn each_photo_has_a_line_where_more_is_to_be_said_and_none_where_nothing_is() {
    let (place, names) = place(3);
    let said = place.vglare(&apply(&names, &["-o", "out/", "-v", "--sources", "lights"])).succeeded().stdout();
    let lines: Vec<_> = said.lines().filter(|line| line.starts_with("photo ")).collect();
    assert_eq!(lines.len(), 3, "{said}");
    for (line, name) in lines.iter().zip(&names) {
        assert!(line.contains(&format!("out/{name}")) && line.contains("2 lights") && line.contains("error"), "{line}");
    }
    let said = place.vglare(&apply(&names, &["-o", "out/", "-v", "--force"])).succeeded().stdout();
    assert!(said.lines().any(|line| line.starts_with("photo ") && line.contains("ghosts of each pixel")), "{said}");
    let said = place.vglare(&apply(&names, &["-o", "out/", "--force"])).succeeded().stdout();
    assert!(said.contains("wrote    3 of 3 pictures into out in"), "{said}");
    let ran = place.vglare(&apply(&names, &["-o", "out/", "--force", "-q"])).succeeded();
    assert_eq!((ran.stdout(), ran.stderr()), (String::new(), String::new()));
}

/// Killed in the middle, it leaves whole pictures only.
#[test]
#[cfg(unix)]
fn a_run_that_is_killed_leaves_nothing_half_written() {
    let (place, names) = place(40);
    let mut run = place.command(&apply(&names, &["-o", "out/"])).spawn().expect("the program runs");
    let pictures = || listed(&place, "out").into_iter().filter(|name| !name.starts_with('.')).collect::<Vec<_>>();
    while !place.path("out").is_dir() || pictures().len() < 3 {
        assert!(run.try_wait().unwrap().is_none(), "it runs long enough to be killed");
        std::thread::yield_now();
    }
    run.kill().expect("it can be killed");
    run.wait().expect("it ends");
    for name in pictures() {
        vglare::photo::read(&place.path(&format!("out/{name}"))).unwrap_or_else(|error| panic!("{error}"));
    }
}
