//! What the plots show.

use egui::{Color32, ColorImage};

use crate::Result;
use crate::choices::Evaluator;
use crate::false_colour::Map;
use crate::frame::Frame;
use crate::plan::{self, HIGHEST_DEGREE, Plan, Request};
use crate::problem::Problem;
use crate::renderer::Field;

/// The most points of a cut.
const POINTS: u32 = 384;
/// How many decades below its largest term a spectrum's colours span.
pub const SPECTRUM_DECADES: f64 = 8.0;

/// Where the picture is cut: along a row or a column of pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cut {
    /// Along a row.
    pub horizontal: bool,
    /// Where, from 0 at the top or left to 1.
    pub at: f64,
}

/// A point of a cut.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CutPoint {
    /// The pixel, column and row of the picture.
    pub pixel: [i32; 2],
    /// x of a horizontal cut, y of a vertical one, in half picture heights.
    pub along: f64,
    /// The field as it was rendered, RGB.
    pub rendered: [f64; 3],
    /// The direct sum in f64.
    pub exact: [f64; 3],
}

/// A predicted error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Degree {
    /// The highest harmonic, that of x and of y.
    pub degree: u32,
    /// What truncation costs at most.
    pub truncation: f64,
    /// What all sources cost together, at most.
    pub total: f64,
}

/// The field along a cut.
pub(super) struct Section {
    horizontal: bool,
    frame: Frame,
    pixels: Vec<[i32; 2]>,
    rendered: Vec<[f64; 3]>,
}

impl Section {
    pub fn take(field: &mut Field, cut: Cut, frame: Frame) -> Result<Self> {
        let window = frame.window;
        let (length, across) =
            if cut.horizontal { (window.width, window.height) } else { (window.height, window.width) };
        let line = (cut.at.clamp(0.0, 1.0) * f64::from(across)).min(f64::from(across - 1)) as i32;
        let count = length.min(POINTS);
        let pixel = |k: u32| {
            let along = (u64::from(k) * u64::from(length) / u64::from(count)) as i32;
            let [i, j] = if cut.horizontal { [along, line] } else { [line, along] };
            [window.x + i, window.y + j]
        };
        let pixels: Vec<_> = (0..count).map(pixel).collect();
        let rendered = field.probe(frame, &pixels)?;
        Ok(Self { horizontal: cut.horizontal, frame, pixels, rendered })
    }

    pub fn beside_truth(&self, problem: &Problem) -> Vec<CutPoint> {
        let exact = problem.on(self.frame).truth(&self.pixels);
        let places = self.pixels.iter().map(|&[i, j]| self.frame.position(f64::from(i), f64::from(j)));
        let along = places.map(|place| if self.horizontal { place.x } else { place.y });
        let values = self.pixels.iter().zip(&self.rendered).zip(exact);
        along
            .zip(values)
            .map(|(along, ((&pixel, &rendered), exact))| CutPoint { pixel, along, rendered, exact })
            .collect()
    }
}

/// The error that the series in the plan's period is predicted to have, for degrees about the plan's.
pub(super) fn convergence(plan: &Plan) -> Vec<Degree> {
    const STEPS: u32 = 12;
    let series = plan.evaluator().is_series();
    let around = if series { plan.degree()[0].max(plan.degree()[1]).max(8) } else { 64 };
    let most = (around + around / 2).min(HIGHEST_DEGREE);
    let request = Request {
        period: series.then_some(plan.period()),
        evaluator: Some(Evaluator::Rows),
        ..Request::new(plan.tolerance)
    };
    let predict = |step: u32| {
        let degree = (most * step).div_ceil(STEPS);
        let planned = plan::plan(plan.problem(), &Request { degree: Some([degree; 2]), ..request }).ok()?;
        Some(Degree { degree, truncation: planned.predicted.truncation, total: planned.predicted.total() })
    };
    (1..=STEPS).filter_map(predict).collect()
}

/// |A|, |B|, |C| and |D|, the largest of the three colours, on a logarithmic scale: harmonics of x from the left, of y from
/// the bottom. What the plan does not keep is clear.
pub(super) fn spectrum_images(terms: &[[f32; 4]], counts: &[u32]) -> [ColorImage; 4] {
    let magnitude = |mode: usize, table: usize| {
        let colours = terms.get(3 * mode..3 * mode + 3).unwrap_or_default();
        colours.iter().fold(0.0, |most: f32, term| most.max(term[table].abs()))
    };
    let largest = terms.as_flattened().iter().fold(f32::MIN_POSITIVE, |most, term| most.max(term.abs()));
    let (width, height) = (counts.len().max(1), counts.iter().max().map_or(1, |&most| most.max(1) as usize));
    [0, 1, 2, 3].map(|table| {
        let mut image = ColorImage::filled([width, height], Color32::TRANSPARENT);
        let mut mode = 0;
        for (n, &count) in counts.iter().enumerate() {
            for m in 0..count as usize {
                let part = f64::from(magnitude(mode, table)) / f64::from(largest);
                let [r, g, b] = Map::Inferno.colour(1.0 + part.max(f64::MIN_POSITIVE).log10() / SPECTRUM_DECADES);
                image[(n, height - 1 - m)] = Color32::from_rgb(r, g, b);
                mode += 1;
            }
        }
        image
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_spectrum_has_its_zeroth_term_bottom_left_and_is_clear_where_nothing_is_kept() {
        let mut terms = vec![[0.0f32; 4]; 9];
        (terms[1][0], terms[6][0]) = (2.0, 2.0);
        let [a, b, ..] = spectrum_images(&terms, &[2, 1]);
        let brightest = Map::Inferno.colour(1.0);
        let brightest = Color32::from_rgb(brightest[0], brightest[1], brightest[2]);
        assert_eq!((a.size, a[(0, 1)], a[(1, 1)], a[(1, 0)]), ([2, 2], brightest, brightest, Color32::TRANSPARENT));
        assert!(b.pixels.iter().all(|&pixel| pixel != brightest));
    }
}
