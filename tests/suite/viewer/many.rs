//! Many photos at once take no more memory than is meant, and none of what was set is lost.

use vglare::photo::{self, Photo, WriteOptions};
use vglare::viewer::App;

use super::*;

/// A session with room for the pixels of two photos, and five of them open.
fn five() -> (tempfile::TempDir, Session, usize) {
    let folder = tempfile::tempdir().unwrap();
    let mut session = Session::new();
    let bytes = 16 * lamp().pixels.len();
    session.app.keep_pixels(2 * bytes);
    for name in 0..5 {
        let path = folder.path().join(format!("{name}.exr"));
        let mut photo: Photo = lamp();
        photo.pixels.iter_mut().for_each(|pixel| pixel[0] += 0.01 * name as f32);
        photo::write(&path, &photo, &WriteOptions::default()).unwrap();
        session.app.open(path);
        session.wait(|app| !app.is_reading());
    }
    (folder, session, bytes)
}

fn next(session: &mut Session) -> String {
    session.shortcut(CTRL, Key::Tab);
    session.wait(|app: &App| !app.is_reading());
    session.app.title()
}

#[test]
fn pixels_beyond_the_budget_are_let_go_and_read_again() {
    let (_folder, mut session, bytes) = five();
    assert_eq!(session.app.pixel_bytes(), 2 * bytes);
    session.app.document_mut().unwrap().look.strength = 2.5;
    session.settle();
    let titles: Vec<_> = (0..5).map(|_| next(&mut session)).collect();
    assert_eq!(titles, ["0", "1", "2", "3", "4"].map(|name| format!("{name}.exr – vglare")));
    assert_eq!(session.app.pixel_bytes(), 2 * bytes);
    let document = session.app.document().unwrap();
    assert_eq!((document.look.strength, document.steps()), (2.5, [true, false]), "what was set is there");
    assert!((document.pixels()[0][0] - lamp().pixels[0][0] - 0.04).abs() < 1e-6, "and so are its own pixels");
    assert!(session.app.notices().is_empty() && session.app.plan().is_some());
    session.app.document_mut().unwrap().undo();
    assert_eq!(session.app.document().unwrap().look.strength, 1.0);
}

#[test]
fn a_photo_that_is_gone_by_then_is_told_once() {
    let (folder, mut session, _) = five();
    std::fs::remove_file(folder.path().join("0.exr")).unwrap();
    assert_eq!(next(&mut session), "0.exr – vglare");
    session.settle();
    let [notice] = session.app.notices() else { panic!("{:?}", session.app.notices()) };
    assert!(notice.contains("0.exr") && notice.contains("No such file"), "{notice}");
    assert_eq!(next(&mut session), "1.exr – vglare");
    assert!(session.app.plan().is_some());
}
