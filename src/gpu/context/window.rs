//! OpenGL in a window, by GLX or EGL.

use std::num::NonZeroU32;
use std::rc::Rc;
use std::time::Duration;

use glow::HasContext as _;
use glutin::config::{Api, Config, ConfigTemplateBuilder, GlConfig as _};
use glutin::context::{
    ContextApi, ContextAttributesBuilder, GlProfile, NotCurrentContext, PossiblyCurrentContext, Robustness, Version,
};
use glutin::display::{Display as GlDisplay, DisplayApiPreference, GetGlDisplay as _, GlDisplay as _};
use glutin::prelude::{NotCurrentGlContext as _, PossiblyCurrentGlContext as _};
use glutin::surface::{GlSurface as _, SurfaceAttributesBuilder, SwapInterval, WindowSurface};
use libloading::Library;
use winit::event_loop::{ActiveEventLoop, EventLoop, OwnedDisplayHandle};
use winit::platform::x11::register_xlib_error_hook;
use winit::raw_window_handle::{HasDisplayHandle as _, HasWindowHandle as _};
use winit::window::{Window, WindowAttributes};

use super::{Backend, Device, Place, Platform, REQUIRED, memory, trusting};
use crate::{Error, Result};

/// What winit loads at run time on X11 and would panic without.
const X11_LIBRARIES: [&str; 2] = ["libxkbcommon.so.0", "libxkbcommon-x11.so.0"];

/// How often a context that was lost is made anew before that is given up.
const ATTEMPTS: usize = 10;
const BETWEEN_ATTEMPTS: Duration = Duration::from_millis(300);

/// An event loop on the display that the environment names.
///
/// # Errors
/// [`Error::NoDisplay`] where it names none, it does not answer, or a library is missing.
pub fn event_loop<T>() -> Result<EventLoop<T>> {
    let variable = |name: &str| std::env::var(name).ok().filter(|value| !value.is_empty());
    let wayland = variable("WAYLAND_DISPLAY").or(variable("WAYLAND_SOCKET"));
    let Some(display) = wayland.clone().or(variable("DISPLAY")) else {
        let reason = "neither WAYLAND_DISPLAY nor DISPLAY names a display".into();
        return Err(Error::NoDisplay { reason });
    };
    if wayland.is_none() {
        for name in X11_LIBRARIES {
            // SAFETY: they are libraries of the system, whose initialisers are those that winit would run.
            if unsafe { Library::new(name) }.is_err() {
                let packages = Backend::Window.packages();
                let reason = format!("{name} was not found (on Debian: apt-get install {packages})");
                return Err(Error::NoDisplay { reason });
            }
        }
    }
    EventLoop::with_user_event()
        .build()
        .map_err(|error| Error::NoDisplay { reason: format!("the display {display} does not answer: {error}") })
}

/// A way to OpenGL 4.3 on a display, before there is any window.
pub struct Display {
    config: Config,
    context: NotCurrentContext,
    route: &'static str,
    /// Goes last: all the others speak through it.
    connection: OwnedDisplayHandle,
}

impl Display {
    /// The first of GLX and EGL that gives OpenGL 4.3 or later.
    ///
    /// # Errors
    /// [`Error::NoContext`] with the reason for each; [`Error::Memory`] and [`Error::Threads`] as in [`Device::open`].
    pub fn open<T>(event_loop: &EventLoop<T>) -> Result<Self> {
        memory::room_to_open()?;
        // GLX first: on X11 drivers resize its windows more smoothly. Wayland has EGL only.
        let connection = event_loop.owned_display_handle();
        let handle =
            connection.display_handle().map_err(|error| Error::NoDisplay { reason: error.to_string() })?.as_raw();
        let glx = DisplayApiPreference::Glx(Box::new(register_xlib_error_hook));
        let mut reasons = Vec::new();
        for (name, api) in [("GLX", glx), ("EGL", DisplayApiPreference::Egl)] {
            let opened = trusting(Backend::Window.library(), || {
                // SAFETY: the handle is that of the connection, which is kept with all that comes of the display.
                let display = unsafe { GlDisplay::new(handle, api) }.map_err(|error| error.to_string())?;
                Self::try_open(&display, connection.clone())
            });
            match opened {
                Ok(display) => return Ok(display),
                Err(reason) => reasons.push(format!("{name}: {reason}")),
            }
        }
        reasons.push(format!("on Debian: apt-get install {}", Backend::Window.packages()));
        Err(Error::NoContext { reasons })
    }

