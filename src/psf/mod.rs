//! Point-spread functions of eyes and cameras, and what a veil takes them by: values, energies, transforms, and
//! mixtures of Gaussians.
//!
//! k(θ) is the part of the light of a point that is scattered to the angle θ, per steradian: L_v / E of the glare
//! equations. With it a veil is V(b) = Σ L(a) Ω(a) k(θ_ab), a sum over the other pixels.
//!
//! | file | what |
//! | --- | --- |
//! | `parameters` | what a user writes, by name and key |
//! | `function` | the functions by one interface, unscaled |
//! | `eye` | those of the eye, in degrees |
//! | `plane`, `table`, `kernel` | those of a picture, in the look's unit or pixels |
//! | `starburst` | what an iris diffracts, on the pixels of a photo |
//! | `basis`, `parts` | functions as weighted sums of functions that do not change with age, pigment or light |
//! | `integral`, `hankel` | energies and transforms |
//! | `fit`, `observers` | mixtures of Gaussians within a tolerance, and of one set of widths for all ages |
//! | `chords` | those of the eye by powers of the chord, for the sphere |
//! | `tail`, `chord` | far from the centre by powers of the angle, and these by powers of the chord |
//! | `profile` | all of it by rows, for plots and tables |

mod basis;
mod chord;
mod chords;
mod eye;
mod fault;
mod fit;
mod function;
mod hankel;
mod integral;
mod kernel;
mod observers;
mod parameters;
mod parts;
mod plane;
mod profile;
mod starburst;
mod table;
mod tail;
#[cfg(test)]
mod tests;

pub use basis::Basis;
pub use chord::{ChordSeries, MOST_POWERS};
pub use chords::ChordPowers;
pub use eye::{AGES, Luminance, Observer, PIGMENTS};
pub use fault::Fault;
pub use fit::{MOST_TERMS, Mixture, TOLERANCES, growing_power, power};
pub use function::Unit;
pub use kernel::Kernel;
pub use observers::Observers;
pub use parameters::{Name, Parameters};
pub use plane::{EXPONENTS, MOST_WIDTHS, Term};
pub use profile::{Mode, Profile, Row};
pub use starburst::{BLADES, FSTOPS, Grid, SENSORS, Starburst, USUAL_BLADES, USUAL_SENSOR};
pub use table::Table;
pub use tail::Tail;

use function::Function;
use parts::Part;

/// Angles at which [`Psf::may_be_mixture`] looks.
const PLACES: usize = 400;

/// A point-spread function.
///
/// Angles and radii are in its [`Psf::unit`]; of those in degrees the values are per steradian, of the others per
/// square of the unit. All are radial but `kernel` and `starburst`, whose values here are means over directions. The energy is what all
/// of a source's light is taken by: f = ∫ k dΩ.
#[derive(Debug, Clone, PartialEq)]
pub struct Psf {
    function: Function,
    /// By what the function's own values are taken.
    scale: f64,
    /// f.
    energy: f64,
}

impl Psf {
    /// A function with the energy that it has by itself.
    fn of(function: Function) -> Self {
        Self { energy: function.energy(), function, scale: 1.0 }
    }

    /// CIE 146:2002's general disability glare equation, for 0.1 to 100 degrees, with the value at 0.1° kept nearer to
    /// 0: f = 0.375 at age 25 and pigment 0.5, and 0.532 at 75.
    pub fn cie(observer: Observer) -> Self {
        Self::of(Function::Cie(observer))
    }

    /// CIE 135/1's total glare function, for 0 to 100 degrees: all of the light, f from 1.00 to 1.04 up to age 80, and
    /// up to 1.1 at 120.
    pub fn cie135(observer: Observer) -> Self {
        Self::of(Function::Cie135(observer))
    }

    /// Spencer's functions (1995), for 0 to 90 degrees, without the ring at 3° (which depends on the wavelength): f
    /// near 1 by day, and less by the ring's share, 0.016 at dusk and 0.033 at night.
    pub fn spencer(luminance: Luminance) -> Self {
        Self::of(Function::Spencer(luminance))
    }

