//! The pixels at which a ghost is computed.

use glam::DVec2;

use crate::frame::{Frame, Window};
use crate::scene::Ghost;
use crate::series::Shape;

/// The most pixels along a side of an [`Area`] that may be drawn as a point.
pub(crate) const LARGEST_POINT: f64 = 64.0;

/// A point may hold so many times the pixels that its ghost asks for.
const SQUARE: f64 = 1.3;

/// Pixels by which a reach is widened, so that no rounding of f64 leaves out a pixel on a rim.
const SLACK: f64 = 1e-3;

/// Pixels of the picture: columns and rows, the last ones exclusive. Whether it is a point does not depend on the tile or the
/// device: the order in which ghosts are added up does on that, and with it the last bit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Area {
    pub first: [i32; 2],
    pub last: [i32; 2],
    /// A small square that may reach beyond the window; anything else ends there.
    pub point: bool,
}

impl Area {
    const NONE: Self = Self { first: [0; 2], last: [0; 2], point: false };

    /// How far a bell is computed, in sizes, where it is left out below a share of its peak: where it ends not much farther, all
    /// of it, so that nothing is left out at all.
    pub fn reach(shape: &dyn Shape, share: f64) -> f64 {
        const NEARLY: f64 = 0.9;
        let (reach, ends) = (shape.reach(share), shape.ends());
        if share < 1.0 && reach >= NEARLY * ends { ends } else { reach }
    }

    /// Where a ghost may be above a share of its peak; nowhere, where none of that is in the window.
    pub fn new(ghost: &Ghost, share: f64, frame: Frame) -> Self {
        let center = frame.pixel(ghost.center);
        let half = Self::reach(ghost.bell.shape(), share) * ghost.size / frame.pixel_sides() + SLACK;
        let (first, last) = ((center - half).ceil(), (center + half).floor() + 1.0);
        let [low, high] = ends(frame.window);
        let (inside, until) = (first.clamp(low, high), last.clamp(low, high));
        if inside.cmpge(until).any() {
            return Self::NONE;
        }
        let integers = |place: DVec2| place.as_ivec2().to_array();
        let sides = last - first;
        let side = sides.max_element();
        if side <= LARGEST_POINT && side * side <= SQUARE * sides.element_product() {
            let first = first - ((side - sides) / 2.0).floor();
            return Self { first: integers(first), last: integers(first + side), point: true };
        }
        Self { first: integers(inside), last: integers(until), point: false }
    }

    /// How many of them are in the window.
    pub fn pixels(&self, frame: Frame) -> f64 {
        let [low, high] = ends(frame.window);
        let [first, last] = [self.first, self.last].map(|[x, y]| DVec2::new(f64::from(x), f64::from(y)));
        (last.clamp(low, high) - first.clamp(low, high)).element_product()
    }
}

/// The window's first pixel, and the one after its last.
fn ends(window: Window) -> [DVec2; 2] {
    let low = DVec2::new(f64::from(window.x), f64::from(window.y));
    [low, low + DVec2::new(f64::from(window.width), f64::from(window.height))]
}
