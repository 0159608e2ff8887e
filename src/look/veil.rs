//! The veil of a look: a point-spread function, and how its angles lie in a picture.

use crate::choices::{Border, Projection};
use crate::frame::Frame;
use crate::photo::View;
use crate::psf::{self, Basis, Grid, Parameters, Psf, Unit};
use crate::scene::{VeilFunction, VeilSection};
use crate::veil::Geometry;

/// What every pixel of a photo scatters over all others.
#[derive(Debug, Clone, PartialEq)]
pub struct Veil {
    parameters: Parameters,
    function: VeilFunction,
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

    /// What a section of a scene file says, or options do, but for its field of view, which is the look's.
    ///
    /// # Errors
    /// A [`psf::Fault`], which names the key: of a function that cannot be had.
    pub fn new(section: &VeilSection, adds: bool) -> Result<Self, psf::Fault> {
        let VeilSection { parameters, fov: _, projection, border, tolerance } = section;
        Ok(Self {
            function: VeilFunction::new(parameters)?,
            parameters: parameters.clone(),
            projection: *projection,
            border: border.unwrap_or_default(),
            tolerance: *tolerance,
            adds,
        })
    }

    /// Whether its function is what a section says, however exact it is to be.
    pub(super) fn is_of(&self, section: &VeilSection) -> bool {
        self.parameters == section.parameters
    }

    /// The same as another section says it. No file is read again for a scatter, a projection, a border or a tolerance.
    ///
    /// # Errors
    /// Those of [`Veil::new`].
    pub fn changed(&self, section: &VeilSection) -> Result<Self, psf::Fault> {
        let unscattered = |parameters: &Parameters| Parameters { scatter: None, ..parameters.clone() };
        let of = |function| Self { function, ..self.saying(section) };
        if section.parameters == self.parameters {
            return Ok(of(self.function.clone()));
        }
        match section.parameters.scatter {
            Some(scatter) if unscattered(&section.parameters) == unscattered(&self.parameters) => {
                self.function.scattering(scatter).map(of)
            }
            _ => VeilFunction::new(&section.parameters).map(of),
        }
    }

    /// What a section says beside the function.
    fn saying(&self, section: &VeilSection) -> Self {
        let &VeilSection { ref parameters, fov: _, projection, border, tolerance } = section;
        let border = border.unwrap_or_default();
        Self { parameters: parameters.clone(), projection, border, tolerance, ..self.clone() }
    }

    /// Veils of functions that scatter all of the light, at most `most`, and what each is multiplied by, RGB, so that their sum is this
    /// one: see [`psf::Basis`]. What changes nothing but the multiples leaves them as they are.
    pub(crate) fn parts(&self, most: usize) -> (Vec<Self>, Vec<[f64; 3]>) {
        let Basis { parts, weights } = self.psf().basis(most);
        let part = |psf: Psf| {
            let (parameters, function) = (Parameters::new(psf.name()), VeilFunction::from(psf));
            Self { parameters, function, adds: false, ..self.clone() }
        };
        (parts.into_iter().map(part).collect(), weights)
    }

    /// The same, added to the photo or not.
    #[must_use]
    pub fn adding(self, adds: bool) -> Self {
        Self { adds, ..self }
    }

    /// The section of a scene file that says the same, without a field of view.
    pub fn section(&self) -> VeilSection {
        let &Self { ref parameters, function: _, projection, border, tolerance, adds: _ } = self;
        VeilSection { parameters: parameters.clone(), fov: None, projection, border: Some(border), tolerance }
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

    /// The pixels that its function has to know, of a photo's frame with lengths in the look's unit; none where it is the same for all.
    pub(crate) fn grid(&self, frame: &Frame) -> Option<Grid> {
        let stored = [frame.window.width, frame.window.height].map(|side| side as usize);
        self.psf().is_of_pixels().then(|| Grid { stored, across: frame.width as usize, pitch: frame.pixel_size() })
    }

    /// The same on these pixels: its function is then one of pixels, too.
    #[must_use]
    pub(crate) fn on(&self, grid: Option<&Grid>) -> Self {
        let Some(grid) = grid else { return self.clone() };
        Self { function: VeilFunction::from(self.psf().on(grid)), ..self.clone() }
    }

    /// The share of the light that it scatters on a photo's frame with lengths in the look's unit, RGB, where the strength is 1.
    pub fn energies(&self, frame: &Frame) -> [f64; 3] {
        self.grid(frame).map_or_else(|| self.psf().energies(), |grid| self.psf().energies_on(&grid))
    }

    /// Whether the function's angles are degrees, so that it matters what the picture spans.
    pub fn is_in_degrees(&self) -> bool {
        self.psf().unit() == Unit::Degrees
    }

    /// How the picture was formed: as it was said, or rectilinear for a function in degrees and a plane for any other.
    pub fn projection(&self) -> Projection {
        let by_default = match self.psf().unit() {
            Unit::Degrees => Projection::Rectilinear,
            Unit::Look | Unit::Pixels | Unit::Micrometres => Projection::Planar,
        };
        self.projection.unwrap_or(by_default)
    }

    /// Where the pixels of a picture lie for this function, whose lengths are in the frame's unit; `view` says how the picture was
    /// seen, for one in degrees: along the middle of all of it, whatever is stored.
    ///
    /// # Errors
    /// A [`psf::Fault`]: where the function is in degrees and there is no view, where it is not and the picture is to be a
    /// sphere, and for pixels that are not square.
    pub fn geometry(&self, frame: &Frame, view: Option<&View>) -> Result<Geometry, psf::Fault> {
        let fault = |key, reason: String| Err(psf::Fault::new(key, reason));
        if frame.pixel_aspect != 1.0 {
            let aspect = frame.pixel_aspect;
            return fault(
                "psf",
                format!(
                    "a veil needs square pixels, and this picture's are {aspect} times as wide as high: resample it first"
                ),
            );
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
            Unit::Pixels | Unit::Micrometres if projection == Projection::Planar => {
                Ok(Geometry::Planar { pitch: 1.0, solid_angle: 1.0 })
            }
            Unit::Pixels | Unit::Micrometres => {
                fault("projection", format!("{name} is a picture in the photo's plane, not in degrees"))
            }
            Unit::Degrees => {
                let Some(&View { focal, .. }) = view else {
                    return fault(
                        "fov",
                        format!("{name} is in degrees, and nothing says how many of them the picture spans"),
                    );
                };
                if projection != Projection::Planar && self.border != Border::None {
                    return fault(
                        "border",
                        "nothing is known of the sphere beyond a picture: only a plane has a border".into(),
                    );
                }
                Ok(match projection {
                    Projection::Rectilinear => Geometry::Rectilinear { focal },
                    Projection::Fisheye => Geometry::Fisheye { focal },
                    Projection::Equirectangular if !frame.is_whole() => {
                        return fault("projection", "an equirectangular picture has all of its pixels stored".into());
                    }
                    Projection::Equirectangular => Geometry::Equirectangular,
                    // As it is in the middle.
                    Projection::Planar => Geometry::planar_degrees((1.0 / focal).to_degrees()),
                })
            }
        }
    }
}
