use std::f64::consts::TAU;

use super::*;
use crate::chance::Chance;
use crate::series::bell::{Bounded, Plane};
use crate::series::kappa;

fn irises(count: usize) -> Vec<Iris> {
    let mut chance = Chance::new(17);
    let mut one = |k: usize| {
        let edge = chance.between(EDGES[0].ln(), EDGES[1].ln()).exp();
        let blades = [0, 3, 4, 5, 6, 9, 16][k % 7];
        let rotation = if blades == 0 { 0.0 } else { chance.between(-400.0, 400.0) };
        Iris::new(edge, blades, rotation).unwrap()
    };
    (0..count).map(&mut one).collect()
}

/// Some of them, cut by one to three rims, of which there is something left.
fn cut_irises(count: usize) -> Vec<Iris> {
    let mut chance = Chance::new(20);
    let one = |iris: Iris| {
        let rims = 1 + chance.bits() % 3;
        let rim = |_| {
            let radius = chance.between(0.7f64.ln(), 60.0f64.ln()).exp();
            let centre = (radius + chance.between(-1.2, 0.9)).max(0.0);
            Cut { centre: centre * DVec2::from_angle(chance.between(0.0, TAU)), radius }
        };
        iris.cut(&(0..rims).map(rim).collect::<Vec<_>>())
    };
    let sharp = |iris: &Iris| iris.edge() < 0.02;
    let all = irises(12 * count).into_iter().filter(|iris| !sharp(iris)).filter_map(one);
    let cut: Vec<Iris> = all.filter(|iris| !iris.cuts().is_empty()).take(count).collect();
    assert_eq!(cut.len(), count);
    cut
}

/// Those of both kinds.
fn all_irises(count: usize) -> impl Iterator<Item = Iris> {
    irises(count).into_iter().chain(cut_irises(count))
}

#[test]
fn a_cut_leaves_what_all_circles_have_in_common() {
    let mut worst = 0.0f64;
    for iris in cut_irises(40) {
        let whole = Iris::new(iris.edge(), iris.blades(), iris.rotation()).unwrap();
        assert_eq!(whole.cut(iris.cuts()), Some(iris.clone()));
        let of = |iris: &Iris| iris.moments().area / iris.0.peak;
        let left = of(&iris) / of(&whole);
        // A sum over a lattice, and the largest value on it.
        let step = 0.02;
        let half = (iris.radius_of(12.0) / step) as i32;
        let (mut sums, mut largest) = ([0.0; 2], 0.0f64);
        for (i, j) in (-half..=half).flat_map(|j| (-half..=half).map(move |i| (i, j))) {
            let at = step * DVec2::new(f64::from(i), f64::from(j));
            let steps = iris.cuts().iter().map(|cut| {
                step_down(0.5 * ((at - cut.centre).length_squared() / cut.radius - cut.radius) / iris.edge())
            });
            let product = steps.product::<f64>() * whole.at(at);
            let value = iris.value(at, DVec2::ONE);
            let scale = iris.0.peak / whole.0.peak;
            assert!((value - scale * product).abs() < 1e-9, "{iris:?} at {at}: {value} {}", scale * product);
            (sums[0], sums[1], largest) = (sums[0] + product, sums[1] + whole.at(at), largest.max(value));
        }
        assert!((sums[0] / sums[1] - left).abs() < 2e-4, "{iris:?}: {left} {sums:?}");
        assert!(largest <= 1.0 && largest > 0.995, "{iris:?}: {largest}");
        worst = worst.max(1.0 - left);
    }
    assert!(worst > 0.9, "one of them is nearly gone: {worst}");
}

#[test]
fn rims_that_leave_all_or_nothing() {
    let iris = Iris::new(0.06, 6, 10.0).unwrap();
    let rim = |x: f64, radius: f64| Cut { centre: DVec2::new(x, 0.0), radius };
    assert_eq!(iris.cut(&[]), Some(iris.clone()));
    // Well beyond it, also where it is next to straight.
    assert_eq!(iris.cut(&[rim(0.1, 1.5), rim(1e9 - 1.5, 1e9)]), Some(iris.clone()));
    for none in [rim(3.0, 1.0), rim(1e9 + 1.6, 1e9), rim(0.0, 0.0), rim(f64::NAN, 1.0), rim(0.0, f64::NAN)] {
        assert_eq!(iris.cut(&[none]), None, "{none:?}");
    }
    let left = |cut: Cut| {
        let of = |iris: &Iris| iris.moments().area / iris.0.peak;
        of(&iris.cut(&[cut]).unwrap()) / of(&iris)
    };
    // A straight rim through the middle leaves half.
    for radius in [1e6, 1e9] {
        assert!((left(rim(radius, radius)) - 0.5).abs() < 0.01, "{}", left(rim(radius, radius)));
    }
    // The rim that a light on the other side would have.
    let one = left(rim(0.8, 1.2));
    let other = left(Cut { centre: DVec2::from_angle(60f64.to_radians()) * 0.8, radius: 1.2 });
    assert!((one - other).abs() < 1e-9, "a hexagon, turned by a sixth: {one} {other}");
}

