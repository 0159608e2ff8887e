//! Memory that one evaluation leaves to the next: fresh pages cost a quarter of a veil.

use std::sync::{Arc, Mutex, PoisonError};

/// As many workspaces as there have been evaluations at a time.
pub(crate) struct Pool<W>(Arc<Mutex<Vec<W>>>);

impl<W> Default for Pool<W> {
    fn default() -> Self {
        Self(Arc::default())
    }
}

impl<W> Clone for Pool<W> {
    fn clone(&self) -> Self {
        Self(self.0.clone())
    }
}

impl<W> std::fmt::Debug for Pool<W> {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.debug_struct("Pool").finish_non_exhaustive()
    }
}

impl<W> Pool<W> {
    /// One that is idle, or a new one.
    pub fn take(&self, new: impl FnOnce() -> W) -> W {
        let idle = self.0.lock().unwrap_or_else(PoisonError::into_inner).pop();
        idle.unwrap_or_else(new)
    }

    pub fn give_back(&self, workspace: W) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).push(workspace);
    }
}
