//! The ghosts of one lamp as they lie on the sensor, at several field angles.
//!
//! A ghost is evenly bright within what its rims leave of it: circles, and the polygon of the iris where it is stopped down.
//! Their irradiances add up, and are shown by their logarithm.

use std::f64::consts::{PI, TAU};

use glam::DVec2;
use image::RgbImage;

use crate::chart::{Anchor, Colour, Shape, Sheet};
use crate::optics::{Clip, GhostPath, LensGhosts, System};

/// Where the lamps' images are on the way from the middle to the corner of the sensor.
const PLACES: [f64; 4] = [0.2, 0.45, 0.7, 0.95];
/// Pixels of the longer side of a panel.
const PANEL: u32 = 640;
/// Rows of rays in each row of pixels.
const SUBROWS: u32 = 4;
/// A ghost in focus is shown at least with this radius, in pixels.
const SMALLEST: f64 = 1.2;
/// Powers of ten between black and the brightest.
const DECADES: f64 = 2.5;
/// Of the pixels with light, the part that is shown brighter than all can be: ghosts that are in focus.
const BURNT: f64 = 2e-3;
/// Left and right, title, a panel's label, between panels, below; in pixels.
const MARGIN: [u32; 5] = [28, 64, 36, 20, 60];
const FONT: f64 = 19.0;
const TITLE: f64 = 25.0;
const INK: Colour = [225, 225, 225];
const SOFT: Colour = [110, 110, 110];

/// A sensor's pixels, and the light on each in the parts of the lamp's for a mm².
struct Raster {
    size: [u32; 2],
    /// Pixels of a mm.
    pixels: f64,
    light: Vec<[f64; 3]>,
}

/// A convex shape on the sensor, in pixels.
enum Rim {
    Circle {
        centre: DVec2,
        radius: f64,
    },
    /// By its corners.
    Polygon(Vec<DVec2>),
}

/// What a light at a tangent of its angle, along a unit vector from the axis, makes.
#[derive(Clone, Copy)]
struct Lamp {
    tangent: f64,
    along: DVec2,
    /// Where its own image is, in mm from the axis.
    image: f64,
}

/// Panels of the sensor with the lamp ever further from the axis.
pub(super) fn sheet(system: &System, ghosts: &LensGhosts) -> Sheet {
    let [width, height] = system.setup().sensor;
    let larger = width.max(height);
    let size = [width, height].map(|side| ((f64::from(PANEL) * side / larger).round() as u32).max(1));
    let [side, title, label, gap, below] = MARGIN;
    let whole = [2 * side + 2 * size[0] + gap, title + 2 * (label + size[1]) + gap + below];
    let mut sheet = Sheet::new(whole, [0; 3]);
    let corner = DVec2::new(-width, height).normalize();
    let lamp = |place: f64| {
        let image = 0.5 * place * width.hypot(height);
        Lamp { tangent: image / ghosts.image_per_tangent.abs(), along: corner, image }
    };
    let panels = PLACES.map(|place| (lamp(place), Raster::new(system, ghosts, lamp(place), size)));
    let brightest = brightest(panels.iter().flat_map(|(_, raster)| &raster.light));
    for (k, (lamp, raster)) in panels.iter().enumerate() {
        let (column, row) = (k as u32 % 2, k as u32 / 2);
        let at = [side + column * (size[0] + gap), title + label + row * (size[1] + label + gap)];
        sheet.shapes.push(Shape::Picture { picture: raster.picture(brightest), at });
        frame(&mut sheet, at.map(f64::from), raster, lamp);
    }
    let first = system.first_order();
    let set = format!("f = {:.1} mm, f/{:.1}", first.focal_length, first.f_number);
    let middle = 0.5 * f64::from(whole[0]);
    sheet.text(format!("{}: {set}, the ghosts of one lamp", system.name()), [middle, 30.0], TITLE, INK, Anchor::Middle);
    let [low, high] = [brightest * 10.0_f64.powf(-DECADES), brightest];
    let scale = format!("logarithmic, black to brightest: {low:.1e} to {high:.1e} of the lamp's light for a mm²");
    sheet.text(scale, [middle, f64::from(whole[1] - below) + 32.0], FONT, INK, Anchor::Middle);
    sheet
}

