//! The program: parse, run, say what went wrong.

use std::process::ExitCode;

use vglare::cli;

fn main() -> ExitCode {
    match cli::run(cli::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("vglare: {error}");
            ExitCode::from(error.exit_code())
        }
    }
}
