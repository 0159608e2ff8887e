use super::*;
use crate::frame::Window;

const REC709: [f64; 3] = [0.2126, 0.7152, 0.0722];
const BLACK: [f32; 4] = [0.0, 0.0, 0.0, 1.0];

fn given(threshold: f64) -> FindOptions {
    FindOptions { threshold: Some(threshold), merge: 0.0, ..FindOptions::VERSION_1 }
}

/// A black picture with these pixels.
fn picture(width: u32, height: u32, lights: &[(u32, u32, [f32; 3])]) -> (Vec<[f32; 4]>, Frame) {
    let mut pixels = vec![BLACK; (width * height) as usize];
    for &(i, j, [r, g, b]) in lights {
        pixels[(j * width + i) as usize] = [r, g, b, 1.0];
    }
    (pixels, Frame::full(width, height))
}

/// A scene given by a function of the plane: a field under a bright sky, with a sun that has an aureole, two lamps and a
/// window. Each pixel is the mean of some samples.
fn landscape(width: u32, height: u32) -> (Vec<[f32; 4]>, Frame) {
    let disc = |x: f64, y: f64, at: (f64, f64), r: f64| (x - at.0).hypot(y - at.1) < r;
    let radiance = |x: f64, y: f64| {
        let sun = if disc(x, y, (0.7, 0.5), 0.03) { 8000.0 } else { 0.0 };
        let off = ((x - 0.7).powi(2) + (y - 0.5).powi(2)) / (2.0 * 0.05 * 0.05);
        let aureole = if off < 30.0 { 40.0 * (-off).exp() } else { 0.0 };
        let lamps = if disc(x, y, (-1.0, -0.3), 0.02) || disc(x, y, (-0.8, -0.3), 0.015) { 900.0 } else { 0.0 };
        let window = if (x + 0.2).abs() < 0.12 && (y + 0.6).abs() < 0.05 { 300.0 } else { 0.0 };
        0.2 + if y > 0.0 { 2.0 + y } else { 0.1 * (x - x.round()) } + sun + aureole + lamps + window
    };
    let frame = Frame::full(width, height);
    let n = if width > 2000 { 2 } else { 4 };
    let offset = |s: u32| (f64::from(s) + 0.5) / f64::from(n) - 0.5;
    let samples: Vec<_> = (0..n * n).map(|s| (offset(s % n), offset(s / n))).collect();
    let pixel = |i: u32, j: u32| {
        let sample = |&(di, dj): &(f64, f64)| radiance(frame.x(f64::from(i) + di), frame.y(f64::from(j) + dj));
        let l = (samples.iter().map(sample).sum::<f64>() / samples.len() as f64) as f32;
        [l, 0.9 * l, 0.7 * l, 1.0]
    };
    ((0..width * height).map(|p| pixel(p % width, p / width)).collect(), frame)
}

#[test]
fn a_light_top_right_is_at_positive_x_and_y() {
    let (pixels, frame) = picture(8, 4, &[(6, 0, [3.0, 2.0, 1.0])]);
    let found = find(&pixels, &frame, REC709, &given(0.5));
    assert_eq!((found.regions, found.dropped, found.rule), (1, 0, Rule::Given));
    let light = found.lights[0];
    assert_eq!(light.position, DVec2::new(1.25, 0.75));
    assert_eq!(light.flux, [0.75, 0.5, 0.25]);
    assert!((light.size - 0.5 / 12_f64.sqrt()).abs() < 1e-15);
}

#[test]
fn a_square_has_the_size_of_its_uniform_density() {
    let square: Vec<_> = (0..100).map(|p| (20 + p % 10, 30 + p / 10, [2.0; 3])).collect();
    let (pixels, frame) = picture(64, 64, &square);
    let light = find(&pixels, &frame, REC709, &given(1.0)).lights[0];
    let side = 10.0 * frame.pixel_size();
    assert!((light.size - side / 12_f64.sqrt()).abs() < 1e-12, "{}", light.size);
    assert!((light.flux[0] - 2.0 * side * side).abs() < 1e-12);
    assert!((light.position - frame.position(24.5, 34.5)).length() < 1e-12);
}

