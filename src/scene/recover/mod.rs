//! How bright clipped highlights may have been: light for the glare, which the picture does not show.
//!
//! A camera's file says of a lamp no more than that it is as bright as white or brighter, and glare made of white is too little. So a
//! clipped pixel shines 2^(S w t) times as bright as it is shown, t = min(1, d / ρ), d its distance from the rim of its region and ρ a
//! hundredth of the picture's shorter side: at the rim without a jump, and from ρ on by S stops. What it gains has the colour of the
//! region's rim, which is not clipped: the core of a red lamp is white in the photo alone.
//!
//! What is clipped is known of pictures for displays: a pixel whose brightest channel is at the end of the scale. Its other channels may
//! be no more than bright, and say then that it is not much brighter than shown: w is the darkest channel's share of the scale. In
//! scene-linear light there is no such end, and clipped is what reaches the photo's maximum in a patch; there w is 1.
//!
//! Nobody can know S. [`Recover::Auto`] has it from how much of the picture is clipped, and from how dark it is around a region:
//! lamps are small and stand out, skies and paper are large or bright all around. See [`Region::standing_out`] and [`of_share`].

mod by;
mod distance;
mod mask;
mod regions;

use rayon::prelude::*;
use serde::Serialize;

use super::emission::Emission;
use super::find::FindOptions;
use super::lit::Lit;
use crate::frame::Frame;
pub use by::Recover;
use distance::{Columns, Parabolas};
use mask::Mask;
use regions::{Region, Run, runs};

/// A photo's pixels as they shine.
#[derive(Debug, Clone, Default)]
pub struct Recovered {
    /// By what.
    pub by: Recover,
    /// All pixels; none where they shine as they are.
    pixels: Vec<[f32; 4]>,
    /// What there was to do, if anything.
    pub told: Option<Recovery>,
}

/// What became of clipped highlights.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Recovery {
    /// How many stops the brightest of them were made brighter by.
    pub stops: f64,
    /// How many pixels shine brighter than they are shown.
    pub pixels: usize,
    /// How many are clipped.
    pub clipped: usize,
    /// The share of all light that shines which they have gained, 0 to 1, by luminance.
    pub share: f64,
    /// What a person ought to know.
    pub note: Option<String>,
}

/// In a line.
impl std::fmt::Display for Recovery {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let &Self { stops, pixels, clipped, share, note: _ } = self;
        let noun = |count| if count == 1 { "clipped pixel" } else { "clipped pixels" };
        if pixels == 0 {
            return write!(f, "nothing of {clipped} {}", noun(clipped));
        }
        let (times, digits) = (stops.exp2(), if stops < 3.0 { 1 } else { 0 });
        let verb = if pixels == 1 { "shines" } else { "shine" };
        write!(f, "{pixels} {} {verb} up to {times:.digits$} times as bright, ", noun(pixels))?;
        write!(f, "which is {:.0} % of all light", 100.0 * share)
    }
}

impl Recovered {
    /// As they are.
    pub const fn nothing(by: Recover) -> Self {
        Self { by, pixels: Vec::new(), told: None }
    }

    /// The pixels that shine, of those that are shown.
    pub fn over<'a>(&'a self, shown: &'a [[f32; 4]]) -> &'a [[f32; 4]] {
        if self.pixels.len() == shown.len() { &self.pixels } else { shown }
    }

    /// Whether other pixels shine than are shown.
    pub fn is_other(&self) -> bool {
        !self.pixels.is_empty()
    }

    /// The bytes that it takes.
    pub(crate) fn bytes(&self) -> usize {
        size_of_val(&*self.pixels)
    }
}

/// A channel of a picture for displays is clipped from here on: 0.995 of the largest code of sRGB, 254 of 255, in linear light.
pub const END: f32 = 0.9887;
/// Between clipped pixels a code may be a little less: noise, and what JPEG makes of it.
const NEARLY: f32 = 0.9 * END;
/// In scene-linear light: this share of the largest luminance.
const AT_PEAK: f32 = 0.995;
/// So many pixels that hang together are a patch, there.
const PATCH: usize = 4;
/// ρ, as a share of the picture's shorter side.
const REACH: f64 = 0.01;
/// A rim has a colour where it is at least so bright, as a share of the clipped level: what is darker is not the lamp's.
const BRIGHT: f64 = 0.5;
/// The least luminance of a colour, as a share of its brightest channel: that of the deepest blue is 0.07.
const LEAST_LUMINANCE: f64 = 0.05;

