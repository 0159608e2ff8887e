//! Sizes, distances and pictures, from nothing to beyond reason.

use glam::DVec2;
use vglare::frame::Frame;
use vglare::gpu::Backend;
use vglare::plan::{Evaluator, Request};
use vglare::scene::Ghost;
use vglare::series::Bell;

use super::{every_choice, look, request};
use crate::support::{long, on_backend, scenes};

const COLOUR: [f64; 3] = [1.0, 2.0, 0.5];

/// A picture with a pixel at the origin, and few others: the degree that a ghost of a few pixels asks for grows with
/// the picture, and what it takes to sum it with a high power of that.
fn frame() -> Frame {
    Frame::full(33, 19)
}

/// Bells that need no period of their own.
fn bells() -> impl Iterator<Item = Bell> {
    Bell::examples().into_iter().filter(|bell| bell.shape().period().is_none())
}

/// Evaluators of a series: a bell with a kink has so many terms that summing them at every pixel takes a CPU too long.
fn series(bell: &Bell) -> Vec<Evaluator> {
    let smooth = *bell == Bell::Gaussian;
    Evaluator::ALL.into_iter().skip(1).filter(|&evaluator| smooth || evaluator != Evaluator::Series).collect()
}

/// The direct sum, those of [`series`], and the plan's own choice.
fn choices(bell: &Bell) -> Vec<Option<Evaluator>> {
    [Evaluator::Direct].into_iter().chain(series(bell)).map(Some).chain([None]).collect()
}

/// What is asked of an evaluator. The degree of a bell with a kink goes with one over its size and the tolerance: at the
/// finest one a series of one below a pixel has millions of terms, which take minutes and are no other than fewer.
fn asked(bell: &Bell, evaluator: Option<Evaluator>, pixels: f64) -> f64 {
    match evaluator {
        Some(Evaluator::Rows | Evaluator::Grid) if *bell != Bell::Gaussian && !long() => {
            if pixels < 1.0 {
                0.1
            } else {
                1e-2
            }
        }
        _ => 1e-3,
    }
}

fn ghost(bell: Bell, center: [f64; 2], size: f64) -> Ghost {
    Ghost { bell, ..scenes::one(center, size, COLOUR) }
}

#[test]
fn sizes_from_a_thousandth_of_a_pixel_to_a_hundred_periods() {
    let pixel = frame().pixel_size();
    on_backend(Backend::ALL[0], |renderer| {
        for pixels in [1e-3, 0.1, 1.0, 10.0, 100.0, 1e4] {
            for bell in bells() {
                for (place, center) in [("on a pixel", [0.0, 0.0]), ("off the pixels", [0.31 * pixel, 0.27 * pixel])] {
                    // No pixel meets more than e^-40 of it, and what bounds that is the product of a root for each axis.
                    if matches!(bell, Bell::Iris(_)) && pixels == 0.1 && place == "off the pixels" {
                        continue;
                    }
                    let ghosts = [ghost(bell.clone(), center, pixels * pixel)];
                    let mut had = 0;
                    for evaluator in choices(&bell) {
                        // Tens of thousands of terms by a lattice take a CPU tens of seconds; rows has them, too.
                        let dear = evaluator == Some(Evaluator::Grid) && bell != Bell::Gaussian && pixels <= 1.0;
                        if dear && !long() {
                            continue;
                        }
                        let chosen = evaluator.map_or("the plan's choice".into(), |evaluator| evaluator.to_string());
                        let what = format!("{bell} of {pixels:e} pixels {place}, {chosen}");
                        let tolerance = asked(&bell, evaluator, pixels);
                        let asked_for = Request { evaluator, ..request(tolerance) };
                        had += usize::from(look(renderer, &what, &ghosts, frame(), &asked_for).is_some());
                    }
                    assert!(had > 0, "{bell} of {pixels:e} pixels {place}: no evaluator can do it");
                }
            }
        }
    });
}

/// In a period that is given, a bell may be a hundred times as wide: the copies make it a constant, and the plan says what
/// that is off by.
#[test]
fn bells_a_hundred_times_as_wide_as_their_period_are_predicted_as_they_come() {
    let period = DVec2::new(6.0, 4.0);
    on_backend(Backend::ALL[0], |renderer| {
        for times in [0.1, 1.0, 10.0, 100.0] {
            for bell in [Bell::Gaussian, Bell::CosineSquared] {
                let ghosts = [ghost(bell.clone(), [0.2, 0.1], times * 4.0)];
                for evaluator in series(&bell) {
                    let what = format!("{bell} of {times} periods, {evaluator}");
                    let (period, evaluator) = (Some(period), Some(evaluator));
                    look(renderer, &what, &ghosts, frame(), &Request { period, evaluator, ..request(1e-2) });
                }
            }
        }
    });
}