#[test]
fn the_window_moves_the_pixels_and_not_the_picture() {
    let (pixels, _) = picture(3, 2, &[(1, 1, [1.0; 3])]);
    for (x, y) in [(10, 20), (-5, -7), (5000, 3)] {
        let frame = Frame::full(100, 50).with_window(Window { x, y, width: 3, height: 2 });
        let light = find(&pixels, &frame, REC709, &given(0.5)).lights[0];
        assert!((light.position - frame.position(f64::from(x) + 1.0, f64::from(y) + 1.0)).length() < 1e-12);
        assert_eq!(light.flux, [0.04 * 0.04; 3]);
    }
}

#[test]
fn close_regions_merge_by_the_parallel_axis_theorem() {
    let (pixels, frame) = picture(100, 100, &[(50, 50, [3.0; 3]), (54, 50, [1.0; 3]), (90, 50, [2.0; 3])]);
    let merged = find(&pixels, &frame, REC709, &FindOptions { merge: 0.08, ..given(0.5) });
    assert_eq!((merged.regions, merged.merged(), merged.lights.len()), (3, 1, 2));
    let light = merged.lights[0];
    assert!((light.position - frame.position(51.0, 50.0)).length() < 1e-12);
    assert!((light.flux[1] - 4.0 * 0.02 * 0.02).abs() < 1e-15);
    // Variance along x is 3, along y 0; half their sum, and the twelfth of a pixel.
    assert!((light.size - 0.02 * (1.5 + 1.0 / 12.0_f64).sqrt()).abs() < 1e-12);
    assert_eq!(find(&pixels, &frame, REC709, &FindOptions { merge: 0.079, ..given(0.5) }).lights.len(), 3);
}

#[test]
fn a_string_of_lamps_does_not_collapse_into_one() {
    let lamps: Vec<_> = (0..40).map(|k| (2 + 4 * k, 5, [1.0; 3])).collect();
    let (pixels, frame) = picture(200, 100, &lamps);
    let found = find(&pixels, &frame, REC709, &FindOptions { merge: 0.1, ..given(0.5) });
    // The left-most of equal ones is kept first and takes the next, 0.08 away, so every second one stays.
    assert_eq!(found.lights.len(), 20);
}

#[test]
fn the_cap_keeps_the_brightest_and_says_what_it_drops() {
    let lights: Vec<_> = (0..10).map(|k| (10 * k, 3, [k as f32 + 1.0; 3])).collect();
    let (pixels, frame) = picture(100, 10, &lights);
    let found = find(&pixels, &frame, REC709, &FindOptions { max_lights: 3, ..given(0.5) });
    assert_eq!((found.lights.len(), found.regions, found.dropped, found.merged()), (3, 10, 7, 0));
    assert!((found.dropped_share - 28.0 / 55.0).abs() < 1e-6);
    assert!((found.shares[0] - 10.0 / 55.0).abs() < 1e-6);
    assert!(found.lights.is_sorted_by(|a, b| a.flux[1] >= b.flux[1]));
}

