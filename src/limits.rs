//! What the system lets the program have: memory where `ulimit -v` or `-d` limits it, and threads.
//!
//! Drivers and compilers do not survive an allocation that fails, and some wait for ever for a thread that was never
//! started. So both are looked after beforehand. Nothing is looked up where there is no limit of memory.

use std::sync::OnceLock;
use std::sync::mpsc::channel;
use std::thread;
use std::time::Duration;

use crate::{Error, Result};

/// What is left free for all the small things that nobody counts.
const SPARE: u64 = 24 << 20;

/// The stack of a thread that only shows that there can be one.
const SMALL_STACK: usize = 64 << 10;
/// Threads besides rayon's and the driver's: those that read and write, and the progress line's.
const OWN_THREADS: usize = 4;

/// The address space and the data that a process may have, bytes; none where that is not limited.
#[derive(Debug, Clone, Copy, Default)]
struct Memory {
    space: Option<u64>,
    data: Option<u64>,
}

impl Memory {
    fn limits() -> Self {
        static LIMITS: OnceLock<Memory> = OnceLock::new();
        *LIMITS.get_or_init(Self::ask)
    }

    #[cfg(target_os = "linux")]
    fn ask() -> Self {
        use rustix::process::{Resource, getrlimit};
        Self { space: getrlimit(Resource::As).current, data: getrlimit(Resource::Data).current }
    }

    #[cfg(not(target_os = "linux"))]
    fn ask() -> Self {
        Self::default()
    }

    /// Bytes left of the tighter limit, and that limit, where this process has taken what `status` says of it.
    fn left(self, status: &str) -> Option<(u64, u64)> {
        let taken = |name: &str| {
            let line = status.lines().find_map(|line| line.strip_prefix(name))?;
            line.trim().strip_suffix(" kB")?.trim().parse::<u64>().ok().map(|kib| kib << 10)
        };
        let left = |limit: Option<u64>, name| limit.and_then(|limit| Some((limit.saturating_sub(taken(name)?), limit)));
        [left(self.space, "VmSize:"), left(self.data, "VmData:")].into_iter().flatten().min()
    }
}

/// Whether the program's memory is limited, so that it has to be looked after.
pub fn memory_is_limited() -> bool {
    let Memory { space, data } = Memory::limits();
    space.is_some() || data.is_some()
}

/// Whether there is room for so many bytes, which `what` wants.
///
/// # Errors
/// [`Error::Memory`]. Where there is no limit, there never is one.
pub fn room(bytes: u64, what: &str) -> Result<()> {
    if !memory_is_limited() {
        return Ok(());
    }
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    enough(Memory::limits().left(&status), bytes, what)
}

fn enough(left: Option<(u64, u64)>, bytes: u64, what: &str) -> Result<()> {
    match left {
        Some((left, limit)) if left < bytes.saturating_add(SPARE) => {
            let [left, limit, bytes] = [left, limit, bytes.saturating_add(SPARE)].map(|bytes| bytes >> 20);
            let reason = format!("the limit of {limit} MiB leaves {left}, and {what} needs {bytes}");
            Err(Error::Memory { reason })
        }
        _ => Ok(()),
    }
}

/// How many of `wanted` threads the system starts beside those that there are.
fn startable(wanted: usize) -> usize {
    let before = threads();
    let (hold, held) = channel::<()>();
    let held = std::sync::Arc::new(std::sync::Mutex::new(held));
    let start = |_| {
        let held = held.clone();
        // Each ends when `hold` is gone.
        let wait = move || drop(held.lock().map(|held| held.recv()));
        thread::Builder::new().stack_size(SMALL_STACK).spawn(wait).ok()
    };
    let started: Vec<_> = (0..wanted).map_while(start).collect();
    let count = started.len();
    drop(hold);
    started.into_iter().for_each(|thread| drop(thread.join()));
    // A thread that has been waited for counts until the system has put it away.
    for _ in 0..100 {
        if threads() <= before {
            break;
        }
        thread::sleep(Duration::from_millis(1));
    }
    count
}

/// How many threads there are, where the system says so.
fn threads() -> usize {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    status.lines().find_map(|line| line.strip_prefix("Threads:")?.trim().parse().ok()).unwrap_or(0)
}

/// How many threads of its own a software renderer starts: two for each core, of at most 16, and some (Mesa 22.3).
fn driver_threads() -> usize {
    2 * cores().min(16) + 3
}

/// How many threads can run at a time, as far as it is known.
pub fn cores() -> usize {
    thread::available_parallelism().map_or(1, usize::from)
}

/// Makes rayon's pool, of fewer threads where the system gives few. It is otherwise made when it is first used, and there
/// is no way to go on then.
///
/// # Errors
/// [`Error::Threads`] where there is none at all.
pub fn start_pool() -> Result<()> {
    let wanted = cores() + OWN_THREADS + driver_threads();
    let given = startable(wanted);
    if given == wanted {
        return Ok(());
    }
    let own = given.saturating_sub(driver_threads() + OWN_THREADS).max(1);
    // One that is there already is as good.
    match rayon::ThreadPoolBuilder::new().num_threads(own).build_global() {
        Err(error) if given == 0 => Err(Error::threads(error)),
        _ => Ok(()),
    }
}

/// Whether a graphics driver will get its threads.
///
/// # Errors
/// [`Error::Threads`]
pub fn threads_for_driver() -> Result<()> {
    let wanted = driver_threads();
    let given = startable(wanted);
    if given == wanted {
        return Ok(());
    }
    Err(Error::threads(format!("the system gives {given} more, and a graphics driver may start {wanted}")))
}

#[cfg(test)]
mod tests {
    use super::*;

    const STATUS: &str =
        "Name:\tvglare\nVmPeak:\t  999999 kB\nVmSize:\t  102400 kB\nVmData:\t   51200 kB\nThreads:\t3\n";

    #[test]
    fn what_is_left_is_that_of_the_tighter_limit() {
        let mib = |mib: u64| mib << 20;
        for (space, data, left) in [
            (None, None, None),
            (Some(mib(300)), None, Some((mib(200), mib(300)))),
            (Some(mib(300)), Some(mib(60)), Some((mib(10), mib(60)))),
            (Some(mib(50)), None, Some((0, mib(50)))),
        ] {
            assert_eq!(Memory { space, data }.left(STATUS), left);
        }
        assert_eq!(Memory { space: Some(1), data: Some(1) }.left(""), None, "a system that does not say");
    }

    #[test]
    fn what_does_not_fit_is_refused_with_figures() {
        assert!(enough(None, u64::MAX, "all").is_ok());
        assert!(enough(Some((SPARE + 10, 1 << 40)), 10, "it").is_ok());
        let refused = enough(Some((30 << 20, 400 << 20)), 32 << 20, "a texture").expect_err("it does not fit");
        let said = "not enough memory: the limit of 400 MiB leaves 30, and a texture needs 56";
        assert_eq!(refused.to_string(), said);
        assert!(enough(Some((1 << 40, 1 << 40)), u64::MAX, "all").is_err());
    }

    #[test]
    fn threads_that_were_tried_are_gone() {
        assert_eq!(startable(5), 5);
    }
}
