//! What cannot be planned for: numbers that are none, and those that f32 has no room for.

use glam::DVec2;
use rayon::prelude::*;

use super::{HIGHEST_DEGREE, Request};
use crate::problem::Images;
use crate::scene::Ghost;
use crate::series::{Bell, SineGaussian};
use crate::{Error, Result};

/// The brightest field: some way below what f32 ends at, because its largest value is known at some pixels only.
const BRIGHTEST: f64 = 1e37;

/// Periods, in half picture heights: from less than any pixel to where a phase of 32 bits tells nothing of the picture
/// apart, by a wide margin; f32 has room for the waves of all of them.
const PERIODS: [f64; 2] = [1e-6, 1e15];

/// Where copies of the bells add up to so many times the field, the period is a mistake, and f32 has no room for the sum.
const MOST_COPIES: f64 = 1e6;

/// Refuses ghosts whose numbers mean nothing: every one of them would be lost without a word, or spoil all pixels.
pub(super) fn ghosts(ghosts: &[Ghost]) -> Result<()> {
    let (smallest, largest) = (f64::from(f32::MIN_POSITIVE), f64::from(f32::MAX));
    let size = |size: f64| (smallest..=largest).contains(&size);
    let wrong = |ghost: &Ghost| {
        if !(size(ghost.size.x) && size(ghost.size.y)) {
            Some(format!(
                "sizes of {:e} x {:e}, and each has to be from {smallest:.1e} to {largest:.1e}",
                ghost.size.x, ghost.size.y
            ))
        } else if let Some(least) = too_narrow(ghost) {
            Some(format!(
                "sizes of {:e} x {:e}, and a {} bell is at least {:.1e} x {:.1e} in its period",
                ghost.size.x, ghost.size.y, ghost.bell, least.x, least.y
            ))
        } else if ghost.center.is_nan() || ghost.center.abs().max_element() > largest {
            Some(format!("its centre at ({:e}, {:e}), beyond what 32-bit floats hold", ghost.center.x, ghost.center.y))
        } else {
            let radiance = ghost.radiance.iter().find(|radiance| !radiance.is_finite());
            radiance.map(|radiance| format!("a radiance of {radiance}"))
        }
    };
    let first = ghosts.par_iter().enumerate().find_map_first(|(index, ghost)| Some((index, wrong(ghost)?)));
    first.map_or(Ok(()), |(index, wrong)| Err(Error::Plan(format!("ghost {} has {wrong}", index + 1))))
}

/// Refuses the same of a photo's images.
pub(super) fn images(images: &Images) -> Result<()> {
    let gathered: Vec<Ghost> = images.all().iter().map(|image| images.gathered(image)).collect();
    ghosts(&gathered)
}

/// The least sizes that the ghost's bell may have, where it is too narrow.
fn too_narrow(ghost: &Ghost) -> Option<DVec2> {
    let Bell::SineGaussian(bell) = &ghost.bell else { return None };
    let least = SineGaussian::NARROWEST * bell.period;
    ghost.size.cmplt(least).any().then_some(least)
}

/// Refuses a period that no series has.
pub(super) fn period(period: DVec2) -> Result<()> {
    let [least, most] = PERIODS;
    if [period.x, period.y].iter().all(|period| (least..=most).contains(period)) {
        return Ok(());
    }
    Err(Error::Plan(format!(
        "a period of {:e} x {:e}, and each has to be from {least:e} to {most:e} half picture heights",
        period.x, period.y
    )))
}

/// Refuses a period in which the bells' copies drown the field; `error` is what they add, relative to it.
pub(super) fn copies(period: DVec2, error: f64) -> Result<()> {
    if error <= MOST_COPIES {
        return Ok(());
    }
    Err(Error::Plan(format!(
        "a period of {:e} x {:e} is too short: the bells' copies would add up to {error:.0e} times the glare",
        period.x, period.y
    )))
}

/// Refuses a degree that no series has.
pub(super) fn request(request: &Request) -> Result<()> {
    match request.degree {
        Some([n, m]) if n.max(m) > HIGHEST_DEGREE => {
            Err(Error::Plan(format!("a degree of {n} x {m}, and {HIGHEST_DEGREE} is the highest")))
        }
        _ => Ok(()),
    }
}

/// Refuses a field that is brighter than a pixel of f32 can be.
pub(super) fn scale(scale: [f64; 3]) -> Result<()> {
    match scale.into_iter().find(|&scale| scale.is_nan() || scale > BRIGHTEST) {
        Some(scale) => {
            Err(Error::Plan(format!("the field reaches {scale:.1e}, and {BRIGHTEST:e} is what vglare renders")))
        }
        None => Ok(()),
    }
}
