//! What all sweeps share: the photo at the size they run at, its ghosts, the bench and the sample.

use std::rc::Rc;
use std::sync::Arc;

use image::imageops::{FilterType, resize};
use image::{ImageBuffer, Rgba};

use super::bench::{Arm, Bench};
use super::point::{Point, Sweep};
use super::sample::Sample;
use super::{Subject, Watch};
use crate::Result;
use crate::certificate::{Certificate, sample_pixels};
use crate::frame::Frame;
use crate::gpu::Device;
use crate::photo::Photo;
use crate::plan::{CostModel, Plan, Request, plan};
use crate::problem::Problem;

/// Pixels of the pictures that sweeps run at, at most: a quick look, and a thorough one.
const QUICK_PIXELS: f64 = 3e5;
const PIXELS: f64 = 2.1e6;

/// Bells that may be summed in f64 to measure an error at every pixel: some seconds.
const MOST_BELLS: usize = 500_000_000;

/// Tolerances that a period and a degree are taken from, the first that can be had: so that what a sweep varies is
/// what its errors come from.
const TIGHT: [f64; 6] = [1e-5, 3e-5, 1e-4, 1e-3, 1e-2, 1e-1];

pub(super) struct Study<'a> {
    pub subject: &'a Subject<'a>,
    pub quick: bool,
    /// The subject's ghosts on this photo.
    pub problem: Arc<Problem>,
    /// The whole picture, shrunk where it is too large for the sweeps.
    pub photo: Photo,
    pub bench: Bench,
    pub sample: Sample,
}

impl<'a> Study<'a> {
    /// # Errors
    /// [`crate::Error::Gl`] where the driver refuses.
    pub fn new(subject: &'a Subject<'a>, device: &Rc<Device>, cost_model: CostModel, quick: bool) -> Result<Self> {
        let photo = at_most(subject.photo, if quick { QUICK_PIXELS } else { PIXELS });
        let most = subject.photo.frame.window.pixels().max(photo.pixels.len());
        let most = most.max(subject.photo.width() as usize * subject.photo.height() as usize);
        let bench = Bench::new(device, cost_model, quick, most)?;
        // Any plan knows where the field is large; `direct` is there for every scene, but for a photo's images.
        let mut request = bench.request(0.5);
        if subject.images.is_none() {
            request.evaluator = Some(crate::plan::Evaluator::Direct);
            request.loop_rounds = usize::MAX;
        }
        let problem = subject.problem(photo.frame);
        let also = plan(&problem, &request).map_or_else(|_| Vec::new(), |plan| sample_pixels(&plan));
        let sample = Sample::new(&photo, &problem, also);
        Ok(Self { subject, quick, problem, photo, bench, sample })
    }

    pub fn frame(&self) -> Frame {
        self.photo.frame
    }

    pub fn request(&self, tolerance: f64) -> Request {
        self.bench.request(tolerance)
    }

    /// The photo's plan for the tightest tolerance that `asked` can have, and that tolerance.
    pub fn tightest(&self, asked: impl Fn(Request) -> Request) -> Option<(f64, Plan)> {
        TIGHT.iter().find_map(|&tolerance| {
            plan(&self.problem, &asked(self.request(tolerance))).ok().map(|plan| (tolerance, plan))
        })
    }

    /// The largest error at every pixel of a picture of this size, by the planner's own plan; none where the direct sum of
    /// all of them takes long.
    ///
    /// # Errors
    /// [`crate::Error::Gl`] where the driver refuses.
    pub fn everywhere(&mut self, tolerance: f64, [width, height]: [u32; 2]) -> Result<Option<f64>> {
        let problem = self.problem.on(self.subject.photo.frame.resized(width, height));
        if self.subject.ghosts().saturating_mul(problem.frame().window.pixels()) > MOST_BELLS {
            return Ok(None);
        }
        let Ok(plan) = plan(&problem, &self.request(tolerance)) else { return Ok(None) };
        Ok(Some(Certificate::measure_all(&mut self.bench.renderer.field, &plan, |_| ())?.measured))
    }

