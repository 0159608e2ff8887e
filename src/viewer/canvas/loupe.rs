//! A loupe at the pointer: pixels as squares, and the numbers of the one under it.

use egui::{Align2, Color32, FontId, Pos2, Rect, Stroke, StrokeKind, Ui, vec2};
use glam::DVec2;

use crate::gpu::Region;
use crate::photo::{ToneMap, srgb_encode};
use crate::viewer::document::Document;
use crate::viewer::viewing::{Placement, Shows};

/// The loupe's side and the text's height below it, in points.
const SIDE: f32 = 180.0;
const TEXT: f32 = 48.0;
/// The side of a pixel of the photo in it, in points.
const PIXEL: f32 = 10.0;

/// What the loupe shows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Loupe {
    /// Where on the screen.
    pub region: Region,
    /// Which pixel of the shown picture is in its middle, column and row.
    pub pixel: [u32; 2],
    /// The middle, on the picture.
    pub center: DVec2,
    /// Pixels of the screen to one of the picture.
    pub side: u32,
    /// Whether it shows the photo as it was.
    pub before: bool,
}

/// The numbers of one pixel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Probe {
    /// Column and row among the shown pixels.
    pub pixel: [u32; 2],
    /// Linear RGBA of the photo as it was.
    pub photo: [f32; 4],
    /// Linear RGBA of what was drawn.
    pub picture: [f32; 4],
}

/// Draws the loupe's frame and text at the pointer, and says what belongs into it; nothing off the picture.
pub fn show(
    ui: &Ui,
    document: &Document,
    placement: &Placement,
    screen: [u32; 2],
    at: Pos2,
    probe: Option<&Probe>,
) -> Option<Loupe> {
    let place = placement.to_picture(at);
    let window = document.frame.window;
    let inside = |x: f64, count: u32| (0.0..f64::from(count)).contains(&x).then_some(x as u32);
    let pixel = [inside(place.x, window.width)?, inside(place.y, window.height)?];
    let rect = beside(at, placement.rect)?;
    let glass = Rect::from_min_size(rect.min, vec2(SIDE, SIDE));
    let painter = ui.painter().with_clip_rect(placement.rect);
    painter.rect_filled(rect.with_min_y(glass.bottom()), 0.0, ui.visuals().panel_fill);
    painter.rect_stroke(rect, 0.0, Stroke::new(1.0, Color32::GRAY), StrokeKind::Outside);
    let middle = Rect::from_center_size(glass.center(), vec2(PIXEL, PIXEL));
    // To be seen on white and on black.
    painter.rect_stroke(middle, 0.0, Stroke::new(3.0, Color32::from_black_alpha(160)), StrokeKind::Outside);
    painter.rect_stroke(middle, 0.0, Stroke::new(1.0, Color32::WHITE), StrokeKind::Outside);

    let part = document.viewing.wipe.map_or(0.0, |wipe| wipe as f32);
    let before = document.viewing.shows == Shows::Photo || at.x < placement.rect.left() + part * placement.rect.width();
    if let Some(probe) = probe.filter(|probe| probe.pixel == pixel) {
        let text = words(document, probe, before);
        let font = FontId::monospace(10.0);
        painter.text(glass.left_bottom() + vec2(4.0, 3.0), Align2::LEFT_TOP, text, font, ui.visuals().text_color());
    }
    let scale = ui.ctx().pixels_per_point();
    let edge = |points: f32, most: u32| (points * scale).round().clamp(0.0, most as f32) as u32;
    let (x, y) = (edge(glass.min.x, screen[0]), edge(glass.min.y, screen[1]));
    let (right, bottom) = (edge(glass.max.x, screen[0]), edge(glass.max.y, screen[1]));
    let region = Region { x, y, width: right - x, height: bottom - y };
    let center = DVec2::new(f64::from(pixel[0]), f64::from(pixel[1])) + 0.5;
    let side = (PIXEL * scale).round().max(1.0) as u32;
    (region.width > 0 && region.height > 0).then_some(Loupe { region, pixel, center, side, before })
}

/// Beside the pointer, within the canvas; none where that has no room.
fn beside(at: Pos2, canvas: Rect) -> Option<Rect> {
    let size = vec2(SIDE, SIDE + TEXT);
    if canvas.width() < size.x || canvas.height() < size.y {
        return None;
    }
    let away = 24.0;
    let x = if at.x + away + size.x <= canvas.right() { at.x + away } else { at.x - away - size.x };
    let y = if at.y + away + size.y <= canvas.bottom() { at.y + away } else { at.y - away - size.y };
    let corner = Pos2::new(x.max(canvas.left()), y.max(canvas.top()));
    Some(Rect::from_min_size(corner, size))
}

/// Place, linear light, and what the display shows of it in codes of 0 to 255.
fn words(document: &Document, probe: &Probe, before: bool) -> String {
    let [r, g, b, _] = if before { probe.photo } else { probe.picture };
    let light = document.gamut.map_or([r, g, b], |gamut| (gamut.as_mat3() * glam::Vec3::new(r, g, b)).to_array());
    let gain = document.viewing.exposure.exp2() as f32;
    let map: ToneMap = document.viewing.tone_map;
    let codes = map.apply(light.map(|c| c * gain)).map(|c| (255.0 * srgb_encode(c)).round() as u8);
    let [column, row] = probe.pixel.map(|at| at * document.shrunk);
    let [r, g, b] = [r, g, b].map(digits);
    format!("column {column}, row {row}\nlinear  {r} {g} {b}\ndisplay {} {} {}", codes[0], codes[1], codes[2])
}

/// At most six characters, so that three fit the loupe, and never more digits than four after the point.
fn digits(value: f32) -> String {
    let fits = |text: &String| text.len() <= 6;
    (0..=4).rev().map(|places| format!("{value:.places$}")).find(fits).unwrap_or_else(|| format!("{value:.0e}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_numbers_fit_the_loupe_whatever_they_are() {
        for (value, text) in [
            (0.0312, "0.0312"),
            (103.7879, "103.79"),
            (-0.0456, "-0.046"),
            (26_543.2, "26543"),
            (-12_345_678.0, "-1e7"),
            (f32::MAX, "3e38"),
            (f32::NAN, "NaN"),
            (f32::NEG_INFINITY, "-inf"),
        ] {
            assert_eq!(digits(value), text);
        }
    }
}
