//! What every pixel scatters over all others: by which function, how its angles lie in the picture, and what comes of it.

use egui::{Grid, RichText, Ui};

use super::psf;
use crate::choices::{Border, Projection};
use crate::job::Ledger;
use crate::look::Veil;
use crate::psf::{Name, Parameters, Unit};
use crate::scene::VeilSection;
use crate::viewer::control::{Number, brief, choice, flag, hint};
use crate::viewer::document::Document;
use crate::viewer::model::Look;
use crate::viewer::stage::Stage;
use crate::viewer::veiling::Figures;

const SCATTER: Number = Number {
    name: "Scatter",
    about: "The share of the light that is scattered, where the strength is 1.",
    unit: "of the light",
    range: 1e-4..=1.0,
    logarithmic: true,
};

const TOLERANCE: Number = Number {
    name: "Veil error",
    about: "The largest error of the veil at any pixel, relative to the veil there.",
    unit: "of the local veil",
    range: 1e-6..=0.5,
    logarithmic: true,
};

const PROJECTIONS: [(Projection, &str, &str); 4] = [
    (Projection::Rectilinear, "rectilinear", "As nearly every lens: straight lines stay straight"),
    (Projection::Fisheye, "fisheye", "Distances from the middle are angles"),
    (
        Projection::Equirectangular,
        "equirectangular",
        "All directions, in a picture twice as wide as high: a veil without ghosts",
    ),
    (Projection::Planar, "planar", "Distances are angles everywhere: right in the middle of the picture only"),
];

const BORDERS: [(Border, &str, &str); 3] = [
    (Border::None, "none", "Nothing beyond the edges, which sends no light"),
    (Border::Mirror, "mirror", "The picture again, turned over"),
    (Border::Extend, "extend", "The pixels at the edge, on and on"),
];

/// Shows the panel.
pub fn show(ui: &mut Ui, document: &mut Document, stage: &Stage) {
    psf::function(ui, document);
    if let Some(veil) = document.look.veil.clone() {
        settings(ui, document, &veil);
    }
    let fault = document.veil_fault.as_deref().or_else(|| stage.veiling().wrong());
    if let Some(fault) = fault {
        ui.label(RichText::new(in_words(fault)).color(ui.visuals().error_fg_color));
    }
    figures(ui, document, stage);
}

fn settings(ui: &mut Ui, document: &mut Document, veil: &Veil) {
    let before = veil.section();
    let mut now = before.clone();
    let opened = document.opened.veil.as_ref().filter(|opened| opened.psf().name() == veil.psf().name());
    let (opened_adds, opened) = (opened.is_some_and(|opened| opened.adds), opened.map(Veil::section));
    let none = VeilSection {
        parameters: Parameters::new(before.parameters.psf),
        fov: None,
        projection: None,
        border: Some(Border::None),
        tolerance: None,
    };
    let opened = opened.unwrap_or(none);
    psf::parameters(ui, document, &mut now.parameters, &opened.parameters);
    let own = match before.parameters.psf {
        Name::Starburst => (0.0, "none besides"),
        _ => (veil.psf().energy(), "the function's own share"),
    };
    SCATTER.optional(ui, &mut now.parameters.scatter, own, opened.parameters.scatter);
    if veil.is_in_degrees() {
        field_of_view(ui, document);
        let about = "How the camera formed the picture: what angle lies between two pixels.";
        let (mut projection, reset) = (veil.projection(), opened.projection.unwrap_or(Projection::Rectilinear));
        choice(ui, "Projection", about, &mut projection, &PROJECTIONS, reset);
        if projection != veil.projection() {
            now.projection = if projection == reset { opened.projection } else { Some(projection) };
        }
    }
    if veil.projection() == Projection::Planar || veil.border != Border::None {
        let (mut border, reset) = (veil.border, opened.border.unwrap_or_default());
        choice(ui, "Border", "What lies beyond the picture's edges, for the veil.", &mut border, &BORDERS, reset);
        now.border = Some(border);
    }
    let open = (Veil::TOLERANCE, "0.01, or what can be had");
    TOLERANCE.optional(ui, &mut now.tolerance, open, opened.tolerance);
    let mut adds = veil.adds;
    let about =
        "The photo keeps all of its own light instead of losing what is scattered, and the picture gains light.";
    if flag(ui, "Keep light", about, &mut adds, opened_adds) {
        document.look.add_veil(adds);
        document.veil_fault = None;
    }
    if now != before {
        document.veil_fault = document.look.change_veil(&now).err().map(|fault| fault.in_words());
    }
}

