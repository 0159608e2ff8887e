//! Which terms of the series each group of ghosts needs.

use std::sync::Arc;

use glam::DVec2;
use rayon::prelude::*;

use super::decay::Decay;
use super::effort::Effort;
use super::gather::Transform;
use super::slots::{Slots, by_chunks};
use crate::Result;
use crate::scene::Ghost;
use crate::series::Bell;

/// Ghosts of one bell and like sizes: one degree, one dispatch.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Group {
    /// The bell.
    pub bell: Bell,
    /// Its ghosts, as indices into the list that was planned for.
    #[serde(skip)]
    pub members: Arc<Vec<u32>>,
    /// How many there are.
    pub ghosts: usize,
    /// The smallest size in x and in y among them.
    pub smallest: DVec2,
    /// The largest.
    pub largest: DVec2,
    /// Whether all of them have the ratio of axes that the smallest has.
    #[serde(skip)]
    pub proportional: bool,
    /// The sum of their peaks, in units of the field's scale.
    pub weight: f64,
    /// Highest harmonic in x and y that they add to.
    pub degree: [u32; 2],
    /// How its spectrum comes about.
    pub transform: Transform,
}

/// Groups the ghosts that are not dropped: sizes within half an octave, or less where there are many, share a group, or equal sizes where
/// the bell's coefficients come from a table.
pub(super) fn group(ghosts: &[Ghost], weights: &[f64]) -> Vec<Group> {
    let steps = if ghosts.len() < MANY { FEW_STEPS } else { MANY_STEPS };
    let chunks = by_chunks(ghosts, weights, |ghosts| {
        let (mut slots, mut groups) = (Slots::new(), Vec::<(Group, Vec<u32>)>::new());
        for (index, ghost, weight) in ghosts {
            let slot = slots.slot(&ghost.bell, key(&ghost.bell, ghost.size, steps));
            if slot == groups.len() {
                groups.push((Group::new(&ghost.bell, ghost.size), Vec::new()));
            }
            let (group, members) = &mut groups[slot];
            group.add(ghost.size, weight);
            members.push(index);
        }
        groups
    });
    let (mut slots, mut groups) = (Slots::new(), Vec::<(Group, Vec<u32>)>::new());
    for (group, members) in chunks.iter().flatten() {
        let slot = slots.slot(&group.bell, key(&group.bell, group.smallest, steps));
        match groups.get_mut(slot) {
            Some((joined, others)) => {
                joined.join(group);
                others.extend(members);
            }
            None => groups.push((group.clone(), members.clone())),
        }
    }
    groups.into_iter().map(|(group, members)| Group { members: Arc::new(members), ..group }).collect()
}

impl Group {
    /// Whether its ghosts are those of a photo's pixels.
    pub fn is_of_photo(&self) -> bool {
        matches!(self.transform, Transform::Photo(_))
    }

    /// How many of the kept modes of y it adds to beside each harmonic of x.
    pub(crate) fn counts(&self, kept: &[u32]) -> Vec<u32> {
        let [n, m] = self.degree;
        kept.iter().take(n as usize + 1).map(|&count| count.min(m + 1)).collect()
    }

    fn new(bell: &Bell, size: DVec2) -> Self {
        Self {
            bell: bell.clone(),
            members: Arc::default(),
            ghosts: 0,
            smallest: size,
            largest: size,
            proportional: true,
            weight: 0.0,
            degree: [0; 2],
            transform: Transform::Dispatch,
        }
    }

    /// A single one, by its number, that is summed itself.
    pub(super) fn of_one(ghost: &Ghost, member: u32, weight: f64) -> Self {
        let mut group = Self::new(&ghost.bell, ghost.size);
        group.add(ghost.size, weight);
        Self { members: Arc::new(vec![member]), transform: Transform::Direct, ..group }
    }

    fn add(&mut self, size: DVec2, weight: f64) {
        self.ghosts += 1;
        self.proportional &= alike(size, self.smallest);
        self.smallest = self.smallest.min(size);
        self.largest = self.largest.max(size);
        self.weight += weight;
    }