#[test]
fn no_place_is_beyond_what_bounds_it() {
    let mut chance = Chance::new(18);
    for iris in all_irises(56) {
        let whole = iris.cuts().is_empty();
        assert!(!whole || (iris.value(DVec2::ZERO, DVec2::ONE) - 1.0).abs() < 1e-14, "{iris:?}");
        for _ in 0..400 {
            let at = DVec2::new(chance.between(-2.5, 2.5), chance.between(-2.5, 2.5));
            let (value, radius) = (iris.value(at, DVec2::ONE), at.length());
            let allowed = iris.along(at.x, 1.0) * iris.along(at.y, 1.0);
            assert!(value <= allowed * (1.0 + 1e-12), "{iris:?} at {at}: {value} {allowed}");
            let step = DVec2::from_angle(chance.between(0.0, TAU)) * 1e-6;
            let slope = (iris.at(at + step) - iris.at(at - step)).abs() / 2e-6;
            let limit = iris.steepest(radius - 1e-6);
            assert!(slope <= limit + 1e-6, "{iris:?} at {at}: {slope} {limit}");
            let share = chance.between(-20.0, 0.0).exp();
            let reach = iris.reach(share);
            assert!(
                value <= share * (1.0 + 1e-9) || at.abs().max_element() <= reach,
                "{iris:?} at {at}: {share} {reach}"
            );
        }
    }
}

/// Half of what there is lies beyond a side of a polygon, and the corners are on the circle.
#[test]
fn edges_lie_where_the_opening_says() {
    for iris in irises(56) {
        let turn = iris.rotation().to_radians();
        let blades = f64::from(iris.blades());
        let (across, distance) = match iris.blades() {
            0 => (DVec2::X, 1.0),
            _ => (DVec2::from_angle(turn + PI / blades), (PI / blades).cos()),
        };
        let sharp = Iris::new(EDGES[0], iris.blades(), iris.rotation()).unwrap();
        assert!((sharp.at(distance * across) - 0.5).abs() < 0.02, "{sharp:?}: {}", sharp.at(distance * across));
        assert!((sharp.outline(across) - distance).abs() < 1e-12);
        if iris.blades() > 0 {
            assert!((sharp.outline(DVec2::from_angle(turn)) - 1.0).abs() < 1e-12);
        }
    }
}

/// By midpoints in polar coordinates.
#[test]
fn integrals_and_variances_are_those_of_their_values() {
    for iris in all_irises(14) {
        let (radii, angles) = (1500, 240);
        let end = iris.radius_of(NOTHING);
        let (mut integral, mut first, mut square) = (0.0, DVec2::ZERO, 0.0);
        for j in 0..angles {
            let towards = DVec2::from_angle(TAU * (f64::from(j) + 0.5) / f64::from(angles));
            for i in 0..radii {
                let radius = end * (f64::from(i) + 0.5) / f64::from(radii);
                let part = iris.at(radius * towards) * radius * end / f64::from(radii) * TAU / f64::from(angles);
                integral += part;
                first += part * radius * towards;
                square += part * radius * radius;
            }
        }
        let variance = 0.5 * (square / integral - (first / integral).length_squared());
        let expected = [iris.integral(DVec2::ONE), iris.variance()];
        assert!((integral / expected[0] - 1.0).abs() < 1e-4, "{iris:?}: {integral} {expected:?}");
        assert!((variance / expected[1] - 1.0).abs() < 1e-4, "{iris:?}: {variance} {expected:?}");
    }
}

#[test]
fn no_transform_is_beyond_its_envelope_which_is_not_far_off() {
    for iris in all_irises(14) {
        // Harmonics of both axes, in a period of 3 and 2.5 sizes.
        let size = DVec2::new(1.0 / 3.0, 0.4);
        let last = (12.0 / (PI * iris.edge())).min(90.0) as u32;
        let counts = vec![last; last as usize];
        let volume = size.element_product();
        let mut closest = 0.0f64;
        for (index, [cc, ss, cs, sc]) in iris.parts(&counts, size).into_iter().enumerate() {
            let [n, m] = [index as u32 / last, index as u32 % last].map(f64::from);
            let z = (TAU * size * DVec2::new(n, m)).length();
            let largest = ((cc - ss).hypot(sc + cs)).max((cc + ss).hypot(cs - sc)) / volume;
            let envelope = iris.envelope(z);
            assert!(largest <= envelope * (1.0 + 1e-9) + 1e-13, "{iris:?} at {z}: {largest} {envelope}");
            if largest > 1e-9 {
                closest = closest.max(largest / envelope);
            }
        }
        assert!(closest > 0.3 || !iris.cuts().is_empty(), "the integral: {closest}");
    }
}

