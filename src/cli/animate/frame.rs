//! Frame after frame: what stands still is there already, and what moves is added.

use std::sync::Arc;

use super::parts::{Maker, Part, Photos, Pixels, Shares, add, shell};
use super::shot::{Cast, Shot};
use super::told::{ErrorTold, PlanTold, Told, together, veils};
use crate::cli::surroundings::{Seen, StrayTold};
use crate::job::VeilError;
use crate::look::Look;
use crate::motion::Sheet;
use crate::photo::{self, Photo};
use crate::scene::Goal;
use crate::{Error, Result};

/// A frame's pictures, and how they came about.
pub struct Drawn {
    pub picture: Option<Photo>,
    pub glare: Option<Photo>,
    pub told: FrameTold,
}

/// How a frame was computed.
#[derive(Debug, Clone, Default)]
pub struct FrameTold {
    /// How the ghosts of what moves were; none where nothing does.
    pub plan: Option<PlanTold>,
    /// Of all that is in the frame.
    pub error: Option<ErrorTold>,
    pub veil: Option<VeilError>,
    /// What light from outside the frame did.
    pub outside: Option<StrayTold>,
    /// What the frame took beside what stands still, without writing.
    pub milliseconds: f64,
    pub stages: Vec<(&'static str, f64)>,
    pub renderer: Option<String>,
    pub warnings: Vec<String>,
}

/// What stands still in all frames.
pub struct Base {
    part: Part,
    /// What each part of it is, and how it was computed.
    pub told: Vec<(&'static str, Told)>,
    pub warnings: Vec<String>,
    /// The pictures to be, without their pixels.
    picture: Photo,
    glare: Photo,
    /// What lamps are drawn in.
    shell: Photo,
    sheet: Sheet,
    /// Values of the photo that are no numbers.
    not_finite: usize,
}

/// Lights before what stands still.
pub struct Lights<'a> {
    pub maker: Maker<'a>,
    pub base: Base,
    shares: Shares,
    /// What a plan of what moves is to reach: a budget, until the first frame has bought a tolerance by it.
    goal: Goal,
}

impl<'a> Lights<'a> {
    /// Computes what stands still: the photo, where one is given or the look has lights and ghosts of its own; and the lights of
    /// the path that never change.
    ///
    /// # Errors
    /// Those of [`Maker::compute`].
    pub fn new(mut maker: Maker<'a>, photo: Photo, given: bool, cast: &Cast, sheet: Sheet) -> Result<Self> {
        let stands = given || !maker.look.ghosts.is_empty() || !maker.look.lights(&[]).is_empty();
        let lit = cast.still.iter().any(|lit| lit.given.flux != [0.0; 3]);
        let stills = usize::from(stands) + usize::from(lit);
        let shares = Shares::new(stills, cast.moves());
        let goal = maker.look.accuracy.goal;
        let mut base = Base::new(&photo, sheet);
        let made = Arc::new(maker.look.made());
        [&mut base.picture, &mut base.glare].into_iter().for_each(|photo| photo.source.made = Some(made.clone()));
        let wanted = maker.wanted();
        if stands {
            let look = maker.look;
            let (photos, told, warnings) = maker.compute(look, shares.still, photo, wanted)?;
            let [picture, glare] = [photos.picture, photos.glare].map(|photo| photo.map(|photo| photo.pixels));
            base.part = Part { picture, glare };
            base.told.push(("photo", told));
            base.warnings.extend(warnings);
        } else {
            let glare = wanted.glare.then(|| vec![[0.0, 0.0, 0.0, 1.0]; photo.pixels.len()]);
            base.part = Part { picture: wanted.picture.then_some(photo.pixels), glare };
        }
        if let Some((part, told)) = maker.lamps(&base.shell, &base.sheet, &cast.still, goal, shares.still)? {
            base.part = std::mem::take(&mut base.part).plus(&part);
            base.told.push(("lights", told));
        }
        Ok(Self { maker, base, shares, goal })
    }

