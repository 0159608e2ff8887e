//! Lights and placed ghosts as handles, the ghosts of the light that is selected, and the axis.

use egui::{Color32, CursorIcon, Painter, Pos2, Rect, Response, Sense, Shape, Stroke, StrokeKind, Ui, vec2};
use glam::DVec2;

use crate::viewer::document::Document;
use crate::viewer::viewing::Placement;

/// The radius of a handle, in points.
const RADIUS: f32 = 7.0;
/// The side of the square by which it can be taken, in points.
const REACH: f32 = 20.0;
/// At most so many ghosts of the selected light are marked.
const MOST_MARKS: usize = 256;

/// At most so many lights, and so many ghosts, have handles: the first ones on the canvas, and the one that is selected.
const MOST_HANDLES: usize = 512;

/// Draws the handles and lets them be dragged.
pub fn show(ui: &mut Ui, document: &mut Document, placement: &Placement) {
    let painter = ui.painter().with_clip_rect(placement.rect);
    axis(ui, &painter, document, placement);
    if let Some(selected) = document.selected {
        ghosts(&painter, document, placement, selected);
    }
    let chosen = document.selected_ghost.as_ref().map(|&(index, _)| index);
    let centers = document.look.ghosts.iter().map(|ghost| ghost.center);
    for index in handled(document, placement, chosen, centers) {
        placed(ui, &painter, document, placement, index);
    }
    let lights = document.lights();
    let positions = lights.iter().map(|light| light.position);
    for index in handled(document, placement, document.selected, positions) {
        light(ui, &painter, document, placement, index);
    }
}

/// Which of the places have handles.
fn handled(
    document: &Document,
    placement: &Placement,
    chosen: Option<usize>,
    places: impl Iterator<Item = DVec2>,
) -> Vec<usize> {
    let canvas = placement.rect.expand(REACH);
    let seen = |place: DVec2| canvas.contains(placement.to_screen(document.place(place)));
    let mut indices = Vec::new();
    for (index, place) in places.enumerate() {
        if chosen == Some(index) || (indices.len() < MOST_HANDLES && seen(place)) {
            indices.push(index);
        }
    }
    indices
}

/// A ghost that no light makes: a square, and of the one that is selected the ellipse of its size.
fn placed(ui: &mut Ui, painter: &Painter, document: &mut Document, placement: &Placement, index: usize) {
    let center = document.look.ghosts[index].center;
    let response = handle(ui, placement, placement.to_screen(document.place(center)), ("ghost", index));
    if response.clicked() || response.drag_started() {
        document.select_ghost(index);
    }
    if let Some(moved) = moved(&response, placement, document.frame.pixel_sides()) {
        document.look.ghosts[index].center += moved;
    }
    let ghost = &document.look.ghosts[index];
    let at = placement.to_screen(document.place(ghost.center));
    let chosen = document.selected_ghost.as_ref().is_some_and(|&(selected, _)| selected == index);
    let response = response.on_hover_text(format!("Ghost {}, which no light makes: drag to move it", index + 1));
    let width = if chosen || response.hovered() { 3.0 } else { 1.5 };
    let bright = if chosen { Color32::YELLOW } else { Color32::WHITE };
    let square = Rect::from_center_size(at, vec2(1.7, 1.7) * RADIUS);
    painter.rect_stroke(square, 0.0, Stroke::new(width + 2.0, shade()), StrokeKind::Middle);
    painter.rect_stroke(square, 0.0, Stroke::new(width, bright), StrokeKind::Middle);
    painter.circle_filled(at, 2.5, colour(ghost.radiance));
    if chosen {
        // Half picture heights in points.
        let scale = 1.0 / (document.frame.pixel_sides() * placement.pitch * placement.scale);
        let radius = (scale * document.look.size * ghost.size).as_vec2();
        painter.add(Shape::ellipse_stroke(
            at,
            vec2(radius.x, radius.y),
            Stroke::new(1.0, Color32::from_white_alpha(120)),
        ));
    }
}

fn axis(ui: &mut Ui, painter: &Painter, document: &mut Document, placement: &Placement) {
    let at = placement.to_screen(document.place(document.look.axis));
    let response = handle(ui, placement, at, "axis").on_hover_text(
        "The lens's axis: ghosts lie on the lines through it and their lights.\n\
         Drag it; a double click puts it back into the picture's centre.",
    );
    if let Some(moved) = moved(&response, placement, document.frame.pixel_sides()) {
        document.look.axis += moved;
    }
    if response.double_clicked() {
        document.look.axis = document.opened.axis;
    }
    for (stroke, reach) in [(Stroke::new(3.0, shade()), 9.0), (Stroke::new(1.0, Color32::WHITE), 8.0)] {
        painter.line_segment([at - vec2(reach, 0.0), at + vec2(reach, 0.0)], stroke);
        painter.line_segment([at - vec2(0.0, reach), at + vec2(0.0, reach)], stroke);
    }
}

