//! What a user can give by mistake or on purpose.

use super::kernels::{cie, gaussian};
use super::photos::{Dice, photo};
use super::worst;
use crate::veil::plan::LONGEST_SIDE;
use crate::veil::reference::Window;
use crate::veil::{BadSources, Border, Error, Gaussian, Geometry, Kernel, Mixture, Photo, Plan};

const FLAT: Geometry = Geometry::Planar { pitch: 1.0, solid_angle: 1.0 };

fn plan(size: [usize; 2], tolerance: f64) -> Plan {
    Plan::new(&Geometry::planar_degrees(0.05), &cie(true), size, Border::None, tolerance).expect("a plan")
}

#[test]
fn a_single_pixel_has_no_veil() {
    let veil =
        plan([1, 1], 1e-3).evaluate(&Photo::rgba(&[3e38, 1.0, 1e-38, 1.0], [1, 1]).expect("a photo")).expect("a veil");
    assert_eq!(veil.planes, [[0.0], [0.0], [0.0]].map(Vec::from));
}

#[test]
fn a_black_photo_has_no_veil() {
    let veil = plan([40, 30], 2e-3).evaluate(&Photo::rgba(&[0.0; 4800], [40, 30]).expect("a photo")).expect("a veil");
    assert!(veil.planes.iter().flatten().all(|value| value.to_bits() == 0));
    assert_eq!((veil.dark, veil.lonely), ([0; 3], [0; 3]));
}

#[test]
fn bad_pixels_are_counted_and_harm_no_other() {
    let mut dice = Dice(2);
    let size = [30, 20];
    let mut values = photo(&mut dice, size, 2, 3.0);
    let (mut clean, bad) = (values.clone(), [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -2.0, -0.0]);
    for (index, bad) in bad.into_iter().enumerate() {
        values[3 * (100 + 7 * index) + 1] = bad;
        clean[3 * (100 + 7 * index) + 1] = 0.0;
    }
    let [veil, clean] = [values, clean]
        .map(|values| plan(size, 2e-3).evaluate(&Photo::rgb(&values, size).expect("a photo")).expect("a veil"));
    assert_eq!(veil.planes, clean.planes);
    assert_eq!(veil.bad, BadSources { undefined: [0, 1, 0], infinite: [0, 2, 0], negative: [0, 1, 0] });
    assert_eq!(clean.bad, BadSources::default());
}

/// The three ways to give a photo are one.
#[test]
fn layouts_agree() {
    let size = [19, 11];
    let values = photo(&mut Dice(3), size, 2, 3.0);
    let rgba: Vec<f32> = values.chunks_exact(3).flat_map(|pixel| [pixel[0], pixel[1], pixel[2], f32::NAN]).collect();
    let planes = [0, 1, 2].map(|channel| values.iter().skip(channel).step_by(3).copied().collect::<Vec<f32>>());
    let photos = [
        Photo::rgb(&values, size).expect("a photo"),
        Photo::rgba(&rgba, size).expect("a photo"),
        Photo::planes(planes.each_ref().map(Vec::as_slice), size).expect("a photo"),
    ];
    let [one, two, three] = photos.map(|photo| plan(size, 2e-3).evaluate(&photo).expect("a veil").planes);
    assert_eq!(one, two);
    assert_eq!(one, three);
}

/// The veil scales with the light, from the smallest floats to the largest.
#[test]
fn radiances_may_be_tiny_or_huge() {
    let size = [50, 40];
    let values: Vec<f32> = photo(&mut Dice(4), size, 3, 8.0).into_iter().map(|value| value.min(1e8)).collect();
    for factor in [1e-30f32, 1.0, 3e30] {
        let values: Vec<f32> = values.iter().map(|value| value * factor).collect();
        let photo = Photo::rgb(&values, size).expect("a photo");
        let geometry = Geometry::Planar { pitch: 0.05, solid_angle: 1e-4 };
        let plan = Plan::new(&geometry, &cie(true), size, Border::None, 2e-3).expect("a plan");
        let veil = plan.evaluate(&photo).expect("a veil");
        let (error, place) = worst(&veil, &photo, &geometry, &cie(true), Border::None, Window::whole(size));
        assert!(error <= plan.predicted().bound, "{factor:e}: {error:e}, {place}");
    }
}

/// Widths from far below a pixel to far beyond the picture, on pictures of one row or column.
#[test]
fn any_width_and_any_size() {
    let mut dice = Dice(6);
    for sigma in [1e-3, 0.2, 1.0, 7.0, 60.0, 1e3, 1e7] {
        for size in [[1, 300], [300, 1], [2, 2], [65, 64], [129, 3]] {
            let values = photo(&mut dice, size, 2, 6.0);
            let photo = Photo::rgb(&values, size).expect("a photo");
            let kernel = gaussian(sigma);
            let plan = Plan::new(&FLAT, &kernel, size, Border::None, 1e-3)
                .unwrap_or_else(|error| panic!("{sigma} {size:?}: {error}"));
            let veil = plan.evaluate(&photo).expect("a veil");
            let (error, place) = worst(&veil, &photo, &FLAT, &kernel, Border::None, Window::whole(size));
            assert!(error <= plan.predicted().bound, "{sigma} {size:?}: {error:e}, {place}, {:?}", plan.predicted());
        }
    }
}

#[test]
fn what_cannot_be_is_refused() {
    let kernel = || gaussian(2.0);
    let new = |geometry: &Geometry, kernel: &Kernel, size, tolerance| {
        Plan::new(geometry, kernel, size, Border::None, tolerance).err()
    };
    assert!(matches!(new(&FLAT, &kernel(), [0, 5], 1e-3), Some(Error::Size { .. })));
    assert!(matches!(new(&FLAT, &kernel(), [LONGEST_SIDE + 1, 5], 1e-3), Some(Error::Size { .. })));
    for tolerance in [0.0, -1.0, 1.0, f64::NAN] {
        assert!(matches!(new(&FLAT, &kernel(), [5, 5], tolerance), Some(Error::Tolerance(_))));
    }
    assert!(matches!(new(&FLAT, &kernel(), [50, 50], 1e-9), Some(Error::OutOfReach { .. })));
    for pitch in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(new(&Geometry::planar_degrees(pitch), &kernel(), [5, 5], 1e-3), Some(Error::Geometry(_))));
    }
    for [sigma, weight] in [[0.0, 1.0], [f64::NAN, 1.0], [1.0, -1.0], [1.0, f64::INFINITY]] {
        let mixture = Mixture { terms: vec![Gaussian { sigma, weight }], ..Mixture::default() };
        assert!(matches!(Kernel::from_mixture(mixture), Err(Error::Kernel(_))));
    }
    let negative = Kernel::new(|angle| 1.0 - angle, Mixture::default()).expect("a mixture");
    assert!(matches!(new(&FLAT, &negative, [5, 5], 1e-3), Some(Error::Kernel(_))));
    assert!(matches!(Photo::rgba(&[0.0; 7], [1, 2]), Err(Error::Length { found: 7, expected: 8 })));
    let photo = [0.0; 12];
    let photo = Photo::rgb(&photo, [2, 2]).expect("a photo");
    assert!(matches!(plan([3, 2], 2e-3).evaluate(&photo), Err(Error::OtherSize { .. })));
}
