//! Looks that were, for undo and redo.

use std::collections::VecDeque;

use super::{Look, LookLights};

/// Most steps that can be undone.
pub const DEPTH: usize = 200;

/// Most lights and ghosts that those steps hold together, about 100 MB: a look may list 100,000 lights.
const MOST_LISTED: usize = 1_000_000;

/// A look, those before it, and those that were undone.
#[derive(Debug, Clone)]
pub struct History {
    now: Look,
    before: VecDeque<Look>,
    undone: Vec<Look>,
    /// The look at the beginning of a gesture, while one is under way.
    begun: Option<Look>,
}

impl History {
    /// A look without a past.
    pub fn new(look: Look) -> Self {
        Self { now: look, before: VecDeque::new(), undone: Vec::new(), begun: None }
    }

    /// The look as it is now.
    pub fn look(&self) -> &Look {
        &self.now
    }

    /// Changes the look: a step of its own, or, during a gesture, a part of one. The same look is no step.
    pub fn set(&mut self, look: Look) {
        if look == self.now {
            return;
        }
        let old = std::mem::replace(&mut self.now, look);
        if self.begun.is_none() {
            self.step(old);
        }
    }

    /// Begins a gesture, such as a drag: whatever is set until [`History::commit`] is one step. Within a gesture it
    /// changes nothing.
    pub fn begin(&mut self) {
        if self.begun.is_none() {
            self.begun = Some(self.now.clone());
        }
    }

    /// Ends the gesture, if one is under way.
    pub fn commit(&mut self) {
        if let Some(begun) = self.begun.take().filter(|begun| *begun != self.now) {
            self.step(begun);
        }
    }

    /// Ends the gesture, if one is under way, and goes back to where it began.
    pub fn cancel(&mut self) {
        if let Some(begun) = self.begun.take() {
            self.now = begun;
        }
    }

    /// Goes a step back, after the end of a gesture under way; says whether there was one.
    pub fn undo(&mut self) -> bool {
        self.commit();
        let Some(look) = self.before.pop_back() else { return false };
        self.undone.push(std::mem::replace(&mut self.now, look));
        true
    }

    /// Takes back the last [`History::undo`]; says whether there was one since the last change.
    pub fn redo(&mut self) -> bool {
        self.commit();
        let Some(look) = self.undone.pop() else { return false };
        self.before.push_back(std::mem::replace(&mut self.now, look));
        true
    }

    /// Whether there is a step to undo.
    pub fn can_undo(&self) -> bool {
        !self.before.is_empty() || self.begun.as_ref().is_some_and(|begun| *begun != self.now)
    }

    /// Whether there is a step to redo.
    pub fn can_redo(&self) -> bool {
        !self.undone.is_empty() && self.begun.as_ref().is_none_or(|begun| *begun == self.now)
    }

    fn step(&mut self, old: Look) {
        self.before.push_back(old);
        self.undone.clear();
        let mut listed: usize = self.before.iter().map(listed).sum();
        while self.before.len() > DEPTH || (listed > MOST_LISTED && self.before.len() > 1) {
            listed -= self.before.pop_front().as_ref().map_or(0, self::listed);
        }
    }
}

/// How many lights and ghosts a look lists.
fn listed(look: &Look) -> usize {
    let lights = match &look.lights {
        LookLights::Found => 0,
        LookLights::Listed(lights) | LookLights::FoundAnd(lights) | LookLights::Photo(lights) => lights.len(),
    };
    lights + look.ghosts.len()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Light;

    fn of(strength: f64) -> Look {
        Look { strength, ..Look::default() }
    }

    fn strengths(steps: &[f64]) -> History {
        let mut history = History::new(of(steps[0]));
        steps[1..].iter().for_each(|&strength| history.set(of(strength)));
        history
    }

    #[test]
    fn steps_are_undone_and_redone_in_order() {
        let mut history = strengths(&[1.0, 2.0, 2.0, 3.0]);
        let mut seen = vec![history.look().strength];
        while history.undo() {
            seen.push(history.look().strength);
        }
        while history.redo() {
            seen.push(history.look().strength);
        }
        assert_eq!(seen, [3.0, 2.0, 1.0, 2.0, 3.0]);
        assert!(history.can_undo() && !history.can_redo());
    }

    #[test]
    fn a_change_forgets_what_was_undone() {
        let mut history = strengths(&[1.0, 2.0]);
        assert!(history.undo() && history.can_redo());
        history.set(of(1.0));
        assert!(history.can_redo(), "the same look is no change");
        history.set(of(5.0));
        assert!(!history.redo() && history.look().strength == 5.0);
        assert!(history.undo() && history.look().strength == 1.0);
    }

    #[test]
    fn a_drag_is_one_step() {
        let mut history = strengths(&[1.0, 2.0]);
        history.begin();
        for step in 0..500 {
            history.begin();
            history.set(of(f64::from(step)));
        }
        history.commit();
        assert!(history.undo() && history.look().strength == 2.0);
        assert!(history.undo() && history.look().strength == 1.0 && !history.can_undo());
        assert!(history.redo() && history.redo() && history.look().strength == 499.0);
    }

    #[test]
    fn a_drag_back_to_where_it_began_is_no_step() {
        let mut history = strengths(&[1.0, 2.0]);
        history.undo();
        history.begin();
        history.set(of(7.0));
        assert!(history.can_undo() && !history.can_redo());
        history.set(of(1.0));
        history.commit();
        assert!(!history.can_undo() && history.redo());
        history.begin();
        history.set(of(9.0));
        history.cancel();
        assert_eq!(history.look().strength, 2.0);
        history.begin();
        history.set(of(9.0));
        assert!(history.undo() && history.look().strength == 2.0, "undo ends a gesture first");
    }

    #[test]
    fn no_more_than_so_many_steps_are_kept() {
        let mut history = History::new(of(0.0));
        (1..=2 * DEPTH).for_each(|step| history.set(of(step as f64)));
        let undone = std::iter::from_fn(|| history.undo().then_some(())).count();
        assert_eq!((undone, history.look().strength), (DEPTH, DEPTH as f64));
    }

    #[test]
    fn looks_of_very_many_lights_are_few_steps_and_the_last_can_always_be_undone() {
        let light = Light { position: glam::DVec2::ZERO, flux: [1.0; 3], size: 0.0, muted: false };
        let many = |strength, count| Look { lights: LookLights::Listed(vec![light; count].into()), ..of(strength) };
        let mut history = History::new(many(0.0, 300_000));
        (1..=20).for_each(|step| history.set(many(f64::from(step), 300_000)));
        assert_eq!(history.before.iter().map(listed).sum::<usize>(), 900_000);
        history.set(many(21.0, 3 * MOST_LISTED));
        history.set(of(22.0));
        assert!(history.undo() && history.look().strength == 21.0);
    }
}
