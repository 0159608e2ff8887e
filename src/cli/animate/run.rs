//! The run itself: what is read once, then frame by frame, the one before being written meanwhile.

use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;

use super::frame::{Drawn, Lights, View, repeats, seen};
use super::outputs::{self, Paths};
use super::parts::Maker;
use super::report::Log;
use super::shot::Shot;
use super::{Args, Lit};
use crate::choices::Normalize;
use crate::cli::apply::pipeline;
use crate::cli::surroundings::Surroundings;
use crate::job::Step;
use crate::look::Look;
use crate::motion::{self, LightPath, Panorama, Sees, Sheet, Track};
use crate::photo::{self, Photo};
use crate::terminal::progress::Progress;
use crate::{Error, Result, limits, panics};

/// A frame that has been made, or one before it that it repeats, by that one's index.
struct Made {
    index: usize,
    result: Result<(Arc<Drawn>, Option<usize>)>,
}

/// Renders all frames of a path.
///
/// # Errors
/// Whatever keeps a frame from being written; those before it are whole, and nothing is left half-written.
pub fn run(args: &Args) -> Result<()> {
    let shot = Shot::new(args, motion::read_path(&args.motion.path)?)?;
    let look = args.look()?;
    let paths = outputs::paths(args, &shot)?;
    let progress = Progress::start(args.quiet);
    progress.say(Step::Reading.to_string());
    let log = match &shot.path {
        motion::Path::Lights(lights) => of_lights(args, &shot, lights, &look, &paths, &progress)?,
        motion::Path::Camera(track, sees) => of_camera(args, &shot, (track, *sees), &look, &paths, &progress)?,
    };
    drop(progress);
    log.finish(args, &shot, &look)
}

/// Lights before a photo, or before black.
fn of_lights<'a>(
    args: &'a Args,
    shot: &'a Shot,
    lights: &'a [LightPath],
    look: &'a Look,
    paths: &'a [Paths],
    progress: &Progress,
) -> Result<Log<'a>> {
    if args.motion.panorama.is_some() {
        return Err(Error::Usage(
            "--panorama is what a camera sees, and the path is of lights: give it yaw, pitch and roll".into(),
        ));
    }
    if !args.hood.is_empty() {
        return Err(Error::Usage(
            "--hood and --stray are of what a camera does not see, and the path is of lights".into(),
        ));
    }
    if look.normalize != Normalize::None {
        let reason = "lights that move need --normalize none: what they add to the glare is computed by itself";
        return Err(Error::Usage(reason.into()));
    }
    args.scene.unit.check(look)?;
    let photo = match &args.photo {
        Some(path) => photo::read_with(path, &args.reading.of_white(args.veil.white_luminance()))?,
        None => black(args.sides()),
    };
    paths[0].check(args, &photo)?;
    let sheet = Sheet::new(look.frame(&photo)?);
    let cast = shot.cast(lights, &sheet, args.motion.outside);
    let repeats = repeats(shot, |before, frame| cast.moving[before] == cast.moving[frame]);
    let mut log = Log::new(args, shot, paths);
    log.photo = args.photo.is_some().then(|| photo.facts());
    log.sides = [photo.width(), photo.height()];
    log.lights = (0..shot.frames).map(|frame| cast.at(frame)).collect();
    progress.say(Step::Computing.to_string());
    let lights = Lights::new(Maker::new(args, look)?, photo, args.photo.is_some(), &cast, sheet)?;
    log.still(&lights.base);
    let make = |lights: &mut Lights<'_>, index: usize, ()| lights.frame(&cast, index);
    through(&mut log, progress, &repeats, |_| Ok(()), || Ok(lights), make)?;
    Ok(log)
}

