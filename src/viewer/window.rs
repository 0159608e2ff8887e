//! The window itself: winit's events in, frames out. It sleeps while nothing happens.

use std::path::PathBuf;
use std::rc::Rc;
use std::sync::Arc;
use std::time::{Duration, Instant};

use winit::application::ApplicationHandler;
use winit::dpi::LogicalSize;
use winit::event::{StartCause, WindowEvent};
use winit::event_loop::{ActiveEventLoop, ControlFlow, EventLoopProxy};
use winit::window::{Window, WindowId};

use super::app::App;
use super::input;
use super::model::{Look, State};
use super::status::Status;
use crate::gpu::{Device, Display, Screen, Surface, event_loop};
use crate::photo::ReadOptions;
use crate::{Error, Result, target};

/// A frame that is due sooner than this goes on with something.
const MOVING: Duration = Duration::from_millis(100);

/// Another thread asks for a frame.
#[derive(Debug, Clone, Copy)]
struct Wanted;

/// How much of a display the window may take when it opens: there are frames and bars as well.
const PART: f64 = 0.95;

/// What a test asks of the window.
#[derive(Debug, Clone, Default)]
pub struct Harness {
    /// A file in which it keeps what it shows whenever it rests.
    pub status: Option<PathBuf>,
    /// After how many frames its context is taken for lost, once.
    pub lose_after: Option<u64>,
}

/// Opens a window on photos, each with `look` at first, and stays until it is closed. Where its context is lost, it goes
/// on with another.
///
/// # Errors
/// [`Error::NoDisplay`] and [`Error::NoContext`] before there is any window; [`Error::Gl`] where the driver fails later
/// for good, [`Error::Write`] where the harness's file cannot be written. A photo that cannot be read is told of in the
/// window.
pub fn run(photos: &[PathBuf], look: Look, reading: ReadOptions, harness: Harness) -> Result<()> {
    let event_loop = event_loop::<Wanted>()?;
    let display = Display::open(&event_loop)?;
    let mut viewer = Viewer {
        waiting: Some(Start {
            display,
            photos: photos.to_vec(),
            look,
            reading,
            harness,
            proxy: event_loop.create_proxy(),
        }),
        open: None,
        failed: None,
    };
    let ended = event_loop.run_app(&mut viewer).map_err(|error| Error::NoDisplay { reason: error.to_string() });
    viewer.failed.map_or(ended, Err)
}

/// What the window is opened with.
struct Start {
    display: Display,
    photos: Vec<PathBuf>,
    look: Look,
    reading: ReadOptions,
    harness: Harness,
    proxy: EventLoopProxy<Wanted>,
}

/// The window, once the event loop runs.
struct Viewer {
    waiting: Option<Start>,
    open: Option<Open>,
    failed: Option<Error>,
}

/// An open window. The surface goes last: GL objects are freed while its context is current.
struct Open {
    app: App,
    screen: Screen,
    input: egui_winit::State,
    /// What happened and waits for the next frame.
    waiting: Vec<egui::Event>,
    state: Option<State>,
    hidden: bool,
    vsync: bool,
    /// Whether nothing of it is seen, minimised or behind others.
    occluded: bool,
    title: String,
    harness: Harness,
    /// What the harness was last told.
    told: Option<Status>,
    /// Whether no frame has been shown since its context was made anew.
    untried: bool,
    device: Rc<Device>,
    surface: Surface,
}

/// What follows a frame.
enum Next {
    /// Nothing until something happens.
    Event,
    /// Another frame, then.
    Frame(Instant),
    /// The window closes.
    Close,
}

