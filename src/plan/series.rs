//! The series of a plan: period, kept terms, and the lattice where there is one.

use glam::DVec2;

use super::amplitudes::{self, Amplitudes};
use super::bands::{self, Band, bands};
use super::candidate::{NEEDED, Survey};
use super::decay::{self, Decay};
use super::lattice::{self, Marginals};
use super::rounding::Strength;
use super::{
    Evaluator, Group, Lattice, Layer, Modes, Precision, Prediction, Request, Series, Transform, check, cost, gather,
    images, period, rounding, share, terms,
};
use crate::frame::Frame;
use crate::problem::Problem;
use crate::series::Modes as Bells;
use crate::{Error, Result};

/// What of the tolerance may lie beyond the modes of [`Wide`].
pub(super) const BEYOND: f64 = 0.02;

/// A period that serves every evaluator, and more modes than any of them needs, each with what it adds to the field.
pub(super) struct Wide {
    period: DVec2,
    periodisation: f64,
    groups: Vec<Group>,
    amplitudes: Amplitudes,
    /// A bound of what lies beyond the modes.
    beyond: f64,
    /// What gathering ghosts left out.
    gathering: f64,
    /// Whether there is nothing to choose among the modes: they were given, for images of the photo.
    given: bool,
}

impl Wide {
    /// None where looking at every ghost's phases takes too long, or where the series is given.
    pub fn new(problem: &Problem, survey: &Survey, request: &Request) -> Option<Self> {
        let images = problem.images();
        let given = request.degree.is_some() || request.evaluator.is_some_and(|evaluator| !evaluator.is_series());
        if given && images.is_none() || !amplitudes::worth_a_try(&survey.groups) {
            return None;
        }
        survey.prepare().ok()?;
        let rounding = rounding::bound(&survey.weighed, Evaluator::Grid, rounding::SEEN_DEGREE);
        let usable = (request.tolerance - rounding).max(0.25 * request.tolerance);
        if images.is_some() && request.degree.is_none() && request.period.is_none() {
            return Self::in_bands(problem, survey, request, usable);
        }
        let period = request.period.unwrap_or_else(|| period::shortest(&survey.reaches, usable * share::PERIODISATION));
        let mut groups = survey.groups.clone();
        let counts = match request.degree {
            Some(degree) => terms::rectangle(&mut groups, degree),
            None if images.is_some() => images::enough(&mut groups, period, usable, &survey.effort)?,
            None => terms::fewest(&mut groups, period, usable * BEYOND, &survey.effort).ok()?,
        };
        let mut gathering =
            gather::choose_in_doubles(&mut groups, period, share::GATHERING * request.tolerance, amplitudes::MODE);
        if let Some(images) = images {
            gathering += images::reduce(&mut groups, images, period, share::IMAGES * request.tolerance);
        }
        // By weights there may be no series at all.
        let needed = rounding > (1.0 - NEEDED) * request.tolerance;
        if !amplitudes::worth_looking(&groups, &counts, period, needed, &request.cost_model) {
            return None;
        }
        survey.effort.spend(amplitudes::work(&groups, &counts, period)).ok()?;
        let amplitudes = Amplitudes::new(problem, &groups, &counts, period, survey.weighed.scale);
        let beyond = terms::error(&groups, period, &counts);
        Some(Self {
            period,
            periodisation: period::error(&survey.reaches, period),
            groups,
            amplitudes,
            beyond,
            gathering,
            given,
        })
    }

