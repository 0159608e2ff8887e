//! Which files a photo becomes, and whether they may be written.

use std::collections::HashMap;
use std::fs;
use std::path::{Path, PathBuf};

use super::Args;
use super::names::Names;
use crate::photo::{self, Photo, WriteOptions};
use crate::{Error, Result, target};

/// A photo and the files that it becomes.
#[derive(Debug, Clone, PartialEq)]
pub struct Paths {
    pub input: PathBuf,
    pub output: PathBuf,
    pub glare: Option<PathBuf>,
}

/// Several photos, and where their pictures go.
pub struct Sequence {
    pub frames: Vec<Paths>,
    /// The folder that the pictures go to.
    pub place: PathBuf,
}

impl Paths {
    /// Those of a single photo, as they were given.
    pub fn single(args: &Args) -> Self {
        let glare = args.output_options.glare.clone();
        Self { input: args.inputs[0].clone(), output: args.output.clone(), glare }
    }

    /// Everything that could keep the results from being written, before the work begins.
    ///
    /// # Errors
    /// Those of [`photo::check_target`] and [`target::check`], and [`Error::Usage`] where two results would be one file.
    pub fn check(&self, args: &Args, photo: &Photo) -> Result<()> {
        let report = args.output_options.report.as_ref();
        photo::check_target(&self.output, photo, &picture_options(args))?;
        if let Some(path) = &self.glare {
            let glare = photo.companion(vec![[0.0; 4]; photo.frame.window.pixels()]);
            photo::check_target(path, &glare, &glare_options(args))?;
        }
        if let Some(path) = report {
            target::check(path, args.force)?;
        }
        let paths = [Some(&self.output), self.glare.as_ref(), report];
        let paths: Vec<_> = paths.into_iter().flatten().collect();
        if (1..paths.len()).any(|k| paths[..k].contains(&paths[k])) {
            return Err(Error::Usage("--output, --glare and --report need a file each".into()));
        }
        Ok(())
    }

    /// Makes the folders of the results.
    ///
    /// # Errors
    /// [`Error::Write`] where the system refuses.
    pub fn make_folders(&self) -> Result<()> {
        for path in [Some(&self.output), self.glare.as_ref()].into_iter().flatten() {
            let Some(folder) = path.parent().filter(|folder| !folder.as_os_str().is_empty()) else { continue };
            match fs::create_dir(folder) {
                Err(error) if !folder.is_dir() => return Err(Error::write(folder, error)),
                _ => {}
            }
        }
        Ok(())
    }
}

/// How the picture is written.
pub fn picture_options(args: &Args) -> WriteOptions {
    let outputs = &args.output_options;
    WriteOptions {
        depth: outputs.depth.map(Into::into),
        exposure: outputs.exposure,
        tone_map: outputs.tonemap.map(Into::into),
        overwrite: args.force,
    }
}

/// How the glare is written: it is to be measured, not looked at, so always as exact as the format allows.
pub fn glare_options(args: &Args) -> WriteOptions {
    WriteOptions { depth: None, exposure: 0.0, tone_map: None, overwrite: args.force }
}

/// The photos of a sequence, with their outputs; none where a single photo becomes a single file.
///
/// # Errors
/// [`Error::Usage`] where the names do not give each photo a file of its own, [`Error::Write`] for a name that cannot be
/// written, [`Error::Exists`] where a file is there and must not be replaced: before anything is read.
pub fn sequence(args: &Args) -> Result<Option<Sequence>> {
    let several = args.inputs.len() > 1;
    let names = match Names::new(&args.output) {
        Some(names) => names,
        None if several => folder(&args.output, "--output")?,
        None => return Ok(None),
    };
    let glare = args.output_options.glare.as_deref();
    let glare = glare.map(|given| Names::new(given).map_or_else(|| folder(given, "--glare"), Ok)).transpose()?;
    let frame = |input: &PathBuf| {
        let glare = glare.as_ref().map(|glare| glare.of(input)).transpose()?;
        Ok(Paths { input: input.clone(), output: names.of(input)?, glare })
    };
    let frames = args.inputs.iter().map(frame).collect::<Result<Vec<_>>>()?;
    apart(args, &frames)?;
    [Some(&names), glare.as_ref()].into_iter().flatten().try_for_each(|names| room(names.place()))?;
    for path in frames.iter().flat_map(|frame| [Some(&frame.output), frame.glare.as_ref()]).flatten() {
        photo::check_name(path)?;
        if path.exists() && !args.force {
            return Err(Error::Exists { path: path.clone() });
        }
    }
    if let Some(path) = &args.output_options.report {
        target::check(path, args.force)?;
    }
    Ok(Some(Sequence { frames, place: names.place().to_owned() }))
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
fn room(folder: &Path) -> Result<()> {
    if folder.is_dir() {
        return Ok(());
    }
    if folder.exists() {
        return Err(Error::write(folder, "it is a file, not a folder"));
    }
    let parent = folder.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
    if parent.is_dir() { Ok(()) } else { Err(Error::write(folder, format!("there is no folder {}", parent.display()))) }
}

/// Whether every output is a file of its own, and no other frame's photo.
fn apart(args: &Args, frames: &[Paths]) -> Result<()> {
    // By which frame each file is made; by none, the report.
    let mut makers: HashMap<PathBuf, Option<usize>> = HashMap::new();
    if let Some(report) = &args.output_options.report {
        makers.insert(real(report), None);
    }
    let input = |index: usize| frames[index].input.display();
    for (index, frame) in frames.iter().enumerate() {
        for path in [Some(&frame.output), frame.glare.as_ref()].into_iter().flatten() {
            let Some(maker) = makers.insert(real(path), Some(index)) else { continue };
            let (path, this) = (path.display(), input(index));
            return Err(Error::Usage(match maker {
                Some(other) if other != index => format!("{} and {this} would both become {path}", input(other)),
                _ => format!("--output, --glare and --report need a file each, and {path} would be two of them"),
            }));
        }
    }
    for (index, frame) in frames.iter().enumerate() {
        let this = frame.input.display();
        match makers.get(&real(&frame.input)) {
            Some(&Some(maker)) if maker != index => {
                return Err(Error::Usage(format!("the output of {} would replace {this}, a photo too", input(maker))));
            }
            Some(None) => return Err(Error::Usage(format!("--report would replace {this}, a photo"))),
            _ => {}
        }
    }
    Ok(())
}

/// A path by which the same file is always the same, whether it is there or not.
fn real(path: &Path) -> PathBuf {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let whole = || fs::canonicalize(folder).ok().and_then(|folder| Some(folder.join(path.file_name()?)));
    fs::canonicalize(path).ok().or_else(whole).unwrap_or_else(|| path.to_owned())
}
