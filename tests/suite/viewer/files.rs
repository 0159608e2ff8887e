//! Looks and pictures in and out of the window.

use std::path::PathBuf;
use std::process::Command;

use tempfile::TempDir;
use vglare::choices::LengthUnit;
use vglare::viewer::Subject;
use vglare::viewer::model::State;

use super::*;

/// A folder with the lamp's photo in it, open.
fn in_a_folder() -> (TempDir, Session) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("lamp.exr");
    photo::write(&path, &lamp(), &WriteOptions::default()).unwrap();
    let mut session = Session::new();
    session.app.remember(State::in_folder(folder.path().join("state")));
    session.app.open(path);
    session.wait(|app| !app.is_reading());
    (folder, session)
}

/// `vglare apply` of a look.
fn command(photo: &Path, output: &Path, look: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_vglare"));
    command.args(["apply", "--quiet"]).arg(photo).arg("-o").arg(output).arg("--scene").arg(look);
    command
}

fn run(command: &mut Command) {
    let output = command.output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

fn apply(photo: &Path, output: &Path, look: &Path) {
    run(&mut command(photo, output, look));
}

/// The same, with the glare alone in a file of its own.
pub(super) fn apply_with(photo: &Path, output: &Path, look: &Path, glare: &Path) {
    run(command(photo, output, look).arg("--glare").arg(glare));
}

#[test]
fn the_window_writes_what_apply_writes_of_the_saved_look() {
    let (folder, mut session) = in_a_folder();
    let path = |name: &str| folder.path().join(name);
    let from = session.at(session.document().lights()[0].position);
    session.drag(from, vec2(40.0, 20.0));
    session.app.document_mut().unwrap().look.strength = 1.7;
    session.app.save_look(&path("look.toml"));
    session.app.export(Subject::Picture, &path("window.exr"));
    session.wait(|app| !app.is_writing());
    assert_eq!(session.app.notices(), [] as [String; 0]);
    apply(&path("lamp.exr"), &path("apply.exr"), &path("look.toml"));
    let [window, apply, photo] = ["window.exr", "apply.exr", "lamp.exr"].map(|name| std::fs::read(path(name)).unwrap());
    assert!(window == apply, "the files differ");
    assert!(window != photo, "there is glare in them");
}

#[test]
fn the_window_writes_what_apply_writes_in_another_unit() {
    let (folder, mut session) = in_a_folder();
    let path = |name: &str| folder.path().join(name);
    let look = |unit, fov| Look { unit, fov, ..lit() };
    for (unit, fov) in [(LengthUnit::Diagonal, None), (LengthUnit::Degrees, Some(60.0)), (LengthUnit::ShortSide, None)]
    {
        // A degree is small, and so is a ghost of a fraction of one.
        let size = if unit == LengthUnit::Degrees { 20.0 } else { 1.0 };
        session.app.document_mut().unwrap().set_look(Look { size, ..look(unit, fov) });
        session.settle();
        assert_eq!(session.app.problem(), None, "{unit}");
        session.app.save_look(&path("look.toml"));
        session.app.export(Subject::Picture, &path("window.exr"));
        session.wait(|app| !app.is_writing());
        assert_eq!(session.app.notices(), [] as [String; 0]);
        apply(&path("lamp.exr"), &path("apply.exr"), &path("look.toml"));
        let [window, apply] = ["window.exr", "apply.exr"].map(|name| std::fs::read(path(name)).unwrap());
        assert!(window == apply, "the files differ in {unit}");
        for name in ["look.toml", "window.exr", "apply.exr"] {
            std::fs::remove_file(path(name)).unwrap();
        }
    }
    session.app.document_mut().unwrap().set_look(look(LengthUnit::Degrees, None));
    session.settle();
    assert!(session.app.problem().is_some_and(|problem| problem.contains("field of view")));
}

#[test]
fn the_picture_is_saved_under_the_name_that_is_typed() {
    let (folder, mut session) = in_a_folder();
    session.key(CTRL, Key::S);
    session.key(Modifiers::NONE, Key::Enter);
    session.wait(|app| !app.is_writing());
    assert_eq!(session.app.notices(), [] as [String; 0]);
    let written = folder.path().join("lamp-glare.exr");
    assert_eq!(session.app.done(), Some(format!("Saved {}", written.display()).as_str()));
    assert_eq!(photo::read(&written).unwrap().pixels.len(), lamp().pixels.len());
    // Now that it is there, Enter alone does not replace it.
    std::fs::write(&written, "precious").unwrap();
    session.key(CTRL, Key::S);
    session.key(Modifiers::NONE, Key::Enter);
    assert!(!session.app.is_writing());
    assert_eq!(std::fs::read(&written).unwrap(), b"precious");
}

/// Clicks what is called so, which must be shown.
pub(super) fn click(session: &mut Session, name: &str) {
    let at = session.app.control(name).unwrap_or_else(|| panic!("{name} is not shown")).center();
    session.drag(at, Vec2::ZERO);
}

#[test]
fn the_menu_saves_the_glare() {
    let (folder, mut session) = in_a_folder();
    click(&mut session, "File");
    let at = session.app.control("Save the glare…").unwrap().center();
    for pressed in [true, false] {
        session.frame(vec![Event::PointerMoved(at)]);
        session.frame(vec![session.button(at, pressed)]);
    }
    assert!(session.app.asks());
    session.key(Modifiers::NONE, Key::Enter);
    session.wait(|app| !app.is_writing());
    assert_eq!(session.app.notices(), [] as [String; 0]);
    let mut command = Command::new(env!("CARGO_BIN_EXE_vglare"));
    let path = |name: &str| folder.path().join(name);
    command.args(["apply", "--quiet"]).arg(path("lamp.exr")).arg("-o").arg(path("out.exr"));
    let done = command.args(["--sources", "lights", "--glare"]).arg(path("glare.exr")).output().unwrap();
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    let [window, apply] = ["lamp-glare-alone.exr", "glare.exr"].map(|name| std::fs::read(path(name)).unwrap());
    assert!(window == apply, "the files differ");
}

#[test]
fn a_photo_of_last_time_is_opened_again() {
    let (folder, _) = in_a_folder();
    let mut next = Session::new();
    next.app.remember(State::in_folder(folder.path().join("state")));
    next.settle();
    let path = folder.path().join("lamp.exr");
    click(&mut next, path.to_str().unwrap());
    next.wait(|app| !app.is_reading());
    assert_eq!(next.document().name(), "lamp.exr");
    // One that is gone by now is told of.
    std::fs::remove_file(&path).unwrap();
    drop(next);
    let mut last = Session::new();
    last.app.remember(State::in_folder(folder.path().join("state")));
    last.settle();
    click(&mut last, path.to_str().unwrap());
    last.wait(|app| !app.is_reading());
    assert!(last.app.document().is_none() && last.app.notices()[0].contains("lamp.exr"));
}

#[test]
fn a_picture_that_is_called_off_never_appears() {
    let (folder, mut session) = in_a_folder();
    let path = folder.path().join("window.exr");
    // A small picture may be there before three frames are; not every time.
    const TRIES: usize = 5;
    for _ in 0..TRIES {
        session.app.export(Subject::Picture, &path);
        session.frame(Vec::new());
        if let Some(at) = session.app.control("Cancel writing").map(|control| control.center()) {
            session.frame(vec![Event::PointerMoved(at), session.button(at, true)]);
            session.frame(vec![session.button(at, false)]);
            assert!(!session.app.is_writing(), "the window lets go of it at once");
            session.settle();
            std::thread::sleep(Duration::from_secs(2));
        }
        session.wait(|app| !app.is_writing());
        assert!(session.app.notices().is_empty(), "{:?}", session.app.notices());
        if !path.exists() {
            return;
        }
        std::fs::remove_file(&path).unwrap();
    }
    panic!("all of {TRIES} pictures that were called off appeared");
}

#[test]
fn a_window_that_closes_while_it_writes_is_asked_twice() {
    let (folder, mut session) = in_a_folder();
    assert!(session.app.may_close());
    session.app.export(Subject::Picture, &folder.path().join("picture.exr"));
    assert!(!session.app.may_close() && session.app.notices()[0].contains("still being written"));
    session.wait(|app| !app.is_writing());
    assert!(session.app.notices().is_empty() && session.app.may_close());
    session.app.export(Subject::Picture, &folder.path().join("again.exr"));
    assert!(!session.app.may_close() && session.app.may_close());
    let names = std::fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().file_name());
    let left: Vec<_> =
        names.filter(|name| !["lamp.exr", "picture.exr", "state"].iter().any(|known| name == known)).collect();
    assert!(left.is_empty(), "{left:?}");
}

