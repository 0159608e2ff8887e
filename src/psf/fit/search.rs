//! How many Gaussians a tolerance takes, and where a fit begins.

use super::samples::{Profile, Samples};
use super::{Fitted, MOST_TERMS, linear, measured};

/// By how much ln error falls with one Gaussian more, times the decades of angle: measured, 1.7 to 1.9 over the eye's
/// functions.
const FALL: f64 = 1.75;
/// ln error of no Gaussian at all, by the same line.
const BEGIN: f64 = 1.9;
/// How many fits a search makes at most.
const FITS: usize = 12;

/// What a profile looks like over a range, roughly.
pub(super) struct Shape {
    /// Where it is to be met.
    pub range: [f64; 2],
    /// Where it begins to fall, by a part of the tolerance: nearer there is nothing to be sampled.
    low: f64,
    /// Where it has fallen to 0.7.
    knee: f64,
    /// The narrowest and the widest standard deviation to begin with.
    widths: [f64; 2],
    /// Decades of angle over which it falls.
    decades: f64,
}

impl Shape {
    /// Of a profile.
    pub fn new(profile: &impl Profile, range: [f64; 2], tolerance: f64) -> Self {
        let [from, to] = range;
        let knee = falls_to(profile, range, 0.7);
        let before = profile(to / 1.05)[0];
        // −d ln k / d ln θ at the far end: that of a Gaussian is θ²/σ² there.
        let slope = (before / profile(to)[0]).ln() / 1.05_f64.ln();
        let widest = to / if slope > 1e-8 { slope.min(100.0).sqrt() } else { 1e-4 };
        // A flat top is a Gaussian's; where it falls from the begin, narrower ones than the begin make up the power.
        let narrowest = (if knee > 2.0 * from { 0.9 } else { 0.5 + 0.04 * tolerance.log10() } * knee).min(widest);
        Self {
            range,
            low: falls_to(profile, range, 1.0 - 0.125 * tolerance).clamp(from, knee),
            knee,
            widths: [narrowest, widest],
            decades: (to / knee).log10().max(0.0) + 0.1,
        }
    }

    /// An angle, moved into the range.
    pub fn within(&self, angle: f64) -> f64 {
        angle.clamp(self.range[0], self.range[1])
    }

    /// As many samples as `count` Gaussians need: their error has up to 2 `count` + 1 extrema.
    pub fn samples(&self, profile: &impl Profile, count: usize) -> Samples {
        let least = (40.0 * (self.range[1] / self.low).log10()) as usize;
        Samples::new(profile, [self.low, self.range[1]], (14 * count).max(least) + 8)
    }

    /// Starts for ln σ: `last` with its widths stretched over another count; what the best mixtures of powers look
    /// like, even but for a wide step to the last; and even ones.
    pub fn starts(&self, count: usize, last: Option<&Fitted>) -> Vec<Vec<f64>> {
        let [narrow, wide] = self.widths;
        let last = last.filter(|last| last.gaussians.len() > 2).map(|last| stretched(&last.gaussians, count));
        let others = [
            spread([narrow, 1.2 * wide], count, 2.0),
            spread([narrow, wide], count, 1.0),
            spread([0.5 * narrow, 0.6 * wide], count, 1.0),
        ];
        last.into_iter().chain(others).collect()
    }

    /// How many Gaussians `tolerance` is likely to take.
    fn guess(&self, tolerance: f64) -> usize {
        (((BEGIN - tolerance.ln()) * self.decades / FALL).ceil() as usize).clamp(1, MOST_TERMS)
    }

    /// By how many an error is from another, likely.
    fn steps(&self, error: f64, other: f64) -> f64 {
        (error / other).ln() * self.decades / FALL
    }
}

/// The smallest angle where a falling profile is `part` of what it is at the range's begin; the range's end where it
/// falls less.
fn falls_to(profile: &impl Profile, range: [f64; 2], part: f64) -> f64 {
    let level = part * profile(range[0])[0];
    if profile(range[1])[0] > level {
        return range[1];
    }
    let [mut low, mut high] = range.map(f64::ln);
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        *if profile(middle.exp())[0] > level { &mut low } else { &mut high } = middle;
    }
    (0.5 * (low + high)).exp().clamp(range[0], range[1])
}

