//! Point-spread functions in degrees and per steradian, and mixtures for them: minimax fits of all-positive weights, relative to the
//! function, made for this purpose.

use crate::veil::{Gaussian, Kernel, Mixture};

/// CIE 146 at age 25 and p 0.5 less its constant, 0.1° to 100°, to 6.8e-3: widths and weights.
const CIE_12: [[f64; 2]; 12] = [
    [0.0473139, 46681.1],
    [0.0855094, 7919.93],
    [0.154346, 1418.01],
    [0.28109, 256.52],
    [0.517354, 47.3505],
    [0.964345, 9.10311],
    [1.82425, 1.85596],
    [3.49912, 0.405195],
    [6.78269, 0.0953031],
    [13.2582, 0.0241589],
    [26.966, 0.0069694],
    [77.7093, 0.00234049],
];

/// The same to 1.2e-3: widths and weights.
const CIE_15: [[f64; 2]; 15] = [
    [0.0400718, 62572.6],
    [0.0645102, 14516.9],
    [0.103175, 3656.53],
    [0.166084, 925.871],
    [0.26948, 233.182],
    [0.43996, 59.311],
    [0.722926, 15.5076],
    [1.1977, 4.20431],
    [2.00237, 1.18856],
    [3.37687, 0.352483],
    [5.74112, 0.109483],
    [9.83551, 0.0355952],
    [17.0952, 0.0122549],
    [31.7678, 0.00468744],
    [88.0401, 0.00190957],
];

/// Spencer 1995, photopic, 0.01° to 90°, to 8.2e-4: widths and weights.
const SPENCER_19: [[f64; 2]; 19] = [
    [0.00632695, 312570.0],
    [0.0127051, 686504.0],
    [0.0154822, 601475.0],
    [0.0278825, 53779.0],
    [0.0447575, 19999.0],
    [0.0714061, 6738.85],
    [0.113882, 2100.32],
    [0.181924, 626.93],
    [0.291746, 184.309],
    [0.470963, 54.394],
    [0.766906, 16.3015],
    [1.25921, 4.99982],
    [2.078, 1.58202],
    [3.43464, 0.519449],
    [5.67854, 0.176732],
    [9.40707, 0.061947],
    [15.7779, 0.0224416],
    [28.2205, 0.00850835],
    [68.8764, 0.00280061],
];

/// The same to 8.9e-3: widths and weights.
const SPENCER_14: [[f64; 2]; 14] = [
    [0.00878978, 426725.0],
    [0.0147378, 1.08592e+06],
    [0.0315389, 57054.0],
    [0.0597363, 14052.2],
    [0.112682, 2928.57],
    [0.212862, 565.462],
    [0.404635, 107.232],
    [0.775917, 21.1857],
    [1.51106, 4.41013],
    [2.98388, 0.96242],
    [5.91221, 0.219518],
    [11.6225, 0.0531751],
    [23.3558, 0.0141473],
    [60.347, 0.00373503],
];

fn mixture(terms: &[[f64; 2]], constant: f64) -> Mixture {
    let terms = terms.iter().map(|[sigma, weight]| Gaussian { sigma: *sigma, weight: *weight }).collect();
    Mixture { terms, constant, quadratic: 0.0 }
}

fn kernel(profile: impl Fn(f64) -> f64 + Send + Sync + 'static, mixture: Mixture) -> Kernel {
    Kernel::new(profile, mixture).expect("a kernel")
}

/// CIE 146:2002, general equation, at age 25 and pigment factor 0.5; inside 0.1° as at 0.1°.
pub(super) fn cie_at(angle: f64) -> f64 {
    let angle = angle.max(0.1);
    let age = 1.0 + (25.0f64 / 62.5).powi(4);
    10.0 / angle.powi(3) + (5.0 / angle.powi(2) + 0.05 / angle) * age + 0.0025 * 0.5
}

/// The same, with the mixture of 12 or of 15 terms.
pub(super) fn cie(exact: bool) -> Kernel {
    let terms: &[[f64; 2]] = if exact { &CIE_15 } else { &CIE_12 };
    kernel(cie_at, mixture(terms, 0.0025 * 0.5))
}

/// Spencer et al. 1995, photopic, without the ring.
pub(super) fn spencer(exact: bool) -> Kernel {
    let terms: &[[f64; 2]] = if exact { &SPENCER_19 } else { &SPENCER_14 };
    let at = |angle: f64| {
        let core = 2.61e6 * (-(angle / 0.02).powi(2)).exp();
        0.384 * core + 0.478 * 20.91 / (angle + 0.02).powi(3) + 0.138 * 72.37 / (angle + 0.02).powi(2)
    };
    kernel(at, mixture(terms, 0.0))
}

/// A single Gaussian, `sigma` wide.
pub(super) fn gaussian(sigma: f64) -> Kernel {
    let mixture = Mixture { terms: vec![Gaussian { sigma, weight: 1.0 / sigma.powi(2) }], ..Mixture::default() };
    Kernel::from_mixture(mixture).expect("a kernel")
}
