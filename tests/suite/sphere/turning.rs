//! Rotation matrices: golden ones, and what makes them rotations.

use std::f64::consts::PI;

use glam::{DQuat, DVec3};
use vglare::series::sphere::{Band, Basis, Coefficients, Phase, RECURSION_LIMIT, each_band, index, project, turn};

use super::{directions, noise, random};
use crate::golden::{cases, count, number};
use crate::support::check::Worst;

fn band(rotation: DQuat, l: usize) -> Band {
    let mut found = None;
    each_band(rotation, l, |band| found = Some(band.clone()).filter(|band| band.l() == l));
    found.unwrap()
}

fn turns() -> Vec<DQuat> {
    let mut next = noise(77);
    let mut result = vec![DQuat::IDENTITY, turn(0.3, 0.0, 0.0), turn(0.0, PI / 2.0, 0.0), turn(0.0, 0.0, PI)];
    result.extend((0..4).map(|_| turn(3.0 * next(), 1.5 * next(), 3.0 * next())));
    result
}

#[test]
fn matrices_are_the_golden_ones() {
    let mut worst = Worst::default();
    for case in cases(include_str!("../../golden/sh_rotation.json")) {
        let axis: Vec<f64> = case["axis"].as_array().unwrap().iter().map(number).collect();
        let (angle, l) = (number(&case["angle"]), count(&case["l"]) as usize);
        let axis = DVec3::from_slice(&axis).normalize();
        let got = band(DQuat::from_axis_angle(axis, angle), l);
        // The whole matrix, or one row of it, counted from the top.
        let (first, rows) = match case["matrix_rows"].as_array() {
            Some(rows) => (0, rows.clone()),
            None => (count(&case["row"]) as isize, vec![case["matrix_row"].clone()]),
        };
        for (m, row) in (first - l as isize..).zip(&rows) {
            assert_eq!(row.as_array().unwrap().len(), 2 * l + 1);
            for (n, expected) in (-(l as isize)..).zip(row.as_array().unwrap()) {
                let error = (got.at(m, n) - number(expected)).abs();
                assert!(error <= 5e-15, "{axis}, {angle}, l {l}, ({m}, {n}): {} for {expected}", got.at(m, n));
                worst.take(error, || format!("{axis}, {angle}, l {l}, ({m}, {n})"));
            }
        }
    }
    println!("worst error {worst}");
}

#[test]
fn matrices_are_orthogonal() {
    for (l, limit) in [(1, 2e-15), (5, 1e-14), (20, 3e-14), (RECURSION_LIMIT, 1e-13)] {
        let mut worst = Worst::default();
        for rotation in turns() {
            let matrix = band(rotation, l);
            let orders = -(l as isize)..=l as isize;
            for m in orders.clone() {
                for n in orders.clone().step_by(if l > 20 { 3 } else { 1 }) {
                    let product: f64 = orders.clone().map(|k| matrix.at(m, k) * matrix.at(n, k)).sum();
                    let error = (product - if m == n { 1.0 } else { 0.0 }).abs();
                    assert!(error <= limit, "l {l}, rows {m} and {n} of {rotation}: {error:e}");
                    worst.take(error, || format!("rows {m} and {n} of {rotation}"));
                }
            }
        }
        println!("l {l}: worst error {worst}");
    }
}

#[test]
fn harmonics_of_a_turned_direction_are_turned_harmonics() {
    let degree = RECURSION_LIMIT;
    let basis = Basis::new(degree);
    for rotation in turns() {
        for v in directions(10, 21) {
            let (before, after) = (basis.at(v), basis.at(rotation * v));
            each_band(rotation, degree, |band| {
                let l = band.l() as isize;
                for m in -l..=l {
                    let sum: f64 = (-l..=l).map(|n| band.at(m, n) * before[index(band.l(), n)]).sum();
                    let error = (sum - after[index(band.l(), m)]).abs();
                    assert!(error < 1e-13, "l {l}, m {m}, {rotation} at {v}: {error:e}");
                }
            });
        }
    }
}

#[test]
fn turning_coefficients_is_projecting_the_turned_function() {
    let mut worst = Worst::default();
    for (seed, rotation) in (0..).zip(turns()) {
        let coefficients = random(12, seed);
        let back = rotation.inverse();
        let projected = project(12, 16, |v| coefficients.at(back * v));
        let error = coefficients.rotated(rotation).difference(&projected);
        assert!(error < 1e-12, "{rotation}: {error:e}");
        worst.take(error, || rotation.to_string());
    }
    println!("worst error {worst}");
}

