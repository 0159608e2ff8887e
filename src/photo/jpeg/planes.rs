//! From planes of components, each at its own size, to pixels.
//!
//! The decoder does this itself for the usual samplings; this is for the others: luma that is sampled less than chroma,
//! factors that do not divide, and scans that hold some of the components.
//!
//! \[JFIF\] ITU-T T.871, section 7: YCbCr.

use super::walk::Frame;

/// One component's samples.
pub(super) struct Plane {
    /// Columns of `samples`, at least as many as the component has.
    pub stride: usize,
    pub samples: Vec<u8>,
}

/// The pixels of the frame, interleaved, as the components have them: no change of colours.
pub(super) fn interleave(frame: &Frame, planes: &[Plane], out: &mut [u8]) {
    let count = planes.len();
    for (index, (plane, &component)) in planes.iter().zip(&frame.components).enumerate() {
        let (most_h, most_v) = frame.most();
        let (columns, rows) = frame.size_of(component);
        let smooth = most_h <= 2 * component.h && most_v <= 2 * component.v;
        let across = Steps { of: component.h, to: most_h, count: columns, smooth };
        let down = Steps { of: component.v, to: most_v, count: rows, smooth };
        for (y, line) in out.chunks_exact_mut(frame.width as usize * count).enumerate() {
            let near = &plane.samples[down.near(y) * plane.stride..][..columns];
            let far = &plane.samples[down.far(y) * plane.stride..][..columns];
            for (x, pixel) in line.chunks_exact_mut(count).enumerate() {
                let (a, b) = (across.near(x), across.far(x));
                let mix = |line: &[u8]| 3 * u16::from(line[a]) + u16::from(line[b]);
                pixel[index] = ((3 * mix(near) + mix(far) + 8) / 16) as u8;
            }
        }
    }
}

/// The samples of a component along one direction, beside the picture's.
///
/// Half as many are interpolated: three parts of the nearer sample and one of the farther, which are the distances of
/// their centres. Other numbers are rare, and repeated, as libjpeg does.
struct Steps {
    of: usize,
    to: usize,
    count: usize,
    /// Whether to interpolate.
    smooth: bool,
}

impl Steps {
    fn near(&self, at: usize) -> usize {
        (at * self.of / self.to).min(self.count - 1)
    }

    fn far(&self, at: usize) -> usize {
        let near = self.near(at);
        match (self.smooth && self.to == 2 * self.of, at % 2) {
            (true, 0) => near.saturating_sub(1),
            (true, _) => (near + 1).min(self.count - 1),
            (false, _) => near,
        }
    }
}

/// \[JFIF\] Y, Cb and Cr become R, G and B; a fourth component stays.
pub(super) fn ycc_to_rgb(pixels: &mut [u8], count: usize) {
    for pixel in pixels.chunks_exact_mut(count) {
        let [y, cb, cr] = [0, 1, 2].map(|i| f32::from(pixel[i]));
        let (cb, cr) = (cb - 128.0, cr - 128.0);
        let rgb = [y + 1.402 * cr, y - 0.344_136 * cb - 0.714_136 * cr, y + 1.772 * cb];
        // Casts saturate.
        (0..3).for_each(|i| pixel[i] = rgb[i].round() as u8);
    }
}
