//! The options of `vglare apply`, read by its own parser, and put into words again.

use std::ffi::{OsStr, OsString};

use clap::parser::ValueSource;
use clap::{ArgMatches, Command, FromArgMatches};

use crate::cli::apply;
use crate::{Error, Result};

/// What each task says for itself, or what a job decides.
const LEFT_OUT: [&str; 4] = ["inputs", "frames", "force", "resume"];

/// The arguments of `vglare apply` as they are understood, and as they were given.
#[derive(Debug)]
pub struct Given {
    pub args: apply::Args,
    /// The photos.
    inputs: Vec<OsString>,
    /// The others: a word each, as `--depth=half`.
    options: Vec<OsString>,
}

impl Given {
    /// The command line of a task, from `apply` on, but for its frames.
    ///
    /// # Errors
    /// [`Error::Usage`] for a word that a job's file cannot hold.
    pub fn words(&self) -> Result<Vec<String>> {
        let resume = OsString::from("--resume");
        let words =
            [OsStr::new("apply")].into_iter().chain(self.options.iter().map(OsString::as_os_str)).chain([&*resume]);
        // A pattern that begins with a dash is none of the options.
        let inputs = [OsStr::new("--")].into_iter().chain(self.inputs.iter().map(OsString::as_os_str));
        words.chain(inputs).map(utf8).collect()
    }
}

/// A word as text in one line; two braces begin a variable of the Open Job Description.
///
/// # Errors
/// [`Error::Usage`]
pub fn utf8(word: &OsStr) -> Result<String> {
    let fits = |text: &&str| !text.contains("{{") && !text.chars().any(char::is_control);
    let refused = || Error::Usage(format!("a job's file cannot hold {}", word.display()));
    word.to_str().filter(fits).map(str::to_owned).ok_or_else(refused)
}

impl clap::Args for Given {
    fn group_id() -> Option<clap::Id> {
        apply::Args::group_id()
    }

    fn augment_args(command: Command) -> Command {
        apply::Args::augment_args(command)
    }

    fn augment_args_for_update(command: Command) -> Command {
        apply::Args::augment_args_for_update(command)
    }
}

impl FromArgMatches for Given {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let args = apply::Args::from_arg_matches(matches)?;
        let command = <apply::Args as clap::Args>::augment_args(Command::new("apply"));
        let raw = |id: &clap::Id| matches.get_raw(id.as_str()).into_iter().flatten().map(OsStr::to_owned);
        let mut given = Self { args, inputs: Vec::new(), options: Vec::new() };
        for argument in command.get_arguments() {
            let id = argument.get_id();
            if matches.value_source(id.as_str()) != Some(ValueSource::CommandLine) {
                continue;
            }
            match argument.get_long() {
                _ if id == "inputs" => given.inputs.extend(raw(id)),
                Some(long) if !LEFT_OUT.contains(&id.as_str()) => {
                    let mut word = OsString::from(format!("--{long}"));
                    if argument.get_action().takes_values() {
                        word.push("=");
                        let comma = argument.get_value_delimiter().unwrap_or(',').to_string();
                        word.push(raw(id).collect::<Vec<_>>().join(OsStr::new(&comma)));
                    }
                    given.options.push(word);
                }
                _ => {}
            }
        }
        Ok(given)
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(clap::Parser)]
    struct Cli {
        #[command(flatten)]
        given: Given,
    }

    fn words(line: &[&str]) -> Vec<String> {
        let line = [&["job"], line].concat();
        let Cli { given } = clap::Parser::try_parse_from(line).unwrap_or_else(|error| panic!("{error}"));
        given.words().unwrap()
    }

    #[test]
    fn options_come_back_as_they_were_given() {
        let given = words(&[
            "in/s.####.exr",
            "-qo",
            "out/it's.####.exr",
            "--frames",
            "1-9",
            "--force",
            "--tint",
            "1,0.5,-0",
            "--widths",
            "0.1,0.2",
            "--tints",
            "1,1,1;1,0,0",
            "--axis=-0.1,0",
            "--mix",
            "add",
        ]);
        let (options, inputs) = given.split_at(given.iter().position(|word| word == "--").unwrap());
        assert_eq!(inputs, ["--", "in/s.####.exr"]);
        assert_eq!((options[0].as_str(), options.last().map(String::as_str)), ("apply", Some("--resume")));
        for expected in [
            "--output=out/it's.####.exr",
            "--quiet",
            "--tint=1,0.5,-0",
            "--widths=0.1,0.2",
            "--tints=1,1,1;1,0,0",
            "--axis=-0.1,0",
            "--mix=add",
        ] {
            assert!(options.iter().any(|word| word == expected), "{expected} is in {options:?}");
        }
        assert_eq!(options.len(), 9, "nothing else is: {options:?}");
    }

    #[test]
    fn what_a_task_is_told_means_what_the_job_was_told() {
        let told = [
            "s.####.exr",
            "-o",
            "o/",
            "--preset",
            "zoom",
            "--sources",
            "lights",
            "--recover",
            "4",
            "--axis=-0.1,0.2",
            "--period",
            "4,3",
        ];
        let look = |line: &[&str]| {
            let line = [&["job"], line].concat();
            let Cli { given } = clap::Parser::try_parse_from(line).unwrap_or_else(|error| panic!("{error}"));
            given.args.look().unwrap()
        };
        let again = words(&told);
        let again: Vec<&str> = again[1..].iter().map(String::as_str).collect();
        assert_eq!(look(&again), look(&told));
        assert_ne!(look(&again), look(&told[..3]));
    }
}
