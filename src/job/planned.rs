//! The second step: how the glare is computed; and how it becomes the third.

use std::sync::Arc;

use super::beside::beside;
use super::{Computed, Computer, Done, EachPixel, Found, Planning, Stages, Step, Wanted, Watch, veil};
use crate::certificate::{Certificate, Verify};
use crate::gpu::{Info, PassTime};
use crate::look::Look;
use crate::photo::{self, Photo};
use crate::plan::Plan;
use crate::renderer::{Pending, Picture, Settings};
use crate::scene::Goal;
use crate::{Error, Result};

/// A photo for which there is a plan.
pub struct Planned<'a> {
    /// The photo, and what glares in it.
    pub found: Found<'a>,
    /// How that is computed.
    pub planning: Planning,
    /// What it was planned for.
    pub info: Arc<Info>,
}

/// What was drawn; some of the picture may still be on its way back.
struct Drawn {
    picture: Option<(Photo, Pending)>,
    glare: Option<Photo>,
    passes: Vec<PassTime>,
    measured_ms: Option<f64>,
}

impl<'a> Planned<'a> {
    /// The smallest and the largest value of the field, all colours alike, between which [`crate::choices::Normalize::Minmax`] stretches it.
    ///
    /// # Errors
    /// Where the driver refuses.
    pub fn range(&self, computer: &mut Computer) -> Result<[f32; 2]> {
        let field = &mut computer.renderer()?.field;
        field.set_scene(&self.planning.plan)?;
        field.range(self.planning.plan.problem().frame())
    }

    /// Computes the spectrum, composites onto the photo and measures the error. `computer` has to be the one that the
    /// plan was made for.
    ///
    /// # Errors
    /// Where the driver refuses; [`Error::NotFinite`], [`Error::PictureNotFinite`]; [`Error::Cancelled`].
    pub fn render(self, computer: &mut Computer, wanted: Wanted, watch: &impl Watch) -> Result<Done<'a>> {
        let Self { found, planning, info } = self;
        let Found { look, photo, frame, facts, bad, scene, mut stages, mut warnings, recovered, settings } = found;
        // What is not finite in the photo already is no fault of the glare's.
        let before = if bad.nan + bad.infinite > 0 { photo::not_finite(&photo.pixels) } else { 0 };
        watch.begin(Step::Computing)?;
        let cast = veil::cast(look, &photo, &recovered, &frame, wanted.verify, Some(computer), &mut stages)?;
        drop(recovered);
        let renderer = computer.renderer()?;
        renderer.field.set_timing(wanted.times);
        // Of the photo as it is: the picture takes over its memory.
        let change = cast.as_ref().map(|cast| cast.change(&photo.pixels));
        let drawn = draw(renderer, photo, &planning.plan, &settings, wanted, &mut stages);
        renderer.field.set_timing(false);
        let Drawn { picture, mut glare, passes, measured_ms } = drawn?;
        let ghosts = glare.as_ref().map(|glare| &*glare.pixels);
        let layers = wanted.layers.then(|| beside(&scene, ghosts, change.as_ref(), frame.window.pixels()));
        glare = glare.filter(|_| wanted.glare);
        if let (Some(cast), Some(glare)) = (&cast, &mut glare) {
            cast.add_to(&mut glare.pixels);
        }

        let certificate = certify(renderer, &planning.plan, wanted.verify, &mut stages, watch)?;
        if let Err(error) = certificate.check() {
            warnings.push(error.to_string());
        }
        let picture = match picture {
            Some((mut picture, pending)) => {
                renderer.collect(pending, &mut picture.pixels)?;
                if let Some(change) = &change {
                    change.add_to(&mut picture.pixels);
                }
                picture.source.beside = layers.unwrap_or_default();
                Some(picture)
            }
            None => None,
        };
        stays_finite(picture.as_ref(), before, glare.as_ref(), cast.as_ref(), certificate.not_finite)?;
        let each_pixel = picture.as_ref().and_then(|picture| each_pixel(look, picture, &planning.plan, &certificate));
        warnings.extend(each_pixel.as_ref().and_then(|each_pixel| Some(each_pixel.check().err()?.to_string())));
        let computed = Some(Computed { info, planning, certificate, each_pixel, passes, measured_ms });
        let veiled = cast.map(|cast| cast.veiled);
        warnings.extend(veiled.as_ref().and_then(|veiled| Some(veiled.error.check().err()?.to_string())));
        Ok(Done { look, frame, facts, bad, scene, picture, glare, computed, veiled, stages, warnings })
    }
}

