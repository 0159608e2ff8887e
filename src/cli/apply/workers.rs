//! Several processes that share a sequence: contexts of OpenGL on two threads of one can end it, and what ends one process leaves the
//! others alone.
//!
//! Each is this program with the same command line and a [`Part`] of the photos. It tells what becomes of each of them by a line of JSON,
//! and ends when this process does, whose end of its standard input is closed then.

use std::collections::HashMap;
use std::io::{BufRead as _, BufReader};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::str::FromStr;
use std::sync::mpsc::{Sender, channel};
use std::thread;

use serde::{Deserialize, Serialize};

use super::Args;
use super::outputs::{Paths, Sequence};
use super::sequence::Hears;
use super::tally::Tally;
use super::told::Told;
use crate::shot::ledger::Entry;
use crate::terminal::progress::Progress;
use crate::terminal::{signals, stdout};
use crate::{Error, Result, limits};

/// Every `count`th photo, from the one at `index` on.
#[derive(Debug, Clone, Copy)]
pub struct Part {
    index: usize,
    count: usize,
}

impl Part {
    /// All photos.
    pub const ALL: Self = Self { index: 0, count: 1 };

    /// The photos of this part: neighbours go to different ones, so that all come to an end together.
    pub fn of(self, photos: &[Paths]) -> impl Iterator<Item = &Paths> {
        photos.iter().skip(self.index).step_by(self.count)
    }
}

impl FromStr for Part {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers = text.split_once('/').and_then(|(index, count)| Some((index.parse().ok()?, count.parse().ok()?)));
        let part = numbers.filter(|(index, count): &(usize, usize)| index < count);
        part.map(|(index, count)| Self { index, count }).ok_or_else(|| "expected INDEX/COUNT".into())
    }
}

/// What becomes of a photo.
#[derive(Serialize, Deserialize)]
enum Fate {
    Done(Told),
    Skipped(Entry),
    Failed { reason: String, code: u8 },
}

#[derive(Serialize, Deserialize)]
struct Message {
    /// Its place among all.
    photo: PathBuf,
    fate: Fate,
}

/// This process, where it is one of several.
pub struct Worker<'a> {
    args: &'a Args,
}

impl<'a> Worker<'a> {
    pub fn new(args: &'a Args) -> Self {
        // Without a thread for it, it ends with the next line that nobody reads.
        let _ = signals::end_with_parent();
        Self { args }
    }

    fn say(&self, photo: &Path, fate: Fate) -> ControlFlow<()> {
        let failed = matches!(fate, Fate::Failed { .. });
        let said = stdout::json(|out| {
            serde_json::to_writer(&mut *out, &Message { photo: photo.to_owned(), fate })?;
            out.write_all(b"\n")
        });
        if said.is_err() || failed && !self.args.sequence.keep_going {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    }
}

impl Hears for Worker<'_> {
    fn skipped(&mut self, photo: &Path, entry: &Entry) {
        let _ = self.say(photo, Fate::Skipped(entry.clone()));
    }

    fn done(&mut self, photo: &Path, told: Result<Told>) -> ControlFlow<()> {
        self.say(
            photo,
            match told {
                Ok(told) => Fate::Done(told),
                Err(error) => {
                    let error = error.in_frame(photo);
                    Fate::Failed { reason: error.to_string(), code: error.exit_code() }
                }
            },
        )
    }
}

/// Has processes do the photos of a sequence, and tells what becomes of them.
///
/// # Errors
/// Those of [`Tally::finish`]; [`Error::Threads`] where a process cannot be started.
pub fn run(args: &Args, sequence: &Sequence) -> Result<()> {
    // What is wrong with it is told once.
    args.look()?;
    let progress = Progress::start(args.quiet);
    let mut tally = Tally::new(args, sequence, &progress);
    tally.lack(&sequence.missing);
    let count = (args.sequence.jobs as usize).min(sequence.frames.len().max(1));
    let mut workers = Vec::new();
    let mut open: HashMap<&Path, usize> = HashMap::new();
    let (send, heard) = channel();
    for index in 0..count {
        let part = Part { index, count };
        open.extend(part.of(&sequence.frames).map(|paths| (paths.input.as_path(), index)));
        workers.push(start(part, send.clone())?);
    }
    drop(send);
    let mut broken = false;
    for Message { photo, fate } in heard {
        if broken || open.remove(photo.as_path()).is_none() {
            continue;
        }
        let next = match fate {
            Fate::Done(told) => tally.done(&photo, Ok(told)),
            Fate::Skipped(entry) => {
                tally.skipped(&photo, &entry);
                ControlFlow::Continue(())
            }
            Fate::Failed { reason, code } => tally.done(&photo, Err(Error::Worker { reason, code })),
        };
        if next.is_break() {
            broken = true;
            // Each ends when this is closed.
            workers.iter_mut().for_each(|worker| drop(worker.stdin.take()));
        }
    }
    let ends = workers.into_iter().map(|mut worker| {
        let ended = worker.wait();
        ended.map_or_else(|error| error.to_string(), |status| status.to_string())
    });
    let ends: Vec<String> = ends.collect();
    for paths in &sequence.frames {
        let Some(&index) = open.get(paths.input.as_path()).filter(|_| !broken) else { continue };
        let reason = format!("{}: its process ended before it was done ({})", paths.input.display(), ends[index]);
        broken = tally.done(&paths.input, Err(Error::Worker { reason, code: 1 })).is_break();
    }
    tally.finish()
}

/// Starts a process for a part, and hands on what it says.
fn start(part: Part, send: Sender<Message>) -> Result<Child> {
    let mut words = std::env::args_os().skip(1);
    let threads = limits::cores().div_ceil(part.count).to_string();
    let mut command = Command::new(std::env::current_exe().map_err(Error::threads)?);
    command.args(words.next()).arg(format!("--among={}/{}", part.index, part.count)).args(words);
    // Its own and those of Mesa's software renderer.
    command.env("RAYON_NUM_THREADS", &threads).env("LP_NUM_THREADS", &threads);
    let mut child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().map_err(Error::threads)?;
    let said = child.stdout.take().expect("it is piped");
    let listen = move || {
        let lines = BufReader::new(said).lines().map_while(Result::ok);
        // Who no longer listens has closed the other end as well.
        lines.filter_map(|line| serde_json::from_str(&line).ok()).for_each(|message| drop(send.send(message)));
    };
    thread::Builder::new().name("worker".into()).spawn(listen).map_err(Error::threads)?;
    Ok(child)
}
