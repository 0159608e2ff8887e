//! The window itself, on an X server of its own, used as a person does: by pointer, keys and files that are dropped.

mod desk;
mod drop;

use std::fs;
use std::path::Path;
use std::process::Command;

use desk::{Desk, on, place};
use vglare::photo::{self, Photo, WriteOptions};

/// A dark room with a lamp.
fn lamp() -> Photo {
    let lamp =
        |i: i32, j: i32| if (i - 80).pow(2) + (j - 40).pow(2) < 36 { [400.0; 4] } else { [0.02, 0.02, 0.02, 1.0] };
    Photo::new(240, 160, (0..160).flat_map(|j| (0..240).map(move |i| lamp(i, j))).collect())
}

/// A desk with the window open on the lamp, which is found to be a light.
fn opened(options: &[&str]) -> Desk {
    let mut desk = Desk::new();
    let (photo, look) = (desk.path("lamp.exr"), desk.path("lights.toml"));
    photo::write(&photo, &lamp(), &WriteOptions::default()).unwrap();
    std::fs::write(&look, "version = 2\n[look]\nsources = \"lights\"\n[veil]\npsf = \"none\"\n").unwrap();
    desk.open(&photo, &[options, &["--scene", look.to_str().unwrap()]].concat());
    desk.to_window(&["windowsize"], &["1260", "1240"]);
    desk.rested();
    desk
}

fn apply(desk: &Desk, look: &Path, output: &Path) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_vglare"));
    command.args(["apply", "--quiet"]).arg(desk.path("lamp.exr")).arg("-o").arg(output).arg("--scene").arg(look);
    let done = command.output().unwrap();
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
}

/// Whether the lamp is seen where the window says it is, beside its handle.
fn shows_the_lamp(desk: &Desk) -> bool {
    let shown = desk.rested();
    let status = desk.until("a light", |status| status["lights_at"][0].is_array());
    let [x, y] = place(&status["lights_at"][0]);
    shown.brightness([x + 14.0, y]) > shown.brightness([x + 200.0, y]) + 400
}

#[test]
fn a_look_is_set_by_pointer_saved_and_undone() {
    let desk = opened(&[]);
    let before = desk.until("a light", |status| status["lights_at"][0].is_array());
    let shown = desk.rested();

    let (light, from) = (place(&before["lights"][0]), place(&before["lights_at"][0]));
    desk.drag(from, [from[0] + 150.0, from[1] + 120.0]);
    let arrived = |at: [f64; 2]| (at[0] - from[0] - 150.0).abs() < 3.0 && (at[1] - from[1] - 120.0).abs() < 3.0;
    let moved = desk.until("a light that moved", |status| arrived(place(&status["lights_at"][0])));
    assert_ne!(place(&moved["lights"][0]), light);
    let to = place(&moved["lights_at"][0]);
    let dragged = desk.rested();
    assert!(dragged.differences(&shown) > 10_000, "the glare follows the light");

    desk.drag(on(&moved, "Strength", 0.5), on(&moved, "Strength", 1.0));
    let strong = desk.until("the strongest glare", |status| status["strength"] == 10.0);
    let beside = [to[0] + 100.0, to[1]];
    assert!(desk.rested().brightness(beside) > dragged.brightness(beside) + 50, "stronger glare is brighter");

    desk.click(on(&strong, "By hand", 0.2));
    let unfolded = desk.until("the choice of an evaluator", |status| status["controls"]["Evaluator"].is_array());
    desk.rested();
    desk.click(on(&unfolded, "Evaluator", 0.5));
    let choices = desk.until("its choices", |status| status["controls"]["choose rows (parametric)"].is_array());
    assert_ne!(choices["evaluator"], "rows");
    desk.rested();
    desk.click(on(&choices, "choose rows (parametric)", 0.5));
    desk.until("another evaluator", |status| status["evaluator"] == "rows");

    desk.key("ctrl+shift+s");
    desk.answer(&desk.path("look.toml"));
    desk.key("ctrl+s");
    desk.answer(&desk.path("saved.exr"));
    apply(&desk, &desk.path("look.toml"), &desk.path("applied.exr"));
    let [saved, applied, photo] =
        ["saved.exr", "applied.exr", "lamp.exr"].map(|name| fs::read(desk.path(name)).unwrap());
    assert!(saved == applied && saved != photo, "what is saved is what apply writes of the saved look");

    // Evaluator, strength, light.
    (0..3).for_each(|_| desk.key("ctrl+z"));
    desk.until("what was there at first", |status| status["steps"][0] == false && status["lights"] == before["lights"]);
    desk.click(on(&unfolded, "By hand", 0.2));
    let again = desk.rested();
    // The light that was dragged is still selected, which marks it.
    assert!(again.brightness(to) == shown.brightness(to) && again.brightness(from) == shown.brightness(from));
    // What was set last is remembered, without a word.
    assert!(desk.path("state/look.toml").exists());
}

