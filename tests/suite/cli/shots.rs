//! Shots: frames by their numbers, runs that go on where others ended, and jobs for farms.

use std::time::SystemTime;

use vglare::photo::Photo;

use super::{Workplace, night};

/// Frames `in/s.0001.exr` and so on, small ones, brighter from frame to frame.
fn place(numbers: &[i64]) -> Workplace {
    let place = Workplace::new();
    std::fs::create_dir(place.path("in")).unwrap();
    for &number in numbers {
        place.write(&format!("in/s.{number:04}.exr"), &frame(number));
    }
    place
}

fn frame(number: i64) -> Photo {
    let mut photo = night();
    photo.pixels[12 * 96 + 70][0] += 30.0 * number as f32;
    photo
}

const SHOT: [&str; 5] = ["apply", "in/s.####.exr", "-o", "out/s.####.exr", "--strength=2"];

fn with<'a>(more: &[&'a str]) -> Vec<&'a str> {
    [&SHOT[..], more].concat()
}

/// The pictures in `out`, each with the time of its last change.
fn pictures(place: &Workplace) -> Vec<(String, SystemTime)> {
    let Ok(entries) = std::fs::read_dir(place.path("out")) else { return Vec::new() };
    let entries = entries.map(Result::unwrap).filter(|entry| entry.file_name() != ".vglare");
    // While a run goes on, one may be gone under its temporary name before it is looked at.
    let looked_at = |entry: std::fs::DirEntry| {
        Some((entry.file_name().into_string().unwrap(), entry.metadata().ok()?.modified().unwrap()))
    };
    let mut pictures: Vec<_> = entries.filter_map(looked_at).collect();
    pictures.sort();
    pictures
}

fn names(place: &Workplace) -> Vec<String> {
    pictures(place).into_iter().map(|(name, _)| name).collect()
}

/// Which pictures have been written since.
fn rewritten(place: &Workplace, before: &[(String, SystemTime)]) -> Vec<String> {
    pictures(place).into_iter().filter(|picture| !before.contains(picture)).map(|(name, _)| name).collect()
}

#[test]
fn frames_are_picked_by_number_and_those_that_are_missing_are_named() {
    let place = place(&[-2, 1, 2, 3, 5, 6, 10]);
    place.vglare(&with(&["--frames", "1-6x2,10", "-q"])).succeeded();
    assert_eq!(names(&place), ["s.0001.exr", "s.0003.exr", "s.0005.exr", "s.0010.exr"]);
    std::fs::remove_dir_all(place.path("out")).unwrap();
    let missing = "frames 4,7-9 of in/s.####.exr are missing";
    place.vglare(&with(&["--frames", "1-10"])).failed(1, &[missing]);
    assert!(!place.path("out").exists(), "nothing is written");
    place
        .vglare(&with(&["--frames", "-2-7,7-9", "--keep-going", "--report", "report.json"]))
        .failed(1, &["frames -1-0,4,7-9 of in/s.####.exr are missing", "6 of 12 photos could not be done"]);
    assert_eq!(names(&place).len(), 6);
    let report = place.read_json("report.json");
    assert_eq!((&report["summary"]["written"], &report["summary"]["failed"]), (&6.into(), &6.into()));
    assert_eq!(report["failed"][5]["error"], "frame 9 of in/s.####.exr is missing");
    // Without numbers all that are there.
    place.vglare(&with(&["--force", "-q"])).succeeded();
    assert_eq!(names(&place).len(), 7);
    for (frames, word) in [("1-", "expected frames"), ("5-1:0", "step of 0"), ("1-9999999", "more than")] {
        place.vglare(&with(&["--frames", frames])).failed(2, &[word]);
    }
    place.vglare(&["apply", "in/t.####.exr", "-o", "out/"]).failed(1, &["in/t.####.exr", "no frame of this pattern"]);
}

