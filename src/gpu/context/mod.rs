//! OpenGL 4.3 with and without a window: GLX or EGL on a display, EGL where there is a driver, OSMesa where there is none,
//! or the context of a program that has one.

mod egl;
mod host;
mod memory;
mod osmesa;
#[cfg(feature = "window")]
pub(in crate::gpu) mod window;

use std::cell::Cell;
use std::fmt;
use std::rc::Rc;
use std::sync::Arc;

use glow::HasContext as _;
use libloading::Library;

use crate::{Error, Result, panics};

pub use memory::be_sparing;

/// The version of OpenGL that every pass is written for.
pub const REQUIRED: (u8, u8) = (4, 3);

/// A way to a GL context.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, serde::Serialize)]
#[cfg_attr(feature = "terminal", derive(clap::ValueEnum))]
#[serde(rename_all = "lowercase")]
pub enum Backend {
    /// EGL on a device or without any surface: the graphics driver, or Mesa's software renderer.
    Egl,
    /// OSMesa, Mesa's software renderer in memory: needs neither driver nor display.
    #[cfg_attr(feature = "terminal", value(name = "osmesa"))]
    OsMesa,
    /// GLX or EGL on a display, drawing into a window; only [`Display`](window::Display) opens it.
    #[cfg_attr(feature = "terminal", value(skip))]
    Window,
    /// A context that the program brought itself; only [`Device::adopt`] takes it.
    #[cfg_attr(feature = "terminal", value(skip))]
    Host,
}

impl Backend {
    /// Every backend that needs no window, in the order in which [`Device::open`] tries them.
    pub const ALL: [Self; 2] = [Self::Egl, Self::OsMesa];

    /// The Debian packages that bring this backend.
    pub fn packages(self) -> &'static str {
        match self {
            Self::Egl => "libegl1 libgl1-mesa-dri",
            Self::OsMesa => "libosmesa6",
            Self::Window => "libgl1 libegl1 libgl1-mesa-dri libx11-6 libx11-xcb1 libxcursor1 libxi6 libxkbcommon-x11-0",
            Self::Host => "",
        }
    }
}

impl Backend {
    /// What a library is called that brings it.
    fn library(self) -> &'static str {
        match self {
            Self::Egl => egl::LIBRARY,
            Self::OsMesa => osmesa::NAMES[0],
            Self::Window | Self::Host => "libGL or libEGL",
        }
    }
}

/// Opens something of a library that has to be trusted to be what its name says: glutin and glow panic where it lacks
/// what they call.
fn trusting<T>(library: &str, open: impl FnOnce() -> Result<T, String>) -> Result<T, String> {
    panics::caught(|| Ok(open())).unwrap_or_else(|error| match error {
        Error::Internal { what } => Err(format!("{library} is not what its name says: {what}")),
        other => Err(other.to_string()),
    })
}

/// Loads a library.
fn load(name: &str) -> Result<Library, String> {
    // SAFETY: it is trusted to be what its name says, as any driver is; its initialisers are its own.
    unsafe { Library::new(name) }.map_err(|error| {
        // One that is there may be damaged, of another machine, or lack others.
        let reason = std::error::Error::source(&error).map_or_else(|| error.to_string(), ToString::to_string);
        let absent = reason.contains(name) && reason.contains("No such file");
        if absent { format!("{name} was not found") } else { format!("{name} cannot be loaded: {reason}") }
    })
}

impl fmt::Display for Backend {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Egl => "egl",
            Self::OsMesa => "osmesa",
            Self::Window => "window",
            Self::Host => "host",
        })
    }
}

/// What keeps a context alive and current; dropped after the last GL object.
trait Platform {
    /// How the context came about, e.g. "EGL device" or "OSMesa".
    fn route(&self) -> String;

    /// Whether the driver says that the context was lost; without a window nobody asks it to say so.
    fn is_lost(&self) -> bool {
        false
    }
}

/// A current GL context on this thread, opened here or adopted from a host. GL objects hold it by [`Rc`], so it outlives
/// them all.
pub struct Device {
    /// By [`Arc`] because egui's painter shares it, or it is a host's.
    gl: Arc<glow::Context>,
    info: Info,
    platform: Box<dyn Platform>,
    lost: Cell<bool>,
    abandoned: Cell<bool>,
    /// Held while the context is to be current; none of a host's, which promises that itself.
    place: Cell<Option<Place>>,
}

thread_local! {
    static TAKEN: Cell<bool> = const { Cell::new(false) };
}

/// The place of the current context on a thread. One that is opened becomes current, so another before it would not be.
struct Place(());

impl Place {
    const REFUSED: &str = "a device is open on this thread already, and would lose its context";

    fn take() -> Result<Self, String> {
        if TAKEN.replace(true) { Err(Self::REFUSED.into()) } else { Ok(Self(())) }
    }
}

