//! The picture under the pointer.

mod handles;
mod loupe;
mod overlay;

use egui::{CursorIcon, Sense, Stroke, Ui, pos2};
use glam::DVec2;

pub use loupe::{Loupe, Probe};

use super::document::Document;
use super::stage::Stage;
use super::viewing::{Placement, Zoom};

/// How far from the wipe's line, in points, it can be taken hold of.
const WIPE_REACH: f32 = 6.0;

/// What the canvas came to be in a frame.
#[derive(Default)]
pub struct Canvas {
    /// Where the picture lies; none where there is no room for it.
    pub placement: Option<Placement>,
    /// What the loupe shows, where there is one.
    pub loupe: Option<Loupe>,
}

/// Lets the pointer move, magnify and drag, and draws what lies over the picture. `screen` is the whole screen's size
/// in pixels; `probe` what is known of the pixel under the pointer.
pub fn show(ui: &mut Ui, document: &mut Document, stage: &Stage, screen: [u32; 2], probe: Option<&Probe>) -> Canvas {
    let rect = ui.available_rect_before_wrap();
    let window = document.frame.window;
    let size = [window.width, window.height];
    let scale = ui.ctx().pixels_per_point();
    let place = |zoom: Zoom| Placement::new(zoom, size, rect, scale, screen);
    let canvas = ui.interact(rect, ui.scope_id().with("canvas"), Sense::click_and_drag());
    let Some(placement) = place(document.viewing.zoom) else { return Canvas::default() };

    // Also over a handle, which takes the pointer from the canvas.
    let pointer = ui.input(|input| input.pointer.hover_pos()).filter(|_| canvas.contains_pointer());
    if let Some(at) = pointer {
        let factor = ui.input(|input| (input.smooth_scroll_delta().y / 200.0).exp() * input.zoom_delta());
        if factor != 1.0 {
            document.viewing.zoom = placement.zoomed(f64::from(factor), at);
        }
    }
    if canvas.dragged() {
        let moved = canvas.drag_delta();
        let moved = DVec2::new(f64::from(moved.x), f64::from(moved.y)) * placement.scale * placement.pitch;
        document.viewing.zoom = Zoom::Fixed { pitch: placement.pitch, center: placement.center() - moved };
        ui.ctx().set_cursor_icon(CursorIcon::Grabbing);
    }
    if canvas.clicked() {
        (document.selected, document.selected_ghost) = (None, None);
    }
    if canvas.double_clicked() {
        document.viewing.zoom = match document.viewing.zoom {
            Zoom::Fit => placement.zoomed(placement.pitch, canvas.interact_pointer_pos().unwrap_or(rect.center())),
            Zoom::Fixed { .. } => Zoom::Fit,
        };
    }
    let placement = place(document.viewing.zoom).unwrap_or(placement);
    overlay::error(ui, document, stage, &placement);
    wipe(ui, document, &placement);
    overlay::cut(ui, document, &placement);
    if document.viewing.handles {
        handles::show(ui, document, &placement);
    }
    let loupe = pointer.filter(|_| document.viewing.loupe);
    let loupe = loupe.and_then(|at| loupe::show(ui, document, &placement, screen, at, probe));
    Canvas { placement: Some(placement), loupe }
}

/// The line between before and after, to be dragged.
fn wipe(ui: &mut Ui, document: &mut Document, placement: &Placement) {
    let Some(part) = &mut document.viewing.wipe else { return };
    let rect = placement.rect;
    let x = rect.left() + *part as f32 * rect.width();
    let mut line = rect;
    (line.min.x, line.max.x) = (x - WIPE_REACH, x + WIPE_REACH);
    let response =
        ui.interact(line, ui.scope_id().with("wipe"), Sense::drag()).on_hover_cursor(CursorIcon::ResizeHorizontal);
    if let Some(at) = response.interact_pointer_pos() {
        *part = f64::from((at.x - rect.left()) / rect.width()).clamp(0.0, 1.0);
    }
    let x = rect.left() + *part as f32 * rect.width();
    let painter = ui.painter().with_clip_rect(rect);
    painter.line_segment(
        [pos2(x, rect.top()), pos2(x, rect.bottom())],
        Stroke::new(3.0, egui::Color32::from_black_alpha(120)),
    );
    painter.line_segment([pos2(x, rect.top()), pos2(x, rect.bottom())], Stroke::new(1.0, egui::Color32::WHITE));
}
