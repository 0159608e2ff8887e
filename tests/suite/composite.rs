//! The photo with its glare: nothing but the glare is added, and a bad pixel harms only itself.

use vglare::choices::LightBy;
use vglare::frame::Frame;
use vglare::plan::{Evaluator, Plan, Request};
use vglare::renderer::{Normalize, Picture, Settings};
use vglare::scene::Emission;

use crate::support::{glare, on_each_backend, on_one_backend, plan, plan_with, scenes};

const SIZE: [u32; 2] = [37, 23];

fn frame() -> Frame {
    Frame::full(SIZE[0], SIZE[1])
}

fn scene() -> Plan {
    plan_with(&scenes::random(6, 12, frame()), frame(), 1e-3, Evaluator::Rows)
}

/// Values below nothing, beyond one and of every size.
fn photo() -> Vec<[f32; 4]> {
    let mut chance = scenes::Chance::new(17);
    let mut value = || {
        let size = chance.octaves(1e-6, 1e5) as f32;
        if chance.up_to(4) == 0 { -size } else { size }
    };
    (0..frame().window.pixels()).map(|i| [value(), value(), value(), i as f32 / 99.0]).collect()
}

fn composite(renderer: &mut Picture, photo: &[[f32; 4]], settings: &Settings) -> Vec<[f32; 4]> {
    let mut picture = photo.to_vec();
    renderer.composite(frame(), &mut picture, settings).unwrap();
    picture
}

#[test]
fn the_picture_is_the_photo_and_the_glare() {
    let plan = scene();
    on_each_backend(|_, renderer| {
        for strength in [1.0, 0.3, -2.0, 0.0] {
            let settings = Settings { strength, ..Settings::default() };
            renderer.field.set_scene(&plan).unwrap();
            let added = renderer.glare(frame(), &settings).unwrap();
            let picture = composite(renderer, &photo(), &settings);
            for ((photo, added), picture) in photo().iter().zip(&added).zip(&picture) {
                for colour in 0..3 {
                    // One rounding, of the sum; the multiplication before it may be fused with it.
                    let exact = f64::from(photo[colour]) + f64::from(added[colour]);
                    let limit = 6e-8 * (exact.abs() + f64::from(added[colour].abs()));
                    let error = (f64::from(picture[colour]) - exact).abs();
                    assert!(error <= limit, "{photo:?} and {added:?} make {picture:?}");
                }
            }
        }
    });
}

#[test]
fn a_strength_of_nothing_leaves_every_value_as_it_is() {
    let plan = scene();
    on_one_backend(|_, renderer| {
        renderer.field.set_scene(&plan).unwrap();
        assert_eq!(composite(renderer, &photo(), &Settings { strength: 0.0, ..Settings::default() }), photo());
    });
}

#[test]
fn alpha_keeps_every_bit() {
    let plan = scene();
    let alphas =
        [0.0, -0.0, 1.0, 0.5, -3.0, 1e30, 1e-40, f32::MIN_POSITIVE, f32::INFINITY, f32::NEG_INFINITY, f32::NAN];
    let mut photo = photo();
    for (pixel, alpha) in photo.iter_mut().zip(alphas.into_iter().cycle()) {
        pixel[3] = alpha;
    }
    on_one_backend(|backend, renderer| {
        renderer.field.set_scene(&plan).unwrap();
        for light_gain in [[1.0; 3], [0.5; 3]] {
            let settings = Settings { threshold: 1.0, light_gain, ..Settings::default() };
            for (before, after) in photo.iter().zip(composite(renderer, &photo, &settings)) {
                assert_eq!(before[3].to_bits(), after[3].to_bits(), "{backend}: {} became {}", before[3], after[3]);
            }
        }
    });
}

#[test]
fn a_bad_pixel_harms_only_itself() {
    let plan = scene();
    let clean = photo();
    let mut photo = clean.clone();
    let bad = [(5, f32::NAN), (40, f32::INFINITY), (41, f32::NEG_INFINITY), (200, -1e30), (850, f32::MAX)];
    for (index, value) in bad {
        photo[index][1] = value;
    }
    on_one_backend(|_, renderer| {
        renderer.field.set_scene(&plan).unwrap();
        let settings = Settings { light_gain: [0.5; 3], threshold: 1.0, ..Settings::default() };
        let expected = composite(renderer, &clean, &settings);
        let picture = composite(renderer, &photo, &settings);
        for (index, (picture, expected)) in picture.iter().zip(&expected).enumerate() {
            if bad.iter().all(|&(place, _)| place != index) {
                assert_eq!(picture, expected, "pixel {index}");
            }
        }
        assert!(picture[5][1].is_nan());
        assert_eq!([picture[40][1], picture[41][1]], [f32::INFINITY, f32::NEG_INFINITY]);
        assert_eq!(picture[200][1], -1e30);
    });
}

#[test]
fn the_glare_is_linear_in_the_strength() {
    let plan = scene();
    on_one_backend(|_, renderer| {
        let plain = glare(renderer, &plan, frame());
        for strength in [0.0, 0.25, 3.0, -1.5] {
            let scaled = renderer.glare(frame(), &Settings { strength, ..Settings::default() }).unwrap();
            for (plain, scaled) in plain.iter().zip(&scaled) {
                for colour in 0..3 {
                    let expected = f64::from(plain[colour]) * strength;
                    // Two multiplications by constants, in whichever order.
                    let error = (f64::from(scaled[colour]) - expected).abs();
                    assert!(
                        error <= 2.0 * 6e-8 * expected.abs(),
                        "{} times {strength} is {}",
                        plain[colour],
                        scaled[colour]
                    );
                }
                assert_eq!(scaled[3], 1.0, "the glare is opaque");
            }
        }
    });
}

