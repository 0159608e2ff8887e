//! Lights found in a photo.
//!
//! Pixels above a threshold are gathered into connected regions; regions that lie close together become one light; the
//! brightest are kept, and the others join them. A light has its region's flux, centroid and extent, so a window or the sun with its aureole is
//! one light with a size.

use std::cmp::Ordering;
use std::collections::HashMap;

use glam::{DVec2, I64Vec2};
use rayon::prelude::*;

use super::Knee;
use super::Light;
use super::Recover;
use super::emission::Emission;
use super::lit::Lit;
use super::nearest::Nearest;
use super::regions::{Moments, regions};
use super::shape;
use super::threshold::{self, Rule};
use crate::choices::{Beyond, LightBy, LightShape};
use crate::frame::Frame;

/// What counts as a light.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FindOptions {
    /// What tells light from the rest, and weights it.
    pub by: LightBy,
    /// The linear value of that, in the photo's unit, from which on a pixel is light; 0 takes every pixel that is not black.
    /// `None` lets the photo decide: see [`threshold`].
    pub threshold: Option<f64>,
    /// A region whose centroid is no farther than this from a brighter one joins it; half picture heights. The brighter
    /// one counts as a disc of its own rms extent. 0 merges none.
    pub merge: f64,
    /// What becomes of a region that is no ball.
    pub shape: LightShape,
    /// At most so many lights are kept, the brightest.
    pub max_lights: usize,
    /// What becomes of the others.
    pub beyond: Beyond,
    /// A single pixel that is more than so many times as bright as the brightest of its neighbours is a firefly: no light,
    /// and nothing that the threshold goes by. At least 1; 0 takes every pixel as it is.
    pub firefly_limit: f64,
    /// Of a threshold: how far below and above it pixels begin to shine and shine in full; see [`Knee`]. Where every pixel is a source
    /// it counts with a threshold that is given; of lights, where it is above 0: 0 has pixels from the threshold on shine in full.
    pub knee: f64,
    /// How much brighter than it is shown what is clipped shines, as a light, as a pixel of the whole photo or in a veil.
    pub recover: Recover,
}

impl FindOptions {
    /// What looks of version 1 go by where they do not say: few lights, by luminance, and those beyond them are lost.
    pub const VERSION_1: Self = Self {
        by: LightBy::Luminance,
        threshold: None,
        merge: MERGE,
        shape: LightShape::Ball,
        max_lights: 64,
        beyond: Beyond::Drop,
        firefly_limit: 0.0,
        knee: 0.0,
        recover: Recover::None,
    };

    /// What of each pixel shines where every pixel is a source.
    pub fn knee(&self) -> Knee {
        self.threshold.map_or(Knee::NONE, |threshold| Knee { threshold, width: self.knee })
    }
}

impl Default for FindOptions {
    /// The brightest channel; 0.02, the width of a thumb at arm's length in a normal lens; more lights than nearly any photo has; and
    /// ten stops.
    ///
    /// Of five panoramas and nine photos, each box-filtered to ten sizes, down to the sun in one pixel of 32 × 16, no
    /// pixel outshines its neighbours by more than 180; of those that a decoder had sampled without a filter, one by 900
    /// and one by 7800.
    fn default() -> Self {
        Self {
            by: LightBy::Brightest,
            threshold: None,
            merge: MERGE,
            shape: LightShape::Kept,
            max_lights: 4096,
            beyond: Beyond::Join,
            firefly_limit: 1000.0,
            knee: 0.0,
            recover: Recover::Auto,
        }
    }
}

/// How close regions are that become one light, unless somebody says otherwise.
const MERGE: f64 = 0.02;

/// The lights of a photo, and what was left out.
#[derive(Debug, Clone, PartialEq)]
pub struct Found {
    /// The lights that were kept, brightest first.
    pub lights: Vec<Light>,
    /// Each light's share of the flux of all regions, weighted by brightness.
    pub shares: Vec<f64>,
    /// What told light from the rest.
    pub by: LightBy,
    /// The linear brightness from which on a pixel is light.
    pub threshold: f64,
    /// How the threshold was chosen.
    pub rule: Rule,
    /// Connected regions before any were merged, one that is no ball as the parts that it was taken apart into.
    pub regions: usize,
    /// Lights beyond [`FindOptions::max_lights`] that were dropped.
    pub dropped: usize,
    /// Their share of the flux of all regions, 0 to 1, weighted by brightness.
    pub dropped_share: f64,
    /// Lights beyond [`FindOptions::max_lights`] that joined the nearest one that was kept.
    pub joined: usize,
    /// Their share of the flux of all regions, in the same way; it is part of the lights' shares.
    pub joined_share: f64,
    /// Pixels at or above the threshold that are no light, because they outshine their neighbours.
    pub fireflies: usize,
    /// Column and row of the first of them in the picture.
    pub first_firefly: Option<(i32, i32)>,
    /// The largest brightness that a pixel gives, fireflies left out; 0 for a black photo.
    pub peak: f64,
}

