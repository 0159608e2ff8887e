//! `vglare bench`: what each pass costs here, as ratios that were measured in one run.

mod cases;
mod choices;
mod digits;
mod exchange;
mod first;
mod gaussians;
mod lens;
mod local;
mod many;
mod random;
mod report;
pub(in crate::laboratory) mod scenes;
mod stage;
mod veil;
mod whole;

use std::path::PathBuf;
use std::rc::Rc;
use std::time::Instant;

use crate::gpu::Device;
use crate::measure::Rounds;
use crate::options::BackendChoice;
use crate::options::CalibrationArgs;
use crate::terminal::{stderr, stdout};
use crate::{Error, Result, target};

pub use report::{Report, Table, Target};
use stage::Stage;

/// Measure what glare costs on this machine
///
/// Times move with whatever else the machine does; ratios hardly do. So what is compared runs in turns, and the medians
/// of several rounds are shown, with the ratio to a yardstick and the least and the most. A copy of the picture on the
/// device is the yardstick of a frame. A few ratios have a bar that vglare means to hold; each is printed with its
/// target.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// Where OpenGL comes from; auto takes the first that gives OpenGL 4.3
    #[arg(long, value_enum, default_value_t = BackendChoice::Auto)]
    backend: BackendChoice,

    /// The picture's size in pixels: 1920x1080, or for --scenes from 64 to 1280 wide, by chance
    #[arg(long, value_name = "WxH", value_parser = size)]
    size: Option<[u32; 2]>,

    /// How often each thing is measured; made even. By default 10
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=10_000))]
    rounds: Option<u16>,

    /// A quick look: 4 rounds unless --rounds says otherwise, and no series at all pixels
    #[arg(long)]
    quick: bool,

    /// Measure nothing but a field of this many Gaussians of one size, for comparison with other programs
    #[arg(long, value_name = "K", value_parser = clap::value_parser!(u32).range(1..=10_000_000))]
    gaussians: Option<u32>,

    /// Their size, in widths of the picture
    #[arg(long, value_name = "WIDTHS", default_value_t = 0.05, value_parser = part, requires = "gaussians")]
    sigma: f64,

    /// The tolerance that they are planned for
    #[arg(long, value_name = "E", default_value_t = 1e-3, value_parser = part, requires = "gaussians")]
    tolerance: f64,

    /// Measure nothing but what the plan chooses in this many random scenes, against every other choice
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=100_000), conflicts_with = "gaussians")]
    scenes: Option<u32>,

    /// The first of these scenes: each has a number, by which it can be looked at again
    #[arg(long, value_name = "NUMBER", default_value_t = 0, requires = "scenes")]
    first: u32,

    /// Measure nothing but small bells, each where it reaches, against a copy
    #[arg(long, conflicts_with_all = ["gaussians", "scenes"])]
    local: bool,

    /// Measure nothing but what the last digits cost: a tolerance of 1e-7, which asks for 64-bit floats, against 1e-5
    #[arg(long, conflicts_with_all = ["gaussians", "scenes", "local"])]
    digits: bool,

    /// Measure nothing but veils, every pixel a source, against a copy
    #[arg(long, conflicts_with_all = ["gaussians", "scenes", "local", "digits"])]
    veil: bool,

    /// Measure nothing but ghosts of all pixels: their spectrum, and their field against a copy
    #[arg(long, conflicts_with_all = ["gaussians", "scenes", "local", "digits", "veil"])]
    whole: bool,

    /// Measure nothing but ghosts of a real lens, and of many lights through many Gaussians
    #[arg(long, conflicts_with_all = ["gaussians", "scenes", "local", "digits", "veil", "whole"])]
    lens: bool,

    /// Measure nothing but frames of the window, without a window: a slider and a light that are dragged
    #[arg(long, conflicts_with_all = ["gaussians", "scenes", "local", "digits", "veil", "whole", "lens", "rounds", "quick"])]
    viewer: bool,

    /// Write the rows of all tables to this file too
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,

    /// Write all that is printed, and the bars, to this file too
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,

    /// Overwrite the files of --csv and --json
    #[arg(long)]
    force: bool,

    /// Fail where a bar is missed
    #[arg(long)]
    strict: bool,

    #[command(flatten)]
    calibration: CalibrationArgs,
}

/// The picture's size where none is given.
const USUAL: [u32; 2] = [1920, 1080];

const EXAMPLES: &str = "\
Examples:
  vglare bench                              What does a 1080p frame cost here?
  vglare bench --quick --backend osmesa     A quick look at Mesa's software renderer
  vglare bench --size 3840x2160 --csv 4k.csv
  vglare bench --gaussians 1000 --json 1000.json
  vglare bench --scenes 200 --size 480x270  How good are the plan's choices and its predictions?
  vglare bench --digits --strict            What do the digits beyond 32-bit floats cost?
  vglare bench --veil                       What does a veil cost?
  vglare bench --whole                      What do the ghosts of all pixels cost?
  vglare bench --lens                       And those of a real lens?
  vglare bench --viewer --strict            Are drags in the window fluent here?";

fn part(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(part @ 1e-7..=1.0) => Ok(part),
        _ => Err("expected a number from 1e-7 to 1".to_owned()),
    }
}