#[test]
fn two_presses_in_one_frame_undo_two_steps() {
    let (_folder, mut session) = in_a_folder();
    for strength in [2.0, 3.0] {
        session.app.document_mut().unwrap().look.strength = strength;
        session.settle();
    }
    let key = |pressed| Event::Key { key: Key::Z, physical_key: None, pressed, repeat: false, modifiers: CTRL };
    session.frame(vec![key(true), key(false), key(true), key(false)]);
    assert_eq!((&session.document().look, session.document().steps()), (&lit(), [false, true]));
}

#[test]
fn what_is_typed_into_an_answer_is_no_shortcut() {
    let (folder, mut session) = in_a_folder();
    session.app.document_mut().unwrap().selected = Some(0);
    let (tone_map, look) = (session.document().viewing.tone_map, session.document().look.clone());
    session.key(CTRL | Modifiers::SHIFT, Key::S);
    // Behind the likely name, and not in its place.
    session.key(Modifiers::NONE, Key::End);
    // A slow frame has the whole path in it: M would mute the light, T choose another tone map.
    let typed = ["m", "t", "l"].map(|text| Event::Text(text.into()));
    let keys = [Key::M, Key::T, Key::L, Key::Enter].map(|key| (key, true));
    let key =
        |(key, pressed)| Event::Key { key, physical_key: None, pressed, repeat: false, modifiers: Modifiers::NONE };
    session.frame(typed.into_iter().chain(keys.map(key)).collect());
    session.frame([Key::M, Key::T, Key::L, Key::Enter].map(|which| key((which, false))).into());
    session.settle();
    assert_eq!((session.document().viewing.tone_map, session.document().viewing.handles), (tone_map, true));
    assert_eq!(session.document().look, look);
    assert!(folder.path().join("lamp.tomlmtl").exists());
}

