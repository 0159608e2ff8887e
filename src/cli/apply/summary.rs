//! What a person is told.

use std::io::{self, Write};

use super::job::{Job, Luminance};
use super::report::kind_name;
use crate::Result;
use crate::certificate::Verify;
use crate::choices::{Border, LengthUnit, Processor};
use crate::cli::plan::text;
use crate::cli::{found, luminance};
use crate::job::{Computed, Done, EachPixel, VeilSeen, Veiled};
use crate::look::{Gathered, Look, LookLens, LookLights};
use crate::photo::Facts;
use crate::scene::Found;
use crate::terminal::{stderr, stdout};

/// Warnings to standard error; unless quiet, a short summary to standard output, where no file goes there.
pub fn print(job: &Job<'_, Done<'_>>) -> Result<()> {
    stderr::warn(&job.work.warnings);
    if job.args.quiet {
        return Ok(());
    }
    stdout::summary(job.args.takes_stdout(), |out| {
        about_photo(out, job)?;
        about_unit(out, &job.work)?;
        about_clipped(out, &job.work.scene)?;
        about_scene(out, &job.work.scene, job.work.look)?;
        if let Some(veiled) = &job.work.veiled {
            about_veil(out, veiled)?;
            veiled.notes.iter().try_for_each(|note| writeln!(out, "note     {note}"))?;
        }
        job.outside.iter().try_for_each(|outside| writeln!(out, "{outside}"))?;
        if let Some(Luminance { scale, photo, glare }) = &job.luminance {
            luminance::line(out, scale, [("photo", photo), ("glare", glare)])?;
        }
        if let Some(computed) = &job.work.computed {
            about_plan(out, job, computed)?;
            computed.planning.notes.iter().try_for_each(|note| writeln!(out, "note     {note}"))?;
        }
        if job.args.verbose {
            about_times(out, job)?;
        }
        let total: f64 = job.work.stages.0.iter().map(|(_, ms)| ms).sum();
        let written: Vec<_> = job.paths.files().map(|path| path.display().to_string()).collect();
        match &written[..] {
            [] => writeln!(out, "done     in {:.2} s, without a picture", total * 1e-3),
            written => writeln!(out, "wrote    {} in {:.2} s", written.join(" and "), total * 1e-3),
        }
    })
}

fn about_photo(out: &mut dyn Write, job: &Job<'_, Done<'_>>) -> io::Result<()> {
    let (Facts { frame, format, depth, picture }, bad) = (&job.work.facts, &job.work.bad);
    let (width, height) = (frame.width, frame.height);
    write!(out, "photo    {}: {width} x {height}, {format}, {depth}", job.paths.input.display())?;
    if frame.pixel_aspect != 1.0 {
        write!(out, ", pixels {:.4} times as wide as high", frame.pixel_aspect)?;
    }
    match picture {
        Some(picture) => writeln!(out, "; its picture is {picture}")?,
        None => writeln!(out)?,
    }
    if let Some((column, row, kind)) = bad.first {
        writeln!(
            out,
            "         {} NaN, {} infinite, {} negative pixels; the first, {}, at column {column}, row {row}; \
             none of them counts as light",
            bad.nan,
            bad.infinite,
            bad.negative,
            kind_name(kind)
        )?;
    }
    Ok(())
}

/// What lengths are counted in, where that is not half the picture's height.
fn about_unit(out: &mut dyn Write, work: &Done<'_>) -> io::Result<()> {
    let (unit, pixels) = (work.look.unit, work.frame.pixel_size().recip());
    match unit {
        LengthUnit::Height => Ok(()),
        LengthUnit::ShortSide if work.frame.unit == 1.0 => Ok(()),
        LengthUnit::Degrees => writeln!(out, "unit     degrees, of {pixels:.1} pixels in the middle of the picture"),
        _ => writeln!(out, "unit     half the picture's {}, {pixels:.1} pixels", unit.to_string().replace('-', " ")),
    }
}

