//! The panels that look into a picture: what they show is true, costs nothing at rest, and looks as it did.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use egui::{Event, Key, Modifiers, PointerButton, Pos2, RawInput, Rect, Theme, pos2, vec2};
use glam::DVec2;
use image::RgbImage;
use vglare::choices::{Evaluator, Mix, Normalize};
use vglare::gpu::{Backend, Device, Screen};
use vglare::look::{Accuracy, Look};
use vglare::photo::{Photo, ToneMap};
use vglare::reference;
use vglare::scene::{FindOptions, Ghost, Goal};
use vglare::series::Bell;
use vglare::viewer::{App, Cut, Document, KEYS, Plot, Shows, Told, Viewing};

const SIZE: [u32; 2] = [1000, 1500];
/// Set, the golden pictures are written instead of compared with.
const BLESS: &str = "VGLARE_BLESS_UI";

struct Session {
    app: App,
    screen: Screen,
    time: f64,
    due: Duration,
}

impl Session {
    /// With a synthetic photo open, on a screen of so many pixels.
    fn of_size(size: [u32; 2]) -> Self {
        let device = Device::open(&Backend::ALL).unwrap();
        let app = App::new(&device, Look::default(), Arc::new(|| {})).unwrap();
        let screen = Screen::hidden(&device, size).unwrap();
        let mut session = Self { app, screen, time: 0.0, due: Duration::ZERO };
        session.app.add(Document::new(Path::new("lamp.exr"), lamp(), Look::default()));
        session.settle();
        session
    }

    /// With a synthetic photo open, only this panel besides, and what it studies known.
    fn with(open: &str, theme: Theme) -> Self {
        let mut session = Self::of_size(SIZE);
        session.app.context().set_theme(theme);
        session.settle();
        for (title, is_open) in [("Look", true), ("View", true), ("Lights", true), ("Accuracy", true), ("Plots", false)]
        {
            if (title == open) != is_open {
                session.click(title);
            }
        }
        session
    }

    fn document(&mut self) -> &mut Document {
        self.app.document_mut().unwrap()
    }

