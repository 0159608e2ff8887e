//! What a person does to a look, one edit each. What was found or came from a preset becomes the look's own when it is
//! edited. Indices are those of the list before the edit; an edit of what is not there changes nothing.

use glam::DVec2;

use super::{Look, LookLens, LookLights};
use crate::scene::{Ghost, LensGhost, Light};
use crate::series::Bell;

/// The period that a bell which is periodic itself begins with, in half picture heights, where the look has none.
const PERIOD: DVec2 = DVec2::splat(4.0);

impl Look {
    /// The lights as a list to be edited, of which `found` are the photo's; those that shine beside its pixels stay beside them.
    pub fn lights_mut(&mut self, found: &[Light]) -> &mut Vec<Light> {
        if !matches!(self.lights, LookLights::Listed(_) | LookLights::Photo(_)) {
            self.lights = LookLights::Listed(self.lights(found).into_owned().into());
        }
        match &mut self.lights {
            LookLights::Listed(lights) | LookLights::Photo(lights) => lights,
            LookLights::Found | LookLights::FoundAnd(_) => unreachable!("they are listed by now"),
        }
    }

    fn edit_light(&mut self, found: &[Light], index: usize, edit: impl FnOnce(&mut Light)) {
        if index < self.lights(found).len() {
            edit(&mut self.lights_mut(found)[index]);
        }
    }

    /// Moves a light, also off the picture.
    pub fn move_light(&mut self, found: &[Light], index: usize, to: DVec2) {
        if to.is_finite() {
            self.edit_light(found, index, |light| light.position = to);
        }
    }

    /// Adds a light, as the last.
    pub fn add_light(&mut self, found: &[Light], light: Light) {
        self.lights_mut(found).push(light);
    }

    /// Takes a light away.
    pub fn delete_light(&mut self, found: &[Light], index: usize) {
        if index < self.lights(found).len() {
            self.lights_mut(found).remove(index);
        }
    }

    /// Mutes a light, or lets it shine again.
    pub fn mute_light(&mut self, found: &[Light], index: usize, muted: bool) {
        self.edit_light(found, index, |light| light.muted = muted);
    }

    /// Sets a light's flux, RGB; below 0 is 0.
    pub fn set_light_flux(&mut self, found: &[Light], index: usize, flux: [f64; 3]) {
        self.edit_light(found, index, |light| light.flux = flux.map(|flux| flux.max(0.0)));
    }

    /// Gives a light the hue of `colour`, RGB, at the luminous flux that it has by `weights`. Black is no hue.
    pub fn set_light_colour(&mut self, found: &[Light], index: usize, colour: [f64; 3], weights: [f64; 3]) {
        let colour = colour.map(|part| part.max(0.0));
        let luminance = |rgb: [f64; 3]| rgb.iter().zip(weights).map(|(part, weight)| part * weight).sum::<f64>();
        self.edit_light(found, index, |light| {
            let factor = luminance(light.flux) / luminance(colour);
            // A weight may be negative, and so may be the luminance of a colour that no eye sees.
            if factor.is_finite() && factor >= 0.0 {
                light.flux = colour.map(|part| part * factor);
            }
        });
    }

    /// The lens's table, to be edited.
    pub fn lens_mut(&mut self) -> &mut Vec<LensGhost> {
        if !matches!(self.lens, LookLens::Own(_)) {
            self.lens = LookLens::Own(self.lens.ghosts().to_vec().into());
        }
        match &mut self.lens {
            LookLens::Own(ghosts) => ghosts,
            LookLens::Preset(_) | LookLens::File(..) | LookLens::Optical(_) => {
                unreachable!("it is the look's own by now")
            }
        }
    }

    /// Replaces a row of the lens's table.
    pub fn set_lens_ghost(&mut self, index: usize, ghost: LensGhost) {
        if index < self.lens.ghosts().len() {
            self.lens_mut()[index] = ghost;
            self.name_period();
        }
    }

    /// Adds a row to the lens's table, as the last.
    pub fn add_lens_ghost(&mut self, ghost: LensGhost) {
        self.lens_mut().push(ghost);
    }

