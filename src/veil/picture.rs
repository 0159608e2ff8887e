//! A picture as a kernel: any shape, each channel its own.

use std::sync::Arc;

use super::error::Error;

/// The most that a pixel of a kernel may spread.
const MOST: f64 = 1e38;

/// What a kernel's energies are made to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Energy {
    /// As they are.
    Kept,
    /// The mean of the three channels to 1, so that the light takes the picture's colour.
    Mean,
    /// Each channel to 1, so that white light stays white; one that is black stays black.
    Each,
}

/// A picture that every pixel is spread by: what a source of light 1 sends to the pixel `right` columns and `below` rows from it
/// is the picture's pixel as far from its centre. A bright pixel is seen as the picture itself, row 0 on top.
#[derive(Debug, Clone, PartialEq)]
pub struct Picture {
    size: [usize; 2],
    centre: [usize; 2],
    /// Millions, which copies share.
    pixels: Arc<Vec<[f64; 3]>>,
}

impl Picture {
    /// A picture of `size` columns and rows around the pixel `centre`, its column and row: pixels row by row from the top, red, green
    /// and blue, each from 0 to 1e38.
    ///
    /// # Errors
    /// [`Error::Kernel`]: another number of pixels than the size says, or none; a centre beyond it; a pixel that is negative or
    /// no number; nothing but black.
    pub fn new(size: [usize; 2], centre: [usize; 2], pixels: impl Into<Arc<Vec<[f64; 3]>>>) -> Result<Self, Error> {
        let pixels = pixels.into();
        let [width, height] = size;
        if pixels.is_empty() || width.checked_mul(height) != Some(pixels.len()) {
            return Err(Error::Kernel(format!(
                "a kernel of {width} × {height} pixels has one at least and as many as that, and not {}",
                pixels.len()
            )));
        }
        if centre[0] >= width || centre[1] >= height {
            return Err(Error::Kernel(format!(
                "the centre of a kernel is one of its {width} × {height} pixels, and not column {} of row {}",
                centre[0], centre[1]
            )));
        }
        if let Some(index) = pixels.iter().position(|pixel| !pixel.iter().all(|value| (0.0..=MOST).contains(value))) {
            let [red, green, blue] = pixels[index];
            return Err(Error::Kernel(format!(
                "a pixel of a kernel spreads from 0 to {MOST:e}, and not ({red}, {green}, {blue}), at column {} of row {}",
                index % width,
                index / width
            )));
        }
        if pixels.iter().flatten().all(|value| *value == 0.0) {
            return Err(Error::Kernel("a kernel that is black makes no veil".into()));
        }
        Ok(Self { size, centre, pixels })
    }

    /// The same with other energies.
    #[must_use]
    pub fn normalised(mut self, energy: Energy) -> Self {
        let energies = self.energies();
        let by = match energy {
            Energy::Kept => return self,
            Energy::Mean => [energies.iter().sum::<f64>() / 3.0; 3],
            Energy::Each => energies.map(|energy| if energy > 0.0 { energy } else { 1.0 }),
        };
        let divide = |pixel: &mut [f64; 3]| pixel.iter_mut().zip(by).for_each(|(value, by)| *value /= by);
        Arc::make_mut(&mut self.pixels).iter_mut().for_each(divide);
        self
    }

    /// The same times `factor`.
    ///
    /// # Errors
    /// [`Error::Kernel`] on a factor that is not above 0, or that makes a pixel too large.
    pub fn times(self, factor: f64) -> Result<Self, Error> {
        if !(factor.is_finite() && factor > 0.0) {
            return Err(Error::Kernel(format!("a kernel is taken a number above 0 times, and not {factor}")));
        }
        let pixels: Vec<_> = self.pixels.iter().map(|pixel| pixel.map(|value| value * factor)).collect();
        Self::new(self.size, self.centre, pixels)
    }

