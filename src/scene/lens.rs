//! A lens, as the table of ghosts that it makes of any light.

use glam::DVec2;

use super::{Ghost, LensGhost, Light, VeilSection};

/// A lens: every light gets one ghost from each entry of its table.
#[derive(Debug, Clone, PartialEq)]
pub struct Lens {
    /// The preset's name, or the file's without its extension.
    pub name: String,
    /// One line for people; empty where the file has none.
    pub description: String,
    /// What it makes of a light.
    pub ghosts: Vec<LensGhost>,
    /// What every pixel scatters in it, if it says so.
    pub veil: Option<LensVeil>,
}

/// The veil of a lens.
#[derive(Debug, Clone, PartialEq)]
pub struct LensVeil {
    /// The function, and how it is laid.
    pub section: VeilSection,
    /// Whether the lens's ghosts are what the lights have of a veil, so that they are left out where there is one.
    pub replaces_ghosts: bool,
}

impl Lens {
    /// The part of a light's luminous flux that returns as veil, 0 to 1: the sum of share × luminance of the tint, with
    /// Rec. 709 weights. A black spot in a wide white field reads about this (ISO 9358's veiling glare index).
    pub fn veiling_share(&self) -> f64 {
        let share =
            |LensGhost { share, tint: [r, g, b], .. }: &LensGhost| share * (0.2126 * r + 0.7152 * g + 0.0722 * b);
        // Not -0, which a sum of nothing is.
        self.ghosts.iter().map(share).fold(0.0, |sum, share| sum + share)
    }
}

/// The ghosts of all lights that are not muted, light by light in the lens's order.
///
/// A lens ghost with `along` = a shows the light at axis + a (position − axis), |a| times as large and blurred by the
/// ghost's own bell. Of a Gaussian bell and a light of rms size s that is a Gaussian of variance σ² + (a s)² along each
/// axis; another bell is made larger until its variance is that. The flux is the light's times share times tint, whatever
/// the sizes.
pub fn ghosts(lights: &[Light], lens: &Lens, axis: DVec2) -> Vec<Ghost> {
    let shining = lights.iter().filter(|light| !light.muted);
    shining.flat_map(|light| lens.ghosts.iter().map(move |ghost| ghost.of(light, axis))).collect()
}

impl LensGhost {
    /// The ghost of one light, through a lens whose axis meets the picture at `axis`.
    pub fn of(&self, light: &Light, axis: DVec2) -> Ghost {
        let center = axis + self.along * (light.position - axis);
        let ghost = self.image(DVec2::splat(light.size));
        Ghost { center, radiance: std::array::from_fn(|c| light.flux[c] * ghost.radiance[c]), ..ghost }
    }

    /// The ghost of a light of flux 1 on the axis, there, whose light is so far from its centre along x and y, as a root mean square.
    pub fn image(&self, extent: DVec2) -> Ghost {
        let shape = self.bell.shape();
        let variance = shape.variance();
        let extent = if variance > 0.0 { self.along * extent / variance.sqrt() } else { DVec2::ZERO };
        let size = DVec2::new(self.size.x.hypot(extent.x), self.size.y.hypot(extent.y));
        let peak = self.share / shape.integral(size);
        Ghost { bell: self.bell.clone(), center: DVec2::ZERO, size, radiance: self.tint.map(|tint| tint * peak) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::series::Bell;

    fn lens_ghost(along: f64, size: DVec2) -> LensGhost {
        LensGhost { bell: Bell::Gaussian, along, size, tint: [1.0, 0.5, 0.0], share: 0.02 }
    }

    #[test]
    fn a_ghost_is_along_the_line_through_the_axis() {
        let light = Light { position: DVec2::new(0.6, -0.4), flux: [1.0; 3], size: 0.0, muted: false };
        let ghost = lens_ghost(-0.5, DVec2::new(0.3, 0.1)).of(&light, DVec2::ZERO);
        assert_eq!(ghost.center, DVec2::new(-0.3, 0.2));
        assert_eq!(ghost.size, DVec2::new(0.3, 0.1));
    }

    #[test]
    fn a_lights_extent_widens_its_ghost_by_its_magnification() {
        let light = Light { position: DVec2::ZERO, flux: [1.0; 3], size: 0.4, muted: false };
        let ghost = lens_ghost(-2.0, DVec2::new(0.6, 1.5)).of(&light, DVec2::ZERO);
        assert!((ghost.size - DVec2::new(1.0, 1.7)).length() < 1e-15);
        assert_eq!(lens_ghost(0.0, DVec2::ONE).of(&light, DVec2::ZERO).size, DVec2::ONE);
    }

    #[test]
    fn a_ghosts_flux_is_the_lights_times_share_times_tint() {
        let light = Light { position: DVec2::new(0.1, 0.2), flux: [7.0, 5.0, 3.0], size: 0.1, muted: false };
        let ghost = lens_ghost(-0.7, DVec2::new(0.2, 0.05)).of(&light, DVec2::ZERO);
        // Summed over the plane on a grid, which for a Gaussian this well sampled is exact.
        let step = 0.01;
        let integral: f64 = (-300..=300)
            .flat_map(|j| (-300..=300).map(move |i| (f64::from(i) * step, f64::from(j) * step)))
            .map(|(x, y)| (-0.5 * ((x / ghost.size.x).powi(2) + (y / ghost.size.y).powi(2))).exp() * step * step)
            .sum();
        for (c, expected) in [0.14, 0.05, 0.0].into_iter().enumerate() {
            assert!((ghost.radiance[c] * integral - expected).abs() < 1e-12);
        }
    }

    #[test]
    fn ghosts_go_light_by_light() {
        let at = |x| Light { position: DVec2::new(x, 0.0), flux: [1.0; 3], size: 0.0, muted: false };
        let along = |a| lens_ghost(a, DVec2::ONE);
        let lens =
            Lens { name: String::new(), description: String::new(), ghosts: vec![along(1.0), along(-1.0)], veil: None };
        let centers: Vec<_> =
            ghosts(&[at(0.5), at(0.25)], &lens, DVec2::ZERO).iter().map(|ghost| ghost.center.x).collect();
        assert_eq!(centers, [0.5, -0.5, 0.25, -0.25]);
        assert!((lens.veiling_share() - 2.0 * 0.02 * (0.2126 + 0.5 * 0.7152)).abs() < 1e-15);
    }
}
