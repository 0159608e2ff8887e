//! What a person is told.

use std::io::{self, Write};

use super::Angles;
use super::run::Run;
use crate::Result;
use crate::terminal::stdout;

/// Unless quiet, a short summary to standard output.
pub fn print(run: &Run<'_>) -> Result<()> {
    if run.args.quiet {
        return Ok(());
    }
    stdout::print(|out| {
        about_panorama(out, run)?;
        about_bands(out, run)?;
        writeln!(out, "error    {:.2} % of the panorama's RMS, at the centres of its pixels", 100.0 * run.error)?;
        about_turn(out, run)?;
        let ([low, high], what) = (run.range, if run.args.irradiance { "irradiance" } else { "radiance" });
        writeln!(out, "values   {what} from {low:.4} to {high:.4}")?;
        writeln!(out, "wrote    {} in {:.2} s", run.args.output.display(), run.seconds)
    })
}

fn about_panorama(out: &mut dyn Write, run: &Run<'_>) -> io::Result<()> {
    let (photo, bad) = (&run.panorama.photo, &run.panorama.bad);
    let (format, depth) = (photo.format_name(), photo.depth_name());
    let (width, height) = (photo.width(), photo.height());
    writeln!(out, "panorama {}: {width} x {height}, {format}, {depth}", run.args.panorama.display())?;
    if let Some((column, row, _)) = bad.first {
        writeln!(
            out,
            "         {} NaN, {} infinite, {} negative pixels, the first at column {column}, row {row}; NaN and infinite \
             values count as 0, negative ones as they are",
            bad.nan, bad.infinite, bad.negative
        )?;
    }
    Ok(())
}

/// Each band up to 8, then as many again at a time.
fn about_bands(out: &mut dyn Write, run: &Run<'_>) -> io::Result<()> {
    let degree = run.own.degree();
    writeln!(out, "degree   {degree}, {} coefficients for each colour", (degree + 1) * (degree + 1))?;
    writeln!(out, "energy         l   share %  so far %")?;
    let share = |energy: f64| if run.energy == 0.0 { 0.0 } else { 100.0 * energy / run.energy };
    let (mut first, mut sum) = (0, 0.0);
    while first <= degree {
        let last = if first <= 8 { first } else { (2 * (first - 1)).min(degree) };
        let energy: f64 = (first..=last).map(|l| run.own.band_energy(l)).sum();
        sum += energy;
        let name = if first == last { first.to_string() } else { format!("{first} to {last}") };
        writeln!(out, "{name:>16}{:>10.3}{:>10.3}", share(energy), share(sum))?;
        first = last + 1;
    }
    Ok(())
}

fn about_turn(out: &mut dyn Write, run: &Run<'_>) -> io::Result<()> {
    if let Some(Angles([yaw, pitch, roll])) = run.args.rotate {
        writeln!(out, "turned   by yaw {yaw}, pitch {pitch}, roll {roll} degrees")?;
    }
    if let Some(check) = &run.check {
        let (width, height) = (check.fine.width, check.fine.height);
        writeln!(out, "check    turned coefficients against those of the turned panorama, relative difference:")?;
        writeln!(out, "         {:.1e} with each of its pixels carried to its new place", check.carried)?;
        writeln!(out, "         {:.1e} with it interpolated, and sampled at {width} x {height} points", check.sampled)?;
    }
    Ok(())
}
