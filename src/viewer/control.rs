//! Controls that say what they set: a row with the name on the left, a tooltip with unit, range and way back, and a
//! double click on the name that goes back.
//!
//! What every control says is kept for the frame, so that tests and scripts find controls by their names and no control
//! goes without.

use std::ops::RangeInclusive;

use egui::{
    ComboBox, Context, DragValue, Id, Key, Label, Rect, Response, RichText, Sense, Slider, SliderClamping, Ui, vec2,
};

/// The width of the column of names, in points.
const NAMES: f32 = 88.0;

/// What a control says of itself.
#[derive(Debug, Clone, PartialEq)]
pub struct Told {
    /// What it is called.
    pub name: String,
    /// What it does, in a sentence.
    pub about: String,
    /// Its unit and range, or what it can be; empty for what only does something.
    pub span: String,
    /// What it goes back to and how; empty for what only does something.
    pub reset: String,
    /// Where its name is drawn, in points.
    pub label: Rect,
    /// Where it is drawn with its name, in points.
    pub rect: Rect,
    /// What can be dragged or clicked of it: of a number's, the slider.
    pub part: Rect,
}

impl Told {
    /// What only does something.
    fn act(name: String, about: &str, rect: Rect) -> Self {
        let (about, span, reset) = (about.to_owned(), String::new(), String::new());
        Self { name, about, span, reset, label: rect, rect, part: rect }
    }
}

fn told_id() -> Id {
    Id::unique("told controls")
}

/// Forgets what controls said in the frame before.
pub fn begin(context: &Context) {
    context.data_mut(|data| data.insert_temp(told_id(), Vec::<Told>::new()));
}

/// What the controls of the last frame said, in the order in which they were shown.
pub fn told(context: &Context) -> Vec<Told> {
    context.data(|data| data.get_temp(told_id())).unwrap_or_default()
}

/// Keeps what a control says of itself.
pub fn tell(ui: &Ui, told: Told) {
    ui.data_mut(|data| data.get_temp_mut_or_default::<Vec<Told>>(told_id()).push(told));
}

/// What is said of a control, to be shown and kept.
pub struct Tip<'a> {
    /// What it is called.
    pub name: &'a str,
    /// What it does, in a sentence.
    pub about: &'a str,
    /// Its unit and range, or what it can be.
    pub span: String,
    /// What a double click on the name sets.
    pub reset: String,
}

/// What came of a row.
#[derive(Debug, Clone, Copy)]
pub struct Row {
    /// Whether it is to go back.
    pub back: bool,
    /// Whether the pointer or the keyboard is at it.
    pub attended: bool,
}

/// How a name goes back, in words.
const BACK: &str = "after a double click on the name";

impl Tip<'_> {
    fn text(&self) -> String {
        let Self { about, span, reset, .. } = self;
        format!("{about}\n{span}\n{reset} {BACK}")
    }

    /// A row with the name, and controls beside it, whose response gets the tooltip.
    pub fn row(&self, ui: &mut Ui, controls: impl FnOnce(&mut Ui) -> Response) -> Row {
        self.row_of(ui, |ui| {
            let response = controls(ui);
            (response.rect, response)
        })
    }

    /// Like [`Tip::row`], with the part that scripts click.
    fn row_of(&self, ui: &mut Ui, controls: impl FnOnce(&mut Ui) -> (Rect, Response)) -> Row {
        let shown = ui.horizontal(|ui| {
            let name = name(ui, self.name);
            let (part, controls) = controls(ui);
            let label = name.rect;
            // By the keyboard too, where the name was reached by Tab.
            let entered = name.has_focus() && ui.input(|input| input.key_pressed(Key::Enter));
            let back = name.double_clicked() || entered;
            let all = (name | controls).on_hover_text(self.text());
            (label, part, Row { back, attended: all.hovered() || all.dragged() || all.has_focus() })
        });
        let (label, part, row) = shown.inner;
        let (name, about) = (self.name.to_owned(), self.about.to_owned());
        let reset = format!("{} {BACK}", self.reset);
        tell(ui, Told { name, about, span: self.span.clone(), reset, label, rect: shown.response.rect, part });
        row
    }
}

/// A name at the left of its column.
fn name(ui: &mut Ui, text: &str) -> Response {
    let height = ui.spacing().interact_size.y;
    let layout = egui::Layout::left_to_right(egui::Align::Center);
    let column = ui.allocate_ui_with_layout(vec2(NAMES, height), layout, |ui| {
        // However short the text is, the column has one width.
        ui.set_min_width(NAMES);
        ui.add(Label::new(text).sense(Sense::click()).selectable(false).truncate())
    });
    column.inner
}

/// A number that can be set.
pub struct Number {
    /// What it is called.
    pub name: &'static str,
    /// What it does, in a sentence.
    pub about: &'static str,
    /// Its unit, or what it is a part of.
    pub unit: &'static str,
    /// The range that the slider spans; what is typed may not leave it either.
    pub range: RangeInclusive<f64>,
    /// The slider's steps are even in the logarithm.
    pub logarithmic: bool,
}