/// The sensor's edge, its middle, the lamp and what is said of it.
fn frame(sheet: &mut Sheet, [left, top]: [f64; 2], raster: &Raster, lamp: &Lamp) {
    let [right, bottom] = [left + f64::from(raster.size[0]), top + f64::from(raster.size[1])];
    let corners = [[left, top], [right, top], [right, bottom], [left, bottom], [left, top]];
    sheet.line(corners.to_vec(), SOFT, 1.0);
    let cross = |sheet: &mut Sheet, [x, y]: [f64; 2], from: f64, to: f64, colour| {
        for [i, j] in [[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]] {
            sheet.line(vec![[x + from * i, y + from * j], [x + to * i, y + to * j]], colour, 1.5);
        }
    };
    cross(sheet, [0.5 * (left + right), 0.5 * (top + bottom)], 0.0, 5.0, SOFT);
    let place = raster.place(lamp.image * lamp.along) + DVec2::new(left, top);
    let disc = (0..16).map(|k| place + 4.0 * DVec2::from_angle(TAU * f64::from(k) / 16.0));
    sheet.area(disc.map(|corner| corner.to_array()).collect(), [255; 3]);
    cross(sheet, place.to_array(), 7.0, 13.0, [255; 3]);
    let angle = lamp.tangent.atan().to_degrees();
    let label = format!("{angle:.1}° off the axis, {:.1} mm on the sensor", lamp.image);
    sheet.text(label, [left, top - 18.0], FONT, INK, Anchor::Left);
}

/// The light that all but a few of the lit pixels are not above.
fn brightest<'a>(light: impl Iterator<Item = &'a [f64; 3]>) -> f64 {
    let mut lit: Vec<f64> = light.map(largest).filter(|&light| light > 0.0).collect();
    let burnt = (BURNT * lit.len() as f64) as usize;
    if lit.is_empty() {
        return 1.0;
    }
    *lit.select_nth_unstable_by(burnt, |a, b| b.total_cmp(a)).1
}

fn largest(light: &[f64; 3]) -> f64 {
    light.iter().copied().fold(0.0, f64::max)
}

impl Raster {
    fn new(system: &System, ghosts: &LensGhosts, lamp: Lamp, size: [u32; 2]) -> Self {
        let [width, height] = size.map(|side| side as usize);
        let pixels = f64::from(size[0]) / system.setup().sensor[0];
        let mut raster = Self { size, pixels, light: Vec::new() };
        // Differences along each row, whose sums are the light; two more for what ends at the right edge.
        let mut steps = vec![[0.0; 3]; (width + 2) * height];
        for ghost in &ghosts.ghosts {
            for colour in 0..3 {
                raster.add(&mut steps, system, ghost, colour, lamp);
            }
        }
        for row in steps.chunks_exact(width + 2) {
            let sums = row.iter().scan([0.0; 3], |sum, step| {
                *sum = std::array::from_fn(|c| sum[c] + step[c]);
                // Rounding leaves something of what ended.
                Some(sum.map(|light: f64| light.max(0.0)))
            });
            raster.light.extend(sums.take(width));
        }
        raster
    }

    /// Where a place in mm, x to the right and y upwards from the axis, is in pixels from the upper left corner.
    fn place(&self, place: DVec2) -> DVec2 {
        let middle = 0.5 * DVec2::new(f64::from(self.size[0]), f64::from(self.size[1]));
        middle + self.pixels * DVec2::new(place.x, -place.y)
    }

    fn add(&self, steps: &mut [[f64; 3]], system: &System, ghost: &GhostPath, colour: usize, lamp: Lamp) {
        let radius = ghost.radius_mm[colour];
        let (light, rims) = if radius * self.pixels < SMALLEST {
            let light = ghost.share[colour] * ghost.vignetting(lamp.tangent) / (PI * (SMALLEST / self.pixels).powi(2));
            let centre = self.place(ghost.magnification[colour] * lamp.image * lamp.along);
            (light, vec![Rim::Circle { centre, radius: SMALLEST }])
        } else {
            let rim = |clip: &Clip| self.rim(system, ghost, clip, colour, lamp);
            (ghost.share[colour] / (PI * radius * radius), ghost.clips.iter().map(rim).collect())
        };
        if !(light.is_finite() && light > 0.0) {
            return;
        }
        let (width, part) = (f64::from(self.size[0]), light / f64::from(SUBROWS));
        for subrow in 0..self.size[1] * SUBROWS {
            let y = (f64::from(subrow) + 0.5) / f64::from(SUBROWS);
            let common = |a: (f64, f64), b: (f64, f64)| (a.0.max(b.0), a.1.min(b.1));
            let span = rims.iter().map(|rim| rim.span(y)).fold((0.0, width), common);
            if span.0 < span.1 {
                let row = (subrow / SUBROWS) as usize * (self.size[0] as usize + 2);
                // A pixel has of it as much as it is covered.
                for (x, light) in [(span.0, part), (span.1, -part)] {
                    let pixel = x.floor();
                    steps[row + pixel as usize][colour] += light * (pixel + 1.0 - x);
                    steps[row + pixel as usize + 1][colour] += light * (x - pixel);
                }
            }
        }
    }

