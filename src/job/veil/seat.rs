//! Where the stored pixels of a picture lie among those that a veil is summed on.
//!
//! On the sphere a camera looks along the middle of its picture. Pixels that are stored of another part (OpenEXR's data window within, or
//! beside, its display window) are then seen as a part of the smallest picture around that middle that holds them, black
//! elsewhere: what is not stored sends no light.

use std::borrow::Cow;

use rayon::prelude::*;

use super::planning::Pixels;
use super::told;
use crate::choices::Border;
use crate::frame::Frame;
use crate::look::Veil as Wanted;
use crate::photo::View;
use crate::psf::Fault;
use crate::veil::{self, Geometry};
use crate::{Result, limits};

/// The most pixels of a picture that is summed for what is stored of it.
const MOST: u64 = 1 << 28;
/// Bytes that a pixel takes while it is summed, about.
const BYTES: u64 = 64;

/// How a picture's pixels lie, and which of them are stored.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Seat {
    pub geometry: Geometry,
    /// Columns and rows of the picture that is planned and summed.
    pub size: [usize; 2],
    /// Of those that are stored.
    pub stored: [usize; 2],
    /// The first stored column and row in that picture.
    first: [usize; 2],
}

impl Seat {
    /// Of the pixels of a frame, for a function whose lengths are in the frame's unit; `view` says how the picture was seen, for one in
    /// degrees.
    ///
    /// # Errors
    /// Where the veil has no such geometry; where the pixels are stored so far from the middle that a sum over them would take too
    /// much memory.
    pub fn new(wanted: &Wanted, frame: &Frame, view: Option<&View>) -> Result<Self> {
        let geometry = wanted.geometry(frame, view).map_err(told)?;
        let stored = [frame.window.width as usize, frame.window.height as usize];
        if matches!(geometry, Geometry::Planar { .. } | Geometry::Equirectangular) {
            return Ok(Self { geometry, size: stored, stored, first: [0, 0] });
        }
        let along = |first: i32, stored: u32, all: u32| {
            // Twice the way from the first stored pixel to the picture's middle, and from there to the last.
            let before = i64::from(all) - 1 - 2 * i64::from(first);
            let after = 2 * (i64::from(stored) - 1) - before;
            let half = before.max(after);
            [half + 1, (half - before) / 2]
        };
        let sides = [
            along(frame.window.x, frame.window.width, frame.width),
            along(frame.window.y, frame.window.height, frame.height),
        ];
        let [width, height] = sides.map(|[side, _]| side.unsigned_abs());
        let pixels = width.saturating_mul(height);
        let most = MOST.max(frame.window.pixels() as u64);
        if pixels > most || width.max(height) > veil::plan::LONGEST_SIDE as u64 {
            return Err(told(Fault::new(
                "projection",
                format!(
                    "what is stored lies so far from the picture's middle, where its camera looks, that the veil would be summed on \
                     {width} × {height} pixels; planar takes it"
                ),
            )));
        }
        let seat = Self {
            geometry,
            size: sides.map(|[side, _]| side as usize),
            stored,
            first: sides.map(|[_, first]| first as usize),
        };
        if seat.size != seat.stored {
            limits::room(BYTES * pixels, "the picture that the stored pixels are a part of")?;
        }
        Ok(seat)
    }