/// A photo's pixels as they shine, on its frame; `is_for_display` tells whether there is an end of the scale.
///
/// Fireflies are no maximum. A pixel with a channel that is not finite, or of which alpha leaves nothing, is not
/// clipped, and stays.
///
/// # Panics
/// If there are not as many pixels as `frame.window` holds.
pub fn recover(pixels: &[[f32; 4]], frame: &Frame, emission: Emission, is_for_display: bool, by: Recover) -> Recovered {
    assert_eq!(pixels.len(), frame.window.pixels(), "the pixels do not fill the frame's window");
    match by {
        Recover::None => return Recovered::nothing(by),
        by if by.is_auto() && !is_for_display => return Recovered::nothing(by),
        Recover::Stops(stops) if stops <= 0.0 => return Recovered::nothing(by),
        Recover::Auto | Recover::AutoFrom(_) | Recover::Stops(_) => {}
    }
    let width = frame.window.width as usize;
    let scale = if is_for_display { Scale::Display } else { Scale::linear(pixels, width, emission) };
    let clipped = |pixel: &[f32; 4]| emission.share(pixel) > 0.0 && scale.reach(pixel, emission) >= scale.end();
    let mut mask = Mask::new(pixels, width, clipped);
    if mask.is_empty() {
        return Recovered::nothing(by);
    }
    if is_for_display {
        mask.close(|pixel| emission.share(pixel) > 0.0 && scale.reach(pixel, emission) >= NEARLY, pixels);
    }
    Highlights::new(pixels, frame, emission, scale, mask).recovered(by)
}

/// The stops of [`Recover::Auto`] in a picture for displays, before what is around a region has its say: by the share of the
/// picture that is clipped.
pub fn stops(pixels: &[[f32; 4]], width: usize, emission: Emission) -> f64 {
    let clipped = clipped(pixels, width, emission, END);
    of_share(clipped.iter().filter(|&&clipped| clipped).count() as f64 / pixels.len().max(1) as f64)
}

/// Which pixels are clipped, row by row: those of which alpha leaves something, and the brightest channel reaches `level`; and of a
/// picture for displays, whose level is [`END`], what is nearly there between them.
pub fn clipped(pixels: &[[f32; 4]], width: usize, emission: Emission, level: f32) -> Vec<bool> {
    let reaches = |pixel: &[f32; 4], level: f32| {
        emission.share(pixel) > 0.0 && pixel[..3].iter().any(|channel| *channel >= level)
    };
    let mut mask = Mask::new(pixels, width, |pixel| reaches(pixel, level));
    if level == END {
        mask.close(|pixel| reaches(pixel, NEARLY), pixels);
    }
    mask.pixels
}

/// Where the scale ends.
#[derive(Clone, Copy)]
enum Scale {
    /// That of a display.
    Display,
    /// Of scene-linear light, at a luminance.
    Linear(f32),
}

impl Scale {
    fn linear(pixels: &[[f32; 4]], width: usize, emission: Emission) -> Self {
        let peak = Lit::new(pixels, width, emission, FindOptions::default().firefly_limit).peak();
        // Of black there is nothing to recover.
        Self::Linear(if peak > 0.0 { AT_PEAK * peak } else { f32::INFINITY })
    }

    fn end(self) -> f32 {
        match self {
            Self::Display => END,
            Self::Linear(end) => end,
        }
    }

    /// How far up the scale a pixel is; not at all, with a channel that is not finite.
    fn reach(self, pixel: &[f32; 4], emission: Emission) -> f32 {
        let &[r, g, b, _] = pixel;
        match self {
            Self::Display if r.is_finite() && g.is_finite() && b.is_finite() => r.max(g).max(b),
            Self::Display => f32::NEG_INFINITY,
            Self::Linear(_) => emission.luminance(pixel),
        }
    }

    /// w: how much of the stops a clipped pixel takes.
    fn weight(self, &[r, g, b, _]: &[f32; 4]) -> f64 {
        match self {
            Self::Display => f64::from(r.min(g).min(b) / END).clamp(0.0, 1.0),
            Self::Linear(_) => 1.0,
        }
    }
}

/// S of [`Recover::Auto`] where a share of the picture is clipped, before the surroundings have their say.
///
/// Of lamps and windows in photos of which more is known, exposed as a camera would, the mean brightness is 140 to 330 times white where
/// 1 to 3 % of the picture are clipped (St. Peter's Square at night, a studio), and 2 to 10 times in skies, of 8 % and more.
fn of_share(share: f64) -> f64 {
    const LAMPS: f64 = 8.0;
    /// Up to this share of the picture may be lamps.
    const FEW: f64 = 0.03;
    /// Stops less for each time that twice as much is clipped.
    const SLOPE: f64 = 2.0;
    (LAMPS - SLOPE * (share / FEW).log2().max(0.0)).max(0.0)
}

