//! The veil in the window: what `vglare apply` makes of the same look, summed in the background, and only when it has to be.

use std::process::Command;

use tempfile::TempDir;
use vglare::choices::{Border, Mix, Projection};
use vglare::look::{LookLens, Veil};
use vglare::photo::ToneMap;
use vglare::psf::{Name, Parameters};
use vglare::scene::{LensGhost, VeilSection};
use vglare::series::Bell;

use super::files::{apply_with, click};
use super::*;

/// On a plane, which is planned quickly.
fn section(parameters: Parameters) -> VeilSection {
    let projection = Some(Projection::Planar);
    VeilSection { parameters, fov: None, projection, border: None, tolerance: None }
}

fn cie(age: f64) -> Parameters {
    Parameters { age: Some(age), ..Parameters::new(Name::Cie) }
}

fn gaussian(width: f64) -> Parameters {
    Parameters { width: Some(width), scatter: Some(0.4), ..Parameters::new(Name::Gaussian) }
}

/// A look with a veil by these parameters, and a picture of 50°.
fn with_veil(parameters: Parameters) -> Look {
    let veil = Veil::new(&section(parameters), false).unwrap();
    Look { veil: Some(veil), fov: Some(50.0), ..lit() }
}

impl Session {
    /// Takes another look and waits for its veil.
    fn take(&mut self, look: Look) {
        self.app.document_mut().unwrap().set_look(look);
        self.rest();
    }

    fn rest(&mut self) {
        self.settle();
        self.wait(|app| !app.is_veiling());
    }

    /// What the screen has where the photo is.
    fn canvas(&self) -> Vec<[u8; 4]> {
        let (rect, screen) = (self.app.placement().unwrap().rect, self.screen.read());
        let is_inside = |index: usize| {
            let (x, y) = (index as u32 % SIZE[0], index as u32 / SIZE[0]);
            rect.contains(pos2(x as f32 + 0.5, y as f32 + 0.5))
        };
        screen.into_iter().enumerate().filter(|(index, _)| is_inside(*index)).map(|(_, pixel)| pixel).collect()
    }

    fn veils(&self) -> u64 {
        self.app.counts().veils
    }

    /// The largest difference, in codes, of what is seen and of what a picture's pixels are to look like; and how far apart the
    /// brightest and the darkest of these are.
    fn apart(&self, picture: &Photo) -> (f32, f32) {
        let (placement, screen) = (self.app.placement().unwrap(), self.screen.read());
        let viewing = &self.document().viewing;
        let gain = (viewing.exposure as f32).exp2();
        let (mut worst, mut least, mut most) = (0.0f32, f32::INFINITY, 0.0f32);
        for (index, pixel) in picture.pixels.iter().enumerate() {
            let (i, j) = (index % 120, index / 120);
            let at = placement.to_screen(DVec2::new(i as f64 + 0.5, j as f64 + 0.5));
            let seen = screen[at.y as usize * SIZE[0] as usize + at.x as usize];
            let wanted = viewing.tone_map.apply([0, 1, 2].map(|c| gain * pixel[c])).map(code);
            for (seen, wanted) in seen.into_iter().zip(wanted) {
                worst = worst.max((f32::from(seen) - wanted).abs());
                (least, most) = (least.min(wanted), most.max(wanted));
            }
        }
        (worst, most - least)
    }
}

/// The code that a display gets for linear light in 0 to 1.
fn code(light: f32) -> f32 {
    255.0 * if light <= 0.003_130_8 { light * 12.92 } else { 1.055 * light.powf(1.0 / 2.4) - 0.055 }
}

/// The lamp's room with a black wall, open from a file; some of its pixels are darker than black.
fn in_a_folder() -> (TempDir, Session) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("room.exr");
    let mut photo = lamp();
    for (index, pixel) in photo.pixels.iter_mut().enumerate() {
        match index % 120 {
            90.. => *pixel = [0.0, 0.0, 0.0, 1.0],
            70 => pixel[1] = -0.01,
            _ => {}
        }
    }
    photo::write(&path, &photo, &WriteOptions::default()).unwrap();
    // With no veil but those that the tests ask for.
    let mut session = Session::looking(Look { veil: None, ..lit() });
    session.app.open(path);
    session.wait(|app| !app.is_reading());
    let viewing = &mut session.app.document_mut().unwrap().viewing;
    (viewing.handles, viewing.tone_map) = (false, ToneMap::Reinhard);
    session.settle();
    (folder, session)
}

