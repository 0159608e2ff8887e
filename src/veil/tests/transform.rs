//! Veils by the transform, against their definition.

use super::kernels::{cie, cie_at, gaussian};
use super::photos::{Dice, photo};
use super::{long, worst};
use crate::veil::reference::{self, Window};
use crate::veil::transform::{Choice, Task, Transform};
use crate::veil::{
    BadSources, Border, Error, FLOOR, Gaussian, Geometry, Kernel, Method, Mixture, Photo, Picture, Plan, Veil,
};

const FLAT: Geometry = Geometry::Planar { pitch: 1.0, solid_angle: 1.0 };
const BORDERS: [Border; 3] = [Border::None, Border::Mirror, Border::Extend];

/// Functions that are no sums of positive Gaussians: a disc of even light, steep at its edge; one with rings that are
/// negative; the eye's, whose core is flat; a needle of nothing but neighbours.
fn profile(index: usize) -> (fn(f64) -> f64, bool) {
    match index {
        0 => (|r| if r < 7.3 { 1.0 } else { 0.0 }, false),
        1 => (|r| (0.7 * r).cos() / (1.0 + r * r), true),
        2 => (|r| cie_at(0.01 * r), false),
        3 => (|r| if r < 1.2 { 0.25 } else { 0.0 }, false),
        _ => (|r| (-0.5 * (r / 4.0) * (r / 4.0)).exp(), false),
    }
}

fn kernel(profile: fn(f64) -> f64) -> Kernel {
    Kernel::new(profile, Mixture::default()).expect("a kernel")
}

/// A picture with no symmetry, with parts that are black.
fn some_picture(dice: &mut Dice) -> Picture {
    let size = [1 + dice.below(60), 1 + dice.below(40)];
    let light = |dice: &mut Dice| if dice.share() < 0.3 { 0.0 } else { 10f64.powf(dice.between(-6.0, 0.0)) };
    let mut pixels: Vec<[f64; 3]> = (0..size[0] * size[1]).map(|_| [0; 3].map(|_| light(dice))).collect();
    pixels[0] = [0.1, 0.2, 0.3];
    Picture::new(size, size.map(|side| dice.below(side)), pixels).expect("a picture")
}

fn whole(size: [usize; 2]) -> Vec<[usize; 2]> {
    (0..size[0] * size[1]).map(|pixel| [pixel % size[0], pixel / size[0]]).collect()
}

/// The largest error of each channel, relative to the magnitude of the local veil or to the floor.
fn errors(veil: &Veil, truth: &[[f64; 3]]) -> [f64; 3] {
    [0, 1, 2].map(|channel| {
        let plane = &veil.planes[channel];
        assert_eq!(plane.len(), truth.len());
        let floor = FLOOR * f64::from(plane.iter().copied().map(f32::abs).fold(0.0, f32::max));
        let error = |(found, truth): (&f32, &[f64; 3])| {
            let (found, truth) = (f64::from(*found), truth[channel]);
            if found == truth { 0.0 } else { (found - truth).abs() / truth.abs().max(floor) }
        };
        let worst = |worst: f64, error: f64| if error.is_nan() { f64::INFINITY } else { worst.max(error) };
        plane.iter().zip(truth).map(error).fold(0.0, worst)
    })
}