impl Found {
    /// How many regions joined a brighter one.
    pub fn merged(&self) -> usize {
        self.regions - self.lights.len() - self.dropped - self.joined
    }

    /// Counts lengths in another unit, of which there are `factor` in the one before.
    pub(crate) fn rescale(&mut self, factor: f64) {
        for light in &mut self.lights {
            light.position *= factor;
            light.size *= factor;
            light.flux = light.flux.map(|flux| flux * factor * factor);
        }
    }
}

/// Finds the lights among the stored pixels of a photo, brightest first.
///
/// `emission` says how a pixel gives light, and the options by which brightness it is told; the weights of linear R, G and B in
/// luminance alone say that alpha is not looked at, and that it is told by luminance. A pixel with a channel that is not finite is never light, and a negative channel counts as 0.
///
/// # Panics
///
/// If there are not as many pixels as `frame.window` holds.
pub fn find(pixels: &[[f32; 4]], frame: &Frame, emission: impl Into<Emission>, options: &FindOptions) -> Found {
    find_shining(pixels, pixels, frame, emission, options)
}

/// The same, where pixels shine otherwise than they are shown: what is light is told by those that are shown, and what flux it has by
/// those that shine.
///
/// # Panics
///
/// If there are not as many pixels of either as `frame.window` holds.
pub fn find_shining(
    shown: &[[f32; 4]],
    shining: &[[f32; 4]],
    frame: &Frame,
    emission: impl Into<Emission>,
    options: &FindOptions,
) -> Found {
    let count = frame.window.pixels();
    assert!(shown.len() == count && shining.len() == count, "the pixels do not fill the frame's window");
    let emission = emission.into().by(options.by);
    let lit = Lit::new(shown, frame.window.width as usize, emission, options.firefly_limit);
    let (threshold, rule) = match options.threshold {
        Some(given) => (given, Rule::Given),
        None => threshold::automatic(&lit),
    };
    let peak = lit.peak();
    let lit = lit.shining(shining);
    let fireflies = lit.fireflies(threshold as f32);
    let knee = Knee { threshold, width: options.knee };
    let soft = (options.knee > 0.0).then(|| knee.softened(shown, shining, emission));
    // Of pixels that the knee has dimmed, all are light that are not black.
    let (lit, least) = match &soft {
        Some(soft) => (lit.shining(soft), f32::MIN_POSITIVE),
        None => (lit, threshold as f32),
    };
    let found = regions(&lit, least, frame.pixel_aspect);
    let (mut found, long): (Vec<Moments>, Vec<Moments>) =
        found.into_iter().partition(|region| options.shape == LightShape::Ball || shape::is_round(region));
    let parts = shape::parts(&lit, least, frame.pixel_aspect, &long);
    let regions = found.len() + parts.len();
    let total = found.iter().chain(&parts).map(|region| region.weight).sum::<f64>().max(f64::MIN_POSITIVE);
    found.sort_by(brightest_first);
    // No two pixels are farther apart than a diagonal.
    let diagonal = frame.pixel_aspect * f64::from(frame.window.width) + f64::from(frame.window.height);
    let radius = (options.merge / frame.pixel_size()).min(diagonal);
    let mut lights = merge(found, radius, count as f64 * frame.pixel_aspect);
    // What was just taken apart is not put together again.
    lights.extend(parts);
    lights.sort_by(brightest_first);
    let beyond = lights.split_off(options.max_lights.min(lights.len()));
    let beyond_share = beyond.iter().fold(0.0, |sum, region| sum + region.weight / total);
    // Where none is kept there is none to be joined.
    let joins = options.beyond == Beyond::Join && !lights.is_empty();
    if joins && !beyond.is_empty() {
        join(&mut lights, &beyond);
        lights.sort_by(brightest_first);
    }
    let [(joined, joined_share), (dropped, dropped_share)] = match joins {
        true => [(beyond.len(), beyond_share), (0, 0.0)],
        false => [(0, 0.0), (beyond.len(), beyond_share)],
    };
    Found {
        lights: lights.iter().map(|region| light(region, frame)).collect(),
        shares: lights.iter().map(|region| region.weight / total).collect(),
        by: emission.by,
        threshold,
        rule,
        regions,
        dropped,
        dropped_share,
        joined,
        joined_share,
        fireflies: fireflies.len(),
        first_firefly: fireflies.first().map(|&(i, j)| (frame.window.x + i as i32, frame.window.y + j as i32)),
        peak: peak.into(),
    }
}

