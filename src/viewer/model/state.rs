//! What the window remembers from one time to the next, in the user's state folder: the last look, the photos that were
//! opened last, the window's size, and its theme.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use etcetera::BaseStrategy as _;

use super::Look;
use crate::scene::{checked_toml, read_scene};
use crate::{Error, Result, target};

/// Names another folder than the user's state folder.
pub const FOLDER: &str = "VGLARE_STATE";

/// Most photos in the list.
pub const MOST_RECENT: usize = 12;

const LOOK: &str = "look.toml";
const RECENT: &str = "recent.json";
const WINDOW: &str = "window.json";
const THEME: &str = "theme.json";

/// The window's colours.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Theme {
    /// As the desktop has them.
    #[default]
    System,
    /// Light ones.
    Light,
    /// Dark ones.
    Dark,
}

/// The folder.
#[derive(Debug, Clone, PartialEq)]
pub struct State {
    folder: PathBuf,
}

impl State {
    /// The user's.
    ///
    /// # Errors
    /// [`Error::Usage`] where the user has no home.
    pub fn of_user() -> Result<Self> {
        if let Some(folder) = std::env::var_os(FOLDER).filter(|folder| !folder.is_empty()) {
            return Ok(Self::in_folder(PathBuf::from(folder)));
        }
        let strategy = etcetera::choose_base_strategy()
            .map_err(|reason| Error::Usage(format!("there is no state folder ({reason}); {FOLDER} can name one")))?;
        // Windows has no folder for state alone.
        let folder = strategy.state_dir().unwrap_or_else(|| strategy.data_dir());
        Ok(Self::in_folder(folder.join("vglare")))
    }

    /// That of another folder, which need not be there.
    pub fn in_folder(folder: PathBuf) -> Self {
        Self { folder }
    }

    /// Keeps a look instead of the one that was kept before.
    ///
    /// # Errors
    /// Those of `checked_toml` and `target::remember_text`, and [`Error::Write`] where the folder cannot be made.
    pub fn keep_look(&self, look: &Look) -> Result<()> {
        let path = self.place(LOOK)?;
        target::remember_text(&path, &checked_toml(&path, &look.to_scene())?)
    }

    /// Where the look is kept.
    pub fn look_file(&self) -> PathBuf {
        self.folder.join(LOOK)
    }

    /// The look that was kept, if there is one.
    ///
    /// # Errors
    /// Those of [`read_scene`].
    pub fn look(&self) -> Result<Option<Look>> {
        let path = self.look_file();
        if path.exists() { read_scene(&path).and_then(Look::from_scene).map(Some) } else { Ok(None) }
    }

    /// Puts a photo at the head of the list, which then has it once; the oldest of too many is forgotten. A list that
    /// cannot be read begins anew.
    ///
    /// # Errors
    /// [`Error::Write`] where the folder cannot be made or the list cannot be written.
    pub fn opened(&self, photo: &Path) -> Result<()> {
        let photo = std::path::absolute(photo).unwrap_or_else(|_| photo.to_owned());
        let mut recent = self.recent().unwrap_or_default();
        recent.retain(|other| *other != photo);
        recent.insert(0, photo);
        recent.truncate(MOST_RECENT);
        target::remember_json(&self.place(RECENT)?, &recent)
    }

    /// The photos that were opened last, the latest first.
    ///
    /// # Errors
    /// [`Error::SceneFile`] where the list is there and cannot be read.
    pub fn recent(&self) -> Result<Vec<PathBuf>> {
        let path = self.folder.join(RECENT);
        let text = match std::fs::read_to_string(&path) {
            Ok(text) => text,
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(Vec::new()),
            Err(error) => return Err(Error::scene_file(&path, format_args!("cannot be read: {error}"))),
        };
        serde_json::from_str(&text)
            .map_err(|error| Error::scene_file(&path, format_args!("it is no list of photos ({error})")))
    }

    /// Keeps the window's columns and rows, in points.
    ///
    /// # Errors
    /// [`Error::Write`] where the folder cannot be made or the file cannot be written.
    pub fn keep_size(&self, size: [u32; 2]) -> Result<()> {
        target::remember_json(&self.place(WINDOW)?, &size)
    }

