//! The function by which every pixel scatters, and its numbers.

use egui::{Grid, Ui};

use super::colour;
use crate::look::Veil;
use crate::printable;
use crate::psf::{
    AGES, BLADES, EXPONENTS, FSTOPS, Luminance, MOST_WIDTHS, Name, PIGMENTS, Parameters, SENSORS, USUAL_BLADES,
    USUAL_SENSOR,
};
use crate::viewer::ask::Purpose;
use crate::viewer::control::{Number, brief, button, cell, choice, done_by};
use crate::viewer::document::Document;

const FUNCTIONS: [(Option<Name>, &str, &str); 12] = [
    (None, "none", "No pixel scatters; lights may still make ghosts"),
    (Some(Name::Cie), "cie", "An eye by CIE 146, its glare from 0.1° on, by age and pigment"),
    (Some(Name::Cie135), "cie135", "An eye by CIE 135/1, all of its light, by age and pigment"),
    (Some(Name::Spencer), "spencer", "An eye by Spencer and others (1995), without the ring, by day, dusk or night"),
    (Some(Name::StilesHolladay), "stiles-holladay", "An eye by Stiles and Holladay's equation, by age"),
    (Some(Name::Gaussian), "gaussian", "One Gaussian, on the picture's plane"),
    (Some(Name::Mixture), "mixture", "Gaussians with weights and colours, on the picture's plane"),
    (Some(Name::Abg), "abg", "a / (b + r^g), as polished surfaces scatter, on the picture's plane"),
    (Some(Name::Table), "table", "Radii and values from a CSV file, on the picture's plane"),
    (Some(Name::Camera), "camera", "A lens: a core and a tail, 3 % of the light, on the picture's plane"),
    (Some(Name::Kernel), "kernel", "A picture of a point's light, pixel by pixel"),
    (Some(Name::Starburst), "starburst", "The spikes of an iris, by what its blades diffract"),
];

const LUMINANCES: [(Luminance, &str, &str); 3] = [
    (Luminance::Photopic, "photopic", "By day"),
    (Luminance::Mesopic, "mesopic", "At dusk"),
    (Luminance::Scotopic, "scotopic", "At night"),
];

const AGE: Number = Number {
    name: "Age",
    about: "The observer's age: older eyes scatter more.",
    unit: "years",
    range: AGES[0]..=AGES[1],
    logarithmic: false,
};

const PIGMENT: Number = Number {
    name: "Pigment",
    about: "The pigment of the observer's eyes: 0 black, 0.5 brown, 1.2 light blue.",
    unit: "by CIE 146",
    range: PIGMENTS[0]..=PIGMENTS[1],
    logarithmic: false,
};

const WIDTH: Number = Number {
    name: "Width",
    about: "The Gaussian's standard deviation.",
    unit: "of the look's unit",
    range: 1e-4..=10.0,
    logarithmic: true,
};

const FSTOP: Number = Number {
    name: "F-number",
    about: "The f-number: the smaller the opening, the larger what it diffracts.",
    unit: "f-number",
    range: FSTOPS[0]..=FSTOPS[1],
    logarithmic: true,
};

const BLADES_OF_IRIS: Number = Number {
    name: "Blades",
    about: "Blades of the iris, 3 to 16, or 0 for a round one: as many spikes where they are even, else twice as many.",
    unit: "blades",
    range: 0.0..=16.0,
    logarithmic: false,
};

const ROTATION: Number = Number {
    name: "Rotation",
    about: "How far the iris is turned against the clock, from a corner on the right.",
    unit: "degrees",
    range: -180.0..=180.0,
    logarithmic: false,
};

const ROUNDNESS: Number = Number {
    name: "Roundness",
    about: "How far the blades are bent: 0 straight, 1 a circle. Bent ones spread their spikes.",
    unit: "of the circle's curvature",
    range: 0.0..=1.0,
    logarithmic: false,
};

const SENSOR: Number = Number {
    name: "Sensor",
    about: "The width of the sensor, which the photo's width spans.",
    unit: "millimetres",
    range: SENSORS[0]..=SENSORS[1],
    logarithmic: true,
};

const WEIGHT: Number = Number {
    name: "weight",
    about: "How much of the light this Gaussian has, as a ratio to the others.",
    unit: "as a ratio",
    range: 0.0..=1e6,
    logarithmic: false,
};