impl Number {
    /// A row with the name, a slider and the number. `reset` is what a double click on the name sets.
    pub fn show(&self, ui: &mut Ui, value: &mut f64, reset: f64) -> Row {
        let before = *value;
        let row = self.tip(reset).row_of(ui, |ui| {
            let (rail, number) = self.slider(ui, value);
            (rail.rect, rail | number)
        });
        settle(value, before, row.back.then_some(reset));
        row
    }

    /// A row of a number that may be left open, by a box before its slider. While it is, `open` is shown, which is what comes of that
    /// and is called so; `reset` is what a double click on the name sets.
    pub fn optional(&self, ui: &mut Ui, value: &mut Option<f64>, (open, called): (f64, &str), reset: Option<f64>) {
        let mut now = value.unwrap_or(open);
        let before = now;
        let reset_told = reset.map_or_else(|| called.to_owned(), brief);
        let tip = Tip {
            name: self.name,
            about: self.about,
            span: format!("{}; or {called}", self.span()),
            reset: reset_told,
        };
        let row = tip.row_of(ui, |ui| {
            let mut set = value.is_some();
            let check = ui.checkbox(&mut set, "");
            if check.changed() {
                *value = set.then_some(open);
            }
            // As wide as the others with the box before it.
            ui.spacing_mut().slider_width -= check.rect.width() + ui.spacing().item_spacing.x;
            let (rail, number) = self.slider(ui, &mut now);
            (rail.rect, check | rail | number)
        });
        if row.back {
            *value = reset;
        } else if now != before && now.is_finite() {
            *value = Some(now);
        }
    }

    /// The slider and the number.
    fn slider(&self, ui: &mut Ui, value: &mut f64) -> (Response, Response) {
        let slider = Slider::new(value, self.range.clone())
            .show_value(false)
            .logarithmic(self.logarithmic)
            // What a file says beyond the range stays until it is set here.
            .clamping(SliderClamping::Edits)
            .smallest_positive(1e-3);
        let rail = ui.add(slider);
        let speed = (self.range.end() - self.range.start()) / 500.0;
        (rail, ui.add(self.digits(value, speed)))
    }

    /// A row without a slider; `speed` is by how much a drag over a point changes it.
    pub fn plain(&self, ui: &mut Ui, value: &mut f64, reset: f64, speed: f64) {
        let before = *value;
        let row = self.tip(reset).row(ui, |ui| ui.add(self.digits(value, speed)));
        settle(value, before, row.back.then_some(reset));
    }

    /// A cell of a table, called `name` there: a secondary click on it goes back.
    pub fn cell(&self, ui: &mut Ui, name: String, value: &mut f64, reset: f64) {
        let before = *value;
        let speed = 0.005 * value.abs().max(0.01);
        let back = cell(ui, self.about, &self.span(), name, &brief(reset), |ui| ui.add(self.digits(value, speed)));
        settle(value, before, back.then_some(reset));
    }

    fn digits<'a>(&self, value: &'a mut f64, speed: f64) -> DragValue<'a> {
        let number = DragValue::new(value).range(self.range.clone()).clamp_existing_to_range(false);
        number.speed(speed).max_decimals(8)
    }

    fn tip(&self, reset: f64) -> Tip<'_> {
        Tip { name: self.name, about: self.about, span: self.span(), reset: brief(reset) }
    }

    /// Its range and its unit.
    pub fn span(&self) -> String {
        format!("{} to {} {}", brief(*self.range.start()), brief(*self.range.end()), self.unit)
    }
}

/// Takes what was set, unless it is no number, or goes back.
fn settle(value: &mut f64, before: f64, back: Option<f64>) {
    if let Some(reset) = back {
        *value = reset;
    } else if !value.is_finite() {
        *value = before;
    }
}

/// A control in a cell of a table: its tooltip, and whether it is to go back, which a secondary click says.
pub fn cell(
    ui: &mut Ui,
    about: &str,
    span: &str,
    name: String,
    reset: &str,
    control: impl FnOnce(&mut Ui) -> Response,
) -> bool {
    let response = control(ui);
    let (rect, back) = (response.rect, response.secondary_clicked());
    let reset = format!("{reset} after a secondary click");
    response.on_hover_text(format!("{about}\n{span}\n{reset}"));
    let (about, span) = (about.to_owned(), span.to_owned());
    tell(ui, Told { name, about, span, reset, label: rect, rect, part: rect });
    back
}

/// A few values to choose from: the value, its name, and what it means.
pub type Choices<'a, T> = [(T, &'a str, &'a str)];

