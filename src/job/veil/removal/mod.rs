//! A veil taken away: the photo x that a veil makes the given one of, y = A x, with a bound of how far the answer is from it.
//!
//! A is what [`Cast::change`](super::Cast::change) does to a photo, as the linear operator that it is of light: each pixel keeps D = 1 − s (f − k(0) Ω)
//! of its own and gets K x = s Σ x(a) Ω(a) k(θ) of the others'. `operator` has both, `solve` two ways to x, `bound` how far they may be off.

mod bound;
mod offsets;
mod operator;
mod ranked;
mod solve;
#[cfg(test)]
mod tests;
mod told;

use rayon::prelude::*;

use super::measure::by_definition;
use super::{NoSources, Stages, VeilSeen, check, enlarged, looked_at, on_pixels, seated, summed_by, terms};
use crate::certificate::Verify;
use crate::look::Look;
use crate::photo::Photo;
use crate::psf::Psf;
use crate::scene::Emission;
use crate::{Error, Result, limits, veil};
use bound::Bound;
use operator::{Field, Operator};
use solve::{Solution, gradients, series};
pub use told::{Amplification, Clipped, Negative, Removal, RemovalError};

/// What is asked of a removal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Removing {
    /// The largest error of a sample, relative to the brightest of the clean photo's in its channel; above 0.
    pub tolerance: f64,
    /// Whether the least that can be had will do where the tolerance cannot be.
    pub allow_floor: bool,
    /// Where the answer, veiled again, is held against the photo.
    pub verify: Verify,
    /// From which value on a sample is clipped; without one, that of a display's white, in photos for displays.
    pub clip: Option<f32>,
    /// Whether negative samples of the answer become 0.
    pub clamp: bool,
}

impl Default for Removing {
    fn default() -> Self {
        Self { tolerance: 1e-4, allow_floor: false, verify: Verify::Sample, clip: None, clamp: false }
    }
}

/// A photo without its veil.
pub struct Removed {
    /// The clean photo.
    pub photo: Photo,
    /// How it was come by, and how exactly; none where there was no veil to take away.
    pub removal: Option<Removal>,
    /// Which pixels are clipped, row by row.
    pub clipped: Vec<bool>,
    /// How many they are; none where nothing says from which value on.
    pub clipping: Option<Clipped>,
    /// What a person ought to know.
    pub warnings: Vec<String>,
}

/// What a pixel takes beside the veil's sums: some fields of three samples.
const BYTES: u64 = 120;

/// Pixels of a picture whose veil on the sphere is planned to any tolerance in no time.
const SMALL: usize = 1 << 14;

/// The veils' tolerances that an answer's asks for, relative to themselves: of the first sum, and of those that follow.
///
/// `scattered` is the largest share that a pixel loses, and `adds` says that it keeps it all the same; `tightest` is what can be had.
fn tolerances(asked: f64, scattered: f64, adds: bool, tightest: f64) -> [f64; 2] {
    /// Parts of the tolerance that the first sum gets, of four; what follows has the rest.
    const PART: f64 = 0.25;
    const LOOSEST: f64 = 1e-2;
    let kept = if adds { 1.0 } else { 1.0 - scattered };
    // Where rows do not bound the answer, its eigenvalues do.
    let least = if kept > scattered { kept - scattered } else { 1.0 - scattered.min(0.95) };
    let tight = (PART * asked * least / scattered).clamp(tightest, LOOSEST);
    let loose = if kept > scattered { (tight * kept / scattered).clamp(tight, LOOSEST) } else { tight };
    // Nearly alike, one plan is enough.
    if loose < 3.0 * tight { [tight, tight] } else { [tight, loose] }
}

