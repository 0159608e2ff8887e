//! The section of a lens along its axis, drawn to scale: glass, stop, sensor, bundles of rays, and the path of a ghost.

use super::bundle::{Bundles, Ray};
use crate::Result;
use crate::chart::{Anchor, COLOURS, Colour, Shape, Sheet, text_width};
use crate::optics::{GhostPath, LINE_D, Prescription, Surface, System};

/// Pixels from left to right.
const WIDTH: f64 = 1400.0;
/// The least and the most from the top to the bottom of what is to scale.
const HEIGHTS: [f64; 2] = [300.0, 900.0];
/// Left, top, right, bottom; in pixels.
const MARGIN: [f64; 4] = [40.0, 118.0, 96.0, 84.0];
const FONT: f64 = 19.0;
const TITLE: f64 = 25.0;
const INK: Colour = [30, 30, 30];
const SOFT: Colour = [140, 140, 140];
/// Of glass of the index 1.4 and of 2.0.
const GLASS: [Colour; 2] = [[232, 241, 250], [120, 168, 214]];
/// Of light on the axis, at the field's edge, and of a ghost.
const LIGHT: [Colour; 3] = [COLOURS[0], COLOURS[2], COLOURS[1]];
/// Rays of a bundle.
const RAYS: [u32; 2] = [7, 5];
/// Pieces of a surface.
const PIECES: u32 = 32;

/// What is drawn.
pub(super) struct Section<'a> {
    pub lens: &'a Prescription,
    pub system: &'a System,
    /// The ghost whose path is shown, and the angle of its light in degrees.
    pub ghost: Option<(&'a GhostPath, f64)>,
}

/// A medium between two surfaces: its outline in mm, and its index.
struct Element {
    outline: Vec<[f64; 2]>,
    index: f64,
}

/// Where a place of the lens is on the sheet.
struct Scale {
    /// The place in mm at the left of what is to scale, on the axis.
    left: f64,
    /// Pixels of a mm.
    pixels: f64,
    /// Pixels from the top to the axis.
    axis: f64,
    /// The corners of what is to scale.
    frame: [[f64; 2]; 2],
}