/// One of a few, in a list that opens.
pub fn choice<T: Copy + PartialEq>(
    ui: &mut Ui,
    name: &str,
    about: &str,
    value: &mut T,
    choices: &Choices<'_, T>,
    reset: T,
) {
    let called = |wanted: T| choices.iter().find(|(choice, ..)| *choice == wanted).map_or("", |(_, name, _)| name);
    let names: Vec<_> = choices.iter().map(|(_, name, _)| *name).collect();
    let tip = Tip { name, about, span: format!("one of {}", names.join(", ")), reset: called(reset).into() };
    let row = tip.row(ui, |ui| {
        let list = ComboBox::from_id_salt(name).selected_text(called(*value));
        list.show_ui(ui, |ui| {
            for (choice, name, meaning) in choices {
                item_of(ui, name, meaning, |ui| ui.selectable_value(value, *choice, *name));
            }
        })
        .response
    });
    if row.back {
        *value = reset;
    }
}

/// One of a few, side by side.
pub fn buttons<T: Copy + PartialEq>(
    ui: &mut Ui,
    name: &str,
    about: &str,
    value: &mut T,
    choices: &Choices<'_, T>,
    reset: T,
) {
    let mut meanings: Vec<String> = Vec::new();
    for (_, name, meaning) in choices {
        meanings.push(format!("{name}: {meaning}"));
    }
    let called = choices.iter().find(|(choice, ..)| *choice == reset).map_or("", |(_, name, _)| name);
    let tip = Tip { name, about, span: meanings.join("\n"), reset: called.into() };
    let row = tip.row(ui, |ui| {
        let shown = ui.horizontal_wrapped(|ui| {
            if choices.len() > 3 {
                // Closer together, to stay in one row.
                (ui.spacing_mut().button_padding.x, ui.spacing_mut().item_spacing.x) = (4.0, 2.0);
            }
            let buttons = choices.iter().map(|(choice, name, meaning)| {
                let button = ui.selectable_value(value, *choice, *name);
                // The row's tooltip explains them all.
                tell(ui, Told::act(format!("choose {name}"), meaning, button.rect));
                button
            });
            buttons.reduce(|all, button| all | button)
        });
        shown.inner.unwrap_or(shown.response)
    });
    if row.back {
        *value = reset;
    }
}

/// Something that is on or off.
pub fn flag(ui: &mut Ui, name: &str, about: &str, value: &mut bool, reset: bool) -> bool {
    let was = *value;
    let tip = Tip { name, about, span: "on or off".into(), reset: if reset { "on" } else { "off" }.into() };
    if tip.row(ui, |ui| ui.checkbox(value, "")).back {
        *value = reset;
    }
    *value != was
}

/// Something to be done.
pub fn button(ui: &mut Ui, text: &str, about: &str) -> bool {
    done_by(ui, text.to_owned(), about, |ui| ui.button(text))
}

/// Something to be done, of one of many: `name` tells which.
pub fn done_by(ui: &mut Ui, name: String, about: &str, control: impl FnOnce(&mut Ui) -> Response) -> bool {
    let response = control(ui);
    tell(ui, Told::act(name, about, response.rect));
    response.on_hover_text(about).clicked()
}

/// One of what a list that is open holds; scripts find it as `choose` and its name. Whether it was chosen.
pub fn item_of(ui: &mut Ui, name: &str, about: &str, control: impl FnOnce(&mut Ui) -> Response) -> bool {
    let about = if about.is_empty() { name } else { about };
    done_by(ui, format!("choose {name}"), about, control)
}

/// A part of a panel that is folded away at first.
pub fn fold(ui: &mut Ui, title: &str, about: &str, inside: impl FnOnce(&mut Ui)) {
    let header = ui.collapsing(title, inside).header_response;
    done_by(ui, title.to_owned(), about, |_| header);
}

/// Explains what is above it, in letters that can be read.
pub fn hint(ui: &mut Ui, text: impl Into<String>) {
    ui.add(Label::new(RichText::new(text).size(12.0)).wrap());
}

/// A number as short as it can be told to six digits.
pub fn brief(value: f64) -> String {
    let size = value.abs();
    if size != 0.0 && !(1e-3..1e6).contains(&size) {
        let (digits, power) =
            format!("{value:.5e}").split_once('e').map(|(a, b)| (a.to_owned(), b.to_owned())).unwrap_or_default();
        let digits = digits.trim_end_matches('0').trim_end_matches('.');
        return format!("{digits}e{power}").replace('-', "−");
    }
    let decimals = 5 - size.max(1e-3).log10().floor() as i32;
    let text = format!("{value:.*}", decimals.max(0) as usize);
    let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    text.replace('-', "−")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_told_briefly() {
        let told = [0.0, 1.0, -4.0, 0.01, 1e-6, 0.1, 1e12, 1234.5678, 123_456.0, 1.0 / 3.0, -2.5e-7].map(brief);
        let wanted = ["0", "1", "−4", "0.01", "1e−6", "0.1", "1e12", "1234.57", "123456", "0.333333", "−2.5e−7"];
        assert_eq!(told, wanted);
    }
}
