//! How much of a pixel shines where only what is bright is to: nothing below a threshold, and smoothly more above it.

use rayon::prelude::*;

use super::emission::Emission;

/// A soft threshold, on the brightest channel of a pixel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Knee {
    /// 0 or more, in the photo's unit.
    pub threshold: f64,
    /// The transition begins so far below the threshold and ends so far above it, 0 or more.
    pub width: f64,
}

impl Knee {
    /// Every pixel shines with all of its light.
    pub const NONE: Self = Self { threshold: 0.0, width: 0.0 };

    /// The share of a pixel's light that shines, 0 to 1: max(m − T, clamp(m − T + K, 0, 2K)² / 4K) / m, m its brightest channel. What
    /// shines is a smooth function of the light, without a jump.
    pub fn share(&self, brightest: f64) -> f64 {
        let Self { threshold, width } = *self;
        // No finite number shines no more than black does.
        if !brightest.is_finite() || brightest <= 0.0 {
            return 0.0;
        }
        let above = brightest - threshold;
        let soft = if width > 0.0 { (above + width).clamp(0.0, 2.0 * width).powi(2) / (4.0 * width) } else { 0.0 };
        (above.max(soft) / brightest).clamp(0.0, 1.0)
    }

    /// What of each pixel shines by how bright it is shown, where pixels shine otherwise than they are shown.
    pub(super) fn softened(&self, shown: &[[f32; 4]], shining: &[[f32; 4]], emission: Emission) -> Vec<[f32; 4]> {
        let of = |(shown, &[r, g, b, a]): (&[f32; 4], &[f32; 4])| {
            let share = self.share(emission.brightness(shown).into()) as f32;
            [share * r, share * g, share * b, a]
        };
        shown.par_iter().zip(shining).map(of).collect()
    }

    /// What of each pixel shines; a channel that is no finite number does not make its pixel brighter.
    pub fn shining(&self, pixels: &[[f32; 4]]) -> Vec<[f32; 4]> {
        let of = |&[r, g, b, a]: &[f32; 4]| {
            let share = self.share(brightest([r, g, b]).into()) as f32;
            [share * r, share * g, share * b, a]
        };
        pixels.par_iter().map(of).collect()
    }
}

/// The largest of the channels that are finite, 0 or more.
pub fn brightest(channels: [f32; 3]) -> f32 {
    channels.into_iter().filter(|channel| channel.is_finite()).fold(0.0, f32::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_shines_grows_without_a_jump() {
        let knee = Knee { threshold: 2.0, width: 0.5 };
        let shines = |m: f64| m * knee.share(m);
        assert_eq!([0.0, 1.0, 1.5, f64::NAN].map(|m| knee.share(m)), [0.0; 4]);
        // At the threshold a quarter of the width; from the end of the transition on all that is above it.
        assert!((shines(2.0) - 0.125).abs() < 1e-12 && (shines(2.5) - 0.5).abs() < 1e-12);
        assert!((shines(1e6) - (1e6 - 2.0)).abs() < 1e-6);
        let mut last = 0.0;
        for step in 1..4000 {
            let next = shines(f64::from(step) * 1e-3);
            assert!((0.0..=1.001e-3).contains(&(next - last)), "{step}");
            last = next;
        }
        assert_eq!((Knee::NONE.share(1e-30), Knee::NONE.share(f64::INFINITY)), (1.0, 0.0));
    }

    #[test]
    fn a_hard_knee_is_the_limit_of_soft_ones() {
        let [hard, soft] = [0.0, 1e-9].map(|width| Knee { threshold: 1.0, width });
        for m in [0.5, 0.999, 1.001, 3.0] {
            assert!((hard.share(m) - soft.share(m)).abs() < 1e-8, "{m}");
        }
        let shining = hard.shining(&[[4.0, 2.0, f32::NAN, 0.5], [0.5, 0.9, 0.1, 1.0]]);
        assert_eq!((shining[0][0], shining[0][1], shining[0][3], shining[1]), (3.0, 1.5, 0.5, [0.0, 0.0, 0.0, 1.0]));
    }
}