    fn frame(&mut self, events: Vec<Event>) {
        self.time += 0.05;
        let size = self.screen.size().map(|side| side as f32);
        let rect = Rect::from_min_size(Pos2::ZERO, vec2(size[0], size[1]));
        let input =
            RawInput { screen_rect: Some(rect), time: Some(self.time), events, focused: true, ..RawInput::default() };
        self.due = self.app.frame(input, &self.screen).unwrap().repaint_after;
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

    /// Frames until something is known.
    fn wait(&mut self, known: impl Fn(&App) -> bool) {
        let started = Instant::now();
        self.settle();
        while !known(&self.app) {
            assert!(started.elapsed() < Duration::from_secs(60), "it never becomes known");
            std::thread::sleep(Duration::from_millis(5));
            self.settle();
        }
        self.settle();
    }

    fn click(&mut self, name: &str) {
        let pos = self.app.control(name).unwrap_or_else(|| panic!("{name} is not shown")).center();
        let button =
            |pressed| Event::PointerButton { pos, button: PointerButton::Primary, pressed, modifiers: Modifiers::NONE };
        self.frame(vec![Event::PointerMoved(pos)]);
        self.frame(vec![button(true)]);
        self.frame(vec![button(false)]);
        self.frame(vec![Event::PointerMoved(pos2(2.0, 2.0))]);
        self.settle();
    }

    /// Clicks twice, or with the other button, in the middle of a rectangle.
    fn go_back(&mut self, told: &Told) {
        let secondary = told.reset.ends_with("a secondary click");
        let (button, times) = if secondary { (PointerButton::Secondary, 1) } else { (PointerButton::Primary, 2) };
        // The name is at the left of its column.
        let pos = if secondary { told.part.center() } else { told.label.left_center() + vec2(3.0, 0.0) };
        let event = |pressed| Event::PointerButton { pos, button, pressed, modifiers: Modifiers::NONE };
        // Long after what was clicked before, so that it is no part of a double click.
        self.time += 1.0;
        self.frame(vec![Event::PointerMoved(pos)]);
        for _ in 0..times {
            self.frame(vec![event(true)]);
            self.frame(vec![event(false)]);
        }
        self.frame(vec![Event::PointerMoved(pos2(2.0, 2.0))]);
    }

    fn press(&mut self, key: Key) {
        for pressed in [true, false] {
            let modifiers = Modifiers::NONE;
            self.frame(vec![Event::Key { key, physical_key: None, pressed, repeat: false, modifiers }]);
        }
    }

    fn told(&self, name: &str) -> Told {
        let told = self.app.controls().into_iter().find(|told| told.name == name);
        told.unwrap_or_else(|| panic!("{name} is not shown"))
    }

    fn plot(&mut self, plot: Plot) {
        self.document().viewing.wanted.plot = plot;
        self.wait(|app| match plot {
            Plot::Off => true,
            Plot::Spectrum => app.study().spectrum().is_some(),
            Plot::Section => app.study().section().is_some(),
            Plot::Convergence => app.study().convergence().is_some(),
        });
    }

    fn picture(&self) -> RgbImage {
        let pixels = self.screen.read();
        RgbImage::from_fn(SIZE[0], SIZE[1], |x, y| {
            let [r, g, b, _] = pixels[(y * SIZE[0] + x) as usize];
            image::Rgb([r, g, b])
        })
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

fn certified(app: &App) -> bool {
    app.study().certificate().is_some()
}

#[test]
fn the_tolerance_changes_the_plan_and_the_look_keeps_the_rest() {
    let mut session = Session::with("Accuracy", Theme::Dark);
    let (before, plan) = (session.document().look.clone(), session.app.plan().unwrap().clone());
    session.click("Tolerance");
    let after = session.document().look.clone();
    let Goal::Tolerance(tolerance) = after.accuracy.goal else { panic!("still a tolerance") };
    assert_ne!(after.accuracy.goal, before.accuracy.goal);
    assert_eq!(session.app.plan().unwrap().tolerance, tolerance);
    assert_ne!(session.app.plan().unwrap(), &plan);
    let mut back = after;
    back.accuracy.goal = before.accuracy.goal;
    assert_eq!(back, before);
}

#[test]
fn the_measured_error_appears_and_is_within_the_prediction() {
    let mut session = Session::with("Accuracy", Theme::Dark);
    for evaluator in [None, Some(Evaluator::Direct), Some(Evaluator::Series)] {
        session.document().look.accuracy.evaluator = evaluator;
        session.frame(Vec::new());
        if evaluator.is_some() {
            assert!(!certified(&session.app), "what was known is of another picture");
        }
        session.wait(certified);
        let found = session.app.study().certificate().unwrap();
        let predicted = session.app.plan().unwrap().predicted.total();
        assert!(found.measured > 0.0 && found.measured <= found.predicted, "{evaluator:?}: {found:?}");
        assert_eq!(found.predicted, predicted);
    }
}

#[test]
fn nothing_is_measured_while_something_moves() {
    let mut session = Session::with("Accuracy", Theme::Dark);
    session.wait(certified);
    let studies = session.app.counts().studies;
    for step in 0..10 {
        session.document().look.axis.x = 0.01 * f64::from(step + 1);
        session.frame(Vec::new());
    }
    assert_eq!(session.app.counts().studies, studies);
    session.wait(certified);
    assert_eq!(session.app.counts().studies, studies + 1);
}

#[test]
fn the_cross_section_is_the_field_and_the_truth_along_the_line() {
    let mut session = Session::with("Plots", Theme::Dark);
    for (horizontal, at, fixed) in [(true, 0.25, 20), (false, 0.5, 60)] {
        session.document().viewing.wanted.cut = Cut { horizontal, at };
        session.plot(Plot::Section);
        let wanted = if horizontal { 120 } else { 80 };
        session.wait(|app| app.study().section().is_some_and(|points| points.len() == wanted));
        let plan = session.app.plan().unwrap().clone();
        let document = session.app.document().unwrap();
        let ghosts = document.look.gather(&document.photo).ghosts;
        for (k, point) in session.app.study().section().unwrap().iter().enumerate() {
            let k = k as i32;
            assert_eq!(point.pixel, if horizontal { [k, fixed] } else { [fixed, k] });
            let [i, j] = point.pixel.map(f64::from);
            let exact = reference::direct(&ghosts, document.frame.position(i, j));
            assert_eq!(point.exact, exact);
            for ((rendered, exact), scale) in point.rendered.iter().zip(exact).zip(plan.scale) {
                assert!((rendered - exact).abs() <= 1.01 * scale * plan.predicted.total(), "{point:?}");
            }
        }
    }
}

#[test]
fn a_higher_degree_is_never_predicted_to_truncate_more() {
    let mut session = Session::with("Plots", Theme::Dark);
    session.plot(Plot::Convergence);
    let degrees = session.app.study().convergence().unwrap();
    assert!(degrees.len() > 4, "{degrees:?}");
    assert!(degrees.windows(2).all(|pair| pair[0].degree < pair[1].degree), "{degrees:?}");
    assert!(degrees.windows(2).all(|pair| pair[1].truncation <= pair[0].truncation * 1.001), "{degrees:?}");
    assert!(degrees.last().unwrap().truncation < 0.5 * degrees[0].truncation, "{degrees:?}");
}

#[test]
fn false_colours_lie_over_the_picture_and_go_again() {
    let mut session = Session::with("Accuracy", Theme::Dark);
    session.wait(certified);
    let was = session.picture();
    session.document().viewing.wanted.error_map = true;
    // Down to a pixel each: the photo is small.
    session.wait(|app| app.study().error_map().is_some_and(|texture| texture.size() == [120, 80]));
    let canvas = session.app.placement().unwrap().rect;
    let (x, y) = (canvas.center().x as u32 + 40, canvas.center().y as u32 + 30);
    assert_ne!(session.picture().get_pixel(x, y), was.get_pixel(x, y));
    session.document().viewing.wanted.error_map = false;
    session.settle();
    assert_eq!(session.picture().get_pixel(x, y), was.get_pixel(x, y));
}

#[test]
fn an_idle_frame_computes_nothing_with_every_panel_open() {
    let mut session = Session::with("Plots", Theme::Dark);
    for title in ["Accuracy", "Performance"] {
        session.click(title);
    }
    session.document().viewing.wanted.error_map = true;
    session.plot(Plot::Section);
    session.wait(|app| certified(app) && app.study().error_map().is_some_and(|texture| texture.size() == [120, 80]));
    let counts = session.app.counts();
    session.frame(Vec::new());
    let now = session.app.counts();
    assert_eq!(
        (now.spectra, now.composites, now.studies, now.views),
        (counts.spectra, counts.composites, counts.studies, counts.views)
    );
    assert!(session.due > Duration::from_secs(1), "{:?}", session.due);
}

/// A look that differs from the default one in everything that can be set in a panel, of the same lens rows and lights.
fn changed(session: &mut Session) -> (Look, Viewing) {
    let document = session.document();
    let (before, viewing) = (document.look.clone(), document.viewing);
    let look = &mut document.look;
    (look.strength, look.size, look.tint, look.axis) = (0.5, 2.0, [0.5, 0.25, 2.0], DVec2::new(0.5, -0.5));
    look.find = FindOptions { threshold: Some(3.0), merge: 0.5, max_lights: 3 };
    (look.mix, look.normalize) = (Mix::Energy, Normalize::Clamp);
    look.accuracy = Accuracy {
        goal: Goal::Tolerance(1e-2),
        allow_floor: true,
        degree: Some([20, 21]),
        period: Some(DVec2::new(7.0, 6.0)),
        evaluator: Some(Evaluator::Rows),
    };
    let mut row = look.lens.ghosts()[0].clone();
    (row.along, row.size, row.tint, row.share) = (0.3, DVec2::new(0.4, 0.5), [0.2, 0.3, 0.4], 0.25);
    row.bell = Bell::Parabola;
    look.set_lens_ghost(0, row);
    let light = &mut document.lights_mut()[0];
    (light.position, light.size) = (DVec2::new(0.1, 0.2), 0.3);
    light.flux = light.flux.map(|part| 2.0 * part);
    let ghost = &mut document.look.ghosts[0];
    (ghost.bell, ghost.center, ghost.size) = (Bell::CosineSquared, DVec2::new(0.3, 0.4), DVec2::new(0.7, 0.8));
    ghost.radiance = [0.2, 0.3, 0.4];
    let view = &mut document.viewing;
    (view.exposure, view.tone_map, view.wipe) = (2.0, ToneMap::Aces, Some(0.25));
    (view.shows, view.mask, view.handles, view.loupe) = (Shows::Glare, true, false, true);
    view.wanted.certificate = false;
    (view.wanted.plot, view.wanted.cut) = (Plot::Section, Cut { horizontal: false, at: 0.25 });
    (before, viewing)
}

/// Every panel open, with a light selected or a ghost.
fn all_open(ghost: bool) -> Session {
    let mut session = Session::of_size([480, 3200]);
    for title in ["Plots", "Performance", "Keys", "Lens ghosts", "By hand"] {
        session.click(title);
    }
    let bell = Bell::Gaussian;
    let placed = Ghost { bell, center: DVec2::ZERO, size: DVec2::splat(0.2), radiance: [0.1; 3] };
    session.document().look.ghosts.push(placed);
    // Their own list, so that a change of the search leaves it alone.
    session.document().lights_mut();
    session.document().select(0);
    if ghost {
        session.document().select_ghost(0);
    }
    session.settle();
    session
}

/// What holds more that is to go back, or moves what is below it when it has gone back; from below.
const LAST: [&str; 6] = ["Plot", "False colours", "Measure", "Wipe", "Goal", "By the photo"];

#[test]
fn every_control_says_what_it_sets_and_goes_back() {
    for ghost in [false, true] {
        let mut session = all_open(ghost);
        let (look, viewing) = changed(&mut session);
        session.settle();
        let controls = session.app.controls();
        for told in &controls {
            assert!(told.about.len() > 4, "{told:?}");
            assert_eq!(told.span.is_empty(), told.reset.is_empty(), "{told:?}");
        }
        let settable: Vec<_> = controls.into_iter().filter(|told| !told.reset.is_empty()).collect();
        assert!(settable.len() > 100, "{}", settable.len());
        for told in settable {
            // What goes back may take another control away, and move the rest.
            let there = session.app.controls().into_iter().find(|other| other.name == told.name);
            let Some(there) = there.filter(|there| there.reset == told.reset) else { continue };
            if ghost && !["Ghost", "Bell"].iter().any(|name| there.name.starts_with(name)) {
                continue;
            }
            if !LAST.contains(&there.name.as_str()) {
                session.go_back(&there);
                // Until it is drawn again, what is below it is elsewhere.
                let drawn = |app: &App| app.study().section().is_some() || app.problem().is_some();
                if !drawn(&session.app) {
                    session.wait(drawn);
                }
            }
        }
        if ghost {
            assert_eq!(session.document().look.ghosts, look.ghosts);
            continue;
        }
        session.document().viewing.wanted.error_map = true;
        session.settle();
        for name in LAST {
            let told = session.told(name);
            session.go_back(&told);
        }
        session.settle();
        let document = session.document();
        let mut now = document.look.clone();
        // Its numbers are not shown.
        now.ghosts.clone_from(&look.ghosts);
        assert_eq!(now.lens.ghosts(), look.lens.ghosts());
        now.lens = look.lens.clone();
        assert_eq!(now, look);
        assert_eq!(document.viewing, viewing);
    }
}

#[test]
fn nothing_that_can_be_clicked_goes_without_a_tooltip() {
    for ghost in [false, true] {
        let mut session = all_open(ghost);
        changed(&mut session);
        session.settle();
        let left = session.app.placement().unwrap().rect.right() + 8.0;
        let controls = session.app.controls();
        let right = controls.iter().fold(left, |right, told| right.max(told.rect.right()));
        let mut seen = 0;
        session.app.context().viewport(|viewport| {
            for (layer, widgets) in viewport.prev_pass.widgets.layers() {
                for widget in widgets.iter() {
                    // A text that can be marked and copied is no control, and the keyboard does not come to it.
                    if !widget.sense.senses_click() || !widget.sense.is_focusable() {
                        continue;
                    }
                    let place = widget.interact_rect.center();
                    if !widget.interact_rect.is_positive() || place.x < left || place.x > right || place.y < 30.0 {
                        continue;
                    }
                    seen += 1;
                    let told = controls.iter().any(|told| told.rect.expand(1.0).contains(place));
                    assert!(told, "{widget:?} of {layer:?} says nothing");
                }
            }
        });
        assert!(seen > 150, "{seen}");
    }
}

/// What the list of keys names: each with what is held before it.
fn listed() -> Vec<(Modifiers, Key)> {
    let parse = |name: &str| {
        let (ctrl, shift) = (name.contains("Ctrl+"), name.contains("Shift+"));
        let key = name.replace("Ctrl+", "").replace("Shift+", "");
        let key = Key::from_name(&key).unwrap_or_else(|| panic!("{name} is no key"));
        (Modifiers { ctrl, command: ctrl, shift, ..Modifiers::NONE }, key)
    };
    KEYS.iter().flat_map(|(keys, _)| keys.split(", ")).map(parse).collect()
}

fn with_a_light() -> Session {
    let mut session = Session::of_size([400, 300]);
    session.document().select(0);
    session.frame(Vec::new());
    session
}

#[test]
fn the_list_of_keys_is_what_the_window_takes() {
    let listed = listed();
    for modifiers in [Modifiers::NONE, Modifiers { ctrl: true, command: true, ..Modifiers::NONE }] {
        for shift in [false, true] {
            let (modifiers, mut session) = (Modifiers { shift, ..modifiers }, with_a_light());
            for &key in Key::ALL {
                let event = Event::Key { key, physical_key: None, pressed: true, repeat: false, modifiers };
                session.frame(vec![event.clone()]);
                let taken = session.app.context().input(|input| !input.events.contains(&event));
                let same = |with: Modifiers| listed.contains(&(with, key));
                // Shift beside a key that is listed without it changes nothing, or is told of in its line.
                let known = same(modifiers) || same(Modifiers { shift: false, ..modifiers });
                assert_eq!(taken, known, "{modifiers:?} {key:?}");
                if taken {
                    session = with_a_light();
                }
            }
        }
    }
}

#[test]
fn what_is_light_is_marked_before_the_photo_is_searched() {
    let mut session = Session::with("Lights", Theme::Dark);
    // Which would lie over it.
    session.document().viewing.handles = false;
    session.settle();
    let marked = |session: &Session| session.picture().pixels().filter(|pixel| pixel.0 == [255, 26, 38]).count();
    assert_eq!(marked(&session), 0);
    session.press(Key::K);
    session.settle();
    let placement = *session.app.placement().unwrap();
    // 25 pixels of the photo are less than 3 away from the lamp's middle.
    let square = (1.0 / (placement.pitch * placement.pitch)) as usize;
    let lamp = marked(&session);
    assert!(lamp.abs_diff(25 * square) < 4 * square, "{lamp} is not 25 times {square}");
    // In the very frame in which the threshold changes.
    session.document().look.find.threshold = Some(0.01);
    session.frame(Vec::new());
    assert!(session.app.document().unwrap().wants_search());
    assert!(marked(&session) > 50 * lamp);
    session.document().look.find.threshold = Some(1e4);
    session.frame(Vec::new());
    assert_eq!(marked(&session), 0);
    session.document().look.find.threshold = Some(40.0);
    session.press(Key::K);
    session.wait(|app| !app.document().unwrap().wants_search());
    assert_eq!(marked(&session), 0);
    let slider = session.told("Threshold").part.center();
    session.frame(vec![Event::PointerMoved(slider)]);
    session.frame(Vec::new());
    assert_eq!(marked(&session), lamp);
    session.frame(vec![Event::PointerMoved(pos2(2.0, 2.0))]);
    session.frame(Vec::new());
    assert_eq!(marked(&session), 0);
}

#[test]
fn a_name_goes_back_by_the_keyboard_too() {
    let mut session = Session::with("Look", Theme::Dark);
    session.document().look.strength = 0.25;
    session.settle();
    for _ in 0..60 {
        session.press(Key::Tab);
        session.press(Key::Enter);
        if session.document().look.strength == 1.0 {
            return;
        }
    }
    panic!("Tab does not come to the name");
}

/// The means of squares of so many pixels, which no way to draw a letter changes much.
const SQUARE: u32 = 10;

fn blurred(picture: &RgbImage) -> RgbImage {
    let [width, height] = [picture.width(), picture.height()].map(|side| side / SQUARE);
    image::imageops::resize(picture, width, height, image::imageops::FilterType::Triangle)
}

/// The mean of the differences of two pictures in codes, and the largest.
fn apart(a: &RgbImage, b: &RgbImage) -> (f64, u8) {
    assert_eq!(a.dimensions(), b.dimensions());
    let differences: Vec<u8> = a.iter().zip(b.iter()).map(|(a, b)| a.abs_diff(*b)).collect();
    let sum: f64 = differences.iter().map(|&difference| f64::from(difference)).sum();
    (sum / differences.len() as f64, differences.into_iter().max().unwrap_or(0))
}

fn alike((mean, most): (f64, u8)) -> bool {
    mean < 1.5 && most < 48
}

/// The panels' side of the screen with one of them open, and all that is folded away in it.
fn panel(title: &str, plot: Plot, theme: Theme) -> RgbImage {
    let mut session = Session::with(title, theme);
    session.document().select(0);
    session.settle();
    for fold in ["Lens ghosts", "By hand"] {
        if session.app.control(fold).is_some() {
            session.click(fold);
        }
    }
    // Not by what this machine was found to be fast at, and with a spectrum to be shown.
    session.document().look.accuracy.evaluator = Some(Evaluator::Rows);
    session.plot(plot);
    session.wait(certified);
    let left = session.app.placement().unwrap().rect.right().ceil() as u32;
    let picture = session.picture();
    if let Some(folder) = std::env::var_os("VGLARE_UI_SHOTS") {
        picture.save(Path::new(&folder).join(format!("{title}-{plot:?}-{theme:?}.png"))).unwrap();
    }
    image::imageops::crop_imm(&picture, left, 0, SIZE[0] - left, 900).to_image()
}

#[test]
fn panels_look_as_they_did() {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/golden-ui");
    let panels = [
        ("look", "Look", Plot::Off),
        ("view", "View", Plot::Off),
        ("lights", "Lights", Plot::Off),
        ("accuracy", "Accuracy", Plot::Off),
        ("spectrum", "Plots", Plot::Spectrum),
        ("section", "Plots", Plot::Section),
        ("degree", "Plots", Plot::Convergence),
    ];
    for (name, title, plot) in panels {
        for (theme, suffix) in [(Theme::Dark, "dark"), (Theme::Light, "light")] {
            let path = folder.join(format!("{name}-{suffix}.png"));
            let shown = blurred(&panel(title, plot, theme));
            if std::env::var_os(BLESS).is_some() {
                std::fs::create_dir_all(&folder).unwrap();
                shown.save(&path).unwrap();
            }
            let golden = image::open(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display())).to_rgb8();
            let difference = apart(&shown, &golden);
            assert!(alike(difference), "{name}, {suffix}: {difference:?}; {BLESS}=1 writes it anew");
        }
    }
}

#[test]
fn a_panel_that_looks_otherwise_is_noticed() {
    let [open, other] = [("Plots", Plot::Spectrum), ("Accuracy", Plot::Off)]
        .map(|(title, plot)| blurred(&panel(title, plot, Theme::Dark)));
    assert!(alike(apart(&open, &open)));
    assert!(!alike(apart(&open, &other)));
    let mut without = open.clone();
    for pixel in
        without.enumerate_pixels_mut().filter(|(x, y, _)| *x < 12 && *y > 8 && *y < 24).map(|(.., pixel)| pixel)
    {
        *pixel = image::Rgb([27; 3]);
    }
    assert!(!alike(apart(&open, &without)), "a missing picture of a table");
}
