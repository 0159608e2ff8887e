//! What a person does to a look, one edit each. What was found or came from a preset becomes the look's own when it is
//! edited. Indices are those of the list before the edit; an edit of what is not there changes nothing.

use glam::DVec2;

use super::{Look, LookLens, LookLights};
use crate::scene::{LensGhost, Light};

impl Look {
    /// The lights as a list to be edited, of which `found` are the photo's.
    pub fn lights_mut(&mut self, found: &[Light]) -> &mut Vec<Light> {
        if self.lights == LookLights::Found {
            self.lights = LookLights::Listed(found.to_vec());
        }
        match &mut self.lights {
            LookLights::Listed(lights) => lights,
            LookLights::Found => unreachable!("they are listed by now"),
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
            if factor.is_finite() {
                light.flux = colour.map(|part| part * factor);
            }
        });
    }

    /// The lens's table, to be edited.
    pub fn lens_mut(&mut self) -> &mut Vec<LensGhost> {
        if !matches!(self.lens, LookLens::Own(_)) {
            self.lens = LookLens::Own(self.lens.ghosts().to_vec());
        }
        match &mut self.lens {
            LookLens::Own(ghosts) => ghosts,
            LookLens::Preset(_) | LookLens::File(..) => unreachable!("it is the look's own by now"),
        }
    }

    /// Replaces a row of the lens's table.
    pub fn set_lens_ghost(&mut self, index: usize, ghost: LensGhost) {
        if index < self.lens.ghosts().len() {
            self.lens_mut()[index] = ghost;
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
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::series::Bell;

    fn light(x: f64) -> Light {
        Light { position: DVec2::new(x, 0.5), flux: [4.0, 2.0, 1.0], size: 0.1, muted: false }
    }

    fn found() -> [Light; 2] {
        [light(0.25), light(0.75)]
    }

    fn edited(edit: impl FnOnce(&mut Look)) -> Vec<Light> {
        let mut look = Look::default();
        edit(&mut look);
        let LookLights::Listed(lights) = look.lights else { panic!("an edit lists the lights") };
        lights
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
    fn a_colour_keeps_the_luminous_flux() {
        let weights = [0.25, 0.5, 0.25];
        // 4 · 0.25 + 2 · 0.5 + 1 · 0.25 = 2.25, and so much in green alone is 4.5.
        let lights = edited(|look| look.set_light_colour(&found(), 1, [0.0, 0.2, 0.0], weights));
        assert!((lights[1].flux[1] - 4.5).abs() < 1e-12 && lights[1].flux[0] == 0.0, "{lights:?}");
        assert_eq!(edited(|look| look.set_light_colour(&found(), 1, [0.0; 3], weights)), found());
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
        assert_eq!(look.lens, LookLens::Own(vec![row]));
    }
}
