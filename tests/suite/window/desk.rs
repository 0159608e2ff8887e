//! A display of its own with the window on it, a pointer and a keyboard by xdotool, and a look at the screen.

use std::fs::{self, File};
use std::io::{BufRead as _, BufReader};
use std::os::unix::fs::PermissionsExt as _;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use serde_json::Value;
use tempfile::TempDir;

/// For how long anything may take: the machine may be busy with other tests.
const PATIENCE: Duration = Duration::from_secs(90);
const SHORTLY: Duration = Duration::from_millis(20);

/// The display, and the window once it is opened. Both end with it.
pub struct Desk {
    folder: TempDir,
    server: Child,
    display: String,
    window: Option<Child>,
    id: String,
}

/// What is on the screen, `0x00RRGGBB` row by row from the top.
#[derive(PartialEq)]
pub struct Picture {
    width: usize,
    pixels: Vec<u32>,
}

impl Drop for Desk {
    fn drop(&mut self) {
        if std::thread::panicking() {
            let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("window{}.png", self.display));
            eprintln!("the screen is kept as {}: {:?}", path.display(), self.screen().write(&path));
        }
        for child in self.window.iter_mut().chain([&mut self.server]) {
            // Either may have come to its end already.
            let _ = child.kill();
            let _ = child.wait();
        }
    }
}

impl Desk {
    /// An empty display, whose number the server chooses itself.
    pub fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let mut server = Command::new("Xvfb");
        server.args(["-displayfd", "1", "-screen", "0", "1280x1260x24", "-nolisten", "tcp", "-fbdir"]);
        server.arg(folder.path()).stdout(Stdio::piped()).stderr(File::create(folder.path().join("xvfb")).unwrap());
        let mut server = server.spawn().expect("Xvfb is there; on Debian: apt-get install xvfb");
        let mut number = String::new();
        BufReader::new(server.stdout.take().unwrap()).read_line(&mut number).unwrap();
        let display = format!(":{}", number.trim());
        Self { folder, server, display, window: None, id: String::new() }
    }

    /// A file of the desk's folder.
    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// The display's name.
    pub fn display(&self) -> &str {
        &self.display
    }

    /// A program on this display, which cannot ask a desktop for dialogs.
    fn command(&self, program: &str) -> Command {
        let mut command = Command::new(program);
        command.env("DISPLAY", &self.display).env("VGLARE_STATE", self.path("state"));
        for other in ["WAYLAND_DISPLAY", "WAYLAND_SOCKET", "DBUS_SESSION_BUS_ADDRESS", "XDG_RUNTIME_DIR"] {
            command.env_remove(other);
        }
        command
    }

    /// Gives the window's desktop a dialog for paths: what `zenity` is to do, in a shell's words.
    pub fn zenity(&self, does: &str) {
        let path = self.path("bin/zenity");
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(&path, format!("#!/bin/sh\n{does}\n")).unwrap();
        fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).unwrap();
    }

    /// Opens the window on a photo, with options, and gives it the keyboard.
    pub fn open(&mut self, photo: &Path, options: &[&str]) {
        let mut command = self.command(env!("CARGO_BIN_EXE_vglare"));
        command.arg("view").args(options).arg(photo).arg("--status").arg(self.path("status.json"));
        // No programs but those of the test.
        command.env("PATH", self.path("bin"));
        let told = File::create(self.path("told")).unwrap();
        command.stdout(told.try_clone().unwrap()).stderr(told);
        let window = command.spawn().unwrap();
        let number = window.id().to_string();
        self.window = Some(window);
        self.until("a photo", |status| status["photo"].is_string() && status["busy"] == false);
        let ids = self.xdotool(&["search", "--onlyvisible", "--pid", &number]);
        self.id = ids.lines().last().expect("there is a window").to_owned();
        self.to_window(&["windowfocus"], &[]);
    }

    /// The window's number.
    pub fn id(&self) -> u32 {
        self.id.parse().unwrap()
    }

    /// Runs xdotool; gives what it says.
    pub fn xdotool(&self, words: &[&str]) -> String {
        let mut command = self.command("xdotool");
        let done = command.args(words).output().expect("xdotool is there; on Debian: apt-get install xdotool");
        assert!(done.status.success(), "xdotool {words:?}: {}", String::from_utf8_lossy(&done.stderr));
        String::from_utf8(done.stdout).unwrap().trim().to_owned()
    }

    /// Runs one of xdotool's commands on the window.
    pub fn to_window(&self, command: &[&str], words: &[&str]) -> String {
        self.xdotool(&[command, &[self.id.as_str()], words].concat())
    }

    /// Presses and releases a key.
    pub fn key(&self, name: &str) {
        self.xdotool(&["key", name]);
    }

    /// Answers the window's question for a path.
    pub fn answer(&self, path: &Path) {
        self.until("a question", |status| status["asks"] == true);
        self.xdotool(&["type", "--delay", "1", path.to_str().unwrap()]);
        self.key("Return");
        self.until("an answer that is taken", |status| status["asks"] == false && status["busy"] == false);
    }

    /// Moves the pointer to a pixel of the window.
    pub fn point(&self, [x, y]: [f64; 2]) {
        let [x, y] = [x, y].map(|side| side.round().to_string());
        self.xdotool(&["mousemove", "--window", &self.id, &x, &y]);
    }

    /// Clicks.
    pub fn click(&self, at: [f64; 2]) {
        self.drag(at, at);
    }

    /// Drags by way of the middle, as a hand does, and moves the pointer out of the way.
    pub fn drag(&self, from: [f64; 2], to: [f64; 2]) {
        self.point(from);
        self.xdotool(&["mousedown", "1"]);
        // A frame has to come between, or a press is no drag.
        for part in [0.0, 0.3, 0.7, 1.0] {
            sleep(Duration::from_millis(60));
            self.point([0, 1].map(|axis| from[axis] + part * (to[axis] - from[axis])));
        }
        sleep(Duration::from_millis(60));
        self.xdotool(&["mouseup", "1"]);
        self.point([3.0, 200.0]);
    }

    /// What the window last said it shows.
    fn status(&self) -> Option<Value> {
        serde_json::from_slice(&fs::read(self.path("status.json")).ok()?).ok()
    }

    /// Waits until the window shows something.
    pub fn until(&self, what: &str, holds: impl Fn(&Value) -> bool) -> Value {
        let started = Instant::now();
        loop {
            let status = self.status();
            if let Some(status) = status.as_ref().filter(|status| holds(status)) {
                return status.clone();
            }
            let told = || fs::read_to_string(self.path("told")).unwrap_or_default();
            assert!(started.elapsed() < PATIENCE, "{what} never comes: {status:#?}\n{}", told());
            sleep(SHORTLY);
        }
    }

    /// What is on the screen once it has stayed the same for half a second.
    pub fn rested(&self) -> Picture {
        let started = Instant::now();
        let (mut before, mut since) = (self.screen(), Instant::now());
        while since.elapsed() < Duration::from_millis(500) {
            assert!(started.elapsed() < PATIENCE, "the screen never rests");
            sleep(SHORTLY);
            let now = self.screen();
            if now != before {
                (before, since) = (now, Instant::now());
            }
        }
        before
    }

    /// The server's framebuffer, an XWD file: a header of big-endian words, its length first, then colours, then rows.
    fn screen(&self) -> Picture {
        let bytes = fs::read(self.path("Xvfb_screen0")).unwrap();
        let word = |index: usize| u32::from_be_bytes(bytes[4 * index..4 * index + 4].try_into().unwrap()) as usize;
        let (width, height, row) = (word(4), word(5), word(12));
        let rows = bytes[word(0) + 12 * word(19)..].chunks_exact(row).take(height);
        let pixel = |four: &[u8]| u32::from_le_bytes(four.try_into().unwrap()) & 0xff_ffff;
        let pixels = rows.flat_map(|row| row[..4 * width].chunks_exact(4).map(pixel)).collect();
        Picture { width, pixels }
    }

    /// Whether the window is still there.
    pub fn is_open(&mut self) -> bool {
        self.window.as_mut().is_some_and(|window| window.try_wait().unwrap().is_none())
    }

    /// Waits until the window has closed, which must be well and without a word.
    pub fn closed(&mut self) {
        let started = Instant::now();
        while self.is_open() {
            assert!(started.elapsed() < PATIENCE, "it does not close");
            sleep(SHORTLY);
        }
        let status = self.window.take().unwrap().wait().unwrap();
        let told = fs::read_to_string(self.path("told")).unwrap();
        assert!(status.success() && told.is_empty(), "{status}: {told}");
    }
}

