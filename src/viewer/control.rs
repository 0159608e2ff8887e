//! Controls that say what they set: a name, a unit and a range in the tooltip, and a double click on the name that puts
//! them back.

use std::ops::RangeInclusive;

use egui::{DragValue, Label, Response, Sense, Slider, SliderClamping, Ui};

/// Where [`App::control`](super::App::control) finds a control's slider.
pub fn place(name: &str) -> egui::Id {
    egui::Id::unique(("control", name))
}

/// A number that can be set.
pub struct Number {
    /// What it is called.
    pub name: &'static str,
    /// What it does, in a sentence.
    pub about: &'static str,
    /// Its unit; empty where it has none.
    pub unit: &'static str,
    /// The range that the slider spans; what is typed may not leave it either.
    pub range: RangeInclusive<f64>,
    /// The slider's steps are even in the logarithm.
    pub logarithmic: bool,
}

impl Number {
    /// A row with the name, a slider and the number. `reset` is what a double click on the name sets.
    pub fn show(&self, ui: &mut Ui, value: &mut f64, reset: f64) -> Response {
        let tip = self.tip(reset);
        ui.horizontal(|ui| {
            let name = ui.add_sized([74.0, 18.0], Label::new(self.name).sense(Sense::click()).selectable(false));
            let slider = Slider::new(value, self.range.clone())
                .show_value(false)
                .logarithmic(self.logarithmic)
                // What a file says beyond the range stays until it is set here.
                .clamping(SliderClamping::Edits)
                .smallest_positive(1e-3);
            let rail = ui.add(slider);
            let speed = (self.range.end() - self.range.start()) / 500.0;
            let number = DragValue::new(value).range(self.range.clone()).clamp_existing_to_range(false);
            let number = number.speed(speed).max_decimals(6);
            let number = ui.add(number);
            if name.double_clicked() {
                *value = reset;
            }
            ui.ctx().data_mut(|data| data.insert_temp(place(self.name), rail.rect));
            (name | rail | number).on_hover_text(tip)
        })
        .inner
    }

    fn tip(&self, reset: f64) -> String {
        let Self { about, unit, range, .. } = self;
        let space = if unit.is_empty() { "" } else { " " };
        format!("{about}\n{} to {}{space}{unit}; {reset} after a double click on the name", range.start(), range.end())
    }
}