    /// Of images, those that need longer periods than others folded into the period of the sharpest.
    fn in_bands(problem: &Problem, survey: &Survey, request: &Request, usable: f64) -> Option<Self> {
        // What folding may cost, of what may be used up.
        const FOLDED: f64 = 0.01;
        let (images, scale) = (problem.images()?, survey.weighed.scale);
        let mut bands = bands(problem, &survey.weighed, &survey.groups, usable * share::PERIODISATION);
        let part = 1.0 / bands.len().max(1) as f64;
        let mut kept: Vec<Vec<u32>> = Vec::new();
        for band in &mut bands {
            kept.push(images::enough(&mut band.groups, band.period, part * usable, &survey.effort)?);
        }
        let fastest = |(band, counts): &(&Band, &Vec<u32>)| counts.len() as f64 / band.period.x;
        let of = bands.iter().zip(&kept);
        let main = of.enumerate().max_by(|one, other| fastest(&one.1).total_cmp(&fastest(&other.1)))?.0;
        let mut gathering = 0.0;
        let (mut main, mut counts) = (bands.swap_remove(main), kept.swap_remove(main));
        gathering += gather::choose_in_doubles(
            &mut main.groups,
            main.period,
            share::GATHERING * request.tolerance,
            amplitudes::MODE,
        );
        gathering += images::reduce(&mut main.groups, images, main.period, part * share::IMAGES * request.tolerance);
        let mut periodisation = period::error(&main.reaches, main.period);
        let (mut beyond, mut folded, mut others) = (0.0, Vec::new(), Vec::new());
        for (band, counts) in bands.iter_mut().zip(&kept) {
            gathering +=
                images::reduce(&mut band.groups, images, band.period, part * share::IMAGES * request.tolerance);
            if !amplitudes::worth_looking(&band.groups, counts, band.period, true, &request.cost_model) {
                return None;
            }
            survey.effort.spend(amplitudes::work(&band.groups, counts, band.period)).ok()?;
            let modes = Amplitudes::new(problem, &band.groups, counts, band.period, scale);
            let budget = part * FOLDED * usable;
            let band_folded = bands::fold(modes.modes(), band.period, main.period, problem.frame(), budget);
            gathering += band_folded.error;
            periodisation += period::error(&band.reaches, band.period);
            beyond += terms::error(&band.groups, band.period, counts);
            let degree = band_folded.harmonics.map(|harmonics| harmonics as u32 - 1);
            others.extend(band.groups.iter().map(|group| Group { degree, ..group.clone() }));
            folded.push(band_folded);
        }
        let degree = |axis: usize| folded.iter().map(|folded| folded.harmonics[axis]).max().unwrap_or(1);
        let [columns, rows] = [0, 1].map(degree);
        counts.resize(counts.len().max(columns), 1);
        counts.iter_mut().take(columns).for_each(|count| *count = (*count).max(rows as u32));
        if !amplitudes::worth_looking(&main.groups, &counts, main.period, true, &request.cost_model) {
            return None;
        }
        survey.effort.spend(amplitudes::work(&main.groups, &counts, main.period)).ok()?;
        let amplitudes = Amplitudes::beside(problem, &main.groups, &counts, main.period, scale, &folded);
        beyond += terms::error(&main.groups, main.period, &counts);
        let groups = main.groups.into_iter().chain(others).collect();
        Some(Self { period: main.period, periodisation, groups, amplitudes, beyond, gathering, given: false })
    }

    /// The modes, and their period.
    pub fn modes(&self) -> (&Modes, DVec2) {
        (self.amplitudes.modes(), self.period)
    }

    /// What they are off by at most, as they were computed.
    pub fn error(&self) -> f64 {
        self.periodisation + self.beyond + self.gathering
    }

    /// What f32 costs with all of the modes.
    pub fn rounding(&self, evaluator: Evaluator) -> f64 {
        let counts = self.amplitudes.modes().counts();
        let degree = [counts.len() as u32 - 1, counts[0] - 1];
        let doubles = rounding::of_doubles(&self.groups, degree);
        let strength = Amplitudes::strength(&self.amplitudes.marginals(counts));
        rounding::of_modes(evaluator, &strength, degree) + doubles
    }

    /// Whether it leaves enough of what may be used up.
    fn fits(&self, request: &Request, usable: f64) -> bool {
        let period = request.period.is_some() || self.periodisation <= 1.5 * share::PERIODISATION * usable;
        period && self.beyond <= 2.0 * BEYOND * usable
    }

    /// The strongest of the modes, and what they hold.
    fn terms(&self, truncation: f64) -> Terms {
        let (counts, left) = match self.given {
            true => (self.amplitudes.modes().counts().to_vec(), 0.0),
            false => self.amplitudes.kept(truncation - self.beyond),
        };
        let mut groups = self.groups.clone();
        for group in &mut groups {
            let [n, m] = group.degree;
            group.degree = [n.min(counts.len() as u32 - 1), m.min(counts[0] - 1)];
        }
        let marginals = self.amplitudes.marginals(&counts);
        let (modes, strength) = (Some(self.amplitudes.modes().clone()), Some(Amplitudes::strength(&marginals)));
        let (marginals, gathering) = (Some(Marginals::of(marginals)), self.gathering);
        Terms { groups, modes, strength, marginals, truncation: self.beyond + left, counts, gathering }
    }
}

