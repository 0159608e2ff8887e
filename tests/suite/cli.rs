//! The program as a user runs it: what it writes, what it says, what it exits with.

mod animate;
mod bad_input;
mod calibrate;
mod each_pixel;
mod environment;
mod exr;
mod extremes;
mod harmonics;
mod interrupted;
mod lens;
mod lights;
mod look;
mod luminance;
mod measure;
mod outputs;
mod panics;
mod pipes;
mod plan;
mod preset_veils;
mod real_lens;
mod recover;
mod refusals;
mod remove;
mod report;
mod rex;
mod scarce;
mod sequence;
mod shots;
mod tables;
mod targets;
mod terminal;
mod tradeoff;
mod unchanged;
mod units;
mod veil;
mod veil_told;
mod view;
mod whole;

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::Value;
use tempfile::TempDir;
use vglare::photo::{self, Photo, WriteOptions};

/// A folder of its own for each test.
struct Workplace {
    folder: TempDir,
}

impl Workplace {
    fn new() -> Self {
        Self { folder: TempDir::new().expect("a temporary folder") }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// A small night scene: a lamp upper right, a weaker one lower left, a dim gradient.
    fn photo(&self, name: &str) -> PathBuf {
        self.write(name, &night())
    }

    fn write(&self, name: &str, photo: &Photo) -> PathBuf {
        let path = self.path(name);
        photo::write(&path, photo, &WriteOptions { overwrite: true, ..WriteOptions::default() }).expect("a photo");
        path
    }

    fn text(&self, name: &str, text: &str) -> PathBuf {
        let path = self.path(name);
        std::fs::write(&path, text).expect("a file");
        path
    }

    /// Runs the program in this folder.
    fn vglare(&self, args: &[&str]) -> Ran {
        Ran(self.command(args).output().expect("the program runs"))
    }

    /// The program, in this folder, which has the cache as well: the user's own is left alone.
    fn command(&self, args: &[&str]) -> Command {
        let mut command = Command::new(Path::new(env!("CARGO_BIN_EXE_vglare")));
        command.args(args).current_dir(self.folder.path()).env("VGLARE_CACHE", self.path("cache"));
        command
    }

    /// What the program printed as JSON.
    fn json(&self, args: &[&str]) -> Value {
        serde_json::from_str(&self.vglare(args).succeeded().stdout()).expect("JSON")
    }

    /// A file of JSON.
    fn read_json(&self, name: &str) -> Value {
        serde_json::from_str(&std::fs::read_to_string(self.path(name)).expect("a file")).expect("JSON")
    }

    /// The names of all files.
    fn files(&self) -> Vec<String> {
        let entries = std::fs::read_dir(self.folder.path()).expect("the folder");
        let mut names: Vec<_> =
            entries.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }
}

/// What the program did.
struct Ran(Output);

impl Ran {
    fn code(&self) -> Option<i32> {
        self.0.status.code()
    }

    fn stdout(&self) -> String {
        String::from_utf8_lossy(&self.0.stdout).into_owned()
    }

    fn stderr(&self) -> String {
        String::from_utf8_lossy(&self.0.stderr).into_owned()
    }

    #[track_caller]
    fn succeeded(self) -> Self {
        assert_eq!(self.code(), Some(0), "{}{}", self.stdout(), self.stderr());
        self
    }

    /// Failed with this code, in words, and without a panic.
    #[track_caller]
    fn failed(self, code: i32, words: &[&str]) -> Self {
        let said = self.stderr();
        assert_eq!(self.code(), Some(code), "{said}");
        for word in words {
            assert!(said.contains(word), "{word:?} is not in: {said}");
        }
        assert!(!said.contains("panicked"), "{said}");
        self
    }
}

fn night() -> Photo {
    let (width, height) = (96, 64);
    let mut pixels: Vec<[f32; 4]> =
        (0..width * height).map(|k| [0.02, 0.02 + 1e-4 * (k % width) as f32, 0.03, 1.0]).collect();
    for (column, row, light) in [
        (70, 12, [900.0, 700.0, 400.0]),
        (71, 12, [800.0, 650.0, 300.0]),
        (20, 50, [60.0, 90.0, 200.0]),
        (21, 50, [0.6, 0.9, 2.0]),
    ] {
        pixels[row * width + column] = [light[0], light[1], light[2], 1.0];
    }
    Photo::new(width as u32, height as u32, pixels)
}
