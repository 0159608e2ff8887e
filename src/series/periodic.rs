//! Bells that are periodic themselves, with the period of the series: they have no copies, and no meaning without it.

use std::cell::RefCell;
use std::f64::consts::{PI, SQRT_2, TAU};

use glam::DVec2;
use num_complex::Complex64;
use rustfft::FftPlanner;

use super::bell::{Factor, Modes, Shape};
use super::special::ive_all;
use super::tails::summed;

/// The von Mises bell exp(κ (cos ωx − 1)), κ = 1/(ωσ)², along each axis: one lobe a period, the Gaussian of size σ where
/// that is small beside the period. It is what the prototype's periodic Gaussian was meant to be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VonMises {
    /// Its period in x and y.
    pub period: DVec2,
}

/// The prototype's periodic Gaussian exp(−(sin ωx − μ)²/2(ωσ)²) along each axis. For |μ| < 1 it has two lobes a period, at
/// arcsin μ and π − arcsin μ; another μ deforms it instead of moving it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SineGaussian {
    /// Its period in x and y; 2π in the prototype's notes.
    pub period: DVec2,
    /// μ, the sine that it is brightest at; from −1 to 1.
    pub mean: f64,
}

impl SineGaussian {
    /// The narrowest, in periods: its coefficients come from samples, a few for each size.
    pub const NARROWEST: f64 = 2e-5;
}

/// A bell that is a product of one periodic factor for each axis.
trait Periodic: Sync {
    const NAME: &'static str;
    const SHADER: &'static str;

    fn period(&self) -> DVec2;

    /// The factor at x periods from its centre, of a size in periods.
    fn factor(&self, x: f64, size: f64) -> f64;

    /// Where the factor is 1, in periods: between two of them it falls and rises once.
    fn lobes(&self) -> Vec<f64>;

    /// a_n and b_n of the factor for n = 0 ..= `highest`.
    fn coefficients(&self, highest: u32, size: f64) -> Vec<[f64; 2]>;

    /// What the coefficients of a size in periods up to a harmonic cost, about, in nanoseconds.
    fn work(&self, highest: f64, size: f64) -> f64;

    /// What the shader needs to know beside offset, size and period.
    fn parameter(&self) -> f64;
}

impl Periodic for VonMises {
    const NAME: &'static str = "von-mises";
    const SHADER: &'static str = "bells/von_mises.glsl";

    fn period(&self) -> DVec2 {
        self.period
    }

    fn factor(&self, x: f64, size: f64) -> f64 {
        // 1 − cos = 2 sin²(half), which does not cancel.
        (-2.0 * ((PI * x).sin() / (TAU * size)).powi(2)).exp()
    }

    fn lobes(&self) -> Vec<f64> {
        vec![0.0]
    }

    /// a_n = exp(−κ) I_n(κ).
    fn coefficients(&self, highest: u32, size: f64) -> Vec<[f64; 2]> {
        ive_all(highest, (TAU * size).powi(-2)).into_iter().map(|mean| [mean, 0.0]).collect()
    }

    fn work(&self, highest: f64, _size: f64) -> f64 {
        300.0 + 12.0 * highest
    }

    fn parameter(&self) -> f64 {
        0.0
    }
}

impl Periodic for SineGaussian {
    const NAME: &'static str = "sine-gaussian";
    const SHADER: &'static str = "bells/sine_gaussian.glsl";

    fn period(&self) -> DVec2 {
        self.period
    }

    fn factor(&self, x: f64, size: f64) -> f64 {
        (-0.5 * (((TAU * x).sin() - self.mean) / (TAU * size)).powi(2)).exp()
    }

    fn lobes(&self) -> Vec<f64> {
        let lobe = self.mean.asin() / TAU;
        vec![lobe, 0.5 - lobe]
    }

    fn coefficients(&self, highest: u32, size: f64) -> Vec<[f64; 2]> {
        by_samples(highest, samples(highest, size), |sine| (-0.5 * ((sine - self.mean) / (TAU * size)).powi(2)).exp())
    }

    /// A sample is a sine and an exponential, and a part of a fast transform.
    fn work(&self, highest: f64, size: f64) -> f64 {
        1000.0 + 15.0 * f64::from(samples(highest as u32, size))
    }

    fn parameter(&self) -> f64 {
        self.mean
    }
}

/// Samples a period by which a smooth factor's coefficients up to `highest` are right to the last bits: what aliases onto
/// them is beyond harmonic 2/σ, where a Gaussian of size σ has nothing left.
fn samples(highest: u32, size: f64) -> u32 {
    let needed = f64::from(highest) + (2.0 / size).min(1e6) + 32.0;
    (needed as u32).next_power_of_two()
}

