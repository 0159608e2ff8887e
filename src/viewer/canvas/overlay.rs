//! What a study of the picture lays over it: the error in false colours, and the line of the cross-section.

use egui::{Color32, CursorIcon, Rect, Sense, Stroke, Ui, pos2};
use glam::DVec2;

use crate::viewer::document::Document;
use crate::viewer::stage::Stage;
use crate::viewer::study::Plot;
use crate::viewer::viewing::Placement;

/// How far from the line, in points, it can be taken hold of.
const REACH: f32 = 6.0;

/// Where the whole picture is on the screen.
fn picture(document: &Document, placement: &Placement) -> Rect {
    let window = document.frame.window;
    let far = DVec2::new(f64::from(window.width), f64::from(window.height));
    Rect::from_min_max(placement.to_screen(DVec2::ZERO), placement.to_screen(far))
}

/// The error in false colours, as far as it is known.
pub fn error(ui: &Ui, document: &Document, stage: &Stage, placement: &Placement) {
    let texture = stage.known().error_map().filter(|_| document.viewing.wanted.error_map);
    if let Some(texture) = texture {
        let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
        let painter = ui.painter().with_clip_rect(placement.rect);
        painter.image(texture.id(), picture(document, placement), whole, Color32::WHITE);
    }
}

/// The line along which the picture is cut, to be dragged.
pub fn cut(ui: &mut Ui, document: &mut Document, placement: &Placement) {
    if document.viewing.wanted.plot != Plot::Section {
        return;
    }
    let picture = picture(document, placement);
    let cut = &mut document.viewing.wanted.cut;
    let place = |at: f64| {
        if cut.horizontal {
            let y = picture.top() + at as f32 * picture.height();
            [pos2(picture.left(), y), pos2(picture.right(), y)]
        } else {
            let x = picture.left() + at as f32 * picture.width();
            [pos2(x, picture.top()), pos2(x, picture.bottom())]
        }
    };
    let (icon, ends) = match cut.horizontal {
        true => (CursorIcon::ResizeVertical, place(cut.at)),
        false => (CursorIcon::ResizeHorizontal, place(cut.at)),
    };
    let reach = Rect::from_points(&ends).expand(REACH).intersect(placement.rect);
    let response = ui.interact(reach, ui.scope_id().with("cut"), Sense::click_and_drag()).on_hover_cursor(icon);
    let mut at = cut.at;
    if let Some(pointer) = response.interact_pointer_pos().filter(|_| response.dragged()) {
        let part = if cut.horizontal {
            (pointer.y - picture.top()) / picture.height()
        } else {
            (pointer.x - picture.left()) / picture.width()
        };
        at = f64::from(part).clamp(0.0, 1.0);
    }
    if response.double_clicked() {
        at = 0.5;
    }
    let ends = place(at);
    cut.at = at;
    let painter = ui.painter().with_clip_rect(placement.rect);
    painter.line_segment(ends, Stroke::new(3.0, Color32::from_black_alpha(120)));
    painter.line_segment(ends, Stroke::new(1.0, Color32::LIGHT_GREEN));
    response.on_hover_text("The cross-section; drag it, a double click puts it into the middle");
}