/// What clipped pixels shine like.
fn about_clipped(out: &mut dyn Write, scene: &Gathered) -> io::Result<()> {
    let Some(recovery) = &scene.recovery else { return Ok(()) };
    writeln!(out, "recovered: {recovery}")?;
    recovery.note.iter().try_for_each(|note| writeln!(out, "         {note}"))
}

/// What is light, and what it becomes.
fn about_scene(out: &mut dyn Write, scene: &Gathered, look: &Look) -> io::Result<()> {
    if look.lens_ghosts().is_empty() && scene.ghosts.is_empty() {
        return match look.lens.ghosts() {
            [] => writeln!(out, "lens     none, so no ghosts"),
            _ if look.is_panorama() => writeln!(out, "lens     none: a picture of all directions has no ghosts"),
            _ => writeln!(out, "lens     {}: a veil in place of its ghosts", look.lens().name),
        };
    }
    let muted = match scene.lights.iter().filter(|light| light.muted).count() {
        0 => String::new(),
        muted => format!(", {muted} of them muted"),
    };
    match (&scene.found, &look.lights) {
        (Some(found), _) if look.finds() => {
            about_found(out, found, look)?;
            if let LookLights::FoundAnd(added) = &look.lights {
                writeln!(out, "         {} more, as listed{muted}", added.len())?;
            }
        }
        _ if !scene.lights.is_empty() => writeln!(out, "lights   {}, as listed{muted}", scene.lights.len())?,
        _ if scene.is_dark() => writeln!(out, "lights   none are listed, so no glare")?,
        _ => {}
    }
    if let Some(images) = &scene.images {
        writeln!(out, "sources  {} pixels", images.raster().pixels())?;
        if let Some(lens) = &scene.lens {
            writeln!(out, "lens     {}{}: {} ghosts of each pixel", lens.name, stop(look), images.of_each())?;
        }
        found::rims(images).iter().try_for_each(|rims| writeln!(out, "         {rims}"))?;
        return match scene.ghosts.len() {
            0 => Ok(()),
            others => writeln!(out, "ghosts   {others} more"),
        };
    }
    match &scene.lens {
        Some(lens) => writeln!(out, "lens     {}{}: {} ghosts in all", lens.name, stop(look), scene.ghosts.len()),
        None => writeln!(out, "ghosts   {}", scene.ghosts.len()),
    }
}

/// What was found in the photo, and what was taken for no light.
fn about_found(out: &mut dyn Write, found: &Found, look: &Look) -> io::Result<()> {
    if found.regions == 0 {
        writeln!(out, "lights   none, so no glare of the photo's own: {}", found::none(found))?;
    } else {
        writeln!(out, "lights   {} at a {} of {:.4} and above", found.lights.len(), found.by, found.threshold)?;
        found::beyond(found).iter().try_for_each(|beyond| writeln!(out, "         {beyond}"))?;
    }
    match found::fireflies(found, &look.find) {
        Some(fireflies) => writeln!(out, "         {fireflies}"),
        None => Ok(()),
    }
}

/// What every pixel scattered, how exactly, and what became of the light.
fn about_veil(out: &mut dyn Write, veiled: &Veiled) -> io::Result<()> {
    let Veiled { seen, strength, scattered, error, ledger, dark, .. } = veiled;
    let VeilSeen { parameters, projection, fov, fov_from, border: _ } = seen;
    write!(out, "veil     {}", parameters.psf)?;
    if let Some((fov, from)) = fov.zip(fov_from.as_ref()) {
        let projection = said(projection);
        let article = if projection.starts_with('e') { "an" } else { "a" };
        write!(out, ", {from}: {} across {article} {projection} picture", text::angle(fov))?;
    }
    let mean = |values: [f64; 3]| values.into_iter().sum::<f64>() / 3.0;
    let by = text::summed(&veiled.summed_by, veiled.terms);
    write!(out, ": scatters {:.1} % of the light, by {by}", 100.0 * strength * mean(*scattered))?;
    // The CPU is what one expects.
    writeln!(out, "{}", if veiled.computed_by == Processor::Gl { ", on the device" } else { "" })?;
    let share = |part: [f64; 3]| 100.0 * mean(part) / mean(ledger.light);
    if mean(ledger.light) > 0.0 {
        let [kept, inside, lost] = [ledger.kept, ledger.inside, ledger.lost].map(share);
        let rest = rest(veiled, kept, lost);
        writeln!(out, "light    {kept:.1} % stays, {inside:.1} % falls elsewhere in the picture, {rest}")?;
    }
    let dark: usize = dark.iter().sum();
    if dark > 0 {
        writeln!(out, "         {dark} samples have a veil below a billionth of the brightest, and are held to that")?;
    }
    writeln!(
        out,
        "error    of the veil, by its own brightness at each pixel: {:.1e} measured at {} pixels, {:.1e} predicted, {:.1e} asked",
        error.measured, error.pixels, error.predicted, error.asked
    )
}

