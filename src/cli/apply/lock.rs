//! What is chosen once for a shot, by one of its frames.

use std::path::PathBuf;
use std::str::FromStr;

use super::inputs::Inputs;
use super::outputs::Sequence;
use super::{Args, job};
use crate::choices::Normalize;
use crate::job::{Computer, Found, Stages, Unwatched};
use crate::look::Look;
use crate::photo::{self, Photo};
use crate::scene::{self, Emission, Recover};
use crate::{Error, Result};

/// By which frame that is chosen which would otherwise be by each.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Lock {
    /// The first.
    First,
    /// That of a number.
    Frame(i64),
    /// By each.
    None,
}

impl FromStr for Lock {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "first" => Ok(Self::First),
            "none" => Ok(Self::None),
            _ => text.parse().map(Self::Frame).map_err(|_| "expected \"first\", \"none\" or a frame's number".into()),
        }
    }
}

/// A look of which nothing is left for a frame to choose that all are to have alike.
#[derive(Debug)]
pub struct Locked {
    pub look: Look,
    /// Between which values of the field glare is stretched.
    pub range: Option<[f32; 2]>,
}

/// A locked look, and what it took to know it, if it took that.
pub struct Locking {
    pub locked: Locked,
    pub computer: Option<Computer>,
}

impl Locking {
    /// Locks a look for a sequence. A heap of photos that are no shot is not locked unless --lock-from says so.
    ///
    /// # Errors
    /// [`Error::Usage`] for a frame that is not there; those of reading it, and of planning its glare.
    pub fn new(args: &Args, sequence: &Sequence, look: Look) -> Result<Self> {
        let mut locking = Self { locked: Locked { look, range: None }, computer: None };
        let look = &mut locking.locked.look;
        let [threshold, recover, range] = free(look);
        if !(threshold || recover || range) {
            return Ok(locking);
        }
        let Some(path) = frame(args, sequence)? else { return Ok(locking) };
        let photo = photo::read_with(&path, &args.reading.of_white(args.veil.white_luminance()))?;
        if recover && photo.source.display_referred {
            let stops = scene::recovery_stops(&photo.pixels, photo.frame.window.width as usize, Emission::of(&photo));
            look.find.recover = Recover::AutoFrom(stops);
        }
        if threshold {
            let frame = look.frame(&photo)?;
            look.find.threshold = Some(look.find(&photo, &look.recovered(&photo), &frame).threshold);
        }
        if range {
            let mut computer = job::computer(args)?;
            locking.locked.range = Some(stretched(look, photo, &mut computer)?);
            locking.computer = Some(computer);
        }
        Ok(locking)
    }
}

/// Whether a photo would choose the threshold, how much brighter what is clipped shines, and between what its glare is stretched.
fn free(look: &Look) -> [bool; 3] {
    [
        look.searches() && look.find.threshold.is_none(),
        look.takes_light() && look.find.recover == Recover::Auto,
        look.renders() && look.normalize == Normalize::Minmax,
    ]
}

/// The frame that chooses for all.
fn frame(args: &Args, sequence: &Sequence) -> Result<Option<PathBuf>> {
    let given = args.photos();
    match args.sequence.lock {
        Some(Lock::None) => Ok(None),
        None => Inputs::first(given),
        Some(Lock::First) => Ok(Inputs::first(given)?.or_else(|| Some(sequence.frames.first()?.input.clone()))),
        Some(Lock::Frame(number)) => {
            let inputs = Inputs::new(given, Some(&[number].into_iter().collect()))?;
            let none = || {
                Error::Usage(format!(
                    "--lock-from {number}: {}",
                    Error::MissingFrames { missing: inputs.missing.clone() }
                ))
            };
            inputs.photos.first().cloned().map(Some).ok_or_else(none)
        }
    }
}

/// Between which values the glare of a photo is stretched.
fn stretched(look: &Look, photo: Photo, computer: &mut Computer) -> Result<[f32; 2]> {
    Found::new(look, photo, Stages::default())?.plan(computer, &Unwatched)?.range(computer)
}
