//! A host's context, adopted: the same bits as on one of vglare's own, and nothing of the host's is lost.

// Whoever brings a context answers for it.
#![allow(unsafe_code)]

use std::rc::Rc;
use std::sync::Arc;

use glow::HasContext as _;
use glutin::api::egl::context::PossiblyCurrentContext;
use glutin::api::egl::device::Device as EglDevice;
use glutin::api::egl::display::Display;
use glutin::config::{ConfigSurfaceTypes, ConfigTemplateBuilder};
use glutin::context::{ContextApi, ContextAttributesBuilder, Version};
use glutin::display::GlDisplay as _;
use vglare::Error;
use vglare::frame::Frame;
use vglare::gpu::{Backend, Device};
use vglare::plan::Evaluator;
use vglare::renderer::Picture;

use crate::support::{bits, glare, on_backend, plan_with, scenes, turn};

/// A program with a context of its own.
struct Host {
    gl: Arc<glow::Context>,
    // The context goes before its display: fields drop in order of declaration.
    context: PossiblyCurrentContext,
    _display: Display,
}

impl Host {
    /// With the first of the drivers' contexts that is to be had, as a host makes it.
    fn new(api: ContextApi) -> Self {
        let open = |device: &EglDevice| -> Option<(PossiblyCurrentContext, Display)> {
            // SAFETY: no native display is given, the template names no window, and nothing is shared.
            unsafe {
                let display = Display::with_device(device, None).ok()?;
                let template = ConfigTemplateBuilder::new().with_surface_type(ConfigSurfaceTypes::empty()).build();
                let config = display.find_configs(template).ok()?.next()?;
                let attributes = ContextAttributesBuilder::new().with_context_api(api).build(None);
                let context = display.create_context(&config, &attributes).ok()?.make_current_surfaceless().ok()?;
                Some((context, display))
            }
        };
        let (context, display) =
            EglDevice::query_devices().unwrap().find_map(|device| open(&device)).expect("these tests need EGL");
        // SAFETY: the context is current, and its own display names its functions.
        let gl = unsafe { glow::Context::from_loader_function_cstr(|name| display.get_proc_address(name)) };
        #[allow(clippy::arc_with_non_send_sync)]
        Self { gl: Arc::new(gl), context, _display: display }
    }

    fn adopted(&self) -> vglare::Result<Rc<Device>> {
        use glutin::prelude::PossiblyCurrentGlContext as _;
        assert!(self.context.is_current());
        // SAFETY: the context is current, and outlives what the tests make on it.
        unsafe { Device::adopt(self.gl.clone()) }
    }

    /// What a careless program leaves behind that would spoil what is drawn after it.
    fn draw_carelessly(&self) {
        let gl = &self.gl;
        // SAFETY: the context is current.
        unsafe {
            let sampler = gl.create_sampler().unwrap();
            gl.sampler_parameter_i32(sampler, glow::TEXTURE_MIN_FILTER, glow::LINEAR as i32);
            gl.sampler_parameter_i32(sampler, glow::TEXTURE_MAG_FILTER, glow::LINEAR as i32);
            (0..15).for_each(|unit| gl.bind_sampler(unit, Some(sampler)));
            let buffer = gl.create_buffer().unwrap();
            gl.bind_buffer(glow::PIXEL_PACK_BUFFER, Some(buffer));
            gl.bind_buffer(glow::PIXEL_UNPACK_BUFFER, Some(buffer));
            for (name, value) in [
                (glow::UNPACK_ROW_LENGTH, 7),
                (glow::UNPACK_SKIP_ROWS, 3),
                (glow::PACK_SKIP_PIXELS, 5),
                (glow::PACK_ROW_LENGTH, 9),
                (glow::UNPACK_SWAP_BYTES, 1),
            ] {
                gl.pixel_store_i32(name, value);
            }
            gl.polygon_mode(glow::FRONT_AND_BACK, glow::LINE);
            for capability in [glow::RASTERIZER_DISCARD, glow::SCISSOR_TEST, glow::BLEND, glow::DEPTH_TEST] {
                gl.enable(capability);
            }
            gl.scissor(0, 0, 1, 1);
            gl.color_mask(false, true, false, true);
            gl.enable(u32::MAX);
        }
    }
}

/// The glare by each evaluator, as bits.
fn fields(picture: &mut Picture) -> Vec<Vec<[u32; 4]>> {
    let frame = Frame::full(41, 29);
    let ghosts = scenes::random(7, 12, frame);
    let field = |evaluator| bits(&glare(picture, &plan_with(&ghosts, frame, 1e-3, evaluator), frame));
    Evaluator::ALL.map(field).into()
}

#[test]
fn a_hosts_context_gives_the_same_bits_and_stays_the_hosts() {
    let expected = on_backend(Backend::Egl, fields);
    let _turn = turn();
    let host = Host::new(ContextApi::OpenGl(Some(Version::new(4, 3))));
    // SAFETY: the context is current.
    let texture = unsafe { host.gl.create_texture().unwrap() };
    host.draw_carelessly();
    let device = host.adopted().unwrap();
    assert_eq!((device.info().backend, &*device.info().route), (Backend::Host, "a host's context"));
    assert!(device.info().limits.texture_size >= 4096);
    let mut picture = Picture::new(&device).unwrap();
    assert!(fields(&mut picture) == expected, "after a careless host");
    host.draw_carelessly();
    device.settle();
    assert!(fields(&mut picture) == expected, "after it has drawn in between");
    drop((picture, device));
    // SAFETY: the context is current still.
    unsafe {
        host.gl.bind_texture(glow::TEXTURE_2D, Some(texture));
        assert!(host.gl.is_texture(texture), "what the host made is there");
        assert_eq!(host.gl.get_error(), glow::NO_ERROR);
    }
    assert!(fields(&mut Picture::new(&host.adopted().unwrap()).unwrap()) == expected, "and it can be adopted again");
}

#[test]
fn a_context_that_is_not_enough_is_refused() {
    let _turn = turn();
    let host = Host::new(ContextApi::Gles(Some(Version::new(3, 0))));
    let error = host.adopted().expect_err("it is one of OpenGL ES");
    assert!(matches!(error, Error::NoContext { .. }), "{error:?}");
    let said = error.to_string();
    assert!(said.contains("the host's context gives OpenGL ES 3.") && said.ends_with("OpenGL 4.3 is needed"), "{said}");
}
