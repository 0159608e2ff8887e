//! How a veil is computed: the mixture of Gaussians, and the plan of each channel.

use super::{failed, told};
use crate::choices::Border;
#[cfg(feature = "laboratory")]
use crate::frame::Frame;
use crate::look::{Look, Veil as Wanted};
#[cfg(feature = "laboratory")]
use crate::photo::View;
use crate::psf::{self, Psf, TOLERANCES};
use crate::veil::{self, Gaussian, Geometry, Kernel, Mixture, Picture, Plan};
use crate::{Error, Result};

/// The part of the tolerance that the mixture of Gaussians may be off by; the rest is for how it is summed.
const OF_MIXTURE: f64 = 0.5;

/// By how much positive Gaussians may be off on a plane, over that: what is further off needs a transform. On the sphere they are
/// but what the plan begins with.
const LOOSER: f64 = 4.0;

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

/// How the veil of some channels is summed, and what it is to be.
pub(super) type Channel = (Plan, Definition);

/// Pictures that functions are planned for.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pixels<'a> {
    pub geometry: &'a Geometry,
    pub size: [usize; 2],
    pub border: Border,
}

/// What a look holds its veil to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Held {
    pub asked: f64,
    /// Whether the lowest that can be had will do.
    pub least: bool,
}

impl Held {
    pub fn new(look: &Look, veil: &Wanted) -> Self {
        Self {
            asked: veil.tolerance(),
            // What nobody asked for need not be had.
            least: look.accuracy.allow_floor || !veil.is_held(),
        }
    }

    /// How the veil of a function is computed to the tolerance; or, where that will do, to the lowest that can be had, and which
    /// that is.
    ///
    /// # Errors
    /// [`Error::ToleranceBelowFloor`] with a floor at which there is a plan.
    pub fn channels(self, psf: &Psf, pixels: Pixels) -> Result<(Vec<Channel>, f64)> {
        let Self { asked, least } = self;
        match channels(psf, pixels, asked) {
            Ok(planned) => Ok((planned, asked)),
            Err(Refusal { error, from: None }) => Err(error),
            Err(Refusal { error, from: Some(from) }) => match lowest(psf, pixels, from.max(asked)) {
                Some(planned) if least => Ok(planned),
                Some((_, floor)) => Err(Error::ToleranceBelowFloor { asked, floor }),
                None => Err(error),
            },
        }
    }
}

/// Why there is no plan, and from which tolerance on there may be one.
struct Refusal {
    error: Error,
    from: Option<f64>,
}

impl From<Error> for Refusal {
    fn from(error: Error) -> Self {
        Self { error, from: None }
    }
}

impl From<veil::Error> for Refusal {
    fn from(error: veil::Error) -> Self {
        let from = match error {
            veil::Error::OutOfReach { best, .. } => Some(best),
            veil::Error::Core { asked, .. } => Some(asked),
            _ => None,
        };
        Self { error: failed(error), from }
    }
}

/// The lowest tolerance above one at which there is a plan, in steps that grow: a looser mixture has a floor of its own.
fn lowest(psf: &Psf, pixels: Pixels, above: f64) -> Option<(Vec<Channel>, f64)> {
    const LOOSEST: f64 = 0.5;
    const GROWTH: f64 = 1.1;
    let (mut tolerance, mut step) = (above, 1.02);
    loop {
        tolerance = in_two_digits(tolerance * step);
        if tolerance > LOOSEST {
            return None;
        }
        if let Ok(planned) = channels(psf, pixels, tolerance) {
            return Some((planned, tolerance));
        }
        step *= GROWTH;
    }
}

/// The next number of two digits, as it is told.
fn in_two_digits(value: f64) -> f64 {
    let unit = 10f64.powi(value.log10().floor() as i32 - 1);
    (value / unit).ceil() * unit
}

/// How the veil of each channel is computed, and what it is to be: one plan for all of them, or one each.
fn channels(psf: &Psf, pixels: Pixels, tolerance: f64) -> Result<Vec<Channel>, Refusal> {
    let Pixels { geometry, size, border } = pixels;
    if let Some((kernel, times)) = psf.picture() {
        let picture = picture(kernel, times)?;
        let plan = Plan::for_picture(&picture, size, border, tolerance)?;
        return Ok(vec![(plan, Definition::Picture(picture))]);
    }
    let plan = |kernel: Kernel| {
        let Mixture { terms, constant, quadratic } = kernel.mixture();
        let has_no_mixture = terms.is_empty() && *constant == 0.0 && *quadratic == 0.0;
        let plan = if has_no_mixture && matches!(geometry, Geometry::Planar { .. }) {
            Plan::for_profile(geometry, |distance| kernel.at(distance), size, border, tolerance)
        } else {
            Plan::new(geometry, &kernel, size, border, tolerance)
        };
        Ok((plan?, Definition::Radial(kernel)))
    };
    let of_mixture = (OF_MIXTURE * tolerance).max(TOLERANCES[0]);
    kernels(psf, pixels, of_mixture)?.into_iter().map(plan).collect()
}

