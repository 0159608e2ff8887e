//! What the tests of the numerics share: seeded scenes, renderers on every backend, and checks that say what was worst.

pub mod check;
pub mod scenes;
mod stage;
pub mod table;

pub use stage::{on_backend, on_device, on_fresh_renderer, on_live};

use std::cell::RefCell;
use std::rc::{Rc, Weak};
use std::sync::{Mutex, MutexGuard, PoisonError};

use vglare::Result;
use vglare::frame::Frame;
use vglare::gpu::Backend;
use vglare::plan::{self, Evaluator, Plan, Request};
use vglare::problem::Problem;
use vglare::renderer::{Picture, Settings};
use vglare::scene::Ghost;

/// Runs `test` once on each backend, with what [`on_backend`] gives.
///
/// It is for tests of what may differ between the two: how a context comes about, what is its default, which way up its
/// rows go, how pixels come and go; and for one test of each pass (spectrum, each evaluator, range, composite, view, mask,
/// Graf), since each has a copy of Mesa's code generator. That all evaluators give the same bits by both is a test of its
/// own (`evaluators`): what else is a matter of numbers is held to them by [`on_one_backend`].
///
/// Fails where a backend gives no context: a machine without GL has not run these tests.
pub fn on_each_backend<T: Send>(test: impl Fn(Backend, &mut Picture) -> T + Sync) -> Vec<T> {
    Backend::ALL.into_iter().map(|backend| on_backend(backend, |renderer| test(backend, renderer))).collect()
}

/// Whether tests by chance, and those of very many terms, take their long form; `.ci/full` asks for it.
pub fn long() -> bool {
    std::env::var_os("VGLARE_LONG_TESTS").is_some()
}

/// Runs `test` on the backend that tests of numbers use.
pub fn on_one_backend<T: Send>(test: impl FnOnce(Backend, &mut Picture) -> T + Send) -> T {
    on_backend(Backend::ALL[0], |renderer| test(Backend::ALL[0], renderer))
}

/// A test's turn at GL, for as long as it is kept.
pub type Turn = Rc<MutexGuard<'static, ()>>;

/// Lets one test at a time use GL; a thread that has its turn gets it again. Mesa's software renderer looks through what
/// all contexts of a process draw with, and does not lock it (`llvmpipe_flush_resource`, Mesa 22.3): two threads that draw
/// may end the process.
pub fn turn() -> Turn {
    static TURN: Mutex<()> = Mutex::new(());
    thread_local! {
        static MINE: RefCell<Weak<MutexGuard<'static, ()>>> = RefCell::default();
    }
    MINE.with_borrow_mut(|mine| {
        mine.upgrade().unwrap_or_else(|| {
            let turn = Rc::new(TURN.lock().unwrap_or_else(PoisonError::into_inner));
            *mine = Rc::downgrade(&turn);
            turn
        })
    })
}

/// The cheapest plan for ghosts on a picture.
pub fn plan(ghosts: &[Ghost], frame: Frame, request: &Request) -> Result<Plan> {
    plan::plan(&Problem::new(ghosts, frame), request)
}

/// The same at the floor of 32-bit floats, where that lies above the tolerance.
pub fn plan_at_least(ghosts: &[Ghost], frame: Frame, request: &Request) -> Result<Plan> {
    plan::plan_at_least(&Problem::new(ghosts, frame), request)
}

/// The most accurate plan within a budget in milliseconds.
pub fn plan_within(ghosts: &[Ghost], frame: Frame, request: &Request, budget: f64) -> Result<Plan> {
    plan::plan_within(&Problem::new(ghosts, frame), request, budget)
}

/// The plan of one evaluator that leaves everything else to vglare.
pub fn plan_with(ghosts: &[Ghost], frame: Frame, tolerance: f64, evaluator: Evaluator) -> Plan {
    let request = Request { evaluator: Some(evaluator), ..Request::new(tolerance) };
    plan(ghosts, frame, &request).unwrap_or_else(|error| panic!("{evaluator} at {tolerance:e}: {error}"))
}

/// The glare alone, at every pixel of the frame's window.
pub fn glare(renderer: &mut Picture, plan: &Plan, frame: Frame) -> Vec<[f32; 4]> {
    renderer.field.set_scene(plan).unwrap();
    renderer.glare(frame, &Settings::default()).unwrap()
}

/// Pixels as bits: what is the same here is the same, NaN and the sign of zero included.
pub fn bits(pixels: &[[f32; 4]]) -> Vec<[u32; 4]> {
    pixels.iter().map(|pixel| pixel.map(f32::to_bits)).collect()
}

/// The red, green and blue of pixels in f64.
pub fn rgb(pixels: &[[f32; 4]]) -> Vec<[f64; 3]> {
    pixels.iter().map(|&[r, g, b, _]| [r, g, b].map(f64::from)).collect()
}

/// The look by default, but of the lights that are found in the photo.
pub fn lit() -> vglare::look::Look {
    vglare::look::Look { lights: vglare::look::LookLights::Found, ..vglare::look::Look::default() }
}