    /// What is planned for.
    pub fn pixels(&self, border: Border) -> Pixels<'_> {
        Pixels { geometry: &self.geometry, size: self.size, border }
    }

    /// A stored pixel in the picture that is summed.
    pub fn seen(&self, [x, y]: [usize; 2]) -> [usize; 2] {
        [x + self.first[0], y + self.first[1]]
    }

    /// What a stored pixel at a column and row weighs as a source.
    pub fn solid_angle(&self, pixel: [usize; 2]) -> f64 {
        self.geometry.solid_angle(self.size, self.seen(pixel))
    }

    /// The picture that is summed, of the stored pixels.
    pub fn filled<'a>(&self, stored: &'a [[f32; 4]]) -> Cow<'a, [[f32; 4]]> {
        if self.size == self.stored || stored.len() != self.stored[0] * self.stored[1] {
            return Cow::Borrowed(stored);
        }
        let mut all = vec![[0.0; 4]; self.size[0] * self.size[1]];
        for (y, row) in stored.chunks_exact(self.stored[0]).enumerate() {
            let [x, y] = self.seen([0, y]);
            all[y * self.size[0] + x..][..row.len()].copy_from_slice(row);
        }
        Cow::Owned(all)
    }

    /// What of a veil falls on the stored pixels.
    pub fn cropped(&self, mut veil: veil::Veil) -> veil::Veil {
        if self.size == self.stored {
            return veil;
        }
        for (plane, dark) in veil.planes.iter_mut().zip(&mut veil.dark) {
            let floor = veil::FLOOR * f64::from(plane.par_iter().copied().reduce(|| 0.0, f32::max));
            let row = |y: usize| {
                let [x, y] = self.seen([0, y]);
                &plane[y * self.size[0] + x..][..self.stored[0]]
            };
            *plane = (0..self.stored[1]).flat_map(row).copied().collect();
            *dark = plane.iter().filter(|value| f64::from(**value) < floor).count();
        }
        veil
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::choices::Projection;
    use crate::frame::Window;
    use crate::psf::{Name, Parameters};
    use crate::scene::VeilSection;

    fn cie() -> Wanted {
        let parameters = Parameters::new(Name::Cie);
        let section = VeilSection { parameters, fov: None, projection: None, border: None, tolerance: None };
        Wanted::new(&section, false).unwrap()
    }

    fn seat(window: Window) -> Result<Seat> {
        let frame = Frame::full(40, 31).with_window(window);
        Seat::new(&cie(), &frame, Some(&View::of_field(60.0, &frame, Projection::Rectilinear)))
    }

    /// A stored pixel has the solid angle that the whole picture says of it, wherever the stored ones lie.
    #[test]
    fn the_camera_looks_along_the_middle_of_the_picture() {
        let whole = seat(Window { x: 0, y: 0, width: 40, height: 31 }).unwrap();
        assert!(whole.size == [40, 31] && whole.stored == whole.size && whole.first == [0, 0]);
        let windows = [
            (Window { x: 3, y: 2, width: 5, height: 4 }, [34, 27]),
            (Window { x: 30, y: 16, width: 10, height: 15 }, [40, 31]),
            (Window { x: -6, y: 15, width: 70, height: 1 }, [88, 1]),
            (Window { x: 19, y: 0, width: 2, height: 31 }, [2, 31]),
            (Window { x: 45, y: 3, width: 5, height: 5 }, [60, 25]),
        ];
        for (window, size) in windows {
            let seat = seat(window).unwrap();
            assert_eq!((seat.size, seat.stored), (size, [window.width as usize, window.height as usize]));
            for (x, y) in [(0, 0), (window.width - 1, 0), (window.width / 2, window.height - 1)] {
                let [column, row] = [window.x + x as i32, window.y + y as i32].map(f64::from);
                let focal = 20.0 / 30f64.to_radians().tan();
                let known = (1.0 + ((column - 19.5) / focal).powi(2) + ((row - 15.0) / focal).powi(2)).powf(-1.5);
                let found = seat.solid_angle([x as usize, y as usize]) * focal * focal;
                assert!((found / known - 1.0).abs() < 1e-12, "{window:?}: {found} for {known}");
            }
        }
    }

    #[test]
    fn what_is_stored_is_filled_up_and_cropped_again() {
        let seat = seat(Window { x: 3, y: 2, width: 5, height: 4 }).unwrap();
        let stored: Vec<[f32; 4]> = (1..=20).map(|value| [value as f32; 4]).collect();
        let filled = seat.filled(&stored);
        assert_eq!(filled.len(), 34 * 27);
        let plane: Vec<f32> = filled.iter().map(|pixel| pixel[0]).collect();
        assert_eq!(plane.iter().sum::<f32>(), 210.0);
        let veil = veil::Veil {
            planes: [plane.clone(), plane.clone(), plane],
            bad: veil::BadSources::default(),
            dark: [900; 3],
            lonely: [0; 3],
            certified: [0.0; 3],
        };
        let cropped = seat.cropped(veil);
        assert_eq!(cropped.planes[2], stored.iter().map(|pixel| pixel[0]).collect::<Vec<_>>());
        assert_eq!(cropped.dark, [0; 3]);
    }

    #[test]
    fn what_lies_too_far_off_is_refused_by_name() {
        let far = seat(Window { x: 30_000, y: -30_000, width: 8, height: 8 }).unwrap_err().to_string();
        assert!(far.contains("projection") && far.contains("planar"), "{far}");
    }
}
