//! What counts as a light, the list of lights, and the one that is selected.

use egui::{ScrollArea, Ui};
use glam::DVec2;

use super::{colour, ghosts};
use crate::choices::{Beyond, LightBy, LightShape, Sources};
use crate::scene::{Found, Light, Recover};
use crate::viewer::control::{self, Number, button, cell, choice, done_by, flag};
use crate::viewer::document::Document;
use crate::viewer::model::LookLights;
use crate::viewer::stage::Stage;

const THRESHOLD: Number = Number {
    name: "Threshold",
    about: "The brightness from which on a pixel is light; what it takes is marked on the picture meanwhile.",
    unit: "in the photo's unit",
    range: 0.0..=1e6,
    logarithmic: true,
};

const MERGE: Number = Number {
    name: "Merge",
    about: "How close regions are that become one light.",
    unit: "of the look's unit",
    range: 0.0..=2.0,
    logarithmic: true,
};

const KNEE: Number = Number {
    name: "Knee",
    about: "How far below and above the threshold pixels begin to shine, and shine in full.",
    unit: "in the photo's unit",
    range: 0.0..=1e6,
    logarithmic: true,
};

const MOST: Number = Number {
    name: "Most",
    about: "At most so many lights are kept, the brightest.",
    unit: "lights",
    range: 0.0..=65536.0,
    logarithmic: true,
};

const BY: [(LightBy, &str, &str); 2] = [
    (LightBy::Brightest, "brightest channel", "A lamp of any colour is as bright as a white one"),
    (LightBy::Luminance, "luminance", "Red and blue lamps are darker than white ones"),
];

const FIREFLIES: Number = Number {
    name: "Firefly limit",
    about: "A single pixel that outshines its neighbours by more is no light; 0 takes it as it is.",
    unit: "times",
    range: 0.0..=1e6,
    logarithmic: true,
};

const RECOVER: Number = Number {
    name: "Recover",
    about: "How much brighter than it is shown what is clipped shines; the picture keeps what it shows.",
    unit: "stops",
    range: 0.0..=Recover::MOST,
    logarithmic: false,
};

const PLACE: [Number; 2] = [place("Light x"), place("Light y")];

const EXTENT: Number = Number {
    name: "Extent",
    about: "The light's rms radius along one axis; 0 is a point.",
    unit: "of the look's unit",
    range: 0.0..=1e6,
    logarithmic: false,
};

const FLUX: [Number; 3] = [flux("Flux red"), flux("Flux green"), flux("Flux blue")];

const fn place(name: &'static str) -> Number {
    Number {
        name,
        about: "Where the light is, from the picture's centre; it may be off the picture.",
        unit: "of the look's unit",
        range: -1e6..=1e6,
        logarithmic: false,
    }
}

const fn flux(name: &'static str) -> Number {
    Number {
        name,
        about: "The light's radiance times its area.",
        unit: "in the photo's unit times the look's unit squared",
        range: 0.0..=1e12,
        logarithmic: false,
    }
}

/// The most height that the list of lights takes, in points.
const LIST: f32 = 192.0;

/// Shows the panel.
pub fn show(ui: &mut Ui, document: &mut Document, stage: &Stage) {
    find(ui, document);
    recover(ui, document, stage);
    ui.separator();
    ui.horizontal(|ui| {
        let about = "Adds a white light in the picture's centre, as bright as the faintest here";
        if button(ui, "Add a light", about) {
            let light = another(&document.lights());
            document.lights_mut().push(light);
            document.select(document.lights().len() - 1);
        }
        if button(ui, "As found", "Goes back to the lights that are found in the photo, where they are") {
            document.look.lights = LookLights::Found;
            document.selected = None;
        }
        if button(ui, "Every pixel", "Makes every pixel of the photo a source, beside the lights of the look's own") {
            document.look.shine_by(Sources::Photo);
            document.selected = None;
        }
    });
    control::hint(
        ui,
        match &document.look.lights {
            LookLights::Found => "As they are found in the photo",
            LookLights::Listed(_) => "A list of the look's own",
            LookLights::FoundAnd(_) => "As they are found in the photo, and the look's own",
            LookLights::Photo(lights) if lights.is_empty() => "Every pixel of the photo",
            LookLights::Photo(_) => "Every pixel of the photo, and the look's own",
        },
    );
    let mut gone = None;
    let shown = document.shows_light.take();
    list(ui, "lights", document.lights().len(), shown, |ui, index| {
        if row(ui, document, index) {
            gone = Some(index);
        }
    });
    if let Some(index) = gone {
        document.delete_light(index);
    }
    if let Some(index) = document.selected.filter(|&index| index < document.lights().len()) {
        ui.separator();
        selected(ui, document, index);
    }
    ui.separator();
    ghosts::show(ui, document);
}

