//! The program: its commands, its help, and how it starts and ends.

#[cfg(all(feature = "laboratory", feature = "window"))]
mod live;
mod shell;

use clap::error::{ContextKind, ContextValue};
use clap::{Parser, Subcommand};

use vglare::cli::{animate, apply, info, job, lights, plan, presets, remove};
#[cfg(feature = "laboratory")]
use vglare::laboratory::{bench, calibrate, harmonics, index, lens, psf, rex, tradeoff};
#[cfg(feature = "window")]
use vglare::viewer::command as view;
use vglare::{Result, panics, terminal};

/// Veiling glare for HDR photographs, to a stated tolerance
///
/// vglare finds the lights in a photo, turns each into the faint, wide ghosts that a lens makes of it, and lays them
/// over the picture. It computes in scene-linear light on OpenGL 4.3, with or without a graphics card or a display.
#[derive(Debug, Parser)]
#[command(name = "vglare", version, arg_required_else_help = true, after_help = EXIT_CODES, max_term_width = 100)]
pub struct Cli {
    #[command(subcommand)]
    command: Command,
}

const EXIT_CODES: &str = "\
Exit codes:
  0  done
  1  a file could not be read or written, or the driver failed
  2  the command line is wrong
  3  the tolerance is below what can be had, or was missed under --strict, or a bench's bar was;
     or the budget is below what the cheapest plan costs
  4  there is no OpenGL 4.3, or no display to open a window on

`vglare COMMAND --help` says more of each command, with examples.";

#[derive(Debug, Subcommand)]
enum Command {
    Apply(Box<apply::Args>),
    Remove(Box<remove::Args>),
    Animate(Box<animate::Args>),
    Job(job::Args),
    #[cfg(feature = "window")]
    View(view::Args),
    Plan(Box<plan::Args>),
    Lights(lights::Args),
    Presets(presets::Args),
    #[cfg(feature = "laboratory")]
    Lens(Box<lens::Args>),
    #[cfg(feature = "laboratory")]
    Psf(Box<psf::Args>),
    #[cfg(feature = "laboratory")]
    Measure(Box<index::Args>),
    #[cfg(feature = "laboratory")]
    Harmonics(Box<harmonics::Args>),
    #[cfg(feature = "laboratory")]
    Bench(bench::Args),
    #[cfg(feature = "laboratory")]
    Calibrate(calibrate::Args),
    #[cfg(feature = "laboratory")]
    Tradeoff(Box<tradeoff::command::Args>),
    #[cfg(feature = "laboratory")]
    Rex(rex::command::Args),
    Info(info::Args),
    Completions(shell::CompletionsArgs),
    Man(shell::ManArgs),
}

/// The error without the tip to put `--` before an option that is mistyped, which would make it a photo's name.
fn without_dashes(mut error: clap::Error) -> clap::Error {
    if let Some(ContextValue::StyledStrs(tips)) = error.remove(ContextKind::Suggested) {
        let tips: Vec<_> = tips.into_iter().filter(|tip| !tip.to_string().contains(" as a value, use ")).collect();
        if !tips.is_empty() {
            error.insert(ContextKind::Suggested, ContextValue::StyledStrs(tips));
        }
    }
    error
}

/// The command line.
///
/// # Errors
/// The code to exit with, where there is nothing to run: it is wrong, or asks for help, and that has been told.
pub fn parse() -> std::result::Result<Cli, u8> {
    Cli::try_parse().map_err(without_dashes).map_err(|error| {
        // clap paints what it prints, and leaves what was typed as it is.
        let typed = std::env::args_os().map(|word| word.to_string_lossy().into_owned());
        let safe = typed.into_iter().all(|word| terminal::is_printable(&word));
        if safe || !error.use_stderr() {
            let _ = error.print();
        } else {
            terminal::print_error(&error);
        }
        error.exit_code() as u8
    })
}

/// Runs the command. What panics becomes an error.
///
/// # Errors
/// Those of the command; [`vglare::Error::exit_code`] says what to exit with.
pub fn run(cli: Cli) -> Result<()> {
    terminal::begin();
    panics::caught(|| command(cli.command))
}

fn command(command: Command) -> Result<()> {
    if !matches!(command, Command::Presets(_) | Command::Completions(_) | Command::Man(_)) {
        terminal::start_threads()?;
    }
    match command {
        Command::Apply(args) => apply::run(&args),
        Command::Remove(args) => remove::run(&args),
        Command::Animate(args) => animate::run(&args),
        Command::Job(args) => job::run(&args),
        #[cfg(feature = "window")]
        Command::View(args) => view::run(&args),
        Command::Plan(args) => plan::run(&args),
        Command::Lights(args) => lights::run(&args),
        Command::Presets(args) => presets::run(&args),
        #[cfg(feature = "laboratory")]
        Command::Lens(args) => lens::run(&args),
        #[cfg(feature = "laboratory")]
        Command::Psf(args) => psf::run(&args),
        #[cfg(feature = "laboratory")]
        Command::Measure(args) => index::run(&args),
        #[cfg(feature = "laboratory")]
        Command::Harmonics(args) => harmonics::run(&args),
        #[cfg(feature = "laboratory")]
        Command::Bench(args) => bench::run(&args, window),
        #[cfg(feature = "laboratory")]
        Command::Calibrate(args) => calibrate::run(&args),
        #[cfg(feature = "laboratory")]
        Command::Tradeoff(args) => tradeoff::command::run(&args),
        #[cfg(feature = "laboratory")]
        Command::Rex(args) => rex::command::run(&args),
        Command::Info(args) => info::run(&args),
        Command::Completions(args) => shell::completions(&args),
        Command::Man(args) => shell::man(&args),
    }
}

/// What `bench --viewer` measures.
#[cfg(all(feature = "laboratory", feature = "window"))]
use live::window;

#[cfg(all(feature = "laboratory", not(feature = "window")))]
fn window(_: &std::rc::Rc<vglare::gpu::Device>, _: [u32; 2], _: &mut bench::Report) -> Result<()> {
    Err(vglare::Error::Usage("--viewer measures the window, and this vglare was built without it".into()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory as _;

    #[test]
    fn the_parser_is_sound() {
        Cli::command().debug_assert();
    }
}
