//! The veil of a photo, channel by channel.

use rayon::prelude::*;

use super::certify::{Bounds, Certificate};
use super::pixels::Bright;
use super::{Channel, Passes, Rows, Transform, Way};
use crate::veil::evaluate::Veil;
use crate::veil::photo::{Photo, exp2};
use crate::veil::simd::Real;

/// Sums that are carried at a time.
const LANES: usize = 16;

/// A channel of a photo.
#[derive(Debug, Clone, Copy)]
pub(super) struct Light<'a> {
    pub photo: &'a Photo<'a>,
    pub channel: usize,
}

/// A veil, and how far it is from the truth at most.
pub(super) struct Summed {
    pub plane: Vec<f32>,
    pub bounds: Bounds,
    /// Whether there is nothing to sum, and the veil exactly black.
    pub black: bool,
}

/// From sums to the photo's unit.
#[derive(Debug, Clone, Copy)]
pub(super) struct Unit {
    factors: [f64; 2],
    /// Whether sums may be negative.
    signed: bool,
}

impl Unit {
    /// Of sums that are `points` times too large, of taps that were multiplied by a power of two.
    fn new(points: f64, channel: &Channel) -> Self {
        // What is smaller than 64 bits hold is so after both.
        let half = channel.taps.exponent / 2;
        Self { factors: [exp2(half) / points, exp2(channel.taps.exponent - half)], signed: channel.signed }
    }

    pub fn of(self, sum: f64) -> f64 {
        let value = sum * self.factors[0] * self.factors[1];
        if self.signed { value } else { value.max(0.0) }
    }

    fn store(self, sums: &[f64], out: &mut [f32]) {
        out.iter_mut().zip(sums).for_each(|(out, sum)| *out = self.of(*sum) as f32);
    }
}

impl Channel {
    /// How many products a sum over all taps has.
    pub(super) fn terms(&self) -> f64 {
        (self.taps.columns.offsets() * self.taps.rows.offsets()) as f64
    }

    /// The bounds of sums whose terms are rounded by `rounding` together, of a light with this ‖L‖₂: relative to the sum where no
    /// term is negative.
    fn bounds(&self, rounding: f64, norm: f64) -> Bounds {
        if !self.signed {
            return Bounds { absolute: 0.0, relative: rounding };
        }
        Bounds { absolute: Unit::new(1.0, self).of(rounding * self.norm * norm), relative: 0.0 }
    }
}

impl Transform {
    /// The veil of a photo of the size that was planned for.
    pub fn evaluate(&self, photo: &Photo) -> Veil {
        let none = [0; 3];
        let mut veil =
            Veil { planes: Default::default(), bad: photo.bad(), dark: none, lonely: none, certified: [0.0; 3] };
        for channel in 0..3 {
            let light = Light { photo, channel };
            let mut summed = self.summed(light, &[]);
            let mut certificate = Certificate::new(&summed);
            if certificate.bound > self.task.tolerance {
                (summed, certificate) = self.without_brightest(light, summed, certificate);
            }
            if certificate.bound > self.task.tolerance {
                veil.lonely[channel] = self.mend(light, &mut summed.plane, &mut certificate, summed.bounds);
            }
            veil.dark[channel] = certificate.dark(&summed.plane);
            veil.certified[channel] = certificate.bound;
            veil.planes[channel] = summed.plane;
        }
        veil
    }

    /// The same with the brightest pixels summed by themselves, where that is closer.
    fn without_brightest(&self, light: Light, summed: Summed, certificate: Certificate) -> (Summed, Certificate) {
        let bright = if matches!(self.way, Way::Taps) { Vec::new() } else { self.brightest(light) };
        if bright.is_empty() {
            return (summed, certificate);
        }
        let without = self.summed(light, &bright);
        let closer = Certificate::new(&without);
        if closer.bound < certificate.bound { (without, closer) } else { (summed, certificate) }
    }

