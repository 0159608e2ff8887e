//! Timing that survives a busy machine: arms measured in turns, and ratios taken within a turn.
//!
//! Absolute times move with whatever else the machine does; the ratio of two arms that ran next to each other hardly
//! does. Every other round runs backwards, so that a machine that slows down meanwhile favours none of them.

use std::time::Instant;

use crate::Result;

/// How often each arm runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Rounds {
    warm_up: usize,
    timed: usize,
}

impl Rounds {
    /// `warm_up` rounds that are not timed, and `timed` that are, made even: as many forwards as backwards.
    pub fn new(warm_up: usize, timed: usize) -> Self {
        Self { warm_up, timed: timed.max(1).next_multiple_of(2) }
    }

    /// How many rounds are timed.
    pub fn timed(self) -> usize {
        self.timed
    }
}

/// One arm's times in milliseconds, round after round.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Samples(Vec<f64>);

impl Samples {
    /// The value that half of the samples stay below; NaN where there is none.
    pub fn median(&self) -> f64 {
        let mut sorted = self.0.clone();
        sorted.sort_by(f64::total_cmp);
        match sorted.len() {
            0 => f64::NAN,
            n => 0.5 * (sorted[(n - 1) / 2] + sorted[n / 2]),
        }
    }

    /// The smallest sample.
    pub fn min(&self) -> f64 {
        self.0.iter().copied().fold(f64::INFINITY, f64::min)
    }

    /// The largest sample.
    pub fn max(&self) -> f64 {
        self.0.iter().copied().fold(f64::NEG_INFINITY, f64::max)
    }

    /// From the smallest to the largest, in parts of the median.
    pub fn spread(&self) -> f64 {
        (self.max() - self.min()) / self.median()
    }

    /// The same samples of a part, for the whole that is `factor` times as large.
    pub fn scaled(&self, factor: f64) -> Self {
        self.0.iter().map(|milliseconds| milliseconds * factor).collect()
    }

    /// What both take together, round by round.
    ///
    /// # Panics
    /// Where the two do not come from the same rounds.
    pub fn plus(&self, other: &Self) -> Self {
        assert_eq!(self.0.len(), other.0.len(), "samples of the same rounds");
        self.0.iter().zip(&other.0).map(|(a, b)| a + b).collect()
    }

    /// How many times as long as `other` this takes.
    ///
    /// # Panics
    /// Where the two do not come from the same rounds.
    pub fn over(&self, other: &Self) -> Ratio {
        assert_eq!(self.0.len(), other.0.len(), "samples of the same rounds");
        let pairs = self.0.iter().zip(&other.0).map(|(a, b)| a / b);
        Ratio { of_medians: self.median() / other.median(), paired: Self(pairs.collect()).median() }
    }
}

impl FromIterator<f64> for Samples {
    fn from_iter<I: IntoIterator<Item = f64>>(milliseconds: I) -> Self {
        Self(milliseconds.into_iter().collect())
    }
}

/// How many times as long one arm takes as another, in two ways; where they disagree, neither is to be trusted.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Ratio {
    /// The ratio of the two medians.
    pub of_medians: f64,
    /// The median of the rounds' own ratios: what is left when the machine's mood cancels.
    pub paired: f64,
}

/// Times the arms in turns: A B C, C B A, and so on.
///
/// # Errors
/// The first that an arm gives.
pub fn interleave<F: FnMut() -> Result<()> + ?Sized, const N: usize>(
    rounds: Rounds,
    mut arms: [&mut F; N],
) -> Result<[Samples; N]> {
    let mut samples = [(); N].map(|()| Samples::default());
    let times = in_turns(rounds, N, |index| {
        let started = Instant::now();
        arms[index]()?;
        Ok(started.elapsed().as_secs_f64() * 1e3)
    })?;
    for (samples, times) in samples.iter_mut().zip(times) {
        samples.0 = times;
    }
    Ok(samples)
}