    /// Takes a row of the lens's table away, unless it is the only one: there is no lens without ghosts.
    pub fn delete_lens_ghost(&mut self, index: usize) {
        let rows = self.lens.ghosts().len();
        if index < rows && rows > 1 {
            self.lens_mut().remove(index);
        }
    }

    /// Replaces a ghost that no light makes.
    pub fn set_ghost(&mut self, index: usize, ghost: Ghost) {
        if let Some(old) = self.ghosts.get_mut(index) {
            *old = ghost;
            self.name_period();
        }
    }

    /// Takes a ghost away that no light makes.
    pub fn delete_ghost(&mut self, index: usize) {
        if index < self.ghosts.len() {
            self.ghosts.remove(index);
        }
    }

    fn bells(&self) -> impl Iterator<Item = &Bell> {
        let placed = self.ghosts.iter().map(|ghost| &ghost.bell);
        self.lens.ghosts().iter().map(|ghost| &ghost.bell).chain(placed)
    }

    /// The period of the bells that are periodic themselves, if there are any.
    fn own_period(&self) -> Option<DVec2> {
        self.bells().find_map(|bell| bell.shape().period())
    }

    /// Whether there are bells that are periodic themselves: then the period is set by hand.
    pub fn has_periodic_bells(&self) -> bool {
        self.own_period().is_some()
    }

    /// The period that a bell which is periodic itself has in this look.
    pub fn bell_period(&self) -> DVec2 {
        self.accuracy.period.or(self.own_period()).unwrap_or(PERIOD)
    }

    /// A file names the period of its bells once, as the series'.
    fn name_period(&mut self) {
        self.accuracy.period = self.accuracy.period.or(self.own_period());
    }