impl Drop for Place {
    fn drop(&mut self) {
        TAKEN.set(false);
    }
}

/// What the driver says about itself.
#[derive(Debug, Clone, serde::Serialize)]
pub struct Info {
    /// The backend in use.
    pub backend: Backend,
    /// How the context came about.
    pub route: String,
    /// GL_RENDERER.
    pub renderer: String,
    /// GL_VENDOR.
    pub vendor: String,
    /// GL_VERSION.
    pub version: String,
    /// Whether the renderer is known to run on the CPU.
    pub software: bool,
    /// The limits that the passes meet.
    pub limits: Limits,
}

impl Info {
    /// Rounds that the renderer runs a shader's loops for one pixel, all of them taken together, where that is limited:
    /// Mesa's software renderer then ends them without a word.
    pub fn loop_rounds(&self) -> Option<usize> {
        self.software.then_some(65535)
    }
}

/// The driver's limits that the passes meet.
#[derive(Debug, Clone, Copy, serde::Serialize)]
pub struct Limits {
    /// Whether shaders have 64-bit floats; OpenGL 4.0 asks for them, and not every driver that calls itself later gives them.
    pub doubles: bool,
    /// Largest width and height of a texture.
    pub texture_size: u32,
    /// Largest width and height of a viewport.
    pub viewport: [u32; 2],
    /// Largest shader storage block, bytes.
    pub storage_block: u64,
    /// Largest uniform block, bytes.
    pub uniform_block: u32,
    /// Shader storage bindings of one program.
    pub storage_bindings: u32,
    /// Work groups of one dispatch, per axis.
    pub work_groups: [u32; 3],
    /// Invocations of one work group.
    pub work_group_invocations: u32,
    /// Shared memory of one work group, bytes.
    pub shared_memory: u32,
}

impl Device {
    /// Opens the first of `backends` that gives OpenGL 4.3 or later and makes it current on this thread.
    ///
    /// # Errors
    /// [`Error::NoContext`] with the reason for each backend that failed and the packages that would mend it;
    /// [`Error::Memory`] and [`Error::Threads`] where the system's limits leave a driver too little; [`Error::Gl`] where
    /// another device that was opened on this thread is still there.
    pub fn open(backends: &[Backend]) -> Result<Rc<Self>> {
        memory::room_to_open()?;
        if TAKEN.get() {
            return Err(Error::Gl(Place::REFUSED.into()));
        }
        let mut reasons = Vec::new();
        for &backend in backends {
            match Self::try_open(backend) {
                Ok(device) => return Ok(Rc::new(device)),
                Err(reason) => {
                    reasons.push(format!("{backend}: {reason} (on Debian: apt-get install {})", backend.packages()));
                }
            }
        }
        Err(Error::NoContext { reasons })
    }

    /// Opens one backend and makes it current on this thread.
    ///
    /// # Errors
    /// Why it does not work, in words.
    pub fn try_open(backend: Backend) -> Result<Self, String> {
        let place = Place::take()?;
        trusting(backend.library(), || {
            let (gl, platform): (glow::Context, Box<dyn Platform>) = match backend {
                Backend::Egl => egl::open()?,
                Backend::OsMesa => osmesa::open()?,
                Backend::Window => return Err("is not opened without a window".into()),
                Backend::Host => return Err("is the program's own, to be adopted".into()),
            };
            Self::new(shared(gl), backend, platform, Some(place))
        })
    }

    /// The device of a context that is current.
    fn new(
        gl: Arc<glow::Context>,
        backend: Backend,
        platform: Box<dyn Platform>,
        place: Option<Place>,
    ) -> Result<Self, String> {
        let version = gl.version();
        let below = (version.major, version.minor) < (u32::from(REQUIRED.0), u32::from(REQUIRED.1));
        if below || version.is_embedded {
            let kind = if version.is_embedded { "OpenGL ES" } else { "OpenGL" };
            return Err(format!("gives {kind} {}.{} and OpenGL 4.3 is needed", version.major, version.minor));
        }
        let info = describe(&gl, backend, platform.route());
        let place = Cell::new(place);
        Ok(Self { gl, info, platform, lost: Cell::default(), abandoned: Cell::default(), place })
    }

    /// The GL functions.
    ///
    /// # Panics
    /// Where the device was abandoned: its context may not be current any more.
    pub(in crate::gpu) fn gl(&self) -> &glow::Context {
        assert!(!self.abandoned.get(), "a device is used that was abandoned");
        &self.gl
    }

    /// The GL functions, for someone who frees what was made on the device; none where it went with its context.
    pub(in crate::gpu) fn to_free(&self) -> Option<&glow::Context> {
        (!self.abandoned.get()).then_some(&*self.gl)
    }

    /// Whether the driver says that the context was lost, as where a graphics card is reset; then nothing that was made
    /// on it can be used.
    pub fn is_lost(&self) -> bool {
        // A driver that is ready again says so, and the context is no better for it.
        self.lost.set(self.lost.get() || self.abandoned.get() || self.platform.is_lost());
        self.lost.get()
    }

