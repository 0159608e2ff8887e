//! What a plan is made for: what shines, and where it is seen.

use std::sync::Arc;

use crate::frame::Frame;
use crate::scene::Ghost;

/// Ghosts, and the picture on which their glare lies. It never changes: a [plan](crate::plan::Plan) owns the problem that
/// it solves, so that neither a renderer nor a certificate can be given the ghosts of another.
#[derive(Debug, Clone)]
pub struct Problem {
    ghosts: Arc<[Ghost]>,
    frame: Frame,
}

impl Problem {
    /// The glare of these ghosts at the pixels of the frame's window.
    pub fn new(ghosts: impl Into<Arc<[Ghost]>>, frame: Frame) -> Arc<Self> {
        Arc::new(Self { ghosts: ghosts.into(), frame })
    }

    /// The ghosts; plans name them by their places here.
    pub fn ghosts(&self) -> &[Ghost] {
        &self.ghosts
    }

    /// The picture, and the pixels at which the glare is wanted.
    pub fn frame(&self) -> Frame {
        self.frame
    }

    /// The same ghosts on another picture, or at other pixels of it.
    pub fn on(&self, frame: Frame) -> Arc<Self> {
        Arc::new(Self { ghosts: self.ghosts.clone(), frame })
    }
}

impl PartialEq for Problem {
    fn eq(&self, other: &Self) -> bool {
        let same = Arc::ptr_eq(&self.ghosts, &other.ghosts) || self.ghosts == other.ghosts;
        same && self.frame == other.frame
    }
}
