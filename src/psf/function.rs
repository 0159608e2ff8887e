//! The functions by their formulas, of one channel and unscaled.

use std::f64::consts::TAU;

use super::eye::{self, Luminance, Observer};
use super::hankel;
use super::integral::integral_from_zero;
use super::kernel::Kernel;
use super::parameters::Name;
use super::parts::Part;
use super::plane::{Abg, Camera, Term};
use super::starburst::Starburst;
use super::table::Table;

/// What a radius or an angle is measured in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Unit {
    /// Degrees on the sphere; values are per steradian.
    Degrees,
    /// The unit of the look; values are per square of it.
    Look,
    /// Pixels of the photo; values are per pixel.
    Pixels,
    /// Micrometres on the sensor; values are per square of them.
    Micrometres,
}

/// One of the functions.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Function {
    Cie(Observer),
    Cie135(Observer),
    Spencer(Luminance),
    StilesHolladay {
        age: f64,
    },
    Gaussian(Vec<Term>),
    Mixture(Vec<Term>),
    Abg(Abg),
    Table(Table),
    Camera,
    /// A picture, and the function that it is of.
    Kernel(Kernel, Name),
    /// Before the pixels are known that make a picture of it.
    Starburst(Starburst),
    /// What others are sums of, and which.
    Part(Part, Name),
}

impl Function {
    pub fn name(&self) -> Name {
        match self {
            Self::Cie(_) => Name::Cie,
            Self::Cie135(_) => Name::Cie135,
            Self::Spencer(_) => Name::Spencer,
            Self::StilesHolladay { .. } => Name::StilesHolladay,
            Self::Gaussian(_) => Name::Gaussian,
            Self::Mixture(_) => Name::Mixture,
            Self::Abg(_) => Name::Abg,
            Self::Table(_) => Name::Table,
            Self::Camera => Name::Camera,
            Self::Starburst(_) => Name::Starburst,
            Self::Kernel(_, of) | Self::Part(_, of) => *of,
        }
    }

    /// Its value at an angle or radius ≥ 0.
    pub fn value(&self, at: f64) -> f64 {
        let [constant, quadratic] = self.moments();
        match self {
            Self::Cie(observer) => eye::cie(*observer, at) + constant,
            Self::Cie135(observer) => {
                eye::cie135(*observer).iter().map(|part| part.value(at)).sum::<f64>() + quadratic * at * at + constant
            }
            Self::Spencer(luminance) => eye::spencer(*luminance, at),
            Self::StilesHolladay { age } => eye::stiles_holladay(*age, at),
            Self::Gaussian(terms) | Self::Mixture(terms) => terms.iter().map(|term| term.value(at * at)).sum(),
            Self::Abg(abg) => abg.value(at),
            Self::Table(table) => table.value(at),
            Self::Camera => Camera.value(at),
            Self::Kernel(kernel, _) => kernel.ring(at),
            Self::Starburst(starburst) => starburst.ring(at),
            Self::Part(part, _) => part.value(at),
        }
    }

    /// The parts that no Gaussian has to stand for: a constant, and what the squared angle is taken by.
    pub fn moments(&self) -> [f64; 2] {
        match self {
            Self::Cie(observer) => [eye::cie_constant(*observer), 0.0],
            Self::Cie135(observer) => eye::cie135_moments(*observer),
            Self::Part(part, _) => part.moments(),
            _ => [0.0; 2],
        }
    }

    pub fn unit(&self) -> Unit {
        match self {
            Self::Cie(_) | Self::Cie135(_) | Self::Spencer(_) | Self::StilesHolladay { .. } | Self::Part(..) => {
                Unit::Degrees
            }
            Self::Gaussian(_) | Self::Mixture(_) | Self::Abg(_) | Self::Table(_) | Self::Camera => Unit::Look,
            Self::Kernel(..) => Unit::Pixels,
            Self::Starburst(_) => Unit::Micrometres,
        }
    }

    /// Where it ends to count for the energy; a table and a tail of an end are 0 beyond.
    pub fn end(&self) -> f64 {
        match self {
            Self::Cie(_) | Self::Cie135(_) | Self::StilesHolladay { .. } => eye::CIE_END,
            Self::Spencer(_) | Self::Part(_, Name::Spencer) => eye::SPENCER_END,
            Self::Part(..) => eye::CIE_END,
            Self::Gaussian(_) | Self::Mixture(_) | Self::Camera | Self::Starburst(_) => f64::INFINITY,
            Self::Abg(abg) => abg.end,
            Self::Table(table) => table.end(),
            Self::Kernel(kernel, _) => kernel.end(),
        }
    }

    /// Within what it is constant by definition; 0 where it is not.
    pub fn flat_within(&self) -> f64 {
        match self {
            Self::Cie(_) => eye::CIE_FROM,
            Self::StilesHolladay { .. } => eye::STILES_FROM,
            Self::Part(part, _) => part.flat_within(),
            _ => 0.0,
        }
    }

