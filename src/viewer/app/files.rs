//! What the window does with files: looks and pictures in and out, and what it remembers.

use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

use egui::{CentralPanel, Key, Modifiers, Panel, ThemePreference, Ui};

use super::App;
use crate::Result;
use crate::scene::{read_scene, write_scene};
use crate::viewer::ask::{Answer, Ask, Purpose};
use crate::viewer::document::Document;
use crate::viewer::export::{Export, Subject};
use crate::viewer::model::{Look, State, Theme, command_line};

/// How often the file of a look is looked at while nothing else happens.
const LOOK_AGAIN: Duration = Duration::from_secs(2);

/// What the window knows of files besides the photos.
#[derive(Default)]
pub struct Files {
    ask: Option<Ask>,
    exports: Vec<Export>,
    /// Where looks and recent photos are remembered, if anywhere.
    state: Option<State>,
    /// The look of last time, and what is remembered by now.
    last: Option<Look>,
    kept: Option<Look>,
    recent: Vec<PathBuf>,
    /// The theme as it is remembered.
    theme: Option<Theme>,
}

/// The scene file that a look was read from or written to last.
pub struct LookFile {
    path: PathBuf,
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

    /// Whether pictures are being written.
    pub fn is_writing(&self) -> bool {
        !self.files.exports.is_empty()
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

    /// Writes the look of the document that is shown as a scene file, in place of one that is there.
    pub fn save_look(&mut self, path: &Path) {
        let Some(document) = self.document_mut() else { return };
        match write_scene(path, &document.look.to_scene(), true) {
            Ok(()) => document.file = Some(LookFile::new(path, &document.look)),
            Err(error) => self.notice(error.to_string()),
        }
    }

    /// Begins to write a picture of the document that is shown, in place of one that is there.
    pub fn export(&mut self, subject: Subject, path: &Path) {
        let Some(document) = self.document() else { return };
        match Export::start(document, subject, path, &self.wake) {
            Ok(export) => self.files.exports.push(export),
            Err(error) => self.notice(error.to_string()),
        }
    }

    /// Copies the command line that does what the window shows.
    fn copy_command(&mut self) {
        let Some(document) = self.document() else { return };
        match command(document) {
            Ok(line) => self.context.copy_text(line),
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

    /// Remembers the look, once it rests.
    pub(super) fn remember_look(&mut self) {
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
        for (path, result) in ended {
            match result {
                Ok(warnings) => {
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

    /// Whether a question stands over everything else.
    pub(super) fn asks(&self) -> bool {
        self.files.ask.is_some()
    }

    /// The bar at the top.
    pub(super) fn bar(&mut self, ui: &mut Ui) {
        let mut command = (self.files.ask.is_none() && !ui.ctx().text_edit_focused()).then(|| pressed(ui)).flatten();
        let (has_photo, mut recalled) = (self.document().is_some(), None);
        Panel::top("bar").show(ui, |ui| {
            ui.horizontal(|ui| {
                ui.menu_button("File", |ui| {
                    for (choice, name) in COMMANDS {
                        let enabled = has_photo || choice == Choice::Ask(Purpose::OpenPhoto);
                        if ui.add_enabled(enabled, egui::Button::new(name)).clicked() {
                            command = Some(choice);
                        }
                    }
                    let last = self.files.last.as_ref().filter(|_| has_photo);
                    if last.is_some() && ui.button("Take the look of last time").clicked() {
                        recalled = last.cloned();
                    }
                });
                let Some((_, document)) = self.documents.get_mut(self.current) else { return };
                let [undo, redo] = document.steps();
                let button = egui::Button::new("Undo");
                if ui.add_enabled(undo, button).on_hover_text("The last change of the look (Ctrl+Z)").clicked() {
                    document.undo();
                }
                let button = egui::Button::new("Redo");
                if ui.add_enabled(redo, button).on_hover_text("What was undone (Ctrl+Shift+Z)").clicked() {
                    document.redo();
                }
            });
        });
        if let (Some(look), Some(document)) = (recalled, self.document_mut()) {
            document.set_look(look);
        }
        match command {
            Some(Choice::Ask(purpose)) => self.ask(purpose),
            Some(Choice::Copy) => self.copy_command(),
            None => {}
        }
        self.answer();
    }

    /// Asks for a path; saving and looks need a document.
    fn ask(&mut self, purpose: Purpose) {
        let likely = self.document().map(|document| likely(document, purpose));
        if likely.is_some() || purpose == Purpose::OpenPhoto {
            self.files.ask = Some(Ask::new(purpose, &likely.unwrap_or_default()));
        }
    }

    /// Does what a path was asked for.
    fn answer(&mut self) {
        let Some(ask) = &mut self.files.ask else { return };
        let answer = ask.show(&self.context);
        if answer == Answer::None {
            return;
        }
        self.files.ask = None;
        let Answer::Path(purpose, path) = answer else { return };
        match purpose {
            Purpose::OpenPhoto => self.open(path),
            Purpose::OpenLook => self.open_look(&path),
            Purpose::SavePicture => self.export(Subject::Picture, &path),
            Purpose::SaveGlare => self.export(Subject::Glare, &path),
            Purpose::SaveLook => self.save_look(&path),
        }
    }

    /// What is there to begin with.
    pub(super) fn start(&mut self, ui: &mut Ui) {
        let mut chosen = None;
        CentralPanel::default().show(ui, |ui| {
            ui.vertical_centered(|ui| {
                ui.add_space(0.3 * ui.available_height());
                ui.label("Drop photos here");
                for path in self.recent() {
                    if ui.link(path.display().to_string()).on_hover_text("Open it again").clicked() {
                        chosen = Some(path.clone());
                    }
                }
            });
        });
        if let Some(path) = chosen {
            self.open(path);
        }
    }

    /// What is being written.
    pub(super) fn exports(&self, ui: &mut Ui) {
        for (index, export) in self.files.exports.iter().enumerate() {
            Panel::bottom(("export", index)).show(ui, |ui| {
                ui.horizontal(|ui| {
                    ui.label(format!("{}: {}", export.path.display(), export.step()));
                    if ui.button("Cancel").clicked() {
                        export.cancel();
                    }
                });
            });
        }
    }
}

/// What the menu and its keys can ask for.
#[derive(Clone, Copy, PartialEq)]
enum Choice {
    Ask(Purpose),
    Copy,
}

const COMMANDS: [(Choice, &str); 6] = [
    (Choice::Ask(Purpose::OpenPhoto), "Open a photo… (Ctrl+O)"),
    (Choice::Ask(Purpose::SavePicture), "Save the picture… (Ctrl+S)"),
    (Choice::Ask(Purpose::SaveGlare), "Save the glare…"),
    (Choice::Ask(Purpose::OpenLook), "Open a look…"),
    (Choice::Ask(Purpose::SaveLook), "Save the look… (Ctrl+Shift+S)"),
    (Choice::Copy, "Copy the command line (Ctrl+Shift+C)"),
];

fn pressed(ui: &Ui) -> Option<Choice> {
    let shift = Modifiers::COMMAND | Modifiers::SHIFT;
    let keys = [
        (shift, Key::S, Choice::Ask(Purpose::SaveLook)),
        (shift, Key::C, Choice::Copy),
        (Modifiers::COMMAND, Key::O, Choice::Ask(Purpose::OpenPhoto)),
        (Modifiers::COMMAND, Key::S, Choice::Ask(Purpose::SavePicture)),
    ];
    ui.input_mut(|input| keys.into_iter().find(|&(with, key, _)| input.consume_key(with, key)).map(|(.., what)| what))
}

/// Where a file is likely to go or to come from.
fn likely(document: &Document, purpose: Purpose) -> PathBuf {
    let stem = document.path.file_stem().unwrap_or_default().to_string_lossy();
    let beside = |name: String| document.path.with_file_name(name);
    match purpose {
        Purpose::OpenPhoto | Purpose::OpenLook => {
            document.path.parent().map(|folder| folder.join("")).unwrap_or_default()
        }
        Purpose::SavePicture => beside(format!("{stem}-glare.exr")),
        Purpose::SaveGlare => beside(format!("{stem}-glare-alone.exr")),
        Purpose::SaveLook => {
            document.file.as_ref().map_or_else(|| beside(format!("{stem}.toml")), |file| file.path.clone())
        }
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