#[test]
fn frames_that_are_done_are_left_out_until_something_changes() {
    let place = place(&[1, 2, 3]);
    place.vglare(&with(&["--frames", "1-2"])).succeeded();
    let first = pictures(&place);
    let resume = |more: &[&str]| {
        let before = pictures(&place);
        let said = place.vglare(&[&with(&["--resume"])[..], more].concat()).succeeded().stdout();
        (rewritten(&place, &before), said)
    };
    // What an earlier run of other frames has done is done.
    let (new, said) = resume(&[]);
    assert_eq!(new, ["s.0003.exr"]);
    assert!(said.contains("resumed  2 photos were done already") && said.contains("wrote    1 of 1"), "{said}");
    assert_eq!(pictures(&place)[..2], first);
    let (new, said) = resume(&[]);
    assert!(new.is_empty() && said.contains("wrote    0 of 0"), "{said}");
    // The photo of one, the picture of another, and what is known of the third.
    place.write("in/s.0001.exr", &frame(9));
    assert_eq!(resume(&[]).0, ["s.0001.exr"]);
    std::fs::write(place.path("out/s.0002.exr"), "torn").unwrap();
    assert_eq!(resume(&[]).0, ["s.0002.exr"]);
    std::fs::write(place.path("out/.vglare/s.0003.exr.json"), "{\"ledger\":1,").unwrap();
    assert_eq!(resume(&[]).0, ["s.0003.exr"]);
    // Another look, in whatever words; an option of the file; other files.
    for more in [&["--tint", "1,1,0.5"][..], &["--depth", "half"], &["--glare", "light/g.####.exr"]] {
        assert_eq!(resume(more).0.len(), 3, "{more:?}");
        assert_eq!(resume(more).0.len(), 0, "{more:?}");
    }
    // Each picture is what it would have been without all that.
    place.vglare(&with(&["--resume"])).succeeded();
    place.vglare(&["apply", "in/s.####.exr", "-o", "again/", "--strength", "2"]).succeeded();
    for name in names(&place) {
        let [one, other] =
            ["out", "again"].map(|folder| std::fs::read(place.path(&format!("{folder}/{name}"))).unwrap());
        assert!(one == other, "{name}");
    }
    // A picture in its photo's place cannot be told from a photo.
    place
        .vglare(&["apply", "in/s.####.exr", "-o", "in/", "--resume"])
        .failed(2, &["--resume cannot replace in/s.0001.exr"]);
}

#[test]
fn the_settings_of_a_lens_and_files_of_a_look_count() {
    let place = place(&[1]);
    let lens = |share: f64| {
        place.text("lens.toml", &format!("[[lens_ghost]]\nalong = -1\nsize = 0.5\nshare = {share}\n"));
    };
    let written = |words: &[&str]| {
        let before = pictures(&place);
        place.vglare(&[&SHOT[..], &["--resume"], words].concat()).succeeded();
        rewritten(&place, &before).len()
    };
    lens(0.1);
    let file = ["--lens", "lens.toml"];
    assert_eq!([written(&file), written(&file)], [1, 0]);
    lens(0.2);
    assert_eq!([written(&file), written(&file)], [1, 0]);
    let real = ["--lens", "double-gauss", "--fstop", "4"];
    assert_eq!([written(&real), written(&real)], [1, 0]);
}

#[test]
#[cfg(target_os = "linux")]
fn a_signal_leaves_whole_frames_and_says_how_to_go_on() {
    use std::os::unix::process::ExitStatusExt as _;
    use std::process::{Command, Stdio};

    for (name, number) in [("INT", 2), ("TERM", 15)] {
        let place = place(&(1..=30).collect::<Vec<_>>());
        let mut command = Command::new("env");
        command
            .args(["--default-signal", env!("CARGO_BIN_EXE_vglare")])
            .args(SHOT)
            .env("VGLARE_CACHE", place.path("cache"));
        let mut child =
            command.current_dir(place.path(".")).stderr(Stdio::piped()).stdout(Stdio::null()).spawn().unwrap();
        while names(&place).iter().filter(|name| name.ends_with(".exr") && !name.starts_with('.')).count() < 3 {
            assert!(child.try_wait().unwrap().is_none(), "it takes long enough to be stopped");
            std::thread::sleep(std::time::Duration::from_millis(1));
        }
        assert!(Command::new("kill").args(["-s", name, &child.id().to_string()]).status().unwrap().success());
        let ended = child.wait_with_output().unwrap();
        // A shell tells that as 130 and 143.
        assert_eq!(ended.status.signal(), Some(number));
        let said = String::from_utf8_lossy(&ended.stderr).into_owned();
        let last = said.lines().last().unwrap_or_default();
        assert!(last.contains(" of 30 photos are done; the same command with --resume does the others"), "{said}");
        let left = pictures(&place);
        for (name, _) in &left {
            vglare::photo::read(&place.path(&format!("out/{name}"))).unwrap_or_else(|error| panic!("{error}"));
        }
        assert!(left.len() < 30, "it was stopped");
        let said = place.vglare(&with(&["--resume"])).succeeded().stdout();
        assert!(said.contains("photos were done already"), "{said}");
        let after = pictures(&place);
        assert_eq!(after.len(), 30);
        // One may have been written whose note was not.
        assert!(left.iter().filter(|picture| !after.contains(picture)).count() <= 1);
    }
}