/// Both ways to sum, all borders; photos with lights up to 10⁸ on black or on noise. What is certified holds, and is no more than
/// what was asked.
#[test]
fn what_is_certified_holds() {
    let (mut dice, cases) = if long() { (Dice(21), 300) } else { (Dice(20), 30) };
    let mut ratios = Vec::new();
    for case in 0..cases {
        let size = [1 + dice.below(50), 1 + dice.below(40)];
        let border = BORDERS[case % 3];
        let tolerance = [1e-7, 1e-5, 1e-2][dice.below(3)];
        let choice = [Choice::Passes, Choice::Taps, Choice::Passes][dice.below(3)];
        let task = Task { size, border, tolerance };
        let values = photo(&mut dice, size, 1 + case % 5, 8.0);
        let photo = Photo::rgb(&values, size).expect("a photo");
        let (transform, truth, signed) = if case % 2 == 0 {
            let (profile, signed) = profile(dice.below(5));
            let transform = Transform::of_profile(task, profile, signed, choice);
            (transform, reference::at(&photo, &FLAT, &kernel(profile), border, &whole(size)), signed)
        } else {
            let picture = some_picture(&mut dice);
            let transform = Transform::of_picture(task, &picture, choice);
            (transform, reference::of_picture(&photo, &picture, border, &whole(size)), false)
        };
        let transform = transform.unwrap_or_else(|error| panic!("{case}: {size:?}: {error}"));
        let veil = transform.evaluate(&photo);
        for (channel, error) in errors(&veil, &truth).into_iter().enumerate() {
            let certified = veil.certified[channel];
            assert!(
                error <= certified,
                "{case}, channel {channel}: {error:e} for {certified:e}, {size:?} {task:?} {choice:?}"
            );
            assert!(signed || certified <= tolerance, "{case}: {certified:e} for {tolerance:e}, {size:?} {border:?}");
            ratios.push(certified / error.max(1e-12));
        }
    }
    ratios.sort_by(f64::total_cmp);
    assert!(ratios[ratios.len() / 2] < 10.0, "certified over found: {ratios:.1?}");
}

/// Rounding is what it is said to be: there is some, and it is below its bound.
#[test]
fn rounding_is_bounded() {
    let (mut dice, size) = (Dice(22), [90, 70]);
    let mut values = vec![0.0; 3 * size[0] * size[1]];
    (0..20).for_each(|_| values[3 * dice.below(size[0] * size[1])] = 1e8);
    let photo = Photo::rgb(&values, size).expect("a photo");
    let task = Task { size, border: Border::None, tolerance: 0.99 };
    let (profile, _) = profile(4);
    let veil = Transform::of_profile(task, profile, false, Choice::Passes).expect("a plan").evaluate(&photo);
    let truth = reference::at(&photo, &FLAT, &kernel(profile), Border::None, &whole(size));
    let norm = values.iter().step_by(3).map(|value| f64::from(*value).powi(2)).sum::<f64>().sqrt();
    // Of the Gaussian, √π σ.
    let unit = norm * std::f64::consts::PI.sqrt() * 4.0 * f64::EPSILON;
    let apart = veil.planes[0].iter().zip(&truth).filter(|(found, _)| **found < 1e-8 * norm as f32);
    let worst = apart.map(|(found, truth)| (f64::from(*found) - truth[0]).abs()).fold(0.0, f64::max);
    assert!(worst < 200.0 * unit && worst > 0.0, "{worst:e} for {unit:e}");
}

