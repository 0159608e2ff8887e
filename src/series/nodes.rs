//! Transforms of bells that end, read between nodes: nothing in them is faster than the radius that the bell ends at, so that
//! where many are asked for, few nodes hold all of them.

use rayon::prelude::*;

/// Nodes for each 1 of z times the radius, where a transform is read between nodes.
const NODES: f64 = 8.0;

/// How many nodes there are up to z.
pub(super) fn nodes(last: f64, radius: f64) -> f64 {
    NODES * radius * last
}

/// An even transform at each of these z ≥ 0, of a bell that ends at a radius: one by one, or where these are many between nodes.
pub(super) fn between_nodes(at: &[f64], radius: f64, transform: impl Fn(f64) -> f64 + Sync) -> Vec<f64> {
    let last = at.iter().copied().fold(0.0, f64::max);
    if nodes(last, radius) >= 0.5 * at.len() as f64 {
        return at.par_iter().map(|&z| transform(z)).collect();
    }
    let width = (NODES * radius).recip();
    // The transform is even, which is what the three nodes before 0 are for.
    let node = |i: usize| transform(width * (i as f64 - 3.0).abs());
    let nodes: Vec<f64> = (0..(last / width) as usize + 8).into_par_iter().map(node).collect();
    let read = |&z: &f64| {
        let place = z / width;
        let first = place as usize;
        nodes.get(first..first + 8).map_or_else(|| transform(z), |near| between(near, place.fract()))
    };
    at.par_iter().map(read).collect()
}

/// Lagrange's polynomial through eight values at −3, −2, … 4, at 0 ≤ t ≤ 1. Through waves of at most one
/// radian for `NODES` nodes it is off by 43.1/8! `NODES`⁻⁸ < 7e-11 of what its waves add up to.
fn between(near: &[f64], t: f64) -> f64 {
    // What Π_{j≠k} (k − j) is for each node.
    const BELOW: [f64; 8] = [-5040.0, 720.0, -240.0, 144.0, -144.0, 240.0, -720.0, 5040.0];
    let away: [f64; 8] = std::array::from_fn(|k| t + 3.0 - k as f64);
    let others = |k: usize| (0..8).filter(|&j| j != k).map(|j| away[j]).product::<f64>();
    near.iter().zip(BELOW).enumerate().map(|(k, (value, below))| value * others(k) / below).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wave_as_fast_as_the_radius_is_read_between_nodes() {
        for i in 0..800 {
            let z = 0.01 * f64::from(i);
            let node = |k: i32| ((NODES * z).floor() + f64::from(k - 3)) / NODES;
            let near: Vec<f64> = (0..8).map(|k| node(k).cos()).collect();
            let off = (between(&near, (NODES * z).fract()) - z.cos()).abs();
            assert!(off < 7e-11, "{z}: {off:e}");
        }
    }
}