#[test]
#[cfg(unix)]
fn a_job_runs_the_frames_with_the_options_that_it_was_given() {
    use std::process::Command;

    let place = place(&[1, 2, 3, 4]);
    let job = |farm: &'static str, more: &[&'static str]| {
        [&["job", farm][..], &SHOT[1..], &["--frames", "1-4", "--sources", "lights"], more].concat()
    };
    place.vglare(&job("slurm", &["--file", "job.sh", "--chunk", "3"])).succeeded();
    let task = |index: &str| {
        let mut command = Command::new("sh");
        command.arg("job.sh").current_dir(place.path(".")).env("SLURM_ARRAY_TASK_ID", index);
        command.env("VGLARE", env!("CARGO_BIN_EXE_vglare")).env("VGLARE_CACHE", place.path("cache"));
        super::Ran(command.output().unwrap()).succeeded().stdout()
    };
    task("1");
    assert_eq!(names(&place), ["s.0004.exr"]);
    task("0");
    assert_eq!(names(&place).len(), 4);
    assert!(task("0").contains("resumed  3 photos"), "a task that is started again does nothing again");
    place.vglare(&with(&["--sources", "lights", "--resume"])).succeeded();
    assert!(task("1").contains("resumed  1 photos"), "it is the same look");

    let said = place.vglare(&job("openjd", &["--file", "job.yaml", "--chunk", "2", "--gpu"])).succeeded().stdout();
    assert!(said.contains("job.yaml: 4 frames, 2 cores and "), "{said}");
    let text = std::fs::read_to_string(place.path("job.yaml")).unwrap();
    for line in [
        "specificationVersion: jobtemplate-2023-09",
        "extensions: [TASK_CHUNKING]",
        "          chunks: {defaultTaskCount: 2, rangeConstraint: NONCONTIGUOUS}",
        "        - {name: amount.worker.gpu, min: 1}",
        "            - \"--sources=lights\"",
        "            - \"--frames={{Task.Param.Frame}}\"",
    ] {
        assert!(text.lines().any(|is| is == line), "{line} is not in:\n{text}");
    }
    place.vglare(&job("openjd", &["--file", "job.yaml"])).failed(1, &["job.yaml", "--force"]);
    place.vglare(&job("openjd", &["--file", "job.yaml", "--force"])).succeeded();
    let text = std::fs::read_to_string(place.path("job.yaml")).unwrap();
    assert!(
        !text.contains("TASK_CHUNKING") && !text.contains("gpu") && text.contains("          type: INT\n"),
        "{text}"
    );
}