#[test]
fn the_window_shows_the_veil_that_apply_lays_over_the_photo() {
    let (folder, mut session) = in_a_folder();
    let path = |name: &str| folder.path().join(name);
    let plain = Look { veil: None, ..with_veil(cie(25.0)) };
    let eye = lit().through(LookLens::preset("eye").unwrap(), false).unwrap();
    let mut added = with_veil(Parameters::new(Name::Camera));
    added.veil = added.veil.map(|veil| veil.adding(true));
    let tinted = Parameters {
        widths: Some(vec![0.05, 0.3]),
        tints: Some(vec![[1.0, 0.5, 0.0], [0.0, 0.5, 1.0]]),
        scatter: Some(0.3),
        ..Parameters::new(Name::Mixture)
    };
    // Light that is taken from the lamp is composited at every pixel of the photo.
    let taken = Look { mix: Mix::Energy, strength: 0.5, ..with_veil(cie(75.0)) };
    let sphere = VeilSection { projection: None, ..section(cie(60.0)) };
    let sphere = Look { veil: Some(Veil::new(&sphere, false).unwrap()), ..with_veil(cie(60.0)) };
    // How many are summed for each, one after the other.
    let looks = [
        (with_veil(cie(25.0)), 1),
        (with_veil(cie(75.0)), 0),
        (sphere, 1),
        (eye, 1),
        (added, 1),
        (with_veil(tinted), 1),
        (taken, 1),
        (plain, 0),
    ];
    for (at, (look, summed)) in looks.into_iter().enumerate() {
        let before = session.veils();
        session.take(look);
        assert_eq!(session.app.problem(), None, "look {at}");
        assert_eq!(session.veils() - before, summed, "look {at}");
        session.app.save_look(&path("look.toml"));
        apply_with(&path("room.exr"), &path("out.exr"), &path("look.toml"), &path("glare.exr"));
        for (shows, name) in [(Shows::Picture, "out.exr"), (Shows::Glare, "glare.exr"), (Shows::Photo, "room.exr")] {
            session.app.document_mut().unwrap().viewing.shows = shows;
            session.settle();
            let (worst, spread) = session.apart(&photo::read(&path(name)).unwrap());
            // Each veil is within a hundredth of the truth, which is no more than a code and a half.
            assert!(worst <= 3.5 && spread > 20.0, "look {at}, {name}: {worst} codes apart of {spread}");
        }
        session.app.document_mut().unwrap().viewing.shows = Shows::Picture;
        session.settle();
        assert_eq!(session.veils() - before, summed, "the glare alone is no other veil");
        for name in ["look.toml", "out.exr", "glare.exr"] {
            std::fs::remove_file(path(name)).unwrap();
        }
    }
}

#[test]
fn the_window_shows_the_photo_that_remove_cleans() {
    let (folder, mut session) = in_a_folder();
    let path = |name: &str| folder.path().join(name);
    let strong = Look { strength: 0.4, ..with_veil(gaussian(0.3)) };
    for (at, look) in [with_veil(gaussian(0.05)), strong].into_iter().enumerate() {
        session.take(look);
        let with_glare = session.canvas();
        session.app.save_look(&path("look.toml"));
        let status = Command::new(env!("CARGO_BIN_EXE_vglare"))
            .args(["remove", "--quiet", "--force", "--allow-floor"])
            .arg(path("room.exr"))
            .args(["-o".into(), path("clean.exr"), "--scene".into(), path("look.toml")])
            .status()
            .unwrap();
        assert!(status.success());
        session.app.document_mut().unwrap().viewing.shows = Shows::Clean;
        session.rest();
        session.settle();
        let removals = at as u64 + 1;
        assert_eq!((session.app.counts().removals, session.app.problem()), (removals, None));
        let (worst, spread) = session.apart(&photo::read(&path("clean.exr")).unwrap());
        assert!(worst <= 1.5 && spread > 20.0, "look {at}: {worst} codes apart of {spread}");
        let clean = session.canvas();
        assert!(clean != with_glare, "look {at}");
        // Away and back again costs no other.
        session.app.document_mut().unwrap().viewing.shows = Shows::Picture;
        session.settle();
        assert!(session.canvas() == with_glare, "look {at}");
        session.app.document_mut().unwrap().viewing.shows = Shows::Clean;
        session.settle();
        assert!(session.canvas() == clean && session.app.counts().removals == removals, "look {at}");
        session.app.document_mut().unwrap().viewing.shows = Shows::Picture;
        session.settle();
        std::fs::remove_file(path("look.toml")).unwrap();
    }
}

