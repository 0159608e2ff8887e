//! A frame's light, taken apart: what stands still, computed once, and what moves, computed for each frame.
//!
//! Glare is linear, so that the parts add up. Of the tolerance each part has a share, so that the sum of their errors is
//! within it: what is computed once a quarter each, what is computed again and again the rest.

use rayon::prelude::*;

use super::shot::Lit;
use super::told::Told;
use super::{Args, Seen};
use crate::choices::Mix;
use crate::gpu::Device;
use crate::job::{Computer, Found, Stages, Unwatched, Wanted};
use crate::look::{Look, LookLights, Shared};
use crate::motion::{Lamps, Sheet};
use crate::photo::{Alpha, Photo};
use crate::scene::{Goal, Light, Recover};
use crate::{Error, Result};

/// What of the tolerance a part has that is computed once.
const OF_STILL: f64 = 0.25;

/// Pixels, row by row.
pub type Pixels = Vec<[f32; 4]>;

/// A part of a frame, or the sum of some.
#[derive(Default)]
pub struct Part {
    /// What it adds to the picture.
    pub picture: Option<Pixels>,
    /// What of that is glare.
    pub glare: Option<Pixels>,
}

/// What parts are computed with.
pub struct Maker<'a> {
    pub args: &'a Args,
    pub look: &'a Look,
    computer: Option<Computer>,
}

/// Of a tolerance, what each part that stands still has, and what moves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shares {
    pub still: f64,
    pub moving: f64,
}

impl Shares {
    /// For so many parts that stand still, and one that moves or none.
    pub fn new(still: usize, moves: bool) -> Self {
        match (still, moves) {
            (0, _) => Self { still: 1.0, moving: 1.0 },
            (_, false) => Self { still: (still as f64).recip(), moving: 0.0 },
            (_, true) => Self { still: OF_STILL, moving: 1.0 - OF_STILL * still as f64 },
        }
    }
}

impl<'a> Maker<'a> {
    /// Opens what ghosts are rendered with, where there can be any.
    ///
    /// # Errors
    /// Those of [`Device::open`].
    pub fn new(args: &'a Args, look: &'a Look) -> Result<Self> {
        let open = || {
            let device = Device::open(args.accuracy.backend.backends())?;
            let known = args.accuracy.known(Some(device.info()));
            Ok::<_, Error>(Computer::new(device, known))
        };
        Ok(Self { args, look, computer: look.renders().then(open).transpose()? })
    }

    /// Lays a look over a photo, to a share of its tolerance; and says what to warn of, calibrations included.
    ///
    /// # Errors
    /// Those of [`Found::new`] and [`Found::compute`].
    pub fn compute(
        &mut self,
        look: &Look,
        share: f64,
        photo: Photo,
        wanted: Wanted,
    ) -> Result<(Photos, Told, Vec<String>)> {
        let mut look = look.clone();
        if let Goal::Tolerance(tolerance) = &mut look.accuracy.goal {
            *tolerance *= share;
        }
        // In the numbers that a person gave.
        let whole = |error: Error| match error {
            Error::ToleranceBelowFloor { asked, floor } => {
                Error::ToleranceBelowFloor { asked: asked / share, floor: floor / share }
            }
            error => error,
        };
        let found = Found::new(&look, photo, Stages::default())?;
        let done = found.compute(self.computer.as_mut(), wanted, &Unwatched).map_err(whole)?;
        let told = Told::of(&done);
        let photos = Photos { picture: done.picture, glare: done.glare };
        Ok((photos, told, done.warnings))
    }

    /// What is wanted of a photo that stands behind the lights, or is seen by a camera.
    pub fn wanted(&self) -> Wanted {
        Wanted {
            // A report alone tells of a picture that nobody keeps.
            picture: self.args.output.is_some() || self.args.outputs.glare.is_none(),
            glare: self.args.outputs.glare.is_some() || self.args.outputs.plot.is_some(),
            layers: false,
            times: false,
            verify: self.args.proof.verify,
        }
    }

