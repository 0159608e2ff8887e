//! A picture as a kernel, pixel by pixel.

use std::sync::{Arc, OnceLock};

use rayon::prelude::*;

use super::Fault;

/// A picture that every pixel is spread by, made to a mean energy of 1 over the three channels: a colour of its light
/// is kept. One pixel of it is one of the photo. Its centre is the pixel at half its rows and columns, rounded down.
#[derive(Debug, Clone, PartialEq)]
pub struct Kernel {
    rows: usize,
    columns: usize,
    /// Row by row from the top, three channels each; millions, which copies share.
    pixels: Arc<Vec<[f64; 3]>>,
    /// What each channel spreads, over these pixels and beyond.
    energies: [f64; 3],
    /// The mean over the channels and over all pixels whose distance from the centre rounds to the index, once it is asked for.
    rings: OnceLock<Vec<f64>>,
}

impl Kernel {
    /// A picture of `rows` × `columns` pixels, row by row from the top.
    ///
    /// # Errors
    /// On the key `kernel`: another number of pixels, none, some that are negative or not finite, or nothing but black.
    pub fn new(rows: usize, columns: usize, mut pixels: Vec<[f64; 3]>) -> Result<Self, Fault> {
        let fault = |reason: String| Err(Fault::new("kernel", reason));
        if rows.checked_mul(columns) != Some(pixels.len()) || pixels.is_empty() {
            return fault(format!("it has {} pixels, which is not {rows} rows of {columns}", pixels.len()));
        }
        if let Some(i) = pixels.iter().position(|pixel| !pixel.iter().all(|x| (0.0..=1e38).contains(x))) {
            let [red, green, blue] = pixels[i];
            let (row, column) = (i / columns + 1, i % columns + 1);
            return fault(format!(
                "a pixel spreads from 0 to 1e38, and not ({red}, {green}, {blue}), in row {row}, column {column}"
            ));
        }
        let energy = pixels.iter().flatten().sum::<f64>() / 3.0;
        if energy < 1e-38 {
            return fault("it is black".into());
        }
        pixels.iter_mut().flatten().for_each(|x| *x /= energy);
        Ok(Self { energies: sums(&pixels), rows, columns, pixels: Arc::new(pixels), rings: OnceLock::new() })
    }

    /// One of as many pixels as there are, of which none is negative, as they are; of each channel so much more falls `beyond` them.
    pub(super) fn of_light(rows: usize, columns: usize, pixels: Vec<[f64; 3]>, beyond: [f64; 3]) -> Self {
        let within = sums(&pixels);
        let energies = [0, 1, 2].map(|channel| within[channel] + beyond[channel]);
        Self { rows, columns, pixels: Arc::new(pixels), energies, rings: OnceLock::new() }
    }

    /// How many rows.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// How many columns.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// What each pixel takes, row by row from the top.
    pub fn pixels(&self) -> &[[f64; 3]] {
        &self.pixels
    }

    /// The same, to be kept by others.
    pub(crate) fn shared(&self) -> Arc<Vec<[f64; 3]>> {
        self.pixels.clone()
    }

    /// The row and the column of the centre.
    pub fn centre(&self) -> [usize; 2] {
        [self.rows / 2, self.columns / 2]
    }

    /// What each channel spreads: of a picture from a file the sums of the channels, whose mean is 1; of others with what falls beyond
    /// it.
    pub fn energies(&self) -> [f64; 3] {
        self.energies
    }

    /// The pixel at the centre.
    pub(super) fn middle(&self) -> [f64; 3] {
        self.pixels[self.rows / 2 * self.columns + self.columns / 2]
    }

    /// The mean over directions and channels at a distance in pixels, between whole ones by a straight line, for plots:
    /// a kernel need not be round.
    pub fn ring(&self, r: f64) -> f64 {
        let rings = self.rings();
        let at = |i: usize| rings.get(i).copied().unwrap_or(0.0);
        if r.is_nan() {
            return r;
        }
        // As large as it may be, `as` stays within usize.
        let (below, part) = (r.floor(), r - r.floor());
        let below = below as usize;
        if below >= rings.len() { 0.0 } else { at(below) * (1.0 - part) + at(below + 1) * part }
    }

