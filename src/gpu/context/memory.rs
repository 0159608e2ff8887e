//! Memory that drivers take, where it is limited.

use crate::{Result, limits};

/// What opening a context takes, bytes: Mesa's libraries and LLVM's, mapped, what they set up, and the stacks of two
/// threads for each core, of at most 16 (Mesa 22.3 with LLVM 15: 250 MiB in all on 2 cores, 350 on 8).
fn opening() -> u64 {
    (224 << 20) + (16 << 20) * limits::cores().min(16) as u64
}

/// Where memory is limited, makes all threads share one arena of the allocator. Each reserves 64 MiB of addresses
/// otherwise (glibc), which count as if they were used.
pub fn be_sparing() {
    #[cfg(all(target_os = "linux", target_env = "gnu"))]
    if limits::memory_is_limited() {
        // It fails for an unknown parameter only.
        // SAFETY: it takes two numbers, and sets the allocator's own under the allocator's lock.
        unsafe { libc::mallopt(libc::M_ARENA_MAX, 1) };
    }
}

/// Whether there is room to open a context, and are threads for its driver.
///
/// # Errors
/// [`crate::Error::Memory`], [`crate::Error::Threads`]
pub(super) fn room_to_open() -> Result<()> {
    limits::room(opening(), "a graphics driver")?;
    limits::threads_for_driver()
}
