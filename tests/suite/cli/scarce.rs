//! Where the system gives little, or something else than its name says: an answer in words.

use std::path::Path;

use super::{Ran, Workplace, night};

/// Runs the program with an address space of so many MiB.
fn within(place: &Workplace, mib: u32, args: &[&str]) -> Ran {
    let mut command = std::process::Command::new("sh");
    command.args(["-c", &format!("ulimit -v {}; exec \"$@\"", mib << 10), "sh", env!("CARGO_BIN_EXE_vglare")]);
    command.args(args).current_dir(place.path(".")).env("VGLARE_CACHE", place.path("cache"));
    Ran(command.output().expect("a shell"))
}

#[test]
fn a_limit_of_memory_ends_in_words_or_in_the_picture() {
    let place = Workplace::new();
    let small = night();
    let pixels = small.pixels.iter().cycle().take(1600 * 900).copied().collect();
    place.write("a.exr", &vglare::photo::Photo::new(1600, 900, pixels));
    // From less than the photo takes to just enough, in which Mesa crashes, waits for ever or aborts if it is let.
    for mib in [70, 120, 280, 340, 400] {
        let ran = within(&place, mib, &["apply", "a.exr", "-o", "b.exr", "--force"]);
        if ran.code() == Some(0) {
            assert!(mib > 280 && place.path("b.exr").exists(), "{mib} MiB");
        } else {
            ran.failed(1, &["not enough memory: the limit of", "MiB leaves"]);
            assert!(
                place.files().iter().all(|name| ["a.exr", "cache"].contains(&name.as_str())),
                "{:?}",
                place.files()
            );
        }
    }
}

#[test]
fn a_limit_that_is_wide_enough_changes_no_picture() {
    let place = Workplace::new();
    ["a.exr", "b.exr"].iter().for_each(|name| drop(place.photo(name)));
    place.vglare(&["apply", "a.exr", "b.exr", "-o", "free/"]).succeeded();
    within(&place, 3000, &["apply", "a.exr", "b.exr", "-o", "bound/", "--report", "r.json"]).succeeded();
    for name in ["a.exr", "b.exr"] {
        let bytes = |folder: &str| std::fs::read(place.path(folder).join(name)).expect("a picture");
        assert!(bytes("free") == bytes("bound"), "{name}");
    }
    assert_eq!(place.read_json("r.json")["summary"]["side_by_side"], false, "one photo at a time");
}

/// A library that every Rust program has loaded, and that is no driver.
fn some_library() -> Option<String> {
    let maps = std::fs::read_to_string("/proc/self/maps").ok()?;
    maps.lines()
        .find_map(|line| Some(line[line.find('/')?..].to_owned()).filter(|path| path.ends_with("libgcc_s.so.1")))
}

#[test]
fn a_library_that_is_not_what_its_name_says_is_named() {
    let place = Workplace::new();
    place.photo("a.exr");
    let folder = place.path("fake");
    std::fs::create_dir(&folder).expect("a folder");
    let run = |backend: &str| {
        let mut command = place.command(&["apply", "a.exr", "-o", "b.exr", "--backend", backend]);
        command.env("LD_LIBRARY_PATH", &folder).env_remove("RUST_BACKTRACE");
        Ran(command.output().expect("the program runs"))
    };
    let names = [("egl", "libEGL.so.1"), ("osmesa", "libOSMesa.so.8")];
    let library = some_library().expect("a program has libraries");
    for (backend, name) in names {
        std::fs::copy(Path::new(&library), folder.join(name)).expect("a library");
        run(backend).failed(4, &["no OpenGL 4.3 context", &format!("{backend}: {name} is not ")]);
    }
    std::fs::write(folder.join("libEGL.so.1"), "no library").expect("a file");
    run("egl").failed(4, &["egl: libEGL.so.1 cannot be loaded: ", "file too short"]);
}
