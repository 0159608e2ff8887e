//! The veil of the photo that is shown: summed on a thread of its own, kept on the device, and laid over the picture by weights.
//!
//! What a person drags changes weights, which costs a composite, or the sums. These are begun with what is set when the sums before
//! are there: until then the picture has the veil before, in its strength of now.

use std::sync::Arc;
use std::time::Instant;

use rayon::{ThreadPool, ThreadPoolBuilder};

use super::document::Document;
use super::loader::Wake;
use super::model::{Look, same_veil};
use super::shrink::shrink;
use super::task::{State, Task};
use crate::frame::Frame;
use crate::job::{Ledger, MOST_LAYERS, VeilLayers, VeilSums};
use crate::renderer::Picture;
use crate::scene::{Emission, Recovered};
use crate::{Error, Result};

/// The veil of one document at a time.
pub struct Veiling {
    wake: Wake,
    /// Its own: what the window asks of all cores itself never waits for a veil.
    pool: Option<Arc<ThreadPool>>,
    /// What was asked for last, of which document, on which pixels.
    look: Option<(u64, Frame, Look)>,
    asked: Option<Asked>,
    /// At most one, so that they do not pile up.
    running: Option<Running>,
    known: Option<Known>,
    refused: Option<(VeilSums, String)>,
    /// Why the last look that was asked for contradicts itself or the photo, if it does.
    wrong: Option<String>,
    /// Whether the device has layers.
    laid_over: bool,
    /// How many were summed.
    count: u64,
    /// How long the last one took, in milliseconds.
    milliseconds: f64,
}

/// What a look asks for.
struct Asked {
    sums: VeilSums,
    /// What each layer is multiplied by at strength 1, RGB.
    weights: Vec<[f64; 3]>,
    strength: f64,
    adds: bool,
}

/// What is being summed: of which document, and what its weights were when it began.
struct Running {
    number: u64,
    sums: VeilSums,
    weights: Vec<[f64; 3]>,
    task: Task<Result<Summed>>,
}

/// What comes of a thread.
struct Summed {
    layers: VeilLayers,
    /// As the device is to have them.
    laid: Laid,
    milliseconds: f64,
}

/// Layers for the device: the veil alone, or what the photo's pixels change by.
struct Laid {
    alone: bool,
    layers: Vec<Vec<[f32; 4]>>,
}

/// A veil that is there.
struct Known {
    sums: VeilSums,
    layers: VeilLayers,
    /// The last weights of these layers.
    weights: Vec<[f64; 3]>,
    /// What has not gone to the device yet.
    laid: Option<Laid>,
    /// Which of the two the device has.
    loaded: Option<bool>,
}

/// What is told of the veil in the picture.
pub struct Figures<'a> {
    /// The layers, with what is known of their error.
    pub layers: &'a VeilLayers,
    /// Where the light is, by the strength and the scatter of now.
    pub ledger: Ledger,
    /// What a person ought to know.
    pub notes: Vec<String>,
    /// Whether they are of what is set, or of what was set before.
    pub is_current: bool,
}

impl Laid {
    fn new(layers: &VeilLayers, pixels: &[[f32; 4]], alone: bool) -> Self {
        let one = |layer| if alone { layers.alone(layer) } else { layers.change(layer, pixels) };
        Self { alone, layers: (0..layers.count()).map(one).collect() }
    }
}

impl Veiling {
    /// None yet; `wake` is called when there is one.
    pub fn new(wake: Wake) -> Self {
        Self {
            wake,
            pool: None,
            look: None,
            asked: None,
            running: None,
            known: None,
            refused: None,
            wrong: None,
            laid_over: false,
            count: 0,
            milliseconds: 0.0,
        }
    }

