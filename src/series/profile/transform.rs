//! The Hankel transform of a profile, and what is left of it beyond a frequency.

use std::f64::consts::TAU;

use rayon::prelude::*;

use super::Profile;
use crate::series::bell::{Bounded, Radial};
use crate::series::nodes::between_nodes;
use crate::series::paraboloid::cut_off;
use crate::series::special::{bessel_j, paraboloid_kernel_looked_up};

/// Rows from which on kernels are looked up: every mode of a series asks for those of all rows.
const FEW_ROWS: usize = 64;

/// Steps of the table of what lies beyond a frequency: their width times the profile's radius, and how many there are.
const STEP: f64 = 0.25;
const STEPS: usize = 4000;

/// What one paraboloid's kernel costs, about, in nanoseconds.
const KERNEL: f64 = 20.0;

impl Profile {
    /// ∫ M dz and ∫ z M dz from each step of z on, where M is the largest |ĝ| from there on; and M.
    fn integrals(&self) -> Vec<[f64; 3]> {
        let width = STEP / self.radius();
        let sampled = self.sampled();
        let mut largest = sampled[STEPS];
        let mut beyond = vec![[0.0, 0.0, largest]; STEPS + 1];
        for i in (0..STEPS).rev() {
            largest = largest.max(sampled[i]);
            let next = beyond[i + 1];
            beyond[i] = [next[0] + width * largest, next[1] + width * (i as f64 + 1.0) * width * largest, largest];
        }
        beyond
    }

    /// A bound of |ĝ| at each step of z and as far as the middle of the next.
    fn sampled(&self) -> Vec<f64> {
        // What looking the kernels up may be off by: a part of what they are, which falls as t^(−5/2).
        let off = if self.looks_up() { 1e-8 } else { 0.0 };
        let weights: f64 = self.kernels.iter().map(|[_, weight]| weight.abs()).sum();
        let falling = self.kernels.iter().map(|[radius, weight]| weight.abs() * (radius / self.radius()).powf(-2.5));
        let falling: f64 = 8.0 * falling.sum::<f64>();
        let bound = |i: usize| {
            let end = STEP * i as f64;
            let off = off * weights.min(falling * end.powf(-2.5));
            // ĝ has nothing faster than the radius in it, so between steps it is hardly larger than at them.
            1.05 * (self.transform(end / self.radius()).abs() + TAU * off)
        };
        (0..=STEPS).into_par_iter().map(bound).collect()
    }

    /// Whether the kernels of so many rows are looked up and not computed.
    fn looks_up(&self) -> bool {
        self.kernels.len() > FEW_ROWS
    }

    /// What the step at the end adds to ĝ/2π, as a disc; `end` is z times the radius.
    fn stepped(&self, end: f64) -> f64 {
        let disc = if end < 1e-4 { 0.5 } else { bessel_j(1, end) / end };
        self.step() * self.radius() * self.radius() * disc
    }

    /// What the kinks and the step leave beyond z.
    fn cut_off(&self, z: f64) -> f64 {
        let kinks: f64 = self.kinks().map(|(radius, kink)| kink.abs() * radius * radius * cut_off(z * radius)).sum();
        kinks + self.step().abs() * (0.6 + 1.0 / (z * self.radius()).sqrt())
    }
}

impl Radial for Profile {
    /// Twice by parts, with ∫ r² J1(qr) dr = r² J2(qr)/q: the step at the end as a disc, every kink as a paraboloid.
    fn transform(&self, z: f64) -> f64 {
        let kinks = self.kernels.iter().map(|&[radius, weight]| weight * paraboloid_kernel_looked_up(z * radius));
        let kinks: f64 = kinks.sum();
        TAU * (self.stepped(z * self.radius()) + kinks)
    }

    fn transforms(&self, at: &[f64]) -> Vec<f64> {
        between_nodes(at, self.radius(), |z| self.transform(z))
    }
}

impl Bounded for Profile {
    /// The smaller of what the kinks leave, which falls slowly, and of all that is left, which falls fast where the
    /// table is smooth and ends where its rows show.
    fn beyond(&self, z: f64, cell: f64) -> f64 {
        let kinks = self.cut_off(z);
        let width = STEP / self.radius();
        // A mode stands for its cell, in which |ĝ| may be as large as half a diagonal further in.
        let first = ((z - 2.0 * cell) / width).floor().max(0.0) as usize;
        let Some([constant, linear, _]) = self.beyond.get_or_init(|| self.integrals()).get(first) else { return kinks };
        let all = (linear + cell * constant) / TAU + self.cut_off(width * STEPS as f64);
        kinks.min(all)
    }

