//! A veil at several tolerances, for studies: how exact it is, and how long it takes.

use std::time::Instant;

use super::{
    Prepared, Stages, brightest, computed, failed, looked_at, measured, predicted, prepared, summed_by, terms, told,
};
use crate::certificate::Verify;
use crate::frame::Frame;
use crate::look::{Look, Veil as Wanted};
use crate::measure::{Rounds, Samples, in_turns};
use crate::photo::Photo;
use crate::scene::VeilSection;
use crate::{Error, Result, veil};

/// What came of one tolerance.
pub(crate) struct Trial {
    /// Gaussians of the mixture.
    pub terms: usize,
    /// How it is summed, in a word.
    pub summed_by: String,
    /// The plan's bound, relative to the local veil.
    pub predicted: f64,
    /// The largest error that was found, relative to it.
    pub measured: f64,
    /// Milliseconds of the sum, without planning.
    pub times: Samples,
}

/// Tries the veil of a look on a photo, on its frame as [`Look::frame`] gives it, at each of these tolerances, in turns; an error
/// of its own for each that cannot be had.
///
/// # Errors
/// Those of a look without a veil, or with one that no tolerance makes possible.
pub(crate) fn trials(
    look: &Look,
    photo: &Photo,
    frame: &Frame,
    tolerances: &[f64],
    rounds: Rounds,
) -> Result<Vec<Result<Trial>>> {
    let Some(wanted) = &look.veil else { return Ok(tolerances.iter().map(|_| Err(none())).collect()) };
    let plan = |&tolerance: &f64| {
        let section = VeilSection { tolerance: Some(tolerance), ..wanted.section() };
        let held = Wanted::new(&section, wanted.adds).map_err(told)?;
        prepared(look, &held, photo, frame, &mut Stages::default())
    };
    let plans: Vec<Result<Prepared>> = tolerances.iter().map(plan).collect();
    let had: Vec<&Prepared> = plans.iter().flatten().collect();
    // They lie alike, whatever the tolerance is.
    let Some(seat) = had.first().map(|plan| plan.seat) else {
        return Ok(plans.into_iter().map(|plan| plan.and_then(|_| Err(none()))).collect());
    };
    let stored = veil::Photo::rgba(photo.pixels.as_flattened(), seat.stored).map_err(failed)?;
    let filled = seat.filled(&photo.pixels);
    let sources = veil::Photo::rgba(filled.as_flattened(), seat.size).map_err(failed)?;
    let mut times = in_turns(rounds, had.len(), |index| {
        let started = Instant::now();
        computed(&had[index].channels, &sources)?;
        Ok(started.elapsed().as_secs_f64() * 1e3)
    })?
    .into_iter();
    let mut pixels = looked_at(seat.stored, brightest(&stored), Verify::Sample);
    pixels.iter_mut().for_each(|pixel| *pixel = seat.seen(*pixel));
    let mut trial = |plan: Prepared| {
        let Prepared { channels, .. } = plan;
        let veil = computed(&channels, &sources)?;
        let bound = predicted(&channels).bound;
        Ok(Trial {
            terms: terms(&channels),
            summed_by: summed_by(&channels),
            predicted: bound,
            measured: measured(&channels, &sources, &seat.geometry, wanted.border, &veil, &pixels, bound)?,
            times: times.next().unwrap_or_default().into_iter().collect(),
        })
    };
    Ok(plans.into_iter().map(|plan| plan.and_then(&mut trial)).collect())
}

fn none() -> Error {
    Error::Usage("there is no veil".into())
}
