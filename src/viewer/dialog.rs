//! The desktop's own dialogs for paths, each on a thread of its own: the window goes on meanwhile.

use std::ffi::OsString;
use std::io;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use rfd::FileDialog;

use super::ask::Purpose;
use super::loader::Wake;
use super::task::{State, Task};

/// What comes back sooner without a path was never shown: nobody is that quick.
const SHOWN: Duration = Duration::from_millis(500);

/// A photo's extensions, a scene file's, and a table's.
const PHOTOS: [&str; 9] = ["exr", "hdr", "pfm", "tif", "tiff", "png", "jpg", "jpeg", "jxl"];
const SCENES: [&str; 1] = ["toml"];
const TABLES: [&str; 2] = ["csv", "txt"];

/// A dialog that is open.
pub struct Dialog {
    purpose: Purpose,
    started: Instant,
    task: Task<Option<Vec<PathBuf>>>,
}

/// What has become of one.
#[derive(Debug, PartialEq)]
pub enum Answer {
    /// It is still open.
    None,
    /// These paths, or none after all. That something may be replaced was asked.
    Paths(Vec<PathBuf>),
    /// The desktop has none to show.
    Missing,
}

/// Whether this desktop has dialogs, as far as is known without asking it, which may take seconds.
pub fn exist() -> bool {
    if cfg!(all(unix, not(target_os = "macos"))) { exist_among(|name| std::env::var_os(name)) } else { true }
}

/// The same for an environment: `zenity` on the path, or a portal that the session's bus can start.
fn exist_among(variable: impl Fn(&str) -> Option<OsString>) -> bool {
    let set = |name: &str| variable(name).filter(|value| !value.is_empty());
    let among = |folders: OsString, file: &str| std::env::split_paths(&folders).any(|path| path.join(file).is_file());
    if set("PATH").is_some_and(|folders| among(folders, "zenity")) {
        return true;
    }
    let bus = || set("XDG_RUNTIME_DIR").is_some_and(|folder| Path::new(&folder).join("bus").exists());
    let folders = set("XDG_DATA_DIRS").unwrap_or_else(|| "/usr/local/share:/usr/share".into());
    let portal = "dbus-1/services/org.freedesktop.portal.Desktop.service";
    (set("DBUS_SESSION_BUS_ADDRESS").is_some() || bus()) && among(folders, portal)
}

impl Dialog {
    /// Opens one that begins at a path that is likely.
    ///
    /// # Errors
    /// Where the system gives no thread.
    pub fn open(purpose: Purpose, likely: &Path, wake: &Wake) -> io::Result<Self> {
        let [title, _] = purpose.words();
        let mut dialog = FileDialog::new().set_title(title);
        dialog = match purpose {
            Purpose::OpenLook | Purpose::SaveLook => dialog.add_filter("Scene files", &SCENES),
            Purpose::OpenTable => dialog.add_filter("Tables", &TABLES),
            Purpose::OpenPhoto | Purpose::OpenKernel => dialog.add_filter("Pictures", &PHOTOS),
            // JPEG XL is read alone.
            Purpose::SavePicture | Purpose::SaveGlare => dialog.add_filter("Pictures", &PHOTOS[..8]),
        };
        dialog = dialog.add_filter("All files", &["*"]);
        let folder = if likely.is_dir() { Some(likely) } else { likely.parent() };
        if let Some(folder) = folder.filter(|folder| folder.is_dir()) {
            dialog = dialog.set_directory(folder);
        }
        if let (true, Some(name)) = (purpose.saves(), likely.file_name()) {
            dialog = dialog.set_file_name(name.to_string_lossy());
        }
        let task = Task::start("dialog", wake, move || match purpose {
            Purpose::OpenPhoto => dialog.pick_files(),
            Purpose::OpenLook | Purpose::OpenTable | Purpose::OpenKernel => dialog.pick_file().map(|path| vec![path]),
            Purpose::SavePicture | Purpose::SaveGlare | Purpose::SaveLook => dialog.save_file().map(|path| vec![path]),
        })?;
        Ok(Self { purpose, started: Instant::now(), task })
    }

    /// What its path is for.
    pub fn purpose(&self) -> Purpose {
        self.purpose
    }

    /// Looks after it. An answer is there once.
    pub fn poll(&self) -> Answer {
        match self.task.poll() {
            State::Running => Answer::None,
            State::Done(Some(paths)) => Answer::Paths(paths),
            // rfd tells of one that was closed and of one that could not be shown alike.
            State::Done(None) if self.started.elapsed() > SHOWN => Answer::Paths(Vec::new()),
            State::Done(None) | State::Failed(_) => Answer::Missing,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dialogs_exist_with_zenity_or_a_bus_that_has_a_portal() {
        let folder = tempfile::tempdir().unwrap();
        let place = |name: &str| folder.path().join(name);
        std::fs::create_dir_all(place("share/dbus-1/services")).unwrap();
        std::fs::create_dir_all(place("bin")).unwrap();
        let with = |set: &[(&str, &str)]| {
            let value = |name: &str| set.iter().find(|(other, _)| *other == name).map(|(_, path)| place(path).into());
            exist_among(value)
        };
        let portal = [("XDG_DATA_DIRS", "share"), ("DBUS_SESSION_BUS_ADDRESS", "bus")];
        assert!(!with(&[("PATH", "bin")]) && !with(&portal));
        std::fs::write(place("bin/zenity"), "").unwrap();
        assert!(with(&[("PATH", "bin")]) && !with(&portal));
        std::fs::write(place("share/dbus-1/services/org.freedesktop.portal.Desktop.service"), "").unwrap();
        assert!(with(&portal) && !with(&portal[..1]));
        std::fs::write(place("bus"), "").unwrap();
        assert!(with(&[portal[0], ("XDG_RUNTIME_DIR", "")]));
        assert!(!with(&[portal[0], ("XDG_RUNTIME_DIR", "bin")]));
    }
}