impl Section<'_> {
    /// Draws it.
    ///
    /// # Errors
    /// A ghost's path that the lens does not have.
    pub fn sheet(&self) -> Result<Sheet> {
        let bundles = Bundles::new(self.lens, self.system)?;
        let edge = bundles.edge();
        let mut drawn = vec![("on the axis".to_owned(), LIGHT[0], bundles.direct(0.0, RAYS[0]), 0.0)];
        match self.ghost {
            Some((ghost, angle)) => {
                let [b, a] = [0, 1].map(|k| ghost.reflections[k]);
                let rays = bundles.ghost(ghost, angle, RAYS[1])?;
                let dark = if rays.is_empty() { ": no ray in this plane arrives" } else { "" };
                let off = if angle > 0.0 { format!(", {angle}° off the axis") } else { String::new() };
                drawn.push((format!("ghost {b},{a}{off}{dark}"), LIGHT[2], rays, angle));
            }
            None => drawn.push((format!("{edge:.1}° off the axis"), LIGHT[1], bundles.direct(edge, RAYS[1]), edge)),
        }
        let scale = self.scale();
        let height = scale.frame[1][1] + MARGIN[3];
        let mut sheet = Sheet::new([WIDTH as u32, height.ceil() as u32], [255; 3]);
        self.glass(&mut sheet, &scale);
        let lead = 0.2 * self.system.sensor_z();
        for (_, colour, rays, angle) in &drawn {
            for ray in rays {
                sheet.line_within(scale.frame, scale.points(&led(ray, *angle, lead)), *colour, 1.2);
            }
        }
        self.numbers(&mut sheet, &scale);
        self.edges(&mut sheet, &scale);
        self.stop_and_sensor(&mut sheet, &scale);
        self.words(&mut sheet, &scale, drawn.iter().map(|(label, colour, ..)| (label.as_str(), *colour)));
        Ok(sheet)
    }

    /// As large as it can be, equally along the axis and across.
    fn scale(&self) -> Scale {
        let [width, height] = self.system.setup().sensor;
        let rims = self.lens.surfaces.iter().map(|surface| surface.semi_aperture);
        let tallest = rims.fold(0.5 * width.hypot(height), f64::max) * 1.06;
        let z = self.elements().into_iter().flat_map(|element| element.outline).map(|point| point[0]);
        let (front, back) =
            z.fold((0.0, self.system.sensor_z()), |(low, high): (f64, f64), z| (low.min(z), high.max(z)));
        let long = back - front;
        let front = front - 0.16 * long;
        let across = WIDTH - MARGIN[0] - MARGIN[2];
        let pixels = (across / (back - front)).min(0.5 * HEIGHTS[1] / tallest);
        let half = (tallest * pixels).max(0.5 * HEIGHTS[0]);
        let axis = MARGIN[1] + half;
        // In the middle, where its height bounds it.
        let inset = 0.5 * (across - pixels * (back - front));
        Scale {
            left: front - (MARGIN[0] + inset) / pixels,
            pixels,
            axis,
            frame: [[MARGIN[0], axis - half], [WIDTH - MARGIN[2] + 1.0, axis + half]],
        }
    }

    /// All media but air, in their order; one behind the last surface as far as the sensor.
    fn elements(&self) -> Vec<Element> {
        let surfaces = &self.lens.surfaces;
        let placed = self.system.surfaces();
        let element = |k: usize| {
            let front = (&surfaces[k], placed[k].z);
            let sensor = Surface::plane(None, surfaces[k].semi_aperture);
            let back = surfaces.get(k + 1).map_or((&sensor, self.system.sensor_z()), |back| (back, placed[k + 1].z));
            let rim = front.0.semi_aperture.max(back.0.semi_aperture);
            let mut outline = profile(front, rim);
            outline.extend(profile(back, rim).into_iter().rev());
            Element { outline, index: surfaces[k].glass.index(LINE_D) }
        };
        (0..surfaces.len()).filter(|&k| !surfaces[k].glass.is_air()).map(element).collect()
    }

    fn glass(&self, sheet: &mut Sheet, scale: &Scale) {
        for Element { outline, index } in self.elements() {
            let part = ((index - 1.4) / 0.6).clamp(0.0, 1.0);
            let mix = |c: usize| f64::from(GLASS[0][c]) + part * (f64::from(GLASS[1][c]) - f64::from(GLASS[0][c]));
            sheet.area(scale.points(&outline), [0, 1, 2].map(|c| mix(c).round() as u8));
        }
    }

    /// Outlines over the rays; thick where the ghost is reflected.
    fn edges(&self, sheet: &mut Sheet, scale: &Scale) {
        for Element { mut outline, .. } in self.elements() {
            outline.extend(outline.first().copied());
            sheet.line(scale.points(&outline), INK, 1.3);
        }
        for (k, surface) in self.lens.surfaces.iter().enumerate() {
            if self.ghost.is_some_and(|(ghost, _)| ghost.reflections.contains(&(k + 1))) {
                let z = self.system.surfaces()[k].z;
                sheet.line(scale.points(&profile((surface, z), surface.semi_aperture)), LIGHT[2], 4.0);
            }
        }
    }

    fn stop_and_sensor(&self, sheet: &mut Sheet, scale: &Scale) {
        let stop = &self.system.surfaces()[self.system.stop_number() - 1];
        let rim = self.lens.surfaces[self.system.stop_number() - 1].semi_aperture;
        let from = stop.semi_aperture;
        let to = (1.25 * rim).max(from + 10.0 / scale.pixels);
        for sign in [-1.0, 1.0] {
            sheet.line(scale.points(&[[stop.z, sign * from], [stop.z, sign * to]]), INK, 4.0);
            // A foot, as drawings of lenses have it.
            let foot = 4.0 / scale.pixels;
            sheet.line(scale.points(&[[stop.z - foot, sign * from], [stop.z + foot, sign * from]]), INK, 2.0);
        }
        let [width, height] = self.system.setup().sensor;
        let (z, corner) = (self.system.sensor_z(), 0.5 * width.hypot(height));
        sheet.line(scale.points(&[[z, -corner], [z, corner]]), INK, 4.0);
        let [x, y] = scale.point([z, 0.0]);
        sheet.text("sensor", [x + 12.0, y - 16.0], FONT, INK, Anchor::Left);
        let [low, high] = [scale.frame[0][0], x];
        let dashed = Some([14.0, 6.0]);
        let axis = vec![[low, y], [high, y]];
        sheet.shapes.push(Shape::Line { points: axis, colour: SOFT, width: 1.0, dashed });
    }

    /// The surfaces' numbers, in as many rows as keep them apart.
    fn numbers(&self, sheet: &mut Sheet, scale: &Scale) {
        let mut ends: Vec<f64> = Vec::new();
        for (k, surface) in self.lens.surfaces.iter().enumerate() {
            let placed = &self.system.surfaces()[k];
            let [x, y] = scale.point([placed.z + surface.sag(surface.semi_aperture), surface.semi_aperture]);
            let label = if surface.stop { format!("{} stop", k + 1) } else { (k + 1).to_string() };
            let half = 0.5 * text_width(&label, 16.0) + 3.0;
            let row = ends.iter().position(|&end| end < x - half).unwrap_or(ends.len());
            if row == ends.len() {
                ends.push(0.0);
            }
            ends[row] = x + half;
            let above = scale.frame[0][1] - 12.0 - 17.0 * row as f64;
            sheet.line(vec![[x, y - 2.0], [x, above + 9.0]], [205; 3], 0.8);
            sheet.text(label, [x, above], 16.0, INK, Anchor::Middle);
        }
    }

    /// The title, what colours mean, and a length.
    fn words<'a>(&self, sheet: &mut Sheet, scale: &Scale, light: impl Iterator<Item = (&'a str, Colour)>) {
        let first = self.system.first_order();
        let set = format!("f = {:.1} mm, f/{:.1}", first.focal_length, first.f_number);
        sheet.text(format!("{}: {set}", self.lens.name), [0.5 * WIDTH, 26.0], TITLE, INK, Anchor::Middle);
        let y = scale.frame[1][1] + 44.0;
        let mut x = MARGIN[0];
        for (label, colour) in light {
            sheet.line(vec![[x, y], [x + 36.0, y]], colour, 2.5);
            sheet.text(label, [x + 46.0, y], FONT, INK, Anchor::Left);
            x += 46.0 + text_width(label, FONT) + 44.0;
        }
        let length = round_length(180.0 / scale.pixels);
        let end = WIDTH - MARGIN[2];
        let start = end - length * scale.pixels;
        sheet.line(vec![[start, y], [end, y]], INK, 2.0);
        for tick in [start, end] {
            sheet.line(vec![[tick, y - 6.0], [tick, y + 6.0]], INK, 2.0);
        }
        sheet.text(format!("{length} mm"), [start - 12.0, y], FONT, INK, Anchor::Right);
    }
}

