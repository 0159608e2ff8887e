//! `vglare calibrate`: what each kind of work costs on this machine.

mod arms;
mod fit;

use std::io::{self, Write};

use comfy_table::{CellAlignment, Table, presets};

use crate::Result;
use crate::calibration;
use crate::gpu::Device;
use crate::measure::Rounds;
use crate::options::BackendChoice;
use crate::plan::CostModel;
use crate::terminal::progress::Progress;
use crate::terminal::{stderr, stdout};

use fit::Fitted;

/// Measure what each kind of work costs on this machine, and keep it
///
/// The plan chooses how to compute the glare by twenty constants, and --budget counts in them. This measures them: small
/// pictures in turns, in pairs that differ in one kind of work, medians of several rounds. They are kept in the user's
/// cache folder (VGLARE_CACHE names another) for this renderer, driver and version of vglare, and the other commands
/// take them from there unless --no-calibration is given. Measure while the machine does nothing else.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// Where OpenGL comes from; auto takes the first that gives OpenGL 4.3
    #[arg(long, value_enum, default_value_t = BackendChoice::Auto)]
    backend: BackendChoice,

    /// Print what was measured, and keep nothing
    #[arg(long)]
    dry_run: bool,

    /// Measure nothing, and forget what was kept for any renderer
    #[arg(long, conflicts_with_all = ["dry_run", "rounds"])]
    forget: bool,

    /// How often each thing is measured; made even
    #[arg(long, value_name = "N", default_value_t = 8, value_parser = clap::value_parser!(u16).range(1..=1000))]
    rounds: u16,
}

const EXAMPLES: &str = "\
Examples:
  vglare calibrate             Measure, print and keep
  vglare calibrate --dry-run   What would be kept?
  vglare calibrate --forget    Back to the built-in constants";

/// What the constants stand for, in the order of [`CostModel::NAMES`].
const MEANINGS: [&str; CostModel::COUNT] = [
    "a bell at a pixel, by direct",
    "a term at a pixel, by series",
    "a harmonic of x at a pixel, by rows",
    "a term of a row's profiles, by rows",
    "a cell of the lattice along a row, by grid",
    "an interpolation at a pixel, by grid",
    "a term of a ghost, in the spectrum",
    "a moment of a ghost, in a gathered spectrum",
    "a bell at a pixel that it reaches, by local",
    "a ghost that is drawn where it reaches, by local",
    "a pixel that ghosts are drawn on, by local",
    "a term at a pixel, by series in doubles",
    "a harmonic of x at a pixel, by rows in doubles",
    "a term of a row's profiles, by rows in doubles",
    "a node of the lattice along a row, by grid in doubles",
    "an interpolation at a pixel, by grid in doubles",
    "a multiply-add of a veil at a pixel, by the CPU",
    "a tap of a veil at a texel, by the device",
    "a pixel that a veil is moved by, there and back",
    "starting a pass",
];

/// Measures, prints and keeps; or forgets.
///
/// # Errors
/// [`crate::Error::NoContext`] without OpenGL 4.3, [`crate::Error::Gl`] where the driver refuses or nothing can be told
/// from noise, [`crate::Error::Write`] where the cache folder cannot be written.
pub fn run(args: &Args) -> Result<()> {
    if args.forget {
        let path = calibration::path()?;
        let done = if calibration::forget()? { "forgot what was in" } else { "there was nothing in" };
        return stdout::print(|out| writeln!(out, "{done} {}", path.display()));
    }
    if !args.dry_run {
        calibration::ready()?;
    }
    let progress = Progress::start(false);
    progress.say("measuring");
    let device = Device::open(args.backend.backends())?;
    let fitted = fit::measure(&device, Rounds::new(0, args.rounds.into()))?;
    drop(progress);
    let kept = if args.dry_run {
        None
    } else {
        if let Some(warning) = calibration::keep(device.info(), fitted.model())? {
            stderr::warn([warning]);
        }
        Some(calibration::path()?)
    };
    stdout::print(|out| {
        writeln!(out, "{}", device.info().renderer)?;
        print(out, &fitted)?;
        match &kept {
            Some(path) => writeln!(out, "Kept in {}", path.display()),
            None => writeln!(out, "Kept nowhere: a dry run."),
        }
    })
}

fn print(out: &mut dyn Write, fitted: &Fitted) -> io::Result<()> {
    let mut table = Table::new();
    table.load_style(presets::NOTHING);
    table.set_header(["constant", "nanoseconds for", "built-in", "measured", "spread %"]);
    let built_in = CostModel::default().values();
    let rows = CostModel::NAMES.iter().zip(MEANINGS).zip(built_in).zip(&fitted.constants);
    for (((name, meaning), built_in), constant) in rows {
        let spread = constant.spread.map_or_else(|| "scaled".to_owned(), |spread| format!("{:.0}", 100.0 * spread));
        table.add_row([name.to_string(), meaning.to_owned(), digits(built_in), digits(constant.value), spread]);
    }
    table.column_iter_mut().skip(2).for_each(|column| column.set_cell_alignment(CellAlignment::Right));
    writeln!(out, "{}", table.trim_fmt())?;
    if fitted.constants.iter().any(|constant| constant.spread.is_none()) {
        writeln!(out, "Scaled: too little to be told from noise here; the built-in ratio to the others stands in.")?;
    }
    Ok(())
}

/// Three digits or so.
fn digits(value: f64) -> String {
    match value.abs() {
        100.0.. => format!("{value:.0}"),
        1.0.. => format!("{value:.1}"),
        _ => format!("{value:.3}"),
    }
}
