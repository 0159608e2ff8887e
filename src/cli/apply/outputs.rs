//! Which files a photo becomes, and whether they may be written.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use super::inputs::Inputs;
use super::names::Names;
use super::{Args, OutputArgs};
use crate::chart::Kind;
use crate::cli::encoding::EncodingArgs;
use crate::photo::{self, Depth, Photo, WriteOptions};
use crate::shot::Frames;
use crate::target::{self, Identity};
use crate::{Error, Result};

/// The option that names a photo's picture, which alone may replace it.
const PICTURE: &str = "--output";

/// A photo and the files that it becomes.
#[derive(Debug, Clone, PartialEq)]
pub struct Paths {
    pub input: PathBuf,
    pub output: Option<PathBuf>,
    pub glare: Option<PathBuf>,
    /// A drawing.
    pub map: Option<PathBuf>,
}

/// Several photos, and where their pictures go.
pub struct Sequence {
    pub frames: Vec<Paths>,
    /// What was asked for and is not there, by pattern; it is left out where --keep-going says so.
    pub missing: Vec<(PathBuf, Frames)>,
    /// The folder that the pictures go to, or else the glare alone or its maps; none where there is a report only.
    pub place: Option<PathBuf>,
}

impl Sequence {
    /// How many photos were asked for, be they there or not.
    pub fn asked(&self) -> usize {
        self.frames.len() + self.missing.iter().map(|(_, frames)| frames.len()).sum::<usize>()
    }
}

impl Paths {
    /// Those of a single photo, as they were given.
    fn single(args: &Args) -> Self {
        let OutputArgs { glare, map, .. } = &args.output_options;
        Self { input: args.photos()[0].clone(), output: args.output.clone(), glare: glare.clone(), map: map.clone() }
    }

    /// All files that the photo becomes, each with the option that names it.
    fn options(&self) -> impl Iterator<Item = (&'static str, &PathBuf)> {
        let all = [(PICTURE, &self.output), ("--glare", &self.glare), ("--map", &self.map)];
        all.into_iter().filter_map(|(option, path)| Some((option, path.as_ref()?)))
    }

    /// All files that the photo becomes.
    pub fn files(&self) -> impl Iterator<Item = &PathBuf> {
        self.options().map(|(_, path)| path)
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
        self.map.iter().chain(&args.output_options.report).try_for_each(|path| target::check(path, args.overwrites()))
    }

    /// Makes the folders of the results.
    ///
    /// # Errors
    /// [`Error::Write`] where the system refuses.
    pub fn make_folders(&self) -> Result<()> {
        self.files().filter_map(|path| path.parent()).try_for_each(target::make_folder)
    }
}

/// How the picture is written.
pub fn picture_options(args: &Args) -> WriteOptions {
    let OutputArgs { encoding, glare, .. } = &args.output_options;
    EncodingArgs::beside(encoding.picture(args.overwrites()), args.output.as_deref(), glare.as_deref())
}