/// A bright pixel is seen as the kernel is in its file, row 0 on top, each channel its own, and nothing at the pixel itself: of a
/// kernel without symmetry, and of one that is the same when it is turned by half a circle.
#[test]
fn a_bright_pixel_shows_the_kernel() {
    let (mut dice, size, at, light) = (Dice(23), [40, 30], [17usize, 11usize], [2.0f32, 3.0, 4.0]);
    let uneven: Vec<[f64; 3]> = (0..7 * 5).map(|_| [0; 3].map(|_| dice.share())).collect();
    let turned: Vec<[f64; 3]> =
        (0..35).map(|index: usize| [0, 1, 2].map(|channel| uneven[index.min(34 - index)][channel])).collect();
    let mut values = vec![0.0; 3 * size[0] * size[1]];
    values[3 * (at[1] * size[0] + at[0])..][..3].copy_from_slice(&light);
    let photo = Photo::rgb(&values, size).expect("a photo");
    for (pixels, centre) in [(uneven, [2, 1]), (turned, [3, 2])] {
        let picture = Picture::new([7, 5], centre, pixels.clone()).expect("a picture");
        for choice in [Choice::Taps, Choice::Passes] {
            // So loose that nothing is summed anew.
            let task = Task { size, border: Border::None, tolerance: 0.5 };
            let veil = Transform::of_picture(task, &picture, choice).expect("a plan").evaluate(&photo);
            assert_eq!(veil.lonely, [0; 3]);
            for (channel, plane) in veil.planes.iter().enumerate() {
                for (pixel, found) in plane.iter().enumerate() {
                    let place = [pixel % size[0], pixel / size[0]];
                    let [x, y] = [0, 1].map(|side| (place[side] + centre[side]).wrapping_sub(at[side]));
                    let inside = x < 7 && y < 5 && place != at;
                    let wanted = if inside { pixels[y * 7 + x][channel] * f64::from(light[channel]) } else { 0.0 };
                    assert!((f64::from(*found) - wanted).abs() < 1e-6, "{choice:?} {place:?}: {found} for {wanted}");
                }
            }
        }
    }
}

/// What leaves one side does not come in at the other, whatever the kernel's reach.
#[test]
fn nothing_comes_around() {
    let size = [24, 15];
    for border in BORDERS {
        for reach in [1, 5, 23, 24, 47, 60] {
            for [right, below] in [[reach, 0], [-reach, 0], [0, reach], [0, -reach], [reach, -reach]] {
                let wide = [2 * 60 + 1, 2 * 60 + 1];
                let mut pixels = vec![[0.0; 3]; wide[0] * wide[1]];
                pixels[((60 + below) * 121 + 60 + right) as usize] = [1.0; 3];
                let picture = Picture::new(wide, [60, 60], pixels).expect("a picture");
                let values: Vec<f32> = (0..3 * size[0] * size[1]).map(|index| 1.0 + index as f32).collect();
                let photo = Photo::rgb(&values, size).expect("a photo");
                // So loose that nothing is summed anew.
                let task = Task { size, border, tolerance: 0.5 };
                let veil = Transform::of_picture(task, &picture, Choice::Passes).expect("a plan").evaluate(&photo);
                let truth = reference::of_picture(&photo, &picture, border, &whole(size));
                let worst = errors(&veil, &truth).into_iter().fold(0.0, f64::max);
                assert!(worst < 1e-4, "{border:?} {right} {below}: {worst:e}");
            }
        }
    }
}

/// A kernel of one pixel moves the photo; one of the centre alone makes no veil, as a pixel does not light itself.
#[test]
fn kernels_of_one_pixel() {
    let size = [9, 6];
    let values = photo(&mut Dice(24), size, 4, 3.0);
    let photo = Photo::rgb(&values, size).expect("a photo");
    let only = Picture::new([1, 1], [0, 0], vec![[1.0; 3]]).expect("a picture");
    let veil = Plan::for_picture(&only, size, Border::None, 1e-6).expect("a plan").evaluate(&photo).expect("a veil");
    assert!(veil.planes.iter().flatten().all(|value| value.to_bits() == 0));
    assert_eq!(veil.certified, [0.0; 3]);
    let beside = Picture::new([2, 1], [0, 0], vec![[0.0; 3], [1.0; 3]]).expect("a picture");
    let veil =
        Plan::for_picture(&beside, size, Border::Extend, 1e-6).expect("a plan").evaluate(&photo).expect("a veil");
    for (pixel, found) in veil.planes[1].iter().enumerate() {
        let left = if pixel % size[0] == 0 { pixel } else { pixel - 1 };
        assert!((found / values[3 * left + 1] - 1.0).abs() < 1e-6 || *found == values[3 * left + 1], "{pixel}");
    }
}

