//! The lens's table: a row for each ghost that it makes of a light.

use egui::scroll_area::ScrollBarVisibility;
use egui::style::ScrollStyle;
use egui::{Grid, ScrollArea, Sense, Ui};
use glam::DVec2;

use super::bell::{self, Bells};
use super::colour;
use crate::scene::LensGhost;
use crate::series::Bell;
use crate::viewer::control::{self, Number, cell, done_by};
use crate::viewer::document::Document;
use crate::viewer::model::{Look, LookLens};

const ALONG: Number = Number {
    name: "along",
    about: "Where the ghost is on the line from the axis to the light: 1 is on the light, −1 opposite.",
    unit: "of the way",
    range: -100.0..=100.0,
    logarithmic: false,
};

const SIZES: [Number; 2] = [size("size x"), size("size y")];

const TINT: [Number; 3] = [tint("red"), tint("green"), tint("blue")];

const SHARE: Number = Number {
    name: "share",
    about: "The part of the light's flux that the ghost carries.",
    unit: "of the flux",
    range: 0.0..=1.0,
    logarithmic: false,
};

/// The ghost that a new row holds.
const NEW: LensGhost =
    LensGhost { bell: Bell::Gaussian, along: -1.0, size: DVec2::splat(0.1), tint: [1.0; 3], share: 1e-3 };

const fn size(name: &'static str) -> Number {
    Number {
        name,
        about: "The ghost's size for a point of light: σ, or half the width of a bell that ends.",
        unit: "of the look's unit",
        range: 1e-4..=100.0,
        logarithmic: false,
    }
}

const fn tint(name: &'static str) -> Number {
    Number {
        name,
        about: "What multiplies this colour of the light.",
        unit: "times",
        range: 0.0..=100.0,
        logarithmic: false,
    }
}

/// Shows the table, folded away at first.
pub fn show(ui: &mut Ui, document: &mut Document) {
    if !matches!(document.look.lens, LookLens::Own(_)) && document.lens_before != document.look.lens {
        document.lens_before = document.look.lens.clone();
    }
    let before = document.lens_before.ghosts().to_vec();
    control::fold(ui, "Lens ghosts", "What the lens makes of each light, a row a ghost", |ui| {
        // Always seen: that there is more to the right is seen by nothing else.
        ui.style_mut().spacing.scroll = ScrollStyle::solid();
        let seen = ScrollBarVisibility::AlwaysVisible;
        ScrollArea::horizontal().scroll_bar_visibility(seen).show(ui, |ui| table(ui, &mut document.look, &before));
        if control::button(ui, "Add a row", "A small ghost opposite the light") {
            document.look.add_lens_ghost(NEW);
        }
        control::hint(
            ui,
            "A double click on a row's number, or a secondary click on a cell, puts back what the lens had.",
        );
    });
}

/// `before` are the rows of the lens that the table was made from.
fn table(ui: &mut Ui, look: &mut Look, before: &[LensGhost]) {
    let mut gone = None;
    let bells = Bells::of(look);
    Grid::new("lens ghosts").striped(true).min_col_width(8.0).show(ui, |ui| {
        ui.label("");
        ui.label("bell").on_hover_text("The ghost's profile");
        for number in std::iter::once(&ALONG).chain(&SIZES).chain(&TINT) {
            ui.label(number.name).on_hover_text(format!("{}\n{}", number.about, number.span()));
        }
        ui.label("hue").on_hover_text("The tint's hue; its strongest colour stays");
        ui.label(SHARE.name).on_hover_text(format!("{}\n{}", SHARE.about, SHARE.span()));
        ui.end_row();
        for index in 0..look.lens.ghosts().len() {
            let old = look.lens.ghosts()[index].clone();
            let mut ghost = old.clone();
            row(ui, &bells, index, &mut ghost, before.get(index).unwrap_or(&NEW));
            let about = "Deletes the row; the last one stays";
            if done_by(ui, format!("delete row {}", index + 1), about, |ui| ui.small_button("×")) {
                gone = Some(index);
            }
            ui.end_row();
            if ghost != old {
                look.set_lens_ghost(index, ghost);
            }
        }
    });
    if let Some(index) = gone {
        look.delete_lens_ghost(index);
    }
}

fn row(ui: &mut Ui, bells: &Bells, index: usize, ghost: &mut LensGhost, before: &LensGhost) {
    let row = index + 1;
    let label = egui::Label::new(row.to_string()).sense(Sense::click()).selectable(false);
    let number = ui.add(label);
    let back = number.double_clicked();
    let about = "The row; a double click on its number puts all of it back to what the lens had.";
    done_by(ui, format!("row {row}"), about, |_| number);
    let (name, about) = (format!("bell {row}"), format!("The ghost's profile; {}.", bell::PARAMETERS));
    let reset = before.bell.to_string();
    // With its mean, where it has one, in one column.
    let list = |ui: &mut Ui| ui.horizontal(|ui| bells.show(ui, ("bell", index), &mut ghost.bell)).inner;
    if cell(ui, &about, bell::SPAN, name, &reset, list) {
        ghost.bell = before.bell.clone();
    }
    let name = |number: &Number| format!("{} {row}", number.name);
    ALONG.cell(ui, name(&ALONG), &mut ghost.along, before.along);
    SIZES[0].cell(ui, name(&SIZES[0]), &mut ghost.size.x, before.size.x);
    SIZES[1].cell(ui, name(&SIZES[1]), &mut ghost.size.y, before.size.y);
    for ((number, part), before) in TINT.iter().zip(&mut ghost.tint).zip(before.tint) {
        number.cell(ui, name(number), part, before);
    }
    let about = "The tint's hue; its strongest colour stays.";
    let reset = before.tint.map(control::brief).join(", ");
    if cell(ui, about, "any hue", format!("hue {row}"), &reset, |ui| colour::button(ui, &mut ghost.tint)) {
        ghost.tint = before.tint;
    }
    SHARE.cell(ui, name(&SHARE), &mut ghost.share, before.share);
    if back {
        *ghost = before.clone();
    }
}
