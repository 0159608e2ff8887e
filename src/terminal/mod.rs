//! What every command does at a terminal: printing, telling, showing how far it is, ending by a signal.

pub(crate) mod progress;
pub(crate) mod signals;
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

/// A number in four digits, as tables and summaries have it.
pub(crate) fn digits(value: f64) -> String {
    match value.abs() {
        0.0 => "0".to_owned(),
        size if (1e-3..1e6).contains(&size) => {
            let after = (3 - size.log10().floor() as i32).max(0) as usize;
            format!("{value:.after$}")
        }
        _ => format!("{value:.3e}"),
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn numbers_have_four_digits() {
        let numbers = [0.0, 0.012_344, 1.0, 123.45, 45_678.9, 1.5e7, -2e-5, f64::NAN].map(super::digits);
        assert_eq!(numbers, ["0", "0.01234", "1.000", "123.5", "45679", "1.500e7", "-2.000e-5", "NaN"]);
    }
}
