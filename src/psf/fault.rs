//! What can be wrong with what a user writes, by the key that it is written under.

use std::fmt;
use std::path::{Path, PathBuf};

/// Something that a point-spread function must not be told.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fault {
    /// The key, as it stands in a scene file; on the command line it is the option's name.
    pub key: &'static str,
    /// Why, in words.
    pub reason: String,
    /// The file that the key names, where it is that which cannot be read, and not the key that is wrong.
    pub unread: Option<PathBuf>,
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "`{}`: {}", self.key, self.in_words())
    }
}

impl std::error::Error for Fault {}

impl Fault {
    /// Of the key `key`.
    pub(crate) fn new(key: &'static str, reason: impl Into<String>) -> Self {
        Self { key, reason: reason.into(), unread: None }
    }

    /// Why, with the file that cannot be read.
    pub fn in_words(&self) -> String {
        match &self.unread {
            Some(path) => format!("{}: {}", path.display(), self.reason),
            None => self.reason.clone(),
        }
    }

    /// Of a file that the key `key` names, and which cannot be read.
    pub(crate) fn of_file(key: &'static str, path: &Path, reason: impl Into<String>) -> Self {
        Self { key, reason: reason.into(), unread: Some(path.to_owned()) }
    }
}

/// `value`, if it is a number from `range[0]` to `range[1]`; `rule` says that in words.
pub(super) fn within(key: &'static str, value: f64, range: [f64; 2], rule: &str) -> Result<f64, Fault> {
    // A number that is not one is within no range. Not below 0, which would be written as such.
    if (range[0]..=range[1]).contains(&value) {
        Ok(value + 0.0)
    } else {
        Err(Fault::new(key, format!("{rule}, and not {value}")))
    }
}

/// `value`, if it is above 0 and such that neither it nor its square leaves what 32-bit floats hold.
pub(super) fn positive(key: &'static str, value: f64) -> Result<f64, Fault> {
    within(key, value, POSITIVE, "a number from 1e-18 to 1e18")
}

/// What [`positive`] takes.
const POSITIVE: [f64; 2] = [1e-18, 1e18];
