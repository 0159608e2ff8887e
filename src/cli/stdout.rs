//! Printing: a reader that has had enough, like `head`, is no error.

use std::io::{self, BufWriter, ErrorKind, Write};
use std::path::Path;

use crate::{Error, Result};

/// Lets `print` write to standard output.
///
/// # Errors
///
/// [`Error::Write`] where standard output cannot be written, unless it is a pipe that has been closed.
pub fn print(print: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<()> {
    let mut out = BufWriter::new(io::stdout().lock());
    match print(&mut out).and_then(|()| out.flush()) {
        Err(e) if e.kind() != ErrorKind::BrokenPipe => Err(Error::write(Path::new("standard output"), e)),
        _ => Ok(()),
    }
}
