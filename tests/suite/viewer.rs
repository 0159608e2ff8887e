//! The window without a window: events in, state and pixels out, and nothing computed that did not change.

mod files;
mod ghosts;
mod many;
mod veil;

use std::path::Path;
use std::rc::Rc;
use std::sync::Arc;
use std::time::{Duration, Instant};

use egui::{Event, Key, Modifiers, PointerButton, Pos2, RawInput, Rect, Vec2, pos2, vec2};
use glam::DVec2;
use vglare::choices::Sources;
use vglare::gpu::{Backend, Device, Screen};
use vglare::look::{Look, LookLights};
use vglare::photo::{self, Missing, Photo, ReadOptions, WriteOptions};
use vglare::plan::Evaluator;
use vglare::scene::Goal;
use vglare::viewer::{App, Document, Shows};

use crate::support::{Turn, lit, turn};

const SIZE: [u32; 2] = [900, 500];
/// The key, as winit tells of it.
const CTRL: Modifiers = Modifiers { ctrl: true, command: true, ..Modifiers::NONE };

/// A person at a screen that nobody sees.
struct Session {
    device: Rc<Device>,
    app: App,
    screen: Screen,
    time: f64,
    due: Duration,
    copied: Vec<String>,
    _turn: Turn,
}

impl Session {
    fn new() -> Self {
        Self::looking(lit())
    }

    /// With a look that photos are opened with.
    fn looking(look: Look) -> Self {
        let turn = turn();
        // Pictures are written on EGL, beside the window's own context as under a real window.
        let device = Device::open(&[Backend::OsMesa]).unwrap();
        let app = App::new(&device, look, Arc::new(|| {})).unwrap();
        let screen = Screen::hidden(&device, SIZE).unwrap();
        Self { device, app, screen, time: 0.0, due: Duration::ZERO, copied: Vec::new(), _turn: turn }
    }

    /// With a synthetic photo open.
    fn with_photo() -> Self {
        let mut session = Self::new();
        session.app.add(Document::new(Path::new("lamp.exr"), lamp(), lit()));
        // The lens's veil is laid over the picture whenever it is there.
        session.wait(|app| !app.is_veiling());
        session
    }

    fn frame(&mut self, events: Vec<Event>) {
        self.time += 0.02;
        let size = self.screen.size().map(|side| side as f32);
        let rect = Rect::from_min_size(Pos2::ZERO, vec2(size[0], size[1]));
        let time = Some(self.time);
        let input = RawInput { screen_rect: Some(rect), time, events, focused: true, ..RawInput::default() };
        let shown = self.app.frame(input, &self.screen).unwrap();
        self.due = shown.repaint_after;
        let copied = shown.platform.commands.into_iter().filter_map(|command| match command {
            egui::OutputCommand::CopyText(text) => Some(text),
            _ => None,
        });
        self.copied.extend(copied);
    }

    /// Frames until what goes on in the background has come to an end.
    fn wait(&mut self, until: impl Fn(&App) -> bool) {
        let started = Instant::now();
        while !until(&self.app) {
            assert!(started.elapsed() < Duration::from_secs(60), "it never comes to an end");
            std::thread::sleep(Duration::from_millis(5));
            self.frame(Vec::new());
        }
        self.settle();
    }

    /// Frames until nothing moves any more.
    fn settle(&mut self) {
        for _ in 0..100 {
            self.frame(Vec::new());
            if self.due > Duration::from_secs(1) {
                return;
            }
        }
        panic!("it never comes to rest");
    }

    fn button(&self, pos: Pos2, pressed: bool) -> Event {
        Event::PointerButton { pos, button: PointerButton::Primary, pressed, modifiers: Modifiers::NONE }
    }

    fn drag(&mut self, from: Pos2, by: Vec2) {
        self.frame(vec![Event::PointerMoved(from)]);
        self.frame(vec![self.button(from, true)]);
        for step in 1..=8 {
            self.frame(vec![Event::PointerMoved(from + by * (step as f32 / 8.0))]);
        }
        self.frame(vec![self.button(from + by, false)]);
        self.frame(vec![Event::PointerMoved(pos2(2.0, 2.0))]);
        self.settle();
    }

    fn press(&mut self, key: Key) {
        self.shortcut(Modifiers::NONE, key);
    }

    fn shortcut(&mut self, modifiers: Modifiers, key: Key) {
        self.key(modifiers, key);
        self.settle();
    }

    /// A key without rest afterwards: a cursor that blinks never comes to rest.
    fn key(&mut self, modifiers: Modifiers, key: Key) {
        for pressed in [true, false] {
            self.frame(vec![Event::Key { key, physical_key: None, pressed, repeat: false, modifiers }]);
        }
    }

    fn document(&self) -> &Document {
        self.app.document().unwrap()
    }

    /// Where a point of the picture plane is on the screen.
    fn at(&self, position: DVec2) -> Pos2 {
        self.app.placement().unwrap().to_screen(self.document().place(position))
    }

