//! Displays of other scales: the same picture of more pixels, and a change in the middle of a drag.

use std::path::Path;

use vglare::gpu::{Backend, Device};
use vglare::photo::Photo;
use vglare::viewer::replay::{Place, Player, Step};
use vglare::viewer::{Document, Status};

use crate::support::{lit, turn};

fn opened(size: [u32; 2]) -> Player {
    let device = Device::open(&Backend::ALL).unwrap();
    let mut player = Player::new(&device, lit(), size).unwrap();
    let pixel = |i: i32, j: i32| if (i - 40).pow(2) + (j - 20).pow(2) < 9 { [400.0; 4] } else { [0.02; 4] };
    let photo = Photo::new(120, 80, (0..80).flat_map(|j| (0..120).map(move |i| pixel(i, j))).collect());
    player.app().add(Document::new(Path::new("lamp.exr"), photo, lit()));
    player.step(&Step::Rest).unwrap();
    player
}

fn light(player: &mut Player) -> [f64; 2] {
    Status::of(player.app()).lights[0]
}

/// Red, green and blue at a place of the picture, added up.
fn brightness(player: &mut Player, at: [f64; 2]) -> u32 {
    let scale = player.app().context().pixels_per_point();
    let at = player.find(&Place::Picture(at)).unwrap() * scale;
    let [width, _] = player.screen().size();
    let pixel = player.screen().read()[at.y as usize * width as usize + at.x as usize];
    pixel[..3].iter().map(|&code| u32::from(code)).sum()
}

#[test]
fn a_picture_is_the_same_at_every_scale() {
    let _turn = turn();
    let mut expected = None;
    for scale in [1.0, 1.5, 2.0] {
        let mut player = opened([900.0, 600.0].map(|side: f32| (side * scale) as u32));
        player.step(&Step::Scale(scale)).unwrap();
        let handles = || Step::Key { key: "L".into(), ctrl: false, shift: false };
        player.step(&handles()).unwrap();
        player.step(&Step::Rest).unwrap();
        let lamp = light(&mut player);
        // The lamp, without its handle; in the dark; on the other side.
        let places = [lamp, [0.9, -0.8], [-lamp[0], -lamp[1]]];
        let seen = places.map(|place| brightness(&mut player, place));
        let near = |a: &[u32], b: &[u32]| a.iter().zip(b).all(|(a, b)| a.abs_diff(*b) <= 12);
        assert!(near(expected.get_or_insert(seen), &seen), "{scale}: {seen:?} after {expected:?}");
        player.step(&handles()).unwrap();
        player.step(&Step::Drag { from: Place::Light(0), to: Place::Picture([0.3, 0.2]), frames: 3 }).unwrap();
        let [x, y] = light(&mut player);
        assert!((x - 0.3).abs() < 0.02 && (y - 0.2).abs() < 0.02, "{scale}: {x}, {y}");
    }
}

#[test]
fn another_scale_in_the_middle_of_a_drag_moves_nothing_by_itself() {
    let _turn = turn();
    let mut player = opened([900, 600]);
    player.step(&Step::Move(Place::Light(0))).unwrap();
    player.step(&Step::Press).unwrap();
    player.step(&Step::Move(Place::Picture([0.2, 0.1]))).unwrap();
    let before = light(&mut player);
    // A monitor of twice the scale: the window has as many points, and the pointer stays at its place in the picture.
    player.step(&Step::Resize([1800, 1200])).unwrap();
    player.step(&Step::Scale(2.0)).unwrap();
    assert_eq!(light(&mut player), before);
    player.step(&Step::Move(Place::Picture([0.4, 0.3]))).unwrap();
    player.step(&Step::Release).unwrap();
    let [x, y] = light(&mut player);
    assert!((x - 0.4).abs() < 0.03 && (y - 0.3).abs() < 0.03, "{x}, {y}");
    player.step(&Step::Key { key: "Z".into(), ctrl: true, shift: false }).unwrap();
    assert!(light(&mut player)[0] < 0.0, "the drag was one step");
}
