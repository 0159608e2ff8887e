use std::sync::Arc;

use glam::DVec2;

use super::envelope::Envelope;
use super::lattice::Lattice;
use super::seat::Seat;
use super::*;
use crate::chance::Chance;
use crate::frame::Window;
use crate::raster::Raster;
use crate::scene::LensGhost;
use crate::series::{Bell, Disc, Iris, Profile};

/// Noise with a lamp in it; or nothing but a lamp.
fn photo(frame: Frame, seed: u64, noise: bool) -> Vec<[f32; 4]> {
    let mut chance = Chance::new(seed);
    let count = frame.window.pixels();
    let mut pixels: Vec<[f32; 4]> =
        (0..count).map(|_| [0; 4].map(|_| if noise { chance.between(0.0, 1.0) as f32 } else { 0.0 })).collect();
    let lamp = chance.between(0.3 * count as f64, 0.7 * count as f64) as usize;
    pixels[lamp] = [300.0, 200.0, 100.0, 1.0];
    pixels
}

fn images(frame: Frame, photo: &[[f32; 4]], bell: &Bell, along: f64, size: f64) -> Images {
    let raster = Raster::new(photo, frame).unwrap();
    let lens =
        LensGhost { bell: bell.clone(), along, size: DVec2::new(size, 0.8 * size), tint: [1.0, 0.5, 0.0], share: 0.1 };
    Images::new(raster, &[lens], DVec2::new(0.113, -0.071), 1.0, [1.0; 3])
}

fn bells() -> Vec<Bell> {
    let disc = |rim, blades, rotation| Bell::Disc(Disc::new(rim, blades, rotation).unwrap());
    let iris = |edge, blades, rotation| Bell::Iris(Iris::new(edge, blades, rotation).unwrap());
    // A profile that falls, that is negative in between, and ends in a step.
    let profile = Profile::new(&[[0.0, 1.0], [0.4, 0.7], [0.7, -0.1], [1.0, 0.3]]).unwrap();
    vec![
        disc(0.0, 0, 0.0),
        disc(0.1, 0, 0.0),
        disc(0.0, 5, 17.0),
        disc(0.2, 6, -40.0),
        iris(0.02, 0, 0.0),
        iris(0.05, 7, 30.0),
        Bell::Paraboloid,
        Bell::Parabola,
        Bell::CosineSquared,
        Bell::Gaussian,
        Bell::Profile(Arc::new(profile)),
    ]
}

const ALONGS: [f64; 6] = [-1.3, -0.7, 0.05, 0.0, 1.0, 2.5];

/// Square pixels, others, and a window that lies apart from the picture's own middle.
fn frames() -> [Frame; 3] {
    let whole = Frame::full(48, 27);
    let window = Window { x: -5, y: 4, width: 37, height: 21 };
    [whole, Frame { pixel_aspect: 1.6, ..Frame::full(40, 31) }, whole.with_window(window)]
}

/// The field by its definition, its largest value in each colour, and by how much a sheet is off over that.
struct Held {
    truth: Vec<[f64; 3]>,
    largest: [f64; 3],
}

impl Held {
    fn new(images: &Images, frame: Frame) -> Self {
        let window = frame.window;
        let places = (0..window.height as i32).flat_map(|j| (0..window.width as i32).map(move |i| (i, j)));
        let place = |(i, j)| frame.position(f64::from(window.x + i), f64::from(window.y + j));
        let truth = images.at(&places.map(place).collect::<Vec<_>>());
        let largest = [0, 1, 2].map(|c| truth.iter().fold(1e-300f64, |most, value| most.max(value[c].abs())));
        Self { truth, largest }
    }

    fn off(&self, sheet: &Sheet) -> f64 {
        let one = |(place, truth): (usize, &[f64; 3])| {
            let value = sheet.pixel(place);
            (0..3).map(|c| (value[c] - truth[c]).abs() / self.largest[c]).fold(0.0, f64::max)
        };
        self.truth.iter().enumerate().map(one).fold(0.0, f64::max)
    }

    fn weights(&self, images: &Images) -> [f64; 3] {
        [0, 1, 2].map(|c| images.all()[0].ghost.radiance[c].abs() / self.largest[c])
    }
}

/// The ways that are off by nothing, for a bell.
fn exact_ways(bell: &Bell) -> Vec<Way> {
    let mut ways = vec![Way::Pairs];
    if let crate::series::Modes::Product(_) = bell.shape().modes() {
        ways.push(Way::Products);
    }
    if let Bell::Disc(_) = bell {
        ways.push(Way::Spans);
    }
    ways
}