    /// Red, green and blue on the screen at a point, added up.
    fn brightness(&self, at: Pos2) -> u32 {
        let pixel = self.screen.read()[at.y as usize * SIZE[0] as usize + at.x as usize];
        pixel[..3].iter().map(|&code| u32::from(code)).sum()
    }
}

/// A dark room with one lamp.
fn lamp() -> Photo {
    let pixel = |i: i32, j: i32| {
        let light = if (i - 40).pow(2) + (j - 20).pow(2) < 9 { 400.0 } else { 0.02 };
        [light, light, light * 0.8, 1.0]
    };
    Photo::new(120, 80, (0..80).flat_map(|j| (0..120).map(move |i| pixel(i, j))).collect())
}

#[test]
fn a_light_is_dragged_and_only_the_spectrum_is_computed_anew() {
    let mut session = Session::new();
    session.app.add(Document::new(Path::new("lamp.exr"), lamp(), Look { veil: None, ..lit() }));
    session.settle();
    let light = session.document().lights()[0].position;
    let (before, from) = (session.app.counts(), session.at(light));
    assert_eq!((before.uploads, before.spectra, before.composites), (1, 1, 1));
    let dark = session.at(DVec2::new(0.3, 0.7));
    let was = session.brightness(dark);
    session.drag(from, dark - from);
    let moved = session.document().lights()[0].position;
    assert!((moved - DVec2::new(0.3, 0.7)).length() < 0.02, "{moved}");
    assert!(session.brightness(dark) > was + 30, "{} after {was}", session.brightness(dark));
    let after = session.app.counts();
    assert_eq!(after.uploads, 1);
    assert!(after.spectra > before.spectra && after.composites - before.composites == after.spectra - before.spectra);
    assert_eq!(session.document().selected, Some(0));
}

#[test]
fn a_light_can_be_dragged_off_the_picture() {
    let mut session = Session::with_photo();
    let from = session.at(session.document().lights()[0].position);
    let canvas = session.app.placement().unwrap().rect;
    session.drag(from, vec2(0.0, canvas.top() + 1.0 - from.y));
    let y = session.document().lights()[0].position.y;
    assert!(y > 1.0, "{y}");
}

#[test]
fn the_strength_slider_asks_for_composites_only() {
    let mut session = Session::with_photo();
    let before = session.app.counts();
    let rail = session.app.control("Strength").unwrap();
    session.drag(rail.center(), vec2(rail.width(), 0.0));
    assert_eq!(session.document().look.strength, 10.0);
    let after = session.app.counts();
    assert_eq!((after.uploads, after.spectra), (before.uploads, before.spectra));
    assert!(after.composites > before.composites);
}

#[test]
fn before_and_after_change_places_without_computing() {
    let mut session = Session::with_photo();
    let beside = session.at(session.document().lights()[0].position + DVec2::new(0.2, 0.0));
    let (counts, after) = (session.app.counts(), session.screen.read());
    let bright = session.brightness(beside);
    session.press(Key::B);
    assert_eq!(session.document().viewing.shows, Shows::Photo);
    assert!(session.brightness(beside) < bright);
    session.press(Key::B);
    let now = session.app.counts();
    assert_eq!((now.uploads, now.spectra, now.composites), (counts.uploads, counts.spectra, counts.composites));
    assert!(session.screen.read() == after, "the picture comes back as it was");
}

#[test]
fn without_its_constant_term_the_glare_is_darker() {
    let mut session = Session::with_photo();
    let document = session.app.document_mut().unwrap();
    document.look.accuracy.evaluator = Some(Evaluator::Rows);
    document.viewing.shows = Shows::Glare;
    document.viewing.exposure = 3.0;
    session.settle();
    let beside = session.at(session.document().lights()[0].position + DVec2::new(0.2, 0.0));
    let (counts, with) = (session.app.counts(), session.brightness(beside));
    session.app.document_mut().unwrap().viewing.without_constant = true;
    session.settle();
    assert!(session.brightness(beside) < with, "{with}");
    session.app.document_mut().unwrap().viewing.without_constant = false;
    session.settle();
    let now = session.app.counts();
    assert_eq!((session.brightness(beside), now.spectra), (with, counts.spectra));
}

#[test]
fn passes_and_painter_leave_each_other_alone() {
    let mut session = Session::with_photo();
    let first = session.screen.read();
    session.press(Key::G);
    assert!(session.screen.read() != first);
    // The picture is drawn anew after many frames of egui's.
    session.press(Key::G);
    assert!(session.screen.read() == first);
}

#[test]
fn an_idle_frame_computes_nothing_and_asks_for_no_other() {
    let mut session = Session::with_photo();
    let counts = session.app.counts();
    session.frame(Vec::new());
    let now = session.app.counts();
    assert_eq!((now.uploads, now.spectra, now.composites), (counts.uploads, counts.spectra, counts.composites));
    assert!(session.due > Duration::from_secs(1), "{:?}", session.due);
}

