//! The unit of a field in which the whole photo shines: a lower bound of its largest value, from its own modes.

use std::f64::consts::TAU;

use glam::DVec2;

use super::amplitudes::Rgb;
use super::candidate::Survey;
use super::images;
use super::modes::Mode;
use super::series::Wide;
use super::weigh::{self, Weighed};
use super::{Request, share};
use crate::frame::Frame;
use crate::problem::{Images, Problem};
use crate::{Error, Result};

/// The tolerance to which modes are computed that are only to tell how large the field is.
const COARSE: f64 = 0.03;

/// What the unit may be below the field's largest value, at those places that are looked at, by what is not known of it.
const CLOSE: f64 = 0.2;

/// How much brighter than light that is spread evenly a field is at its largest, as a first guess.
const LIKELY: f64 = 3.0;

/// The first guess may be off by much; each next is off by what the last could tell.
const GUESSES: usize = 12;

/// Places along the longer side of the picture.
const PLACES: u32 = 64;

/// The weights of a problem with images, in units of what the field reaches.
///
/// # Errors
/// [`Error::Plan`] where no series of them can be had.
pub(super) fn weighed(problem: &Problem, images: &Images, request: &Request) -> Result<Weighed> {
    let mut weighed = weigh::weigh(problem, request.tolerance);
    let of_ghosts = if problem.ghosts().is_empty() { [0.0; 3] } else { weighed.scale };
    // All that the images hold, at one place.
    let mut scale = images.all().iter().fold(of_ghosts, |sum, image| {
        let peak = images.gathered(image).radiance;
        [0, 1, 2].map(|colour| sum[colour] + peak[colour].abs())
    });
    if let Some(infinite) = scale.into_iter().find(|scale| !scale.is_finite()) {
        return Err(Error::Plan(format!("the ghosts of all pixels would reach {infinite:e}")));
    }
    if problem.ghosts().is_empty() {
        let spread = evenly(images);
        scale = [0, 1, 2].map(|colour| scale[colour].min(LIKELY * spread[colour]));
    }
    let largest = scale.into_iter().fold(0.0, f64::max);
    // A colour of which there is nothing is held against the others.
    scale = scale.map(|own| if own > 0.0 { own } else { largest });
    let coarse = Request { tolerance: COARSE, degree: None, evaluator: None, ..*request };
    for _ in 0..GUESSES {
        let survey = Survey::of(problem, in_units(problem, images, &coarse, scale));
        let wide = Wide::new(problem, &survey, &coarse).ok_or_else(|| images::too_many(&survey.groups))?;
        let (modes, period) = wide.modes();
        let kept = modes.counts().to_vec();
        let seen = Seen::new(problem.frame(), &kept, &modes.kept(&kept).collect::<Vec<_>>(), period);
        // What was dropped is a little of the tolerance, too.
        let error = wide.error() + survey.weighed.dropped_error;
        weighed.peaks.extend(seen.peaks);
        let known = seen.largest.iter().all(|largest| *largest == 0.0 || error <= CLOSE * largest);
        let next = |colour: usize| {
            let largest = seen.largest[colour];
            scale[colour] * if error <= CLOSE * largest { largest - error } else { largest.max(error) }
        };
        scale = [0, 1, 2].map(next);
        if known {
            break;
        }
    }
    let peaks = std::mem::take(&mut weighed.peaks);
    Ok(Weighed { peaks, ..in_units(problem, images, request, scale) })
}

/// What the images would come to if the light of each were spread evenly over all that it reaches.
pub(super) fn evenly(images: &Images) -> Rgb {
    images.all().iter().fold([0.0; 3], |sum, image| {
        let (flux, [low, high]) = (images.gathered(image).flux(), images.centres(image));
        let area = (high - low + 2.0 * image.ghost.size).element_product();
        [0, 1, 2].map(|colour| sum[colour] + flux[colour].abs() / area)
    })
}

/// The weights in a given unit.
pub(super) fn in_units(problem: &Problem, images: &Images, request: &Request, scale: Rgb) -> Weighed {
    let mut weighed = weigh::weigh_in(problem, request.tolerance, scale);
    weighed.images = images::weights(images, scale);
    // The faintest are left out: they would not show if all of their light were at one place.
    let largest = weighed.images.clone();
    let budget = share::DROPPED * request.tolerance - weighed.dropped_error;
    let (dropped, error) = weigh::drop_faint(&mut weighed.images, &largest, budget);
    weighed.dropped += dropped;
    weighed.dropped_error += error;
    weighed.weight += weighed.images.iter().sum::<f64>();
    weighed
}

/// What a series comes to on a grid of places.
struct Seen {
    /// The largest magnitude, RGB.
    largest: Rgb,
    /// And the pixel that it is at.
    peaks: [[i32; 2]; 3],
}

impl Seen {
    fn new(frame: Frame, counts: &[u32], modes: &[Mode], period: DVec2) -> Self {
        let window = frame.window;
        let pixels = |first: i32, length: u32, count: u32| -> Vec<i32> {
            let at = |k: u32| first + (u64::from(length - 1) * u64::from(k) / u64::from(count.max(2) - 1)) as i32;
            (0..count).map(at).collect()
        };
        let longer = window.width.max(window.height);
        let along = |length: u32| (PLACES * length).div_ceil(longer).clamp(length.min(4), length.max(1));
        let columns = pixels(window.x, window.width, along(window.width));
        let rows = pixels(window.y, window.height, along(window.height));
        let waves = |turns: f64, harmonics: usize| -> Vec<[f64; 2]> {
            let wave = |n: usize| {
                let turns = n as f64 * turns;
                let (sin, cos) = (TAU * (turns - turns.round())).sin_cos();
                [cos, sin]
            };
            (0..harmonics).map(wave).collect()
        };
        let down: Vec<Vec<[f64; 2]>> =
            rows.iter().map(|j| waves(frame.y(f64::from(*j)) / period.y, counts[0] as usize)).collect();
        let mut seen = Self { largest: [0.0; 3], peaks: [[columns[0], rows[0]]; 3] };
        for (row, down) in rows.iter().zip(&down) {
            // Of each harmonic of x, its cosine's and its sine's part.
            let mut rest = modes;
            let profile: Vec<[[f64; 2]; 3]> = counts
                .iter()
                .map(|&count| {
                    let (mine, others) = rest.split_at(count as usize);
                    rest = others;
                    let mut sums = [[0.0; 2]; 3];
                    for (mode, [cos, sin]) in mine.iter().zip(down) {
                        for (sum, [a, b, c, d]) in sums.iter_mut().zip(mode) {
                            *sum = [sum[0] + a * cos + b * sin, sum[1] + c * cos + d * sin];
                        }
                    }
                    sums
                })
                .collect();
            for column in &columns {
                let across = waves(frame.x(f64::from(*column)) / period.x, counts.len());
                let mut value = [0.0; 3];
                for (sums, [cos, sin]) in profile.iter().zip(&across) {
                    for (value, [a, b]) in value.iter_mut().zip(sums) {
                        *value += a * cos + b * sin;
                    }
                }
                for (colour, value) in value.into_iter().enumerate() {
                    if value.abs() > seen.largest[colour] {
                        seen.largest[colour] = value.abs();
                        seen.peaks[colour] = [*column, *row];
                    }
                }
            }
        }
        seen
    }
}
