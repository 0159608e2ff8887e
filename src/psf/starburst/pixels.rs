//! What of a pattern falls on pixels: means over them, not values at their middles.

use rayon::prelude::*;

use super::pattern::Pattern;
use crate::psf::kernel::sums;

/// To this radius, in λ₀N, fringes are seen in white light; to there, and to so many pixels, a pixel's mean is taken over both axes.
const FRINGES: f64 = 16.0;
/// Half the width of a spike's middle, in λ₀N.
const SPIKE: f64 = 3.0;
const CLOSE: f64 = 4.0;
/// A pixel's parts there, each of two by two samples, are at most this wide, in λ₀N, but no more than so many along a side: pixels
/// that are wider than that have hardly any light, and its sum is right: see `around`.
const PART: f64 = 0.4;
const MOST_PARTS: f64 = 180.0;
/// Across a spike, samples are at most so far apart, in λ₀N on the spike itself and where there are fringes, or of the distance from its
/// middle; of a pixel at most so many.
const STEPS: [f64; 2] = [0.25, 0.5];
const STEP_OF_DISTANCE: f64 = 0.2;
const MOST_STEPS: f64 = 512.0;
/// To so many pixels a spike's fall along itself counts within a pixel.
const FALLING: f64 = 32.0;

/// Pixels around a point, and how the pattern lies on them.
pub(super) struct Pixels<'a> {
    pattern: &'a Pattern,
    /// The side of a pixel in λ₀N.
    side: f64,
    spikes: Vec<Spike>,
    /// The direction of the first spike, and the angle to the next; radians against the clock from the right.
    first: f64,
    spacing: f64,
}

/// A direction.
struct Spike {
    sine: f64,
    cosine: f64,
}

impl<'a> Pixels<'a> {
    /// Pixels of a side, in λ₀N, for a pattern whose aperture is turned by so many radians against the clock.
    pub fn new(pattern: &'a Pattern, side: f64, rotation: f64) -> Self {
        let aperture = pattern.aperture();
        let first = rotation + aperture.first_spike();
        let spacing = 2.0 * aperture.sector();
        let count = (std::f64::consts::TAU / spacing).round() as usize;
        let spike = |index: usize| {
            let (sine, cosine) = (first + spacing * index as f64).sin_cos();
            Spike { sine, cosine }
        };
        Self { pattern, side, spikes: (0..count).map(spike).collect(), first, spacing }
    }

    /// The light that falls beyond the rectangle of so many pixels to either side of the middle one, and above and below.
    pub fn outside(&self, [across, up]: [usize; 2]) -> [f64; 3] {
        let [across, up] = [across, up].map(|reach| (reach as f64 + 0.5) * self.side);
        self.pattern.outside(self.first, |direction| {
            let (sine, cosine) = direction.sin_cos();
            (across / cosine.abs()).min(up / sine.abs())
        })
    }

    /// What falls on all of these pixels but the middle one, which is 0; row by row from the top. Their sum is what lies between the edges
    /// of that one and of all: samples alone meet it within some ten-thousandths of the light.
    pub fn around(&self, [across, up]: [usize; 2]) -> Vec<[f64; 3]> {
        let columns = 2 * across + 1;
        let mut pixels = vec![[0.0; 3]; columns * (2 * up + 1)];
        let middle = pixels.len() / 2;
        // The same on the other side, as the transform of what is real.
        let (above, rest) = pixels.split_at_mut(middle);
        above.par_chunks_mut(columns).enumerate().for_each(|(row, pixels)| {
            for (column, pixel) in pixels.iter_mut().enumerate() {
                *pixel = self.pixel(column as f64 - across as f64, (up - row) as f64);
            }
        });
        let [whole, beyond] = [self.outside([0, 0]), self.outside([across, up])];
        let sampled = sums(above);
        let by = [0, 1, 2].map(|k| if sampled[k] > 0.0 { 0.5 * (whole[k] - beyond[k]) / sampled[k] } else { 1.0 });
        above.par_iter_mut().for_each(|pixel| (0..3).for_each(|k| pixel[k] *= by[k]));
        rest[1..].par_iter_mut().zip(above.par_iter().rev()).for_each(|(below, above)| *below = *above);
        pixels
    }

