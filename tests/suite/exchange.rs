//! Pixel buffers change how pixels travel, and not one bit of them.

use vglare::frame::{Frame, Window};
use vglare::plan::Evaluator;
use vglare::renderer::Settings;

use crate::support::{bits, on_each_backend, plan_with, scenes};

const FRAME: Frame = Frame::full(83, 45).with_window(Window { x: -3, y: 2, width: 87, height: 41 });

/// Pixels of every kind: light, negative, infinite, and NaN with a payload.
fn photo(frame: Frame, seed: usize) -> Vec<[f32; 4]> {
    let odd = [f32::INFINITY, -2.5, f32::from_bits(0x7fc0_1234), f32::MIN_POSITIVE / 8.0];
    (0..frame.window.pixels())
        .map(|i| [i as f32, 0.5, if i % 97 == seed { odd[i / 97 % 4] } else { 0.25 }, (i % 7) as f32])
        .collect()
}

#[test]
fn buffers_bring_the_same_bits() {
    let ghosts = scenes::random(8, 30, FRAME);
    let settings = Settings { strength: 0.75, ..Settings::default() };
    on_each_backend(|backend, renderer| {
        renderer.field.set_scene(&plan_with(&ghosts, FRAME, 1e-3, Evaluator::Grid)).unwrap();
        for tile_pixels in [4 << 20, 1000, 40] {
            renderer.field.set_tile_pixels(tile_pixels);
            let [straight, buffered] = [false, true].map(|buffered| {
                renderer.set_pixel_buffers(buffered);
                let mut picture = photo(FRAME, 5);
                renderer.composite(FRAME, &mut picture, &settings).unwrap();
                bits(&picture)
            });
            assert!(straight == buffered, "{backend}, tiles of {tile_pixels}");
            assert!(straight != bits(&photo(FRAME, 5)), "there is glare, or this test could not fail");
        }
    });
}

#[test]
fn a_picture_may_be_collected_after_the_next_is_submitted() {
    let small = Frame::full(31, 20);
    let ghosts = scenes::random(3, 12, FRAME);
    let plan = |frame| plan_with(&ghosts, frame, 1e-3, Evaluator::Rows);
    let settings = Settings::default();
    on_each_backend(|backend, renderer| {
        let mut alone = [photo(FRAME, 1), photo(small, 2)];
        for (frame, pixels) in [FRAME, small].into_iter().zip(&mut alone) {
            renderer.field.set_scene(&plan(frame)).unwrap();
            renderer.composite(frame, pixels, &settings).unwrap();
        }
        renderer.set_pixel_buffers(true);
        for tile_pixels in [4 << 20, 300] {
            renderer.field.set_tile_pixels(tile_pixels);
            let [mut first, mut second] = [photo(FRAME, 1), photo(small, 2)];
            renderer.field.set_scene(&plan(FRAME)).unwrap();
            let under_way = renderer.submit(FRAME, &mut first, &settings).unwrap();
            renderer.field.set_scene(&plan(small)).unwrap();
            let also = renderer.submit(small, &mut second, &settings).unwrap();
            renderer.field.probe(small, &[[3, 4]]).unwrap();
            renderer.collect(under_way, &mut first).unwrap();
            renderer.collect(also, &mut second).unwrap();
            assert!(bits(&first) == bits(&alone[0]), "{backend}, the first, tiles of {tile_pixels}");
            assert!(bits(&second) == bits(&alone[1]), "{backend}, the second, tiles of {tile_pixels}");
            // One that is never collected harms nobody.
            drop(renderer.submit(small, &mut photo(small, 0), &settings).unwrap());
        }
    });
}
