//! Radiances from nothing to beyond f32, opposite ones, and what normalisation and files make of them.

use vglare::frame::Frame;
use vglare::gpu::Backend;
use vglare::photo::{self, Depth, Photo, WriteOptions};
use vglare::plan::{Evaluator, Request};
use vglare::renderer::{Normalize, Settings};
use vglare::scene::Ghost;

use super::{every_choice, look, request};
use crate::support::{glare, on_backend, on_one_backend, plan, plan_with, scenes};

fn frame() -> Frame {
    Frame::full(65, 37)
}

fn gain(ghosts: &[Ghost], gain: [f64; 3]) -> Vec<Ghost> {
    let one = |ghost: &Ghost| {
        let [r, g, b] = ghost.radiance;
        Ghost { radiance: [r * gain[0], g * gain[1], b * gain[2]], ..ghost.clone() }
    };
    ghosts.iter().map(one).collect()
}

/// Renders a scene by every evaluator; at least one has to be able to.
fn looked_at(name: &str, ghosts: &[Ghost], tolerance: f64) {
    on_backend(Backend::ALL[0], |renderer| {
        let mut had = 0;
        for evaluator in every_choice() {
            let chosen = evaluator.map_or("the plan's choice".into(), |evaluator| evaluator.to_string());
            let asked_for = Request { evaluator, ..request(tolerance) };
            had += usize::from(look(renderer, &format!("{name}, {chosen}"), ghosts, frame(), &asked_for).is_some());
        }
        assert!(had > 0, "{name}: no evaluator can do it");
    });
}

#[test]
fn radiances_from_1e_30_to_1e30_in_one_scene() {
    let plain = scenes::sized(5, 6, frame(), 0.3, 0.8);
    let at = |x: f64, size: f64, radiance: f64| scenes::one([x, 0.1], size, [radiance, 2.0 * radiance, 0.5 * radiance]);
    let ladder: Vec<Ghost> = (0..13).map(|k| at(0.1 * f64::from(k) - 0.6, 0.3, 10f64.powi(5 * k - 30))).collect();
    looked_at("every fifth power of ten from 1e-30 to 1e30", &ladder, 1e-3);
    looked_at("a colour for each end", &gain(&plain, [1e-30, 1.0, 1e30]), 1e-3);
    let mixed: Vec<Ghost> = [gain(&plain, [1e30, 1e-30, 1.0]), gain(&plain[..2], [1e-30, 1e-30, 1e-30])].concat();
    looked_at("colours and ghosts at both ends", &mixed, 1e-3);
    // What does not reach the picture may be as bright as it likes.
    for distance in [15.0, 20.0, 30.0, 60.0, 1000.0] {
        let far = [gain(&plain, [1e-30; 3]), vec![at(1.8 + 0.3 * distance, 0.3, 1e30)]].concat();
        looked_at(&format!("1e-30 here, and 1e30 {distance} sizes away"), &far, 1e-3);
    }
    let red_only = scenes::one([1.8 + 0.3 * 16.0, 0.0], 0.3, [1e30, 0.0, 0.0]);
    looked_at("1e-30 here, and 1e30 of red far away", &[gain(&plain, [1e-30; 3]), vec![red_only]].concat(), 1e-3);
}

/// A bright ghost that never reaches the picture must not make a faint one vanish.
#[test]
fn a_faint_ghost_survives_a_blinding_one_out_of_reach() {
    let faint = scenes::one([0.0, 0.0], 0.4, [1e-3, 2e-3, 3e-3]);
    let blinding = scenes::one([1000.0, 0.0], 0.4, [1e35; 3]);
    let plan = plan(&[faint.clone(), blinding], frame(), &request(1e-3)).unwrap();
    assert_eq!((plan.ghosts(), plan.dropped), (1, 1));
    for (scale, radiance) in plan.scale.iter().zip(faint.radiance) {
        assert!((scale / radiance - 1.0).abs() < 1e-3, "{:?}", plan.scale);
    }
}

#[test]
fn denormal_radiances_are_nothing_to_a_picture_and_something_to_the_plan() {
    let plain = scenes::sized(5, 6, frame(), 0.3, 0.8);
    for radiance in [1e-37, 1e-40, 1e-45, 1e-100, 1e-300] {
        looked_at(&format!("radiances of {radiance:e}"), &gain(&plain, [radiance; 3]), 1e-3);
    }
    looked_at("denormal beside plain", &gain(&plain, [1e-40, 1.0, 1e-310]), 1e-3);
}

#[test]
fn fields_beyond_f32_are_refused() {
    let plain = scenes::sized(5, 6, frame(), 0.3, 0.8);
    for radiance in [1e38, 1e100, 1e307] {
        let error = plan(&gain(&plain, [1.0, radiance, 1.0]), frame(), &request(1e-3)).unwrap_err().to_string();
        assert!(error.contains("the field reaches"), "{error}");
    }
    looked_at("just below", &gain(&plain, [3e36, 1.0, 1e-6]), 1e-3);
}