#[test]
fn jobs_that_could_not_run_are_refused() {
    let place = place(&[1]);
    let before = place.files();
    let one = ["job", "slurm", "in/s.0001.exr", "-o", "out/", "--file", "j.sh"];
    place.vglare(&one).failed(2, &["one pattern"]);
    let shot = ["job", "openjd", "in/s.####.exr", "-o", "out/s.####.exr", "--frames", "1-9"];
    for (more, code, words) in [
        (&[][..], 2, &["--file"][..]),
        (&["--file", "j.yaml", "--report", "r.json"], 2, &["--report"]),
        (&["--file", "j.yaml", "--preset", "none-such"], 2, &["none-such"]),
        (&["--file", "j.yaml", "--no-such-option"], 2, &["--no-such-option"]),
        (&["--file", "j.yaml", "--chunk", "0"], 2, &["--chunk"]),
        (&["--file", "nowhere/j.yaml"], 1, &["nowhere"]),
        (&["--file", "j.yaml", "--glare", "one.exr"], 2, &["one.exr", "--glare"]),
    ] {
        place.vglare(&[&shot[..], more].concat()).failed(code, words);
        assert_eq!(place.files(), before, "{more:?}");
    }
    let ran = place.vglare(&[&shot[..], &["--file", "j.yaml"]].concat()).succeeded();
    assert!(ran.stderr().contains("8 of 9 frames are not there yet"), "{}", ran.stderr());
}

/// The mean of what was added to each frame, in `light/g.####.pfm`, and its largest value.
fn glare(place: &Workplace, frames: std::ops::RangeInclusive<i64>, options: &[&str]) -> Vec<[f64; 2]> {
    let words = ["apply", "in/s.####.exr", "--glare", "light/g.####.pfm", "--force", "-q"];
    place.vglare(&[&words[..], options].concat()).succeeded();
    let of = |frame| {
        let photo = vglare::photo::read(&place.path(&format!("light/g.{frame:04}.pfm"))).unwrap();
        let values = || photo.pixels.iter().flat_map(|pixel| &pixel[..3]).map(|&value| f64::from(value));
        [values().sum::<f64>() / (3 * photo.pixels.len()) as f64, values().fold(0.0, f64::max)]
    };
    frames.map(of).collect()
}

/// Noise of a photon count and of a sensor; 36 lamps from 1 to 100 times as bright as what is around them, so that wherever a threshold lies one
/// is close to it.
fn noisy(frame: i64) -> Photo {
    let mut state = 0x9e37_79b9_7f4a_7c15_u64.wrapping_mul(frame as u64 + 1);
    let mut uniform = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f32 / (1 << 24) as f32
    };
    let mut pixels = Vec::new();
    for row in 0..96 {
        for column in 0..144 {
            let (lamp, x, y) = (column / 24 + 6 * (row / 16), column % 24, row % 16);
            let level =
                if (10..13).contains(&x) && (7..10).contains(&y) { 100_f32.powf(lamp as f32 / 35.0) } else { 0.2 };
            // The sum of twelve has the variance 1.
            let normal = (0..12).map(|_| uniform()).sum::<f32>() - 6.0;
            let seen = (level + (0.002 * level).sqrt() * normal + 0.003 * normal).max(0.0);
            pixels.push([seen, 0.9 * seen, 0.7 * seen, 1.0]);
        }
    }
    Photo::new(144, 96, pixels)
}

#[test]
fn the_glare_of_a_noisy_shot_stands_still() {
    let place = place(&[]);
    (1..=5).for_each(|frame| drop(place.write(&format!("in/s.{frame:04}.exr"), &noisy(frame))));
    for sources in ["photo", "lights"] {
        let means: Vec<f64> = glare(&place, 1..=5, &["--sources", sources]).iter().map(|[mean, _]| *mean).collect();
        assert!(means[0] > 0.0);
        for pair in means.windows(2) {
            assert!((pair[1] / pair[0] - 1.0).abs() < 0.005, "{sources}: {means:?}");
        }
    }
}

/// In proportion to its own light: without a threshold nothing else depends on how bright it is.
#[test]
fn a_lamp_that_flickers_moves_its_own_glare_alone() {
    let place = place(&[]);
    for (frame, level) in [(1, 0.9), (2, 1.0), (3, 1.1)] {
        let mut photo = night();
        photo.pixels[50 * 96 + 20] = [60.0 * level, 90.0 * level, 200.0 * level, 1.0];
        place.write(&format!("in/s.{frame:04}.exr"), &photo);
    }
    let means = glare(&place, 1..=3, &["--tolerance", "1e-4"]);
    let [less, more] = [means[1][0] - means[0][0], means[2][0] - means[1][0]];
    assert!(less > 0.0 && (more / less - 1.0).abs() < 0.02, "{means:?}");
}