impl Picture {
    /// Red, green and blue at a pixel, added up.
    pub fn brightness(&self, at: [f64; 2]) -> u32 {
        let pixel = self.pixels[at[1] as usize * self.width + at[0] as usize];
        (pixel >> 16) + (pixel >> 8 & 0xff) + (pixel & 0xff)
    }

    fn write(&self, path: &Path) -> Result<(), png::EncodingError> {
        let [width, height] = [self.width, self.pixels.len() / self.width].map(|side| side as u32);
        let mut encoder = png::Encoder::new(File::create(path)?, width, height);
        encoder.set_color(png::ColorType::Rgb);
        let bytes: Vec<u8> = self.pixels.iter().flat_map(|pixel| pixel.to_be_bytes().into_iter().skip(1)).collect();
        encoder.write_header()?.write_image_data(&bytes)
    }

    /// How many of the pixels differ.
    pub fn differences(&self, other: &Self) -> usize {
        self.pixels.iter().zip(&other.pixels).filter(|(a, b)| a != b).count()
    }
}

/// A place in a status.
pub fn place(value: &Value) -> [f64; 2] {
    [0, 1].map(|axis| value[axis].as_f64().unwrap_or_else(|| panic!("{value} is no place")))
}

/// A place on a control, a part of its width from its left.
pub fn on(status: &Value, control: &str, part: f64) -> [f64; 2] {
    let sides = &status["controls"][control];
    let [left, top, right, bottom] = [0, 1, 2, 3].map(|side| sides[side].as_f64().expect(control));
    [left + part * (right - left), (top + bottom) / 2.0]
}