#[test]
fn a_period_as_wide_as_the_picture_or_shorter_is_predicted_as_it_comes() {
    let frame = frame();
    let picture = frame.pixel_size() * DVec2::new(65.0, 37.0);
    on_backend(Backend::ALL[0], |renderer| {
        for bell in [Bell::Gaussian, Bell::CosineSquared] {
            let ghosts = [ghost(bell.clone(), [0.2, 0.1], 0.3), ghost(bell.clone(), [-1.5, -0.8], 0.5)];
            for part in [0.1, 0.5, 1.0, 1.0 + 1e-12] {
                for evaluator in series(&bell) {
                    let what = format!("{bell}, a period of {part} pictures, {evaluator}");
                    let (period, evaluator) = (Some(part * picture), Some(evaluator));
                    look(renderer, &what, &ghosts, frame, &Request { period, evaluator, ..request(0.1) });
                }
            }
        }
    });
}

#[test]
fn ghosts_a_million_units_away() {
    let near = || scenes::sized(3, 5, frame(), 0.3, 1.0);
    let far = |size: f64, [r, g, b]: [f64; 3]| scenes::one([1e6, -1e6], size, [r, g, b]);
    let with = |ghost: Ghost| [near(), vec![ghost]].concat();
    let cases = [
        ("a narrow one beside near ones", with(far(1.0, COLOUR)), Some(1)),
        ("one as wide as it is far", vec![far(1e6, COLOUR)], Some(0)),
        ("one of a quarter of the distance", vec![far(2.5e5, COLOUR)], Some(0)),
        ("a wide one beside near ones", with(far(1e6, COLOUR)), Some(0)),
        ("a blinding one whose flank reaches near ones", with(far(2.5e5, [1e7; 3])), Some(0)),
        ("a blinding narrow one beside near ones", with(far(1.0, [1e38; 3])), Some(1)),
        ("a narrow one alone", vec![far(1.0, COLOUR)], Some(1)),
    ];
    on_backend(Backend::ALL[0], |renderer| {
        for (name, ghosts, dropped) in &cases {
            let mut had = 0;
            for evaluator in every_choice() {
                let chosen = evaluator.map_or("the plan's choice".into(), |evaluator| evaluator.to_string());
                let asked_for = Request { evaluator, ..request(1e-3) };
                if let Some(outcome) = look(renderer, &format!("{name}, {chosen}"), ghosts, frame(), &asked_for) {
                    had += 1;
                    assert!(dropped.is_none_or(|dropped| outcome.plan.dropped == dropped), "{name}");
                }
            }
            assert!(had > 0, "{name}: no evaluator can do it");
        }
    });
}

#[test]
fn pictures_of_one_pixel_and_of_16384_pixels_a_side() {
    on_backend(Backend::ALL[0], |renderer| {
        for [width, height] in [[1, 1], [16384, 1], [1, 16384], [16385, 3], [3, 16385]] {
            let frame = Frame::full(width, height);
            let half = DVec2::new(f64::from(width) / f64::from(height), 1.0);
            // As wide as a fifth of the picture or, where that is nothing, of its height.
            let size = (0.2 * half).max(DVec2::splat(0.2)).max(DVec2::splat(2.0 * frame.pixel_size()));
            let at = |x: f64, y: f64| Ghost { size, ..scenes::one([x * half.x, y * half.y], 1.0, COLOUR) };
            let ghosts = [at(0.0, 0.0), at(-0.9, 0.8), at(1.1, -0.3)];
            for evaluator in every_choice() {
                let chosen = evaluator.map_or("the plan's choice".into(), |evaluator| evaluator.to_string());
                let what = format!("{width} x {height} pixels, {chosen}");
                let asked_for = Request { evaluator, ..request(1e-4) };
                look(renderer, &what, &ghosts, frame, &asked_for).unwrap_or_else(|| panic!("{what}: no plan"));
            }
        }
    });
}

/// The tables of f32 hold sizes in parts of a period, and one over sizes: both ends of what a size may be.
#[test]
fn sizes_at_the_ends_of_what_f32_holds() {
    let (smallest, largest) = (f64::from(f32::MIN_POSITIVE), f64::from(f32::MAX));
    on_backend(Backend::ALL[0], |renderer| {
        for bell in bells() {
            for size in [smallest, 1e-20, 1e20, largest] {
                let ghosts = [ghost(bell.clone(), [0.0, 0.0], size)];
                let mut had = 0;
                for evaluator in choices(&bell) {
                    let chosen = evaluator.map_or("the plan's choice".into(), |evaluator| evaluator.to_string());
                    let what = format!("{bell} of size {size:.1e}, {chosen}");
                    let asked_for = Request { evaluator, ..request(1e-3) };
                    had += usize::from(look(renderer, &what, &ghosts, frame(), &asked_for).is_some());
                }
                assert!(had > 0, "{bell} of size {size:e}: no evaluator can do it");
            }
        }
    });
}
