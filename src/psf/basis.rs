//! Functions as weighted sums of fixed ones.

use super::Psf;
use super::eye::{self, Luminance};
use super::function::Function;
use super::parts::Part;
use super::plane::Term;

/// A function as Σ weight · part, the parts nowhere negative and each of unit energy.
///
/// What age, pigment, adaptation, weights, tints or the scattered share change are the weights alone: two functions that
/// [`Basis::shares_parts_with`] have one set of veils V_i, and each of them V = Σ w_i V_i. As no weight is negative,
/// V_i that are within the relative error ε of theirs make a V that is within ε of its own, whatever the weights are.
/// (Where V_i are so dark that they are held to a share of their channel's largest, n parts err by n such shares of V's
/// largest at most, since no w_i V_i is above V.) f and k(0) are the same sums: f = Σ w_i, and k(0) = Σ w_i k_i(0).
#[derive(Debug, Clone, PartialEq)]
pub struct Basis {
    /// Functions of their own, each with a mixture, a transform and so on.
    pub parts: Vec<Psf>,
    /// How much of the light each scatters, RGB: never negative, and 0 of what a function has nothing of.
    pub weights: Vec<[f64; 3]>,
}

impl Basis {
    /// Whether the other differs in its weights at most.
    pub fn shares_parts_with(&self, other: &Self) -> bool {
        self.parts == other.parts
    }

    /// Σ weight · part at an angle or radius, RGB.
    pub fn values(&self, at: f64) -> [f64; 3] {
        self.sum(|part| [part.value(at); 3])
    }

    /// f by channels, as [`Psf::energies`].
    pub fn energies(&self) -> [f64; 3] {
        self.sum(Psf::energies)
    }

    /// k(0) by channels, as [`Psf::centres`].
    pub fn centres(&self) -> [f64; 3] {
        self.sum(Psf::centres)
    }

    fn sum(&self, of: impl Fn(&Psf) -> [f64; 3]) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for (part, weights) in self.parts.iter().zip(&self.weights) {
            let values = of(part);
            (0..3).for_each(|channel| sum[channel] += weights[channel] * values[channel]);
        }
        sum
    }
}

impl Psf {
    /// It as a sum of at most `most` parts, or else as one part, itself, whose weight is its energy.
    ///
    /// `cie` and `cie135` are sums of four (one of them a constant), of any age and pigment; `spencer` of three, by any
    /// light; `mixture` of as many Gaussians as it has widths. The others are themselves, whatever share they scatter;
    /// so are `stiles-holladay` of any age, and `abg` of any factor `a`.
    pub fn basis(&self, most: usize) -> Basis {
        let sums = self.function.sums();
        if sums.len() > most {
            return Basis {
                weights: vec![[self.energy; 3]],
                parts: vec![Self::of(self.function.clone()).of_unit_energy()],
            };
        }
        let part = |(function, factors): (Function, [f64; 3])| {
            let part = Self::of(function);
            let weights = factors.map(|factor| self.scale * factor * part.energy);
            (part.of_unit_energy(), weights)
        };
        let (parts, weights) = sums.into_iter().map(part).unzip();
        Basis { parts, weights }
    }

    /// The same function with unit energy.
    fn of_unit_energy(self) -> Self {
        Self { scale: self.scale / self.energy, energy: 1.0, ..self }
    }
}

