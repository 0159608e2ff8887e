//! Pictures in their surroundings: what `apply --environment` and `animate --panorama` have in common.

use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Instant;

use serde::Serialize;

use crate::choices::Projection;
use crate::environment::{Environment, Outside, Sight, StrayError, StrayPlan, band};
use crate::look::Look;
use crate::motion::{Camera, Panorama};
use crate::options::HoodArgs;
use crate::photo::{self, Photo, ReadOptions};
use crate::psf::Psf;
use crate::{Error, Result};

/// A panorama, and what of its light reaches a picture.
pub struct Surroundings {
    environment: Environment,
    hood: HoodArgs,
    /// The function of the look's veil and its tolerance, where that is in degrees.
    veil: Option<(Psf, f64)>,
    /// The plan that was made last, which views of one kind share.
    plan: Mutex<Option<Arc<StrayPlan>>>,
}

/// A picture before it has its glare: what it shows, what is around it, and what its camera does not see.
pub struct Seen<'a> {
    surroundings: &'a Surroundings,
    outside: Outside<'a>,
    camera: Camera,
    fov: f64,
    /// The picture, with the band around it; without its pixels once they are taken.
    photo: Photo,
    /// Lights outside of it.
    lights: usize,
    /// What finding out what it does not see took.
    milliseconds: f64,
}

/// What light from outside the frame did.
#[derive(Debug, Clone, Serialize)]
pub struct StrayTold {
    /// Yaw, pitch and roll of the camera in degrees.
    pub view: [f64; 3],
    /// What the picture's width spans, in degrees.
    pub fov: f64,
    /// Degrees from the axis from which on light is cut.
    pub hood: f64,
    /// The light from outside that the hood accepts: radiance times steradians, RGB.
    pub flux: [f64; 3],
    /// Lights outside of the picture that make ghosts.
    pub lights: usize,
    /// What is spread evenly, as radiance, RGB.
    pub even: [f64; 3],
    /// The mean over the picture of all that is added of it, ghosts apart, RGB.
    pub mean: [f64; 3],
    /// Its share in the mean of all glare.
    pub share: Option<f64>,
    /// Columns and rows around the picture that shine as its own do.
    pub band: [u32; 2],
    /// Directions in which the veil from beyond was summed.
    pub directions: Option<usize>,
    /// How exact that is, relative to itself.
    pub error: Option<StrayError>,
    /// Milliseconds that it took, its measurement apart.
    pub milliseconds: f64,
}

impl Surroundings {
    /// Reads a panorama.
    ///
    /// # Errors
    /// Those of [`photo::read_with`]; [`Error::ReadPhoto`] for one that is no panorama, or has pixels that are no number or infinite.
    pub fn read(path: &Path, options: &ReadOptions, hood: HoodArgs, look: &Look) -> Result<Self> {
        let photo = photo::read_with(path, &ReadOptions { overscan: 0.0, ..options.clone() })?;
        let bad = photo::survey(&photo);
        if bad.nan + bad.infinite > 0 {
            let at =
                bad.first.map_or_else(String::new, |(column, row, _)| format!(", one at column {column}, row {row}"));
            let count = bad.nan + bad.infinite;
            return Err(Error::read_photo(
                path,
                format!("surroundings need a number in every pixel, and {count} are NaN or infinite{at}"),
            ));
        }
        let panorama = Panorama::new(photo).map_err(|reason| Error::read_photo(path, reason))?;
        let veil = look.veil.as_ref().filter(|veil| look.strength != 0.0 && veil.is_in_degrees());
        let veil = veil.map(|veil| (veil.psf().clone(), veil.tolerance()));
        Ok(Self { environment: Environment::new(panorama, &look.find), hood, veil, plan: Mutex::new(None) })
    }

    /// What a camera sees of it, on a picture whose width spans `fov` degrees, with at least so many columns and rows beyond it; or
    /// a photo in place of what it sees.
    ///
    /// # Errors
    /// [`Error::Usage`] for a photo that does not fit.
    pub fn seen(
        &self,
        camera: &Camera,
        fov: f64,
        sides: [u32; 2],
        least: [u32; 2],
        photo: Option<Photo>,
    ) -> Result<Seen<'_>> {
        let panorama = self.environment.panorama();
        let band = band(fov, sides, panorama.photo().height());
        let beyond = [0, 1].map(|side| band[side].max(least[side]));
        let sight = Sight::new(camera, fov, sides, beyond, self.hood.hood());
        let view = panorama.view(camera, fov, sides, beyond);
        let photo = match photo {
            Some(photo) => placed(photo, view)?,
            None => view,
        };
        let started = Instant::now();
        let outside = self.environment.outside(sight, self.planned(&sight));
        let milliseconds = started.elapsed().as_secs_f64() * 1e3;
        Ok(Seen { surroundings: self, outside, camera: *camera, fov, photo, lights: 0, milliseconds })
    }

    /// How the veil from outside is summed on pictures as a sight has them, where there is one.
    fn planned(&self, sight: &Sight) -> Option<Arc<StrayPlan>> {
        let (psf, tolerance) = self.veil.as_ref()?;
        // A plan is whole or not there, whoever panicked.
        let mut kept = self.plan.lock().unwrap_or_else(PoisonError::into_inner);
        if !kept.as_ref().is_some_and(|plan| plan.fits(psf, *tolerance, sight)) {
            *kept = Some(Arc::new(StrayPlan::new(psf, *tolerance, sight)));
        }
        kept.clone()
    }
}

