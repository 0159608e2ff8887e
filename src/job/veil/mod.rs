//! The veil of a photo: planned, computed, held against its definition, and what it does to the picture.

mod account;
mod layers;
mod measure;
mod planned;
mod planning;
mod removal;
mod seat;
mod summing;
#[cfg(feature = "laboratory")]
mod trials;

use std::cell::Cell;
use std::rc::Rc;

use rayon::prelude::*;

use super::{Computer, Stages};
use crate::certificate::Verify;
use crate::choices::Normalize;
use crate::frame::Frame;
use crate::look::{Look, Veil as Wanted};
use crate::photo::{Photo, View};
use crate::psf::{Fault, Grid, Name, Unit};
use crate::scene::{Emission, Recovered};
use crate::veil::{self, Predicted};
use crate::{Error, Result, limits};

pub use account::{Ledger, NoSources, VeilError, Veiled};
use account::{Loss, ledger, no_sources};
pub use layers::{MOST_LAYERS, VeilLayers, VeilSums};
use measure::{brightest, looked_at, measured};
pub use planned::{VeilPlanned, VeilSeen};
#[cfg(feature = "laboratory")]
pub(crate) use planning::plan_of;
use planning::{Channel, Definition, Held};
pub use removal::{Amplification, Clipped, Negative, Removal, RemovalError, Removed, Removing, remove};
use seat::Seat;
use summing::{Summed, computed, summed};
#[cfg(feature = "laboratory")]
pub(crate) use trials::{Trial, trials};

/// Half a unit in the last place of an f32.
const HALF_A_UNIT: f64 = 0.5 * f32::EPSILON as f64;

/// A veil that is ready to be laid over its photo.
pub(super) struct Cast {
    /// s V, planes of rows.
    planes: [Vec<f32>; 3],
    loses: Loss,
    pub veiled: Veiled,
}

/// What is known of a veil before anything is summed.
pub(super) struct Prepared {
    /// The veil on these pixels.
    wanted: Wanted,
    view: Option<View>,
    seat: Seat,
    /// A plan and a kernel for all channels, or one for each.
    channels: Rc<Vec<Channel>>,
    /// The tolerance that it is held to.
    asked: f64,
}

thread_local! {
    /// The veil that this thread planned last: photos of a sequence that are seen alike share its plan, which depends on nothing else.
    static KEPT: Cell<Option<Kept>> = const { Cell::new(None) };
}

/// How a veil is planned, and for what.
struct Kept {
    asked_for: Wanted,
    grid: Option<Grid>,
    seat: Seat,
    held: Held,
    /// The veil on these pixels, and how it is planned.
    wanted: Wanted,
    channels: Rc<Vec<Channel>>,
    asked: f64,
}

/// Plans the veil of a look for pixels of a frame, which is the photo's, or that of a photo made larger or smaller.
fn prepared(look: &Look, wanted: &Wanted, photo: &Photo, frame: &Frame, stages: &mut Stages) -> Result<Prepared> {
    check(look, wanted, frame)?;
    let (view, seat) = seated(look, wanted, photo, frame)?;
    let (held, grid) = (Held::new(look, wanted), wanted.grid(&enlarged(look, frame)));
    let planned = |kept: &mut Option<Kept>| {
        let fits = |kept: &Kept| (&kept.asked_for, kept.grid, kept.seat, kept.held) == (wanted, grid, seat, held);
        if !kept.as_ref().is_some_and(fits) {
            let asked_for = wanted.clone();
            let wanted = on_pixels(wanted, grid.as_ref())?;
            let (channels, asked) = held.channels(wanted.psf(), seat.pixels(wanted.border))?;
            *kept = Some(Kept { asked_for, grid, seat, held, wanted, channels: channels.into(), asked });
        }
        let Kept { wanted, channels, asked, .. } = kept.as_ref().expect("it is planned");
        Ok(Prepared { wanted: wanted.clone(), view, seat, channels: channels.clone(), asked: *asked })
    };
    stages.time("veil plan", || with_kept(planned))
}

