//! What the window does with files: looks and pictures in and out, and what it remembers.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant, SystemTime};

use egui::{CentralPanel, Panel, ProgressBar, ThemePreference, Ui};

use super::App;
use super::ask::{Questions, likely};
use super::menu::{mark, recent};
use crate::options::command_line;
use crate::scene::{read_scene, write_scene};
use crate::viewer::ask::Purpose;
use crate::viewer::document::Document;
use crate::viewer::export::{Export, Subject};
use crate::viewer::model::{Look, State, Theme};
use crate::{Result, target};

/// How often the file of a look is looked at while nothing else happens.
const LOOK_AGAIN: Duration = Duration::from_secs(2);

/// How often a look is remembered while a gesture goes on, in seconds.
const KEEP_AGAIN: f64 = 2.0;

/// What is said to who closes the window too soon, and for how long what they then call off may take to end.
const STILL_WRITING: &str = "a picture is still being written; close again to call it off";
const GRACE: Duration = Duration::from_secs(2);

/// What the window knows of files besides the photos.
#[derive(Default)]
pub struct Files {
    pub(super) questions: Questions,
    exports: Vec<Export>,
    /// Where looks and recent photos are remembered, if anywhere.
    pub(super) state: Option<State>,
    /// The look of last time, and what is remembered by now.
    pub(super) last: Option<Look>,
    pub(super) kept: Option<Look>,
    /// When that was, in egui's seconds.
    kept_at: f64,
    pub(super) recent: Vec<PathBuf>,
    /// What was done last, until something else is to be done.
    pub(super) done: Option<String>,
    /// The theme as it is remembered.
    theme: Option<Theme>,
}

/// The scene file that a look was read from or written to last.
pub struct LookFile {
    pub(super) path: PathBuf,
    modified: Option<SystemTime>,
    /// The look that it holds.
    look: Look,
}

impl LookFile {
    fn new(path: &Path, look: &Look) -> Self {
        Self { path: path.to_owned(), modified: modified(path), look: look.clone() }
    }
}

impl App {
    /// Remembers looks and photos in a folder, and recalls what was remembered there.
    pub fn remember(&mut self, state: State) {
        match state.look() {
            Ok(look) => self.files.last = look,
            Err(error) => self.notice(error.to_string()),
        }
        self.files.recent = state.recent().unwrap_or_default();
        if let Some(theme) = state.theme() {
            self.context.set_theme(preference(theme));
        }
        self.files.theme = Some(self.theme());
        self.files.state = Some(state);
    }

    /// The photos that were opened last, the latest first.
    pub fn recent(&self) -> &[PathBuf] {
        &self.files.recent
    }

    /// What was saved or copied last, until something else is to be.
    pub fn done(&self) -> Option<&str> {
        self.files.done.as_deref()
    }

    /// Whether pictures are being written.
    pub fn is_writing(&self) -> bool {
        !self.files.exports.is_empty()
    }

    /// Whether the window may close. While pictures are being written it has to be asked twice, which calls them off.
    pub fn may_close(&mut self) -> bool {
        if !self.is_writing() {
            return true;
        }
        if !self.notices.iter().any(|notice| notice == STILL_WRITING) {
            self.notice(STILL_WRITING.into());
            return false;
        }
        self.files.exports.iter().for_each(Export::cancel);
        // What is in the middle of being written takes its temporary file along.
        let until = Instant::now() + GRACE;
        while Instant::now() < until && self.files.exports.iter().any(|export| export.poll().is_none()) {
            std::thread::sleep(Duration::from_millis(5));
        }
        true
    }

    /// Takes the look of a scene file for the document that is shown. Where it cannot be read, the look stays.
    pub fn open_look(&mut self, path: &Path) {
        let look = read_scene(path).and_then(Look::from_scene);
        match (look, self.document_mut()) {
            (Err(error), _) => self.notice(error.to_string()),
            (Ok(_), None) => {}
            (Ok(look), Some(document)) => {
                document.file = Some(LookFile::new(path, &look));
                document.set_look(look);
            }
        }
    }

    /// Whether a path is none of the files that the window shows: the photos, but for `own`, and their looks' files.
    fn check_spare(&self, path: &Path, own: Option<&Path>, looks: bool) -> Result<()> {
        let documents = || self.documents.iter().map(|(_, document)| document);
        let photos = documents().map(|document| document.path.as_path()).filter(|photo| Some(*photo) != own);
        let files = documents().filter_map(|document| Some(document.file.as_ref()?.path.as_path()));
        let photos = photos.map(|photo| ("a photo that is open", photo));
        let inputs: Vec<_> = photos.chain(files.filter(|_| looks).map(|file| ("the file of a look", file))).collect();
        target::spare(&[("this", path)], &inputs)
    }

    /// Writes the look of the document that is shown as a scene file, in place of one that is there, unless that is a photo.
    pub fn save_look(&mut self, path: &Path) {
        if let Err(error) = self.check_spare(path, None, false) {
            return self.notice(error.to_string());
        }
        let Some(document) = self.document_mut() else { return };
        match write_scene(path, &document.look.to_scene(), true) {
            Ok(()) => {
                document.file = Some(LookFile::new(path, &document.look));
                self.files.done = Some(format!("Saved {}", path.display()));
            }
            Err(error) => self.notice(error.to_string()),
        }
    }