#[test]
fn small_photos_black_ones_and_extreme_lights() {
    let mut dice = Dice(25);
    for size in [[1, 1], [1, 70], [70, 1], [2, 2], [33, 32]] {
        for border in BORDERS {
            for choice in [Choice::Taps, Choice::Passes] {
                let task = Task { size, border, tolerance: 1e-5 };
                let (profile, _) = profile(4);
                let transform = Transform::of_profile(task, profile, false, choice).expect("a plan");
                let black = vec![0.0; 3 * size[0] * size[1]];
                let veil = transform.evaluate(&Photo::rgb(&black, size).expect("a photo"));
                assert!(veil.planes.iter().flatten().all(|value| value.to_bits() == 0));
                for scale in [1e-38f32, 1.0, 1e29] {
                    let values: Vec<f32> =
                        photo(&mut dice, size, 2, 8.0).into_iter().map(|value| value * scale).collect();
                    let photo = Photo::rgb(&values, size).expect("a photo");
                    let veil = transform.evaluate(&photo);
                    let truth = reference::at(&photo, &FLAT, &kernel(profile), border, &whole(size));
                    for (error, certified) in errors(&veil, &truth).into_iter().zip(veil.certified) {
                        assert!(
                            error <= certified,
                            "{size:?} {border:?} {choice:?} {scale:e}: {error:e}, {certified:e}"
                        );
                        assert!(certified <= 1e-5 || scale < 1e-30, "{size:?} {border:?} {scale:e}: {certified:e}");
                    }
                }
            }
        }
    }
}

/// What 32 bits do not hold is not certified: a veil that is too bright, and one that is too dark.
#[test]
fn veils_beyond_32_bits_are_not_certified() {
    let (size, values) = ([3, 1], [[1e38f32; 3], [0.0; 3], [0.0; 3]]);
    let task = Task { size, border: Border::None, tolerance: 1e-3 };
    for choice in [Choice::Taps, Choice::Passes] {
        for (scale, light) in [(1e8, 1.0), (1e-9, 1e-38 / 1e38)] {
            let values: Vec<f32> =
                values.as_flattened().iter().map(|value| (f64::from(*value) * light) as f32).collect();
            let transform = Transform::of_profile(task, |_| scale, false, choice).expect("a plan");
            let veil = transform.evaluate(&Photo::rgb(&values, size).expect("a photo"));
            assert_eq!(veil.certified, [f64::INFINITY; 3], "{choice:?} {scale:e}");
            assert!(veil.planes[0][1] == if scale > 1.0 { f32::INFINITY } else { 0.0 }, "{choice:?} {scale:e}");
        }
    }
}

/// What is no light is counted, and harms no other pixel.
#[test]
fn bad_pixels_are_black() {
    let size = [30, 20];
    let values = photo(&mut Dice(26), size, 2, 3.0);
    let (mut bad, mut clean) = (values.clone(), values);
    for (index, value) in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -2.0].into_iter().enumerate() {
        bad[3 * (100 + 7 * index) + 1] = value;
        clean[3 * (100 + 7 * index) + 1] = 0.0;
    }
    for choice in [Choice::Taps, Choice::Passes] {
        let task = Task { size, border: Border::Mirror, tolerance: 1e-6 };
        let transform = Transform::of_profile(task, profile(0).0, false, choice).expect("a plan");
        let [one, two] = [&bad, &clean].map(|values| transform.evaluate(&Photo::rgb(values, size).expect("a photo")));
        assert_eq!(one.planes, two.planes);
        assert_eq!(one.bad, BadSources { undefined: [0, 1, 0], infinite: [0, 2, 0], negative: [0, 1, 0] });
    }
}