/// Equally bright ones from the top, then from the left.
fn brightest_first(a: &Moments, b: &Moments) -> Ordering {
    let brighter = b.weight.total_cmp(&a.weight);
    brighter.then(a.mean.y.total_cmp(&b.mean.y)).then(a.mean.x.total_cmp(&b.mean.x))
}

/// From pixels of the window to the picture plane.
fn light(region: &Moments, frame: &Frame) -> Light {
    let (side, aspect) = (frame.pixel_size(), frame.pixel_aspect);
    let column = f64::from(frame.window.x) + region.mean.x / aspect;
    let row = f64::from(frame.window.y) + region.mean.y;
    // A pixel is a rectangle of light and no point: 1/12 is the variance of a uniform density of width 1.
    let variance = region.variance() + (aspect * aspect + 1.0) / 24.0;
    Light {
        position: frame.position(column, row),
        flux: region.flux.map(|sum| sum * frame.pixel_sides().element_product()),
        size: variance.sqrt() * side,
        muted: false,
    }
}

/// Lets each region, brightest first, join the nearest one kept so far that it is close to, or keeps it.
///
/// A region is close to a kept one if its centroid is within `radius` heights of a pixel of the disc that has the kept one's
/// centroid and rms extent, so that the panes of a window come together. The disc is that of the kept region alone
/// and does not grow, so that a light does not wander off along a string of lamps. `area` is that of the window, in
/// squares of a pixel's height.
fn merge(regions: Vec<Moments>, radius: f64, area: f64) -> Vec<Moments> {
    if radius.is_nan() || radius <= 0.0 || regions.is_empty() {
        return regions;
    }
    let mut cells = Cells::new(radius.max((area / regions.len() as f64).sqrt()));
    let (mut kept, mut discs): (Vec<Moments>, Vec<(DVec2, f64)>) = Default::default();
    for region in regions {
        let distance = |&at: &usize| discs[at].0.distance(region.mean);
        let close = cells.at(region.mean).iter().filter(|at| distance(at) <= discs[**at].1);
        if let Some(&at) = close.min_by(|a, b| distance(a).total_cmp(&distance(b)).then(a.cmp(b))) {
            kept[at].absorb(&region);
        } else {
            // A uniform disc of radius r has the variance r² / 4 along each axis; that of the pixel is left out, so
            // that the disc of a single one is a point.
            let reach = radius + 2.0 * region.variance().sqrt();
            cells.insert(kept.len(), region.mean, reach);
            discs.push((region.mean, reach));
            kept.push(region);
        }
    }
    kept
}

/// Adds the light of others to the nearest of the lights that are kept, wherever those are by what they have taken.
fn join(kept: &mut [Moments], others: &[Moments]) {
    let nearest = Nearest::new(kept.iter().map(|region| region.mean).collect());
    let places: Vec<Option<usize>> = others.par_iter().map(|other| nearest.to(other.mean)).collect();
    for (place, other) in places.into_iter().zip(others) {
        if let Some(at) = place {
            kept[at].absorb(other);
        }
    }
}

/// Which discs reach into which square cell of the plane.
struct Cells {
    side: f64,
    discs: HashMap<I64Vec2, Vec<usize>>,
}

impl Cells {
    fn new(side: f64) -> Self {
        Self { side, discs: HashMap::new() }
    }

    fn cell(&self, at: DVec2) -> I64Vec2 {
        (at / self.side).floor().as_i64vec2()
    }

    /// Discs that may hold `at`.
    fn at(&self, at: DVec2) -> &[usize] {
        self.discs.get(&self.cell(at)).map_or(&[], Vec::as_slice)
    }

    fn insert(&mut self, disc: usize, center: DVec2, radius: f64) {
        let (low, high) = (self.cell(center - radius), self.cell(center + radius));
        for y in low.y..=high.y {
            for x in low.x..=high.x {
                self.discs.entry(I64Vec2::new(x, y)).or_default().push(disc);
            }
        }
    }
}

#[cfg(test)]
mod tests;
