//! `vglare lens`: a real lens by its surfaces, and the ghosts that it makes of a light.
//!
//! | module | what it does |
//! | --- | --- |
//! | `list` | the lenses that come with vglare, a line each |
//! | `report`, `text` | a lens → what JSON tells of it, and text |
//! | `exact` | ghosts by exact rays, beside the matrices |
//! | `section`, `bundle` | the section along the axis, with bundles of exact rays |
//! | `coatings` | the reflectance of coatings over wavelength |
//! | `lamp` | the ghosts of a lamp on the sensor |

mod bundle;
mod coatings;
mod exact;
mod lamp;
mod list;
mod report;
mod section;
mod text;

use std::path::{Path, PathBuf};

use crate::chart::{Chart, Kind, Sheet};
use crate::laboratory::page::png_bytes;
use crate::optics::{GhostPath, LensGhosts, System};
use crate::options::OpticsArgs;
use crate::scene::{NamedLens, Optical, OpticsSection};
use crate::terminal::stdout;
use crate::{Error, Result, target};

use exact::Rays;
use report::Report;
use section::Section;

/// Show a real lens: its surfaces, what follows from them, and its ghosts
///
/// Without a name, lists the lenses that come with vglare. With one, prints focal length, f-number, field, pupils, all surfaces, and the
/// ghosts by pairs of surfaces that reflect, the brightest on the sensor first: m_g is where a ghost is as a multiple of where the
/// light's own image is; its share is of that image's light; its focus is from the sensor, positive behind it.
/// Draws the section with rays, the coatings' reflectance, and the ghosts of a lamp.
///
/// A file is vglare's TOML, a table of pbrt, or a sequential one of Zemax (.zmx): docs/lenses.md.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// A lens that comes with vglare, or a file of surfaces
    #[arg(value_name = "NAME|FILE")]
    name: Option<PathBuf>,

    #[command(flatten)]
    optics: OpticsArgs,

    /// Ghosts to show at most, 0 for all [default: 20, and all with --json]
    #[arg(long, value_name = "COUNT", requires = "name")]
    ghosts: Option<usize>,

    /// Trace exact rays, so many for each ghost that is shown, and tell what they make of it beside the matrices
    #[arg(long, value_name = "RAYS", num_args = 0..=1, default_missing_value = "4096", requires = "name")]
    exact: Option<usize>,

    /// The angle of a light off the axis, in degrees, for --exact and --ghost
    #[arg(long, value_name = "DEGREES", requires = "name")]
    angle: Option<f64>,

    /// Draw the section along the axis, to scale, with rays: .svg or .png
    #[arg(long, value_name = "FILE", requires = "name")]
    section: Option<PathBuf>,

    /// The ghost whose path --section shows, by the surfaces that reflect it
    #[arg(long, value_name = "B,A", value_parser = pair, requires = "section")]
    ghost: Option<[usize; 2]>,

    /// Draw what each coating reflects on each glass, over wavelength: .svg or .png
    #[arg(long, value_name = "FILE", requires = "name")]
    coatings: Option<PathBuf>,

    /// Draw the ghosts of one lamp on the sensor, at several angles: .svg or .png
    #[arg(long, value_name = "FILE", requires = "name")]
    lamp: Option<PathBuf>,

    /// Print JSON
    #[arg(long)]
    json: bool,

    /// Replace files that exist
    #[arg(long)]
    force: bool,
}

const EXAMPLES: &str = "\
Examples:
  vglare lens                                             Which real lenses are there?
  vglare lens double-gauss --fstop 4
  vglare lens planar --section planar.svg --ghost 8,3     The way of a ghost
  vglare lens zoom --setting '200 mm' --lamp lamp.png --coatings coatings.svg
  vglare lens mine.zmx --exact --angle 10                 How far are the matrices off?";

/// Ghosts that text shows where nobody says how many.
const SHOWN: usize = 20;

fn pair(text: &str) -> std::result::Result<[usize; 2], String> {
    let numbers: Vec<usize> = text.split(',').filter_map(|number| number.trim().parse().ok()).collect();
    match (&numbers[..], text.split(',').count()) {
        // The light comes to the one behind first, in whichever order they are named.
        (&[one, other], 2) => Ok([one.max(other), one.min(other)]),
        _ => Err("expected the numbers of two surfaces, as 8,3".to_owned()),
    }
}

/// Shows a lens, or lists all.
///
/// # Errors
/// [`Error::Usage`] and [`Error::UnknownLens`] for what is no lens of surfaces, [`Error::Optics`] for files and settings that cannot
/// be, [`Error::Exists`] and [`Error::Write`] for drawings that cannot be written.
pub fn run(args: &Args) -> Result<()> {
    let Some(name) = &args.name else { return list(args) };
    let report = show(args, name)?;
    if args.json {
        return stdout::json(|out| {
            serde_json::to_writer_pretty(&mut *out, &report)?;
            writeln!(out)
        });
    }
    stdout::print(|out| out.write_all(text::text(&report).as_bytes()))
}