/// Where no answer can be proved, the window says so, and shows the photo.
#[test]
fn a_veil_that_cannot_be_taken_away_leaves_the_photo() {
    let (folder, mut session) = in_a_folder();
    let gaussian = Parameters { scatter: Some(0.9), ..gaussian(0.05) };
    let mirrored = VeilSection { border: Some(Border::Mirror), ..section(gaussian.clone()) };
    session.take(Look { veil: Some(Veil::new(&mirrored, false).unwrap()), ..with_veil(gaussian) });
    session.app.document_mut().unwrap().viewing.shows = Shows::Clean;
    session.rest();
    session.settle();
    assert_eq!(session.app.counts().removals, 0);
    let (worst, spread) = session.apart(&photo::read(&folder.path().join("room.exr")).unwrap());
    assert!(worst <= 1.5 && spread > 20.0, "{worst} codes apart of {spread}");
}

#[test]
fn strength_scatter_age_and_pigment_cost_a_composite_and_no_veil() {
    let (_folder, mut session) = in_a_folder();
    session.take(with_veil(cie(25.0)));
    let wall = session.at(DVec2::new(1.2, 0.0));
    let mut before = (session.app.counts(), session.brightness(wall));
    assert_eq!(before.0.veils, 1);
    let mut changes: Vec<Look> = Vec::new();
    let look = session.document().look.clone();
    changes.push(Look { strength: 0.5, ..look.clone() });
    changes.push(Look { strength: 1.5, ..look.clone() });
    changes.push(with_veil(Parameters { scatter: Some(0.1), ..cie(25.0) }));
    changes.push(with_veil(Parameters { scatter: Some(0.8), ..cie(25.0) }));
    changes.push(with_veil(cie(90.0)));
    changes.push(with_veil(Parameters { pigment: Some(1.2), ..cie(60.0) }));
    for change in changes {
        session.app.document_mut().unwrap().look = change;
        session.frame(Vec::new());
        assert!(!session.app.is_veiling(), "nothing is summed");
        let now = (session.app.counts(), session.brightness(wall));
        assert_eq!((now.0.veils, now.0.spectra), (before.0.veils, before.0.spectra));
        assert_eq!(now.0.composites, before.0.composites + 1);
        assert_ne!(now.1, before.1, "it is seen at once");
        before = now;
    }
    // At rest, nothing is computed.
    session.settle();
    session.frame(Vec::new());
    assert_eq!((session.app.counts(), session.due > Duration::from_secs(1)), (before.0, true));
}

#[test]
fn a_drag_of_what_has_to_be_summed_ends_with_the_veil_that_is_set() {
    let (_folder, mut session) = in_a_folder();
    session.take(with_veil(gaussian(0.5)));
    for width in [0.4, 0.3, 0.2, 0.1, 0.05, 0.02] {
        session.app.document_mut().unwrap().look = with_veil(gaussian(width));
        session.frame(Vec::new());
    }
    session.rest();
    let dragged = session.screen.read();
    assert!(session.veils() <= 7, "no more than there were changes");
    session.app.document_mut().unwrap().look = with_veil(gaussian(0.3));
    session.rest();
    assert!(session.screen.read() != dragged);
    session.app.document_mut().unwrap().look = with_veil(gaussian(0.02));
    session.rest();
    assert!(session.screen.read() == dragged);
}

#[test]
fn what_a_veil_lacks_is_said_and_the_picture_stays() {
    let (_folder, mut session) = in_a_folder();
    let before = session.app.counts();
    for (look, words) in [
        (Look { fov: None, ..with_veil(cie(25.0)) }, "field of view"),
        (Look { strength: 10.0, ..with_veil(cie(25.0)) }, "give less"),
        (Look { normalize: vglare::choices::Normalize::Minmax, ..with_veil(cie(25.0)) }, "only that glare is physical"),
        (Look { fov: Some(720.0), ..with_veil(cie(25.0)) }, "from 0.1 to 179 degrees"),
    ] {
        session.take(look);
        assert!(session.app.problem().is_some_and(|said| said.contains(words)), "{:?}", session.app.problem());
        let now = session.app.counts();
        assert_eq!((now.veils, now.composites), (before.veils, before.composites));
    }
    // What only the plan finds out is said as well, and the ghosts are there.
    let narrow = Parameters { widths: Some(vec![1e-3, 2.0]), scatter: Some(0.5), ..Parameters::new(Name::Mixture) };
    let mut look = with_veil(narrow);
    look.veil =
        Some(Veil::new(&VeilSection { tolerance: Some(1e-12), ..look.veil.unwrap().section() }, false).unwrap());
    session.take(look);
    assert!(session.app.problem().is_some_and(|said| said.contains("below")), "{:?}", session.app.problem());
    session.take(with_veil(cie(25.0)));
    assert_eq!((session.app.problem(), session.veils()), (None, 1));
    assert!(session.app.notices().is_empty(), "{:?}", session.app.notices());
}

