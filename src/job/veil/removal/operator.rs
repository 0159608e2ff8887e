//! What a veil does to a photo, as a linear operator: A x = D x + K x.

use rayon::prelude::*;

use super::super::account::Loss;
use super::super::planning::Held;
use super::super::{Channel, Definition, Seat, computed, failed};
use crate::choices::Border;
use crate::look::Veil as Wanted;
use crate::scene::Emission;
use crate::{Result, veil};

/// A number for each sample, by channels: rows of pixels, row 0 on top.
pub type Field = [Vec<f32>; 3];

/// A bound of what is added to a residual, or of a residual: its largest sample, and the root of the sum of its squares.
#[derive(Debug, Clone, Copy, Default)]
pub struct Norms {
    pub largest: f64,
    pub root: f64,
}

impl Norms {
    pub fn of(values: &[f32]) -> Self {
        let both = |value: &f32| (f64::from(value.abs()), f64::from(*value).powi(2));
        let with = |a: (f64, f64), b: (f64, f64)| (a.0.max(b.0), a.1 + b.1);
        // Row by row in their order, so that a sum is the same every time.
        let parts: Vec<_> =
            values.par_chunks(1 << 14).map(|part| part.iter().map(both).fold((0.0, 0.0), with)).collect();
        let (largest, squares) = parts.into_iter().fold((0.0, 0.0), with);
        Self { largest, root: squares.sqrt() }
    }

    pub fn plus(self, other: Self) -> Self {
        Self { largest: self.largest + other.largest, root: self.root + other.root }
    }

    pub fn times(self, factor: f64) -> Self {
        Self { largest: factor * self.largest, root: factor * self.root }
    }
}

/// The veil of light that may be negative.
pub struct Signed {
    /// K x.
    pub veil: Field,
    /// By how much it may be off, by channels.
    pub error: [Norms; 3],
}

/// The operator on the finite samples of a photo; others are no part of it.
pub struct Operator<'a> {
    /// The veil, on the photo's pixels.
    wanted: &'a Wanted,
    seat: Seat,
    strength: f64,
    loses: Loss,
    /// The share of its colour that each pixel gives; none where all give all.
    shares: Option<Vec<f32>>,
    pixels: &'a [[f32; 4]],
    /// How exactly K is summed, relative to itself at each pixel: first, and where less will do.
    plans: [Vec<Channel>; 2],
    /// How often K was summed.
    pub veils: usize,
}

/// Which of an operator's two tolerances its veil is summed to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Within {
    Tight,
    Loose,
}

impl<'a> Operator<'a> {
    /// Plans the veil to two tolerances, relative to itself at each pixel; where one cannot be had, to the lowest that can.
    ///
    /// # Errors
    /// Where there is no plan at all.
    pub fn new(
        wanted: &'a Wanted,
        seat: Seat,
        strength: f64,
        pixels: &'a [[f32; 4]],
        emission: Emission,
        tolerances: [f64; 2],
    ) -> Result<Self> {
        let plan = |asked| -> Result<Vec<Channel>> {
            Ok(Held { asked, least: true }.channels(wanted.psf(), seat.pixels(wanted.border))?.0)
        };
        let plans = match tolerances {
            [tight, loose] if tight >= loose => [plan(tight)?, Vec::new()],
            [tight, loose] => [plan(tight)?, plan(loose)?],
        };
        let shares = emission.straight.then(|| pixels.par_iter().map(|pixel| emission.share(pixel)).collect());
        let loses = Loss::new(wanted, seat, strength);
        Ok(Self { wanted, seat, strength, loses, shares, pixels, plans, veils: 0 })
    }

    /// How the veil is summed where it is to be exact.
    pub fn channels(&self) -> &[Channel] {
        &self.plans[0]
    }

    pub fn wanted(&self) -> &Wanted {
        self.wanted
    }

    pub fn seat(&self) -> Seat {
        self.seat
    }

    pub fn strength(&self) -> f64 {
        self.strength
    }

    /// Whether K is its own transpose where samples count by the area of their pixels.
    pub fn is_symmetric(&self) -> bool {
        let radial = self.channels().iter().all(|(_, definition)| matches!(definition, Definition::Radial(_)));
        radial && self.shares.is_none() && self.wanted.border != Border::Extend
    }

    /// Pixels.
    pub fn len(&self) -> usize {
        self.pixels.len()
    }

    /// Whether a sample is a part of the photo's light.
    pub fn has(&self, channel: usize, pixel: usize) -> bool {
        self.pixels[pixel][channel].is_finite()
    }

