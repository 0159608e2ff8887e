//! What cannot be planned for: numbers that are none, and those that f32 has no room for.

use glam::DVec2;
use rayon::prelude::*;

use super::{HIGHEST_DEGREE, Request};
use crate::scene::Ghost;
use crate::{Error, Result};

/// The brightest field: some way below what f32 ends at, because its largest value is known at some pixels only.
const BRIGHTEST: f64 = 1e37;

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

/// Refuses a period or a degree that no series has.
pub(super) fn request(request: &Request) -> Result<()> {
    let period = request.period.unwrap_or(DVec2::ONE);
    if !(period.is_finite() && period.min_element() > 0.0) {
        return Err(Error::Plan(format!("a period of {} x {} is none", period.x, period.y)));
    }
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
