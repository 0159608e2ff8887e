//! Colours, picked instead of set as three numbers.

use egui::{Response, Ui};

use crate::viewer::control::{Tip, brief};

/// Lets a hue be picked: the colour, as bright as a display can show it. It is changed only where one was picked.
fn pick(ui: &mut Ui, colour: &mut [f64; 3]) -> Response {
    let most = colour.iter().fold(f64::MIN_POSITIVE, |most, part| most.max(part.abs()));
    let mut hue = colour.map(|part| (part / most).max(0.0) as f32);
    let button = ui.color_edit_button_rgb(&mut hue);
    if button.changed() {
        *colour = hue.map(f64::from);
    }
    button
}

/// The strongest of `now` is what the strongest of the hue becomes; black is no hue.
fn as_strong(hue: [f64; 3], now: [f64; 3]) -> Option<[f64; 3]> {
    let strongest = |colour: [f64; 3]| colour.into_iter().fold(0.0f64, |most, part| most.max(part.abs()));
    let factor = strongest(now) / strongest(hue);
    (factor.is_finite() && factor > 0.0).then(|| hue.map(|part| part * factor))
}

/// A hue picked for what multiplies light, or for a ghost: its strongest colour stays.
pub fn button(ui: &mut Ui, colour: &mut [f64; 3]) -> Response {
    let mut hue = *colour;
    let button = pick(ui, &mut hue);
    if button.changed() {
        *colour = as_strong(hue, *colour).unwrap_or(*colour);
    }
    button
}

/// A row for it.
pub fn of_tint(ui: &mut Ui, name: &str, about: &str, colour: &mut [f64; 3], reset: [f64; 3]) {
    let tip = Tip { name, about, span: "any hue".into(), reset: told(reset) };
    if tip.row(ui, |ui| button(ui, colour)).back {
        *colour = reset;
    }
}

/// A row for the hue of a light's flux; returns the hue that was picked. `reset` is a flux.
pub fn of_light(ui: &mut Ui, flux: &mut [f64; 3], reset: [f64; 3]) -> Option<[f64; 3]> {
    let about = "The hue of its light; its luminous flux stays.";
    let tip = Tip { name: "Hue", about, span: "any hue".into(), reset: told(reset) };
    let mut picked = None;
    let row = tip.row(ui, |ui| {
        let mut hue = *flux;
        let button = pick(ui, &mut hue);
        picked = button.changed().then_some(hue);
        button
    });
    if row.back {
        *flux = reset;
    }
    picked
}

/// Red, green and blue, for people.
fn told(colour: [f64; 3]) -> String {
    colour.map(brief).join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_hue_is_as_strong_as_the_colour_was() {
        assert_eq!(as_strong([0.5, 0.25, 0.0], [1.0, 3.0, 2.0]), Some([3.0, 1.5, 0.0]));
        assert_eq!(as_strong([0.0; 3], [1.0; 3]), None);
        assert_eq!(as_strong([1.0; 3], [0.0; 3]), None);
    }
}
