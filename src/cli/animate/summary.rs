//! What a person is told.

use std::io::{self, Write};

use super::Args;
use super::report::{FrameLog, Log};
use super::shot::{Lit, Shot};
use super::told::PlanTold;
use crate::Result;
use crate::look::{Look, LookLens};
use crate::motion::Path;
use crate::photo::Facts;
use crate::target;
use crate::terminal::stdout;

/// A short summary to standard output, where no file goes there.
///
/// # Errors
/// Where standard output cannot be written.
pub fn print(args: &Args, shot: &Shot, look: &Look, log: &Log<'_>) -> Result<()> {
    let outputs = &args.outputs;
    let files = [&args.output, &outputs.glare, &outputs.plot, &outputs.report].into_iter().flatten();
    stdout::summary(files.into_iter().any(|path| target::is_standard(path)), |out| {
        about_path(out, args, shot)?;
        about_picture(out, args, log)?;
        about_lens(out, look)?;
        if args.verbose {
            (0..log.frames.len()).try_for_each(|index| about_frame(out, shot, log, index))?;
        }
        about_still(out, log)?;
        about_plans(out, log)?;
        about_errors(out, shot, log)?;
        if let Some(renderer) = log.frames.iter().find_map(|frame| frame.told.renderer.as_deref()) {
            writeln!(out, "renderer {renderer}")?;
        }
        about_files(out, args, shot, log)
    })
}

fn about_path(out: &mut dyn Write, args: &Args, shot: &Shot) -> io::Result<()> {
    let what = match &shot.path {
        Path::Lights(lights) if lights.len() == 1 => "a light".to_owned(),
        Path::Lights(lights) => format!("{} lights", lights.len()),
        Path::Camera(..) => "a camera".to_owned(),
    };
    let [first, last] = shot.path.span();
    let (path, frames) = (args.motion.path.display(), shot.frames);
    let count = if frames == 1 { "1 frame".to_owned() } else { format!("{frames} frames") };
    writeln!(out, "path     {path}: {what} from {first} to {last}, in {count}")
}

fn about_picture(out: &mut dyn Write, args: &Args, log: &Log<'_>) -> io::Result<()> {
    let [width, height] = log.sides;
    match (&args.photo, &log.photo, &args.motion.panorama) {
        (Some(path), Some(Facts { format, depth, .. }), _) => {
            writeln!(out, "photo    {}: {width} x {height}, {format}, {depth}", path.display())
        }
        (_, _, Some(path)) => writeln!(out, "view     {width} x {height} of {}", path.display()),
        _ => writeln!(out, "picture  {width} x {height}, black"),
    }
}

fn about_lens(out: &mut dyn Write, look: &Look) -> io::Result<()> {
    if look.lens_ghosts().is_empty() {
        return writeln!(out, "lens     {}, without ghosts", look.lens().name);
    }
    match &look.lens {
        LookLens::Optical(optical) => writeln!(out, "lens     {}, f/{:.1}", look.lens().name, optical.f_number()),
        _ => writeln!(out, "lens     {}", look.lens().name),
    }
}

/// A frame in a line.
fn about_frame(out: &mut dyn Write, shot: &Shot, log: &Log<'_>, index: usize) -> io::Result<()> {
    let FrameLog { same, told, written_ms, .. } = &log.frames[index];
    write!(out, "frame    {:>5}", shot.number(index))?;
    if let Some(same) = same {
        return writeln!(out, "  is frame {}", shot.number(*same));
    }
    if let Some(lights) = log.lights.get(index) {
        let shining = lights.iter().filter_map(Lit::shining).count();
        write!(out, "  {shining} of {} lights", lights.len())?;
    }
    if let Some((camera, fov)) = log.cameras.get(index) {
        write!(out, "  yaw {:.2}, pitch {:.2}, roll {:.2}, {fov:.1}°", camera.yaw, camera.pitch, camera.roll)?;
    }
    if let Some(PlanTold { evaluator, terms, .. }) = &told.plan {
        write!(out, ", {evaluator}")?;
        if *terms > 0 {
            write!(out, " of {terms} terms")?;
        }
    }
    if let Some(error) = told.error {
        write!(out, ", error {:.1e}", error.measured)?;
    }
    writeln!(out, ", {:.0} ms, written in {written_ms:.0}", told.milliseconds)
}

/// What was computed once.
fn about_still(out: &mut dyn Write, log: &Log<'_>) -> io::Result<()> {
    for (what, told) in log.still_parts() {
        let by = told.plan.as_ref().map_or_else(String::new, |plan| format!(", by {}", plan.evaluator));
        let what = match *what {
            "photo" => "the photo's glare",
            _ => "lights that never change",
        };
        writeln!(out, "still    {what}{by}, once, in {:.0} ms", told.milliseconds)?;
    }
    Ok(())
}

/// How many frames there were of each kind.
fn about_plans(out: &mut dyn Write, log: &Log<'_>) -> io::Result<()> {
    let mut kinds: Vec<(String, usize)> = Vec::new();
    let mut count = |kind: String| match kinds.iter_mut().find(|(known, _)| *known == kind) {
        Some((_, count)) => *count += 1,
        None => kinds.push((kind, 1)),
    };
    for frame in &log.frames {
        count(match (frame.same, &frame.told.plan) {
            (Some(_), _) => "as the one before".to_owned(),
            (None, Some(plan)) => format!("by {}", plan.evaluator),
            (None, None) => "without ghosts that move".to_owned(),
        });
    }
    let told: Vec<String> = kinds.iter().map(|(kind, count)| format!("{count} {kind}")).collect();
    let (computed, milliseconds) =
        log.computed().fold((0, 0.0), |(n, ms), frame| (n + 1, ms + frame.told.milliseconds));
    write!(out, "frames   {}", told.join(", "))?;
    writeln!(out, "; {:.0} ms a frame that was computed", milliseconds / f64::from(computed.max(1)))
}

fn about_errors(out: &mut dyn Write, shot: &Shot, log: &Log<'_>) -> io::Result<()> {
    if let Some((index, error)) = log.worst() {
        writeln!(
            out,
            "error    {:.1e} measured at {} pixels of frame {}, the worst; {:.1e} predicted, {:.1e} asked",
            error.measured,
            error.pixels,
            shot.number(index),
            error.predicted,
            error.asked
        )?;
    }
    if let Some((index, error)) = log.worst_veil() {
        writeln!(
            out,
            "error    of the veil, by its own brightness at each pixel: {:.1e} measured in frame {}, the worst; {:.1e} asked",
            error.measured,
            shot.number(index),
            error.asked
        )?;
    }
    Ok(())
}

fn about_files(out: &mut dyn Write, args: &Args, shot: &Shot, log: &Log<'_>) -> io::Result<()> {
    let (first, last) = (shot.number(0), shot.number(shot.frames - 1));
    let patterns: Vec<String> =
        [&args.output, &args.outputs.glare].into_iter().flatten().map(|path| path.display().to_string()).collect();
    match &patterns[..] {
        [] => writeln!(out, "done     in {:.2} s, without a picture", log.seconds()),
        patterns => writeln!(out, "wrote    {}, {first} to {last}, in {:.2} s", patterns.join(" and "), log.seconds()),
    }
}
