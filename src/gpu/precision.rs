//! How exact a driver's own functions are in f32, and vglare's phases beside them.

use std::f64::consts::TAU;
use std::rc::Rc;

use super::context::Device;
use super::layout::{ARGUMENTS, VALUES};
use super::resource::Buffer;
use super::runner::Runner;
use crate::Result;

/// Largest arguments: radians of the driver's functions, harmonics of vglare's phases.
pub const RANGES: [f64; 7] = [1.0, 10.0, 100.0, 1e3, 1e4, 1e5, 1e6];

/// Arguments that are tried in each range, and how many of them a work group takes.
const COUNT: u32 = 1 << 14;
pub(super) const GROUP: u32 = 64;

/// The worst errors over arguments of up to some size, against f64; infinite where a value was not finite.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Precision {
    /// The largest argument.
    pub up_to: f64,
    /// Of the driver's sin x, absolute.
    pub sin: f64,
    /// Of the driver's cos x, absolute.
    pub cos: f64,
    /// Of the driver's exp(−x), relative; absolute where the value is below the smallest normal f32.
    pub exp: f64,
    /// Of vglare's cosine and sine of n φ, absolute, with n up to the argument and any φ.
    pub cis: f64,
    /// Values that were NaN or infinite.
    pub not_finite: usize,
}

/// One argument, as in `precision.comp`: x as bits, n, φ in 2⁻³² of a turn.
type Argument = [u32; 4];

/// Measures every range.
///
/// # Errors
/// [`crate::Error::Gl`] where the driver refuses.
pub fn measure(device: &Rc<Device>) -> Result<Vec<Precision>> {
    let runner = Runner::new(device)?;
    RANGES.into_iter().map(|range| one(&runner, range, &arguments(range))).collect()
}

/// Arguments spread over a range, of either sign, the largest among them.
fn arguments(range: f64) -> Vec<Argument> {
    // Multiples of irrational numbers, modulo 1: as even as a grid, and never in step with a period.
    let part = |k: u32, irrational: f64| (f64::from(k) * irrational).fract();
    let argument = |k: u32| {
        let x = range * if k == 0 { 1.0 } else { 2.0 * part(k, 0.618_033_988_749_895) - 1.0 };
        let n = (range * part(k, 0.754_877_666_246_693)).ceil() as u32;
        let phase = (part(k, 0.569_840_290_998_053) * 2f64.powi(32)) as u32;
        [(x as f32).to_bits(), n, phase, 0]
    };
    (0..COUNT).map(argument).collect()
}

/// The worst errors over some arguments.
fn one(runner: &Runner, up_to: f64, arguments: &[Argument]) -> Result<Precision> {
    let device = runner.device();
    let input = Buffer::from_slice(device, arguments)?;
    let output = Buffer::<[f32; 4]>::new(device, 2 * arguments.len())?;
    input.bind_storage(ARGUMENTS);
    output.bind_storage(VALUES);
    runner.dispatch("precision.comp", &[], [(arguments.len() as u32).div_ceil(GROUP), 1, 1])?;
    let values = output.read(2 * arguments.len());
    device.check("measuring its precision")?;
    Ok(worst(up_to, arguments, &values))
}

fn worst(up_to: f64, arguments: &[Argument], values: &[[f32; 4]]) -> Precision {
    let mut worst = Precision { up_to, sin: 0.0, cos: 0.0, exp: 0.0, cis: 0.0, not_finite: 0 };
    for (&[x, n, phase, _], values) in arguments.iter().zip(values.chunks_exact(2)) {
        let x = f64::from(f32::from_bits(x));
        let turned = TAU * f64::from(n.wrapping_mul(phase)) / 2f64.powi(32);
        let decay = (-x.abs()).exp();
        let [[sin, cos, exp, _], [re, im, _, _]] = [values[0], values[1]];
        worst.not_finite += [sin, cos, exp, re, im].iter().filter(|value| !value.is_finite()).count();
        worse(&mut worst.sin, sin, x.sin(), 1.0);
        worse(&mut worst.cos, cos, x.cos(), 1.0);
        worse(&mut worst.exp, exp, decay, if decay < f64::from(f32::MIN_POSITIVE) { 1.0 } else { decay });
        worse(&mut worst.cis, re, turned.cos(), 1.0);
        worse(&mut worst.cis, im, turned.sin(), 1.0);
    }
    worst
}

/// The larger of an error and the next; a NaN is not lost.
fn worse(worst: &mut f64, value: f32, exact: f64, scale: f64) {
    let error = if value.is_finite() { (f64::from(value) - exact).abs() / scale } else { f64::INFINITY };
    *worst = worst.max(error);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::Backend;
    use crate::gpu::tests::turn;

    fn on_each_backend(test: impl Fn(&Runner) + Sync) {
        let _turn = turn();
        for backend in Backend::ALL {
            std::thread::scope(|scope| {
                let run = || test(&Runner::new(&Device::open(&[backend]).expect("these tests need GL")).unwrap());
                scope.spawn(run).join().unwrap_or_else(|panic| std::panic::resume_unwind(panic));
            });
        }
    }

    #[test]
    fn phases_are_exact_to_a_millionth_for_any_harmonic_and_everything_is_finite() {
        on_each_backend(|runner| {
            for range in RANGES.into_iter().chain([f64::from(u32::MAX)]) {
                let found = one(runner, range, &arguments(range)).unwrap();
                println!("{found:?}");
                assert!(found.cis <= 1e-6, "{found:?}");
                assert_eq!(found.not_finite, 0, "{found:?}");
                assert!(found.cis > 1e-9, "exacter than f32 can be: nothing was compared: {found:?}");
            }
        });
    }

    #[test]
    fn phases_are_exact_at_the_seams_of_the_quadrants() {
        let seams = (0..8u32).flat_map(|eighth| [-1i32, 0, 1].map(|by| (eighth << 29).wrapping_add_signed(by)));
        let arguments: Vec<Argument> = seams.flat_map(|phase| [0, 1, 2, u32::MAX].map(|n| [0, n, phase, 0])).collect();
        on_each_backend(|runner| {
            let found = one(runner, 0.0, &arguments).unwrap();
            assert!(found.cis <= 1e-6 && found.not_finite == 0, "{found:?}");
        });
    }

    #[test]
    fn a_wrong_value_and_a_nan_are_told() {
        let right = [[0.0, 1.0, 1.0, 0.0], [1.0, 0.0, 0.0, 0.0]];
        let arguments = [[0, 3, 0, 0]];
        let exact = worst(0.0, &arguments, &right);
        assert_eq!([exact.sin, exact.cos, exact.exp, exact.cis], [0.0; 4]);
        for (row, column) in [(0, 0), (0, 1), (0, 2), (1, 0), (1, 1)] {
            for (value, error) in [(0.5, 0.5), (f32::NAN, f64::INFINITY)] {
                let mut wrong = right;
                wrong[row][column] = value;
                let found = worst(0.0, &arguments, &wrong);
                let largest = [found.sin, found.cos, found.exp, found.cis].into_iter().fold(0.0, f64::max);
                assert_eq!(largest, error, "{row} {column}");
                assert_eq!(found.not_finite, usize::from(value.is_nan()));
            }
        }
    }
}
