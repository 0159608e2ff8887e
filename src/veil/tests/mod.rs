//! Veils against their definition.

mod extremes;
mod golden;
mod kernels;
mod photos;
mod planar;
mod rings;
mod spherical;
mod transform;

use super::reference::{self, Window};
use super::{Border, FLOOR, Geometry, Kernel, Photo, Veil};

/// Whether tests by chance take their long form; `.ci/full` asks for it.
fn long() -> bool {
    std::env::var_os("VGLARE_LONG_TESTS").is_some()
}

/// The largest error of a veil within a window, relative to the local veil or to the floor, and the channel and pixel where it is.
fn worst(
    veil: &Veil,
    photo: &Photo,
    geometry: &Geometry,
    kernel: &Kernel,
    border: Border,
    window: Window,
) -> (f64, String) {
    let truth = reference::veil(photo, geometry, kernel, border, window);
    let mut worst = (0.0, String::new());
    let last = [0, 1].map(|side| (window.first[side] + window.size[side]).min(photo.size()[side]));
    for channel in 0..3 {
        let largest = veil.planes[channel].iter().copied().fold(0.0, f32::max);
        let floor = FLOOR * f64::from(largest);
        let mut truth = truth.iter().map(|truth| truth[channel]);
        for y in window.first[1]..last[1] {
            for x in window.first[0]..last[0] {
                let truth = truth.next().unwrap_or(f64::NAN);
                let found = f64::from(veil.planes[channel][y * photo.size()[0] + x]);
                let error = if found == truth { 0.0 } else { (found - truth).abs() / truth.max(floor) };
                if error > worst.0 || error.is_nan() {
                    worst = (error, format!("channel {channel} at {x}, {y}: {found:e} for {truth:e}"));
                }
            }
        }
    }
    worst
}
