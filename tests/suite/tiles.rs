//! Tiles meet without a seam, bit for bit.

use vglare::frame::{Frame, Window};
use vglare::plan::Evaluator;
use vglare::renderer::{Normalize, Picture, Settings};

use crate::support::{bits, on_one_backend, plan_with, scenes};

const FRAME: Frame = Frame::full(83, 45).with_window(Window { x: -3, y: 2, width: 87, height: 41 });

fn pictures(renderer: &mut Picture, tile_pixels: usize) -> [Vec<[u32; 4]>; 3] {
    renderer.field.set_tile_pixels(tile_pixels);
    let settings = Settings { strength: 0.75, ..Settings::default() };
    let mut picture: Vec<[f32; 4]> =
        (0..FRAME.window.pixels()).map(|i| [i as f32, 0.5, 1.0 / (i + 1) as f32, 0.25]).collect();
    renderer.composite(FRAME, &mut picture, &settings).unwrap();
    let glare = renderer.glare(FRAME, &settings).unwrap();
    let stretched = renderer.glare(FRAME, &Settings { normalize: Normalize::Minmax, ..settings }).unwrap();
    [bits(&picture), bits(&glare), bits(&stretched)]
}

#[test]
fn tiles_meet_bit_for_bit() {
    let ghosts = scenes::random(8, 30, FRAME);
    on_one_backend(|backend, renderer| {
        for evaluator in Evaluator::ALL {
            renderer.field.set_scene(&plan_with(&ghosts, FRAME, 1e-3, evaluator)).unwrap();
            let whole = pictures(renderer, 4 << 20);
            for tile_pixels in [40, FRAME.window.width as usize, 1000] {
                let tiled = pictures(renderer, tile_pixels);
                for (what, (tiled, whole)) in ["composite", "glare", "minmax"].iter().zip(tiled.iter().zip(&whole)) {
                    let seam = tiled.iter().zip(whole).position(|(a, b)| a != b);
                    assert_eq!(seam, None, "{backend}, {evaluator}, {what}, tiles of {tile_pixels}: first difference");
                }
            }
        }
    });
}