#[test]
fn a_preset_brings_its_veil_and_undo_takes_both_away() {
    let mut session = Session::with_photo();
    let mut before = Vec::new();
    for (name, has_veil, has_ghosts) in
        [("eye", true, false), ("none", false, false), ("zoom", true, true), ("classic-veil", true, false)]
    {
        before.push(session.document().look.clone());
        click(&mut session, "Lens");
        click(&mut session, &format!("choose {name}"));
        session.rest();
        let look = &session.document().look;
        assert_eq!((look.veil.is_some(), session.app.problem()), (has_veil, None), "{name}");
        assert_eq!((look.lens().name.as_str(), !look.lens_ghosts().is_empty()), (name, has_ghosts));
    }
    for look in before.into_iter().rev() {
        session.shortcut(CTRL, Key::Z);
        session.rest();
        assert_eq!(session.document().look, look);
    }
    assert_eq!(session.document().look, lit());
}

#[test]
fn a_lens_by_hand_keeps_the_veil() {
    let mut session = Session::with_photo();
    session.take(lit().through(LookLens::preset("classic-veil").unwrap(), false).unwrap());
    let veil = session.document().look.veil.clone();
    let bell = Bell::Gaussian;
    let row = LensGhost { bell, along: -1.0, size: DVec2::splat(0.1), tint: [1.0; 3], share: 1e-3 };
    session.app.document_mut().unwrap().look.add_lens_ghost(row);
    session.rest();
    assert_eq!((&session.document().look.veil, session.veils()), (&veil, 1));
}

#[test]
fn another_photo_has_a_veil_of_its_own() {
    let (_folder, mut session) = in_a_folder();
    session.take(with_veil(gaussian(0.2)));
    let other = Photo::new(120, 80, lamp().pixels.into_iter().rev().collect());
    session.app.add(Document::new(Path::new("other.exr"), other, with_veil(gaussian(0.2))));
    session.rest();
    let shown = session.screen.read();
    // Back and forth: nothing of one lies over the other.
    for _ in 0..2 {
        session.shortcut(CTRL, Key::Tab);
        session.rest();
    }
    assert!(session.screen.read() == shown);
}

#[test]
fn a_table_is_asked_for_by_its_path() {
    let (folder, mut session) = in_a_folder();
    let path = folder.path().join("halo.csv");
    std::fs::write(&path, "0.01,1\n0.1,0.1\n1,0.001\n").unwrap();
    click(&mut session, "Function");
    let at = session.app.control("choose table").unwrap().center();
    for pressed in [true, false] {
        session.frame(vec![Event::PointerMoved(at)]);
        session.frame(vec![session.button(at, pressed)]);
    }
    session.frame(Vec::new());
    assert!(session.app.asks() && session.document().look.veil.is_none());
    // What is typed replaces what was likely.
    session.frame(vec![Event::Text(path.display().to_string())]);
    session.key(Modifiers::NONE, Key::Enter);
    session.rest();
    let parameters = session.document().look.veil.as_ref().unwrap().section().parameters;
    assert_eq!((parameters.psf, parameters.table), (Name::Table, Some(path)));
    assert_eq!((session.app.problem(), session.veils()), (None, 1));
}

/// Needs a whole program: what it is told to open with brings its veil.
#[test]
fn the_program_opens_with_the_veil_of_its_preset() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    photo::write(&path("lamp.exr"), &lamp(), &WriteOptions::default()).unwrap();
    std::fs::write(path("script.json"), r#"["load", "rest"]"#).unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_vglare"));
    command.arg("view").arg(path("lamp.exr")).args(["--preset", "eye", "--script"]).arg(path("script.json"));
    let output = command.arg("--script-output").arg(path("out")).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let steps: serde_json::Value = serde_json::from_slice(&std::fs::read(path("out/steps.json")).unwrap()).unwrap();
    assert_eq!((&steps[1]["counts"]["veils"], &steps[1]["busy"]), (&1.into(), &false.into()), "{steps}");
}
