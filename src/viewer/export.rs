//! Pictures written in the background, on a device of their own: what `vglare apply` writes, bit for bit.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use super::document::Document;
use super::loader::Wake;
use super::model::Look;
use super::task::{State, Task};
use crate::gpu::{Backend, Device};
use crate::job::{Computer, Done, Found, Known, Stages, Step, Wanted, Watch};
use crate::look::Search;
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

/// What is done one after the other; the photo is read already.
const STEPS: [Step; 5] = [Step::Finding, Step::Planning, Step::Computing, Step::Measuring, Step::Writing];

/// How far it is, for both threads.
struct Progress {
    step: Mutex<Step>,
    cancelled: AtomicBool,
    wake: Wake,
}

impl Watch for Progress {
    fn step(&self, step: Step) {
        *self.step.lock().unwrap_or_else(PoisonError::into_inner) = step;
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
        let search = document.search();
        let (target, watch) = (path.to_owned(), progress.clone());
        let work = move || write(photo, &look, search, subject, &target, &watch);
        let task = Task::start("export", wake, work).map_err(|reason| Error::write(path, reason))?;
        Ok(Self { path: path.to_owned(), progress, task })
    }

    /// What goes on.
    pub fn step(&self) -> Step {
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
fn write(
    photo: Arc<Photo>,
    look: &Look,
    search: Search,
    subject: Subject,
    path: &Path,
    watch: &Progress,
) -> Result<Vec<String>> {
    let options = WriteOptions { overwrite: true, ..WriteOptions::default() };
    photo::check_target(path, &photo, &options)?;
    let found = Found::knowing(look, photo, Some(search), Stages::default())?;
    // One at a time: they would share the device's memory, and contexts of Mesa's software renderer that are at work on two
    // threads at once can end the process (`llvmpipe_flush_resource`, Mesa 22.3).
    static TURN: Mutex<()> = Mutex::new(());
    let _turn = TURN.lock().unwrap_or_else(PoisonError::into_inner);
    if watch.cancelled() {
        return Err(Error::Cancelled);
    }
    let mut computer = look.renders().then(computer).transpose()?;
    let wanted = Wanted { picture: subject == Subject::Picture, glare: subject == Subject::Glare, ..Wanted::default() };
    let Done { picture, glare, mut warnings, .. } = found.compute(computer.as_mut(), wanted, watch)?;
    watch.begin(Step::Writing)?;
    if let Some(mut picture) = picture.or(glare) {
        picture.source.made = Some(look.made().into());
        photo::write_unless(path, &picture, &options, || watch.cancelled())?;
        warnings.extend(photo::lost(path, &picture, &options));
    }
    Ok(warnings)
}

fn computer() -> Result<Computer> {
    let device = Device::open(&Backend::ALL)?;
    let known = Known::of(device.info());
    Ok(Computer::new(device, known))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::look::{LookLens, LookLights};
    use crate::scene::FindOptions;

    /// A grey photo with a lamp.
    fn photo() -> Photo {
        let mut pixels = vec![[0.25, 0.25, 0.25, 1.0]; 32 * 16];
        pixels[100..103].fill([50.0, 50.0, 50.0, 1.0]);
        Photo::new(32, 16, pixels)
    }

    #[test]
    fn a_job_starts_from_what_the_window_has_found() {
        let lens = LookLens::preset("zoom").unwrap();
        let look = Look { lens, lights: LookLights::Found, veil: None, ..Look::default() };
        let document = Document::new(Path::new("a.exr"), photo(), look.clone());
        // A search would give the lamp another flux than this.
        let mut known = document.found.clone();
        known.lights[0].flux = [7.0; 3];
        let lights = |options: FindOptions| {
            let search = Search { options, unit: 1.0, found: known.clone() };
            Found::knowing(&look, document.photo.clone(), Some(search), Stages::default()).unwrap().scene.lights
        };
        assert_eq!(lights(document.searched), known.lights, "it is not searched again");
        let other = FindOptions { merge: 0.5, ..document.searched };
        assert_eq!(lights(other), document.found.lights, "by other rules it is");
        // Nor is a photo copied until its picture is drawn.
        let found = Found::new(&look, document.photo.clone(), Stages::default()).unwrap();
        assert!(Arc::ptr_eq(&found.photo, &document.photo));
    }
}
