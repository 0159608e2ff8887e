//! The list of lights.

use egui::Ui;
use glam::DVec2;

use crate::scene::Light;
use crate::viewer::document::Document;
use crate::viewer::look::Lamp;
use crate::viewer::stage::Stage;

/// Shows the panel.
pub fn show(ui: &mut Ui, document: &mut Document, _: &Stage) {
    ui.horizontal(|ui| {
        if ui
            .button("Add")
            .on_hover_text("A white light in the picture's centre, as bright as the faintest here")
            .clicked()
        {
            document.selected = Some(document.look.lamps.len());
            let lamp = Lamp { light: another(&document.look.lamps), muted: false };
            document.look.lamps.push(lamp);
        }
        let back = ui.button("As found").on_hover_text("The lights that were found in the photo, where they were");
        if back.clicked() {
            document.look.lamps.clone_from(&document.opened.lamps);
            document.selected = None;
        }
    });
    let mut gone = None;
    for (index, lamp) in document.look.lamps.iter_mut().enumerate() {
        ui.horizontal(|ui| {
            let mut on = !lamp.muted;
            if ui.checkbox(&mut on, "").on_hover_text("Whether it glares (M)").clicked() {
                lamp.muted = !on;
            }
            let text = format!("{}  {:.2e}", index + 1, flux(&lamp.light));
            let row = ui.selectable_label(document.selected == Some(index), text);
            if row.on_hover_text("Its flux: radiance times area, in half picture heights squared").clicked() {
                document.selected = Some(index);
            }
            if ui.small_button("×").on_hover_text("Delete it (Delete)").clicked() {
                gone = Some(index);
            }
        });
    }
    if let Some(index) = gone {
        document.look.lamps.remove(index);
        document.selected = None;
    }
}

/// The mean of a light's colours.
fn flux(light: &Light) -> f64 {
    light.flux.iter().sum::<f64>() / 3.0
}

/// A point in the centre, as bright as the faintest light that there is.
fn another(lamps: &[Lamp]) -> Light {
    let faintest = lamps.iter().map(|lamp| flux(&lamp.light)).fold(f64::INFINITY, f64::min);
    let flux = if faintest.is_finite() { faintest } else { 1.0 };
    Light { position: DVec2::ZERO, flux: [flux; 3], size: 0.0, muted: false }
}