fn size(text: &str) -> Result<[u32; 2], String> {
    let sides = text.split_once(['x', 'X']).map(|(width, height)| [width.parse(), height.parse()]);
    match sides {
        Some([Ok(width @ 16..=16384), Ok(height @ 16..=16384)]) => Ok([width, height]),
        _ => Err("expected WxH, each 16 to 16384 pixels, like 1920x1080".to_owned()),
    }
}

/// Measures frames of the window on a device, with a picture of so many pixels, into a report. The window is not the
/// laboratory's to know.
pub type Window = fn(&Rc<Device>, [u32; 2], &mut Report) -> Result<()>;

/// Measures, prints and writes; `window` is what `--viewer` measures by.
///
/// # Errors
///
/// [`Error::NoContext`] without OpenGL 4.3; [`Error::Exists`] and [`Error::Write`] where a file cannot be written;
/// [`Error::Missed`] where a bar is missed and that was asked to be an error.
pub fn run(args: &Args, window: Window) -> Result<()> {
    let outputs = [("--csv", &args.csv), ("--json", &args.json)];
    let outputs: Vec<_> = outputs.into_iter().filter_map(|(option, path)| Some((option, path.as_deref()?))).collect();
    target::spare(&outputs, &[])?;
    for path in args.csv.iter().chain(&args.json) {
        target::check(path, args.force)?;
    }
    let report = measure(args, window)?;
    stdout::print(|out| report.print(out))?;
    if let Some(path) = &args.csv {
        let text = report.csv().map_err(|reason| Error::write(path, reason))?;
        target::write_text(path, &text, args.force)?;
    }
    if let Some(path) = &args.json {
        target::write_json(path, &report, args.force)?;
    }
    let missed = report.missed();
    if args.strict && !missed.is_empty() { Err(Error::Missed { missed }) } else { Ok(()) }
}

fn measure(args: &Args, window: Window) -> Result<Report> {
    let rounds = Rounds::new(2, args.rounds.map_or(if args.quick { 4 } else { 10 }, usize::from));
    let started = Instant::now();
    let device = Device::open(args.backend.backends())?;
    let opened = started.elapsed();

    let known = args.calibration.known(Some(device.info()));
    if let Some(warning) = &known.warning {
        stderr::warn([warning]);
    }
    let size = args.size.unwrap_or(USUAL);
    let stage = Stage::new(device, size, rounds, known.model);
    let mut report =
        Report::new(stage.device().info(), args.size.or_else(|| args.scenes.is_none().then_some(size)), rounds);
    if let Some(count) = args.gaussians {
        gaussians::of_one_size(&stage, &mut report, count as usize, args.sigma, args.tolerance)?;
        return Ok(report);
    }
    if let Some(count) = args.scenes {
        choices::of_random_scenes(&stage, &mut report, args.first..args.first.saturating_add(count), args.size)?;
        return Ok(report);
    }
    if args.local {
        local::against_a_copy(&stage, &mut report)?;
        return Ok(report);
    }
    if args.digits {
        digits::in_doubles(&stage, &mut report)?;
        return Ok(report);
    }
    if args.veil {
        veil::against_a_copy(&stage, &mut report)?;
        return Ok(report);
    }
    if args.whole {
        whole::against_a_copy(&stage, &mut report)?;
        return Ok(report);
    }
    if args.lens {
        lens::against_a_copy(&stage, &mut report)?;
        return Ok(report);
    }
    if args.viewer {
        window(stage.shared_device(), size, &mut report)?;
        return Ok(report);
    }
    first::frame(&stage, opened, &mut report)?;
    cases::default_path(&stage, &mut report)?;
    local::against_a_copy(&stage, &mut report)?;
    digits::in_doubles(&stage, &mut report)?;
    veil::against_a_copy(&stage, &mut report)?;
    whole::against_a_copy(&stage, &mut report)?;
    many::ghosts(&stage, &mut report, args.quick)?;
    if !args.quick {
        lens::against_a_copy(&stage, &mut report)?;
        cases::rows_and_series(&stage, &mut report)?;
    }
    cases::passes(&stage, &mut report, args.quick)?;
    exchange::ways(&stage, &mut report)?;
    Ok(report)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(clap::Parser)]
    struct Cli {
        #[command(flatten)]
        args: Args,
    }

    fn parsed(args: &[&str]) -> Result<Args, clap::Error> {
        clap::Parser::try_parse_from(["bench"].iter().chain(args)).map(|Cli { args }| args)
    }

    #[test]
    fn sizes_are_two_sides() {
        assert_eq!(parsed(&[]).unwrap().size, None);
        assert_eq!(parsed(&["--size", "64x36"]).unwrap().size, Some([64, 36]));
        for bad in ["64", "64x", "x36", "0x36", "64x-1", "64x36x2", "99999x10", "a×b"] {
            assert!(parsed(&["--size", bad]).is_err(), "{bad}");
        }
    }

    #[test]
    fn a_file_that_exists_is_refused_before_anything_is_measured() {
        let file = tempfile::NamedTempFile::new().unwrap();
        let args = parsed(&["--csv", file.path().to_str().unwrap()]).unwrap();
        assert!(matches!(run(&args, |_, _, _| unreachable!()), Err(Error::Exists { .. })));
    }
}