/// A list, of which only the rows that are seen are made: there may be 100,000 of them. `shown` is scrolled to.
///
/// So many that they would leave no room for the rest have a part of the panel to be scrolled in.
pub(super) fn list(ui: &mut Ui, name: &str, rows: usize, shown: Option<usize>, mut row: impl FnMut(&mut Ui, usize)) {
    let height = ui.spacing().interact_size.y;
    let mut area = ScrollArea::vertical().id_salt(name).max_height(LIST);
    if let Some(index) = shown {
        let middle = index as f32 * (height + ui.spacing().item_spacing.y) - 0.5 * (LIST - height);
        area = area.vertical_scroll_offset(middle.max(0.0));
    }
    area.show_rows(ui, height, rows, |ui, seen| seen.for_each(|index| row(ui, index)));
}

/// A light in the list; whether it is to be deleted.
fn row(ui: &mut Ui, document: &mut Document, index: usize) -> bool {
    let (light, number) = (document.lights()[index], index + 1);
    ui.horizontal(|ui| {
        let (mut on, about) = (!light.muted, "Whether the light glares (M).");
        let mut clicked = false;
        let back = cell(ui, about, "on or off", format!("mute {number}"), "on", |ui| {
            let mute = ui.checkbox(&mut on, "");
            clicked = mute.clicked();
            mute
        });
        if clicked || (back && light.muted) {
            document.lights_mut()[index].muted = !on && !back;
        }
        let about = "Selects the light. Its flux is radiance times area, in the look's unit squared";
        let text = format!("Light {number}:  {:.2e}", mean_flux(&light));
        let chosen = document.selected == Some(index);
        if done_by(ui, format!("light {number}"), about, |ui| ui.selectable_label(chosen, text)) {
            document.select(index);
        }
        done_by(ui, format!("delete {number}"), "Deletes the light (Delete)", |ui| ui.small_button("×"))
    })
    .inner
}

/// What counts as a light; the photo is searched anew while it is set.
fn find(ui: &mut Ui, document: &mut Document) {
    let whole = matches!(document.look.lights, LookLights::Photo(_));
    let (opened, found) = (document.opened.find, document.found.threshold);
    let find = &mut document.look.find;
    choice(ui, "Told by", "What of a pixel tells light from the rest.", &mut find.by, &BY, opened.by);
    let mut automatic = find.threshold.is_none();
    let about = "Lets the photo decide from which brightness on a pixel is light.";
    if flag(ui, "By the photo", about, &mut automatic, opened.threshold.is_none()) {
        find.threshold = (!automatic).then_some(found);
    }
    if let Some(threshold) = &mut find.threshold {
        let row = THRESHOLD.show(ui, threshold, opened.threshold.unwrap_or(found));
        document.sets_threshold = row.attended;
    }
    if whole && find.threshold.is_some() {
        KNEE.show(ui, &mut find.knee, opened.knee);
    }
    let about = "Marks the pixels that are light by now, before the photo is searched (K).";
    flag(ui, "Mask", about, &mut document.viewing.mask, false);
    MERGE.show(ui, &mut find.merge, opened.merge);
    let (mut kept, by_default) = (find.shape == LightShape::Kept, opened.shape == LightShape::Kept);
    let about = "Makes several lights of one that is long, bent or hollow, so that it keeps its shape.";
    if flag(ui, "Keep shapes", about, &mut kept, by_default) {
        find.shape = if kept { LightShape::Kept } else { LightShape::Ball };
    }
    let mut most = find.max_lights as f64;
    MOST.show(ui, &mut most, opened.max_lights as f64);
    if most != find.max_lights as f64 {
        find.max_lights = most.round() as usize;
    }
    let (mut joins, by_default) = (find.beyond == Beyond::Join, opened.beyond == Beyond::Join);
    let about = "Lets lights beyond the most join the nearest that is kept, so that no light is lost.";
    if flag(ui, "Join the rest", about, &mut joins, by_default) {
        find.beyond = if joins { Beyond::Join } else { Beyond::Drop };
    }
    FIREFLIES.show(ui, &mut find.firefly_limit, opened.firefly_limit);
    if find.firefly_limit > 0.0 && find.firefly_limit < 1.0 {
        // Below 1 nearly every pixel would be one; the way to 0 leads through there.
        find.firefly_limit = find.firefly_limit.round();
    }
    let searching = if document.wants_search() { ", searching" } else { "" };
    let (regions, threshold) = (document.found.regions, control::brief(document.found.threshold));
    let noun = if regions == 1 { "region" } else { "regions" };
    control::hint(ui, format!("{regions} {noun} from {threshold} on{searching}"));
    match &document.found {
        Found { joined: 0, dropped: 0, .. } => {}
        Found { joined: 0, dropped, dropped_share, .. } => {
            control::hint(ui, format!("{dropped} fainter lights left out, {} % of the flux", percent(*dropped_share)))
        }
        Found { joined, joined_share, .. } => {
            control::hint(ui, format!("{joined} fainter lights joined, {} % of the flux", percent(*joined_share)))
        }
    }
    match document.found.fireflies {
        0 => {}
        1 => control::hint(ui, "1 firefly, which is no light"),
        many => control::hint(ui, format!("{many} fireflies, which are no lights")),
    }
}