impl Function {
    /// The functions that it is a sum of, and what they are taken by, RGB.
    fn sums(&self) -> Vec<(Self, [f64; 3])> {
        let parts = |parts: &[(Part, f64)]| -> Vec<_> {
            parts.iter().map(|&(part, factor)| (Self::Part(part, self.name()), [factor; 3])).collect()
        };
        let power = |exponent: i32, from: f64| Part::Power { exponent, from };
        match self {
            Self::Cie(observer) => {
                let [first, second, third] = eye::cie_powers(*observer);
                let from = eye::CIE_FROM;
                parts(&[
                    (power(3, from), third),
                    (power(2, from), second),
                    (power(1, from), first),
                    (Part::Constant, eye::cie_constant(*observer)),
                ])
            }
            Self::Cie135(observer) => {
                let [core, wide] = eye::cie135_factors(*observer);
                let [constant, _] = eye::cie135_moments(*observer);
                let pigment = wide * observer.pigment();
                parts(&[(Part::Core, core), (Part::Wide, wide), (Part::Pigment, pigment), (Part::Constant, constant)])
            }
            Self::StilesHolladay { age } => parts(&[(power(2, eye::STILES_FROM), eye::stiles_holladay_power(*age))]),
            Self::Spencer(luminance) => {
                // By itself the core, a Gaussian, would vanish a few pixels from a source: it comes with the day's tail.
                let [core, _, square] = eye::spencer_weights(*luminance);
                let [core_by_day, _, square_by_day] = eye::spencer_weights(Luminance::Photopic);
                let day = core / core_by_day;
                let mut all = vec![(Self::Spencer(Luminance::Photopic), [day; 3])];
                all.extend(parts(&[(Part::Tail, 1.0 - day), (Part::Square, square - square_by_day)]));
                all
            }
            Self::Mixture(terms) => {
                let gaussian = |term: &Term| {
                    let white = Term::of_energy(term.sigma, 1.0, [1.0; 3]);
                    (Self::Gaussian(vec![white]), term.tint.map(|tint| tint * term.energy()))
                };
                terms.iter().map(gaussian).collect()
            }
            Self::Abg(abg) => {
                let (function, factor) = abg.over_its_factor();
                vec![(Self::Abg(function), [factor; 3])]
            }
            _ => vec![(self.clone(), [1.0; 3])],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Name, Observer, Table};
    use super::*;

    fn close(x: f64, known: f64, what: &str) {
        assert!((x - known).abs() <= 2e-9 * known, "{what}: {x} for {known}");
    }

    fn observer(age: f64, pigment: f64) -> Observer {
        Observer::new(age, pigment).unwrap()
    }

    /// The functions of each kind, which share their parts and differ in all else that they take.
    fn kinds() -> Vec<(Vec<Psf>, usize)> {
        let people = [(0.0, 0.0), (20.0, 0.5), (60.0, 1.2), (120.0, 0.3)].map(|(age, pigment)| observer(age, pigment));
        let mixture = |weights: [f64; 2], tints: [[f64; 3]; 2]| {
            Psf::gaussians(&[0.1, 0.01], Some(&weights), Some(&tints)).unwrap()
        };
        let kinds = [
            (people.map(Psf::cie).to_vec(), 4),
            (people.map(Psf::cie135).to_vec(), 4),
            (people.map(|observer| Psf::stiles_holladay(observer.age()).unwrap()).to_vec(), 1),
            ([Luminance::Photopic, Luminance::Mesopic, Luminance::Scotopic].map(Psf::spencer).to_vec(), 3),
            (vec![mixture([1.0, 3.0], [[1.0; 3]; 2]), mixture([1.0, 0.0], [[1.0, 0.5, 0.0], [0.0, 2.0, 1.0]])], 2),
            ([1e-6, 3.0].map(|a| Psf::abg(a, 1e-4, 1.8, Some(2.0)).unwrap()).to_vec(), 1),
            (vec![Psf::camera()], 1),
            (vec![Psf::gaussian(0.2).unwrap()], 1),
            (vec![Psf::table(Table::new(&[[0.01, 3.0], [0.1, 1.0], [1.0, 0.1]]).unwrap())], 1),
        ];
        let less = |psf: &Psf| psf.clone().scattering(0.125).unwrap();
        kinds.map(|(psfs, count)| (psfs.iter().map(less).chain(psfs.clone()).collect(), count)).to_vec()
    }

    #[test]
    fn a_function_is_the_sum_of_parts_that_all_of_its_kind_share() {
        for (psfs, count) in kinds() {
            let first = psfs[0].basis(64);
            for psf in &psfs {
                let basis = psf.basis(64);
                assert!(basis.parts.len() == count && basis.shares_parts_with(&first), "{psf:?}");
                assert!(basis.weights.iter().flatten().all(|weight| *weight >= 0.0), "{:?}", basis.weights);
                assert!(basis.parts.iter().all(|part| part.energy() == 1.0 && part.unit() == psf.unit()));
                for at in [0.0, 1e-3, 0.02, 0.0999, 0.1, 0.3, 0.99, 1.7, 30.0, 100.0, 170.0] {
                    if psf.name() != Name::Mixture {
                        (0..3).for_each(|k| close(basis.values(at)[k], psf.value(at), &format!("{psf:?} at {at}")));
                    }
                }
                (0..3).for_each(|k| close(basis.energies()[k], psf.energies()[k], "energy"));
                (0..3).for_each(|k| close(basis.centres()[k], psf.centres()[k], "centre"));
            }
        }
    }

    /// A mixture's Gaussians by channels.
    #[test]
    fn tints_are_weights() {
        let psf = Psf::gaussians(&[0.1, 0.01], Some(&[1.0, 3.0]), Some(&[[1.0, 0.5, 0.0], [0.0, 2.0, 1.0]])).unwrap();
        let basis = psf.basis(2);
        assert_eq!(basis.weights, [[0.25, 0.125, 0.0], [0.0, 1.5, 0.75]]);
        close(basis.values(0.02)[1], 0.125 * basis.parts[0].value(0.02) + 1.5 * basis.parts[1].value(0.02), "values");
    }

    /// With fewer parts than it takes, a function is one.
    #[test]
    fn a_function_may_be_its_only_part() {
        for (psfs, count) in kinds().into_iter().filter(|(_, count)| *count > 1) {
            let psf = &psfs[0];
            let basis = psf.basis(count - 1);
            assert!(basis.parts.len() == 1 && basis.shares_parts_with(&psfs[psfs.len() / 2].basis(1)), "{psf:?}");
            close(basis.values(0.05)[0], psf.value(0.05), "value");
            (0..3).for_each(|k| close(basis.energies()[k], psf.energies()[k], "energy"));
            (0..3).for_each(|k| close(basis.centres()[k], psf.centres()[k], "centre"));
        }
    }

    /// Other functions have other parts: a drag from one to the other is no change of weights.
    #[test]
    fn other_functions_have_other_parts() {
        let all: Vec<Basis> = kinds().iter().map(|(psfs, _)| psfs[0].basis(64)).collect();
        for (i, one) in all.iter().enumerate() {
            assert!(all.iter().enumerate().all(|(j, other)| one.shares_parts_with(other) == (i == j)));
        }
        assert!(!Psf::gaussian(0.2).unwrap().basis(9).shares_parts_with(&Psf::gaussian(0.3).unwrap().basis(9)));
    }

    /// A part is planned as a function is: it has a mixture of positive Gaussians, within what was asked.
    #[test]
    fn parts_have_mixtures() {
        for (psfs, _) in kinds() {
            for part in psfs[0].basis(64).parts {
                let mixture = part.mixture([0.02, 60.0], 1e-3).unwrap();
                assert!(mixture.error <= 1e-3 && mixture.is_positive(), "{part:?}: {:.1e}", mixture.error);
                let at = mixture.range[0] * 1.7;
                assert!((mixture.value(at) / part.value(at) - 1.0).abs() <= 1.001e-3, "{part:?}");
            }
        }
    }
}
