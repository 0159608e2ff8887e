//! What every pixel of the photo scatters.

use std::path::PathBuf;

use clap::ValueEnum;
use clap::builder::PossibleValue;

use crate::choices::{Border, Projection};
use crate::look::{Look, LookLens, Veil};
use crate::options::psf::told;
use crate::options::{ApertureArgs, PsfArgs};
use crate::photo::WhiteLuminance;
use crate::psf::{Name, Parameters};
use crate::scene::VeilSection;
use crate::{Error, Result};

/// The veil: every pixel a source, by a point-spread function.
#[derive(Debug, Clone, Default, clap::Args)]
#[command(next_help_heading = "Veil")]
pub struct VeilArgs {
    /// What every pixel scatters over all others, by a point-spread function; `vglare psf` shows each [default: none]
    #[arg(long, value_enum, value_name = "PSF")]
    veil: Option<VeilName>,

    #[command(flatten)]
    psf: PsfArgs,

    /// How the camera formed the picture [default: rectilinear for functions in degrees, planar for others]
    #[arg(long, value_enum)]
    projection: Option<Projection>,

    /// What lies beyond the picture's edges, for the veil [default: none]
    #[arg(long, value_enum)]
    border: Option<Border>,
}

/// `--veil`.
#[derive(Debug, Clone, Copy, PartialEq)]
enum VeilName {
    None,
    Psf(Name),
}

impl ValueEnum for VeilName {
    fn value_variants<'a>() -> &'a [Self] {
        const ALL: [VeilName; 1 + Name::ALL.len()] = {
            let mut all = [VeilName::None; 1 + Name::ALL.len()];
            let mut index = 0;
            while index < Name::ALL.len() {
                all[index + 1] = VeilName::Psf(Name::ALL[index]);
                index += 1;
            }
            all
        };
        &ALL
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        match self {
            Self::None => Some(PossibleValue::new("none").help("Nothing")),
            Self::Psf(name) => name.to_possible_value(),
        }
    }
}

impl VeilArgs {
    /// What is given wins over what was set before; so does a tolerance, which is an option of all glare, and an opening, which a starburst
    /// shares with the lens.
    ///
    /// # Errors
    /// [`Error::Usage`], which names the option.
    pub fn over(&self, look: Look, tolerance: Option<f64>, aperture: &ApertureArgs) -> Result<Look> {
        let look = self.veiled(look, tolerance, aperture)?;
        let is_starburst = look.veil.as_ref().is_some_and(|veil| veil.section().parameters.psf == Name::Starburst);
        if *aperture != ApertureArgs::default() && !is_starburst && !matches!(look.lens, LookLens::Optical(_)) {
            return Err(Error::Usage(
                "--fstop, --blades and --sensor are of a lens that is known by its surfaces, or of a starburst: name one by --lens (vglare lens \
                 lists them), or give --veil starburst"
                    .into(),
            ));
        }
        Ok(look)
    }

    /// Whether a look can be of a panorama, where it is; `lens` is the option by which a lens was named, if any.
    ///
    /// # Errors
    /// [`Error::Usage`] for ghosts, which a picture of all directions has none of.
    pub fn check_panorama(look: &Look, lens: Option<&str>) -> Result<()> {
        let none = "an equirectangular picture of all directions has no lens's axis, and so no ghosts: its lights make a veil alone";
        match lens {
            _ if !look.is_panorama() => Ok(()),
            Some(option) if !look.lens.ghosts().is_empty() => {
                Err(Error::Usage(format!("{option}: {none}; leave {} out, or give --lens none", look.lens().name)))
            }
            _ if !look.ghosts.is_empty() => Err(Error::Usage(format!("--scene has ghosts, and {none}"))),
            _ => Ok(()),
        }
    }

    fn veiled(&self, look: Look, tolerance: Option<f64>, aperture: &ApertureArgs) -> Result<Look> {
        let before = look.veil.as_ref().map(Veil::section);
        let adds = look.veil.as_ref().is_some_and(|veil| veil.adds);
        let section = match (self.veil, before) {
            (Some(VeilName::None), _) if self.says_nothing() => return Ok(Look { veil: None, ..look }),
            (Some(VeilName::None), _) => None,
            (Some(VeilName::Psf(name)), Some(before)) if before.parameters.psf == name => Some(before),
            (Some(VeilName::Psf(name)), before) => {
                let none = VeilSection {
                    parameters: Parameters::new(name),
                    fov: None,
                    projection: None,
                    border: None,
                    tolerance: None,
                };
                Some(before.map_or(none, |before| VeilSection { parameters: Parameters::new(name), ..before }))
            }
            (None, before) => before,
        };
        let Some(VeilSection { parameters, fov: _, projection, border, tolerance: before }) = section else {
            if self.says_nothing() {
                return Ok(look);
            }
            return Err(Error::Usage(
                "there is no veil, and options say how it is to be: name its function by --veil, as cie".into(),
            ));
        };
        let section = VeilSection {
            parameters: self.psf.over(parameters, aperture),
            fov: None,
            projection: self.projection.or(projection),
            border: self.border.or(border),
            tolerance: tolerance.or(before),
        };
        Ok(Look { veil: Some(told(Veil::new(&section, adds))?), ..look })
    }

    /// What the photo's white is in cd/m², where that is given.
    pub fn white_luminance(&self) -> Option<WhiteLuminance> {
        self.psf.white_luminance()
    }

    /// The files that its function is read from.
    pub fn files(&self) -> impl Iterator<Item = &PathBuf> {
        self.psf.files()
    }

    fn says_nothing(&self) -> bool {
        let Self { veil: _, psf, projection, border } = self;
        psf.is_empty() && projection.is_none() && border.is_none()
    }
}