/// Does something with what was planned last. That is taken out meanwhile: a thread that waits for its planning may plan another.
fn with_kept<T>(work: impl FnOnce(&mut Option<Kept>) -> T) -> T {
    let mut kept = KEPT.take();
    let result = work(&mut kept);
    KEPT.set(kept);
    result
}

/// How a photo was seen, where that matters, and where the pixels of a frame lie for a veil.
fn seated(look: &Look, wanted: &Wanted, photo: &Photo, frame: &Frame) -> Result<(Option<View>, Seat)> {
    let view = seen(look, wanted, photo)?.map(|view| view.resized(&photo.frame, frame));
    let seat = Seat::new(wanted, &enlarged(look, frame), view.as_ref())?;
    Ok((view, seat))
}

/// The veil on pixels that its function has to know.
///
/// # Errors
/// Where the system has no room for a picture of it.
fn on_pixels(wanted: &Wanted, grid: Option<&Grid>) -> Result<Wanted> {
    if let Some(Grid { stored: [columns, rows], .. }) = grid {
        let bytes = 4 * size_of::<[f64; 3]>() as u64 * *columns as u64 * *rows as u64;
        limits::room(bytes, "the picture of the veil's function")?;
    }
    Ok(wanted.on(grid))
}

/// A look that is made larger is so by its veil, too, where that is on the picture's plane.
fn enlarged(look: &Look, frame: &Frame) -> Frame {
    frame.in_units_of(frame.unit * look.size)
}

/// How the veil of a look would be computed on the pixels of a frame, which is the photo's, or that of a photo made larger or
/// smaller; none without one.
///
/// # Errors
/// Those that computing it would have before it begins.
pub fn plan_veil(look: &Look, photo: &Photo, frame: &Frame) -> Result<Option<VeilPlanned>> {
    let Some(wanted) = look.veil_on(frame) else { return Ok(None) };
    let prepared = prepared(look, wanted, photo, frame, &mut Stages::default())?;
    Ok(Some(VeilPlanned::new(look, frame, prepared)))
}

/// The veil that a look asks for, of a photo that shines as it is `recovered`; none without one.
///
/// # Errors
/// [`Error::Usage`] where the look contradicts itself or the photo, [`Error::ToleranceBelowFloor`] where the veil cannot be had to
/// the tolerance.
pub(super) fn cast(
    look: &Look,
    photo: &Photo,
    recovered: &Recovered,
    frame: &Frame,
    verify: Verify,
    computer: Option<&mut Computer>,
    stages: &mut Stages,
) -> Result<Option<Cast>> {
    let Some(wanted) = look.veil_on(frame) else { return Ok(None) };
    let Prepared { wanted, view, seat, channels, asked } = prepared(look, wanted, photo, frame, stages)?;
    let wanted = &wanted;
    let pixels = &*Emission::of(photo).given(recovered.over(&photo.pixels));
    let stored = veil::Photo::rgba(pixels.as_flattened(), seat.stored).map_err(failed)?;
    let filled = seat.filled(pixels);
    let sources = veil::Photo::rgba(filled.as_flattened(), seat.size).map_err(failed)?;
    let Summed { veil: computed, by, note } = stages.time("veil", || summed(&channels, &sources, asked, computer))?;
    // Of a transform the plan knows no more than what it is held to.
    let certified = computed.certified.into_iter().fold(0.0, f64::max);
    let measured = stages.time("veil certify", || {
        let mut pixels = looked_at(seat.stored, brightest(&stored), verify);
        pixels.iter_mut().for_each(|pixel| *pixel = seat.seen(*pixel));
        measured(&channels, &sources, &seat.geometry, wanted.border, &computed, &pixels, certified)
            .map(|error| (error, pixels.len()))
    })?;
    let mut computed = seat.cropped(computed);
    let strength = look.strength;
    let loses = Loss::new(wanted, seat, strength);
    let scale = strength as f32;
    computed.planes.par_iter_mut().for_each(|plane| plane.iter_mut().for_each(|value| *value *= scale));
    let veil::Veil { planes, bad, dark, .. } = computed;
    // The product is rounded.
    let predicted = certified + if strength == 1.0 { 0.0 } else { HALF_A_UNIT };
    let veiled = Veiled {
        seen: VeilSeen::new(wanted, frame, view),
        strength,
        scattered: wanted.psf().energies(),
        centre: wanted.psf().centres(),
        adds: wanted.adds,
        terms: terms(&channels),
        summed_by: summed_by(&channels),
        computed_by: by,
        notes: [raised(asked, wanted.tolerance()), without_size(look, wanted), coarse(loses.in_the_middle()), note]
            .into_iter()
            .flatten()
            .collect(),
        error: VeilError { asked, predicted, measured: measured.0, pixels: measured.1 },
        ledger: ledger(&stored, &planes, &loses),
        dark,
        no_sources: no_sources(bad),
    };
    Ok(Some(Cast { planes, loses, veiled }))
}

