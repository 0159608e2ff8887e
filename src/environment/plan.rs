//! In which directions a picture's veil is summed, and what goes between them.
//!
//! No light is nearer to the picture than the band's edge: over such a distance the veil changes, next to that edge. So what is outside
//! is taken in zones, each four times as far from the picture as the one before, and summed in directions that are spaced as its own
//! distance asks for. Between directions go polynomials of the fifth degree along each side: from the coarsest to the next, and from the
//! finest to the pixels.

use glam::DVec3;
use rayon::prelude::*;

use super::cut::{Border, Zone};
use super::lanes::Summed;
use super::sight::{Rectangle, Sight};
use crate::psf::Psf;
use crate::veil::Tabled;

/// Nodes that a polynomial goes through.
pub(super) const NODES: usize = 6;

/// Zones, and how many times as far from the picture each is as the one before.
const ZONES: usize = 3;
const FARTHER: f64 = 4.0;

/// Steps between directions that are tried, over the zone's distance, from the widest.
const WIDEST: f64 = 0.8;
const NARROWEST: f64 = 0.08;

/// The first steps from either end, over those between: what goes between nodes is worst where they lie to one side.
const FIRST: [f64; 2] = [0.5, 0.7];

/// Of a tolerance, what is left to what goes between nodes.
const BETWEEN: f64 = 0.5;

/// The opening of cells, by the root of the tolerance, and the widest that there is: what sums are off by goes with its square.
const OPENING: f64 = 1.2;
const WIDEST_OPENING: f64 = 0.15;

/// Cells that zones share, by their radius, over the zone's distance.
const SHARED: f64 = 0.1;

/// How the veil from outside is summed on pictures that are seen alike, wherever their camera looks.
pub struct StrayPlan {
    pub(super) psf: Psf,
    pub(super) scatter: Tabled,
    pub(super) summed: Summed,
    pub(super) sides: [u32; 2],
    edges: [[f64; 2]; 2],
    /// The nearest first.
    pub(super) layers: Vec<Layer>,
    pub(super) tolerance: f64,
    pub(super) opening: f64,
    /// What goes between directions is off by at most so much of itself.
    pub(super) between: f64,
}

/// A zone, and the directions in which its veil is summed.
pub(super) struct Layer {
    pub zone: Zone,
    /// Of the picture's pixels, or of the nodes of the layer before.
    pub axes: [Axis; 2],
}

/// Nodes along one side of a picture, and what each of some places has of them.
pub(super) struct Axis {
    /// Over the focal length, from the left, or the lower end, on.
    pub nodes: Vec<f64>,
    /// The first node, and how much of it and the next ones.
    pub weights: Vec<(usize, [f32; NODES])>,
}

impl StrayPlan {
    /// For a function in degrees, within about a tolerance of the veil itself, on pictures as a sight has them.
    pub fn new(psf: &Psf, tolerance: f64, sight: &Sight) -> Self {
        let (edges, sides) = (sight.edges(), sight.sides());
        let scatter = Tabled::new(|angle| psf.value(angle));
        let shown = sight.shown();
        // How far beyond the pixels each zone begins.
        let distance = (edges[0][1] - edges[0][0]).min(edges[1][1] - edges[1][0]);
        let distances: [f64; ZONES] = std::array::from_fn(|zone| distance * FARTHER.powi(zone as i32));
        // By the chord, which is less the farther from the middle.
        let begins = distances.map(|distance| {
            let rectangle = Rectangle::new(edges.map(|[last, _]| last + distance));
            let [x, y] = rectangle.edges();
            Border { rectangle, shares: SHARED * distance / (1.0 + x * x + y * y) }
        });
        // Cells that it shares with the one before are a little nearer.
        let nearest = distances.map(|distance| (1.0 - 1.5 * SHARED) * distance);
        let nearest = nearest.map(|distance| Rectangle::new(edges.map(|[last, _]| last + distance)));
        let nearest = |zone: usize| if zone == 0 { shown } else { nearest[zone] };
        let mut layers: Vec<Layer> = Vec::new();
        for (zone, distance) in distances.into_iter().enumerate() {
            let inner = (zone > 0).then(|| begins[zone]);
            let ends = Zone { shown, inner, outer: begins.get(zone + 1).copied() };
            let places = match layers.last() {
                None => [0, 1].map(|side| places(edges[side][0], sides[side])),
                Some(Layer { axes, .. }) => axes.each_ref().map(|axis| axis.nodes.clone()),
            };
            let off = |axes: &[Axis; 2]| off(axes, sight, &nearest(zone), &scatter);
            layers.push(Layer { zone: ends, axes: fine_enough(&places, distance, BETWEEN * tolerance, off) });
        }
        // A zone's light passes through the polynomials of all layers before its own.
        let passes = |zone: usize| {
            let layers = layers[..=zone].iter();
            layers.map(|layer| 1.0 + off(&layer.axes, sight, &nearest(zone), &scatter)).product::<f64>() - 1.0
        };
        let between = (0..ZONES).map(passes).fold(0.0, f64::max);
        let opening = (OPENING * tolerance.sqrt()).min(WIDEST_OPENING);
        let summed = Summed::new(&scatter, tolerance);
        Self { psf: psf.clone(), scatter, summed, sides, edges, layers, tolerance, opening, between }
    }

    /// Whether it is the plan for these.
    pub fn fits(&self, psf: &Psf, tolerance: f64, sight: &Sight) -> bool {
        (&self.psf, self.tolerance, self.edges, self.sides) == (psf, tolerance, sight.edges(), sight.sides())
    }