    /// A rim as it bounds a colour of a ghost.
    fn rim(&self, system: &System, ghost: &GhostPath, clip: &Clip, colour: usize, lamp: Lamp) -> Rim {
        let narrowest = ghost.clips.first().map_or(0.0, |first| first.center_per_tangent);
        let apart = ghost.scale[colour] * (clip.center_per_tangent - narrowest) * lamp.tangent;
        let centre = self.place((ghost.magnification[colour] * lamp.image + apart) * lamp.along);
        let radius = ghost.scale[colour].abs() * clip.radius * self.pixels;
        let iris = system.iris();
        match iris.sides(system.first_order()).filter(|_| clip.surface == system.stop_number()) {
            None => Rim::Circle { centre, radius },
            Some(sides) => {
                let turned = if (ghost.scale[colour] < 0.0) != clip.inverted { PI } else { 0.0 };
                let corner = |k: u32| {
                    let angle = iris.rotation.to_radians() + turned + TAU * f64::from(k) / f64::from(sides);
                    centre + radius * DVec2::new(angle.cos(), -angle.sin())
                };
                Rim::Polygon((0..sides).map(corner).collect())
            }
        }
    }

    /// By the logarithm of the light, in its hue.
    fn picture(&self, brightest: f64) -> RgbImage {
        let [width, height] = self.size;
        RgbImage::from_fn(width, height, |x, y| {
            let light = self.light[(y * width + x) as usize];
            let most = largest(&light);
            if most <= 0.0 {
                return image::Rgb([0; 3]);
            }
            let level = (1.0 + (most / brightest).log10() / DECADES).clamp(0.0, 1.0);
            image::Rgb(light.map(|part| (255.0 * level * (part / most).powf(1.0 / 2.2)).round() as u8))
        })
    }
}