/// How the photo was seen, for a veil in degrees.
fn seen(look: &Look, veil: &Wanted, photo: &Photo) -> Result<Option<View>> {
    let why = || format!("{} is in degrees", veil.psf().name());
    veil.is_in_degrees().then(|| look.view(photo, &why())).transpose()
}

fn raised(tolerance: f64, asked: f64) -> Option<String> {
    (tolerance > asked).then(|| {
        format!("the veil is held to {tolerance:.1e} of itself instead of {asked:.1e}: the lowest that can be had here")
    })
}

/// Says so where a size is asked for of a veil that has none.
fn without_size(look: &Look, veil: &Wanted) -> Option<String> {
    let why = match (veil.psf().unit(), veil.psf().name()) {
        (Unit::Look, _) => return None,
        (Unit::Degrees, _) => "is in degrees",
        (_, Name::Starburst) => "is as large as the f-number and the sensor make it",
        (Unit::Pixels | Unit::Micrometres, _) => "is a picture, one pixel of it for one of the photo",
    };
    let (size, name) = (look.size, veil.psf().name());
    (size != 1.0).then(|| format!("a size of {size} changes nothing of the veil, whose function, {name}, {why}"))
}

/// Says so where a pixel's own share of what it scatters is more than all of that, and it gains light; of what the one in the middle
/// loses, RGB.
fn coarse(lost: [f64; 3]) -> Option<String> {
    let most = lost.into_iter().fold(0.0, f64::min);
    (most < 0.0).then(|| {
        format!(
            "the pixels are coarser than the function's core: in the middle of the picture they come out {:.2} times as bright, by the \
             veil's definition",
            1.0 - most
        )
    })
}

/// Whether a look's veil can be what it says.
fn check(look: &Look, veil: &Wanted, frame: &Frame) -> Result<()> {
    if look.normalize != Normalize::None {
        return Err(Error::Usage("a veil needs --normalize none: only that glare is physical".into()));
    }
    let most = veil.energies(&enlarged(look, frame)).into_iter().fold(0.0, f64::max);
    if look.strength * most >= 1.0 && !veil.adds {
        return Err(Error::Usage(format!(
            "a strength of {} scatters {:.3} of the light, and there is no more than all of it: give less, or --mix add to keep the \
             photo as it is",
            look.strength,
            look.strength * most
        )));
    }
    Ok(())
}

fn told(fault: Fault) -> Error {
    let option = if fault.key == "psf" { "veil" } else { fault.key };
    Error::Usage(format!("--{option}: {}", fault.reason))
}

fn failed(error: veil::Error) -> Error {
    match error {
        veil::Error::OutOfReach { asked, best, .. } => Error::ToleranceBelowFloor { asked, floor: best },
        // A picture that there cannot be: no plan would do.
        veil::Error::Geometry(reason) => Error::Usage(reason),
        error => Error::Plan(error.to_string()),
    }
}