const TAIL: [Number; 3] = [
    tail("A", "a of a / (b + r^g): what the tail is multiplied by.", 1e-12..=1e6),
    tail("B", "b of a / (b + r^g): how wide the core is, as r^g.", 1e-12..=1e6),
    tail(
        "Exponent",
        "g of a / (b + r^g): how fast the tail falls; below 2.05 it needs an end.",
        EXPONENTS[0]..=EXPONENTS[1],
    ),
];

const END: Number =
    tail("End", "The radius from which on it no longer counts for the light that is scattered.", 1e-3..=1e3);

const fn tail(name: &'static str, about: &'static str, range: std::ops::RangeInclusive<f64>) -> Number {
    Number { name, about, unit: "by the look's unit", range, logarithmic: true }
}

/// Which function; a table and a picture ask for their file.
pub fn function(ui: &mut Ui, document: &mut Document) {
    let name = |veil: &Option<Veil>| veil.as_ref().map(|veil| veil.psf().name());
    let (now, opened) = (name(&document.look.veil), name(&document.opened.veil));
    let mut chosen = now;
    choice(ui, "Function", "How a pixel's light is scattered over all others.", &mut chosen, &FUNCTIONS, opened);
    if chosen == now {
        return;
    }
    document.veil_fault = None;
    match chosen {
        _ if chosen == opened => document.look.veil.clone_from(&document.opened.veil),
        Some(Name::Table) => document.wants_path = Some(Purpose::OpenTable),
        Some(Name::Kernel) => document.wants_path = Some(Purpose::OpenKernel),
        _ => document.veil_fault = document.look.choose_psf(chosen).err().map(|fault| fault.in_words()),
    }
}

/// The numbers that a function takes; `opened` are what it was opened with, or nothing.
pub fn parameters(ui: &mut Ui, document: &mut Document, now: &mut Parameters, opened: &Parameters) {
    match now.psf {
        Name::Cie | Name::Cie135 => {
            number(ui, &AGE, &mut now.age, 25.0, opened.age);
            number(ui, &PIGMENT, &mut now.pigment, 0.5, opened.pigment);
        }
        Name::StilesHolladay => number(ui, &AGE, &mut now.age, 25.0, opened.age),
        Name::Spencer => {
            let (before, reset) = (now.luminance.unwrap_or_default(), opened.luminance.unwrap_or_default());
            let mut luminance = before;
            choice(ui, "Luminance", "What the eye is adapted to.", &mut luminance, &LUMINANCES, reset);
            if luminance != before {
                now.luminance = if luminance == reset { opened.luminance } else { Some(luminance) };
            }
        }
        Name::Gaussian => number(ui, &WIDTH, &mut now.width, 0.1, opened.width),
        Name::Mixture => mixture(ui, now, opened),
        Name::Abg => {
            for ((one, value), reset) in
                TAIL.iter().zip([&mut now.a, &mut now.b, &mut now.g]).zip([opened.a, opened.b, opened.g])
            {
                let begin = value.unwrap_or(1.0);
                number(ui, one, value, begin, reset.or(Some(begin)));
            }
            END.optional(ui, &mut now.end, (1.0, "none"), opened.end);
        }
        Name::Table => file(ui, document, now.table.as_deref(), Purpose::OpenTable),
        Name::Kernel => file(ui, document, now.kernel.as_deref(), Purpose::OpenKernel),
        Name::Starburst => iris(ui, now, opened),
        Name::Camera => {}
    }
}

/// The iris of a starburst.
fn iris(ui: &mut Ui, now: &mut Parameters, opened: &Parameters) {
    let open = now.fstop.unwrap_or(FSTOPS[1]);
    number(ui, &FSTOP, &mut now.fstop, open, opened.fstop.or(Some(open)));
    let usual = f64::from(USUAL_BLADES);
    let before = now.blades.unwrap_or(USUAL_BLADES);
    let mut blades = now.blades.map(f64::from);
    number(ui, &BLADES_OF_IRIS, &mut blades, usual, opened.blades.map(f64::from));
    now.blades = blades.map(|blades| match blades.round() as u32 {
        // There is nothing between a round one and a triangle.
        1 | 2 if before == 0 => BLADES[0],
        1 | 2 => 0,
        blades => blades,
    });
    if now.blades == Some(0) {
        (now.rotation, now.roundness) = (None, None);
    } else {
        number(ui, &ROTATION, &mut now.rotation, 0.0, opened.rotation);
        number(ui, &ROUNDNESS, &mut now.roundness, 0.0, opened.roundness);
    }
    number(ui, &SENSOR, &mut now.sensor, USUAL_SENSOR, opened.sensor);
}

