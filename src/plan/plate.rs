//! The plate: ghosts of the whole photo that no series holds, summed over all pixels on the picture's own.

use std::sync::{Arc, Mutex, PoisonError};

use super::candidate::{Survey, candidate};
use super::direct::STORED;
use super::effort::Effort;
use super::terms::Group;
use super::weigh::{Weighed, weigh};
use super::{
    Cost, Evaluator, Found, Layer, Plan, Refusal, Request, Transform, check, cost, images, own_period, period, unit,
};
use crate::frame::Frame;
use crate::plate::{self, Chosen, Part, Sheet, Way};
use crate::problem::{Image, Images, Problem};
use crate::scene::Ghost;
use crate::{Error, Result};

/// Images of a photo that are summed on the picture's own pixels, each by the way that is cheapest for it.
#[derive(Debug, Clone)]
pub struct Plate {
    /// The images, a group each, of [`Transform::Direct`].
    pub groups: Vec<Group>,
    /// How each is summed.
    pub parts: Vec<Part>,
    /// What it takes one core, in nanoseconds.
    pub nanoseconds: f64,
    /// The field that was summed last, with the frame whose pixels those are.
    held: Arc<Mutex<Held>>,
}

type Held = Option<(Frame, Arc<Sheet>)>;

/// What is held follows from the rest.
impl PartialEq for Plate {
    fn eq(&self, other: &Self) -> bool {
        self.groups == other.groups && self.parts == other.parts
    }
}

impl Plate {
    /// The field at a frame's pixels, in no unit; summed once.
    ///
    /// # Errors
    /// [`Error::Memory`] where memory is limited and that is too little.
    pub(crate) fn sheet(&self, problem: &Problem, frame: Frame) -> Result<Arc<Sheet>> {
        let held = || self.held.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, sheet)) = held().as_ref().filter(|(known, _)| *known == frame) {
            return Ok(sheet.clone());
        }
        let Some(images) = problem.images() else { return Err(Error::Plan("a plate without a photo".into())) };
        let sheet = Arc::new(plate::sheet(images, &self.parts, frame)?);
        *held() = Some((frame, sheet.clone()));
        Ok(sheet)
    }
}

impl Plate {
    /// Forgets the field that was summed, so that it is summed anew.
    pub(crate) fn forget(&self) {
        *self.held.lock().unwrap_or_else(PoisonError::into_inner) = None;
    }

    /// How each image is summed.
    pub fn ways(&self) -> impl Iterator<Item = Way> {
        self.parts.iter().map(|part| part.way)
    }
}

/// Why there is none.
pub(super) fn by_hand() -> Error {
    Error::Plan("a plate has neither a period nor a degree; these are a series'".into())
}

/// What of the tolerance the plate may use up, beside a series and alone.
const BESIDE: f64 = 0.4;
const ALONE: f64 = 0.9;

/// Modes of one image beyond which it is taken for sharp; the first that gives a plan is taken.
const SHARP: [f64; 4] = [1e5, 2e4, 2e3, 0.0];

/// Values of bells that finding the unit may take, and places that are looked at for it.
const EFFORT: f64 = 2e8;
const PLACES: [f64; 2] = [3.0, 24.0];

/// The plan of a series for the images that have one, and a plate for all others; all of them, where the plate is asked for.
///
/// # Errors
/// [`Error::Plan`] where numbers mean nothing; else why what is no part of the plate cannot be had.
pub(super) fn plan(
    all: &Images,
    problem: &Arc<Problem>,
    asked: &Request,
    series: &[Error],
) -> Result<std::result::Result<Plan, Vec<Error>>> {
    let (scale, peaks) = unit_of(all, problem);
    check::scale(scale)?;
    let task = Task { all, problem, asked, scale };
    let needs = task.needs();
    let mut refusals = Vec::new();
    let mut last = None;
    for most in SHARP {
        let smooth = |need: &&(usize, f64)| need.1 < most && asked.evaluator != Some(Evaluator::Plate);
        let smooth: Vec<usize> = needs.iter().filter(smooth).map(|(member, _)| *member).collect();
        if last.as_ref() == Some(&smooth) {
            continue;
        }
        match task.beside(&smooth)? {
            Ok(plan) => {
                let told = |error: &Error| Refusal { evaluator: Evaluator::Series, reason: error.reason() };
                let refused = plan.refused.iter().cloned().chain(series.iter().take(1).map(told)).collect();
                // A certificate looks at the last first.
                let peaks = plan.peaks.iter().chain(peaks.iter().rev()).copied().collect();
                return Ok(Ok(Plan { refused, peaks, ..plan }));
            }
            Err(errors) => refusals = errors,
        }
        last = Some(smooth);
    }
    Ok(Err(refusals))
}

/// A lower bound of the field's largest value, RGB, and the pixels that it was found at.
fn unit_of(all: &Images, problem: &Problem) -> ([f64; 3], Vec<[i32; 2]>) {
    let effort: f64 = all.all().iter().map(|image| plate::effort(all, image)).sum();
    let most = (EFFORT / effort.max(1.0)).clamp(PLACES[0], PLACES[1]) as usize;
    let mut places = plate::bright_places(all, problem.frame());
    places.truncate(most);
    if !problem.ghosts().is_empty() {
        places.extend(weigh(problem, 1e-3).peaks.into_iter().take(most));
    }
    let truth = problem.truth(&places);
    let mut scale = truth.iter().fold([0.0f64; 3], |most, value| [0, 1, 2].map(|c| most[c].max(value[c].abs())));
    if scale == [0.0; 3] {
        scale = unit::evenly(all);
    }
    let largest = scale.into_iter().fold(0.0, f64::max);
    // A colour of which there is nothing is held against the others.
    (scale.map(|own| if own > 0.0 { own } else { largest }), places)
}