impl Scale {
    fn point(&self, [z, height]: [f64; 2]) -> [f64; 2] {
        [(z - self.left) * self.pixels, self.axis - height * self.pixels]
    }

    fn points(&self, places: &[[f64; 2]]) -> Vec<[f64; 2]> {
        places.iter().map(|&place| self.point(place)).collect()
    }
}

/// A surface from its lower to its upper rim, and flat from there to that of its element, at a height of `rim`.
fn profile((surface, z): (&Surface, f64), rim: f64) -> Vec<[f64; 2]> {
    let own = surface.semi_aperture;
    let height = |k: u32| own * (2.0 * f64::from(k) / f64::from(PIECES) - 1.0);
    let at = |height: f64, place: f64| [z + surface.sag(height), place];
    let mut points: Vec<_> = (0..=PIECES).map(|k| at(height(k), height(k))).collect();
    if rim > own {
        points.insert(0, at(own, -rim));
        points.push(at(own, rim));
    }
    points
}

/// A ray with the way before the first surface, `lead` mm along the axis, and on to the sensor.
fn led(ray: &Ray, angle: f64, lead: f64) -> Ray {
    let Some(&[z, height]) = ray.first() else { return Vec::new() };
    // Light that leans towards positive heights comes from below.
    let start = [z - lead, height - lead * angle.to_radians().tan()];
    std::iter::once(start).chain(ray.iter().copied()).collect()
}