#[test]
fn light_is_taken_only_where_the_photo_is_bright_enough() {
    let gain = [0.5, 0.25, 0.75];
    let settings =
        Settings { light_gain: gain, threshold: 2.0, emission: [0.25, 0.5, 0.25].into(), ..Settings::default() };
    // At the threshold, just below it, above it, far below, and infinite: what has no finite light keeps it.
    let below = f32::from_bits(2f32.to_bits() - 1);
    let colours =
        [[2.0; 3], [below; 3], [0.0, 5.0, 0.0], [0.0, 3.0, 0.0], [-50.0, 2.0, 1.0], [f32::INFINITY, 0.0, 0.0]];
    let taken = [true, false, true, false, false, false];
    let frame = Frame::full(6, 1);
    let photo = colours.map(|[r, g, b]| [r, g, b, 1.0]);
    on_one_backend(|_, renderer| {
        // No ghosts: what is left is the photo with its lights taken.
        renderer.field.set_scene(&plan_with(&[], frame, 1e-2, Evaluator::Rows)).unwrap();
        let mut picture = photo;
        renderer.composite(frame, &mut picture, &settings).unwrap();
        for ((before, after), taken) in photo.iter().zip(&picture).zip(taken) {
            for colour in 0..3 {
                let factor = if taken { gain[colour] as f32 } else { 1.0 };
                assert_eq!(after[colour], before[colour] * factor, "{before:?} became {after:?}");
            }
        }
    });
}

#[test]
fn light_is_taken_by_what_a_pixel_gives_of_its_colour() {
    // Straight alpha gives its share, and a negative weight makes blue darker than black.
    let emission = Emission { weights: [0.5, 0.75, -0.25], straight: true, by: LightBy::Luminance };
    let settings = Settings { light_gain: [0.5; 3], threshold: 1.0, emission, ..Settings::default() };
    let hidden = [0.0, 0.125, 0.5, f32::NAN].map(|alpha| [4.0, 4.0, 0.0, alpha]);
    let photo = [hidden[0], hidden[1], hidden[2], hidden[3], [0.0, 0.0, 90.0, 1.0], [2.0, 2.0, -90.0, 7.0]];
    let taken = [false, false, true, false, false, true];
    let frame = Frame::full(6, 1);
    on_one_backend(|_, renderer| {
        renderer.field.set_scene(&plan_with(&[], frame, 1e-2, Evaluator::Rows)).unwrap();
        let mut picture = photo;
        renderer.composite(frame, &mut picture, &settings).unwrap();
        for ((before, after), taken) in photo.iter().zip(&picture).zip(taken) {
            let left = |c: usize| if taken && before[c] > 0.0 { 0.5 * before[c] } else { before[c] };
            assert_eq!(after[..3], [0, 1, 2].map(left), "{before:?} became {after:?}");
        }
    });
}

#[test]
fn a_constant_is_taken_from_the_field_before_it_becomes_glare() {
    let plan = scene();
    let constant = [0.05, 0.01, 0.002];
    on_one_backend(|_, renderer| {
        renderer.field.set_scene(&plan).unwrap();
        for normalize in [Normalize::None, Normalize::Clamp, Normalize::Minmax] {
            let settings = Settings { strength: 2.0, normalize, ..Settings::default() };
            let raw = renderer.glare(frame(), &Settings { normalize: Normalize::None, ..settings }).unwrap();
            let with = renderer.glare(frame(), &settings).unwrap();
            let without = renderer.glare(frame(), &Settings { constant, ..settings }).unwrap();
            for ((raw, with), without) in raw.iter().zip(&with).zip(&without) {
                for colour in 0..3 {
                    let less = raw[colour] - 2.0 * constant[colour] as f32;
                    let want = match normalize {
                        Normalize::None => less,
                        Normalize::Clamp => less.clamp(0.0, 2.0),
                        Normalize::Minmax => with[colour],
                    };
                    let limit = 1e-6 * (raw[colour].abs() + 0.1);
                    assert!((without[colour] - want).abs() <= limit, "{normalize:?}: {without:?}, not {want}");
                }
            }
        }
    });
}

#[test]
fn the_constant_term_is_all_of_a_series_of_degree_zero() {
    let ghosts = scene().problem().ghosts().to_vec();
    let request = |degree| Request {
        evaluator: Some(Evaluator::Rows),
        period: Some([8.0, 6.0].into()),
        degree: Some([degree; 2]),
        ..Request::new(1e-2)
    };
    on_one_backend(|_, renderer| {
        renderer.field.set_scene(&plan(&ghosts, frame(), &request(0)).unwrap()).unwrap();
        let level = renderer.field.probe(frame(), &[[3, 4]]).unwrap()[0];
        renderer.field.set_scene(&plan(&ghosts, frame(), &request(40)).unwrap()).unwrap();
        let constant = renderer.field.constant_term().unwrap();
        for colour in 0..3 {
            assert!(
                (constant[colour] - level[colour]).abs() <= 1e-6 * level[colour].abs(),
                "{constant:?}, not {level:?}"
            );
        }
        renderer.field.set_scene(&plan_with(&ghosts, frame(), 1e-3, Evaluator::Direct)).unwrap();
        assert_eq!(renderer.field.constant_term(), None, "bells have none");
    });
}