#[test]
fn a_bad_file_is_told_of_and_the_picture_stays() {
    let folder = tempfile::tempdir().unwrap();
    let good = folder.path().join("good.exr");
    photo::write(&good, &lamp(), &WriteOptions::default()).unwrap();
    let mut session = Session::new();
    for path in [good, folder.path().join("missing.exr")] {
        session.app.open(path);
        session.wait(|app| !app.is_reading());
    }
    assert_eq!(session.document().name(), "good.exr");
    assert!(session.app.notices().len() == 1 && session.app.notices()[0].contains("missing.exr"));
    let lit = session.at(session.document().lights()[0].position);
    assert!(session.brightness(lit) > 600);
}

#[test]
fn what_is_said_of_how_a_photo_was_read_is_said_here_too() {
    let unfinished = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/inputs/exr-unfinished-render.exr");
    let mut session = Session::new();
    for (missing, words, is_open) in
        [(Missing::Refuse, "--missing zero", false), (Missing::Zero, "their pixels are 0", true)]
    {
        session.app.read_by(ReadOptions { missing, ..ReadOptions::default() });
        session.app.open(unfinished.clone());
        session.wait(|app| !app.is_reading());
        let last = session.app.notices().last().unwrap();
        assert!(last.contains("exr-unfinished-render.exr: ") && last.contains(words), "{last}");
        assert_eq!(session.app.document().is_some(), is_open);
    }
}

#[test]
fn a_look_that_cannot_be_is_told_of_and_the_picture_stays() {
    let mut session = Session::with_photo();
    let before = session.app.counts();
    session.app.document_mut().unwrap().look.accuracy.goal = Goal::Tolerance(1e-12);
    session.settle();
    assert!(session.app.problem().unwrap().contains("below what can be had here"), "{:?}", session.app.problem());
    let now = session.app.counts();
    assert_eq!((now.spectra, now.composites), (before.spectra, before.composites));
    let lit = session.at(session.document().lights()[0].position);
    assert!(session.brightness(lit) > 600);
    session.app.document_mut().unwrap().look.accuracy.allow_floor = true;
    session.settle();
    assert_eq!(session.app.problem(), None);
    assert_eq!(session.app.counts().spectra, before.spectra + 1);
}

#[test]
fn a_drag_is_one_step() {
    let mut session = Session::with_photo();
    let from = session.at(session.document().lights()[0].position);
    session.drag(from, vec2(60.0, 30.0));
    session.press(Key::M);
    assert!(session.document().lights()[0].muted);
    session.shortcut(CTRL, Key::Z);
    assert!(!session.document().lights()[0].muted);
    let moved = session.document().lights()[0].position;
    session.shortcut(CTRL, Key::Z);
    assert_eq!((&session.document().look, session.document().steps()), (&lit(), [false, true]));
    session.shortcut(CTRL, Key::Y);
    assert_eq!(session.document().lights()[0].position, moved);
    session.shortcut(CTRL | Modifiers::SHIFT, Key::Z);
    assert!(session.document().lights()[0].muted);
}

#[test]
fn every_pixel_is_a_source_until_lights_are_asked_for() {
    let mut session = Session::new();
    session.app.add(Document::new(Path::new("lamp.exr"), lamp(), Look::default()));
    session.wait(|app| !app.is_veiling());
    assert_eq!((session.app.problem(), session.document().lights().len()), (None, 0));
    assert_eq!(session.document().found.lights.len(), 1, "they are known");
    // In the middle of a ghost, far from the lamp, where the veil is thin.
    let ghost = session.document().look.lens.ghosts()[0].along * session.document().found.lights[0].position;
    let ghost = session.at(ghost);
    let lit = session.brightness(ghost);
    session.press(Key::B);
    assert!(lit > session.brightness(ghost) + 10, "the lamp's pixels shine");
    session.press(Key::B);
    // A threshold is one of all pixels, and counts at once.
    session.app.document_mut().unwrap().look.find.threshold = Some(1e6);
    session.settle();
    assert!(session.brightness(ghost) + 10 < lit && session.app.problem().is_none());
    session.shortcut(CTRL, Key::Z);
    assert_eq!(session.brightness(ghost), lit);
    session.app.document_mut().unwrap().look.lights = LookLights::Found;
    session.settle();
    assert_eq!((session.app.problem(), session.document().lights().len()), (None, 1));
    session.app.document_mut().unwrap().look.shine_by(Sources::Photo);
    session.settle();
    assert_eq!(session.document().look, Look::default());
    session.shortcut(CTRL, Key::Z);
    assert_eq!(session.document().look, crate::support::lit());
}

#[test]
fn other_rules_search_the_photo_anew() {
    let mut session = Session::with_photo();
    assert_eq!(session.document().lights().len(), 1);
    session.app.document_mut().unwrap().look.find.threshold = Some(1e6);
    session.wait(|app| !app.document().unwrap().wants_search());
    assert!(session.document().lights().is_empty());
    assert_eq!(session.app.counts().spectra, 2);
    session.shortcut(CTRL, Key::Z);
    assert_eq!(session.document().look.find.threshold, None);
}