#[test]
fn a_picture_that_cannot_be_written_is_told_of_and_leaves_nothing() {
    let (folder, mut session) = in_a_folder();
    session.app.export(Subject::Glare, &folder.path().join("none/glare.exr"));
    session.app.export(Subject::Picture, &folder.path().join("picture.docx"));
    session.wait(|app| !app.is_writing());
    assert_eq!(session.app.notices().len(), 2, "{:?}", session.app.notices());
    let names = std::fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect::<Vec<_>>();
    assert!(names.len() == 2 && names.contains(&"lamp.exr".into()) && names.contains(&"state".into()), "{names:?}");
}

#[test]
fn no_photo_is_replaced_by_a_look_the_glare_or_anothers_picture() {
    let (folder, mut session) = in_a_folder();
    let path = |name: &str| folder.path().join(name);
    photo::write(&path("other.exr"), &lamp(), &WriteOptions::default()).unwrap();
    session.app.open(path("other.exr"));
    session.wait(|app| !app.is_reading());
    session.app.save_look(&path("look.toml"));
    let files = ["lamp.exr", "other.exr", "look.toml"].map(path);
    let before = files.clone().map(|path| std::fs::read(path).unwrap());
    let at = |name: &str| folder.path().join("state/..").join(name);
    std::fs::create_dir_all(path("state")).unwrap();
    session.app.save_look(&at("other.exr"));
    session.app.save_look(&at("lamp.exr"));
    session.app.export(Subject::Glare, &at("other.exr"));
    session.app.export(Subject::Picture, &at("lamp.exr"));
    session.app.export(Subject::Picture, &at("look.toml"));
    assert!(!session.app.is_writing());
    // Each is told of once.
    for (notice, name) in session.app.notices().iter().zip(["other.exr", "lamp.exr", "look.toml"]) {
        assert!(notice.contains("would replace") && notice.contains(name), "{notice}");
    }
    assert_eq!(session.app.notices().len(), 3);
    assert!(files.map(|path| std::fs::read(path).unwrap()) == before);
}

