//! Quadrature by the rule of Gauss and Legendre.

use std::sync::LazyLock;

use glam::DVec2;

use crate::series::sphere::gauss_legendre;

/// Nodes that a rule has at most.
const MOST: usize = 48;

/// Of each number of nodes.
static RULES: LazyLock<Vec<Vec<(f64, f64)>>> = LazyLock::new(|| (1..=MOST).map(gauss_legendre).collect());

/// Nodes and weights of an interval.
pub fn nodes(count: usize, from: f64, to: f64) -> impl Iterator<Item = (f64, f64)> {
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    RULES[count.clamp(1, MOST) - 1].iter().map(move |(node, weight)| (middle + half * node, half * weight))
}

/// ∫ f between two places.
pub fn integral(count: usize, from: f64, to: f64, f: impl Fn(f64) -> f64) -> f64 {
    nodes(count, from, to).map(|(at, weight)| weight * f(at)).sum()
}

/// ∫∫ f over a rectangle.
pub fn over(count: usize, low: DVec2, high: DVec2, f: impl Fn(DVec2) -> f64) -> f64 {
    integral(count, low.x, high.x, |x| integral(count, low.y, high.y, |y| f(DVec2::new(x, y))))
}
