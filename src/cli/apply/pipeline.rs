//! Three steps for each of many things, one after the other or side by side.

use std::ops::ControlFlow;
use std::sync::mpsc::sync_channel;
use std::thread;

use crate::{Error, Result};

/// Takes `count` things through three steps, in order, until the last step breaks it off.
///
/// Side by side, the first and the last step have a thread each, and the middle one, which may hold what must not change
/// threads, stays on this one: while it works on a thing, the next is in the first step and the one before in the last.
/// A step hands on what it has done only when the next step is free for it, so that no more than three things are there
/// at any time.
///
/// `prepare` makes what the middle step works with, while the first thing is in the first step already.
///
/// # Errors
/// That of `prepare`.
pub fn run<S, A: Send, B: Send>(
    count: usize,
    side_by_side: bool,
    first: impl Fn(usize) -> A + Send,
    prepare: impl FnOnce() -> Result<S>,
    mut middle: impl FnMut(&mut S, A) -> B,
    mut last: impl FnMut(B) -> ControlFlow<()> + Send,
) -> Result<()> {
    if !side_by_side {
        let mut tool = prepare()?;
        let _ = (0..count).try_for_each(|index| last(middle(&mut tool, first(index))));
        return Ok(());
    }
    thread::scope(|scope| {
        // Both hand over from hand to hand: what waited in between would be one more thing in memory.
        let (give, take) = sync_channel(0);
        let (pass_on, finish) = sync_channel(0);
        // Each ends when the other end of its channel is gone, be it by an error or a panic.
        thread::Builder::new()
            .name("read".into())
            .spawn_scoped(scope, move || (0..count).try_for_each(|index| give.send(first(index))))
            .map_err(Error::threads)?;
        thread::Builder::new()
            .name("write".into())
            .spawn_scoped(scope, move || finish.into_iter().try_for_each(&mut last))
            .map_err(Error::threads)?;
        let mut tool = prepare()?;
        let _ = take.into_iter().try_for_each(|thing| pass_on.send(middle(&mut tool, thing)));
        Ok(())
    })
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicUsize, Ordering};

    use super::*;
    use crate::Error;

    /// Something that knows how many of it there are.
    struct Counted<'a>(usize, &'a [AtomicUsize; 2]);

    impl<'a> Counted<'a> {
        fn new(index: usize, counts: &'a [AtomicUsize; 2]) -> Self {
            let now = counts[0].fetch_add(1, Ordering::SeqCst) + 1;
            counts[1].fetch_max(now, Ordering::SeqCst);
            Self(index, counts)
        }
    }

    impl Drop for Counted<'_> {
        fn drop(&mut self) {
            self.1[0].fetch_sub(1, Ordering::SeqCst);
        }
    }

    #[test]
    fn all_go_through_in_order_and_few_are_there_at_once() {
        for (side_by_side, most) in [(false, 1), (true, 3)] {
            let counts = [const { AtomicUsize::new(0) }; 2];
            let mut seen = Vec::new();
            let first = |index| Counted::new(index, &counts);
            let last = |thing: Counted<'_>| {
                seen.push(thing.0);
                ControlFlow::Continue(())
            };
            run(50, side_by_side, first, || Ok(()), |(), thing| thing, last).unwrap();
            assert_eq!(seen, (0..50).collect::<Vec<_>>());
            assert!(counts[1].load(Ordering::SeqCst) <= most, "{counts:?}");
        }
    }

    #[test]
    fn the_last_step_may_break_it_off() {
        for side_by_side in [false, true] {
            let begun = AtomicUsize::new(0);
            let first = |index| {
                begun.fetch_add(1, Ordering::SeqCst);
                index
            };
            let last = |index| if index == 3 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) };
            run(1000, side_by_side, first, || Ok(()), |(), index| index, last).unwrap();
            assert!(begun.load(Ordering::SeqCst) <= 7, "{begun:?}");
        }
    }

    #[test]
    fn what_cannot_be_prepared_ends_it() {
        for side_by_side in [false, true] {
            let prepare = || Err::<(), _>(Error::Gl("lost".into()));
            let last = |_: usize| panic!("nothing comes this far");
            let result = run(1000, side_by_side, |index| index, prepare, |(), index| index, last);
            assert!(matches!(result, Err(Error::Gl(_))));
        }
    }

    #[test]
    fn a_panic_in_any_step_ends_it_all() {
        for bad in 0..3 {
            let fail = move |step| assert!(step != bad, "as meant");
            let whole = move || {
                let first = |index| {
                    if index == 5 {
                        fail(0)
                    }
                };
                let last = |()| {
                    fail(2);
                    ControlFlow::Continue(())
                };
                run(1000, true, first, || Ok(()), |(), ()| fail(1), last)
            };
            assert!(std::panic::catch_unwind(whole).is_err(), "step {bad}");
        }
    }
}