    /// Points of the photo's own ghosts: their quality at the sample, and their times.
    ///
    /// # Errors
    /// [`crate::Error::Gl`] where the driver refuses.
    pub fn measured(&mut self, sweep: Sweep, plans: &[(Option<f64>, Plan)], watch: Watch<'_>) -> Result<Vec<Point>> {
        let frame = self.frame();
        // One plan may do for many tolerances; it is timed once.
        let mut arms: Vec<Arm<'_>> = Vec::new();
        let mut indices = Vec::new();
        for (_, plan) in plans {
            let index = arms.iter().position(|arm| arm.plan == plan).unwrap_or_else(|| {
                arms.push(Arm { plan });
                arms.len() - 1
            });
            indices.push(index);
        }
        let timings = self.bench.time(&arms, watch)?;
        let mut points = Vec::new();
        for ((asked, plan), timing) in plans.iter().zip(indices.iter().map(|&index| &timings[index])) {
            self.bench.renderer.field.set_scene(plan)?;
            let field = self.bench.renderer.field.probe(frame, &self.sample.pixels)?;
            let quality = self.sample.judge(&field);
            points.push(Point::planned(sweep, frame, *asked, plan).with_quality(&quality).with_timing(timing));
        }
        Ok(points)
    }
}

/// The whole picture of a photo, shrunk to about `pixels` pixels where it has more. Pixels that are no number are black.
pub(super) fn at_most(photo: &Photo, pixels: f64) -> Photo {
    let (width, height) = (photo.width(), photo.height());
    let factor = (pixels / (f64::from(width) * f64::from(height))).sqrt().min(1.0);
    let sides = [width, height].map(|side| ((f64::from(side) * factor).round() as u32).max(1));
    let sound = |value: f32| if value.is_finite() { value } else { 0.0 };
    let rows = (0..height).flat_map(|row| photo.picture_row(row).iter().map(|p| p.map(sound)).collect::<Vec<_>>());
    let whole: Vec<[f32; 4]> = rows.collect();
    let pixels = if sides == [width, height] {
        whole
    } else {
        let flat = bytemuck::allocation::cast_vec(whole);
        let picture = ImageBuffer::<Rgba<f32>, _>::from_raw(width, height, flat).expect("as many pixels as it has");
        let small = resize(&picture, sides[0], sides[1], FilterType::Triangle);
        small.pixels().map(|pixel| pixel.0).collect()
    };
    let mut small = Photo::new(sides[0], sides[1], pixels);
    small.frame = small.frame.in_units_of(photo.frame.unit);
    small.source.primaries = photo.source.primaries;
    small.source.display_referred = photo.source.display_referred;
    small
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::Window;

    #[test]
    fn a_shrunk_photo_keeps_its_mean_and_its_aspect_and_loses_what_is_no_number() {
        let mut pixels = vec![[0.25, 0.5, 1.0, 1.0]; 200 * 100];
        pixels[5050][0] = f32::NAN;
        let small = at_most(&Photo::new(200, 100, pixels), 5000.0);
        assert_eq!((small.width(), small.height()), (100, 50));
        assert!(small.pixels.iter().all(|p| p[0] > 0.0 && p[0] < 0.251 && (p[1] - 0.5).abs() < 1e-5), "no NaN");
    }

    #[test]
    fn a_window_becomes_the_whole_picture() {
        let mut photo = Photo::new(2, 2, vec![[1.0; 4]; 4]);
        photo.frame = Frame::full(4, 3).with_window(Window { x: 1, y: 1, width: 2, height: 2 });
        let whole = at_most(&photo, 1e6);
        assert_eq!((whole.width(), whole.height(), whole.pixels.len()), (4, 3, 12));
        assert_eq!([whole.pixels[0][0], whole.pixels[5][0], whole.pixels[7][0]], [0.0, 1.0, 0.0]);
    }
}
