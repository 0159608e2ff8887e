//! Flat pictures.

use super::kernels::{cie, gaussian, spencer};
use super::photos::{Dice, photo};
use super::{long, worst};
use crate::veil::reference::Window;
use crate::veil::{Border, Gaussian, Geometry, Kernel, Mixture, Photo, Plan};

/// Some kernel, a pitch for it, and a tolerance that its mixture allows.
fn some_kernel(dice: &mut Dice) -> (Kernel, f64, f64) {
    let degrees = 10f64.powf(dice.between(-1.6, -0.3));
    match dice.below(5) {
        0 => (cie(false), degrees, 1e-2),
        1 => (cie(true), degrees, 3e-3),
        2 => (spencer(true), degrees, 3e-3),
        3 => (gaussian(10f64.powf(dice.between(-0.3, 2.0))), 1.0, 10f64.powf(dice.between(-4.0, -2.0))),
        _ => {
            let term = |dice: &mut Dice| Gaussian {
                sigma: 10f64.powf(dice.between(-0.5, 2.5)),
                weight: 10f64.powf(dice.between(-4.0, 1.0)),
            };
            let terms = (0..1 + dice.below(6)).map(|_| term(dice)).collect();
            let mixture = Mixture { terms, constant: 1e-5 * dice.share(), quadratic: 1e-9 * dice.share() };
            (Kernel::from_mixture(mixture).expect("a kernel"), 1.0, 10f64.powf(dice.between(-3.5, -2.0)))
        }
    }
}

#[test]
fn the_bound_holds_relative_to_the_local_veil() {
    let (mut dice, cases) = if long() { (Dice(77), 400) } else { (Dice(1), 20) };
    let mut ratios = Vec::new();
    for case in 0..cases {
        let size = [1 + dice.below(120), 1 + dice.below(90)];
        let (kernel, pitch, tolerance) = some_kernel(&mut dice);
        let lights = 1 + dice.below(6);
        let values = photo(&mut dice, size, lights, 8.0);
        let photo = Photo::rgb(&values, size).expect("a photo");
        let geometry = Geometry::planar_degrees(pitch);
        let plan = Plan::new(&geometry, &kernel, size, Border::None, tolerance);
        let plan = plan.unwrap_or_else(|error| panic!("{case}: {size:?} at {pitch}: {error} {kernel:?}"));
        let veil = plan.evaluate(&photo).expect("a veil");
        let (error, place) = worst(&veil, &photo, &geometry, &kernel, Border::None, Window::whole(size));
        let bound = plan.predicted().bound;
        assert!(bound <= tolerance, "{case}");
        assert!(
            error <= bound,
            "{case}: {error:e} for {bound:e}, {place}, {:?}, {size:?} {kernel:?}",
            plan.predicted()
        );
        ratios.push(bound / error.max(1e-12));
    }
    ratios.sort_by(f64::total_cmp);
    assert!(ratios[ratios.len() / 2] < 10.0, "bound over measured: {ratios:.1?}");
}

/// Its profile is the function at every offset, wherever between lattice points it stands.
#[test]
fn a_bright_pixel_anywhere_has_the_profile_of_the_function() {
    let size = [230, 170];
    for (kernel, tolerance) in [(cie(false), 1e-2), (cie(true), 2e-3), (spencer(false), 1.2e-2)] {
        let geometry = Geometry::planar_degrees(0.04);
        let plan = Plan::new(&geometry, &kernel, size, Border::None, tolerance).expect("a plan");
        for [x, y] in [[0, 0], [229, 169], [100, 3], [101, 64], [117, 88]] {
            let mut values = vec![0.0; 3 * size[0] * size[1]];
            values[3 * (y * size[0] + x) + 1] = 1e4;
            let veil = plan.evaluate(&Photo::rgb(&values, size).expect("a photo")).expect("a veil");
            assert!(veil.planes[0].iter().chain(&veil.planes[2]).all(|value| *value == 0.0));
            for (pixel, found) in veil.planes[1].iter().enumerate() {
                let distance = ((pixel % size[0]) as f64 - x as f64).hypot((pixel / size[0]) as f64 - y as f64);
                let wanted =
                    if distance == 0.0 { 0.0 } else { 1e4 * 0.04f64.to_radians().powi(2) * kernel.at(0.04 * distance) };
                let error = (f64::from(*found) - wanted).abs();
                assert!(error <= plan.predicted().bound * wanted, "{distance} from {x}, {y}: {found:e} for {wanted:e}");
            }
        }
    }
}

#[test]
fn borders_are_those_of_a_larger_picture() {
    let mut dice = Dice(5);
    for border in [Border::Mirror, Border::Extend] {
        for size in [[37, 22], [8, 1], [1, 1]] {
            let values = photo(&mut dice, size, 3, 5.0);
            let photo = Photo::rgb(&values, size).expect("a photo");
            let geometry = Geometry::planar_degrees(0.1);
            let plan = Plan::new(&geometry, &cie(true), size, border, 3e-3).expect("a plan");
            let veil = plan.evaluate(&photo).expect("a veil");
            let (error, place) = worst(&veil, &photo, &geometry, &cie(true), border, Window::whole(size));
            assert!(error <= plan.predicted().bound, "{border:?} {size:?}: {error:e}, {place}");
        }
    }
}

/// Stars so far from each other that the veil of each is far below what rounding leaves of its own light; more than are taken at a time.
#[test]
fn lonely_pixels_are_exact() {
    let (mut dice, size) = (Dice(9), [150, 120]);
    let mut values = vec![0.0; 3 * size[0] * size[1]];
    for y in (0..size[1]).step_by(2) {
        for x in (0..size[0]).step_by(2) {
            values[3 * (y * size[0] + x)] = 10f64.powf(dice.between(-4.0, 4.0)) as f32;
        }
    }
    let photo = Photo::rgb(&values, size).expect("a photo");
    for kernel in [gaussian(0.35), gaussian(9.0)] {
        let geometry = Geometry::Planar { pitch: 1.0, solid_angle: 1.0 };
        let plan = Plan::new(&geometry, &kernel, size, Border::None, 1e-4).expect("a plan");
        let veil = plan.evaluate(&photo).expect("a veil");
        let window = Window { first: [20, 30], size: [70, 20] };
        let (error, place) = worst(&veil, &photo, &geometry, &kernel, Border::None, window);
        assert!(error <= plan.predicted().bound, "{error:e}, {place}, {:?}", veil.lonely);
    }
}
