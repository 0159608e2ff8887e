//! The veil on a plane by its transform, for what no sum of positive Gaussians is: any function of the distance, any picture as a
//! kernel, any tolerance that 32-bit floats hold.
//!
//! The photo, with what its border adds, is padded with zeros so that nothing comes around, transformed in 64 bits, multiplied by
//! the kernel's transform, and transformed back ([`passes`]). The kernel is 0 at the source itself. Where the kernel or the photo is
//! so small that a sum over all offsets costs less, that is taken ([`direct`]).
//!
//! # The bound
//!
//! A transform rounds relative to the whole photo, not to the veil at a pixel. With n the binary logarithm of the number of
//! points, u half the distance from 1 to the next number, and β the largest error of a root of unity, a convolution by three
//! transforms of n steps is off by at most
//!
//! ‖k‖₂ ‖L‖₂ ((1 + u)^3n (1 + √5 u)^(3n + 1) (1 + β)^3n − 1)
//!
//! at every pixel (C. Percival, *Rapid multiplication modulo the sum and difference of highly composite numbers*, Math. Comp. 72
//! (2003) 387, with the √5 of R. Brent, C. Percival and P. Zimmermann, *Error bounds on complex floating-point multiplication*,
//! Math. Comp. 76 (2007) 1469). That is for steps of radix 2; here are larger ones too, which multiply by roots of unity less often
//! for each binary digit. It is the worst case: what happens is some thousand times less.
//!
//! ‖k‖₂ is known to the plan, ‖L‖₂ and the veil it is relative to are not: so [`super::Predicted::bound`] is the
//! tolerance, its rounding that of a photo that is even, and [`super::Veil::certified`] says of a computed veil what holds for its
//! own photo. Where that would be more than the tolerance, the brightest pixels are taken out and summed one by one, and pixels
//! whose veil is too dark still are summed by the definition, so far as there are not too many of either.

mod certify;
mod cost;
mod direct;
mod evaluate;
mod passes;
mod pixels;
mod taps;

use super::error::Error;
use super::evaluate::Pool;
use super::geometry::Border;
use super::picture::Picture;
use super::simd::Real;
use crate::fast_length::fast_length;
use cost::Cost;
use passes::{Passes, Rows, Spectrum};
use taps::Taps;

pub(super) use cost::pyramid_nanoseconds;

/// Bytes that a plan and its evaluation may take.
pub const MOST_MEMORY: usize = 16 << 30;

/// Of a number that is rounded to 32 bits.
const STORED: f64 = <f32 as Real>::UNIT;

/// Of a root of unity in 64 bits, whose angle, of up to 2π, is rounded three times: in units of u.
const ROOT: f64 = 16.0;

/// What is asked for.
#[derive(Debug, Clone, Copy)]
pub(super) struct Task {
    pub size: [usize; 2],
    pub border: Border,
    pub tolerance: f64,
}

/// Some veil on a plane.
#[derive(Debug)]
pub(super) struct Transform {
    task: Task,
    /// One for all channels, or one each.
    channels: Vec<Channel>,
    /// Columns and rows beyond each edge that are seen.
    margin: [usize; 2],
    way: Way,
    pub cost: Cost,
}

/// The kernel of a channel.
#[derive(Debug)]
struct Channel {
    taps: Taps,
    /// ‖k‖₂ of the taps.
    norm: f64,
    /// ‖k‖₁ of the taps.
    sum: f64,
    signed: bool,
    spectrum: Option<Spectrum>,
}

#[derive(Debug)]
enum Way {
    /// Every tap at every pixel.
    Taps,
    Passes(Passes, Pool<Rows>),
}

/// Which way is taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Choice {
    Cheaper,
    #[cfg(test)]
    Taps,
    #[cfg(test)]
    Passes,
}

impl Task {
    /// How many columns and rows lie between two pixels at most.
    pub fn most(&self) -> [usize; 2] {
        let beyond = if self.border == Border::None { [0, 0] } else { self.size };
        [0, 1].map(|side| self.size[side] - 1 + beyond[side])
    }
}

impl Transform {
    /// The veil of a function of the distance in pixels.
    pub fn of_profile(
        task: Task,
        value: impl Fn(f64) -> f64 + Sync,
        signed: bool,
        choice: Choice,
    ) -> Result<Self, Error> {
        // Before there is a table of all offsets.
        Cost::of_widest(&task).check()?;
        Self::new(task, vec![Taps::of_profile(value, task.most(), signed)?], choice)
    }

    /// The veil of a picture.
    pub fn of_picture(task: Task, picture: &Picture, choice: Choice) -> Result<Self, Error> {
        let mut taps: Vec<Taps> = (0..3).map(|channel| Taps::of_picture(picture, channel, task.most())).collect();
        if taps[1] == taps[0] && taps[2] == taps[0] {
            taps.truncate(1);
        }
        Self::new(task, taps, choice)
    }

