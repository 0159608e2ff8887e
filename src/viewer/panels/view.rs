//! How the picture is looked at.

use egui::{RichText, ThemePreference, Ui};

use crate::photo::ToneMap;
use crate::viewer::control::{Number, buttons, choice, flag, hint};
use crate::viewer::document::Document;
use crate::viewer::stage::Stage;
use crate::viewer::viewing::{MOST_EXPOSURE, Shows};

const EXPOSURE: Number = Number {
    name: "Exposure",
    about: "Raises or lowers the light before the tone map; of the view only.",
    unit: "stops",
    range: -MOST_EXPOSURE..=MOST_EXPOSURE,
    logarithmic: false,
};

const WIPE: Number = Number {
    name: "Wipe at",
    about: "Where the line of the wipe is, from the left.",
    unit: "of the canvas's width",
    range: 0.0..=1.0,
    logarithmic: false,
};

/// Where a wipe begins.
const MIDDLE: f64 = 0.5;

const TONE_MAPS: [(ToneMap, &str, &str); 4] = [
    (ToneMap::None, "none", "Clips at 0 and 1"),
    (ToneMap::Reinhard, "Reinhard", "v / (1 + v) of each colour; flattens contrast"),
    (ToneMap::Aces, "ACES", "Film-like and contrasty; strong colours burn to white"),
    (ToneMap::Agx, "AgX", "Soft and wide; takes bright colours gently to white"),
];

const SHOWS: [(Shows, &str, &str); 4] = [
    (Shows::Picture, "After", "the photo with its glare"),
    (Shows::Photo, "Before", "the photo as it was (B)"),
    (Shows::Glare, "Glare", "the glare alone, what is added (G)"),
    (Shows::Clean, "Clean", "the photo without the look's veil, as if it had had it (C)"),
];

const THEMES: [(ThemePreference, &str, &str); 3] = [
    (ThemePreference::System, "system", "as the desktop has it"),
    (ThemePreference::Light, "light", "dark letters on light panels"),
    (ThemePreference::Dark, "dark", "light letters on dark panels"),
];

/// Shows the panel.
pub fn show(ui: &mut Ui, document: &mut Document, stage: &Stage) {
    let viewing = &mut document.viewing;
    EXPOSURE.show(ui, &mut viewing.exposure, 0.0);
    let about = "How light comes into the display's range (T); of the view only.";
    choice(ui, "Tone map", about, &mut viewing.tone_map, &TONE_MAPS, ToneMap::default());
    buttons(ui, "Shows", "What is seen.", &mut viewing.shows, &SHOWS, Shows::Picture);
    if viewing.shows == Shows::Clean {
        cleaned(ui, stage, document.look.veil.is_some());
    }
    let viewing = &mut document.viewing;
    let mut wipe = viewing.wipe.is_some();
    if flag(ui, "Wipe", "Before on the left, after on the right of a line (W).", &mut wipe, false) {
        viewing.wipe = wipe.then_some(MIDDLE);
    }
    if let Some(at) = &mut viewing.wipe {
        WIPE.show(ui, at, MIDDLE);
    }
    flag(ui, "Handles", "The lights and the axis over the picture (L).", &mut viewing.handles, true);
    flag(ui, "Loupe", "Pixels and their values at the pointer (I).", &mut viewing.loupe, false);
    let mut theme = ui.ctx().options(|options| options.theme_preference);
    let before = theme;
    buttons(ui, "Theme", "The window's colours; remembered.", &mut theme, &THEMES, ThemePreference::System);
    if theme != before {
        ui.ctx().set_theme(theme);
    }
}

/// How the clean photo was come by.
fn cleaned(ui: &mut Ui, stage: &Stage, has_veil: bool) {
    let removing = stage.removing();
    if !has_veil {
        hint(ui, "The look has no veil that could be taken away.");
    } else if removing.is_running() {
        hint(ui, "Taking the veil away…");
    } else if let Some(refused) = removing.refused() {
        ui.label(RichText::new(refused).color(ui.visuals().error_fg_color));
    } else if let Some(removal) = removing.removal() {
        let noise = match removal.amplification.largest {
            Some(times) => format!("; noise {times:.2} times as large at most"),
            None => String::new(),
        };
        hint(ui, format!("Off by {:.1e} of the brightest at most{noise}. Ghosts stay.", removal.error.predicted));
    }
}
