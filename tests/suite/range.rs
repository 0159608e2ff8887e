//! The reduction to minimum and maximum sees every pixel, whatever the picture's sides.

use vglare::frame::Frame;
use vglare::plan::Evaluator;
use vglare::renderer::{Normalize, Picture, Settings};

use crate::support::{glare, on_each_backend, on_one_backend, plan_with, scenes};

const SIZES: [[u32; 2]; 9] = [[1, 1], [1, 2], [2, 1], [3, 3], [5, 7], [17, 31], [255, 257], [640, 480], [1921, 1081]];

/// Scenes whose smallest and largest values are in turn in corners, on borders and within.
fn ghosts(frame: Frame, which: u64) -> Vec<vglare::scene::Ghost> {
    let (right, top) = (frame.x(f64::from(frame.width) - 1.0), frame.y(0.0));
    match which {
        0 => vec![scenes::one([right, top], 0.7, [1.0, 0.5, 0.2])],
        1 => vec![scenes::one([-right, -top], 0.9, [0.3, 0.2, 1.7])],
        2 => vec![scenes::one([right, -top], 0.8, [-1.0, 0.5, 0.2])],
        _ => scenes::random(which, 4, frame),
    }
}

fn ends(pixels: &[[f32; 4]]) -> [f32; 2] {
    let values = || pixels.iter().flat_map(|pixel| &pixel[..3]);
    assert!(values().all(|value| value.is_finite()));
    [values().copied().fold(f32::INFINITY, f32::min), values().copied().fold(f32::NEG_INFINITY, f32::max)]
}

/// Reduction and picture multiply the very same f32 values by the very same scale: nothing may differ.
fn the_range_is_that_of_the_pixels(renderer: &mut Picture, frame: Frame, tile_pixels: usize) {
    for which in 0..if frame.window.pixels() > 100_000 { 2 } else { 4 } {
        let ghosts = ghosts(frame, which);
        let plan = plan_with(&ghosts, frame, 1e-2, if which % 2 == 0 { Evaluator::Grid } else { Evaluator::Rows });
        let expected = ends(&glare(renderer, &plan, frame));
        renderer.field.set_tile_pixels(tile_pixels);
        assert_eq!(renderer.field.range(frame).unwrap(), expected, "{frame:?}, scene {which}, tiles of {tile_pixels}");
        renderer.field.set_tile_pixels(4 << 20);
    }
}

#[test]
fn the_range_is_that_of_all_pixels_at_odd_sizes() {
    on_each_backend(|_, renderer| {
        for [width, height] in SIZES {
            the_range_is_that_of_the_pixels(renderer, Frame::full(width, height), 4 << 20);
        }
    });
}

#[test]
fn the_range_gathers_tiles() {
    on_one_backend(|_, renderer| {
        for ([width, height], tile) in
            [([5, 7], 1), ([17, 31], 40), ([17, 31], 17), ([255, 257], 3000), ([640, 480], 100_000)]
        {
            the_range_is_that_of_the_pixels(renderer, Frame::full(width, height), tile);
        }
    });
}

#[test]
fn the_comparison_of_ranges_would_notice_one_pixel() {
    let mut pixels = vec![[0.5, 0.5, 0.5, 1.0]; 9];
    assert_eq!(ends(&pixels), [0.5, 0.5]);
    pixels[8][2] = 0.5 + f32::EPSILON;
    assert_eq!(ends(&pixels), [0.5, 0.5 + f32::EPSILON]);
}

#[test]
fn minmax_stretches_to_zero_and_one_and_clamp_clamps() {
    let frame = Frame::full(61, 35);
    let ghosts = [scenes::one([0.4, 0.3], 0.4, [2.5, 1.0, 0.5]), scenes::one([-0.8, 0.0], 0.3, [-0.7, 0.1, 0.0])];
    on_one_backend(|_, renderer| {
        for evaluator in Evaluator::ALL {
            let plan = plan_with(&ghosts, frame, 1e-3, evaluator);
            let plain = glare(renderer, &plan, frame);
            let mut with = |normalize| renderer.glare(frame, &Settings { normalize, ..Settings::default() }).unwrap();
            let [low, high] = ends(&plain);
            assert!(low < -0.5 && high > 2.0, "the scene is beyond 0..1 at both ends: {low} {high}");

            let stretched = with(Normalize::Minmax);
            assert_eq!(ends(&stretched), [0.0, 1.0], "{evaluator}");
            let clamped = with(Normalize::Clamp);
            for ((plain, stretched), clamped) in plain.iter().zip(&stretched).zip(&clamped) {
                for colour in 0..3 {
                    let expected = (plain[colour] - low) / (high - low);
                    // A subtraction and a division, which GLSL rounds to 2.5 ulp.
                    assert!((stretched[colour] - expected).abs() <= 5e-7, "{stretched:?} for {expected}");
                    assert_eq!(clamped[colour], plain[colour].clamp(0.0, 1.0));
                }
            }
        }
    });
}

#[test]
fn a_flat_field_stretches_to_nothing() {
    let frame = Frame::full(7, 5);
    on_one_backend(|_, renderer| {
        for evaluator in Evaluator::ALL {
            let plan = plan_with(&[], frame, 1e-3, evaluator);
            renderer.field.set_scene(&plan).unwrap();
            assert_eq!(renderer.field.range(frame).unwrap(), [0.0, 0.0]);
            for normalize in [Normalize::None, Normalize::Clamp, Normalize::Minmax] {
                let pixels = renderer.glare(frame, &Settings { normalize, ..Settings::default() }).unwrap();
                assert!(
                    pixels.iter().all(|pixel| *pixel == [0.0, 0.0, 0.0, 1.0]),
                    "{evaluator}, {normalize:?}: {pixels:?}"
                );
            }
        }
    });
}