/// Draws what is to be drawn, and returns what is to be told.
fn show(args: &Args, name: &Path) -> Result<Report> {
    if args.angle.is_some() && args.exact.is_none() && args.ghost.is_none() {
        return Err(Error::Usage("--angle is that of a light for --exact or for --ghost".into()));
    }
    let outputs = outputs(args)?;
    let lens = optical(&args.optics, name)?;
    let system = System::new(lens.prescription(), &lens.section().setup())?;
    let ghosts = lens.ghosts();
    let ghost = args.ghost.map(|pair| chosen(ghosts, pair, system.name())).transpose()?;
    let most = match args.ghosts {
        Some(0) => usize::MAX,
        Some(most) => most,
        None if args.json => usize::MAX,
        None => SHOWN,
    };
    let mut report = Report::new(&lens, &system, most);
    if let Some(count) = args.exact {
        let traced = exact::exact(&system, ghosts, most, Rays { count, angle: args.angle })?;
        for (row, exact) in report.ghosts.iter_mut().zip(traced) {
            row.exact = Some(exact);
        }
    }
    let section = Section { lens: lens.prescription(), system: &system, ghost: ghost.zip(args.angle.or(Some(0.0))) };
    let bytes = |drawing, path, kind| match drawing {
        Drawing::Section => of_sheet(&section.sheet()?, path, kind),
        Drawing::Coatings => of_chart(&coatings::chart(lens.prescription()), path, kind),
        Drawing::Lamp => of_sheet(&lamp::sheet(&system, ghosts), path, kind),
    };
    // All is drawn before anything is written.
    let files = outputs.into_iter().map(|(drawing, path, kind)| Ok((path, bytes(drawing, path, kind)?)));
    let files = files.collect::<Result<Vec<_>>>()?;
    files.iter().try_for_each(|(path, bytes)| target::write(path, bytes, args.force))?;
    Ok(report)
}

fn list(args: &Args) -> Result<()> {
    if args.optics.section() != OpticsSection::default() {
        return Err(Error::Usage("name the lens that is to be set; vglare lens lists them".into()));
    }
    let entries = list::entries()?;
    if args.json {
        stdout::json(|out| list::json(out, &entries))
    } else {
        stdout::print(|out| list::text(out, &entries))
    }
}

/// What can be drawn.
#[derive(Debug, Clone, Copy)]
enum Drawing {
    Section,
    Coatings,
    Lamp,
}

/// What is to be drawn, where and as what; files that cannot be written are told before the work.
fn outputs(args: &Args) -> Result<Vec<(Drawing, &Path, Kind)>> {
    let named = [
        ("--section", Drawing::Section, &args.section),
        ("--coatings", Drawing::Coatings, &args.coatings),
        ("--lamp", Drawing::Lamp, &args.lamp),
    ];
    let given = || named.iter().filter_map(|(option, drawing, path)| Some((*option, *drawing, path.as_deref()?)));
    let kinds = given().map(|(_, drawing, path)| Ok((drawing, path, Kind::of(path)?)));
    let kinds = kinds.collect::<Result<Vec<_>>>()?;
    let paths: Vec<(&str, &Path)> = given().map(|(option, _, path)| (option, path)).collect();
    let lens = args.name.as_deref().filter(|name| name.is_file());
    let inputs: Vec<(&str, &Path)> = lens.map(|lens| ("the lens", lens)).into_iter().collect();
    target::spare(&paths, &inputs)?;
    paths.iter().try_for_each(|(_, path)| target::check(path, args.force))?;
    Ok(kinds)
}

fn optical(args: &OpticsArgs, name: &Path) -> Result<Optical> {
    match args.lens(name)? {
        NamedLens::Optical(lens) => Ok(lens),
        NamedLens::Preset(_) | NamedLens::Table(..) => Err(Error::Usage(format!(
            "{} is a table of ghosts, and has no surfaces; vglare lens lists the lenses that have",
            name.display()
        ))),
    }
}

/// The ghost of a pair of surfaces.
fn chosen<'a>(ghosts: &'a LensGhosts, pair: [usize; 2], name: &str) -> Result<&'a GhostPath> {
    ghosts.ghosts.iter().find(|ghost| ghost.reflections == pair).ok_or_else(|| {
        let mut mirrors: Vec<_> = ghosts.ghosts.iter().flat_map(|ghost| ghost.reflections.iter().copied()).collect();
        mirrors.sort_unstable();
        mirrors.dedup();
        let mirrors = mirrors.iter().map(usize::to_string).collect::<Vec<_>>().join(", ");
        let [b, a] = pair;
        Error::Usage(format!("{name} has no ghost {b},{a}; the surfaces that reflect are {mirrors}"))
    })
}

fn of_sheet(sheet: &Sheet, path: &Path, kind: Kind) -> Result<Vec<u8>> {
    match kind {
        Kind::Svg => sheet.svg().map(String::into_bytes),
        Kind::Png => png_bytes(path, &sheet.picture()?),
    }
}

fn of_chart(chart: &Chart, path: &Path, kind: Kind) -> Result<Vec<u8>> {
    match kind {
        // It has no picture in it, without which every chart is shapes.
        Kind::Svg => Ok(chart.svg()?.unwrap_or_default().into_bytes()),
        Kind::Png => png_bytes(path, &chart.picture()?),
    }
}

#[cfg(test)]
mod tests;
