//! The window under input that no person would give it: nothing breaks, nothing grows, looks stay finite.
//!
//! A few hundred frames by default; `VGLARE_FUZZ_SECONDS` goes on for as long, seed after seed.

use std::path::Path;
use std::time::{Duration, Instant};

use egui::{Event, Key, Modifiers, MouseWheelSource, MouseWheelUnit, PointerButton, TouchPhase, pos2, vec2};
use vglare::gpu::{Backend, Device};
use vglare::photo::Photo;
use vglare::viewer::Document;
use vglare::viewer::replay::{Player, Step};

use crate::support::scenes::Chance;
use crate::support::{lit, turn};

/// Frames of one seed, and what memory may grow by after the first seeds, in bytes.
const FRAMES: usize = 100;
const WARM_SEEDS: u64 = 2;
const MOST_GROWTH: u64 = 64 << 20;

/// Keys that do something, and some that do not.
const KEYS: [Key; 16] = [
    Key::B,
    Key::G,
    Key::L,
    Key::W,
    Key::H,
    Key::M,
    Key::Z,
    Key::Y,
    Key::Tab,
    Key::Delete,
    Key::Escape,
    Key::ArrowLeft,
    Key::ArrowUp,
    Key::Enter,
    Key::Num5,
    Key::Minus,
];

impl Chance {
    fn at(&mut self) -> egui::Pos2 {
        // Also off the screen.
        pos2(self.below(760) as f32 - 20.0, self.below(460) as f32 - 20.0)
    }

    fn event(&mut self) -> Event {
        let command = self.below(8) == 0;
        let modifiers = Modifiers { ctrl: command, command, shift: self.below(6) == 0, ..Modifiers::NONE };
        match self.below(10) {
            0..=4 => Event::PointerMoved(self.at()),
            5 | 6 => {
                let pressed = self.below(2) == 0;
                Event::PointerButton { pos: self.at(), button: PointerButton::Primary, pressed, modifiers }
            }
            7 => {
                let (unit, phase) = (MouseWheelUnit::Point, TouchPhase::Move);
                let source = MouseWheelSource::Wheel;
                let delta = vec2(0.0, self.below(400) as f32 - 200.0);
                Event::MouseWheel { unit, delta, phase, source, modifiers }
            }
            8 => {
                let key = KEYS[self.below(KEYS.len() as u64) as usize];
                // Closing the only photo would end the run.
                let modifiers = if key == Key::W { Modifiers::NONE } else { modifiers };
                Event::Key { key, physical_key: None, pressed: self.below(2) == 0, repeat: false, modifiers }
            }
            _ => Event::Text(["0", "-", ".", "e9", "nan", "17"][self.below(6) as usize].into()),
        }
    }
}

fn photo() -> Photo {
    let pixel = |i: i32, j: i32| match (i - 20).pow(2) + (j - 12).pow(2) {
        0..=8 => [300.0, 250.0, 200.0, 1.0],
        300 => [f32::NAN, f32::INFINITY, -1.0, 1.0],
        _ => [0.02; 4],
    };
    Photo::new(64, 40, (0..40).flat_map(|j| (0..64).map(move |i| pixel(i, j))).collect())
}

/// Resident memory of this process, in bytes.
fn resident() -> u64 {
    let text = std::fs::read_to_string("/proc/self/statm").expect("Linux tells of memory there");
    text.split_whitespace().nth(1).and_then(|pages| pages.parse::<u64>().ok()).expect("its second word are pages")
        * 4096
}

fn check(player: &mut Player, seed: u64) {
    let app = player.app();
    let Some(document) = app.document() else { return };
    let look = &document.look;
    let finite = document.lights().iter().all(|light| light.position.is_finite() && light.size.is_finite());
    assert!(finite && look.strength.is_finite() && look.axis.is_finite(), "seed {seed}: {look:?}");
    let zoom = app.placement().is_none_or(|placement| placement.origin.is_finite() && placement.pitch > 0.0);
    assert!(zoom, "seed {seed}: {:?}", app.placement());
}

/// One seed's frames; how many there were.
fn play(player: &mut Player, seed: u64) -> usize {
    let mut chance = Chance::new(seed);
    player.app().add(Document::new(Path::new("fuzz.exr"), photo(), lit()));
    for frame in 0..FRAMES {
        let events = (0..=chance.below(3)).map(|_| chance.event()).collect();
        player.frame(events).unwrap_or_else(|error| panic!("seed {seed}, frame {frame}: {error}"));
        if chance.below(40) == 0 {
            let size = [1 + chance.below(900) as u32, 1 + chance.below(600) as u32];
            player.step(&Step::Resize(size)).unwrap_or_else(|error| panic!("seed {seed}, {size:?}: {error}"));
        }
        if chance.below(80) == 0 {
            player.step(&Step::Scale(0.5 + chance.below(6) as f32 * 0.5)).unwrap();
        }
        check(player, seed);
    }
    // Release what is held, and close the photo.
    let (pos, modifiers) = (pos2(-5.0, -5.0), Modifiers::NONE);
    player
        .frame(vec![Event::PointerButton { pos, button: PointerButton::Primary, pressed: false, modifiers }])
        .unwrap();
    player.step(&Step::Resize([720, 440])).unwrap();
    player.step(&Step::Key { key: "Escape".into(), ctrl: false, shift: false }).unwrap();
    player.step(&Step::Key { key: "W".into(), ctrl: true, shift: false }).unwrap();
    FRAMES
}

#[test]
fn random_input_breaks_nothing_and_memory_does_not_grow() {
    let asked = std::env::var("VGLARE_FUZZ_SECONDS").ok().and_then(|text| text.parse().ok());
    let started = Instant::now();
    let _turn = turn();
    let device = Device::open(&Backend::ALL).unwrap();
    let mut player = Player::new(&device, lit(), [720, 440]).unwrap();
    let (mut frames, mut seed, mut warm) = (0, 0, None);
    while seed <= WARM_SEEDS || asked.is_some_and(|seconds| started.elapsed() < Duration::from_secs(seconds)) {
        frames += play(&mut player, seed);
        seed += 1;
        if seed == WARM_SEEDS {
            warm = Some(resident());
        }
        if asked.is_some() && seed.is_multiple_of(20) {
            println!("{frames} frames, {} MiB", resident() >> 20);
        }
    }
    let (warm, now) = (warm.unwrap(), resident());
    println!("{frames} frames of {seed} seeds; {} MiB, after {} MiB", now >> 20, warm >> 20);
    assert!(now < warm + MOST_GROWTH, "{warm} bytes came to {now} in {frames} frames");
}
