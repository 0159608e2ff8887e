//! The main path: spectrum → field → normalise → composite.
//!
//! Three things, each used by those who need it: a [`Field`] evaluates a plan, a [`Picture`] lays a field's glare over a
//! photo, and a [`Live`] shows a picture on a screen. A [`Scatter`] sums the veil of a photo.
//!
//! ```no_run
//! # use vglare::{frame::Frame, gpu::{Backend, Device}, plan::{plan, Request}, problem::Problem};
//! # use vglare::renderer::{Picture, Settings};
//! # let (ghosts, frame) = (Vec::new(), Frame::full(1920, 1080));
//! # let mut pixels = vec![[0.0; 4]; frame.window.pixels()];
//! let device = Device::open(&Backend::ALL)?;
//! let plan = plan(&Problem::new(ghosts, frame), &Request::new(1e-3))?;
//! let mut picture = Picture::new(&device)?;
//! picture.field.set_scene(&plan)?; // the spectrum, once
//! picture.composite(frame, &mut pixels, &Settings::default())?;
//! # Ok::<(), vglare::Error>(())
//! ```

mod convert;
mod exchange;
mod field;
mod graf;
mod lattice;
mod live;
mod local;
mod mask;
mod picture;
mod plate;
mod scatter;
mod settings;
mod spectrum;
mod tiles;
mod view;

use crate::frame::Window;

pub use exchange::Pending;
pub use field::Field;
pub use graf::{GrafRenderer, GrafScene};
pub use live::Live;
pub use mask::Mask;
pub use picture::Picture;
pub use scatter::Scatter;
pub use settings::Settings;
pub use view::{Part, View};

pub use crate::choices::Normalize;

/// Where a tile's first pixel stands among the window's.
fn offset(window: Window, tile: Window) -> usize {
    (tile.y - window.y) as usize * window.width as usize + (tile.x - window.x) as usize
}