/// How the glare is written.
pub fn glare_options(args: &Args, path: &Path) -> WriteOptions {
    let options = args.output_options.encoding.glare(path, args.output.is_some(), args.overwrites());
    EncodingArgs::beside(options, Some(path), args.output.as_deref())
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
/// Those of [`Inputs::new`]; [`Error::MissingFrames`]; [`Error::Usage`] where the names do not give each photo a file of its own, or
/// one that is read would be replaced; [`Error::Write`] for a name that cannot be written, [`Error::Exists`] where a file is there and must not be replaced:
/// before anything is read.
pub fn work(args: &Args) -> Result<Work> {
    let inputs = Inputs::new(args.photos(), args.sequence.frames.as_ref())?;
    if !inputs.missing.is_empty() && (inputs.photos.is_empty() || !args.sequence.keep_going) {
        return Err(Error::MissingFrames { missing: inputs.missing });
    }
    of(args, inputs, args.overwrites())
}

/// The outputs of these photos, be they there or not.
///
/// # Errors
/// Those of [`work`], but for photos that are missing.
pub fn of(args: &Args, inputs: Inputs, overwrites: bool) -> Result<Work> {
    let Inputs { photos, missing } = inputs;
    let is_shot = args.sequence.resume || Inputs::is_shot(args.photos(), args.sequence.frames.as_ref());
    let several = photos.len() > 1;
    let names = |given: Option<&Path>, option: &str| {
        let named = |given: &Path| match Names::new(given) {
            Some(names) => Ok(names),
            None if several && !target::is_standard(given) => folder(given, option),
            None => Ok(Names::File(given.to_owned())),
        };
        given.map(named).transpose()
    };
    let pictures = names(args.output.as_deref(), "--output")?;
    let glare = names(args.output_options.glare.as_deref(), "--glare")?;
    let maps = names(args.output_options.map.as_deref(), "--map")?;
    let all = || pictures.iter().chain(&glare).chain(&maps);
    let is_file = |names: &Names| matches!(names, Names::File(_));
    if !several && !is_shot && all().all(is_file) {
        let paths = Paths::single(args);
        holds_layers(args, paths.output.as_deref())?;
        paths.map.iter().try_for_each(|path| Kind::of(path).map(drop))?;
        apart(args, std::slice::from_ref(&paths))?;
        return Ok(Work::Single(paths));
    }
    let given = all().filter_map(|names| if let Names::File(path) = names { Some(path) } else { None });
    if args.photos().iter().chain(given).chain(&args.output_options.report).any(|path| target::is_standard(path)) {
        return Err(Error::Usage("- is for one photo: it neither has a name nor holds several".into()));
    }
    let frame = |input: &PathBuf| {
        let of = |names: &Option<Names>| names.as_ref().map(|names| names.of(input)).transpose();
        Ok(Paths { input: input.clone(), output: of(&pictures)?, glare: of(&glare)?, map: of(&maps)? })
    };
    let frames = photos.iter().map(frame).collect::<Result<Vec<_>>>()?;
    apart(args, &frames)?;
    all().try_for_each(|names| room(names.place()))?;
    for frame in &frames {
        let picture = frame.output.iter().map(|path| (path, picture_options(args)));
        let glare = frame.glare.iter().map(|path| (path, glare_options(args, path)));
        picture.chain(glare).try_for_each(|(path, options)| photo::check_name(path, options.format))?;
        holds_layers(args, frame.output.as_deref())?;
        frame.map.iter().try_for_each(|path| Kind::of(path).map(drop))?;
        if let Some(path) = frame.files().find(|path| path.is_file() && !overwrites) {
            return Err(Error::Exists { path: path.clone() });
        }
    }
    if let Some(path) = &args.output_options.report {
        target::check(path, overwrites)?;
    }
    let place = all().next().map(|names| names.place().to_owned());
    Ok(Work::Sequence(Sequence { frames, missing, place }))
}

/// Whether the picture's file can hold the layers that are asked for.
fn holds_layers(args: &Args, output: Option<&Path>) -> Result<()> {
    let Some(path) = output.filter(|_| args.output_options.layers) else { return Ok(()) };
    // No other format knows half floats.
    if photo::holds(path, args.output_options.encoding.format(), Depth::Half) {
        return Ok(());
    }
    Err(Error::Usage(format!("--layers: {} is no .exr, and other formats hold no layers", path.display())))
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
    // By which frame each file is made, and for which option; by none, the report.
    let mut makers: HashMap<Identity, Option<(usize, &str)>> = HashMap::new();
    let report = args.output_options.report.as_deref();
    if let Some(report) = report.and_then(Identity::of) {
        makers.insert(report, None);
    }
    let input = |index: usize| frames[index].input.display();
    for (index, frame) in frames.iter().enumerate() {
        for (option, path) in frame.options() {
            let maker = (index, option);
            let Some(other) = Identity::of(path).and_then(|file| makers.insert(file, Some(maker))) else { continue };
            let (path, this) = (path.display(), input(index));
            return Err(Error::Usage(match other {
                Some((other, _)) if other != index => format!("{} and {this} would both become {path}", input(other)),
                _ => format!("--output, --glare, --map and --report need a file each, and {path} would be two of them"),
            }));
        }
    }
    let maker = |path: &Path| Identity::of(path).and_then(|file| makers.get(&file).copied());
    for (index, frame) in frames.iter().enumerate() {
        let this = frame.input.display();
        if target::is_standard(&frame.input) {
            continue;
        }
        match maker(&frame.input) {
            Some(Some((maker, _))) if maker != index => {
                return Err(Error::Usage(format!("the output of {} would replace {this}, a photo too", input(maker))));
            }
            Some(Some((_, option))) if option != PICTURE => {
                return Err(Error::Usage(format!("{option} would replace {this}, the photo")));
            }
            Some(Some(_)) if args.sequence.resume => {
                let reason = "nothing would tell a photo with its glare from one without";
                return Err(Error::Usage(format!("--resume cannot replace {this}, the photo: {reason}")));
            }
            Some(None) => return Err(Error::Usage(format!("--report would replace {this}, a photo"))),
            _ => {}
        }
    }
    for path in args.scene.files().into_iter().chain(args.veil.files().chain(&args.surroundings.environment).cloned()) {
        let option = match maker(&path) {
            None => continue,
            Some(None) => "--report",
            Some(Some((_, option))) => option,
        };
        return Err(Error::Usage(format!("{option} would replace {}, which the scene is read from", path.display())));
    }
    Ok(())
}
