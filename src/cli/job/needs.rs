//! What a task needs of the machine that it runs on.

/// Beside its photos: the program, a driver, shaders, and what planning takes of any photo.
const BASE: u64 = 512 << 20;
/// Of each pixel, in bytes: three photos of 16 in the pipeline, one as it shines, the layers of a veil, the transform that planning
/// looks at, and a file's bytes on both sides. Three frames through the default lens on Mesa's software renderer, whose textures are
/// memory too, took 800 MiB of 1920 × 1080 and 2180 MiB of 3840 × 2160 at most.
const PIXEL: u64 = 256;
/// Pixels to a core, where the CPUs render.
const CORE: usize = 500_000;

/// What a task asks for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Needs {
    pub cores: u32,
    /// In MiB.
    pub memory: u32,
    /// Whether it asks for a graphics card.
    pub gpu: bool,
}

impl Needs {
    /// For photos of so many pixels, where that is known.
    pub fn new(pixels: Option<usize>, gpu: bool) -> Self {
        let memory = pixels.map_or(4096, |pixels| (BASE + PIXEL * pixels as u64).div_ceil(1 << 20));
        let cores = match pixels {
            Some(pixels) if !gpu => pixels.div_ceil(CORE).clamp(2, 16) as u32,
            None if !gpu => 4,
            _ => 2,
        };
        Self { cores, memory: memory.try_into().unwrap_or(u32::MAX), gpu }
    }

    /// The same, with what a person says instead.
    pub fn given(self, cores: Option<u32>, memory: Option<u32>) -> Self {
        Self { cores: cores.unwrap_or(self.cores), memory: memory.unwrap_or(self.memory), ..self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rule_is_what_the_help_says() {
        let needs = |pixels, gpu| Needs::new(pixels, gpu);
        assert_eq!(needs(Some(1920 * 1080), false), Needs { cores: 5, memory: 1019, gpu: false });
        assert_eq!(needs(Some(3840 * 2160), true), Needs { cores: 2, memory: 2537, gpu: true });
        assert_eq!(needs(Some(96 * 54), false).cores, 2);
        assert_eq!(needs(Some(16384 * 16384), false).cores, 16);
        assert_eq!(needs(None, false).given(None, Some(100)), Needs { cores: 4, memory: 100, gpu: false });
    }
}