    /// From now on the context may not be current any more, and must not be used: what was made on it goes with it, and
    /// is not freed one by one.
    pub fn abandon(&self) {
        self.abandoned.set(true);
        self.place.take();
    }

    /// The GL functions, for a painter that keeps them.
    pub(in crate::gpu) fn shared_gl(&self) -> Arc<glow::Context> {
        self.gl.clone()
    }

    /// What the driver says about itself.
    pub fn info(&self) -> &Info {
        &self.info
    }

    /// An error where the driver has one to tell since it was last asked; running out of memory, above all.
    ///
    /// # Errors
    /// [`Error::Gl`], which names `work`.
    pub fn check(&self, work: &str) -> Result<()> {
        // SAFETY: the device keeps its context current on this thread.
        let name = match unsafe { self.gl().get_error() } {
            glow::NO_ERROR => return Ok(()),
            glow::OUT_OF_MEMORY => "out of memory".to_owned(),
            glow::INVALID_OPERATION => "invalid operation".to_owned(),
            glow::INVALID_VALUE => "invalid value".to_owned(),
            other => format!("error {other:#x}"),
        };
        Err(Error::Gl(format!("{name} while {work}")))
    }

    /// Waits until the GL has done all that it was asked to.
    pub fn finish(&self) {
        // SAFETY: the device keeps its context current on this thread.
        unsafe { self.gl().finish() }
    }
}

/// egui's painter and hosts share the functions by an `Arc`; nothing leaves this thread.
#[allow(clippy::arc_with_non_send_sync)]
fn shared(gl: glow::Context) -> Arc<glow::Context> {
    Arc::new(gl)
}

impl fmt::Debug for Device {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Device").field("info", &self.info).field("platform", &self.platform.route()).finish()
    }
}

fn describe(gl: &glow::Context, backend: Backend, route: String) -> Info {
    // SAFETY: the context is current, and the name is one of OpenGL 4.3.
    let text = |name| unsafe { gl.get_parameter_string(name) };
    // SAFETY: the context is current, and the name is one of OpenGL 4.3.
    let number = |name| unsafe { gl.get_parameter_i32(name) }.max(0) as u32;
    // SAFETY: the context is current, and the name is one of OpenGL 4.3.
    let indexed = |name, index| unsafe { gl.get_parameter_indexed_i32(name, index) }.max(0) as u32;
    let mut viewport = [0; 2];
    // SAFETY: the context is current, and the parameter has two numbers, as the array.
    unsafe { gl.get_parameter_i32_slice(glow::MAX_VIEWPORT_DIMS, &mut viewport) };
    let renderer = text(glow::RENDERER);
    let software = ["llvmpipe", "softpipe", "swrast", "SwiftShader"].iter().any(|name| renderer.contains(name));
    Info {
        backend,
        route,
        vendor: text(glow::VENDOR),
        version: text(glow::VERSION),
        software,
        renderer,
        limits: Limits {
            doubles: has_doubles(gl),
            texture_size: number(glow::MAX_TEXTURE_SIZE),
            viewport: viewport.map(|side| side.max(0) as u32),
            // SAFETY: the context is current, and the name is one of OpenGL 4.3.
            storage_block: unsafe { gl.get_parameter_i64(glow::MAX_SHADER_STORAGE_BLOCK_SIZE) }.max(0) as u64,
            uniform_block: number(glow::MAX_UNIFORM_BLOCK_SIZE),
            storage_bindings: number(glow::MAX_SHADER_STORAGE_BUFFER_BINDINGS),
            work_groups: [0, 1, 2].map(|axis| indexed(glow::MAX_COMPUTE_WORK_GROUP_COUNT, axis)),
            work_group_invocations: number(glow::MAX_COMPUTE_WORK_GROUP_INVOCATIONS),
            shared_memory: number(glow::MAX_COMPUTE_SHARED_MEMORY_SIZE),
        },
    }
}

/// Whether a shader that computes with 64-bit floats compiles.
fn has_doubles(gl: &glow::Context) -> bool {
    const SOURCE: &str = "#version 430\nlayout(local_size_x = 1) in;\n\
        layout(std430, binding = 0) buffer Numbers { double numbers[]; };\n\
        void main() { numbers[1] = numbers[0] * numbers[0]; }\n";
    // SAFETY: the context is current.
    let Ok(shader) = (unsafe { gl.create_shader(glow::COMPUTE_SHADER) }) else { return false };
    // SAFETY: the context is current, and the shader is its own.
    unsafe {
        gl.shader_source(shader, SOURCE);
        gl.compile_shader(shader);
        let compiled = gl.get_shader_compile_status(shader);
        gl.delete_shader(shader);
        compiled
    }
}
