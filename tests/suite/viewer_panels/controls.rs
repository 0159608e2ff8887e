//! What every control of the panels has: what it says of itself, a way back, and keys.

use vglare::choices::{Beyond, Border, LengthUnit, LightBy, LightShape, Mix, Normalize};
use vglare::look::Accuracy;
use vglare::photo::ToneMap;
use vglare::psf::Luminance;
use vglare::scene::{FindOptions, Ghost, Recover};
use vglare::series::Bell;
use vglare::viewer::{KEYS, Shows, Viewing};

use super::*;

impl Session {
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
}

/// A look that differs from the default one in everything that can be set in a panel, of the same lens rows and lights.
fn changed(session: &mut Session) -> (Look, Viewing) {
    let document = session.document();
    let (before, viewing) = (document.look.clone(), document.viewing);
    let look = &mut document.look;
    (look.strength, look.size, look.tint, look.axis) = (0.5, 2.0, [0.5, 0.25, 2.0], DVec2::new(0.5, -0.5));
    look.find = FindOptions {
        by: LightBy::Luminance,
        threshold: Some(3.0),
        merge: 0.5,
        shape: LightShape::Ball,
        max_lights: 3,
        beyond: Beyond::Drop,
        firefly_limit: 100.0,
        knee: 0.0,
        recover: Recover::Stops(3.0),
    };
    (look.mix, look.normalize) = (Mix::Energy, Normalize::Clamp);
    look.accuracy = Accuracy {
        goal: Goal::Tolerance(1e-2),
        allow_floor: true,
        each_pixel: false,
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
    (view.wanted.certificate, view.without_constant) = (false, true);
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
const LAST: [&str; 7] = ["Plot", "False colours", "Measure", "Wipe", "Goal", "Recover", "By the photo"];

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
        // Nine of them for each row of the lens, which has five.
        assert!(settable.len() > 90, "{}", settable.len());
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
                    drop(session);
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

/// A look with a veil of these parameters, of a picture of 50°.
fn veiled_by(parameters: Parameters) -> Look {
    let section = VeilSection { parameters, fov: None, projection: None, border: None, tolerance: None };
    Look { veil: Some(Veil::new(&section, false).unwrap()), fov: Some(50.0), ..lit() }
}

#[test]
fn every_control_of_a_veil_goes_back() {
    let of = Parameters::new;
    let widths =
        |widths: [f64; 2]| Parameters { widths: Some(widths.to_vec()), scatter: Some(0.2), ..of(Name::Mixture) };
    let tail =
        |tail: [f64; 3], end| Parameters { a: Some(tail[0]), b: Some(tail[1]), g: Some(tail[2]), end, ..of(Name::Abg) };
    let eye = Parameters { age: Some(60.0), pigment: Some(1.0), scatter: Some(0.2), ..of(Name::Cie) };
    let dusk = Parameters { luminance: Some(Luminance::Mesopic), scatter: Some(0.5), ..of(Name::Spencer) };
    let day = Parameters { scatter: Some(0.9), ..of(Name::Spencer) };
    let wide = |width| Parameters { width: Some(width), scatter: Some(0.1), ..of(Name::Gaussian) };
    let tinted = Parameters {
        weights: Some(vec![1.0, 3.0]),
        tints: Some(vec![[1.0; 3], [0.5, 0.0, 1.0]]),
        ..widths([0.05, 0.4])
    };
    let plain = Parameters { weights: Some(vec![1.0; 2]), tints: Some(vec![[1.0; 3]; 2]), ..widths([0.02, 0.2]) };
    let iris = |fstop, blades, rotation, roundness, sensor| Parameters {
        fstop: Some(fstop),
        blades: Some(blades),
        rotation: Some(rotation),
        roundness: Some(roundness),
        sensor: Some(sensor),
        ..of(Name::Starburst)
    };
    let cases: [(Parameters, Parameters, &[&str]); 6] = [
        (of(Name::Cie), eye, &["Age", "Pigment", "Scatter", "Field", "Veil error", "Projection", "Keep light", "Unit"]),
        (day, dusk, &["Luminance", "Scatter", "Field"]),
        (wide(0.1), wide(0.5), &["Width", "Border"]),
        (plain, tinted, &["width 1", "width 2", "weight 1", "weight 2", "hue 1", "hue 2"]),
        (tail([1e-4, 1e-3, 2.5], None), tail([2e-4, 2e-3, 3.0], Some(2.0)), &["A", "B", "Exponent", "End"]),
        (
            iris(16.0, 6, 0.0, 0.0, 36.0),
            Parameters { scatter: Some(0.02), ..iris(8.0, 9, 15.0, 0.3, 23.5) },
            &["F-number", "Blades", "Rotation", "Roundness", "Sensor"],
        ),
    ];
    let mut session = Session::of_size([480, 2600]);
    for (opened, set, names) in cases {
        let opened = veiled_by(opened);
        session.app.add(Document::new(Path::new("lamp.exr"), lamp(), opened.clone()));
        session.settle();
        let document = session.document();
        let planar = !opened.veil.as_ref().unwrap().is_in_degrees();
        let section = VeilSection {
            projection: (!planar).then_some(Projection::Fisheye),
            border: planar.then_some(Border::Mirror),
            tolerance: Some(0.02),
            ..veiled_by(set).veil.unwrap().section()
        };
        document.look.veil = Some(Veil::new(&section, true).unwrap());
        (document.look.fov, document.look.unit) = (Some(40.0), LengthUnit::Diagonal);
        session.settle();
        for name in names {
            let told = session.told(name);
            assert!(!told.span.is_empty() && told.about.len() > 4, "{told:?}");
            session.go_back(&told);
            session.settle();
        }
        for name in ["Veil error", "Keep light", "Border", "Scatter", "Projection"] {
            if session.app.control(name).is_some() {
                session.go_back(&session.told(name));
                session.settle();
            }
        }
        let look = Look { fov: opened.fov, unit: opened.unit, ..session.document().look.clone() };
        assert_eq!(look, opened, "all of it is as it was");
    }
}

#[test]
fn a_veils_control_sets_what_it_says() {
    let mut session = Session::of_size([480, 2600]);
    session.app.add(Document::new(Path::new("lamp.exr"), lamp(), veiled()));
    session.settle();
    session.wait(|app| !app.is_veiling());
    let veils = session.app.counts().veils;
    // The middle of a slider, and the box before one.
    session.click("Age");
    session.click("Pigment");
    let section = session.document().look.veil.as_ref().unwrap().section();
    assert!(section.parameters.age.is_some_and(|age| (age - 60.0).abs() < 2.0), "{section:?}");
    assert!(section.parameters.pigment.is_some_and(|pigment| (pigment - 0.6).abs() < 0.02), "{section:?}");
    assert_eq!(session.app.counts().veils, veils, "both are weights");
    session.click("Scatter");
    let scatter = session.document().look.veil.as_ref().unwrap().section().parameters.scatter;
    // Even in the logarithm, between 1e-4 and 1.
    assert!(scatter.is_some_and(|scatter| (scatter / 0.01).ln().abs() < 0.3), "{scatter:?}");
    let field = session.app.controls().into_iter().find(|told| told.name == "Field").unwrap();
    session.click_at(pos2(field.part.left() - 20.0, field.part.center().y));
    assert_eq!(session.document().look.fov, None);
    assert!(session.app.problem().is_some_and(|said| said.contains("field of view")));
    session.click_at(pos2(field.part.left() - 20.0, field.part.center().y));
    assert_eq!((session.document().look.fov, session.app.problem()), (Some(50.0), None));
}