#[test]
fn a_bad_look_is_told_of_and_the_old_one_stays() {
    let (folder, mut session) = in_a_folder();
    let path = folder.path().join("look.toml");
    std::fs::write(&path, "[look]\nstrength = 2.5\n").unwrap();
    session.app.open_look(&path);
    session.settle();
    assert_eq!(session.document().look.strength, 2.5);
    let looked = session.document().look.clone();
    std::fs::write(folder.path().join("bad.toml"), "[look]\nstrength = -1\n").unwrap();
    session.app.open_look(&folder.path().join("bad.toml"));
    session.settle();
    assert_eq!(session.document().look, looked);
    assert!(session.app.notices().len() == 1 && session.app.notices()[0].contains("bad.toml: line 2"));
    session.shortcut(CTRL, Key::Z);
    assert_eq!(session.document().look, lit());
}

#[test]
fn a_look_that_changes_on_disk_is_read_again() {
    let (folder, mut session) = in_a_folder();
    let path = folder.path().join("look.toml");
    std::fs::write(&path, "[look]\nstrength = 2.5\n").unwrap();
    session.app.open_look(&path);
    session.settle();
    std::fs::write(&path, "[look]\nstrength = 3.5\n").unwrap();
    let later = std::time::SystemTime::now() + Duration::from_secs(5);
    std::fs::File::options().write(true).open(&path).unwrap().set_modified(later).unwrap();
    session.settle();
    assert_eq!(session.document().look.strength, 3.5);
}

#[test]
fn the_command_line_is_copied_where_there_is_one() {
    let (folder, mut session) = in_a_folder();
    session.app.document_mut().unwrap().look.strength = 0.5;
    session.shortcut(CTRL | Modifiers::SHIFT, Key::C);
    let words = shlex::split(&session.copied[0]).unwrap();
    let path = |name: &str| folder.path().join(name).display().to_string();
    let files = ["vglare", "apply", &path("lamp.exr"), "-o", &path("lamp-glare.exr")];
    assert_eq!(words, [&files[..], &["--sources", "lights", "--strength", "0.5"]].concat());
    // A light by hand needs a file.
    session.app.document_mut().unwrap().lights_mut().clear();
    session.shortcut(CTRL | Modifiers::SHIFT, Key::C);
    assert!(session.copied.len() == 1 && session.app.notices()[0].contains("save the look first"));
    session.app.save_look(&folder.path().join("look.toml"));
    session.shortcut(CTRL | Modifiers::SHIFT, Key::C);
    assert!(session.copied[1].ends_with(&format!("--scene {}", path("look.toml"))), "{}", session.copied[1]);
}

#[test]
fn photos_and_looks_are_remembered() {
    let (folder, mut session) = in_a_folder();
    session.app.document_mut().unwrap().look.size = 1.5;
    session.settle();
    let state = State::in_folder(folder.path().join("state"));
    assert_eq!(state.look().unwrap().unwrap().size, 1.5);
    drop(session);
    let mut next = Session::new();
    next.app.remember(state);
    next.settle();
    assert_eq!(next.app.recent(), [folder.path().join("lamp.exr")] as [PathBuf; 1]);
}
