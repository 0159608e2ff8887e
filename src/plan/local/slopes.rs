//! Bells by tables, which are upper bounds: a map asks for some dozen values of each ghost.

use crate::plan::direct::per_offset;
use crate::plan::weigh::along;
use crate::series::{Bell, Modes, Shape};

/// Entries of a table, and the distance of the last of a bell that does not end, in sizes: exp(−128) is as good as nothing.
const ENTRIES: usize = 1024;
const FARTHEST: f64 = 16.0;

/// What of a bell decides how much f32 is off.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// A Gaussian: its exponent has the offset's rounding.
    Exponential,
    Product,
    /// No product, and bounded by the radius alone.
    Radial,
    Periodic,
}

/// A bell along an axis.
pub(super) struct Slopes<'a> {
    pub bell: &'a Bell,
    pub shape: &'a dyn Shape,
    pub kind: Kind,
    pub ends: f64,
    pub jump: f64,
    /// What an offset's rounding shifts it by, for each unit of the offset.
    pub per_offset: f64,
    /// Entries for each unit of the distance.
    scale: f64,
    /// What it is and how steep it is, at most, from each entry on.
    entries: Vec<[f64; 2]>,
}

impl<'a> Slopes<'a> {
    pub fn new(bell: &'a Bell) -> Self {
        let shape = bell.shape();
        let kind = match bell {
            Bell::Gaussian => Kind::Exponential,
            Bell::VonMises(_) | Bell::SineGaussian(_) => Kind::Periodic,
            bell if matches!(bell.shape().modes(), Modes::Product(_)) => Kind::Product,
            _ => Kind::Radial,
        };
        let (ends, scale) = (shape.ends(), ENTRIES as f64 / shape.ends().min(FARTHEST));
        let entry = |k: usize| {
            let distance = k as f64 / scale;
            [if kind == Kind::Periodic { 1.0 } else { along(shape, distance) }, shape.steepest(distance)]
        };
        let last = if ends.is_finite() { [0.0; 2] } else { entry(ENTRIES) };
        let entries = (0..ENTRIES).map(entry).chain([last]).collect();
        Self { bell, shape, kind, ends, jump: shape.jump(), per_offset: per_offset(bell), scale, entries }
    }

    /// What it is and how steep it is, at most, at a distance ≥ 0 or farther.
    pub fn at(&self, distance: f64) -> [f64; 2] {
        // A bell that ends may still be something right there.
        let distance = if distance > self.ends { f64::INFINITY } else { distance.min(self.ends * (1.0 - 1e-9)) };
        self.entries[((distance * self.scale) as usize).min(ENTRIES)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_are_bounds_and_close() {
        for bell in Bell::examples() {
            let slopes = Slopes::new(&bell);
            if slopes.kind == Kind::Periodic {
                assert_eq!(slopes.at(3.0)[0], 1.0);
                continue;
            }
            for k in 0..3000 {
                let distance = 0.003 * f64::from(k);
                let [value, steepest] = slopes.at(distance);
                let exact = slopes.shape.along(distance, 1.0);
                assert!(value >= exact && steepest >= slopes.shape.steepest(distance), "{bell} at {distance}");
                assert!(
                    value <= 1.2 * exact + 0.02 || exact == 0.0 && distance >= slopes.ends,
                    "{bell} at {distance}: {value} {exact}"
                );
            }
        }
    }
}