    /// A frame.
    ///
    /// # Errors
    /// Those of [`Maker::lamps`], and [`Error::PictureNotFinite`].
    pub fn frame(&mut self, cast: &Cast, frame: usize) -> Result<Drawn> {
        let (base, share) = (&self.base, self.shares.moving);
        let moving = &cast.moving[frame];
        let moved = match moving[..] {
            [] => None,
            _ => self.maker.lamps(&base.shell, &base.sheet, moving, self.goal, share)?,
        };
        if let (Goal::Budget(_), Some(plan)) = (self.goal, moved.as_ref().and_then(|(_, told)| told.plan.as_ref())) {
            // One tolerance for all, or what is left out would change from frame to frame.
            self.goal = Goal::Tolerance(plan.tolerance / share);
        }
        let told = self.told(moved.as_ref().map(|(_, told)| told));
        let (base, part) = (&self.base, moved.map(|(part, _)| part).unwrap_or_default());
        let with = |still: &Option<Pixels>, more: Option<Pixels>, shell: &Photo| {
            let mut pixels = still.clone()?;
            more.iter().for_each(|more| add(&mut pixels, more));
            Some(Photo { pixels, ..shell.clone() })
        };
        let picture = with(&base.part.picture, part.picture, &base.picture);
        let drawn = Drawn { picture, glare: with(&base.part.glare, part.glare, &base.glare), told };
        let beyond = drawn.picture.as_ref().map_or(0, |picture| photo::not_finite(&picture.pixels));
        match beyond.saturating_sub(base.not_finite) {
            0 => Ok(drawn),
            pixels => Err(Error::PictureNotFinite { pixels }),
        }
    }

    /// What is told of a frame by what is told of its moving part.
    fn told(&self, moved: Option<&Told>) -> FrameTold {
        let parts: Vec<&Told> = self.base.told.iter().map(|(_, told)| told).chain(moved).collect();
        let asked = match self.maker.look.accuracy.goal {
            Goal::Tolerance(tolerance) => tolerance,
            Goal::Budget(_) => parts.iter().filter_map(|told| Some(told.error?.asked)).sum(),
        };
        FrameTold { veil: veils(&parts), error: together(&parts, asked), ..FrameTold::of(moved, &parts) }
    }
}

impl Base {
    fn new(photo: &Photo, sheet: Sheet) -> Self {
        let empty = |photo: Photo| Photo { pixels: Vec::new(), ..photo };
        Self {
            part: Part::default(),
            told: Vec::new(),
            warnings: Vec::new(),
            picture: Photo { frame: photo.frame, pixels: Vec::new(), source: photo.source.clone() },
            glare: empty(photo.companion(vec![[0.0; 4]; photo.pixels.len()])),
            shell: shell(photo),
            sheet,
            not_finite: photo::not_finite(&photo.pixels),
        }
    }
}

impl FrameTold {
    fn of(moved: Option<&Told>, parts: &[&Told]) -> Self {
        let renderer = parts.iter().find_map(|told| told.info.as_ref());
        Self {
            plan: moved.and_then(|told| told.plan.clone()),
            milliseconds: moved.map_or(0.0, |told| told.milliseconds),
            stages: moved.map_or_else(Vec::new, |told| told.stages.clone()),
            renderer: renderer.map(|info| format!("{}, {}", info.renderer, info.route)),
            warnings: moved.map_or_else(Vec::new, |told| told.notes.clone()),
            ..Self::default()
        }
    }
}

/// What a camera sees of a place.
pub enum View<'a> {
    /// With what it does not see.
    Lit(Box<Seen<'a>>),
    /// By itself, with its field of view.
    Dark(Box<Photo>, f64),
}

/// What a camera sees, with its glare: all of a frame is new.
///
/// # Errors
/// Those of [`Maker::compute`] and [`Seen::look`].
pub fn seen(maker: &mut Maker<'_>, view: View<'_>) -> Result<Drawn> {
    let wanted = maker.wanted();
    let (look, photo, lit) = match view {
        View::Dark(photo, fov) => (Look { fov: Some(fov), ..maker.look.clone() }, *photo, None),
        View::Lit(mut seen) => (seen.look(maker.look)?, seen.take(), Some(*seen)),
    };
    let (Photos { mut picture, mut glare }, told, warnings) = maker.compute(&look, 1.0, photo, wanted)?;
    let outside = lit.map(|seen| seen.lay(&look, picture.as_mut(), glare.as_mut()));
    let parts = [&told];
    let asked = told.error.map_or(0.0, |error| error.asked);
    let frame = FrameTold { veil: veils(&parts), error: together(&parts, asked), ..FrameTold::of(Some(&told), &parts) };
    let warnings = [frame.warnings.clone(), warnings].concat();
    let made = Arc::new(maker.look.made());
    let finished = |photo: Photo| {
        let mut photo = photo.cropped();
        photo.source.made = Some(made.clone());
        photo
    };
    let [picture, glare] = [picture, glare].map(|photo| photo.map(finished));
    Ok(Drawn { picture, glare, told: FrameTold { warnings, outside, ..frame } })
}

/// Which frames are the same as the one before.
pub fn repeats(shot: &Shot, same: impl Fn(usize, usize) -> bool) -> Vec<bool> {
    (0..shot.frames).map(|frame| frame > 0 && same(frame - 1, frame)).collect()
}
