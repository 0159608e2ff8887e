//! What a person is told beside the results. A standard error that is full or closed keeps nothing from being done.

use std::fmt::Display;
use std::io::{self, Write as _};

/// A line each.
pub fn warn<T: Display>(warnings: impl IntoIterator<Item = T>) {
    let mut stderr = io::stderr().lock();
    for warning in warnings {
        let _ = writeln!(stderr, "vglare: warning: {warning}");
    }
}
