use std::f64::consts::TAU;

use glam::DVec2;

use super::*;
use crate::chance::Chance;
use crate::frame::Window;

/// Pixels by chance over eight decades, some of them no light.
fn pixels(count: usize, chance: &mut Chance) -> Vec<[f32; 4]> {
    let mut pixels: Vec<[f32; 4]> =
        (0..count).map(|_| [0, 1, 2, 3].map(|_| 10f64.powf(chance.between(-4.0, 4.0)) as f32)).collect();
    pixels[count / 2] = [f32::NAN, -3.0, f32::INFINITY, 1.0];
    pixels
}

/// Σ L Ω e^{−i(x q_x + y q_y)} by definition.
fn waves(pixels: &[[f32; 4]], frame: Frame, q: DVec2) -> [[f64; 2]; 3] {
    let area = frame.pixel_sides().element_product();
    let mut sums = [[0.0; 2]; 3];
    for (index, pixel) in pixels.iter().enumerate() {
        let (width, x, y) = (frame.window.width as usize, frame.window.x, frame.window.y);
        let at = frame.position(f64::from(x + (index % width) as i32), f64::from(y + (index / width) as i32));
        let (sin, cos) = q.dot(at).sin_cos();
        for (sum, light) in sums.iter_mut().zip(pixel) {
            let light = if light.is_finite() && *light > 0.0 { area * f64::from(*light) } else { 0.0 };
            *sum = [sum[0] + light * cos, sum[1] - light * sin];
        }
    }
    sums
}

/// The same from moments, or from the pixels.
fn from_raster(raster: &Raster, reduction: Reduction, q: DVec2) -> [[f64; 2]; 3] {
    let theta = q * reduction.pitch() * raster.frame().pixel_sides();
    let correction = if reduction.level == 0 { 1.0 } else { spline(theta.x) * spline(theta.y) };
    // The first harmonic.
    let waves = raster.waves(reduction, q, [2, 2], [true; 3]);
    let (sin, cos) = q.dot(raster.middle(reduction)).sin_cos();
    waves.map(|waves| {
        let [cc, sc, cs, ss] = waves.map(|wave| wave[(1, 1)] / correction);
        let (re, im) = (cc - ss, -sc - cs);
        [re * cos + im * sin, im * cos - re * sin]
    })
}

#[test]
fn moments_have_the_waves_of_the_pixels_within_the_bound() {
    let mut chance = Chance::new(5);
    let windows = [
        Window { x: 0, y: 0, width: 96, height: 54 },
        Window { x: -7, y: 11, width: 61, height: 83 },
        Window { x: 3, y: 0, width: 5, height: 1 },
    ];
    for (window, aspect) in windows.into_iter().zip([1.0, 1.7, 0.5]) {
        let frame = Frame { pixel_aspect: aspect, ..Frame::full(100, 90) }.with_window(window);
        let pixels = pixels(window.pixels(), &mut chance);
        let raster = Raster::new(&pixels, frame).unwrap();
        for level in 0..=raster.levels() {
            for doubles in [false, true] {
                for transformed in [false, true] {
                    let reduction = raster.reduction(level, doubles);
                    let reduction = if transformed { reduction.by_transform() } else { reduction };
                    // Of radians a point: from none to what a lattice hardly resolves.
                    for _ in 0..12 {
                        let fastest = if level == 0 && transformed { frequencies::FASTEST } else { 2.5 };
                        let theta = fastest * DVec2::new(chance.between(-1.0, 1.0), chance.between(-1.0, 1.0));
                        let q = theta / (reduction.pitch() * frame.pixel_sides());
                        let (truth, sums) = (waves(&pixels, frame, q), from_raster(&raster, reduction, q));
                        let [x, y] = if level == 0 { [0.0; 2] } else { [aliasing(theta.x), aliasing(theta.y)] };
                        let gain = if level == 0 { 1.0 } else { (spline(theta.x) * spline(theta.y)).recip() };
                        let [across, down] = reduction.off();
                        let bound = x + y + x * y + gain * (reduction.rounding() + 1e-12 + 2.0 * (across + down));
                        for colour in 0..3 {
                            let off =
                                (0..2).map(|part| (sums[colour][part] - truth[colour][part]).powi(2)).sum::<f64>();
                            let off = off.sqrt() / raster.flux()[colour];
                            assert!(off <= bound, "{window:?}, {reduction:?}, {theta}: {off:e} for {bound:e}");
                        }
                    }
                }
            }
        }
    }
}

