//! Ghosts of a whole photo that are larger by far than others, or farther from it, each kind in a series of its own, with the period
//! that it needs; and all of them in one series again.
//!
//! A period as long as the largest ghosts ask for would multiply the modes of the smallest, which are the most as it is. But within
//! the picture a series of one period can be that of another: what it is there, W, times a window that is 1 on the picture and falls
//! to 0 within the rest of the other's period P, and repeated by that, is smooth, and W on the picture. With a window that is a box
//! of width P, blurred by a Gaussian of σ, everything has a closed form: all windows side by side sum to 1, so that no point is off by
//! more than twice what its own lacks; and wave κ of W becomes, at wave nω,
//!
//! ```text
//! (1/P) ∫ w(x) e^{i(κ − nω)x} dx = sinc(P(κ − nω)/2) e^{−σ²(κ − nω)²/2}
//! ```

use std::f64::consts::TAU;

use glam::DVec2;
use ndarray::Array2;

use super::amplitudes::Rgb;
use super::modes::{Mode, Modes};
use super::period::{self, Reach};
use super::weigh::Weighed;
use super::{Group, Transform};
use crate::frame::Frame;
use crate::problem::Problem;

/// A period that others are folded into is at least this much longer than the picture: the shorter the room for the window, the more
/// harmonics it needs.
const ROOM: f64 = 1.25;

/// Ghosts whose periods have less than this times the area of the smallest share one.
const LARGER: f64 = 1.8;

/// Ghosts that share a period.
pub(super) struct Band {
    pub groups: Vec<Group>,
    pub reaches: Vec<Reach>,
    pub period: DVec2,
}

/// The groups of a problem by the periods that they need, the shortest first; ghosts that are no images are with the first.
pub(super) fn bands(problem: &Problem, weighed: &Weighed, groups: &[Group], budget: f64) -> Vec<Band> {
    let (images, others): (Vec<Group>, Vec<Group>) =
        groups.iter().cloned().partition(|group| matches!(group.transform, Transform::Photo(_)));
    let of_others = period::reaches_of_ghosts(problem, weighed);
    let least = ROOM * 2.0 * farthest(problem.frame());
    // Each within its part, so that those of a band are within theirs in the longest of their periods.
    let part = budget / (images.len() + 1) as f64;
    let needed = |reaches: &[Reach]| period::shortest(reaches, part).max(least);
    let mut found: Vec<Band> = images
        .into_iter()
        .map(|group| {
            let reaches = period::reaches_of_images(problem, weighed, &group.members);
            Band { period: needed(&reaches), groups: vec![group], reaches }
        })
        .collect();
    found.sort_by(|one, other| one.area().total_cmp(&other.area()));
    let mut bands: Vec<Band> = Vec::new();
    let mut smallest = 0.0;
    for band in found {
        match bands.last_mut().filter(|_| band.area() <= LARGER * smallest) {
            Some(last) => last.join(band),
            None => {
                smallest = band.area();
                bands.push(band);
            }
        }
    }
    if let Some(first) = bands.first_mut().filter(|_| !others.is_empty()) {
        first.join(Band { period: needed(&of_others), groups: others, reaches: of_others });
    }
    if let [only] = &mut bands[..] {
        // Nothing is folded into it.
        only.period = period::shortest(&only.reaches, budget);
    }
    bands
}

impl Band {
    /// Takes up another, in the longer of both periods.
    fn join(&mut self, other: Self) {
        self.groups.extend(other.groups);
        self.reaches.extend(other.reaches);
        self.period = self.period.max(other.period);
    }

    fn area(&self) -> f64 {
        self.period.element_product()
    }
}

/// How far a pixel is from the origin, at most, along each axis.
fn farthest(frame: Frame) -> DVec2 {
    let (low, high) = frame.bounds();
    low.abs().max(high.abs())
}

/// A series in the period of another: so many harmonics of x and of y, and A, B, C, D of all of them, harmonic by harmonic of x.
pub(super) struct Folded {
    pub harmonics: [usize; 2],
    pub terms: Vec<Mode>,
    /// By how much it may be off on the picture.
    pub error: f64,
}