fn light(ui: &mut Ui, painter: &Painter, document: &mut Document, placement: &Placement, index: usize) {
    let at = placement.to_screen(document.place(document.lights()[index].position));
    let response = handle(ui, placement, at, index);
    if response.clicked() || response.drag_started() {
        document.select(index);
    }
    if let Some(moved) = moved(&response, placement, document.frame.pixel_sides()) {
        document.lights_mut()[index].position += moved;
    }
    let light = document.lights()[index];
    let chosen = document.selected == Some(index);
    let response = response.on_hover_text(format!("Light {}: drag to move it", index + 1));
    let width = if chosen || response.hovered() { 3.0 } else { 1.5 };
    painter.circle_stroke(at, RADIUS, Stroke::new(width + 2.0, shade()));
    painter.circle_stroke(at, RADIUS, Stroke::new(width, if chosen { Color32::YELLOW } else { Color32::WHITE }));
    if light.muted {
        let arm = vec2(RADIUS, RADIUS) * std::f32::consts::FRAC_1_SQRT_2;
        painter.line_segment([at - arm, at + arm], Stroke::new(width, Color32::WHITE));
    } else {
        painter.circle_filled(at, 2.5, colour(light.flux));
    }
}

/// Marks at the ghosts of one light, and the line that they lie on.
fn ghosts(painter: &Painter, document: &Document, placement: &Placement, selected: usize) {
    let Some(light) = document.lights().get(selected).copied() else { return };
    let axis = document.look.axis;
    let place = |along: f64| placement.to_screen(document.place(axis + along * (light.position - axis)));
    let along = document.look.lens.ghosts().iter().map(|ghost| ghost.along);
    let (low, high) = along.clone().fold((0.0f64, 1.0f64), |(low, high), along| (low.min(along), high.max(along)));
    painter.line_segment([place(low), place(high)], Stroke::new(1.0, Color32::from_white_alpha(90)));
    for along in along.take(MOST_MARKS) {
        painter.circle_filled(place(along), 2.0, Color32::from_white_alpha(160));
    }
}

fn handle(ui: &mut Ui, placement: &Placement, at: Pos2, salt: impl std::hash::Hash + std::fmt::Debug) -> Response {
    let rect = Rect::from_center_size(at, vec2(REACH, REACH)).intersect(placement.rect);
    ui.interact(rect, ui.scope_id().with(("handle", salt)), Sense::click_and_drag()).on_hover_cursor(CursorIcon::Move)
}

/// By how much a handle was dragged, on the picture plane; `pixel` has the sides of a pixel there.
fn moved(response: &Response, placement: &Placement, pixel: DVec2) -> Option<DVec2> {
    let moved = response.drag_delta();
    let by = DVec2::new(f64::from(moved.x), -f64::from(moved.y)) * placement.scale * placement.pitch * pixel;
    (response.dragged() && by != DVec2::ZERO).then_some(by)
}

fn shade() -> Color32 {
    Color32::from_black_alpha(140)
}

/// A flux's hue, as bright as can be shown.
fn colour(flux: [f64; 3]) -> Color32 {
    let most = flux.iter().fold(f64::MIN_POSITIVE, |a, &b| a.max(b));
    let code = |channel: f64| (255.0 * (channel / most).clamp(0.0, 1.0).powf(1.0 / 2.2)) as u8;
    Color32::from_rgb(code(flux[0]), code(flux[1]), code(flux[2]))
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use egui::pos2;

    use super::*;
    use crate::look::{Look, LookLights};
    use crate::photo::Photo;
    use crate::scene::Light;
    use crate::viewer::viewing::Zoom;

    #[test]
    fn of_very_many_lights_the_first_on_the_canvas_and_the_selected_one_have_handles() {
        // Every other light is far off the picture.
        let light = |index: u32| Light {
            position: DVec2::new(if index.is_multiple_of(2) { 0.5 } else { 50.0 }, 0.0),
            flux: [1.0; 3],
            size: 0.0,
            muted: false,
        };
        let look = Look { lights: LookLights::Listed((0..100_000).map(light).collect()), ..Look::default() };
        let document = Document::new(Path::new("a.exr"), Photo::new(8, 4, vec![[0.5; 4]; 32]), look);
        let rect = Rect::from_min_max(pos2(0.0, 0.0), pos2(400.0, 200.0));
        let placement = Placement::new(Zoom::Fit, [8, 4], rect, 1.0, [400, 200]).unwrap();
        let lights = document.lights();
        let places = || lights.iter().map(|light| light.position);
        let mut expected: Vec<usize> = (0..MOST_HANDLES).map(|k| 2 * k).collect();
        assert_eq!(handled(&document, &placement, None, places()), expected);
        expected.push(77_777);
        assert_eq!(handled(&document, &placement, Some(77_777), places()), expected);
    }
}
