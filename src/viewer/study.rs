//! What is found out about a picture that is at rest: how exact it is, a cut through it, its spectrum, and how its error
//! falls with the degree.
//!
//! Only what has to come from the device is done where the window is drawn. The truth that it is held against is summed
//! in f64 on threads of their own. While anything moves, nothing begins.

mod error_map;
mod findings;

use egui::{ColorImage, Context, TextureHandle, TextureOptions};

use super::loader::Wake;
use super::task::{State, Task};
use crate::Result;
use crate::certificate::{Certificate, Samples};
use crate::frame::Frame;
use crate::plan::Plan;
use crate::renderer::Field;

pub use error_map::{DECADES, colour};
pub use findings::{Cut, CutPoint, Degree, SPECTRUM_DECADES};

/// What is to be found out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wanted {
    /// The error at sample pixels.
    pub certificate: bool,
    /// The error all over the picture.
    pub error_map: bool,
    /// The plot.
    pub plot: Plot,
    /// Where the picture is cut.
    pub cut: Cut,
}

impl Default for Wanted {
    fn default() -> Self {
        Self { certificate: true, error_map: false, plot: Plot::Off, cut: Cut { horizontal: true, at: 0.5 } }
    }
}

/// Which plot is shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Plot {
    /// None.
    Off,
    /// The spectrum's magnitudes.
    Spectrum,
    /// The field along a line.
    Section,
    /// The error that is predicted for other degrees.
    Convergence,
}

/// The picture that is looked into; `number` tells it from those before.
#[derive(Clone, Copy)]
pub struct Picture<'a> {
    pub number: u64,
    pub plan: &'a Plan,
}

/// What is known of the picture.
pub struct Study {
    wake: Wake,
    number: u64,
    certificate: Finding<u64, Certificate>,
    section: Finding<(u64, Cut), Vec<CutPoint>>,
    convergence: Finding<u64, Vec<Degree>>,
    error_map: Finding<(u64, u32), ColorImage>,
    error_texture: Option<TextureHandle>,
    spectrum: Option<(u64, [TextureHandle; 4])>,
}

/// An answer that is worked out in the background.
struct Finding<Q, A> {
    asked: Option<Q>,
    task: Option<Task<A>>,
    known: Option<A>,
}

impl<Q: PartialEq, A: Send + 'static> Finding<Q, A> {
    fn new() -> Self {
        Self { asked: None, task: None, known: None }
    }

    fn wants(&self, question: &Q) -> bool {
        self.asked.as_ref() != Some(question)
    }

    /// Begins to work it out. Where the system gives no thread, there is no answer.
    fn begin(&mut self, question: Q, wake: &Wake, work: impl FnOnce() -> A + Send + 'static) {
        self.asked = Some(question);
        self.task = Task::start("study", wake, work).ok();
    }

    /// Whether an answer has come in.
    fn take_in(&mut self) -> Result<bool> {
        match self.task.as_ref().map(Task::poll) {
            None | Some(State::Running) => Ok(false),
            Some(State::Failed(error)) => {
                self.task = None;
                Err(error)
            }
            Some(State::Done(answer)) => {
                (self.task, self.known) = (None, Some(answer));
                Ok(true)
            }
        }
    }
}

impl Study {
    /// Nothing is known yet; `wake` is called when something is.
    pub fn new(wake: Wake) -> Self {
        Self {
            wake,
            number: 0,
            certificate: Finding::new(),
            section: Finding::new(),
            convergence: Finding::new(),
            error_map: Finding::new(),
            error_texture: None,
            spectrum: None,
        }
    }

    /// Takes in what has been worked out; whether there was anything.
    ///
    /// # Errors
    /// [`crate::Error::Internal`] where one of them came to grief, once.
    pub fn take_in(&mut self, context: &Context) -> Result<bool> {
        let mut news = self.certificate.take_in()? | self.section.take_in()? | self.convergence.take_in()?;
        if self.error_map.take_in()? {
            news = true;
            let image = self.error_map.known.take();
            self.error_texture = image.map(|image| context.load_texture("error", image, TextureOptions::NEAREST));
        }
        Ok(news)
    }

    /// Lets go of what is known of another picture.
    pub fn forget_others(&mut self, number: u64) {
        if self.number != number {
            self.number = number;
            (self.certificate.known, self.section.known, self.convergence.known) = (None, None, None);
            (self.error_texture, self.spectrum) = (None, None);
        }
    }