    fn join(&mut self, other: &Self) {
        self.ghosts += other.ghosts;
        self.proportional &= other.proportional && alike(other.smallest, self.smallest);
        self.smallest = self.smallest.min(other.smallest);
        self.largest = self.largest.max(other.largest);
        self.weight += other.weight;
    }
}

/// Whether the axes of two sizes have one ratio, but for what comes of computing it.
fn alike(a: DVec2, b: DVec2) -> bool {
    (a.x * b.y - a.y * b.x).abs() <= 1e-14 * a.x * b.y
}

/// Ghosts from which groups are of closer sizes: the closer they are, the fewer sizes stand for all of them where they are gathered.
const MANY: usize = 50_000;
/// Groups an octave, of few ghosts and of many.
const FEW_STEPS: i32 = 2;
const MANY_STEPS: i32 = 8;

/// What the ghosts of a group have in common, of so many groups an octave.
fn key(bell: &Bell, size: DVec2, steps: i32) -> [i64; 2] {
    let tabulated = bell.shape().tabulated();
    size.to_array().map(|size| if tabulated { size.to_bits() as i64 } else { step(size, steps) })
}

/// ⌊steps log2 x⌋, and a constant, for a positive normal number: by its exponent, and by that of a power of the rest.
fn step(x: f64, steps: i32) -> i64 {
    let exponent = |x: f64| (x.to_bits() >> 52) as i64;
    let mantissa = f64::from_bits(x.to_bits() & (u64::MAX >> 12) | 1f64.to_bits());
    i64::from(steps) * exponent(x) + exponent(mantissa.powi(steps))
}

/// The whole rectangle of modes for every group: the prototype's choice, and that of a degree given by hand.
pub(super) fn rectangle(groups: &mut [Group], degree: [u32; 2]) -> Vec<u32> {
    for group in groups {
        group.degree = degree;
    }
    vec![degree[1] + 1; degree[0] as usize + 1]
}

/// How many harmonics kept modes have along either axis.
pub(super) fn harmonics(counts: &[u32]) -> [f64; 2] {
    [counts.len() as f64, f64::from(counts[0])]
}

/// Groups that are looked at together, before anyone asks whether that is still worth it.
const AT_ONCE: usize = 32;

/// The modes of each group that are just enough for its part of the budget; what is kept is their union.
///
/// # Errors
/// [`Error::Plan`](crate::Error::Plan) where a bell is so narrow or so sharp that it would need too high a degree, or
/// where looking for it costs too much.
pub(super) fn fewest(groups: &mut [Group], period: DVec2, budget: f64, effort: &Effort) -> Result<Vec<u32>> {
    let part = budget / groups.len().max(1) as f64;
    let mut union = vec![1];
    for groups in groups.chunks_mut(AT_ONCE) {
        let expected = |group: &Group| Decay::new(group, period).expected_work(part / group.weight);
        effort.expect(groups.iter().map(expected).sum())?;
        let kept = |group: &Group| Decay::new(group, period).kept(part / group.weight);
        let kept: Vec<Result<Vec<u32>>> = groups.par_iter().map(kept).collect();
        for (group, counts) in groups.iter_mut().zip(kept) {
            let counts = counts?;
            effort.spend(Decay::new(group, period).work(harmonics(&counts)))?;
            if union.len() < counts.len() {
                union.resize(counts.len(), 1);
            }
            for (kept, count) in union.iter_mut().zip(&counts) {
                *kept = (*kept).max(*count);
            }
            group.degree = [counts.len() as u32 - 1, counts[0] - 1];
        }
    }
    Ok(union)
}

/// A bound of what the kept modes leave out at any pixel.
pub(super) fn error(groups: &[Group], period: DVec2, counts: &[u32]) -> f64 {
    groups.iter().map(|group| group.weight * Decay::new(group, period).beyond(&group.counts(counts))).sum()
}