#[test]
fn a_bad_file_that_is_dropped_leaves_the_picture() {
    let mut desk = opened(&[]);
    fs::write(desk.path("bad.exr"), "no photo").unwrap();
    photo::write(&desk.path("other.exr"), &lamp(), &WriteOptions::default()).unwrap();
    let before = desk.until("a light", |status| status["lights_at"][0].is_array());
    drop::drop_file(desk.display(), desk.id(), [400, 300], &desk.path("bad.exr")).unwrap();
    let told = desk.until("a notice", |status| status["notices"][0].is_string() && status["busy"] == false);
    assert!(told["notices"][0].as_str().unwrap().contains("bad.exr"), "{}", told["notices"]);
    assert_eq!((&told["photo"], &told["lights"]), (&before["photo"], &before["lights"]));
    assert!(shows_the_lamp(&desk), "it is still shown");
    drop::drop_file(desk.display(), desk.id(), [400, 300], &desk.path("other.exr")).unwrap();
    desk.until("the other photo", |status| status["photo"] == "other.exr");
    desk.key("ctrl+q");
    desk.closed();
}

#[test]
fn the_window_is_looked_at_made_small_hidden_and_closed() {
    let mut desk = opened(&[]);
    let name = desk.to_window(&["getwindowname"], &[]);
    assert!(name.contains("lamp.exr"), "{name}");
    // The photo alone and back, the glare alone and back.
    let mut shown = desk.rested();
    let first = shown;
    shown = desk.rested();
    for key in ["b", "b", "g", "g"] {
        desk.key(key);
        let now = desk.rested();
        assert!(now.differences(&shown) > 1000, "{key}");
        shown = now;
    }
    assert!(shown == first, "it is shown as it was at first");
    desk.point([500.0, 300.0]);
    desk.xdotool(&["click", "4", "click", "4"]);
    desk.drag([500.0, 300.0], [600.0, 380.0]);
    assert!(desk.rested().differences(&first) > 1000, "it is magnified and moved");
    // Nearly nothing, nothing, and back.
    desk.to_window(&["windowsize"], &["40", "30"]);
    desk.rested();
    desk.to_window(&["windowunmap"], &[]);
    desk.rested();
    assert!(desk.is_open(), "it ended while it was hidden");
    desk.to_window(&["windowmap"], &[]);
    desk.to_window(&["windowsize"], &["1260", "1240"]);
    desk.to_window(&["windowfocus"], &[]);
    desk.key("f");
    assert!(shows_the_lamp(&desk), "it comes back");
    desk.key("ctrl+q");
    desk.closed();
}

#[test]
fn a_context_that_is_lost_is_made_anew_under_the_window() {
    let mut desk = opened(&["--lose-after", "12"]);
    let before = desk.until("a light", |status| status["lights_at"][0].is_array());
    let (mut from, mut now) = (place(&before["lights_at"][0]), before);
    // More than twelve frames, and those after them are on another context.
    for _ in 0..3 {
        let to = [from[0] + 60.0, from[1] + 20.0];
        desk.drag(from, to);
        let arrived = |at: [f64; 2]| (at[0] - to[0]).abs() < 3.0 && (at[1] - to[1]).abs() < 3.0;
        now = desk.until("a light that moved", |status| arrived(place(&status["lights_at"][0])));
        from = place(&now["lights_at"][0]);
    }
    assert_eq!(now["notices"].as_array().unwrap().len(), 0, "{now:#}");
    assert!(now["devices"] == 2, "{now:#}");
    desk.key("ctrl+z");
    desk.until("the drag before", |status| status["lights"] != now["lights"]);
    desk.key("ctrl+q");
    desk.closed();
}

#[test]
fn the_desktops_dialogs_ask_while_the_window_goes_on() {
    let mut desk = opened(&[]);
    let before = desk.until("a photo", |status| status["photo"] == "lamp.exr");
    let (saved, other, go) = (desk.path("saved.exr"), desk.path("other.exr"), desk.path("go"));
    let wait = format!(
        "echo \"$@\" >{}; until [ -e {} ]; do /bin/sleep 0.05; done",
        desk.path("asked").display(),
        go.display()
    );
    desk.zenity(&format!("{wait}; echo {}", saved.display()));
    desk.key("ctrl+s");
    desk.until("a dialog", |status| status["dialog"] == true && status["asks"] == false);
    // The window goes on meanwhile, and what is shown then is not what is saved.
    photo::write(&other, &lamp(), &WriteOptions::default()).unwrap();
    drop::drop_file(desk.display(), desk.id(), [400, 300], &other).unwrap();
    desk.until("the other photo", |status| status["photo"] == "other.exr");
    fs::write(&go, "").unwrap();
    desk.until("a picture", |status| status["dialog"] == false && status["busy"] == false && saved.exists());
    let asked = fs::read_to_string(desk.path("asked")).unwrap();
    assert!(asked.contains("--save") && asked.contains("lamp-glare.exr") && asked.contains("*.exr"), "{asked}");

    // One that is closed without an answer, later than nobody could; one that cannot be shown; and one for several.
    desk.zenity("/bin/sleep 0.7; exit 1");
    desk.key("ctrl+s");
    desk.until("a dialog", |status| status["dialog"] == true);
    desk.until("none", |status| status["dialog"] == false && status["asks"] == false);
    desk.zenity("exit 1");
    desk.key("ctrl+s");
    desk.until("a question in the window", |status| status["asks"] == true);
    desk.key("Escape");
    desk.until("no question", |status| status["asks"] == false);
    desk.zenity(&format!("echo '{}|{}'", saved.display(), desk.path("lamp.exr").display()));
    desk.key("ctrl+o");
    desk.until("the photos", |status| status["busy"] == false && status["photo"] != "other.exr");
    let now = desk.until("no dialog", |status| status["dialog"] == false);
    assert_eq!(now["notices"], before["notices"]);
    desk.key("ctrl+q");
    desk.closed();
}
