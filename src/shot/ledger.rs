//! What is known of frames that were written, so that a run can go on where another ended.
//!
//! Beside a frame's first file, in the hidden folder [`FOLDER`], lies a file of its own, as `.vglare/shot.0001.exr.json`: one line
//! of JSON, written under another name and renamed. A file each, and not lines added to one, because several machines write into a
//! folder at once, and a shared file system need not add lines whole; so that no entry can be lost or torn by another.
//! `cat .vglare/*.json` is the ledger as JSON lines.
//!
//! A frame is done where its entry is of this version, the same settings, and the same input, and what was written is still there
//! as it was. Files are compared by name, size and time of modification, and by their hash (BLAKE3, 256 bits) where those differ. Whatever cannot
//! be read, or is of another version, counts as not there.

use std::fmt::Debug;
use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};
use std::time::UNIX_EPOCH;

use serde::{Deserialize, Serialize};

use crate::target::{self, Identity};
use crate::{Error, Result};

/// The folder of entries, in that of the outputs.
pub const FOLDER: &str = ".vglare";
/// Of the form of an entry.
const VERSION: u32 = 1;

/// How a file looks from outside.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Stamp {
    /// As it was named.
    file: String,
    bytes: u64,
    /// Nanoseconds since 1970.
    modified: i64,
}

impl Stamp {
    /// That of a file; none of what is no file, as a pipe.
    pub fn of(path: &Path) -> Option<Self> {
        let about = fs::metadata(path).ok().filter(|about| about.is_file())?;
        let modified = about.modified().ok()?.duration_since(UNIX_EPOCH).ok()?.as_nanos().try_into().ok()?;
        Some(Self { file: path.to_string_lossy().into_owned(), bytes: about.len(), modified })
    }
}

/// A file, with what it holds.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
struct Mark {
    #[serde(flatten)]
    stamp: Stamp,
    hash: String,
}

impl Mark {
    fn of(stamp: Stamp, path: &Path) -> io::Result<Self> {
        Ok(Self { hash: hash_of(path)?, stamp })
    }

    /// Whether the file at `path` holds the same: by the stamp, or by what it holds. Gives its mark as it is now.
    fn still(&self, path: &Path) -> Option<Self> {
        let stamp = Stamp::of(path)?;
        if stamp == self.stamp {
            return Some(self.clone());
        }
        let same = stamp.bytes == self.stamp.bytes && hash_of(path).ok()? == self.hash;
        same.then(|| Self { stamp, hash: self.hash.clone() })
    }
}

/// How far a result is from the truth.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Measured {
    /// The bound.
    pub predicted: f64,
    /// The largest that was measured, in the same measure.
    pub measured: f64,
    /// The tolerance.
    pub asked: f64,
}

/// What is known of a frame that was written.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Entry {
    /// The version of this form.
    ledger: u32,
    /// The program's.
    vglare: String,
    settings: String,
    input: Mark,
    outputs: Vec<Mark>,
    /// Of the ghosts, relative to the largest glare; none where there are none.
    pub glare: Option<Measured>,
    /// Of the veil, relative to the veil at a pixel; none where there is none.
    pub veil: Option<Measured>,
}

impl Entry {
    /// Whether an error is beyond what was asked.
    pub fn missed(&self) -> bool {
        let missed = |error: &Measured| error.measured.is_nan() || error.measured > error.asked;
        self.glare.iter().chain(&self.veil).any(missed)
    }
}

/// The entries of frames that are made with the same settings.
#[derive(Debug)]
pub struct Ledger {
    settings: String,
}

impl Ledger {
    /// For settings, of which all counts that `Debug` shows, and what the files hold that they name.
    ///
    /// # Errors
    /// [`Error::SceneFile`] where such a file cannot be read.
    pub fn new(settings: &impl Debug, files: impl IntoIterator<Item = PathBuf>) -> Result<Self> {
        let mut hasher = blake3::Hasher::new();
        hasher.update(format!("{settings:?}").as_bytes());
        for path in files {
            let hash = hash_of(&path).map_err(|error| Error::scene_file(&path, error))?;
            hasher.update(hash.as_bytes());
        }
        Ok(Self { settings: hasher.finalize().to_hex().to_string() })
    }

