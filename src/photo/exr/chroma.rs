//! Subsampled colours at full resolution, and luminance and chroma as red, green and blue.
//!
//! OpenEXR's luminance-chroma pictures (`ImfRgbaYca.h`) hold Y, RY = (R − Y) / Y and BY = (B − Y) / Y, where Y is
//! luminance by the file's primaries, and RY and BY every second column and row. A sample of a subsampled channel lies
//! on the pixel of its column and row; between samples a cubic (Catmull and Rom 1974) goes through the four nearest,
//! the outermost repeated at the edges.

use rayon::prelude::*;

/// The samples of a subsampled channel.
pub(super) struct Plane {
    /// Row by row.
    pub samples: Vec<f32>,
    /// Samples in a row; > 0.
    pub width: usize,
    /// A sample in every so many columns and rows.
    pub sampling: (usize, usize),
}

/// Fills a component of pixels, `width` a row, from a plane that covers them.
pub(super) fn enlarge(pixels: &mut [[f32; 4]], width: usize, component: usize, plane: &Plane) {
    let (across, down) = plane.sampling;
    let rows = plane.samples.len() / plane.width;
    pixels.par_chunks_mut(width).enumerate().for_each(|(y, pixels)| {
        let row = |row: usize| &plane.samples[row * plane.width..][..plane.width];
        let near = neighbours(y / down, rows);
        let blended: Vec<f32> = (0..plane.width).map(|x| cubic(near.map(|y| row(y)[x]), y % down, down)).collect();
        for (x, pixel) in pixels.iter_mut().enumerate() {
            pixel[component] = cubic(neighbours(x / across, plane.width).map(|x| blended[x]), x % across, across);
        }
    });
}

/// The sample at or before a place, the one before it, and the two after it.
fn neighbours(at: usize, count: usize) -> [usize; 4] {
    let last = count - 1;
    [at.saturating_sub(1), at, (at + 1).min(last), (at + 2).min(last)]
}

/// The value `step` / `steps` of the way from the second to the third of four samples.
fn cubic([a, b, c, d]: [f32; 4], step: usize, steps: usize) -> f32 {
    // Not b times 1 and the others times 0: they may be infinite.
    if step == 0 {
        return b;
    }
    let t = step as f32 / steps as f32;
    let slope = c - a + t * (2.0 * a - 5.0 * b + 4.0 * c - d + t * (3.0 * (b - c) + d - a));
    b + 0.5 * t * slope
}

/// Turns pixels of RY, Y, BY into red, green, blue. `weights` are those of luminance, of which green's is not 0.
pub(super) fn to_rgb(pixels: &mut [[f32; 4]], weights: [f64; 3]) {
    let [red, green, blue] = weights.map(|weight| weight as f32);
    pixels.par_iter_mut().for_each(|pixel| {
        let [ry, y, by, alpha] = *pixel;
        let (r, b) = ((ry + 1.0) * y, (by + 1.0) * y);
        // Grey stays grey to the last bit.
        let g = if ry == 0.0 && by == 0.0 { y } else { (y - r * red - b * blue) / green };
        *pixel = [r, g, b, alpha];
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_parabola_comes_through_between_its_samples() {
        // Catmull-Rom is exact for polynomials of degree 2.
        let f = |x: f32| 3.0 + 0.5 * x - 0.25 * x * x;
        for steps in [2, 4] {
            for step in 0..steps {
                let at = step as f32 / steps as f32;
                let got = cubic([-1.0, 0.0, 1.0, 2.0].map(f), step, steps);
                assert!((got - f(at)).abs() < 1e-6, "{got} at {at}");
            }
        }
    }

    #[test]
    fn samples_lie_on_their_pixels() {
        let plane = Plane { samples: vec![1.0, f32::INFINITY, 3.0, 4.0], width: 2, sampling: (2, 2) };
        let mut pixels = vec![[0.0; 4]; 16];
        enlarge(&mut pixels, 4, 1, &plane);
        assert_eq!([0, 2, 8, 10].map(|at| pixels[at][1]), [1.0, f32::INFINITY, 3.0, 4.0]);
    }

    #[test]
    fn luminance_and_chroma_are_what_openexr_says() {
        let weights = [0.2126, 0.7152, 0.0722];
        let (r, g, b) = (0.9, 0.4, 0.1);
        let y = weights[0] * r + weights[1] * g + weights[2] * b;
        let mut pixels = [[((r - y) / y) as f32, y as f32, ((b - y) / y) as f32, 0.5], [0.0, 0.3, 0.0, 1.0]];
        to_rgb(&mut pixels, weights);
        for (got, want) in pixels[0].iter().zip([r, g, b, 0.5]) {
            assert!((f64::from(*got) - want).abs() < 1e-6, "{got} for {want}");
        }
        assert_eq!(pixels[1], [0.3, 0.3, 0.3, 1.0]);
    }
}