    fn try_open(display: &GlDisplay, connection: OwnedDisplayHandle) -> Result<Self, String> {
        let template = ConfigTemplateBuilder::new()
            .with_api(Api::OPENGL)
            .with_depth_size(0)
            .with_stencil_size(0)
            .with_transparency(false)
            .build();
        // vglare draws without depth, stencil or samples.
        // SAFETY: the template names no native window that would have to be one.
        let config = unsafe { display.find_configs(template) }
            .map_err(|error| error.to_string())?
            .min_by_key(|config| (config.num_samples(), !config.hardware_accelerated()))
            .ok_or("no configuration for OpenGL in a window")?;
        let route = match display {
            GlDisplay::Egl(_) => "EGL window",
            GlDisplay::Glx(_) => "GLX window",
        };
        let context = new_context(&config)?;
        Ok(Self { config, context, route, connection })
    }

    /// Opens a window and makes its context current on this thread.
    ///
    /// # Errors
    /// [`Error::NoDisplay`] where the window is refused, [`Error::NoContext`] where its context is.
    pub fn window(self, event_loop: &ActiveEventLoop, attributes: WindowAttributes) -> Result<(Rc<Device>, Surface)> {
        let window = glutin_winit::finalize_window(event_loop, attributes, &self.config)
            .map_err(|error| Error::NoDisplay { reason: error.to_string() })?;
        let Self { config, context, route, connection } = self;
        let refused = |reason: String| Error::NoContext { reasons: vec![format!("{route}: {reason}")] };
        let surface = new_surface(&config, &window).map_err(refused)?;
        let (device, context) = current(&config, context, &surface, route, &connection).map_err(refused)?;
        Ok((device, Surface { surface, context, config, route, window, connection }))
    }
}

/// A context that says when it is lost, or, where the driver has none, one that does not.
fn new_context(config: &Config) -> Result<NotCurrentContext, String> {
    let create = |robustness| {
        let attributes = ContextAttributesBuilder::new()
            .with_context_api(ContextApi::OpenGl(Some(Version::new(REQUIRED.0, REQUIRED.1))))
            .with_profile(GlProfile::Core)
            .with_robustness(robustness)
            .build(None);
        // SAFETY: the configuration is of this display, and no other context shares with it.
        unsafe { config.display().create_context(config, &attributes) }
    };
    create(Robustness::RobustLoseContextOnReset)
        .or_else(|_| create(Robustness::NotRobust))
        .map_err(|error| format!("no core context of OpenGL 4.3: {error}"))
}

fn new_surface(config: &Config, window: &Window) -> Result<glutin::surface::Surface<WindowSurface>, String> {
    let handle = window.window_handle().map_err(|error| error.to_string())?.as_raw();
    let (width, height) = sides(window.inner_size().into());
    let attributes = SurfaceAttributesBuilder::<WindowSurface>::new().build(handle, width, height);
    // SAFETY: the handle is that of the window, which `Surface` keeps for longer than its surface.
    unsafe { config.display().create_window_surface(config, &attributes) }.map_err(|error| error.to_string())
}

/// Makes a context current on a surface.
fn current(
    config: &Config,
    context: NotCurrentContext,
    surface: &glutin::surface::Surface<WindowSurface>,
    route: &'static str,
    connection: &OwnedDisplayHandle,
) -> Result<(Rc<Device>, Rc<PossiblyCurrentContext>), String> {
    let place = Place::take()?;
    let context = Rc::new(context.make_current(surface).map_err(|error| error.to_string())?);
    let display = config.display();
    // SAFETY: the context is current, and its own display names its functions.
    let gl = unsafe { glow::Context::from_loader_function_cstr(|name| display.get_proc_address(name)) };
    let reset_status = reset_status(&gl, &display);
    let platform = OnScreen { _context: context.clone(), route, reset_status, _connection: connection.clone() };
    let device = Device::new(super::shared(gl), Backend::Window, Box::new(platform), Some(place))?;
    Ok((Rc::new(device), context))
}

type ResetStatus = unsafe extern "system" fn() -> u32;

