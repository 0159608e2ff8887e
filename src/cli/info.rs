//! `vglare info`: what there is to compute on.

use std::io::{self, Write};

use serde::Serialize;

use super::stdout;
use crate::Result;
use crate::gpu::{Backend, Device, Info};

/// Show the renderer, its limits, and which backends work
///
/// For a backend that does not work, says why, and which Debian packages would mend it.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Print JSON
    #[arg(long)]
    json: bool,
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
    debian_packages: &'static str,
}

/// Prints what each backend says of itself.
///
/// # Errors
/// Where standard output cannot be written. A backend that does not work is no error here.
pub fn run(args: &Args) -> Result<()> {
    let reports: Vec<Report> = Backend::ALL.into_iter().map(report).collect();
    stdout::print(|out| if args.json { json(out, &reports) } else { text(out, &reports) })
}

fn report(backend: Backend) -> Report {
    let (info, reason) = match Device::try_open(backend) {
        Ok(device) => (Some(device.info().clone()), None),
        Err(reason) => (None, Some(reason)),
    };
    Report { backend, works: info.is_some(), info, reason, debian_packages: backend.packages() }
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
    let [x, y, z] = limits.work_groups;
    let (invocations, shared) = (limits.work_group_invocations, limits.shared_memory >> 10);
    writeln!(out, "  work groups        {x} x {y} x {z} of {invocations} invocations, {shared} KiB shared")
}
