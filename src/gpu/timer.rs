//! How long each pass takes.

use std::rc::Rc;
use std::time::Instant;

use glow::HasContext as _;

use super::context::Device;
use crate::{Error, Result};

/// One pass, timed.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct PassTime {
    /// The pass: the stem of its shader's file.
    pub pass: String,
    /// Milliseconds from an idle device to an idle device again.
    pub wall_ms: f64,
    /// Milliseconds by the device's own timer; none where that answers zero, as Mesa's software renderer may.
    pub gpu_ms: Option<f64>,
}

/// Times passes one after the other; does nothing until it is enabled.
pub(crate) struct Timer {
    device: Rc<Device>,
    query: glow::Query,
    enabled: bool,
    started: Option<Instant>,
    times: Vec<PassTime>,
}

impl Timer {
    pub fn new(device: &Rc<Device>) -> Result<Self> {
        // SAFETY: the device keeps its context current on this thread.
        let query =
            unsafe { device.gl().create_query() }.map_err(|reason| Error::Gl(format!("timer query: {reason}")))?;
        Ok(Self { device: device.clone(), query, enabled: false, started: None, times: Vec::new() })
    }

    pub fn set_enabled(&mut self, enabled: bool) {
        self.enabled = enabled;
    }

    pub fn begin(&mut self) {
        if self.enabled {
            self.device.finish();
            self.started = Some(Instant::now());
            // SAFETY: the device keeps its context current on this thread, and the query is its own.
            unsafe { self.device.gl().begin_query(glow::TIME_ELAPSED, self.query) };
        }
    }

    pub fn end(&mut self, pass: &str) {
        let Some(started) = self.started.take() else { return };
        let gl = self.device.gl();
        // SAFETY: the device keeps its context current on this thread, and the query is its own.
        unsafe { gl.end_query(glow::TIME_ELAPSED) };
        self.device.finish();
        let wall_ms = started.elapsed().as_secs_f64() * 1e3;
        // The 32-bit result saturates at 4.3 s; glow's 64-bit call is not safe on every 4.3 driver.
        // SAFETY: the device keeps its context current on this thread, and the query is its own.
        let nanoseconds = unsafe { gl.get_query_parameter_u32(self.query, glow::QUERY_RESULT) };
        let gpu_ms = (nanoseconds > 0 && nanoseconds < u32::MAX).then(|| f64::from(nanoseconds) * 1e-6);
        self.times.push(PassTime { pass: pass.to_owned(), wall_ms, gpu_ms });
    }

    pub fn take(&mut self) -> Vec<PassTime> {
        std::mem::take(&mut self.times)
    }
}

impl Drop for Timer {
    fn drop(&mut self) {
        if let Some(gl) = self.device.to_free() {
            // SAFETY: the device's context is there and current, and nothing uses what is freed from here on.
            unsafe { gl.delete_query(self.query) }
        }
    }
}
