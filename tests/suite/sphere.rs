//! Spherical harmonics: golden values, and the theorems that they must obey.

mod panorama;
mod turning;
mod values;

use glam::DVec3;
use vglare::series::sphere::Coefficients;

/// A reproducible sequence of numbers in −1..1.
fn noise(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
    move || {
        // Marsaglia's xorshift.
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / 2f64.powi(52) - 1.0
    }
}

/// Coefficients of about 1 each, the three colours unlike.
fn random(degree: usize, seed: u64) -> Coefficients {
    let mut next = noise(seed);
    let values = (0..(degree + 1).pow(2)).map(|_| [next(), next(), next()]).collect();
    Coefficients::new(degree, values)
}

/// Directions all over the sphere, both poles and places close to them among them.
fn directions(count: usize, seed: u64) -> Vec<DVec3> {
    let mut next = noise(seed);
    let mut result = vec![DVec3::Z, -DVec3::Z, DVec3::X, DVec3::new(1e-9, -2e-9, 1.0), DVec3::new(1e-4, 0.0, -1.0)];
    result.extend((0..count).map(|_| DVec3::new(next(), next(), next())));
    result.into_iter().map(DVec3::normalize).collect()
}
