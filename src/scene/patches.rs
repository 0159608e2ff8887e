//! Light that lies together: places gathered into a few groups, so that what depends on where light is need not be known for each.

use glam::DVec2;

/// Light at a place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Spot {
    /// Where, in the unit of lengths.
    pub place: DVec2,
    /// How much, 0 or more.
    pub light: f64,
}

/// Where the light of some spots is on average; in the middle of them where they are dark.
fn middle(spots: &[Spot], group: &[usize]) -> DVec2 {
    if let [only] = group {
        return spots[*only].place;
    }
    let of = |weight: &dyn Fn(&Spot) -> f64| {
        let (sum, total) = group.iter().fold((DVec2::ZERO, 0.0), |(sum, total), &spot| {
            let weight = weight(&spots[spot]);
            (sum + weight * spots[spot].place, total + weight)
        });
        (total > 0.0).then(|| sum / total)
    };
    of(&|spot| spot.light).or_else(|| of(&|_| 1.0)).unwrap_or_default()
}

/// Spots in groups, as numbers, at most as many as each of `counts`, which rise: a list of groups for each, in which those of the one before
/// are cut further. Again and again the group whose light is spread most, times how much it has, is cut in two where that leaves least:
/// along a line of x or y, so that cells of a rectangle stay rectangles.
pub(crate) fn levels(spots: &[Spot], counts: &[usize]) -> Vec<Vec<Vec<usize>>> {
    let mut groups = vec![Group::new(spots, (0..spots.len()).collect())];
    let mut level = |most: usize| {
        while groups.len() < most {
            let widest = groups.iter().enumerate().max_by(|one, other| one.1.spread.total_cmp(&other.1.spread));
            let Some(number) = widest.filter(|(_, group)| group.spread > 0.0).map(|(number, _)| number) else { break };
            let group = groups.swap_remove(number);
            groups.extend(group.halves(spots));
        }
        groups.iter().map(|group| group.members.clone()).collect()
    };
    counts.iter().map(|&most| level(most)).collect()
}

struct Group {
    members: Vec<usize>,
    /// Light times square distance from its middle.
    spread: f64,
}

impl Group {
    fn new(spots: &[Spot], members: Vec<usize>) -> Self {
        let middle = middle(spots, &members);
        let spread =
            members.iter().map(|&spot| spots[spot].light * (spots[spot].place - middle).length_squared()).sum();
        Self { members, spread }
    }

    /// Cut across the axis along which its light is spread more, where what is left in both is least.
    fn halves(mut self, spots: &[Spot]) -> [Self; 2] {
        let middle = middle(spots, &self.members);
        let spread = self.members.iter().fold(DVec2::ZERO, |sum, &spot| {
            let apart = spots[spot].place - middle;
            sum + spots[spot].light * apart * apart
        });
        let axis = usize::from(spread.y > spread.x);
        let along = |spot: &usize| spots[*spot].place[axis];
        self.members.sort_by(|one, other| along(one).total_cmp(&along(other)));
        // Of light L with moments M and Q, Q − M² / L is what is left; the Q of both add up to the same wherever they are cut.
        let light = |spot: &usize| DVec2::new(spots[*spot].light, spots[*spot].light * (along(spot) - middle[axis]));
        let total: DVec2 = self.members.iter().map(light).sum();
        let held = |part: DVec2| if part.x > 0.0 { part.y * part.y / part.x } else { 0.0 };
        let (mut before, mut best) = (DVec2::ZERO, (f64::NEG_INFINITY, 1));
        for (index, pair) in self.members.windows(2).enumerate() {
            before += light(&pair[0]);
            let found = held(before) + held(total - before);
            if along(&pair[0]) < along(&pair[1]) && found > best.0 {
                best = (found, index + 1);
            }
        }
        let others = self.members.split_off(best.1);
        [Self::new(spots, self.members), Self::new(spots, others)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn spot(x: f64, y: f64, light: f64) -> Spot {
        Spot { place: DVec2::new(x, y), light }
    }

    #[test]
    fn spots_are_joined_with_their_neighbours() {
        let clusters = [DVec2::new(-1.0, 0.5), DVec2::new(0.9, -0.3), DVec2::new(0.2, 0.8)];
        let spots: Vec<Spot> = (0..30)
            .map(|k| {
                let place = clusters[k % 3] + 0.01 * DVec2::from_angle(k as f64);
                Spot { place, light: 1.0 + k as f64 }
            })
            .collect();
        let together = |most| levels(&spots, &[most]).remove(0);
        let groups = together(3);
        assert_eq!(groups.len(), 3);
        for group in &groups {
            assert_eq!(group.len(), 10);
            assert!(group.iter().all(|spot| spot % 3 == group[0] % 3), "{group:?}");
            assert!((middle(&spots, group) - clusters[group[0] % 3]).length() < 0.02);
        }
        // All of them once, however many groups.
        let counts = [1, 2, 5, 29];
        let found = levels(&spots, &counts);
        for (most, groups) in counts.into_iter().zip(&found) {
            let mut all: Vec<usize> = groups.concat();
            all.sort_unstable();
            assert_eq!(all, (0..30).collect::<Vec<_>>());
            assert_eq!(groups.len(), most);
            assert_eq!(groups.len(), together(most).len());
        }
        // Each level cuts the groups of the one before.
        for pair in found.windows(2) {
            let within = |group: &Vec<usize>| pair[0].iter().any(|large| group.iter().all(|spot| large.contains(spot)));
            assert!(pair[1].iter().all(within));
        }
    }

    #[test]
    fn where_the_light_is_counts_and_darkness_is_not_cut() {
        // A lamp and much that is dim.
        let mut spots: Vec<Spot> = (0..100).map(|k| spot(f64::from(k) * 0.01, 0.0, 0.001)).collect();
        spots.push(spot(2.0, 0.0, 50.0));
        let groups = levels(&spots, &[2]).remove(0);
        assert!(groups.contains(&vec![100]), "{groups:?}");
        let dark: Vec<Spot> = (0..10).map(|k| spot(f64::from(k), 0.0, 0.0)).collect();
        assert_eq!(levels(&dark, &[3])[0].len(), 1);
        assert_eq!(middle(&dark, &[0, 1, 2]), DVec2::new(1.0, 0.0));
        // At one place there is nothing to cut.
        assert_eq!(levels(&[spot(0.5, 0.5, 1.0); 9], &[4])[0].len(), 1);
        assert_eq!(middle(&[], &[]), DVec2::ZERO);
    }
}
