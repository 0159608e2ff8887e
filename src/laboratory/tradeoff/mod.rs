//! The whole trade of speed for accuracy, for one photo and its ghosts, on one device.
//!
//! [`measure`] runs the sweeps one after the other and gathers [`Results`]; [`write()`] puts them into a folder as tables,
//! plots, pictures and a page. Errors are held against the direct sum in f64; times are medians of rounds in turns.

mod bench;
mod captions;
pub mod command;
mod front;
mod looks;
mod page;
mod phases;
mod plots;
mod point;
mod sample;
mod study;
mod sweeps;
mod write;

use std::rc::Rc;
use std::sync::Arc;

use serde::Serialize;

use crate::frame::Frame;
use crate::gpu::{Device, Info};
use crate::look::Look;
use crate::photo::Photo;
use crate::plan::{CostModel, Evaluator, Request};
use crate::problem::{Images, Problem};
use crate::scene::Ghost;
use crate::{Error, Result};

pub use front::{Crossover, Recommendation, exponent, short};
pub use phases::PhaseCurve;
pub use point::{Point, Storage, Sweep};
pub use write::{check, spare, write};

use looks::Looks;
use study::Study;

/// What is measured: a photo and what glares in it.
pub struct Subject<'a> {
    name: &'a str,
    photo: &'a Photo,
    ghosts: &'a [Ghost],
    /// The ghosts that all of its pixels make, where they make some.
    images: Option<Arc<Images>>,
    /// A look whose veil is studied, too.
    veil: Option<&'a Look>,
}

impl<'a> Subject<'a> {
    /// A photo, by a name for people, and what glares in it: ghosts, those of all of its pixels, and the veil of a look that has one,
    /// which says itself what the photo spans.
    ///
    /// # Errors
    /// [`Error::Usage`] where nothing glares.
    pub fn new(
        name: &'a str,
        photo: &'a Photo,
        ghosts: &'a [Ghost],
        images: Option<Arc<Images>>,
        look: &'a Look,
    ) -> Result<Self> {
        let veil = look.veil.is_some().then_some(look);
        let images = images.filter(|images| !images.all().is_empty());
        if ghosts.is_empty() && images.is_none() && veil.is_none() {
            return Err(Error::Usage(format!(
                "nothing glares in {name}: --lights or --scene can say what does, --threshold find fainter lights"
            )));
        }
        Ok(Self { name, photo, ghosts, images, veil })
    }

    /// Its ghosts on a frame.
    fn problem(&self, frame: Frame) -> Arc<Problem> {
        match &self.images {
            Some(images) => Problem::with_images(self.ghosts, images.clone(), frame),
            None => Problem::new(self.ghosts, frame),
        }
    }

    /// How many ghosts it has, those of all pixels too.
    fn ghosts(&self) -> usize {
        let images = self.images.as_ref().map_or(0, |images| images.count());
        self.ghosts.len() + images
    }
}

/// Hears how much of a sweep is done, from 0 to 1.
pub type Watch<'a> = &'a mut dyn FnMut(f64);

/// All that was measured.
#[derive(Serialize)]
pub struct Results {
    vglare: &'static str,
    /// The photo's name.
    pub photo: String,
    /// Columns and rows of the photo.
    pub picture: [u32; 2],
    /// Columns and rows of the picture that the sweeps ran at.
    pub swept: [u32; 2],
    /// Ghosts that the photo has.
    pub ghosts: usize,
    /// Whether fewer settings and rounds were asked for.
    pub quick: bool,
    /// Rounds that each time is the median of.
    pub rounds: usize,
    /// Pixels that each error is the largest of.
    pub sample: usize,
    /// What it was measured on.
    pub device: Info,
    /// Whether the planner reckoned with costs that were measured on this machine.
    pub calibrated: bool,
    /// What to use for ghosts; none where nothing was exact enough, or where there are none.
    pub recommendation: Option<Recommendation>,
    /// Every setting that was tried, sweep by sweep.
    pub points: Vec<Point>,
    /// The points on the front of the tolerance sweep, by their index, the fastest first.
    pub front: Vec<usize>,
    /// Those on the front of the veil, which has errors relative to itself at each pixel.
    pub veil_front: Vec<usize>,
    /// Where each evaluator becomes faster than the direct sum.
    pub crossovers: Vec<Crossover>,
    /// The period that the phases' stability was measured in.
    pub phase_period: f64,
    /// Turns of the highest harmonic that the planner takes, at the picture's border; none where it takes none.
    pub phase_reach: Option<f64>,
    /// The phases' errors, a curve for each way to compute them; none without ghosts.
    pub phases: Vec<PhaseCurve>,
    #[serde(skip)]
    looks: Looks,
}

