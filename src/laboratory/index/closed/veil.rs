//! The veil of an even field at a point: ∫ k over all that is lit, in polar coordinates about the point. Along a ray the integral of k is
//! the energy within a radius, so that what is left is one integral over directions of the energy within the picture's edge, less what
//! lies within spots.

use std::f64::consts::{PI, TAU};

use glam::DVec2;

use super::rule;
use super::sight::Sight;
use crate::psf::{Psf, Unit};

/// The energy of a function within radii or angles: a table, cubic in between by its slopes, which are 2π r k(r).
pub struct Energies {
    /// Whether radii are angles, in degrees.
    angles: bool,
    /// What a length of the plane is divided by to be one of the function.
    unit: f64,
    /// Of the radii `FIRST` · ratioⁿ: the energy, and its slope.
    rows: Vec<[f64; 2]>,
    first: f64,
    ratio: f64,
}

/// Rows of the table.
const ROWS: u32 = 600;
/// The first radius, of the last.
const FIRST: f64 = 1e-6;
/// Nodes in directions, from one corner or end of a spot to the next.
const DIRECTIONS: usize = 24;

impl Energies {
    /// Of a function of angles in degrees, or of lengths in the look's unit over `unit`, up to the farthest of a field.
    pub fn new(psf: &Psf, unit: f64, sight: &Sight) -> Self {
        let angles = psf.unit() == Unit::Degrees;
        let corner = sight.half.length();
        let last = if angles { 2.0 * (corner / sight.focal).atan().to_degrees() } else { 2.0 * corner / unit };
        let (first, ratio) = (FIRST * last, FIRST.powf(-f64::from(ROWS).recip()));
        let row = |k: u32| {
            let at = first * ratio.powi(k as i32);
            let around = if angles { TAU * at.to_radians().sin() * 1f64.to_radians() } else { TAU * at };
            // A step beyond the end is as flat as it is there.
            [psf.energy_within(at), if at < psf.end() { around * psf.value(at) } else { 0.0 }]
        };
        Self { angles, unit, rows: (0..=ROWS).map(row).collect(), first, ratio }
    }

    fn within(&self, at: f64) -> f64 {
        let place = (at / self.first).ln() / self.ratio.ln();
        if place.is_nan() || place <= 0.0 {
            // As over a constant.
            return self.rows[0][0] * (at / self.first).powi(2);
        }
        let row = (place as usize).min(ROWS as usize - 1);
        let low = self.first * self.ratio.powi(row as i32);
        let width = low * (self.ratio - 1.0);
        let t = (at - low) / width;
        let [[one, slope], [other, its_slope]] = [self.rows[row], self.rows[row + 1]];
        let (back, square) = (1.0 - t, t * t);
        back * back * (1.0 + 2.0 * t) * one
            + square * (3.0 - 2.0 * t) * other
            + width * t * back * (back * slope - t * its_slope)
    }

    /// The veil at a point of an even field of luminance 1.
    pub fn veil(&self, sight: &Sight, at: DVec2) -> f64 {
        let [across, up] = sight.beside(at);
        let towards = sight.direction(at);
        // The function's radius of a place on the plane.
        let radius = |place: DVec2| match self.angles {
            true => (2.0 * (0.5 * towards.distance(sight.direction(place))).asin()).to_degrees(),
            false => place.distance(at) / self.unit,
        };
        // The direction on the plane of one by an angle about the point, and the reverse.
        let way = |angle: f64| match self.angles {
            true => {
                let (sine, cosine) = angle.sin_cos();
                let aside = cosine * across + sine * up;
                // How the place moves that is seen as the view turns.
                (aside.truncate() * towards.z - towards.truncate() * aside.z).normalize()
            }
            false => DVec2::from_angle(angle),
        };
        let angle = |place: DVec2| match self.angles {
            true => {
                let aside = sight.direction(place);
                aside.dot(up).atan2(aside.dot(across))
            }
            false => (place - at).to_angle(),
        };
        let corners =
            [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]].map(|signs| angle(DVec2::from(signs) * sight.half));
        let ends = sight.spots.iter().filter_map(|spot| spot.ends(at)).flatten();
        let ends = ends.map(|end| angle(at + 1e-3 * sight.half.x * DVec2::from_angle(end)));
        let mut places: Vec<f64> = corners.into_iter().chain(ends).chain([-PI, PI]).collect();
        places.sort_by(f64::total_cmp);
        let along = |turn: f64| {
            let way = way(turn);
            let within = |far: f64| self.within(radius(at + far * way));
            let spots = sight.spots.iter().filter_map(|spot| spot.along(at, way));
            within(sight.edge(at, way)) - spots.map(|[enters, leaves]| within(leaves) - within(enters)).sum::<f64>()
        };
        places.windows(2).map(|pair| rule::integral(DIRECTIONS, pair[0], pair[1], along)).sum::<f64>() / TAU
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::psf::Observer;

