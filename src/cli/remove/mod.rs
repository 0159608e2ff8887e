//! `vglare remove`: a veil taken away from a photo.

mod model;
mod report;
mod summary;

use std::path::{Path, PathBuf};

use clap::ValueEnum;

use super::apply::ProofArgs;
use super::encoding::EncodingArgs;
use super::luminance::Extent;
use crate::job::{self, Removed, Removing, Stages, Step, Watch as _};
use crate::look::Look;
use crate::options::ReadArgs;
use crate::options::numbers::{positive, tolerance};
use crate::photo::{self, Made, Photo, ToneMap, WriteOptions};
use crate::terminal::progress::Progress;
use crate::{Error, Result, target};

use model::ModelArgs;
use report::{Luminance, Report};

/// Take a veil away from a photo
///
/// Finds the photo of which the veil makes the given one: of what `vglare apply --veil PSF --lens none` does with the same options, the
/// inverse. The answer comes with a bound of how far it is from the clean photo at every sample, relative to the brightest of its colour,
/// and is veiled again and compared with the photo at some pixels. Where nothing can be proved, or not to the tolerance, nothing is written. Ghosts
/// are not looked at, and stay. It needs no OpenGL.
///
/// Light that was clipped cannot be recovered, nor the veil that it made elsewhere be taken away: --mask shows where. Noise grows by at most
/// the factors that are told.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// The photo: OpenEXR, Radiance HDR, PFM, TIFF, PNG, JPEG or JPEG XL; - for standard input
    #[arg(value_name = "INPUT")]
    input: PathBuf,

    /// The clean picture: .exr .hdr .pfm .tif .tiff .png .jpg .jpeg; may be left out where --report is given
    #[arg(short, long, required_unless_present = "report")]
    output: Option<PathBuf>,

    /// Replace files that exist
    #[arg(long)]
    force: bool,

    /// Say nothing but errors and warnings
    #[arg(short, long)]
    quiet: bool,

    #[command(flatten)]
    reading: ReadArgs,

    #[command(flatten)]
    model: ModelArgs,

    /// Largest error at any sample, relative to the clean photo's brightest sample of the same colour
    #[arg(long, value_name = "E", default_value_t = 1e-4, allow_hyphen_values = true, value_parser = tolerance, help_heading = "Accuracy")]
    tolerance: f64,

    /// Where the tolerance cannot be had, take the lowest that can, instead of failing
    #[arg(long, help_heading = "Accuracy")]
    allow_floor: bool,

    #[command(flatten)]
    proof: ProofArgs,

    /// From which value of its brightest channel on a pixel is clipped, above 0, in linear light [default: a
    /// display's white, in pictures for displays; else nothing is]
    #[arg(long, value_name = "VALUE", allow_hyphen_values = true, value_parser = positive)]
    clip: Option<f64>,

    /// What becomes of samples that are negative without the veil
    #[arg(long, value_enum, default_value_t = NegativeArg::Keep)]
    negative: NegativeArg,

    /// Write which pixels are clipped, and cannot be recovered, in white on black
    #[arg(long, value_name = "FILE", help_heading = "Output")]
    mask: Option<PathBuf>,

    /// Write what was done, how and how exactly, as JSON
    #[arg(long, value_name = "FILE", help_heading = "Output")]
    report: Option<PathBuf>,

    #[command(flatten)]
    encoding: EncodingArgs,
}

const EXAMPLES: &str = "\
Examples:
  vglare remove photo.exr -o clean.exr --veil camera
  vglare remove photo.exr -o clean.exr --veil camera --scatter 0.1 --tolerance 1e-5
  vglare remove photo.exr -o clean.exr --veil cie --age 60 --fov 50
  vglare remove photo.exr -o clean.exr --veil table --table measured.csv --report report.json
  vglare remove photo.exr -o clean.exr --scene look.toml --clip 60000 --mask clipped.png
  vglare remove photo.exr -o clean.exr --preset classic-prime";

/// `--negative`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum NegativeArg {
    /// They stay; formats for displays hold none, and show black
    Keep,
    /// They become 0
    Clamp,
}

impl Args {
    /// The files that are written.
    fn outputs(&self) -> Vec<(&'static str, &Path)> {
        let all = [("--output", &self.output), ("--mask", &self.mask), ("--report", &self.report)];
        all.into_iter().filter_map(|(option, path)| Some((option, path.as_deref()?))).collect()
    }

