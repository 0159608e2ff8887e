//! The bells of the experiment: the notes', and what they were meant to be.

use std::f64::consts::TAU;

use crate::series::numeric::{Coefficients, Rule, sine_gaussian};

/// The period of every bell here.
pub(in crate::laboratory::rex) const PERIOD: f64 = TAU;

/// One bell: its mean μ and its weight.
pub(in crate::laboratory::rex) type Bell = [f64; 2];

/// Which function of x and μ a bell is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::laboratory::rex) enum Kind {
    /// exp(−(sin x − μ)²/2σ²), the notes'.
    Sine,
    /// exp(κ (cos(x − μ) − 1)), κ = 1/σ²: one lobe in a period, which μ moves along.
    VonMises,
}

/// Bells of one kind and size.
#[derive(Debug, Clone)]
pub(in crate::laboratory::rex) struct Bells {
    pub kind: Kind,
    pub sigma: f64,
    pub bells: Vec<Bell>,
}

impl Bells {
    /// One bell at `x`, its weight included.
    pub fn one(&self, [mean, weight]: Bell, x: f64) -> f64 {
        weight
            * match self.kind {
                Kind::Sine => sine_gaussian(mean, self.sigma)(x),
                Kind::VonMises => (((x - mean).cos() - 1.0) / (self.sigma * self.sigma)).exp(),
            }
    }

    /// The sum of all at `x`.
    pub fn value(&self, x: f64) -> f64 {
        self.bells.iter().map(|&bell| self.one(bell, x)).sum()
    }

    /// The sum of the bells' own coefficients, as the prototype adds them up.
    pub fn coefficients(&self, rule: Rule, degree: u32) -> Coefficients {
        let zero = Coefficients { period: rule.series_period(), terms: vec![[0.0; 2]; degree as usize + 1] };
        self.bells.iter().fold(zero, |sum, &bell| sum.plus(&rule.of(|x| self.one(bell, x), degree)))
    }

    /// The largest difference from a series over a period; NaN is not lost.
    pub fn error(&self, series: &Coefficients) -> f64 {
        largest(|x| series.value(x) - self.value(x))
    }
}

/// The largest |f| at even steps over a period; NaN is not lost.
pub(in crate::laboratory::rex) fn largest(f: impl Fn(f64) -> f64) -> f64 {
    const STEPS: u32 = 2000;
    let values = (0..STEPS).map(|i| f(PERIOD * f64::from(i) / f64::from(STEPS)).abs());
    values.fold(0.0, |worst, value| if value.is_nan() || value > worst { value } else { worst })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::series::numeric::Slips;

    #[test]
    fn the_von_mises_bell_moves_along_and_the_notes_bell_does_not() {
        let at = |kind, mean| Bells { kind, sigma: 0.1, bells: vec![[mean, 1.0]] };
        let difference = |kind| {
            let (still, moved) = (at(kind, 0.0), at(kind, 0.5));
            largest(|x| moved.value(x + 0.5) - still.value(x))
        };
        assert!(difference(Kind::VonMises) < 1e-12, "{}", difference(Kind::VonMises));
        assert!(difference(Kind::Sine) > 0.9);
    }

    #[test]
    fn errors_fall_with_the_degree_and_a_nan_is_told() {
        let bells = Bells { kind: Kind::Sine, sigma: 0.1, bells: vec![[0.5, 1.0], [0.0, 0.5]] };
        let rule = Rule { period: PERIOD, samples: 1000, slips: Slips::default() };
        let series = bells.coefficients(rule, 60);
        assert!(bells.error(&series) < 5e-8 && bells.error(&series.cut(10)) > 0.1);
        assert!(largest(|x| if x > 3.0 { f64::NAN } else { 1.0 }).is_nan());
    }
}
