//! Files on their way to a name: `.vglare-*.part` beside the target.
//!
//! Nothing of them is left behind. One that is not persisted is removed when it is dropped. Where a signal ends the
//! program, [`remove_all`] removes those that there are. What is killed without a word, or by a loss of power, cannot
//! remove anything; the next run that writes into the same folder does. It knows such a stray by its lock: a part is
//! locked for as long as its program lives, and the system lets go of a lock when it ends. A lock tells nothing of a
//! program on another machine, where the file system does not share them; so a part has in its name which start of which
//! machine it was made in, and one of another is only removed when nothing has been written to it for a day.

use std::collections::BTreeSet;
use std::fs::{self, File, Metadata};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{LazyLock, Mutex, MutexGuard, PoisonError, TryLockError};
use std::time::{Duration, Instant};

use tempfile::{Builder, NamedTempFile};

const PREFIX: &str = ".vglare-";
const SUFFIX: &str = ".part";

/// For how long a part of another start has to be untouched until it is a stray.
const STRAY_AFTER: Duration = Duration::from_secs(24 * 60 * 60);

/// How often a new part may be taken for a stray, between being made and being locked, before the lock is given up.
const TRIES: usize = 10;

/// What begins the names of parts of this start of this machine; all that the system says is that starts differ.
static OURS: LazyLock<String> = LazyLock::new(|| {
    let start = fs::read_to_string("/proc/sys/kernel/random/boot_id").unwrap_or_default();
    match start.get(..8).filter(|start| start.bytes().all(|byte| byte.is_ascii_hexdigit())) {
        Some(start) => format!("{PREFIX}{start}-"),
        None => format!("{PREFIX}unknown-"),
    }
});

/// What parts there are, and in which folders strays have been looked for.
#[derive(Default)]
struct Register {
    parts: BTreeSet<PathBuf>,
    swept: BTreeSet<PathBuf>,
}

static REGISTER: Mutex<Option<Register>> = Mutex::new(None);

fn register() -> MutexGuard<'static, Option<Register>> {
    REGISTER.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A file that vanishes unless it is persisted.
#[derive(Debug)]
pub struct Part {
    file: Option<NamedTempFile>,
}

impl Part {
    /// A new, empty one in a folder; strays there are removed.
    ///
    /// # Errors
    /// Where the folder takes no file.
    pub fn new(folder: &Path) -> io::Result<Self> {
        let mut register = register();
        let register = register.get_or_insert_default();
        if register.swept.insert(folder.to_owned()) {
            sweep(folder);
        }
        for _ in 0..TRIES {
            let file = make(folder)?;
            // Where there are no locks, there are none for who would remove it either.
            let locked = !matches!(file.as_file().try_lock(), Err(fs::TryLockError::WouldBlock));
            // Another run may have removed it before it was locked.
            if locked && file.path().exists() {
                register.parts.insert(file.path().to_owned());
                return Ok(Self { file: Some(file) });
            }
        }
        Err(io::Error::other("its temporary file vanishes again and again"))
    }

    /// What it holds.
    pub fn file(&self) -> &File {
        self.file.as_ref().expect("a part has its file until it is persisted").as_file()
    }

    /// Gives it its name, in place of a file that is there or only where there is none.
    ///
    /// # Errors
    /// Of the kind [`io::ErrorKind::AlreadyExists`] where there is one, others where the system refuses.
    pub fn persist(mut self, path: &Path, overwrite: bool) -> io::Result<()> {
        let mut register = register();
        let Some(file) = self.file.take() else { return Ok(()) };
        let part = file.path().to_owned();
        let done = if overwrite {
            file.persist(path)
        } else {
            file.persist_noclobber(path).or_else(|refused| match refused.error.kind() {
                io::ErrorKind::AlreadyExists => Err(refused),
                // A file system may know neither of the ways that never replace (FAT, some over a network): the name is
                // taken first, by an empty file.
                _ => match File::create_new(path) {
                    Ok(_) => refused.file.persist(path).inspect_err(|_| drop(fs::remove_file(path))),
                    Err(error) => Err(tempfile::PersistError { error, file: refused.file }),
                },
            })
        };
        // What was not persisted is removed here, while nothing else looks at the register.
        let done = done.map(drop).map_err(|refused| refused.error);
        if let Some(register) = register.as_mut() {
            register.parts.remove(&part);
        }
        done
    }
}

impl Drop for Part {
    fn drop(&mut self) {
        let Some(file) = self.file.take() else { return };
        let mut register = register();
        let part = file.path().to_owned();
        drop(file);
        if let Some(register) = register.as_mut() {
            register.parts.remove(&part);
        }
    }
}

