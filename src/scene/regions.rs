//! Connected regions of light: which pixels hang together, and where their light is.
//!
//! Two neighbouring pixels, also diagonal ones, at or above the threshold belong to one region. Rows are cut into runs,
//! a run joins those that it touches in the row above by union-find, and a region keeps nothing but its moments, so
//! memory goes with the number of regions and not with that of pixels. Bands of rows are labelled side by side and
//! stitched afterwards; their height depends on the picture alone, so the result does not depend on the threads.

use std::ops::Range;

use glam::DVec2;
use rayon::prelude::*;

use super::emission::{Emission, is_light};
use super::lit::Lit;

/// Sums over pixels of light. Positions are columns and rows of the stored window, columns times the pixels' aspect, so that
/// a pixel's height is the unit of both; areas are pixels.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Moments {
    /// Sum of radiance, RGB, as much as its pixel gives of it.
    pub flux: [f64; 3],
    /// Sum of brightness.
    pub weight: f64,
    /// Mean position, weighted by brightness.
    pub mean: DVec2,
    /// Sum of brightness times the squared distance from the mean.
    pub spread: f64,
    /// What the pixels cover.
    pub area: f64,
    /// Column and row of the first pixel, from the top and then from the left.
    pub first: [u32; 2],
}

impl Moments {
    /// Adds another's light to this (parallel-axis theorem).
    pub fn absorb(&mut self, other: &Self) {
        if other.weight <= 0.0 {
            return;
        }
        let weight = self.weight + other.weight;
        let earlier = (other.first[1], other.first[0]) < (self.first[1], self.first[0]);
        if self.weight <= 0.0 || earlier {
            self.first = other.first;
        }
        self.area += other.area;
        let between = other.mean - self.mean;
        self.spread += other.spread + between.length_squared() * (self.weight * (other.weight / weight));
        self.mean += between * (other.weight / weight);
        self.flux.iter_mut().zip(other.flux).for_each(|(a, b)| *a += b);
        self.weight = weight;
    }

    /// Mean square distance from the mean along one axis, between the pixels' centres.
    pub fn variance(&self) -> f64 {
        self.spread / (2.0 * self.weight)
    }

    /// Of one pixel, by column and row.
    pub fn of_pixel(lit: &Lit<'_>, [i, j]: [u32; 2], aspect: f64) -> Self {
        let at = j as usize * lit.width() + i as usize;
        Self::of_run(&lit.pixels()[at..=at], lit.emission(), i as usize, j as usize, aspect)
    }

    /// Of neighbouring pixels in row `j`, the first of which is in column `i`; `aspect` is a pixel's width over its height.
    fn of_run(pixels: &[[f32; 4]], emission: Emission, i: usize, j: usize, aspect: f64) -> Self {
        let (mut flux, mut sums) = ([0.0; 3], [0.0; 3]);
        for (k, pixel) in pixels.iter().enumerate() {
            let (l, k) = (f64::from(emission.brightness(pixel)), k as f64);
            let share = f64::from(emission.share(pixel));
            sums[0] += l;
            sums[1] += l * k;
            sums[2] += l * k * k;
            flux.iter_mut().zip(pixel).for_each(|(sum, &c)| *sum += share * f64::from(c.max(0.0)));
        }
        let offset = sums[1] / sums[0];
        let mean = DVec2::new(aspect * (i as f64 + offset), j as f64);
        let spread = aspect * aspect * (sums[2] - sums[1] * offset).max(0.0);
        let (area, first) = (aspect * pixels.len() as f64, [i as u32, j as u32]);
        Self { flux, weight: sums[0], mean, spread, area, first }
    }
}

/// Columns `start..end` of a row, and the region that they are in.
#[derive(Debug, Clone, Copy)]
struct Run {
    start: u32,
    end: u32,
    region: u32,
}

impl Run {
    /// Whether the two, in rows next to each other, share an edge or a corner.
    fn touches(&self, other: &Self) -> bool {
        self.start <= other.end && other.start <= self.end
    }
}

/// Every region of pixels at or above `threshold`, in the order of their first pixels.
///
/// Black pixels are in none, whatever the threshold, and neither are fireflies. `aspect` is a pixel's width over its height.
pub(super) fn regions(lit: &Lit<'_>, threshold: f32, aspect: f64) -> Vec<Moments> {
    stitch(lit.bands().map(|rows| Band::new(lit, rows, threshold, aspect)).collect())
}

/// Some rows of the picture: their regions, and the runs of the first and the last row.
struct Band {
    regions: Regions,
    first: Vec<Run>,
    last: Vec<Run>,
}

