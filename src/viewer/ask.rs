//! A question for a path, asked in the window itself, so that it works on every display.

use std::path::{Path, PathBuf};

use egui::text::{CCursor, CCursorRange};
use egui::{Context, Id, Key, Modal, TextEdit, Ui};

/// What a path is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Purpose {
    /// A photo to open.
    OpenPhoto,
    /// A scene file to take the look from.
    OpenLook,
    /// A CSV file of radius and value, for the veil's function.
    OpenTable,
    /// A picture of a point's light, for the veil's function.
    OpenKernel,
    /// A file for the photo with its glare.
    SavePicture,
    /// A file for the glare alone.
    SaveGlare,
    /// A scene file for the look.
    SaveLook,
}

/// A question that has not been answered.
pub struct Ask {
    purpose: Purpose,
    text: String,
    /// Whether the keyboard has been led to the text.
    led: bool,
}

/// An answer.
#[derive(Debug, Clone, PartialEq)]
pub enum Answer {
    /// Not yet.
    None,
    /// Never mind.
    Cancelled,
    /// This path; what is there may be replaced.
    Path(Purpose, PathBuf),
}

impl Purpose {
    /// What it is called, and what is done with the path.
    pub fn words(self) -> [&'static str; 2] {
        match self {
            Self::OpenPhoto => ["Open a photo", "Open"],
            Self::OpenLook => ["Open a look, as a scene file", "Open"],
            Self::OpenTable => ["Open a function, as a table of radius and value (.csv)", "Open"],
            Self::OpenKernel => ["Open a function, as a picture of a point's light", "Open"],
            Self::SavePicture => ["Save the picture (.exr .hdr .pfm .tif .png .jpg)", "Save"],
            Self::SaveGlare => ["Save the glare alone (.exr .hdr .pfm .tif .png .jpg)", "Save"],
            Self::SaveLook => ["Save the look, as a scene file (.toml)", "Save"],
        }
    }

    /// Whether something is written there.
    pub fn saves(self) -> bool {
        matches!(self, Self::SavePicture | Self::SaveGlare | Self::SaveLook)
    }
}

impl Ask {
    /// A question, with a path that is likely.
    pub fn new(purpose: Purpose, likely: &Path) -> Self {
        Self { purpose, text: likely.to_string_lossy().into_owned(), led: false }
    }

    /// Shows it over everything else.
    pub fn show(&mut self, context: &Context) -> Answer {
        let modal = Modal::new(Id::unique("path")).show(context, |ui| self.fields(ui));
        if modal.inner != Answer::None {
            return modal.inner;
        }
        if modal.should_close() { Answer::Cancelled } else { Answer::None }
    }

    fn fields(&mut self, ui: &mut Ui) -> Answer {
        let [title, verb] = self.purpose.words();
        ui.set_width(420.0);
        ui.heading(title);
        let edit = TextEdit::singleline(&mut self.text).desired_width(f32::INFINITY).hint_text("path");
        let mut shown = edit.show(ui);
        let field = shown.response.response;
        if !std::mem::replace(&mut self.led, true) {
            field.request_focus();
            // What is typed replaces what was likely; a cursor key goes on from its end.
            let all = CCursorRange::two(CCursor::default(), CCursor::new(self.text.chars().count()));
            shown.state.cursor.set_char_range(Some(all));
            shown.state.store(ui.ctx(), field.id);
        }
        let path = PathBuf::from(self.text.trim());
        let replaces = self.purpose.saves() && path.exists();
        if replaces {
            ui.label("It exists already.");
        }
        let entered = field.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
        let mut answer = Answer::None;
        ui.horizontal(|ui| {
            let verb = if replaces { "Replace" } else { verb };
            let chosen = ui.button(verb).clicked();
            // What is replaced takes a press of the button: Enter alone is too quick.
            if !self.text.trim().is_empty() && (chosen || (entered && !replaces)) {
                answer = Answer::Path(self.purpose, path);
            }
            if ui.button("Cancel").clicked() {
                answer = Answer::Cancelled;
            }
        });
        answer
    }
}
