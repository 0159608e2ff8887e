//! What the tests of the numerics share: seeded scenes, renderers on every backend, and checks that say what was worst.

pub mod check;
pub mod scenes;
pub mod table;

use std::cell::RefCell;
use std::rc::{Rc, Weak};
use std::sync::{Mutex, MutexGuard, PoisonError};

use vglare::Result;
use vglare::frame::Frame;
use vglare::gpu::{Backend, Device};
use vglare::plan::{self, Evaluator, Plan, Request};
use vglare::problem::Problem;
use vglare::renderer::{Renderer, Settings};
use vglare::scene::Ghost;

/// Runs `test` once on each backend, each with a thread and a context of its own: a context is current on one thread,
/// and a thread has one current context.
///
/// Fails where a backend gives no context: a machine without GL has not run these tests.
pub fn on_each_backend<T: Send>(test: impl Fn(Backend, &mut Renderer) -> T + Sync) -> Vec<T> {
    Backend::ALL.into_iter().map(|backend| on_backend(backend, |renderer| test(backend, renderer))).collect()
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

/// Runs `test` with a fresh renderer of one backend.
pub fn on_backend<T: Send>(backend: Backend, test: impl FnOnce(&mut Renderer) -> T + Send) -> T {
    let run = || {
        let _turn = turn();
        let device = Device::open(&[backend]).unwrap_or_else(|error| panic!("these tests need GL: {error}"));
        test(&mut Renderer::new(&device).unwrap())
    };
    let name = format!("{} on {backend}", std::thread::current().name().unwrap_or("a test"));
    std::thread::scope(|scope| {
        let thread = std::thread::Builder::new().name(name).spawn_scoped(scope, run).unwrap();
        thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
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
pub fn glare(renderer: &mut Renderer, plan: &Plan, frame: Frame) -> Vec<[f32; 4]> {
    renderer.set_scene(plan).unwrap();
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