/// `glGetGraphicsResetStatus`, which glow does not have, where the driver says that it has it.
fn reset_status(gl: &glow::Context, display: &GlDisplay) -> Option<ResetStatus> {
    let (version, extensions) = (gl.version(), gl.supported_extensions());
    let name = if (version.major, version.minor) >= (4, 5) {
        c"glGetGraphicsResetStatus"
    } else if extensions.contains("GL_KHR_robustness") {
        c"glGetGraphicsResetStatusKHR"
    } else if extensions.contains("GL_ARB_robustness") {
        c"glGetGraphicsResetStatusARB"
    } else {
        return None;
    };
    // SAFETY: an address or null becomes a function or none, and its signature is that of the specification.
    unsafe { std::mem::transmute::<*const std::ffi::c_void, Option<ResetStatus>>(display.get_proc_address(name)) }
}

struct OnScreen {
    _context: Rc<PossiblyCurrentContext>,
    route: &'static str,
    reset_status: Option<ResetStatus>,
    /// Goes last: the context's display speaks through it.
    _connection: OwnedDisplayHandle,
}

impl Platform for OnScreen {
    fn route(&self) -> String {
        self.route.into()
    }

    fn is_lost(&self) -> bool {
        // SAFETY: the function is the context's own, which is current unless the device was abandoned, and then nobody asks;
        // it takes nothing.
        self.reset_status.is_some_and(|ask| unsafe { ask() } != glow::NO_ERROR)
    }
}

/// A window and what is drawn into it.
pub struct Surface {
    // The window goes late, and the connection last: fields drop in order of declaration.
    surface: glutin::surface::Surface<WindowSurface>,
    context: Rc<PossiblyCurrentContext>,
    config: Config,
    route: &'static str,
    window: Window,
    connection: OwnedDisplayHandle,
}

impl Surface {
    /// The window.
    pub fn window(&self) -> &Window {
        &self.window
    }

    /// Puts a new context and surface in the place of ones that were lost, on the same window. The device before is
    /// abandoned.
    ///
    /// # Errors
    /// [`Error::NoContext`] where the driver refuses for some seconds; the window is closed then.
    pub fn rebuild(self, before: &Device) -> Result<(Rc<Device>, Self)> {
        before.abandon();
        let Self { surface, context, config, route, window, connection } = self;
        // A context that is lost may refuse even this, and is not current then either.
        let _ = context.make_not_current_in_place();
        // A window has one surface at a time.
        drop(surface);
        drop(context);
        let mut attempts = 0;
        loop {
            let made = new_context(&config).and_then(|context| {
                let surface = new_surface(&config, &window)?;
                current(&config, context, &surface, route, &connection)
                    .map(|(device, context)| (device, context, surface))
            });
            match made {
                Ok((device, context, surface)) => {
                    return Ok((device, Self { surface, context, config, route, window, connection }));
                }
                // A card that is being reset takes a while.
                Err(_) if attempts < ATTEMPTS => {
                    attempts += 1;
                    std::thread::sleep(BETWEEN_ATTEMPTS);
                }
                Err(reason) => return Err(Error::NoContext { reasons: vec![format!("{route}: {reason}")] }),
            }
        }
    }

    /// Shows what was drawn.
    ///
    /// # Errors
    /// [`Error::Gl`] where the context is lost.
    pub fn swap(&self) -> Result<()> {
        self.window.pre_present_notify();
        self.surface.swap_buffers(&self.context).map_err(|error| Error::Gl(format!("the window is lost: {error}")))
    }

    /// Fits the surface to the window's size, in pixels; one without pixels is left as it was.
    pub fn resize(&self, size: [u32; 2]) {
        if size.iter().all(|&side| side > 0) {
            let (width, height) = sides(size.into());
            self.surface.resize(&self.context, width, height);
        }
    }

    /// Whether frames wait for the display; says whether the driver obeys.
    pub fn set_vsync(&self, vsync: bool) -> bool {
        let interval = if vsync { SwapInterval::Wait(NonZeroU32::MIN) } else { SwapInterval::DontWait };
        self.surface.set_swap_interval(&self.context, interval).is_ok()
    }
}

fn sides((width, height): (u32, u32)) -> (NonZeroU32, NonZeroU32) {
    let side = |side| NonZeroU32::new(side).unwrap_or(NonZeroU32::MIN);
    (side(width), side(height))
}
