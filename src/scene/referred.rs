//! Which other files a scene or lens file refers to.

use std::fs;
use std::path::{Path, PathBuf};

/// A file beyond this many bytes is not looked into.
const LONGEST: u64 = 1 << 26;

/// The files of profiles and of the veil that a scene or lens file names, which lie beside it. None where it is no such file.
pub fn referred(path: &Path) -> Vec<PathBuf> {
    if !fs::metadata(path).is_ok_and(|about| about.is_file() && about.len() <= LONGEST) {
        return Vec::new();
    }
    let table: toml::Table = fs::read_to_string(path).ok().and_then(|text| text.parse().ok()).unwrap_or_default();
    let profiles = table.get("profile").and_then(toml::Value::as_array);
    let veil = |key| table.get("veil").and_then(|veil| veil.get(key)?.as_str());
    let files = profiles.into_iter().flatten().filter_map(|profile| profile.get("file")?.as_str());
    let optics = table.get("optics").and_then(|optics| optics.get("file")?.as_str());
    let files = files.chain(optics).chain(veil("table")).chain(veil("kernel"));
    files.map(|file| path.parent().unwrap_or(Path::new("")).join(file)).collect()
}
