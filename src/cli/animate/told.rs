//! What is known of how a part of a frame was computed, once its pixels have been handed on.

use std::sync::Arc;

use glam::DVec2;
use serde::Serialize;

use crate::gpu::Info;
use crate::job::{Done, VeilError};
use crate::plan::{Evaluator, Plan};

/// How the ghosts of a part, or of a frame, were computed.
#[derive(Debug, Clone, Serialize)]
pub struct PlanTold {
    pub evaluator: Evaluator,
    pub period: DVec2,
    pub degree: [u32; 2],
    pub terms: usize,
    pub ghosts: usize,
    pub dropped: usize,
    pub tolerance: f64,
    pub predicted_ms: Option<f64>,
}

/// How exact ghosts are, relative to the largest glare of the same colour.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct ErrorTold {
    pub asked: f64,
    pub predicted: f64,
    pub measured: f64,
    /// At how many pixels.
    pub pixels: usize,
}

/// How a part was computed.
#[derive(Debug, Clone, Default)]
pub struct Told {
    pub plan: Option<PlanTold>,
    pub error: Option<ErrorTold>,
    /// The largest glare, RGB: what the error is relative to.
    pub scale: [f64; 3],
    pub veil: Option<VeilError>,
    pub milliseconds: f64,
    pub stages: Vec<(&'static str, f64)>,
    pub info: Option<Arc<Info>>,
    pub notes: Vec<String>,
}

impl From<&Plan> for PlanTold {
    fn from(plan: &Plan) -> Self {
        Self {
            evaluator: plan.evaluator(),
            period: plan.period(),
            degree: plan.degree(),
            terms: plan.terms(),
            ghosts: plan.ghosts(),
            dropped: plan.dropped,
            tolerance: plan.tolerance,
            predicted_ms: plan.cost(),
        }
    }
}

impl Told {
    /// What a job tells.
    pub fn of(done: &Done<'_>) -> Self {
        let computed = done.computed.as_ref();
        let notes = computed.iter().flat_map(|computed| &computed.planning.notes);
        Self {
            plan: computed.map(|computed| PlanTold::from(&computed.planning.plan)),
            error: computed.map(|computed| ErrorTold {
                asked: computed.certificate.asked,
                predicted: computed.certificate.predicted,
                measured: computed.certificate.measured,
                pixels: computed.certificate.pixels,
            }),
            scale: computed.map_or([0.0; 3], |computed| computed.planning.plan.scale),
            veil: done.veiled.as_ref().map(|veiled| veiled.error),
            milliseconds: done.stages.0.iter().map(|(_, milliseconds)| milliseconds).sum(),
            stages: done.stages.0.clone(),
            info: computed.map(|computed| computed.info.clone()),
            notes: notes.chain(done.veiled.iter().flat_map(|veiled| &veiled.notes)).cloned().collect(),
        }
    }
}

/// How exact the ghosts of all parts are together: their errors at most add up, and the largest glare of all is no less
/// than that of any part.
pub fn together(parts: &[&Told], asked: f64) -> Option<ErrorTold> {
    let errors: Vec<(ErrorTold, [f64; 3])> = parts.iter().filter_map(|told| Some((told.error?, told.scale))).collect();
    if let [(error, _)] = errors[..] {
        return Some(ErrorTold { asked, ..error });
    }
    let largest: [f64; 3] = std::array::from_fn(|k| errors.iter().fold(0.0, |most, (_, scale)| scale[k].max(most)));
    let sum = |of: fn(&ErrorTold) -> f64| {
        let colour = |k: usize| errors.iter().map(|(error, scale)| of(error) * scale[k] / largest[k]).sum::<f64>();
        // A NaN stays one.
        (0..3).filter(|&k| largest[k] > 0.0).map(colour).fold(0.0, |most, x| if x <= most { most } else { x })
    };
    let (predicted, measured) = (sum(|error| error.predicted), sum(|error| error.measured));
    let pixels = errors.iter().map(|(error, _)| error.pixels).min()?;
    Some(ErrorTold { asked, predicted, measured, pixels })
}

/// The worst of the parts' veils: each is held to its own brightness at every pixel, and so is their sum.
pub fn veils(parts: &[&Told]) -> Option<VeilError> {
    parts.iter().filter_map(|told| told.veil).reduce(|one, other| VeilError {
        asked: one.asked.max(other.asked),
        predicted: one.predicted.max(other.predicted),
        measured: if one.measured <= other.measured { other.measured } else { one.measured },
        pixels: one.pixels.min(other.pixels),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn part(measured: f64, scale: f64) -> Told {
        let error = Some(ErrorTold { asked: 1e-3, predicted: 2.0 * measured, measured, pixels: 9 });
        Told { error, scale: [scale, scale, 0.0], ..Told::default() }
    }

    #[test]
    fn errors_add_up_by_the_light_they_are_of() {
        let (bright, faint, none) = (part(2e-4, 4.0), part(4e-4, 1.0), Told::default());
        let error = together(&[&bright, &faint, &none], 1e-3).unwrap();
        assert!((error.measured - 3e-4).abs() < 1e-12 && (error.predicted - 6e-4).abs() < 1e-12);
        assert!((together(&[&faint], 1e-3).unwrap().measured - 4e-4).abs() < 1e-12);
        assert!(together(&[&none], 1e-3).is_none());
        assert!(together(&[&bright, &part(f64::NAN, 1.0)], 1e-3).unwrap().measured.is_nan());
    }
}
