//! Lines in pixels: cut to the plot, and cut into dashes.

/// A point in pixels.
pub(super) type Point = [f64; 2];

/// The parts of a line that lie within a rectangle, whose corners are `low` and `high`; none ends the line.
pub(super) fn clipped(points: impl Iterator<Item = Option<Point>>, low: Point, high: Point) -> Vec<Vec<Point>> {
    let mut parts: Vec<Vec<Point>> = Vec::new();
    let mut before: Option<Point> = None;
    for point in points {
        if let (Some(from), Some(to)) = (before, point)
            && let Some([start, end]) = clip([from, to], low, high)
        {
            match parts.last_mut() {
                Some(part) if part.last() == Some(&start) => part.push(end),
                _ => parts.push(vec![start, end]),
            }
        }
        before = point;
    }
    parts
}

/// The part of a segment within a rectangle (Liang and Barsky, "A new concept and method for line clipping", 1984).
fn clip([from, to]: [Point; 2], low: Point, high: Point) -> Option<[Point; 2]> {
    let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
    for axis in 0..2 {
        let step = to[axis] - from[axis];
        let ends = [low[axis] - from[axis], high[axis] - from[axis]];
        if step == 0.0 {
            if ends[0] > 0.0 || ends[1] < 0.0 {
                return None;
            }
            continue;
        }
        let (a, b) = (ends[0] / step, ends[1] / step);
        enter = enter.max(a.min(b));
        leave = leave.min(a.max(b));
    }
    let at = |t: f64| [from[0] + t * (to[0] - from[0]), from[1] + t * (to[1] - from[1])];
    // The ends themselves, not almost: they join with the next segment's.
    let start = if enter == 0.0 { from } else { at(enter) };
    let end = if leave == 1.0 { to } else { at(leave) };
    (enter <= leave).then_some([start, end])
}

/// A line cut into dashes of length `on` with gaps of length `off` between them.
pub(super) fn dashes(line: &[Point], on: f64, off: f64) -> Vec<Vec<Point>> {
    let mut dashes = Vec::new();
    let mut dash: Vec<Point> = line.first().copied().into_iter().collect();
    let (mut drawing, mut left) = (true, on);
    for pair in line.windows(2) {
        let [mut from, to] = [pair[0], pair[1]];
        loop {
            let length = (to[0] - from[0]).hypot(to[1] - from[1]);
            if length < left {
                left -= length;
                if drawing {
                    dash.push(to);
                }
                break;
            }
            let t = left / length;
            from = [from[0] + t * (to[0] - from[0]), from[1] + t * (to[1] - from[1])];
            dash.push(from);
            if drawing {
                dashes.push(std::mem::take(&mut dash));
            } else {
                dash = vec![from];
            }
            drawing = !drawing;
            left = if drawing { on } else { off };
        }
    }
    if drawing && dash.len() > 1 {
        dashes.push(dash);
    }
    dashes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_cut_at_the_edges_and_broken_at_gaps() {
        let points = [[-5.0, 5.0], [5.0, 5.0], [5.0, 15.0]].map(Some);
        assert_eq!(clipped(points.into_iter(), [0.0, 0.0], [10.0, 10.0]), [[[0.0, 5.0], [5.0, 5.0], [5.0, 10.0]]]);
        let broken = [Some([1.0, 1.0]), Some([2.0, 2.0]), None, Some([3.0, 3.0]), Some([4.0, 4.0])];
        assert_eq!(clipped(broken.into_iter(), [0.0; 2], [10.0; 2]).len(), 2);
        let outside = [[-5.0, 1.0], [-1.0, 9.0]].map(Some);
        assert!(clipped(outside.into_iter(), [0.0; 2], [10.0; 2]).is_empty());
    }

    #[test]
    fn dashes_have_their_lengths_around_corners() {
        let line = [[0.0, 0.0], [6.0, 0.0], [6.0, 6.0]];
        let dashes = dashes(&line, 4.0, 1.0);
        assert_eq!(dashes[0], [[0.0, 0.0], [4.0, 0.0]]);
        assert_eq!(dashes[1], [[5.0, 0.0], [6.0, 0.0], [6.0, 3.0]]);
        assert_eq!(dashes[2], [[6.0, 4.0], [6.0, 6.0]]);
    }
}
