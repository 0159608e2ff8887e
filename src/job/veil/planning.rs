//! How a veil is computed: the mixture of Gaussians, and the plan of each channel.

use super::{failed, told};
#[cfg(feature = "laboratory")]
use crate::frame::Frame;
use crate::look::Veil as Wanted;
#[cfg(feature = "laboratory")]
use crate::photo::View;
use crate::psf::{self, Psf, TOLERANCES};
use crate::veil::{Gaussian, Geometry, Kernel, Mixture, Picture, Plan};
use crate::{Error, Result};

/// The part of the tolerance that the mixture of Gaussians may be off by; the rest is for how it is summed.
const OF_MIXTURE: f64 = 0.5;

/// What the veil of some channels is to be.
pub(super) enum Definition {
    /// A function of the distance, or of the angle.
    Radial(Kernel),
    /// A picture, on a plane, one pixel of it for one of the photo.
    Picture(Picture),
}

impl Definition {
    /// Gaussians of its mixture; none where it is no mixture.
    pub fn terms(&self) -> usize {
        match self {
            Self::Radial(kernel) => kernel.mixture().terms.len(),
            Self::Picture(_) => 0,
        }
    }
}

/// How the veil is computed to a tolerance; or, where that will do, to the lowest that can be had, and which that is.
pub(super) fn at_least(
    veil: &Wanted,
    geometry: &Geometry,
    size: [usize; 2],
    asked: f64,
    least: bool,
) -> Result<(Vec<(Plan, Definition)>, f64)> {
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
fn channels(veil: &Wanted, geometry: &Geometry, size: [usize; 2], tolerance: f64) -> Result<Vec<(Plan, Definition)>> {
    if let Some((kernel, times)) = veil.psf().picture() {
        let picture = picture(kernel, times)?;
        let plan = Plan::for_picture(&picture, size, veil.border, tolerance).map_err(failed)?;
        return Ok(vec![(plan, Definition::Picture(picture))]);
    }
    let plan = |kernel: Kernel| {
        let Mixture { terms, constant, quadratic } = kernel.mixture();
        let plan = if terms.is_empty() && *constant == 0.0 && *quadratic == 0.0 {
            Plan::for_profile(geometry, |distance| kernel.at(distance), size, veil.border, tolerance)
        } else {
            Plan::new(geometry, &kernel, size, veil.border, tolerance)
        };
        Ok((plan.map_err(failed)?, Definition::Radial(kernel)))
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
    let wanted: Psf = psf.clone();
    let value = move |angle: f64| wanted.value(angle);
    if !mixture.is_positive() {
        if !matches!(geometry, Geometry::Planar { .. }) {
            return Err(Error::Plan(format!(
                "{} is like no sum of positive Gaussians, and on the sphere no other veil is computed: --projection planar takes it",
                psf.name()
            )));
        }
        let none = Mixture { terms: Vec::new(), constant: 0.0, quadratic: 0.0 };
        return Ok(vec![Kernel::new(value, none).map_err(failed)?]);
    }
    let of = |channel: usize| {
        let term = |term: &psf::Term| Gaussian { sigma: term.sigma, weight: term.weight * term.tint[channel] };
        let terms = mixture.terms.iter().map(term).collect();
        Mixture { terms, constant: mixture.constant, quadratic: mixture.quadratic }
    };
    if mixture.terms.iter().any(|term| term.tint != [1.0; 3]) {
        return (0..3).map(|channel| Kernel::from_mixture(of(channel)).map_err(failed)).collect();
    }
    Ok(vec![Kernel::new(value, of(0)).map_err(failed)?])
}

/// A picture as a kernel, so many times what it is.
fn picture(kernel: &psf::Kernel, times: f64) -> Result<Picture> {
    let [row, column] = kernel.centre();
    Picture::new([kernel.columns(), kernel.rows()], [column, row], kernel.pixels().to_vec())
        .and_then(|picture| picture.times(times))
        .map_err(failed)
}
