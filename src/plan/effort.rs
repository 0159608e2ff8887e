//! How much planning may cost. Work is counted and never timed, so that a request has one plan, whatever the machine and
//! whatever else it does.

use std::cell::Cell;

use crate::{Error, Result};

/// What planning may always cost, in milliseconds.
const LEAST: f64 = 3.0;
/// And otherwise as a part of what the cheapest plan in hand is expected to take.
const PART: f64 = 0.08;

/// What is left of what planning may cost, in nanoseconds of a core of our day.
#[derive(Debug, Clone)]
pub(super) struct Effort {
    spent: Cell<f64>,
    most: Cell<f64>,
}

impl Effort {
    /// As much as it takes: where there is no other plan, or one was asked for by hand.
    pub fn unlimited() -> Self {
        Self { spent: Cell::new(0.0), most: Cell::new(f64::INFINITY) }
    }

    /// Bounds it by a plan in hand, which is expected to take so many milliseconds.
    pub fn beside(&self, milliseconds: f64) {
        self.most.set(self.most.get().min(1e6 * allowed(milliseconds)));
    }

    /// As much as it takes, after all.
    pub fn lift(&self) {
        self.most.set(f64::INFINITY);
    }

    /// Whether something that would take so many nanoseconds is worth a try.
    pub fn affords(&self, nanoseconds: f64) -> bool {
        nanoseconds <= self.most.get()
    }

    /// Takes note of so many nanoseconds.
    ///
    /// # Errors
    /// [`Error::Plan`] where that is more than is left.
    pub fn spend(&self, nanoseconds: f64) -> Result<()> {
        self.spent.set(self.spent.get() + nanoseconds);
        if self.spent.get() <= self.most.get() {
            return Ok(());
        }
        Err(too_much())
    }

    /// Whether so many nanoseconds more are left.
    ///
    /// # Errors
    /// [`Error::Plan`] where they are not.
    pub fn expect(&self, nanoseconds: f64) -> Result<()> {
        if self.spent.get() + nanoseconds <= self.most.get() { Ok(()) } else { Err(too_much()) }
    }

    /// What was spent, for tests.
    #[cfg(test)]
    pub fn spent(&self) -> f64 {
        self.spent.get()
    }
}

fn too_much() -> Error {
    Error::Plan("planning it would cost more than it could save".into())
}

/// What planning may cost beside a plan in hand, both in milliseconds.
fn allowed(milliseconds: f64) -> f64 {
    LEAST.max(PART * milliseconds)
}