    /// Takes in what has been summed.
    pub fn take_in(&mut self) {
        let Some(Running { number, sums, weights, task }) = self.running.take() else { return };
        let shown = self.look.as_ref().map(|(shown, ..)| *shown);
        match task.poll() {
            State::Running => self.running = Some(Running { number, sums, weights, task }),
            _ if shown != Some(number) => {}
            State::Failed(error) | State::Done(Err(error)) => self.refused = Some((sums, error.to_string())),
            State::Done(Ok(Summed { layers, laid, milliseconds })) => {
                (self.count, self.milliseconds) = (self.count + 1, milliseconds);
                self.known = Some(Known { sums, layers, weights, laid: Some(laid), loaded: None });
                self.weigh();
            }
        }
    }

    /// Asks for the veil of a look on a document's pixels, which lie on `frame` and shine as they are `recovered`, and begins what is missing unless something is
    /// being summed; `alone` is how the device is to have it.
    ///
    /// # Errors
    /// [`Error::Usage`] where the look contradicts itself or the photo; what was asked for before stays.
    pub fn ask(
        &mut self,
        number: u64,
        document: &Document,
        recovered: &Arc<Recovered>,
        frame: Frame,
        look: &Look,
        alone: bool,
    ) -> Result<()> {
        let same =
            self.look.as_ref().is_some_and(|(of, on, known)| (*of, *on) == (number, frame) && same_veil(known, look));
        if !same {
            let sums = VeilSums::of(look, &document.photo, &frame);
            self.wrong = sums.as_ref().err().map(ToString::to_string);
            let sums = sums?;
            // The layers of another photo are none of this one's.
            if self.look.as_ref().is_none_or(|(of, ..)| *of != number) || look.veil.is_none() {
                self.let_go();
            }
            self.look = Some((number, frame, look.clone()));
            let adds = look.veil.as_ref().is_some_and(|veil| veil.adds);
            self.asked = sums.map(|(sums, weights)| Asked { sums, weights, strength: look.strength, adds });
            self.weigh();
        }
        self.begin(number, document, recovered, alone);
        Ok(())
    }

    /// What the layers that are there are multiplied by, where they are those of the look.
    fn weigh(&mut self) {
        if let (Some(asked), Some(known)) = (&self.asked, &mut self.known)
            && asked.sums == known.sums
        {
            known.weights.clone_from(&asked.weights);
        }
    }

    fn begin(&mut self, number: u64, document: &Document, recovered: &Arc<Recovered>, alone: bool) {
        let Some(Asked { sums, adds, weights, .. }) = &self.asked else { return };
        let known = self.known.as_ref().is_some_and(|known| known.sums == *sums);
        let refused = self.refused.as_ref().is_some_and(|(refused, _)| refused == sums);
        if self.running.is_some() || known || refused {
            return;
        }
        if self.pool.is_none() {
            // Where the system gives none, the one that all share will do.
            self.pool = ThreadPoolBuilder::new().build().ok().map(Arc::new);
        }
        let (pool, asked, alone) = (self.pool.clone(), sums.clone(), alone || *adds);
        let (photo, means, recovered) = (document.photo.clone(), document.means.clone(), recovered.clone());
        let side = document.shrunk;
        let work = move || {
            let work = || {
                let shown = means.as_deref().unwrap_or(&photo.pixels);
                // Of means, those of the file's pixels as they shine.
                let shrunk = means.as_ref().filter(|_| recovered.is_other());
                let shrunk = shrunk.and_then(|_| shrink(&photo.frame, recovered.over(&photo.pixels), side).1);
                let shining = shrunk.as_deref().unwrap_or_else(|| recovered.over(shown));
                sum(&asked, Emission::of(&photo), shown, shining, alone)
            };
            match pool {
                Some(pool) => pool.install(work),
                None => work(),
            }
        };
        match Task::start("veil", &self.wake, work) {
            Ok(task) => {
                let (sums, weights) = (sums.clone(), weights.clone());
                self.running = Some(Running { number, sums, weights, task });
            }
            Err(error) => self.refused = Some((sums.clone(), format!("the veil cannot be computed: {error}"))),
        }
    }