impl Rim {
    /// What of a row it holds, from and to; from above to where it holds nothing.
    fn span(&self, y: f64) -> (f64, f64) {
        const NOTHING: (f64, f64) = (f64::INFINITY, f64::NEG_INFINITY);
        match self {
            Self::Circle { centre, radius } => {
                let half = ((radius - (y - centre.y)) * (radius + (y - centre.y))).sqrt();
                if half.is_nan() { NOTHING } else { (centre.x - half, centre.x + half) }
            }
            Self::Polygon(corners) => {
                let next = corners.iter().cycle().skip(1);
                let crossings = corners.iter().zip(next).filter(|(a, b)| (a.y <= y) != (b.y <= y));
                let places = crossings.map(|(a, b)| a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y));
                places.fold(NOTHING, |(low, high), x| (low.min(x), high.max(x)))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::optics::{GhostOptions, Setup};
    use crate::scene::lenses;

    fn set(name: &str, fstop: Option<f64>) -> (System, LensGhosts) {
        let lens = lenses::find(name).unwrap().prescription().unwrap();
        let system = System::new(&lens, &Setup { fstop, ..Setup::default() }).unwrap();
        let ghosts = system.ghosts(&GhostOptions::default()).unwrap();
        (system, ghosts)
    }

    fn lamp(ghosts: &LensGhosts, image: f64) -> Lamp {
        Lamp { tangent: image / ghosts.image_per_tangent, along: DVec2::new(-0.8, 0.6), image }
    }

    /// The green light of all ghosts on a place in pixels, by the circles of the matrices.
    fn by_matrices(raster: &Raster, ghosts: &LensGhosts, lamp: Lamp, at: DVec2) -> f64 {
        let of = |ghost: &GhostPath| {
            let radius = ghost.radius_mm[1];
            if radius * raster.pixels < SMALLEST {
                let centre = raster.place(ghost.magnification[1] * lamp.image * lamp.along);
                let light = ghost.share[1] * ghost.vignetting(lamp.tangent) / (PI * (SMALLEST / raster.pixels).powi(2));
                return if at.distance(centre) <= SMALLEST { light } else { 0.0 };
            }
            let within = |clip: &Clip| {
                let (centre, radius) = ghost.on_sensor(clip, lamp.tangent, lamp.image);
                at.distance(raster.place(centre * lamp.along)) <= radius * raster.pixels
            };
            if ghost.clips.iter().all(within) { ghost.share[1] / (PI * radius * radius) } else { 0.0 }
        };
        ghosts.ghosts.iter().map(of).sum()
    }

    #[test]
    fn light_is_where_the_matrices_have_it() {
        for name in ["double-gauss", "heliar", "retrofocus"] {
            let (system, ghosts) = set(name, None);
            let lamp = lamp(&ghosts, 9.0);
            let raster = Raster::new(&system, &ghosts, lamp, [900, 600]);
            let (mut compared, mut alike) = (0, 0);
            for k in (0..raster.light.len()).step_by(101) {
                let at = DVec2::new((k % 900) as f64 + 0.5, (k / 900) as f64 + 0.5);
                let expected = by_matrices(&raster, &ghosts, lamp, at);
                compared += 1;
                // A pixel on an edge has a part of the light.
                alike += usize::from((raster.light[k][1] - expected).abs() <= 1e-6 * expected + 1e-15);
            }
            println!("{name}: {alike} of {compared} pixels");
            assert!(100 * alike > 85 * compared, "{name}: {alike} of {compared}");
        }
    }

    #[test]
    fn the_brightest_place_is_the_ghost_in_focus_and_not_the_lamp() {
        let (system, ghosts) = set("double-gauss", None);
        let lamp = lamp(&ghosts, 9.0);
        let raster = Raster::new(&system, &ghosts, lamp, [900, 600]);
        let (k, _) = raster.light.iter().map(largest).enumerate().max_by(|a, b| a.1.total_cmp(&b.1)).unwrap();
        let found = DVec2::new((k % 900) as f64 + 0.5, (k / 900) as f64 + 0.5);
        // Its red is smaller than its blue, and brighter for that.
        let focused = &ghosts.ghosts[0];
        assert!(focused.radius_mm[0] < 0.2, "{focused:?}");
        let place = raster.place(focused.magnification[0] * lamp.image * lamp.along);
        assert!(found.distance(place) < focused.radius_mm[0] * raster.pixels + 1.5, "{found}, and not {place}");
        assert!(found.distance(raster.place(lamp.image * lamp.along)) > 10.0);
    }

    #[test]
    fn a_picture_has_the_light_of_its_ghosts() {
        let (system, mut ghosts) = set("double-gauss", None);
        let lamp = lamp(&ghosts, 5.0);
        // Those that are on the sensor as a whole.
        let on_sensor = |ghost: &GhostPath| {
            (0..3).all(|c| ghost.magnification[c].abs() * lamp.image * 0.6 + 1.01 * ghost.radius_mm[c] < 11.9)
        };
        ghosts.ghosts.retain(on_sensor);
        assert!(ghosts.ghosts.len() > 5);
        let raster = Raster::new(&system, &ghosts, lamp, [900, 600]);
        for c in 0..3 {
            let found = raster.light.iter().map(|light| light[c]).sum::<f64>() / raster.pixels.powi(2);
            let expected: f64 = ghosts.ghosts.iter().map(|g| g.share[c] * g.vignetting(lamp.tangent)).sum();
            assert!((found / expected - 1.0).abs() < 0.01, "{c}: {found} {expected}");
        }
    }

    #[test]
    fn blades_show_when_the_iris_is_stopped_down() {
        let square = Rim::Polygon([[2.0, 1.0], [4.0, 3.0], [2.0, 5.0], [0.0, 3.0]].map(DVec2::from).to_vec());
        assert_eq!((square.span(3.0), square.span(2.0)), ((0.0, 4.0), (1.0, 3.0)));
        assert!(square.span(0.5).0 > square.span(0.5).1 && square.span(5.5).0 > square.span(5.5).1);
        let polygons = |fstop| {
            let (system, ghosts) = set("tessar", fstop);
            let lamp = lamp(&ghosts, 9.0);
            let raster = Raster::new(&system, &ghosts, lamp, [90, 60]);
            let rims = ghosts.ghosts.iter().flat_map(|ghost| {
                ghost.clips.iter().map(|clip| raster.rim(&system, ghost, clip, 1, lamp)).collect::<Vec<_>>()
            });
            rims.filter(|rim| matches!(rim, Rim::Polygon(_))).count()
        };
        assert_eq!(polygons(None), 0);
        assert!(polygons(Some(11.0)) > 5);
    }

    #[test]
    fn a_sheet_has_the_sensor_four_times_with_the_lamp_further_out_each() {
        let (system, ghosts) = set("planar", None);
        let sheet = sheet(&system, &ghosts);
        let pictures: Vec<_> = sheet.shapes.iter().filter(|shape| matches!(shape, Shape::Picture { .. })).collect();
        assert_eq!(pictures.len(), 4);
        assert_eq!(sheet.svg().unwrap().matches("<image").count(), 4);
        for picture in pictures {
            let Shape::Picture { picture, .. } = picture else { continue };
            assert_eq!([picture.width(), picture.height()], [640, 427]);
            let lit = picture.pixels().filter(|pixel| pixel.0.iter().any(|&part| part > 40)).count();
            assert!(lit > 5000, "{lit}");
        }
    }
}
