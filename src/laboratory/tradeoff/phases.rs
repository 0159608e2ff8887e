//! How far cos(n·2πx/T) is off by the ways of computing its phase in f32, against f64.
//!
//! docs/math.md, "f32 phases", has the bounds.

use std::f64::consts::TAU;

use serde::Serialize;

use crate::frame::Frame;
use crate::series::phase;

/// Highest harmonic.
const HIGHEST: u32 = 4096;
/// Positions along the picture's width.
const POSITIONS: u32 = 275;
/// Bins for each doubling of n.
const BINS: f64 = 2.0;

/// One way, and its errors.
#[derive(Debug, Clone, Serialize)]
pub struct PhaseCurve {
    /// What it is called.
    pub way: &'static str,
    /// n·x/T in turns where x is the picture's border, and the largest error at any position in the picture of the
    /// harmonics up to that n, down to the next point's.
    pub points: Vec<[f64; 2]>,
}

/// What is computed for each harmonic of one position: its cosine.
type Way = fn(f64, f64, &mut dyn FnMut(u32, f32));

/// The ways, the one that vglare uses among them.
const WAYS: [(&str, Way); 5] = [
    ("cos(n·ω·x) in f32", |x, period, out| {
        let (omega, x) = ((TAU / period) as f32, x as f32);
        (0..=HIGHEST).for_each(|n| out(n, (n as f32 * omega * x).cos()));
    }),
    ("fract(n·(x/T)) in f32", |x, period, out| {
        let turns = (x / period) as f32;
        (0..=HIGHEST).for_each(|n| out(n, cos_turns((n as f32 * turns).fract())));
    }),
    ("n·φ in u32, as vglare does", |x, period, out| {
        let first = phase(x, period);
        (0..=HIGHEST).for_each(|n| out(n, cos_turns(n.wrapping_mul(first) as i32 as f32 * 2f32.powi(-32))));
    }),
    ("Chebyshev recurrence in f32", |x, period, out| {
        let first = (TAU * x / period).cos() as f32;
        let (mut before, mut now) = (first, 1.0);
        for n in 0..=HIGHEST {
            out(n, now);
            (before, now) = (now, 2.0 * first * now - before);
        }
    }),
    ("rotation in f32", |x, period, out| {
        let (sine, cosine) = (TAU * x / period).sin_cos();
        let (sine, cosine) = (sine as f32, cosine as f32);
        let (mut c, mut s) = (1.0f32, 0.0f32);
        for n in 0..=HIGHEST {
            out(n, c);
            (c, s) = (c * cosine - s * sine, s * cosine + c * sine);
        }
    }),
];

fn cos_turns(turns: f32) -> f32 {
    (turns * TAU as f32).cos()
}

/// The ways' errors at positions along a picture's width, in a period.
pub(super) fn curves(frame: Frame, period: f64) -> Vec<PhaseCurve> {
    let columns = f64::from(frame.width - 1);
    let positions: Vec<f64> =
        (0..POSITIONS).map(|k| frame.x((columns * f64::from(k) / f64::from(POSITIONS - 1)).round())).collect();
    WAYS.iter().map(|&(way, compute)| PhaseCurve { way, points: errors(compute, &positions, period) }).collect()
}

fn errors(compute: Way, positions: &[f64], period: f64) -> Vec<[f64; 2]> {
    let bin = |n: u32| (BINS * f64::from(n.max(1)).log2()).ceil() as usize;
    let mut bins: Vec<f64> = vec![f64::NAN; bin(HIGHEST) + 1];
    for &x in positions {
        compute(x, period, &mut |n, cosine| {
            let error = (f64::from(cosine) - (TAU * f64::from(n) * (x / period)).cos()).abs();
            // NaN is where nothing came yet; max takes the number.
            bins[bin(n)] = bins[bin(n)].max(error);
        });
    }
    let border = positions.iter().fold(0.0f64, |border, x| border.max(x.abs())) / period;
    let turns = |bin: usize| (bin as f64 / BINS).exp2() * border;
    bins.iter().enumerate().filter(|(_, error)| !error.is_nan()).map(|(bin, &error)| [turns(bin), error]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn phases_in_u32_stay_exact_where_the_others_do_not() {
        let curves = curves(Frame::full(1920, 1080), 20.0);
        let at_end = |name: &str| {
            let curve = curves.iter().find(|curve| curve.way.contains(name)).expect("the way is there");
            curve.points.iter().map(|point| point[1]).fold(0.0, f64::max)
        };
        assert!(at_end("u32") < 5e-6, "{}", at_end("u32"));
        assert!(at_end("cos(n") > 3e-5, "{}", at_end("cos(n"));
        assert!(at_end("Chebyshev") > 1e-2, "{}", at_end("Chebyshev"));
        assert!(at_end("rotation") > 1e-5, "{}", at_end("rotation"));
        // The border is at 16/9 less half a pixel; 4096 of it are 364 turns.
        let last = curves[0].points.last().unwrap()[0];
        assert!((last - 4096.0 * 1919.0 / 1080.0 / 20.0).abs() < 1e-6, "{last}");
    }
}
