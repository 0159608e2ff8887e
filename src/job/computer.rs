//! What pictures are computed with.

use std::rc::Rc;
use std::sync::Arc;

use super::Known;
use crate::Result;
use crate::choices::Processor;
use crate::gpu::{Device, Info};
use crate::renderer::{Picture, Scatter};

/// A device, what is known of its speed, and what renders on it: made once for however many photos.
pub struct Computer {
    device: Rc<Device>,
    pub(super) info: Arc<Info>,
    /// Its warning is told with the first photo and gone then: what is wrong with a machine is no photo's fault.
    pub(super) known: Known,
    renderer: Option<Picture>,
    scatter: Option<Scatter>,
    /// What sums veils, where someone said so.
    pub(super) veil_by: Option<Processor>,
}

impl Computer {
    /// What renders on `device`, whose shaders are compiled with the first photo. Plans go by what is known of its speed:
    /// by what was measured here, which [`Known::of`] reads, or by the built-in cost model, which is the default.
    pub fn new(device: Rc<Device>, known: Known) -> Self {
        let info = Arc::new(device.info().clone());
        Self { device, info, known, renderer: None, scatter: None, veil_by: None }
    }

    /// Lets go of what renders, as after a panic in it; the next photo gets another.
    pub fn start_over(&mut self) {
        self.renderer = None;
        self.scatter = None;
    }

    /// From now on veils are summed by this, or, as at first, by what the cost model says is cheaper; a software renderer is never
    /// taken by itself.
    pub fn sum_veils_by(&mut self, processor: Option<Processor>) {
        self.veil_by = processor;
    }

    /// What sums veils, made if need be.
    pub(super) fn scatter(&mut self) -> Result<&mut Scatter> {
        Ok(match &mut self.scatter {
            Some(scatter) => scatter,
            none => none.insert(Scatter::new(&self.device)?),
        })
    }

    /// What renders, made if need be.
    pub(super) fn renderer(&mut self) -> Result<&mut Picture> {
        Ok(match &mut self.renderer {
            Some(renderer) => renderer,
            none => none.insert(Picture::new(&self.device)?),
        })
    }
}
