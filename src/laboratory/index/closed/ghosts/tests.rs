use super::*;
use crate::frame::Frame;
use crate::scene::{Light, Optical, OpticsSection};
use crate::series::Shape as _;

fn lens(name: &str, fstop: f64, blades: u32) -> Optical {
    let section = OpticsSection {
        lens: Some(name.to_owned()),
        fstop: Some(fstop),
        blades: Some(blades),
        coating: Some("none".to_owned()),
        ..OpticsSection::default()
    };
    Optical::new(section).unwrap().fitted(&Frame::full(3, 2))
}

/// The sum of the ghosts of lights all over the field, each as it is cut where the light is.
#[test]
fn an_even_fields_light_is_the_sum_of_its_lights() {
    const LIGHTS: [u32; 2] = [48, 32];
    let half = DVec2::new(1.5, 1.0);
    let plain = Sight::new(half, 3.0);
    let sight = Sight { spots: vec![plain.spot(DVec2::new(-0.6, 0.3), 6.0)], ..plain };
    for (fstop, blades) in [(6.8, 0), (11.0, 5)] {
        let optical = lens("triplet", fstop, blades);
        let rows: Vec<Row<'_>> =
            optical.rimmed().map(|rimmed| Row::new(rimmed, 1.0, [1.0; 3], half.length()).unwrap()).collect();
        assert!(rows.iter().any(|row| row.cut.is_some()), "rims cut some");
        let points = [DVec2::ZERO, DVec2::new(0.6, -0.3), DVec2::new(-1.1, 0.8)];
        let mut wanted = vec![[0.0; 3]; rows.len()];
        let mut carried = vec![0.0; rows.len()];
        let cell = 2.0 * half / DVec2::new(f64::from(LIGHTS[0]), f64::from(LIGHTS[1]));
        let place = |x: u32, y: u32| cell * DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5) - half;
        let all = (0..LIGHTS[1]).flat_map(|y| (0..LIGHTS[0]).map(move |x| place(x, y)));
        let lit: Vec<DVec2> = all.filter(|place| sight.is_lit(*place)).collect();
        let flux = cell.element_product() * sight.area() / (cell.element_product() * lit.len() as f64);
        for position in &lit {
            let light = Light { position: *position, flux: [flux; 3], size: 0.29 * cell.x, muted: false };
            for (row, ghost) in optical.ghosts_at(*position).iter().enumerate() {
                carried[row] += ghost.share / optical.lens().ghosts[row].share / lit.len() as f64;
                let ghost = ghost.of(&light, DVec2::ZERO);
                for (sum, point) in wanted[row].iter_mut().zip(points) {
                    *sum += ghost.radiance[1] * ghost.bell.shape().value(point - ghost.center, ghost.size);
                }
            }
        }
        // Gaussians between whose centres there are gaps are no even field's.
        let is_even = |row: &Row<'_>| matches!(row.bell, Round::Iris(_)) || row.size > 0.6 * row.along.abs() * cell.x;
        let even: Vec<usize> = (0..rows.len()).filter(|&row| is_even(&rows[row])).collect();
        assert!(3 * even.len() > 2 * rows.len(), "{} of {}", even.len(), rows.len());
        let of_all = |of: &dyn Fn(usize) -> f64| even.iter().map(|&row| of(row)).sum::<f64>();
        for (k, point) in points.iter().enumerate() {
            let (known, whole) =
                (of_all(&|row| wanted[row][k]), of_all(&|row| rows[row].share[1] * rows[row].light(&sight, *point)));
            assert!((whole / known - 1.0).abs() < 1e-2, "f/{fstop} at {point}: {whole} for {known}");
            for (row, wanted) in even.iter().map(|&row| (&rows[row], &wanted[row])) {
                let found = row.share[1] * row.light(&sight, *point);
                assert!((found - wanted[k]).abs() < 0.01 * known, "{}: {found} for {}", row.along, wanted[k]);
            }
        }
        for (row, carried) in rows.iter().zip(carried) {
            // Rims bite the sharper, the more often light meets them.
            let near = if matches!(row.bell, Round::Iris(_)) { 5e-3 } else { 1e-2 };
            assert!((row.carried(&sight) - carried).abs() < near, "{} for {carried}", row.carried(&sight));
        }
    }
}

#[test]
fn polar_coordinates_give_what_discs_and_error_functions_do() {
    let half = DVec2::new(1.5, 1.0);
    let sight = Sight::new(half, 3.0);
    let optical = lens("triplet", 6.8, 0);
    let rows = optical.rimmed().map(|rimmed| Row::new(rimmed, 1.0, [1.0; 3], half.length()).unwrap());
    let mut compared = 0;
    for row in rows.filter(|row| row.cut.is_none()) {
        for at in [DVec2::ZERO, DVec2::new(0.7, 0.5), DVec2::new(-1.4, -0.9)] {
            let (whole, polar) = (row.over_rectangle(half, at), row.around(half, at));
            // Of a ghost that is all within the field there is all.
            assert!(
                (whole - polar).abs() < 2e-3 * whole.max(0.05 / row.along.powi(2)),
                "{}: {whole} {polar}",
                row.along
            );
            compared += 1;
        }
        let spot = sight.spot(DVec2::new(0.2, 0.1), 40.0);
        let at = row.along * spot.centre + 0.4 * DVec2::X;
        let (whole, rings) = (row.over_spot(&spot, at), row.cut_by_spot(&spot, at));
        assert!((whole - rings).abs() < 0.02 * whole.max(0.05 / row.along.powi(2)), "{}: {whole} {rings}", row.along);
    }
    assert!(compared > 9, "{compared}");
    // Deep within, a pile of discs is the iris's own integral.
    let iris = Iris::new(0.1, 0, 0.0).unwrap();
    let pi = pile(&iris, |radius| PI * radius * radius);
    assert!((pi / iris.integral(DVec2::ONE) - 1.0).abs() < 1e-6, "{pi}");
}

#[test]
fn arcs_of_a_circle_are_those_within_the_rectangle() {
    let half = DVec2::new(1.5, 1.0);
    for (distance, middle, seen) in
        [(0.5, 0.0, PI), (1.2, 0.3, PI), (1.7, 2.0, PI), (1.2, 3.0, 0.4), (1.6, -3.0, 1.0), (1.7, 0.6, 0.2)]
    {
        let inside = |angle: f64| {
            let turn = (angle - middle).rem_euclid(TAU);
            (distance * DVec2::from_angle(angle)).abs().cmple(half).all() && turn.min(TAU - turn) <= seen
        };
        const STEPS: u32 = 20_000;
        let counted = (0..STEPS).filter(|k| inside(TAU * f64::from(*k) / f64::from(STEPS))).count() as f64 * TAU
            / f64::from(STEPS);
        let found: f64 = arcs(half, distance, middle, seen).iter().map(|[low, high]| high - low).sum();
        assert!((found - counted).abs() < 3e-3, "{distance} {middle} {seen}: {found} for {counted}");
    }
    assert!(arcs(half, 1.9, 0.0, PI).is_empty());
}
