//! Ranges of frame numbers: `1,3,7-20:2`, as the Open Job Description has integers (<Int>-<Int>:<Int>, jobtemplate-2023-09,
//! section 3.4.1), and `1001-1240x2`, as compositors write it.

use std::collections::HashSet;
use std::fmt;
use std::str::FromStr;

/// The most frames that are counted: eleven hours of film.
const MOST: usize = 1_000_000;

/// Frame numbers, each once, in the order in which they were asked for.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Frames(Vec<i64>);

impl Frames {
    /// How many there are.
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// The numbers, in their order.
    pub fn iter(&self) -> impl Iterator<Item = i64> {
        self.0.iter().copied()
    }

    /// Groups of `count` numbers or fewer, from the first to the last. `count` is at least 1.
    pub fn chunks(&self, count: usize) -> impl Iterator<Item = Self> {
        self.0.chunks(count).map(|chunk| Self(chunk.to_vec()))
    }
}

impl FromIterator<i64> for Frames {
    /// One that comes again is left out.
    fn from_iter<T: IntoIterator<Item = i64>>(numbers: T) -> Self {
        let mut seen = HashSet::new();
        Self(numbers.into_iter().filter(|&number| seen.insert(number)).collect())
    }
}

/// As ranges, separated by commas: `7`, `1-10`, `1-10:3`, `10-1x3`; the step may follow a colon or an x. What ends before it begins
/// counts downwards, with or without a minus before the step. A number that comes again counts once.
impl FromStr for Frames {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let mut numbers = Vec::new();
        for part in text.split(',').map(str::trim) {
            let Range { first, last, step } = part.parse()?;
            let count = first.abs_diff(last) / step;
            if count >= (MOST - numbers.len()) as u64 {
                return Err(format!("{text} has more than {MOST} frames"));
            }
            let step = if last < first { -(step as i64) } else { step as i64 };
            numbers.extend((0..=count as i64).map(|index| first + index * step));
        }
        Ok(numbers.into_iter().collect())
    }
}

/// From the first to the last, inclusive, by steps of 1 or more.
struct Range {
    first: i64,
    last: i64,
    step: u64,
}

impl FromStr for Range {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || format!("expected frames as 7, 1-10, 1-10:2 or 1-10x2, found {text:?}");
        let (first, rest) = whole(text).ok_or_else(wrong)?;
        if rest.is_empty() {
            return Ok(Self { first, last: first, step: 1 });
        }
        let (last, rest) = rest.strip_prefix('-').and_then(whole).ok_or_else(wrong)?;
        let Some(step) = rest.strip_prefix([':', 'x']) else {
            return if rest.is_empty() { Ok(Self { first, last, step: 1 }) } else { Err(wrong()) };
        };
        match whole(step) {
            Some((0, "")) => Err(format!("a step of 0 leads nowhere in {text:?}")),
            Some((step, "")) if step < 0 && first < last => Err(format!("{text:?} counts away from its end")),
            Some((step, "")) => Ok(Self { first, last, step: step.unsigned_abs() }),
            _ => Err(wrong()),
        }
    }
}

/// The number that a text begins with, and what follows. Numbers are kept small enough to be added.
fn whole(text: &str) -> Option<(i64, &str)> {
    let digits = text.strip_prefix('-').unwrap_or(text);
    let end = text.len() - digits.trim_start_matches(|c: char| c.is_ascii_digit()).len();
    let number: i64 = text[..end].parse().ok()?;
    (number.unsigned_abs() <= 1 << 60).then_some((number, &text[end..]))
}

/// Rising, in as few ranges as come from one look: `1001-1240:2`, `1,3,7-20`.
impl fmt::Display for Frames {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut numbers = self.0.clone();
        numbers.sort_unstable();
        let mut rest = &numbers[..];
        let mut comma = "";
        while let [first, ..] = *rest {
            let step = rest.get(1).map_or(1, |second| second - first);
            let steps = rest.windows(2).take_while(|pair| pair[1] - pair[0] == step).count();
            // Two numbers are no range, unless they are neighbours.
            let steps = if steps == 1 && step != 1 { 0 } else { steps };
            write!(f, "{comma}{first}")?;
            if steps > 0 {
                write!(f, "-{}", rest[steps])?;
            }
            if steps > 0 && step != 1 {
                write!(f, ":{step}")?;
            }
            rest = &rest[steps + 1..];
            comma = ",";
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn numbers(text: &str) -> Vec<i64> {
        text.parse::<Frames>().unwrap_or_else(|error| panic!("{text}: {error}")).iter().collect()
    }

    #[test]
    fn ranges_are_counted_once_and_in_their_order() {
        for (text, expected) in [
            ("7", &[7][..]),
            ("1-4", &[1, 2, 3, 4]),
            ("1001-1006x2", &[1001, 1003, 1005]),
            ("1,3,7-11:2", &[1, 3, 7, 9, 11]),
            ("-2-1", &[-2, -1, 0, 1]),
            ("-5--3", &[-5, -4, -3]),
            ("4-1", &[4, 3, 2, 1]),
            ("4-1:-2", &[4, 2]),
            ("5--5x5", &[5, 0, -5]),
            ("3-3", &[3]),
            ("1-3, 2-5", &[1, 2, 3, 4, 5]),
            ("0010-0011", &[10, 11]),
        ] {
            assert_eq!(numbers(text), expected, "{text}");
        }
    }

    #[test]
    fn what_is_no_range_is_refused() {
        for text in
            ["", "1-", "a", "1-10x", "1-10:0", "1-10:-1", "1,,2", "1-2-3", "1:2", "1-10x2x2", "1.5", "+1", "--1"]
        {
            assert!(text.parse::<Frames>().is_err(), "{text}");
        }
        for text in ["1-100000000", "0-999999,-1", "99999999999999999999", "-9223372036854775808-9223372036854775807"] {
            assert!(text.parse::<Frames>().is_err(), "{text}");
        }
        assert_eq!("0-999999".parse::<Frames>().unwrap().len(), MOST);
    }

    #[test]
    fn ranges_are_written_as_they_are_read() {
        for (text, expected) in [
            ("1001-1240x2", "1001-1239:2"),
            ("5-1", "1-5"),
            ("1,2", "1-2"),
            ("1,3", "1,3"),
            ("1,3,5", "1-5:2"),
            ("1,3,7-20:2", "1,3,7-19:2"),
            ("-3--1,4", "-3--1,4"),
            ("8", "8"),
        ] {
            let frames: Frames = text.parse().unwrap();
            assert_eq!(frames.to_string(), expected, "{text}");
            let sorted = |frames: &Frames| frames.iter().collect::<std::collections::BTreeSet<_>>();
            assert_eq!(sorted(&frames.to_string().parse().unwrap()), sorted(&frames), "{text}");
        }
        assert_eq!(Frames::default().to_string(), "");
    }

    #[test]
    fn chunks_have_all_numbers_in_order() {
        let chunks: Vec<String> = "1-7".parse::<Frames>().unwrap().chunks(3).map(|chunk| chunk.to_string()).collect();
        assert_eq!(chunks, ["1-3", "4-6", "7"]);
    }
}
