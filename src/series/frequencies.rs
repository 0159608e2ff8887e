//! Waves of any frequency from one transform of what stands on a lattice.
//!
//! Two products of matrices for each image of a photo would take most of the time there is. But values μ_j have a transform at
//! evenly spaced frequencies, and a B-spline β of order p carries from there to any other: with φ = 2πu_j/L, u_j the number of a point
//! from the middle one and L that of frequencies, as many turns τ apart,
//!
//! ```text
//! Σ_k β(τ − k) e^{−iφk} = β̂(φ) e^{−iφτ} (1 + ε),    |ε| ≤ Σ_{l≠0} |φ / (φ + 2πl)|^p
//! ```
//!
//! so that the transform is taken of μ_j / β̂(φ_j), and ε is the smaller, the more frequencies there are than points (Dutt and Rokhlin,
//! "Fast Fourier transforms for nonequispaced data", 1993, with a B-spline in place of the Gaussian).

use std::f64::consts::{PI, TAU};

use ndarray::Array2;
use pulp::Arch;
use rayon::prelude::*;
use realfft::RealFftPlanner;
use rustfft::FftPlanner;
use rustfft::num_complex::Complex;

use super::special::bspline;
use crate::fast_length::fast_length;

/// Points that a B-spline reaches.
const ORDER: usize = 20;

/// So many frequencies, at least, for each point.
const OVERSAMPLING: f64 = 2.2;

type Wave = Complex<f64>;

/// Of pixels no waves are read that turn faster than this from one to the next, in radians: they repeat themselves after whole turns, and
/// the frequencies of y are gone through once.
pub(crate) const FASTEST: f64 = 1.4 * PI;

/// By how much a wave is off where it comes from a transform of so many points, over all light.
pub(crate) fn error(points: usize) -> f64 {
    let ratio = points as f64 / (2.0 * length(points) as f64 - points as f64);
    // Two of them, and others that are smaller by far; and what doubles lose.
    2.1 * ratio.powi(ORDER as i32) + 1e-13
}

/// Frequencies for so many points.
fn length(points: usize) -> usize {
    fast_length(((OVERSAMPLING * points as f64).ceil() as usize).max(4 * ORDER))
}

/// What computing one of so many points takes, about, in nanoseconds.
pub(crate) fn work(points: [usize; 2]) -> f64 {
    const POINT: f64 = 40.0;
    3.0 * POINT * points.map(|points| length(points) as f64).iter().product::<f64>()
}

/// What the waves of one image take, about, in nanoseconds, by its harmonics of x and y.
pub(crate) fn work_of_waves([n, m]: [f64; 2]) -> f64 {
    const PRODUCT: f64 = 0.5;
    // Frequencies of y for each harmonic of it, on both sides of 0: as the period is to the picture with its padding, about.
    const FREQUENCIES: f64 = 2.0;
    let taps = ORDER as f64;
    3.0 * PRODUCT * taps * 2.0 * (n * (FREQUENCIES * m + taps) + 2.0 * n * m)
}

/// The transform of values on a lattice, of one channel or several.
#[derive(Debug)]
pub(crate) struct Spectrum {
    /// Frequencies along x and y.
    length: [usize; 2],
    /// Of each channel: for each frequency of x from none on a row of all frequencies of y.
    waves: Vec<Vec<Wave>>,
}

impl Spectrum {
    /// Of columns and rows of values, each a channel's by column and row; counted from the middle ones.
    pub fn new(channels: usize, points: [usize; 2], value: impl Fn(usize, usize, usize) -> f64 + Sync) -> Self {
        let length = points.map(length);
        let columns = length[0] / 2 + 1;
        let gains = [0, 1].map(|axis| gains(points[axis], length[axis]));
        let channel = |channel: usize| {
            let along = along_rows(points, length[0], |x, y| value(channel, x, y) * gains[0][x] * gains[1][y]);
            down_columns(&along, points[1], [columns, length[1]])
        };
        Self { length, waves: (0..channels).map(channel).collect() }
    }

    /// Sums over cos cos, sin cos, cos sin and sin sin of so many harmonics of the first waves, in radians a point, of either sign.
    pub fn waves(&self, channel: usize, first: [f64; 2], harmonics: [usize; 2]) -> [Array2<f64>; 4] {
        let turns = [0, 1].map(|axis| first[axis].abs() / TAU * self.length[axis] as f64);
        let [n, m] = harmonics;
        let mut sums = [0; 4].map(|_| Array2::zeros((n, m)));
        // The frequencies of y that there are waves between.
        let most = (turns[1] * (m - 1) as f64).ceil() as isize + ORDER as isize;
        let down: Vec<Spline> = (0..m).map(|m| Spline::at(turns[1] * m as f64)).collect();
        let sign = first.map(f64::signum);
        let mut column = vec![Wave::ZERO; 2 * most as usize + 1];
        for n in 0..n {
            self.column(channel, &Spline::at(turns[0] * n as f64), most, &mut column);
            for (m, spline) in down.iter().enumerate() {
                // At the frequency itself, and at the opposite one, where the same spline stands the other way round.
                let from = |first: isize| &column[(most + first) as usize..][..ORDER];
                let [mut plus, mut minus] = [Wave::ZERO; 2];
                let mirrored = from(1 - spline.first - ORDER as isize).iter().rev();
                for ((weight, above), below) in spline.weights.iter().zip(from(spline.first)).zip(mirrored) {
                    plus += above * weight;
                    minus += below * weight;
                }
                let (sum, difference) = (plus + minus, plus - minus);
                sums[0][(n, m)] = 0.5 * sum.re;
                sums[1][(n, m)] = -0.5 * sign[0] * sum.im;
                sums[2][(n, m)] = -0.5 * sign[1] * difference.im;
                sums[3][(n, m)] = -0.5 * sign[0] * sign[1] * difference.re;
            }
        }
        sums
    }

