//! Fourier coefficients of any function of one variable, by sampling it, as the prototype's plug-ins compute them.
//!
//! The right way is the mean over one period,
//!
//! ```text
//! a_n = τ/M Σ f(x_i) cos nωx_i     b_n = τ/M Σ f(x_i) sin nωx_i     x_i = iT/M, i < M; τ = 1 for n = 0, else 2
//! f(x) ≈ a_0 + Σ_{n≥1} a_n cos nωx + b_n sin nωx
//! ```
//!
//! which for smooth periodic functions converges faster than any power of M. What the notes' plug-ins do instead is in
//! [`Slips`], one by one (docs/math.md, "Numeric coefficients").

use std::f64::consts::TAU;

/// What the notes' plug-ins get wrong (002); the default is nothing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Slips {
    /// The samples cover (−1, 1), whatever the period is, and are integrated as if they covered (−T, T): two periods.
    pub interval: bool,
    /// The integral over two periods is divided by one of them: twice the mean.
    pub twice: bool,
    /// The period is taken to be half of what it is; for `exp(−(sin x − μ)²/2σ²)` π instead of 2π.
    pub half_period: bool,
}

impl Slips {
    /// All of them, as printed.
    pub const ALL: Self = Self { interval: true, twice: true, half_period: true };
}

/// How a function is sampled.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rule {
    /// The function's period; the slip halves it.
    pub period: f64,
    /// How many samples; at least 1, and more than twice the degree for the coefficients to mean anything.
    pub samples: u32,
    /// Which of the notes' slips are made.
    pub slips: Slips,
}

impl Rule {
    /// The period that the series is given.
    pub fn series_period(&self) -> f64 {
        if self.slips.half_period { 0.5 * self.period } else { self.period }
    }

    /// How many periods the samples are taken to cover.
    pub fn turns(&self) -> u32 {
        if self.slips.interval { 2 } else { 1 }
    }

    /// What the mean is multiplied by.
    pub fn gain(&self) -> f64 {
        if self.slips.twice { 2.0 } else { 1.0 }
    }

    /// The values of `f` where the rule wants them.
    pub fn sample(&self, f: impl Fn(f64) -> f64) -> Vec<f64> {
        let [from, length] = if self.slips.interval { [-1.0, 2.0] } else { [0.0, self.series_period()] };
        (0..self.samples).map(|i| f(from + length * (f64::from(i) / f64::from(self.samples)))).collect()
    }

    /// The coefficients up to `degree` of what was sampled.
    ///
    /// # Panics
    /// If there are not as many values as the rule has samples.
    pub fn coefficients(&self, values: &[f64], degree: u32) -> Coefficients {
        assert_eq!(values.len(), self.samples as usize, "values of this rule");
        let count = u64::from(self.samples);
        // Every phase is a whole number of 1/M of a turn, so it is reduced exactly.
        let table: Vec<[f64; 2]> = (0..count)
            .map(|i| {
                let (sin, cos) = (TAU * (i as f64 / count as f64)).sin_cos();
                [cos, sin]
            })
            .collect();
        let step = |n: u32| u64::from(self.turns()) * u64::from(n);
        let one = |n: u32| {
            let mut sum = [Sum::default(); 2];
            for (i, value) in (0..count).zip(values) {
                let basis = table[(step(n) * i % count) as usize];
                sum[0].add(value * basis[0]);
                sum[1].add(value * basis[1]);
            }
            let tau = if n == 0 { 1.0 } else { 2.0 };
            sum.map(|sum| self.gain() * tau * sum.total() / count as f64)
        };
        Coefficients { period: self.series_period(), terms: (0..=degree).map(one).collect() }
    }

    /// Samples `f` and computes its coefficients up to `degree`.
    pub fn of(&self, f: impl Fn(f64) -> f64, degree: u32) -> Coefficients {
        self.coefficients(&self.sample(f), degree)
    }
}

/// A sum that carries what its additions lose (Kahan and Babuška).
#[derive(Debug, Clone, Copy, Default)]
struct Sum {
    sum: f64,
    lost: f64,
}

impl Sum {
    fn add(&mut self, value: f64) {
        let sum = self.sum + value;
        let [large, small] = if self.sum.abs() >= value.abs() { [self.sum, value] } else { [value, self.sum] };
        self.lost += (large - sum) + small;
        self.sum = sum;
    }

    fn total(self) -> f64 {
        self.sum + self.lost
    }
}

/// The coefficients (a_n, b_n) of a series and its period; the one of n = 0 is (mean, 0).
#[derive(Debug, Clone, PartialEq)]
pub struct Coefficients {
    /// The period T > 0.
    pub period: f64,
    /// (a_n, b_n) from n = 0 on.
    pub terms: Vec<[f64; 2]>,
}

impl Coefficients {
    /// The series at `x`.
    pub fn value(&self, x: f64) -> f64 {
        let turns = x / self.period;
        let term = |(n, [a, b]): (usize, &[f64; 2])| {
            let (sin, cos) = (TAU * (n as f64 * turns).fract()).sin_cos();
            a * cos + b * sin
        };
        // From the small ones to the large ones.
        self.terms.iter().enumerate().rev().map(term).sum()
    }

    /// The series cut after `degree`.
    #[must_use]
    pub fn cut(&self, degree: u32) -> Self {
        let terms = self.terms.iter().take(degree as usize + 1).copied().collect();
        Self { period: self.period, terms }
    }

    /// The coefficients of the sum of two functions.
    ///
    /// # Panics
    /// If the periods or the degrees differ.
    #[must_use]
    pub fn plus(&self, other: &Self) -> Self {
        assert_eq!((self.period, self.terms.len()), (other.period, other.terms.len()), "series of one basis");
        let terms = self.terms.iter().zip(&other.terms).map(|(a, b)| [a[0] + b[0], a[1] + b[1]]).collect();
        Self { period: self.period, terms }
    }
}

/// The notes' "periodic Gaussian" exp(−(sin x − μ)²/2σ²), of period 2π (002).
///
/// It has two lobes in a period where |μ| < 1, and μ moves them towards each other instead of along.
pub fn sine_gaussian(mean: f64, sigma: f64) -> impl Fn(f64) -> f64 {
    move |x: f64| {
        let offset = (x.sin() - mean) / sigma;
        (-0.5 * offset * offset).exp()
    }
}
