//! How a picture is looked at, and where its pixels lie on the screen for it.

use egui::{Pos2, Rect, pos2};
use glam::DVec2;

use super::study::Wanted;
use crate::gpu::Region;
use crate::photo::ToneMap;

/// The largest exposure that can be set, in stops up and down.
pub const MOST_EXPOSURE: f64 = 16.0;

/// What the canvas shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Shows {
    /// The photo with its glare.
    #[default]
    Picture,
    /// The photo as it was.
    Photo,
    /// The glare alone.
    Glare,
    /// The photo without the veil that the look describes.
    Clean,
}

/// Which part of the picture is seen, and how large.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Zoom {
    /// All of it, as large as fits.
    #[default]
    Fit,
    /// So many shown pixels to one of the screen, with this place of the picture in the middle.
    Fixed {
        /// Shown pixels to one of the screen, > 0.
        pitch: f64,
        /// The place in the middle, in shown pixels from the top left.
        center: DVec2,
    },
}

/// How a picture is looked at; neither the glare nor what is saved depends on it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Viewing {
    /// Which part, how large.
    pub zoom: Zoom,
    /// What is seen.
    pub shows: Shows,
    /// Stops, −`MOST_EXPOSURE` to `MOST_EXPOSURE`.
    pub exposure: f64,
    /// How light comes into the display's range.
    pub tone_map: ToneMap,
    /// What part of the canvas, 0 to 1 from the left, shows the photo as it was.
    pub wipe: Option<f64>,
    /// Whether the constant term of the field's series is left out.
    pub without_constant: bool,
    /// Whether the lights are drawn over the picture.
    pub handles: bool,
    /// Whether a loupe is at the pointer.
    pub loupe: bool,
    /// Whether the pixels that are light are marked.
    pub mask: bool,
    /// What is to be found out while it rests.
    pub wanted: Wanted,
}

impl Default for Viewing {
    fn default() -> Self {
        Self {
            zoom: Zoom::Fit,
            shows: Shows::Picture,
            exposure: 0.0,
            tone_map: ToneMap::default(),
            wipe: None,
            without_constant: false,
            handles: true,
            loupe: false,
            mask: false,
            wanted: Wanted::default(),
        }
    }
}

/// Where the picture lies on the screen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Placement {
    /// The canvas, in points.
    pub rect: Rect,
    /// The canvas, in pixels of the screen.
    pub region: Region,
    /// Pixels of the screen in one point.
    pub scale: f64,
    /// The picture's place at the canvas's top left corner.
    pub origin: DVec2,
    /// The picture's pixels from one of the screen to the next.
    pub pitch: f64,
}

impl Placement {
    /// Of a picture of `size` pixels on a canvas; none where the canvas has no pixels.
    pub fn new(zoom: Zoom, size: [u32; 2], rect: Rect, scale: f32, screen: [u32; 2]) -> Option<Self> {
        let edge = |points: f32, most: u32| (points * scale).round().clamp(0.0, most as f32) as u32;
        let (x, y) = (edge(rect.min.x, screen[0]), edge(rect.min.y, screen[1]));
        let (right, bottom) = (edge(rect.max.x, screen[0]), edge(rect.max.y, screen[1]));
        let region = Region { x, y, width: right.checked_sub(x)?, height: bottom.checked_sub(y)? };
        if region.width == 0 || region.height == 0 {
            return None;
        }
        let size = DVec2::new(f64::from(size[0]), f64::from(size[1]));
        let canvas = DVec2::new(f64::from(region.width), f64::from(region.height));
        let (pitch, center) = match zoom {
            Zoom::Fit => ((size / canvas).max_element(), size / 2.0),
            Zoom::Fixed { pitch, center } => (pitch, center),
        };
        let corner = center - pitch * canvas / 2.0;
        // Whole pixels of the screen, where it is magnified or 1:1, so that squares keep their edges while it is moved.
        let origin = if pitch <= 1.0 { (corner / pitch).round() * pitch } else { corner };
        Some(Self { rect, region, scale: f64::from(scale), origin, pitch })
    }

    /// Where a place of the picture lies on the screen, in points.
    pub fn to_screen(&self, place: DVec2) -> Pos2 {
        let corner = DVec2::new(f64::from(self.region.x), f64::from(self.region.y));
        let at = (corner + (place - self.origin) / self.pitch) / self.scale;
        pos2(at.x as f32, at.y as f32)
    }

    /// The inverse of [`Placement::to_screen`].
    pub fn to_picture(&self, at: Pos2) -> DVec2 {
        let corner = DVec2::new(f64::from(self.region.x), f64::from(self.region.y));
        let at = DVec2::new(f64::from(at.x), f64::from(at.y)) * self.scale - corner;
        self.origin + self.pitch * at
    }

    /// The picture's place in the middle of the canvas.
    pub fn center(&self) -> DVec2 {
        self.origin + self.pitch * DVec2::new(f64::from(self.region.width), f64::from(self.region.height)) / 2.0
    }

    /// The zoom that is `factor` times as large and leaves what is at `at`, in points, where it is.
    pub fn zoomed(&self, factor: f64, at: Pos2) -> Zoom {
        // From a pixel as large as a canvas to 64 of the picture's in one.
        let pitch = (self.pitch / factor).clamp(1.0 / 256.0, 64.0);
        let fixed = self.to_picture(at);
        Zoom::Fixed { pitch, center: fixed + (self.center() - fixed) * (pitch / self.pitch) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui::vec2;

    fn placed(zoom: Zoom) -> Placement {
        let rect = Rect::from_min_size(pos2(10.0, 20.0), vec2(200.0, 100.0));
        Placement::new(zoom, [400, 100], rect, 2.0, [800, 600]).unwrap()
    }

    #[test]
    fn fit_shows_all_of_the_picture_in_the_middle() {
        let placement = placed(Zoom::Fit);
        assert_eq!(placement.region, Region { x: 20, y: 40, width: 400, height: 200 });
        assert_eq!((placement.pitch, placement.origin), (1.0, DVec2::new(0.0, -50.0)));
        assert_eq!(placement.to_screen(DVec2::new(200.0, 50.0)), pos2(110.0, 70.0));
    }

    #[test]
    fn zooming_keeps_what_is_under_the_pointer() {
        let mut placement = placed(Zoom::Fit);
        let at = pos2(33.0, 91.0);
        for factor in [1.7, 3.0, 0.01, 1e6] {
            let before = placement.to_picture(at);
            placement = placed(placement.zoomed(factor, at));
            // Within the pixel of the screen to which the corner is rounded.
            assert!((placement.to_picture(at) - before).abs().max_element() <= placement.pitch, "{factor}");
        }
    }

    #[test]
    fn a_canvas_without_pixels_has_no_placement() {
        let rect = Rect::from_min_size(pos2(10.0, 20.0), vec2(0.0, 100.0));
        assert_eq!(Placement::new(Zoom::Fit, [4, 4], rect, 1.0, [100, 100]), None);
        let beyond = Rect::from_min_size(pos2(200.0, 20.0), vec2(50.0, 50.0));
        assert_eq!(Placement::new(Zoom::Fit, [4, 4], beyond, 1.0, [100, 100]), None);
    }
}
