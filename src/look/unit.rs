//! What a look's lengths and angles are in a picture.

use super::{Look, Veil};
use crate::choices::{LengthUnit, Projection};
use crate::frame::Frame;
use crate::photo::{Photo, View};
use crate::scene::check_fov;
use crate::{Error, Result};

impl Look {
    /// A photo's frame, with lengths in the look's unit.
    ///
    /// All lengths are, positions as well as sizes: a look then is one drawing, larger or smaller, about the picture's centre.
    ///
    /// # Errors
    /// [`Error::Usage`] where the unit is the degree and nothing says what the picture spans.
    pub fn frame(&self, photo: &Photo) -> Result<Frame> {
        self.in_unit(photo.frame, || self.view(photo, "the unit of lengths is the degree"))
    }

    /// A frame with lengths in the look's unit; `view` says how its picture is seen, where that matters.
    pub(crate) fn in_unit(&self, frame: Frame, view: impl FnOnce() -> Result<View>) -> Result<Frame> {
        // In half picture heights.
        let across = frame.pixel_aspect * f64::from(frame.width) / f64::from(frame.height);
        Ok(frame.in_units_of(match self.unit {
            LengthUnit::Height => 1.0,
            LengthUnit::ShortSide => across.min(1.0),
            LengthUnit::Diagonal => across.hypot(1.0),
            LengthUnit::Degrees => 2.0 * view()?.focal * 1.0f64.to_radians() / f64::from(frame.height),
        }))
    }

    /// How a photo was seen: by the field that somebody said, else by what its file says.
    ///
    /// # Errors
    /// [`Error::Usage`] for a field that is none, and where nothing says it, with `why` it is needed.
    pub fn view(&self, photo: &Photo, why: &str) -> Result<View> {
        let whole = (self.projection() == Projection::Equirectangular).then_some(360.0);
        if let Some(fov) = self.fov.or(whole) {
            check_fov(fov, Some(self.projection()))
                .map_err(|fault| Error::Usage(format!("--fov: {}", fault.reason)))?;
            let mut view = View::of_field(fov, &photo.frame, self.projection());
            if whole.is_some() {
                view.from = "all directions".to_owned();
            }
            return Ok(view);
        }
        let unsaid = |doubt: String| {
            Error::Usage(format!(
                "--fov: {why}, and nothing says how many of them the picture spans: give a field of view, as 50 for a standard \
                 lens{doubt}"
            ))
        };
        photo.view().map_err(|reason| unsaid(format!(" ({reason})")))?.ok_or_else(|| unsaid(String::new()))
    }

    /// How the camera formed the picture: as a veil in degrees has it, and rectilinear without one.
    pub fn projection(&self) -> Projection {
        self.veil.as_ref().filter(|veil| veil.is_in_degrees()).map_or(Projection::Rectilinear, Veil::projection)
    }
}
