//! `vglare completions` and `vglare man`, from the argument parser's own generators.

use clap::CommandFactory as _;

use vglare::{Error, Result, terminal};

use super::Cli;

/// Print completions for a shell
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  vglare completions bash > ~/.local/share/bash-completion/completions/vglare
  vglare completions fish > ~/.config/fish/completions/vglare.fish")]
pub struct CompletionsArgs {
    /// The shell
    shell: clap_complete::Shell,
}

/// Print the manual, or write one page for each command
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  vglare man | man -l -
  vglare man --folder /usr/local/share/man/man1")]
pub struct ManArgs {
    /// Write vglare.1 and a page for each command into this folder
    #[arg(long, value_name = "FOLDER")]
    folder: Option<std::path::PathBuf>,
}

/// Prints the completions.
///
/// # Errors
/// Where standard output cannot be written.
pub fn completions(args: &CompletionsArgs) -> Result<()> {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut Cli::command(), "vglare", &mut script);
    terminal::print(|out| out.write_all(&script))
}

/// Prints or writes the manual.
///
/// # Errors
/// Where standard output or the folder cannot be written.
pub fn man(args: &ManArgs) -> Result<()> {
    let Some(folder) = &args.folder else {
        return terminal::print(|out| clap_mangen::Man::new(Cli::command()).render(out));
    };
    let refused = |error: std::io::Error| Error::write(folder, error);
    std::fs::create_dir_all(folder).map_err(refused)?;
    clap_mangen::generate_to(Cli::command(), folder).map_err(refused)
}
