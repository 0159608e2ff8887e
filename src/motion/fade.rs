//! How much of a light is in the picture, and lights drawn as lamps.

use glam::DVec2;
use libm::erf;

use crate::frame::{Frame, Window};
use crate::scene::Light;

/// A share below this is none: less than a picture shows of any light.
pub const LEAST_SHARE: f64 = 1e-6;

/// The least width of the bell by which a light fades at the picture's edge, in half its shorter side, and in pixels: a
/// light that is smaller would go out from one frame to the next.
const FADES_WITHIN: f64 = 0.03;
const FADES_WITHIN_PIXELS: f64 = 2.0;

/// A lamp is drawn no sharper than this, in pixels, so that it glides from pixel to pixel.
const SHARPEST: f64 = 0.5;
/// Where a lamp's bell is left out, in its widths: a billionth of its peak.
const ENDS: f64 = 6.5;

/// Where lights fade, and where lamps are drawn.
#[derive(Debug, Clone, Copy)]
pub struct Sheet {
    frame: Frame,
    low: DVec2,
    high: DVec2,
    /// The least width of the bell by which lights fade.
    least: f64,
}

impl Sheet {
    /// Of a picture, with lengths in a look's unit: it ends where the picture ends, or what is stored beyond it.
    pub fn new(frame: Frame) -> Self {
        let half = 0.5 * frame.pixel_sides();
        let (low, high) = frame.bounds();
        let edge = DVec2::new(frame.half_width(), frame.half_height());
        let short = edge.min_element();
        let least = (FADES_WITHIN * short).max(FADES_WITHIN_PIXELS * frame.pixel_sides().max_element());
        Self { frame, low: (low - half).min(-edge), high: (high + half).max(edge), least }
    }

    /// How much of a light is in the picture, 0 to 1: the part of a Gaussian bell there, of the light's size and no less than
    /// is fit for fading. It is smooth in the light's place and 1 to all that a picture shows well within.
    pub fn share(&self, light: &Light) -> f64 {
        let width = light.size.max(self.least);
        let [x, y] = [0, 1].map(|axis| {
            let within = |edge: f64| (edge - light.position[axis]) / width;
            normal(within(self.low[axis]), within(self.high[axis]))
        });
        let share = x * y;
        if share < LEAST_SHARE { 0.0 } else { share }
    }
}

/// The part of a Gaussian bell of width 1 that lies between two places; with what is small far out kept exact.
fn normal(from: f64, to: f64) -> f64 {
    let half = std::f64::consts::FRAC_1_SQRT_2;
    // Both on one side: of the tails, which erf would round away.
    if from > 0.0 {
        return 0.5 * (libm::erfc(from * half) - libm::erfc(to * half));
    }
    if to < 0.0 {
        return 0.5 * (libm::erfc(-to * half) - libm::erfc(-from * half));
    }
    0.5 * (erf(to * half) - erf(from * half))
}

/// Lights as they are seen, on black.
#[derive(Debug, Clone)]
pub struct Lamps {
    /// Row by row from the top; alpha is 1.
    pub pixels: Vec<[f32; 4]>,
    /// Whether any of it is not black.
    pub lit: bool,
}

impl Lamps {
    /// Draws lights as Gaussian bells of their size and flux, each pixel with its mean over the pixel.
    pub fn draw(sheet: &Sheet, lights: &[Light]) -> Self {
        let window = sheet.frame.window;
        let mut lamps = Self { pixels: vec![[0.0, 0.0, 0.0, 1.0]; window.pixels()], lit: false };
        lights.iter().filter(|light| light.flux != [0.0; 3]).for_each(|light| lamps.add(&sheet.frame, light));
        lamps
    }

    fn add(&mut self, frame: &Frame, light: &Light) {
        let sides = frame.pixel_sides();
        let width = sides.map(|side| light.size.hypot(SHARPEST * side));
        let at = frame.pixel(light.position);
        let reach = ENDS * width / sides;
        let Window { x, y, width: columns, height: rows } = frame.window;
        let columns = cut(at.x - reach.x, at.x + reach.x, x, columns);
        let rows = cut(at.y - reach.y, at.y + reach.y, y, rows);
        // The share of each column, and of each row, per side of a pixel.
        let part = |places: &std::ops::Range<i32>, axis: usize| -> Vec<f64> {
            let scale = sides[axis] / width[axis];
            let of = |place| {
                let offset = f64::from(place) - at[axis];
                normal((offset - 0.5) * scale, (offset + 0.5) * scale) / sides[axis]
            };
            places.clone().map(of).collect()
        };
        let (across, down) = (part(&columns, 0), part(&rows, 1));
        for (row, down) in rows.zip(&down) {
            let start = (row - y) as usize * frame.window.width as usize;
            for (column, across) in columns.clone().zip(&across) {
                let pixel = &mut self.pixels[start + (column - x) as usize];
                for (value, flux) in pixel.iter_mut().zip(light.flux) {
                    *value += (flux * across * down) as f32;
                }
                self.lit = true;
            }
        }
    }
}

