//! How much memory open photos take: pixels of tabs that were not looked at for longest are let go, and read again.

use super::App;

/// The most bytes of pixels that are kept for all open photos together; of the one that is shown, all are.
pub const PIXEL_BYTES: usize = 1 << 30;

/// Which tabs' pixels are kept.
pub struct Budget {
    /// The most bytes for all.
    pub(super) bytes: usize,
    /// How often another tab was chosen.
    turns: u64,
    shown: Option<u64>,
}

impl Default for Budget {
    fn default() -> Self {
        Self { bytes: PIXEL_BYTES, turns: 0, shown: None }
    }
}

impl App {
    /// Sets the most bytes of pixels that are kept for all open photos together, [`PIXEL_BYTES`] at first.
    pub fn keep_pixels(&mut self, bytes: usize) {
        self.budget.bytes = bytes;
    }

    /// The bytes of pixels that are kept for all open photos together.
    pub fn pixel_bytes(&self) -> usize {
        self.documents.iter().map(|(_, document)| document.bytes()).sum()
    }

    /// Sees to it that the pixels of the document that is shown are there or on their way, and not too many others.
    pub(super) fn keep_within_budget(&mut self) {
        let Some((number, document)) = self.documents.get_mut(self.current) else { return };
        if self.budget.shown != Some(*number) {
            self.budget.shown = Some(*number);
            self.budget.turns += 1;
            document.seen = self.budget.turns;
            document.unreadable = false;
        }
        if document.is_asleep() && !document.unreadable && !self.loader.wakes(*number) {
            self.loader.wake(*number, document);
        }
        let mut bytes = self.pixel_bytes();
        let mut others: Vec<_> =
            self.documents.iter_mut().filter(|(other, _)| self.budget.shown != Some(*other)).collect();
        others.sort_by_key(|(_, document)| document.seen);
        for (_, document) in others {
            if bytes <= self.budget.bytes {
                break;
            }
            bytes -= document.bytes();
            document.sleep();
        }
    }

    /// Takes in what was read again of a document that is still open.
    pub(super) fn wake(&mut self, number: u64, read: crate::Result<super::Document>) {
        let Some((_, document)) = self.documents.iter_mut().find(|(other, _)| *other == number) else { return };
        match read {
            Ok(fresh) => document.wake(fresh),
            Err(error) => {
                // Not before it is chosen again: it would be tried for ever.
                document.unreadable = true;
                self.notice(error.to_string());
            }
        }
    }

    /// Reads no more files.
    pub(super) fn stop_reading(&mut self) {
        self.loader.cancel();
        self.document_mut().into_iter().for_each(|document| document.unreadable = document.is_asleep());
    }
}