    /// The light of the pixel whose middle lies so many pixels to the right and above.
    fn pixel(&self, right: f64, above: f64) -> [f64; 3] {
        let distance = length(right, above);
        let sum = if distance < CLOSE || distance * self.side < FRINGES {
            self.close(right, above)
        } else if self.pattern.aperture().is_round() {
            self.pattern.at(distance * self.side, 0.0).map(f64::from)
        } else {
            self.far(right, above, distance)
        };
        sum.map(|light| light * self.side * self.side)
    }

    /// The index of the spike that is nearest to a direction, and the angle to it.
    fn nearest(&self, direction: f64) -> (usize, f64) {
        let turns = (direction - self.first) / self.spacing;
        let index = turns.round();
        ((index as isize).rem_euclid(self.spikes.len() as isize) as usize, (turns - index).abs() * self.spacing)
    }

    /// The mean over a pixel by samples along both axes (Gauss's two points in each part).
    fn close(&self, right: f64, above: f64) -> [f64; 3] {
        let parts = (self.side / PART).ceil().min(MOST_PARTS);
        let count = 2 * parts as usize;
        let off = |sample: usize| {
            let point = if sample.is_multiple_of(2) { -1.0 } else { 1.0 } / 12.0_f64.sqrt();
            ((sample / 2) as f64 + 0.5 + point) / parts - 0.5
        };
        let mut sum = [0.0; 3];
        for y in (0..count).map(|row| (above + off(row)) * self.side) {
            for x in (0..count).map(|column| (right + off(column)) * self.side) {
                let angle = if self.pattern.aperture().is_round() { 0.0 } else { self.nearest(y.atan2(x)).1 };
                let light = self.pattern.at(length(x, y), angle);
                (0..3).for_each(|k| sum[k] += f64::from(light[k]));
            }
        }
        sum.map(|sum| sum / (count * count) as f64)
    }

    /// The same by samples across the nearest spike, along which the pattern changes little: over distances from its middle a
    /// square counts as a trapezoid. Across and along, the places in a square are not correlated.
    fn far(&self, right: f64, above: f64, distance: f64) -> [f64; 3] {
        let (index, angle) = self.nearest(above.atan2(right));
        let Spike { sine, cosine } = self.spikes[index];
        let [off, along] = [above * cosine - right * sine, right * cosine + above * sine].map(|x| x * self.side);
        let [short, long] = [sine.abs().min(cosine.abs()), sine.abs().max(cosine.abs())].map(|x| x * self.side);
        let width = short + long;
        let closest = (off.abs() - 0.5 * width).max(0.0);
        let step = match closest {
            ..SPIKE => STEPS[0],
            ..FRINGES => STEPS[1],
            _ => STEP_OF_DISTANCE * closest,
        };
        let steps = (width / step).ceil().min(MOST_STEPS);
        let ways = if distance < FALLING { [-1.0, 1.0].map(|way| way * self.side / 12.0_f64.sqrt()) } else { [0.0; 2] };
        if steps <= 1.0 && ways[0] == 0.0 {
            return self.pattern.at(distance * self.side, angle).map(f64::from);
        }
        let (mut sum, mut all) = ([0.0; 3], 0.0);
        for step in 0..steps as usize {
            let from_middle = width * ((step as f64 + 0.5) / steps - 0.5);
            // Of two boxes, one after the other.
            let weight = (0.5 * width - from_middle.abs()).min(short).max(0.0) + 1e-12 * width;
            for &way in if ways[0] == 0.0 { &ways[..1] } else { &ways[..] } {
                let [across, along] = [(off + from_middle).abs(), along + way];
                let light = self.pattern.at(length(across, along), self.folded(across.atan2(along)));
                (0..3).for_each(|k| sum[k] += weight * f64::from(light[k]));
                all += weight;
            }
        }
        sum.map(|sum| sum / all)
    }

    /// An angle beyond the middle between spikes as that to the next one.
    fn folded(&self, angle: f64) -> f64 {
        if 2.0 * angle > self.spacing { (self.spacing - angle).max(0.0) } else { angle }
    }
}

/// Of numbers whose squares are none too large or small, in a fraction of the time of `hypot`.
fn length(x: f64, y: f64) -> f64 {
    (x * x + y * y).sqrt()
}
