//! How long the last pictures took, and how fast frames follow each other.

use std::collections::VecDeque;

use super::stage::Times;

/// How many pictures are remembered.
const PICTURES: usize = 120;
/// A frame that comes later than this after the one before is not of the same movement, in seconds.
const PAUSE: f64 = 0.25;
/// The part of a new frame's time in the mean.
const WEIGHT: f64 = 0.1;

/// How long the last pictures took. It grows with pictures, not with time: an idle window has nothing to draw.
#[derive(Default)]
pub struct Timings {
    pictures: VecDeque<Times>,
    composites: u64,
    last: Option<f64>,
    interval: Option<f64>,
}

impl Timings {
    /// Keeps the times of a picture, told from the one before by how many there have been.
    pub fn keep(&mut self, composites: u64, times: Times) {
        if std::mem::replace(&mut self.composites, composites) == composites {
            return;
        }
        if self.pictures.len() == PICTURES {
            self.pictures.pop_front();
        }
        self.pictures.push_back(times);
    }

    /// The last pictures, the oldest first.
    pub fn pictures(&self) -> impl ExactSizeIterator<Item = &Times> {
        self.pictures.iter()
    }

    /// A frame begins, at a time in seconds.
    pub fn tick(&mut self, time: f64) {
        let since = self.last.replace(time).map(|last| time - last).filter(|since| (0.0..PAUSE).contains(since));
        if let Some(since) = since {
            self.interval = Some(self.interval.map_or(since, |mean| mean + WEIGHT * (since - mean)));
        }
    }

    /// Frames a second while something last moved.
    pub fn frame_rate(&self) -> Option<f64> {
        self.interval.filter(|&interval| interval > 0.0).map(f64::recip)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pauses_do_not_count_as_slow_frames() {
        let mut timings = Timings::default();
        assert_eq!(timings.frame_rate(), None);
        for time in [0.0, 0.02, 0.04, 9.0, 9.02] {
            timings.tick(time);
        }
        assert!((timings.frame_rate().unwrap() - 50.0).abs() < 1e-6, "{:?}", timings.frame_rate());
    }

    #[test]
    fn a_picture_is_kept_once_and_old_ones_go() {
        let mut timings = Timings::default();
        for composites in [1, 1, 2, 2, 2] {
            timings.keep(composites, Times { plan: composites as f64, ..Times::default() });
        }
        assert_eq!(timings.pictures().map(|times| times.plan).collect::<Vec<_>>(), [1.0, 2.0]);
        (3..1000).for_each(|composites| timings.keep(composites, Times::default()));
        assert_eq!(timings.pictures().len(), PICTURES);
    }
}