impl Band {
    fn new(lit: &Lit<'_>, rows: Range<usize>, threshold: f32, aspect: f64) -> Self {
        let mut regions = Regions::default();
        let (mut first, mut above, mut runs) = (Vec::new(), Vec::new(), Vec::new());
        for j in rows.clone() {
            let row = &lit.pixels()[j * lit.width()..][..lit.width()];
            runs.clear();
            let mut touched = 0;
            each_run(lit, j, threshold, |start, end| {
                let moments = Moments::of_run(&row[start..end], lit.emission(), start, j, aspect);
                let run = Run { start: start as u32, end: end as u32, region: 0 };
                runs.push(Run { region: regions.add(&run, &moments, &above, &mut touched), ..run });
            });
            if j == rows.start {
                first = runs.clone();
            }
            std::mem::swap(&mut above, &mut runs);
        }
        Self { regions, first, last: above }
    }
}

/// Calls `found(start, end)` for each run of light in a row, from the left.
fn each_run(lit: &Lit<'_>, row: usize, threshold: f32, mut found: impl FnMut(usize, usize)) {
    let mut start = None;
    lit.each(row, |column, brightness| {
        if is_light(brightness, threshold) {
            start.get_or_insert(column);
        } else if let Some(start) = start.take() {
            found(start, column);
        }
    });
    if let Some(start) = start {
        found(start, lit.width());
    }
}

/// Regions as a forest: a region that joined another points to it and left its moments there or will.
#[derive(Default)]
struct Regions {
    moments: Vec<Moments>,
    parents: Vec<u32>,
}

impl Regions {
    fn push(&mut self, moments: Moments) -> u32 {
        let region = self.parents.len() as u32;
        self.parents.push(region);
        self.moments.push(moments);
        region
    }

    /// The region that `region` is in by now. Halves the way there for the next time.
    fn root(&mut self, mut region: u32) -> u32 {
        while self.parents[region as usize] != region {
            let parent = self.parents[region as usize];
            self.parents[region as usize] = self.parents[parent as usize];
            region = parent;
        }
        region
    }

    /// Makes two regions one, under the older; its moments are added up in [`Regions::finish`].
    fn join(&mut self, a: u32, b: u32) -> u32 {
        let (a, b) = (self.root(a), self.root(b));
        self.parents[a.max(b) as usize] = a.min(b);
        a.min(b)
    }

    /// Adds a run to the regions that it touches in the row above, from run `touched` of that row on, or starts one.
    fn add(&mut self, run: &Run, moments: &Moments, above: &[Run], touched: &mut usize) -> u32 {
        while above.get(*touched).is_some_and(|other| other.end < run.start) {
            *touched += 1;
        }
        let mut region = None;
        for other in above[*touched..].iter().take_while(|other| run.touches(other)) {
            region = Some(self.join(region.unwrap_or(other.region), other.region));
        }
        match region {
            Some(region) => {
                self.moments[region as usize].absorb(moments);
                region
            }
            None => self.push(*moments),
        }
    }

    /// The moments of each region that has joined no other.
    fn finish(mut self) -> Vec<Moments> {
        // A parent is older than its children, so from the youngest on every region is complete when it is passed on.
        for region in (0..self.parents.len()).rev() {
            let parent = self.parents[region] as usize;
            if parent != region {
                let child = self.moments[region];
                self.moments[parent].absorb(&child);
            }
        }
        let is_root = self.parents.iter().enumerate().map(|(region, &parent)| region == parent as usize);
        let mut is_root = is_root.collect::<Vec<_>>().into_iter();
        self.moments.retain(|_| is_root.next() == Some(true));
        self.moments
    }
}

