//! Ghosts sorted into a few slots, in chunks on all cores.

use std::hash::Hash;

use rayon::prelude::*;
use rustc_hash::FxHashMap;

use crate::scene::Ghost;
use crate::series::{Bell, Distinct};

/// Ghosts that one task goes through. The chunks are joined in their order, so that a plan does not depend on how many
/// cores there are.
const CHUNK: usize = 4096;

/// Numbers for pairs of bell and key, in the order in which they first come.
pub(super) struct Slots<'a, K> {
    bells: Distinct<'a>,
    places: FxHashMap<(usize, K), usize>,
    /// The last pair that was asked for, and its number: often the next one too.
    last: Option<((usize, K), usize)>,
}

impl<'a, K: Hash + Eq + Copy> Slots<'a, K> {
    pub fn new() -> Self {
        Self { bells: Distinct::new(), places: FxHashMap::default(), last: None }
    }

    /// The pair's number, one more than the last where it is new.
    pub fn slot(&mut self, bell: &'a Bell, key: K) -> usize {
        let (bell, _) = self.bells.number(bell);
        let pair = (bell, key);
        if let Some((last, slot)) = self.last
            && last == pair
        {
            return slot;
        }
        let next = self.places.len();
        let slot = *self.places.entry(pair).or_insert(next);
        self.last = Some((pair, slot));
        slot
    }
}

/// What `work` makes of each chunk of the ghosts that are kept, with their indices and weights; chunk by chunk.
pub(super) fn by_chunks<T: Send>(
    ghosts: &[Ghost],
    weights: &[f64],
    work: impl Fn(&mut dyn Iterator<Item = (u32, &Ghost, f64)>) -> T + Sync,
) -> Vec<T> {
    let chunks = ghosts.par_chunks(CHUNK).zip(weights.par_chunks(CHUNK)).enumerate();
    chunks
        .map(|(chunk, (ghosts, weights))| {
            let first = (chunk * CHUNK) as u32;
            let all = (first..).zip(ghosts).zip(weights).map(|((index, ghost), &weight)| (index, ghost, weight));
            work(&mut all.filter(|(_, _, weight)| *weight > 0.0))
        })
        .collect()
}