/// What becomes of the rest of the light, of which a share in percent is kept and another is lost; there may be more than there was.
fn rest(veiled: &Veiled, kept: f64, lost: f64) -> String {
    // What a tenth of a percent does not show.
    if lost > -0.05 {
        return format!("{:.1} % leaves it", lost.max(0.0));
    }
    let why = match veiled.seen.border {
        _ if veiled.adds => "the veil is added, and the photo keeps its own light",
        _ if kept > 100.0 => "pixels are coarser than the function's core",
        Border::Mirror | Border::Extend => "some comes from beyond the edges",
        Border::None => "the veil's error is as large",
    };
    format!("and {:.1} % more than there was: {why}", -lost)
}

/// A choice as it is written.
fn said(choice: &impl std::fmt::Debug) -> String {
    format!("{choice:?}").to_lowercase()
}

fn about_plan(out: &mut dyn Write, job: &Job<'_, Done<'_>>, computed: &Computed) -> io::Result<()> {
    let Computed { info, planning, certificate: error, each_pixel, measured_ms, passes: _ } = computed;
    let plan = &planning.plan;
    text::plan(out, plan)?;
    if let Some(budget) = job.work.look.accuracy.goal.budget() {
        write!(out, "budget   {budget} ms bought a tolerance of {:.1e}", plan.tolerance)?;
        let (predicted, measured) = (plan.cost().unwrap_or(f64::NAN), measured_ms.unwrap_or(f64::NAN));
        writeln!(out, ": {predicted:.1} ms predicted, {measured:.1} ms measured")?;
    }
    let all = if error.verify == Verify::Full { "all " } else { "" };
    writeln!(
        out,
        "error    {:.1e} measured at {all}{} pixels, {:.1e} predicted, {:.1e} asked",
        error.measured, error.pixels, error.predicted, error.asked
    )?;
    if let Some(EachPixel { asked, predicted, measured, darker, .. }) = each_pixel {
        write!(out, "         of photo and glare at the darkest pixel: at most {measured:.1e} measured, ")?;
        write!(out, "{predicted:.1e} predicted, {asked:.1e} asked")?;
        match darker.iter().max() {
            Some(&darker) if darker > 0 => writeln!(out, "; {darker} pixels below 1/4096 of the mean count as that")?,
            _ => writeln!(out)?,
        }
    }
    writeln!(out, "renderer {}, {}", info.renderer, info.route)
}

fn about_times(out: &mut dyn Write, job: &Job<'_, Done<'_>>) -> io::Result<()> {
    if let Some(computed) = &job.work.computed {
        text::details(out, &computed.planning)?;
    }
    for pass in job.work.computed.iter().flat_map(|computed| &computed.passes) {
        write!(out, "pass     {:<13}{:>9.2} ms", pass.pass, pass.wall_ms)?;
        match pass.gpu_ms {
            Some(gpu) => writeln!(out, ", {gpu:.2} ms by the device's timer")?,
            None => writeln!(out)?,
        }
    }
    for (stage, ms) in &job.work.stages.0 {
        writeln!(out, "stage    {stage:<13}{ms:>9.2} ms")?;
    }
    Ok(())
}

/// How far a lens that is known by its surfaces is open.
fn stop(look: &Look) -> String {
    match &look.lens {
        LookLens::Optical(optical) => format!(", f/{:.1}", optical.f_number()),
        _ => String::new(),
    }
}