/// The whole places from one to another, of those that are stored.
fn cut(from: f64, to: f64, first: i32, count: u32) -> std::ops::Range<i32> {
    let end = i64::from(first) + i64::from(count);
    // Casts of floats stop at the ends of their range.
    let low = (from.floor() as i64).clamp(i64::from(first), end);
    let high = (to.ceil() as i64).saturating_add(1).clamp(low, end);
    low as i32..high as i32
}

#[cfg(test)]
mod tests {
    use super::*;

    fn light(x: f64, y: f64, size: f64) -> Light {
        Light { position: DVec2::new(x, y), flux: [6.0, 3.0, 0.0], size, muted: false }
    }

    fn sheet() -> Sheet {
        Sheet::new(Frame::full(160, 90))
    }

    #[test]
    fn a_light_fades_by_its_share_within() {
        let (sheet, edge) = (sheet(), 160.0 / 90.0);
        assert_eq!(sheet.share(&light(0.3, -0.2, 0.01)), 1.0);
        assert!((sheet.share(&light(edge, 0.0, 0.01)) - 0.5).abs() < 1e-12);
        assert!((sheet.share(&light(edge, 1.0, 0.01)) - 0.25).abs() < 1e-12);
        assert_eq!(sheet.share(&light(2.5, 0.0, 0.01)), 0.0);
        // Evenly over its own size: 16 % of a bell of 0.2 are beyond one width.
        assert!((sheet.share(&light(edge - 0.2, 0.0, 0.2)) - 0.8413).abs() < 1e-4);
        let mut before = 1.0;
        for step in 0..=500 {
            let share = sheet.share(&light(edge - 0.2 + f64::from(step) * 1e-3, 0.0, 0.0));
            // Of a bell of two pixels, 0.0444: no more than 0.4 / 0.0444 a unit.
            assert!(share <= before && before - share < 0.4 / 0.044 * 1e-3, "step {step}: {share} after {before}");
            before = share;
        }
        assert_eq!(before, 0.0);
    }

    #[test]
    fn a_lamp_has_its_flux_wherever_it_is_and_whatever_its_size() {
        let area = Frame::full(160, 90).pixel_size().powi(2);
        for (x, y, size) in [(0.0, 0.0, 0.0), (0.3017, -0.2503, 0.0), (0.01, 0.02, 0.05), (-1.0, 0.4, 0.01)] {
            let lamps = Lamps::draw(&sheet(), &[light(x, y, size)]);
            for (colour, flux) in [6.0, 3.0, 0.0].into_iter().enumerate() {
                let sum: f64 = lamps.pixels.iter().map(|pixel| f64::from(pixel[colour])).sum();
                assert!((sum * area - flux).abs() < 1e-5, "{x}, {y}, {size}: {}", sum * area);
            }
        }
    }

    #[test]
    fn a_lamp_is_where_its_light_is_and_ends_with_the_picture() {
        let frame = Frame::full(160, 90);
        let lamps = Lamps::draw(&sheet(), &[light(frame.x(40.0), frame.y(20.0), 0.0)]);
        let brightest = (0..lamps.pixels.len()).max_by(|&a, &b| lamps.pixels[a][0].total_cmp(&lamps.pixels[b][0]));
        assert_eq!(brightest, Some(20 * 160 + 40));
        for far in [light(9.0, 0.0, 0.1), light(0.0, -1e30, 0.0), light(-1e9, 1e9, 0.3)] {
            assert!(!Lamps::draw(&sheet(), &[far]).lit);
        }
    }

    #[test]
    fn what_is_stored_beyond_the_picture_counts() {
        let window = Window { x: -10, y: 0, width: 180, height: 90 };
        let wide = Sheet::new(Frame::full(160, 90).with_window(window));
        assert!((wide.share(&light(160.0 / 90.0, 0.0, 0.01)) - 1.0).abs() < 1e-6);
        let narrow = Sheet::new(Frame::full(160, 90).with_window(Window { x: 40, y: 0, width: 20, height: 90 }));
        assert_eq!(narrow.share(&light(1.0, 0.0, 0.01)), 1.0);
    }
}