/// Takes the veil of a look away from a photo that has it: what [`super::super::Found::compute`] adds to the clean one. Other than there, negative samples
/// are light like any other, since the answer could not be linear without; what is not finite is no light, and stays. Ghosts are not looked at.
///
/// # Errors
/// [`Error::Usage`] where the look contradicts itself or the photo, [`Error::ToleranceBelowFloor`] where the answer cannot be had to the
/// tolerance, [`Error::Unproved`] where nothing says how far an answer would be off, [`Error::PictureNotFinite`] where it is beyond 32-bit floats.
pub fn remove(look: &Look, mut photo: Photo, removing: Removing, stages: &mut Stages) -> Result<Removed> {
    let frame = look.frame(&photo)?;
    let (clipped, clipping) = told::clipped(&photo, removing.clip);
    let mut warnings = photo.source.notes.clone();
    warnings.extend(clipping.as_ref().and_then(Clipped::warning));
    let Some(wanted) = look.veil_on(&frame) else {
        return Ok(Removed { photo, removal: None, clipped, clipping, warnings });
    };
    check(look, wanted, &frame)?;
    let (view, seat) = seated(look, wanted, &photo, &frame)?;
    let wanted = &on_pixels(wanted, wanted.grid(&enlarged(look, &frame)).as_ref())?;
    let scattered = look.strength * largest(wanted.psf());
    if scattered == 0.0 {
        return Ok(Removed { photo, removal: None, clipped, clipping, warnings });
    }
    limits::room(BYTES * photo.pixels.len() as u64, "taking a veil away")?;
    let asked = removing.tolerance;
    // On the sphere of a large picture what is tighter takes long to find out that it cannot be had.
    let is_planar = matches!(seat.geometry, veil::Geometry::Planar { .. });
    let tightest = if is_planar || photo.pixels.len() <= SMALL { 1e-7 } else { 1e-3 };
    let tolerances = tolerances(asked, scattered, wanted.adds, tightest);
    let mut operator = stages.time("veil plan", || {
        Operator::new(wanted, seat, look.strength, &photo.pixels, Emission::of(&photo), tolerances)
    })?;
    let (units, veiled) = scaled(&operator, &photo);
    let bounds = stages.time("rows", || Bound::all(&mut operator))?;
    let method = Method::choose(&operator, &bounds, scattered, asked)?;
    let solution = stages.time("solve", || match method {
        Method::Series => series(&mut operator, &veiled, &bounds, asked),
        Method::Gradients => gradients(&mut operator, &veiled, &bounds, asked),
    })?;
    let predicted = proved(&solution, &removing, operator.veils)?;
    let clean = unscaled(&operator, &photo, &solution, units)?;
    let measured = stages.time("certify", || measured(&operator, &photo, &clean, &bounds, &removing))?;
    let negative = Negative::of(&photo.pixels, &clean, &solution, units, removing.clamp);
    warnings.extend(negative.warning());
    let removal = Removal {
        seen: VeilSeen::new(wanted, &frame, view),
        strength: look.strength,
        scattered: wanted.psf().energies(),
        adds: wanted.adds,
        terms: terms(operator.channels()),
        summed_by: summed_by(operator.channels()),
        method: method.name(),
        steps: solution.steps,
        veils: operator.veils,
        contraction: bounds.each_ref().map(|bound| bound.contraction),
        error: RemovalError { asked, predicted, measured: measured.0, pixels: measured.1 },
        amplification: Amplification::of(&bounds),
        negative,
        no_light: no_light(&photo.pixels),
    };
    warnings.extend(removal.error.check().err().map(|error| error.to_string()));
    photo.pixels = clean;
    if removing.clamp {
        clamp(&mut photo.pixels);
    }
    Ok(Removed { photo, removal: Some(removal), clipped, clipping, warnings })
}

/// How far an answer is off at most, relative to the brightest samples, where that is what was asked for.
///
/// # Errors
/// [`Error::ToleranceBelowFloor`] where it is more, and [`Error::Unproved`] where it says nothing of the answer.
fn proved(solution: &Solution, removing: &Removing, veils: usize) -> Result<f64> {
    let (asked, predicted) = (removing.tolerance, solution.relative());
    match predicted {
        // A NaN is neither.
        bound if bound <= asked || removing.allow_floor && bound < 1.0 => Ok(bound),
        floor if floor < 1.0 => Err(Error::ToleranceBelowFloor { asked, floor }),
        _ => Err(Error::Unproved(format!(
            "after {veils} sums of the veil the answer is not known to be near the clean photo"
        ))),
    }
}

/// Lets finite samples be 0 or more.
fn clamp(pixels: &mut [[f32; 4]]) {
    let colours = |pixel: &mut [f32; 4]| {
        pixel[..3].iter_mut().filter(|value| value.is_finite()).for_each(|value| *value = value.max(0.0));
    };
    pixels.par_iter_mut().for_each(colours);
}

/// How the answer is looked for.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Method {
    Series,
    Gradients,
}

impl Method {
    /// The one that takes fewer sums of the veil, of those whose answer can be proved.
    fn choose(operator: &Operator, bounds: &[Bound; 3], scattered: f64, asked: f64) -> Result<Self> {
        let contraction = bounds.iter().map(|bound| bound.contraction).fold(0.0, f64::max);
        let by_rows = bounds.iter().all(|bound| bound.dominance.is_some());
        let by_spectra = bounds.iter().all(|bound| bound.spectrum.is_some());
        if !by_rows && !by_spectra {
            return Err(Error::Unproved(format!(
                "pixels keep less of their own light than falls on them of the others', up to {contraction:.2} times as much, and only of a \
                 veil of Gaussians on a plane without a border is more known: no answer could be told from a wrong one"
            )));
        }
        // The slowest part of a photo would take so many steps: most take fewer, by the series.
        let slowest = |factor: f64| (asked.ln() / factor.ln()).max(1.0);
        let root = (1.0 - scattered.min(0.99)).sqrt();
        let [terms, steps] = [0.6 * slowest(contraction.min(0.999)), 1.0 + 2.0 * slowest((1.0 - root) / (1.0 + root))];
        let faster = operator.is_symmetric() && steps < terms;
        Ok(if by_rows && !faster { Self::Series } else { Self::Gradients })
    }

