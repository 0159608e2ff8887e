//! A look laid over a photo: find, plan, render, certify. What the command line and the window do alike.
//!
//! Each step is a type of its own, which the next one consumes, so that nothing can be asked for before it is there:
//!
//! | step | what is known by then |
//! | --- | --- |
//! | [`Found`] | the photo, what glares in it, what the composite is told |
//! | [`Planned`] | the plan, too |
//! | [`Done`] | the picture, the glare alone, how exact they are and how long they took |
//!
//! ```no_run
//! # use std::path::Path;
//! # use vglare::{gpu::{Backend, Device}, job::{Computer, Found, Known, Stages, Unwatched, Wanted}, look::Look, photo};
//! let device = Device::open(&Backend::ALL)?;
//! let known = Known::of(device.info());
//! let mut computer = Computer::new(device, known);
//! let look = Look { strength: 1.5, ..Look::default() };
//! let found = Found::new(&look, photo::read(Path::new("night.exr"))?, Stages::default())?;
//! let done = found.compute(Some(&mut computer), Wanted::default(), &Unwatched)?;
//! let picture = done.picture.expect("it is wanted");
//! photo::write(Path::new("out.exr"), &picture, &photo::WriteOptions::default())?;
//! # Ok::<(), vglare::Error>(())
//! ```

mod beside;
mod computer;
mod done;
mod each_pixel;
mod excess;
mod found;
mod panorama;
mod planned;
mod planning;
mod settings;
mod veil;
mod watch;

use std::time::Instant;

use crate::certificate::Verify;

pub use crate::calibration::Known;
pub use computer::Computer;
pub use done::{Computed, Done};
pub use each_pixel::{Darkest, EachPixel};
pub use found::Found;
pub use planned::Planned;
#[cfg(feature = "laboratory")]
pub(crate) use planning::request;
pub use planning::{Planning, plan};
pub use settings::{bright_light, settings};
pub use veil::{
    Amplification, Clipped, Ledger, MOST_LAYERS, Negative, NoSources, Removal, RemovalError, Removed, Removing,
    VeilError, VeilLayers, VeilPlanned, VeilSeen, VeilSums, Veiled, plan_veil, remove,
};
#[cfg(feature = "laboratory")]
pub(crate) use veil::{Trial, plan_of, trials};
pub use watch::{Step, Unwatched, Watch};

/// What is wanted. The picture does not depend on what else is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wanted {
    /// The picture.
    pub picture: bool,
    /// The glare alone.
    pub glare: bool,
    /// What the glare is made of, as layers beside the picture.
    pub layers: bool,
    /// How long each pass takes, at the price of doing one after the other.
    pub times: bool,
    /// Where the error is measured.
    pub verify: Verify,
}

impl Default for Wanted {
    /// The picture alone.
    fn default() -> Self {
        Self { picture: true, glare: false, layers: false, times: false, verify: Verify::Sample }
    }
}

/// Stages and their milliseconds.
#[derive(Debug, Default)]
pub struct Stages(pub Vec<(&'static str, f64)>);

impl Stages {
    /// Runs one stage and notes how long it took.
    pub fn time<T>(&mut self, name: &'static str, work: impl FnOnce() -> T) -> T {
        let started = Instant::now();
        let result = work();
        self.0.push((name, started.elapsed().as_secs_f64() * 1e3));
        result
    }

    /// Lets one stage have some of the milliseconds of another.
    fn shift(&mut self, from: &str, to: &str, milliseconds: f64) {
        for (stage, wall) in &mut self.0 {
            match stage {
                stage if *stage == from => *wall = (*wall - milliseconds).max(0.0),
                stage if *stage == to => *wall += milliseconds,
                _ => {}
            }
        }
    }
}
