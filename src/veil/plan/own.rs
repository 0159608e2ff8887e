//! What the layers realise at the source itself, where nothing is wanted.

use super::Placed;
use super::lattice::Lattice;

/// Columns and rows after which the table repeats: lattices of a larger pitch enter it by their mean.
pub(crate) const PERIOD: usize = 16;

/// The realised kernel at offset 0.
#[derive(Debug, Clone)]
pub(crate) struct Own {
    /// By the lower bits of a pixel's row and column.
    pub table: Vec<[f64; PERIOD]>,
    /// The largest it is anywhere.
    pub largest: f64,
    /// By how much the table can be wrong, for lattices of a larger pitch than it repeats.
    pub spread: f64,
}

/// Of one Gaussian along one dimension, by the phase.
#[derive(Debug, Clone)]
struct Term {
    weight: f64,
    by_phase: Vec<f64>,
}

impl Term {
    fn along(&self, pixel: usize) -> f64 {
        self.by_phase[pixel % self.by_phase.len()]
    }

    /// The least and the largest.
    fn range(&self) -> [f64; 2] {
        self.by_phase.iter().fold([f64::INFINITY, 0.0], |[low, high], value| [low.min(*value), high.max(*value)])
    }
}

impl Own {
    pub fn new(placed: impl IntoIterator<Item = Placed>, constant: f64) -> Self {
        let term = |placed: Placed| {
            let lattice = Lattice { pitch: placed.pitch, kernel: &placed.half };
            let by_phase = if placed.pitch == 1 {
                vec![placed.half[0]]
            } else {
                (0..placed.pitch).map(|phase| lattice.realised(phase, 0)).collect()
            };
            Term { weight: placed.weight, by_phase }
        };
        let terms: Vec<Term> = placed.into_iter().map(term).collect();
        let fine = |term: &&Term| term.by_phase.len() <= PERIOD;
        let (mut middle, mut spread) = (constant, 0.0);
        for term in terms.iter().filter(|term| !fine(term)) {
            let [low, high] = term.range();
            middle += 0.5 * term.weight * (high * high + low * low);
            spread += 0.5 * term.weight * (high * high - low * low);
        }
        let entry = |x: usize, y: usize| {
            middle + terms.iter().filter(fine).map(|term| term.weight * term.along(x) * term.along(y)).sum::<f64>()
        };
        let table = (0..PERIOD).map(|y| std::array::from_fn(|x| entry(x, y))).collect();
        let largest = constant + terms.iter().map(|term| term.weight * term.range()[1].powi(2)).sum::<f64>();
        Self { table, largest, spread }
    }
}
