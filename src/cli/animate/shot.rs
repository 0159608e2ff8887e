//! What happens in which frame, known before anything is computed.

use super::{Args, Outside};
use crate::motion::{Camera, LightPath, Path, Said, Sees, Sheet, Track, VIEW_FOV};
use crate::scene::Light;
use crate::{Error, Result};

/// Frames, and what moves through them.
pub struct Shot {
    /// The number of the first.
    pub first: i64,
    /// How many there are.
    pub frames: usize,
    /// What moves.
    pub path: Path,
}

/// A light in a frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lit {
    /// Its number among the path's.
    pub light: usize,
    /// As the path has it.
    pub given: Light,
    /// How much of it makes glare.
    pub share: f64,
}

/// The lights of each frame: those that are the same in all of them, and those that are not.
pub struct Cast {
    pub still: Vec<Lit>,
    pub moving: Vec<Vec<Lit>>,
}

impl Shot {
    /// What the options make of a path.
    ///
    /// # Errors
    /// [`Error::Usage`] where nothing says how many frames there are.
    pub fn new(args: &Args, said: Said) -> Result<Self> {
        let Said { path, counts_frames } = said;
        let [first, last] = path.span();
        let counted = counts_frames.then_some(last - first + 1.0);
        let frames = match (args.motion.frames, counted) {
            (Some(frames), _) => frames as usize,
            (None, Some(counted)) if counted <= 1e6 => counted as usize,
            (None, Some(counted)) => {
                return Err(Error::Usage(format!(
                    "the path counts {counted} frames; --frames says how many there are to be"
                )));
            }
            (None, None) => return Err(Error::Usage("how many frames are there to be? --frames N says it".into())),
        };
        let number = args.motion.first.map(i64::from).unwrap_or(if counts_frames { first as i64 } else { 1 });
        Ok(Self { first: number, frames, path })
    }

    /// The number of a frame, counted from 0.
    pub fn number(&self, frame: usize) -> i64 {
        self.first + frame as i64
    }

    /// The time of a frame.
    pub fn time(&self, frame: usize) -> f64 {
        self.path.time(frame, self.frames)
    }

    /// The lights of all frames of a picture.
    pub fn cast(&self, lights: &[LightPath], sheet: &Sheet, outside: Outside) -> Cast {
        let lit = |frame: usize, number: usize| -> Option<Lit> {
            let given = lights[number].at(self.time(frame))?;
            let share = if outside == Outside::Keep { 1.0 } else { sheet.share(&given) };
            Some(Lit { light: number, given, share })
        };
        let mut cast = Cast { still: Vec::new(), moving: vec![Vec::new(); self.frames] };
        for number in 0..lights.len() {
            let all: Vec<Option<Lit>> = (0..self.frames).map(|frame| lit(frame, number)).collect();
            match all[0] {
                Some(first) if all.iter().all(|lit| *lit == Some(first)) => cast.still.push(first),
                _ => cast.moving.iter_mut().zip(all).for_each(|(frame, lit)| frame.extend(lit)),
            }
        }
        cast
    }

    /// The camera of a frame, and the field of view that it has then.
    ///
    /// # Panics
    /// Where `track` is not this shot's.
    pub fn camera(&self, track: &Track<4>, sees: Sees, frame: usize, unsaid: Option<f64>) -> (Camera, f64) {
        let camera = Camera::at(track, sees, self.time(frame)).expect("a camera is there in all frames");
        let fov = camera.fov.or(unsaid).unwrap_or(VIEW_FOV);
        (camera, fov)
    }
}

impl Cast {
    /// All lights of a frame, in the path's order.
    pub fn at(&self, frame: usize) -> Vec<Lit> {
        let mut all = [&self.still[..], &self.moving[frame]].concat();
        all.sort_by_key(|lit| lit.light);
        all
    }

    /// Whether anything ever changes.
    pub fn moves(&self) -> bool {
        self.moving.iter().any(|lights| !lights.is_empty())
    }
}