#[test]
fn lights_beyond_the_cap_join_the_nearest_and_no_flux_is_lost() {
    let lights: Vec<_> = (0..10).map(|k| (10 * k, 3, [k as f32 + 1.0, 2.0, 0.0])).collect();
    let (pixels, frame) = picture(100, 10, &lights);
    let options = FindOptions { max_lights: 3, beyond: Beyond::Join, ..given(0.5) };
    let found = find(&pixels, &frame, REC709, &options);
    assert_eq!((found.lights.len(), found.regions, found.dropped, found.joined, found.merged()), (3, 10, 0, 7, 0));
    assert!((found.shares.iter().sum::<f64>() - 1.0).abs() < 1e-12 && found.dropped_share == 0.0);
    let area = frame.pixel_size().powi(2);
    let flux = |colour: usize| found.lights.iter().map(|light| light.flux[colour]).sum::<f64>() / area;
    assert!((flux(0) - 55.0).abs() < 1e-9 && (flux(1) - 20.0).abs() < 1e-9);
    // Seven are left of the third, which comes first by now, in the middle of what it has taken.
    let luminance = |k: u32| 0.2126 * (f64::from(k) + 1.0) + 2.0 * 0.7152;
    let (weight, moment) =
        (0..8).fold((0.0, 0.0), |(sum, moment), k| (sum + luminance(k), moment + luminance(k) * 10.0 * f64::from(k)));
    let first = frame.pixel(found.lights[0].position);
    assert!((first.x - moment / weight).abs() < 1e-5 && (first.y - 3.0).abs() < 1e-9, "{first}");
    let total = (0..10).map(luminance).sum::<f64>();
    let share = (0..7).map(luminance).sum::<f64>() / total;
    assert!((found.joined_share - share).abs() < 1e-6, "{} {share}", found.joined_share);
    assert!(found.lights[0].size > 0.4 && found.lights[1].size < 0.1, "{:?}", found.lights);
    // Nobody is there to be joined.
    let none = find(&pixels, &frame, REC709, &FindOptions { max_lights: 0, ..options });
    assert_eq!((none.lights.len(), none.dropped, none.joined), (0, 10, 0));
    assert!((none.dropped_share - 1.0).abs() < 1e-12);
}

#[test]
fn lamps_of_any_colour_are_found_by_their_brightest_channel() {
    let lamps = [(10, 5, [1.0, 0.05, 0.0]), (40, 5, [1.0, 0.5, 0.0]), (70, 5, [0.0, 0.1, 1.0]), (85, 5, [1.0; 3])];
    let (mut pixels, frame) = picture(100, 10, &lamps);
    pixels.iter_mut().filter(|pixel| **pixel == BLACK).for_each(|pixel| *pixel = [0.1, 0.1, 0.1, 1.0]);
    let options = |by| FindOptions { by, threshold: Some(0.9), ..FindOptions::default() };
    let found = find(&pixels, &frame, REC709, &options(LightBy::Brightest));
    assert_eq!((found.lights.len(), found.by, found.peak), (4, LightBy::Brightest, 1.0));
    assert!(found.shares.iter().all(|share| (share - 0.25).abs() < 1e-9), "{:?}", found.shares);
    assert_eq!(find(&pixels, &frame, REC709, &options(LightBy::Luminance)).lights.len(), 1);
    // Clipped highlights of a photo for a display, by themselves.
    let patch = |x: u32, colour| (0..9).map(move |p| (x + p % 3, 20 + p / 3, colour));
    let patch: Vec<_> = patch(20, [1.0, 0.1, 0.0]).chain(patch(60, [1.0; 3])).collect();
    let (mut pixels, frame) = picture(100, 100, &patch);
    pixels.iter_mut().filter(|pixel| **pixel == BLACK).for_each(|pixel| *pixel = [0.2, 0.2, 0.2, 1.0]);
    let found = find(&pixels, &frame, REC709, &FindOptions::default());
    assert_eq!((found.rule, found.lights.len()), (Rule::Clipped, 2));
    assert_eq!(find(&pixels, &frame, REC709, &FindOptions::VERSION_1).lights.len(), 1);
}

#[test]
fn equal_lights_come_from_the_top_and_then_from_the_left() {
    let (pixels, frame) = picture(9, 9, &[(7, 1, [1.0; 3]), (1, 7, [1.0; 3]), (1, 1, [1.0; 3])]);
    let found = find(&pixels, &frame, REC709, &given(0.5));
    let at: Vec<_> = found.lights.iter().map(|light| frame.pixel(light.position).round().as_i64vec2()).collect();
    assert_eq!(at, [I64Vec2::new(1, 1), I64Vec2::new(7, 1), I64Vec2::new(1, 7)]);
}