    /// The entry of a frame that is done: made of this input with these settings by this version, and all there.
    pub fn done(&self, input: &Path, outputs: &[&Path]) -> Option<Entry> {
        let place = place(outputs.first()?)?;
        let entry: Entry = serde_json::from_slice(&fs::read(&place).ok()?).ok()?;
        let alike = entry.ledger == VERSION
            && entry.vglare == env!("CARGO_PKG_VERSION")
            && entry.settings == self.settings
            && entry.outputs.len() == outputs.len();
        if !alike || replaces(input, outputs) {
            return None;
        }
        // What is named otherwise may still be the same file: from another folder, or another machine.
        let input = entry.input.still(input)?;
        let marks =
            entry.outputs.iter().zip(outputs).map(|(mark, path)| mark.still(path)).collect::<Option<Vec<_>>>()?;
        if (&input, &marks) != (&entry.input, &entry.outputs) {
            let entry = Entry { input, outputs: marks, ..entry };
            // So that it is not read the next time; that time it is read again where this cannot be written.
            let _ = write(&place, &entry);
            return Some(entry);
        }
        Some(entry)
    }

    /// Notes a frame that was written. `read` is the input's stamp from before it was read: one that has changed since is not noted,
    /// and neither is one that its output replaces, nor what is no file.
    ///
    /// # Errors
    /// [`Error::Write`].
    pub fn note(
        &self,
        read: Option<&Stamp>,
        input: &Path,
        outputs: &[&Path],
        [glare, veil]: [Option<Measured>; 2],
    ) -> Result<()> {
        let (Some(read), Some(place)) = (read, outputs.first().and_then(|first| place(first))) else { return Ok(()) };
        if replaces(input, outputs) {
            return Ok(());
        }
        let marks = || -> io::Result<Option<Entry>> {
            let input_mark = Mark::of(read.clone(), input)?;
            if Stamp::of(input).as_ref() != Some(read) {
                return Ok(None);
            }
            let mut marks = Vec::with_capacity(outputs.len());
            for path in outputs {
                let Some(stamp) = Stamp::of(path) else { return Ok(None) };
                marks.push(Mark::of(stamp, path)?);
            }
            Ok(Some(Entry {
                ledger: VERSION,
                vglare: env!("CARGO_PKG_VERSION").to_owned(),
                settings: self.settings.clone(),
                input: input_mark,
                outputs: marks,
                glare,
                veil,
            }))
        };
        match marks().map_err(|error| Error::write(&place, error))? {
            Some(entry) => write(&place, &entry),
            None => Ok(()),
        }
    }
}

/// Forgets a frame, if anything is known of it; and the folder, where nothing else is in it.
pub fn forget(outputs: &[&Path]) {
    let Some(place) = outputs.first().and_then(|first| place(first)) else { return };
    // What cannot be removed is of no harm.
    if fs::remove_file(&place).is_ok() {
        let _ = fs::remove_dir(target::folder(&place));
    }
}

/// Whether an output takes the place of the input.
fn replaces(input: &Path, outputs: &[&Path]) -> bool {
    let input = Identity::of(input);
    outputs.iter().any(|output| Identity::of(output) == input)
}

/// Where the entry of a frame is, by its first output.
fn place(output: &Path) -> Option<PathBuf> {
    let mut name = output.file_name()?.to_owned();
    name.push(".json");
    Some(target::folder(output).join(FOLDER).join(name))
}

fn write(place: &Path, entry: &Entry) -> Result<()> {
    target::make_folder(target::folder(place))?;
    let line = serde_json::to_string(entry).expect("an entry is plain numbers and text");
    // After a loss of power it may be gone, and the frame is done again: no run has to wait for the disk.
    target::remember_text(place, &(line + "\n"))
}

/// BLAKE3 of a regular file, 256 bits in hexadecimal digits.
///
/// # Errors
/// Where it cannot be read, or is no file.
pub(crate) fn hash_of(path: &Path) -> io::Result<String> {
    if !path.is_file() {
        return Err(io::ErrorKind::InvalidInput.into());
    }
    Ok(blake3::Hasher::new().update_reader(File::open(path)?)?.finalize().to_hex().to_string())
}

#[cfg(test)]
mod tests {
    use std::fs::FileTimes;
    use std::time::{Duration, SystemTime};

    use super::*;

    struct Shot {
        folder: tempfile::TempDir,
        ledger: Ledger,
    }

    impl Shot {
        fn new() -> Self {
            let shot =
                Self { folder: tempfile::tempdir().unwrap(), ledger: Ledger::new(&("strength", 1.0), []).unwrap() };
            fs::write(shot.path("in"), "light").unwrap();
            fs::write(shot.path("out"), "glare").unwrap();
            shot
        }

        fn path(&self, name: &str) -> PathBuf {
            self.folder.path().join(name)
        }

