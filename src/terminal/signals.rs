//! Signals that end the program: nothing half-written is left behind then, and it is told how to go on.

use std::io::{IsTerminal as _, Write as _};
use std::sync::{Mutex, PoisonError};

/// What is told last where a signal ends the program.
static LAST_WORDS: Mutex<Option<String>> = Mutex::new(None);

/// From now on this is told where a signal ends the program, or nothing.
pub fn set_last_words(words: Option<String>) {
    *LAST_WORDS.lock().unwrap_or_else(PoisonError::into_inner) = words;
}

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
            say_last_words();
            let _ = emulate_default_handler(signal);
            std::process::exit(128 + signal);
        }
    };
    if std::thread::Builder::new().name("signals".into()).spawn(watch).is_err() {
        handle.close();
    }
}

/// From now on the program ends, as by a signal, when whoever holds the other end of its standard input does.
///
/// # Errors
/// Where the system gives no thread.
pub fn end_with_parent() -> std::io::Result<()> {
    let watch = || {
        let _ = std::io::copy(&mut std::io::stdin().lock(), &mut std::io::sink());
        let _held = crate::target::part::remove_all();
        end();
    };
    std::thread::Builder::new().name("parent".into()).spawn(watch).map(drop)
}

#[cfg(unix)]
fn end() {
    let _ = signal_hook::low_level::emulate_default_handler(signal_hook::consts::SIGTERM);
}

#[cfg(not(unix))]
fn end() {
    std::process::exit(1);
}

/// Says them, unless that takes longer than a moment, as where nobody reads what is told.
#[cfg(unix)]
fn say_last_words() {
    let Some(words) = LAST_WORDS.try_lock().ok().and_then(|mut words| words.take()) else { return };
    let (said, heard) = std::sync::mpsc::channel();
    let say = move || {
        // In place of the line that says how far it is.
        if std::io::stderr().is_terminal() {
            let _ = write!(std::io::stderr(), "\r\x1b[2K");
        }
        super::stderr::tell(words);
        let _ = said.send(());
    };
    if std::thread::Builder::new().name("last words".into()).spawn(say).is_ok() {
        let _ = heard.recv_timeout(std::time::Duration::from_millis(500));
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
