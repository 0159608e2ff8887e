//! The program: parse, run, say what went wrong.

use std::process::ExitCode;

use clap::Parser as _;
use vglare::cli::{self, Cli};

fn main() -> ExitCode {
    match cli::run(Cli::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("vglare: {error}");
            ExitCode::from(error.exit_code())
        }
    }
}
