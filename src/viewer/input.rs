//! What the pointer did, in frames that can tell it apart.

use egui::Event;

/// Keeps the events of one frame; gives the rest, for the next. A frame ends before a press or a release of the pointer's
/// button that comes after a move, and after each.
///
/// egui takes a press or a release to be where the pointer is at the end of its frame, and forgets by how much it moved
/// before a release. While a frame takes long, all of that is in one: what the pointer pressed would be missed, and what
/// it let go of would stay behind or jump after it.
pub fn split(events: &mut Vec<Event>) -> Vec<Event> {
    let Some(button) = events.iter().position(|event| matches!(event, Event::PointerButton { .. })) else {
        return Vec::new();
    };
    let moved = events[..button].iter().any(|event| matches!(event, Event::PointerMoved(_)));
    events.split_off(if moved { button } else { button + 1 })
}

#[cfg(test)]
mod tests {
    use egui::{Modifiers, PointerButton, pos2};

    use super::*;

    #[test]
    fn a_button_has_a_frame_of_its_own() {
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
        let expected = [moved(1.0), button(true), moved(2.0), button(false), moved(3.0)].map(|event| vec![event]);
        assert_eq!(frames, expected);
        let mut clicked = vec![button(true), button(false)];
        assert_eq!((split(&mut clicked), clicked), (vec![button(false)], vec![button(true)]));
    }
}
