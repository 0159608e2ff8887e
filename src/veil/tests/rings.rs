//! The veil of a whole sphere.

use std::f64::consts::PI;

use super::*;
use crate::veil::{Mixture, Plan};

const SIZE: [usize; 2] = [64, 32];

/// Like an eye's: steep, and even within a tenth of a degree.
fn eye() -> Kernel {
    let value = |angle: f64| {
        let angle = angle.max(0.1);
        10.0 / angle.powi(3) + 5.0 / angle.powi(2) + 2.5e-3
    };
    Kernel::new(value, Mixture::default()).unwrap()
}

fn planned(kernel: &Kernel, size: [usize; 2]) -> Plan {
    Plan::new(&Geometry::Equirectangular, kernel, size, Border::None, 1e-2).expect("a plan")
}

/// Light by column and row, of one colour.
fn photo(size: [usize; 2], light: impl Fn(usize, usize) -> f32) -> Vec<f32> {
    let pixel = |at: usize| {
        let light = light(at % size[0], at / size[0]);
        [light, 0.5 * light, 0.0]
    };
    (0..size[0] * size[1]).flat_map(pixel).collect()
}

fn veil(plan: &Plan, pixels: &[f32]) -> Vec<f32> {
    let [red, ..] = plan.evaluate(&Photo::rgb(pixels, plan.size()).unwrap()).unwrap().planes;
    red
}

/// What is bright here and there, a sun among it.
fn world(column: usize, row: usize) -> f32 {
    let (x, y) = (column as f64 / 64.0 * 2.0 * PI, row as f64 / 32.0 * PI);
    let sun = if (column, row) == (5, 9) { 3e4 } else { 0.0 };
    (((2.0 * x).sin() + (3.0 * y).cos()).exp() + sun) as f32
}

#[test]
fn it_is_the_sum_over_all_pixels() {
    for kernel in
        [eye(), Kernel::new(|angle: f64| (1.0 + (angle / 10.0).powi(2)).powf(-1.5), Mixture::default()).unwrap()]
    {
        let plan = planned(&kernel, SIZE);
        let pixels = photo(SIZE, world);
        let photo = Photo::rgb(&pixels, SIZE).unwrap();
        let computed = plan.evaluate(&photo).unwrap();
        let places: Vec<[usize; 2]> =
            [[0, 0], [63, 0], [20, 31], [5, 9], [6, 9], [37, 9], [0, 15], [63, 16], [32, 2]].to_vec();
        let truth = reference::at(&photo, &Geometry::Equirectangular, &kernel, Border::None, &places);
        for ([x, y], truth) in places.into_iter().zip(truth) {
            for (plane, truth) in computed.planes.iter().zip(truth).take(2) {
                let error = (f64::from(plane[y * SIZE[0] + x]) / truth - 1.0).abs();
                assert!(error <= plan.predicted().bound, "{x}, {y}: {error:e} of {:e}", plan.predicted().bound);
            }
        }
        assert!(computed.planes[2].iter().all(|value| *value == 0.0));
    }
}

#[test]
fn an_even_sky_stays_even_and_has_the_light_that_the_kernel_scatters() {
    let plan = planned(&eye(), SIZE);
    let veil = veil(&plan, &photo(SIZE, |_, _| 1.0));
    let kernel = eye();
    // ∫ k dΩ over the sphere, by even steps of the logarithm of the angle.
    let mut energy = 0.0;
    let steps = 40_000;
    let (low, high) = (1e-6f64.ln(), PI.ln());
    for step in 0..steps {
        let angle = (low + (high - low) * (f64::from(step) + 0.5) / f64::from(steps)).exp();
        energy += 2.0 * PI * kernel.at(angle.to_degrees()) * angle.sin() * angle * (high - low) / f64::from(steps);
    }
    for value in veil {
        assert!((f64::from(value) / energy - 1.0).abs() < 5e-3, "{value} for {energy}");
    }
}

#[test]
fn turning_the_world_turns_its_veil() {
    let plan = planned(&eye(), SIZE);
    let turned = |by: usize| veil(&plan, &photo(SIZE, |column, row| world((column + by) % 64, row)));
    let (one, other) = (turned(0), turned(16));
    for (at, value) in other.iter().enumerate() {
        let same = one[at / 64 * 64 + (at % 64 + 16) % 64];
        assert!((value / same - 1.0).abs() < 1e-5, "{at}: {value} {same}");
    }
}

#[test]
fn a_point_at_a_pole_or_at_the_seam_has_a_round_veil() {
    let (size, kernel) = ([128, 64], eye());
    let plan = planned(&kernel, size);
    // All of the ring about the pole: the same all round it.
    let pole = veil(&plan, &photo(size, |_, row| if row == 0 { 1.0 } else { 0.0 }));
    for row in pole.chunks_exact(128) {
        assert!(row.iter().all(|value| (value / row[0] - 1.0).abs() < 1e-4), "{row:?}");
    }
    // Two pixels beside the seam: the same to both sides of it.
    let seam =
        veil(&plan, &photo(size, |column, row| if row == 20 && (column == 0 || column == 127) { 1.0 } else { 0.0 }));
    for row in seam.chunks_exact(128) {
        assert!((0..64).all(|k| (row[k] / row[127 - k] - 1.0).abs() < 1e-4), "{row:?}");
    }
}

/// Between any two points up to 60° apart, at poles, across the seam and elsewhere, a small source sends what the function says, from all
/// over its pixel: next to a pole its middle is not the middle of its light.
#[test]
fn far_from_a_source_it_is_the_function() {
    let (size, kernel) = ([256, 128], eye());
    let plan = planned(&kernel, size);
    let direction = |[x, y]: [f64; 2]| {
        let (theta, phi) = (PI * y / 128.0, 2.0 * PI * x / 256.0);
        [theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos()]
    };
    let middle = |pixel: [usize; 2]| direction(pixel.map(|k| k as f64 + 0.5));
    let apart = |a: [f64; 3], b: [f64; 3]| (0..3).map(|k| a[k] * b[k]).sum::<f64>().min(1.0).acos().to_degrees();
    for source in [[0, 64], [17, 1], [255, 30], [100, 127]] {
        let seen = veil(&plan, &photo(size, |column, row| if [column, row] == source { 1.0 } else { 0.0 }));
        // Parts of the source, and what of its area they are.
        const PARTS: usize = 6;
        let offset = |k: usize| (k as f64 + 0.5) / PARTS as f64;
        let places =
            (0..PARTS * PARTS).map(|k| [source[0] as f64 + offset(k % PARTS), source[1] as f64 + offset(k / PARTS)]);
        let parts: Vec<([f64; 3], f64)> =
            places.map(|place| (direction(place), (PI * place[1] / 128.0).sin())).collect();
        let whole: f64 = parts.iter().map(|(_, area)| area).sum();
        let area = Geometry::Equirectangular.solid_angle(size, source);
        for (at, value) in seen.iter().enumerate() {
            let to = middle([at % 256, at / 256]);
            let angle = apart(middle(source), to);
            if (15.0..60.0).contains(&angle) {
                let sent: f64 = parts.iter().map(|(from, area)| area * kernel.at(apart(*from, to))).sum();
                let wanted = area * sent / whole;
                assert!((f64::from(*value) / wanted - 1.0).abs() < 0.01, "{source:?} at {angle}: {value} for {wanted}");
            }
        }
    }
}
