//! Parts of the sphere.

use super::kernels::{cie, spencer};
use super::photos::{Dice, photo};
use super::{long, worst};
use crate::veil::reference::Window;
use crate::veil::{Border, Error, Geometry, Photo, Plan};

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

/// Whatever the field: within the bound, or refused.
#[test]
fn fields_from_a_tenth_to_179_degrees() {
    let mut dice = Dice(12);
    let size = [64, 48];
    let values = photo(&mut dice, size, 3, 8.0);
    let photo = Photo::rgb(&values, size).expect("a photo");
    for field in [0.1, 90.0, 179.0] {
        let geometry = Geometry::rectilinear(field, size[0]);
        let plan = Plan::new(&geometry, &cie(true), size, Border::None, 1e-2).expect("a small picture has a plan");
        let veil = plan.evaluate(&photo).expect("a veil");
        let window = Window { first: [0, 20], size: [64, 4] };
        let (error, place) = worst(&veil, &photo, &geometry, &cie(true), Border::None, window);
        assert!(error <= plan.predicted().bound, "{field}°: {error:e}, {place}, {:?}", plan.predicted());
    }
    // A large picture of a tenth of a degree lies within the core of the function.
    let geometry = Geometry::rectilinear(0.1, 400);
    let refused = Plan::new(&geometry, &cie(true), [400, 300], Border::None, 1e-3);
    assert!(matches!(refused, Err(Error::Core { .. } | Error::OutOfReach { .. })), "{refused:?}");
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
