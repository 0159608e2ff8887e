//! How strong the glare is, what it looks like, and of which lens.

use egui::{ComboBox, Ui};

use super::{colour, lens, veil};
use crate::choices::{LengthUnit, Mix, Normalize};
use crate::look::Veil;
use crate::scene::presets::{self, NO_LENS};
use crate::scene::{Optical, OpticsSection, lenses};
use crate::viewer::control::{Number, Tip, choice, item_of};
use crate::viewer::document::Document;
use crate::viewer::model::{Look, LookLens};
use crate::viewer::stage::Stage;

const STRENGTH: Number = Number {
    name: "Strength",
    about: "What the glare is multiplied by.",
    unit: "times the lens's own",
    range: 0.0..=10.0,
    logarithmic: true,
};

const SIZE: Number = Number {
    name: "Size",
    about: "What the size of every ghost is multiplied by; its light stays as much as it is.",
    unit: "times",
    range: 0.01..=100.0,
    logarithmic: true,
};

const FSTOP: Number = Number {
    name: "F-number",
    about: "What the lens is stopped down to; the smaller its opening, the smaller its ghosts, and blades show.",
    unit: "focal lengths over diameters",
    range: 0.7..=32.0,
    logarithmic: true,
};

const TINT: [Number; 3] = [tint("Tint red"), tint("Tint green"), tint("Tint blue")];

const AXIS: [Number; 2] = [axis("Axis x"), axis("Axis y")];

const MIXES: [(Mix, &str, &str); 2] = [
    (Mix::Add, "add", "The photo keeps its light"),
    (Mix::Energy, "energy", "What scatters is missing in the photo's lights; not with normalised glare"),
];

const UNITS: [(LengthUnit, &str, &str); 4] = [
    (LengthUnit::ShortSide, "short side", "Half the picture's shorter side, which stays when it is turned by 90°"),
    (LengthUnit::Height, "height", "Half its height, as in files that name no unit"),
    (LengthUnit::Diagonal, "diagonal", "Half its diagonal, which does so, too"),
    (LengthUnit::Degrees, "degrees", "As they are in the picture's middle, by its field of view"),
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
        unit: "times",
        range: 0.0..=4.0,
        logarithmic: false,
    }
}

const fn axis(name: &'static str) -> Number {
    Number {
        name,
        about: "Where the lens's axis meets the picture; 0 is the picture's centre.",
        unit: "of the look's unit",
        range: -4.0..=4.0,
        logarithmic: false,
    }
}

/// Shows the panel.
pub fn show(ui: &mut Ui, document: &mut Document, _: &Stage) {
    let (look, opened) = (&mut document.look, &document.opened);
    STRENGTH.show(ui, &mut look.strength, opened.strength);
    preset(ui, look, opened);
    stop(ui, look, opened);
    SIZE.show(ui, &mut look.size, opened.size);
    let about = "What all lengths are counted in: sizes, and positions from the picture's centre. Their numbers stay.";
    choice(ui, "Unit", about, &mut look.unit, &UNITS, opened.unit);
    if look.unit == LengthUnit::Degrees && !look.veil.as_ref().is_some_and(Veil::is_in_degrees) {
        veil::field_of_view(ui, document);
    }
    let (look, opened) = (&mut document.look, &document.opened);
    for (colour, number) in TINT.iter().enumerate() {
        number.show(ui, &mut look.tint[colour], opened.tint[colour]);
    }
    colour::of_tint(ui, "Tint", "The hue of the glare; its strongest colour stays.", &mut look.tint, opened.tint);
    AXIS[0].show(ui, &mut look.axis.x, opened.axis.x);
    AXIS[1].show(ui, &mut look.axis.y, opened.axis.y);
    let mut mix = look.mix;
    choice(ui, "Mix", "Where the ghosts' light comes from.", &mut mix, &MIXES, opened.mix);
    if mix != look.mix {
        look.set_mix(mix);
    }
    let about = "How the field's values become glare.";
    choice(ui, "Normalise", about, &mut look.normalize, &NORMALIZE, opened.normalize);
    lens::show(ui, document);
}

/// What a lens is called for people.
fn called(lens: &LookLens) -> String {
    match lens {
        LookLens::Preset(lens) | LookLens::File(_, lens) => lens.name.clone(),
        LookLens::Optical(optical) => optical.lens().name.clone(),
        LookLens::Own(_) => "its own table".into(),
    }
}

/// How far a lens that is known by its surfaces is stopped down; no row where there is none.
fn stop(ui: &mut Ui, look: &mut Look, opened: &Look) {
    let LookLens::Optical(optical) = &look.lens else { return };
    let set = |lens: &LookLens| match lens {
        LookLens::Optical(optical) => optical.section().fstop,
        _ => None,
    };
    // As it is engraved: a lens opens as wide as that but for 1 %.
    let (mut fstop, widest) = (set(&look.lens), (100.0 * optical.widest()).round() / 100.0);
    FSTOP.optional(ui, &mut fstop, (widest, "as wide as the lens opens"), set(&opened.lens));
    if fstop != set(&look.lens) {
        let fstop = fstop.map(|fstop| fstop.max(widest));
        // What cannot be set stays as it was.
        if let Ok(set) = Optical::new(OpticsSection { fstop, ..optical.section().clone() }) {
            look.lens = LookLens::Optical(set);
        }
    }
}

/// The lenses that there are, and real ones after them; one with a veil brings it along.
fn preset(ui: &mut Ui, look: &mut Look, opened: &Look) {
    let presets = || presets::all().iter().map(|preset| preset.name).chain([NO_LENS]);
    let names: Vec<_> = presets().collect();
    let span = format!("one of {}, or a table of the look's own", names.join(", "));
    let about = "What the lights are seen through.";
    let tip = Tip { name: "Lens", about, span, reset: called(&opened.lens) };
    let row = tip.row(ui, |ui| {
        // High enough for all: that there are more below is seen by nothing.
        let list = ComboBox::from_id_salt("preset").height(720.0).selected_text(called(&look.lens));
        list.show_ui(ui, |ui| {
            for preset in presets() {
                // A preset that is compiled in can be read; a test reads them all.
                let Ok(lens) = presets::named(preset) else { continue };
                let chosen = matches!(&look.lens, LookLens::Preset(now) if now.name == lens.name);
                let about = lens.description.clone();
                if item_of(ui, preset, &about, |ui| ui.selectable_label(chosen, preset)) {
                    let adds = look.veil.as_ref().is_some_and(|veil| veil.adds);
                    // What cannot be had of a preset is nothing; the same test makes their veils.
                    *look = look.clone().through(LookLens::Preset(lens.into()), adds).unwrap_or_else(|_| look.clone());
                }
            }
            ui.separator();
            for lens in lenses::all() {
                let name = lens.name;
                let chosen =
                    matches!(&look.lens, LookLens::Optical(now) if now.section().lens.as_deref() == Some(name));
                let about = "A real lens, by the surfaces of its patent";
                if item_of(ui, &format!("real {name}"), about, |ui| ui.selectable_label(chosen, name)) {
                    let section = OpticsSection { lens: Some(name.to_owned()), ..OpticsSection::default() };
                    let adds = look.veil.as_ref().is_some_and(|veil| veil.adds);
                    let through = |optical| look.clone().through(LookLens::Optical(optical), adds);
                    *look = Optical::new(section).and_then(through).unwrap_or_else(|_| look.clone());
                }
            }
        })
        .response
    });
    if row.back {
        (look.lens, look.veil) = (opened.lens.clone(), opened.veil.clone());
    }
}