    fn name(self) -> &'static str {
        match self {
            Self::Series => "series",
            Self::Gradients => "conjugate gradients",
        }
    }
}

/// The largest share of the light that a function scatters.
fn largest(psf: &Psf) -> f64 {
    psf.energies().into_iter().fold(0.0, f64::max)
}

/// The power of two by which each channel is divided, and the photo's samples over it, of which the largest is from 1 to 2.
fn scaled(operator: &Operator, photo: &Photo) -> ([f64; 3], Field) {
    let unit = |channel: usize| {
        let finite = photo.pixels.par_iter().map(|pixel| pixel[channel].abs()).filter(|value| value.is_finite());
        let most = finite.reduce(|| 0.0, f32::max);
        if most > 0.0 { f64::from(most).log2().floor().exp2() } else { 1.0 }
    };
    let units = [0, 1, 2].map(unit);
    (units, operator.map(|channel, pixel, _| f64::from(photo.pixels[pixel][channel]) / units[channel]))
}

/// The clean photo's pixels: alpha, and what is no light, as they were.
///
/// # Errors
/// [`Error::PictureNotFinite`] where one is beyond what 32-bit floats hold.
fn unscaled(operator: &Operator, photo: &Photo, solution: &Solution, units: [f64; 3]) -> Result<Vec<[f32; 4]>> {
    let of = |(at, own): (usize, &[f32; 4])| {
        let mut pixel = *own;
        for channel in 0..3 {
            if operator.has(channel, at) {
                pixel[channel] = (units[channel] * f64::from(solution.clean[channel][at])) as f32;
            }
        }
        pixel
    };
    let pixels: Vec<[f32; 4]> = photo.pixels.par_iter().enumerate().map(of).collect();
    let lost = |(at, pixel): &(usize, &[f32; 4])| (0..3).any(|c| operator.has(c, *at) && !pixel[c].is_finite());
    match pixels.par_iter().enumerate().filter(lost).count() {
        0 => Ok(pixels),
        pixels => Err(Error::PictureNotFinite { pixels }),
    }
}

/// Samples that are no light.
fn no_light(pixels: &[[f32; 4]]) -> NoSources {
    let count = |is: fn(f32) -> bool| [0, 1, 2].map(|c| pixels.par_iter().filter(|pixel| is(pixel[c])).count());
    NoSources { nan: count(f32::is_nan), infinite: count(f32::is_infinite), negative: [0; 3] }
}

/// The largest |y − A x| at some pixels, relative to the clean photo's brightest sample in the channel and to the largest sum of a row of A, by the veil's own definition;
/// and how many pixels that are.
fn measured(
    operator: &Operator,
    photo: &Photo,
    clean: &[[f32; 4]],
    bounds: &[Bound; 3],
    removing: &Removing,
) -> Result<(f64, usize)> {
    let seat = operator.seat();
    let field = operator.map(|channel, pixel, _| f64::from(clean[pixel][channel]));
    let brightest = {
        let given = operator.given(&field, 1.0);
        super::brightest(&veil::Photo::rgba(given.as_flattened(), seat.stored).map_err(super::failed)?)
    };
    let pixels = looked_at(seat.stored, brightest, removing.verify);
    let seen: Vec<[usize; 2]> = pixels.iter().map(|pixel| seat.seen(*pixel)).collect();
    let mut veils = vec![[0.0; 3]; pixels.len()];
    for sign in [1.0, -1.0] {
        if field.iter().all(|plane| plane.par_iter().all(|value| sign * value <= 0.0)) {
            continue;
        }
        let given = operator.given(&field, sign);
        let filled = seat.filled(&given);
        let sources = veil::Photo::rgba(filled.as_flattened(), seat.size).map_err(super::failed)?;
        let truth = by_definition(
            operator.channels(),
            &sources,
            &seat.geometry,
            operator.wanted().border,
            &seen,
            removing.tolerance,
        )?;
        for (sum, truth) in veils.iter_mut().zip(truth) {
            (0..3).for_each(|c| sum[c] += f64::from(sign) * operator.strength() * truth[c]);
        }
    }
    let peaks = field.each_ref().map(|plane| f64::from(plane.par_iter().copied().reduce(|| 0.0, f32::max)));
    let mut worst = 0.0f64;
    for (&[x, y], veil) in pixels.iter().zip(veils) {
        let at = y * seat.stored[0] + x;
        let (_, kept) = operator.kept(at);
        for channel in (0..3).filter(|&channel| operator.has(channel, at)) {
            let own = kept[channel] * f64::from(clean[at][channel]);
            let left = (f64::from(photo.pixels[at][channel]) - own - veil[channel]).abs();
            let norm = bounds[channel].kept.max(1.0 - bounds[channel].row) + bounds[channel].row;
            let error = if left == 0.0 { 0.0 } else { left / (norm * peaks[channel]) };
            worst = if error.is_nan() { f64::INFINITY } else { worst.max(error) };
        }
    }
    Ok((worst, pixels.len()))
}
