//! The angles at which a fit is judged, and sums of Gaussians there.

/// What a sum of Gaussians shall be, at angles that are even in their logarithm.
pub(super) struct Samples {
    /// Squared angles.
    pub squares: Vec<f64>,
    /// What the sum shall be, over what its error is relative to.
    pub wanted: Vec<f64>,
    /// ln of what the error is relative to.
    pub units: Vec<f64>,
}

/// A profile that Gaussians are fitted to: at an angle what they shall sum to, and what their error is relative to.
pub(in super::super) trait Profile: Fn(f64) -> [f64; 2] {}
impl<F: Fn(f64) -> [f64; 2]> Profile for F {}

impl Samples {
    /// `count` ≥ 2 samples of `profile` from `range[0]` to `range[1]`, both included.
    pub fn new(profile: &impl Profile, range: [f64; 2], count: usize) -> Self {
        let mut samples = Self { squares: Vec::new(), wanted: Vec::new(), units: Vec::new() };
        for angle in even_in_logarithm(range, count) {
            let [sum, unit] = profile(angle);
            samples.squares.push(angle * angle);
            samples.wanted.push(sum / unit);
            samples.units.push(unit.ln());
        }
        samples
    }

    /// How many.
    pub fn len(&self) -> usize {
        self.squares.len()
    }

    /// Gaussians of standard deviations e^`widths` and heights e^`weights` over the units: a row of one each for each
    /// sample.
    pub fn shares(&self, widths: &[f64], weights: &[f64]) -> Vec<f64> {
        let inverse: Vec<f64> = widths.iter().map(|width| 0.5 * (-2.0 * width).exp()).collect();
        let mut shares = Vec::with_capacity(self.len() * widths.len());
        for (square, unit) in self.squares.iter().zip(&self.units) {
            shares
                .extend(weights.iter().zip(&inverse).map(|(weight, inverse)| (weight - unit - square * inverse).exp()));
        }
        shares
    }
}

/// `count` numbers from `range[0]` to `range[1]`, both exactly there, with even ratios between.
pub(in super::super) fn even_in_logarithm(range: [f64; 2], count: usize) -> impl Iterator<Item = f64> {
    let [low, high] = range.map(f64::ln);
    let last = count.max(2) - 1;
    (0..=last).map(move |i| match i {
        0 => range[0],
        i if i == last => range[1],
        i => (low + (high - low) * i as f64 / last as f64).exp(),
    })
}

/// A sum of Gaussians by the logarithms of widths and weights, both of which are so positive whatever a step does; and
/// its errors at samples.
#[derive(Clone)]
pub(super) struct Sum {
    /// ln σ.
    pub widths: Vec<f64>,
    /// ln of the value at the centre.
    pub weights: Vec<f64>,
    /// Each Gaussian over the unit: a row a sample.
    pub shares: Vec<f64>,
    /// Sum less what is wanted, over the unit, at each sample.
    pub errors: Vec<f64>,
}

impl Sum {
    /// Of these widths and weights, at `samples`.
    pub fn new(samples: &Samples, widths: Vec<f64>, weights: Vec<f64>) -> Self {
        let shares = samples.shares(&widths, &weights);
        let errors = shares
            .chunks_exact(widths.len())
            .zip(&samples.wanted)
            .map(|(row, wanted)| row.iter().sum::<f64>() - wanted);
        let errors = errors.collect();
        Self { widths, weights, shares, errors }
    }

    /// The largest error; infinite where one is no number.
    pub fn largest(&self) -> f64 {
        largest(&self.errors)
    }

    /// Σ errors².
    pub fn cost(&self) -> f64 {
        self.errors.iter().map(|error| error * error).sum()
    }

    /// The error's derivatives by all ln weights, then by all ln widths, at sample `i`.
    pub fn gradient(&self, samples: &Samples, i: usize, into: &mut [f64]) {
        let n = self.widths.len();
        let (by_weight, by_width) = into.split_at_mut(n);
        by_weight.copy_from_slice(&self.shares[i * n..(i + 1) * n]);
        for ((to, share), width) in by_width.iter_mut().zip(&*by_weight).zip(&self.widths) {
            *to = share * samples.squares[i] * (-2.0 * width).exp();
        }
    }

    /// Moved by a step in ln weights and ln widths, shortened so that none changes by more than `most`.
    pub fn moved(&self, samples: &Samples, step: &[f64], most: f64) -> Self {
        let (by_weight, by_width) = step.split_at(self.widths.len());
        let shortened = (most / largest(step)).min(1.0);
        let add = |to: &[f64], by: &[f64]| to.iter().zip(by).map(|(x, dx)| x + shortened * dx).collect();
        Self::new(samples, add(&self.widths, by_width), add(&self.weights, by_weight))
    }
}

/// The largest size; infinite where one is no number, which no comparison would find.
pub(super) fn largest(numbers: &[f64]) -> f64 {
    numbers.iter().fold(0.0, |most: f64, x| if x.is_nan() { f64::INFINITY } else { most.max(x.abs()) })
}