/// What the picture spans, as somebody says or as its file does.
pub fn field_of_view(ui: &mut Ui, document: &mut Document) {
    let look = &document.look;
    let (projection, frame) = (look.projection(), &document.photo.frame);
    let view = Look { fov: None, ..look.clone() }.view(&document.photo, "angles are needed");
    let said = view.as_ref().ok().map(|view| (view.across(frame, projection), view.from.clone()));
    let most = if matches!(projection, Projection::Fisheye | Projection::Equirectangular) { 360.0 } else { 179.0 };
    let number = Number {
        name: "Field",
        about: "The field of view: the angle that the picture's width spans.",
        unit: "degrees",
        range: 0.1..=most,
        logarithmic: false,
    };
    let open = (said.as_ref().map_or(50.0, |(across, _)| *across), "what the photo's file says");
    number.optional(ui, &mut document.look.fov, open, document.opened.fov);
    match (said, document.look.fov) {
        (_, Some(_)) => {}
        (Some((across, from)), None) => hint(ui, format!("{across:.1}° across by the file: {from}")),
        (None, None) => hint(ui, "No field of view is known: give one, as 50 for a standard lens."),
    }
}

/// What is wrong, without the option that a command line has for it.
fn in_words(fault: &str) -> &str {
    match fault.strip_prefix("--").and_then(|rest| rest.split_once(": ")) {
        Some((option, words)) if !option.contains(' ') => words,
        _ => fault,
    }
}

/// What comes of it.
fn figures(ui: &mut Ui, document: &Document, stage: &Stage) {
    let look = &document.look;
    let Some(veil) = &look.veil else { return };
    let known = stage.veiling().figures();
    Grid::new("veil").num_columns(2).striped(true).show(ui, |ui| {
        let mut row = |name: &str, about: &str, value: String| {
            ui.label(name).on_hover_text(about);
            ui.label(value);
            ui.end_row();
        };
        let scattered = veil.energies(&document.frame).map(|share| look.strength * share);
        row("scattered", "The share of each pixel's light: strength times f", of_three(scattered));
        let per = match veil.psf().unit() {
            Unit::Degrees => "/sr",
            Unit::Look => "/unit²",
            Unit::Pixels => "/pixel",
            Unit::Micrometres => "/µm²",
        };
        row(
            "k(0)",
            "The function at its centre, where the strength is 1",
            format!("{} {per}", of_three(veil.psf().centres())),
        );
        // In its row, so that nothing below moves while something is dragged.
        let error = match &known {
            Some(Figures { layers, is_current: true, .. }) => {
                format!("{:.1e} of {:.1e}", layers.predicted, layers.asked)
            }
            _ if stage.veiling().is_summing() => "computing…".into(),
            _ => "–".into(),
        };
        row("predicted error", "At most, relative to the veil at each pixel; and what it is held to", error);
        let Some(known) = &known else { return };
        row("Gaussians", "Of the mixtures that stand for the function", known.layers.terms.to_string());
    });
    let Some(known) = known else { return };
    ledger(ui, &known.ledger);
    known.notes.into_iter().for_each(|note| hint(ui, note));
}

/// Where the light is.
fn ledger(ui: &mut Ui, ledger: &Ledger) {
    let Ledger { light, kept, inside, lost, gained } = *ledger;
    Grid::new("ledger").num_columns(4).striped(true).show(ui, |ui| {
        ui.strong("light").on_hover_text("What becomes of the photo's light, as shares of it");
        ["red", "green", "blue"].into_iter().for_each(|colour| _ = ui.label(colour));
        ui.end_row();
        let rows = [
            ("kept", "By the pixels that it was of", kept),
            ("in the picture", "Scattered over other pixels", inside),
            ("out of it", "Scattered beyond the edges", lost.map(|lost| lost.max(0.0))),
            (
                "more",
                "That there was not before: of a veil that is added, or by the definition, of coarse pixels",
                gained,
            ),
        ];
        for (name, about, parts) in rows {
            ui.label(name).on_hover_text(about);
            for (part, whole) in parts.into_iter().zip(light) {
                ui.label(if whole > 0.0 { format!("{:.2} %", 100.0 * part / whole) } else { "–".into() });
            }
            ui.end_row();
        }
    });
}

/// One number where the colours have the same, else all three.
fn of_three(values: [f64; 3]) -> String {
    let [red, green, blue] = values.map(brief);
    if red == green && green == blue { red } else { format!("{red}, {green}, {blue}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faults_are_told_without_options() {
        assert_eq!(in_words("--fov: cie is in degrees"), "cie is in degrees");
        for as_it_is in ["a strength of 2 scatters 1.1 of the light: give less", "--mix energy: x", "no option"] {
            assert_eq!(in_words(as_it_is), as_it_is);
        }
    }
}
