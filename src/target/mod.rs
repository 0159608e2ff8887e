//! The one way in which a file is written: beside its target, to disk, then renamed.
//!
//! What is promised: a target is as it was before, or whole; it is never half-written, not by an error, a signal or a full
//! disk, and not by a loss of power either, since the file is on the disk before it gets its name. Once a write has come
//! back without an error, the name is on the disk too (where the file system has such a thing). A link is followed and
//! stays a link; a file that is replaced keeps its permissions. What is no file, as a pipe or a device, is written to as
//! it is; `-` is standard output.
//!
//! | module | what it does |
//! | --- | --- |
//! | [`mod@part`] | the file beside the target, that leaves nothing behind |
//! | [`same`] | which paths are one file, so that no output replaces another or an input |

pub(crate) mod part;
mod same;

use std::fs::{self, File};
use std::io::{self, BufWriter, Cursor, IsTerminal as _, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use serde::Serialize;

use crate::{Error, Result};

use part::Part;
pub use same::{Identity, spare};

/// Why what fills a file gave up.
type Reason = Box<dyn std::error::Error + Send + Sync>;

/// How many links a path may lead through, as Linux has it.
const MOST_LINKS: usize = 40;

/// What a file is filled through.
pub trait Sink: Write + Seek {}

impl<T: Write + Seek> Sink for T {}

/// A file to be.
#[derive(Debug)]
pub struct Target {
    /// As it was named.
    given: PathBuf,
    place: Place,
    overwrite: bool,
}

#[derive(Debug)]
enum Place {
    /// A file, written under another name in `folder` first.
    File { path: PathBuf, folder: PathBuf },
    /// Standard output, by whatever name.
    Stdout,
    /// A pipe or a device: written to as it is.
    Stream,
}

impl Target {
    /// Where a path leads.
    ///
    /// # Errors
    /// [`Error::Exists`] where a file is there and must not be replaced; [`Error::Write`] where it is a folder, or is to be
    /// in one that is missing.
    pub fn new(given: &Path, overwrite: bool) -> Result<Self> {
        let found = |place| Ok(Self { given: given.to_owned(), place, overwrite });
        if is_stdout(given) {
            return found(Place::Stdout);
        }
        // A link is followed, so that it stays a link.
        let path = followed(given).map_err(|error| Error::write(given, plain(&error)))?;
        match fs::symlink_metadata(&path) {
            Ok(kind) if kind.is_dir() => return Err(Error::write(given, "it is a folder")),
            Ok(kind) if !kind.is_file() => return found(Place::Stream),
            Ok(_) if !overwrite => return Err(Error::Exists { path: given.to_owned() }),
            _ => {}
        }
        let folder = folder(&path).to_owned();
        if !folder.is_dir() {
            return Err(Error::write(given, format!("there is no folder {}", folder.display())));
        }
        found(Place::File { path, folder })
    }

    /// Whether what is written would be seen on a terminal.
    pub fn is_terminal(&self) -> bool {
        matches!(self.place, Place::Stdout) && io::stdout().is_terminal()
    }

    /// Whether its folder takes a file: one made and removed again is the one honest test.
    ///
    /// # Errors
    /// [`Error::Write`] where it does not.
    pub fn try_out(&self) -> Result<()> {
        match &self.place {
            Place::File { folder, .. } => Part::new(folder).map(drop).map_err(|error| self.refused(&error)),
            Place::Stdout | Place::Stream => Ok(()),
        }
    }

    /// Writes what `fill` gives. `cancelled` is asked with every quarter of a megabyte, and before the file gets its name.
    ///
    /// # Errors
    /// [`Error::Write`] where the disk is full, the system refuses, or `fill` gives up; [`Error::Exists`] where a file has
    /// appeared meanwhile that must not be replaced; [`Error::Cancelled`]. Nothing is left behind then, unless the target
    /// is a pipe or a device.
    pub fn write(
        &self,
        cancelled: &dyn Fn() -> bool,
        fill: impl FnOnce(&mut dyn Sink) -> Result<(), Reason>,
    ) -> Result<()> {
        self.put(cancelled, fill, true)
    }

    fn put(
        &self,
        cancelled: &dyn Fn() -> bool,
        fill: impl FnOnce(&mut dyn Sink) -> Result<(), Reason>,
        to_disk: bool,
    ) -> Result<()> {
        let Place::File { path, folder } = &self.place else { return self.stream(cancelled, fill) };
        let part = Part::new(folder).map_err(|error| self.refused(&error))?;
        let mut guarded = Guarded { file: part.file(), cancelled, failed: None };
        let mut writer = BufWriter::with_capacity(1 << 18, &mut guarded);
        let filled = fill(&mut writer).and_then(|()| Ok(writer.flush()?));
        drop(writer);
        // A system's reason is told as it is, and not in an encoder's words.
        let failed = guarded.failed.map(|error| self.refused(&error));
        if cancelled() {
            return Err(Error::Cancelled);
        }
        match (failed, filled) {
            (Some(error), _) => return Err(error),
            (None, Err(reason)) => return Err(Error::write(&self.given, reason)),
            (None, Ok(())) => {}
        }
        self.keep(part, path, folder, to_disk).map_err(|error| match error.kind() {
            io::ErrorKind::AlreadyExists => Error::Exists { path: self.given.clone() },
            _ => self.refused(&error),
        })
    }

    /// Gives a part its name, once what it holds is on the disk.
    fn keep(&self, part: Part, path: &Path, folder: &Path, to_disk: bool) -> io::Result<()> {
        if self.overwrite
            && let Ok(old) = fs::metadata(path)
            && part.file().metadata()?.permissions() != old.permissions()
        {
            part.file().set_permissions(old.permissions())?;
        }
        if to_disk {
            unless_unknown(part.file().sync_data())?;
        }
        part.persist(path, self.overwrite)?;
        if to_disk { sync_folder(folder) } else { Ok(()) }
    }

    fn stream(
        &self,
        cancelled: &dyn Fn() -> bool,
        fill: impl FnOnce(&mut dyn Sink) -> Result<(), Reason>,
    ) -> Result<()> {
        // Encoders jump back to fill in sizes, which a pipe cannot.
        let mut memory = Cursor::new(Vec::new());
        fill(&mut memory).map_err(|reason| Error::write(&self.given, reason))?;
        if cancelled() {
            return Err(Error::Cancelled);
        }
        let bytes = memory.get_ref();
        let done = match self.place {
            // Through the program's own, or its position would not be the one that the summary goes on from.
            Place::Stdout => io::stdout().write_all(bytes).and_then(|()| io::stdout().flush()),
            _ => File::options().write(true).open(&self.given).and_then(|mut stream| stream.write_all(bytes)),
        };
        done.map_err(|error| if cancelled() { Error::Cancelled } else { self.refused(&error) })
    }

    fn refused(&self, error: &io::Error) -> Error {
        Error::write(&self.given, plain(error))
    }
}

/// A file that takes no more once it is called off, and remembers why it took no more.
struct Guarded<'a> {
    file: &'a File,
    cancelled: &'a dyn Fn() -> bool,
    failed: Option<io::Error>,
}

