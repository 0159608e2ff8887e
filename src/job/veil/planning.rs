//! How a veil is computed: the mixture of Gaussians, and the plan of each channel.

use super::{failed, told};
#[cfg(feature = "laboratory")]
use crate::frame::Frame;
use crate::look::Veil as Wanted;
#[cfg(feature = "laboratory")]
use crate::photo::View;
use crate::psf::{Psf, TOLERANCES};
use crate::veil::{Gaussian, Geometry, Kernel, Mixture, Plan};
use crate::{Error, Result};

/// The part of the tolerance that the mixture of Gaussians may be off by; the rest is for how it is summed.
const OF_MIXTURE: f64 = 0.5;

/// How the veil is computed to a tolerance; or, where that will do, to the lowest that can be had, and which that is.
pub(super) fn at_least(
    veil: &Wanted,
    geometry: &Geometry,
    size: [usize; 2],
    asked: f64,
    least: bool,
) -> Result<(Vec<(Plan, Kernel)>, f64)> {
    // A looser mixture has a floor of its own.
    const TRIES: u32 = 4;
    const MORE: f64 = 1.05;
    let mut tolerance = asked;
    for _ in 0..TRIES {
        match channels(veil, geometry, size, tolerance) {
            Err(Error::ToleranceBelowFloor { floor, .. }) if least && MORE * floor < 1.0 => {
                tolerance = MORE * floor.max(tolerance);
            }
            planned => return Ok((planned?, tolerance)),
        }
    }
    channels(veil, geometry, size, tolerance).map(|planned| (planned, tolerance))
}

/// How the veil of each channel is computed, and what it is to be: one plan for all of them, or one each.
fn channels(veil: &Wanted, geometry: &Geometry, size: [usize; 2], tolerance: f64) -> Result<Vec<(Plan, Kernel)>> {
    let plan = |kernel: Kernel| {
        let plan = Plan::new(geometry, &kernel, size, veil.border, tolerance).map_err(failed)?;
        Ok((plan, kernel))
    };
    let of_mixture = (OF_MIXTURE * tolerance).max(TOLERANCES[0]);
    kernels(veil, geometry, size, of_mixture)?.into_iter().map(plan).collect()
}

/// The plan of a veil that is the same for all channels, for benches.
///
/// # Errors
/// Those of a look with this veil.
#[cfg(feature = "laboratory")]
pub(crate) fn plan_of(veil: &Wanted, frame: &Frame, view: Option<&View>, tolerance: f64) -> Result<Plan> {
    let geometry = veil.geometry(frame, view).map_err(told)?;
    let size = [frame.width as usize, frame.height as usize];
    let mut channels = channels(veil, &geometry, size, tolerance)?;
    Ok(channels.swap_remove(0).0)
}

/// The kernels that the channels have: one for all of them, or one each.
fn kernels(veil: &Wanted, geometry: &Geometry, size: [usize; 2], tolerance: f64) -> Result<Vec<Kernel>> {
    let psf = veil.psf();
    let range = geometry.angles(size, veil.border);
    let mut mixture = psf.mixture(range, tolerance).map_err(told)?;
    // Positive ones may come less close.
    let mut looser = 2.0 * tolerance;
    while !mixture.is_positive() && looser < TOLERANCES[1] {
        mixture = psf.mixture(range, looser).map_err(told)?;
        looser *= 2.0;
    }
    if !mixture.is_positive() {
        return Err(Error::Plan(format!(
            "{} is like no sum of positive Gaussians, and no other veil is computed",
            psf.name()
        )));
    }
    let of = |channel: usize| {
        let term = |term: &crate::psf::Term| Gaussian { sigma: term.sigma, weight: term.weight * term.tint[channel] };
        let terms = mixture.terms.iter().map(term).collect();
        Mixture { terms, constant: mixture.constant, quadratic: mixture.quadratic }
    };
    if mixture.terms.iter().any(|term| term.tint != [1.0; 3]) {
        return (0..3).map(|channel| Kernel::from_mixture(of(channel)).map_err(failed)).collect();
    }
    let wanted: Psf = psf.clone();
    Ok(vec![Kernel::new(move |angle| wanted.value(angle), of(0)).map_err(failed)?])
}
