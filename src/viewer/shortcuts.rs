//! The keyboard.

use egui::{Context, Key, Modifiers};
use glam::DVec2;

use super::document::Document;
use super::viewing::{MOST_EXPOSURE, Placement, Shows, Zoom};
use crate::photo::ToneMap;

/// Keys and what they do, for the list that a person can read.
///
/// A test holds it against what the window takes: names of keys as egui has them, with what is held before them.
pub const KEYS: [(&str, &str); 21] = [
    ("F, 1", "fit the photo to the window; a pixel to a pixel"),
    ("+, =, −", "magnify; make smaller"),
    ("B", "the photo as it was, and back"),
    ("G", "the glare alone, and back"),
    ("C", "the photo without the look's veil, and back"),
    ("W", "a wipe between the photo as it was and with its glare"),
    ("L", "the lights' handles"),
    ("I", "the loupe"),
    ("K", "a mark on every pixel that is light"),
    ("[, ]", "a third of a stop darker, lighter"),
    ("T", "the next tone map"),
    ("Left, Right, Up, Down", "move the selected light or ghost by a pixel of the photo, with Shift by ten"),
    ("M", "mute the selected light"),
    ("Delete", "delete the selected light or ghost"),
    ("Ctrl+O, Ctrl+S", "open a photo; save the picture"),
    ("Ctrl+Shift+S, Ctrl+Shift+C", "save the look; copy the command line"),
    ("Ctrl+Z", "undo"),
    ("Ctrl+Shift+Z, Ctrl+Y", "redo"),
    ("Ctrl+Tab, Ctrl+W", "the next photo; close this one"),
    ("Ctrl+Q", "close the window"),
    ("Ctrl++, Ctrl+=, Ctrl+−, Ctrl+0", "larger, smaller letters; as they were"),
];

/// What keys ask of the window rather than of one document.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Command {
    /// Show the next document.
    Next,
    /// Close this one.
    Close,
}

/// Does what the keys ask, unless text is being edited.
pub fn apply(context: &Context, document: &mut Document, placement: Option<&Placement>) -> Option<Command> {
    if context.text_edit_focused() {
        return None;
    }
    let pressed = |key| context.input_mut(|input| input.consume_key(Modifiers::NONE, key));
    look_at(document, placement, &pressed);
    let viewing = &mut document.viewing;
    let other = |shows: Shows, now: Shows| if now == shows { Shows::Picture } else { shows };
    if pressed(Key::B) {
        viewing.shows = other(Shows::Photo, viewing.shows);
    }
    if pressed(Key::G) {
        viewing.shows = other(Shows::Glare, viewing.shows);
    }
    if pressed(Key::C) {
        viewing.shows = other(Shows::Clean, viewing.shows);
    }
    if pressed(Key::W) {
        viewing.wipe = viewing.wipe.map_or(Some(0.5), |_| None);
    }
    if pressed(Key::L) {
        viewing.handles = !viewing.handles;
    }
    if pressed(Key::I) {
        viewing.loupe = !viewing.loupe;
    }
    if pressed(Key::K) {
        viewing.mask = !viewing.mask;
    }
    selected(context, document, &pressed);
    // A slow frame may have several presses; each is a step.
    let count = |modifiers, key| context.input_mut(|input| input.count_and_consume_key(modifiers, key));
    let redone = count(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z) + count(Modifiers::COMMAND, Key::Y);
    (0..redone).for_each(|_| document.redo());
    (0..count(Modifiers::COMMAND, Key::Z)).for_each(|_| document.undo());
    let command = |key| context.input_mut(|input| input.consume_key(Modifiers::COMMAND, key));
    if command(Key::Tab) {
        return Some(Command::Next);
    }
    command(Key::W).then_some(Command::Close)
}

fn look_at(document: &mut Document, placement: Option<&Placement>, pressed: &dyn Fn(Key) -> bool) {
    let viewing = &mut document.viewing;
    if pressed(Key::F) {
        viewing.zoom = Zoom::Fit;
    }
    if let Some(placement) = placement {
        if pressed(Key::Num1) {
            viewing.zoom = Zoom::Fixed { pitch: 1.0, center: placement.center() };
        }
        if pressed(Key::Plus) || pressed(Key::Equals) {
            viewing.zoom = placement.zoomed(1.25, placement.rect.center());
        }
        if pressed(Key::Minus) {
            viewing.zoom = placement.zoomed(0.8, placement.rect.center());
        }
    }
    for (key, stops) in [(Key::OpenBracket, -1.0), (Key::CloseBracket, 1.0)] {
        if pressed(key) {
            viewing.exposure = (viewing.exposure + stops / 3.0).clamp(-MOST_EXPOSURE, MOST_EXPOSURE);
        }
    }
    if pressed(Key::T) {
        viewing.tone_map = match viewing.tone_map {
            ToneMap::None => ToneMap::Reinhard,
            ToneMap::Reinhard => ToneMap::Aces,
            ToneMap::Aces => ToneMap::Agx,
            ToneMap::Agx => ToneMap::None,
        };
    }
}

/// What moves, mutes and deletes the light or the ghost that is selected.
fn selected(context: &Context, document: &mut Document, pressed: &dyn Fn(Key) -> bool) {
    let light = document.selected.filter(|&index| index < document.lights().len());
    let ghost = document.selected_ghost.as_ref().map(|&(index, _)| index);
    let ghost = ghost.filter(|&index| index < document.look.ghosts.len());
    if light.is_none() && ghost.is_none() {
        return;
    }
    let by = moved(context) * document.frame.pixel_size();
    let deleted = pressed(Key::Delete);
    if let Some(index) = light {
        if by != DVec2::ZERO {
            document.lights_mut()[index].position += by;
        }
        if pressed(Key::M) {
            let light = &mut document.lights_mut()[index];
            light.muted = !light.muted;
        }
        if deleted {
            document.delete_light(index);
        }
    } else if let Some(index) = ghost {
        document.look.ghosts[index].center += by;
        if deleted {
            document.delete_ghost(index);
        }
    }
}

/// By how many pixels the arrows move what is selected, y up.
fn moved(context: &Context) -> DVec2 {
    let arrows = [
        (Key::ArrowLeft, DVec2::NEG_X),
        (Key::ArrowRight, DVec2::X),
        (Key::ArrowUp, DVec2::Y),
        (Key::ArrowDown, DVec2::NEG_Y),
    ];
    let mut by = DVec2::ZERO;
    // A slider that has the keyboard takes the arrows for itself.
    if context.memory(|memory| memory.focused()).is_none() {
        for (key, way) in arrows {
            for (modifiers, pixels) in [(Modifiers::SHIFT, 10.0), (Modifiers::NONE, 1.0)] {
                if context.input_mut(|input| input.consume_key(modifiers, key)) {
                    by += way * pixels;
                }
            }
        }
    }
    by
}