    /// Beyond where there is no light to speak of, or no angle: Gaussians that had to follow it would be for nothing.
    pub fn reach(&self) -> f64 {
        match self {
            // Six times the widest Gaussian, 1.5e-8 of its height.
            Self::Camera => 6.0 * Camera::WIDTHS[2],
            Self::Abg(abg) => abg.reach(),
            Self::Table(table) => table.end(),
            _ if self.unit() == Unit::Degrees => 180.0,
            _ => f64::INFINITY,
        }
    }

    /// Within what it changes little.
    fn scale(&self) -> f64 {
        match self {
            Self::Cie(_) => eye::CIE_FROM,
            Self::Cie135(_) => 0.002,
            Self::Spencer(_) => 0.2 * eye::SPENCER_SHIFT,
            Self::StilesHolladay { .. } => eye::STILES_FROM,
            Self::Gaussian(terms) | Self::Mixture(terms) => {
                terms.iter().map(|term| term.sigma).fold(f64::INFINITY, f64::min)
            }
            Self::Abg(abg) => 0.5 * abg.core(),
            Self::Table(table) => table.first(),
            Self::Camera => Camera::WIDTHS[0],
            Self::Kernel(..) => 1.0,
            Self::Starburst(starburst) => starburst.unit(),
            Self::Part(part, _) => part.scale(),
        }
    }

    /// 2π ∫ k from 0 to its end: sin θ dθ on the sphere, r dr in the plane.
    pub fn energy(&self) -> f64 {
        match self {
            Self::Gaussian(_) | Self::Mixture(_) | Self::Table(_) | Self::Kernel(_, Name::Kernel) => 1.0,
            // What it scatters besides is known where the pixels are.
            Self::Starburst(_) => 1.0,
            Self::Kernel(kernel, _) => kernel.energies().iter().sum::<f64>() / 3.0,
            Self::Abg(abg) => abg.energy(),
            Self::Camera => Camera.energy(),
            _ => self.integrated(self.end()),
        }
    }

    /// The same up to an angle or radius, at most to its end.
    pub fn energy_within(&self, to: f64) -> f64 {
        let to = to.min(self.end());
        match self {
            Self::Gaussian(terms) | Self::Mixture(terms) => {
                terms.iter().map(|term| -term.energy() * (-0.5 * (to / term.sigma).powi(2)).exp_m1()).sum()
            }
            Self::Table(table) => table.energy_within(to),
            Self::Kernel(kernel, _) => kernel.energy_within(to),
            Self::Starburst(starburst) => starburst.within(to),
            // At 50 of its units nothing is left.
            Self::Camera => self.integrated(to.min(50.0)),
            _ if to.is_infinite() => self.energy(),
            _ => self.integrated(to),
        }
    }

    /// [`Function::energy_within`] by quadrature.
    fn integrated(&self, to: f64) -> f64 {
        if self.unit() == Unit::Degrees {
            let ring = |angle: f64| TAU * angle.to_radians().sin() * 1_f64.to_radians() * self.value(angle);
            integral_from_zero(&ring, self.scale(), to)
        } else {
            integral_from_zero(&|r| TAU * r * self.value(r), self.scale(), to)
        }
    }

    /// The transform in the plane at `frequency` > 0 cycles per unit.
    pub fn transform(&self, frequency: f64) -> f64 {
        let q = TAU * frequency;
        // Steradians in a square degree of the plane.
        let square = 1_f64.to_radians().powi(2);
        match self {
            Self::Cie135(observer) => square * eye::cie135(*observer).iter().map(|part| part.transform(q)).sum::<f64>(),
            Self::Part(part, _) => square * part.transform(q),
            Self::Gaussian(terms) | Self::Mixture(terms) => {
                terms.iter().map(|term| term.energy() * (-0.5 * (term.sigma * q).powi(2)).exp()).sum()
            }
            Self::Table(_) => hankel::transform_within(&|r| self.value(r), self.scale(), self.end(), q),
            Self::Abg(abg) if abg.end.is_finite() => {
                hankel::transform_within(&|r| self.value(r), self.scale(), abg.end, q)
            }
            // Its rings' straight lines bend at every pixel.
            Self::Kernel(kernel, _) => hankel::transform(&|r| kernel.ring(r), self.scale(), kernel.end() + 1.0, q),
            Self::Starburst(starburst) => starburst.transform(frequency),
            Self::Abg(_) | Self::Camera => hankel::transform(&|r| self.value(r), self.scale(), 3.0 * self.scale(), q),
            _ => {
                let [constant, _] = self.moments();
                square * hankel::transform(&|angle| self.value(angle) - constant, self.scale(), 3.0 * self.scale(), q)
            }
        }
    }
}