    /// The same `factor` times as wide and high, about the middle of its centre. Each of its pixels is an evenly lit square,
    /// whose energy falls to the pixels that it covers: of each channel the energy stays.
    ///
    /// # Errors
    /// [`Error::Kernel`] on a factor that is not above 0, or that makes a side longer than `most`.
    pub fn scaled(&self, factor: f64, most: usize) -> Result<Self, Error> {
        let reach = [0, 1].map(|side| {
            let before = (self.centre[side] as f64 + 0.5) * factor;
            let after = ((self.size[side] - self.centre[side]) as f64 - 0.5) * factor;
            [before, after].map(|reach| (reach - 0.5).ceil().max(0.0))
        });
        if !(factor.is_finite() && factor > 0.0 && reach.iter().all(|[before, after]| before + after < most as f64)) {
            return Err(Error::Kernel(format!(
                "a kernel of {} × {} pixels is scaled by a number above 0 that makes it at most {most} pixels wide and high, and not by \
                 {factor}",
                self.size[0], self.size[1]
            )));
        }
        let reach = reach.map(|reach| reach.map(|reach| reach as usize));
        let size = reach.map(|[before, after]| before + after + 1);
        let shares = [0, 1].map(|side| {
            (0..self.size[side]).map(|pixel| shares(pixel, self.centre[side], factor, reach[side])).collect::<Vec<_>>()
        });
        let mut pixels = vec![[0.0; 3]; size[0] * size[1]];
        for (index, pixel) in self.pixels.iter().enumerate() {
            let [across, down] = [&shares[0][index % self.size[0]], &shares[1][index / self.size[0]]];
            for (row, down) in (down.0..).zip(&down.1) {
                for (into, across) in pixels[row * size[0] + across.0..].iter_mut().zip(&across.1) {
                    into.iter_mut().zip(pixel).for_each(|(into, value)| *into += down * across * value);
                }
            }
        }
        Self::new(size, [reach[0][0], reach[1][0]], pixels)
    }

    /// Columns and rows.
    pub fn size(&self) -> [usize; 2] {
        self.size
    }

    /// Column and row of the centre.
    pub fn centre(&self) -> [usize; 2] {
        self.centre
    }

    /// The sum of each channel.
    pub fn energies(&self) -> [f64; 3] {
        [0, 1, 2].map(|channel| self.pixels.iter().map(|pixel| pixel[channel]).sum())
    }

    /// What a source of light 1 sends to the pixel `right` columns and `below` rows from it.
    pub fn at(&self, [right, below]: [isize; 2]) -> [f64; 3] {
        let [x, y] = [self.centre[0] as isize + right, self.centre[1] as isize + below];
        let [width, height] = self.size.map(|side| side as isize);
        if (0..width).contains(&x) && (0..height).contains(&y) {
            self.pixels[(y * width + x) as usize]
        } else {
            [0.0; 3]
        }
    }
}

