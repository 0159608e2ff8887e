//! What is light is decided in one way: by the search, by the mask over the window's photo, and by the composite.

use glam::DVec2;
use vglare::choices::LightBy;
use vglare::frame::Frame;
use vglare::gpu::{Backend, Screen};
use vglare::plan::Evaluator;
use vglare::renderer::{Mask, Settings};
use vglare::scene::{Emission, FindOptions, find, is_light};

use crate::support::scenes::Chance;
use crate::support::{on_live, plan_with};

const SIDE: u32 = 64;

/// A number that a channel may well have, or should not.
fn channel(chance: &mut Chance) -> f32 {
    const ODD: [f32; 10] =
        [0.0, -0.0, f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, f32::MIN, f32::MIN_POSITIVE, -60.0, 1.0];
    match chance.below(8) {
        0 => ODD[chance.below(ODD.len() as u64) as usize],
        1 | 2 => -chance.octaves(1e-3, 1e3) as f32,
        _ => chance.octaves(1e-3, 1e3) as f32,
    }
}

/// Pixels by chance; of some, alpha is what it should not be.
fn pixels(seed: u64) -> Vec<[f32; 4]> {
    let mut chance = Chance::new(seed);
    let pixel = |_| {
        let [r, g, b] = [(); 3].map(|()| channel(&mut chance));
        let alpha = if chance.below(4) == 0 { channel(&mut chance) } else { chance.between(0.0, 1.0) as f32 };
        [r, g, b, alpha]
    };
    let mut pixels: Vec<_> = (0..SIDE * SIDE).map(pixel).collect();
    pixels[0] = [100.0, -60.0, 0.0, 1.0];
    // So bright that the sum is beyond what a float holds, and hidden by alpha.
    pixels[1] = [f32::MAX, f32::MAX, f32::MAX, 0.0];
    pixels
}

#[test]
fn search_mask_and_composite_take_the_same_pixels_for_light() {
    // Of Rec.709, of ACES2065-1, whose blue is darker than black, and so wide that large channels overflow.
    let weights = [[0.2126, 0.7152, 0.0722], [0.343_966_46, 0.728_166_1, -0.072_132_55], [4.0, -5.0, 2.0]];
    let frame = Frame::full(SIDE, SIDE);
    let plan = plan_with(&[], frame, 1e-2, Evaluator::Rows);
    on_live(Backend::ALL[0], |live| {
        live.picture.field.set_scene(&plan).unwrap();
        let by = |case| if case < 6 { LightBy::Luminance } else { LightBy::Brightest };
        for (index, straight, by) in (0..12).map(|case| (case % 6 / 2, case % 2 == 1, by(case))) {
            let emission = Emission { straight, by, ..weights[index].into() };
            let mut pixels = pixels(7 + index as u64);
            // Seen by no device that flushes the sum.
            pixels[2] = [0.0, f32::MIN_POSITIVE, -60.0, 1.0];
            // Thresholds at which pixels lie exactly, and those that leave nothing out, or all.
            let exact = pixels.iter().step_by(301).map(|pixel| emission.brightness(pixel));
            let thresholds: Vec<f32> = exact.chain([0.0, 21.2, f32::MAX, f32::INFINITY]).collect();
            live.picture.load(frame, &pixels).unwrap();
            let screen = Screen::hidden(live.picture.field.device(), [SIDE, SIDE]).unwrap();
            for threshold in thresholds {
                let what = format!("{emission:?} from {threshold} on");
                let light: Vec<bool> =
                    pixels.iter().map(|pixel| is_light(emission.brightness(pixel), threshold)).collect();

                let (origin, threshold) = (DVec2::ZERO, f64::from(threshold));
                screen.clear([0.0; 3]);
                let mask = Mask { threshold, firefly_limit: 0.0, emission, origin, pitch: 1.0 };
                live.mask(&mask, &screen, screen.whole()).unwrap();
                let marked: Vec<bool> = screen.read().iter().map(|pixel| pixel[0] > 0).collect();

                let settings = Settings { light_gain: [0.5; 3], threshold, emission, ..Settings::default() };
                let mut picture = pixels.clone();
                live.picture.composite(frame, &mut picture, &settings).unwrap();
                let any = light.iter().any(|&light| light);
                let options =
                    FindOptions { by, threshold: Some(threshold), firefly_limit: 0.0, ..FindOptions::default() };
                assert_eq!(find(&pixels, &frame, emission, &options).regions > 0, any, "{what}");
                for (index, (before, after)) in pixels.iter().zip(&picture).enumerate() {
                    assert_eq!(marked[index], light[index], "the mask, {what}: {before:?}");
                    for colour in 0..3 {
                        let (before, after) = (before[colour], after[colour]);
                        let left = if light[index] && before > 0.0 { 0.5 * before } else { before };
                        let same = after == left || (after.is_nan() && left.is_nan());
                        // A device may take what is below the smallest normal number for nothing.
                        let tiny = before.abs() <= f32::MIN_POSITIVE && after == 0.0;
                        assert!(same || tiny, "the composite, {what}: {before} became {after}");
                    }
                }
            }
            live.picture.load(frame, &pixels).unwrap();
        }
    });
}
