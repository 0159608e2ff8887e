//! `vglare psf`: a point-spread function, its transform and its mixture of Gaussians.

mod draw;
mod told;

use std::path::{Path, PathBuf};

use crate::chart::Kind;
use crate::choices::Projection;
use crate::frame::Frame;
use crate::options::numbers::{positive, range, sides};
use crate::options::psf::{told, wrong};
use crate::options::{ApertureArgs, PsfArgs};
use crate::photo::View;
use crate::psf::{Mixture, Name, Parameters, Profile, Psf, Unit};
use crate::scene::{VeilFunction, check_fov};
use crate::terminal::stdout;
use crate::{Error, Result, target};

/// Show a point-spread function: what a point's light becomes
///
/// Prints its energy, its value at the centre, how much of its light lies within some angles, and the Gaussians by which
/// `apply --veil` computes it, with their error; draws and writes all of that.
///
/// cie, cie135, spencer and stiles-holladay are the human eye's, in degrees and per steradian; starburst is in micrometres on the
/// sensor, as a mean over directions and colours; the others are in the look's unit, and per square of it. cie keeps its value at 0.1 degrees inside of that, and
/// stiles-holladay that at 1 degree; spencer is without the ring, whose place depends on the wavelength.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// The function
    #[arg(value_enum, value_name = "PSF")]
    name: Name,

    #[command(flatten)]
    psf: PsfArgs,

    #[command(flatten)]
    aperture: ApertureArgs,

    /// The angles or radii [default: 0.1 to 100 degrees, from 0.01 for cie135 and spencer; 0.001 to 2 of the look's unit; 1 to 20000 micrometres]
    #[arg(long, value_name = "FROM,TO", allow_hyphen_values = true, value_parser = range)]
    range: Option<[f64; 2]>,

    /// How close the Gaussians are to come, relatively, from 1e-6 to 0.5
    #[arg(long, value_name = "E", default_value_t = 1e-2, allow_hyphen_values = true, value_parser = positive)]
    tolerance: f64,

    /// Give the values of a function in the look's unit per steradian: the unit is half the shorter side of a picture whose width spans
    /// so many degrees, 0.1 to 179, as it is on the axis
    #[arg(long, value_name = "DEGREES", allow_hyphen_values = true, value_parser = positive)]
    fov: Option<f64>,

    /// The shape of that picture
    #[arg(long, value_name = "WxH", default_value = "3x2", value_parser = sides, requires = "fov")]
    frame: [u32; 2],

    /// Print JSON: all of it, and the rows of --csv
    #[arg(long)]
    json: bool,

    /// Draw profile, error of the Gaussians, encircled energy and transform: .svg or .png
    #[arg(long, value_name = "FILE")]
    plot: Option<PathBuf>,

    /// Write the same as numbers: .csv
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,

    /// Replace files that exist
    #[arg(long)]
    force: bool,
}

const EXAMPLES: &str = "\
Examples:
  vglare psf cie --age 60 --plot psf.svg --csv psf.csv
  vglare psf spencer --adaptation scotopic --tolerance 1e-3
  vglare psf abg --abg 1e-4,1e-3,2.5
  vglare psf camera --fov 50 --json
  vglare psf table --table measured.csv --plot psf.png
  vglare psf starburst --fstop 16 --blades 7";

/// A function, and all that is shown of it.
pub(super) struct Shown {
    pub psf: Psf,
    pub range: [f64; 2],
    /// None of a picture, which is not round.
    pub mixture: Option<Mixture>,
    pub profile: Profile,
    /// What its unit is on the axis of a picture, where it is in the look's and that is asked for: its values are per steradian then.
    pub axis: Option<Axis>,
}

/// The axis of a rectilinear picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Axis {
    /// Degrees across its width.
    pub fov: f64,
    /// The look's unit, half the shorter side, in focal lengths: radians on the axis.
    pub unit: f64,
}

impl Axis {
    /// # Errors
    /// [`Error::Usage`] for a function in another unit, and a field of view that is none.
    fn new(psf: &Psf, fov: f64, [width, height]: [u32; 2]) -> Result<Self> {
        let (name, usage) = (psf.name(), |reason: String| Error::Usage(format!("--fov: {reason}")));
        match psf.unit() {
            Unit::Look => {}
            Unit::Degrees => return Err(usage(format!("{name} is per steradian already"))),
            Unit::Pixels | Unit::Micrometres => return Err(usage(format!("{name} is not in the look's unit"))),
        }
        check_fov(fov, Some(Projection::Planar)).map_err(|fault| usage(fault.reason))?;
        let View { focal, .. } = View::of_field(fov, &Frame::full(width, height), Projection::Planar);
        Ok(Self { fov, unit: 0.5 * f64::from(width.min(height)) / focal })
    }
}

