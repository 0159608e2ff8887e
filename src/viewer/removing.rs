//! The photo that is shown without the veil of its look, found on a thread of its own and laid over the picture as a change of it.

use std::sync::Arc;

use rayon::{ThreadPool, ThreadPoolBuilder};

use super::document::Document;
use super::loader::Wake;
use super::model::{Look, same_veil};
use super::task::{State, Task};
use crate::frame::Frame;
use crate::job::{Removal, Removed, Removing as Asked, Stages, remove};
use crate::photo::Photo;
use crate::renderer::Picture;
use crate::{Error, Result};

/// The clean photo of one document at a time.
pub struct Removing {
    wake: Wake,
    /// Its own: what the window asks of all cores itself never waits for it.
    pool: Option<Arc<ThreadPool>>,
    /// At most one, so that they do not pile up.
    running: Option<(Of, Task<Result<Removed>>)>,
    known: Option<(Of, Known)>,
    /// Whether the device has the change.
    loaded: bool,
    /// How many photos were cleaned.
    count: u64,
}

/// What is cleaned, of which veil.
struct Of {
    number: u64,
    frame: Frame,
    look: Look,
}

/// What came of it.
enum Known {
    /// What the pixels change by, and how exactly; none where the look has no veil.
    Clean {
        change: Vec<[f32; 4]>,
        removal: Option<Box<Removal>>,
    },
    Refused(String),
}

impl Of {
    fn is(&self, number: u64, frame: Frame, look: &Look) -> bool {
        (self.number, self.frame) == (number, frame) && same_veil(&self.look, look)
    }
}

impl Removing {
    /// None yet; `wake` is called when there is one.
    pub fn new(wake: Wake) -> Self {
        Self { wake, pool: None, running: None, known: None, loaded: false, count: 0 }
    }

    /// Takes in what has been found.
    pub fn take_in(&mut self) {
        let Some((of, task)) = self.running.take() else { return };
        let known = match task.poll() {
            State::Running => {
                self.running = Some((of, task));
                return;
            }
            State::Failed(error) | State::Done(Err(error)) => Known::Refused(error.to_string()),
            State::Done(Ok(removed)) => {
                self.count += 1;
                let removal = removed.removal.map(Box::new);
                Known::Clean { change: removed.photo.pixels, removal }
            }
        };
        (self.known, self.loaded) = (Some((of, known)), false);
    }

    /// Asks for a document's photo without the veil of a look, on `frame`, and begins unless another is under way.
    pub fn ask(&mut self, number: u64, document: &Document, frame: Frame, look: &Look) {
        let known = self.known.as_ref().is_some_and(|(of, _)| of.is(number, frame, look));
        if known || self.running.is_some() {
            return;
        }
        if self.pool.is_none() {
            // Where the system gives none, the one that all share will do.
            self.pool = ThreadPoolBuilder::new().build().ok().map(Arc::new);
        }
        let of = Of { number, frame, look: look.clone() };
        let (pool, look) = (self.pool.clone(), look.clone());
        let (whole, means) = (document.photo.clone(), document.means.clone());
        let work = move || {
            let work = || {
                let pixels = means.as_deref().unwrap_or(&whole.pixels);
                clean(&look, &Photo { frame, pixels: pixels.clone(), ..whole.without_pixels() })
            };
            match pool {
                Some(pool) => pool.install(work),
                None => work(),
            }
        };
        match Task::start("removal", &self.wake, work) {
            Ok(task) => self.running = Some((of, task)),
            Err(error) => {
                self.known = Some((of, Known::Refused(format!("the veil cannot be taken away: {error}"))));
            }
        }
    }

    /// Brings the device up to date. Whether that changed something.
    ///
    /// # Errors
    /// [`Error::Gl`] where the driver refuses.
    pub fn load(&mut self, picture: &mut Picture) -> Result<bool> {
        if self.loaded {
            return Ok(false);
        }
        let Some((_, known @ Known::Clean { .. })) = &mut self.known else { return Ok(false) };
        if let Known::Clean { change, .. } = known
            && let Err(error) = picture.lay_over(std::slice::from_ref(change))
        {
            match error {
                Error::Gl(_) => return Err(error),
                error => *known = Known::Refused(error.to_string()),
            }
        }
        self.loaded = true;
        Ok(true)
    }

    /// What the layer on the device is multiplied by, where it is that of what is shown.
    pub fn weight(&self, number: u64, frame: Frame, look: &Look) -> f64 {
        let fits = |(of, known): &(Of, Known)| of.is(number, frame, look) && matches!(known, Known::Clean { .. });
        f64::from(u8::from(self.loaded && self.known.as_ref().is_some_and(fits)))
    }

    /// The device has other layers now.
    pub fn unload(&mut self) {
        self.loaded = false;
    }

    /// Whether one is under way.
    pub fn is_running(&self) -> bool {
        self.running.is_some()
    }

    /// How the last one was come by; none where there is none, or there was no veil to take away.
    pub fn removal(&self) -> Option<&Removal> {
        match self.known.as_ref()? {
            (_, Known::Clean { removal, .. }) => removal.as_deref(),
            _ => None,
        }
    }

    /// Why there is none, if so.
    pub fn refused(&self) -> Option<&str> {
        match self.known.as_ref()? {
            (_, Known::Refused(reason)) => Some(reason),
            _ => None,
        }
    }

    /// How many photos were cleaned.
    pub fn count(&self) -> u64 {
        self.count
    }

    /// Lets go of all of it; what comes of a task that goes on is for nobody.
    pub fn clear(&mut self) {
        (self.known, self.loaded) = (None, false);
    }
}

/// The clean photo, as what its pixels change by: to the tolerance of `vglare remove`, or to what can be had.
fn clean(look: &Look, photo: &Photo) -> Result<Removed> {
    let asked = Asked { allow_floor: true, ..Asked::default() };
    let mut removed = remove(look, photo.clone(), asked, &mut Stages::default())?;
    for (pixel, own) in removed.photo.pixels.iter_mut().zip(&photo.pixels) {
        // What is no number stays what it is.
        *pixel = [0, 1, 2, 3].map(|k| if own[k].is_finite() && k < 3 { pixel[k] - own[k] } else { 0.0 });
    }
    Ok(removed)
}
