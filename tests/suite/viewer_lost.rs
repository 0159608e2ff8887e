//! A device that is lost while the window is used: it goes on with another, and nothing that was set is gone.

use std::path::Path;

use vglare::gpu::{Backend, Device};
use vglare::look::Veil;
use vglare::photo::Photo;
use vglare::psf::{Name, Parameters};
use vglare::scene::VeilSection;
use vglare::viewer::model::State;
use vglare::viewer::replay::{Place, Player, Step};
use vglare::viewer::{Document, Status};

use crate::support::{lit, turn};

/// A window on a lamp, with a folder in which it remembers things.
fn opened(backend: Backend) -> (tempfile::TempDir, Player) {
    let folder = tempfile::tempdir().unwrap();
    let device = Device::open(&[backend]).unwrap();
    let mut player = Player::new(&device, lit(), [900, 600]).unwrap();
    let pixel = |i: i32, j: i32| if (i - 40).pow(2) + (j - 20).pow(2) < 9 { [400.0; 4] } else { [0.02; 4] };
    let photo = Photo::new(120, 80, (0..80).flat_map(|j| (0..120).map(move |i| pixel(i, j))).collect());
    player.app().remember(State::in_folder(folder.path().join("state")));
    player.app().add(Document::new(Path::new("lamp.exr"), photo, lit()));
    for panel in ["Plots", "Performance"] {
        let place = Place::Control(panel.into(), 0.5);
        player.step(&Step::Rest).unwrap();
        player.step(&Step::Drag { from: place.clone(), to: place, frames: 1 }).unwrap();
    }
    player.step(&Step::Rest).unwrap();
    (folder, player)
}

fn status(player: &mut Player) -> Status {
    Status::of(player.app())
}

#[test]
fn the_window_looks_the_same_on_the_next_device() {
    let _turn = turn();
    for backend in Backend::ALL {
        let (_folder, mut player) = opened(backend);
        let side = Place::Screen([5.0, 300.0]);
        player.step(&Step::Drag { from: Place::Light(0), to: Place::Picture([0.3, 0.2]), frames: 4 }).unwrap();
        // The timings are of the device, and they are drawn.
        let performance = Place::Control("Performance".into(), 0.5);
        player.step(&Step::Drag { from: performance.clone(), to: performance, frames: 1 }).unwrap();
        for step in [Step::Move(side), Step::Rest, Step::Idle(30), Step::Rest] {
            player.step(&step).unwrap();
        }
        wait_for_the_studies(&mut player);
        let (before, shown) = (player.screen().read(), status(&mut player));
        player.step(&Step::Lose).unwrap();
        wait_for_the_studies(&mut player);
        let now = status(&mut player);
        assert_eq!((now.lights, now.strength, now.steps), (shown.lights, shown.strength, shown.steps));
        assert_eq!(now.notices, [] as [String; 0]);
        let after = player.screen().read();
        let differ = before.iter().zip(&after).filter(|(before, after)| before != after).count();
        assert_eq!(differ, 0, "{backend}");
    }
}

#[test]
fn the_veil_lies_over_the_picture_on_the_next_device() {
    let _turn = turn();
    let (_folder, mut player) = opened(Backend::ALL[0]);
    let parameters = Parameters { width: Some(0.2), scatter: Some(0.3), ..Parameters::new(Name::Gaussian) };
    let section = VeilSection { parameters, fov: None, projection: None, border: None, tolerance: None };
    let veil = Some(Veil::new(&section, false).unwrap());
    // The study of the field is drawn in panels, and comes when it comes.
    let canvas = |player: &mut Player| {
        let [width, _] = player.screen().size();
        let pixels = player.screen().read().into_iter().enumerate();
        pixels.filter(|(at, _)| (at % width as usize) < 500 && (at / width as usize) < 500).collect::<Vec<_>>()
    };
    let without = canvas(&mut player);
    player.app().document_mut().unwrap().look.veil = veil;
    player.step(&Step::Rest).unwrap();
    let with = canvas(&mut player);
    assert!(with != without);
    player.step(&Step::Lose).unwrap();
    player.step(&Step::Rest).unwrap();
    assert_eq!((canvas(&mut player) == with, status(&mut player).counts.veils), (true, 1));
}

/// Until what is found out in the background has been shown.
fn wait_for_the_studies(player: &mut Player) {
    for _ in 0..40 {
        player.step(&Step::Idle(2)).unwrap();
        std::thread::sleep(std::time::Duration::from_millis(25));
    }
    player.step(&Step::Rest).unwrap();
}

#[test]
fn a_drag_goes_on_and_its_look_is_kept_meanwhile() {
    let _turn = turn();
    let (folder, mut player) = opened(Backend::ALL[0]);
    player.step(&Step::Move(Place::Light(0))).unwrap();
    player.step(&Step::Press).unwrap();
    for step in 1..=4 {
        player.step(&Step::Move(Place::Picture([0.1 * f64::from(step), 0.0]))).unwrap();
    }
    // In the middle of it, more than two seconds after it began.
    player.step(&Step::Idle(150)).unwrap();
    let there = status(&mut player).lights[0];
    let kept = || State::in_folder(folder.path().join("state")).look().unwrap().unwrap();
    assert_eq!(kept().lights(&[])[0].position.to_array(), there);
    player.step(&Step::Lose).unwrap();
    player.step(&Step::Move(Place::Picture([0.4, 0.3]))).unwrap();
    let there = status(&mut player).lights[0];
    assert!((there[1] - 0.3).abs() < 0.02, "the drag goes on: {there:?}");
    // What comes to an end at once keeps it as well.
    let file = player.app().keep_look().unwrap();
    assert!(file.ends_with("look.toml"));
    assert_eq!(kept().lights(&[])[0].position.to_array(), there);
    player.step(&Step::Release).unwrap();
    player.step(&Step::Key { key: "Z".into(), ctrl: true, shift: false }).unwrap();
    assert!(status(&mut player).lights[0] != there, "it is one step, and can be undone");
}