/// Logarithms of `count` widths between two, with even steps but for the last, which is `wider` times as long.
fn spread(ends: [f64; 2], count: usize, wider: f64) -> Vec<f64> {
    let [low, high] = ends.map(f64::ln);
    if count < 3 {
        return (0..count).map(|i| low + (high - low) * (i as f64 + 0.5) / count as f64).collect();
    }
    let step = (high - low) / (count as f64 - 2.0 + wider);
    (0..count).map(|i| if i == count - 1 { high } else { low + step * i as f64 }).collect()
}

/// ln σ of `count` Gaussians that lie as those do.
fn stretched(gaussians: &[[f64; 2]], count: usize) -> Vec<f64> {
    let last = gaussians.len() - 1;
    let at = |i: usize| {
        let place = if count > 1 { (i * last) as f64 / (count - 1) as f64 } else { 0.5 * last as f64 };
        let below = (place as usize).min(last - 1);
        let part = place - below as f64;
        gaussians[below][0].ln() * (1.0 - part) + gaussians[below + 1][0].ln() * part
    };
    (0..count).map(at).collect()
}

/// The fewest Gaussians with which `attempt`, of a count and the last fit, meets `tolerance`: from the likely number up
/// or down. If none does, the fit of the least error.
pub(super) fn fewest(
    shape: &Shape,
    tolerance: f64,
    mut attempt: impl FnMut(usize, Option<&Fitted>) -> Fitted,
) -> Fitted {
    let mut count = shape.guess(tolerance);
    let mut best = attempt(count, None);
    let mut last = best.clone();
    // The most that failed, and the fewest that met it.
    let (mut failed, mut met) = (0, MOST_TERMS + 1);
    let mut idle = 0;
    for _ in 0..FITS {
        let steps = shape.steps(last.error, tolerance);
        let next = if last.error <= tolerance {
            met = met.min(count);
            (count as f64 + steps).ceil().max(failed as f64 + 1.0) as usize
        } else {
            failed = failed.max(count);
            (count as f64 + steps).min(met as f64 - 1.0).min((count + 6) as f64) as usize
        };
        count = next.clamp(failed + 1, (met - 1).max(failed + 1));
        if count >= met || count > MOST_TERMS || idle >= 3 {
            break;
        }
        let fit = attempt(count, Some(&last));
        let better = match (fit.error <= tolerance, best.error <= tolerance) {
            (true, true) => fit.gaussians.len() < best.gaussians.len(),
            (true, false) => true,
            (false, true) => false,
            (false, false) => fit.error < best.error,
        };
        // More Gaussians that are no better: the profile is none that positive ones can meet.
        idle = if best.error > tolerance && fit.error > 0.9 * best.error { idle + 1 } else { 0 };
        if better {
            best = fit.clone();
        }
        last = fit;
    }
    best
}

/// The ratios of neighbouring widths that [`signed`] tries, from the one that cancels least.
const RATIOS: [f64; 5] = [1.9, 1.7, 1.5, 1.4, 1.3];
/// What the sum of all sizes may be over the function.
const MOST_CANCELLATION: f64 = 100.0;

/// For profiles that positive mixtures do not meet: weights of both signs, of even widths. `positive` where that is no
/// better.
pub(super) fn signed(profile: &impl Profile, shape: &Shape, tolerance: f64, positive: Fitted) -> Fitted {
    let mut best = positive;
    let [low, high] = [(0.28 * shape.knee).ln(), (1.2 * shape.widths[1]).ln()];
    for ratio in RATIOS {
        let count = (((high - low) / f64::ln(ratio)).ceil() as usize + 1).clamp(2, MOST_TERMS);
        let samples = shape.samples(profile, count);
        let widths: Vec<f64> = (0..count).map(|i| low + (high - low) * i as f64 / (count - 1) as f64).collect();
        let heights: Vec<f64> = widths.iter().map(|width| profile(shape.within(width.exp()))[0].ln()).collect();
        let basis = samples.shares(&widths, &heights);
        let Some((factors, _)) = linear::least_largest(&basis, count, &samples.wanted, 60) else { continue };
        let sizes =
            basis.chunks_exact(count).map(|row| row.iter().zip(&factors).map(|(a, b)| (a * b).abs()).sum::<f64>());
        if sizes.fold(0.0, f64::max) > MOST_CANCELLATION {
            continue;
        }
        let gaussians: Vec<[f64; 2]> = (0..count).map(|i| [widths[i].exp(), factors[i] * heights[i].exp()]).collect();
        let error = measured(profile, shape.range, &gaussians);
        if error < 0.7 * best.error {
            best = Fitted { gaussians, error };
        }
        if best.error <= tolerance {
            break;
        }
    }
    best
}
