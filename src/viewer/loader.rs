//! Photos are read and searched for lights on threads of their own, so that the window never waits for a file.

use std::collections::VecDeque;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};

use super::document::Document;
use super::model::Look;
use crate::photo::ReadOptions;
use crate::{Error, Result, panics};

/// Tells the event loop that something has come in.
pub type Wake = Arc<dyn Fn() + Send + Sync>;

/// How many files are read at a time: each takes memory for its pixels twice, and all cores.
const AT_A_TIME: usize = 2;

/// Reads files in the background, in the order in which they were asked for.
pub struct Loader {
    /// How they are read.
    pub options: ReadOptions,
    sender: Sender<(u64, Result<Document>)>,
    receiver: Receiver<(u64, Result<Document>)>,
    wake: Wake,
    /// Those that are being read come first; as many may be cancelled and still come to an end.
    under_way: VecDeque<File>,
    running: usize,
    next: u64,
}

/// A file on its way.
struct File {
    number: u64,
    path: PathBuf,
    /// The document that it is read again for.
    document: Option<u64>,
    /// What has not begun yet.
    work: Option<Work>,
}

type Work = Box<dyn FnOnce() -> Result<Document> + Send>;

/// What has been read.
pub struct Read {
    /// The document that it was read again for, if it is not to be another.
    pub document: Option<u64>,
    /// What came of it.
    pub result: Result<Document>,
}

impl Loader {
    /// A loader that calls `wake` whenever a file is done.
    pub fn new(wake: Wake) -> Self {
        let (sender, receiver) = channel();
        Self {
            options: ReadOptions::default(),
            sender,
            receiver,
            wake,
            under_way: VecDeque::new(),
            running: 0,
            next: 0,
        }
    }

    /// Begins to read a photo.
    pub fn read(&mut self, path: PathBuf, look: Look) {
        let (file, options) = (path.clone(), self.options.clone());
        self.ask(path, None, Box::new(move || Document::read(&file, &options, look)));
    }

    /// Begins to read a photo again whose document let go of its pixels.
    pub fn wake(&mut self, number: u64, document: &Document) {
        let (file, look, options) = (document.path.clone(), document.known_look(), self.options.clone());
        self.ask(document.path.clone(), Some(number), Box::new(move || Document::read(&file, &options, look)));
    }

    /// Whether a document's photo is being read again.
    pub fn wakes(&self, number: u64) -> bool {
        self.under_way.iter().any(|file| file.document == Some(number))
    }

    fn ask(&mut self, path: PathBuf, document: Option<u64>, work: Work) {
        self.under_way.push_back(File { number: self.next, path, document, work: Some(work) });
        self.next += 1;
        self.begin();
    }

    /// Begins with what waits, as far as there is room for it.
    fn begin(&mut self) {
        while self.running < AT_A_TIME
            && let Some(file) = self.under_way.iter_mut().find(|file| file.work.is_some())
            && let Some(work) = file.work.take()
        {
            let (number, path, sender, wake) = (file.number, file.path.clone(), self.sender.clone(), self.wake.clone());
            let failed = path.clone();
            let work = move || {
                let result = panics::caught(work).map_err(|error| error.in_frame(&path));
                // The other end is gone only when the window is.
                let _ = sender.send((number, result));
                wake();
            };
            self.running += 1;
            if let Err(reason) = std::thread::Builder::new().name("photo".into()).spawn(work) {
                let _ = self.sender.send((number, Err(Error::read_photo(&failed, reason))));
            }
        }
    }

    /// The files that are being read.
    pub fn under_way(&self) -> impl Iterator<Item = &PathBuf> {
        self.under_way.iter().map(|file| &file.path)
    }

    /// Lets go of the files that are being read: their threads come to an end, and what they read is dropped.
    pub fn cancel(&mut self) {
        self.under_way.clear();
    }

    /// What has come in and was not cancelled.
    pub fn take(&mut self) -> Vec<Read> {
        let mut done = Vec::new();
        while let Ok((number, result)) = self.receiver.try_recv() {
            self.running -= 1;
            let wanted = self.under_way.iter().position(|file| file.number == number);
            if let Some(File { document, .. }) = wanted.and_then(|at| self.under_way.remove(at)) {
                done.push(Read { document, result });
            }
        }
        self.begin();
        done
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;
    use std::sync::atomic::{AtomicUsize, Ordering};

    use super::*;
    use crate::photo::Photo;

    fn loader() -> (Loader, Receiver<()>) {
        let (sender, woken) = channel();
        (Loader::new(Arc::new(move || sender.send(()).unwrap())), woken)
    }

    #[test]
    fn a_panic_while_a_file_is_read_is_what_came_of_it() {
        let (mut loader, woken) = loader();
        loader.ask("a.exr".into(), None, Box::new(|| panic!("as it should")));
        woken.recv().unwrap();
        let told: Vec<_> = loader.take().into_iter().map(|read| read.result.err().map(|e| e.to_string())).collect();
        assert_eq!(told, [Some("a.exr: an internal error (as it should); please report it".to_owned())]);
        assert_eq!(loader.under_way().count(), 0);
    }

    #[test]
    fn few_files_are_read_at_a_time_and_all_in_the_end() {
        static AT_WORK: AtomicUsize = AtomicUsize::new(0);
        static MOST: AtomicUsize = AtomicUsize::new(0);
        let (mut loader, woken) = loader();
        for name in 0..20 {
            let work = move || {
                MOST.fetch_max(AT_WORK.fetch_add(1, Ordering::SeqCst) + 1, Ordering::SeqCst);
                let photo = Photo::new(1, 1, vec![[0.5; 4]]);
                AT_WORK.fetch_sub(1, Ordering::SeqCst);
                Ok(Document::new(Path::new(&name.to_string()), photo, Look::default()))
            };
            loader.ask(name.to_string().into(), None, Box::new(work));
        }
        let mut names = Vec::new();
        while names.len() < 20 {
            woken.recv().unwrap();
            names.extend(loader.take().into_iter().filter_map(|read| read.result.ok()).map(|document| document.name()));
        }
        names.sort_by_key(|name| name.parse::<u32>().ok());
        assert_eq!(names, (0..20).map(|name| name.to_string()).collect::<Vec<_>>());
        assert!(MOST.load(Ordering::SeqCst) <= AT_A_TIME);
    }
}