#[test]
fn the_exact_ways_are_the_sum_over_all_pixels() {
    for (bell, (number, along)) in
        bells().iter().flat_map(|bell| ALONGS.into_iter().enumerate().map(move |k| (bell, k)))
    {
        let frame = frames()[number % 3];
        for (size, noise) in [(0.5, true), (0.02, true), (0.21, false)] {
            let pixels = photo(frame, number as u64, noise);
            let images = images(frame, &pixels, bell, along, size);
            let held = Held::new(&images, frame);
            for way in exact_ways(bell) {
                let parts = [Part { image: 0, way, weights: held.weights(&images) }];
                let off = held.off(&sheet(&images, &parts, frame).unwrap());
                assert!(off < 1e-8, "{bell:?} along {along} of {size}: {way:?} is off by {off:e}");
            }
        }
    }
}

#[test]
fn no_lattice_is_off_by_more_than_its_bound_and_no_bound_is_far_too_large() {
    let mut factors = Vec::new();
    for (bell, (number, along)) in
        bells().iter().flat_map(|bell| ALONGS.into_iter().enumerate().map(move |k| (bell, k)))
    {
        let frame = frames()[number % 3];
        for (size, noise) in [(0.5, true), (0.11, true), (0.3, false)] {
            let pixels = photo(frame, 7 + number as u64, noise);
            let images = images(frame, &pixels, bell, along, size);
            let held = Held::new(&images, frame);
            let weights = held.weights(&images);
            let seat = Seat::new(&images, &images.all()[0], frame);
            // What doubles lose, and what is left out of a tail of a lamp that is not in the picture.
            let flux = images.raster().flux();
            let nothing =
                1e-9 + 2.0 * crate::problem::NOTHING * (0..3).map(|c| weights[c] * flux[c]).fold(0.0, f64::max);
            for finer in [1, 2, 4] {
                // All light, or without the lamp.
                for alone_above in [f64::INFINITY, 0.5 * weights[0] * seat.light(0, 0).1 * 300.0] {
                    let bound = Lattice::new(&seat, finer)
                        .map_or(0.0, |lattice| Envelope::new(&seat, &lattice).largest(&seat, weights, alone_above));
                    let parts = [Part { image: 0, way: Way::Lattice { finer, alone_above }, weights }];
                    let off = held.off(&sheet(&images, &parts, frame).unwrap());
                    let told = format!("{bell:?} along {along} of {size}, {finer} points: {off:e} for {bound:e}");
                    assert!(off <= bound + nothing, "{told}");
                    if off > 1e-7 + 10.0 * nothing {
                        factors.push((bound / off, told));
                    }
                }
            }
        }
    }
    factors.sort_by(|one, other| one.0.total_cmp(&other.0));
    let [median, most] = [factors.len() / 2, factors.len() - 1].map(|place| &factors[place]);
    assert!(factors.len() > 200 && median.0 < 10.0 && most.0 < 100.0, "{} {median:?} {most:?}", factors.len());
}

#[test]
fn what_is_chosen_is_within_the_budget() {
    let mut chance = Chance::new(5);
    let frame = Frame::full(96, 54);
    for bell in bells() {
        for tolerance in [1e-2, 1e-3, 1e-4] {
            let along = ALONGS[chance.between(0.0, 6.0) as usize];
            let pixels = photo(frame, 3, chance.between(0.0, 1.0) < 0.5);
            let images = images(frame, &pixels, &bell, along, 0.5 * 10f64.powf(chance.between(-1.0, 0.0)));
            let held = Held::new(&images, frame);
            let chosen = choose(&images, &[0], frame, held.largest, tolerance).unwrap();
            let off = held.off(&sheet(&images, &chosen.parts, frame).unwrap());
            let told = chosen.error + chosen.cut + chosen.rounding;
            assert!(off <= told + 1e-9 && chosen.error <= tolerance, "{bell:?} along {along}: {off:e} for {told:e}");
        }
    }
}

#[test]
fn a_sheet_is_the_same_for_any_number_of_threads() {
    let frame = Frame::full(48, 27);
    let images = images(frame, &photo(frame, 1, true), &Bell::Paraboloid, -0.7, 0.4);
    for way in [Way::Pairs, Way::Lattice { finer: 2, alone_above: 0.1 }] {
        let of = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let parts = [Part { image: 0, way, weights: [1.0; 3] }];
            pool.install(|| sheet(&images, &parts, frame).unwrap().planes)
        };
        assert!(of(1) == of(3), "{way:?}");
    }
}

#[test]
fn the_brightest_place_is_where_a_lamp_is_shown() {
    let frame = Frame::full(96, 54);
    for along in [-1.0, 0.3, 0.9] {
        let pixels = photo(frame, 2, false);
        let lamp = pixels.iter().position(|pixel| pixel[0] > 0.0).unwrap();
        let images = images(frame, &pixels, &Bell::Disc(Disc::new(0.1, 0, 0.0).unwrap()), along, 0.1);
        let place = frame.position((lamp % 96) as f64, (lamp / 96) as f64);
        let shown = frame.pixel(images.axis() + along * (place - images.axis()));
        let [x, y] = bright_places(&images, frame)[0].map(f64::from);
        assert!((DVec2::new(x, y) - shown).abs().max_element() <= 1.0, "{x} {y} {shown}");
    }
}
