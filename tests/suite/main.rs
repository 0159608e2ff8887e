//! vglare's promises, one module each.

mod scene;
