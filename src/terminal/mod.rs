//! What every command does at a terminal: printing, telling, showing how far it is, ending by a signal.

pub(crate) mod progress;
mod signals;
pub(crate) mod stderr;
pub(crate) mod stdout;

pub use stderr::{print as print_error, tell};
pub use stdout::print;

use crate::{Result, gpu, limits, panics, printable};

/// Makes the process that of a command: panics become errors and are told by whoever catches them, memory is spared where
/// it is limited, and a signal leaves nothing half-written behind.
pub fn begin() {
    panics::keep_quiet();
    gpu::be_sparing();
    signals::listen();
}

/// Starts the threads that pictures are worked on with.
///
/// # Errors
/// [`crate::Error::Threads`] where the system gives none at all.
pub fn start_threads() -> Result<()> {
    limits::start_pool()
}

/// Whether a text commands a terminal nothing when it is printed as it is.
pub fn is_printable(text: &str) -> bool {
    printable::printable(text) == text
}
