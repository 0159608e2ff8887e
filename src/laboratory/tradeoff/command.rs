//! `vglare tradeoff`: what accuracy costs, for one photo here.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use comfy_table::{CellAlignment, Table, presets};

use super::{Results, Subject, exponent, short};
use crate::Result;
use crate::gpu::Device;
use crate::laboratory::tradeoff;
use crate::look::Look;
use crate::options::BackendChoice;
use crate::options::CalibrationArgs;
use crate::options::FindArgs;
use crate::options::ReadArgs;
use crate::options::SceneArgs;
use crate::options::VeilArgs;
use crate::photo::{self, Photo};
use crate::terminal::progress::Progress;
use crate::terminal::stderr::warn;
use crate::terminal::stdout;

/// Show what accuracy costs for a photo on this machine
///
/// Varies the tolerance, the evaluator, the degree, the lattice, the number of ghosts and the picture's size, measures
/// the time and the error of each against the direct sum in 64-bit floats, and writes a folder: a page that recommends a
/// tolerance and shows why, plots, error maps, and all numbers as CSV and JSON.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// The photo: OpenEXR, Radiance HDR, PFM, TIFF, PNG or JPEG
    photo: PathBuf,

    /// The folder to write to; index.html in it is the page
    #[arg(short, long, value_name = "FOLDER")]
    output: PathBuf,

    /// Fewer settings, fewer rounds, smaller pictures: a minute or two instead of many without a graphics card
    #[arg(long)]
    quick: bool,

    /// Write into a folder even if it holds other files
    #[arg(long)]
    force: bool,

    /// Print nothing but errors
    #[arg(short, long)]
    quiet: bool,

    /// Where OpenGL comes from; auto takes the first that gives OpenGL 4.3
    #[arg(long, value_enum, default_value_t = BackendChoice::Auto)]
    backend: BackendChoice,

    #[command(flatten)]
    reading: ReadArgs,

    #[command(flatten)]
    scene: SceneArgs,

    #[command(flatten)]
    veil: VeilArgs,

    #[command(flatten)]
    find: FindArgs,

    #[command(flatten)]
    calibration: CalibrationArgs,
}

const EXAMPLES: &str = "\
Examples:
  vglare tradeoff night.exr -o trade --quick
  vglare tradeoff night.exr -o trade --preset vintage-uncoated
  vglare tradeoff night.exr -o trade --scene scene.toml
  vglare tradeoff night.exr -o trade --veil cie --fov 50

A folder that an earlier run has written is written anew.";

/// Measures, writes and prints the planner's choices.
///
/// # Errors
///
/// [`crate::Error::Occupied`] where the folder holds other files; [`crate::Error::Write`] where a file cannot be
/// written; [`crate::Error::Usage`] where nothing glares; and those of reading the photo and the scene.
pub fn run(args: &Args) -> Result<()> {
    let progress = Progress::start(args.quiet);
    let inputs: Vec<_> = std::iter::once(args.photo.clone()).chain(args.scene.files()).collect();
    tradeoff::spare(&args.output, &inputs)?;
    let mut look = args.veil.over(args.scene.look(&args.find)?, None, &args.scene.optics.aperture)?;
    args.scene.unit.check(&look)?;
    look.find = args.find.over(look.find);
    progress.say("reading the photo");
    let mut photo = photo::read_with(&args.photo, &args.reading.of_white(args.veil.white_luminance()))?;
    warn(&photo.source.notes);
    progress.say("finding what glares");
    let veiled = veiled(&look, &photo)?;
    photo.frame = look.frame(&photo)?;
    // Ghosts are studied, too, in whose place there is a veil.
    look.veil = None;
    let scene = look.gather(&photo, &photo.frame);
    let name = name(&args.photo);
    let subject = Subject::new(&name, &photo, &scene.ghosts, scene.images.clone(), &veiled)?;
    tradeoff::check(&args.output, args.force)?;
    let device = Device::open(args.backend.backends())?;
    let known = args.calibration.known(Some(device.info()));
    warn(&known.warning);
    let costs = known.file.is_some().then_some(known.model);
    let results = tradeoff::measure(&subject, &device, costs, args.quick, &mut |what, done| progress.part(what, done))?;
    progress.say("writing");
    let index = tradeoff::write(&args.output, &results)?;
    drop(progress);
    if args.quiet { Ok(()) } else { stdout::print(|out| summary(out, &results, &index)) }
}

