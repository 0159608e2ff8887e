//! The program: parse, run, say what went wrong.

mod program;

use std::process::ExitCode;

use vglare::terminal;

fn main() -> ExitCode {
    let cli = match program::parse() {
        Ok(cli) => cli,
        Err(code) => return ExitCode::from(code),
    };
    match program::run(cli) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            terminal::tell(&error);
            ExitCode::from(error.exit_code())
        }
    }
}
