//! Signals that end the program: nothing half-written is left behind then.

/// Has signals take the files along that are being written, from now on.
///
/// Whoever sent a signal sees the program end by that signal, as if it had done nothing about it; one that the program was
/// started to ignore (`nohup`) stays ignored. Where a file would become larger than the system lets it be (`ulimit -f`),
/// that is an error of writing and not the program's end. What no program hears of, as `kill -9`, leaves files that the
/// next run in their folder removes: see [`crate::target::part`].
#[cfg(unix)]
pub fn listen() {
    use std::sync::Arc;

    use signal_hook::consts::{SIGHUP, SIGINT, SIGQUIT, SIGTERM, SIGXCPU, SIGXFSZ};
    use signal_hook::iterator::Signals;
    use signal_hook::low_level::emulate_default_handler;

    // Someone hears it, so that it does not end the program; the system call then fails, which is all that matters.
    let _ = signal_hook::flag::register(SIGXFSZ, Arc::default());
    let ignored = ignored();
    let ends =
        [SIGHUP, SIGINT, SIGQUIT, SIGTERM, SIGXCPU].into_iter().filter(|signal| ignored >> (signal - 1) & 1 == 0);
    // Without a thread for it, signals do what they always do.
    let Ok(mut signals) = Signals::new(ends) else { return };
    let handle = signals.handle();
    let watch = move || {
        if let Some(signal) = signals.forever().next() {
            let _held = crate::target::part::remove_all();
            let _ = emulate_default_handler(signal);
            std::process::exit(128 + signal);
        }
    };
    if std::thread::Builder::new().name("signals".into()).spawn(watch).is_err() {
        handle.close();
    }
}

/// The signals that this process was started to ignore, a bit each; none where the system does not tell.
#[cfg(unix)]
fn ignored() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0)
}

#[cfg(not(unix))]
pub fn listen() {}