/// The plan of a veil that is the same for all channels, for benches.
///
/// # Errors
/// Those of a look with this veil.
#[cfg(feature = "laboratory")]
pub(crate) fn plan_of(veil: &Wanted, frame: &Frame, view: Option<&View>, tolerance: f64) -> Result<Plan> {
    let geometry = veil.geometry(frame, view).map_err(told)?;
    let size = [frame.width as usize, frame.height as usize];
    let veil = veil.on(veil.grid(frame).as_ref());
    let mut channels = channels(veil.psf(), Pixels { geometry: &geometry, size, border: veil.border }, tolerance)
        .map_err(|refusal| refusal.error)?;
    Ok(channels.swap_remove(0).0)
}

/// The kernels that the channels have: one for all of them, or one each.
fn kernels(psf: &Psf, pixels: Pixels, tolerance: f64) -> Result<Vec<Kernel>> {
    let range = pixels.geometry.angles(pixels.size, pixels.border);
    let is_planar = matches!(pixels.geometry, Geometry::Planar { .. });
    let wanted: Psf = psf.clone();
    let value = move |angle: f64| wanted.value(angle);
    if matches!(pixels.geometry, Geometry::Equirectangular) {
        // Summed as it is.
        return Ok(vec![Kernel::new(value, Mixture::default()).map_err(failed)?]);
    }
    let Some(mixture) = positive(psf, range, tolerance, if is_planar { LOOSER } else { f64::INFINITY })? else {
        if !is_planar {
            return Err(Error::Plan(format!(
                "{} is like no sum of positive Gaussians, and on the sphere no other veil is computed: --projection planar takes it",
                psf.name()
            )));
        }
        let none = Mixture { terms: Vec::new(), constant: 0.0, quadratic: 0.0 };
        return Ok(vec![Kernel::new(value, none).map_err(failed)?]);
    };
    let of = |channel: usize| {
        let term = |term: &psf::Term| Gaussian { sigma: term.sigma, weight: term.weight * term.tint[channel] };
        let terms = mixture.terms.iter().map(term).collect();
        Mixture { terms, constant: mixture.constant, quadratic: mixture.quadratic }
    };
    if mixture.terms.iter().all(|term| term.tint == [1.0; 3]) {
        return Ok(vec![Kernel::new(value, of(0)).map_err(failed)?]);
    }
    // A grey tint is the same for all channels.
    let grey = mixture.terms.iter().all(|term| term.tint == [term.tint[0]; 3]);
    let channels = if grey { 0..1 } else { 0..3 };
    channels.map(|channel| Kernel::from_mixture(of(channel)).map_err(failed)).collect()
}

/// A mixture of positive Gaussians within `tolerance`, or, as positive ones may come less close, up to `looser` times that; none
/// where there is none.
fn positive(psf: &Psf, range: [f64; 2], tolerance: f64, looser: f64) -> Result<Option<psf::Mixture>> {
    let mut within = tolerance;
    loop {
        if psf.may_be_mixture(range, within) {
            let mixture = psf.mixture(range, within).map_err(told)?;
            if mixture.is_positive() {
                return Ok(Some(mixture));
            }
        }
        within *= 2.0;
        if within > looser * tolerance || within >= TOLERANCES[1] {
            return Ok(None);
        }
    }
}

/// A picture as a kernel, so many times what it is.
fn picture(kernel: &psf::Kernel, times: f64) -> Result<Picture> {
    let [row, column] = kernel.centre();
    let picture = Picture::new([kernel.columns(), kernel.rows()], [column, row], kernel.shared());
    let scaled = if times == 1.0 { picture } else { picture.and_then(|picture| picture.times(times)) };
    scaled.map_err(failed)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::psf::{Luminance, Observer};

    /// A tolerance that is named is one that can be had, and above what was refused, as it is printed.
    #[test]
    fn a_floor_that_is_named_can_be_had() {
        let cie = Psf::cie(Observer::new(25.0, 0.5).unwrap());
        let spencer = Psf::spencer(Luminance::Photopic);
        let cases = [(&cie, 50.0, [60, 40], 1e-8), (&spencer, 60.0, [100, 90], 1e-3)];
        // The second takes a minute.
        let count = if std::env::var_os("VGLARE_LONG_TESTS").is_some() { 2 } else { 1 };
        for (psf, fov, size, asked) in cases.into_iter().take(count) {
            let geometry = Geometry::rectilinear(fov, size[0]);
            let pixels = Pixels { geometry: &geometry, size, border: Border::None };
            let refused = Held { asked, least: false }.channels(psf, pixels).map(|(_, tolerance)| tolerance);
            let Err(Error::ToleranceBelowFloor { floor, .. }) = refused else { panic!("{fov}: {refused:?}") };
            let printed: f64 = format!("{floor:.1e}").parse().unwrap();
            assert!(floor > asked && (printed / floor - 1.0).abs() < 1e-9, "{fov}: {floor:e}");
            let (planned, held) = Held { asked: floor, least: false }.channels(psf, pixels).unwrap();
            assert!(planned[0].0.predicted().bound <= floor && held == floor, "{fov}: {floor:e}");
            let (_, least) = Held { asked, least: true }.channels(psf, pixels).unwrap();
            assert_eq!(least, floor);
        }
        assert_eq!([1.01e-3, 1e-3, 0.099_9].map(in_two_digits), [1.1e-3, 1e-3, 0.1]);
    }
}