/// A number that is `open` where nothing says it.
fn number(ui: &mut Ui, number: &Number, value: &mut Option<f64>, open: f64, reset: Option<f64>) {
    let mut now = value.unwrap_or(open);
    let before = now;
    if number.show(ui, &mut now, reset.unwrap_or(open)).back {
        *value = reset;
    } else if now != before {
        *value = Some(now);
    }
}

/// The file of a table or a picture.
fn file(ui: &mut Ui, document: &mut Document, path: Option<&std::path::Path>, purpose: Purpose) {
    let whole = path.map(|path| printable::line(&path.to_string_lossy())).unwrap_or_default();
    let name = path.and_then(|path| path.file_name()).map(|name| printable::line(&name.to_string_lossy()));
    ui.label(name.unwrap_or_default()).on_hover_text(whole);
    if button(ui, "Another file…", "Opens another file of the kind") {
        document.wants_path = Some(purpose);
    }
}

/// A row for each Gaussian.
fn mixture(ui: &mut Ui, now: &mut Parameters, opened: &Parameters) {
    let mut widths = now.widths.clone().unwrap_or_default();
    let count = widths.len();
    let mut weights = now.weights.clone().unwrap_or_else(|| vec![1.0; count]);
    let mut tints = now.tints.clone().unwrap_or_else(|| vec![[1.0; 3]; count]);
    // Lists of other lengths are none of a function that could be had.
    weights.resize(count, 1.0);
    tints.resize(count, [1.0; 3]);
    let before = (widths.clone(), weights.clone(), tints.clone());
    let mut gone = None;
    Grid::new("mixture").striped(true).min_col_width(8.0).show(ui, |ui| {
        ["", "width", "weight", "hue"].into_iter().for_each(|head| _ = ui.label(head));
        ui.end_row();
        for index in 0..count {
            let row = index + 1;
            let was = |list: &Option<Vec<f64>>, other: f64| {
                list.as_ref().and_then(|list| list.get(index).copied()).unwrap_or(other)
            };
            ui.label(row.to_string());
            let reset = was(&opened.widths, before.0[index]);
            WIDTH.cell(ui, format!("width {row}"), &mut widths[index], reset);
            WEIGHT.cell(ui, format!("weight {row}"), &mut weights[index], was(&opened.weights, 1.0));
            let reset = opened.tints.as_ref().and_then(|tints| tints.get(index).copied()).unwrap_or([1.0; 3]);
            let about = "The Gaussian's hue; its strongest colour stays.";
            let told = reset.map(brief).join(", ");
            if cell(ui, about, "any hue", format!("hue {row}"), &told, |ui| colour::button(ui, &mut tints[index])) {
                tints[index] = reset;
            }
            let about = "Takes the Gaussian away; the last one stays";
            if done_by(ui, format!("delete Gaussian {row}"), about, |ui| ui.small_button("×")) {
                gone = Some(index);
            }
            ui.end_row();
        }
    });
    if let Some(index) = gone.filter(|_| count > 1) {
        (_, _, _) = (widths.remove(index), weights.remove(index), tints.remove(index));
    }
    let about = "Another one, twice as wide as the last";
    if button(ui, "Add a Gaussian", about) && count < MOST_WIDTHS {
        widths.push(2.0 * widths.last().copied().unwrap_or(0.05));
        weights.push(1.0);
        tints.push([1.0; 3]);
    }
    if (&widths, &weights, &tints) != (&before.0, &before.1, &before.2) {
        let said = weights.iter().any(|&weight| weight != 1.0) || now.weights.is_some();
        now.weights = said.then_some(weights);
        let said = tints.iter().any(|&tint| tint != [1.0; 3]) || now.tints.is_some();
        now.tints = said.then_some(tints);
        now.widths = Some(widths);
    }
}