    /// Sets the series' period, > 0, or leaves it to the plan, which cannot be where a bell is periodic itself. Such bells
    /// have the same period.
    pub fn set_period(&mut self, period: Option<DVec2>) {
        let Some(period) = period else {
            if !self.has_periodic_bells() {
                self.accuracy.period = None;
            }
            return;
        };
        self.accuracy.period = Some(period);
        let set = |bell: &mut Bell| *bell = bell.clone().in_period(period);
        self.ghosts.iter_mut().for_each(|ghost| set(&mut ghost.bell));
        if self.lens.ghosts().iter().any(|ghost| ghost.bell.shape().period().is_some()) {
            self.lens_mut().iter_mut().for_each(|ghost| set(&mut ghost.bell));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::series::{Bell, VonMises};

    fn light(x: f64) -> Light {
        Light { position: DVec2::new(x, 0.5), flux: [4.0, 2.0, 1.0], size: 0.1, muted: false }
    }

    fn found() -> [Light; 2] {
        [light(0.25), light(0.75)]
    }

    fn edited(edit: impl FnOnce(&mut Look)) -> Vec<Light> {
        let mut look = Look { lights: LookLights::Found, ..Look::default() };
        edit(&mut look);
        let LookLights::Listed(lights) = look.lights else { panic!("an edit lists the lights") };
        lights.to_vec()
    }

    #[test]
    fn an_edit_changes_one_light_and_lists_the_rest_as_found() {
        let [first, second] = found();
        let off = DVec2::new(-3.0, 1.5);
        assert_eq!(edited(|look| look.move_light(&found(), 1, off)), [first, Light { position: off, ..second }]);
        assert_eq!(edited(|look| look.add_light(&found(), light(2.0))), [first, second, light(2.0)]);
        assert_eq!(edited(|look| look.delete_light(&found(), 0)), [second]);
        assert_eq!(edited(|look| look.mute_light(&found(), 0, true)), [Light { muted: true, ..first }, second]);
        let flux = [0.5, 0.0, 3.0];
        assert_eq!(edited(|look| look.set_light_flux(&found(), 0, [0.5, -1.0, 3.0]))[0], Light { flux, ..first });
    }

    #[test]
    fn a_light_is_added_beside_the_photos_pixels() {
        let mut look = Look::default();
        look.add_light(&found(), light(2.0));
        assert_eq!(look.lights, LookLights::Photo(vec![light(2.0)].into()));
        look.delete_light(&found(), 0);
        assert_eq!(look, Look::default());
    }

    #[test]
    fn an_edit_lists_what_was_added_to_the_found_ones_too() {
        let mut look = Look { lights: LookLights::FoundAnd(vec![light(3.0)].into()), ..Look::default() };
        look.mute_light(&found(), 2, true);
        let [first, second] = found();
        assert_eq!(look.lights, LookLights::Listed(vec![first, second, Light { muted: true, ..light(3.0) }].into()));
    }

    #[test]
    fn a_colour_keeps_the_luminous_flux() {
        let weights = [0.25, 0.5, 0.25];
        // 4 · 0.25 + 2 · 0.5 + 1 · 0.25 = 2.25, and so much in green alone is 4.5.
        let lights = edited(|look| look.set_light_colour(&found(), 1, [0.0, 0.2, 0.0], weights));
        assert!((lights[1].flux[1] - 4.5).abs() < 1e-12 && lights[1].flux[0] == 0.0, "{lights:?}");
        assert_eq!(edited(|look| look.set_light_colour(&found(), 1, [0.0; 3], weights)), found());
        let ap0 = [0.344, 0.728, -0.072];
        assert_eq!(edited(|look| look.set_light_colour(&found(), 1, [0.0, 0.0, 1.0], ap0)), found());
    }

    #[test]
    fn an_edit_of_what_is_not_there_changes_nothing() {
        let mut look = Look::default();
        look.move_light(&found(), 2, DVec2::ZERO);
        look.move_light(&found(), 0, DVec2::NAN);
        look.delete_light(&found(), 2);
        look.mute_light(&[], 0, true);
        look.delete_lens_ghost(99);
        let row = look.lens.ghosts()[0].clone();
        look.set_lens_ghost(99, row);
        assert_eq!(look, Look::default());
    }

    #[test]
    fn periodic_bells_have_the_looks_period() {
        let mut look = Look::default();
        let bell = Bell::VonMises(VonMises { period: look.bell_period() });
        let ghost = LensGhost { bell: bell.clone(), ..look.lens.ghosts()[0].clone() };
        look.set_lens_ghost(0, ghost);
        look.ghosts.push(Ghost { bell, center: DVec2::ZERO, size: DVec2::ONE, radiance: [1.0; 3] });
        assert_eq!(look.accuracy.period, Some(PERIOD));
        let period = DVec2::new(5.0, 3.0);
        look.set_period(Some(period));
        let periods: Vec<_> = look.bells().filter_map(|bell| bell.shape().period()).collect();
        assert_eq!((periods, look.accuracy.period), (vec![period; 2], Some(period)));
        look.set_period(None);
        assert_eq!(look.accuracy.period, Some(period), "a file has to name it");
        look.delete_ghost(0);
        look.set_lens_ghost(0, LensGhost { bell: Bell::Gaussian, ..look.lens.ghosts()[0].clone() });
        look.set_period(None);
        assert_eq!(look.accuracy.period, None);
    }

    #[test]
    fn a_lens_becomes_the_looks_own_and_keeps_a_ghost() {
        let preset = Look::default().lens.ghosts().to_vec();
        let (bell, size) = (Bell::Parabola, DVec2::ONE);
        let row = LensGhost { bell, along: 0.5, size, tint: [1.0; 3], share: 0.1 };
        let mut look = Look::default();
        look.set_lens_ghost(1, row.clone());
        assert_eq!((&look.lens.ghosts()[0], &look.lens.ghosts()[1]), (&preset[0], &row));
        look.add_lens_ghost(row.clone());
        assert_eq!(look.lens.ghosts().len(), preset.len() + 1);
        for _ in 0..20 {
            look.delete_lens_ghost(0);
        }
        assert_eq!(look.lens, LookLens::Own(vec![row].into()));
    }
}