        fn note(&self) {
            let input = self.path("in");
            let error = Measured { predicted: 2e-4, measured: 1e-4, asked: 1e-3 };
            let stamp = Stamp::of(&input);
            self.ledger.note(stamp.as_ref(), &input, &[&self.path("out")], [Some(error), None]).unwrap();
        }

        fn done(&self) -> Option<Entry> {
            self.ledger.done(&self.path("in"), &[&self.path("out")])
        }

        fn age(&self, name: &str) {
            let file = File::options().write(true).open(self.path(name)).unwrap();
            file.set_times(FileTimes::new().set_modified(SystemTime::now() - Duration::from_secs(99))).unwrap();
        }
    }

    #[test]
    fn a_frame_is_done_until_something_changes() {
        let shot = Shot::new();
        assert_eq!(shot.done(), None);
        shot.note();
        let entry = shot.done().expect("it is done");
        assert!(!entry.missed() && entry.glare.unwrap().measured == 1e-4);
        // What was touched or copied is read, and is the same; and it is noted that it is.
        for name in ["in", "out"] {
            shot.age(name);
            assert_ne!(shot.done().expect("it holds the same"), entry);
        }
        let text = fs::read_to_string(shot.path(".vglare/out.json")).unwrap();
        assert_eq!((text.lines().count(), serde_json::from_str(&text).ok()), (1, shot.done()));
        let other = Ledger::new(&("strength", 1.5), []).unwrap();
        assert_eq!(other.done(&shot.path("in"), &[&shot.path("out")]), None, "other settings");
        let other = Ledger::new(&("strength", 1.0), [shot.path("in")]).unwrap();
        assert_eq!(other.done(&shot.path("in"), &[&shot.path("out")]), None, "a file of the settings");
        assert_eq!(shot.ledger.done(&shot.path("in"), &[&shot.path("out"), &shot.path("in")]), None, "more outputs");
    }

    #[test]
    fn what_is_torn_changed_or_gone_is_to_be_done_again() {
        type Harm = fn(&Shot);
        let harms: [(&str, Harm); 8] = [
            ("another input", |shot| fs::write(shot.path("in"), "brighter").unwrap()),
            ("another input as long", |shot| {
                fs::write(shot.path("in"), "night").unwrap();
                shot.age("in");
            }),
            ("a torn output", |shot| fs::write(shot.path("out"), "gla").unwrap()),
            ("a changed output", |shot| {
                fs::write(shot.path("out"), "GLARE").unwrap();
                shot.age("out");
            }),
            ("no output", |shot| fs::remove_file(shot.path("out")).unwrap()),
            ("no input", |shot| fs::remove_file(shot.path("in")).unwrap()),
            ("a torn entry", |shot| {
                let path = shot.path(".vglare/out.json");
                let text = fs::read(&path).unwrap();
                fs::write(path, &text[..text.len() / 2]).unwrap();
            }),
            ("another version", |shot| {
                let path = shot.path(".vglare/out.json");
                let text = fs::read_to_string(&path).unwrap().replace("\"ledger\":1", "\"ledger\":2");
                fs::write(path, text).unwrap();
            }),
        ];
        for (what, harm) in harms {
            let shot = Shot::new();
            shot.note();
            assert!(shot.done().is_some());
            harm(&shot);
            assert_eq!(shot.done(), None, "{what}");
        }
    }

    #[test]
    fn an_input_that_changes_while_it_is_read_is_not_noted() {
        let shot = Shot::new();
        let (input, output) = (shot.path("in"), shot.path("out"));
        let before = Stamp::of(&input);
        shot.age("in");
        shot.ledger.note(before.as_ref(), &input, &[&output], [None, None]).unwrap();
        assert!(!shot.path(FOLDER).exists());
        // Nor what its output replaces.
        shot.ledger.note(Stamp::of(&output).as_ref(), &output, &[&output], [None, None]).unwrap();
        assert_eq!(shot.ledger.done(&output, &[&output]), None);
    }

    #[test]
    fn entries_of_many_writers_are_all_there() {
        let shot = Shot::new();
        std::thread::scope(|scope| {
            for writer in 0..8 {
                let shot = &shot;
                scope.spawn(move || {
                    for frame in 0..10 {
                        let output = shot.path(&format!("out.{writer}.{frame}"));
                        fs::write(&output, [writer, frame]).unwrap();
                        let input = shot.path("in");
                        shot.ledger.note(Stamp::of(&input).as_ref(), &input, &[&output], [None, None]).unwrap();
                    }
                });
            }
        });
        assert_eq!(fs::read_dir(shot.path(FOLDER)).unwrap().count(), 80);
    }
}