/// Where rounding would be too much for a dark veil: a few bright pixels are summed by themselves, and dark ones by the definition.
#[test]
fn dark_veils_are_summed_anew() {
    let (mut dice, size) = (Dice(27), [120, 90]);
    for (noise, stars) in [(false, 5), (true, 5), (false, 200)] {
        let mut values: Vec<f32> =
            (0..3 * size[0] * size[1]).map(|_| if noise { dice.between(0.5, 1.0) as f32 } else { 0.0 }).collect();
        for _ in 0..stars {
            let at = 3 * dice.below(size[0] * size[1] / 8);
            values[at..][..3].fill(dice.between(1e7, 1e8) as f32);
        }
        let photo = Photo::rgb(&values, size).expect("a photo");
        let profile = |r: f64| if r < 6.5 { 1.0 } else { r.powf(-8.0) };
        for border in [Border::None, Border::Mirror] {
            let task = Task { size, border, tolerance: 1.5e-7 };
            let transform = Transform::of_profile(task, profile, false, Choice::Passes);
            let veil = transform.expect("a plan").evaluate(&photo);
            let kernel = Kernel::new(profile, Mixture::default()).expect("a kernel");
            let pixels: Vec<[usize; 2]> = whole(size).into_iter().step_by(7).collect();
            let floor = FLOOR * f64::from(veil.planes[0].iter().copied().fold(0.0, f32::max));
            let truth = reference::at(&photo, &FLAT, &kernel, border, &pixels);
            for ([x, y], truth) in pixels.iter().zip(truth) {
                let found = f64::from(veil.planes[0][y * size[0] + x]);
                let error = (found - truth[0]).abs() / truth[0].max(floor);
                assert!(error <= veil.certified[0], "{noise} {border:?} at {x}, {y}: {error:e}");
            }
            assert!(veil.certified[0] <= 1.5e-7, "{noise} {border:?}: {:e}", veil.certified[0]);
            assert_eq!(stars > 64, veil.lonely[0] > 0, "{noise} {border:?}: {:?}", veil.lonely);
        }
    }
}

/// Where the pyramid refuses, the transform takes over; and where that costs less.
#[test]
fn what_the_pyramid_cannot() {
    let (mut dice, size) = (Dice(28), [90, 60]);
    let values = photo(&mut dice, size, 3, 6.0);
    let photo = Photo::rgb(&values, size).expect("a photo");
    // A tolerance out of reach; a core as wide as the photo, which the mixture does not have; no mixture at all.
    let wide = |angle: f64| 1.0 / (1.0 + (angle / 60.0).powi(8));
    let part = Mixture { terms: vec![Gaussian { sigma: 30.0, weight: 0.5 }], ..Mixture::default() };
    let cases = [
        (gaussian(6.0), 2e-7),
        (Kernel::new(wide, part).expect("a kernel"), 1e-4),
        (kernel(|r| if r < 55.5 { 1.0 } else { 0.0 }), 1e-3),
    ];
    for (kernel, tolerance) in cases {
        for border in BORDERS {
            let plan = Plan::new(&FLAT, &kernel, size, border, tolerance).expect("a plan");
            assert!(plan.method() != Method::Pyramid, "{:?}", plan.predicted());
            assert!(plan.predicted().bound <= tolerance);
            let veil = plan.evaluate(&photo).expect("a veil");
            let window = Window { first: [30, 20], size: [20, 20] };
            let (error, place) = worst(&veil, &photo, &FLAT, &kernel, border, window);
            let certified = veil.certified.into_iter().fold(0.0, f64::max);
            assert!(error <= certified && certified <= tolerance, "{border:?}: {error:e} {certified:e}, {place}");
        }
    }
}