    /// A Gaussian's veil on a rectangle is a product of error functions.
    #[test]
    fn a_gaussians_veil_is_a_product_of_error_functions() {
        let (sight, sigma) = (Sight::new(DVec2::new(1.5, 1.0), 2.0), 0.3);
        let energies = Energies::new(&Psf::gaussian(sigma).unwrap(), 1.0, &sight);
        let part = |at: f64, half: f64| {
            let erf = |x: f64| crate::series::special::erf(x / (sigma * std::f64::consts::SQRT_2));
            0.5 * (erf(half - at) + erf(half + at))
        };
        for at in [DVec2::ZERO, DVec2::new(1.2, -0.7), DVec2::new(-1.3, 0.85)] {
            let wanted = part(at.x, 1.5) * part(at.y, 1.0);
            let found = energies.veil(&sight, at);
            assert!((found / wanted - 1.0).abs() < 1e-6, "{at}: {found} for {wanted}");
        }
        // About the middle of a spot all but what is within it.
        let spotted = Sight { spots: vec![sight.spot(DVec2::ZERO, 10.0)], ..sight.clone() };
        let radius = 2.0 * 5f64.to_radians().tan();
        let wanted = energies.veil(&sight, DVec2::ZERO) - (1.0 - (-0.5 * (radius / sigma).powi(2)).exp());
        assert!((energies.veil(&spotted, DVec2::ZERO) - wanted).abs() < 1e-7);
    }

    /// The sum over the pixels of a fine picture comes close to it, on the plane and on the sphere; in spots, as pixels are coarser than what is
    /// next to a point.
    #[test]
    fn sums_over_pixels_come_close_to_it() {
        const ROWS: usize = 300;
        let pixel = 2.0 / ROWS as f64;
        let place = |x: usize, y: usize| DVec2::new(x as f64 - 224.5, y as f64 - 149.5) * pixel;
        let plain = Sight::new(DVec2::new(1.5, 1.0), 1.5 / 25f64.to_radians().tan());
        let spots = [place(225, 150), place(350, 240)].map(|place| plain.spot(place, 8.0)).to_vec();
        let sight = Sight { spots, ..plain };
        let (eye, camera) = (Psf::cie(Observer::new(40.0, 0.5).unwrap()), Psf::camera());
        for psf in [&camera, &eye] {
            let energies = Energies::new(psf, 1.0, &sight);
            for here in [place(225, 150), place(350, 240), place(356, 233)] {
                // What the function has of a pixel, and how large that is.
                let seen = |there: DVec2| match psf.unit() {
                    Unit::Degrees => {
                        let directions = [here, there].map(|place| sight.direction(place));
                        let angle = directions[0].angle_between(directions[1]).to_degrees();
                        psf.value(angle) * directions[1].z.powi(3) * (pixel / sight.focal).powi(2)
                    }
                    _ => psf.value(there.distance(here)) * pixel * pixel,
                };
                let all = (0..ROWS).flat_map(|y| (0..ROWS * 3 / 2).map(move |x| place(x, y)));
                let wanted: f64 = all.filter(|there| sight.is_lit(*there)).map(seen).sum();
                let found = energies.veil(&sight, here);
                assert!((found / wanted - 1.0).abs() < 6e-3, "{}: {found} for {wanted} at {here}", psf.name());
            }
        }
    }
}
