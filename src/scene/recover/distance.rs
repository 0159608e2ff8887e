//! How far pixels of a mask are from what is not in it: the exact Euclidean distance transform, by parabolas \[FH12\].
//!
//! A pixel beyond the end of a run is farther from all of the run than the pixel at that end, so the envelope of a run is that of
//! its own columns and the two beside them. What lies beyond the picture is not known, and is no end.
//!
//! \[FH12\] P. Felzenszwalb, D. Huttenlocher, "Distance Transforms of Sampled Functions", Theory of Computing 8, 2012.

use super::mask::Mask;

/// Rows to the nearest pixel of the same column that is not in the mask; [`FAR`] where there is none.
pub(super) struct Columns {
    width: usize,
    rows: Vec<u32>,
}

/// More rows than a picture has.
const FAR: u32 = 1 << 30;

impl Columns {
    /// Of a mask, row by row.
    pub fn new(mask: &Mask) -> Self {
        let width = mask.width;
        // Memory of rows that have none in the mask is never touched.
        let mut rows = vec![0u32; mask.pixels.len()];
        let height = rows.len() / width.max(1);
        let step = |near: &[u32], row: &mut [u32]| {
            row.iter_mut().zip(near).for_each(|(own, near)| *own = (*own).min(near + 1));
        };
        let clipped: Vec<usize> = mask.rows().map(|(row, _)| row).collect();
        for (j, line) in mask.rows() {
            let (above, below) = rows.split_at_mut(j * width);
            below.iter_mut().zip(line).for_each(|(rows, inside)| *rows = if *inside { FAR } else { 0 });
            if j > 0 {
                step(&above[(j - 1) * width..], &mut below[..width]);
            }
        }
        for j in clipped.into_iter().rev().filter(|j| j + 1 < height) {
            let (above, below) = rows.split_at_mut((j + 1) * width);
            step(&below[..width], &mut above[j * width..]);
        }
        Self { width, rows }
    }

    /// The distances of the columns `start..end` of a row, all of them in the mask and those beside them not, in heights of a pixel,
    /// which is `aspect` times as wide; infinite where all of the picture is in it.
    pub fn along(&self, row: usize, start: usize, end: usize, aspect: f64, parabolas: &mut Parabolas) -> Vec<f64> {
        let first = start.saturating_sub(1);
        let rows = &self.rows[row * self.width..][first..(end + 1).min(self.width)];
        parabolas.clear();
        for (column, &rows) in rows.iter().enumerate().filter(|(_, rows)| **rows < FAR) {
            parabolas.add(aspect * column as f64, f64::from(rows).powi(2));
        }
        let mut at = 0;
        let mut distance = |column: usize| {
            let x = aspect * (column - first) as f64;
            while parabolas.0.get(at + 1).is_some_and(|next| next.from < x) {
                at += 1;
            }
            parabolas.0.get(at).map_or(f64::INFINITY, |least| least.at(x).sqrt())
        };
        (start..end).map(&mut distance).collect()
    }
}

/// The lower envelope of parabolas (x − v)² + c, from the left.
#[derive(Default)]
pub(super) struct Parabolas(Vec<Parabola>);

#[derive(Clone, Copy)]
struct Parabola {
    vertex: f64,
    least: f64,
    /// Where it begins to be the lowest.
    from: f64,
}

impl Parabola {
    fn at(&self, x: f64) -> f64 {
        (x - self.vertex).powi(2) + self.least
    }
}

impl Parabolas {
    fn clear(&mut self) {
        self.0.clear();
    }

    /// Adds one to the right of all others.
    fn add(&mut self, vertex: f64, least: f64) {
        let mut from = f64::NEG_INFINITY;
        while let Some(last) = self.0.last() {
            from = (least - last.least + vertex * vertex - last.vertex * last.vertex) / (2.0 * (vertex - last.vertex));
            if from > last.from {
                break;
            }
            self.0.pop();
            from = f64::NEG_INFINITY;
        }
        self.0.push(Parabola { vertex, least, from });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every distance against the least of all, on masks by chance.
    #[test]
    fn distances_are_the_least_of_all() {
        let (width, height) = (23, 17);
        for (seed, aspect) in [(1u32, 1.0), (2, 2.5), (3, 0.3), (4, 1.0)] {
            let mut state = seed;
            let mut chance = || {
                state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                state >> 24
            };
            let mask: Vec<bool> = (0..width * height).map(|_| chance() < 245).collect();
            let columns = Columns::new(&Mask::of(mask.clone(), width));
            let mut parabolas = Parabolas::default();
            for row in 0..height {
                let mut column = 0;
                while column < width {
                    let run =
                        mask[row * width + column..(row + 1) * width].iter().take_while(|inside| **inside).count();
                    let along = columns.along(row, column, column + run, aspect, &mut parabolas);
                    for (k, distance) in along.into_iter().enumerate() {
                        let square = |at: usize| {
                            let x = aspect * ((at % width) as f64 - (column + k) as f64);
                            x * x + ((at / width) as f64 - row as f64).powi(2)
                        };
                        let least = (0..mask.len()).filter(|&at| !mask[at]).map(square).fold(f64::INFINITY, f64::min);
                        assert!((distance - least.sqrt()).abs() < 1e-9, "{row}, {}: {distance} {least}", column + k);
                    }
                    column += run + 1;
                }
            }
        }
        let all = Columns::new(&Mask::of(vec![true; 6], 3));
        assert_eq!(all.along(1, 0, 3, 1.0, &mut Parabolas::default()), [f64::INFINITY; 3]);
    }
}