#[test]
fn what_is_not_finite_is_no_light_and_negatives_count_as_0() {
    let bad = [(0, 0, [f32::NAN, 9.0, 9.0]), (3, 0, [9.0, f32::INFINITY, 9.0]), (6, 0, [9.0, 9.0, f32::NEG_INFINITY])];
    let (mut pixels, frame) = picture(9, 3, &bad);
    assert_eq!(find(&pixels, &frame, REC709, &given(0.5)).lights, []);
    pixels[9 + 4] = [2.0, 4.0, -8.0, 0.0];
    let found = find(&pixels, &frame, REC709, &FindOptions { firefly_limit: 0.0, ..FindOptions::default() });
    let area = frame.pixel_size().powi(2);
    assert_eq!((found.lights.len(), found.lights[0].flux), (1, [2.0 * area, 4.0 * area, 0.0]));
}

#[test]
fn pictures_without_light_have_none() {
    for level in [0.0, 0.18, 1.0, 5e4] {
        let (frame, pixels) = (Frame::full(16, 9), vec![[level, level, level, 1.0]; 144]);
        let found = find(&pixels, &frame, REC709, &FindOptions::default());
        assert_eq!((found.lights.len(), found.regions, found.dropped_share), (0, 0, 0.0));
        assert!(found.threshold >= f64::from(level));
    }
    let one = find(&[[3.0; 4]], &Frame::full(1, 1), REC709, &given(0.0));
    assert_eq!((one.lights[0].position, one.lights[0].flux), (DVec2::ZERO, [12.0; 3]));
    assert_eq!(find(&[BLACK], &Frame::full(1, 1), REC709, &given(0.0)).lights, []);
    let empty = Frame::full(8, 8).with_window(Window { x: 0, y: 0, width: 0, height: 0 });
    assert_eq!(find(&[], &empty, REC709, &FindOptions::default()).lights, []);
}

#[test]
fn a_firefly_is_no_light_and_leaves_the_lamps_theirs() {
    let (mut pixels, frame) = (vec![[0.3, 0.3, 0.3, 1.0]; 40_000], Frame::full(200, 200));
    for p in [100, 101, 300, 301] {
        pixels[p + 20_000] = [400.0, 350.0, 300.0, 1.0];
    }
    let clean = find(&pixels, &frame, REC709, &FindOptions::default());
    assert_eq!((clean.lights.len(), clean.fireflies, clean.first_firefly), (1, 0, None));
    pixels[5050] = [6e4, 6e4, 6e4, 1.0];
    let found = find(&pixels, &frame, REC709, &FindOptions::default());
    assert_eq!((found.fireflies, found.first_firefly), (1, Some((50, 25))));
    assert_eq!((&found.lights, found.threshold), (&clean.lights, clean.threshold));
    let all = find(&pixels, &frame, REC709, &FindOptions { firefly_limit: 0.0, ..FindOptions::default() });
    assert_eq!((all.fireflies, all.lights[0].flux[0] > 1000.0 * frame.pixel_size().powi(2)), (0, true));
    // Given a threshold, too, and where the window lies elsewhere.
    let frame = Frame::full(400, 400).with_window(Window { x: -7, y: 100, width: 200, height: 200 });
    let given = find(&pixels, &frame, REC709, &FindOptions { threshold: Some(10.0), ..FindOptions::default() });
    assert_eq!((given.lights.len(), given.first_firefly), (1, Some((43, 125))));
}

#[test]
fn the_sun_in_one_pixel_of_a_small_panorama_is_a_light() {
    // What the 256 × 128 of a panorama at sunrise has there, each pixel a mean of 4 × 4: 180 times its neighbours.
    let (mut pixels, frame) = (vec![[0.25, 0.25, 0.25, 1.0]; 256 * 128], Frame::full(256, 128));
    for (offset, l) in [(0, 7596.0), (1, 42.0), (256, 40.0), (257, 30.0)] {
        pixels[9000 + offset] = [l, l, l, 1.0];
    }
    let found = find(&pixels, &frame, REC709, &FindOptions::default());
    assert_eq!((found.lights.len(), found.fireflies), (1, 0));
}

