//! The program: parse, run, say what went wrong.

#![warn(clippy::print_stderr, clippy::print_stdout)]

use std::process::ExitCode;

use vglare::cli;

fn main() -> ExitCode {
    let cli = match cli::parse() {
        Ok(cli) => cli,
        Err(code) => return ExitCode::from(code),
    };
    match cli::run(cli) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            cli::tell(&error);
            ExitCode::from(error.exit_code())
        }
    }
}