#[test]
fn matrices_and_angles_turn_alike() {
    let poles = [turn(0.0, PI, 0.0), turn(0.4, PI, 0.0), turn(0.4, 1e-9, 0.2), turn(1.0, PI - 1e-9, 0.0)];
    let mut worst = Worst::default();
    for rotation in turns().into_iter().chain(poles) {
        for degree in [0, 1, 2, 7, RECURSION_LIMIT] {
            let coefficients = random(degree, degree as u64);
            let by_angles = coefficients.rotated_by_angles(rotation);
            let error = by_angles.difference(&coefficients.rotated_by_matrices(rotation));
            assert!(error < 1e-13, "degree {degree}, {rotation}: {error:e}");
            worst.take(error, || format!("degree {degree}, {rotation}"));
        }
    }
    println!("worst difference {worst}");
    // Further up the matrices are lost, and not used.
    let coefficients = random(200, 1);
    let right = coefficients.rotated(turn(0.0, PI / 2.0, 0.0));
    assert!(coefficients.rotated_by_matrices(turn(0.0, PI / 2.0, 0.0)).difference(&right) > 1e-3);
}

#[test]
fn high_degrees_turn_as_well() {
    // The last is nearly upside down: there the seeds of Wigner's d leave f64 first.
    for rotation in [turn(0.7, 0.4, -0.3), turn(0.0, PI / 2.0, 0.0), turn(0.3, 3.05, 1.0)] {
        let coefficients = random(400, 6);
        let turned = coefficients.rotated(rotation);
        for l in 0..=400 {
            let ratio = turned.band_energy(l) / coefficients.band_energy(l);
            assert!((ratio - 1.0).abs() < 1e-11, "{rotation}, band {l}: {ratio}");
        }
        for v in directions(4, 8) {
            let (before, after) = (coefficients.at(v), turned.at(rotation * v));
            // The values are about √(161000 / 4π), 100.
            let error = (before[0] - after[0]).abs();
            assert!(error < 1e-9, "{rotation} at {v}: {error:e}");
        }
    }
}

#[test]
fn turns_compose_and_keep_energy() {
    let coefficients = random(30, 5);
    let (first, second) = (turn(0.4, -0.7, 1.1), turn(-2.0, 0.2, 0.6));
    let composed = coefficients.rotated(second * first);
    assert!(coefficients.rotated(first).rotated(second).difference(&composed) < 1e-12);
    assert!(coefficients.rotated(first).rotated(first.inverse()).difference(&coefficients) < 1e-12);
    assert!(coefficients.rotated(second).difference(&composed) > 0.1, "another turn is another function");
    for l in 0..=30 {
        let (before, after) = (coefficients.band_energy(l), composed.band_energy(l));
        assert!((after / before - 1.0).abs() < 1e-12, "band {l}: {after} for {before}");
    }
}

#[test]
fn yaw_pitch_and_roll_turn_as_they_say() {
    let quarter = PI / 2.0;
    for (rotation, from, to) in [
        (turn(quarter, 0.0, 0.0), DVec3::X, DVec3::Y),
        (turn(0.0, quarter, 0.0), DVec3::X, DVec3::Z),
        (turn(0.0, 0.0, quarter), DVec3::Y, DVec3::Z),
        (turn(quarter, quarter, 0.0), DVec3::X, DVec3::Z),
        (turn(quarter, 0.0, quarter), DVec3::Y, DVec3::Z),
    ] {
        assert!((rotation * from - to).length() < 1e-15, "{rotation} takes {from} to {}", rotation * from);
        // A lobe along `from` is a lobe along `to` afterwards.
        let mut lobe = Coefficients::zero(1);
        for (m, amount) in [(-1, from.y), (0, from.z), (1, from.x)] {
            lobe.values_mut()[index(1, m)] = [amount; 3];
        }
        let [most, _, _] = lobe.at(from);
        assert!((lobe.rotated(rotation).at(to)[0] - most).abs() < 1e-15, "{rotation}");
    }
}

/// Matrices for one convention are wrong for the other, unless the turn is about z by a half.
#[test]
fn conventions_do_not_mix() {
    let (coefficients, rotation) = (random(4, 2), turn(0.5, 0.6, 0.7));
    let mixed = coefficients.clone().in_phase(Phase::CondonShortley).rotated(rotation).in_phase(Phase::CondonShortley);
    assert!(mixed.difference(&coefficients.rotated(rotation)) > 0.1);
}
