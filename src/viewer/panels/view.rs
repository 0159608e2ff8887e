//! How the picture is looked at.

use egui::{ComboBox, Ui};

use crate::photo::ToneMap;
use crate::viewer::control::Number;
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

const TONE_MAPS: [(ToneMap, &str); 4] =
    [(ToneMap::None, "none"), (ToneMap::Reinhard, "Reinhard"), (ToneMap::Aces, "ACES"), (ToneMap::Agx, "AgX")];

/// Shows the panel.
pub fn show(ui: &mut Ui, document: &mut Document, _: &Stage) {
    let viewing = &mut document.viewing;
    EXPOSURE.show(ui, &mut viewing.exposure, 0.0);
    ui.horizontal(|ui| {
        ui.add_sized([74.0, 18.0], egui::Label::new("Tone map"));
        let name = TONE_MAPS.iter().find(|(map, _)| *map == viewing.tone_map).map_or("", |(_, name)| name);
        ComboBox::from_id_salt("tone map").selected_text(name).show_ui(ui, |ui| {
            for (map, name) in TONE_MAPS {
                ui.selectable_value(&mut viewing.tone_map, map, name);
            }
        });
    });
    ui.horizontal_wrapped(|ui| {
        ui.selectable_value(&mut viewing.shows, Shows::Picture, "With glare");
        ui.selectable_value(&mut viewing.shows, Shows::Photo, "Before").on_hover_text("The photo as it was (B)");
        ui.selectable_value(&mut viewing.shows, Shows::Glare, "Glare alone").on_hover_text("What is added (G)");
    });
    ui.horizontal_wrapped(|ui| {
        let mut wipe = viewing.wipe.is_some();
        if ui
            .checkbox(&mut wipe, "Wipe")
            .on_hover_text("Before on the left, after on the right of a line (W)")
            .clicked()
        {
            viewing.wipe = wipe.then_some(0.5);
        }
        ui.checkbox(&mut viewing.handles, "Handles").on_hover_text("The lights and the axis over the picture (L)");
        ui.checkbox(&mut viewing.loupe, "Loupe").on_hover_text("Pixels and their values at the pointer (I)");
    });
}