#[test]
fn straight_alpha_takes_its_share_and_premultiplied_does_not() {
    let (mut pixels, frame) =
        picture(20, 10, &[(4, 4, [8.0; 3]), (5, 4, [8.0; 3]), (14, 4, [8.0; 3]), (15, 4, [8.0; 3])]);
    let lamp = |alpha: f32, at: usize, pixels: &mut Vec<[f32; 4]>| {
        (pixels[at][3], pixels[at + 1][3]) = (alpha, alpha);
    };
    lamp(0.0, 84, &mut pixels);
    lamp(0.5, 94, &mut pixels);
    let straight = Emission { straight: true, ..REC709.into() };
    let found = find(&pixels, &frame, straight, &given(1.0));
    let area = 2.0 * frame.pixel_size().powi(2);
    assert_eq!((found.lights.len(), found.lights[0].flux, found.peak), (1, [4.0 * area; 3], 4.0));
    assert_eq!(find(&pixels, &frame, straight, &given(4.5)).lights, []);
    assert_eq!(find(&pixels, &frame, REC709, &given(1.0)).lights.len(), 2);
}

#[test]
fn a_picture_darker_than_black_has_no_lights() {
    let weights = [0.343_966, 0.728_166, -0.072_133];
    let (pixels, frame) = (vec![[0.0, 0.001, 0.4, 1.0]; 200], Frame::full(20, 10));
    let found = find(&pixels, &frame, weights, &FindOptions::VERSION_1);
    assert_eq!((found.lights.len(), found.threshold, found.peak), (0, 0.0, 0.0));
}

#[test]
fn the_same_scene_has_the_same_lights_at_any_resolution() {
    let of = |width, height| {
        let (pixels, frame) = landscape(width, height);
        find(&pixels, &frame, REC709, &FindOptions::default())
    };
    let expected = of(1920, 1080);
    assert_eq!(expected.lights.len(), 4, "the sun, the window and two lamps: {expected:?}");
    let places = [(0.7, 0.5), (-0.2, -0.6), (-1.0, -0.3), (-0.8, -0.3)];
    for (light, (x, y)) in expected.lights.iter().zip(places) {
        assert!((light.position - DVec2::new(x, y)).length() < 0.002, "{light:?} is not at {x}, {y}");
    }
    for (width, height) in [(480, 270), (960, 540), (3840, 2160)] {
        let found = of(width, height);
        assert!(
            (found.threshold / expected.threshold).log2().abs() < 0.5,
            "{} {}",
            found.threshold,
            expected.threshold
        );
        assert_eq!(found.lights.len(), 4);
        for (light, expected) in found.lights.iter().zip(&expected.lights) {
            assert!((light.position - expected.position).length() < 0.003, "{light:?} {expected:?}");
            assert!((light.flux[1] / expected.flux[1] - 1.0).abs() < 0.03, "{light:?} {expected:?}");
            assert!((light.size - expected.size).abs() < 0.1 * 2.0 / f64::from(height), "{light:?} {expected:?}");
        }
    }
}

#[test]
fn the_result_does_not_depend_on_the_threads() {
    let (pixels, frame) = landscape(641, 479);
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| find(&pixels, &frame, REC709, &FindOptions { threshold: Some(1.9), ..Default::default() }))
    };
    assert!(!with(1).lights.is_empty());
    assert_eq!(with(1), with(7));
}

