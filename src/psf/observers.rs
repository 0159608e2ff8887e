//! Mixtures for all ages at once.

use super::eye::{self, AGES, Observer};
use super::fit::{self, AllAges, Mixture};
use super::function::Function;
use super::plane::Term;
use super::{Fault, Psf};

/// Gaussians of one set of widths for all ages of `cie`, `cie135` or `stiles-holladay`, at one pigment: a change of age
/// is a change of weights, which costs nothing.
#[derive(Debug, Clone, PartialEq)]
pub struct Observers {
    function: Function,
    ages: AllAges,
    range: [f64; 2],
}

impl Psf {
    /// The Gaussians of all ages that meet `tolerance` over `range`, if it is a function of age. [`Psf::mixture`] is of
    /// the same.
    ///
    /// # Errors
    /// On a range or a tolerance that is none.
    pub fn observers(&self, range: [f64; 2], tolerance: f64) -> Result<Option<Observers>, Fault> {
        let ([from, to], tolerance) = fit::checked(range, tolerance)?;
        let range = [from, to.min(self.function.reach().max(from))];
        if self.function.at_age(AGES[0]).is_none() || range[1] <= self.flat_within() {
            return Ok(None);
        }
        let range = [range[0].max(self.flat_within()), range[1]];
        let profile = |age: f64| {
            let function = self.function.at_age(age).unwrap_or_else(|| self.function.clone());
            let factor = function.normaliser();
            let [constant, quadratic] = function.moments();
            move |angle: f64| {
                // Less its moments the function falls alike at every age; an error relative to that is less of it all.
                [(function.value(angle) - constant - quadratic * angle * angle) * factor; 2]
            }
        };
        let ages = AllAges::new(profile, range, tolerance);
        Ok(Some(Observers { function: self.function.clone(), ages, range }))
    }
}

impl Observers {
    /// The mixture of `psf`, if it is the same function at the same pigment, of any age and scatter.
    pub fn mixture(&self, psf: &Psf) -> Option<Mixture> {
        let alike = self.function.at_age(AGES[0]) == psf.function.at_age(AGES[0]);
        (alike && psf.function.at_age(AGES[0]).is_some()).then(|| self.of(psf))
    }

    /// The mixture of a function that is alike.
    pub(super) fn of(&self, psf: &Psf) -> Mixture {
        let part = psf.function.age().map_or(0.0, |age| (age / AGES[1]).powi(4));
        let factor = 1.0 / psf.function.normaliser();
        let [constant, quadratic] = psf.function.moments();
        let terms =
            self.ages.mixed(part).into_iter().map(|[sigma, height]| Term::new(sigma, height * factor)).collect();
        Mixture { terms, constant, quadratic, error: self.ages.error, range: self.range }.scaled(psf.scale)
    }
}

impl Function {
    /// The same at another age, if it is a function of age.
    fn at_age(&self, age: f64) -> Option<Self> {
        match self {
            Self::Cie(observer) => Some(Self::Cie(observer.aged(age))),
            Self::Cie135(observer) => Some(Self::Cie135(observer.aged(age))),
            Self::StilesHolladay { .. } => Some(Self::StilesHolladay { age }),
            _ => None,
        }
    }

    /// Its age, if it is a function of age.
    fn age(&self) -> Option<f64> {
        match self {
            Self::Cie(observer) | Self::Cie135(observer) => Some(Observer::age(*observer)),
            Self::StilesHolladay { age } => Some(*age),
            _ => None,
        }
    }

    /// What it is to be multiplied by to be linear in the fourth power of age.
    fn normaliser(&self) -> f64 {
        match self {
            Self::Cie135(observer) => eye::cie135_normaliser(*observer),
            _ => 1.0,
        }
    }
}
