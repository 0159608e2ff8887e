//! What a plan is made for: what shines, and where it is seen.

mod images;

use std::sync::Arc;

use glam::DVec2;
use rayon::prelude::*;

use crate::frame::Frame;
use crate::reference;
use crate::scene::Ghost;

pub(crate) use images::NOTHING;
pub use images::{Image, Images, Patch, Rims};

/// Ghosts, and the picture on which their glare lies. It never changes: a [plan](crate::plan::Plan) owns the problem that
/// it solves, so that neither a renderer nor a certificate can be given the ghosts of another.
#[derive(Debug, Clone)]
pub struct Problem {
    ghosts: Arc<[Ghost]>,
    images: Option<Arc<Images>>,
    frame: Frame,
}

impl Problem {
    /// The glare of these ghosts at the pixels of the frame's window.
    pub fn new(ghosts: impl Into<Arc<[Ghost]>>, frame: Frame) -> Arc<Self> {
        Arc::new(Self { ghosts: ghosts.into(), images: None, frame })
    }

    /// The glare of these ghosts, and of those that all pixels of a photo make.
    pub fn with_images(ghosts: impl Into<Arc<[Ghost]>>, images: Arc<Images>, frame: Frame) -> Arc<Self> {
        Self::with_some(ghosts.into(), Some(images), frame)
    }

    /// The ghosts, but for those of the photo's pixels; plans name them by their places here.
    pub fn ghosts(&self) -> &[Ghost] {
        &self.ghosts
    }

    /// The ghosts of the photo's pixels, where they make any; plans name them by their places there.
    pub fn images(&self) -> Option<&Images> {
        self.images.as_deref()
    }

    /// The picture, and the pixels at which the glare is wanted.
    pub fn frame(&self) -> Frame {
        self.frame
    }

    /// The same ghosts, and of the images those that are given.
    pub(crate) fn of_images(&self, images: Option<Images>) -> Arc<Self> {
        Self::with_some(self.ghosts.clone(), images.map(Arc::new), self.frame)
    }

    fn with_some(ghosts: Arc<[Ghost]>, images: Option<Arc<Images>>, frame: Frame) -> Arc<Self> {
        let images = images.filter(|images| !images.all().is_empty());
        Arc::new(Self { ghosts, images, frame })
    }

    /// The same sources on another picture, or at other pixels of it.
    pub fn on(&self, frame: Frame) -> Arc<Self> {
        Arc::new(Self { frame, ..self.clone() })
    }

    /// Whether nothing shines.
    pub fn is_dark(&self) -> bool {
        self.ghosts.is_empty() && self.images.is_none()
    }

    /// The field at pixels of the picture, by its definition.
    pub fn truth(&self, pixels: &[[i32; 2]]) -> Vec<[f64; 3]> {
        let points: Vec<DVec2> = pixels.iter().map(|&[i, j]| self.frame.position(f64::from(i), f64::from(j))).collect();
        let mut field = reference::direct_at(&self.ghosts, &points);
        if let Some(images) = &self.images {
            let added = images.at(&points);
            field.par_iter_mut().zip(added).for_each(|(field, added)| {
                field.iter_mut().zip(added).for_each(|(field, added)| *field += added);
            });
        }
        field
    }
}

impl PartialEq for Problem {
    fn eq(&self, other: &Self) -> bool {
        let same = Arc::ptr_eq(&self.ghosts, &other.ghosts) || self.ghosts == other.ghosts;
        let images = match (&self.images, &other.images) {
            (Some(one), Some(other)) => Arc::ptr_eq(one, other) || one == other,
            (None, None) => true,
            _ => false,
        };
        same && images && self.frame == other.frame
    }
}