/// Ghosts and their opposites; the field is what is left.
#[test]
fn equal_and_opposite_ghosts() {
    let plain = scenes::sized(5, 6, frame(), 0.3, 0.8);
    let opposite = gain(&plain, [-1.0; 3]);
    let red: Vec<Ghost> = gain(&plain, [-1.0, 1.0, 1.0]);
    let near = gain(&plain, [-1.0 + 1e-3; 3]);
    let shuffled: Vec<Ghost> = plain.iter().chain(opposite.iter().rev()).cloned().collect();
    let paired: Vec<Ghost> = plain.iter().zip(&opposite).flat_map(|(a, b)| [a.clone(), b.clone()]).collect();
    let moved: Vec<Ghost> = opposite.iter().map(|g| Ghost { center: g.center + 0.01, ..g.clone() }).collect();
    looked_at("pairs that cancel", &paired, 1e-3);
    looked_at("all and then all their opposites", &shuffled, 1e-3);
    looked_at("red that cancels", &[plain.clone(), red].concat(), 1e-3);
    looked_at("all but a thousandth cancels", &[plain.clone(), near].concat(), 0.05);
    looked_at("opposites a little aside", &[plain.clone(), moved].concat(), 1e-2);
    // All but 1e-9, of which f32 has nothing left; beyond 1e-13 f64 has none either.
    let nearly = gain(&plain, [-1.0 + 1e-9; 3]);
    looked_at("all but a thousand-millionth cancels", &[plain, nearly].concat(), 1e-3);
}

#[test]
fn flat_fields_have_no_contrast_to_stretch() {
    let flat = [
        ("no ghost", Vec::new()),
        ("a bell ten thousand times as wide", vec![scenes::one([0.3, 0.1], 1e4, [1.0, 1.0, 1.0])]),
        ("a bright one", vec![scenes::one([0.3, 0.1], 1e5, [1e20, 1e20, 1e20])]),
        ("a faint one", vec![scenes::one([0.3, 0.1], 1e5, [1e-20, 1e-20, 1e-20])]),
        ("what cancels", vec![scenes::one([0.3, 0.1], 1.0, [1.0; 3]), scenes::one([0.3, 0.1], 1.0, [-1.0; 3])]),
    ];
    let settings = Settings { normalize: Normalize::Minmax, ..Settings::default() };
    on_one_backend(|backend, renderer| {
        for (name, ghosts) in &flat {
            for evaluator in Evaluator::ALL {
                let plan = plan_with(ghosts, frame(), 1e-4, evaluator);
                let field = glare(renderer, &plan, frame());
                let range = renderer.field.range(frame()).unwrap();
                let stretched = renderer.glare(frame(), &settings).unwrap();
                assert!(field.as_flattened().iter().all(|value| value.is_finite()), "{name}");
                let black = stretched.iter().all(|pixel| pixel[..3] == [0.0; 3]);
                assert!(black, "{backend}, {name}, {evaluator}: rounding of {range:?} was stretched to 0..1");
                println!("{backend}, {name}, {evaluator}: from {:e} to {:e}, drawn black", range[0], range[1]);
            }
        }
    });
}

/// What is not flat is stretched, down to a contrast of a hundredth of a percent.
#[test]
fn weak_contrast_is_stretched_all_the_same() {
    let settings = Settings { normalize: Normalize::Minmax, ..Settings::default() };
    on_one_backend(|backend, renderer| {
        for size in [3.0, 30.0, 100.0] {
            let ghosts = [scenes::one([0.3, 0.1], size, [1.0; 3])];
            for evaluator in Evaluator::ALL {
                let plan = plan_with(&ghosts, frame(), 1e-5, evaluator);
                renderer.field.set_scene(&plan).unwrap();
                let [low, high] = renderer.field.range(frame()).unwrap();
                let stretched = renderer.glare(frame(), &settings).unwrap();
                let ends = stretched
                    .iter()
                    .flat_map(|pixel| &pixel[..3])
                    .fold([f32::MAX, f32::MIN], |ends, &value| [ends[0].min(value), ends[1].max(value)]);
                println!("{backend}, size {size}, {evaluator}: contrast {:.1e} becomes {ends:?}", 1.0 - low / high);
                assert!(
                    ends[0].abs() < 1e-6 && (ends[1] - 1.0).abs() < 1e-6,
                    "{backend}, {size}, {evaluator}: {ends:?}"
                );
            }
        }
    });
}

/// Half floats end at 65504: what is beyond stays the largest of them, and nothing becomes infinite.
#[test]
fn half_floats_near_their_end() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("bright.exr");
    let frame = Frame::full(33, 1);
    let ghosts = [scenes::one([0.0, 0.0], 9.0, [1e5, 65504.0, 65519.0])];
    let mut pixels = vec![[0.0, 0.0, 0.5, 1.0]; 33];
    on_backend(Backend::ALL[0], |renderer| {
        let plan = plan_with(&ghosts, frame, 1e-4, Evaluator::Rows);
        renderer.field.set_scene(&plan).unwrap();
        renderer.composite(frame, &mut pixels, &Settings::default()).unwrap();
    });
    let photo = Photo::new(33, 1, pixels.clone());
    photo::write(&path, &photo, &WriteOptions { depth: Some(Depth::Half), ..WriteOptions::default() }).unwrap();
    let read = photo::read(&path).unwrap();
    let mut worst = 0.0f32;
    for (pixel, half) in pixels.iter().zip(&read.pixels) {
        for (&value, &half) in pixel.iter().zip(half) {
            assert!(half.is_finite() && half <= 65504.0, "{value} became {half}");
            let held = value.clamp(-65504.0, 65504.0);
            // Half a step of eleven bits, or of the smallest half float.
            worst = worst.max((half - held).abs() / (held.abs() * 2f32.powi(-11)).max(2f32.powi(-25)));
        }
    }
    let clipped = pixels.as_flattened().iter().filter(|&&value| value > 65504.0).count();
    println!("{clipped} of {} values are beyond 65504; the others are off by {worst} of half a step", 4 * 33);
    assert!(clipped > 0 && worst <= 1.0, "{worst}");
}
