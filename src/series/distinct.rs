//! Bells told apart: a scene may have as many as it has ghosts.

use std::hash::Hasher;

use rustc_hash::{FxHashMap, FxHasher};

use super::Bell;

/// Numbers for bells, in the order in which they first come.
pub(crate) struct Distinct<'a> {
    bells: Vec<&'a Bell>,
    /// The numbers of those with one digest, which are hardly ever more than one.
    numbers: FxHashMap<[u64; 4], Vec<usize>>,
    /// The last that was asked for: often the next one too.
    last: usize,
    /// Whether discs that are only turned are one.
    turned: bool,
}

impl<'a> Distinct<'a> {
    /// Each bell by itself.
    pub fn new() -> Self {
        Self { bells: Vec::new(), numbers: FxHashMap::default(), last: 0, turned: false }
    }

    /// Bells that have the same bounds in one: the rotation of a disc or an iris is in none of them.
    pub fn by_bounds() -> Self {
        Self { turned: true, ..Self::new() }
    }

    /// The bell's number, and whether it is new.
    pub fn number(&mut self, bell: &'a Bell) -> (usize, bool) {
        if self.bells.get(self.last).is_some_and(|last| self.same(last, bell)) {
            return (self.last, false);
        }
        let digest = digest(bell, self.turned);
        let known = self.numbers.get(&digest).and_then(|numbers| {
            let mut numbers = numbers.iter().copied();
            numbers.find(|&number| self.same(self.bells[number], bell))
        });
        self.last = known.unwrap_or_else(|| {
            self.numbers.entry(digest).or_default().push(self.bells.len());
            self.bells.push(bell);
            self.bells.len() - 1
        });
        (self.last, known.is_none())
    }

    fn same(&self, one: &Bell, other: &Bell) -> bool {
        match (one, other) {
            (Bell::Disc(one), Bell::Disc(other)) if self.turned => {
                (one.rim(), one.blades()) == (other.rim(), other.blades())
            }
            (Bell::Iris(one), Bell::Iris(other)) if self.turned => {
                (one.edge(), one.blades()) == (other.edge(), other.blades()) && one.cuts() == other.cuts()
            }
            _ => one == other,
        }
    }
}

/// Numbers that are the same for the same bell, and hardly ever for another.
fn digest(bell: &Bell, turned: bool) -> [u64; 4] {
    let [first, second, third] = match bell {
        Bell::Gaussian | Bell::CosineSquared | Bell::Parabola | Bell::Paraboloid => [0.0; 3],
        Bell::VonMises(bell) => [bell.period.x, bell.period.y, 0.0],
        Bell::SineGaussian(bell) => [bell.period.x, bell.period.y, bell.mean],
        Bell::Profile(profile) => {
            let [radius, value] = profile.rows().last().unwrap_or_default();
            [profile.rows().count() as f64, radius, value]
        }
        Bell::Disc(disc) => [disc.rim(), f64::from(disc.blades()), if turned { 0.0 } else { disc.rotation() }],
        Bell::Iris(iris) => [iris.edge(), f64::from(iris.blades()), if turned { 0.0 } else { iris.rotation() }],
    };
    let cuts = if let Bell::Iris(iris) = bell { iris.cuts() } else { &[] };
    let mut hasher = FxHasher::default();
    let numbers = cuts.iter().flat_map(|cut| [cut.centre.x, cut.centre.y, cut.radius]);
    numbers.for_each(|number| hasher.write_u64(number.to_bits()));
    let kind = u64::from(bell.kind()) ^ hasher.finish();
    // −0 is 0.
    [kind, (first + 0.0).to_bits(), (second + 0.0).to_bits(), (third + 0.0).to_bits()]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::series::Disc;

    #[test]
    fn bells_have_the_numbers_of_their_first_places() {
        let all: Vec<Bell> = Bell::examples();
        let again = Bell::examples();
        let mut distinct = Distinct::new();
        for (number, bell) in all.iter().enumerate() {
            assert_eq!(distinct.number(bell), (number, true), "{bell}");
        }
        for (number, bell) in again.iter().enumerate().rev() {
            assert_eq!(distinct.number(bell), (number, false), "{bell}");
        }
    }

    #[test]
    fn a_turned_disc_is_another_but_for_its_bounds() {
        let disc = |rim, blades, rotation| Bell::Disc(Disc::new(rim, blades, rotation).unwrap());
        let all = [disc(0.1, 6, 0.0), disc(0.1, 6, 5.0), disc(0.1, 5, 5.0), disc(0.2, 6, 5.0), disc(0.1, 6, -0.0)];
        let (mut each, mut bounds) = (Distinct::new(), Distinct::by_bounds());
        assert_eq!(all.each_ref().map(|bell| each.number(bell).0), [0, 1, 2, 3, 0]);
        assert_eq!(all.each_ref().map(|bell| bounds.number(bell).0), [0, 0, 1, 2, 0]);
    }
}
