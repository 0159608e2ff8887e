//! Pictures written in the background, on a device of their own: what `vglare apply` writes, bit for bit.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use super::document::Document;
use super::loader::Wake;
use super::model::Look;
use super::task::{State, Task};
use crate::gpu::{Backend, Device};
use crate::job::{Computer, Job, Stages, Wanted, Watch};
use crate::photo::{self, Photo, WriteOptions};
use crate::{Error, Result};

/// Which picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Subject {
    /// The photo with its glare.
    Picture,
    /// The glare alone.
    Glare,
}

/// A picture on its way to its file.
pub struct Export {
    /// The file.
    pub path: PathBuf,
    progress: Arc<Progress>,
    task: Task<Result<Vec<String>>>,
}

/// What is done one after the other; how long each takes is not known beforehand.
const STEPS: [&str; 5] = ["finding the lights", "planning", "computing the glare", "measuring the error", "writing"];

/// How far it is, for both threads.
struct Progress {
    step: Mutex<&'static str>,
    cancelled: AtomicBool,
    wake: Wake,
}

impl Watch for Progress {
    fn step(&self, what: &'static str) {
        *self.step.lock().unwrap_or_else(PoisonError::into_inner) = what;
        (self.wake)();
    }

    fn measured(&self, _: usize) {}

    fn advance(&self, _: usize) {}

    fn cancelled(&self) -> bool {
        self.cancelled.load(Ordering::Relaxed)
    }
}

impl Export {
    /// Begins to write a picture of a document, in place of one that is there.
    ///
    /// # Errors
    /// [`Error::Write`] where the system gives no thread.
    pub fn start(document: &Document, subject: Subject, path: &Path, wake: &Wake) -> Result<Self> {
        if document.is_asleep() {
            return Err(Error::write(path, "its photo is not there yet"));
        }
        let step = Mutex::new(STEPS[0]);
        let progress = Arc::new(Progress { step, cancelled: AtomicBool::new(false), wake: wake.clone() });
        let (photo, look) = (document.photo.clone(), document.look.clone());
        let (target, watch) = (path.to_owned(), progress.clone());
        let work = move || write(&photo, &look, subject, &target, &watch);
        let task = Task::start("export", wake, work).map_err(|reason| Error::write(path, reason))?;
        Ok(Self { path: path.to_owned(), progress, task })
    }

    /// What goes on.
    pub fn step(&self) -> &'static str {
        *self.progress.step.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Which part of the steps is done, 0 to 1.
    pub fn part(&self) -> f32 {
        let step = self.step();
        STEPS.iter().position(|&other| other == step).unwrap_or(0) as f32 / STEPS.len() as f32
    }

    /// Asks it to stop: after the step that goes on, or in the middle of writing. The file does not appear then.
    pub fn cancel(&self) {
        self.progress.cancelled.store(true, Ordering::Relaxed);
    }

    /// What came of it, with what a person ought to know, once it has come to an end.
    pub fn poll(&self) -> Option<Result<Vec<String>>> {
        match self.task.poll() {
            State::Running => None,
            State::Done(result) => Some(result),
            State::Failed(error) => Some(Err(error.in_frame(&self.path))),
        }
    }
}

/// All of it, on the thread of its own.
fn write(photo: &Photo, look: &Look, subject: Subject, path: &Path, watch: &Progress) -> Result<Vec<String>> {
    let options = WriteOptions { overwrite: true, ..WriteOptions::default() };
    photo::check_target(path, photo, &options)?;
    let mut job = Job::new(look, photo.clone(), Stages::default())?;
    // One at a time: they would share the device's memory, and contexts of Mesa's software renderer that are at work on two
    // threads at once can end the process (`llvmpipe_flush_resource`, Mesa 22.3).
    static TURN: Mutex<()> = Mutex::new(());
    let _turn = TURN.lock().unwrap_or_else(PoisonError::into_inner);
    if watch.cancelled() {
        return Err(Error::Cancelled);
    }
    let mut computer = look.renders().then(|| Device::open(&Backend::ALL).map(Computer::new)).transpose()?;
    let wanted = Wanted { glare: subject == Subject::Glare, ..Wanted::default() };
    job.compute(computer.as_mut(), wanted, watch)?;
    if watch.cancelled() {
        return Err(Error::Cancelled);
    }
    watch.step(STEPS[4]);
    let picture = match job.glare.take() {
        Some(glare) => job.photo.companion(glare),
        None => job.photo,
    };
    photo::write_unless(path, &picture, &options, || watch.cancelled())?;
    let mut warnings = job.warnings;
    warnings.extend(photo::lost(path, &picture, &options));
    Ok(warnings)
}
