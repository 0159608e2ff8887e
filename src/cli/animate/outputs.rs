//! Which files the frames become, and whether they may be written.

use std::path::{Path, PathBuf};

use super::Args;
use super::shot::Shot;
use crate::chart::Kind;
use crate::cli::apply::names::Names;
use crate::cli::apply::outputs::room;
use crate::photo::{self, Photo};
use crate::target::{self, spare};
use crate::{Error, Result};

/// The files of a frame.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Paths {
    pub picture: Option<PathBuf>,
    pub glare: Option<PathBuf>,
}

/// The files of all frames.
///
/// # Errors
/// [`Error::Usage`] for names that do not give each frame a file of its own, and where one that is read would be replaced;
/// [`Error::Write`] for a name that cannot be written, [`Error::Exists`] for a file that must not be replaced.
pub fn paths(args: &Args, shot: &Shot) -> Result<Vec<Paths>> {
    let pictures = args.output.as_deref().map(|given| names(given, "--output")).transpose()?;
    let glare = args.outputs.glare.as_deref().map(|given| names(given, "--glare")).transpose()?;
    let stem = args.motion.path.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned());
    let frame = |frame: usize| {
        let of =
            |names: &Option<Names>| names.as_ref().map(|names| names.of_frame(&stem, shot.number(frame))).transpose();
        Ok(Paths { picture: of(&pictures)?, glare: of(&glare)? })
    };
    let paths = (0..shot.frames).map(frame).collect::<Result<Vec<_>>>()?;
    apart(args, &paths)?;
    pictures.iter().chain(&glare).try_for_each(|names| room(names.place()))?;
    for path in paths.iter().flat_map(Paths::all) {
        photo::check_name(path, args.outputs.encoding.format())?;
        if path.is_file() && !args.force {
            return Err(Error::Exists { path: path.clone() });
        }
    }
    if let Some(plot) = &args.outputs.plot {
        Kind::of(plot)?;
    }
    args.outputs.plot.iter().chain(&args.outputs.report).try_for_each(|path| target::check(path, args.force))?;
    Ok(paths)
}

impl Paths {
    /// Those that there are.
    pub fn all(&self) -> impl Iterator<Item = &PathBuf> {
        self.picture.iter().chain(&self.glare)
    }

    /// Everything that could keep pictures like these from being written.
    ///
    /// # Errors
    /// Those of [`photo::check_target`].
    pub fn check(&self, args: &Args, photo: &Photo) -> Result<()> {
        let encoding = &args.outputs.encoding;
        if let Some(path) = &self.picture {
            target::make_folder(target::folder(path))?;
            photo::check_target(path, photo, &encoding.picture(args.force))?;
        }
        if let Some(path) = &self.glare {
            target::make_folder(target::folder(path))?;
            let glare = photo.companion(vec![[0.0; 4]; photo.frame.window.pixels()]);
            photo::check_target(path, &glare, &encoding.glare(path, args.output.is_some(), args.force))?;
        }
        Ok(())
    }
}

/// Names that number frames.
fn names(given: &Path, option: &str) -> Result<Names> {
    Names::new(given).filter(Names::count).ok_or_else(|| {
        Error::Usage(format!(
            "{option} has no place for the frame's number: {} would be one file of all; write it as out.####.png or out_%04d.png",
            given.display()
        ))
    })
}

/// Whether every output is a file of its own, and nothing that is read.
fn apart(args: &Args, paths: &[Paths]) -> Result<()> {
    let report = args.outputs.report.iter().map(|path| ("--report", path.as_path()));
    let report = report.chain(args.outputs.plot.iter().map(|path| ("--plot", path.as_path())));
    let pictures = paths.iter().flat_map(|paths| {
        let picture = paths.picture.iter().map(|path| ("--output", path.as_path()));
        picture.chain(paths.glare.iter().map(|path| ("--glare", path.as_path())))
    });
    let outputs: Vec<(&str, &Path)> = report.chain(pictures).collect();
    let scene = args.scene.files();
    let mut inputs: Vec<(&str, &Path)> = vec![("the path", &args.motion.path)];
    inputs.extend(args.photo.iter().map(|path| ("the photo", path.as_path())));
    inputs.extend(args.motion.panorama.iter().map(|path| ("the panorama", path.as_path())));
    let read = scene.iter().chain(args.veil.files());
    inputs.extend(read.map(|path| ("which the scene is read from", path.as_path())));
    spare(&outputs, &inputs)
}
