//! The list of lights.

use egui::Ui;
use glam::DVec2;

use crate::scene::Light;
use crate::viewer::document::Document;
use crate::viewer::model::LookLights;
use crate::viewer::stage::Stage;

/// Shows the panel.
pub fn show(ui: &mut Ui, document: &mut Document, _: &Stage) {
    ui.horizontal(|ui| {
        if ui
            .button("Add")
            .on_hover_text("A white light in the picture's centre, as bright as the faintest here")
            .clicked()
        {
            let light = another(document.lights());
            document.selected = Some(document.lights().len());
            document.lights_mut().push(light);
        }
        let back = ui.button("As found").on_hover_text("The lights that are found in the photo, where they are");
        if back.clicked() {
            document.look.lights = LookLights::Found;
            document.selected = None;
        }
    });
    let mut gone = None;
    for index in 0..document.lights().len() {
        let light = document.lights()[index];
        ui.horizontal(|ui| {
            let mut on = !light.muted;
            if ui.checkbox(&mut on, "").on_hover_text("Whether it glares (M)").clicked() {
                document.lights_mut()[index].muted = !on;
            }
            let text = format!("{}  {:.2e}", index + 1, flux(&light));
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
        document.delete_light(index);
    }
}

/// The mean of a light's colours.
fn flux(light: &Light) -> f64 {
    light.flux.iter().sum::<f64>() / 3.0
}

/// A point in the centre, as bright as the faintest light that there is.
fn another(lights: &[Light]) -> Light {
    let faintest = lights.iter().map(flux).fold(f64::INFINITY, f64::min);
    let flux = if faintest.is_finite() { faintest } else { 1.0 };
    Light { position: DVec2::ZERO, flux: [flux; 3], size: 0.0, muted: false }
}
