//! What a plan promises: a bound of the error, source by source.

/// Upper bounds of the error, by source; relative to the field's largest value, like the tolerance.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize)]
pub struct Prediction {
    /// Ghosts that are left out.
    pub dropped: f64,
    /// Bells where they are left out, by `local`.
    pub cut: f64,
    /// Copies of the bells, a period away.
    pub periodisation: f64,
    /// Harmonics that are left out.
    pub truncation: f64,
    /// Between the lattice's nodes.
    pub interpolation: f64,
    /// Moments of cells that are left out.
    pub gathering: f64,
    /// Floats while they compute: phases, products, sums.
    pub rounding: f64,
    /// f32 as the format in which passes leave their results to each other: spectrum, tables, lattice; or, where they leave
    /// doubles, as that of the field.
    pub storage: f64,
}

impl Prediction {
    /// All of it.
    pub fn total(&self) -> f64 {
        self.dropped
            + self.cut
            + self.periodisation
            + self.truncation
            + self.interpolation
            + self.gathering
            + self.single()
    }

    /// The same, but for what floats cost in all, some of which is storage.
    pub(super) fn with_single(self, single: f64) -> Self {
        let storage = self.storage.min(0.5 * single);
        Self { storage, rounding: single - storage, ..self }
    }

    /// What floats cost in all.
    pub fn single(&self) -> f64 {
        self.rounding + self.storage
    }
}

/// One source of error, as a prediction has it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Source {
    /// One word for it.
    pub name: &'static str,
    /// What the error comes from, in some words.
    pub about: &'static str,
    /// What it costs at most, relative to the largest glare of the same colour.
    pub error: f64,
}

impl Prediction {
    /// Every source with its error, in the order in which the data meets them.
    pub fn sources(&self) -> impl Iterator<Item = Source> + use<> {
        let &Self { dropped, cut, periodisation, truncation, interpolation, gathering, rounding, storage } = self;
        let sources = [
            ("dropped", "ghosts left out", dropped),
            ("cut", "bells beyond their reach", cut),
            ("periodisation", "wrapped copies", periodisation),
            ("truncation", "harmonics left out", truncation),
            ("interpolation", "looking up between the lattice's nodes", interpolation),
            ("gathering", "moments left out", gathering),
            ("rounding", "floats while they compute", rounding),
            ("storage", "keeping results as 32-bit floats", storage),
        ];
        sources.into_iter().map(|(name, about, error)| Source { name, about, error })
    }
}