    /// Whether one of them goes to standard output.
    fn takes_stdout(&self) -> bool {
        self.outputs().into_iter().any(|(_, path)| target::is_standard(path))
    }

    fn removing(&self) -> Removing {
        Removing {
            tolerance: self.tolerance,
            allow_floor: self.allow_floor,
            verify: self.proof.verify,
            clip: self.clip.map(|level| level as f32),
            clamp: self.negative == NegativeArg::Clamp,
        }
    }

    /// Everything that could keep the results from being written, before the work begins.
    fn check(&self, photo: &Photo) -> Result<()> {
        if let Some(path) = &self.output {
            photo::check_target(path, photo, &self.picture_options())?;
        }
        if let Some(path) = &self.mask {
            if self.clip.is_none() && !photo.source.display_referred {
                return Err(Error::Usage(
                    "--mask: nothing says from which value on this photo is clipped: give it by --clip".into(),
                ));
            }
            photo::check_target(path, &photo.companion(vec![[0.0; 4]; photo.pixels.len()]), &self.mask_options())?;
        }
        self.report.as_deref().map_or(Ok(()), |path| target::check(path, self.force))
    }

    fn picture_options(&self) -> WriteOptions {
        EncodingArgs::beside(self.encoding.picture(self.force), self.output.as_deref(), self.mask.as_deref())
    }

    fn mask_options(&self) -> WriteOptions {
        let options = WriteOptions { tone_map: Some(ToneMap::None), ..self.encoding.other(self.force) };
        EncodingArgs::beside(options, self.mask.as_deref(), self.output.as_deref())
    }

    /// Writes the picture and the mask; what a person ought to know of it.
    fn write(&self, removed: &mut Removed) -> Result<()> {
        if let Some(path) = &self.mask {
            let white = |&clipped: &bool| [[0.0, 0.0, 0.0, 1.0], [1.0; 4]][usize::from(clipped)];
            let mask = removed.photo.companion(removed.clipped.iter().map(white).collect());
            photo::write(path, &mask, &self.mask_options())?;
        }
        if let Some(path) = &self.output {
            let options = self.picture_options();
            photo::write(path, &removed.photo, &options)?;
            removed.warnings.extend(photo::lost(path, &removed.photo, &options));
        }
        Ok(())
    }
}

/// Takes the veil away.
///
/// # Errors
/// Whatever keeps a picture from being written; nothing is left half-written then.
pub fn run(args: &Args) -> Result<()> {
    let mut inputs = args.model.files();
    inputs.push(args.input.clone());
    // A picture may replace its own photo.
    let own = |option: &str| option == "--output";
    let outputs = args.outputs();
    let scene: Vec<_> = args.model.files();
    let scene: Vec<(&str, &Path)> = scene.iter().map(|path| ("which the veil is read from", &**path)).collect();
    target::spare(&outputs, &scene)?;
    let beside: Vec<_> = outputs.iter().copied().filter(|(option, _)| !own(option)).collect();
    target::spare(&beside, &[("the photo", &args.input)])?;
    let look: Look = args.model.look()?;
    let progress = Progress::start(args.quiet);
    let mut stages = Stages::default();
    progress.step(Step::Reading);
    let photo =
        stages.time("read", || photo::read_with(&args.input, &args.reading.of_white(args.model.white_luminance())))?;
    args.check(&photo)?;
    let facts = photo.facts();
    let scale = photo.luminance_scale();
    let before = scale.as_ref().and_then(|scale| Extent::of(&photo, scale));
    progress.step(Step::Computing);
    let mut removed = job::remove(&look, photo, args.removing(), &mut stages)?;
    removed.warnings.extend(model::ghosts_stay(&look));
    // A look, as it is taken away.
    removed.photo.source.made = Some(Made::new(&format!("# vglare remove\n{}", look.made().settings)).into());
    progress.step(Step::Writing);
    let written = {
        let stages = &mut stages;
        stages.time("write", || args.write(&mut removed))
    };
    written?;
    let luminance = scale.map(|scale| Luminance { photo: before, clean: Extent::of(&removed.photo, &scale), scale });
    let report = Report { args, facts: &facts, removed: &removed, stages: &stages, luminance: luminance.as_ref() };
    if let Some(path) = &args.report {
        target::write_json(path, &report.json(), args.force)?;
    }
    drop(progress);
    summary::print(&report)?;
    match &removed.removal {
        Some(removal) if args.proof.strict => removal.error.check(),
        _ => Ok(()),
    }
}
