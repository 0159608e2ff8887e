//! What has to be done again after a change.

use super::{Look, LookLights};
use crate::choices::LengthUnit;

/// The first of the steps that have to be done again; all that follow it have to be as well.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Work {
    /// None: the picture stays as it is.
    Nothing,
    /// Lay the field over the photo; the spectrum stays.
    Composite,
    /// Plan, for the same ghosts, and compute their spectrum.
    Plan,
    /// Make ghosts of the same lights.
    Ghosts,
    /// Search the photo for lights, or for the threshold that tells them from the rest.
    Lights,
}

/// What has to be done again for the picture of `new`, where that of `old` is there.
pub fn work(old: &Look, new: &Look) -> Work {
    // All fields by name: one that is added does not compile until it has a step.
    #[rustfmt::skip]
    let Look {
        description: _, lens: _, unit, fov, axis, size, tint, lights, ghosts, find, strength, veil, mix, normalize, accuracy,
    } = new;
    // All that is known of the photo is in the unit.
    let degrees = |look: &Look| (look.fov, look.projection());
    if old.unit != *unit || (*unit == LengthUnit::Degrees && degrees(old) != degrees(new)) {
        return Work::Lights;
    }
    // A search that found lights for `old` is the same for `new`, unless it goes by other rules.
    if new.searches() && !(old.searches() && old.find == *find) {
        return Work::Lights;
    }
    match (&old.lights, lights) {
        (LookLights::Listed(_) | LookLights::Photo(_), LookLights::Found | LookLights::FoundAnd(_)) => {
            return Work::Lights;
        }
        (old, new) if old != new => return Work::Ghosts,
        _ => {}
    }
    if new.takes_photo() && (old.find.knee(), old.find.recover) != (new.find.knee(), new.find.recover) {
        return Work::Ghosts;
    }
    let makes = (old.axis, old.size, old.tint) == (*axis, *size, *tint);
    if old.lens_ghosts() != new.lens_ghosts() || !makes || old.ghosts != *ghosts {
        return Work::Ghosts;
    }
    // What the picture is at its darkest depends on the strength.
    if old.accuracy != *accuracy || accuracy.each_pixel && old.strength != *strength {
        return Work::Plan;
    }
    if (old.strength, &old.veil, old.fov, old.mix, old.normalize) == (*strength, veil, *fov, *mix, *normalize) {
        Work::Nothing
    } else {
        Work::Composite
    }
}

/// Whether the veil of two looks is one on the same photo, in its strength and in its weights, too.
pub fn same_veil(old: &Look, new: &Look) -> bool {
    // All fields by name here as well; ghosts and their light have nothing to do with it.
    #[rustfmt::skip]
    let Look {
        description: _, lens: _, unit, fov, axis: _, size, tint: _, lights: _, ghosts: _, find, strength, veil, mix: _, normalize, accuracy,
    } = new;
    (old.unit, old.fov, old.size, old.strength) == (*unit, *fov, *size, *strength)
        && (&old.veil, old.normalize, old.accuracy.allow_floor) == (veil, *normalize, accuracy.allow_floor)
        && old.find.recover == find.recover
}

#[cfg(test)]
mod tests {
    use glam::DVec2;

    use super::super::{Accuracy, LookLens};
    use super::*;
    use crate::choices::{Evaluator, LightBy, Mix, Normalize};
    use crate::scene::{FindOptions, Ghost, Goal, Light};
    use crate::series::Bell;

    fn changed(from: &Look, change: impl FnOnce(&mut Look)) -> Work {
        let mut to = from.clone();
        change(&mut to);
        work(from, &to)
    }

    #[test]
    fn every_part_of_a_look_has_its_step() {
        let look = Look { lights: LookLights::Found, ..Look::default() };
        let after = |change: fn(&mut Look)| changed(&look, change);
        assert_eq!(after(|_| {}), Work::Nothing);
        assert_eq!(after(|look| look.description = "new".into()), Work::Nothing);
        assert_eq!(after(|look| look.lens = LookLens::Own(look.lens.ghosts().to_vec().into())), Work::Nothing);
        assert_eq!(after(|look| look.strength = 0.0), Work::Composite);
        assert_eq!(after(|look| look.normalize = Normalize::Minmax), Work::Composite);
        assert_eq!(after(|look| look.mix = Mix::Energy), Work::Composite);
        assert_eq!(after(|look| look.accuracy.goal = Goal::Budget(5.0)), Work::Plan);
        assert_eq!(after(|look| look.accuracy.evaluator = Some(Evaluator::Direct)), Work::Plan);
        assert_eq!(after(|look| look.accuracy = Accuracy { allow_floor: true, ..look.accuracy }), Work::Plan);
        assert_eq!(after(|look| look.size = 2.0), Work::Ghosts);
        assert_eq!(after(|look| look.tint = [0.0; 3]), Work::Ghosts);
        assert_eq!(after(|look| look.axis.x = 0.1), Work::Ghosts);
        assert_eq!(after(|look| look.lens = LookLens::preset("zoom").unwrap()), Work::Ghosts);
        assert_eq!(after(|look| look.lights = LookLights::Listed(Vec::new().into())), Work::Ghosts);
        let ghost = Ghost { bell: Bell::Gaussian, center: DVec2::ZERO, size: DVec2::ONE, radiance: [1.0; 3] };
        assert_eq!(changed(&look, |look| look.ghosts.push(ghost)), Work::Ghosts);
        assert_eq!(after(|look| look.find = FindOptions { merge: 0.5, ..look.find }), Work::Lights);
        assert_eq!(after(|look| look.find = FindOptions { by: LightBy::Luminance, ..look.find }), Work::Lights);
        assert_eq!(after(|look| look.lights = Look::default().lights), Work::Ghosts);
        assert_eq!(changed(&Look::default(), |look| look.find.merge = 0.5), Work::Nothing);
        assert_eq!(after(|look| look.unit = LengthUnit::Height), Work::Lights);
        assert_eq!(after(|look| look.fov = Some(40.0)), Work::Composite);
        let degrees = Look { unit: LengthUnit::Degrees, ..Look::default() };
        assert_eq!(changed(&degrees, |look| look.fov = Some(40.0)), Work::Lights);
    }

    #[test]
    fn listed_lights_need_no_search_unless_their_light_is_taken_from_the_photo() {
        let light = Light { position: DVec2::ONE, flux: [1.0; 3], size: 0.0, muted: false };
        let look = Look { lights: LookLights::Listed(vec![light].into()), ..Look::default() };
        let muted = |look: &mut Look| look.lights = LookLights::Listed(vec![Light { muted: true, ..light }].into());
        assert_eq!(changed(&look, muted), Work::Ghosts);
        assert_eq!(changed(&look, |look| look.find.threshold = Some(2.0)), Work::Nothing);
        assert_eq!(changed(&look, |look| look.lights = LookLights::Found), Work::Lights);
        assert_eq!(changed(&look, |look| look.lights = LookLights::FoundAnd(vec![light].into())), Work::Lights);
        let found = Look { lights: LookLights::Found, ..look.clone() };
        assert_eq!(changed(&found, |look| look.lights = LookLights::FoundAnd(vec![light].into())), Work::Ghosts);
        assert_eq!(changed(&look, |look| look.mix = Mix::Energy), Work::Lights);
        let energy = Look { mix: Mix::Energy, ..look };
        assert_eq!(changed(&energy, |look| look.find.threshold = Some(2.0)), Work::Lights);
        assert_eq!(changed(&energy, |look| look.mix = Mix::Add), Work::Composite);
    }
}
