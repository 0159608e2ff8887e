//! EGL without a window: each device that the driver names in turn, then Mesa's surfaceless platform.

use std::ffi::{CStr, CString, c_void};
use std::ptr;

use glutin::api::egl::context::PossiblyCurrentContext;
use glutin::api::egl::device::Device;
use glutin::api::egl::display::Display;
use glutin::config::{ConfigSurfaceTypes, ConfigTemplateBuilder};
use glutin::context::{ContextApi, ContextAttributesBuilder, GlProfile, Version};
use glutin::display::GlDisplay as _;
use glutin_egl_sys::egl;
use glutin_egl_sys::egl::types::{EGLContext, EGLDisplay, EGLint};
use libloading::Library;

use super::{Platform, REQUIRED, load};

/// `EGL_PLATFORM_SURFACELESS_MESA`, of the extension EGL_MESA_platform_surfaceless.
const PLATFORM_SURFACELESS: egl::types::EGLenum = 0x31DD;
pub(super) const LIBRARY: &str = "libEGL.so.1";

/// A core context of the required version, current on this thread.
pub(super) fn open() -> Result<(glow::Context, Box<dyn Platform>), String> {
    let _loaded = load(LIBRARY)?;
    let mut reasons = Vec::new();
    match Device::query_devices() {
        Ok(devices) => {
            for (index, device) in devices.enumerate() {
                match open_device(&device, index) {
                    Ok(opened) => return Ok(opened),
                    Err(error) => reasons.push(format!("device {index}: {error}")),
                }
            }
        }
        Err(error) => reasons.push(format!("devices: {error}")),
    }
    open_surfaceless().map_err(|error| {
        reasons.push(format!("surfaceless: {error}"));
        reasons.join("; ")
    })
}

struct OnDevice {
    // The context goes before its display: fields drop in order of declaration.
    _context: PossiblyCurrentContext,
    _display: Display,
    index: usize,
}

impl Platform for OnDevice {
    fn route(&self) -> String {
        format!("EGL device {}", self.index)
    }
}

fn open_device(device: &Device, index: usize) -> glutin::error::Result<(glow::Context, Box<dyn Platform>)> {
    // SAFETY: no native display is given that would have to be one.
    let display = unsafe { Display::with_device(device, None) }?;
    let template = ConfigTemplateBuilder::new().with_surface_type(ConfigSurfaceTypes::empty()).build();
    // SAFETY: the template names no native window that would have to be one.
    let config = unsafe { display.find_configs(template) }?.next().ok_or(glutin::error::ErrorKind::BadConfig)?;
    let attributes = ContextAttributesBuilder::new()
        .with_context_api(ContextApi::OpenGl(Some(Version::new(REQUIRED.0, REQUIRED.1))))
        .with_profile(GlProfile::Core)
        .build(None);
    // SAFETY: the configuration is of this display, and no other context shares with it.
    let context = unsafe { display.create_context(&config, &attributes) }?.make_current_surfaceless()?;
    // SAFETY: the context is current, and its own display names its functions.
    let gl = unsafe { glow::Context::from_loader_function_cstr(|name| display.get_proc_address(name)) };
    Ok((gl, Box::new(OnDevice { _context: context, _display: display, index })))
}

struct Surfaceless {
    egl: egl::Egl,
    display: EGLDisplay,
    context: EGLContext,
    _library: Library,
}

impl Platform for Surfaceless {
    fn route(&self) -> String {
        "EGL surfaceless".into()
    }
}

impl Drop for Surfaceless {
    fn drop(&mut self) {
        // SAFETY: display and context are those that EGL gave, and the context is not used from here on.
        unsafe {
            // Another one may be current by now.
            if self.egl.GetCurrentContext() == self.context {
                self.egl.MakeCurrent(self.display, egl::NO_SURFACE, egl::NO_SURFACE, egl::NO_CONTEXT);
            }
            self.egl.DestroyContext(self.display, self.context);
        }
    }
}

/// glutin has no surfaceless display, so this route calls EGL itself.
fn open_surfaceless() -> Result<(glow::Context, Box<dyn Platform>), String> {
    let library = load(LIBRARY)?;
    let egl = egl::Egl::load_with(|name| match CString::new(name) {
        // SAFETY: the symbol is only read as an address; EGL's own table knows its type.
        Ok(name) => unsafe { library.get::<*const c_void>(name.as_bytes_with_nul()) }.map_or(ptr::null(), |f| *f),
        Err(_) => ptr::null(),
    });
    if !egl.GetPlatformDisplay.is_loaded() {
        return Err("EGL is older than 1.5".into());
    }
    // SAFETY: the platform takes no native display and no attributes, which null says; EGL refuses one that it has not.
    let display = unsafe { egl.GetPlatformDisplay(PLATFORM_SURFACELESS, ptr::null_mut(), ptr::null()) };
    // SAFETY: the display is one that EGL gave, and null asks for no version.
    if display == egl::NO_DISPLAY || unsafe { egl.Initialize(display, ptr::null_mut(), ptr::null_mut()) } == 0 {
        return Err("the platform is not supported".into());
    }
    let context = create_context(&egl, display)?;
    let platform = Surfaceless { egl, display, context, _library: library };
    // SAFETY: display and context are those that EGL gave; no surface is allowed, or refused.
    let made = unsafe { platform.egl.MakeCurrent(display, egl::NO_SURFACE, egl::NO_SURFACE, context) };
    if made == 0 {
        return Err("the context cannot be made current".into());
    }
    // SAFETY: the name ends in NUL.
    let loader = |name: &CStr| unsafe { platform.egl.GetProcAddress(name.as_ptr()) }.cast::<c_void>().cast_const();
    // SAFETY: the context is current, and its own EGL names its functions.
    let gl = unsafe { glow::Context::from_loader_function_cstr(loader) };
    Ok((gl, Box::new(platform)))
}

fn create_context(egl: &egl::Egl, display: EGLDisplay) -> Result<EGLContext, String> {
    let wanted = [egl::SURFACE_TYPE, 0, egl::RENDERABLE_TYPE, egl::OPENGL_BIT, egl::NONE].map(|word| word as EGLint);
    let (mut config, mut found) = (ptr::null(), 0);
    // SAFETY: the list ends in NONE, and there is room for one configuration and for their number.
    let chosen = unsafe { egl.ChooseConfig(display, wanted.as_ptr(), &mut config, 1, &mut found) };
    // SAFETY: it takes a number.
    if chosen == 0 || found == 0 || unsafe { egl.BindAPI(egl::OPENGL_API) } == 0 {
        return Err("no configuration for OpenGL".into());
    }
    let attributes = [
        (egl::CONTEXT_MAJOR_VERSION, u32::from(REQUIRED.0)),
        (egl::CONTEXT_MINOR_VERSION, u32::from(REQUIRED.1)),
        (egl::CONTEXT_OPENGL_PROFILE_MASK, egl::CONTEXT_OPENGL_CORE_PROFILE_BIT),
        (egl::NONE, egl::NONE),
    ];
    let attributes: Vec<EGLint> =
        attributes.iter().flat_map(|&(key, value)| [key as EGLint, value as EGLint]).collect();
    // SAFETY: display and configuration are those that EGL gave, and the list ends in NONE.
    let context = unsafe { egl.CreateContext(display, config, egl::NO_CONTEXT, attributes.as_ptr()) };
    if context == egl::NO_CONTEXT { Err("no core context of OpenGL 4.3".into()) } else { Ok(context) }
}