    /// Whether something is wanted that is neither known nor being worked out.
    pub fn is_due(&self, number: u64, wanted: &Wanted, frame: Frame) -> bool {
        let plot = match wanted.plot {
            Plot::Off => false,
            Plot::Spectrum => self.spectrum.as_ref().is_none_or(|(known, _)| *known != number),
            Plot::Section => self.section.wants(&(number, wanted.cut)),
            Plot::Convergence => self.convergence.wants(&number),
        };
        let map = wanted.error_map && self.next_stride(number, frame).is_some();
        plot || map || (wanted.certificate && self.certificate.wants(&number))
    }

    /// The next finer step of the error map; none where it is on its way, or as fine as it gets.
    fn next_stride(&self, number: u64, frame: Frame) -> Option<u32> {
        match self.error_map.asked {
            Some((asked, stride)) if asked == number && self.error_map.task.is_none() => {
                error_map::finer(stride, frame)
            }
            Some((asked, _)) if asked == number => None,
            _ => Some(error_map::coarsest(frame)),
        }
    }

    /// Begins what is due; returns whether something is known at once.
    ///
    /// # Errors
    /// [`crate::Error::Gl`] where the driver refuses.
    pub fn begin(
        &mut self,
        picture: &Picture<'_>,
        wanted: &Wanted,
        field: &mut Field,
        context: &Context,
    ) -> Result<bool> {
        let &Picture { number, plan } = picture;
        let frame = plan.problem().frame();
        if wanted.certificate && self.certificate.wants(&number) {
            let samples = Samples::take(field, plan)?;
            self.certificate.begin(number, &self.wake, move || samples.certify());
        }
        if wanted.error_map
            && let Some(stride) = self.next_stride(number, frame)
        {
            let map = error_map::Rendered::take(field, plan, frame, stride)?;
            let problem = plan.problem().clone();
            self.error_map.begin((number, stride), &self.wake, move || map.image(&problem));
        }
        match wanted.plot {
            Plot::Section if self.section.wants(&(number, wanted.cut)) => {
                let section = findings::Section::take(field, wanted.cut, frame)?;
                let problem = plan.problem().clone();
                let truth = move || section.beside_truth(&problem);
                self.section.begin((number, wanted.cut), &self.wake, truth);
            }
            Plot::Convergence if self.convergence.wants(&number) => {
                let plan = plan.clone();
                self.convergence.begin(number, &self.wake, move || findings::convergence(&plan));
            }
            Plot::Spectrum if self.spectrum.as_ref().is_none_or(|(known, _)| *known != number) => {
                let images = findings::spectrum_images(&field.spectrum_terms(), plan.counts());
                let load = |image| context.load_texture("spectrum", image, TextureOptions::NEAREST);
                self.spectrum = Some((number, images.map(load)));
                return Ok(true);
            }
            _ => {}
        }
        Ok(false)
    }

    /// The error at sample pixels.
    pub fn certificate(&self) -> Option<&Certificate> {
        self.certificate.known.as_ref()
    }

    /// The field along the cut, and the truth beside it.
    pub fn section(&self) -> Option<&[CutPoint]> {
        self.section.known.as_deref()
    }

    /// The error predicted for degrees around the plan's.
    pub fn convergence(&self) -> Option<&[Degree]> {
        self.convergence.known.as_deref()
    }

    /// The magnitudes of A, B, C and D.
    pub fn spectrum(&self) -> Option<&[TextureHandle; 4]> {
        self.spectrum.as_ref().map(|(_, textures)| textures)
    }

    /// The error all over the picture, in false colours.
    pub fn error_map(&self) -> Option<&TextureHandle> {
        self.error_texture.as_ref()
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;
    use std::sync::mpsc::channel;

    use super::*;

    #[test]
    fn an_answer_that_came_to_grief_is_told_once() {
        let (sender, woken) = channel();
        let wake: Wake = Arc::new(move || sender.send(()).unwrap());
        let mut finding = Finding::<u32, u32>::new();
        finding.begin(1, &wake, || panic!("as it should"));
        woken.recv().unwrap();
        assert!(finding.take_in().is_err_and(|error| error.to_string().contains("as it should")));
        assert!(matches!(finding.take_in(), Ok(false)));
        assert!(!finding.wants(&1), "it is not asked again and again");
    }
}
