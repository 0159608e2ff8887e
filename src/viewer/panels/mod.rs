//! The controls, one file a panel: a function that shows it, and its line in [`PANELS`].

mod accuracy;
mod bell;
mod by_hand;
mod colour;
mod ghosts;
mod keys;
mod lens;
mod lights;
mod look;
mod performance;
mod plots;
mod psf;
mod veil;
mod view;

use egui::{CollapsingHeader, ScrollArea, Ui};

pub use performance::vsync;

use super::control::done_by;
use super::document::Document;
use super::stage::Stage;

/// One panel.
struct Panel {
    title: &'static str,
    /// What is in it, in a sentence.
    about: &'static str,
    /// Whether it is open at first.
    open: bool,
    /// Shows it; what it changes in the document is rendered in the same frame.
    show: fn(&mut Ui, &mut Document, &Stage),
}

/// Every panel, from the top.
const PANELS: [Panel; 8] = [
    Panel {
        title: "Look",
        about: "How strong the glare is, what it looks like, and of which lens.",
        open: true,
        show: look::show,
    },
    Panel {
        title: "Veil",
        about: "What every pixel scatters over all others, and what becomes of the light.",
        open: true,
        show: veil::show,
    },
    Panel {
        title: "View",
        about: "How the picture is looked at; nothing that is saved depends on it.",
        open: true,
        show: view::show,
    },
    Panel {
        title: "Lights",
        about: "What counts as a light, the lights, and the ghosts that no light makes.",
        open: true,
        show: lights::show,
    },
    Panel {
        title: "Accuracy",
        about: "How exact the glare is: what is asked, planned and measured.",
        open: true,
        show: accuracy::show,
    },
    Panel {
        title: "Plots",
        about: "The spectrum, a cross-section of the field, and the error against the degree.",
        open: false,
        show: plots::show,
    },
    Panel {
        title: "Performance",
        about: "What was computed, and how long it took.",
        open: false,
        show: performance::show,
    },
    Panel { title: "Keys", about: "What the keyboard does.", open: false, show: keys::show },
];

/// Shows every panel of a document.
pub fn show(ui: &mut Ui, document: &mut Document, stage: &Stage) {
    document.sets_threshold = false;
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        for panel in &PANELS {
            let header = CollapsingHeader::new(panel.title).default_open(panel.open);
            let shown = header.show(ui, |ui| (panel.show)(ui, document, stage));
            done_by(ui, panel.title.to_owned(), panel.about, |_| shown.header_response);
        }
    });
}
