//! OSMesa: Mesa's software renderer drawing into memory, loaded at run time.

use std::ffi::{CString, c_int, c_uchar, c_void};
use std::ptr;

use libloading::Library;

use super::{Platform, REQUIRED, load};

pub(super) const NAMES: [&str; 3] = ["libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"];

// From GL/osmesa.h.
const FORMAT: c_int = 0x22;
const PROFILE: c_int = 0x33;
const CORE_PROFILE: c_int = 0x34;
const CONTEXT_MAJOR_VERSION: c_int = 0x36;
const CONTEXT_MINOR_VERSION: c_int = 0x37;
const RGBA: c_int = glow::RGBA as c_int;

type Handle = *mut c_void;
type CreateContextAttribs = unsafe extern "C" fn(*const c_int, Handle) -> Handle;
type MakeCurrent = unsafe extern "C" fn(Handle, *mut c_void, u32, c_int, c_int) -> c_uchar;
type DestroyContext = unsafe extern "C" fn(Handle);
type GetProcAddress = unsafe extern "C" fn(*const std::ffi::c_char) -> *const c_void;

struct OsMesa {
    context: Handle,
    destroy: DestroyContext,
    /// The colour buffer that OSMesa insists on; every pass draws into its own framebuffer objects instead.
    _buffer: Box<[u8; 4]>,
    /// Unloaded last: fields drop in order of declaration.
    _library: Library,
}

impl Platform for OsMesa {
    fn route(&self) -> String {
        "OSMesa".into()
    }
}

impl Drop for OsMesa {
    fn drop(&mut self) {
        // SAFETY: OSMesa gave the context, the library is loaded still, and nothing uses the context from here on.
        unsafe { (self.destroy)(self.context) }
    }
}

/// A core context of the required version, current on this thread.
pub(super) fn open() -> Result<(glow::Context, Box<dyn Platform>), String> {
    let library = load(NAMES[0]).or_else(|first| NAMES[1..].iter().find_map(|name| load(name).ok()).ok_or(first))?;
    let missing = |error: libloading::Error| format!("{} is not as expected: {error}", NAMES[0]);
    // SAFETY: the type is that of GL/osmesa.h, and the library outlives the pointer in `OsMesa`.
    let create = *unsafe { library.get::<CreateContextAttribs>(b"OSMesaCreateContextAttribs\0") }.map_err(missing)?;
    // SAFETY: the type is that of GL/osmesa.h, and the library outlives the pointer in `OsMesa`.
    let make_current = *unsafe { library.get::<MakeCurrent>(b"OSMesaMakeCurrent\0") }.map_err(missing)?;
    // SAFETY: the type is that of GL/osmesa.h, and the library outlives the pointer in `OsMesa`.
    let destroy = *unsafe { library.get::<DestroyContext>(b"OSMesaDestroyContext\0") }.map_err(missing)?;
    // SAFETY: the type is that of GL/osmesa.h, and the library outlives the pointer in `OsMesa`.
    let address = *unsafe { library.get::<GetProcAddress>(b"OSMesaGetProcAddress\0") }.map_err(missing)?;

    let attributes = [
        [FORMAT, RGBA],
        [PROFILE, CORE_PROFILE],
        [CONTEXT_MAJOR_VERSION, c_int::from(REQUIRED.0)],
        [CONTEXT_MINOR_VERSION, c_int::from(REQUIRED.1)],
        [0, 0],
    ];
    // SAFETY: the list ends in 0, and null is no context to share with.
    let context = unsafe { create(attributes.as_flattened().as_ptr(), ptr::null_mut()) };
    if context.is_null() {
        return Err("gives no core context of OpenGL 4.3".into());
    }
    let mut buffer = Box::new([0u8; 4]);
    let pixels = buffer.as_mut_ptr().cast();
    // SAFETY: the context is OSMesa's, and the buffer has a pixel of four bytes and lives as long as the context.
    let current = unsafe { make_current(context, pixels, glow::UNSIGNED_BYTE, 1, 1) };
    let platform = OsMesa { context, destroy, _buffer: buffer, _library: library };
    if current == 0 {
        return Err("would not make its context current".into());
    }
    // SAFETY: the context is current, and its own library names its functions.
    let gl = unsafe {
        glow::Context::from_loader_function(|name| match CString::new(name) {
            Ok(name) => address(name.as_ptr()),
            Err(_) => ptr::null(),
        })
    };
    Ok((gl, Box::new(platform)))
}
