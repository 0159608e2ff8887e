//! The panels that look into a picture: what they show is true, costs nothing at rest, and looks as it did.

mod controls;

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use egui::{Event, Key, Modifiers, PointerButton, Pos2, RawInput, Rect, Theme, pos2, vec2};
use glam::DVec2;
use image::RgbImage;
use vglare::choices::{Evaluator, Projection};
use vglare::gpu::{Backend, Device, Screen};
use vglare::look::{Look, Veil};
use vglare::photo::Photo;
use vglare::psf::{Name, Parameters};
use vglare::reference;
use vglare::scene::{Goal, VeilSection};
use vglare::viewer::{App, Cut, Document, Plot, Told};

use crate::support::{Turn, lit, turn};

const SIZE: [u32; 2] = [1000, 1500];
/// Set, the golden pictures are written instead of compared with.
const BLESS: &str = "VGLARE_BLESS_UI";

struct Session {
    app: App,
    screen: Screen,
    time: f64,
    due: Duration,
    _turn: Turn,
}

impl Session {
    /// With a synthetic photo open, on a screen of so many pixels.
    fn of_size(size: [u32; 2]) -> Self {
        let turn = turn();
        let device = Device::open(&Backend::ALL).unwrap();
        let app = App::new(&device, lit(), Arc::new(|| {})).unwrap();
        let screen = Screen::hidden(&device, size).unwrap();
        let mut session = Self { app, screen, time: 0.0, due: Duration::ZERO, _turn: turn };
        session.app.add(Document::new(Path::new("lamp.exr"), lamp(), lit()));
        // The lens's veil is laid over the picture, and told of, whenever it is there.
        session.wait(|app| !app.is_veiling());
        session
    }

    /// With a synthetic photo open, only this panel besides, and what it studies known.
    fn with(open: &str, theme: Theme) -> Self {
        let mut session = Self::of_size(SIZE);
        session.app.context().set_theme(theme);
        session.settle();
        for (title, is_open) in
            [("Look", true), ("Veil", true), ("View", true), ("Lights", true), ("Accuracy", true), ("Plots", false)]
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
        self.click_at(self.app.control(name).unwrap_or_else(|| panic!("{name} is not shown")).center());
    }

    fn click_at(&mut self, pos: Pos2) {
        let button =
            |pressed| Event::PointerButton { pos, button: PointerButton::Primary, pressed, modifiers: Modifiers::NONE };
        self.frame(vec![Event::PointerMoved(pos)]);
        self.frame(vec![button(true)]);
        self.frame(vec![button(false)]);
        self.frame(vec![Event::PointerMoved(pos2(2.0, 2.0))]);
        self.settle();
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

/// A look with the veil of an eye, on a plane, which is planned quickly, in a picture of 50°.
fn veiled() -> Look {
    let parameters = Parameters::new(Name::Cie);
    let projection = Some(Projection::Planar);
    let section = VeilSection { parameters, fov: None, projection, border: None, tolerance: None };
    Look { veil: Some(Veil::new(&section, false).unwrap()), fov: Some(50.0), ..lit() }
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
        let ghosts = document.look.gather(&document.photo, &document.frame).ghosts;
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
    if title == "Veil" {
        session.document().look = veiled();
        session.wait(|app| !app.is_veiling());
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
        ("veil", "Veil", Plot::Off),
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