#[test]
fn what_each_frame_would_choose_one_chooses_for_all() {
    let place = place(&[1]);
    let mut bright = night();
    bright.pixels[40 * 96 + 40] = [90_000.0, 90_000.0, 90_000.0, 1.0];
    bright.pixels[40 * 96 + 41] = [90_000.0, 90_000.0, 90_000.0, 1.0];
    place.write("in/s.0002.exr", &bright);
    let thresholds = |options: &[&str]| {
        let words = ["--sources", "lights", "--report", "report.json", "--force", "-q"];
        place.vglare(&[&SHOT[..], &words, options].concat()).succeeded();
        let report = place.read_json("report.json");
        let frames = report["frames"].as_array().unwrap().iter();
        frames.map(|frame| frame["scene"]["threshold"].as_f64().unwrap()).collect::<Vec<_>>()
    };
    let each = thresholds(&["--lock-from", "none"]);
    assert!(each[1] > 2.0 * each[0], "{each:?}");
    assert_eq!(thresholds(&[]), [each[0]; 2]);
    assert_eq!(thresholds(&["--frames", "2"]), [each[0]], "whichever are done");
    assert_eq!(thresholds(&["--lock-from", "2"]), [each[1]; 2]);
    assert_eq!(thresholds(&["--threshold", "3"]), [3.0; 2]);
    // What is stretched.
    let stretched = |lock| {
        let of = glare(
            &place,
            1..=2,
            &["--sources", "lights", "--threshold", "10", "--normalize", "minmax", "--lock-from", lock],
        );
        [of[0][1], of[1][1]]
    };
    let [one, other] = stretched("none");
    assert!((one - 1.0).abs() < 0.01 && (other - 1.0).abs() < 0.01, "{one} {other}");
    let [one, other] = stretched("first");
    assert!((one - 1.0).abs() < 0.01 && other > 2.0, "{one} {other}");
    place
        .vglare(&with(&["--sources", "lights", "--lock-from", "9", "--force"]))
        .failed(2, &["--lock-from 9", "frame 9 of in/s.####.exr is missing"]);
    place.vglare(&with(&["--lock-from", "last"])).failed(2, &["\"first\", \"none\" or a frame's number"]);
}

#[test]
fn processes_share_a_shot() {
    let place = place(&[1, 2, 3, 4, 5, 6]);
    place.vglare(&["apply", "in/s.####.exr", "-o", "one/", "--strength", "2", "--report", "one.json"]).succeeded();
    let said = place.vglare(&with(&["--jobs", "3", "--report", "report.json"])).succeeded().stdout();
    assert!(said.contains("wrote    6 of 6 pictures"), "{said}");
    let same = |name: &str| {
        let [one, other] = ["out", "one"].map(|folder| std::fs::read(place.path(&format!("{folder}/{name}"))).unwrap());
        one == other
    };
    assert!(names(&place).len() == 6 && names(&place).iter().all(|name| same(name)));
    let [one, other] = ["one.json", "report.json"].map(|name| place.read_json(name));
    assert_eq!(other["frames"].as_array().map(Vec::len), Some(6));
    assert_eq!(other["summary"]["worst_error"], one["summary"]["worst_error"]);
    let said = place.vglare(&with(&["--jobs", "3", "--resume"])).succeeded().stdout();
    assert!(said.contains("resumed  6 photos"), "{said}");
    place.vglare(&with(&["--jobs", "2"])).failed(1, &["out/s.0001.exr", "--force"]);
    // A photo that cannot be done stops all, or none.
    std::fs::write(place.path("in/s.0002.exr"), "torn").unwrap();
    place.vglare(&with(&["--jobs", "2", "--force"])).failed(1, &["in/s.0002.exr"]);
    let ran = place.vglare(&with(&["--jobs", "2", "--force", "--keep-going"]));
    assert!(ran.stdout().contains("wrote    5 of 6"), "{}", ran.stdout());
    ran.failed(1, &["in/s.0002.exr", "1 of 6 photos could not be done"]);
}

