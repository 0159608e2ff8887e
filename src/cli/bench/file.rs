//! A report's file, which appears only when it is complete.

use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

use tempfile::Builder;

use super::report::Reason;
use crate::{Error, Result};

/// A file that may be written: asked before the long work starts.
pub(super) struct File {
    path: PathBuf,
    folder: PathBuf,
    overwrite: bool,
}

impl File {
    /// # Errors
    /// [`Error::Exists`] where the file is there and must not be replaced; [`Error::Write`] where its folder is missing.
    pub fn new(path: &Path, overwrite: bool) -> Result<Self> {
        if path.is_dir() {
            return Err(Error::write(path, "it is a folder"));
        }
        if path.exists() && !overwrite {
            return Err(Error::Exists { path: path.to_owned() });
        }
        let folder = match path.parent() {
            Some(folder) if !folder.as_os_str().is_empty() => folder,
            _ => Path::new("."),
        };
        if !folder.is_dir() {
            return Err(Error::write(path, format!("there is no folder {}", folder.display())));
        }
        Ok(Self { path: path.to_owned(), folder: folder.to_owned(), overwrite })
    }

    /// Writes it under another name, then renames it.
    ///
    /// # Errors
    /// [`Error::Write`], and [`Error::Exists`] where the file has come meanwhile.
    pub fn write(&self, write: impl FnOnce(&mut dyn Write) -> Result<(), Reason>) -> Result<()> {
        let complain = |reason: Reason| Error::write(&self.path, reason);
        let mut builder = Builder::new();
        builder.prefix(".vglare-").suffix(".part");
        // The library's own default is for secrets; a report gets what the umask leaves, like any other file.
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
        let file = builder.tempfile_in(&self.folder).map_err(|error| complain(error.into()))?;
        let mut buffered = BufWriter::new(file.as_file());
        write(&mut buffered).and_then(|()| Ok(buffered.flush()?)).map_err(complain)?;
        drop(buffered);
        let done = if self.overwrite { file.persist(&self.path) } else { file.persist_noclobber(&self.path) };
        match done {
            Ok(_) => Ok(()),
            Err(error) if error.error.kind() == std::io::ErrorKind::AlreadyExists => {
                Err(Error::Exists { path: self.path.clone() })
            }
            Err(error) => Err(complain(error.error.into())),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    #[test]
    fn a_file_is_whole_or_not_there() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("report.csv");
        let fails = File::new(&path, false).unwrap().write(|out| {
            out.write_all(b"half")?;
            Err("full".into())
        });
        assert!(fails.unwrap_err().to_string().ends_with("full"));
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);

        File::new(&path, false).unwrap().write(|out| Ok(out.write_all(b"one")?)).unwrap();
        assert!(matches!(File::new(&path, false), Err(Error::Exists { .. })));
        File::new(&path, true).unwrap().write(|out| Ok(out.write_all(b"two")?)).unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"two");
        assert!(matches!(File::new(&folder.path().join("no/report.csv"), true), Err(Error::Write { .. })));
    }
}