    /// The distance of the farthest pixel's ring.
    pub(super) fn end(&self) -> f64 {
        self.rings().len() as f64
    }

    fn rings(&self) -> &[f64] {
        self.rings.get_or_init(|| rings(self.columns, self.centre(), &self.pixels))
    }

    /// The energy, mean of the channels, of the pixels within a distance.
    pub(super) fn energy_within(&self, r: f64) -> f64 {
        let [row, column] = self.centre();
        let far = |i: usize| {
            let [dy, dx] = [(i / self.columns).abs_diff(row), (i % self.columns).abs_diff(column)];
            (dx as f64).hypot(dy as f64)
        };
        self.pixels
            .iter()
            .enumerate()
            .filter(|(i, _)| far(*i) <= r)
            .map(|(_, pixel)| pixel.iter().sum::<f64>() / 3.0)
            .sum()
    }
}

/// The sums of the channels, in parallel and always in the same order.
pub(super) fn sums(pixels: &[[f64; 3]]) -> [f64; 3] {
    let add = |a: [f64; 3], b: &[f64; 3]| [0, 1, 2].map(|channel| a[channel] + b[channel]);
    let parts: Vec<[f64; 3]> = pixels.par_chunks(4096).map(|part| part.iter().fold([0.0; 3], add)).collect();
    parts.iter().fold([0.0; 3], add)
}

/// The means over rings of one pixel.
fn rings(columns: usize, [row, column]: [usize; 2], pixels: &[[f64; 3]]) -> Vec<f64> {
    let mut sums: Vec<[f64; 2]> = Vec::new();
    for (i, pixel) in pixels.iter().enumerate() {
        let [dy, dx] = [(i / columns).abs_diff(row), (i % columns).abs_diff(column)];
        let ring = (dx as f64).hypot(dy as f64).round() as usize;
        if ring >= sums.len() {
            sums.resize(ring + 1, [0.0; 2]);
        }
        sums[ring][0] += pixel.iter().sum::<f64>() / 3.0;
        sums[ring][1] += 1.0;
    }
    // A ring of a narrow strip may have no pixel.
    sums.iter().map(|[sum, count]| if *count > 0.0 { sum / count } else { 0.0 }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The mean of the channels' sums becomes 1, and their ratio stays.
    #[test]
    fn energy_is_one_and_colour_stays() {
        let pixels: Vec<[f64; 3]> = (0..15).map(|i| [1.0, 2.0, 3.0].map(|x| x * f64::from(i))).collect();
        let kernel = Kernel::new(3, 5, pixels).unwrap();
        let [red, green, blue] = kernel.energies();
        assert!((red - 0.5).abs() < 1e-14 && (green - 1.0).abs() < 1e-14 && (blue - 1.5).abs() < 1e-14);
        assert_eq!(kernel.centre(), [1, 2]);
        assert!((kernel.energy_within(10.0) - 1.0).abs() < 1e-14);
        // The four neighbours and the four at √2 round to the ring 1: 1 to 3, 6, 8 and 11 to 13 of a sum of 105.
        assert!((kernel.ring(1.0) - 56.0 / 8.0 / 105.0).abs() < 1e-14, "{}", kernel.ring(1.0));
        assert_eq!(kernel.ring(1e300), 0.0);
    }

    #[test]
    fn what_is_no_kernel_is_refused() {
        let grey = |x: f64| vec![[x; 3]; 4];
        let no_pixels = Kernel::new(0, 4, Vec::new());
        for refused in
            [Kernel::new(2, 3, grey(1.0)), no_pixels, Kernel::new(2, 2, grey(0.0)), Kernel::new(2, 2, grey(-1.0))]
        {
            assert_eq!(refused.unwrap_err().key, "kernel");
        }
        for x in [f64::NAN, f64::INFINITY] {
            assert!(Kernel::new(2, 2, grey(x)).unwrap_err().reason.contains("row 1, column 1"));
        }
    }
}