/// Runs `count` arms in turns and gives what each brought back, round after round; what the warm-up brings is dropped.
///
/// # Errors
/// The first that an arm gives.
pub fn in_turns<T>(rounds: Rounds, count: usize, mut arm: impl FnMut(usize) -> Result<T>) -> Result<Vec<Vec<T>>> {
    for _ in 0..rounds.warm_up {
        (0..count).try_for_each(|index| arm(index).map(drop))?;
    }
    let mut brought: Vec<Vec<T>> = (0..count).map(|_| Vec::with_capacity(rounds.timed)).collect();
    for round in 0..rounds.timed {
        for turn in 0..count {
            let index = if round % 2 == 0 { turn } else { count - 1 - turn };
            brought[index].push(arm(index)?);
        }
    }
    Ok(brought)
}

/// Where a ratio, by what it depends on, rises through 1 for the last time; straight between its points on logarithmic
/// scales. None where it does not.
pub fn crossover(ratios: &[[f64; 2]]) -> Option<f64> {
    let rises = |pair: &&[[f64; 2]]| pair[0][1] < 1.0 && pair[1][1] >= 1.0;
    ratios.windows(2).rfind(rises).map(|pair| {
        let [[from, below], [to, above]] = [pair[0], pair[1]].map(|point| point.map(f64::ln));
        (from + (to - from) * below / (below - above)).exp()
    })
}

#[cfg(test)]
mod tests {
    use std::cell::RefCell;

    use super::*;
    use crate::Error;

    type Arm<'a> = &'a mut dyn FnMut() -> Result<()>;

    fn samples(milliseconds: &[f64]) -> Samples {
        milliseconds.iter().copied().collect()
    }

    #[test]
    fn arms_run_in_turns_and_every_other_round_backwards() {
        let order = RefCell::new(String::new());
        let [mut a, mut b, mut c] = ['A', 'B', 'C'].map(|name| {
            let order = &order;
            move || {
                order.borrow_mut().push(name);
                Ok(())
            }
        });
        let arms: [Arm<'_>; 3] = [&mut a, &mut b, &mut c];
        let timed = interleave(Rounds::new(1, 3), arms).unwrap();
        assert_eq!(*order.borrow(), "ABC ABC CBA ABC CBA".replace(' ', ""));
        assert!(timed.iter().all(|samples| samples.0.len() == 4 && samples.min() >= 0.0));
    }

    #[test]
    fn the_first_error_ends_it() {
        let ran = RefCell::new(0);
        let mut fails = || Err(Error::Gl("lost".into()));
        let mut counts = || {
            *ran.borrow_mut() += 1;
            Ok(())
        };
        let arms: [Arm<'_>; 2] = [&mut fails, &mut counts];
        assert!(interleave(Rounds::new(0, 2), arms).is_err());
        assert_eq!(*ran.borrow(), 0);
    }

    #[test]
    fn the_median_stands_in_the_middle() {
        for (values, median) in [(&[3.0][..], 3.0), (&[4.0, 1.0], 2.5), (&[9.0, 1.0, 2.0], 2.0), (&[1.0; 4], 1.0)] {
            assert_eq!(samples(values).median(), median, "{values:?}");
        }
        assert!(samples(&[]).median().is_nan());
        let three = samples(&[2.0, 8.0, 4.0]);
        assert_eq!((three.min(), three.max(), three.spread()), (2.0, 8.0, 1.5));
    }

    #[test]
    fn paired_ratios_see_through_a_machine_that_slows_down() {
        let slowing = [1.0, 1.0, 5.0, 20.0];
        let (once, thrice) = (samples(&slowing), samples(&slowing.map(|time| 3.0 * time)));
        assert_eq!(thrice.over(&once), Ratio { of_medians: 3.0, paired: 3.0 });
        // One slow outlier moves neither.
        let outlier = samples(&[3.0, 3.0, 15.0, 6000.0]);
        assert_eq!(outlier.over(&once).paired, 3.0);
    }

    #[test]
    fn the_crossover_lies_where_the_ratio_is_one() {
        // 0.02 K milliseconds against 1 millisecond.
        let ratios: Vec<_> = (0..11).map(|power| f64::from(1 << power)).map(|count| [count, 0.02 * count]).collect();
        assert!((crossover(&ratios).unwrap() - 50.0).abs() < 1e-9);
        assert_eq!(crossover(&ratios[..5]), None);
        assert_eq!(crossover(&ratios[7..]), None);
    }

    #[test]
    fn rounds_are_even_and_never_none() {
        assert_eq!([0, 1, 2, 7].map(|timed| Rounds::new(0, timed).timed()), [2, 2, 2, 8]);
    }
}