    /// The window's size, if one was kept that is of use.
    pub fn size(&self) -> Option<[u32; 2]> {
        let text = std::fs::read_to_string(self.folder.join(WINDOW)).ok()?;
        let size: [u32; 2] = serde_json::from_str(&text).ok()?;
        size.iter().all(|side| (100..=16384).contains(side)).then_some(size)
    }

    /// Keeps the window's theme.
    ///
    /// # Errors
    /// [`Error::Write`] where the folder cannot be made or the file cannot be written.
    pub fn keep_theme(&self, theme: Theme) -> Result<()> {
        target::remember_json(&self.place(THEME)?, &theme)
    }

    /// The window's theme, if one was kept that is known.
    pub fn theme(&self) -> Option<Theme> {
        let text = std::fs::read_to_string(self.folder.join(THEME)).ok()?;
        serde_json::from_str(&text).ok()
    }

    /// A file in the folder, which is made if need be.
    fn place(&self, name: &str) -> Result<PathBuf> {
        let path = self.folder.join(name);
        std::fs::create_dir_all(&self.folder).map_err(|reason| Error::write(&path, reason))?;
        Ok(path)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn state() -> (tempfile::TempDir, State) {
        let folder = tempfile::tempdir().unwrap();
        let state = State::in_folder(folder.path().join("made/if/need be"));
        (folder, state)
    }

    #[test]
    fn a_look_is_kept_until_the_next() {
        let (_folder, state) = state();
        assert_eq!(state.look().unwrap(), None);
        for strength in [0.1, 2.0 / 3.0] {
            let look = Look { strength, ..Look::default() };
            state.keep_look(&look).unwrap();
            assert_eq!(state.look().unwrap(), Some(look));
        }
        let refused = state.keep_look(&Look { strength: f64::NAN, ..Look::default() });
        assert!(matches!(refused, Err(Error::SceneFile { .. })));
        assert_eq!(state.look().unwrap().unwrap().strength, 2.0 / 3.0);
        std::fs::write(state.folder.join(LOOK), "strength = 1").unwrap();
        assert!(state.look().unwrap_err().to_string().contains("look.toml: line 1"));
    }

    #[test]
    fn photos_are_listed_once_and_the_oldest_are_forgotten() {
        let (_folder, state) = state();
        assert_eq!(state.recent().unwrap(), [] as [PathBuf; 0]);
        let photo = |k: usize| std::path::absolute(format!("{k}.exr")).unwrap();
        for k in [0, 1, 0] {
            state.opened(Path::new(&format!("{k}.exr"))).unwrap();
        }
        assert_eq!(state.recent().unwrap(), [photo(0), photo(1)]);
        (0..20).for_each(|k| state.opened(&photo(k)).unwrap());
        assert_eq!(state.recent().unwrap(), (8..20).rev().map(photo).collect::<Vec<_>>());
        std::fs::write(state.folder.join(RECENT), "[1]").unwrap();
        assert!(matches!(state.recent(), Err(Error::SceneFile { .. })));
        state.opened(&photo(3)).unwrap();
        assert_eq!(state.recent().unwrap(), [photo(3)]);
    }

    #[test]
    fn the_windows_size_is_kept_where_it_is_of_use() {
        let (_folder, state) = state();
        assert_eq!(state.size(), None);
        state.keep_size([1000, 700]).unwrap();
        assert_eq!(state.size(), Some([1000, 700]));
        state.keep_size([1000, 0]).unwrap();
        assert_eq!(state.size(), None);
    }

    #[test]
    fn the_theme_is_kept_where_it_is_known() {
        let (_folder, state) = state();
        assert_eq!(state.theme(), None);
        for theme in [Theme::Light, Theme::System, Theme::Dark] {
            state.keep_theme(theme).unwrap();
            assert_eq!(state.theme(), Some(theme));
        }
        std::fs::write(state.folder.join(THEME), "\"sepia\"").unwrap();
        assert_eq!(state.theme(), None);
    }

    #[test]
    fn a_folder_that_cannot_be_made_is_an_error() {
        let (folder, _) = state();
        std::fs::write(folder.path().join("file"), "").unwrap();
        let state = State::in_folder(folder.path().join("file/state"));
        assert!(matches!(state.keep_look(&Look::default()), Err(Error::Write { .. })));
        assert!(matches!(state.opened(Path::new("a.exr")), Err(Error::Write { .. })));
    }
}
