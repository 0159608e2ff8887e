//! Parts of the sphere.

use super::kernels::{cie, spencer};
use super::photos::{Dice, photo};
use super::{long, worst};
use crate::veil::reference::Window;
use crate::veil::sphere::angle;
use crate::veil::{Border, Error, Geometry, Kernel, Photo, Plan};

/// Kernels, fields, projections and tolerances; with lights up to 10⁸ over black or noise.
#[test]
fn the_bound_holds_on_the_sphere() {
    let (mut dice, rounds) = if long() { (Dice(78), 12) } else { (Dice(11), 1) };
    let mut ratios = Vec::new();
    let fields = [1.0, 5.0, 20.0, 40.0, 50.0, 60.0];
    for (case, field) in fields.into_iter().cycle().take(fields.len() * rounds).enumerate() {
        let size = [110 + dice.below(60), 70 + dice.below(40)];
        let fisheye = case % fields.len() == 3;
        let geometry = if fisheye { Geometry::fisheye(field, size[0]) } else { Geometry::rectilinear(field, size[0]) };
        let (kernel, tolerance) = if case % 2 == 0 { (spencer(true), 2e-2) } else { (cie(true), 1e-2) };
        let values = photo(&mut dice, size, 4, 8.0);
        let photo = Photo::rgb(&values, size).expect("a photo");
        let plan = Plan::new(&geometry, &kernel, size, Border::None, tolerance);
        let plan = plan.unwrap_or_else(|error| panic!("{case}: {field}° {size:?}: {error}"));
        let veil = plan.evaluate(&photo).expect("a veil");
        let window = Window { first: [dice.below(size[0] - 20), 0], size: [20, size[1]] };
        let (error, place) = worst(&veil, &photo, &geometry, &kernel, Border::None, window);
        let bound = plan.predicted().bound;
        assert!(error <= bound && bound <= tolerance, "{field}° {size:?}: {error:e}, {place}, {:?}", plan.predicted());
        ratios.push(bound / error);
    }
    ratios.sort_by(f64::total_cmp);
    assert!(ratios[ratios.len() / 2] < 10.0, "{ratios:.1?}");
}

/// The error of a veil within a window of a photo with lights, and what its plan says.
fn check(
    geometry: &Geometry,
    kernel: &Kernel,
    size: [usize; 2],
    tolerance: f64,
    window: Window,
    dice: &mut Dice,
) -> Plan {
    let mut values = photo(dice, size, 4, 8.0);
    // Lights in corners and on edges as well.
    for [x, y] in [[0, 0], [size[0] - 1, dice.below(size[1])], [dice.below(size[0]), size[1] - 1]] {
        values[3 * (y * size[0] + x) + dice.below(3)] = 10f64.powf(dice.between(0.0, 8.0)) as f32;
    }
    let photo = Photo::rgb(&values, size).expect("a photo");
    let plan = Plan::new(geometry, kernel, size, Border::None, tolerance);
    let plan = plan.unwrap_or_else(|error| panic!("{geometry:?} {size:?}: {error}"));
    let veil = plan.evaluate(&photo).expect("a veil");
    let (error, place) = worst(&veil, &photo, geometry, kernel, Border::None, window);
    let predicted = plan.predicted();
    assert!(error <= predicted.bound, "{geometry:?} {size:?}: {error:e}, {place}, {predicted:?}");
    assert!(predicted.bound <= tolerance, "{predicted:?}");
    plan
}

/// One light at an edge or in a corner, and nothing else: what falls at the far end of the picture comes of one pair of pixels, where
/// depths differ most, and of pairs that are 180 degrees apart.
#[test]
fn lone_lights_at_the_edges_are_within_the_bound_everywhere() {
    let cases = [
        (Geometry::fisheye(89.0, 169), [169, 43], &cie(true), [168, 42]),
        (Geometry::rectilinear(61.0, 193), [193, 34], &spencer(true), [0, 17]),
        (Geometry::rectilinear(82.0, 187), [187, 42], &cie(true), [0, 0]),
        (Geometry::rectilinear(50.0, 300), [300, 168], &cie(true), [299, 47]),
        (Geometry::fisheye(179.0, 100), [100, 60], &cie(true), [0, 0]),
    ];
    for (geometry, size, kernel, [x, y]) in cases {
        let mut values = vec![0.0; 3 * size[0] * size[1]];
        values[3 * (y * size[0] + x) + 1] = 1.0;
        let photo = Photo::rgb(&values, size).expect("a photo");
        let plan = Plan::new(&geometry, kernel, size, Border::None, 1e-2).expect("a plan");
        let veil = plan.evaluate(&photo).expect("a veil");
        let camera = geometry.camera(size).expect("a camera");
        let point = |x: usize, y: usize| camera.point(x as f64, y as f64);
        let (here, mut error) = (point(x, y), 0.0f64);
        for at in (0..size[0] * size[1]).filter(|at| *at != y * size[0] + x) {
            let wanted = here.solid_angle * kernel.at(angle(here.chord(&point(at % size[0], at / size[0]))));
            error = error.max((f64::from(veil.planes[1][at]) / wanted - 1.0).abs());
        }
        assert!(error <= plan.predicted().bound, "{geometry:?}: {error:e}, {:?}", plan.predicted());
    }
}

