//! A scene looks the same at every resolution.

use vglare::frame::Frame;
use vglare::plan::Evaluator;
use vglare::reference::direct_at;
use vglare::scene::Ghost;

use crate::support::check::within;
use crate::support::{on_one_backend, plan_with, scenes};

const TOLERANCE: f64 = 1e-3;

fn ghosts() -> Vec<Ghost> {
    scenes::sized(21, 40, Frame::full(16, 9), 0.1, 1.0)
}

#[test]
fn every_size_of_a_picture_keeps_the_promise_at_its_own_pixels() {
    on_one_backend(|backend, renderer| {
        for [width, height] in [[960, 540], [1920, 1080], [3840, 2160], [7680, 4320]] {
            let frame = Frame::full(width, height);
            for evaluator in Evaluator::ALL {
                let plan = plan_with(&ghosts(), frame, TOLERANCE, evaluator);
                let pixels = scenes::probes(1, &ghosts(), &plan, frame);
                let exact = direct_at(&ghosts(), &scenes::positions(frame, &pixels));
                renderer.field.set_scene(&plan).unwrap();
                let actual = renderer.field.probe(frame, &pixels).unwrap();
                let name = format!("{backend}, {evaluator}, {height}p");
                within(plan.predicted.total(), &name, &pixels, &exact, &actual);
            }
        }
    });
}

#[test]
fn pixels_that_share_their_centres_agree_across_sizes() {
    // Three times as many pixels a side: the middle one of each nine lies where the coarse one does.
    let coarse = Frame::full(320, 180);
    let pixels: Vec<[i32; 2]> = (0..180).step_by(13).flat_map(|j| (0..320).step_by(17).map(move |i| [i, j])).collect();
    on_one_backend(|backend, renderer| {
        for evaluator in Evaluator::ALL {
            let mut look = |frame: Frame, times: i32| {
                let plan = plan_with(&ghosts(), frame, TOLERANCE, evaluator);
                renderer.field.set_scene(&plan).unwrap();
                let place = |k: i32| times * k + times / 2;
                let mine: Vec<_> = pixels.iter().map(|&[i, j]| [place(i), place(j)]).collect();
                for (&[i, j], &[a, b]) in pixels.iter().zip(&mine) {
                    let shared = coarse.position(f64::from(i), f64::from(j));
                    assert!((frame.position(f64::from(a), f64::from(b)) - shared).length() < 1e-15);
                }
                renderer.field.probe(frame, &mine).unwrap()
            };
            let at_180 = look(coarse, 1);
            for (frame, times) in [(Frame::full(960, 540), 3), (Frame::full(2880, 1620), 9)] {
                // Each is within the tolerance of the truth, so they are within twice of each other.
                let difference = within(
                    2.0 * TOLERANCE,
                    &format!("{backend}, {evaluator}, 180 rows against {}", frame.height),
                    &pixels,
                    &at_180,
                    &look(frame, times),
                );
                println!("{backend}, {evaluator}: 180 rows against {}: {:.1e}", frame.height, difference.relative);
            }
        }
    });
}
