//! Photos as sources: three planes, without what cannot send light.

use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

use super::error::Error;
use super::geometry::Border;
use super::simd::Plane;

/// The brightest pixel of a channel is scaled to between this power of two and half of it: room above for sums, and for
/// kernels' tails below, so that neither overflows nor loses bits.
const TOP: i32 = 60;

/// Sources darker than this share of the brightest, 2⁻¹⁰⁰, are left out: even 10⁹ of them make no 10⁻²⁰ of the largest veil.
const SHARE: f32 = 7.888_609e-31;

/// The pixels of a photo, as they lie in memory; row 0 is on top.
#[derive(Debug, Clone, Copy)]
pub struct Photo<'a> {
    size: [usize; 2],
    values: Values<'a>,
}

#[derive(Debug, Clone, Copy)]
enum Values<'a> {
    Interleaved { values: &'a [f32], channels: usize },
    Planes([&'a [f32]; 3]),
}

/// Pixels that were taken as black, by channels.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct BadSources {
    /// NaN.
    pub undefined: [usize; 3],
    /// Infinite, of either sign.
    pub infinite: [usize; 3],
    /// Negative and finite.
    pub negative: [usize; 3],
}

/// What a channel's values are multiplied by before the veil is summed, and what of them is no source.
#[derive(Debug, Clone, Copy, Default)]
struct Survey {
    brightest: f32,
    undefined: usize,
    infinite: usize,
    negative: usize,
}

/// A channel as a source.
pub(crate) struct Sources {
    /// Values times 2^`exponent`.
    pub plane: Plane<f32>,
    pub exponent: i32,
}

impl<'a> Photo<'a> {
    /// A photo of `size` columns and rows whose values are interleaved: red, green, blue, alpha, pixel by pixel. Alpha is no light.
    ///
    /// # Errors
    /// As many values as the size does not ask for.
    pub fn rgba(values: &'a [f32], size: [usize; 2]) -> Result<Self, Error> {
        check(values.len(), 4 * size[0] * size[1])?;
        Ok(Self { size, values: Values::Interleaved { values, channels: 4 } })
    }

    /// The same without alpha.
    ///
    /// # Errors
    /// As [`Photo::rgba`].
    pub fn rgb(values: &'a [f32], size: [usize; 2]) -> Result<Self, Error> {
        check(values.len(), 3 * size[0] * size[1])?;
        Ok(Self { size, values: Values::Interleaved { values, channels: 3 } })
    }

    /// A photo in three planes of rows.
    ///
    /// # Errors
    /// As [`Photo::rgba`].
    pub fn planes(planes: [&'a [f32]; 3], size: [usize; 2]) -> Result<Self, Error> {
        for plane in planes {
            check(plane.len(), size[0] * size[1])?;
        }
        Ok(Self { size, values: Values::Planes(planes) })
    }

    /// Columns and rows.
    pub fn size(&self) -> [usize; 2] {
        self.size
    }

    /// A channel's value, as it stands in the photo.
    pub fn value(&self, channel: usize, x: usize, y: usize) -> f32 {
        let pixel = y * self.size[0] + x;
        match self.values {
            Values::Interleaved { values, channels } => values[pixel * channels + channel],
            Values::Planes(planes) => planes[channel][pixel],
        }
    }

    /// A row of interleaved values, or a row of each plane.
    fn row(&self, y: usize) -> Row<'a> {
        let width = self.size[0];
        match self.values {
            Values::Interleaved { values, channels: 4 } => {
                Row::Four(values[4 * y * width..][..4 * width].as_chunks().0)
            }
            Values::Interleaved { values, .. } => Row::Three(values[3 * y * width..][..3 * width].as_chunks().0),
            Values::Planes(planes) => Row::Planes(planes.map(|plane| plane[y * width..][..width].as_chunks().0)),
        }
    }

    fn survey(&self, arch: Arch) -> [Survey; 3] {
        let rows = (0..self.size[1]).into_par_iter().with_min_len(16).map(|y| match self.row(y) {
            Row::Four(row) => arch.dispatch(Look(row)),
            Row::Three(row) => arch.dispatch(Look(row)),
            Row::Planes(rows) => rows.map(|row| arch.dispatch(Look(row))[0]),
        });
        rows.reduce(Default::default, |one, other| std::array::from_fn(|channel| one[channel].with(other[channel])))
    }

    /// Takes over the three channels, with `margin` columns and rows of `border` on each side, into planes of that size. Returns
    /// what of them is no light.
    pub(super) fn sources(&self, border: Border, margin: [usize; 2], into: &mut [Sources; 3]) -> BadSources {
        let arch = Arch::new();
        let surveys = self.survey(arch);
        let [width, height] = self.size;
        let takes = surveys.map(|survey| Take::new(&survey));
        into.iter_mut().zip(takes).for_each(|(into, take)| into.exponent = take.exponent);
        let [red, green, blue] = into.each_mut().map(|into| &mut into.plane);
        let rows = red.par_rows_mut().zip(green.par_rows_mut()).zip(blue.par_rows_mut()).enumerate();
        rows.for_each(|(row, ((red, green), blue))| {
            let Some(y) = border.source(row as isize - margin[1] as isize, height) else { return };
            let mut into = [red, green, blue];
            let inside = into.each_mut().map(|into| &mut into[margin[0]..][..width]);
            match self.row(y) {
                Row::Four(row) => arch.dispatch(Lights { row, takes, into: inside }),
                Row::Three(row) => arch.dispatch(Lights { row, takes, into: inside }),
                Row::Planes(rows) => {
                    for ((row, take), into) in rows.into_iter().zip(takes).zip(inside) {
                        row.iter().zip(into).for_each(|([value], into)| *into = take.light(*value));
                    }
                }
            }
            for into in into {
                for column in (0..margin[0]).chain(margin[0] + width..2 * margin[0] + width) {
                    if let Some(x) = border.source(column as isize - margin[0] as isize, width) {
                        into[column] = into[margin[0] + x];
                    }
                }
            }
        });
        BadSources::new(&surveys)
    }

    /// A channel's light along a row, unscaled, and along what a border adds beyond its ends: the first of `into`, which holds the row
    /// at least, is the column −`before`.
    pub(super) fn lights(&self, channel: usize, y: usize, border: Border, before: usize, into: &mut [f64]) {
        let width = self.size[0];
        let (left, rest) = into.split_at_mut(before);
        let (middle, right) = rest.split_at_mut(width.min(rest.len()));
        match self.row(y) {
            Row::Four(row) => row.iter().zip(middle).for_each(|(pixel, into)| *into = light(pixel[channel])),
            Row::Three(row) => row.iter().zip(middle).for_each(|(pixel, into)| *into = light(pixel[channel])),
            Row::Planes(rows) => rows[channel].iter().zip(middle).for_each(|([value], into)| *into = light(*value)),
        }
        // Not beyond one picture.
        let pictures = -(width as isize)..2 * width as isize;
        let beyond = |column: isize| {
            let inside = border.source(column, width).filter(|_| pictures.contains(&column));
            inside.map_or(0.0, |x| light(self.value(channel, x, y)))
        };
        left.iter_mut().zip(-(before as isize)..).for_each(|(into, column)| *into = beyond(column));
        right.iter_mut().zip(width as isize..).for_each(|(into, column)| *into = beyond(column));
    }

    /// The channels as sources, without a border.
    pub(crate) fn channels(&self) -> [Sources; 3] {
        let [width, height] = self.size;
        let mut channels = [0, 1, 2].map(|_| Sources { plane: Plane::new(width, height), exponent: 0 });
        self.sources(Border::None, [0; 2], &mut channels);
        channels
    }

    /// What is no light.
    pub(super) fn bad(&self) -> BadSources {
        BadSources::new(&self.survey(Arch::new()))
    }
}

impl BadSources {
    fn new(surveys: &[Survey; 3]) -> Self {
        let count = |of: fn(&Survey) -> usize| surveys.each_ref().map(of);
        Self {
            undefined: count(|survey| survey.undefined),
            infinite: count(|survey| survey.infinite),
            negative: count(|survey| survey.negative),
        }
    }
}

/// A row as it lies in memory.
enum Row<'a> {
    Four(&'a [[f32; 4]]),
    Three(&'a [[f32; 3]]),
    Planes([&'a [[f32; 1]]; 3]),
}

/// What of a channel is taken, and how.
#[derive(Debug, Clone, Copy)]
struct Take {
    least: f32,
    exponent: i32,
    scale: Scale,
}

impl Take {
    fn new(survey: &Survey) -> Self {
        let exponent = survey.exponent();
        Self { least: survey.brightest * SHARE, exponent, scale: Scale::new(exponent) }
    }

    #[inline(always)]
    fn light(self, value: f32) -> f32 {
        // False for NaN as well.
        let light = value > self.least && value < f32::INFINITY;
        self.scale.of(if light { value } else { 0.0 })
    }
}

/// A power of two that may be too small or too large for an f32: the product of two that are not.
#[derive(Debug, Clone, Copy)]
pub(super) struct Scale([f32; 2]);

impl Scale {
    pub fn new(exponent: i32) -> Self {
        let half = exponent / 2;
        Self([half, exponent - half].map(|exponent| exp2(exponent) as f32))
    }

    #[inline(always)]
    pub fn of(self, value: f32) -> f32 {
        value * self.0[0] * self.0[1]
    }
}

/// The light of each channel of a row.
struct Lights<'a, const N: usize> {
    row: &'a [[f32; N]],
    takes: [Take; 3],
    into: [&'a mut [f32]; 3],
}

impl<const N: usize> WithSimd for Lights<'_, N> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let [red, green, blue] = self.into;
        for (((pixel, red), green), blue) in self.row.iter().zip(red).zip(green).zip(blue) {
            *red = self.takes[0].light(pixel[0]);
            *green = self.takes[1].light(pixel[1]);
            *blue = self.takes[2].light(pixel[2]);
        }
    }
}

/// Surveys of the first three values of each pixel, or of the only one.
struct Look<'a, const N: usize>(&'a [[f32; N]]);

impl<const N: usize> WithSimd for Look<'_, N> {
    type Output = [Survey; 3];

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> [Survey; 3] {
        let (mut brightest, mut finite, mut undefined, mut negative) = ([0f32; N], [0u32; N], [0u32; N], [0u32; N]);
        for pixel in self.0 {
            for channel in 0..N {
                let value = pixel[channel];
                let number = value.abs() < f32::INFINITY;
                brightest[channel] = if number && value > brightest[channel] { value } else { brightest[channel] };
                finite[channel] += u32::from(number);
                undefined[channel] += u32::from(value.is_nan());
                negative[channel] += u32::from(number && value < 0.0);
            }
        }
        std::array::from_fn(|channel| {
            let channel = channel.min(N - 1);
            let [finite, undefined, negative] = [finite, undefined, negative].map(|kind| kind[channel] as usize);
            Survey { brightest: brightest[channel], undefined, infinite: self.0.len() - finite - undefined, negative }
        })
    }
}

impl Survey {
    fn with(self, other: Self) -> Self {
        Self {
            brightest: self.brightest.max(other.brightest),
            undefined: self.undefined + other.undefined,
            infinite: self.infinite + other.infinite,
            negative: self.negative + other.negative,
        }
    }

    /// The power of two that takes the brightest value to between 2^(TOP − 1) and 2^TOP.
    fn exponent(&self) -> i32 {
        if self.brightest > 0.0 { TOP - f64::from(self.brightest).log2().ceil() as i32 } else { 0 }
    }
}

/// What a value sends.
pub(super) fn light(value: f32) -> f64 {
    // False for NaN as well.
    if value > 0.0 && value < f32::INFINITY { f64::from(value) } else { 0.0 }
}

/// 2^`exponent`, exactly.
pub(super) fn exp2(exponent: i32) -> f64 {
    2f64.powi(exponent)
}

fn check(found: usize, expected: usize) -> Result<(), Error> {
    if found == expected { Ok(()) } else { Err(Error::Length { found, expected }) }
}
