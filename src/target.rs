//! Small files that a command writes whole: beside the target, then renamed.

use std::io::Write as _;
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
    let mut text = serde_json::to_string_pretty(value).map_err(|error| Error::write(path, error))?;
    text.push('\n');
    write_text(path, &text, overwrite)
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
    check(path, overwrite)?;
    let refused = |error: std::io::Error| Error::write(path, error);
    if path.exists() && !path.is_file() {
        // A pipe or a device has no beside.
        return std::fs::write(path, bytes).map_err(refused);
    }
    let mut builder = tempfile::Builder::new();
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt as _;
        // What the umask leaves of the usual permissions, instead of a temporary file's own.
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    let mut file = builder.prefix(".vglare-").tempfile_in(folder(path)).map_err(refused)?;
    file.write_all(bytes).map_err(refused)?;
    if overwrite {
        file.persist(path).map_err(|error| refused(error.error))?;
    } else {
        file.persist_noclobber(path).map_err(|error| refused(error.error))?;
    }
    Ok(())
}

fn folder(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}