/// The modes of a series of one period, in another that is longer than the picture, off by no more than a budget, or by hardly more.
pub(super) fn fold(modes: &Modes, from: DVec2, into: DVec2, frame: Frame, budget: f64) -> Folded {
    let counts = modes.counts();
    let [columns, rows] = [counts.len(), counts[0] as usize];
    let mut tables: [[Array2<f64>; 4]; 3] = [0; 3].map(|_| [0; 4].map(|_| Array2::zeros((columns, rows))));
    let places = counts.iter().enumerate().flat_map(|(n, &count)| (0..count as usize).map(move |m| (n, m)));
    let mut total: Rgb = [0.0; 3];
    for (place, mode) in places.zip(modes.kept(counts)) {
        for (colour, terms) in mode.into_iter().enumerate() {
            for (table, term) in tables[colour].iter_mut().zip(terms) {
                table[place] = term;
                total[colour] += term.abs();
            }
        }
    }
    let total = super::amplitudes::largest(total);
    let far = farthest(frame);
    // Half of the budget for each axis, and of that half for what the window lacks, half for what lies beyond the harmonics.
    let part = (0.25 * budget / total.max(f64::MIN_POSITIVE)).min(0.1);
    let along = [0, 1].map(|axis| Window::new(from[axis], into[axis], far[axis], [columns, rows][axis], part));
    let [x, y] = &along;
    let even = along.each_ref().map(|window| window.matrix(1.0));
    let odd = along.each_ref().map(|window| window.matrix(-1.0));
    // A, B, C, D stand before cosines and sines of x and of y.
    let ways = [[&even[0], &even[1]], [&even[0], &odd[1]], [&odd[0], &even[1]], [&odd[0], &odd[1]]];
    let folded = tables.map(|tables| {
        [0, 1, 2, 3].map(|term: usize| {
            let [across, down] = ways[term];
            across.dot(&tables[term]).dot(&down.t())
        })
    });
    let places = (0..x.harmonics).flat_map(|n| (0..y.harmonics).map(move |m| (n, m)));
    let terms = places.map(|at| folded.each_ref().map(|tables| tables.each_ref().map(|table| table[at]))).collect();
    let beyond = x.beyond + y.beyond + x.beyond * y.beyond;
    Folded { harmonics: [x.harmonics, y.harmonics], terms, error: total * (2.0 * (x.lacks + y.lacks) + beyond) }
}

/// The window along an axis.
struct Window {
    /// Of what is folded, and of what it is folded into.
    from: f64,
    into: f64,
    sigma: f64,
    /// Harmonics of what is folded, and how many become of them.
    folded: usize,
    harmonics: usize,
    /// What it lacks of 1 on the picture, at most.
    lacks: f64,
    /// What lies beyond the harmonics, of a wave of amplitude 1.
    beyond: f64,
}

impl Window {
    /// For a picture whose pixels are no farther than `far` from the origin.
    fn new(from: f64, into: f64, far: f64, folded: usize, budget: f64) -> Self {
        // erfc(z / √2) ≤ e^{−z² / 2}, and what two sides lack is no more than twice half of that.
        let widths = (2.0 * budget.recip().ln()).sqrt();
        let room = 0.5 * into - far;
        let sigma = room.max(f64::MIN_POSITIVE) / widths;
        let (first, fastest) = (TAU / into, TAU / from * (folded - 1) as f64);
        // Σ_{n>N} |ŵ| / P of both signs, by the first of them and a geometric series.
        let beyond = |harmonics: usize| {
            let least = harmonics as f64 * first - fastest;
            if least <= 0.0 {
                return f64::INFINITY;
            }
            let falls = (-0.5 * (sigma * least).powi(2)).exp();
            4.0 / (into * least) * falls * (1.0 + 1.0 / (first * sigma * sigma * least))
        };
        let fits = |harmonics: &usize| beyond(*harmonics) <= budget;
        let least = (fastest / first) as usize + 1;
        let harmonics = (least..least + 100_000).find(fits).unwrap_or(least + 100_000);
        let lacks = if room > 0.0 { budget } else { f64::INFINITY };
        Self { from, into, sigma, folded, harmonics, lacks, beyond: beyond(harmonics) }
    }

    /// What each harmonic gets of each wave that is folded: of cosines, or, with the sign turned, of sines.
    fn matrix(&self, sign: f64) -> Array2<f64> {
        let transform = |wave: f64| {
            let half = 0.5 * self.into * wave;
            let sinc = if half.abs() < 1e-8 { 1.0 } else { half.sin() / half };
            sinc * (-0.5 * (self.sigma * wave).powi(2)).exp()
        };
        Array2::from_shape_fn((self.harmonics, self.folded), |(n, q)| {
            let (wave, own) = (TAU / self.from * q as f64, TAU / self.into * n as f64);
            let both = transform(wave - own) + sign * transform(wave + own);
            if n == 0 { 0.5 * both } else { both }
        })
    }
}

#[cfg(test)]
mod tests {

