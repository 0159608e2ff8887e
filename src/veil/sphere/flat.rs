//! Narrow fields, on a plane: one convolution by transforms, whatever the function's core.
//!
//! Over a few degrees a kernel is one of the pixels' offset, nearly, times a factor of each pixel; what that misses is measured. The
//! transforms are in 64 bits. Their error is relative to all the light there is (Higham, *Accuracy and stability of numerical algorithms*, 24.1:
//! ‖ŷ − y‖₂ ≤ u log₂ n · c ‖y‖₂); but over a narrow field all of the light reaches every pixel, by the kernel's least value at least.
//! So it is relative to the local veil as well, unless a single pixel sends more than all others together: its own veil is then
//! summed directly.

use std::sync::Arc;

use rayon::prelude::*;
use rustfft::num_complex::Complex;
use rustfft::{Fft, FftPlanner};

use super::camera::{Camera, Point, angle};
use super::choose::Task;
use super::measure::{BETWEEN, TARGETS, offsets, target};
use crate::veil::photo::Sources;
use crate::veil::simd::Plane;

/// Powers of the scale by which a pixel counts, that are tried: for kernels that fall as 1/θ⁰ to 1/θ³.
const POWERS: [f64; 4] = [0.0, 0.5, 1.0, 1.5];

/// c of the transforms' error, for radices up to 5 and all four of them, and the product with the kernel's between.
const TRANSFORMS: f64 = 24.0;

/// Columns that are transformed at a time.
const BLOCK: usize = 8;

/// A veil on a narrow field.
#[derive(Clone)]
pub(in crate::veil) struct Flat {
    camera: Camera,
    /// The power of the scale by which source and target count.
    power: f64,
    /// Columns and rows that transforms have.
    padded: [usize; 2],
    /// The kernel's, real and even: from frequency 0 to the half, columns of rows.
    spectrum: Vec<f64>,
    transforms: [Arc<dyn Fft<f64>>; 4],
    /// Bound of the error, and the part of it that is rounding.
    pub bound: f64,
    pub rounding: f64,
}

impl std::fmt::Debug for Flat {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.debug_struct("Flat").field("camera", &self.camera).field("bound", &self.bound).finish_non_exhaustive()
    }
}

/// A kernel of offsets.
struct Offsets<'a> {
    task: &'a Task<'a>,
    power: f64,
}

impl Offsets<'_> {
    fn point(&self, x: f64, y: f64) -> Point {
        self.task.camera.point(x, y)
    }

    /// What the kernel would have to be between two pixels.
    fn needed(&self, one: &Point, other: &Point) -> f64 {
        (self.task.profile)(angle(one.chord(other))) * (one.scale * other.scale).powf(self.power)
    }

    /// In the middle of what pairs need that lie about the picture's middle, or in its corners.
    fn at(&self, [x, y]: [usize; 2]) -> f64 {
        if [x, y] == [0, 0] {
            return 0.0;
        }
        let [u, v] = [x as f64, y as f64];
        let [width, height] = self.task.camera.size.map(|side| side as f64 - 1.0);
        let pairs = [
            [[0.5 * (width - u), 0.5 * (height - v)], [0.5 * (width + u), 0.5 * (height + v)]],
            [[0.0, 0.0], [u, v]],
            [[0.0, v], [u, 0.0]],
        ];
        let [mut low, mut high] = [f64::INFINITY, 0.0f64];
        for [one, other] in pairs {
            let needed = self.needed(&self.point(one[0], one[1]), &self.point(other[0], other[1]));
            (low, high) = (low.min(needed), high.max(needed));
        }
        0.5 * (low + high)
    }

    /// The largest relative error.
    fn error(&self) -> f64 {
        let camera = &self.task.camera;
        let around = |share: &[f64; 2]| {
            let at = target(camera, *share);
            let here = self.point(at[0] as f64, at[1] as f64);
            let wrong = |source: [usize; 2]| {
                let there = self.point(source[0] as f64, source[1] as f64);
                let kernel = self.at([0, 1].map(|side| source[side].abs_diff(at[side])));
                (kernel / self.needed(&here, &there) - 1.0).abs()
            };
            offsets(camera, at).into_iter().map(wrong).fold(0.0, f64::max)
        };
        TARGETS.par_iter().map(around).reduce(|| 0.0, f64::max)
    }
}

