//! How strong the glare is, what it looks like, and of which lens.

use egui::{CollapsingHeader, ComboBox, DragValue, Grid, ScrollArea, Ui};
use glam::DVec2;

use crate::choices::{Mix, Normalize};
use crate::scene::{LensGhost, presets};
use crate::series::Bell;
use crate::viewer::control::Number;
use crate::viewer::document::Document;
use crate::viewer::model::{Look, LookLens};
use crate::viewer::stage::Stage;

const STRENGTH: Number = Number {
    name: "Strength",
    about: "What the glare is multiplied by; 1 is the lens's own.",
    unit: "",
    range: 0.0..=10.0,
    logarithmic: true,
};

const SIZE: Number = Number {
    name: "Size",
    about: "What the size of every ghost is multiplied by; its light stays as much as it is.",
    unit: "",
    range: 0.01..=100.0,
    logarithmic: true,
};

const TINT: [Number; 3] = [tint("Tint red"), tint("Tint green"), tint("Tint blue")];

const AXIS: [Number; 2] = [axis("Axis x"), axis("Axis y")];

const MIXES: [(Mix, &str, &str); 2] = [
    (Mix::Add, "add", "The photo keeps its light"),
    (Mix::Energy, "energy", "What scatters is missing in the photo's lights; not with normalised glare"),
];

const NORMALIZE: [(Normalize, &str, &str); 3] = [
    (Normalize::None, "none", "The glare's values as they are: physical"),
    (Normalize::Clamp, "clamp", "Clamped to 0 to 1"),
    (Normalize::Minmax, "minmax", "Stretched to 0 to 1 by the smallest and the largest in the picture"),
];

const fn tint(name: &'static str) -> Number {
    Number {
        name,
        about: "What this colour of the glare is multiplied by.",
        unit: "",
        range: 0.0..=4.0,
        logarithmic: false,
    }
}

const fn axis(name: &'static str) -> Number {
    Number {
        name,
        about: "Where the lens's axis meets the picture; 0 is the picture's centre.",
        unit: "half picture heights",
        range: -4.0..=4.0,
        logarithmic: false,
    }
}

/// Shows the panel.
pub fn show(ui: &mut Ui, document: &mut Document, _: &Stage) {
    let (look, opened) = (&mut document.look, &document.opened);
    STRENGTH.show(ui, &mut look.strength, opened.strength);
    lens(ui, look);
    SIZE.show(ui, &mut look.size, opened.size);
    for (colour, number) in TINT.iter().enumerate() {
        number.show(ui, &mut look.tint[colour], opened.tint[colour]);
    }
    AXIS[0].show(ui, &mut look.axis.x, opened.axis.x);
    AXIS[1].show(ui, &mut look.axis.y, opened.axis.y);
    choice(ui, "Mix", "Where the glare's light comes from", &mut look.mix, &MIXES);
    choice(ui, "Normalise", "How the field's values become glare", &mut look.normalize, &NORMALIZE);
    CollapsingHeader::new("Lens ghosts").show(ui, |ui| {
        ScrollArea::horizontal().show(ui, |ui| table(ui, look));
    });
}

fn lens(ui: &mut Ui, look: &mut Look) {
    ui.horizontal(|ui| {
        ui.add_sized([74.0, 18.0], egui::Label::new("Lens"));
        let combo = ComboBox::from_id_salt("preset").selected_text(look.lens().name);
        combo.show_ui(ui, |ui| {
            for preset in presets::all() {
                // A preset that is compiled in can be read; a test reads them all.
                let Ok(lens) = preset.lens() else { continue };
                let chosen = matches!(&look.lens, LookLens::Preset(now) if now.name == lens.name);
                let tip = lens.description.clone();
                if ui.selectable_label(chosen, &lens.name).on_hover_text(tip).clicked() {
                    look.lens = LookLens::Preset(lens);
                }
            }
        });
    });
}

/// One of a few, by name.
fn choice<T: Copy + PartialEq>(ui: &mut Ui, name: &str, about: &str, value: &mut T, choices: &[(T, &str, &str)]) {
    ui.horizontal(|ui| {
        ui.add_sized([74.0, 18.0], egui::Label::new(name)).on_hover_text(about);
        let now = choices.iter().find(|(choice, ..)| choice == value).map_or("", |(_, name, _)| name);
        ComboBox::from_id_salt(name).selected_text(now).show_ui(ui, |ui| {
            for (choice, name, tip) in choices {
                ui.selectable_value(value, *choice, *name).on_hover_text(*tip);
            }
        });
    });
}

/// The lens's table, a row a ghost.
fn table(ui: &mut Ui, look: &mut Look) {
    let mut gone = None;
    Grid::new("lens ghosts").striped(true).show(ui, |ui| {
        for (name, tip) in [
            ("bell", "The ghost's profile"),
            ("along", "Where it is on the line from the axis to the light: 1 is on the light, −1 opposite"),
            ("size x", "For a point of light, in half picture heights: σ, or half the width of a bell that ends"),
            ("size y", "As size x"),
            ("red", "What multiplies the light's red"),
            ("green", "What multiplies the light's green"),
            ("blue", "What multiplies the light's blue"),
            ("share", "The part of the light's flux that it carries"),
        ] {
            ui.label(name).on_hover_text(tip);
        }
        ui.end_row();
        for index in 0..look.lens.ghosts().len() {
            let before = look.lens.ghosts()[index].clone();
            let mut ghost = before.clone();
            row(ui, &mut ghost);
            if ui.small_button("×").on_hover_text("Delete it; the last one stays").clicked() {
                gone = Some(index);
            }
            ui.end_row();
            if ghost != before {
                look.set_lens_ghost(index, ghost);
            }
        }
    });
    if let Some(index) = gone {
        look.delete_lens_ghost(index);
    }
    if ui.button("Add").on_hover_text("A ghost opposite the light").clicked() {
        let (bell, size) = (Bell::Gaussian, DVec2::splat(0.1));
        look.add_lens_ghost(LensGhost { bell, along: -1.0, size, tint: [1.0; 3], share: 1e-3 });
    }
}

fn row(ui: &mut Ui, ghost: &mut LensGhost) {
    ui.label(ghost.bell.to_string());
    let mut cell = |value: &mut f64, least: f64, most: f64| {
        let speed = 0.005 * value.abs().max(1e-4);
        let cell = DragValue::new(value).range(least..=most).clamp_existing_to_range(false);
        ui.add(cell.speed(speed).max_decimals(8));
    };
    cell(&mut ghost.along, -100.0, 100.0);
    cell(&mut ghost.size.x, 1e-4, 100.0);
    cell(&mut ghost.size.y, 1e-4, 100.0);
    ghost.tint.iter_mut().for_each(|part| cell(part, 0.0, 100.0));
    cell(&mut ghost.share, 0.0, 1.0);
}
