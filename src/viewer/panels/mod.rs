//! The controls, one file a panel: a function that shows it, and its line in [`PANELS`].

mod accuracy;
mod by_hand;
mod keys;
mod lights;
mod look;
mod performance;
mod plots;
mod view;

use egui::{CollapsingHeader, ScrollArea, Ui};

pub use performance::vsync;

use super::control::place;
use super::document::Document;
use super::stage::Stage;

/// One panel.
struct Panel {
    title: &'static str,
    /// Whether it is open at first.
    open: bool,
    /// Shows it; what it changes in the document is rendered in the same frame.
    show: fn(&mut Ui, &mut Document, &Stage),
}

/// Every panel, from the top.
const PANELS: [Panel; 7] = [
    Panel { title: "Look", open: true, show: look::show },
    Panel { title: "View", open: true, show: view::show },
    Panel { title: "Lights", open: true, show: lights::show },
    Panel { title: "Accuracy", open: true, show: accuracy::show },
    Panel { title: "Plots", open: false, show: plots::show },
    Panel { title: "Performance", open: false, show: performance::show },
    Panel { title: "Keys", open: false, show: keys::show },
];

/// Shows every panel of a document.
pub fn show(ui: &mut Ui, document: &mut Document, stage: &Stage) {
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        for panel in &PANELS {
            let header = CollapsingHeader::new(panel.title).default_open(panel.open);
            let shown = header.show(ui, |ui| (panel.show)(ui, document, stage));
            ui.data_mut(|data| data.insert_temp(place(panel.title), shown.header_response.rect));
        }
    });
}