impl Guarded<'_> {
    fn noting<T>(&mut self, result: io::Result<T>) -> io::Result<T> {
        result.map_err(|error| {
            let kind = error.kind();
            if kind != io::ErrorKind::Interrupted {
                self.failed.get_or_insert(error);
            }
            kind.into()
        })
    }
}

impl Write for Guarded<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if (self.cancelled)() {
            return Err(io::Error::other("cancelled"));
        }
        let done = self.file.write(bytes);
        self.noting(done)
    }

    fn flush(&mut self) -> io::Result<()> {
        let done = self.file.flush();
        self.noting(done)
    }
}

impl Seek for Guarded<'_> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        let done = self.file.seek(to);
        self.noting(done)
    }
}

/// Whether a file may be written: asked before the long work starts.
///
/// # Errors
/// Those of [`Target::new`] and [`Target::try_out`].
pub fn check(path: &Path, overwrite: bool) -> Result<()> {
    Target::new(path, overwrite)?.try_out()
}

/// Writes `value` as JSON.
///
/// # Errors
/// Those of [`Target::new`] and [`Target::write`].
pub fn write_json(path: &Path, value: &impl Serialize, overwrite: bool) -> Result<()> {
    Target::new(path, overwrite)?.write(&|| false, |sink| {
        serde_json::to_writer_pretty(&mut *sink, value)?;
        Ok(sink.write_all(b"\n")?)
    })
}

