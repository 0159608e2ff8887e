//! Panics, turned into errors: what goes wrong with one photo must not take the others along.

use std::any::Any;
use std::collections::VecDeque;
use std::panic::{self, AssertUnwindSafe, PanicHookInfo};
use std::sync::{Mutex, MutexGuard, PoisonError};

use crate::{Error, Result};

/// Panics that are remembered: as many as threads may be at work, as a rule.
const REMEMBERED: usize = 64;
/// Bytes of a panic's own words that are told.
const WORDS: usize = 400;

/// Where the last ones were, and what they said. The hook alone knows the place, and runs on the thread that panics;
/// whoever catches it on another, as behind rayon's, finds it by its words.
static LAST: Mutex<VecDeque<(String, String)>> = Mutex::new(VecDeque::new());

fn last() -> MutexGuard<'static, VecDeque<(String, String)>> {
    LAST.lock().unwrap_or_else(PoisonError::into_inner)
}

/// From now on a panic prints nothing by itself; whoever catches it tells it. With `RUST_BACKTRACE` it is printed, too.
pub fn keep_quiet() {
    let before = panic::take_hook();
    let loud = std::env::var_os("RUST_BACKTRACE").is_some_and(|value| value != "0");
    panic::set_hook(Box::new(move |info| {
        remember(info);
        if loud {
            before(info);
        }
    }));
}

fn remember(info: &PanicHookInfo<'_>) {
    let place = info.location().map(|place| format!("{}:{}", short(place.file()), place.line()));
    let mut last = last();
    last.truncate(REMEMBERED - 1);
    last.push_front((words(info.payload()), place.unwrap_or_default()));
}

/// Does `work`, whose panic becomes its error.
///
/// # Errors
/// Those of `work`, and [`Error::Internal`].
pub fn caught<T>(work: impl FnOnce() -> Result<T>) -> Result<T> {
    // What a panic leaves half done is dropped by the callers, and never looked at.
    panic::catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(|panic| Err(error(&*panic)))
}

/// The error that a panic is told as.
pub fn error(panic: &(dyn Any + Send)) -> Error {
    let words = words(panic);
    let place = last().iter().find(|(said, _)| *said == words).map(|(_, place)| place.clone());
    let what = match place.filter(|place| !place.is_empty()) {
        Some(place) => format!("{place}: {words}"),
        None => words,
    };
    Error::Internal { what }
}

/// What a panic says, in one line.
fn words(panic: &(dyn Any + Send)) -> String {
    let said = panic.downcast_ref::<&str>().copied().or_else(|| panic.downcast_ref::<String>().map(String::as_str));
    let mut words = said.unwrap_or("no reason given").split_whitespace().collect::<Vec<_>>().join(" ");
    words.truncate(words.floor_char_boundary(WORDS));
    words
}

/// A source file's path from its crate's folder on: what comes before tells of the machine that built it.
fn short(file: &str) -> &str {
    let after = |mark: &str| file.split_once(mark).map(|(_, rest)| rest);
    // A registry's own folder comes first.
    let of_registry = after("/registry/src/").and_then(|rest| rest.split_once('/')).map(|(_, rest)| rest);
    of_registry.or_else(|| after("/library/")).or_else(|| after("/build/")).unwrap_or(file)
}

#[cfg(test)]
mod tests {
    use rayon::prelude::*;

    use super::*;

    fn text(work: impl FnOnce() -> Result<()>) -> String {
        caught(work).expect_err("it panics").to_string()
    }

    #[test]
    fn a_panic_becomes_an_error_in_one_line() {
        let said = text(|| panic!("two\n  lines {}", 7));
        assert_eq!(said, "an internal error (two lines 7); please report it");
        assert_eq!(text(|| panic::panic_any(7)), "an internal error (no reason given); please report it");
        let error = caught(|| Err::<(), _>(Error::Cancelled));
        assert!(matches!(error, Err(Error::Cancelled)), "{error:?}");
    }

    #[test]
    fn a_panic_on_a_thread_of_a_pool_is_caught_where_it_is_waited_for() {
        let said = text(|| {
            (0..1000).into_par_iter().for_each(|i| assert!(i != 500, "number {i}"));
            Ok(())
        });
        assert_eq!(said, "an internal error (number 500); please report it");
    }

    #[test]
    fn a_long_reason_is_cut_between_characters() {
        let said = text(|| panic!("{}", "é".repeat(1000)));
        assert!(said.len() < 500 && said.contains('é'), "{said}");
    }

    #[test]
    fn places_do_not_tell_who_built_it() {
        for (file, expected) in [
            ("src/scene/find.rs", "src/scene/find.rs"),
            ("/home/a/.cargo/registry/src/index.crates.io-1949/exr-1.74.0/src/lib.rs", "exr-1.74.0/src/lib.rs"),
            ("/rustc/0123/library/core/src/option.rs", "core/src/option.rs"),
            ("/home/a/target/debug/build/egl_sys-01/out/egl.rs", "egl_sys-01/out/egl.rs"),
        ] {
            assert_eq!(short(file), expected);
        }
    }
}
