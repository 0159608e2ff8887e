//! Clipped pixels that hang together, and what lies around them.

use super::mask::Mask;

/// Columns `start..end` of a row, all of them clipped and those beside them not, and the region that they are in.
#[derive(Debug, Clone, Copy)]
pub(super) struct Run {
    pub row: usize,
    pub start: usize,
    pub end: usize,
    pub region: usize,
}

/// What is known of a region.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Region {
    pub pixels: usize,
    /// The sum of the colours of bright pixels at its rim.
    pub colour: [f64; 3],
    /// The sum of how bright it is some way outside, of the clipped level, and of how many pixels.
    pub outside: [f64; 2],
}

/// The runs of a mask, row by row and from the left, and how many regions they are in, which touch nowhere, not at corners either.
pub(super) fn runs(mask: &Mask) -> (Vec<Run>, usize) {
    let mut runs: Vec<Run> = Vec::new();
    let mut parents: Vec<usize> = Vec::new();
    let mut last = 0..0;
    for (row, line) in mask.rows() {
        // A row may have none above it.
        let above = if runs.last().is_some_and(|run| run.row + 1 == row) { last } else { 0..0 };
        let (first, mut touched) = (runs.len(), above.start);
        let mut start = 0;
        while let Some(skip) = line[start..].iter().position(|clipped| *clipped) {
            start += skip;
            let end = line[start..].iter().position(|clipped| !clipped).map_or(line.len(), |length| start + length);
            while touched < above.end && runs[touched].end < start {
                touched += 1;
            }
            let mut region = parents.len();
            for other in runs[touched..above.end].iter().take_while(|other| other.start <= end) {
                let root = root(&mut parents, other.region);
                // The older one stays.
                let (old, young) = (region.min(root), region.max(root));
                if young < parents.len() {
                    parents[young] = old;
                }
                region = old;
            }
            if region == parents.len() {
                parents.push(region);
            }
            runs.push(Run { row, start, end, region });
            start = end;
        }
        last = first..runs.len();
    }
    let mut numbers = vec![usize::MAX; parents.len()];
    let mut count = 0;
    for run in &mut runs {
        let root = root(&mut parents, run.region);
        if numbers[root] == usize::MAX {
            numbers[root] = count;
            count += 1;
        }
        run.region = numbers[root];
    }
    (runs, count)
}

/// The region that `region` is in by now. Halves the way there for the next time.
fn root(parents: &mut [usize], mut region: usize) -> usize {
    while parents[region] != region {
        parents[region] = parents[parents[region]];
        region = parents[region];
    }
    region
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_touches_at_a_corner_is_one_region() {
        let of = |rows: &[&str]| {
            let mask: Vec<bool> = rows.iter().flat_map(|row| row.chars().map(|c| c == '#')).collect();
            let (runs, regions) = runs(&Mask::of(mask, rows[0].len()));
            (runs.iter().map(|run| run.region).collect::<Vec<_>>(), regions)
        };
        assert_eq!(of(&["#.#.#", ".#...", "....#"]), (vec![0, 0, 1, 0, 2], 3));
        // Two that join only further down, and one within.
        assert_eq!(of(&["#...#", "#.#.#", "#...#", "#####"]), (vec![0, 0, 0, 1, 0, 0, 0, 0], 2));
        assert_eq!(of(&["##.", "...", "##."]), (vec![0, 1], 2));
        assert_eq!(of(&["...", "..."]), (vec![], 0));
        assert_eq!(of(&["###", "###"]), (vec![0, 0], 1));
    }
}