    fn envelope(&self, z: f64) -> f64 {
        let step = (z * self.radius() / STEP) as usize;
        match self.beyond.get_or_init(|| self.integrals()).get(step) {
            Some(&[_, _, largest]) => largest,
            None => {
                let kinks = self.kernels.iter().map(|[radius, weight]| weight.abs() * (z * radius).powf(-2.5));
                let disc = self.step().abs() * self.radius().powi(2) * (z * self.radius()).powf(-1.5);
                TAU * (8.0 * 0.86 * kinks.sum::<f64>() + 0.83 * disc)
            }
        }
    }

    fn end(&self) -> f64 {
        self.radius()
    }

    /// The table of what lies beyond each frequency, on two cores.
    fn preparation(&self) -> f64 {
        0.5 * KERNEL * STEPS as f64 * self.kernels.len() as f64
    }

    fn work(&self) -> f64 {
        KERNEL * self.kernels.len() as f64
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec2;

    use super::*;
    use crate::series::Shape as _;
    use crate::series::nodes::nodes;
    use crate::series::profile::tests::trembling;
    use crate::series::special::paraboloid_kernel;

    #[test]
    fn what_a_series_needs_is_made_when_one_asks_and_once() {
        let profile = trembling();
        assert!(profile.variance() > 0.0 && profile.integral(DVec2::ONE) > 0.0);
        assert!(profile.beyond.get().is_none(), "made though only the direct sum was asked for");
        let shared = std::sync::Arc::new(profile);
        let first = Bounded::beyond(&*shared, 20.0, 0.1);
        let made = shared.beyond.get().unwrap().as_ptr();
        assert_eq!((Bounded::beyond(&*shared, 20.0, 0.1), shared.beyond.get().unwrap().as_ptr()), (first, made));
        assert_eq!(*shared, trembling(), "the same profile, whatever has been made of it");
    }

    #[test]
    fn kernels_that_are_looked_up_are_those_that_are_computed() {
        let profile = trembling();
        assert!(profile.looks_up());
        for z in [0.0, 1e-3, 0.7, 12.3, 456.7, 2345.6] {
            let kinks: f64 =
                profile.kernels.iter().map(|[radius, weight]| weight * paraboloid_kernel(z * radius)).sum();
            let exact = TAU * (profile.stepped(z * profile.radius()) + kinks);
            let off = (profile.transform(z) - exact).abs();
            assert!(off < 1e-8 * profile.volume, "{z}: {off:e}");
        }
    }

    #[test]
    fn transforms_between_nodes_are_those_that_are_summed() {
        let profile = trembling();
        let last = 40.0;
        let at: Vec<f64> = (0..4000).map(|i| last * f64::from(i) / 3999.0).collect();
        assert!(nodes(last, profile.radius()) < 0.5 * at.len() as f64, "few enough nodes");
        for (z, read) in at.iter().zip(profile.transforms(&at)) {
            let kinks: f64 =
                profile.kernels.iter().map(|[radius, weight]| weight * paraboloid_kernel(z * radius)).sum();
            let off = (read - TAU * (profile.stepped(z * profile.radius()) + kinks)).abs();
            assert!(off < 2e-8 * profile.volume, "{z}: {off:e}");
        }
    }

    #[test]
    fn the_bound_from_looked_up_kernels_holds_between_its_steps_and_is_close() {
        let profile = trembling();
        let (bounds, width) = (profile.sampled(), STEP / profile.radius());
        let (mut largest, mut sum) = (0.0f64, [0.0; 2]);
        for (i, bound) in bounds.iter().enumerate() {
            let exact = [0.0, 0.5].map(|between| profile.transform(width * (i as f64 + between)).abs());
            let next = bounds.get(i + 1).copied().unwrap_or(f64::INFINITY);
            assert!(exact[0] <= *bound && exact[1] <= bound.max(next) + 0.03 * largest.max(exact[1]), "step {i}");
            largest = largest.max(exact[0]);
            sum = [sum[0] + bound, sum[1] + exact[0]];
        }
        assert!(sum[0] < 1.06 * sum[1], "{sum:?}");
    }
}
