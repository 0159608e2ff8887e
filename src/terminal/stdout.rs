//! Printing: a reader that has had enough, like `head`, is no error, and no text from a file commands a terminal.

use std::io::{self, BufWriter, ErrorKind, Write};
use std::path::Path;

use crate::printable::{Escapes, Printable};
use crate::{Error, Result};

/// Lets `print` write text to standard output.
///
/// # Errors
///
/// [`Error::Write`] where standard output cannot be written, unless it is a pipe that has been closed.
pub fn print(print: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<()> {
    print_as(Escapes::Text, print)
}

/// Lets `print` write JSON to standard output.
///
/// # Errors
///
/// Those of [`print`](fn@print).
pub fn json(print: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<()> {
    print_as(Escapes::Json, print)
}

/// Lets `print` write a summary: to standard error where standard output has a file of the run's.
///
/// # Errors
///
/// Those of [`print`](fn@print).
pub fn summary(is_taken: bool, print: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<()> {
    if !is_taken {
        return self::print(print);
    }
    let mut out = Printable::new(BufWriter::new(io::stderr().lock()), Escapes::Text);
    // Where nobody listens, nothing is lost.
    let _ = print(&mut out).and_then(|()| out.flush());
    Ok(())
}

fn print_as(escapes: Escapes, print: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<()> {
    let mut out = Printable::new(BufWriter::new(io::stdout().lock()), escapes);
    match print(&mut out).and_then(|()| out.flush()) {
        Err(e) if e.kind() != ErrorKind::BrokenPipe => Err(Error::write(Path::new("standard output"), e)),
        _ => Ok(()),
    }
}
