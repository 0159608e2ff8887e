//! `vglare psf`: a point-spread function, its transform and its mixture of Gaussians.

mod draw;

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use crate::chart::Kind;
use crate::options::numbers::positive;
use crate::options::psf::{told, wrong};
use crate::options::{ApertureArgs, PsfArgs};
use crate::psf::{Mixture, Name, Parameters, Profile, Psf, Row, Unit};
use crate::scene::VeilFunction;
use crate::terminal::stdout;
use crate::{Result, target};

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
    range: Option<Range>,

    /// How close the Gaussians are to come, relatively, from 1e-6 to 0.5
    #[arg(long, value_name = "E", default_value_t = 1e-2, allow_hyphen_values = true, value_parser = positive)]
    tolerance: f64,

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
  vglare psf spencer --luminance scotopic --tolerance 1e-3
  vglare psf abg --abg 1e-4,1e-3,2.5
  vglare psf table --table measured.csv --plot psf.png
  vglare psf starburst --fstop 16 --blades 7";

/// `--range`.
#[derive(Debug, Clone, Copy)]
struct Range([f64; 2]);

fn range(text: &str) -> std::result::Result<Range, String> {
    let ends: Vec<f64> = text.split(',').filter_map(|end| positive(end.trim()).ok()).collect();
    match (ends[..].first_chunk(), text.split(',').count()) {
        (Some(&[from, to]), 2) if ends.len() == 2 && from < to => Ok(Range([from, to])),
        _ => Err("expected two numbers above 0, the smaller one first, like 0.1,30".to_owned()),
    }
}

/// A function, and all that is shown of it.
pub(super) struct Shown {
    pub psf: Psf,
    pub range: [f64; 2],
    /// None of a picture, which is not round.
    pub mixture: Option<Mixture>,
    pub profile: Profile,
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
    let parameters = args.psf.over(Parameters::new(args.name), &args.aperture);
    let psf = told(VeilFunction::new(&parameters))?.psf().clone();
    let range = args.range.map_or_else(|| usual(&psf), |Range(range)| range);
    let mixture =
        if psf.is_round() { Some(psf.mixture(range, args.tolerance).map_err(|fault| wrong(&fault))?) } else { None };
    let profile = psf.profile(range, mixture.as_ref(), ROWS).map_err(|fault| wrong(&fault))?;
    let shown = Shown { psf, range, mixture, profile };
    if let Some((path, kind)) = drawn {
        draw::write(path, kind, &shown, args.force)?;
    }
    if let Some(path) = &args.csv {
        target::write_text(path, &csv(&shown), args.force)?;
    }
    stdout::print(|out| out.write_all(summary(&shown).as_bytes()))
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

fn summary(Shown { psf, range: [from, to], mixture, profile }: &Shown) -> String {
    let (angle, area) = units(psf.unit());
    let mut text = format!("psf      {}, from {from} to {to}{angle}\n", psf.name());
    // Writing to a string cannot fail.
    let _ = writeln!(text, "energy   {:.4} of the light; {:.4e} per {area} at the centre", psf.energy(), psf.centre());
    let places = [0.01, 0.1, 1.0, 10.0].into_iter().filter(|place| (*from..=*to).contains(place));
    let within: Vec<String> = places
        .map(|place| format!("{:.1} % within {place}{angle}", 100.0 * psf.energy_within(place) / psf.energy()))
        .collect();
    if !within.is_empty() {
        let _ = writeln!(text, "         {}", within.join(", "));
    }
    match mixture {
        Some(mixture) => {
            let _ = writeln!(
                text,
                "mixture  {} Gaussians, within {:.2e} of it from {} to {}{angle}",
                mixture.terms.len(),
                mixture.error,
                mixture.range[0],
                mixture.range[1]
            );
            for term in &mixture.terms {
                let _ = writeln!(text, "         sigma {:<12.6} value at its centre {:.6e}", term.sigma, term.weight);
            }
            if mixture.constant != 0.0 || mixture.quadratic != 0.0 {
                let _ = writeln!(
                    text,
                    "         and {:.6e} + {:.6e} × angle², exactly",
                    mixture.constant, mixture.quadratic
                );
            }
        }
        None => {
            let _ = writeln!(text, "mixture  none: a picture is not round");
        }
    }
    let _ = writeln!(text, "rows     {} angles, {} frequencies", profile.rows.len(), profile.modes.len());
    text
}

/// What stands after an angle, and the unit of areas.
pub(super) fn units(unit: Unit) -> (&'static str, &'static str) {
    match unit {
        Unit::Degrees => ("°", "steradian"),
        Unit::Look => (" half heights", "square of a half height"),
        Unit::Pixels => (" pixels", "pixel"),
        Unit::Micrometres => (" µm", "square µm"),
    }
}

/// All rows; the frequencies stand beside the angles, line by line, and have no more to do with them than that.
fn csv(Shown { profile: Profile { rows, modes }, .. }: &Shown) -> String {
    let mut text = "angle,value,mixture,relative error,encircled energy,frequency,transform\n".to_owned();
    for (Row { angle, value, mixture, error, encircled }, mode) in rows.iter().zip(modes) {
        let number = |value: f64| if value.is_nan() { String::new() } else { format!("{value:e}") };
        let line = [*angle, *value, *mixture, *error, *encircled, mode.frequency, mode.transform].map(number);
        let _ = writeln!(text, "{}", line.join(","));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_range_is_two_numbers_in_their_order() {
        assert_eq!(range("0.1, 30").unwrap().0, [0.1, 30.0]);
        for bad in ["", "1", "2,1", "1,1", "0,1", "-1,1", "1,nan", "1,2,3"] {
            assert!(range(bad).is_err(), "{bad}");
        }
    }
}