    /// The area of a pixel, and D there: what it keeps of its own light, RGB.
    pub fn kept(&self, pixel: usize) -> (f64, [f64; 3]) {
        let (area, lost) = self.loses.at(pixel);
        (area, lost.map(|lost| 1.0 - lost))
    }

    /// A field by a rule for each sample, given the channel, the pixel and D; 0 where there is no light.
    pub fn map(&self, rule: impl Fn(usize, usize, f64) -> f64 + Sync) -> Field {
        let pixels: Vec<[f32; 3]> = (0..self.len())
            .into_par_iter()
            .map(|pixel| {
                let (_, kept) = self.kept(pixel);
                [0, 1, 2].map(|c| if self.has(c, pixel) { rule(c, pixel, kept[c]) as f32 } else { 0.0 })
            })
            .collect();
        [0, 1, 2].map(|c| pixels.par_iter().map(|pixel| pixel[c]).collect())
    }

    /// Light as pixels give it: what is brighter than 0 of a field times a sign.
    pub fn given(&self, field: &Field, sign: f32) -> Vec<[f32; 4]> {
        let [red, green, blue] = field;
        let of = |pixel: usize| {
            let share = self.shares.as_ref().map_or(1.0, |shares| shares[pixel]);
            let [r, g, b] = [red, green, blue].map(|plane| share * (sign * plane[pixel]).max(0.0));
            [r, g, b, 1.0]
        };
        (0..self.len()).into_par_iter().map(of).collect()
    }

    /// K of light that is nowhere negative, and the bound of its error relative to itself, by channels.
    fn veil(&mut self, given: &[[f32; 4]], within: Within) -> Result<(Field, [f64; 3])> {
        let loose = within == Within::Loose && !self.plans[1].is_empty();
        let filled = self.seat.filled(given);
        let sources = veil::Photo::rgba(filled.as_flattened(), self.seat.size).map_err(failed)?;
        let veil = self.seat.cropped(computed(&self.plans[usize::from(loose)], &sources)?);
        self.veils += 1;
        let mut planes = veil.planes;
        let strength = self.strength;
        for plane in &mut planes {
            plane.par_iter_mut().for_each(|value| *value = (strength * f64::from(*value)) as f32);
        }
        // The product is rounded.
        Ok((planes, veil.certified.map(|error| error + super::super::HALF_A_UNIT)))
    }

    /// K of any light: what is brighter and what is darker than 0 is summed apart, since a veil reads no negative light.
    ///
    /// # Errors
    /// Those of the sum.
    pub fn signed_veil(&mut self, light: &Field, within: Within) -> Result<Signed> {
        let mut veil = [0, 1, 2].map(|_| vec![0.0f32; self.len()]);
        let mut error = [Norms::default(); 3];
        for sign in [1.0f32, -1.0] {
            let any = light.iter().any(|plane| plane.par_iter().any(|value| sign * value > 0.0));
            if !any {
                continue;
            }
            let (part, bounds) = self.veil(&self.given(light, sign), within)?;
            for (channel, part) in part.into_iter().enumerate() {
                error[channel] = error[channel].plus(error_of(&part, bounds[channel]));
                let both = veil[channel].par_iter_mut().zip(part).enumerate();
                both.for_each(|(pixel, (sum, part))| {
                    if self.pixels[pixel][channel].is_finite() {
                        *sum += sign * part;
                    }
                });
            }
        }
        Ok(Signed { veil, error })
    }

    /// K 1, from above: the largest sum of a row that there can be at each sample.
    ///
    /// # Errors
    /// Those of the sum.
    pub fn row_sums(&mut self) -> Result<Field> {
        let white = [0, 1, 2].map(|_| vec![1.0f32; self.len()]);
        let (mut sums, bounds) = self.veil(&self.given(&white, 1.0), Within::Loose)?;
        for (sums, bound) in sums.iter_mut().zip(bounds) {
            let floor = veil::FLOOR * f64::from(sums.par_iter().copied().reduce(|| 0.0, f32::max));
            sums.par_iter_mut().for_each(|sum| *sum = ((f64::from(*sum) + floor) / (1.0 - bound)).next_up() as f32);
        }
        Ok(sums)
    }
}

/// What a computed veil may be off by, of which `bound` is relative to the true one.
fn error_of(veil: &[f32], bound: f64) -> Norms {
    let norms = Norms::of(veil);
    // What is darker than the floor is held to that.
    let floor = veil::FLOOR * norms.largest;
    let floored = Norms { largest: 0.0, root: floor * (veil.len() as f64).sqrt() };
    if bound < 1.0 {
        norms.plus(floored).times(bound / (1.0 - bound))
    } else {
        Norms { largest: f64::INFINITY, root: f64::INFINITY }
    }
}
