//! How far a computed veil is from the truth at most, and what is done where that is too far.

use rayon::prelude::*;

use super::evaluate::{Light, Summed};
use super::{STORED, Transform};
use crate::veil::FLOOR;
use crate::veil::simd::Real;

/// Products that pixels which are summed one by one may cost, of a channel: seconds.
const EFFORT: f64 = 2e9;

/// Half the distance between the smallest numbers of 32 bits, 2⁻¹⁵⁰.
const SMALLEST: f64 = 7.006_492_321_624_085e-46;

/// Values that a thread looks through at a time.
const PART: usize = 1 << 14;

/// Lanes by which extremes are found.
const LANES: usize = 16;

/// Bounds of the error of each sum before it is stored.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Bounds {
    /// In the photo's unit.
    pub absolute: f64,
    /// Over the sum.
    pub relative: f64,
}

impl Bounds {
    /// The bound of a veil, over that or over the floor: `unit` is the larger of the two.
    fn over(&self, unit: f64) -> f64 {
        let absolute = self.absolute + SMALLEST;
        let relative = STORED + self.relative;
        if unit > absolute && unit < f64::INFINITY { relative + absolute / (unit - absolute) } else { f64::INFINITY }
    }

    /// The least unit at which the bound is no more than `tolerance`.
    fn least(&self, tolerance: f64) -> f64 {
        let left = tolerance - STORED - self.relative;
        let absolute = self.absolute + SMALLEST;
        if left > 0.0 { absolute * (1.0 + left) / left } else { f64::INFINITY }
    }
}

/// What holds for a computed veil.
#[derive(Debug, Clone, Copy)]
pub(super) struct Certificate {
    /// Of the error relative to the local veil or to the floor.
    pub bound: f64,
    floor: f64,
}

impl Certificate {
    pub fn new(Summed { plane, bounds, black }: &Summed) -> Self {
        let ends = |one: [f32; 2], other: [f32; 2]| [one[0].min(other[0]), one[1].max(other[1])];
        let none = [f32::INFINITY, 0.0];
        let of_part = |part: &[f32]| {
            let (lanes, rest) = part.as_chunks::<LANES>();
            let mut found = [[f32::INFINITY; LANES], [0.0; LANES]];
            for values in lanes {
                for lane in 0..LANES {
                    let value = values[lane].abs();
                    found[0][lane] = if value < found[0][lane] { value } else { found[0][lane] };
                    found[1][lane] = if value > found[1][lane] { value } else { found[1][lane] };
                }
            }
            let found = (0..LANES).map(|lane| [found[0][lane], found[1][lane]]);
            found.chain(rest.iter().map(|value| [value.abs(); 2])).fold(none, ends)
        };
        let [least, largest] = plane.par_chunks(PART).map(of_part).reduce(|| none, ends).map(f64::from);
        let floor = FLOOR * largest;
        Self { bound: if *black { 0.0 } else { bounds.over(least.max(floor)) }, floor }
    }

    /// How many pixels are below the floor.
    pub fn dark(&self, plane: &[f32]) -> usize {
        let of_part =
            |part: &[f32]| part.iter().map(|value| usize::from(f64::from(value.abs()) < self.floor)).sum::<usize>();
        plane.par_chunks(PART).map(of_part).sum()
    }
}

impl Transform {
    /// Sums pixels by the definition for whose veil the bound is too large, if they are not too many. Returns how many.
    pub(super) fn mend(&self, light: Light, plane: &mut [f32], certificate: &mut Certificate, bounds: Bounds) -> usize {
        let least = bounds.least(self.task.tolerance);
        let floor = certificate.floor;
        if floor.is_infinite() {
            // Some pixel is too bright for 32 bits.
            return 0;
        }
        let lacks = |value: f32| f64::from(value.abs()).max(floor) < least;
        let places: Vec<usize> =
            plane.par_iter().enumerate().filter(|(_, value)| lacks(**value)).map(|(place, _)| place).collect();
        let list = self.list(light);
        if places.len() as f64 * list.count as f64 > EFFORT {
            return 0;
        }
        let (width, unit) = (self.task.size[0], self.unit(light));
        let sums: Vec<[f64; 2]> = places
            .par_iter()
            .map(|place| self.at(light.channel, &list, [place % width, place / width]).map(|sum| unit.of(sum)))
            .collect();
        let terms = (list.longest + 2) as f64 * f64::UNIT;
        let mut worst = self.task.tolerance.min(certificate.bound);
        for (place, [sum, magnitude]) in places.iter().zip(sums) {
            plane[*place] = sum as f32;
            let bounds = Bounds { absolute: terms * magnitude, relative: 0.0 };
            let exact = sum == 0.0 && magnitude == 0.0;
            worst = worst.max(if exact { 0.0 } else { bounds.over(sum.abs().max(floor)) });
        }
        certificate.bound = worst;
        places.len()
    }
}
