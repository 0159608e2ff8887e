//! Questions for paths: by the desktop's dialogs where it has any, and otherwise in the window.

use std::path::{Path, PathBuf};

use egui::{Panel, Ui};

use super::App;
use crate::psf::Name;
use crate::viewer::ask::{Answer, Ask, Purpose};
use crate::viewer::dialog::{self, Dialog};
use crate::viewer::document::Document;
use crate::viewer::export::Subject;

/// What is being asked.
#[derive(Default)]
pub struct Questions {
    /// Whether to ask by dialogs where the desktop has any.
    dialogs: bool,
    dialog: Option<Dialog>,
    typed: Option<Ask>,
    /// Of which document; another may be shown by the time of the answer.
    document: Option<u64>,
}

impl Questions {
    /// Whether a dialog may be what a question leads to, so that a typed path has to be asked for.
    pub fn by_dialog(&self) -> bool {
        self.dialogs && dialog::exist()
    }
}

impl App {
    /// Asks by the desktop's dialogs from now on, where it has any.
    pub fn use_dialogs(&mut self) {
        self.files.questions.dialogs = true;
    }

    /// Whether a question stands over everything else.
    pub fn asks(&self) -> bool {
        self.files.questions.typed.is_some()
    }

    /// Whether a dialog of the desktop is open. The window goes on meanwhile.
    pub fn asks_elsewhere(&self) -> bool {
        self.files.questions.dialog.is_some()
    }

    /// Asks for a path, `typed` in the window or by whichever way there is; saving and looks need a document.
    pub(super) fn ask(&mut self, purpose: Purpose, typed: bool) {
        let document = self.documents.get(self.current);
        let likely = document.map(|(_, document)| likely(document, purpose));
        if likely.is_none() && purpose != Purpose::OpenPhoto {
            return;
        }
        let likely = likely.unwrap_or_default();
        if !typed && self.files.questions.dialog.is_some() {
            // One at a time; the strip at the bottom lets go of one that is lost behind other windows.
            return;
        }
        self.files.questions.document = document.map(|(number, _)| *number);
        if !typed && self.files.questions.by_dialog() {
            self.files.questions.dialog = Dialog::open(purpose, &likely, &self.wake).ok();
        }
        if self.files.questions.dialog.is_none() {
            self.files.questions.typed = Some(Ask::new(purpose, &likely));
        }
    }

    /// Does what paths were asked for.
    pub(super) fn answer(&mut self) {
        if let Some(dialog) = &self.files.questions.dialog {
            let purpose = dialog.purpose();
            match dialog.poll() {
                dialog::Answer::None => {}
                dialog::Answer::Missing => self.type_instead(),
                dialog::Answer::Paths(paths) => {
                    self.files.questions.dialog = None;
                    paths.into_iter().for_each(|path| self.answered(purpose, path));
                }
            }
        }
        let Some(ask) = &mut self.files.questions.typed else { return };
        let answer = ask.show(&self.context);
        if answer == Answer::None {
            return;
        }
        self.files.questions.typed = None;
        if let Answer::Path(purpose, path) = answer {
            self.answered(purpose, path);
        }
    }

    /// Asks in the window what a dialog was to ask.
    fn type_instead(&mut self) {
        let questions = &mut self.files.questions;
        let Some(dialog) = questions.dialog.take() else { return };
        let document = self.documents.iter().find(|(number, _)| Some(*number) == questions.document);
        let likely = document.map(|(_, document)| likely(document, dialog.purpose()));
        questions.typed = Some(Ask::new(dialog.purpose(), &likely.unwrap_or_default()));
    }

    /// Takes a path for the document of which it was asked, whichever is shown by now.
    fn answered(&mut self, purpose: Purpose, path: PathBuf) {
        if purpose == Purpose::OpenPhoto {
            return self.open(path);
        }
        let asked = self.files.questions.document;
        let Some(index) = self.documents.iter().position(|(number, _)| Some(*number) == asked) else {
            return self.notice(format!("{}: its photo has been closed meanwhile", path.display()));
        };
        let shown = std::mem::replace(&mut self.current, index);
        match purpose {
            Purpose::OpenLook => self.open_look(&path),
            Purpose::OpenTable => self.open_psf(Name::Table, &path),
            Purpose::OpenKernel => self.open_psf(Name::Kernel, &path),
            Purpose::SaveLook => self.save_look(&path),
            Purpose::SavePicture => self.export(Subject::Picture, &path),
            Purpose::SaveGlare => self.export(Subject::Glare, &path),
            Purpose::OpenPhoto => {}
        }
        self.current = shown;
    }

    /// Takes the function of a file for the veil of the document that is shown. Where there is none in it, the veil stays.
    fn open_psf(&mut self, name: Name, path: &Path) {
        let Some(document) = self.document_mut() else { return };
        document.veil_fault = None;
        if let Err(fault) = document.look.choose_psf_file(name, path) {
            self.notice(fault.in_words());
        }
    }

    /// What a dialog elsewhere asks.
    pub(super) fn asked_elsewhere(&mut self, ui: &mut Ui) {
        let Some(dialog) = &self.files.questions.dialog else { return };
        let [title, _] = dialog.purpose().words();
        let (mut typed, mut cancelled) = (false, false);
        Panel::bottom("dialog").show(ui, |ui| {
            ui.horizontal(|ui| {
                ui.label(format!("A dialog of the desktop asks: {title}"));
                typed = ui.button("Type a path instead").clicked();
                cancelled = ui.button("Cancel").on_hover_text("Whatever it says then is ignored").clicked();
            });
        });
        if typed {
            self.type_instead();
        } else if cancelled {
            self.files.questions.dialog = None;
        }
    }
}

/// Where a file is likely to go or to come from.
pub fn likely(document: &Document, purpose: Purpose) -> PathBuf {
    let stem = document.path.file_stem().unwrap_or_default().to_string_lossy();
    let beside = |name: String| document.path.with_file_name(name);
    match purpose {
        Purpose::OpenPhoto | Purpose::OpenLook | Purpose::OpenTable | Purpose::OpenKernel => {
            document.path.parent().map(|folder| folder.join("")).unwrap_or_default()
        }
        Purpose::SavePicture => beside(format!("{stem}-glare.exr")),
        Purpose::SaveGlare => beside(format!("{stem}-glare-alone.exr")),
        Purpose::SaveLook => {
            let file = document.file.as_ref().map(|file| Path::to_owned(&file.path));
            file.unwrap_or_else(|| beside(format!("{stem}.toml")))
        }
    }
}
