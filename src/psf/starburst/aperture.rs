//! The opening of an iris of diameter 1, and how long the chords are that cross it at right angles to a direction.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// So many cells beside the end of an arc, where its chord falls like a root, are integrated in closed form.
const NEAR_TIP: f64 = 32.0;

/// An opening whose corners lie on the circle of diameter 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Aperture {
    /// None of a round one.
    blades: u32,
    /// The curvature of the blades by that of the circle through the corners.
    roundness: f64,
}

impl Aperture {
    pub fn new(blades: u32, roundness: f64) -> Self {
        // Blades of the circle's curvature are the circle.
        if blades == 0 || roundness >= 1.0 { Self { blades: 0, roundness: 1.0 } } else { Self { blades, roundness } }
    }

    /// Whether it is a circle.
    pub fn is_round(self) -> bool {
        self.blades == 0
    }

    /// Whether its blades are straight.
    pub fn is_straight(self) -> bool {
        self.roundness == 0.0
    }

    /// Radians from a spike to the middle between it and the next; the pattern is the same beyond either. The spikes are
    /// at right angles to the blades, on both sides: where no two blades are parallel, there are twice as many.
    pub fn sector(self) -> f64 {
        match self.blades {
            0 => PI,
            blades if blades.is_multiple_of(2) => PI / f64::from(blades),
            blades => FRAC_PI_2 / f64::from(blades),
        }
    }

    /// Radians from the first corner to the middle of the first blade.
    pub fn first_spike(self) -> f64 {
        if self.is_round() { 0.0 } else { PI / f64::from(self.blades) }
    }

    /// Its area.
    pub fn area(self) -> f64 {
        if self.is_round() {
            return 0.25 * PI;
        }
        let blades = f64::from(self.blades);
        let polygon = 0.125 * blades * (TAU / blades).sin();
        if self.is_straight() {
            return polygon;
        }
        let (radius, half) = (self.radius(), self.half_arc());
        polygon + 0.5 * blades * radius * radius * (2.0 * half - (2.0 * half).sin())
    }

    /// The radius of the arcs.
    fn radius(self) -> f64 {
        0.5 / self.roundness
    }

    /// Half of the angle of an arc about its centre.
    fn half_arc(self) -> f64 {
        ((PI / f64::from(self.blades)).sin() * self.roundness).asin()
    }

    /// Mean lengths of its chords at right angles to a direction, `angle` radians from the middle of a blade, in `count` cells
    /// that share the diameter evenly.
    pub fn chords(self, angle: f64, count: usize) -> Vec<f64> {
        let mut chords = vec![0.0; count];
        if self.is_round() {
            add_arc(&mut chords, [0.0; 2], 0.5, [0.0, TAU]);
            return chords;
        }
        let half = PI / f64::from(self.blades);
        for blade in 0..self.blades {
            let middle = f64::from(2 * blade) * half - angle;
            if self.is_straight() {
                let [from, to] = [middle - half, middle + half].map(|at| [0.5 * at.cos(), 0.5 * at.sin()]);
                add_line(&mut chords, from, to);
            } else {
                let off = 0.5 * half.cos() - self.radius() * self.half_arc().cos();
                let centre = [off * middle.cos(), off * middle.sin()];
                add_arc(&mut chords, centre, self.radius(), [middle - self.half_arc(), middle + self.half_arc()]);
            }
        }
        chords
    }
}

/// Adds −∫ y dx of a line, in each cell by its width: of a boundary that is run through against the clock, the chords.
fn add_line(chords: &mut [f64], [x1, y1]: [f64; 2], [x2, y2]: [f64; 2]) {
    let sign = if x2 < x1 { 1.0 } else { -1.0 };
    let slope = (y2 - y1) / (x2 - x1);
    // Upright, it has no part in any cell.
    if slope.is_finite() {
        add(chords, [x1.min(x2), x1.max(x2)], sign, |from, to| (to - from) * (y1 + slope * (0.5 * (from + to) - x1)));
    }
}

/// The same of an arc of a circle between two angles, the smaller one first.
fn add_arc(chords: &mut [f64], [x, y]: [f64; 2], radius: f64, [first, last]: [f64; 2]) {
    let near = NEAR_TIP / chords.len() as f64;
    let height = |at: f64| (radius * radius - at * at).max(0.0).sqrt();
    let area = |at: f64| 0.5 * (at * height(at) + radius * radius * (at / radius).clamp(-1.0, 1.0).asin());
    let mut from = first;
    while from < last {
        // To where it turns back.
        let half_turn = (from / PI + 1e-12).floor();
        let to = last.min(PI * (half_turn + 1.0));
        let above = if half_turn.rem_euclid(2.0) == 0.0 { 1.0 } else { -1.0 };
        let [a, b] = [radius * from.cos(), radius * to.cos()];
        add(chords, [x + a.min(b), x + a.max(b)], above, |from, to| {
            let [from, to] = [from - x, to - x];
            let under = if radius - from.abs().max(to.abs()) < near {
                area(to) - area(from)
            } else {
                (to - from) / 6.0 * (height(from) + 4.0 * height(0.5 * (from + to)) + height(to))
            };
            y * (to - from) + above * under
        });
        from = to;
    }
}

/// Adds the integral of a piece of the boundary to the cells between `from` and `to`, by their width.
fn add(chords: &mut [f64], [from, to]: [f64; 2], sign: f64, integral: impl Fn(f64, f64) -> f64) {
    let count = chords.len() as f64;
    let cell = |x: f64| ((x + 0.5) * count).floor().clamp(0.0, count - 1.0) as usize;
    let [first, last] = [cell(from), cell(to)];
    for (index, chord) in (first..).zip(&mut chords[first..=last]) {
        let edges = [index, index + 1].map(|edge| edge as f64 / count - 0.5);
        let [from, to] = [from.max(edges[0]), to.min(edges[1])];
        if to > from {
            *chord += sign * count * integral(from, to);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The chords of all cells hold the area, from whatever side they are looked at, and those of a square's blade and corner
    /// are known.
    #[test]
    fn chords_hold_the_area() {
        for (blades, roundness) in [(0, 0.0), (3, 0.0), (3, 0.7), (4, 1.0), (5, 1e-3), (6, 0.4), (16, 0.99)] {
            let aperture = Aperture::new(blades, roundness);
            for angle in [0.0, 1e-7, 0.1, 0.5, 1.0, 3.0] {
                let area = aperture.chords(angle, 777).iter().sum::<f64>() / 777.0;
                assert!((area - aperture.area()).abs() < 1e-8, "{blades}, {roundness}, {angle}: {area}");
            }
        }
        let side = 0.5_f64.sqrt();
        let square = Aperture::new(4, 0.0);
        let (blade, corner) = (square.chords(0.0, 1000), square.chords(PI / 4.0, 1000));
        assert!(blade[..146].iter().all(|chord| *chord == 0.0) && (blade[147] - side).abs() < 1e-12);
        assert!((corner[499] - 0.999).abs() < 1e-12 && (corner[0] - 0.001).abs() < 1e-12);
        let disc = Aperture::new(7, 1.0).chords(0.3, 1000);
        assert!((disc[250] - 2.0 * (0.25 - 0.2495_f64.powi(2)).sqrt()).abs() < 1e-6);
    }

    #[test]
    fn spikes_are_as_many_as_blades_or_twice_that() {
        let spikes = |blades| PI / Aperture::new(blades, 0.0).sector();
        assert_eq!([3, 4, 5, 6, 16].map(|blades| spikes(blades).round() as u32), [6, 4, 10, 6, 16]);
    }
}
