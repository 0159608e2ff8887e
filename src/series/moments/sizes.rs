//! Gaussians of many sizes as those of a few.
//!
//! As a function of w = 1/σ² a Gaussian is e^(−qw), where q ≥ 0 is the place. By the polynomial that meets it at the r nodes
//! of Chebyshev between the least and the largest w, a and b, it is off by at most max |f⁽ʳ⁾| / r! · 2 ((b − a) / 4)ʳ; and
//! qʳ e^(−qw) is at most (r / ea)ʳ, whatever the place, so that with Stirling's r! ≥ √(2πr) (r/e)ʳ no Gaussian is off by more
//! than
//!
//! ```text
//! 2 ((b/a − 1) / 4)^r / √(2πr)
//! ```
//!
//! Nor is it by more than 4 ρ^(1−r) / (ρ − 1), where ρ is the sum of the half axes of the ellipse, in units of (b − a)/2, that has
//! its foci in a and b and touches 0, since in the half plane beyond 0 no Gaussian is more than 1 (L. N. Trefethen,
//! *Approximation Theory and Approximation Practice*, theorem 8.2); which is less for many nodes.
//!
//! So a ghost is as good as r ghosts, one of each of r sizes, its weight times Lagrange's polynomials at its own size.

use std::f64::consts::{PI, TAU};

use glam::DVec2;

/// Sizes between which others are interpolated; all of them have the ratio of the smallest one's axes.
#[derive(Debug, Clone)]
pub struct Sizes {
    smallest: DVec2,
    /// w at each node, and its barycentric weight.
    nodes: Vec<[f64; 2]>,
}

impl Sizes {
    /// So many sizes for all from one to the other, in any unit.
    pub fn new(smallest: DVec2, largest: DVec2, count: u32) -> Self {
        let [high, low] = [smallest, largest].map(|size| 1.0 / (size.x * size.x));
        let node = |k: u32| {
            let (sin, cos) = (PI * (f64::from(k) + 0.5) / f64::from(count)).sin_cos();
            let sign = if k.is_multiple_of(2) { 1.0 } else { -1.0 };
            [0.5 * (low + high) + 0.5 * (high - low) * cos, sign * sin]
        };
        Self { smallest, nodes: (0..count).map(node).collect() }
    }

    /// The sizes.
    pub fn sizes(&self) -> impl Iterator<Item = DVec2> {
        let alone = self.nodes.len() == 1;
        let size = move |&[w, _]: &[f64; 2]| if alone { 1.0 } else { 1.0 / (w.sqrt() * self.smallest.x) };
        self.nodes.iter().map(move |node| self.smallest * size(node))
    }

    /// What a ghost of a size counts for at each of them, in their order: Lagrange's polynomials, in the barycentric form.
    pub fn weights(&self, size: DVec2) -> impl Iterator<Item = f64> {
        let w = 1.0 / (size.x * size.x);
        let one = self.nodes.len() == 1;
        let met = self.nodes.iter().position(|[node, _]| *node == w).or(one.then_some(0));
        let sum: f64 = self.nodes.iter().map(|[node, weight]| weight / (w - node)).sum();
        self.nodes.iter().enumerate().map(move |(k, [node, weight])| match met {
            Some(met) => f64::from(u8::from(met == k)),
            None => weight / (w - node) / sum,
        })
    }

    /// A bound of what the weights of a ghost add up to, without their signs: Lebesgue's constant (Trefethen, theorem 15.2, for
    /// these nodes too).
    pub fn gain(count: u32) -> f64 {
        if count == 1 { 1.0 } else { 1.0 + 2.0 / PI * f64::from(count).ln() }
    }
}

/// The fewest sizes that stand for all from one to the other with no Gaussian of peak 1 off by more than `error`, and by how
/// much the worst of them is; none where they are too far apart for the bound.
pub fn sizes_within(smallest: DVec2, largest: DVec2, error: f64) -> Option<(u32, f64)> {
    const MOST: u32 = 40;
    if smallest == largest {
        return Some((1, 0.0));
    }
    let ratio = (largest.x / smallest.x).powi(2);
    let center = (ratio + 1.0) / (ratio - 1.0);
    let rho = center + (center * center - 1.0).sqrt();
    let off = |count: u32| {
        let count = f64::from(count);
        let by_slope = 2.0 * (0.25 * (ratio - 1.0)).powf(count) / (TAU * count).sqrt();
        by_slope.min(4.0 * rho.powf(1.0 - count) / (rho - 1.0))
    };
    (2..MOST).map(|count| (count, off(count))).find(|(_, off)| *off <= error)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gaussian_is_as_good_as_a_few_of_other_sizes() {
        let (smallest, largest) = (DVec2::new(0.1, 0.07), DVec2::new(0.14, 0.098));
        for count in [2, 3, 5, 8, 12] {
            let sizes = Sizes::new(smallest, largest, count);
            let bound = (1..400).map(|k| 10f64.powf(-0.04 * f64::from(k))).filter_map(|error| {
                sizes_within(smallest, largest, error).filter(|(needed, _)| *needed == count).map(|(_, off)| off)
            });
            let bound = bound.fold(0.0, f64::max);
            let mut worst = 0.0f64;
            for k in 0..=50 {
                let size = smallest.lerp(largest, f64::from(k) / 50.0);
                let weights: Vec<f64> = sizes.weights(size).collect();
                assert!(weights.iter().map(|weight| weight.abs()).sum::<f64>() <= Sizes::gain(count) + 1e-12);
                for place in 0..200 {
                    let offset = DVec2::new(0.005, 0.003) * f64::from(place);
                    let value = |size: DVec2| (-0.5 * (offset / size).length_squared()).exp();
                    let interpolated: f64 =
                        sizes.sizes().zip(&weights).map(|(size, weight)| weight * value(size)).sum();
                    worst = worst.max((interpolated - value(size)).abs());
                }
            }
            assert!(worst <= bound + 1e-14 && worst > 0.02 * bound, "{count}: {worst:.1e} of {bound:.1e}");
        }
    }

    #[test]
    fn one_size_is_itself() {
        let size = DVec2::new(0.3, 0.2);
        assert_eq!(sizes_within(size, size, 0.0), Some((1, 0.0)));
        let sizes = Sizes::new(size, size, 1);
        assert_eq!(sizes.sizes().collect::<Vec<_>>(), [size]);
        assert_eq!(sizes.weights(size).collect::<Vec<_>>(), [1.0]);
    }
}
