//! The bar at the top: the menu and its keys, undo and redo, and what was done last.

use std::path::PathBuf;

use egui::{Key, Label, Modifiers, Panel, Response, RichText, Ui};

use super::App;
use crate::viewer::ask::Purpose;
use crate::viewer::control::{self, Told};

/// What was chosen in the menu.
#[derive(Default)]
struct Chosen {
    command: Option<Choice>,
    /// The look of last time is wanted.
    recalled: bool,
    /// A photo that was open before.
    again: Option<PathBuf>,
}

impl App {
    /// The bar at the top.
    pub(super) fn bar(&mut self, ui: &mut Ui) {
        let mut chosen = Chosen::default();
        if !self.asks() && !ui.ctx().text_edit_focused() {
            chosen.command = pressed(ui);
        }
        Panel::top("bar").show(ui, |ui| {
            ui.horizontal(|ui| {
                let menu = ui.menu_button("File", |ui| self.menu(ui, &mut chosen));
                mark(ui, "File", "Photos, pictures and looks", &menu.response);
                self.steps(ui);
                if self.is_veiling() {
                    ui.add_space(12.0);
                    ui.weak("Computing the veil…");
                }
                if let Some(done) = &self.files.done {
                    ui.add_space(12.0);
                    ui.add(Label::new(RichText::new(done).weak()).truncate());
                }
            });
        });
        if let (true, Some(look)) = (chosen.recalled, self.files.last.clone()) {
            self.document_mut().into_iter().for_each(|document| document.set_look(look.clone()));
        }
        chosen.again.into_iter().for_each(|path| self.open(path));
        if chosen.command.is_some() {
            self.files.done = None;
        }
        match chosen.command {
            Some(Choice::Ask(purpose)) => self.ask(purpose, false),
            Some(Choice::Type(purpose)) => self.ask(purpose, true),
            Some(Choice::Copy) => self.copy_command(),
            None => {}
        }
        self.answer();
    }

    fn menu(&self, ui: &mut Ui, chosen: &mut Chosen) {
        let has_photo = self.document().is_some();
        for (choice, name) in COMMANDS {
            let enabled = has_photo || choice == Choice::Ask(Purpose::OpenPhoto);
            let item = ui.add_enabled(enabled, egui::Button::new(name));
            mark(ui, name, name, &item);
            if item.clicked() {
                chosen.command = Some(choice);
            }
        }
        if !self.files.recent.is_empty() {
            ui.menu_button("Open again", |ui| chosen.again = recent(ui, &self.files.recent));
        }
        if self.files.questions.by_dialog() {
            ui.menu_button("Type a path…", |ui| {
                for (choice, name) in TYPED {
                    let enabled = has_photo || choice == Purpose::OpenPhoto;
                    if ui.add_enabled(enabled, egui::Button::new(name)).clicked() {
                        chosen.command = Some(Choice::Type(choice));
                    }
                }
            });
        }
        if has_photo && self.files.last.is_some() {
            chosen.recalled = ui.button("Take the look of last time").clicked();
        }
    }

    /// Undo and redo.
    fn steps(&mut self, ui: &mut Ui) {
        let Some(document) = self.document_mut() else { return };
        let [undo, redo] = document.steps();
        let button = egui::Button::new("Undo");
        if ui.add_enabled(undo, button).on_hover_text("The last change of the look (Ctrl+Z)").clicked() {
            document.undo();
        }
        let button = egui::Button::new("Redo");
        if ui.add_enabled(redo, button).on_hover_text("What was undone (Ctrl+Shift+Z)").clicked() {
            document.redo();
        }
    }
}

const AGAIN: &str = "Open it again";

/// Photos to be opened again; which of them is.
pub(super) fn recent(ui: &mut Ui, photos: &[PathBuf]) -> Option<PathBuf> {
    let mut chosen = None;
    for path in photos {
        let name = path.display().to_string();
        let link = ui.link(&name).on_hover_text(AGAIN);
        mark(ui, &name, AGAIN, &link);
        if link.clicked() {
            chosen = Some(path.clone());
        }
    }
    chosen
}

/// Notes where something to click is, for scripts.
pub(super) fn mark(ui: &Ui, name: &str, about: &str, what: &Response) {
    let (name, about, rect) = (name.to_owned(), about.to_owned(), what.rect);
    let (span, reset) = (String::new(), String::new());
    control::tell(ui, Told { name, about, span, reset, label: rect, rect, part: rect });
}

/// What the menu and its keys can ask for.
#[derive(Clone, Copy, PartialEq)]
enum Choice {
    Ask(Purpose),
    /// The same by a path that is typed in the window.
    Type(Purpose),
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

const TYPED: [(Purpose, &str); 5] = [
    (Purpose::OpenPhoto, "Open a photo"),
    (Purpose::SavePicture, "Save the picture"),
    (Purpose::SaveGlare, "Save the glare"),
    (Purpose::OpenLook, "Open a look"),
    (Purpose::SaveLook, "Save the look"),
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