/// What is to be planned.
struct Task<'a> {
    all: &'a Images,
    problem: &'a Arc<Problem>,
    asked: &'a Request,
    scale: [f64; 3],
}

impl Task<'_> {
    fn weighed(&self, problem: &Problem, request: &Request) -> Weighed {
        match problem.images() {
            Some(images) => unit::in_units(problem, images, request, self.scale),
            None => super::weigh::weigh_in(problem, request.tolerance, self.scale),
        }
    }

    /// About how many modes each image needs in a period of its own; as many as there are none of, where it has no series.
    fn needs(&self) -> Vec<(usize, f64)> {
        let weighed = self.weighed(self.problem, self.asked);
        let groups = images::groups(self.all, &weighed);
        let part = BESIDE * self.asked.tolerance / groups.len().max(1) as f64;
        let effort = Effort::unlimited();
        let need = |group: &Group| {
            let reaches = period::reaches_of_images(self.problem, &weighed, &group.members);
            let period = self.asked.period.unwrap_or_else(|| period::shortest(&reaches, part));
            let found = super::terms::fewest(&mut [group.clone()], period, part, &effort);
            found.map_or(f64::INFINITY, |counts| counts.iter().map(|count| f64::from(*count)).sum())
        };
        // What is too faint to show needs none.
        let unknown = |weight: &f64| if *weight == 0.0 { 0.0 } else { f64::INFINITY };
        let mut needs: Vec<f64> = weighed.images.iter().map(unknown).collect();
        for group in &groups {
            let need = need(group);
            group.members.iter().for_each(|member| needs[*member as usize] = need);
        }
        needs.into_iter().enumerate().collect()
    }

    /// A series of some images, and of all ghosts, beside a plate of the other images.
    fn beside(&self, smooth: &[usize]) -> Result<std::result::Result<Plan, Vec<Error>>> {
        let (asked, problem) = (self.asked, self.problem);
        let sharp: Vec<usize> = (0..self.all.all().len()).filter(|member| !smooth.contains(member)).collect();
        let alone = smooth.is_empty() && problem.ghosts().is_empty();
        let budget = asked.tolerance * if alone { ALONE } else { BESIDE };
        let chosen = plate::choose(self.all, &sharp, problem.frame(), self.scale, budget)?;
        let own = chosen.error + chosen.cut + chosen.rounding + 2.0 * STORED;
        let left = asked.tolerance - own;
        if left <= 0.0 {
            return Ok(Err(vec![Error::ToleranceBelowFloor { asked: asked.tolerance, floor: own }]));
        }
        let plan = if alone {
            Plan { scale: self.scale, ..Plan::by_hand(problem.clone(), Vec::new()) }
        } else {
            let part = problem.of_images((!smooth.is_empty()).then(|| self.all.only(smooth)));
            match self.rest(&part, &Request { tolerance: left, ..*asked })? {
                Ok(plan) => renumbered(plan, smooth),
                Err(errors) => return Ok(Err(errors)),
            }
        };
        Ok(Ok(self.with_plate(plan, &sharp, chosen)))
    }

    /// The plan of what is no part of the plate.
    fn rest(&self, part: &Arc<Problem>, request: &Request) -> Result<std::result::Result<Plan, Vec<Error>>> {
        let images = part.images().into_iter().flat_map(|images| images.all().iter().map(|image| &image.ghost));
        let bells: Vec<Ghost> = images.chain(part.ghosts()).cloned().collect();
        let evaluator = request.evaluator.filter(|evaluator| *evaluator != Evaluator::Plate);
        let request = &Request { period: own_period(&bells, request)?, evaluator, ..*request };
        let survey = Survey::of(part, self.weighed(part, request));
        let mut found = Found::default();
        found.series(part, &survey, request, &Evaluator::SERIES, false);
        if part.images().is_none() {
            found.take(Evaluator::Direct, candidate(part, &survey, None, request, Evaluator::Direct));
        }
        Ok(found.cheapest())
    }

    /// A plan, with a plate beside it.
    fn with_plate(&self, plan: Plan, sharp: &[usize], chosen: Chosen) -> Plan {
        let Chosen { parts, error, cut, rounding, nanoseconds } = chosen;
        let weight = |image: &Image| super::weigh::peak_weight(&self.all.gathered(image), self.scale);
        let group = |member: &usize| {
            let image = &self.all.all()[*member];
            let pixels = self.all.raster_of(image).pixels();
            Group { ghosts: pixels, ..Group::of_one(&image.ghost, *member as u32, weight(image)) }
        };
        let groups = sharp.iter().map(group).collect();
        let (mut layers, mut predicted) = (plan.layers.clone(), plan.predicted);
        layers.push(Layer::Plate(Plate { groups, parts, nanoseconds, held: Arc::default() }));
        predicted.interpolation += error;
        predicted.cut += cut;
        predicted.rounding += rounding;
        predicted.storage += 2.0 * STORED;
        let costs: Vec<Cost> =
            vec![cost::estimate(&layers, plan.precision, self.problem.frame(), &self.asked.cost_model)];
        let (problem, tolerance) = (self.problem.clone(), self.asked.tolerance);
        Plan { problem, tolerance, layers, predicted, costs, ..plan }
    }
}

/// The plan of some of the images, with these as all are numbered.
fn renumbered(plan: Plan, members: &[usize]) -> Plan {
    plan.with_groups(|group| {
        if matches!(group.transform, Transform::Photo(_)) {
            group.members = Arc::new(group.members.iter().map(|member| members[*member as usize] as u32).collect());
        }
    })
}
