//! Pictures of a few points of the front: where the field is off, and what the composite looks like.

use image::imageops::{FilterType, resize};
use image::{Rgb, RgbImage};
use rayon::prelude::*;

use super::Watch;
use super::front::choice;
use super::point::Point;
use super::sample::{Pictured, composite, pictured};
use super::study::{Study, at_most};
use crate::Result;
use crate::chart::{Axis, Map, Scalar};
use crate::frame::{Frame, Window};
use crate::photo::{Photo, Shown};
use crate::plan::{Request, plan};
use crate::reference;
use crate::renderer::Settings;
use palette::color_difference::Ciede2000 as _;

/// Pixels of a map, and bells that the direct sum may evaluate for it.
const MAP_PIXELS: f64 = 3e5;
const EFFORT: f64 = 1.5e8;
/// A crop's sides in pixels, and how much it is enlarged.
const CROP: [u32; 2] = [132, 88];
const ENLARGED: u32 = 3;
/// What the maps' colours begin and end at: powers of ten of the error.
const RANGE: [f64; 2] = [-7.0, -1.0];

/// The pictures.
#[derive(Default)]
pub(super) struct Looks {
    /// The whole picture with its exact glare, and a frame where the crops are.
    pub overview: Option<RgbImage>,
    /// The crop without glare, and with the exact one.
    pub bare: Option<RgbImage>,
    pub exact: Option<RgbImage>,
    pub shown: Vec<Look>,
}

/// One point's pictures.
pub(super) struct Look {
    pub point: Point,
    /// False colours of the error.
    pub map: RgbImage,
    pub crop: RgbImage,
    /// The largest ΔE2000 within the crop, and in the whole picture.
    pub delta_e: f64,
    pub delta_e_whole: f64,
}

impl Looks {
    /// The largest ΔE2000 that was seen in pictures of a point; none where none was drawn.
    pub fn delta_e(&self, point: &Point) -> Option<f64> {
        let same = |look: &&Look| look.point.asked == point.asked && look.point.evaluator == point.evaluator;
        self.shown.iter().find(same).map(|look| look.delta_e_whole)
    }
}

fn largest(values: &[f64]) -> f64 {
    values.iter().copied().fold(0.0, f64::max)
}

/// A photo with its exact glare, as it is shown.
struct Truth {
    photo: Photo,
    exact: Vec<[f64; 3]>,
    shown: Vec<Pictured>,
}

impl Truth {
    /// Of the photo, or of a window of it.
    fn new(study: &Study<'_>, photo: Photo) -> Self {
        let frame = photo.frame;
        let Window { x, y, width, height } = frame.window;
        let at = |k: u32| frame.position(f64::from(x) + f64::from(k % width), f64::from(y) + f64::from(k / width));
        let points: Vec<_> = (0..width * height).map(at).collect();
        let exact = reference::direct_at(study.subject.ghosts, &points);
        let mut truth = Self { photo, exact, shown: Vec::new() };
        truth.shown = truth.with(&truth.exact);
        truth
    }

    /// The picture with a field.
    fn with(&self, field: &[[f64; 3]]) -> Vec<Pictured> {
        let shown = Shown::of(&self.photo);
        let pixels = self.photo.pixels.par_iter().zip(field);
        pixels.map(|(&[r, g, b, _], &field)| pictured(shown, composite([r, g, b], field))).collect()
    }

    /// ΔE2000 of each pixel between the exact picture and another.
    fn delta_e(&self, other: &[Pictured]) -> Vec<f64> {
        self.shown.iter().zip(other).map(|(a, b)| f64::from(a.lab.difference(b.lab))).collect()
    }

    fn picture(&self, pixels: &[Pictured]) -> RgbImage {
        let Window { width, height, .. } = self.photo.frame.window;
        RgbImage::from_fn(width, height, |i, j| {
            Rgb(pixels[(j * width + i) as usize].code.map(|code| (255.0 * code).round() as u8))
        })
    }
}

