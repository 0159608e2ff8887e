//! The last level of a mip chain, which 003 takes for the least and the largest value.

/// The one texel of the last level: each level is half of the one above it, rounded down, and the mean of two by two.
///
/// That is the mean of the picture (of a power of two along each side; else of most of it), and neither its least nor its
/// largest value, by which 003 means to normalise. A reduction to least and largest has to be its own.
///
/// # Panics
/// Where `values` is not `width` × `height` of them, or none.
pub fn last_mip(values: &[f32], width: usize, height: usize) -> f32 {
    assert!(!values.is_empty() && values.len() == width * height, "a picture of {width} x {height}");
    let (mut level, mut size) = (values.to_vec(), [width, height]);
    while size != [1, 1] {
        let half = size.map(|side| (side / 2).max(1));
        let at = |i: usize, j: usize| level[j.min(size[1] - 1) * size[0] + i.min(size[0] - 1)];
        let mean = |i: usize, j: usize| {
            0.25 * (at(2 * i, 2 * j) + at(2 * i + 1, 2 * j) + at(2 * i, 2 * j + 1) + at(2 * i + 1, 2 * j + 1))
        };
        let next: Vec<f32> =
            (0..half[1]).flat_map(|j| (0..half[0]).map(move |i| (i, j))).map(|(i, j)| mean(i, j)).collect();
        (level, size) = (next, half);
    }
    level[0]
}