impl Start {
    fn open(self, event_loop: &ActiveEventLoop) -> Result<Open> {
        // Without a home nothing is remembered.
        let state = State::of_user().ok();
        let size = fitting(event_loop, state.as_ref().and_then(State::size).unwrap_or([1280, 800]));
        // Shown with its first frame, so that nothing flashes.
        let attributes = Window::default_attributes().with_title("vglare").with_inner_size(size).with_visible(false);
        let (device, surface) = self.display.window(event_loop, attributes)?;
        surface.set_vsync(true);
        let proxy = self.proxy;
        let wake = Arc::new(move || {
            // The loop is gone only when the window is.
            let _ = proxy.send_event(Wanted);
        });
        let mut app = App::new(&device, self.look, wake)?;
        app.read_by(self.reading.clone());
        state.clone().into_iter().for_each(|state| app.remember(state));
        app.use_dialogs();
        self.photos.into_iter().for_each(|path| app.open(path));
        let window = surface.window();
        let input = egui_winit::State::new(
            app.context().clone(),
            egui::ViewportId::ROOT,
            window,
            Some(window.scale_factor() as f32),
            window.theme(),
            Some(app.max_texture_side()),
        );
        let screen = Screen::of_window(&device, window.inner_size().into());
        Ok(Open {
            app,
            screen,
            input,
            waiting: Vec::new(),
            state,
            hidden: true,
            vsync: true,
            occluded: false,
            title: String::new(),
            harness: self.harness,
            told: None,
            untried: false,
            device,
            surface,
        })
    }
}

/// A size in points, or what of it fits onto the largest display.
fn fitting(event_loop: &ActiveEventLoop, [width, height]: [u32; 2]) -> LogicalSize<f64> {
    let displays = event_loop.available_monitors().map(|display| display.size().to_logical(display.scale_factor()));
    let largest = displays.reduce(|a: LogicalSize<f64>, b| if a.width * a.height < b.width * b.height { b } else { a });
    // Some displays do not say how large they are.
    let most = |most: Option<f64>| most.filter(|&most| most > 0.0).map_or(f64::INFINITY, |most| PART * most);
    LogicalSize::new(
        f64::from(width).min(most(largest.map(|size| size.width))),
        f64::from(height).min(most(largest.map(|size| size.height))),
    )
}

impl Open {
    /// Remembers look and size; at the end there is nobody to be told that they cannot be.
    fn keep(&mut self) {
        self.app.keep_look();
        let window = self.surface.window();
        let size: LogicalSize<u32> = window.inner_size().to_logical(window.scale_factor());
        let _ = self.state.as_ref().map(|state| state.keep_size([size.width, size.height]));
    }

    /// Closes the window, unless something is to be said before.
    fn close(&mut self, event_loop: &ActiveEventLoop) {
        if self.app.may_close() {
            self.keep();
            event_loop.exit();
        } else {
            self.surface.window().request_redraw();
        }
    }

    /// Keeps what is shown, once nothing moves and where it has changed.
    fn keep_status(&mut self, rest: Duration) -> Result<()> {
        let Some(path) = self.harness.status.as_ref().filter(|_| rest > MOVING) else { return Ok(()) };
        let now = Some(Status::of(&self.app));
        if now != self.told {
            target::remember_json(path, &now)?;
            self.told = now;
        }
        Ok(())
    }

    /// Fails once a frame was the last of its context.
    fn count(&mut self) -> Result<()> {
        let frames = self.harness.lose_after;
        self.harness.lose_after = frames.and_then(|frames| frames.checked_sub(1));
        if self.device.is_lost() || frames == Some(0) {
            return Err(Error::Gl("the window's context was lost".into()));
        }
        Ok(())
    }

    /// Goes on with another context, where `lost` says why there has to be one.
    fn rebuild(mut self, lost: &Error) -> Result<Self> {
        let kept = self.app.keep_look().map(|path| format!("; the look is kept in {}", path.display()));
        let ended = |why: &Error| Error::Gl(format!("{lost} ({why}){}", kept.as_deref().unwrap_or_default()));
        if self.untried {
            return Err(ended(&Error::Gl("right after it was made anew".into())));
        }
        let Self { mut app, device, surface, .. } = self;
        let (device, surface) = surface.rebuild(&device).map_err(|error| ended(&error))?;
        app.rebuild(&device).map_err(|error| ended(&error))?;
        surface.set_vsync(self.vsync);
        let screen = Screen::of_window(&device, self.screen.size());
        Ok(Self { app, device, surface, screen, untried: true, ..self })
    }