/// Draws a few points of the front: the fastest, the one that is recommended, the most exact.
///
/// # Errors
/// [`crate::Error::Gl`] where the driver refuses, [`crate::Error::Chart`] where a map cannot be drawn.
pub(super) fn looks(study: &mut Study<'_>, points: &[Point], front: &[usize], watch: Watch<'_>) -> Result<Looks> {
    let picked = picked(points, front);
    let Some(&coarsest) = picked.first() else { return Ok(Looks::default()) };
    let most = MAP_PIXELS.min(EFFORT / study.subject.ghosts.len() as f64);
    let small = Truth::new(study, at_most(study.subject.photo, most));
    watch(0.2);

    let rough = field(study, coarsest, small.photo.frame)?;
    let delta_e = small.delta_e(&small.with(&rough));
    let window = crop_window(study.photo.frame, small.photo.frame, &delta_e);
    let crop = Truth::new(study, cropped(&study.photo, window));
    let enlarged = |picture: RgbImage| {
        resize(&picture, ENLARGED * picture.width(), ENLARGED * picture.height(), FilterType::Nearest)
    };
    let mut looks = Looks {
        overview: Some(framed(&small, window, study.photo.frame)),
        bare: Some(enlarged(crop.picture(&crop.with(&vec![[0.0; 3]; crop.exact.len()])))),
        exact: Some(enlarged(crop.picture(&crop.shown))),
        shown: Vec::new(),
    };
    for (done, &point) in picked.iter().enumerate() {
        let whole = field(study, point, small.photo.frame)?;
        // The tolerance counts relative to the whole picture's largest value: a plan for the crop alone would be finer.
        let near = field(study, point, study.photo.frame)?;
        let seen = crop.with(&cut(&near, study.photo.width(), window));
        looks.shown.push(Look {
            point: point.clone(),
            map: map(&small, &whole)?,
            crop: enlarged(crop.picture(&seen)),
            delta_e: largest(&crop.delta_e(&seen)),
            delta_e_whole: largest(&small.delta_e(&small.with(&whole))).max(largest(&crop.delta_e(&seen))),
        });
        watch(0.3 + 0.7 * (done + 1) as f64 / picked.len() as f64);
    }
    Ok(looks)
}

/// The fastest point of the front, the middle and the most exact one, and the one that is recommended.
fn picked<'a>(points: &'a [Point], front: &[usize]) -> Vec<&'a Point> {
    let Some(last) = front.len().checked_sub(1) else { return Vec::new() };
    let mut picked: Vec<&Point> = [0, last.div_ceil(2), last].iter().map(|&k| &points[front[k]]).collect();
    picked.extend(choice(points));
    picked.sort_by(|a, b| b.measured.unwrap_or(0.0).total_cmp(&a.measured.unwrap_or(0.0)));
    picked.dedup_by(|a, b| a.asked == b.asked && a.evaluator == b.evaluator);
    picked
}

/// The field of a point's request at all pixels of a frame's window, in the photo's light.
fn field(study: &mut Study<'_>, point: &Point, frame: Frame) -> Result<Vec<[f64; 3]>> {
    let request = Request { evaluator: point.evaluator, ..study.bench.request(point.asked.unwrap_or(1e-3)) };
    let plan = plan(&study.problem.on(frame), &request)?;
    study.bench.renderer.field.set_scene(&plan)?;
    let glare = study.bench.renderer.glare(frame, &Settings::default())?;
    Ok(glare.into_iter().map(|[r, g, b, _]| [r, g, b].map(f64::from)).collect())
}

