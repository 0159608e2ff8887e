//! `vglare info`: what there is to compute on, or what is known of a photo.

mod photo;

use std::io::{self, Write};
use std::path::PathBuf;
use std::rc::Rc;

use comfy_table::{CellAlignment, Table, presets};
use serde::Serialize;

use crate::Result;
use crate::gpu::precision::{self, Precision};
use crate::gpu::{Backend, Device, Info};
use crate::options::ReadArgs;
use crate::terminal::stdout;

/// Show the renderer, its limits, and which backends work; or what a photo's file says of itself
///
/// For a backend that does not work, says why, and which Debian packages would mend it. Of a photo, says how it is stored, what its
/// numbers mean, in cd/m² too where the file names that, and what it spans.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// A photo, in place of the renderer; - for standard input
    #[arg(value_name = "PHOTO", conflicts_with = "precision")]
    photo: Option<PathBuf>,

    #[command(flatten)]
    reading: ReadArgs,

    /// Print JSON
    #[arg(long)]
    json: bool,

    /// Measure how exact the renderer's sin, cos and exp are in 32-bit floats, and vglare's own phases
    #[arg(long)]
    precision: bool,
}

/// One backend, working or not.
#[derive(Serialize)]
struct Report {
    backend: Backend,
    works: bool,
    #[serde(skip_serializing_if = "Option::is_none")]
    info: Option<Info>,
    #[serde(skip_serializing_if = "Option::is_none")]
    reason: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    precision: Option<Vec<Precision>>,
    debian_packages: &'static str,
}

/// Prints what each backend says of itself, or what is known of a photo.
///
/// # Errors
/// Where standard output cannot be written, the precision cannot be measured, or the photo cannot be read. A backend that does not work is no
/// error here.
pub fn run(args: &Args) -> Result<()> {
    if let Some(path) = &args.photo {
        return photo::run(path, &args.reading, args.json);
    }
    let reports: Vec<Report> =
        Backend::ALL.into_iter().map(|backend| report(backend, args.precision)).collect::<Result<_>>()?;
    if args.json { stdout::json(|out| json(out, &reports)) } else { stdout::print(|out| text(out, &reports)) }
}

fn report(backend: Backend, precise: bool) -> Result<Report> {
    let (info, reason, precision) = match Device::try_open(backend) {
        Ok(device) => {
            let device = Rc::new(device);
            let precision = precise.then(|| precision::measure(&device)).transpose()?;
            (Some(device.info().clone()), None, precision)
        }
        Err(reason) => (None, Some(reason), None),
    };
    Ok(Report { backend, works: info.is_some(), info, reason, precision, debian_packages: backend.packages() })
}

fn json(out: &mut dyn Write, reports: &[Report]) -> io::Result<()> {
    #[derive(Serialize)]
    struct All<'a> {
        version: &'a str,
        backends: &'a [Report],
    }
    serde_json::to_writer_pretty(&mut *out, &All { version: env!("CARGO_PKG_VERSION"), backends: reports })?;
    writeln!(out)
}

fn text(out: &mut dyn Write, reports: &[Report]) -> io::Result<()> {
    writeln!(out, "vglare {}", env!("CARGO_PKG_VERSION"))?;
    let first = reports.iter().position(|report| report.works);
    for (index, report) in reports.iter().enumerate() {
        let mark = if Some(index) == first { " (--backend auto takes this one)" } else { "" };
        match (&report.info, &report.reason) {
            (Some(info), _) => {
                writeln!(out, "\n{}: works{mark}", report.backend)?;
                describe(out, info)?;
                if let Some(precision) = &report.precision {
                    about_precision(out, precision)?;
                }
            }
            (None, reason) => {
                writeln!(out, "\n{}: does not work: {}", report.backend, reason.as_deref().unwrap_or("unknown"))?;
                writeln!(out, "  on Debian: apt-get install {}", report.debian_packages)?;
            }
        }
    }
    Ok(())
}

fn describe(out: &mut dyn Write, info: &Info) -> io::Result<()> {
    let kind = if info.software { "software" } else { "hardware" };
    writeln!(out, "  renderer           {} ({kind})", info.renderer)?;
    writeln!(out, "  vendor             {}", info.vendor)?;
    writeln!(out, "  OpenGL             {}", info.version)?;
    writeln!(out, "  route              {}", info.route)?;
    let limits = info.limits;
    writeln!(out, "  largest texture    {0} x {0}", limits.texture_size)?;
    writeln!(out, "  largest storage    {} MiB a block", limits.storage_block >> 20)?;
    writeln!(out, "  64-bit floats      {}", if limits.doubles { "yes" } else { "no" })?;
    writeln!(out, "  largest uniforms   {} KiB a block", limits.uniform_block >> 10)?;
    let [x, y, z] = limits.work_groups;
    let (invocations, shared) = (limits.work_group_invocations, limits.shared_memory >> 10);
    writeln!(out, "  work groups        {x} x {y} x {z} of {invocations} invocations, {shared} KiB shared")
}

fn about_precision(out: &mut dyn Write, ranges: &[Precision]) -> io::Result<()> {
    writeln!(out, "  worst errors in f32, for arguments x or harmonics n up to")?;
    let mut table = Table::new();
    table.load_style(presets::NOTHING);
    table.set_header(["", "sin x", "cos x", "exp(-x), relative", "vglare's phases, n φ", "not finite"]);
    for range in ranges {
        let errors = [range.sin, range.cos, range.exp, range.cis].map(|error| format!("{error:.1e}"));
        let [sin, cos, exp, cis] = errors;
        table.add_row([format!("{}", range.up_to), sin, cos, exp, cis, range.not_finite.to_string()]);
    }
    table.column_iter_mut().for_each(|column| column.set_cell_alignment(CellAlignment::Right));
    table.lines().try_for_each(|line| writeln!(out, "    {}", line.trim_end()))
}
