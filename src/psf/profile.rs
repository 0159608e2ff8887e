//! A function by rows: what plots and tables are made of.

use super::{Fault, Mixture, Psf};

/// A function at an angle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Row {
    /// Angle or radius, in the function's unit.
    pub angle: f64,
    /// k, per steradian or squared unit.
    pub value: f64,
    /// The mixture there.
    pub mixture: f64,
    /// mixture / k − 1; no number where k is 0.
    pub error: f64,
    /// The energy within the angle, over all of it.
    pub encircled: f64,
}

/// A function at a frequency.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mode {
    /// Cycles per degree or unit.
    pub frequency: f64,
    /// The transform there, in the measure of the energy.
    pub transform: f64,
}

/// A function and its mixture over a range of angles, and the transform over the frequencies that belong to them.
#[derive(Debug, Clone, PartialEq)]
pub struct Profile {
    /// By angle, even in its logarithm.
    pub rows: Vec<Row>,
    /// By frequency, even in its logarithm: from 1/2θ of the largest angle to that of the smallest.
    pub modes: Vec<Mode>,
}

impl Psf {
    /// The function at `count` angles over `range`, beside `mixture`, and its transform at as many frequencies; for
    /// `kernel`, which has no mixture, that column is no number.
    ///
    /// # Errors
    /// On a range that is none, or a count that is not from 2 to 10 000.
    pub fn profile(&self, range: [f64; 2], mixture: Option<&Mixture>, count: usize) -> Result<Profile, Fault> {
        let ([from, to], _) = super::fit::checked(range, 0.1)?;
        if !(2..=10_000).contains(&count) {
            return Err(Fault::new("count", format!("there are from 2 to 10000 rows, and not {count}")));
        }
        let angle = |i: usize| from * (to / from).powf(i as f64 / (count - 1) as f64);
        let rows = (0..count).map(angle).map(|angle| {
            let value = self.value(angle);
            let mixture = mixture.map_or(f64::NAN, |mixture| mixture.value(angle));
            Row {
                angle,
                value,
                mixture,
                error: if value == 0.0 { f64::NAN } else { mixture / value - 1.0 },
                encircled: self.energy_within(angle) / self.energy,
            }
        });
        let modes = (0..count)
            .rev()
            .map(|i| 0.5 / angle(i))
            .map(|frequency| Mode { frequency, transform: self.transform(frequency) });
        Ok(Profile { rows: rows.collect(), modes: modes.collect() })
    }
}
