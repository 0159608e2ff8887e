//! The modes of the field, where the plan has computed them on its way.

use std::fmt;
use std::sync::Arc;

/// A, B, C and D of one mode (docs/math.md, "Many ghosts"), for each colour, in units of the field's scale; the mode's
/// weight κ is in them.
pub type Mode = [[f64; 4]; 3];

/// More modes than any evaluator needs, in f64: what the plan looked at becomes the spectrum.
#[derive(Clone)]
pub struct Modes {
    table: Arc<Table>,
}

struct Table {
    counts: Vec<u32>,
    modes: Vec<Mode>,
    milliseconds: f64,
}

impl Modes {
    /// Of `counts[n]` harmonics of y beside harmonic n of x, one row after the other.
    pub(super) fn new(counts: Vec<u32>, modes: Vec<Mode>, milliseconds: f64) -> Self {
        Self { table: Arc::new(Table { counts, modes, milliseconds }) }
    }

    /// How many harmonics of y there are beside each of x.
    pub(super) fn counts(&self) -> &[u32] {
        &self.table.counts
    }

    /// How long it took to compute them, by the wall clock: part of the spectrum's time, and no more than a report.
    pub fn milliseconds(&self) -> f64 {
        self.table.milliseconds
    }

    /// The modes of `counts[n]` harmonics of y beside harmonic n of x, one row after the other; zeros where there are
    /// more than were computed.
    pub fn kept(&self, counts: &[u32]) -> impl Iterator<Item = Mode> {
        let mut rest = &self.table.modes[..];
        let mut rows = self.table.counts.iter();
        counts.iter().flat_map(move |&kept| {
            let (row, others) = rest.split_at(rows.next().map_or(0, |&count| count as usize));
            rest = others;
            row.iter().copied().chain(std::iter::repeat([[0.0; 4]; 3])).take(kept as usize)
        })
    }
}

impl PartialEq for Modes {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.table, &other.table)
            || (self.table.counts == other.table.counts && self.table.modes == other.table.modes)
    }
}

impl fmt::Debug for Modes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} modes", self.table.modes.len())
    }
}