/// How the veil is summed, in a word for each way that a channel of it is.
fn summed_by(channels: &[Channel]) -> String {
    let mut ways: Vec<String> = channels.iter().map(|(plan, _)| plan.method().to_string()).collect();
    ways.sort();
    ways.dedup();
    ways.join(" and ")
}

/// Gaussians of the mixture.
fn terms(channels: &[Channel]) -> usize {
    channels.iter().map(|(_, definition)| definition.terms()).max().unwrap_or(0)
}

fn predicted(channels: &[Channel]) -> Predicted {
    let worst = channels.iter().map(|(plan, _)| plan.predicted()).max_by(|a, b| a.bound.total_cmp(&b.bound));
    worst.expect("there is a kernel").clone()
}

/// What a sample gives: nothing where it is negative or no number.
fn light(value: f32) -> f64 {
    if value > 0.0 && value.is_finite() { f64::from(value) } else { 0.0 }
}

impl Cast {
    /// Pixels at which it is no finite number.
    pub fn not_finite(&self) -> usize {
        let finite = |at: usize| self.planes.iter().all(|plane| plane[at].is_finite());
        (0..self.planes[0].len()).into_par_iter().filter(|&at| !finite(at)).count()
    }

    /// Adds the veil to glare.
    pub fn add_to(&self, glare: &mut [[f32; 4]]) {
        let planes = self.planes.each_ref();
        glare.par_iter_mut().enumerate().for_each(|(at, pixel)| {
            pixel.iter_mut().zip(planes).for_each(|(value, plane)| *value += plane[at]);
        });
    }

    /// What the photo's pixels change by: less what they lose, more what falls on them. What is negative or no number loses
    /// nothing.
    pub fn change(&self, photo: &[[f32; 4]]) -> Change {
        let of = |(at, own): (usize, &[f32; 4])| {
            let (_, lost) = self.loses.at(at);
            [0, 1, 2].map(|k| (f64::from(self.planes[k][at]) - lost[k] * light(own[k])) as f32)
        };
        Change(photo.par_iter().enumerate().map(of).collect())
    }
}

/// What is added to a photo, RGB.
pub(super) struct Change(Vec<[f32; 3]>);

impl Change {
    /// Adds it.
    pub fn add_to(&self, picture: &mut [[f32; 4]]) {
        picture.par_iter_mut().zip(&self.0).for_each(|(pixel, change)| {
            pixel.iter_mut().zip(change).for_each(|(value, change)| *value += change);
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::psf::Parameters;
    use crate::scene::VeilSection;

    fn prepared_at(age: f64) -> Prepared {
        let photo = Photo::new(12, 8, vec![[1.0; 4]; 96]);
        let parameters = Parameters { age: Some(age), ..Parameters::new(Name::Cie) };
        let section = VeilSection { parameters, fov: None, projection: None, border: None, tolerance: None };
        let wanted = Wanted::new(&section, false).unwrap();
        let look = Look { veil: Some(wanted.clone()), fov: Some(50.0), ..Look::default() };
        prepared(&look, &wanted, &photo, &photo.frame, &mut Stages::default()).unwrap()
    }

    #[test]
    fn the_plan_before_is_taken_where_nothing_else_is_asked_for() {
        let [first, again, older, back] = [40.0, 40.0, 70.0, 40.0].map(prepared_at);
        assert!(Rc::ptr_eq(&first.channels, &again.channels) && !Rc::ptr_eq(&first.channels, &back.channels));
        assert!(older.wanted.psf().energies()[0] > first.wanted.psf().energies()[0]);
        assert_eq!(back.wanted, first.wanted);
    }

    #[test]
    fn another_veil_may_be_planned_while_one_is() {
        let kept = with_kept(|kept| {
            let inner = prepared_at(30.0);
            *kept = None;
            inner
        });
        // What was planned within is not taken for what was planned around it.
        assert!(with_kept(|kept| kept.is_none()));
        assert!(!Rc::ptr_eq(&kept.channels, &prepared_at(30.0).channels));
    }
}
