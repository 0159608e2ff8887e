//! Bells and their Fourier series, in f64.

/// The kinds of bell, by the name that scene files use.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Bell {
    /// exp(−x²/2σx² − y²/2σy²).
    Gaussian,
}