    /// The light of some of the path's lights, on black; none where they give none.
    ///
    /// # Errors
    /// Those of [`Maker::compute`].
    pub fn lamps(
        &mut self,
        shell: &Photo,
        sheet: &Sheet,
        lights: &[Lit],
        goal: Goal,
        share: f64,
    ) -> Result<Option<(Part, Told)>> {
        let gain = self.kept(shell)?;
        let drawn: Vec<Light> = lights
            .iter()
            .map(|lit| Light { flux: [0, 1, 2].map(|k| lit.given.flux[k] * gain[k]), ..lit.given })
            .collect();
        let Lamps { pixels, lit } = Lamps::draw(sheet, &drawn);
        let shining: Vec<Light> = lights.iter().filter_map(Lit::shining).collect();
        if !lit && shining.is_empty() {
            return Ok(None);
        }
        let look = self.of_lamps(shining, goal);
        let (shown, wanted) = (self.args.motion.lamps == Seen::Shown, self.wanted());
        let asked =
            Wanted { picture: wanted.picture && shown, glare: wanted.glare || wanted.picture && !shown, ..wanted };
        let photo = Photo { pixels, ..shell.clone() };
        let (photos, told, _) = self.compute(&look, share, photo, asked)?;
        let Photos { picture, glare } = photos;
        let [picture, glare] = [picture, glare].map(|photo| photo.map(|photo| photo.pixels));
        let part = match (wanted.picture, shown) {
            (true, false) => Part { picture: glare.clone(), glare: glare.filter(|_| wanted.glare) },
            _ => Part { picture, glare },
        };
        Ok(Some((part, told)))
    }

    /// The look of the path's lights alone: what else shines is another part's.
    fn of_lamps(&self, lights: Vec<Light>, goal: Goal) -> Look {
        let mut look = self.look.clone();
        look.lights = LookLights::Listed(lights.into());
        look.ghosts = Shared::default();
        // Lamps are as bright as they are drawn, and have given their ghosts' light already.
        look.find.recover = Recover::None;
        look.mix = Mix::Add;
        look.accuracy.goal = goal;
        look
    }

    /// What of its light a lamp keeps, RGB, where its ghosts' light is taken from it.
    fn kept(&self, shell: &Photo) -> Result<[f64; 3]> {
        if self.look.mix == Mix::Add {
            return Ok([1.0; 3]);
        }
        let light = Light { position: glam::DVec2::ZERO, flux: [1.0; 3], size: 0.0, muted: false };
        let look = Look { ghosts: Shared::default(), ..self.look.clone() };
        let frame = look.frame(shell)?;
        let ghosts = look.fitted(&frame).ghosts(&[light]);
        let carried = |k: usize| ghosts.iter().map(|ghost| ghost.flux()[k]).sum::<f64>();
        Ok([0, 1, 2].map(|k| (1.0 - self.look.strength * carried(k)).max(0.0)))
    }
}

/// Pictures of a job.
pub struct Photos {
    pub picture: Option<Photo>,
    pub glare: Option<Photo>,
}

impl Lit {
    /// What of it makes glare; none where nothing does.
    pub fn shining(&self) -> Option<Light> {
        (self.share > 0.0 && self.given.flux != [0.0; 3])
            .then(|| Light { flux: self.given.flux.map(|flux| flux * self.share), ..self.given })
    }
}

/// A photo's frame, colours and camera, without its pixels, for what is drawn in it: opaque, and from no file.
pub fn shell(photo: &Photo) -> Photo {
    let mut shell = photo.without_pixels();
    shell.source.alpha = Alpha::None;
    shell.source.notes.clear();
    shell
}

impl Part {
    /// This and another, whose colours are added; alpha stays.
    pub fn plus(mut self, other: &Self) -> Self {
        let add = |to: &mut Option<Pixels>, more: &Option<Pixels>| match (to, more) {
            (Some(to), Some(more)) => add(to, more),
            (to @ None, Some(more)) => *to = Some(more.clone()),
            _ => {}
        };
        add(&mut self.picture, &other.picture);
        add(&mut self.glare, &other.glare);
        self
    }
}

/// Adds colours to others; alpha stays.
pub fn add(to: &mut [[f32; 4]], more: &[[f32; 4]]) {
    to.par_iter_mut().zip(more).for_each(|(pixel, more)| {
        (0..3).for_each(|k| pixel[k] += more[k]);
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_make_one_tolerance() {
        for (still, moves) in [(0, true), (1, true), (2, true), (1, false), (2, false)] {
            let Shares { still: each, moving } = Shares::new(still, moves);
            let sum = each * still as f64 + if moves { moving } else { 0.0 };
            assert!((sum - 1.0).abs() < 1e-12, "{still}, {moves}: {sum}");
        }
    }

    #[test]
    fn parts_add_colours_and_keep_alpha() {
        let part = |value: f32, alpha: f32| Part { picture: Some(vec![[value, 0.0, 1.0, alpha]]), glare: None };
        let sum = part(1.0, 0.5).plus(&part(2.0, 1.0)).plus(&Part::default());
        assert_eq!((sum.picture, sum.glare), (Some(vec![[3.0, 0.0, 2.0, 0.5]]), None));
        assert_eq!(Part::default().plus(&part(2.0, 1.0)).picture, Some(vec![[2.0, 0.0, 1.0, 1.0]]));
    }
}