/// The way is that of the least cost.
#[test]
fn the_cheaper_way_is_taken() {
    let size = [640, 360];
    let plan = |geometry: &Geometry, kernel: &Kernel, tolerance| {
        Plan::new(geometry, kernel, size, Border::None, tolerance).expect("a plan")
    };
    let pyramid = plan(&Geometry::planar_degrees(0.08), &cie(false), 1e-2);
    assert_eq!((pyramid.method(), pyramid.memory()), (Method::Pyramid, None));
    // Too narrow for coarse lattices, and too wide for quick kernels on the pixels.
    assert_eq!(plan(&FLAT, &gaussian(12.0), 1e-3).method(), Method::Transform { points: [1120, 720] });
    assert_eq!(plan(&FLAT, &gaussian(100.0), 1e-3).method(), Method::Pyramid);
    let square = |side: usize| Picture::new([side; 2], [side / 2; 2], vec![[1.0; 3]; side * side]).expect("a picture");
    let of_square = |side| Plan::for_picture(&square(side), size, Border::None, 1e-4).expect("a plan");
    assert_eq!(of_square(7).method(), Method::Sum);
    assert_eq!(of_square(41).method(), Method::Transform { points: [672, 384] });
    // A kernel that is even has half of a real transform; one that is not, all of a complex one, and three of them if it has colours.
    let memory = of_square(41).memory().expect("a transform");
    let mut pixels = vec![[1.0; 3]; 41 * 41];
    pixels[3] = [1.0, 2.0, 3.0];
    let uneven = Picture::new([41; 2], [20; 2], pixels).expect("a picture");
    let uneven = Plan::for_picture(&uneven, size, Border::None, 1e-4).expect("a plan").memory().expect("a transform");
    let [columns, rows] = [672 / 2 + 1, 384];
    assert!((memory as f64 / (columns * (16 * 360 + 8 * rows / 2)) as f64 - 1.0).abs() < 0.05, "{memory}");
    assert!((uneven as f64 / (columns * (16 * 360 + 3 * 16 * rows)) as f64 - 1.0).abs() < 0.05, "{uneven}");
}

#[test]
fn what_cannot_be_is_refused() {
    let size = [20, 10];
    let of_profile = |profile: fn(f64) -> f64, size, tolerance| {
        Plan::for_profile(&FLAT, profile, size, Border::None, tolerance).err()
    };
    for profile in [|_| f64::NAN, |r| if r > 5.0 { f64::INFINITY } else { 1.0 }] as [fn(f64) -> f64; 2] {
        assert!(matches!(of_profile(profile, size, 1e-3), Some(Error::Kernel(_))));
    }
    assert!(matches!(of_profile(|_| 1.0, size, 5e-8), Some(Error::OutOfReach { .. })));
    assert!(matches!(of_profile(|_| 1.0, size, 0.0), Some(Error::Tolerance(_))));
    assert!(matches!(of_profile(|_| 1.0, [0, 3], 1e-3), Some(Error::Size { .. })));
    assert!(matches!(of_profile(|_| 1.0, [65536, 65536], 1e-3), Some(Error::Memory { .. })));
    let sphere = Plan::for_profile(&Geometry::rectilinear(50.0, 20), |_| 1.0, size, Border::None, 1e-3);
    assert!(matches!(sphere, Err(Error::Geometry(_))));
    // Near, and where the pyramid looks at no offset.
    for (place, size) in [(7.0, size), (64.0, [100, 1])] {
        let at = move |r: f64| if r == place { -1e-9 } else { 1.0 };
        let negative = Kernel::new(at, Mixture::default()).expect("a kernel");
        let refused = Plan::new(&FLAT, &negative, size, Border::None, 1e-3);
        assert!(matches!(refused, Err(Error::Kernel(_))), "{refused:?}");
        assert!(Plan::for_profile(&FLAT, at, size, Border::None, 1e-3).is_ok());
    }
    let picture = Picture::new([3, 1], [1, 0], vec![[1.0; 3]; 3]).expect("a picture");
    assert!(matches!(Plan::for_picture(&picture, [0, 1], Border::None, 1e-3), Err(Error::Size { .. })));
    let plan = Plan::for_picture(&picture, size, Border::None, 1e-3).expect("a plan");
    assert!(matches!(plan.evaluate(&Photo::rgb(&[0.0; 3], [1, 1]).expect("a photo")), Err(Error::OtherSize { .. })));
}