    /// Brings the device up to date: the veil alone, or what the photo's pixels change by. Whether that changed something.
    ///
    /// # Errors
    /// [`Error::Gl`] where the driver refuses. Where it has no room, that is what [`Veiling::problem`] says.
    pub fn load(&mut self, picture: &mut Picture, document: &Document, alone: bool) -> Result<bool> {
        let alone = alone || self.asked.as_ref().is_some_and(|asked| asked.adds);
        let Some(known) = &mut self.known else {
            // Layers of nothing keep no room.
            if std::mem::take(&mut self.laid_over) {
                picture.lay_over(&[])?;
            }
            return Ok(false);
        };
        if known.loaded == Some(alone) {
            return Ok(false);
        }
        let laid = known.laid.take().filter(|laid| laid.alone == alone);
        let laid = laid.unwrap_or_else(|| Laid::new(&known.layers, document.pixels(), alone));
        match picture.lay_over(&laid.layers) {
            Ok(()) => (known.loaded, self.laid_over) = (Some(alone), true),
            Err(error @ Error::Gl(_)) => return Err(error),
            Err(error) => self.refused = self.known.take().map(|known| (known.sums, error.to_string())),
        }
        Ok(true)
    }

    /// The device has other layers now.
    pub fn unload(&mut self) {
        if let Some(known) = &mut self.known {
            known.loaded = None;
        }
        self.laid_over = false;
    }

    /// What the layers on the device are multiplied by.
    pub fn weights(&self) -> [[f64; 3]; MOST_LAYERS] {
        let mut weights = [[0.0; 3]; MOST_LAYERS];
        if let (Some(asked), Some(known)) = (&self.asked, &self.known) {
            for (weight, layer) in weights.iter_mut().zip(&known.weights) {
                *weight = layer.map(|weight| asked.strength * weight);
            }
        }
        weights
    }

    /// Whether a veil is being summed.
    pub fn is_summing(&self) -> bool {
        self.running.is_some()
    }

    /// Why there is no veil of what is set, if so.
    pub fn problem(&self) -> Option<&str> {
        let (asked, (refused, reason)) = (self.asked.as_ref()?, self.refused.as_ref()?);
        (asked.sums == *refused).then_some(reason)
    }

    /// Why there is no veil of what was set last, in the words of a command line.
    pub fn wrong(&self) -> Option<&str> {
        self.wrong.as_deref().or_else(|| self.problem())
    }

    /// What is known of the veil in the picture, if there is one.
    pub fn figures(&self) -> Option<Figures<'_>> {
        let (asked, known) = (self.asked.as_ref()?, self.known.as_ref()?);
        let weights = self.weights();
        let ledger = known.layers.ledger(&weights, asked.adds);
        let notes = known.layers.notes(&weights, asked.adds);
        Some(Figures { layers: &known.layers, ledger, notes, is_current: asked.sums == known.sums })
    }

    /// How many were summed, and the milliseconds that the last one took.
    pub fn effort(&self) -> (u64, f64) {
        (self.count, self.milliseconds)
    }

    /// Lets go of all of it; what comes of a sum that goes on is for nobody.
    pub fn clear(&mut self) {
        self.let_go();
        (self.look, self.asked, self.wrong) = (None, None, None);
    }

    fn let_go(&mut self) {
        (self.known, self.refused) = (None, None);
    }
}

/// All of it, on the thread of its own.
fn sum(sums: &VeilSums, emission: Emission, shown: &[[f32; 4]], shining: &[[f32; 4]], alone: bool) -> Result<Summed> {
    let started = Instant::now();
    let layers = sums.compute(emission, shining)?;
    let laid = Laid::new(&layers, shown, alone);
    Ok(Summed { layers, laid, milliseconds: started.elapsed().as_secs_f64() * 1e3 })
}
