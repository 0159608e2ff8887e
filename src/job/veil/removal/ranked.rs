//! How much of a field a kernel can gather at one pixel at most, wherever both lie: the largest value by the largest, and so on.
//!
//! Σ k(a) x(a) ≤ Σ kᵢ xᵢ, both in falling order (Hardy, Littlewood and Pólya, *Inequalities*, theorem 368). Light is most often in few pixels,
//! and this is then far below the sum of the kernel times the largest of the field.

use rayon::prelude::*;

/// Kernel values that are told apart, for each octave; those of a bin count as its largest.
const BINS: i32 = 64;
/// The same of a field.
const LEVELS: f64 = 16.0;
/// Octaves; what is less counts as if it were at the last.
const OCTAVES: usize = 40;

/// The values of a kernel by their size.
pub struct Ranked {
    /// How often each bin is there, and its largest value, falling.
    bins: Vec<[f64; 2]>,
}

impl Ranked {
    /// Of values and how often each is there.
    pub fn new(values: impl Iterator<Item = [f64; 2]>, largest: f64) -> Self {
        let value = |bin: usize| largest * (-(bin as f64) / f64::from(BINS)).exp2();
        let mut bins: Vec<[f64; 2]> = (0..=OCTAVES * BINS as usize).map(|bin| [0.0, value(bin)]).collect();
        let last = bins.len() - 1;
        for [value, times] in values {
            bins[below(value / largest, f64::from(BINS), last)][0] += times;
        }
        Self { bins }
    }

    /// The sum of the `count` largest values, from above.
    fn sum(&self, count: f64) -> f64 {
        let (mut left, mut sum) = (count, 0.0);
        for [times, value] in &self.bins {
            let taken = times.min(left);
            sum += taken * value;
            left -= taken;
            if left <= 0.0 {
                break;
            }
        }
        sum
    }

    /// The largest sum of the kernel over a field, by what its values are without their signs; `row` is the largest sum of the kernel.
    pub fn gathers(&self, field: &[f32], row: f64) -> f64 {
        let largest = f64::from(field.par_iter().map(|value| value.abs()).reduce(|| 0.0, f32::max));
        if largest == 0.0 {
            return 0.0;
        }
        let last = OCTAVES * LEVELS as usize;
        let count = |part: &[f32]| {
            let mut counts = vec![0u64; last + 1];
            part.iter().for_each(|value| counts[below(f64::from(value.abs()) / largest, LEVELS, last)] += 1);
            counts
        };
        let add = |mut one: Vec<u64>, other: Vec<u64>| {
            one.iter_mut().zip(other).for_each(|(one, other)| *one += other);
            one
        };
        let counts = field.par_chunks(1 << 14).map(count).reduce(|| vec![0; last + 1], add);
        let level = |step: usize| largest * (-(step as f64) / LEVELS).exp2();
        let (mut above, mut sum) = (0u64, 0.0);
        for (step, count) in counts[..last].iter().enumerate() {
            above += count;
            // Where the field is above the next level, it is that much higher at most.
            sum += (level(step) - level(step + 1)) * self.sum(above as f64).min(row);
        }
        sum + level(last) * row
    }
}

/// In which bin a share of the largest value is, from the largest down: rather in one that is too high.
fn below(share: f64, bins: f64, last: usize) -> usize {
    if share > 0.0 { ((-share.log2() * bins - 1e-6).max(0.0) as usize).min(last) } else { last }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chance::Chance;

    #[test]
    fn no_sum_is_above_that_of_the_ranked_values() {
        let mut chance = Chance::new(11);
        for steepness in [0.5, 3.0, 20.0] {
            let mut kernel: Vec<f64> = (0..400).map(|k| (1.0 + 0.1 * f64::from(k)).powf(-steepness)).collect();
            let mut field: Vec<f32> = (0..400).map(|_| chance.between(0.0, 1.0).powi(9) as f32).collect();
            let ranked = Ranked::new(kernel.iter().map(|value| [*value, 1.0]), 1.0);
            let row: f64 = kernel.iter().sum();
            let bound = ranked.gathers(&field, row);
            let sum = |field: &[f32]| kernel.iter().zip(field).map(|(k, x)| k * f64::from(*x)).sum::<f64>();
            assert!(sum(&field) <= bound && bound <= row, "{bound} of {row}");
            field.sort_by(|a, b| b.total_cmp(a));
            kernel.sort_by(|a, b| b.total_cmp(a));
            let best: f64 = kernel.iter().zip(&field).map(|(k, x)| k * f64::from(*x)).sum();
            assert!(best <= bound && bound < 1.1 * best, "{steepness}: {bound} for {best}");
        }
    }
}
