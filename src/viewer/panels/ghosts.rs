//! The ghosts that no light makes: those that a scene file places outright.

use egui::Ui;
use glam::DVec2;

use super::bell::{self, Bells};
use super::colour;
use super::lights::list;
use crate::scene::Ghost;
use crate::series::Bell;
use crate::viewer::control::{self, Number, Tip, button, done_by};
use crate::viewer::document::Document;

const PLACE: [Number; 2] = [place("Ghost x"), place("Ghost y")];
const SIZES: [Number; 2] = [size("Ghost width"), size("Ghost height")];
const RADIANCE: [Number; 3] = [radiance("Ghost red"), radiance("Ghost green"), radiance("Ghost blue")];

const fn place(name: &'static str) -> Number {
    Number {
        name,
        about: "Where the ghost's centre is, from the picture's; it may be off the picture.",
        unit: "of the look's unit",
        range: -1e6..=1e6,
        logarithmic: false,
    }
}

const fn size(name: &'static str) -> Number {
    Number {
        name,
        about: "The ghost's size along this axis: σ, or half the width of a bell that ends.",
        unit: "of the look's unit",
        range: 1e-4..=1e4,
        logarithmic: false,
    }
}

const fn radiance(name: &'static str) -> Number {
    Number {
        name,
        about: "The ghost's radiance at its centre; below 0 it takes light away.",
        unit: "in the photo's unit",
        range: -1e12..=1e12,
        logarithmic: false,
    }
}

/// Shows the list, and the numbers of the one that is selected.
pub fn show(ui: &mut Ui, document: &mut Document) {
    let about = "Adds a round ghost in the picture's centre that no light makes, of radiance 0.1";
    if button(ui, "Add a ghost", about) {
        let size = DVec2::splat(0.3);
        document.look.ghosts.push(Ghost { bell: Bell::Gaussian, center: DVec2::ZERO, size, radiance: [0.1; 3] });
        document.select_ghost(document.look.ghosts.len() - 1);
    }
    let mut gone = None;
    list(ui, "ghosts", document.look.ghosts.len(), None, |ui, index| {
        let number = index + 1;
        ui.horizontal(|ui| {
            let text = format!("Ghost {number}:  {}", document.look.ghosts[index].bell);
            let chosen = document.selected_ghost.as_ref().is_some_and(|&(selected, _)| selected == index);
            let about = "Selects the ghost, which no light makes";
            if done_by(ui, format!("ghost {number}"), about, |ui| ui.selectable_label(chosen, text)) {
                document.select_ghost(index);
            }
            let about = "Deletes the ghost (Delete)";
            if done_by(ui, format!("delete ghost {number}"), about, |ui| ui.small_button("×")) {
                gone = Some(index);
            }
        });
    });
    if let Some(index) = gone {
        document.delete_ghost(index);
    }
    selected(ui, document);
}

/// The numbers of the ghost that is selected; each goes back to what it was then.
fn selected(ui: &mut Ui, document: &mut Document) {
    let Some((index, before)) = document.selected_ghost.clone() else { return };
    let Some(old) = document.look.ghosts.get(index).cloned() else { return };
    let mut ghost = old.clone();
    ui.strong(format!("Ghost {}", index + 1));
    let tip = Tip { name: "Bell", about: bell::PARAMETERS, span: bell::SPAN.into(), reset: before.bell.to_string() };
    let bells = Bells::of(&document.look);
    if tip.row(ui, |ui| bells.show(ui, "ghost's bell", &mut ghost.bell)).back {
        ghost.bell = before.bell.clone();
    }
    PLACE[0].plain(ui, &mut ghost.center.x, before.center.x, 0.002);
    PLACE[1].plain(ui, &mut ghost.center.y, before.center.y, 0.002);
    SIZES[0].plain(ui, &mut ghost.size.x, before.size.x, 0.002);
    SIZES[1].plain(ui, &mut ghost.size.y, before.size.y, 0.002);
    for ((number, part), before) in RADIANCE.iter().zip(&mut ghost.radiance).zip(before.radiance) {
        let speed = 0.01 * part.abs().max(1e-4);
        number.plain(ui, part, before, speed);
    }
    let about = "The hue of the ghost; its strongest colour stays.";
    colour::of_tint(ui, "Ghost hue", about, &mut ghost.radiance, before.radiance);
    if ghost != old {
        document.look.set_ghost(index, ghost);
    }
    control::hint(ui, "A ghost is not turned and does not move with the lights.");
}