impl Shown {
    /// What values are multiplied by: as many squares of the unit as are a steradian on the axis.
    pub fn factor(&self) -> f64 {
        self.axis.map_or(1.0, |axis| axis.unit.powi(2).recip())
    }

    /// What stands after an angle or a radius, and what values are for.
    pub fn units(&self) -> (&'static str, &'static str) {
        let (angle, area) = units(self.psf.unit());
        (angle, if self.axis.is_some() { "steradian" } else { area })
    }
}

/// Rows of the profile.
const ROWS: usize = 400;

/// Shows a function.
///
/// # Errors
/// [`crate::Error::Usage`] where there is no such function; whatever keeps a file from being written.
pub fn run(args: &Args) -> Result<()> {
    let drawn = args.plot.as_deref().map(|path| Kind::of(path).map(|kind| (path, kind))).transpose()?;
    let outputs: Vec<(&str, &Path)> = [("--plot", &args.plot), ("--csv", &args.csv)]
        .into_iter()
        .filter_map(|(name, path)| Some((name, path.as_deref()?)))
        .collect();
    target::spare(&outputs, &[])?;
    outputs.iter().try_for_each(|(_, path)| target::check(path, args.force))?;
    if args.psf.white_luminance().is_some() {
        return Err(Error::Usage("--luminance: cd/m² are of a photo, and a function alone is of none".into()));
    }
    let parameters = args.psf.over(Parameters::new(args.name), &args.aperture);
    let psf = told(VeilFunction::new(&parameters))?.psf().clone();
    let range = args.range.unwrap_or_else(|| usual(&psf));
    let mixture =
        if psf.is_round() { Some(psf.mixture(range, args.tolerance).map_err(|fault| wrong(&fault))?) } else { None };
    let profile = psf.profile(range, mixture.as_ref(), ROWS).map_err(|fault| wrong(&fault))?;
    let axis = args.fov.map(|fov| Axis::new(&psf, fov, args.frame)).transpose()?;
    let shown = Shown { psf, range, mixture, profile, axis };
    if let Some((path, kind)) = drawn {
        draw::write(path, kind, &shown, args.force)?;
    }
    if let Some(path) = &args.csv {
        target::write_text(path, &told::csv(&shown), args.force)?;
    }
    if args.json {
        return stdout::json(|out| told::json(out, &shown));
    }
    stdout::print(|out| out.write_all(told::summary(&shown).as_bytes()))
}

/// What is shown where nobody says.
fn usual(psf: &Psf) -> [f64; 2] {
    match (psf.unit(), psf.name()) {
        (Unit::Degrees, Name::Cie135 | Name::Spencer) => [0.01, psf.end()],
        (Unit::Degrees, _) => [psf.flat_within().max(0.1), psf.end()],
        (Unit::Look, _) => [1e-3, 2.0],
        (Unit::Pixels, _) => [1.0, 1000.0],
        (Unit::Micrometres, _) => [1.0, 2e4],
    }
}

/// What stands after an angle, and the unit of areas.
fn units(unit: Unit) -> (&'static str, &'static str) {
    match unit {
        Unit::Degrees => ("°", "steradian"),
        Unit::Look => (" half heights", "square of a half height"),
        Unit::Pixels => (" pixels", "pixel"),
        Unit::Micrometres => (" µm", "square µm"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Half the height of a picture of 3 × 2 is tan(25°) / 1.5 of its focal length where its width spans 50°.
    #[test]
    fn the_unit_is_half_the_shorter_side_in_focal_lengths() {
        let camera = || Parameters::new(Name::Camera).function(|_| unreachable!(), |_| unreachable!()).unwrap();
        let unit = |frame| Axis::new(&camera(), 50.0, frame).unwrap().unit;
        let half = 25.0f64.to_radians().tan();
        assert!((unit([3, 2]) / (half / 1.5) - 1.0).abs() < 1e-12 && (unit([2, 3]) / half - 1.0).abs() < 1e-12);
        assert!(Axis::new(&camera(), 200.0, [3, 2]).is_err());
        let cie = Parameters::new(Name::Cie).function(|_| unreachable!(), |_| unreachable!()).unwrap();
        assert!(Axis::new(&cie, 50.0, [3, 2]).is_err_and(|error| error.to_string().contains("per steradian already")));
    }
}
