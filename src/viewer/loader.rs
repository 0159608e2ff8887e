//! Photos are read and searched for lights on threads of their own, so that the window never waits for a file.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};

use super::document::Document;
use super::model::Look;
use crate::{Error, Result, panics};

/// Tells the event loop that something has come in.
pub type Wake = Arc<dyn Fn() + Send + Sync>;

/// Reads files in the background.
pub struct Loader {
    sender: Sender<(u64, Result<Document>)>,
    receiver: Receiver<(u64, Result<Document>)>,
    wake: Wake,
    under_way: Vec<(u64, PathBuf)>,
    next: u64,
}

impl Loader {
    /// A loader that calls `wake` whenever a file is done.
    pub fn new(wake: Wake) -> Self {
        let (sender, receiver) = channel();
        Self { sender, receiver, wake, under_way: Vec::new(), next: 0 }
    }

    /// Begins to read a photo.
    pub fn read(&mut self, path: PathBuf, look: Look) {
        let file = path.clone();
        self.begin(path, move || Document::read(&file, look));
    }

    /// Begins to do what gives a document of a file.
    fn begin(&mut self, path: PathBuf, read: impl FnOnce() -> Result<Document> + Send + 'static) {
        let (number, sender, wake) = (self.next, self.sender.clone(), self.wake.clone());
        self.next += 1;
        let name = path.clone();
        self.under_way.push((number, path));
        let work = move || {
            // The other end is gone only when the window is.
            let _ = sender.send((number, panics::caught(read).map_err(|error| error.in_frame(&name))));
            wake();
        };
        if let Err(reason) = std::thread::Builder::new().name("photo".into()).spawn(work) {
            let path = self.under_way.pop().map(|(_, path)| path).unwrap_or_default();
            let _ = self.sender.send((number, Err(Error::read_photo(&path, reason))));
        }
    }

    /// The files that are being read.
    pub fn under_way(&self) -> impl Iterator<Item = &PathBuf> {
        self.under_way.iter().map(|(_, path)| path)
    }

    /// Lets go of the files that are being read: their threads come to an end, and what they read is dropped.
    pub fn cancel(&mut self) {
        self.under_way.clear();
    }

    /// What has come in and was not cancelled.
    pub fn take(&mut self) -> Vec<Result<Document>> {
        let mut done = Vec::new();
        while let Ok((number, result)) = self.receiver.try_recv() {
            let wanted = self.under_way.iter().position(|&(waiting, _)| waiting == number);
            if let Some(at) = wanted {
                self.under_way.remove(at);
                done.push(result);
            }
        }
        done
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_while_a_file_is_read_is_what_came_of_it() {
        let (sender, woken) = channel();
        let mut loader = Loader::new(Arc::new(move || sender.send(()).unwrap()));
        loader.begin("a.exr".into(), || panic!("as it should"));
        woken.recv().unwrap();
        let told: Vec<_> =
            loader.take().into_iter().map(|result| result.err().map(|error| error.to_string())).collect();
        assert_eq!(told, [Some("a.exr: an internal error (as it should); please report it".to_owned())]);
        assert_eq!(loader.under_way().count(), 0);
    }
}
