//! The iris's transform, by the trapezium rule, which converges exponentially for a function that has no kink; and how fast it falls.
//!
//! Moving the path of integration off the real axis, by η towards k, divides the transform by e^{η|k|}, up to where a step has a pole: at
//! an exponent of iπ, which is η = πe of a polygon, and η√(1 + η²) = πe of a round one. What stands before that is fitted: the tests
//! hold it for all numbers of blades.

use std::f64::consts::{PI, TAU};
use std::sync::{Arc, PoisonError};

use glam::DVec2;
use ndarray::Array2;

use super::{Iris, NOTHING};
use crate::series::bell::{Bounded, Plane, Shape as _};
use crate::series::frequencies::{self, Spectrum};

/// Parts of all waves that it is worth to know alone.
const PARTS: [f64; 2] = [0.25, 0.5];

/// The transform of an iris up to z radians for each size: that of samples so far apart.
#[derive(Debug)]
pub(super) struct Waves {
    z: f64,
    step: f64,
    spectrum: Spectrum,
}

impl Iris {
    /// Values at points of a square lattice about the centre, row by row, and their distance: such that sums of them over waves no faster
    /// than z are integrals but for some 1e-13.
    pub(super) fn samples(&self, z: f64) -> (f64, Array2<f64>) {
        // What the rule is off by is the transform as far from 2π over the distance.
        let step = TAU / (z + NOTHING / self.fall());
        let half = (self.radius_of(NOTHING) / step).ceil();
        let places: Vec<f64> = (0..=2 * half as usize).map(|index| step * (index as f64 - half)).collect();
        let mut values = Array2::zeros((places.len(), places.len()));
        self.over(&places, &places, DVec2::ONE, &mut |row, of_row| {
            values.row_mut(row).iter_mut().zip(of_row).for_each(|(value, of_row)| *value = *of_row);
        });
        (step, values)
    }

    /// Their transform at waves up to z, or somewhat farther, or where that is less to z = NOTHING / η, beyond which there is none.
    fn waves(&self, z: f64) -> Arc<Waves> {
        let all = NOTHING / self.fall();
        let known = || self.0.waves.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(waves) = known().as_ref().filter(|waves| z <= waves.z || waves.z >= all) {
            return waves.clone();
        }
        // Nobody waits meanwhile: a core that waits for others may be given another ghost of the same iris.
        let z = PARTS.map(|part| part * all).into_iter().find(|&part| z <= part).unwrap_or(all);
        let (step, values) = self.samples(z);
        // The farther from the ends of a lattice, the closer is a transform: with so many zeros around to some 1e-14.
        let zeros = values.nrows() / 5;
        let place = |index: usize| index.checked_sub(zeros).filter(|index| *index < values.nrows());
        let value = |_, column, row| {
            let at = place(row).zip(place(column));
            at.map_or(0.0, |at| values[at])
        };
        let spectrum = Spectrum::new(1, [values.nrows() + 2 * zeros; 2], value);
        known().insert(Arc::new(Waves { z, step, spectrum })).clone()
    }

    /// η at the poles; that of the nearest.
    pub(super) fn fall(&self) -> f64 {
        let pole = PI * self.edge();
        let round = |radius: f64| {
            let pole = pole / radius;
            radius * (0.5 * ((1.0 + 4.0 * pole * pole).sqrt() - 1.0)).sqrt()
        };
        let opening = if self.is_round() { round(1.0) } else { pole };
        self.cuts().iter().map(|cut| round(cut.radius)).fold(opening, f64::min)
    }

    /// e^−ηz times a factor that blades have, and one of cuts, and a little more for each e-fold.
    fn falls(&self, z: f64, [factor, of_blades]: [f64; 2]) -> f64 {
        let folds = self.fall() * z.max(0.0);
        let cut = self.0.peak / self.0.whole_peak * (1.0 + self.cuts().len() as f64).powi(2);
        let factor = factor + of_blades * f64::from(self.blades()).powi(4);
        cut * factor * (1.0 + 0.05 * folds).powi(2) * (-folds).exp()
    }
}

impl Bounded for Iris {
    /// All of |ĝ| beyond z over 4π² is no more than (20 + 0.0013 n⁴) e^−ηz; modes stand for their cells, in which it may be as large as half
    /// a diagonal nearer, and of which a few may have its ridges.
    fn beyond(&self, z: f64, cell: f64) -> f64 {
        self.falls(z - 2.0 * cell, [40.0, 0.0026])
    }

    fn envelope(&self, z: f64) -> f64 {
        self.moments().area.min(self.falls(z, [10.0, 0.0006]))
    }

    /// The lattice's own values, once.
    fn preparation(&self) -> f64 {
        let side = 2.0 * self.radius_of(NOTHING) * (1.0 + PARTS[1]) * NOTHING / (TAU * self.fall());
        let steps = f64::from(self.blades()) + self.cuts().len() as f64;
        side * side * (10.0 + 8.0 * steps) + frequencies::work([(1.4 * side) as usize; 2]) / 3.0
    }
}

impl Plane for Iris {
    fn parts(&self, counts: &[u32], size: DVec2) -> Vec<[f64; 4]> {
        let most = counts.iter().max().map_or(0, |&count| count as usize);
        let fastest = DVec2::new(counts.len() as f64, most as f64) * TAU * size;
        let waves = self.waves(fastest.max_element());
        let Waves { step, spectrum, .. } = &*waves;
        let first = TAU * size * *step;
        // Of faster waves there is nothing.
        let within = |first: f64, harmonics: usize| harmonics.min((PI / first) as usize + 1);
        let harmonics = [within(first.x, counts.len()), within(first.y, most)];
        let waves = spectrum.waves(0, first.to_array(), harmonics);
        let scale = step * step * size.element_product();
        let modes = counts.iter().enumerate().flat_map(|(n, &count)| (0..count as usize).map(move |m| [n, m]));
        // Cosines of both, sines of both, and those of one.
        let [cc, sc, cs, ss] = &waves;
        let part = |at: [usize; 2]| match at[0] < harmonics[0] && at[1] < harmonics[1] {
            true => [cc, ss, cs, sc].map(|part| scale * part[at]),
            false => [0.0; 4],
        };
        modes.map(part).collect()
    }
}