/// All of a transform beyond each of some z, over 4π², summed on a lattice that is finer than its ridges.
#[test]
fn transforms_fall_as_they_are_said_to_with_any_blades() {
    let mut closest = 0.0f64;
    for blades in (3..=MOST_BLADES).chain([0]) {
        for (edge, rotation) in [(0.06, 0.0), (0.1, 11.0), (0.3, 5.0)] {
            let iris = Iris::new(edge, blades, if blades == 0 { 0.0 } else { rotation }).unwrap();
            let last = 110usize;
            let cell = 17.0 / iris.fall() / last as f64;
            let counts = vec![last as u32; last];
            let mut modes: Vec<(f64, f64)> = iris
                .parts(&counts, DVec2::splat(cell / TAU))
                .into_iter()
                .enumerate()
                .map(|(index, [cc, ss, cs, sc])| {
                    let (n, m) = (index / last, index % last);
                    let held = 0.5 * ((cc - ss).hypot(sc + cs) + (cc + ss).hypot(cs - sc));
                    (cell * (n as f64).hypot(m as f64), kappa(n as u32, m as u32) * held)
                })
                .collect();
            modes.sort_by(|one, other| other.0.total_cmp(&one.0));
            let mut beyond = 0.0;
            for (z, held) in modes {
                let bound = iris.beyond(z, 0.0);
                assert!(z * iris.fall() > 15.0 || beyond <= 0.5 * bound, "{blades} {edge} at {z}: {beyond} {bound}");
                if z * iris.fall() > 1.0 && z * iris.fall() < 15.0 {
                    closest = closest.max(beyond / bound);
                }
                beyond += held;
            }
        }
    }
    assert!(closest > 0.1, "{closest}");
}

// In a period, modes within an ellipse, at some places.
#[test]
fn a_cut_series_is_no_farther_off_than_its_bound() {
    let mut chance = Chance::new(19);
    for iris in all_irises(14) {
        let size = DVec2::new(0.2, 0.25);
        let turn = TAU * size;
        let cell = 0.5 * turn.length();
        let mut closest = 0.0f64;
        for part in [0.6, 1.0, 1.6] {
            let z = part * 6.0 / iris.fall();
            let rows = (z / turn.x) as u32;
            let counts: Vec<u32> = (0..=rows)
                .map(|n| ((z * z - (turn.x * f64::from(n)).powi(2)).max(0.0).sqrt() / turn.y) as u32 + 1)
                .collect();
            let table = Modes::Plane(&iris).table(&counts, size);
            let bound = iris.beyond(z, cell);
            for _ in 0..12 {
                let at = DVec2::new(chance.between(-0.4, 0.4), chance.between(-0.4, 0.4));
                let copies = (-2..=2).flat_map(|i| (-2..=2).map(move |j| DVec2::new(f64::from(i), f64::from(j))));
                let exact: f64 = copies.map(|copy| iris.value(at + copy, size)).sum();
                let mut sum = 0.0;
                let modes = (0u32..).zip(&counts).flat_map(|(n, &count)| (0..count).map(move |m| (n, m)));
                for ((n, m), [cc, ss, cs, sc]) in modes.zip(&table) {
                    assert!(kappa(n, m) >= 1.0);
                    let ((sin_x, cos_x), (sin_y, cos_y)) =
                        ((TAU * f64::from(n) * at.x).sin_cos(), (TAU * f64::from(m) * at.y).sin_cos());
                    sum += cc * cos_x * cos_y + ss * sin_x * sin_y + cs * cos_x * sin_y + sc * sin_x * cos_y;
                }
                assert!((sum - exact).abs() <= bound + 1e-12, "{iris:?} at {at}, {part}: {sum} {exact} {bound}");
                closest = closest.max((sum - exact).abs() / bound);
            }
        }
        assert!(closest > 1e-3 || !iris.cuts().is_empty() && closest > 1e-5, "{iris:?}: {closest}");
    }
}

#[test]
fn what_makes_no_iris_is_refused() {
    let refused =
        [(0.0, 0, 0.0), (0.4, 5, 0.0), (f64::NAN, 5, 0.0), (0.1, 1, 0.0), (0.1, 2, 0.0), (0.1, 17, 0.0), (0.1, 0, 3.0)];
    for (edge, blades, rotation) in refused {
        assert!(Iris::new(edge, blades, rotation).is_err(), "{edge} {blades} {rotation}");
    }
    assert!(Iris::new(0.1, 6, f64::INFINITY).is_err());
}

#[test]
fn a_lattice_of_values_is_its_values() {
    for iris in all_irises(28) {
        let size = DVec2::new(0.3, 0.2);
        let [xs, ys] = [0.31, 0.17].map(|step| (-9..=9).map(|k| step * f64::from(k)).collect::<Vec<f64>>());
        iris.over(&xs, &ys, size, &mut |row, values| {
            for (x, value) in xs.iter().zip(values) {
                let expected = iris.value(DVec2::new(*x, ys[row]), size);
                assert!((value - expected).abs() <= 1e-13, "{iris:?} at {x}, {}: {value} {expected}", ys[row]);
            }
        });
    }
}
