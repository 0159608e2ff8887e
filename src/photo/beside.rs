//! What OpenEXR files hold beside a picture: layers and parts, and how it was made.

use serde::Serialize;

/// How a picture was made: the attributes `vglare.version`, `vglare.settings` and `vglare.look` of OpenEXR.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Made {
    /// Of vglare.
    pub version: String,
    /// The look as a scene file has it, in TOML.
    pub settings: String,
    /// What tells one look from another: sixteen digits, the same for the same settings.
    pub look: String,
}

impl Made {
    /// By this version of vglare, by settings in TOML.
    pub fn new(settings: &str) -> Self {
        // FNV-1a of 64 bits: http://www.isthe.com/chongo/tech/comp/fnv. It is to be the same for ever, and keeps nobody out.
        let mix = |hash: u64, byte: &u8| (hash ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3);
        let look = settings.as_bytes().iter().fold(0xcbf2_9ce4_8422_2325, mix);
        Self { version: env!("CARGO_PKG_VERSION").into(), settings: settings.into(), look: format!("{look:016x}") }
    }
}

/// A layer beside a picture: the channels `NAME.R`, `NAME.G` and `NAME.B` in 32-bit floats, in place of those that the photo's file had.
#[derive(Debug, Clone, PartialEq)]
pub struct Beside {
    /// NAME.
    pub name: &'static str,
    /// RGB, as many as the picture's, in the same order; the fourth is not written.
    pub pixels: Vec<[f32; 4]>,
}

/// A part of an OpenEXR file.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Part {
    /// Its name.
    pub name: Option<String>,
    /// What its channels are called.
    pub channels: Vec<String>,
    /// Their layers: what the channels' names begin with, each once; empty where that is nothing.
    pub layers: Vec<String>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_are_told_apart_by_fnv_1a() {
        // The test vectors of its authors, for "" and for "foobar".
        assert_eq!(Made::new("").look, "cbf29ce484222325");
        assert_eq!(Made::new("foobar").look, "85944171f73967e8");
    }
}