    /// Stiles and Holladay's equation, adjusted to an age of [`AGES`], for 1 to 30 degrees. Nearer to 0 the value at 1°
    /// is kept; the power goes on to 100°, further than the standard says.
    ///
    /// # Errors
    /// On an age out of range.
    pub fn stiles_holladay(age: f64) -> Result<Self, Fault> {
        Ok(Self::of(Function::StilesHolladay { age: Observer::new(age, 0.0)?.age() }))
    }

    /// A Gaussian of unit energy, of the standard deviation `width`.
    ///
    /// # Errors
    /// On a width that is not positive.
    pub fn gaussian(width: f64) -> Result<Self, Fault> {
        Ok(Self::of(Function::Gaussian(plane::gaussian(width)?)))
    }

    /// Gaussians of the standard deviations `widths`, of energies that are as `weights` to each other (equal without
    /// any) and together 1, each tinted by three numbers of `tints` (white without any).
    ///
    /// # Errors
    /// On widths that are not positive or too many, other counts of weights or tints, negative numbers, or nothing but
    /// 0.
    pub fn gaussians(widths: &[f64], weights: Option<&[f64]>, tints: Option<&[[f64; 3]]>) -> Result<Self, Fault> {
        Ok(Self::of(Function::Mixture(plane::mixture(widths, weights, tints)?)))
    }

    /// The tail a/(b + r^g) of Harvey and Shack to the radius `end`, beyond which it is 0: without one over the plane,
    /// which takes a g of 2.05 or more.
    ///
    /// # Errors
    /// On numbers that are not positive, a g outside [`EXPONENTS`], or no end where there must be one.
    pub fn abg(a: f64, b: f64, g: f64, end: Option<f64>) -> Result<Self, Fault> {
        Ok(Self::of(Function::Abg(plane::Abg::new([a, b, g], end)?)))
    }

    /// A core and an inverse-square tail as lenses have them, 3 % of the light.
    pub fn camera() -> Self {
        Self::of(Function::Camera)
    }

    /// A measured function, which ends where its rows end.
    pub fn table(table: Table) -> Self {
        Self::of(Function::Table(table))
    }

    /// A picture.
    pub fn kernel(kernel: Kernel) -> Self {
        Self::of(Function::Kernel(kernel, Name::Kernel))
    }

    /// What an iris diffracts: all of the light, of which most stays in its pixel; see [`Psf::on`].
    pub fn starburst(starburst: Starburst) -> Self {
        Self::of(Function::Starburst(starburst))
    }

    /// The function on the pixels of a photo: of `starburst` a picture, in pixels, of the light that leaves one; of any other that
    /// itself.
    #[must_use]
    pub fn on(&self, grid: &Grid) -> Self {
        match &self.function {
            Function::Starburst(starburst) => Self::of(Function::Kernel(starburst.kernel(grid), Name::Starburst)),
            _ => self.clone(),
        }
    }

    /// f on the pixels of a photo by channels, without the picture that [`Psf::on`] makes.
    pub fn energies_on(&self, grid: &Grid) -> [f64; 3] {
        match &self.function {
            Function::Starburst(starburst) => starburst.energies(grid),
            _ => self.energies(),
        }
    }

    /// Whether it is another one for other photos.
    pub fn is_of_pixels(&self) -> bool {
        matches!(self.function, Function::Starburst(_))
    }

    /// Whether it is the same in all directions.
    pub fn is_round(&self) -> bool {
        !matches!(self.function, Function::Starburst(_) | Function::Kernel(..))
    }

    /// The same function with the energy `scatter`; of `starburst`, with so much of the light that its lens scatters besides.
    ///
    /// # Errors
    /// On one that is not above 0 and at most 1; of `starburst` 0 is right, too.
    pub fn scattering(self, scatter: f64) -> Result<Self, Fault> {
        if let Function::Starburst(starburst) = self.function {
            return starburst.scattering(scatter).map(Self::starburst);
        }
        let scatter =
            fault::within("scatter", scatter, [1e-12, 1.0], "the scattered share is above 0, from 1e-12, to 1")?;
        Ok(Self { scale: scatter / self.function.energy(), energy: scatter, function: self.function })
    }

