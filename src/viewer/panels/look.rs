//! How strong the glare is, and of which lens.

use egui::{ComboBox, Ui};

use crate::scene::presets;
use crate::viewer::control::Number;
use crate::viewer::document::Document;
use crate::viewer::model::LookLens;
use crate::viewer::stage::Stage;

const STRENGTH: Number = Number {
    name: "Strength",
    about: "What the glare is multiplied by; 1 is the lens's own.",
    unit: "",
    range: 0.0..=10.0,
    logarithmic: true,
};

/// Shows the panel.
pub fn show(ui: &mut Ui, document: &mut Document, _: &Stage) {
    let reset = document.opened.strength;
    STRENGTH.show(ui, &mut document.look.strength, reset);
    ui.horizontal(|ui| {
        ui.add_sized([74.0, 18.0], egui::Label::new("Lens"));
        let combo = ComboBox::from_id_salt("preset").selected_text(document.look.lens().name);
        combo.show_ui(ui, |ui| {
            for preset in presets::all() {
                // A preset that is compiled in can be read; a test reads them all.
                let Ok(lens) = preset.lens() else { continue };
                let chosen = matches!(&document.look.lens, LookLens::Preset(now) if now.name == lens.name);
                let tip = lens.description.clone();
                if ui.selectable_label(chosen, &lens.name).on_hover_text(tip).clicked() {
                    document.look.lens = LookLens::Preset(lens);
                }
            }
        });
    });
}
