//! `vglare job`: a shot as a job for a farm that is there already.

mod given;
mod needs;
mod openjd;
mod slurm;

use std::ffi::OsStr;
use std::path::PathBuf;

use crate::terminal::{stderr, stdout};
use crate::{Error, Result, target};

use given::Given;
use needs::Needs;

/// Write a shot as a job for a render farm
///
/// Writes what a farm's own scheduler takes: a job template of the Open Job Description, which AWS Deadline Cloud and others read, or a
/// batch script for Slurm. Its tasks run `vglare apply` with the options that are given here, on some frames each, with --resume:
/// a task that is started again goes on where it ended, and no frame is done twice. docs/farm.md leads through both.
#[derive(Debug, clap::Args)]
#[command(subcommand_required = true, arg_required_else_help = true)]
pub struct Args {
    #[command(subcommand)]
    farm: Farm,
}

#[derive(Debug, clap::Subcommand)]
enum Farm {
    /// A job template of the Open Job Description (jobtemplate-2023-09)
    ///
    /// A task for each frame; with --chunk one for several, by the extension TASK_CHUNKING, which the scheduler may make more or
    /// fewer. How often a task is tried again is the scheduler's to know: the format has no word for it.
    #[command(after_help = "\
Examples:
  vglare job openjd 'in/s.####.exr' -o 'out/s.####.exr' --frames 1001-1240 --file job.yaml
  vglare job openjd 'in/s.####.exr' -o 'out/s.####.exr' --frames 1001-1240 --file job.yaml --chunk 10 --gpu --preset zoom
  openjd run job.yaml")]
    Openjd(Box<JobArgs>),
    /// A batch script for Slurm, whose array has a task for each --chunk frames
    ///
    /// A task that fails is put into the queue again, twice at most, unless its command line is wrong; one whose node fails is by Slurm.
    #[command(after_help = "\
Examples:
  vglare job slurm 'in/s.####.exr' -o 'out/s.####.exr' --frames 1001-1240 --file job.sh --chunk 10
  sbatch job.sh")]
    Slurm(Box<JobArgs>),
}

/// The job, and the options of `vglare apply` for its frames.
#[derive(Debug, clap::Args)]
struct JobArgs {
    #[command(flatten)]
    apply: Given,

    #[command(flatten)]
    job: JobOptions,
}

#[derive(Debug, clap::Args)]
#[command(next_help_heading = "Job")]
struct JobOptions {
    /// The job's file; --force replaces one that is there
    #[arg(long, value_name = "FILE", required = true)]
    file: PathBuf,

    /// How many frames a task does [default: 1 for openjd; for slurm as many as make 1000 tasks]
    #[arg(long, value_name = "COUNT", value_parser = clap::value_parser!(u32).range(1..))]
    chunk: Option<u32>,

    /// Ask for a graphics card; without it the CPUs render
    #[arg(long)]
    gpu: bool,

    /// Cores for each task [default: one for each half megapixel of the first frame, 2 to 16; 2 beside a graphics card]
    #[arg(long, value_name = "COUNT", value_parser = clap::value_parser!(u32).range(1..))]
    cores: Option<u32>,

    /// Memory for each task in MiB [default: 512, and 256 bytes for each pixel of the first frame; 4096 where none is there yet]
    #[arg(long, value_name = "MIB", value_parser = clap::value_parser!(u32).range(1..))]
    memory: Option<u32>,

    /// What the job is called [default: vglare and the pattern's name]
    #[arg(long, value_name = "NAME", value_parser = title)]
    name: Option<String>,
}

/// All that a job's file says.
struct Job {
    name: String,
    /// Of `vglare`, but for --frames.
    words: Vec<String>,
    frames: crate::shot::Frames,
    chunk: Option<usize>,
    needs: Needs,
    /// The folder that the words' paths are seen from.
    folder: String,
    /// Whether the job's file lies in it.
    is_beside: bool,
}

/// Writes the job.
///
/// # Errors
/// [`Error::Usage`] where the options are none for a shot, or could not be done; those of writing.
pub fn run(args: &Args) -> Result<()> {
    let (args, text): (_, fn(&Job) -> Result<String>) = match &args.farm {
        Farm::Openjd(args) => (args, openjd::text),
        Farm::Slurm(args) => (args, slurm::text),
    };
    let JobOptions { file, chunk, gpu, cores, memory, name } = &args.job;
    target::check(file, args.apply.args.replaces())?;
    let shot = args.apply.args.shot()?;
    let first = shot.first()?;
    let needs = Needs::new(first.map(|photo| photo.pixels.len()), *gpu).given(*cores, *memory);
    let folder = std::env::current_dir().map_err(|error| Error::write(file, error))?;
    let beside = target::folder(file).canonicalize().ok();
    let job = Job {
        name: name.clone().unwrap_or_else(|| format!("vglare {}", shot.name())),
        words: args.apply.words()?,
        frames: shot.frames,
        chunk: chunk.map(|chunk| chunk as usize),
        needs,
        is_beside: beside.is_some() && beside == folder.canonicalize().ok(),
        folder: given::utf8(folder.as_os_str())?,
    };
    target::write_text(file, &text(&job)?, args.apply.args.replaces())?;
    if shot.missing > 0 {
        stderr::warn([format!("{} of {} frames are not there yet", shot.missing, job.frames.len())]);
    }
    let Needs { cores, memory, gpu } = job.needs;
    stdout::print(|out| {
        write!(out, "wrote    {}: {} frames, {cores} cores and {memory} MiB a task", file.display(), job.frames.len())?;
        writeln!(out, "{}", if gpu { ", and a graphics card" } else { "" })
    })
}

/// A line of text that fits into both formats.
fn title(text: &str) -> Result<String, String> {
    let fits = !text.is_empty() && text.len() <= 64 && !text.chars().any(char::is_control);
    let fits = fits && given::utf8(OsStr::new(text)).is_ok();
    if fits { Ok(text.to_owned()) } else { Err("expected a line of 1 to 64 bytes, without \"{{\"".into()) }
}