    /// Directions in all.
    pub(super) fn directions(&self) -> usize {
        self.layers.iter().map(|layer| layer.axes[0].nodes.len() * layer.axes[1].nodes.len()).sum()
    }

    /// Where the centre of a pixel is, by its column and its row from the lowest, over the focal length.
    pub(super) fn place(&self, pixel: [usize; 2]) -> [f64; 2] {
        [0, 1].map(|side| places(self.edges[side][0], self.sides[side])[pixel[side]])
    }
}

/// The centres of so many pixels, the last of which is so far from the middle.
fn places(last: f64, count: u32) -> Vec<f64> {
    let place = |k: u32| if count > 1 { last * (2.0 * f64::from(k) / f64::from(count - 1) - 1.0) } else { 0.0 };
    (0..count).map(place).collect()
}

/// Nodes for places, as far apart as a tolerance allows what goes between them to be off.
fn fine_enough(places: &[Vec<f64>; 2], distance: f64, tolerance: f64, off: impl Fn(&[Axis; 2]) -> f64) -> [Axis; 2] {
    let mut step = WIDEST;
    loop {
        let axes = places.each_ref().map(|places| Axis::new(places, step * distance));
        if off(&axes) <= tolerance || step <= NARROWEST {
            return axes;
        }
        step *= 0.85;
    }
}

impl Axis {
    /// For places from -x to x, at most a step apart.
    fn new(places: &[f64], step: f64) -> Self {
        let end = places.last().map_or(0.0, |end| end.abs()).max(f64::MIN_POSITIVE);
        let few = 2 * FIRST.len() + 1;
        let ends: f64 = 2.0 * FIRST.iter().sum::<f64>();
        let between = (2.0 * end / step - ends).ceil().max((NODES - few) as f64) as usize;
        let steps = FIRST.into_iter().chain((0..between).map(|_| 1.0)).chain(FIRST.into_iter().rev());
        let unit = 2.0 * end / (ends + between as f64);
        let mut nodes = vec![-end];
        nodes.extend(steps.scan(-end, |node, step| {
            *node += step * unit;
            Some(*node)
        }));
        let weights = places.iter().map(|place| weights(*place, &nodes)).collect();
        Self { nodes, weights }
    }

    /// Places half way between nodes, with the weights of the nodes about them.
    fn middles(&self) -> (Vec<f64>, Vec<(usize, [f32; NODES])>) {
        let middles: Vec<f64> = self.nodes.windows(2).map(|pair| 0.5 * (pair[0] + pair[1])).collect();
        let weights = middles.iter().map(|middle| weights(*middle, &self.nodes)).collect();
        (middles, weights)
    }
}

/// The first of the nodes about a place, and the weight of each: those of Lagrange's polynomials.
fn weights(place: f64, nodes: &[f64]) -> (usize, [f32; NODES]) {
    let after = nodes.partition_point(|node| *node <= place);
    let first = after.saturating_sub(NODES / 2).min(nodes.len() - NODES);
    let about = &nodes[first..first + NODES];
    let weight = |k: usize| {
        let others = about.iter().enumerate().filter(|(other, _)| *other != k);
        others.map(|(_, other)| (place - other) / (about[k] - other)).product::<f64>() as f32
    };
    (first, std::array::from_fn(weight))
}

/// What polynomials between nodes are off by at most, relative to the veil: the largest for a light anywhere on the edge where a
/// zone begins, since that of many is no more, and those farther off are smoother.
fn off(axes: &[Axis; 2], sight: &Sight, begins: &Rectangle, scatter: &Tabled) -> f64 {
    const LIGHTS: usize = 12;
    // By symmetry one half of two edges does; and middles between nodes are the worst places but for a little.
    const BESIDE: f64 = 1.5;
    let [right, top] = begins.edges();
    let light = |k: usize| {
        let along = (k / 2) as f64 / (LIGHTS - 1) as f64;
        sight.direction(if k.is_multiple_of(2) { [right, along * top] } else { [along * right, top] })
    };
    let [across, down] = axes.each_ref().map(Axis::middles);
    let directions = |xs: &[f64], ys: &[f64]| -> Vec<DVec3> {
        ys.iter().flat_map(|&y| xs.iter().map(move |&x| sight.direction([x, y]))).collect()
    };
    let nodes = directions(&axes[0].nodes, &axes[1].nodes);
    let between = directions(&across.0, &down.0);
    let worst = |k: usize| {
        let light = light(k);
        let value = |direction: &DVec3| scatter.at(direction.distance_squared(light)).value;
        let values: Vec<f64> = nodes.iter().map(value).collect();
        let columns = axes[0].nodes.len();
        let mut worst = 0.0f64;
        for (at, direction) in between.iter().enumerate() {
            let ((column, across), (row, down)) = (&across.1[at % across.1.len()], &down.1[at / across.1.len()]);
            let mut sum = 0.0;
            for (k, down) in down.iter().enumerate() {
                let nodes = &values[(row + k) * columns + column..];
                sum += f64::from(*down) * nodes.iter().zip(across).map(|(node, w)| node * f64::from(*w)).sum::<f64>();
            }
            worst = worst.max((sum / value(direction) - 1.0).abs());
        }
        worst
    };
    BESIDE * (0..2 * LIGHTS).into_par_iter().map(worst).reduce(|| 0.0, f64::max)
}