/// The look, which says what the photo spans: the sweeps' pictures come from no file.
fn veiled(look: &Look, photo: &Photo) -> Result<Look> {
    let fov = match look.veil.as_ref().filter(|veil| veil.is_in_degrees()) {
        Some(veil) => {
            let view = look.view(photo, &format!("{} is in degrees", veil.psf().name()))?;
            Some(view.across(&photo.frame, veil.projection()))
        }
        None => look.fov,
    };
    Ok(Look { fov, ..look.clone() })
}

/// A file's name without its folder.
fn name(path: &Path) -> String {
    path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
}

fn summary(out: &mut dyn Write, results: &Results, index: &Path) -> io::Result<()> {
    if results.ghosts > 0 {
        of_ghosts(out, results)?;
    }
    of_veil(out, results)?;
    writeln!(out, "wrote {}", index.display())
}

/// The veil at each tolerance; nothing without one.
fn of_veil(out: &mut dyn Write, results: &Results) -> io::Result<()> {
    let mut table = Table::new();
    table.load_style(presets::NOTHING);
    table.set_header(["tolerance", "summed by", "predicted", "measured", "ms"]);
    let (mut refusals, points) = (Vec::new(), results.of_veil());
    if points.is_empty() {
        return Ok(());
    }
    for point in points {
        let asked = point.asked.map(exponent).unwrap_or_default();
        if let Some(reason) = &point.refused {
            refusals.push(format!("{asked}: {reason}"));
            continue;
        }
        let error = |value: Option<f64>| value.map_or("-".to_owned(), |value| format!("{value:.1e}"));
        let [predicted, measured] = [point.predicted, point.measured].map(error);
        let (by, ms) = (point.summed_by.clone().unwrap_or_default(), point.ms.map_or("-".to_owned(), short));
        table.add_row([asked, by, predicted, measured, ms]);
    }
    table.column_iter_mut().skip(2).for_each(|column| column.set_cell_alignment(CellAlignment::Right));
    let [width, height] = results.swept;
    writeln!(out, "The veil at {width} × {height}, by its own brightness at each pixel, summed on the processor")?;
    writeln!(out, "{}", table.trim_fmt())?;
    refusals.iter().try_for_each(|refusal| writeln!(out, "{refusal}"))
}

/// The planner's choices for the ghosts, and what to use.
fn of_ghosts(out: &mut dyn Write, results: &Results) -> io::Result<()> {
    let mut table = Table::new();
    table.load_style(presets::NOTHING);
    table.set_header(["tolerance", "evaluator", "degree", "predicted", "measured", "ΔE2000", "ms"]);
    let mut refusals = Vec::new();
    for point in results.choices() {
        let asked = point.asked.map(exponent).unwrap_or_default();
        if let Some(reason) = &point.refused {
            refusals.push(format!("{asked}: {reason}"));
            continue;
        }
        let error = |value: Option<f64>| value.map_or("-".to_owned(), |value| format!("{value:.1e}"));
        let number = |value: Option<f64>| value.map_or("-".to_owned(), short);
        let evaluator = point.evaluator.map(|evaluator| evaluator.to_string()).unwrap_or_default();
        let [predicted, measured] = [point.predicted, point.measured].map(error);
        let [delta_e, ms] = [point.delta_e_max, point.ms].map(number);
        table.add_row([asked, evaluator, point.degree(), predicted, measured, delta_e, ms]);
    }
    table.column_iter_mut().skip(2).for_each(|column| column.set_cell_alignment(CellAlignment::Right));
    let [width, height] = results.swept;
    writeln!(
        out,
        "The planner's choices at {width} × {height}, {} ghosts, {}",
        results.ghosts, results.device.renderer
    )?;
    writeln!(out, "{}", table.trim_fmt())?;
    refusals.iter().try_for_each(|refusal| writeln!(out, "{refusal}"))?;
    match &results.recommendation {
        Some(recommendation) => writeln!(out, "{}", recommendation.sentence()),
        None => Ok(()),
    }
}