/// Kept modes, and what is known of them.
struct Terms {
    groups: Vec<Group>,
    counts: Vec<u32>,
    /// The modes themselves, where they were computed.
    modes: Option<Modes>,
    strength: Option<Strength>,
    /// What each harmonic holds, where it was looked at.
    marginals: Option<Marginals>,
    /// What is left out.
    truncation: f64,
    /// What gathering left out, where the modes were computed.
    gathering: f64,
}

/// What a series is planned from.
struct Brief<'a> {
    evaluator: Evaluator,
    precision: Precision,
    survey: &'a Survey,
    wide: Option<&'a Wide>,
    frame: Frame,
    request: &'a Request,
    period: DVec2,
    /// What is predicted without the terms.
    predicted: Prediction,
    /// What of the tolerance may be used up, and what of that the terms have to make up for.
    usable: f64,
    excess: f64,
}

/// Chooses period, terms and lattice within what may be used up, and adds what they cost to what is predicted.
///
/// # Errors
/// [`Error::Plan`] where there is no such series.
pub(super) fn plan_series(
    (evaluator, precision): (Evaluator, Precision),
    survey: &Survey,
    wide: Option<&Wide>,
    frame: Frame,
    request: &Request,
    predicted: Prediction,
    usable: f64,
) -> Result<(Series, Prediction)> {
    // A degree that is given needs no looking at what a bell's coefficients are.
    if let Some(group) = survey.groups.iter().find(|group| matches!(group.bell.shape().modes(), Bells::None)) {
        return Err(decay::no_series(&group.bell));
    }
    survey.prepare()?;
    // A photo's images are in the series that was looked at, or in none.
    let of_photo = survey.groups.iter().any(|group| matches!(group.transform, Transform::Photo(_)));
    let wide = wide.filter(|wide| of_photo || wide.fits(request, usable));
    if of_photo && wide.is_none() {
        return Err(images::too_many(&survey.groups));
    }
    let period = match (request.period, wide) {
        (Some(period), _) => period,
        (None, Some(wide)) => wide.period,
        (None, None) => period::shortest(&survey.reaches, usable * share::PERIODISATION),
    };
    let periodisation = wide.map_or_else(|| period::error(&survey.reaches, period), |w| w.periodisation);
    check::copies(period, periodisation)?;
    let predicted = Prediction { periodisation, ..predicted };
    let moments = wide.map_or(0.0, |wide| wide.gathering - share::GATHERING * request.tolerance);
    let excess = excess(&predicted, usable) + moments.max(0.0);
    let brief = Brief { evaluator, precision, survey, wide, frame, request, period, predicted, usable, excess };
    if evaluator != Evaluator::Grid {
        return brief.finish(brief.terms(share::TRUNCATION)?, None);
    }
    let [first, second] = share::GRID.map(|(truncation, interpolation)| brief.with_lattice(truncation, interpolation));
    let cost = |(series, _): &(Series, Prediction)| {
        cost::estimate(&[Layer::Series(series.clone())], Precision::default(), frame, &request.cost_model).milliseconds
    };
    match (first, second) {
        (Ok(first), Ok(second)) => Ok(if cost(&second) < cost(&first) { second } else { first }),
        (Ok(only), Err(_)) | (_, Ok(only)) => Ok(only),
        (Err(_), Err(refusal)) => Err(refusal),
    }
}

/// What is dropped and what copies add beyond their shares of what may be used up; the terms have to make up for it.
///
/// Ghosts are dropped by the tolerance, before anyone knows what rounding takes of it; a period that serves every
/// evaluator is no evaluator's own; and one that was given may be off by anything, which no number of terms mends.
fn excess(predicted: &Prediction, usable: f64) -> f64 {
    const MENDED: f64 = 0.1;
    let shares = share::DROPPED + share::PERIODISATION - share::GATHERING;
    // Nothing may be left at all, where the series is given.
    (predicted.dropped + predicted.periodisation - shares * usable).min(MENDED * usable).max(0.0)
}

