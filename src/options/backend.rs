//! Where OpenGL comes from.

use crate::gpu::Backend;

/// `--backend`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum BackendChoice {
    /// The first that gives OpenGL 4.3
    Auto,
    /// EGL, on a graphics card or Mesa's software renderer
    Egl,
    /// OSMesa, Mesa's software renderer in memory
    #[value(name = "osmesa")]
    OsMesa,
}

impl BackendChoice {
    /// The backends to try, in order.
    pub fn backends(self) -> &'static [Backend] {
        match self {
            Self::Auto => &Backend::ALL,
            Self::Egl => &[Backend::Egl],
            Self::OsMesa => &[Backend::OsMesa],
        }
    }
}
