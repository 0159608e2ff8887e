//! What the pointer did, in frames that can tell it apart.

use egui::Event;

/// Keeps the events up to the pointer's first button; gives the rest, for the next frame.
///
/// egui takes a press or a release to be where the pointer is at the end of its frame. While a frame takes long, the
/// pointer goes on: what it pressed would be missed, and what it let go of would jump after it.
pub fn split(events: &mut Vec<Event>) -> Vec<Event> {
    let button = events.iter().position(|event| matches!(event, Event::PointerButton { .. }));
    button.map_or_else(Vec::new, |first| events.split_off(first + 1))
}

#[cfg(test)]
mod tests {
    use egui::{Modifiers, PointerButton, pos2};

    use super::*;

    #[test]
    fn a_frame_has_one_button_at_its_end() {
        let button = |pressed| {
            let (pos, button, modifiers) = (pos2(1.0, 2.0), PointerButton::Primary, Modifiers::NONE);
            Event::PointerButton { pos, button, pressed, modifiers }
        };
        let moved = |x| Event::PointerMoved(pos2(x, 0.0));
        let mut events = vec![moved(1.0), button(true), moved(2.0), button(false), moved(3.0)];
        let mut frames = Vec::new();
        while !events.is_empty() {
            let rest = split(&mut events);
            frames.push(std::mem::replace(&mut events, rest));
        }
        let expected = [vec![moved(1.0), button(true)], vec![moved(2.0), button(false)], vec![moved(3.0)]];
        assert_eq!(frames, expected);
    }
}
