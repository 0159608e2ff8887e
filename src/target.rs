//! Small files that a command writes whole: beside the target, then renamed.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::Path;

use serde::Serialize;

use crate::{Error, Result};

/// Whether a file may be written: asked before the long work starts.
///
/// # Errors
/// [`Error::Exists`] where it is there and must not be replaced, [`Error::Write`] where its folder is missing.
pub fn check(path: &Path, overwrite: bool) -> Result<()> {
    if path.is_dir() {
        return Err(Error::write(path, "it is a folder"));
    }
    if path.exists() && !overwrite {
        return Err(Error::Exists { path: path.to_owned() });
    }
    let folder = folder(path);
    if folder.is_dir() { Ok(()) } else { Err(Error::write(path, format!("there is no folder {}", folder.display()))) }
}

/// Writes `value` as JSON.
///
/// # Errors
/// Those of [`check`], and [`Error::Write`] where the disk is full or the system refuses.
pub fn write_json(path: &Path, value: &impl Serialize, overwrite: bool) -> Result<()> {
    write_by(path, overwrite, |out| {
        serde_json::to_writer_pretty(&mut *out, value)?;
        out.write_all(b"\n")
    })
}

/// Writes a text.
///
/// # Errors
/// Those of [`check`], and [`Error::Write`] where the disk is full or the system refuses.
pub fn write_text(path: &Path, text: &str, overwrite: bool) -> Result<()> {
    write(path, text.as_bytes(), overwrite)
}

/// Writes bytes.
///
/// # Errors
/// Those of [`check`], and [`Error::Write`] where the disk is full or the system refuses.
pub fn write(path: &Path, bytes: &[u8], overwrite: bool) -> Result<()> {
    write_by(path, overwrite, |out| out.write_all(bytes))
}

/// Writes what `print` prints.
fn write_by(path: &Path, overwrite: bool, print: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<()> {
    check(path, overwrite)?;
    let refused = |error: io::Error| Error::write(path, error);
    let all = |file: &File| {
        let mut out = BufWriter::new(file);
        print(&mut out).and_then(|()| out.flush()).map_err(refused)
    };
    if path.exists() && !path.is_file() {
        // A pipe or a device has no beside.
        return all(&File::create(path).map_err(refused)?);
    }
    let mut builder = tempfile::Builder::new();
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt as _;
        // What the umask leaves of the usual permissions, instead of a temporary file's own.
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    let file = builder.prefix(".vglare-").tempfile_in(folder(path)).map_err(refused)?;
    all(file.as_file())?;
    if overwrite {
        file.persist(path).map_err(|error| refused(error.error))?;
    } else {
        file.persist_noclobber(path).map_err(|error| refused(error.error))?;
    }
    Ok(())
}

/// The folder that a file is in.
pub fn folder(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}
