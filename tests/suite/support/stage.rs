//! One renderer a backend, kept between tests: to open a context and to compile its programs takes longer than most
//! tests draw, and a used renderer gives what a fresh one gives, bit by bit (`order` holds it to that).
//!
//! What a test prints on a stage is seen by `--nocapture` alone, since a thread keeps the output of the test that
//! started it; what a panic says is told by the test itself.

use std::cell::{Cell, RefCell};
use std::panic::{self, AssertUnwindSafe};
use std::rc::Rc;
use std::sync::{LazyLock, Mutex, Once, PoisonError};

use rayon::{ThreadPool, ThreadPoolBuilder};
use vglare::gpu::{Backend, Device};
use vglare::renderer::{Live, Picture};

use super::turn;

/// What a renderer's tiles hold unless a test says otherwise (`src/renderer/tiles.rs`).
const TILE_PIXELS: usize = 4 << 20;

thread_local! {
    /// What a stage keeps between tests.
    static KEPT: RefCell<Option<(Live, Rc<Device>)>> = const { RefCell::new(None) };
    /// What the last panic on a stage says, and where it was.
    static SAID: Cell<Option<String>> = const { Cell::new(None) };
}

/// The threads of each backend. The first has the context; the others share what it computes by many.
static STAGES: LazyLock<[(Backend, Mutex<ThreadPool>); 2]> =
    LazyLock::new(|| Backend::ALL.map(|backend| (backend, Mutex::new(threads(backend)))));

fn threads(backend: Backend) -> ThreadPool {
    ThreadPoolBuilder::new().thread_name(move |index| format!("{backend} {index}")).build().expect("threads")
}

/// Runs `test` with a context of the backend that is current, on the backend's own thread.
pub fn on_device<T: Send>(backend: Backend, test: impl FnOnce(&Rc<Device>) -> T + Send) -> T {
    on_stage(backend, |_, device| test(device))
}

/// Runs `test` with a renderer that has done nothing yet.
pub fn on_fresh_renderer<T: Send>(backend: Backend, test: impl FnOnce(&mut Picture) -> T + Send) -> T {
    on_device(backend, |device| test(&mut Picture::new(device).unwrap()))
}

/// Runs `test` with the backend's renderer, which has no scene and every setting as a fresh one has it.
pub fn on_backend<T: Send>(backend: Backend, test: impl FnOnce(&mut Picture) -> T + Send) -> T {
    on_live(backend, |live| test(&mut live.picture))
}

/// The same, with what shows its pictures.
pub fn on_live<T: Send>(backend: Backend, test: impl FnOnce(&mut Live) -> T + Send) -> T {
    on_stage(backend, |live, _| test(live))
}

fn on_stage<T: Send>(backend: Backend, test: impl FnOnce(&mut Live, &Rc<Device>) -> T + Send) -> T {
    tell_panics();
    let (_, stage) = STAGES.iter().find(|(of, _)| *of == backend).expect("a backend that needs no window");
    // A stage has one test at a time, so that the thread with the context, where it waits for the others, finds no other
    // test to begin with.
    let stage = stage.lock().unwrap_or_else(PoisonError::into_inner);
    let test = Mutex::new(Some(test));
    let run = |thread: rayon::BroadcastContext<'_>| {
        let test = (thread.index() == 0).then(|| test.lock().unwrap().take().expect("one thread is the first"))?;
        Some(panic::catch_unwind(AssertUnwindSafe(|| with_kept(backend, test))).map_err(|panic| (panic, SAID.take())))
    };
    let ran = stage.broadcast(run).into_iter().flatten().next().expect("one thread is the first");
    drop(stage);
    ran.unwrap_or_else(|(panic, said)| {
        eprintln!("{}", said.unwrap_or_default());
        panic::resume_unwind(panic)
    })
}

/// Runs `test` with what is kept, or with a new one where nothing is; after a panic nothing is kept.
fn with_kept<T>(backend: Backend, test: impl FnOnce(&mut Live, &Rc<Device>) -> T) -> T {
    let _turn = turn();
    let (mut live, device) = KEPT.take().unwrap_or_else(|| {
        let device = Device::open(&[backend]).unwrap_or_else(|error| panic!("these tests need GL: {error}"));
        (Live::new(&device).unwrap(), device)
    });
    // A view shows what was drawn last, if anything was.
    live.unload();
    let renderer = &mut live.picture;
    renderer.field.forget_scene();
    renderer.field.set_tile_pixels(TILE_PIXELS);
    renderer.set_pixel_buffers(!device.info().software);
    renderer.field.set_timing(false);
    renderer.field.take_times();
    let result = test(&mut live, &device);
    // Another thread may draw next, and is to find nothing that this context has begun.
    live.picture.field.finish();
    device.check("a test").unwrap();
    KEPT.set(Some((live, device)));
    result
}

/// From now on a panic on a stage is kept for the test to tell.
fn tell_panics() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        let before = panic::take_hook();
        panic::set_hook(Box::new(move |info| {
            let on_stage = std::thread::current().name().is_some_and(|name| {
                name.split_once(' ').is_some_and(|(of, _)| Backend::ALL.iter().any(|backend| backend.to_string() == of))
            });
            if on_stage { SAID.set(Some(info.to_string())) } else { before(info) }
        }));
    });
}

/// A stage tells a test's panic and goes on with a renderer as good as new.
#[test]
fn a_panic_comes_back_and_leaves_no_trace() {
    let panic = panic::catch_unwind(|| on_backend(Backend::Egl, |_| -> () { panic!("as it should") })).unwrap_err();
    assert_eq!(panic.downcast_ref(), Some(&"as it should"));
    on_backend(Backend::Egl, |renderer| {
        renderer.field.set_tile_pixels(1);
        renderer.field.set_timing(true);
    });
    on_backend(Backend::Egl, |renderer| assert!(renderer.field.take_times().is_empty()));
}
