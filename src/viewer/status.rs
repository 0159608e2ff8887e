//! What the window shows, for whoever drives it from outside: a script, or a test with a pointer of its own.

use std::collections::BTreeMap;

use egui::Pos2;
use serde::Serialize;

use super::app::App;
use super::control::Told;
use super::stage::Counts;
use crate::choices::Evaluator;

/// What is open and set, and where it is.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Status {
    /// The name of the photo that is shown.
    pub photo: Option<String>,
    /// Where its lights are.
    pub lights: Vec<[f64; 2]>,
    /// The strength of its glare.
    pub strength: Option<f64>,
    /// What evaluates its glare, by hand or as planned.
    pub evaluator: Option<Evaluator>,
    /// Whether there is something to undo, and to redo.
    pub steps: [bool; 2],
    /// Whether a photo is being read, a veil computed, or a picture written.
    pub busy: bool,
    /// Whether the window asks for a path.
    pub asks: bool,
    /// Whether a dialog of the desktop asks for one.
    pub dialog: bool,
    /// What went wrong and was not dismissed.
    pub notices: Vec<String>,
    /// On how many devices it has been drawn, one after the other.
    pub devices: u32,
    /// How often each kind of work has been done, on the last of them.
    pub counts: Counts,
    /// The screen's pixels in a point.
    pub scale: f32,
    /// Where the lights are on the screen, in pixels from its top left.
    pub lights_at: Vec<[f32; 2]>,
    /// Left, top, right and bottom of the controls that are shown, in pixels.
    pub controls: BTreeMap<String, [f32; 4]>,
}

impl Status {
    /// As the last frame left it.
    pub fn of(app: &App) -> Self {
        let document = app.document();
        let scale = app.context().pixels_per_point();
        let pixels = |at: Pos2| [at.x * scale, at.y * scale];
        let lights = document.map(|document| document.lights()).unwrap_or_default();
        let placed = app.placement().zip(document);
        let at = |position| placed.map(|(placement, document)| placement.to_screen(document.place(position)));
        let control = |told: Told| {
            let [[left, top], [right, bottom]] = [told.part.min, told.part.max].map(pixels);
            (told.name, [left, top, right, bottom])
        };
        Self {
            photo: document.map(super::Document::name),
            lights: lights.iter().map(|light| light.position.to_array()).collect(),
            strength: document.map(|document| document.look.strength),
            evaluator: app.plan().map(|plan| plan.evaluator()),
            steps: document.map(super::Document::steps).unwrap_or_default(),
            busy: app.is_reading() || app.is_writing() || app.is_veiling(),
            asks: app.asks(),
            dialog: app.asks_elsewhere(),
            notices: app.notices().to_vec(),
            devices: app.devices(),
            counts: app.counts(),
            scale,
            lights_at: lights.iter().filter_map(|light| at(light.position)).map(pixels).collect(),
            controls: app.controls().into_iter().map(control).collect(),
        }
    }
}
