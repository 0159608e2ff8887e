//! Which files a photo becomes, and whether they may be written.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use super::Args;
use super::names::Names;
use crate::photo::{self, Photo, WriteOptions};
use crate::target::{self, Identity};
use crate::{Error, Result};

/// A photo and the files that it becomes.
#[derive(Debug, Clone, PartialEq)]
pub struct Paths {
    pub input: PathBuf,
    pub output: Option<PathBuf>,
    pub glare: Option<PathBuf>,
}

/// Several photos, and where their pictures go.
pub struct Sequence {
    pub frames: Vec<Paths>,
    /// The folder that the pictures go to, or else the glare alone; none where there is a report only.
    pub place: Option<PathBuf>,
}

impl Paths {
    /// Those of a single photo, as they were given.
    fn single(args: &Args) -> Self {
        let glare = args.output_options.glare.clone();
        Self { input: args.photos()[0].clone(), output: args.output.clone(), glare }
    }

    /// The files that the photo becomes.
    pub fn pictures(&self) -> impl Iterator<Item = &PathBuf> {
        self.output.iter().chain(&self.glare)
    }

    /// Everything that could keep the results from being written, before the work begins.
    ///
    /// # Errors
    /// Those of [`photo::check_target`] and [`target::check`].
    pub fn check(&self, args: &Args, photo: &Photo) -> Result<()> {
        if let Some(path) = &self.output {
            photo::check_target(path, photo, &picture_options(args))?;
        }
        if let Some(path) = &self.glare {
            let glare = photo.companion(vec![[0.0; 4]; photo.frame.window.pixels()]);
            photo::check_target(path, &glare, &glare_options(args, path))?;
        }
        match &args.output_options.report {
            Some(path) => target::check(path, args.force),
            None => Ok(()),
        }
    }

    /// Makes the folders of the results.
    ///
    /// # Errors
    /// [`Error::Write`] where the system refuses.
    pub fn make_folders(&self) -> Result<()> {
        self.pictures().filter_map(|path| path.parent()).try_for_each(target::make_folder)
    }
}

/// How the picture is written.
pub fn picture_options(args: &Args) -> WriteOptions {
    args.output_options.encoding.picture(args.force)
}

/// How the glare is written.
pub fn glare_options(args: &Args, path: &Path) -> WriteOptions {
    args.output_options.encoding.glare(path, args.output.is_some(), args.force)
}

/// What is to be done: photos with their outputs.
pub enum Work {
    /// A photo that becomes single files.
    Single(Paths),
    Sequence(Sequence),
}

/// The photos with their outputs.
///
/// # Errors
/// [`Error::Usage`] where the names do not give each photo a file of its own, or one that is read would be replaced;
/// [`Error::Write`] for a name that cannot be written, [`Error::Exists`] where a file is there and must not be replaced:
/// before anything is read.
pub fn work(args: &Args) -> Result<Work> {
    let several = args.photos().len() > 1;
    let names = |given: Option<&Path>, option: &str| {
        let named = |given: &Path| match Names::new(given) {
            Some(names) => Ok(names),
            None if several => folder(given, option),
            None => Ok(Names::File(given.to_owned())),
        };
        given.map(named).transpose()
    };
    let pictures = names(args.output.as_deref(), "--output")?;
    let glare = names(args.output_options.glare.as_deref(), "--glare")?;
    let is_file = |names: &Names| matches!(names, Names::File(_));
    if !several && pictures.iter().chain(&glare).all(is_file) {
        let paths = Paths::single(args);
        apart(args, std::slice::from_ref(&paths))?;
        return Ok(Work::Single(paths));
    }
    let frame = |input: &PathBuf| {
        let of = |names: &Option<Names>| names.as_ref().map(|names| names.of(input)).transpose();
        Ok(Paths { input: input.clone(), output: of(&pictures)?, glare: of(&glare)? })
    };
    let frames = args.photos().iter().map(frame).collect::<Result<Vec<_>>>()?;
    apart(args, &frames)?;
    pictures.iter().chain(&glare).try_for_each(|names| room(names.place()))?;
    for path in frames.iter().flat_map(Paths::pictures) {
        photo::check_name(path)?;
        if path.is_file() && !args.force {
            return Err(Error::Exists { path: path.clone() });
        }
    }
    if let Some(path) = &args.output_options.report {
        target::check(path, args.force)?;
    }
    let place = pictures.as_ref().or(glare.as_ref()).map(|names| names.place().to_owned());
    Ok(Work::Sequence(Sequence { frames, place }))
}

/// A name without fields that many outputs are to share, as the folder that it can only be.
fn folder(given: &Path, option: &str) -> Result<Names> {
    if given.is_file() {
        let reason = format!("it is a file; for a sequence, {option} needs a folder or a pattern");
        return Err(Error::write(given, reason));
    }
    if given.extension().is_some() {
        return Err(Error::Usage(format!(
            "{} is one file; for a sequence, {option} needs a folder, as out/, or a pattern, as out.####.exr or {{name}}.png",
            given.display()
        )));
    }
    Ok(Names::folder(given))
}

/// Whether a folder is there, or can be made.
pub(in crate::cli) fn room(folder: &Path) -> Result<()> {
    if folder.is_dir() {
        return Ok(());
    }
    if folder.exists() {
        return Err(Error::write(folder, "it is a file, not a folder"));
    }
    let parent = folder.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
    if parent.is_dir() { Ok(()) } else { Err(Error::write(folder, format!("there is no folder {}", parent.display()))) }
}

/// Whether every output is a file of its own, and nothing that is read. Only a picture may replace the photo that it was
/// made of.
fn apart(args: &Args, frames: &[Paths]) -> Result<()> {
    // By which frame each file is made, and whether it is its picture; by none, the report.
    let mut makers: HashMap<Identity, Option<(usize, bool)>> = HashMap::new();
    let report = args.output_options.report.as_deref();
    if let Some(report) = report.and_then(Identity::of) {
        makers.insert(report, None);
    }
    let input = |index: usize| frames[index].input.display();
    for (index, frame) in frames.iter().enumerate() {
        for path in frame.pictures() {
            let maker = (index, Some(path) == frame.output.as_ref());
            let Some(other) = Identity::of(path).and_then(|file| makers.insert(file, Some(maker))) else { continue };
            let (path, this) = (path.display(), input(index));
            return Err(Error::Usage(match other {
                Some((other, _)) if other != index => format!("{} and {this} would both become {path}", input(other)),
                _ => format!("--output, --glare and --report need a file each, and {path} would be two of them"),
            }));
        }
    }
    let maker = |path: &Path| Identity::of(path).and_then(|file| makers.get(&file).copied());
    for (index, frame) in frames.iter().enumerate() {
        let this = frame.input.display();
        match maker(&frame.input) {
            Some(Some((maker, _))) if maker != index => {
                return Err(Error::Usage(format!("the output of {} would replace {this}, a photo too", input(maker))));
            }
            Some(Some((_, false))) => return Err(Error::Usage(format!("--glare would replace {this}, the photo"))),
            Some(None) => return Err(Error::Usage(format!("--report would replace {this}, a photo"))),
            _ => {}
        }
    }
    for path in args.scene.files().into_iter().chain(args.veil.files().chain(&args.surroundings.environment).cloned()) {
        let option = match maker(&path) {
            None => continue,
            Some(None) => "--report",
            Some(Some((_, true))) => "--output",
            Some(Some((_, false))) => "--glare",
        };
        return Err(Error::Usage(format!("{option} would replace {}, which the scene is read from", path.display())));
    }
    Ok(())
}