/// Removes all parts that there are, and lets no other begin or get its name while what is given back is held: for a
/// program that is about to end. A file system that no longer answers keeps it from that for two seconds only.
#[must_use]
pub fn remove_all() -> Option<impl Drop> {
    let until = Instant::now() + Duration::from_secs(2);
    let register = loop {
        match REGISTER.try_lock() {
            Ok(register) => break register,
            Err(TryLockError::Poisoned(register)) => break register.into_inner(),
            Err(TryLockError::WouldBlock) if Instant::now() > until => return None,
            Err(TryLockError::WouldBlock) => std::thread::sleep(Duration::from_millis(1)),
        }
    };
    for path in register.iter().flat_map(|register| &register.parts) {
        let _ = fs::remove_file(path);
    }
    Some(register)
}

fn make(folder: &Path) -> io::Result<NamedTempFile> {
    let mut builder = Builder::new();
    builder.prefix(OURS.as_str()).suffix(SUFFIX);
    // The library's own default is for secrets; a picture gets what the umask leaves, like any other file.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder.tempfile_in(folder)
}

/// Removes what runs have left in a folder that could not remove it themselves. What cannot be removed stays.
fn sweep(folder: &Path) {
    let Ok(entries) = fs::read_dir(folder) else { return };
    for entry in entries.flatten() {
        let name = entry.file_name();
        let Some(name) = name.to_str().filter(|name| name.starts_with(PREFIX) && name.ends_with(SUFFIX)) else {
            continue;
        };
        let is_due = |about: &Metadata| about.is_file() && (name.starts_with(&*OURS) || untouched(about));
        // Of the name itself, not of what a link leads to.
        if entry.metadata().is_ok_and(|about| is_due(&about)) {
            remove_stray(&entry.path());
        }
    }
}

fn untouched(about: &Metadata) -> bool {
    about.modified().is_ok_and(|then| then.elapsed().is_ok_and(|age| age > STRAY_AFTER))
}

fn remove_stray(path: &Path) {
    let Ok(file) = File::options().write(true).open(path) else { return };
    if file.try_lock().is_ok() {
        let _ = fs::remove_file(path);
    }
}

#[cfg(test)]
mod tests {
    use std::fs::FileTimes;
    use std::time::SystemTime;

    use super::*;

    fn left(folder: &Path) -> usize {
        fs::read_dir(folder).unwrap().count()
    }

    /// A part as a run leaves it that was killed.
    fn stray(folder: &Path, begin: &str, age: Duration) -> PathBuf {
        let path = folder.join(format!("{begin}aBc123{SUFFIX}"));
        let file = File::create_new(&path).unwrap();
        file.set_times(FileTimes::new().set_modified(SystemTime::now() - age)).unwrap();
        path
    }

    #[test]
    fn strays_of_this_start_go_at_once_and_others_after_a_day() {
        let folder = tempfile::tempdir().unwrap();
        let (hour, days) = (Duration::from_secs(3600), Duration::from_secs(3 * 86400));
        let ours = stray(folder.path(), &OURS, Duration::ZERO);
        let elsewhere = stray(folder.path(), ".vglare-00000000-", hour);
        let old = stray(folder.path(), ".vglare-", days);
        let precious = stray(folder.path(), "vglare-", days);
        drop(Part::new(folder.path()).unwrap());
        assert_eq!([ours, elsewhere, old, precious].map(|path| path.exists()), [false, true, false, true]);
    }

    #[test]
    fn a_part_that_is_being_written_is_no_stray() {
        let folder = tempfile::tempdir().unwrap();
        let part = Part::new(folder.path()).unwrap();
        part.file().set_times(FileTimes::new().set_modified(SystemTime::UNIX_EPOCH)).unwrap();
        sweep(folder.path());
        assert_eq!(left(folder.path()), 1, "it is locked");
        part.persist(&folder.path().join("whole"), false).unwrap();
        sweep(folder.path());
        assert_eq!(left(folder.path()), 1, "it has its name");
    }

    #[test]
    fn what_is_not_persisted_leaves_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("there");
        fs::write(&path, "precious").unwrap();
        let refused = Part::new(folder.path()).unwrap().persist(&path, false).unwrap_err();
        assert_eq!(refused.kind(), io::ErrorKind::AlreadyExists);
        drop(Part::new(folder.path()).unwrap());
        assert_eq!((left(folder.path()), fs::read(&path).unwrap()), (1, b"precious".to_vec()));
    }
}