    /// The sum over all sources, the bright ones by themselves.
    fn summed(&self, light: Light, bright: &[Bright]) -> Summed {
        let [width, height] = self.task.size;
        let mut plane = vec![0.0; width * height];
        let channel = self.channel(light.channel);
        let (bounds, lit) = match &self.way {
            Way::Taps => {
                let unit = Unit::new(1.0, channel);
                self.slide(light, &mut plane, |_, sums, out| unit.store(sums, out));
                let norm = self.norm(light);
                (channel.bounds(channel.terms() * f64::UNIT, norm), norm > 0.0)
            }
            Way::Passes(passes, pool) => {
                let points = passes.size().map(|side| side as f64);
                let (points, rounding) = (points[0] * points[1], self.rounding(passes));
                let unit = Unit::new(points, channel);
                let store = |y: usize, sums: &[f64], out: &mut [f32]| {
                    if bright.is_empty() {
                        return unit.store(sums, out);
                    }
                    let mut sums = sums.to_vec();
                    self.add_bright(light.channel, bright, points, y, &mut sums);
                    unit.store(&sums, out);
                };
                let mut rows = pool.take(|| passes.room(height));
                let norm = self.convolve(passes, &mut rows, light, bright);
                let across = self.margin[0];
                passes.back(&rows, &mut plane, |y, sums, out| store(y, &sums[across..][..width], out));
                pool.give_back(rows);
                let of_bright = self.bounds_of_bright(channel, bright);
                let absolute = Unit::new(1.0, channel).of(rounding * channel.norm * norm);
                let lit = norm > 0.0 || !bright.is_empty();
                (Bounds { absolute: absolute + of_bright.absolute, ..of_bright }, lit)
            }
        };
        Summed { plane, bounds, black: !lit || channel.norm == 0.0 }
    }

    /// The half spectra of photo and kernel convolved, but for bright pixels. Returns ‖L‖₂.
    fn convolve(&self, passes: &Passes, rows: &mut Rows, light: Light, bright: &[Bright]) -> f64 {
        let ([width, height], border) = (self.task.size, self.task.border);
        let [across, down] = self.margin;
        let squares = passes.rows(rows, |y, into| {
            let (seen, rest) = into.split_at_mut(width + 2 * across);
            light.photo.lights(light.channel, y, border, across, seen);
            rest.fill(0.0);
            bright.iter().for_each(|bright| bright.take_out(y, across, seen));
            squares(seen)
        });
        let row_of = |place: usize| {
            let seen = place < height + 2 * down;
            if seen { border.source(place as isize - down as isize, height) } else { None }
        };
        if let Some(spectrum) = &self.channel(light.channel).spectrum {
            passes.multiply(rows, spectrum, row_of, down);
        }
        self.rows_seen().map(|(_, row)| squares[row]).sum::<f64>().sqrt()
    }

    /// ‖L‖₂ of a channel, its border's included.
    fn norm(&self, light: Light) -> f64 {
        let rows = (0..self.task.size[1]).into_par_iter().with_min_len(16);
        let each: Vec<f64> = rows.map(|row| squares(&self.lights(light, row))).collect();
        self.rows_seen().map(|(_, row)| each[row]).sum::<f64>().sqrt()
    }

    /// The bounds of the sums over bright pixels.
    fn bounds_of_bright(&self, channel: &Channel, bright: &[Bright]) -> Bounds {
        if bright.is_empty() {
            return Bounds { absolute: 0.0, relative: 0.0 };
        }
        let terms = (bright.iter().map(Bright::images).sum::<usize>() + 2) as f64 * f64::UNIT;
        // No tap is more than 1.
        let lights: f64 = bright.iter().map(|bright| bright.light * bright.images() as f64).sum();
        channel.bounds(terms, lights / channel.norm.max(f64::MIN_POSITIVE))
    }

    /// From sums to the photo's unit, for a few of them.
    pub(super) fn unit(&self, light: Light) -> Unit {
        Unit::new(1.0, self.channel(light.channel))
    }
}

/// Σ of the squares, in lanes that need not wait for each other.
fn squares(values: &[f64]) -> f64 {
    let (lanes, rest) = values.as_chunks::<LANES>();
    let mut sums = [0.0; LANES];
    for values in lanes {
        sums.iter_mut().zip(values).for_each(|(sum, value)| *sum += value * value);
    }
    sums.iter().sum::<f64>() + rest.iter().map(|value| value * value).sum::<f64>()
}