/// The error relative to the field's largest value, the worst colour, as powers of ten.
fn map(truth: &Truth, field: &[[f64; 3]]) -> Result<RgbImage> {
    let largest = [0, 1, 2].map(|c| truth.exact.iter().map(|exact| exact[c].abs()).fold(f64::MIN_POSITIVE, f64::max));
    let errors = truth.exact.iter().zip(field).map(|(exact, field)| {
        let worst = (0..3).map(|c| (field[c] - exact[c]).abs() / largest[c]).fold(0.0, f64::max);
        worst.log10().clamp(RANGE[0], RANGE[1])
    });
    let frame = truth.photo.frame;
    let scalar = Scalar { width: frame.width, height: frame.height, values: errors.collect() };
    let (low, high) = frame.bounds();
    let axis = |label: &str, low, high| Axis { label: label.into(), range: Some([low, high]), log: false };
    let value = axis("log10 of the error", RANGE[0], RANGE[1]);
    let axes = [axis("x, half picture heights", low.x, high.x), axis("y", low.y, high.y)];
    scalar.chart("", axes, value, Map::Inferno, 560).picture()
}

/// A window of the frame around the place where the picture differs most.
fn crop_window(frame: Frame, small: Frame, delta_e: &[f64]) -> Window {
    let (worst, _) = delta_e.iter().enumerate().fold((0, -1.0), |w, (k, &d)| if d > w.1 { (k, d) } else { w });
    let at = [worst as u32 % small.width, worst as u32 / small.width].map(f64::from);
    let pixel = frame.pixel(small.position(at[0], at[1]));
    let sides = [CROP[0].min(frame.width), CROP[1].min(frame.height)];
    let start = |center: f64, side: u32, whole: u32| {
        (center - 0.5 * f64::from(side)).round().clamp(0.0, f64::from(whole - side)) as i32
    };
    Window {
        x: start(pixel.x, sides[0], frame.width),
        y: start(pixel.y, sides[1], frame.height),
        width: sides[0],
        height: sides[1],
    }
}

fn cropped(photo: &Photo, window: Window) -> Photo {
    let pixels = cut(&photo.pixels, photo.width(), window);
    Photo { frame: photo.frame.with_window(window), pixels, source: photo.source.clone() }
}

/// A window of a whole picture that is `width` pixels wide.
fn cut<T: Copy>(pixels: &[T], width: u32, window: Window) -> Vec<T> {
    let row = |y: u32| {
        let from = (window.y as u32 + y) as usize * width as usize + window.x as usize;
        &pixels[from..from + window.width as usize]
    };
    (0..window.height).flat_map(row).copied().collect()
}

/// The whole picture with a line around the window.
fn framed(truth: &Truth, window: Window, frame: Frame) -> RgbImage {
    let mut picture = truth.picture(&truth.shown);
    let scale = f64::from(picture.width()) / f64::from(frame.width);
    let along = |start: i32, side: u32, most: u32| {
        let end = f64::from(start) + f64::from(side);
        [f64::from(start), end].map(|place| ((place * scale) as u32).min(most - 1))
    };
    let [left, right] = along(window.x, window.width, picture.width());
    let [top, bottom] = along(window.y, window.height, picture.height());
    for (i, j) in
        (left..=right).flat_map(|i| [(i, top), (i, bottom)]).chain((top..=bottom).flat_map(|j| [(left, j), (right, j)]))
    {
        picture.put_pixel(i, j, Rgb([255, 255, 255]));
    }
    picture
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_crop_stays_in_the_picture_and_goes_where_it_differs_most() {
        let (frame, small) = (Frame::full(600, 400), Frame::full(60, 40));
        let mut delta_e = vec![0.0; 2400];
        let mut worst_at = |i: usize, j: usize| {
            delta_e.fill(0.1);
            delta_e[j * 60 + i] = 2.0;
            crop_window(frame, small, &delta_e)
        };
        assert_eq!(worst_at(0, 0), Window { x: 0, y: 0, width: 132, height: 88 });
        assert_eq!(worst_at(59, 39), Window { x: 468, y: 312, width: 132, height: 88 });
        let middle = worst_at(30, 20);
        assert!((middle.x - 239).abs() < 3 && (middle.y - 161).abs() < 3, "{middle:?}");
        assert_eq!(crop_window(Frame::full(20, 10), Frame::full(20, 10), &[0.0; 200]).width, 20);
    }
}