    /// Draws a frame; says what comes next.
    fn frame(&mut self) -> Result<Next> {
        let window = self.surface.window();
        let size: [u32; 2] = window.inner_size().into();
        // A window of which nothing is seen shows nothing; the event that ends that draws it.
        if size.contains(&0) || self.occluded {
            return Ok(Next::Event);
        }
        if size != self.screen.size() {
            self.surface.resize(size);
            self.screen.set_size(size);
        }
        let mut input = self.input.take_egui_input(window);
        input.events.splice(..0, self.waiting.drain(..));
        self.waiting = input::split(&mut input.events);
        let shown = self.app.frame(input, &self.screen)?;
        self.count()?;
        let window = self.surface.window();
        if shown.vsync != self.vsync {
            // A driver may not obey; then it stays as it was.
            self.surface.set_vsync(shown.vsync);
            self.vsync = shown.vsync;
        }
        self.surface.swap()?;
        self.untried = false;
        self.input.handle_platform_output(window, shown.platform);
        let title = self.app.title();
        if title != self.title {
            window.set_title(&title);
            self.title = title;
        }
        if std::mem::take(&mut self.hidden) {
            window.set_visible(true);
        }
        let wait = if self.waiting.is_empty() { shown.repaint_after } else { Duration::ZERO };
        self.keep_status(wait)?;
        let due = Instant::now().checked_add(wait);
        Ok(if shown.close { Next::Close } else { due.map_or(Next::Event, Next::Frame) })
    }
}

impl Viewer {
    fn fail(&mut self, event_loop: &ActiveEventLoop, error: Error) {
        self.failed = Some(error);
        event_loop.exit();
    }

    fn redraw(&mut self, event_loop: &ActiveEventLoop) {
        let Some(open) = &mut self.open else { return };
        match open.frame() {
            Ok(Next::Close) => open.close(event_loop),
            Ok(Next::Event) => event_loop.set_control_flow(ControlFlow::Wait),
            Ok(Next::Frame(due)) if due.saturating_duration_since(Instant::now()) < Duration::from_millis(1) => {
                open.surface.window().request_redraw();
            }
            Ok(Next::Frame(due)) => event_loop.set_control_flow(ControlFlow::WaitUntil(due)),
            Err(error @ Error::Gl(_)) => self.recover(event_loop, &error),
            Err(error) => self.fail(event_loop, error),
        }
    }

    /// Goes on after the driver failed, or ends.
    fn recover(&mut self, event_loop: &ActiveEventLoop, error: &Error) {
        match self.open.take().map(|open| open.rebuild(error)) {
            Some(Ok(open)) => {
                open.surface.window().request_redraw();
                self.open = Some(open);
            }
            Some(Err(error)) => self.fail(event_loop, error),
            None => {}
        }
    }
}

impl ApplicationHandler<Wanted> for Viewer {
    fn resumed(&mut self, event_loop: &ActiveEventLoop) {
        let Some(start) = self.waiting.take() else { return };
        match start.open(event_loop) {
            Ok(open) => {
                // A window that is not shown yet gets no request to draw, on some displays.
                open.surface.resize(open.screen.size());
                self.open = Some(open);
                self.redraw(event_loop);
            }
            Err(error) => self.fail(event_loop, error),
        }
    }

    fn new_events(&mut self, event_loop: &ActiveEventLoop, cause: StartCause) {
        if let (StartCause::ResumeTimeReached { .. }, Some(open)) = (cause, &self.open) {
            event_loop.set_control_flow(ControlFlow::Wait);
            open.surface.window().request_redraw();
        }
    }

    fn user_event(&mut self, _: &ActiveEventLoop, _: Wanted) {
        if let Some(open) = &self.open {
            open.surface.window().request_redraw();
        }
    }

    fn window_event(&mut self, event_loop: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        let Some(open) = &mut self.open else { return };
        match event {
            WindowEvent::CloseRequested => open.close(event_loop),
            WindowEvent::RedrawRequested => self.redraw(event_loop),
            WindowEvent::Occluded(occluded) => {
                open.occluded = occluded;
                if !occluded {
                    open.surface.window().request_redraw();
                }
            }
            event => {
                if open.input.on_window_event(open.surface.window(), &event).repaint {
                    open.surface.window().request_redraw();
                }
            }
        }
    }
}
