//! Ways of light through a lens: the direct one, and those with reflections.

use super::error::{OpticsError, Result};
use super::system::System;

/// A way of light from the scene to the sensor, through a lens of a certain number of surfaces.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Path {
    /// Surfaces in the light's order, by their index from 0: first one that sends it back, then one that sends it on, and so on.
    reflections: Vec<usize>,
    surfaces: usize,
}

/// What happens to light at a surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Step {
    /// The surface's index, from 0.
    pub surface: usize,
    /// Whether the light arrives from the scene's side.
    pub forward: bool,
    /// Whether it is reflected; it goes through otherwise.
    pub reflects: bool,
}

impl Path {
    /// The way by reflections at these surfaces, in the light's order, numbered from 1; the direct one of none. A ghost
    /// of the pair a < b is `[b, a]`: light comes to b first.
    ///
    /// # Errors
    ///
    /// [`OpticsError::Path`] unless their number is even, and each lies on the side to which the light goes.
    pub fn new(system: &System, reflections: &[usize]) -> Result<Self> {
        let surfaces = system.surfaces().len();
        let fault = || OpticsError::Path { reflections: reflections.to_vec(), surfaces };
        let exist = reflections.iter().all(|number| (1..=surfaces).contains(number));
        let alternate = reflections
            .windows(2)
            .enumerate()
            .all(|(k, pair)| if k % 2 == 0 { pair[1] < pair[0] } else { pair[1] > pair[0] });
        if !exist || !alternate || reflections.len() % 2 == 1 {
            return Err(fault());
        }
        Ok(Self { reflections: reflections.iter().map(|number| number - 1).collect(), surfaces })
    }

    /// The way without reflections.
    pub fn direct(system: &System) -> Self {
        Self { reflections: Vec::new(), surfaces: system.surfaces().len() }
    }

    /// The surfaces at which it is reflected, in the light's order, numbered from 1.
    pub fn reflections(&self) -> Vec<usize> {
        self.reflections.iter().map(|index| index + 1).collect()
    }

    /// How many surfaces the lens has through which it leads.
    pub fn surfaces(&self) -> usize {
        self.surfaces
    }

    /// All that happens to the light, in its order.
    pub(super) fn steps(&self) -> Vec<Step> {
        let mut steps = Vec::with_capacity(self.surfaces * (1 + self.reflections.len()));
        // The next surface that it meets when it goes on.
        let mut next = 0;
        let through = |forward| move |surface| Step { surface, forward, reflects: false };
        for (turn, &surface) in self.reflections.iter().enumerate() {
            let forward = turn % 2 == 0;
            if forward {
                steps.extend((next..surface).map(through(true)));
            } else {
                steps.extend((surface + 1..next).rev().map(through(false)));
            }
            steps.push(Step { surface, forward, reflects: true });
            next = if forward { surface } else { surface + 1 };
        }
        steps.extend((next..self.surfaces).map(through(true)));
        steps
    }

    /// All that happens to light that goes the other way, from the sensor to the scene, in its order.
    pub(super) fn steps_back(&self) -> Vec<Step> {
        // What reflects it does so from the side that it comes from, either way.
        let back = |step: Step| Step { forward: step.forward == step.reflects, ..step };
        self.steps().into_iter().rev().map(back).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::singlet;
    use super::super::{Setup, System};
    use super::*;

    #[test]
    fn light_meets_every_surface_between_its_turns() {
        let path = |reflections: &[usize], surfaces| Path { reflections: reflections.to_vec(), surfaces };
        let walked = |path: Path| {
            let sign = |step: Step| match (step.reflects, step.forward) {
                (true, true) => "(",
                (true, false) => ")",
                (false, true) => ">",
                (false, false) => "<",
            };
            path.steps().into_iter().map(|step| format!("{}{}", sign(step), step.surface)).collect::<String>()
        };
        assert_eq!(walked(path(&[], 3)), ">0>1>2");
        assert_eq!(walked(path(&[3, 1], 5)), ">0>1>2(3<2)1>2>3>4");
        assert_eq!(walked(path(&[1, 0], 2)), ">0(1)0>1");
        assert_eq!(walked(path(&[2, 0, 1, 0], 3)), ">0>1(2<1)0(1)0>1>2");
    }

    #[test]
    fn ways_that_no_light_goes_are_refused() {
        let system = System::new(&singlet(), &Setup::default()).unwrap();
        for reflections in [&[][..], &[3, 2], &[3, 2, 3, 2]] {
            assert_eq!(Path::new(&system, reflections).unwrap().reflections(), reflections);
        }
        for reflections in [&[3][..], &[2, 3], &[2, 2], &[4, 1], &[1, 0], &[3, 2, 1, 2], &[3, 2, 2, 1]] {
            assert!(Path::new(&system, reflections).is_err(), "{reflections:?}");
        }
    }
}