/// The sweeps by what they are called while they run, and roughly the part of the whole time that each takes.
const STAGES: &[(&str, f64)] = &[
    ("tolerances", 0.22),
    ("degrees", 0.12),
    ("lattices", 0.1),
    ("storage", 0.04),
    ("numbers of ghosts", 0.28),
    ("sizes", 0.15),
    ("the veil", 0.04),
    ("pictures", 0.05),
];
/// Those of a photo without ghosts.
const OF_VEIL: &[(&str, f64)] = &[("the veil", 1.0)];

/// Runs a stage, which is told whom to tell how much of it is done.
type Stage<'a> = &'a mut dyn FnMut(&mut dyn FnMut(Watch<'_>) -> Result<()>) -> Result<()>;

/// The sweeps of ghosts.
fn of_ghosts(study: &mut Study<'_>, stage: Stage<'_>) -> Result<Vec<Point>> {
    let mut points = Vec::new();
    stage(&mut |watch| sweeps::tolerance(study, watch).map(|found| points.extend(found)))?;
    stage(&mut |watch| sweeps::degree(study, watch).map(|found| points.extend(found)))?;
    stage(&mut |watch| sweeps::oversampling(study, watch).map(|found| points.extend(found)))?;
    stage(&mut |watch| sweeps::storage(study, watch).map(|found| points.extend(found)))?;
    stage(&mut |watch| sweeps::ghosts(study, watch).map(|found| points.extend(found)))?;
    let tolerance = front::choice(&points).and_then(|point| point.asked).unwrap_or(1e-3);
    stage(&mut |watch| sweeps::size(study, tolerance, watch).map(|found| points.extend(found)))?;
    Ok(points)
}

/// Runs all sweeps, with plans by what was measured of this machine's costs, or else by the built-in ones; `watch` hears
/// what is going on, and how much of all is done, from 0 to 1.
///
/// # Errors
/// [`Error::Gl`] where the driver refuses, [`Error::Chart`] where an error map cannot be drawn.
pub fn measure(
    subject: &Subject<'_>,
    device: &Rc<Device>,
    costs: Option<CostModel>,
    quick: bool,
    watch: &mut dyn FnMut(&'static str, f64),
) -> Result<Results> {
    let mut study = Study::new(subject, device, costs.unwrap_or_default(), quick)?;
    let has_ghosts = subject.ghosts() > 0;
    let mut stages = if has_ghosts { STAGES } else { OF_VEIL }.iter().scan(0.0, |before, &(name, part)| {
        *before += part;
        Some((name, *before - part, part))
    });
    let mut stage = |run: &mut dyn FnMut(Watch<'_>) -> Result<()>| {
        let (name, before, part) = stages.next().unwrap_or(("the rest", 1.0, 0.0));
        watch(name, before);
        run(&mut |done: f64| watch(name, before + part * done))
    };
    let mut points = if has_ghosts { of_ghosts(&mut study, &mut stage)? } else { Vec::new() };
    stage(&mut |_| sweeps::veil(&study).map(|found| points.extend(found)))?;
    let front = front::front(&points, Sweep::Tolerance);
    let mut looks = Looks::default();
    // Of a photo's images not every pixel's truth is to be had in minutes.
    if has_ghosts && subject.images.is_none() {
        stage(&mut |watch| looks::looks(&mut study, &points, &front, watch).map(|found| looks = found))?;
    }
    let mut recommendation = front::recommend(&points);
    if let Some(found) = &mut recommendation
        && let Some(measured) = study.everywhere(found.tolerance, [found.width, found.height])?
    {
        (found.measured, found.everywhere) = (found.measured.max(measured), true);
    }
    let seen = front::choice(&points).and_then(|point| looks.delta_e(point));
    // Whichever evaluator the planner takes, the phases are those of a series.
    let tight = study.tightest(|request| Request { evaluator: Some(Evaluator::Rows), ..request });
    let period =
        tight.as_ref().filter(|(_, plan)| plan.terms() > 0).map_or_else(|| wide(&study), |(_, p)| p.period().x);
    Ok(Results {
        vglare: env!("CARGO_PKG_VERSION"),
        photo: subject.name.to_owned(),
        picture: [subject.photo.width(), subject.photo.height()],
        swept: [study.photo.width(), study.photo.height()],
        ghosts: subject.ghosts(),
        quick,
        rounds: study.bench.rounds.timed(),
        sample: study.sample.pixels.len(),
        device: device.info().clone(),
        calibrated: costs.is_some(),
        recommendation: recommendation.map(|found| found.seen(seen.unwrap_or(0.0))),
        crossovers: front::crossovers(&points),
        phase_reach: tight
            .map(|(_, plan)| f64::from(plan.degree()[0]) * 0.5 * wide(&study) / period)
            .filter(|&n| n >= 1.0),
        phases: if has_ghosts { phases::curves(study.photo.frame, period) } else { Vec::new() },
        phase_period: period,
        veil_front: front::front(&points, Sweep::Veil),
        points,
        front,
        looks,
    })
}

/// The picture's width in half its heights.
fn wide(study: &Study<'_>) -> f64 {
    2.0 * study.photo.frame.half_width()
}
