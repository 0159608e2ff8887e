//! What `vglare calibrate` measured, kept in the user's cache folder: one file, an entry for each renderer.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use etcetera::BaseStrategy as _;
use serde::{Deserialize, Serialize};

use crate::gpu::Info;
use crate::plan::CostModel;
use crate::{Error, Result, target};

/// Names another folder than the user's cache folder.
pub const FOLDER: &str = "VGLARE_CACHE";

const FILE: &str = "calibration.json";

/// What is known of a renderer's speed.
#[derive(Debug, Clone, Default)]
pub struct Known {
    /// The model that was measured, or the built-in one.
    pub model: CostModel,
    /// The file that it is from; none for the built-in one.
    pub file: Option<PathBuf>,
    /// Why a file that is there was not used, or only in part.
    pub warning: Option<String>,
}

impl Known {
    /// What is known of a device.
    pub fn of(device: &Info) -> Self {
        // Without a cache folder nothing was ever kept.
        let Ok(path) = path() else { return Self::default() };
        match read(&path) {
            Ok(kept) => {
                let key = Key::of(device);
                let entry = kept.calibrations.into_iter().find(|entry| entry.key == key);
                entry.map_or_else(Self::default, |entry| {
                    let completed = entry.nanoseconds.completed();
                    let warning = entry.nanoseconds.lacks().map(|what| {
                        format!("{} is from before {what}; `vglare calibrate` measures that too", path.display())
                    });
                    Self { model: completed.unwrap_or(entry.nanoseconds), file: Some(path), warning }
                })
            }
            Err(reason) => {
                let warning = format!("{} is not used: {reason}; `vglare calibrate` replaces it", path.display());
                Self { warning: Some(warning), ..Self::default() }
            }
        }
    }
}

/// What a calibration holds for.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Key {
    vglare: String,
    renderer: String,
    driver: String,
}

impl Key {
    fn of(device: &Info) -> Self {
        Self {
            vglare: env!("CARGO_PKG_VERSION").to_owned(),
            renderer: device.renderer.clone(),
            driver: device.version.clone(),
        }
    }
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Entry {
    #[serde(flatten)]
    key: Key,
    nanoseconds: CostModel,
}

/// The file.
#[derive(Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Kept {
    calibrations: Vec<Entry>,
}

/// Where calibrations are kept.
///
/// # Errors
/// [`Error::Usage`] where the user has no home.
pub fn path() -> Result<PathBuf> {
    if let Some(folder) = std::env::var_os(FOLDER).filter(|folder| !folder.is_empty()) {
        return Ok(PathBuf::from(folder).join(FILE));
    }
    let strategy = etcetera::choose_base_strategy()
        .map_err(|reason| Error::Usage(format!("there is no cache folder ({reason}); {FOLDER} can name one")))?;
    Ok(strategy.cache_dir().join("vglare").join(FILE))
}

/// Makes the folder, so that what was measured can be kept; asked before the long work starts.
///
/// # Errors
/// [`Error::Write`] where the folder cannot be made or the file cannot be one, and that of [`path`].
pub fn ready() -> Result<()> {
    let path = path()?;
    if let Some(folder) = path.parent() {
        target::make_folder(folder)?;
    }
    target::check(&path, true)
}

/// What the file has; nothing where it is not there.
fn read(path: &Path) -> std::result::Result<Kept, String> {
    let text = match std::fs::read_to_string(path) {
        Ok(text) => text,
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(Kept::default()),
        Err(error) => return Err(error.to_string()),
    };
    let kept: Kept = serde_json::from_str(&text).map_err(|error| format!("it is no calibration ({error})"))?;
    let sound = |model: &CostModel| model.completed().unwrap_or(*model).is_sound();
    match kept.calibrations.iter().find(|entry| !sound(&entry.nanoseconds)) {
        Some(entry) => Err(format!("what it has for {} cannot be times", entry.key.renderer)),
        None => Ok(kept),
    }
}

/// Keeps what was measured on a device, instead of what was kept for it before and of what other versions of vglare
/// measured. Gives a warning where the file that was there could not be read.
///
/// # Errors
/// [`Error::Write`] where the folder or the file cannot be written, and that of [`path`].
pub fn keep(device: &Info, model: CostModel) -> Result<Option<String>> {
    let path = path()?;
    let (mut kept, warning) = match read(&path) {
        Ok(kept) => (kept, None),
        Err(reason) => (Kept::default(), Some(format!("{} was replaced: {reason}", path.display()))),
    };
    let key = Key::of(device);
    kept.calibrations.retain(|entry| entry.key != key && entry.key.vglare == key.vglare);
    kept.calibrations.push(Entry { key, nanoseconds: model });
    target::write_json(&path, &kept, true)?;
    Ok(warning)
}

/// Removes the file; says whether there was one.
///
/// # Errors
/// [`Error::Write`] where it is there and cannot be removed, and that of [`path`].
pub fn forget() -> Result<bool> {
    let path = path()?;
    match std::fs::remove_file(&path) {
        Ok(()) => Ok(true),
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(false),
        Err(error) => Err(Error::write(&path, error)),
    }
}