/// How clipped pixels shine: by their photo's kind, or by so many stops. Where neither that nor a look has something to say, there is no row.
fn recover(ui: &mut Ui, document: &mut Document, stage: &Stage) {
    let number = |recover| match recover {
        Recover::Auto | Recover::AutoFrom(_) => None,
        Recover::None => Some(0.0),
        Recover::Stops(stops) => Some(stops),
    };
    let told = stage.recovery();
    let is_set = [&document.look, &document.opened].iter().any(|look| look.find.recover != Recover::Auto);
    if !is_set && !document.photo.source.display_referred {
        return;
    }
    let (before, opened) = (number(document.look.find.recover), number(document.opened.find.recover));
    let mut now = before;
    let open = told.map_or(0.0, |told| told.stops);
    RECOVER.optional(ui, &mut now, (open, "what files for displays are likely to need"), opened);
    if now != before {
        document.look.find.recover = match now {
            None => Recover::Auto,
            Some(stops) if stops > 0.0 => Recover::Stops(stops),
            Some(_) => Recover::None,
        };
    }
    if let Some(told) = told {
        control::hint(ui, told.to_string());
        told.note.iter().for_each(|note| control::hint(ui, note));
    }
}

/// The numbers of one light; each goes back to what it was when the light was selected.
fn selected(ui: &mut Ui, document: &mut Document, index: usize) {
    let weights = document.photo.luminance_weights();
    let old = document.lights()[index];
    let (mut light, before) = (old, document.light_before().unwrap_or(old));
    ui.strong(format!("Light {}", index + 1));
    PLACE[0].plain(ui, &mut light.position.x, before.position.x, 0.002);
    PLACE[1].plain(ui, &mut light.position.y, before.position.y, 0.002);
    EXTENT.plain(ui, &mut light.size, before.size, 0.001);
    for ((number, part), before) in FLUX.iter().zip(&mut light.flux).zip(before.flux) {
        let speed = 0.01 * part.abs().max(1e-6);
        number.plain(ui, part, before, speed);
    }
    let hue = colour::of_light(ui, &mut light.flux, before.flux);
    if light != old {
        document.lights_mut()[index] = light;
    }
    if let Some(hue) = hue {
        document.look.set_light_colour(&document.found.lights, index, hue, weights);
    }
}

/// A share in percent, to a tenth.
fn percent(share: f64) -> String {
    control::brief((1e3 * share).round() / 10.0)
}

/// The mean of a light's colours.
fn mean_flux(light: &Light) -> f64 {
    light.flux.iter().sum::<f64>() / 3.0
}

/// A point in the centre, as bright as the faintest light that there is.
fn another(lights: &[Light]) -> Light {
    let faintest = lights.iter().map(mean_flux).fold(f64::INFINITY, f64::min);
    let flux = if faintest.is_finite() { faintest } else { 1.0 };
    Light { position: DVec2::ZERO, flux: [flux; 3], size: 0.0, muted: false }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_a_list_of_100_000_only_the_rows_that_are_seen_are_made() {
        let context = egui::Context::default();
        let rows = |shown: Option<usize>| {
            let mut made = Vec::new();
            let mut output = context.run_ui(egui::RawInput::default(), |ui| {
                list(ui, "lights", 100_000, shown, |ui, index| {
                    ui.horizontal(|ui| ui.label(format!("Light {index}")));
                    made.push(index);
                });
            });
            // No one draws them.
            output.textures_delta.clear();
            made
        };
        // A context's first frames measure.
        for _ in 0..3 {
            rows(None);
        }
        let made = rows(None);
        assert!(made[0] == 0 && made.len() < 30, "{made:?}");
        rows(Some(54_321));
        let made = rows(None);
        assert!(made.contains(&54_321) && made.len() < 60, "{made:?}");
    }
}