    /// Its name.
    pub fn name(&self) -> Name {
        self.function.name()
    }

    /// What angles and radii are measured in.
    pub fn unit(&self) -> Unit {
        self.function.unit()
    }

    /// k at an angle or radius; its size counts. Beyond [`Psf::end`] a table, a tail that was given an end and a picture are 0,
    /// and an eye's formula goes on.
    pub fn value(&self, at: f64) -> f64 {
        if at.is_nan() { at } else { self.scale * self.function.value(at.abs()) }
    }

    /// k at the centre, of which a pixel keeps k(0) Ω.
    pub fn centre(&self) -> f64 {
        self.value(0.0)
    }

    /// k at the centre by channels: they differ by tints, and in a `kernel`.
    pub fn centres(&self) -> [f64; 3] {
        match &self.function {
            Function::Mixture(terms) => [0, 1, 2]
                .map(|channel| self.scale * terms.iter().map(|term| term.weight * term.tint[channel]).sum::<f64>()),
            Function::Kernel(kernel, _) => kernel.middle().map(|middle| self.scale * middle),
            _ => [self.centre(); 3],
        }
    }

    /// f = ∫ k dΩ from 0 to [`Psf::end`], relatively within 1e-9: on the sphere 2π ∫ k sin θ dθ, in the plane 2π ∫ k r
    /// dr.
    pub fn energy(&self) -> f64 {
        self.energy
    }

    /// f by channels: they differ by tints, and in a `kernel`, whose mean is then [`Psf::energy`].
    pub fn energies(&self) -> [f64; 3] {
        match &self.function {
            Function::Mixture(terms) => [0, 1, 2]
                .map(|channel| self.scale * terms.iter().map(|term| term.energy() * term.tint[channel]).sum::<f64>()),
            Function::Kernel(kernel, _) => kernel.energies().map(|energy| self.scale * energy),
            _ => [self.energy; 3],
        }
    }

    /// The energy within an angle or radius, at most all of it.
    pub fn energy_within(&self, at: f64) -> f64 {
        if at.is_nan() { at } else { self.scale * self.function.energy_within(at.abs()) }
    }

    /// Where it ends to count for the energy; infinite where the plane's integral is taken.
    pub fn end(&self) -> f64 {
        self.function.end()
    }

    /// Within what angle it is constant by definition, with a kink there that no Gaussians meet; 0 where there is none.
    pub fn flat_within(&self) -> f64 {
        self.function.flat_within()
    }

    /// The picture of `kernel`, or of `starburst` on pixels, and what its pixels are to be taken by.
    pub fn picture(&self) -> Option<(&Kernel, f64)> {
        match &self.function {
            Function::Kernel(kernel, _) => Some((kernel, self.scale)),
            _ => None,
        }
    }

    /// The transform 2π ∫ k J₀(2πνθ) θ dθ at `frequency` ν, in cycles per unit: that of the plane, which near 0 the
    /// sphere is, of a function of the eye with all that lies beyond its end. At 0 it is the energy. Constants have none.
    pub fn transform(&self, frequency: f64) -> f64 {
        let frequency = frequency.abs();
        if frequency == 0.0 { self.energy } else { self.scale * self.function.transform(frequency) }
    }

