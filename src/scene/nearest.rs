//! Which of many points is the nearest: a tree that halves them by x and by y in turns.

use glam::DVec2;

/// Points of the plane, none of them NaN.
pub(super) struct Nearest {
    /// Points and their numbers: the one in the middle of a slice splits those before it from those after it.
    tree: Vec<(DVec2, usize)>,
}

impl Nearest {
    pub fn new(points: Vec<DVec2>) -> Self {
        let mut tree: Vec<_> = points.into_iter().zip(0..).collect();
        split(&mut tree, 0);
        Self { tree }
    }

    /// The number of the point that is nearest, the first of those that are equally near; none where there are no points.
    pub fn to(&self, place: DVec2) -> Option<usize> {
        let mut best = (f64::INFINITY, usize::MAX);
        search(&self.tree, 0, place, &mut best);
        (best.1 != usize::MAX).then_some(best.1)
    }
}

fn split(points: &mut [(DVec2, usize)], axis: usize) {
    if points.len() < 2 {
        return;
    }
    let middle = points.len() / 2;
    points.select_nth_unstable_by(middle, |a, b| a.0[axis].total_cmp(&b.0[axis]).then(a.1.cmp(&b.1)));
    let (before, after) = points.split_at_mut(middle);
    split(before, 1 - axis);
    split(&mut after[1..], 1 - axis);
}

fn search(points: &[(DVec2, usize)], axis: usize, place: DVec2, best: &mut (f64, usize)) {
    let middle = points.len() / 2;
    let Some(&(point, number)) = points.get(middle) else { return };
    let here = (point.distance_squared(place), number);
    if here < *best {
        *best = here;
    }
    let across = place[axis] - point[axis];
    let [near, far] = match across < 0.0 {
        true => [&points[..middle], &points[middle + 1..]],
        false => [&points[middle + 1..], &points[..middle]],
    };
    search(near, 1 - axis, place, best);
    if across * across <= best.0 {
        search(far, 1 - axis, place, best);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chance::Chance;

    #[test]
    fn it_is_what_looking_at_each_finds() {
        let mut chance = Chance::new(7);
        for count in [0, 1, 2, 3, 10, 500] {
            // On a coarse lattice, so that many are equally near.
            let mut place =
                |most: f64| DVec2::new(chance.between(0.0, most).floor(), chance.between(0.0, most).floor());
            let points: Vec<DVec2> = (0..count).map(|_| place(20.0)).collect();
            let nearest = Nearest::new(points.clone());
            for _ in 0..300 {
                let place = place(30.0) - 5.0;
                let each = points.iter().enumerate().map(|(number, point)| (point.distance_squared(place), number));
                let first = each.min_by(|a, b| a.partial_cmp(b).unwrap()).map(|(_, number)| number);
                assert_eq!(nearest.to(place), first, "{count}");
            }
        }
    }
}
