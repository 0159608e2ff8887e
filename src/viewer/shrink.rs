//! A photo that is too large to be computed live, as means of squares of its pixels.

use crate::frame::{Frame, Window};

/// The smallest side of squares by which a window comes to at most `most` pixels.
pub(super) fn side(window: Window, most: usize) -> u32 {
    (1..).find(|&side| shrunk(window, side).pixels() <= most).unwrap_or(1)
}

fn shrunk(window: Window, side: u32) -> Window {
    let i_side = side as i32;
    Window {
        x: window.x.div_euclid(i_side),
        y: window.y.div_euclid(i_side),
        width: (window.width / side).max(1),
        height: (window.height / side).max(1),
    }
}

/// The means of squares of pixels; what does not fill a square at the right and at the bottom is left out.
pub(super) fn shrink(frame: &Frame, pixels: &[[f32; 4]], side: u32) -> (Frame, Option<Vec<[f32; 4]>>) {
    let from = frame.window;
    let to = shrunk(from, side);
    let [width, height] = [frame.width, frame.height].map(|whole| (whole / side).max(1));
    let frame = frame.resized(width, height).with_window(to);
    let stride = from.width as usize;
    let (wide, tall) = (side.min(from.width) as usize, side.min(from.height) as usize);
    let weight = 1.0 / (wide * tall) as f32;
    let mean = |row: usize, column: usize| {
        let mut sum = [0.0f32; 4];
        for line in 0..tall {
            let at = (row * side as usize + line) * stride + column * side as usize;
            for pixel in &pixels[at..at + wide] {
                for (sum, value) in sum.iter_mut().zip(pixel) {
                    *sum += value * weight;
                }
            }
        }
        sum
    };
    let (width, height) = (to.width as usize, to.height as usize);
    let pixels = (0..height).flat_map(|row| (0..width).map(move |column| (row, column)));
    (frame, Some(pixels.map(|(row, column)| mean(row, column)).collect()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::photo::Photo;

    #[test]
    fn a_large_photo_is_shown_by_means_of_squares() {
        let pixels = (0..12 * 6).map(|i| [(i % 12) as f32, (i / 12) as f32, 1.0, 1.0]).collect();
        let photo = Photo::new(12, 6, pixels);
        assert_eq!((side(photo.frame.window, 72), side(photo.frame.window, 71)), (1, 2));
        let (frame, pixels) = shrink(&photo.frame, &photo.pixels, 3);
        let pixels = pixels.unwrap();
        assert_eq!((frame, pixels.len()), (Frame::full(4, 2), 8));
        assert!(pixels[1].iter().zip([4.0, 1.0, 1.0, 1.0]).all(|(got, want)| (got - want).abs() < 1e-5), "{pixels:?}");
    }

    #[test]
    fn a_strip_is_shrunk_without_vanishing() {
        let (frame, pixels) = shrink(&Frame::full(9, 1), &[[2.0; 4]; 9], 4);
        let pixels = pixels.unwrap();
        assert_eq!((frame.window.width, frame.window.height, pixels.len()), (2, 1, 2));
        assert!(pixels.iter().flatten().all(|value| (value - 2.0).abs() < 1e-6));
    }
}
