//! What is asked for of closed forms.

use clap::ValueEnum;

use super::{Closed, Model, Place, rays, refusal};
use crate::frame::Frame;
use crate::laboratory::index::field::{Field, Place as Pixel};
use crate::look::{Look, LookLens};
use crate::options::numbers::{not_negative, positive};
use crate::photo::View;
use crate::scene::{Optical, OpticsSection};
use crate::{Error, Result};

/// How an index is found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Method {
    /// A chart is seen through the look, as pictures are
    Rendered,
    /// By integrals of ghosts and veil, without a picture
    Closed,
    /// One beside the other
    Both,
}

/// Closed forms.
#[derive(Debug, clap::Args)]
#[command(next_help_heading = "Closed form")]
pub struct ClosedArgs {
    /// How the index is found [default: both of a lens that is known by its surfaces, closed with --angles or --fstops, else rendered]
    #[arg(long, value_enum, conflicts_with = "photo")]
    method: Option<Method>,

    /// Spots at these angles from the axis, in degrees along the picture's diagonal, each alone in the field, in closed form
    #[arg(long, value_name = "DEGREES,…", value_delimiter = ',', conflicts_with_all = ["photo", "chart"], value_parser = not_negative)]
    angles: Vec<f64>,

    /// The lens at each of these f-numbers, in closed form
    #[arg(long, value_name = "N,…", value_delimiter = ',', conflicts_with_all = ["photo", "fstop"], value_parser = positive)]
    fstops: Vec<f64>,

    /// Trace so many rays for each pair of the lens's surfaces, from a spot's centre back to the field, and give the ghosts' part of the index
    /// by them, with an interval of 99 %; 64 or more
    #[arg(long, value_name = "COUNT", conflicts_with = "photo", value_parser = clap::value_parser!(u32).range(64..=1 << 30))]
    rays: Option<u32>,
}

impl ClosedArgs {
    /// Whether a chart is rendered, and whether there are closed forms.
    ///
    /// # Errors
    /// [`Error::Usage`] for options that contradict each other, and for a look without a closed form where one is asked for.
    pub fn methods(&self, look: &Look) -> Result<[bool; 2]> {
        let is_table = !self.angles.is_empty() || !self.fstops.is_empty();
        let refused = refusal(look);
        let method = match self.method {
            Some(Method::Rendered | Method::Both) if is_table => {
                return Err(Error::Usage(
                    "--angles and --fstops are of closed forms: leave --method out, or give --method closed".into(),
                ));
            }
            Some(Method::Rendered) if self.rays.is_some() => {
                return Err(Error::Usage("--rays are beside a closed form: give --method closed or both".into()));
            }
            Some(method) => method,
            None if is_table => Method::Closed,
            None if self.rays.is_some() => Method::Both,
            None if refused.is_none() && matches!(look.lens, LookLens::Optical(_)) => Method::Both,
            None => Method::Rendered,
        };
        match (method, refused) {
            (Method::Closed | Method::Both, Some(why)) => Err(Error::Usage(why)),
            (method, _) => Ok([method != Method::Closed, method != Method::Rendered]),
        }
    }

    /// The closed forms: of the chart's places, diameter by diameter, or of each f-number's angles.
    ///
    /// # Errors
    /// [`Error::Usage`] for angles that are not in the picture and spots that overlap; those of lenses that cannot be set so.
    pub fn indices(&self, look: &Look, field: &Field, pixels: &[Pixel], diameters: &[f64]) -> Result<Vec<Closed>> {
        let frame = Frame::full(field.size[0], field.size[1]);
        let view = || Ok(View::of_field(look.fov.unwrap_or(super::super::USUAL_FOV), &frame, look.projection()));
        let frame = look.in_unit(frame, view)?;
        let looks = self.looks(look)?;
        let mut all = Vec::new();
        for look in &looks {
            let fitted = look.fitted(&frame);
            let model = Model::new(&fitted, frame, field.focal)?;
            let system = self.rays.map(|_| rays::system(&model)).transpose()?;
            let tracing = system.as_ref().zip(self.rays);
            let tracing =
                tracing.map(|(system, rays)| rays::Tracing::new(&model, system, rays as usize)).transpose()?;
            for &diameter in diameters {
                let places = self.places(&model, &frame, pixels, diameter)?;
                // Spots of a chart are in it at once, those at angles each alone.
                for spots in places.chunks(if self.has_angles() { 1 } else { places.len() }) {
                    for (place, mut closed) in spots.iter().zip(model.indices(spots, diameter)?) {
                        let traced = tracing.as_ref().map(|tracing| tracing.index(&model, spots, place, &closed));
                        closed.rays = traced.transpose()?;
                        all.push(closed);
                    }
                }
            }
        }
        Ok(all)
    }

    /// The look at each f-number.
    fn looks(&self, look: &Look) -> Result<Vec<Look>> {
        if self.fstops.is_empty() {
            return Ok(vec![look.clone()]);
        }
        let LookLens::Optical(optical) = &look.lens else {
            return Err(Error::Usage(
                "--fstops are of a lens that is known by its surfaces: name one by --lens (vglare lens lists them)"
                    .into(),
            ));
        };
        let at = |&fstop: &f64| {
            let lens = Optical::new(OpticsSection { fstop: Some(fstop), ..optical.section().clone() })?;
            Ok(Look { lens: LookLens::Optical(lens), ..look.clone() })
        };
        self.fstops.iter().map(at).collect()
    }

    fn places(&self, model: &Model<'_>, frame: &Frame, pixels: &[Pixel], diameter: f64) -> Result<Vec<Place>> {
        if !self.angles.is_empty() {
            return model.on_diagonal(&self.angles, diameter);
        }
        let place =
            |&Pixel { name, pixel: [x, y] }: &Pixel| Place { name: Some(name), at: frame.position(x as f64, y as f64) };
        Ok(pixels.iter().map(place).collect())
    }

    /// Whether spots are at angles, in place of the chart's.
    pub fn has_angles(&self) -> bool {
        !self.angles.is_empty()
    }
}