#[test]
#[cfg(target_os = "linux")]
fn a_process_that_is_killed_is_told_and_none_outlives_who_started_it() {
    use std::process::{Child, Command, Stdio};

    let start = |place: &Workplace| {
        let mut command = place.command(&with(&["--jobs", "2", "--keep-going", "-q"]));
        command.stderr(Stdio::piped()).spawn().unwrap()
    };
    let workers = |parent: &Child| -> Vec<String> {
        let path = format!("/proc/{0}/task/{0}/children", parent.id());
        std::fs::read_to_string(path).unwrap_or_default().split_whitespace().map(str::to_owned).collect()
    };
    let kill = |signal: &str, id: &str| {
        assert!(Command::new("kill").args([signal, id]).status().unwrap().success());
    };
    let begun = |place: &Workplace, parent: &mut Child| {
        while names(place).iter().filter(|name| !name.starts_with('.')).count() < 2 {
            assert!(parent.try_wait().unwrap().is_none(), "it takes long enough");
            std::thread::sleep(std::time::Duration::from_millis(1));
        }
    };
    let shot = place(&(1..=40).collect::<Vec<_>>());
    let mut parent = start(&shot);
    begun(&shot, &mut parent);
    kill("-KILL", &workers(&parent)[0]);
    let ran = super::Ran(parent.wait_with_output().unwrap());
    let said = ran.stderr();
    assert!(said.contains("its process ended before it was done (signal: 9"), "{said}");
    // The other has done its own.
    let done = names(&shot).into_iter().filter(|name| !name.starts_with('.')).count();
    assert!((20..40).contains(&done), "{done}");
    ran.failed(1, &["of 40 photos could not be done"]);

    let shot = place(&(1..=40).collect::<Vec<_>>());
    let mut parent = start(&shot);
    begun(&shot, &mut parent);
    let children = workers(&parent);
    assert_eq!(children.len(), 2);
    parent.kill().unwrap();
    parent.wait().unwrap();
    let until = std::time::Instant::now() + std::time::Duration::from_secs(20);
    while children
        .iter()
        .any(|id| std::fs::read_to_string(format!("/proc/{id}/stat")).is_ok_and(|stat| !stat.contains(") Z ")))
    {
        assert!(std::time::Instant::now() < until, "they end, too");
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    for (name, _) in pictures(&shot) {
        assert!(!name.starts_with('.'), "{name} is left");
        vglare::photo::read(&shot.path(&format!("out/{name}"))).unwrap_or_else(|error| panic!("{error}"));
    }
}

/// Of photos that are named one by one only pictures are left once all are done; what is known of them stays where some are not, or where
/// `--resume` is asked for.
#[test]
fn photos_that_are_named_one_by_one_leave_pictures_alone() {
    let place = place(&[1, 2]);
    let list = |more: &[&str]| {
        let list = ["apply", "in/s.0001.exr", "in/s.0002.exr", "-o", "out/", "--strength=2"];
        place.vglare(&[&list[..], more].concat())
    };
    let known = || place.path("out/.vglare").exists();
    list(&[]).succeeded();
    assert!(!known() && names(&place) == ["s.0001.exr", "s.0002.exr"]);
    list(&["--resume"]).succeeded();
    assert!(known());
    let before = pictures(&place);
    list(&["--resume"]).succeeded();
    assert_eq!(rewritten(&place, &before), Vec::<String>::new());
    list(&["--force"]).succeeded();
    assert!(!known());
    let whole = std::fs::read(place.path("in/s.0002.exr")).unwrap();
    std::fs::write(place.path("in/s.0002.exr"), &whole[..whole.len() / 2]).unwrap();
    assert_ne!(list(&["--force", "--keep-going"]).code(), Some(0));
    std::fs::write(place.path("in/s.0002.exr"), &whole).unwrap();
    let before = pictures(&place);
    list(&["--resume"]).succeeded();
    assert_eq!(rewritten(&place, &before), ["s.0002.exr"]);
}