/// Writes a text.
///
/// # Errors
/// Those of [`Target::new`] and [`Target::write`].
pub fn write_text(path: &Path, text: &str, overwrite: bool) -> Result<()> {
    write(path, text.as_bytes(), overwrite)
}

/// Writes bytes.
///
/// # Errors
/// Those of [`Target::new`] and [`Target::write`].
pub fn write(path: &Path, bytes: &[u8], overwrite: bool) -> Result<()> {
    Target::new(path, overwrite)?.write(&|| false, |sink| Ok(sink.write_all(bytes)?))
}

/// Replaces a text that may be lost with the power: what a window remembers must not keep it waiting for the disk.
///
/// # Errors
/// Those of [`Target::new`] and [`Target::write`].
pub fn remember_text(path: &Path, text: &str) -> Result<()> {
    Target::new(path, true)?.put(&|| false, |sink| Ok(sink.write_all(text.as_bytes())?), false)
}

/// The same with `value` as JSON.
///
/// # Errors
/// Those of [`remember_text`].
pub fn remember_json(path: &Path, value: &impl Serialize) -> Result<()> {
    remember_text(path, &json(path, value)?)
}

fn json(path: &Path, value: &impl Serialize) -> Result<String> {
    let text = serde_json::to_string_pretty(value).map_err(|error| Error::write(path, error))?;
    Ok(text + "\n")
}

/// Makes a folder, and those that it is in, where they are missing.
///
/// # Errors
/// [`Error::Write`] where the system refuses.
pub fn make_folder(path: &Path) -> Result<()> {
    let refused = |error: io::Error| Error::write(path, plain(&error));
    if path.is_dir() || path.as_os_str().is_empty() {
        return Ok(());
    }
    fs::create_dir_all(path).map_err(refused)?;
    sync_folder(folder(path)).map_err(refused)
}

/// The folder that a path is in.
pub fn folder(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// The path that links lead to, be there a file at their end or not yet.
fn followed(given: &Path) -> io::Result<PathBuf> {
    let mut path = given.to_owned();
    for _ in 0..MOST_LINKS {
        match fs::read_link(&path) {
            Ok(next) => path = folder(&path).join(next),
            Err(_) => return Ok(path),
        }
    }
    Err(io::Error::other("its links lead round and round"))
}

/// Whether a path is `-`: standard input where it is read, standard output where it is written. A file of that name is `./-`.
pub(crate) fn is_standard(path: &Path) -> bool {
    path == Path::new("-")
}

/// Whether a path is `-`, or one of the names that Unix has for standard output.
fn is_stdout(path: &Path) -> bool {
    if is_standard(path) {
        return true;
    }
    let names = ["/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"];
    let is = |path: &Path| names.iter().any(|name| path == Path::new(name));
    // A link to it, as under a name that ends in .exr.
    cfg!(unix) && (is(path) || fs::read_link(path).is_ok_and(|next| is(&next)))
}

/// A system's reason in words that stand alone.
fn plain(error: &io::Error) -> String {
    match error.kind() {
        io::ErrorKind::StorageFull => "the disk is full".into(),
        io::ErrorKind::QuotaExceeded => "the disk quota is used up".into(),
        io::ErrorKind::FileTooLarge => "it would be larger than a file may be here".into(),
        io::ErrorKind::ReadOnlyFilesystem => "its disk can only be read".into(),
        io::ErrorKind::PermissionDenied => "the system does not permit it".into(),
        _ => error.to_string(),
    }
}

/// Puts a folder's new names on the disk.
fn sync_folder(folder: &Path) -> io::Result<()> {
    if cfg!(not(unix)) {
        return Ok(());
    }
    match File::open(folder) {
        Ok(open) => unless_unknown(open.sync_all()),
        // One may write into a folder that one may not read.
        Err(_) => Ok(()),
    }
}

/// File systems that have no notion of syncing say so, and have done all they can.
fn unless_unknown(result: io::Result<()>) -> io::Result<()> {
    match result {
        Err(error) if matches!(error.kind(), io::ErrorKind::InvalidInput | io::ErrorKind::Unsupported) => Ok(()),
        other => other,
    }
}
