//! What moves from frame to frame: lights in a picture, or a camera in a panorama.
//!
//! | module | what it does |
//! | --- | --- |
//! | `curve` | values at times → values at any time between, smooth and without overshoot |
//! | `path` | what lights or a camera do at a time |
//! | `file` | a file of rows → a path |
//! | `fade` | how much of a light is in the picture, and lights drawn as lamps |
//! | `view` | what a camera sees of a panorama |

mod curve;
mod fade;
mod file;
mod path;
mod view;

pub use curve::Track;
pub use fade::{LEAST_SHARE, Lamps, Sheet};
pub use file::{FLUX, SIZE, Said, read_path};
pub use path::{Camera, LightPath, Path, Sees};
pub use view::{Panorama, VIEW_FOV};