#[test]
fn aliasing_is_the_sum_that_it_stands_for() {
    for theta in [1e-3, 0.02, 0.049_9, 0.050_1, 0.3, 1.0, 2.0, 3.0, 4.5] {
        let sum: f64 =
            (1..20_000).flat_map(|l| [f64::from(l), -f64::from(l)]).map(|l| (theta / (theta + TAU * l)).powi(4)).sum();
        let bound = aliasing(theta);
        assert!(bound >= sum * (1.0 - 1e-9) && bound <= 1.15 * sum + 2e-14, "{theta}: {bound:e} for {sum:e}");
        assert_eq!(aliasing(-theta), bound);
    }
    assert_eq!((spline(0.0), aliasing(7.0)), (1.0, f64::INFINITY));
}

#[test]
fn what_is_no_light_has_no_flux() {
    let frame = Frame::full(2, 1);
    let raster = Raster::new(&[[1.0, 2.0, -3.0, 0.0], [f32::NAN, 1.0, f32::INFINITY, 0.0]], frame).unwrap();
    // A pixel's area is 2 × 2.
    assert_eq!(raster.flux(), [4.0, 12.0, 0.0]);
    let light = |column: usize| raster.along_row(0, column..column + 1, &[1.0]);
    assert_eq!((light(0), light(1)), ([4.0, 8.0, 0.0], [0.0, 4.0, 0.0]));
    assert!(Raster::new(&[[1.0; 4]], frame).is_err());
}

/// A transform has the waves of the moments that it is of: all harmonics, of either sign along either axis.
#[test]
fn a_transform_has_the_waves_of_its_moments() {
    let mut chance = Chance::new(11);
    let frame = Frame::full(130, 77);
    let raster = Raster::new(&pixels(frame.window.pixels(), &mut chance), frame).unwrap();
    for (level, sign) in [(1, DVec2::new(1.0, 1.0)), (2, DVec2::new(-1.0, 1.0)), (1, DVec2::new(-1.0, -1.0))] {
        let reduction = raster.reduction(level, true);
        let harmonics = [23, 17];
        // The last is one that the lattice still resolves.
        let first = sign * 0.85 * std::f64::consts::PI / 22.0 / (reduction.pitch() * frame.pixel_sides());
        let [own, other] = [reduction, reduction.by_transform()].map(|way| {
            let middle = raster.middle(way);
            let waves = raster.waves(way, first, harmonics, [true, false, true]);
            (middle, waves)
        });
        assert!(other.1[1].iter().all(|waves| waves.iter().all(|wave| *wave == 0.0)), "green is not wanted");
        for colour in [0, 2] {
            for (n, m) in (0..harmonics[0]).flat_map(|n| (0..harmonics[1]).map(move |m| (n, m))) {
                let about_origin = |(middle, waves): &(DVec2, [[Array2<f64>; 4]; 3]), sign: f64| {
                    let [cc, sc, cs, ss] = waves[colour].each_ref().map(|wave| wave[(n, m)]);
                    let turned = first * DVec2::new(n as f64, sign * m as f64);
                    let (sin, cos) = turned.dot(*middle).sin_cos();
                    let (re, im) = (cc - sign * ss, -sc - sign * cs);
                    [re * cos + im * sin, im * cos - re * sin]
                };
                for sign in [1.0, -1.0] {
                    let (one, two) = (about_origin(&own, sign), about_origin(&other, sign));
                    let off = (one[0] - two[0]).hypot(one[1] - two[1]) / raster.flux()[colour];
                    let bound: f64 = reduction.by_transform().off().iter().sum::<f64>() + 1e-12;
                    assert!(off <= bound, "{level} {sign} ({n}, {m}): {off:e} for {bound:e}");
                }
            }
        }
    }
}
