//! What a person is told beside the results. A standard error that is full or closed keeps nothing from being done.

use std::fmt::Display;
use std::io::{self, BufWriter, Write as _};

use crate::printable::{Escapes, Printable};

/// A line each.
pub fn warn<T: Display>(warnings: impl IntoIterator<Item = T>) {
    warnings.into_iter().for_each(|warning| tell(format_args!("warning: {warning}")));
}

/// What went wrong.
pub fn tell(error: impl Display) {
    print(format_args!("vglare: {error}\n"));
}

/// A text as it is, but for what would command a terminal.
pub fn print(text: impl Display) {
    let mut stderr = Printable::new(BufWriter::new(io::stderr().lock()), Escapes::Text);
    let _ = write!(stderr, "{text}").and_then(|()| stderr.flush());
}
