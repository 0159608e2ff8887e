//! What counts as a light, the list of lights, and the one that is selected.

use egui::{DragValue, Ui};
use glam::DVec2;

use crate::scene::Light;
use crate::viewer::control::Number;
use crate::viewer::document::Document;
use crate::viewer::model::LookLights;
use crate::viewer::stage::Stage;

const THRESHOLD: Number = Number {
    name: "Threshold",
    about: "The luminance from which on a pixel is light.",
    unit: "in the photo's unit",
    range: 0.0..=1e6,
    logarithmic: true,
};

const MERGE: Number = Number {
    name: "Merge",
    about: "How close regions are that become one light.",
    unit: "half picture heights",
    range: 0.0..=2.0,
    logarithmic: true,
};

const MOST: Number = Number {
    name: "Most",
    about: "At most so many lights are kept, the brightest.",
    unit: "lights",
    range: 0.0..=1024.0,
    logarithmic: true,
};

/// Shows the panel.
pub fn show(ui: &mut Ui, document: &mut Document, _: &Stage) {
    find(ui, document);
    ui.separator();
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
    if let Some(index) = document.selected.filter(|&index| index < document.lights().len()) {
        ui.separator();
        selected(ui, document, index);
    }
}

/// What counts as a light; the photo is searched anew while it is set.
fn find(ui: &mut Ui, document: &mut Document) {
    let (opened, found) = (document.opened.find, document.found.threshold);
    let find = &mut document.look.find;
    let mut automatic = find.threshold.is_none();
    let tip = "Let the photo decide from which luminance on a pixel is light";
    if ui.checkbox(&mut automatic, "Threshold by the photo").on_hover_text(tip).changed() {
        find.threshold = (!automatic).then_some(found);
    }
    if let Some(threshold) = &mut find.threshold {
        THRESHOLD.show(ui, threshold, opened.threshold.unwrap_or(found));
    }
    MERGE.show(ui, &mut find.merge, opened.merge);
    let mut most = find.max_lights as f64;
    MOST.show(ui, &mut most, opened.max_lights as f64);
    if most != find.max_lights as f64 {
        find.max_lights = most.round() as usize;
    }
    let searching = if document.wants_search() { ", searching" } else { "" };
    ui.label(format!("{} regions from {:.3e} on{searching}", document.found.regions, document.found.threshold));
}

/// The numbers of one light.
fn selected(ui: &mut Ui, document: &mut Document, index: usize) {
    let weights = document.photo.luminance_weights();
    let before = document.lights()[index];
    let mut light = before;
    ui.label(format!("Light {}", index + 1));
    let mut cell = |name: &str, tip: &str, value: &mut f64, least: f64, speed: f64| {
        ui.horizontal(|ui| {
            ui.add_sized([74.0, 18.0], egui::Label::new(name)).on_hover_text(tip);
            let number = DragValue::new(value).range(least..=1e12).clamp_existing_to_range(false);
            ui.add(number.speed(speed).max_decimals(8)).on_hover_text(tip);
        });
    };
    let place = "Where it is, in half picture heights from the centre; it may be off the picture";
    cell("x", place, &mut light.position.x, -1e12, 0.002);
    cell("y", place, &mut light.position.y, -1e12, 0.002);
    cell("Extent", "Its rms radius along one axis, in half picture heights; 0 is a point", &mut light.size, 0.0, 0.001);
    let flux = "Radiance times area, in the photo's unit times half picture heights squared";
    for (name, part) in ["Red", "Green", "Blue"].into_iter().zip(&mut light.flux) {
        let speed = 0.01 * part.abs().max(1e-6);
        cell(name, flux, part, 0.0, speed);
    }
    if light != before {
        document.lights_mut()[index] = light;
    }
    let most = light.flux.iter().fold(f64::MIN_POSITIVE, |a, &b| a.max(b));
    let mut hue = light.flux.map(|part| (part / most) as f32);
    ui.horizontal(|ui| {
        ui.add_sized([74.0, 18.0], egui::Label::new("Hue"));
        let button = ui.color_edit_button_rgb(&mut hue).on_hover_text("Its hue; its luminous flux stays");
        if button.changed() {
            let hue = hue.map(f64::from);
            document.look.set_light_colour(&document.found.lights, index, hue, weights);
        }
    });
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
