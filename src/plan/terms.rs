//! Which terms of the series each group of ghosts needs.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use glam::DVec2;

use super::weigh::Weighed;
use super::{HIGHEST_DEGREE, periodised_peak};
use crate::scene::Ghost;
use crate::series::Bell;
use crate::{Error, Result};

/// Ghosts of one bell and like sizes: one degree, one dispatch.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Group {
    /// The bell.
    pub bell: Bell,
    /// Its ghosts, as indices into the list that was planned for.
    #[serde(skip)]
    pub members: Vec<u32>,
    /// How many there are.
    pub ghosts: usize,
    /// The smallest size in x and in y among them.
    pub smallest: DVec2,
    /// The sum of their peaks, in units of the field's scale.
    pub weight: f64,
    /// Highest harmonic in x and y that they add to.
    pub degree: [u32; 2],
}

/// Groups the ghosts that are not dropped: sizes within half an octave share a group.
pub(super) fn group(ghosts: &[Ghost], weighed: &Weighed) -> Vec<Group> {
    let mut groups: BTreeMap<(&str, [i32; 2]), Group> = BTreeMap::new();
    for ((index, ghost), &weight) in (0..).zip(ghosts).zip(&weighed.weights).filter(|(_, weight)| **weight > 0.0) {
        let half_octave = |size: f64| (2.0 * size.log2()).floor() as i32;
        let key = (ghost.bell.shape().name(), [half_octave(ghost.size.x), half_octave(ghost.size.y)]);
        let group = groups.entry(key).or_insert_with(|| Group {
            bell: ghost.bell,
            members: Vec::new(),
            ghosts: 0,
            smallest: ghost.size,
            weight: 0.0,
            degree: [0; 2],
        });
        group.members.push(index);
        group.ghosts += 1;
        group.smallest = group.smallest.min(ghost.size);
        group.weight += weight;
    }
    groups.into_values().collect()
}

/// The whole rectangle of modes for every group: the prototype's choice, and that of a degree given by hand.
pub(super) fn rectangle(groups: &mut [Group], degree: [u32; 2]) -> Vec<u32> {
    for group in groups {
        group.degree = degree;
    }
    vec![degree[1] + 1; degree[0] as usize + 1]
}

/// An ellipse of modes for each group, just large enough for its part of the budget; what is kept is their union.
///
/// # Errors
/// [`Error::Plan`] where a bell is so narrow that a degree beyond [`HIGHEST_DEGREE`] would be needed.
pub(super) fn ellipses(groups: &mut [Group], period: DVec2, budget: f64) -> Result<Vec<u32>> {
    let part = budget / groups.len().max(1) as f64;
    let mut union = vec![1];
    for group in groups {
        let counts = ellipse_within(group, period, part / group.weight)?;
        if union.len() < counts.len() {
            union.resize(counts.len(), 1);
        }
        for (kept, count) in union.iter_mut().zip(&counts) {
            *kept = (*kept).max(*count);
        }
        group.degree = [counts.len() as u32 - 1, counts[0] - 1];
    }
    Ok(union)
}

/// The smallest ellipse whose tail, for a bell of peak 1, is at most `error`.
fn ellipse_within(group: &Group, period: DVec2, error: f64) -> Result<Vec<u32>> {
    if error >= 1.0 {
        return Ok(vec![1]);
    }
    let size = group.smallest / period;
    // For a Gaussian exp(−R²/2) is what lies beyond an ellipse of R "sigmas" of the spectrum; the bisection makes it
    // exact, also where the lattice of modes is coarse.
    let radius = (2.0 * (1.0 / error).ln()).sqrt();
    let widest = 1.2 * radius + 2.0 * TAU * size.max_element();
    let reach = (widest / (TAU * size)).ceil().max_element();
    if reach > f64::from(HIGHEST_DEGREE) {
        return Err(Error::Plan(format!(
            "ghosts of size {:.2e} would need a degree of about {reach:.0}, and {HIGHEST_DEGREE} is the highest; \
             --evaluator direct has no degree",
            group.smallest.min_element()
        )));
    }
    let tails = Tails::new(group.bell, size, [reach as u32; 2]);
    let (mut low, mut high) = (0.0, widest);
    for _ in 0..14 {
        let middle = 0.5 * (low + high);
        if tails.beyond(&ellipse(size, middle)) > error { low = middle } else { high = middle }
    }
    Ok(ellipse(size, high))
}

/// Modes within an ellipse of `radius` "sigmas" of the spectrum of a Gaussian of `size` periods.
fn ellipse(size: DVec2, radius: f64) -> Vec<u32> {
    let axes = radius / (TAU * size);
    let rows = axes.x.floor() as u32;
    (0..=rows)
        .map(|n| {
            let across = 1.0 - (f64::from(n) / axes.x.max(f64::MIN_POSITIVE)).powi(2);
            (axes.y * across.max(0.0).sqrt()).floor() as u32 + 1
        })
        .collect()
}

/// What a bell of one size has beyond each harmonic.
struct Tails {
    coefficients_x: Vec<f64>,
    tails_x: Vec<f64>,
    tails_y: Vec<f64>,
    peak_y: f64,
}

impl Tails {
    fn new(bell: Bell, size: DVec2, highest: [u32; 2]) -> Self {
        let shape = bell.shape();
        let doubled = |n: u32| if n == 0 { 1.0 } else { 2.0 };
        Self {
            coefficients_x: (0..=highest[0]).map(|n| doubled(n) * shape.coefficient(n, size.x)).collect(),
            tails_x: shape.tails(highest[0], size.x),
            tails_y: shape.tails(highest[1], size.y),
            peak_y: periodised_peak(bell, size.y),
        }
    }

    /// The sum of all coefficients outside the kept modes: the largest error, reached at the bell's centre.
    ///
    /// It falls as either size grows, for any set of modes whose rows get no longer with n: written as a sum over n,
    /// each term is a tail in y, which falls with σy, and by summation by parts the whole is a sum of tails in x.
    /// So the smallest sizes of a group stand for all of it.
    fn beyond(&self, counts: &[u32]) -> f64 {
        let rows = self.coefficients_x.iter().zip(counts);
        let within: f64 = rows.map(|(x, &count)| x * self.tails_y[count as usize - 1]).sum();
        within + self.tails_x[counts.len() - 1] * self.peak_y
    }
}

/// A bound of what the kept modes leave out at any pixel.
pub(super) fn error(groups: &[Group], period: DVec2, counts: &[u32]) -> f64 {
    let one = |group: &Group| {
        let mine: Vec<u32> =
            counts.iter().take(group.degree[0] as usize + 1).map(|&count| count.min(group.degree[1] + 1)).collect();
        let highest = [group.degree[0], group.degree[1]];
        group.weight * Tails::new(group.bell, group.smallest / period, highest).beyond(&mine)
    };
    groups.iter().map(one).sum()
}