/// A camera in a panorama.
fn of_camera<'a>(
    args: &'a Args,
    shot: &'a Shot,
    (track, sees): (&'a Track<4>, Sees),
    look: &'a Look,
    paths: &'a [Paths],
    progress: &Progress,
) -> Result<Log<'a>> {
    let Some(path) = &args.motion.panorama else {
        return Err(Error::Usage("the path is of a camera: --panorama names what it sees".into()));
    };
    let unsaid = look.fov;
    let lit = args.motion.surroundings == Lit::Lit;
    if !lit && !args.hood.is_empty() {
        return Err(Error::Usage(
            "--hood and --stray are of light from outside the frame, and the surroundings are dark".into(),
        ));
    }
    let place = if lit {
        Place::Lit(
            Surroundings::read(path, &args.reading.of_white(args.veil.white_luminance()), args.hood, look)?.into(),
        )
    } else {
        Place::Dark(panorama(args, path)?.into())
    };
    let (sides, overscan) = (args.sides(), args.reading.options().overscan);
    let beyond = sides.map(|side| (f64::from(side) * overscan).round() as u32);
    let camera = |frame: usize| shot.camera(track, sees, frame, unsaid);
    paths[0].check(args, &black(sides))?;
    let repeats = repeats(shot, |before, frame| camera(before) == camera(frame));
    let mut log = Log::new(args, shot, paths);
    log.sides = sides;
    log.cameras = (0..shot.frames).map(camera).collect();
    progress.say(Step::Computing.to_string());
    let view = |index: usize| {
        let (camera, fov) = camera(index);
        match &place {
            Place::Lit(surroundings) => {
                surroundings.seen(&camera, fov, sides, beyond, None).map(|seen| View::Lit(seen.into()))
            }
            Place::Dark(panorama) => Ok(View::Dark(panorama.view(&camera, fov, sides, beyond).into(), fov)),
        }
    };
    let prepare = || Maker::new(args, look);
    let make = |maker: &mut Maker<'_>, _: usize, view: View<'_>| seen(maker, view);
    through(&mut log, progress, &repeats, view, prepare, make)?;
    Ok(log)
}

/// Where a camera is.
enum Place {
    Lit(Box<Surroundings>),
    Dark(Box<Panorama>),
}

fn panorama(args: &Args, path: &Path) -> Result<Panorama> {
    let options = photo::ReadOptions { overscan: 0.0, ..args.reading.of_white(args.veil.white_luminance()) };
    let photo = photo::read_with(path, &options)?;
    Panorama::new(photo).map_err(|reason| Error::read_photo(path, reason))
}

fn black([width, height]: [u32; 2]) -> Photo {
    Photo::new(width, height, vec![[0.0, 0.0, 0.0, 1.0]; width as usize * height as usize])
}

/// Takes all frames through their steps: what `first` gives is there before a frame is made, of those that do not repeat the one
/// before; the last one made is kept for those that do.
fn through<T, A: Send>(
    log: &mut Log<'_>,
    progress: &Progress,
    repeats: &[bool],
    first: impl Fn(usize) -> Result<A> + Send + Sync,
    prepare: impl FnOnce() -> Result<T>,
    mut make: impl FnMut(&mut T, usize, A) -> Result<Drawn>,
) -> Result<()> {
    let mut kept: Option<(usize, Arc<Drawn>)> = None;
    let begin = |index: usize| (index, (!repeats[index]).then(|| panics::caught(|| first(index))));
    let middle = |tool: &mut T, (index, given): (usize, Option<Result<A>>)| {
        let result = match (given, &kept) {
            (None, Some((made, drawn))) => Ok((drawn.clone(), Some(*made))),
            // What it would repeat has failed.
            (None, None) => Err(Error::Cancelled),
            (Some(given), _) => {
                let drawn = given.and_then(|given| panics::caught(|| make(tool, index, given))).map(Arc::new);
                kept = drawn.as_ref().ok().map(|drawn| (index, drawn.clone()));
                drawn.map(|drawn| (drawn, None))
            }
        };
        Made { index, result }
    };
    let mut failed = None;
    let last = |Made { index, result }: Made| match result
        .and_then(|(drawn, same)| panics::caught(|| log.write(index, &drawn, same)))
    {
        Ok(()) => {
            let (done, all) = (index + 1, repeats.len());
            progress.part(format!("{done} of {all} frames"), done as f64 / all as f64);
            ControlFlow::Continue(())
        }
        Err(error) => {
            failed = Some(log.blame(index, error));
            ControlFlow::Break(())
        }
    };
    pipeline::run(repeats.len(), !limits::memory_is_limited(), begin, prepare, middle, last)?;
    failed.map_or(Ok(()), Err)
}
