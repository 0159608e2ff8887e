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

/// Draws the handles and lets them be dragged.
pub fn show(ui: &mut Ui, document: &mut Document, placement: &Placement) {
    let painter = ui.painter().with_clip_rect(placement.rect);
    axis(ui, &painter, document, placement);
    if let Some(selected) = document.selected {
        ghosts(&painter, document, placement, selected);
    }
    for index in 0..document.look.ghosts.len() {
        placed(ui, &painter, document, placement, index);
    }
    for index in 0..document.lights().len() {
        light(ui, &painter, document, placement, index);
    }
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
    let Some(light) = document.lights().get(selected) else { return };
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