    fn new(task: Task, taps: Vec<Taps>, choice: Choice) -> Result<Self, Error> {
        let reach = [0, 1].map(|side| {
            let axes = taps.iter().map(|taps| [taps.columns, taps.rows][side]);
            axes.fold([0, 0], |[before, after], axis| [before.max(axis.before), after.max(axis.after)])
        });
        let farthest = reach.map(|[before, after]| before.max(after));
        let margin =
            [0, 1].map(|side| if task.border == Border::None { 0 } else { farthest[side].min(task.size[side]) });
        let points = [0, 1].map(|side| {
            let seen = task.size[side] + margin[side] + margin[side].max(farthest[side]);
            fast_length(seen.max(reach[side][0] + reach[side][1] + 1))
        });
        let cost = Cost::new(&task, &taps, points);
        let by_taps = match choice {
            Choice::Cheaper => cost.by_taps(),
            #[cfg(test)]
            Choice::Taps => true,
            #[cfg(test)]
            Choice::Passes => false,
        };
        let cost = if by_taps { cost.of_taps() } else { cost };
        cost.check()?;
        let way = if by_taps { Way::Taps } else { Way::Passes(Passes::new(points), Pool::default()) };
        let channels = taps.into_iter().map(|taps| Channel::new(taps, &way)).collect();
        let transform = Self { task, channels, margin, way, cost };
        let best = transform.even();
        if best > task.tolerance {
            return Err(Error::OutOfReach { asked: task.tolerance, best, distance: 0.0 });
        }
        Ok(transform)
    }

    /// The bound to which an evaluation is held, and that of an even photo.
    pub fn predicted(&self) -> [f64; 2] {
        let signed = self.channels.iter().any(|channel| channel.signed);
        let even = self.even();
        [if matches!(self.way, Way::Taps) && !signed { even } else { self.task.tolerance }, even]
    }

    /// The bound of the error of an even photo, relative to the local veil where that sees a quarter of the kernel at least.
    fn even(&self) -> f64 {
        let sources = [0, 1].map(|side| (self.task.size[side] + 2 * self.margin[side]) as f64);
        let relative = |channel: &Channel| match &self.way {
            Way::Taps => channel.terms() * f64::UNIT,
            Way::Passes(passes, _) => {
                let even = (sources[0] * sources[1]).sqrt() * channel.norm / channel.sum.max(f64::MIN_POSITIVE);
                4.0 * self.rounding(passes) * even
            }
        };
        STORED + self.channels.iter().map(relative).fold(0.0, f64::max)
    }

    /// By how much a convolution is off at most, over ‖k‖₂ ‖L‖₂.
    fn rounding(&self, passes: &Passes) -> f64 {
        let root = 5f64.sqrt();
        // A real transform is one of half the length and a step more.
        let steps = 3.0 * (passes.size().map(|side| (side as f64).log2()).iter().sum::<f64>() + 2.0);
        // The last: the scaling, and the square of sums of roundings.
        f64::UNIT * (steps * (1.0 + root + ROOT) + root + 2.0)
    }

    /// What a function that reaches across the photo takes at least: there is none of that which costs less.
    pub fn least_nanoseconds(task: &Task) -> f64 {
        Cost::of_widest(task).nanoseconds
    }

    /// The points of the transform, columns and rows; none where every tap is summed.
    pub fn points(&self) -> Option<[usize; 2]> {
        match &self.way {
            Way::Taps => None,
            Way::Passes(passes, _) => Some(passes.size()),
        }
    }

    /// Which of the kernels is a channel's.
    fn channel(&self, channel: usize) -> &Channel {
        &self.channels[channel.min(self.channels.len() - 1)]
    }
}

impl Channel {
    fn new(taps: Taps, way: &Way) -> Self {
        let norm = taps.sum(|value| value * value).sqrt();
        let sum = taps.sum(f64::abs);
        let spectrum = match way {
            Way::Taps => None,
            Way::Passes(passes, _) => Some(spectrum(passes, &taps)),
        };
        Self { signed: taps.is_signed(), norm, sum, spectrum, taps }
    }
}

/// The kernel's transform.
fn spectrum(passes: &Passes, taps: &Taps) -> Spectrum {
    let mut rows = passes.room(taps.rows.kept());
    let [width, height] = passes.size();
    let kept = taps.columns.kept();
    passes.rows(&mut rows, |row, into| {
        let values = &taps.values[row * kept..][..kept];
        let at = |place: usize| taps.columns.wrapped(place, width).map_or(0.0, |index| values[index]);
        into.iter_mut().enumerate().for_each(|(place, into)| *into = at(place));
    });
    passes.spectrum(&rows, |place| taps.rows.wrapped(place, height), taps.is_even())
}
