//! The kernel of a veil: what is wanted, and the mixture of Gaussians that comes close to it.

use std::fmt;
use std::sync::Arc;

use super::error::Error;

/// weight · exp(−θ² / 2 sigma²).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gaussian {
    /// Standard deviation, in the unit of the kernel's argument; above 0.
    pub sigma: f64,
    /// Value at θ = 0; not negative.
    pub weight: f64,
}

/// Σ of `terms`, plus `constant`, plus `quadratic` · θ².
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Mixture {
    /// The Gaussians, in any order.
    pub terms: Vec<Gaussian>,
    /// What is added everywhere; not negative. Exact, as it is a moment of the picture.
    pub constant: f64,
    /// What is added times the square of the angle; not negative. Exact likewise, on a plane.
    pub quadratic: f64,
}

impl Mixture {
    /// Its value at `angle`.
    pub fn at(&self, angle: f64) -> f64 {
        let square = angle * angle;
        let terms = self.terms.iter().map(|term| term.weight * (-0.5 * square / (term.sigma * term.sigma)).exp());
        terms.sum::<f64>() + self.constant + self.quadratic * square
    }

    fn check(&self) -> Result<(), Error> {
        for Gaussian { sigma, weight } in &self.terms {
            if !(sigma.is_finite() && *sigma > 0.0 && weight.is_finite() && *weight >= 0.0) {
                return Err(Error::Kernel(format!(
                    "a Gaussian of a veil has a width above 0 and a weight of at least 0, and not {sigma} and {weight}"
                )));
            }
        }
        let moments = [self.constant, self.quadratic];
        if moments.iter().any(|moment| !moment.is_finite() || *moment < 0.0) {
            return Err(Error::Kernel(format!(
                "the constant and the quadratic term of a veil are at least 0, and not {} and {}",
                moments[0], moments[1]
            )));
        }
        Ok(())
    }
}

/// A radial kernel.
#[derive(Clone)]
pub struct Kernel {
    profile: Arc<dyn Fn(f64) -> f64 + Send + Sync>,
    mixture: Mixture,
}

impl fmt::Debug for Kernel {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_struct("Kernel").field("mixture", &self.mixture).finish_non_exhaustive()
    }
}

impl Kernel {
    /// The kernel whose value at an angle is `profile`, at least 0 and nowhere rising by much, and which `mixture`
    /// approximates from the distance of a pixel or so outwards: what it lacks nearer is made good where it can be.
    ///
    /// # Errors
    /// A mixture with a width, a weight or a moment that is negative or no number.
    pub fn new(profile: impl Fn(f64) -> f64 + Send + Sync + 'static, mixture: Mixture) -> Result<Self, Error> {
        mixture.check()?;
        Ok(Self { profile: Arc::new(profile), mixture })
    }

    /// The kernel that is a mixture itself.
    ///
    /// # Errors
    /// As [`Kernel::new`].
    pub fn from_mixture(mixture: Mixture) -> Result<Self, Error> {
        let own = mixture.clone();
        Self::new(move |angle| own.at(angle), mixture)
    }

    /// The wanted value at `angle`.
    pub fn at(&self, angle: f64) -> f64 {
        (self.profile)(angle)
    }

    /// The mixture.
    pub fn mixture(&self) -> &Mixture {
        &self.mixture
    }
}
