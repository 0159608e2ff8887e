//! A mistake in the program costs one photo, and is told.

use super::Workplace;

/// Four photos, of which the second meets a panic in `step`.
fn shot(step: &str, more: &[&str]) -> (Workplace, super::Ran) {
    let place = Workplace::new();
    ["a.exr", "b.exr", "c.exr", "d.exr"].iter().for_each(|name| drop(place.photo(name)));
    let fault = format!("{step}:2");
    let mut args = vec!["apply", "a.exr", "b.exr", "c.exr", "d.exr", "-o", "out/", "--panic-in", &fault];
    args.extend(more);
    // Whoever asks for a backtrace gets the panic's own words, too.
    let ran = place.command(&args).env_remove("RUST_BACKTRACE").output().expect("the program runs");
    (place, super::Ran(ran))
}

fn written(place: &Workplace) -> Vec<String> {
    let mut names: Vec<_> = std::fs::read_dir(place.path("out"))
        .expect("the folder")
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .filter(|name| name != ".vglare")
        .collect();
    names.sort();
    names
}

#[test]
fn a_panic_in_one_photo_leaves_the_others_and_the_report() {
    for step in ["read", "compute", "write"] {
        for more in [&[][..], &["--one-by-one"]] {
            let args: Vec<&str> = ["--keep-going", "--report", "r.json"].iter().chain(more).copied().collect();
            let (place, ran) = shot(step, &args);
            let what = format!("a fault on purpose, in step {step}); please report it");
            let all = "1 of 4 photos could not be done";
            ran.failed(1, &["vglare: b.exr: an internal error (src/cli/apply/fault.rs:", &what, all]);
            assert_eq!(written(&place), ["a.exr", "c.exr", "d.exr"], "{step}, {more:?}");
            let report = place.read_json("r.json");
            assert_eq!(
                (report["frames"].as_array().unwrap().len(), &report["failed"][0]["input"]),
                (3, &"b.exr".into())
            );
            // The photos are the same, and so are their pictures, the panic before or not.
            let picture = |name: &str| vglare::photo::read(&place.path(&format!("out/{name}"))).unwrap().pixels;
            assert!(picture("a.exr") == picture("c.exr"), "{step}, {more:?}");
        }
    }
}

#[test]
fn a_panic_ends_a_run_that_is_not_to_go_on() {
    let (place, ran) = shot("compute", &["--report", "r.json"]);
    ran.failed(1, &["b.exr: an internal error", "please report it"]);
    assert_eq!(written(&place), ["a.exr"]);
}