impl Flat {
    /// Whether a narrow field is flat enough, and then the way to sum it.
    pub fn new(task: &Task) -> Option<Self> {
        let size = task.camera.size;
        let errors = POWERS.map(|power| (Offsets { task, power }.error(), power));
        let (error, power) = errors.into_iter().min_by(|one, other| one.0.total_cmp(&other.0))?;
        // NaN is none.
        if error.is_nan() || BETWEEN * error >= task.tolerance {
            return None;
        }
        let padded = size.map(|side| smooth(2 * side - 1));
        let kernel = Offsets { task, power };
        let rows: Vec<f64> =
            (0..size[0] * size[1]).into_par_iter().map(|at| kernel.at([at % size[0], at / size[0]])).collect();
        let least = rows.iter().skip(1).copied().fold(f64::INFINITY, f64::min);
        // All four quarters.
        let all = 4.0 * rows.iter().sum::<f64>();
        let unit = 0.5 * f64::EPSILON;
        // The targets' factors are between 1 and the corner's; two channels are transformed at a time, and half of the light may be the
        // pixel's own.
        let factor = task.camera.corner().scale.powf(-power).max(1.0);
        let transforms = TRANSFORMS * ((padded[0] * padded[1]) as f64).log2() * unit;
        let rounding = 2.0 * std::f64::consts::SQRT_2 * factor * transforms * all / least + f64::from(f32::EPSILON);
        let bound = BETWEEN * error + rounding;
        if bound.is_nan() || bound >= task.tolerance {
            return None;
        }
        let mut planner = FftPlanner::new();
        let transforms = [
            planner.plan_fft_forward(padded[0]),
            planner.plan_fft_inverse(padded[0]),
            planner.plan_fft_forward(padded[1]),
            planner.plan_fft_inverse(padded[1]),
        ];
        let mut flat = Self { camera: task.camera, power, padded, spectrum: Vec::new(), transforms, bound, rounding };
        flat.spectrum = flat.spectrum_of(&rows);
        Some(flat)
    }

    /// Operations for each pixel of one channel.
    pub fn operations(&self) -> f64 {
        let pixels = (self.camera.size[0] * self.camera.size[1]) as f64;
        let padded = (self.padded[0] * self.padded[1]) as f64;
        // Four transforms of two channels each, of which three channels are used.
        10.0 / 3.0 * padded * padded.log2() / pixels
    }

    /// The transform of the kernel, over the number of points.
    fn spectrum_of(&self, quarter: &[f64]) -> Vec<f64> {
        let [width, height] = self.camera.size;
        let [columns, rows] = self.padded;
        let count = 1.0 / (columns * rows) as f64;
        let mut along = vec![Complex::new(0.0, 0.0); columns * height];
        along.par_chunks_mut(columns).zip(quarter.par_chunks(width)).for_each(|(row, quarter)| {
            for (x, value) in quarter.iter().enumerate() {
                row[x].re = *value;
                row[(columns - x) % columns].re = *value;
            }
            self.transforms[0].process(row);
        });
        let half = rows / 2 + 1;
        let mut spectrum = vec![0.0; (columns / 2 + 1) * half];
        spectrum.par_chunks_mut(half).enumerate().for_each_init(
            || vec![Complex::new(0.0, 0.0); rows],
            |column, (x, out)| {
                column.fill(Complex::new(0.0, 0.0));
                for y in 0..height {
                    column[y].re = along[y * columns + x].re;
                    column[(rows - y) % rows].re = column[y].re;
                }
                self.transforms[2].process(column);
                out.iter_mut().zip(column.iter()).for_each(|(out, value)| *out = count * value.re);
            },
        );
        spectrum
    }

    /// The veil of three channels, in the scale of each.
    pub fn sum(&self, sources: &[Sources; 3]) -> [Plane<f32>; 3] {
        let [width, height] = self.camera.size;
        let mut veils = [0, 1, 2].map(|_| Plane::new(width, height));
        let mut values = vec![Complex::new(0.0, 0.0); self.padded[0] * height];
        let sums = sources.each_ref().map(|sources| self.all(&sources.plane));
        for pair in [[0, 1], [2, 2]] {
            self.fill(&mut values, pair.map(|channel| (&sources[channel].plane, sums[channel][0])));
            self.convolve(&mut values);
            for (part, channel) in pair.into_iter().enumerate().take(if pair[0] == pair[1] { 1 } else { 2 }) {
                let (values, norm) = (&values, sums[channel][0]);
                veils[channel].par_rows_mut().enumerate().for_each(|(y, out)| {
                    let row = &values[y * self.padded[0]..][..width];
                    for (x, (out, value)) in out.iter_mut().zip(row).enumerate() {
                        let value = norm * if part == 0 { value.re } else { value.im };
                        *out = (value * self.camera.point(x as f64, y as f64).scale.powf(-self.power)).max(0.0) as f32;
                    }
                });
            }
        }
        veils
    }