/// What a photo and its surroundings may say differently of their white, relatively, and still count in one unit.
const SAME_UNIT: f64 = 0.01;

/// A photo amid what a camera sees.
fn placed(photo: Photo, view: Photo) -> Result<Photo> {
    let refused = |why: &str| Err(Error::Usage(format!("--environment: {why}")));
    if !photo.frame.is_whole() || photo.frame.pixel_aspect != 1.0 {
        return refused("the photo is to be all of a picture, of square pixels, and nothing beyond it");
    }
    if photo.source.primaries != view.source.primaries {
        return refused("the photo and the panorama are of other primaries: --primaries says those of both");
    }
    if let (Some(one), Some(other)) = (photo.luminance_scale(), view.luminance_scale()) {
        let [one, other] = [one, other].map(|scale| scale.cd_m2_per_unit);
        if (one / other - 1.0).abs() > SAME_UNIT {
            let why = format!(
                "white is {one:.4} cd/m² in the photo and {other:.4} in the panorama: --luminance says it of both"
            );
            return refused(&why);
        }
    }
    Ok(photo.surrounded(view))
}

impl Seen<'_> {
    /// The picture, with the band around it, whose pixels are gone then.
    pub fn take(&mut self) -> Photo {
        let pixels = std::mem::take(&mut self.photo.pixels);
        Photo { frame: self.photo.frame, pixels, source: self.photo.source.clone() }
    }

    /// A look for it: with the lights outside of it, and its field of view.
    ///
    /// # Errors
    /// [`Error::Usage`] for a picture that is not rectilinear, and those of [`Look::frame`].
    pub fn look(&mut self, look: &Look) -> Result<Look> {
        if look.projection() != Projection::Rectilinear {
            return Err(Error::Usage("--projection: a view of surroundings is rectilinear".into()));
        }
        let mut look = Look { fov: Some(self.fov), ..look.clone() };
        let lights = if look.renders() { self.outside.lights(&look.frame(&self.photo)?) } else { Vec::new() };
        self.lights = lights.len();
        look.add_lights(lights);
        Ok(look)
    }

    /// Adds what comes from beyond the band to the picture and to its glare, whose pixels are those of the photo.
    pub fn lay(&self, look: &Look, picture: Option<&mut Photo>, glare: Option<&mut Photo>) -> StrayTold {
        let started = Instant::now();
        let field = self.outside.veil();
        let hood = self.surroundings.hood;
        let even = self.outside.even(look.strength * hood.stray());
        let whole = glare.as_ref().map(|glare| glare.mean());
        for photo in picture.into_iter().chain(glare) {
            let window = photo.frame.window;
            let before = [-window.x, -window.y].map(|side| side.max(0) as u32);
            if let Some(field) = &field {
                field.add_to(&mut photo.pixels, window.width as usize, before, look.strength);
            }
            if even != [0.0; 3] {
                photo.pixels.iter_mut().for_each(|pixel| (0..3).for_each(|k| pixel[k] += even[k] as f32));
            }
        }
        let milliseconds = self.milliseconds + started.elapsed().as_secs_f64() * 1e3;
        let veil = field.as_ref().map_or([0.0; 3], |field| field.mean().map(|mean| look.strength * mean));
        let added = [0, 1, 2].map(|k| veil[k] + even[k]);
        let sum = |colours: [f64; 3]| colours.into_iter().sum::<f64>();
        let Camera { yaw, pitch, roll, fov: _ } = self.camera;
        StrayTold {
            view: [yaw, pitch, roll],
            fov: self.fov,
            hood: hood.hood(),
            flux: self.outside.flux(),
            lights: self.lights,
            even,
            mean: added,
            share: whole.map(|whole| sum(added) / (sum(whole) + sum(added)).max(f64::MIN_POSITIVE)),
            band: self.outside.beyond(),
            directions: field.as_ref().map(|field| field.directions()),
            error: field.map(|field| self.outside.measured(&field)),
            milliseconds,
        }
    }
}

impl std::fmt::Display for StrayTold {
    /// In two lines.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { hood, flux, lights, share, error, .. } = self;
        let mean = flux.iter().sum::<f64>() / 3.0;
        write!(
            f,
            "outside  {mean:.4} steradians of 1 fall into the lens from beyond the picture, to {hood}° off its axis"
        )?;
        if let Some(share) = share {
            write!(f, ": {:.1} % of the mean glare", 100.0 * share)?;
        }
        match lights {
            0 => {}
            1 => write!(f, "; 1 light there makes ghosts")?,
            lights => write!(f, "; {lights} lights there make ghosts")?,
        }
        if self.directions.is_none() {
            write!(f, "\n         the look has no veil in degrees, which would be known there")?;
        }
        if let Some(StrayError { asked, predicted, measured, pixels }) = error {
            write!(
                f,
                "\n         its veil is off by {measured:.1e} of itself, measured at {pixels} pixels, {predicted:.1e} predicted, {asked:.1e} \
                 asked"
            )?;
        }
        Ok(())
    }
}