/// a_n and b_n of a smooth function of the sine of 2πx, by the trapezium rule, which converges faster than any power; `highest` is
/// below `samples`, a multiple of 4.
fn by_samples(highest: u32, samples: u32, function: impl Fn(f64) -> f64) -> Vec<[f64; 2]> {
    let (whole, quarter) = (samples as usize, samples as usize / 4);
    let mut waves = vec![Complex64::ZERO; whole];
    for k in 0..=quarter {
        let sine = (TAU * (k as f64 / whole as f64)).sin();
        // What rises in a quarter of a turn comes back three times, twice with another sign.
        let [above, below] = [sine, -sine].map(|sine| Complex64::from(function(sine)));
        (waves[k], waves[2 * quarter - k]) = (above, above);
        (waves[2 * quarter + k], waves[(whole - k) % whole]) = (below, below);
    }
    let mean = |sum: f64| sum / f64::from(samples);
    if highest == 0 {
        return vec![[mean(waves.iter().map(|wave| wave.re).sum()), 0.0]];
    }
    PLANNER.with_borrow_mut(|planner| planner.plan_fft_forward(whole)).process(&mut waves);
    waves.truncate(highest as usize + 1);
    // Σ f e^(−2πinx) is Σ f cos − i Σ f sin.
    waves.into_iter().map(|wave| [mean(wave.re), mean(-wave.im)]).collect()
}

thread_local! {
    /// A plan has hundreds of sizes, of a few numbers of samples.
    static PLANNER: RefCell<FftPlanner<f64>> = RefCell::new(FftPlanner::new());
}

impl<B: Periodic> Shape for B {
    fn name(&self) -> &'static str {
        B::NAME
    }

    fn shader(&self) -> &'static str {
        B::SHADER
    }

    fn value(&self, offset: DVec2, size: DVec2) -> f64 {
        let (x, size) = (offset / Periodic::period(self), size / Periodic::period(self));
        self.factor(x.x, size.x) * self.factor(x.y, size.y)
    }

    /// It comes back after a period.
    fn along(&self, _distance: f64, _size: f64) -> f64 {
        1.0
    }

    /// A lobe, where one lies between, and else the brighter end.
    fn brightest(&self, axis: usize, low: f64, high: f64, size: f64) -> f64 {
        let period = Periodic::period(self)[axis];
        let within = |lobe: f64| {
            let next = period * (lobe + (low / period - lobe).ceil());
            (next <= high).then_some(next.max(low))
        };
        self.lobes().into_iter().find_map(within).unwrap_or_else(|| {
            let factor = |offset: f64| self.factor(offset / period, size / period);
            if factor(low) > factor(high) { low } else { high }
        })
    }

    fn wrap(&self, _period: f64, _distance: f64, _size: f64) -> f64 {
        0.0
    }

    /// As steep as a Gaussian, exp(−1/2), and a little more.
    fn steepest(&self, _distance: f64) -> f64 {
        0.61
    }

    fn reach(&self, _share: f64) -> f64 {
        f64::INFINITY
    }

    fn integral(&self, size: DVec2) -> f64 {
        let period = Periodic::period(self);
        let size = size / period;
        let mean = |size: f64| Periodic::coefficients(self, 0, size)[0][0];
        period.element_product() * mean(size.x) * mean(size.y)
    }

    fn variance(&self) -> f64 {
        1.0
    }

    fn modes(&self) -> Modes<'_> {
        Modes::Product(self)
    }

    fn period(&self) -> Option<DVec2> {
        Some(Periodic::period(self))
    }

    fn parameters(&self) -> Vec<[f64; 4]> {
        let frequency = 1.0 / Periodic::period(self);
        vec![[frequency.x, frequency.y, self.parameter(), 0.0]]
    }
}

impl<B: Periodic> Factor for B {
    fn coefficients(&self, highest: u32, size: f64) -> Vec<[f64; 2]> {
        Periodic::coefficients(self, highest, size)
    }

    /// The sum of |a_n + i b_n| to where nothing is left. Of a bell too narrow for that it is the rest of all that a von
    /// Mises bell has, its peak; the others are not that narrow ([`SineGaussian::NARROWEST`]).
    fn tails(&self, highest: u32, size: f64) -> Vec<f64> {
        let (needed, most) = (2.0 / size, 2.0 / SineGaussian::NARROWEST);
        let (last, rest) = (highest + needed.min(most) as u32, if needed > most { 1.0 } else { 0.0 });
        let coefficients = Periodic::coefficients(self, last, size);
        summed(highest, last, rest, |n| {
            let [a, b] = coefficients[n as usize];
            2.0 * a.hypot(b)
        })
    }

    fn mean(&self, size: f64) -> f64 {
        Periodic::coefficients(self, 0, size)[0][0]
    }

    /// That asks for what lies beyond, too.
    fn work(&self, highest: f64, size: f64) -> f64 {
        Periodic::work(self, highest + 2.0 / size.max(SineGaussian::NARROWEST), size)
    }

    /// Where a Gaussian of the same size has no more than ε left.
    fn degree(&self, error: f64, size: f64) -> f64 {
        (1.0 / error).max(3.0).ln().sqrt() / (SQRT_2 * PI * size) + 2.0
    }
}