/// Pictures from a tenth of a degree to 179 have a plan, by transforms, by lattices or by tiles.
#[test]
fn fields_from_a_tenth_to_179_degrees() {
    let mut dice = Dice(12);
    let fields: &[f64] =
        if long() { &[0.1, 0.5, 2.0, 7.0, 30.0, 75.0, 100.0, 125.0, 150.0, 179.0] } else { &[0.5, 90.0, 170.0] };
    for field in fields {
        let size = [150, 70];
        let geometry = Geometry::rectilinear(*field, size[0]);
        check(&geometry, &cie(true), size, 1e-2, Window { first: [0, 20], size: [150, 3] }, &mut dice);
    }
}

/// A thousandth of the local veil, which one power of the depth for all lattices misses by far.
#[test]
fn a_thousandth_on_the_sphere() {
    let mut dice = Dice(15);
    let fields: &[f64] = if long() { &[1.0, 5.0, 12.0, 30.0, 50.0, 70.0] } else { &[50.0] };
    for field in fields {
        let size = [180, 90];
        let geometry = Geometry::rectilinear(*field, size[0]);
        let plan = check(&geometry, &cie(true), size, 1e-3, Window { first: [0, 0], size: [180, 4] }, &mut dice);
        assert!(plan.predicted().rounding < 1e-4);
    }
}

/// A single light that outshines all others together: by transforms its own veil would be lost in rounding.
#[test]
fn a_light_that_outshines_all_on_a_narrow_field() {
    let size = [64, 40];
    let mut values: Vec<f32> = vec![1e-3; 3 * size[0] * size[1]];
    values[3 * (11 * size[0] + 30)] = 1e12;
    let photo = Photo::rgb(&values, size).expect("a photo");
    let geometry = Geometry::rectilinear(0.3, size[0]);
    let plan = Plan::new(&geometry, &cie(true), size, Border::None, 1e-2).expect("a plan");
    let veil = plan.evaluate(&photo).expect("a veil");
    assert_eq!(veil.lonely, [1, 0, 0]);
    let (error, place) = worst(&veil, &photo, &geometry, &cie(true), Border::None, Window::whole(size));
    assert!(error <= plan.predicted().bound, "{error:e}, {place}");
}

/// A pixel's own light is left out exactly, however bright it is, and one pixel has no veil.
#[test]
fn lonely_pixels_are_exact_on_the_sphere() {
    let (mut dice, size) = (Dice(13), [120, 80]);
    let mut values = vec![0.0; 3 * size[0] * size[1]];
    for _ in 0..40 {
        values[3 * dice.below(size[0] * size[1]) + 2] = 10f64.powf(dice.between(-4.0, 6.0)) as f32;
    }
    let photo = Photo::rgb(&values, size).expect("a photo");
    let geometry = Geometry::rectilinear(10.0, size[0]);
    let plan = Plan::new(&geometry, &cie(true), size, Border::None, 1e-2).expect("a plan");
    let veil = plan.evaluate(&photo).expect("a veil");
    assert!(veil.lonely[2] > 0, "{:?}", veil.lonely);
    let (error, place) = worst(&veil, &photo, &geometry, &cie(true), Border::None, Window::whole(size));
    assert!(error <= plan.predicted().bound, "{error:e}, {place}");

    let plan = Plan::new(&geometry, &cie(true), [1, 1], Border::None, 1e-2).expect("a plan");
    let veil = plan.evaluate(&Photo::rgb(&[1.0, 2.0, 3.0], [1, 1]).expect("a photo")).expect("a veil");
    assert_eq!(veil.planes, [[0.0], [0.0], [0.0]].map(Vec::from));
}

#[test]
fn the_sphere_has_no_border() {
    for geometry in [Geometry::rectilinear(50.0, 8), Geometry::fisheye(50.0, 8)] {
        let refused = Plan::new(&geometry, &cie(true), [8, 8], Border::Mirror, 1e-2);
        assert!(matches!(refused, Err(Error::Geometry(_))));
    }
    for geometry in
        [Geometry::Rectilinear { focal: 0.0 }, Geometry::rectilinear(f64::NAN, 8), Geometry::fisheye(400.0, 8)]
    {
        assert!(matches!(Plan::new(&geometry, &cie(true), [8, 8], Border::None, 1e-2), Err(Error::Geometry(_))));
    }
}
