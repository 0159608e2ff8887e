//! What an even pixel of a panorama sends to the centre of another: ∫ k dΩ over it.

use std::f64::consts::{PI, TAU};

use super::Tabled;

/// The side of a part of a pixel, in radians, within which no kernel changes: a 500th of a degree.
const LEAST: f64 = 3.5e-5;

/// A row of pixels, and one that it sends to.
#[derive(Debug, Clone, Copy)]
pub(in crate::veil) struct Rows {
    /// From the zenith: the centre of the row that it sends to, and the upper and the lower end of this one.
    to: f64,
    ends: [f64; 2],
    /// Half the width of a pixel, in radians of azimuth.
    half: f64,
}

/// How fine integrals are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::veil) enum Fineness {
    Usual,
    /// To hold the others against.
    Finer,
}

/// Nodes and weights of Gauss and Legendre, of four and of three points on −1 to 1.
const FOUR: [[f64; 2]; 4] = [
    [-0.861_136_311_594_052_6, 0.347_854_845_137_453_85],
    [-0.339_981_043_584_856_26, 0.652_145_154_862_546_1],
    [0.339_981_043_584_856_26, 0.652_145_154_862_546_1],
    [0.861_136_311_594_052_6, 0.347_854_845_137_453_85],
];
const THREE: [[f64; 2]; 3] =
    [[-0.774_596_669_241_483_4, 5.0 / 9.0], [0.0, 8.0 / 9.0], [0.774_596_669_241_483_4, 5.0 / 9.0]];

impl Rows {
    pub fn new([width, height]: [usize; 2], to: usize, from: usize) -> Self {
        let step = PI / height as f64;
        Self {
            to: step * (to as f64 + 0.5),
            ends: [step * from as f64, step * (from as f64 + 1.0)],
            half: PI / width as f64,
        }
    }

    /// How many samples around the ring tell all of it, where e^(−π `falls`) is nothing.
    pub fn samples(&self, falls: f64) -> f64 {
        let nearest = self.ends.iter().map(|end| (end - self.to).abs()).fold(f64::INFINITY, f64::min);
        // The distance of two rings over the larger sine bounds where K, as a function of the azimuth, is no function any more.
        let sine = self.to.sin().max(self.ends[0].sin()).max(self.ends[1].sin());
        TAU * falls * sine / nearest
    }

    /// For a pixel at an azimuth from the other one: the integral over its height, times its width, as at its middle.
    pub fn over_height(&self, kernel: &Tabled, azimuth: f64) -> f64 {
        let half = (0.5 * azimuth).sin().powi(2);
        2.0 * self.half * self.along(kernel, self.ends, &FOUR, half)
    }

    /// ∫ k sin θ dθ between two angles, where the sine of half the azimuth has this square.
    fn along(&self, kernel: &Tabled, [upper, lower]: [f64; 2], nodes: &[[f64; 2]], half: f64) -> f64 {
        let (middle, reach) = (0.5 * (upper + lower), 0.5 * (lower - upper));
        let sine = self.to.sin();
        let node = |&[node, weight]: &[f64; 2]| {
            let theta = middle + reach * node;
            let across = theta.sin();
            let chord = 4.0 * ((0.5 * (theta - self.to)).sin().powi(2) + sine * across * half);
            weight * across * kernel.value(chord)
        };
        reach * nodes.iter().map(node).sum::<f64>()
    }

    /// ∫ k dΩ over the pixel that is so many columns away.
    pub fn over_pixel(&self, kernel: &Tabled, columns: usize, fineness: Fineness) -> f64 {
        let middle = 2.0 * self.half * columns as f64;
        let parts = Parts { rows: self, kernel, fineness };
        if columns > 0 {
            return parts.over(self.ends, [middle - self.half, middle + self.half]);
        }
        // Its own column: both halves alike.
        2.0 * parts.over(self.ends, [0.0, self.half])
    }
}

/// Integrals over parts of pixels.
struct Parts<'a> {
    rows: &'a Rows,
    kernel: &'a Tabled,
    fineness: Fineness,
}

impl Parts<'_> {
    /// Over a part between two angles from the zenith and two azimuths: at once where it is far for its size, else in two parts.
    fn over(&self, theta: [f64; 2], phi: [f64; 2]) -> f64 {
        let rows = self.rows;
        let sine = 0.5 * (theta[0] + theta[1]);
        let (tall, wide) = (theta[1] - theta[0], (phi[1] - phi[0]) * sine.sin());
        let size = tall.max(wide);
        let beside = (theta[0] - rows.to).max(rows.to - theta[1]).max(0.0);
        // The least distance of the two meridians, at the less wide of the two rings.
        let least = rows.to.sin().min(theta[0].sin().min(theta[1].sin()).max(0.0));
        let across = 2.0 * least * (0.5 * phi[0].min(PI)).sin().max(0.0);
        let distance = beside.hypot(across);
        let (nodes, far): (&[[f64; 2]], f64) = match self.fineness {
            Fineness::Usual => (&THREE, 0.7),
            Fineness::Finer => (&FOUR, 0.6),
        };
        if size <= far * distance || size <= LEAST {
            let (middle, reach) = (0.5 * (phi[0] + phi[1]), 0.5 * (phi[1] - phi[0]));
            let node = |&[node, weight]: &[f64; 2]| {
                weight * rows.along(self.kernel, theta, nodes, (0.5 * (middle + reach * node)).sin().powi(2))
            };
            return reach * nodes.iter().map(node).sum::<f64>();
        }
        if tall >= wide {
            // At the other pixel's own height, where it is within.
            let within = rows.to > theta[0] && rows.to < theta[1];
            let cut = if within { rows.to } else { 0.5 * (theta[0] + theta[1]) };
            return self.over([theta[0], cut], phi) + self.over([cut, theta[1]], phi);
        }
        let cut = 0.5 * (phi[0] + phi[1]);
        self.over(theta, [phi[0], cut]) + self.over(theta, [cut, phi[1]])
    }
}
