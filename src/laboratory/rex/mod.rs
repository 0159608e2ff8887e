//! The research prototype's experiments, each by a name.
//!
//! "rex" is the framework that the prototype's plug-ins were written for. An experiment here is one file with its
//! parameters, `Args`, whose defaults are those of the prototype's notes, and `run`, which computes and draws. It
//! brings back a [`Report`]: figures with their numbers, tables and measured errors; [`Book`] writes these as files
//! with a page around them.
//!
//! To add one: the file, its `mod` line, and its line in `experiments!`.

mod benchmark;
mod book;
pub mod command;
mod cosine_2d;
mod fourier_1d;
mod fourier_1d_gpu;
mod gaussian_2d;
mod lab;
mod lookup;
mod normalize;
mod page;
mod parabola_1d;
mod parabola_2d;
mod paraboloid_bessel;
mod plane;
mod report;

use crate::chance;
pub use crate::chart;
pub use book::Book;
pub use lab::Lab;
pub use report::{Field, Figure, Numbers, Report, Table};

use clap::{Command, FromArgMatches as _, Subcommand};

use crate::Result;

/// Makes the enum of all experiments: a variant for each, with its parameters, and how to run it.
macro_rules! experiments {
    ($($name:literal => $variant:ident($module:ident)),* $(,)?) => {
        /// Every experiment, with its parameters.
        #[derive(Debug, Clone, Subcommand)]
        pub enum Experiment {
            // A doc here would be the help; that is the parameters' own.
            $(#[allow(missing_docs)] #[command(name = $name)] $variant($module::Args),)*
        }

        impl Experiment {
            /// Its name on the command line.
            pub fn name(&self) -> &'static str {
                match self {
                    $(Self::$variant(_) => $name,)*
                }
            }

            /// Runs it.
            ///
            /// # Errors
            /// [`crate::Error::NoContext`] and [`crate::Error::Gl`] from one that draws with OpenGL;
            /// [`crate::Error::Usage`] for parameters that do not go together.
            pub fn run(&self, lab: &mut Lab) -> Result<Report> {
                let report = match self {
                    $(Self::$variant(args) => $module::run(lab, args),)*
                };
                report.map(|report| report.named(self.name()))
            }
        }
    };
}

// In the order in which `all` runs and shows them.
experiments! {
    "parabola-1d" => Parabola1d(parabola_1d),
    "fourier-1d" => Fourier1d(fourier_1d),
    "fourier-1d-gpu" => Fourier1dGpu(fourier_1d_gpu),
    "paraboloid-bessel" => ParaboloidBessel(paraboloid_bessel),
    "parabola-2d" => Parabola2d(parabola_2d),
    "cosine-2d" => Cosine2d(cosine_2d),
    "gaussian-2d" => Gaussian2d(gaussian_2d),
    "normalize" => Normalize(normalize),
    "benchmark" => Benchmark(benchmark),
    "lookup" => Lookup(lookup),
}

impl Experiment {
    /// Name and one-line description of each.
    pub fn names() -> Vec<(String, String)> {
        let about = |command: &Command| command.get_about().map(ToString::to_string).unwrap_or_default();
        commands().get_subcommands().map(|command| (command.get_name().to_owned(), about(command))).collect()
    }

    /// All of them, each with its defaults; `as_printed` for those that can run the notes' own slips.
    pub fn all(as_printed: bool) -> Vec<Self> {
        let commands = commands();
        let one = |command: &Command| {
            let knows = command.get_arguments().any(|argument| argument.get_long() == Some("as-printed"));
            let flag = (as_printed && knows).then_some("--as-printed");
            let arguments = [command.get_name()].into_iter().chain(flag);
            let matches = commands.clone().try_get_matches_from(arguments);
            matches.and_then(|matches| Self::from_arg_matches(&matches)).expect("every parameter has a default")
        };
        commands.get_subcommands().map(one).collect()
    }
}

fn commands() -> Command {
    Experiment::augment_subcommands(Command::new("rex").no_binary_name(true))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_experiment_has_defaults_and_a_description() {
        let names = Experiment::names();
        assert_eq!(Experiment::all(false).len(), names.len());
        assert_eq!(Experiment::all(true).len(), names.len());
        for (name, about) in names {
            assert!(name.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-'), "{name}");
            assert!(about.len() > 10, "{name} says what it is: {about:?}");
        }
    }
}
