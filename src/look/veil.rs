//! The veil of a look: a point-spread function, and how its angles lie in a picture.

use crate::choices::{Border, Projection};
use crate::frame::Frame;
use crate::psf::{self, Parameters, Psf, Unit};
use crate::scene::{VeilFunction, VeilSection, check_fov};
use crate::veil::Geometry;

/// What every pixel of a photo scatters over all others.
#[derive(Debug, Clone, PartialEq)]
pub struct Veil {
    parameters: Parameters,
    function: VeilFunction,
    fov: Option<f64>,
    projection: Option<Projection>,
    /// What lies beyond the picture's edges.
    pub border: Border,
    /// The largest error relative to the veil at each pixel, where somebody said it.
    tolerance: Option<f64>,
    /// Whether the photo keeps all of its own light, instead of losing what is scattered: where a person asked to add.
    pub adds: bool,
}

impl Veil {
    /// What a veil is held to where nobody says: no eye sees a hundredth of a veil.
    pub const TOLERANCE: f64 = 1e-2;

    /// What a section of a scene file says, or options do.
    ///
    /// # Errors
    /// A [`psf::Fault`], which names the key: of a function that cannot be had, and a field of view that is none.
    pub fn new(section: &VeilSection, adds: bool) -> Result<Self, psf::Fault> {
        let VeilSection { parameters, fov, projection, border, tolerance } = section;
        fov.map_or(Ok(()), |fov| check_fov(fov, *projection))?;
        Ok(Self {
            function: VeilFunction::new(parameters)?,
            parameters: parameters.clone(),
            fov: *fov,
            projection: *projection,
            border: border.unwrap_or_default(),
            tolerance: *tolerance,
            adds,
        })
    }

    /// The same, added to the photo or not.
    #[must_use]
    pub fn adding(self, adds: bool) -> Self {
        Self { adds, ..self }
    }

    /// The section of a scene file that says the same.
    pub fn section(&self) -> VeilSection {
        let &Self { ref parameters, function: _, fov, projection, border, tolerance, adds: _ } = self;
        VeilSection { parameters: parameters.clone(), fov, projection, border: Some(border), tolerance }
    }

    /// What it is held to, relative to the veil at each pixel: [`Veil::TOLERANCE`] unless somebody said otherwise.
    pub fn tolerance(&self) -> f64 {
        self.tolerance.unwrap_or(Self::TOLERANCE)
    }

    /// Whether somebody said what it is held to.
    pub fn is_held(&self) -> bool {
        self.tolerance.is_some()
    }

    /// The function.
    pub fn psf(&self) -> &Psf {
        self.function.psf()
    }

    /// The field of view that was given, in degrees across the picture's width.
    pub fn fov(&self) -> Option<f64> {
        self.fov
    }

    /// How the picture was formed: as it was said, or rectilinear for a function in degrees and a plane for any other.
    pub fn projection(&self) -> Projection {
        let by_default = match self.psf().unit() {
            Unit::Degrees => Projection::Rectilinear,
            Unit::Look | Unit::Pixels => Projection::Planar,
        };
        self.projection.unwrap_or(by_default)
    }

    /// Where the pixels of a picture lie for this function.
    ///
    /// # Errors
    /// A [`psf::Fault`]: where the function is in degrees and nothing says what the picture spans, where it is not and the
    /// picture is to be a sphere, and for pixels that are not square.
    pub fn geometry(&self, frame: &Frame) -> Result<Geometry, psf::Fault> {
        let fault = |key, reason: String| Err(psf::Fault::new(key, reason));
        if frame.pixel_aspect != 1.0 {
            return fault("psf", "a veil needs square pixels, and this picture has none".into());
        }
        let (name, projection) = (self.psf().name(), self.projection());
        match self.psf().unit() {
            Unit::Look => match projection {
                Projection::Planar => {
                    let pitch = frame.pixel_size();
                    Ok(Geometry::Planar { pitch, solid_angle: pitch * pitch })
                }
                _ => fault("projection", format!("{name} is a function on the picture's plane, not in degrees")),
            },
            Unit::Pixels => fault("psf", format!("{name} is no radial function, and vglare computes radial ones")),
            Unit::Degrees => {
                let Some(fov) = self.fov else {
                    return fault(
                        "fov",
                        format!(
                            "{name} is in degrees, and nothing says how many of them the picture spans: give a field of view, \
                             as 50 for a standard lens"
                        ),
                    );
                };
                check_fov(fov, Some(projection))?;
                if projection != Projection::Planar && self.border != Border::None {
                    return fault(
                        "border",
                        "nothing is known of the sphere beyond a picture: only a plane has a border".into(),
                    );
                }
                let width = frame.width as usize;
                // A window that lies elsewhere than in the middle of its picture would be seen from elsewhere.
                if projection != Projection::Planar && *frame != Frame::full(frame.width, frame.height) {
                    return fault(
                        "projection",
                        "a picture of which another part is stored than all has a planar veil only".into(),
                    );
                }
                Ok(match projection {
                    Projection::Rectilinear => Geometry::rectilinear(fov, width),
                    Projection::Fisheye => Geometry::fisheye(fov, width),
                    // As it is in the middle.
                    Projection::Planar => {
                        let focal = 0.5 * width as f64 / (0.5 * fov).to_radians().tan();
                        Geometry::planar_degrees((1.0 / focal).to_degrees())
                    }
                })
            }
        }
    }
}
