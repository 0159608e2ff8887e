//! A line that says what goes on, on a terminal, when it takes longer than a second.

use std::thread;
use std::time::Duration;

use indicatif::{FormattedDuration, ProgressBar, ProgressDrawTarget, ProgressStyle};

use crate::job::{Step, Watch};
use crate::printable;

const PATIENCE: Duration = Duration::from_secs(1);
const TICK: Duration = Duration::from_millis(100);
/// Steps of a bar.
const PARTS: f64 = 1000.0;

/// Something that takes as long as it takes, and something that can be counted.
const STEP: &str = "{spinner} {msg} {elapsed}";
const MEASURED: &str = "{spinner} {msg} {wide_bar} {percent} % {elapsed}";

fn style(template: &str) -> ProgressStyle {
    ProgressStyle::with_template(template).expect("the template is sound")
}

/// The line; gone when dropped.
pub struct Progress {
    bar: ProgressBar,
}

impl Progress {
    /// Starts it, hidden at first; `quiet` keeps it hidden.
    pub fn start(quiet: bool) -> Self {
        let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::hidden());
        bar.set_style(style(STEP));
        if !quiet {
            let shown = bar.downgrade();
            let show = move || {
                thread::sleep(PATIENCE);
                // Gone by now, if the work was.
                if let Some(bar) = shown.upgrade() {
                    bar.set_draw_target(ProgressDrawTarget::stderr());
                }
                while let Some(bar) = shown.upgrade() {
                    bar.tick();
                    drop(bar);
                    thread::sleep(TICK);
                }
            };
            // Where the system gives no thread, the work goes on without the line.
            let _ = thread::Builder::new().name("progress".into()).spawn(show);
        }
        Self { bar }
    }

    /// From now on shows how much of `total` is done.
    pub fn measured(&self, total: usize) {
        self.bar.set_style(style(MEASURED));
        self.bar.set_length(total as u64);
    }

    /// So much more is done.
    pub fn advance(&self, by: usize) {
        self.bar.inc(by as u64);
    }

    /// Says what goes on now.
    pub fn say(&self, what: impl AsRef<str>) {
        self.bar.set_style(style(STEP));
        self.bar.set_message(printable::line(what.as_ref()));
    }

    /// Takes the line away while `print` prints.
    pub fn aside<T>(&self, print: impl FnOnce() -> T) -> T {
        self.bar.suspend(print)
    }

    /// Says how many of `total` are `done`, `since` of which the time has passed; how many that is a second, and how long the others will
    /// take at that.
    pub fn counted(&self, noun: &str, [done, since, total]: [usize; 3], passed: Duration) {
        let pace = since as f64 / passed.as_secs_f64();
        let mut what = format!("{done} of {total} {noun}");
        if since > 0 && done < total && pace.is_finite() {
            let left = FormattedDuration(passed.mul_f64((total - done) as f64 / since as f64));
            what += &format!(", {} a second, {left} left", super::digits(pace));
        }
        self.part(what, done as f64 / total.max(1) as f64);
    }

    /// Says what goes on now, and how much of all is done, from 0 to 1.
    pub fn part(&self, what: impl AsRef<str>, done: f64) {
        if self.bar.length().is_none() {
            let template = "{spinner} {bar:30} {msg} {elapsed}";
            self.bar.set_style(ProgressStyle::with_template(template).expect("the template is sound"));
            self.bar.set_length(PARTS as u64);
        }
        self.bar.set_position((done * PARTS) as u64);
        self.bar.set_message(printable::line(what.as_ref()));
    }
}

impl Watch for Progress {
    fn step(&self, step: Step) {
        self.say(step.to_string());
    }

    fn measured(&self, pixels: usize) {
        self.measured(pixels);
    }

    fn advance(&self, pixels: usize) {
        self.advance(pixels);
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