impl Region {
    /// How much it stands out from what is some way outside of it, 0 to 1: all, where that is at most 0.6 times as bright as the clipped
    /// level.
    fn standing_out(&self) -> f64 {
        let [sum, pixels] = self.outside;
        if pixels > 0.0 { (2.5 - 2.5 * sum / pixels).clamp(0.0, 1.0) } else { 1.0 }
    }
}

/// A photo's clipped pixels.
struct Highlights<'a> {
    pixels: &'a [[f32; 4]],
    width: usize,
    aspect: f64,
    /// ρ, in heights of a pixel.
    reach: f64,
    emission: Emission,
    scale: Scale,
    mask: Mask,
    runs: Vec<Run>,
    regions: Vec<Region>,
}

impl<'a> Highlights<'a> {
    fn new(pixels: &'a [[f32; 4]], frame: &Frame, emission: Emission, scale: Scale, mask: Mask) -> Self {
        let (width, aspect) = (frame.window.width as usize, frame.pixel_aspect);
        let reach = REACH * (aspect * f64::from(frame.width)).min(f64::from(frame.height));
        let (runs, count) = runs(&mask);
        let regions = vec![Region::default(); count];
        let mut all = Self { pixels, width, aspect, reach, emission, scale, mask, runs, regions };
        all.look_around();
        all
    }