/// One list of regions from those of the bands, joined where they touch across a border.
fn stitch(bands: Vec<Band>) -> Vec<Moments> {
    let mut all = Regions::default();
    let mut above: Vec<Run> = Vec::new();
    for Band { mut regions, first, last } in bands {
        let offset = all.parents.len() as u32;
        all.parents.extend(regions.parents.iter().map(|parent| parent + offset));
        all.moments.append(&mut regions.moments);
        let below: Vec<Run> = first.iter().map(|run| Run { region: run.region + offset, ..*run }).collect();
        let mut from = 0;
        for run in &below {
            while above.get(from).is_some_and(|other| other.end < run.start) {
                from += 1;
            }
            for other in above[from..].iter().take_while(|other| run.touches(other)) {
                all.join(other.region, run.region);
            }
        }
        above = last.iter().map(|run| Run { region: run.region + offset, ..*run }).collect();
    }
    all.finish()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::choices::LightBy;

    const EMISSION: Emission = Emission { weights: [0.25, 0.5, 0.25], straight: false, by: LightBy::Luminance };

    fn regions(pixels: &[[f32; 4]], width: usize, threshold: f32) -> Vec<Moments> {
        super::regions(&Lit::new(pixels, width, EMISSION, 0.0), threshold, 1.0)
    }

    /// Regions of a picture drawn with digits, each the radiance of its pixel.
    fn drawn(rows: &[&str]) -> Vec<Moments> {
        let digit = |c: char| f32::from(c.to_digit(10).unwrap_or(0) as u8);
        let pixels: Vec<_> = rows.iter().flat_map(|row| row.chars().map(|c| [digit(c); 4])).collect();
        regions(&pixels, rows[0].len(), 1.0)
    }

    /// The definition: flood every region from its first pixel.
    fn flooded(pixels: &[[f32; 4]], width: usize, threshold: f32) -> Vec<Moments> {
        let mut free: Vec<bool> = pixels.iter().map(|p| EMISSION.luminance(p) >= threshold).collect();
        let height = pixels.len() / width;
        let mut out = Vec::new();
        for first in 0..pixels.len() {
            let (mut moments, mut queue) = (Moments::default(), vec![first]);
            while let Some(p) = queue.pop() {
                if !std::mem::take(&mut free[p]) {
                    continue;
                }
                let (i, j) = (p % width, p / width);
                moments.absorb(&Moments::of_run(&pixels[p..=p], EMISSION, i, j, 1.0));
                for y in j.saturating_sub(1)..(j + 2).min(height) {
                    queue.extend((i.saturating_sub(1)..(i + 2).min(width)).map(|x| y * width + x));
                }
            }
            if moments.weight > 0.0 {
                out.push(moments);
            }
        }
        out
    }

    #[test]
    fn corners_connect_and_gaps_do_not() {
        assert_eq!(drawn(&["1..", ".1.", "..1"]).len(), 1);
        assert_eq!(drawn(&["..1", ".1.", "1.."]).len(), 1);
        assert_eq!(drawn(&["1.1", "...", "1.1"]).len(), 4);
        assert_eq!(drawn(&["1..1", "....", "1..."]).len(), 3);
        assert_eq!(drawn(&["...", "..."]).len(), 0);
    }

    #[test]
    fn arms_that_meet_below_are_one_region() {
        assert_eq!(drawn(&["1.1.1.1", "1.1.1.1", "1111111"]).len(), 1);
        assert_eq!(drawn(&["1111111", "1.....1", "1.111.1", "1.1.1.1", "1.1...1", "1.11111"]).len(), 1);
        let u = drawn(&["2...2", "2...2", "22222"]);
        assert_eq!((u.len(), u[0].weight, u[0].flux), (1, 18.0, [18.0; 3]));
    }

    #[test]
    fn moments_are_those_of_the_luminance() {
        let region = drawn(&["....", "..3.", "..1."])[0];
        assert_eq!((region.flux, region.weight, region.mean), ([4.0; 3], 4.0, DVec2::new(2.0, 1.25)));
        assert!((region.spread - (3.0 * 0.25 * 0.25 + 0.75 * 0.75)).abs() < 1e-15);
    }

    #[test]
    fn random_pictures_agree_with_the_flood_also_across_bands() {
        let mut state = 1_u32;
        let mut random = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 8) as f32 / (1 << 24) as f32
        };
        // The second is three bands high.
        for (width, height, threshold) in [(61, 47, 0.6), (60_000, 5, 0.62), (1, 300, 0.5), (300, 1, 0.5)] {
            let pixels: Vec<_> = (0..width * height).map(|_| [random(), random(), random(), 1.0]).collect();
            let key = |m: &Moments| (m.mean.y.to_bits(), m.mean.x.to_bits(), m.weight.to_bits());
            let (mut fast, mut slow) = (regions(&pixels, width, threshold), flooded(&pixels, width, threshold));
            assert_eq!(fast.len(), slow.len());
            fast.sort_by(|a, b| a.weight.total_cmp(&b.weight));
            slow.sort_by(|a, b| a.weight.total_cmp(&b.weight));
            for (a, b) in fast.iter().zip(&slow) {
                assert!((a.weight - b.weight).abs() <= 1e-12 * b.weight, "{a:?} {b:?}");
                assert!((a.mean - b.mean).length() < 1e-8, "{:?} {:?}", key(a), key(b));
                assert!((a.spread - b.spread).abs() <= 1e-9 * (1.0 + b.spread), "{a:?} {b:?}");
            }
        }
    }
}