impl Brief<'_> {
    /// Whether nothing of the series is left to plan, and its error comes as it comes.
    fn given(&self) -> bool {
        self.request.period.is_some() && self.request.degree.is_some()
    }

    /// The series with terms and a lattice, each within its part of what may be used up.
    fn with_lattice(&self, truncation: f64, interpolation: f64) -> Result<(Series, Prediction)> {
        let mut terms = self.terms(truncation)?;
        let degree = [terms.counts.len() as u32 - 1, terms.counts[0] - 1];
        let marginals = terms.marginals.take();
        if marginals.is_none() {
            self.survey
                .effort
                .spend(terms.groups.iter().map(|group| Decay::new(group, self.period).held_work(group)).sum())?;
        }
        let marginals = marginals.unwrap_or_else(|| Marginals::by_weights(&terms.groups, degree, self.period));
        // Where the series is given there may be nothing left: then a lattice is to cost a little of what rounding does.
        let budget = interpolation * self.usable.max(if self.given() { 0.1 * self.predicted.single() } else { 0.0 });
        let lattice =
            lattice::coarsest(self.precision, degree, self.period, &marginals, self.frame, budget, self.request)?;
        let on_cpu = self.precision == Precision::Single
            && cost::cpu_is_cheaper(&terms.counts, &lattice, self.period, &self.request.cost_model);
        self.finish(terms, Some(Lattice { on_cpu, ..lattice }))
    }

    /// The kept terms, within a part of what may be used up.
    fn terms(&self, part: f64) -> Result<Terms> {
        let truncation = self.usable * part - self.excess;
        let terms = match (self.request.degree, self.wide) {
            (None, Some(wide)) => wide.terms(truncation),
            (Some(_), Some(wide)) if wide.given => wide.terms(truncation),
            (degree, _) => {
                let mut groups = self.survey.groups.clone();
                let counts = match degree {
                    Some(degree) => terms::rectangle(&mut groups, degree),
                    None => terms::fewest(&mut groups, self.period, truncation, &self.survey.effort)?,
                };
                Terms {
                    groups,
                    counts,
                    modes: None,
                    strength: None,
                    marginals: None,
                    truncation: f64::NAN,
                    gathering: 0.0,
                }
            }
        };
        let count: usize = terms.counts.iter().map(|&count| count as usize).sum();
        let most = self.request.most_terms;
        // A term takes as much again in 64-bit floats.
        let most = if self.precision == Precision::Double { most / 2 } else { most };
        if count > most {
            return Err(Error::Plan(format!("the series would have {count} terms, and {most} fit on the device")));
        }
        if terms.marginals.is_some() {
            return Ok(terms);
        }
        Ok(Terms { truncation: terms::error(&terms.groups, self.period, &terms.counts), ..terms })
    }

    /// The series, with all that it adds to the error.
    fn finish(&self, terms: Terms, lattice: Option<Lattice>) -> Result<(Series, Prediction)> {
        let Terms { mut groups, counts, modes, strength, marginals: _, truncation, gathering } = terms;
        let interpolation = lattice.map_or(0.0, |lattice| lattice.error);
        let mut predicted = Prediction { truncation, interpolation, gathering, ..self.predicted };
        if self.precision == Precision::Single
            && let Some(strength) = strength
        {
            // What was planned with may have been a bound by weights.
            let degree = [counts.len() as u32 - 1, counts[0] - 1];
            let known = rounding::of_modes(self.evaluator, &strength, degree) + rounding::of_doubles(&groups, degree);
            predicted = predicted.with_single((known + self.survey.beside.rounding).min(predicted.single()));
        }
        let Request { tolerance, ref cost_model, .. } = *self.request;
        // In 64-bit floats every ghost meets every mode, but for what was gathered when the modes were looked at.
        if self.precision == Precision::Single
            && !groups.iter().any(|group| matches!(group.transform, Transform::Photo(_)))
        {
            predicted.gathering += gather::choose(&mut groups, self.period, tolerance, &predicted, cost_model);
        }
        let (evaluator, precision, period) = (self.evaluator, self.precision, self.period);
        Ok((Series { evaluator, precision, period, counts: counts.into(), groups, modes, lattice }, predicted))
    }
}