/// The largest 1, 2 or 5 times a power of ten that is not above a length.
fn round_length(length: f64) -> f64 {
    let power = 10.0_f64.powf(length.log10().floor());
    let times = [5.0, 2.0, 1.0].into_iter().find(|times| times * power <= length * (1.0 + 1e-12));
    times.unwrap_or(1.0) * power
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::optics::{GhostOptions, Setup};
    use crate::scene::lenses;

    fn drawn<T>(name: &str, look: impl FnOnce(&Section, Sheet) -> T) -> T {
        let lens = lenses::find(name).unwrap().prescription().unwrap();
        let system = System::new(&lens, &Setup::default()).unwrap();
        let section = Section { lens: &lens, system: &system, ghost: None };
        let sheet = section.sheet().unwrap();
        look(&section, sheet)
    }

    fn areas(sheet: &Sheet) -> usize {
        sheet.shapes.iter().filter(|shape| matches!(shape, Shape::Area { .. })).count()
    }

    #[test]
    fn a_section_has_an_outline_for_each_element_on_the_sheet() {
        for (name, elements) in [("singlet", 1), ("triplet", 3), ("tessar", 4), ("double-gauss", 6), ("zoom", 12)] {
            drawn(name, |_, sheet| {
                assert_eq!(areas(&sheet), elements, "{name}");
                assert_eq!(sheet.svg().unwrap().matches("<polygon").count(), elements, "{name}");
            });
        }
        for lens in lenses::all() {
            drawn(lens.name, |_, sheet| {
                let [width, height] = sheet.size.map(f64::from);
                let inside = |&[x, y]: &[f64; 2]| (0.0..=width).contains(&x) && (0.0..=height).contains(&y);
                let cut = sheet.shapes.iter().any(|shape| match shape {
                    Shape::Area { outline, .. } => !outline.iter().all(inside),
                    Shape::Line { points, .. } => !points.iter().all(inside),
                    Shape::Text { at, .. } => !inside(at),
                    Shape::Picture { .. } => false,
                });
                assert!(!cut, "{} is cut off", lens.name);
            });
        }
    }

    #[test]
    fn a_ghosts_path_takes_the_place_of_the_fields_edge() {
        let lens = lenses::find("double-gauss").unwrap().prescription().unwrap();
        let system = System::new(&lens, &Setup::default()).unwrap();
        let ghosts = system.ghosts(&GhostOptions::default()).unwrap();
        let ghost = ghosts.ghosts.iter().find(|ghost| ghost.reflections == [8, 3]).unwrap();
        let sheet = Section { lens: &lens, system: &system, ghost: Some((ghost, 0.0)) }.sheet().unwrap();
        let lines = |colour: Colour| {
            let of = |shape: &&Shape| matches!(shape, Shape::Line { colour: its, .. } if *its == colour);
            sheet.shapes.iter().filter(of).count()
        };
        // Rays, the two surfaces, and the legend.
        assert!(lines(LIGHT[2]) > 2 + 2 && lines(LIGHT[1]) == 0, "{}", lines(LIGHT[2]));
        let told = |shape: &Shape| matches!(shape, Shape::Text { text, .. } if text == "ghost 8,3");
        assert!(sheet.shapes.iter().any(told));
    }

    #[test]
    fn lengths_are_round() {
        assert_eq!([9.0, 10.0, 19.0, 20.0, 49.9, 0.07].map(round_length), [5.0, 10.0, 10.0, 20.0, 20.0, 0.05]);
    }
}
