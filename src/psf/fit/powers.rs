//! Powers of the distance: what functions on the sphere are made of in stereographic coordinates.

use super::super::Fault;
use super::super::plane::Term;
use super::samples::Samples;
use super::{Fitted, Mixture, checked, fitted, linear, measured};

/// |d|^−`exponent`, for exponents above 0 to 6, over `range` within `tolerance`: a positive mixture.
///
/// # Errors
/// On a range that is none, an exponent or a tolerance out of range.
pub fn power(exponent: f64, range: [f64; 2], tolerance: f64) -> Result<Mixture, Fault> {
    let (range, tolerance) = checked(range, tolerance)?;
    let exponent = super::super::fault::within("exponent", exponent, [0.01, 6.0], "an exponent is from 0.01 to 6")?;
    // The largest is 1, so that no power of a small distance leaves what f64 holds.
    let unit = range[0];
    let profile = |x: f64| [x.powf(-exponent); 2];
    let fit = fitted(&profile, [1.0, range[1] / unit], tolerance);
    Ok(of_fit(fit, range, [0.0; 2], unit, unit.powf(-exponent)))
}

/// |d|^`exponent` for the exponent 1 or 3, over `range`, as a constant, a term in d² and Gaussians. It serves as a small
/// correction of |d|^−`against`, so that its error is relative to that power: at most `tolerance` times |d|^−`against`
/// times D^(`exponent` + `against`), D the far end of the range; there it is relative to the power itself.
///
/// By r = ∫ (1 − e^(−r²u)) u^(−3/2) du / 2√π and r³ = 3 ∫ (e^(−r²u) − 1 + r²u) u^(−5/2) du / 4√π these are all that
/// there is to it.
///
/// # Errors
/// On a range that is none, another exponent, or a tolerance out of range.
pub fn growing_power(exponent: u32, against: f64, range: [f64; 2], tolerance: f64) -> Result<Mixture, Fault> {
    let (range, tolerance) = checked(range, tolerance)?;
    if !matches!(exponent, 1 | 3) {
        return Err(Fault::new("exponent", format!("powers that grow are 1 and 3, and not {exponent}")));
    }
    let against = super::super::fault::within("against", against, [0.0, 6.0], "an exponent is from 0 to 6")?;
    let far = range[1];
    let power = f64::from(exponent);
    let profile = |x: f64| [x.powf(power), x.powf(-against)];
    let near = range[0] / far;
    if near > 1.0 - 1e-6 {
        return Ok(Mixture::of_constant(far.powf(power), range));
    }
    let mut best: Option<(Mixture, f64)> = None;
    for count in 0..=24 {
        let found = growing_fit(&profile, near, count);
        if let Some((fit, moments)) = found
            && best.as_ref().is_none_or(|(_, least)| fit.error < *least)
        {
            let error = fit.error;
            best = Some((of_fit(fit, range, moments, far, far.powf(power)), error));
            if error <= tolerance {
                break;
            }
        }
    }
    best.map(|(mixture, _)| mixture).ok_or_else(|| Fault::new("range", "no sum of Gaussians was found over it"))
}

/// A constant, a factor of d² and `count` Gaussians for `profile` over `near`..1: of some sets of even widths the best.
fn growing_fit(profile: &impl super::Profile, near: f64, count: usize) -> Option<(Fitted, [f64; 2])> {
    let samples = Samples::new(profile, [near, 1.0], 30 * (count + 2) + (40.0 * -near.log10()) as usize);
    // Wide ones alone: narrow Gaussians would correct what is far below the power that the error is relative to.
    let mut best: Option<(Fitted, [f64; 2])> = None;
    for widest in [0.5, 0.7] {
        for ratio in [1.6, 2.0, 2.5, 3.0] {
            let widths: Vec<f64> =
                (0..count).map(|i| f64::ln(widest) - f64::ln(ratio) * (count - 1 - i) as f64).collect();
            let Some((gaussians, moments)) = growing_weights(&samples, &widths) else { continue };
            // Of the whole sum: the moments are taken from what is wanted.
            let rest = |x: f64| {
                let [wanted, unit] = profile(x);
                [wanted - moments[0] - moments[1] * x * x, unit]
            };
            let error = measured(&rest, [near, 1.0], &gaussians);
            if best.as_ref().is_none_or(|(best, _)| error < best.error) {
                best = Some((Fitted { gaussians, error }, moments));
            }
        }
    }
    best
}

/// Heights of Gaussians of ln σ `widths`, and the constant and the factor of d² beside them.
fn growing_weights(samples: &Samples, widths: &[f64]) -> Option<(Vec<[f64; 2]>, [f64; 2])> {
    let count = widths.len();
    let shares = samples.shares(widths, &vec![0.0; count]);
    let mut basis = Vec::with_capacity(samples.len() * (count + 2));
    for (i, (square, unit)) in samples.squares.iter().zip(&samples.units).enumerate() {
        basis.extend_from_slice(&shares[i * count..(i + 1) * count]);
        basis.extend([(-unit).exp(), square * (-unit).exp()]);
    }
    let (factors, _) = linear::least_largest(&basis, count + 2, &samples.wanted, 40)?;
    let gaussians = widths.iter().zip(&factors).map(|(width, height)| [width.exp(), *height]).collect();
    Some((gaussians, [factors[count], factors[count + 1]]))
}

/// A fit in lengths of `unit` and values of `value`, as a mixture over `range`.
fn of_fit(fit: Fitted, range: [f64; 2], [constant, quadratic]: [f64; 2], unit: f64, value: f64) -> Mixture {
    Mixture {
        terms: fit.gaussians.iter().map(|[sigma, height]| Term::new(sigma * unit, height * value)).collect(),
        constant: constant * value,
        quadratic: quadratic * value / (unit * unit),
        error: fit.error,
        range,
    }
}