    /// The length of a channel's sources, as they enter the convolution, and their sum.
    fn all(&self, light: &Plane<f32>) -> [f64; 2] {
        let row = |y: usize| {
            light.row(y)[..light.width()].iter().enumerate().fold([0.0; 2], |[square, sum], (x, light)| {
                if *light == 0.0 {
                    return [square, sum];
                }
                let sent = f64::from(*light) * self.sends(x, y);
                [square + sent * sent, sum + sent]
            })
        };
        let rows: Vec<[f64; 2]> = (0..light.height()).into_par_iter().map(row).collect();
        let [square, sum] = rows.into_iter().fold([0.0; 2], |one, other| [one[0] + other[0], one[1] + other[1]]);
        [square.sqrt(), sum]
    }

    /// What a pixel's light counts.
    fn sends(&self, x: usize, y: usize) -> f64 {
        let point = self.camera.point(x as f64, y as f64);
        point.solid_angle * point.scale.powf(-self.power)
    }

    /// Two channels, each of length 1.
    fn fill(&self, values: &mut [Complex<f64>], channels: [(&Plane<f32>, f64); 2]) {
        let inverse = channels.map(|(_, norm)| if norm > 0.0 { 1.0 / norm } else { 0.0 });
        values.par_chunks_mut(self.padded[0]).enumerate().for_each(|(y, row)| {
            row.fill(Complex::new(0.0, 0.0));
            let [(one, _), (other, _)] = channels;
            let lights = one.row(y)[..one.width()].iter().zip(other.row(y)).zip(row);
            for (x, ((one, other), out)) in lights.enumerate() {
                let sends = self.sends(x, y);
                *out = Complex::new(f64::from(*one) * sends * inverse[0], f64::from(*other) * sends * inverse[1]);
            }
        });
    }

    fn convolve(&self, values: &mut [Complex<f64>]) {
        let [columns, rows] = self.padded;
        let height = self.camera.size[1];
        values.par_chunks_mut(columns).for_each(|row| self.transforms[0].process(row));
        // By blocks of columns, which are brought side by side; those of all blocks lie apart, so that they are taken out and put back.
        let blocks: Vec<Vec<Complex<f64>>> = (0..columns.div_ceil(BLOCK))
            .into_par_iter()
            .map(|block| {
                let first = block * BLOCK;
                let count = BLOCK.min(columns - first);
                let mut all = vec![Complex::new(0.0, 0.0); count * rows];
                for y in 0..height {
                    for (x, value) in values[y * columns + first..][..count].iter().enumerate() {
                        all[x * rows + y] = *value;
                    }
                }
                for (x, column) in all.chunks_exact_mut(rows).enumerate() {
                    self.transforms[2].process(column);
                    let x = (first + x).min(columns - first - x);
                    let half = &self.spectrum[x * (rows / 2 + 1)..][..rows / 2 + 1];
                    for (y, value) in column.iter_mut().enumerate() {
                        *value *= half[y.min(rows - y)];
                    }
                    self.transforms[3].process(column);
                }
                let mut kept = Vec::with_capacity(count * height);
                all.chunks_exact(rows).for_each(|column| kept.extend_from_slice(&column[..height]));
                kept
            })
            .collect();
        values.par_chunks_mut(columns).enumerate().for_each(|(y, row)| {
            for (block, row) in blocks.iter().zip(row.chunks_mut(BLOCK)) {
                row.iter_mut().enumerate().for_each(|(x, out)| *out = block[x * height + y]);
            }
            self.transforms[1].process(row);
        });
    }

    /// The pixel of a channel that sends more than all others together, if there is one.
    pub fn lonely(&self, light: &Plane<f32>) -> Option<[usize; 2]> {
        let [_, sum] = self.all(light);
        let half = 0.5 * (1.0 - 1e-9) * sum;
        let of_row = |y: usize| {
            let mut row = light.row(y)[..light.width()].iter().enumerate();
            row.position(|(x, light)| *light > 0.0 && f64::from(*light) * self.sends(x, y) > half).map(|x| [x, y])
        };
        (0..light.height()).into_par_iter().find_map_any(of_row)
    }
}

/// The least number from `least` on without factors above 5.
fn smooth(least: usize) -> usize {
    let rest = |mut number: usize| {
        for factor in [2, 3, 5] {
            while number.is_multiple_of(factor) {
                number /= factor;
            }
        }
        number
    };
    (least.max(1)..).find(|number| rest(*number) == 1).unwrap_or(least)
}