#[test]
fn a_hundred_thousand_regions_merge_in_a_moment() {
    let lights: Vec<_> = (0..100_000).map(|k| (2 * (k % 500), 2 * (k / 500), [1.0 + (k % 97) as f32; 3])).collect();
    let (pixels, frame) = picture(1000, 400, &lights);
    let start = std::time::Instant::now();
    let found = find(&pixels, &frame, REC709, &given(0.5));
    assert_eq!((found.regions, found.dropped), (100_000, 100_000 - 64));
    let joined = find(&pixels, &frame, REC709, &FindOptions { max_lights: 4096, beyond: Beyond::Join, ..given(0.5) });
    assert_eq!((joined.lights.len(), joined.joined), (4096, 100_000 - 4096));
    let merged = find(&pixels, &frame, REC709, &FindOptions { merge: 0.02, max_lights: usize::MAX, ..given(0.5) });
    assert_eq!(merged.merged() + merged.lights.len(), 100_000);
    let (all, kept) = (lights.iter().map(|l| f64::from(l.2[0])).sum::<f64>(), frame.pixel_size().powi(2));
    let flux: f64 = merged.lights.iter().map(|light| light.flux[0]).sum();
    assert!((flux / (all * kept) - 1.0).abs() < 1e-9, "merging keeps the flux");
    // Quadratic time would take minutes.
    assert!(start.elapsed().as_secs_f64() < 5.0);
}

/// A pixel twice as wide as high has twice the area, and the extent along one axis of a rectangle of 2 by 1.
#[test]
fn lights_of_wide_pixels_lie_farther_apart_and_are_larger() {
    let (pixels, frame) = picture(8, 4, &[(6, 0, [3.0, 2.0, 1.0])]);
    let frame = Frame { pixel_aspect: 2.0, ..frame };
    let light = find(&pixels, &frame, REC709, &given(0.5)).lights[0];
    assert_eq!(light.position, DVec2::new(2.5, 0.75));
    assert_eq!(light.flux, [3.0, 2.0, 1.0].map(|radiance| radiance * 1.0 * 0.5));
    assert!((light.size - 0.5 * (5.0f64 / 24.0).sqrt()).abs() < 1e-15, "{}", light.size);
    // Two pixels of a row are 1 apart, two of a column 0.5.
    let two = |i, j| picture(8, 4, &[(2, 1, [3.0; 3]), (i, j, [3.0; 3])]).0;
    let found = |pixels: &[[f32; 4]]| find(pixels, &frame, REC709, &given(0.5)).lights;
    let spread = |lights: Vec<Light>| (lights.len(), lights[0].size.powi(2));
    let pixel = 0.25 * 5.0 / 24.0;
    let [(one, across), (other, down)] = [two(3, 1), two(2, 2)].map(|pixels| spread(found(&pixels)));
    assert_eq!((one, other), (1, 1));
    // Variances of ±d/2 along one of two axes: d²/8.
    assert!((across - pixel - 1.0 / 8.0).abs() < 1e-15 && (down - pixel - 0.25 / 8.0).abs() < 1e-15, "{across} {down}");
    let merged = |merge| find(&two(4, 1), &frame, REC709, &FindOptions { merge, ..given(0.5) }).lights.len();
    assert_eq!((merged(1.99), merged(2.01)), (2, 1));
}

#[test]
fn a_lamp_that_flickers_around_a_soft_threshold_comes_and_goes_by_its_own_light() {
    let flux = |level: f32, knee: f64| {
        let mut pixels = vec![[0.1, 0.1, 0.1, 1.0]; 64];
        pixels[27] = [level, level, level, 1.0];
        pixels[60] = [100.0, 100.0, 100.0, 1.0];
        let options =
            FindOptions { threshold: Some(10.0), knee, firefly_limit: 0.0, merge: 0.0, ..FindOptions::default() };
        let frame = Frame::full(8, 8);
        let found = find(&pixels, &frame, [0.2126, 0.7152, 0.0722], &options);
        let area = frame.pixel_size().powi(2);
        found.lights.iter().map(|light| light.flux[0]).sum::<f64>() / area
    };
    // All of it at once, or no more than it grows by itself.
    assert!(flux(10.1, 0.0) - flux(9.9, 0.0) > 10.0);
    let mut last = flux(5.0, 2.0);
    assert!((last - 90.0).abs() < 1e-4, "the other lamp alone: {last}");
    for step in 1..=150 {
        let next = flux(5.0 + 0.1 * step as f32, 2.0);
        assert!((-1e-4..0.1001).contains(&(next - last)), "{last} {next}");
        last = next;
    }
    assert!((last - 100.0).abs() < 1e-3, "all that is above the threshold: {last}");
}