/// The shares of a pixel that fall to each pixel of a scaled side, from the first on.
fn shares(pixel: usize, centre: usize, factor: f64, [before, after]: [usize; 2]) -> (usize, Vec<f64>) {
    let middle = pixel as f64 - centre as f64;
    // Of the scaled side's pixel 0 the left edge is at 0.
    let edges = [middle - 0.5, middle + 0.5].map(|edge| edge * factor + before as f64 + 0.5);
    let last = before + after;
    let first = (edges[0].max(0.0) as usize).min(last);
    let end = (edges[1].ceil().max(0.0) as usize).clamp(first + 1, last + 1);
    let covered = |into: usize| (edges[1].min(into as f64 + 1.0) - edges[0].max(into as f64)).max(0.0);
    let covered: Vec<f64> = (first..end).map(covered).collect();
    let all: f64 = covered.iter().sum();
    // A pixel far below the size of others may be lost to rounding.
    if all > 0.0 { (first, covered.iter().map(|part| part / all).collect()) } else { (first, vec![1.0]) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ramp(size: [usize; 2]) -> Vec<[f64; 3]> {
        (0..size[0] * size[1]).map(|index| [1.0, 2.0, 4.0].map(|colour| colour * (1 + index) as f64)).collect()
    }

    #[test]
    fn energies_are_as_asked() {
        let picture = Picture::new([3, 2], [1, 1], ramp([3, 2])).expect("a picture");
        assert_eq!(picture.energies(), [21.0, 42.0, 84.0]);
        let close =
            |found: [f64; 3], wanted: [f64; 3]| found.iter().zip(wanted).all(|(f, w)| (f / w - 1.0).abs() < 1e-14);
        assert!(close(picture.clone().normalised(Energy::Mean).energies(), [3.0 / 7.0, 6.0 / 7.0, 12.0 / 7.0]));
        assert!(close(picture.clone().normalised(Energy::Each).energies(), [1.0; 3]));
        assert!(close(
            picture.clone().normalised(Energy::Kept).times(2.0).expect("a picture").energies(),
            [42.0, 84.0, 168.0]
        ));
        // A channel without light stays so.
        let red = Picture::new([1, 1], [0, 0], vec![[3.0, 0.0, 0.0]]).expect("a picture");
        assert_eq!(red.normalised(Energy::Each).energies(), [1.0, 0.0, 0.0]);
    }

    /// The energy of every channel stays, and so does where its middle lies from the centre, in its own pixels.
    #[test]
    fn scaling_keeps_energy_and_place() {
        let picture = Picture::new([5, 4], [1, 2], ramp([5, 4])).expect("a picture");
        let first = |picture: &Picture, factor: f64| {
            let mut sums = [0.0; 2];
            for y in 0..picture.size()[1] {
                for x in 0..picture.size()[0] {
                    let [right, below] = [0, 1].map(|side| [x, y][side] as isize - picture.centre()[side] as isize);
                    let light = picture.at([right, below])[1];
                    sums[0] += light * right as f64 / factor;
                    sums[1] += light * below as f64 / factor;
                }
            }
            sums.map(|sum| sum / picture.energies()[1])
        };
        let wanted = first(&picture, 1.0);
        for factor in [0.01, 0.3, 1.0, 2.0, 3.7, 11.0] {
            let scaled = picture.scaled(factor, 100).expect("a picture");
            for (found, wanted) in scaled.energies().iter().zip(picture.energies()) {
                assert!((found / wanted - 1.0).abs() < 1e-12, "{factor}");
            }
            // Within a scaled pixel no place is kept, but where the edges of pixels are those of scaled ones.
            let most = if factor % 2.0 == 1.0 { 1e-9 } else { 0.5 / factor };
            let found = first(&scaled, factor);
            assert!((found[0] - wanted[0]).abs() < most && (found[1] - wanted[1]).abs() < most, "{factor}: {found:?}");
        }
        assert_eq!(picture.scaled(1.0, 100).expect("a picture"), picture);
        assert_eq!(picture.scaled(1e-3, 100).expect("a picture").size(), [1, 1]);
    }

    #[test]
    fn what_is_no_kernel_is_refused() {
        let refused = |picture: Result<Picture, Error>, part: &str| match picture {
            Err(Error::Kernel(told)) => assert!(told.contains(part), "{told}"),
            other => panic!("{other:?}"),
        };
        refused(Picture::new([2, 2], [0, 0], vec![[1.0; 3]; 3]), "and not 3");
        refused(Picture::new([0, 2], [0, 0], Vec::new()), "and not 0");
        refused(Picture::new([usize::MAX, 2], [0, 0], vec![[1.0; 3]]), "and not 1");
        refused(Picture::new([2, 2], [2, 0], vec![[1.0; 3]; 4]), "column 2");
        refused(Picture::new([2, 2], [0, 0], vec![[0.0; 3]; 4]), "black");
        for bad in [-1.0, f64::NAN, f64::INFINITY, 2e38] {
            refused(
                Picture::new([2, 2], [0, 0], [vec![[1.0; 3]; 3], vec![[0.0, bad, 0.0]]].concat()),
                "column 1 of row 1",
            );
        }
        let picture = Picture::new([2, 2], [0, 0], vec![[1.0; 3]; 4]).expect("a picture");
        for factor in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e9] {
            refused(picture.scaled(factor, 1000), "scaled");
        }
        refused(picture.times(f64::INFINITY), "times");
    }
}