    /// Begins to write a picture of the document that is shown, in place of one that is there, unless that is another photo
    /// or a look's file. The glare alone does not replace its own photo either.
    pub fn export(&mut self, subject: Subject, path: &Path) {
        let Some(document) = self.document() else { return };
        let own = (subject == Subject::Picture).then_some(document.path.as_path());
        if let Err(error) = self.check_spare(path, own, true) {
            return self.notice(error.to_string());
        }
        match Export::start(document, subject, path, &self.wake) {
            Ok(export) => self.files.exports.push(export),
            Err(error) => self.notice(error.to_string()),
        }
    }

    /// Copies the command line that does what the window shows.
    pub(super) fn copy_command(&mut self) {
        let Some(document) = self.document() else { return };
        match command(document) {
            Ok(line) => {
                self.context.copy_text(line);
                self.files.done = Some("Copied the command line".into());
            }
            Err(error) => self.notice(error.to_string()),
        }
    }

    /// Remembers a photo that was opened.
    pub(super) fn remember_photo(&mut self, path: &Path) {
        let Some(state) = &self.files.state else { return };
        match state.opened(path) {
            Ok(()) => self.files.recent = state.recent().unwrap_or_default(),
            Err(error) => self.notice(error.to_string()),
        }
    }

    /// Remembers the look once it rests, and now and then while a gesture goes on.
    pub(super) fn remember_look(&mut self, gesture: bool) {
        let now = self.context.time();
        if !gesture || now - self.files.kept_at > KEEP_AGAIN {
            self.write_look();
            self.files.kept_at = now;
        }
    }

    /// Remembers the look, where it is not the one that the photo was opened with.
    pub(super) fn write_look(&mut self) {
        let Some((_, document)) = self.documents.get(self.current) else { return };
        let Some(state) = &self.files.state else { return };
        if self.files.kept.as_ref() == Some(&document.look) || document.look == document.opened {
            return;
        }
        self.files.kept = Some(document.look.clone());
        if let Err(error) = state.keep_look(&document.look) {
            self.notice(error.to_string());
        }
    }

    fn theme(&self) -> Theme {
        match self.context.options(|options| options.theme_preference) {
            ThemePreference::System => Theme::System,
            ThemePreference::Light => Theme::Light,
            ThemePreference::Dark => Theme::Dark,
        }
    }

    /// Remembers the theme, where it was changed.
    pub(super) fn remember_theme(&mut self) {
        let theme = self.theme();
        let Some(state) = self.files.state.as_ref().filter(|_| self.files.theme != Some(theme)) else { return };
        self.files.theme = Some(theme);
        if let Err(error) = state.keep_theme(theme) {
            self.notice(error.to_string());
        }
    }

    /// Takes what has come of exports, and looks whose files have changed.
    pub(super) fn take_in_files(&mut self) {
        let mut ended = Vec::new();
        self.files.exports.retain(|export| match export.poll() {
            None => true,
            Some(result) => {
                ended.push((export.path.clone(), result));
                false
            }
        });
        if self.files.exports.is_empty() {
            self.notices.retain(|notice| notice != STILL_WRITING);
        }
        for (path, result) in ended {
            match result {
                Ok(warnings) => {
                    self.files.done = Some(format!("Saved {}", path.display()));
                    warnings.into_iter().for_each(|text| self.notice(format!("{}: {text}", path.display())));
                }
                Err(crate::Error::Cancelled) => {}
                Err(error) => self.notice(error.to_string()),
            }
        }
        let Some(file) = self.document_mut().and_then(|document| document.file.as_mut()) else { return };
        let now = modified(&file.path);
        if now.is_some() && now != file.modified {
            file.modified = now;
            let path = file.path.clone();
            self.open_look(&path);
        }
    }

    /// When the look's file is to be looked at again, where there is one.
    pub(super) fn next_look(&self) -> Duration {
        let watched = self.document().is_some_and(|document| document.file.is_some());
        if watched { LOOK_AGAIN } else { Duration::MAX }
    }

    /// What is there to begin with.
    pub(super) fn start(&mut self, ui: &mut Ui) {
        let mut chosen = None;
        CentralPanel::default().show(ui, |ui| {
            ui.vertical_centered(|ui| {
                ui.add_space(0.3 * ui.available_height());
                ui.label("Drop photos here");
                chosen = recent(ui, self.recent());
            });
        });
        if let Some(path) = chosen {
            self.open(path);
        }
    }

    /// What is being written.
    pub(super) fn exports(&mut self, ui: &mut Ui) {
        let mut index = 0;
        self.files.exports.retain(|export| {
            index += 1;
            let strip = Panel::bottom(("export", index)).show(ui, |ui| {
                ui.horizontal(|ui| {
                    ui.add(ProgressBar::new(export.part()).desired_width(220.0).text(export.step().to_string()));
                    let about = "The file does not appear then";
                    let cancel = ui.button("Cancel").on_hover_text(about);
                    mark(ui, "Cancel writing", about, &cancel);
                    ui.label(export.path.display().to_string());
                    cancel.clicked()
                })
                .inner
            });
            if strip.inner {
                // It comes to an end by itself, and nobody waits for it.
                export.cancel();
            }
            !strip.inner
        });
    }
}

/// The command line for a document; its look file is named where it holds the look as it is.
fn command(document: &Document) -> Result<String> {
    let file = document.file.as_ref().filter(|file| file.look == document.look);
    let output = likely(document, Purpose::SavePicture);
    command_line(&document.look, &document.path, &output, file.map(|file| file.path.as_path()))
}

fn preference(theme: Theme) -> ThemePreference {
    match theme {
        Theme::System => ThemePreference::System,
        Theme::Light => ThemePreference::Light,
        Theme::Dark => ThemePreference::Dark,
    }
}

fn modified(path: &Path) -> Option<SystemTime> {
    path.metadata().and_then(|about| about.modified()).ok()
}
