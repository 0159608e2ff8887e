//! cos and sin of every harmonic at a list of positions, in f64.

use std::f64::consts::TAU;

/// Harmonics after which the rotations begin anew, so that their roundings do not add up.
const ANEW: usize = 16;

/// (cos 2πnt, sin 2πnt) times `gains[n]`, harmonic after harmonic, each for all of the positions t, in periods and best within
/// half of one; off by some 2⁻⁵³ (10 + 2πn).
pub fn waves(turns: &[f64], gains: &[f64]) -> Vec<[f64; 2]> {
    let count = turns.len();
    let exactly = |n: usize, t: f64| {
        let turns = n as f64 * t;
        let (sin, cos) = (TAU * (turns - turns.round())).sin_cos();
        [cos, sin]
    };
    let once: Vec<[f64; 2]> = turns.iter().map(|&t| exactly(1, t)).collect();
    let mut waves: Vec<[f64; 2]> = Vec::with_capacity(count * gains.len());
    for n in 0..gains.len() {
        if n % ANEW == 0 {
            waves.extend(turns.iter().map(|&t| exactly(n, t)));
            continue;
        }
        let before = waves.len() - count;
        for (k, &[c, s]) in once.iter().enumerate() {
            let [cos, sin] = waves[before + k];
            waves.push([cos * c - sin * s, sin * c + cos * s]);
        }
    }
    if count > 0 {
        for (row, &gain) in waves.chunks_exact_mut(count).zip(gains) {
            row.iter_mut().for_each(|wave| *wave = wave.map(|value| value * gain));
        }
    }
    waves
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn waves_are_those_of_each_harmonic_by_itself() {
        let turns = [0.0, 0.125, -0.37, 0.499_999, 1.0 / 3.0];
        let gains: Vec<f64> = (0..700).map(|n| 1.0 + 1e-3 * f64::from(n)).collect();
        let all = waves(&turns, &gains);
        assert_eq!(all.len(), turns.len() * gains.len());
        for (n, &gain) in gains.iter().enumerate() {
            for (k, &t) in turns.iter().enumerate() {
                let angle = TAU * ((n as f64 * t).fract());
                let [cos, sin] = all[n * turns.len() + k];
                let most = gain * f64::EPSILON * (10.0 + TAU * n as f64);
                assert!((cos - gain * angle.cos()).abs() < most && (sin - gain * angle.sin()).abs() < most, "{n} {t}");
            }
        }
    }
}