/// How exact the glare is at each pixel, where the look asks for it.
fn each_pixel(look: &Look, picture: &Photo, plan: &Plan, certificate: &Certificate) -> Option<EachPixel> {
    let Certificate { predicted, measured, .. } = *certificate;
    match look.accuracy.goal {
        Goal::Tolerance(asked) if look.accuracy.each_pixel => {
            Some(EachPixel::of(picture, plan, look.strength, asked, [predicted, measured]))
        }
        _ => None,
    }
}

/// Draws what is wanted. The picture takes over the photo's memory, unless someone else holds it.
fn draw(
    renderer: &mut Picture,
    photo: Arc<Photo>,
    plan: &Plan,
    settings: &Settings,
    wanted: Wanted,
    stages: &mut Stages,
) -> Result<Drawn> {
    let frame = plan.problem().frame();
    stages.time("spectrum", || renderer.field.set_scene(plan))?;
    // What the plan has computed of the spectrum is the spectrum's.
    let computed = plan.spectrum_milliseconds();
    stages.shift("plan", "spectrum", computed);
    let mut passes = renderer.field.take_times();
    let spectrum = computed + milliseconds(&passes);
    let glare = match wanted.glare || wanted.layers {
        true => Some(photo.companion(stages.time("glare", || renderer.glare(frame, settings))?)),
        false => None,
    };
    let mut times = renderer.field.take_times();
    let mut picture = None;
    if wanted.picture {
        passes.append(&mut times);
        let mut photo = Arc::unwrap_or_clone(photo);
        let pending = stages.time("composite", || {
            if wanted.times {
                // A pass can only be timed while nothing else is under way.
                return renderer.composite(frame, &mut photo.pixels, settings).map(|()| Pending::default());
            }
            renderer.submit(frame, &mut photo.pixels, settings)
        })?;
        picture = Some((photo, pending));
        times = renderer.field.take_times();
    }
    let measured_ms = wanted.times.then(|| spectrum + milliseconds(&times));
    passes.extend(times);
    Ok(Drawn { picture, glare, passes, measured_ms })
}

/// Holds the field against the direct sum.
fn certify(
    renderer: &mut Picture,
    plan: &Plan,
    verify: Verify,
    stages: &mut Stages,
    watch: &impl Watch,
) -> Result<Certificate> {
    watch.begin(Step::Measuring)?;
    stages.time("certify", || match verify {
        Verify::Sample => Certificate::measure(&mut renderer.field, plan),
        Verify::Full => {
            watch.measured(plan.problem().frame().window.pixels());
            Certificate::measure_all(&mut renderer.field, plan, |pixels| watch.advance(pixels))
        }
    })
}

/// An error where the picture is not finite though the photo is, but for `before` pixels, or where the glare is not; the veil is
/// part of it.
pub(super) fn stays_finite(
    picture: Option<&Photo>,
    before: usize,
    glare: Option<&Photo>,
    veil: Option<&veil::Cast>,
    not_finite: usize,
) -> Result<()> {
    let count = |photo: Option<&Photo>| photo.map_or(0, |photo| photo::not_finite(&photo.pixels));
    let of_glare = count(glare).max(not_finite).max(veil.map_or(0, veil::Cast::not_finite));
    match (of_glare, count(picture).saturating_sub(before)) {
        (0, 0) => Ok(()),
        (0, pixels) => Err(Error::PictureNotFinite { pixels }),
        (of_glare, pixels) => Err(Error::NotFinite { pixels: pixels.max(of_glare) }),
    }
}

/// What a budget is for; moving the picture to the device and back is not in it.
fn milliseconds(passes: &[PassTime]) -> f64 {
    let counts = |time: &&PassTime| time.pass != "upload" && time.pass != "readback";
    passes.iter().filter(counts).map(|time| time.wall_ms).sum()
}
