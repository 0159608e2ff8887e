//! What was rendered before leaves no trace, and a scene that is there already costs nothing.

use vglare::frame::Frame;
use vglare::gpu::Backend;
use vglare::plan::{Evaluator, Plan};
use vglare::renderer::{Normalize, Picture, Settings};
use vglare::scene::Ghost;

use crate::support::{bits, on_backend, on_each_backend, on_fresh_renderer, plan_with, scenes};

/// Everything that a scene gives, as bits.
#[derive(Debug, PartialEq)]
struct Frames {
    composite: Vec<[u32; 4]>,
    glare: Vec<[u32; 4]>,
    stretched: Vec<[u32; 4]>,
    probe: Vec<[u64; 3]>,
    range: [u32; 2],
}

#[derive(Clone)]
struct Scene {
    frame: Frame,
    ghosts: Vec<Ghost>,
    plan: Plan,
}

impl Scene {
    fn new(seed: u64, size: [u32; 2], evaluator: Evaluator) -> Self {
        let frame = Frame::full(size[0], size[1]);
        let ghosts = scenes::random(seed, 10 + seed as usize, frame);
        Self { frame, plan: plan_with(&ghosts, frame, 1e-3, evaluator), ghosts }
    }

    fn frames(&self, renderer: &mut Picture) -> Frames {
        renderer.field.set_scene(&self.plan).unwrap();
        let settings = Settings::default();
        let mut picture: Vec<[f32; 4]> = (0..self.frame.window.pixels()).map(|i| [0.1, i as f32, 3.0, 0.5]).collect();
        // The composite comes first: the very first thing that a fresh renderer draws.
        renderer.composite(self.frame, &mut picture, &settings).unwrap();
        let last = [self.frame.width as i32 - 1, self.frame.height as i32 - 1];
        let probe = renderer.field.probe(self.frame, &[[0, 0], last, [last[0] / 2, last[1] / 3]]).unwrap();
        let minmax = Settings { normalize: Normalize::Minmax, ..settings };
        Frames {
            composite: bits(&picture),
            glare: bits(&renderer.glare(self.frame, &settings).unwrap()),
            stretched: bits(&renderer.glare(self.frame, &minmax).unwrap()),
            probe: probe.into_iter().map(|value| value.map(f64::to_bits)).collect(),
            range: renderer.field.range(self.frame).unwrap().map(f32::to_bits),
        }
    }
}

#[test]
fn the_first_frame_is_the_second() {
    for backend in Backend::ALL {
        for evaluator in Evaluator::ALL {
            let scene = Scene::new(2, [41, 29], evaluator);
            on_fresh_renderer(backend, |renderer| {
                let (first, second) = (scene.frames(renderer), scene.frames(renderer));
                assert!(first == second, "{backend}, {evaluator}");
            });
        }
    }
}

#[test]
fn a_fresh_renderer_may_begin_with_anything() {
    for evaluator in Evaluator::ALL {
        let scene = Scene::new(4, [41, 29], evaluator);
        let (frame, settings) = (scene.frame, Settings::default());
        let expected = on_fresh_renderer(Backend::Egl, |renderer| scene.frames(renderer));
        on_fresh_renderer(Backend::Egl, |renderer| {
            renderer.field.set_scene(&scene.plan).unwrap();
            assert_eq!(bits(&renderer.glare(frame, &settings).unwrap()), expected.glare, "{evaluator}: glare");
        });
        on_fresh_renderer(Backend::Egl, |renderer| {
            renderer.field.set_scene(&scene.plan).unwrap();
            let minmax = Settings { normalize: Normalize::Minmax, ..settings };
            assert_eq!(bits(&renderer.glare(frame, &minmax).unwrap()), expected.stretched, "{evaluator}: minmax");
        });
        on_fresh_renderer(Backend::Egl, |renderer| {
            renderer.field.set_scene(&scene.plan).unwrap();
            assert_eq!(renderer.field.range(frame).unwrap().map(f32::to_bits), expected.range, "{evaluator}: range");
        });
        on_fresh_renderer(Backend::Egl, |renderer| {
            renderer.field.set_scene(&scene.plan).unwrap();
            let probe = renderer.field.probe(frame, &[[0, 0]]).unwrap();
            assert_eq!(probe[0].map(f64::to_bits), expected.probe[0], "{evaluator}: probe");
        });
    }
}

#[test]
fn other_scenes_sizes_and_evaluators_in_between_leave_no_trace() {
    let scenes: Vec<Scene> = (Evaluator::ALL.into_iter().enumerate())
        .flat_map(|(k, evaluator)| {
            let seed = k as u64;
            [Scene::new(seed, [41, 29], evaluator), Scene::new(seed + 9, [12, 50], evaluator)]
        })
        .collect();
    on_each_backend(|backend, renderer| {
        let before: Vec<Frames> = scenes.iter().map(|scene| scene.frames(renderer)).collect();
        for (index, scene) in scenes.iter().enumerate().rev() {
            let evaluator = scene.plan.evaluator();
            assert!(scene.frames(renderer) == before[index], "{backend}, {evaluator}: backwards");
        }
        for step in [3, 5] {
            for index in (0..scenes.len()).map(|k| k * step % scenes.len()) {
                let evaluator = scenes[index].plan.evaluator();
                assert!(scenes[index].frames(renderer) == before[index], "{backend}, {evaluator}: by {step}s");
            }
        }
        assert!(before[0] != before[2], "other scenes differ, or this test could not fail");
    });
}

/// How often the spectrum was computed since the times were last taken.
fn spectra(renderer: &mut Picture) -> usize {
    renderer.field.take_times().iter().filter(|time| time.pass == "spectrum").count()
}

#[test]
fn the_same_scene_keeps_its_spectrum_and_another_does_not() {
    let Scene { frame, mut ghosts, plan } = Scene::new(1, [41, 29], Evaluator::Rows);
    // By dispatches, which can be counted.
    let plan = plan.without_modes();
    on_each_backend(|_, renderer| {
        let mut ghosts = ghosts.clone();
        renderer.field.set_timing(true);
        renderer.field.set_scene(&plan).unwrap();
        assert_eq!(spectra(renderer), plan.groups().count(), "one dispatch a group");
        renderer.field.set_scene(&plan).unwrap();
        renderer.glare(frame, &Settings::default()).unwrap();
        renderer.glare(frame, &Settings { strength: 2.0, ..Settings::default() }).unwrap();
        assert_eq!(spectra(renderer), 0, "nothing changed that the spectrum depends on");

        ghosts[3].radiance[2] *= 1.5;
        let plan = plan_with(&ghosts, frame, 1e-3, Evaluator::Rows).without_modes();
        renderer.field.set_scene(&plan).unwrap();
        assert_eq!(spectra(renderer), plan.groups().count(), "a ghost changed");
        renderer.field.forget_scene();
        renderer.field.set_scene(&plan).unwrap();
        assert_eq!(spectra(renderer), plan.groups().count(), "it was forgotten");
    });
    // A ghost that changes a little changes the picture, too.
    let before = on_backend(Backend::Egl, |renderer| crate::support::glare(renderer, &plan, frame));
    ghosts[3].center.x += 0.01;
    let plan = plan_with(&ghosts, frame, 1e-3, Evaluator::Rows);
    let after = on_backend(Backend::Egl, |renderer| crate::support::glare(renderer, &plan, frame));
    assert_ne!(bits(&before), bits(&after));
}