    /// The waves at one frequency of x, at frequencies of y from −`most` to `most`.
    fn column(&self, channel: usize, spline: &Spline, most: isize, column: &mut [Wave]) {
        let [columns, rows] = self.length.map(|length| length as isize);
        column.fill(Wave::ZERO);
        for (k, weight) in (spline.first..).zip(spline.weights) {
            let k = k.rem_euclid(columns);
            // Of what is real, the other half is the conjugate.
            let (stored, conjugated) = if k <= columns / 2 { (k, false) } else { (columns - k, true) };
            let wave = &self.waves[channel][(stored * rows) as usize..][..rows as usize];
            // In two runs, from 0 up and from −1 down.
            let (below, above) = column.split_at_mut(most as usize);
            let add = |to: &mut [Wave], from: &[Wave]| {
                Arch::new().dispatch(
                    #[inline(always)]
                    || to.iter_mut().zip(from).for_each(|(to, from)| *to += from * weight),
                );
            };
            let (up, down) = (&wave[..above.len()], &wave[wave.len() - below.len()..]);
            if conjugated {
                let back = |values: &[Wave]| values.iter().rev().map(Wave::conj).collect::<Vec<_>>();
                // At −y: 0, −1, −2, … and …, 2, 1.
                let ups: Vec<Wave> = std::iter::once(wave[0].conj())
                    .chain(wave[wave.len() + 1 - above.len()..].iter().rev().map(Wave::conj))
                    .collect();
                add(above, &ups);
                add(below, &back(&wave[1..=below.len()]));
            } else {
                add(above, up);
                add(below, down);
            }
        }
    }
}

/// A B-spline about a place, in frequencies: what it is at so many of them from the first on.
struct Spline {
    first: isize,
    weights: [f64; ORDER],
}

impl Spline {
    fn at(place: f64) -> Self {
        let below = place.floor();
        let weights = bspline(place - below);
        Self { first: below as isize - (ORDER as isize / 2 - 1), weights }
    }
}

/// One over the spline's transform at each point.
fn gains(points: usize, length: usize) -> Vec<f64> {
    let gain = |point: usize| {
        let half = PI * (point as f64 - middle(points) as f64) / length as f64;
        if half == 0.0 { 1.0 } else { (half / half.sin()).powi(ORDER as i32) }
    };
    (0..points).map(gain).collect()
}

/// The point that is counted from.
pub(crate) fn middle(points: usize) -> usize {
    points / 2
}

/// The transforms of all rows: a row of half of the frequencies for each.
fn along_rows([columns, rows]: [usize; 2], length: usize, value: impl Fn(usize, usize) -> f64 + Sync) -> Array2<Wave> {
    let transform = RealFftPlanner::<f64>::new().plan_fft_forward(length);
    let mut all = Array2::from_elem((rows, length / 2 + 1), Wave::ZERO);
    let tasks = all.as_slice_mut().unwrap_or_default().par_chunks_mut(length / 2 + 1).enumerate();
    tasks.for_each_init(
        || (transform.make_input_vec(), transform.make_scratch_vec()),
        |(input, scratch), (y, row)| {
            input.fill(0.0);
            for x in 0..columns {
                input[(x + length - middle(columns)) % length] = value(x, y);
            }
            transform.process_with_scratch(input, row, scratch).expect("buffers are of the planner's lengths");
        },
    );
    all
}

/// The transforms of some columns, of which `rows` have something, one after the other.
fn down_columns(along: &Array2<Wave>, rows: usize, [columns, length]: [usize; 2]) -> Vec<Wave> {
    let transform = FftPlanner::<f64>::new().plan_fft_forward(length);
    let mut all = vec![Wave::ZERO; columns * length];
    all.par_chunks_mut(length).enumerate().for_each_init(
        || vec![Wave::ZERO; transform.get_inplace_scratch_len()],
        |scratch, (k, column)| {
            for y in 0..rows {
                column[(y + length - middle(rows)) % length] = along[(y, k)];
            }
            transform.process_with_scratch(column, scratch);
        },
    );
    all
}