    use super::*;
    use crate::chance::Chance;
    use crate::look::{Look, LookLens};
    use crate::plan::Request;
    use crate::raster::Raster;

    /// A few waves of one period are themselves in another, within the bound, at every pixel; and the bound is of their size.
    #[test]
    fn waves_are_folded_within_the_bound() {
        let frame = Frame::full(90, 50);
        let counts = vec![9, 7, 4, 2];
        let modes: Vec<Mode> = (0..22)
            .map(|k| [0, 1, 2].map(|c| [0, 1, 2, 3].map(|t| ((7 * k + 3 * c + 5 * t + 1) as f64).sin())))
            .collect();
        let modes = Modes::new(counts, modes, 0.0);
        for (from, into) in [(DVec2::new(9.0, 7.0), DVec2::new(4.6, 2.7)), (DVec2::new(3.1, 2.9), DVec2::new(5.0, 3.0))]
        {
            for budget in [1e-2, 1e-5, 1e-8] {
                let folded = fold(&modes, from, into, frame, budget);
                let [columns, rows] = folded.harmonics;
                assert_eq!(folded.terms.len(), columns * rows);
                assert!(folded.error <= 2.0 * budget, "{budget}: {}", folded.error);
                let kept: Vec<Mode> = modes.kept(modes.counts()).collect();
                let mut worst = 0.0f64;
                for (i, j) in (0..90).flat_map(|i| (0..50).map(move |j| (i, j))) {
                    let at = frame.position(f64::from(i), f64::from(j));
                    let old =
                        modes.counts().iter().enumerate().flat_map(|(n, &c)| (0..c as usize).map(move |m| (n, m)));
                    let new = (0..columns).flat_map(|n| (0..rows).map(move |m| (n, m)));
                    let wanted = sum(old, &kept, at, from);
                    worst = worst.max((sum(new, &folded.terms, at, into) - wanted).abs());
                }
                assert!(worst <= folded.error && worst > 1e-4 * folded.error, "{budget}: {worst} {}", folded.error);
            }
        }
    }

    /// Ghosts of a real lens, from points to such as are larger than the picture: one series, and it is the sum over all pixels and
    /// ghosts.
    #[test]
    fn ghosts_of_a_real_lens_are_one_series() {
        let frame = Frame::full(96, 54);
        let mut chance = Chance::new(7);
        let mut pixels = vec![[0.02, 0.03, 0.04, 1.0]; frame.window.pixels()];
        for lamp in [1000, 2611, 4790] {
            pixels[lamp] = [0, 1, 2, 3].map(|_| chance.between(20.0, 90.0) as f32);
        }
        let raster = Raster::new(&pixels, frame).unwrap();
        let look =
            Look { lens: LookLens::preset("double-gauss").unwrap(), axis: DVec2::new(0.1, -0.05), ..Look::default() };
        // In patches, each with its own cut ghosts.
        let images = look.images(&crate::photo::Photo::new(1, 1, vec![[0.0; 4]]), || raster).unwrap();
        assert!(images.patches() > 2);
        let problem = Problem::with_images(Vec::new(), images.clone(), frame);
        for tolerance in [1e-2, 1e-3] {
            let plan = crate::plan::plan(&problem, &Request::new(tolerance)).unwrap();
            assert!(plan.predicted.total() <= tolerance);
            let series = plan.series().unwrap();
            let kept: Vec<Mode> = series.modes.as_ref().unwrap().kept(&series.counts).collect();
            let points: Vec<DVec2> =
                (0..40).map(|k| frame.position(f64::from(k * 37 % 96), f64::from(k * 23 % 54))).collect();
            for (at, truth) in points.iter().zip(images.at(&points)) {
                let places = series.counts.iter().enumerate().flat_map(|(n, &c)| (0..c as usize).map(move |m| (n, m)));
                let error = (sum(places, &kept, *at, series.period) - truth[1] / plan.scale[1]).abs();
                assert!(error <= plan.predicted.total(), "{tolerance} at {at}: {error}");
            }
        }
    }

    fn sum(places: impl Iterator<Item = (usize, usize)>, modes: &[Mode], at: DVec2, period: DVec2) -> f64 {
        places
            .zip(modes)
            .map(|((n, m), mode)| {
                let [(sx, cx), (sy, cy)] =
                    [(n, at.x / period.x), (m, at.y / period.y)].map(|(n, turns)| (TAU * n as f64 * turns).sin_cos());
                let [a, b, c, d] = mode[1];
                a * cx * cy + b * cx * sy + c * sx * cy + d * sx * sy
            })
            .sum()
    }
}