    /// Whether there is a pixel, and it is not clipped.
    fn outside(&self, x: isize, y: isize) -> Option<&'a [f32; 4]> {
        let inside = x >= 0 && y >= 0 && (x as usize) < self.width;
        let at = inside.then(|| y as usize * self.width + x as usize)?;
        (!*self.mask.pixels.get(at)?).then(|| &self.pixels[at])
    }

    /// Sees what is at the regions' rims, and beyond.
    fn look_around(&mut self) {
        let far = 3.0 * self.reach;
        let [across, down] = [(far / self.aspect).round().max(1.0) as isize, far.round().max(1.0) as isize];
        let mut regions = std::mem::take(&mut self.regions);
        for run in &self.runs {
            let region = &mut regions[run.region];
            region.pixels += run.end - run.start;
            for x in run.start as isize..run.end as isize {
                let y = run.row as isize;
                for (dx, dy) in [(-1, 0), (1, 0), (0, -1), (0, 1), (-1, -1), (1, -1), (-1, 1), (1, 1)] {
                    let Some(pixel) = self.outside(x + dx, y + dy) else { continue };
                    self.add_colour(region, pixel);
                    if dx == 0 || dy == 0 {
                        let beyond = self.outside(x + dx * across, y + dy * down);
                        region.outside = beyond.map_or(region.outside, |pixel| {
                            let level = f64::from(self.emission.luminance(pixel) / self.white());
                            [region.outside[0] + level, region.outside[1] + 1.0]
                        });
                    }
                }
            }
        }
        self.regions = regions;
    }

    /// The luminance of what is clipped in all channels.
    fn white(&self) -> f32 {
        self.scale.end()
    }

    fn add_colour(&self, region: &mut Region, pixel: &[f32; 4]) {
        let level = f64::from(self.scale.reach(pixel, self.emission) / self.scale.end());
        if level.is_finite() && level >= BRIGHT {
            let colour = region.colour.iter_mut().zip(pixel);
            colour.for_each(|(sum, channel)| *sum += f64::from(channel.max(0.0)));
        }
    }

    /// Light of a colour, of luminance 1; none where it has next to none.
    fn hue(&self, colour: [f64; 3]) -> Option<[f64; 3]> {
        let luminance = self.luminance(colour);
        let brightest = colour.into_iter().fold(0.0, f64::max);
        (luminance > LEAST_LUMINANCE * brightest).then(|| colour.map(|channel| channel / luminance))
    }

    fn luminance(&self, colour: [f64; 3]) -> f64 {
        colour.iter().zip(self.emission.weights).map(|(channel, weight)| channel * f64::from(weight)).sum()
    }

    /// The pixels, with those that are clipped as they shine.
    fn recovered(&self, by: Recover) -> Recovered {
        let clipped: usize = self.regions.iter().map(|region| region.pixels).sum();
        let part = clipped as f64 / self.pixels.len() as f64;
        let stops = |region: &Region| match by {
            // A maximum of scene-linear light is in a pixel, too, where nothing is clipped.
            _ if matches!(self.scale, Scale::Linear(_)) && region.pixels < PATCH => 0.0,
            Recover::Stops(stops) => stops,
            Recover::Auto => of_share(part) * region.standing_out(),
            Recover::AutoFrom(stops) => stops * region.standing_out(),
            Recover::None => 0.0,
        };
        if clipped == self.pixels.len() {
            let note = "all of the picture is clipped, and nothing says how bright it was: it shines as it is".into();
            let told = Recovery { stops: 0.0, pixels: 0, clipped, share: 0.0, note: Some(note) };
            return Recovered { told: Some(told), ..Recovered::nothing(by) };
        }
        let regions: Vec<_> = self.regions.iter().map(|region| (stops(region), self.hue(region.colour))).collect();
        let columns = Columns::new(&self.mask);
        let mut pixels: Vec<_> = self.pixels.par_iter().copied().collect();
        let rows: Vec<&[Run]> = self.runs.chunk_by(|one, other| one.row == other.row).collect();
        // The rows that have some, each with its own.
        let mut lines: Vec<(&mut [[f32; 4]], &[Run])> = Vec::with_capacity(rows.len());
        let mut rows = rows.into_iter().peekable();
        for (row, line) in pixels.chunks_exact_mut(self.width).enumerate() {
            if let Some(runs) = rows.next_if(|runs| runs[0].row == row) {
                lines.push((line, runs));
            }
        }
        let gains: Vec<Gain> = lines
            .into_par_iter()
            .map_init(Parabolas::default, |parabolas, (line, runs)| {
                runs.iter().fold(Gain::default(), |gain, run| {
                    let (stops, hue) = regions[run.region];
                    if stops == 0.0 {
                        return gain;
                    }
                    let distances = columns.along(run.row, run.start, run.end, self.aspect, parabolas);
                    let shining = &mut line[run.start..run.end];
                    shining
                        .iter_mut()
                        .zip(distances)
                        .fold(gain, |gain, (pixel, distance)| gain.plus(self.brighten(pixel, stops, hue, distance)))
                })
            })
            .collect();
        let gain = gains.into_iter().fold(Gain::default(), Gain::plus);
        let told = self.told(by, gain, clipped, part);
        let pixels = if gain.pixels > 0 { pixels } else { Vec::new() };
        Recovered { by, pixels, told }
    }

    /// Lets a pixel shine, at a distance from the nearest that is not clipped; what it gains.
    fn brighten(&self, pixel: &mut [f32; 4], stops: f64, hue: Option<[f64; 3]>, distance: f64) -> Gain {
        // The rim lies between the two.
        let within = distance - 0.5 * self.aspect.min(1.0);
        let stops = stops * self.scale.weight(pixel) * (within / self.reach).clamp(0.0, 1.0);
        let [r, g, b, _] = *pixel;
        let own = [r, g, b].map(|channel| f64::from(channel.max(0.0)));
        let luminance = self.luminance(own);
        let Some(hue) = hue.or_else(|| self.hue(own)).filter(|_| stops > 0.0 && luminance > 0.0) else {
            return Gain::default();
        };
        let gained = (stops.exp2() - 1.0) * luminance;
        for (channel, hue) in pixel.iter_mut().zip(hue) {
            *channel = (f64::from(*channel) + gained * hue).min(f32::MAX.into()) as f32;
        }
        Gain { pixels: 1, stops, light: gained * f64::from(self.emission.share(pixel)) }
    }

    /// What is said of it; nothing where there was nothing to do.
    fn told(&self, by: Recover, gain: Gain, clipped: usize, part: f64) -> Option<Recovery> {
        let is_patch = |region: &Region| region.pixels >= PATCH;
        if gain.pixels == 0 && (!by.is_auto() || !self.regions.iter().any(is_patch)) {
            return None;
        }
        let luminance =
            |row: &[[f32; 4]]| -> f64 { row.iter().map(|pixel| f64::from(self.emission.luminance(pixel))).sum() };
        let rows: Vec<f64> = self.pixels.par_chunks(self.width).map(luminance).collect();
        let light: f64 = rows.into_iter().sum();
        let share = if gain.light > 0.0 { gain.light / (light + gain.light) } else { 0.0 };
        let note = (part > MUCH).then(|| {
            format!(
                "{:.0} % of the picture is clipped, more than lamps are: how bright it was is a guess{}",
                100.0 * part,
                if by.is_auto() { ", and --recover STOPS says another" } else { "" }
            )
        });
        Some(Recovery { stops: gain.stops, pixels: gain.pixels, clipped, share, note })
    }
}

/// Beyond this share of a picture, what is clipped is told.
const MUCH: f64 = 0.1;

/// What pixels have gained.
#[derive(Debug, Clone, Copy, Default)]
struct Gain {
    pixels: usize,
    /// The most of one.
    stops: f64,
    /// Luminance.
    light: f64,
}

impl Gain {
    fn plus(self, other: Self) -> Self {
        Self { pixels: self.pixels + other.pixels, stops: self.stops.max(other.stops), light: self.light + other.light }
    }
}

#[cfg(test)]
mod tests;