    /// Gaussians whose sum is this function within the relative error `tolerance` at all angles of `range`, as few as
    /// are found; where no number of them meets it, the best: [`Mixture::error`] says what is met.
    ///
    /// Within [`Psf::flat_within`] no mixture follows the function. A range that begins there is cut to what lies
    /// outside: see [`Mixture::range`]; the rest, function less mixture, ends at that angle. One that lies inside is a
    /// constant. A function that all but vanishes, as `camera` beyond three units, is followed to there.
    ///
    /// # Errors
    /// On a range or a tolerance that is none, and for `kernel` and `starburst`, which are not radial.
    pub fn mixture(&self, range: [f64; 2], tolerance: f64) -> Result<Mixture, Fault> {
        let ([from, to], tolerance) = fit::checked(range, tolerance)?;
        let range = [from, to.min(self.function.reach().max(from))];
        if let Some(mixture) = self.known_mixture(range)? {
            return Ok(mixture);
        }
        match self.observers(range, tolerance)? {
            Some(observers) => Ok(observers.of(self)),
            None => Ok(self.fitted(range, tolerance)),
        }
    }

    /// Whether positive Gaussians may come within the relative error `tolerance` at all angles of `range`. What is told not to
    /// be cannot be, by a look that costs nothing beside a fit; what may be is left to [`Psf::mixture`].
    pub fn may_be_mixture(&self, range: [f64; 2], tolerance: f64) -> bool {
        // The others are such mixtures by their formulas.
        if !matches!(self.function, Function::Table(_) | Function::Abg(_)) {
            return self.is_round();
        }
        let places: Vec<f64> = fit::even_in_logarithm(range, PLACES).collect();
        fit::above_convex(|at| self.function.value(at), &places) <= ((1.0 + tolerance) / (1.0 - tolerance)).ln() + 1e-9
    }

    /// As [`Psf::mixture`], but for functions of age of this age alone: no more Gaussians, and fewer where the core
    /// matters (`cie135` at pixels of a few thousandths of a degree), whose widths are those of no other age.
    ///
    /// # Errors
    /// As of [`Psf::mixture`].
    pub fn mixture_alone(&self, range: [f64; 2], tolerance: f64) -> Result<Mixture, Fault> {
        let ([from, to], tolerance) = fit::checked(range, tolerance)?;
        let range = [from, to.min(self.function.reach().max(from))];
        Ok(self.known_mixture(range)?.unwrap_or_else(|| self.fitted(range, tolerance)))
    }

    /// The mixture of this function, by itself.
    fn fitted(&self, range: [f64; 2], tolerance: f64) -> Mixture {
        let range = [range[0].max(self.flat_within()), range[1]];
        let [constant, quadratic] = self.function.moments();
        let profile = |at: f64| {
            let value = self.function.value(at);
            [value - constant - quadratic * at * at, value]
        };
        let fitted = fit::fitted(&profile, range, tolerance);
        let terms = fitted.gaussians.iter().map(|[sigma, height]| Term::new(*sigma, *height)).collect();
        Mixture { terms, constant, quadratic, error: fitted.error, range }.scaled(self.scale)
    }

    /// The mixture of a function that needs no fit.
    fn known_mixture(&self, range: [f64; 2]) -> Result<Option<Mixture>, Fault> {
        Ok(match &self.function {
            Function::Kernel(..) | Function::Starburst(_) => {
                let reason = format!("{} is a picture and no mixture of round Gaussians", self.name());
                return Err(Fault::new("psf", reason));
            }
            Function::Gaussian(terms) | Function::Mixture(terms) => {
                let mut terms = terms.clone();
                terms.sort_by(|a, b| a.sigma.total_cmp(&b.sigma));
                Some(Mixture { terms, constant: 0.0, quadratic: 0.0, error: 0.0, range }.scaled(self.scale))
            }
            Function::Part(Part::Constant, _) => Some(Mixture::of_constant(self.centre(), range)),
            // None of what is left, if anything is.
            _ if range[0] >= self.function.reach() && self.function.value(range[1]) == 0.0 => {
                Some(Mixture::of_constant(0.0, range))
            }
            _ if range[0] >= self.function.reach() => Some(Mixture { error: 1.0, ..Mixture::of_constant(0.0, range) }),
            _ if range[1] <= self.flat_within() => Some(Mixture::of_constant(self.centre(), range)),
            _ => None,
        })
    }
}
