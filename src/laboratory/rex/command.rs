//! `vglare rex`: the research prototype's experiments.

use std::path::PathBuf;

use super::{Book, Experiment, Lab, Report};
use crate::Result;
use crate::options::BackendChoice;
use crate::terminal::progress::Progress;
use crate::terminal::stdout;

/// Run the research prototype's experiments again, and see them
///
/// "rex" is the framework that vglare's prototype was written for. Each experiment computes what the prototype's notes
/// describe and writes a page with figures, their numbers and the measured errors. By default the mathematics are
/// right; with --as-printed, experiments that know it run the notes' formulas as they stand, slips included, beside
/// the right ones.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES, subcommand_value_name = "NAME", subcommand_help_heading = "Experiments")]
pub struct Args {
    #[command(subcommand)]
    what: What,

    /// The folder to write to; by default rex-NAME here
    #[arg(short, long, value_name = "FOLDER", global = true)]
    output: Option<PathBuf>,

    /// Write into a folder even if it holds other files
    #[arg(long, global = true)]
    force: bool,

    /// Where OpenGL comes from; auto takes the first that gives OpenGL 4.3
    #[arg(long, value_enum, default_value_t = BackendChoice::Auto, global = true)]
    backend: BackendChoice,

    /// Print nothing but errors
    #[arg(short, long, global = true)]
    quiet: bool,
}

#[derive(Debug, clap::Subcommand)]
enum What {
    /// Say which experiments there are
    List,
    /// Run every experiment with its defaults
    All {
        /// Run the notes' formulas as they stand, where an experiment can
        #[arg(long)]
        as_printed: bool,
    },
    #[command(flatten)]
    One(Experiment),
}

const EXAMPLES: &str = "\
Examples:
  vglare rex list                         Which experiments are there?
  vglare rex parabola-1d                  One of them, into the folder rex-parabola-1d
  vglare rex parabola-1d --degree 100 -o parabola
  vglare rex all -o experiments           All of them, into one page: experiments/index.html

A folder that an earlier run has written is written anew; files of other experiments stay in it.";

/// Runs what was asked for and writes it.
///
/// # Errors
///
/// [`crate::Error::Occupied`] where the folder holds other files; [`crate::Error::Write`] where a file cannot be
/// written; [`crate::Error::NoContext`] without OpenGL 4.3 in an experiment that needs it; and those of
/// [`Experiment::run`].
pub fn run(args: &Args) -> Result<()> {
    let experiments = match &args.what {
        What::List => return list(),
        What::All { as_printed } => Experiment::all(*as_printed),
        What::One(experiment) => vec![experiment.clone()],
    };
    let name = match &experiments[..] {
        [one] => one.name(),
        _ => "all",
    };
    let folder = args.output.clone().unwrap_or_else(|| PathBuf::from(format!("rex-{name}")));
    let mut book = Book::create(&folder, args.force)?;
    let mut lab = Lab::new(args.backend.backends());
    let progress = Progress::start(args.quiet);
    let mut reports = Vec::new();
    for (index, experiment) in experiments.iter().enumerate() {
        progress.say(format!("{} ({} of {})", experiment.name(), index + 1, experiments.len()));
        let report = experiment.run(&mut lab)?;
        book.add(&report, lab.info())?;
        // Its pictures are on disk now.
        reports.push(Report { figures: Vec::new(), ..report });
    }
    drop(progress);
    if args.quiet { Ok(()) } else { summary(&reports, &book) }
}

fn list() -> Result<()> {
    let names = Experiment::names();
    let width = names.iter().map(|(name, _)| name.len()).max().unwrap_or(0);
    stdout::print(|out| names.iter().try_for_each(|(name, about)| writeln!(out, "{name:width$}  {about}")))
}

fn summary(reports: &[Report], book: &Book) -> Result<()> {
    stdout::print(|out| {
        for report in reports {
            writeln!(out, "{}: {}", report.name, report.title)?;
            for (what, value) in &report.measures {
                writeln!(out, "  {what}: {value}")?;
            }
        }
        writeln!(out, "wrote {}", book.index().display())
    })
}
