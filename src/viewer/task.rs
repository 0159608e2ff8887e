//! Work on a thread of its own, so that the window never waits.

use std::io;
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::thread;

use super::loader::Wake;
use crate::{Error, Result, panics};

/// Work under way.
pub struct Task<T> {
    receiver: Receiver<Result<T>>,
}

/// Wakes the window when it is dropped.
struct WakeAfterwards(Wake);

impl Drop for WakeAfterwards {
    fn drop(&mut self) {
        (self.0)();
    }
}

/// What has become of a task.
#[derive(Debug)]
pub enum State<T> {
    /// It goes on.
    Running,
    /// It came to an end, with this.
    Done(T),
    /// It came to an end by a panic, or its result has been taken.
    Failed(Error),
}

impl<T: Send + 'static> Task<T> {
    /// Begins a task, after which `wake` is called.
    ///
    /// # Errors
    /// Where the system gives no thread.
    pub fn start(name: &str, wake: &Wake, work: impl FnOnce() -> T + Send + 'static) -> io::Result<Self> {
        let (sender, receiver) = channel();
        let wake = WakeAfterwards(wake.clone());
        thread::Builder::new().name(name.to_owned()).spawn(move || {
            let _wake = wake;
            // Moved in after it, and so gone before the window is woken, even where the work panics.
            let sender = sender;
            // The other end is gone where nobody wants the result any more.
            let _ = sender.send(panics::caught(|| Ok(work())));
        })?;
        Ok(Self { receiver })
    }

    /// Looks after it; its result is there once.
    pub fn poll(&self) -> State<T> {
        match self.receiver.try_recv() {
            Ok(Ok(result)) => State::Done(result),
            Ok(Err(error)) => State::Failed(error),
            Err(TryRecvError::Empty) => State::Running,
            Err(TryRecvError::Disconnected) => State::Failed(Error::Internal { what: "a thread is gone".into() }),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;
    use std::sync::mpsc::channel;

    use super::*;

    #[test]
    fn a_task_wakes_the_window_and_is_done_once() {
        let (sender, receiver) = channel();
        let wake: Wake = Arc::new(move || sender.send(()).unwrap());
        let task = Task::start("test", &wake, || 7).unwrap();
        receiver.recv().unwrap();
        assert!(matches!(task.poll(), State::Done(7)));
        assert!(matches!(task.poll(), State::Failed(_)));
    }

    #[test]
    fn a_task_that_panics_wakes_the_window_too() {
        let (sender, receiver) = channel();
        let wake: Wake = Arc::new(move || sender.send(()).unwrap());
        let task = Task::<()>::start("test", &wake, || panic!("as it should")).unwrap();
        receiver.recv().unwrap();
        let State::Failed(error) = task.poll() else { panic!("it has no result") };
        assert_eq!(error.to_string(), "an internal error (as it should); please report it");
    }
}
