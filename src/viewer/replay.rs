//! Scripts: what a person does at the window, written down, done again without a window.
//!
//! A script is a JSON list of steps. Time is the script's own: a frame is a fiftieth of a second later than the one
//! before it, however long it took.

use std::fs;
use std::path::{Path, PathBuf};
use std::rc::Rc;
use std::sync::Arc;
use std::time::{Duration, Instant};

use egui::{Event, Key, Modifiers, MouseWheelUnit, PointerButton, Pos2, RawInput, Rect, TouchPhase, Vec2, pos2, vec2};
use glam::DVec2;
use serde::{Deserialize, Serialize};

use super::app::App;
use super::stage::Times;
use super::status::Status;
use crate::gpu::{Device, Screen};
use crate::look::Look;
use crate::photo::ReadOptions;
use crate::target::Target;
use crate::{Error, Result, target};

/// Seconds from a frame to the next.
const FRAME: f64 = 0.02;
/// For how long files may be read, and after how many frames all must be at rest.
const PATIENCE: Duration = Duration::from_secs(60);
const MOST_FRAMES: usize = 1000;

/// A place on the screen.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Place {
    /// Points from the screen's top left corner.
    Screen([f32; 2]),
    /// A point of the picture plane.
    Picture([f64; 2]),
    /// A light of the photo that is shown, by its index.
    Light(usize),
    /// A part of the slider of the control of that name, 0 to 1 from its left.
    Control(String, f32),
}

/// A thing to do.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Step {
    /// Opens a photo and waits until it was read.
    Open(PathBuf),
    /// Drops a file on the window.
    Drop(PathBuf),
    /// Waits until nothing is being read.
    Load,
    /// Frames until none is due within a second, and no veil is being computed.
    Rest,
    /// So many frames without input.
    Idle(usize),
    /// Moves the pointer.
    Move(Place),
    /// Presses the pointer's first button where the pointer is.
    Press,
    /// Releases it.
    Release,
    /// Presses at one place, moves to the other in as many frames, and releases.
    Drag {
        /// Where it is pressed.
        from: Place,
        /// Where it is released.
        to: Place,
        /// In how many frames it gets there.
        frames: usize,
    },
    /// Turns the wheel, in points.
    Wheel(f32),
    /// Presses and releases a key by egui's name for it.
    Key {
        /// egui's name for the key, like `B` or `ArrowLeft`.
        key: String,
        /// With the control key held.
        #[serde(default)]
        ctrl: bool,
        /// With the shift key held.
        #[serde(default)]
        shift: bool,
    },
    /// Gives the screen another size, in pixels.
    Resize([u32; 2]),
    /// Loses the device, as where a graphics card is reset, and goes on with another of the kind.
    Lose,
    /// Sets the pixels in a point.
    Scale(f32),
    /// Writes what is on the screen to a PNG file of that name.
    Screenshot(String),
}

/// What a step came to.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Outcome {
    /// Milliseconds that each of its frames took, with what the device did for it.
    pub frames_ms: Vec<f64>,
    /// How long each kind of work last took.
    pub times: Times,
    /// What is shown by its end.
    #[serde(flatten)]
    pub status: Status,
}

/// Does what scripts say, on a screen that nobody sees.
pub struct Player {
    app: App,
    screen: Screen,
    device: Rc<Device>,
    time: f64,
    scale: f32,
    pointer: Pos2,
    due: Duration,
    frames_ms: Vec<f64>,
}

/// Reads a script.
///
/// # Errors
/// [`Error::Script`] where it cannot be read or is none.
pub fn read_script(path: &Path) -> Result<Vec<Step>> {
    let failed = |reason: String| Error::Script { path: path.to_owned(), reason };
    let text = fs::read_to_string(path).map_err(|error| failed(error.to_string()))?;
    serde_json::from_str(&text).map_err(|error| failed(error.to_string()))
}

/// Plays a script on a screen of `size` with photos open, and writes what came of each step, and its screenshots, to a
/// folder.
///
/// # Errors
/// [`Error::Script`] where a step cannot be done, [`Error::Write`] where the folder cannot be written to, and those of
/// [`App::frame`].
pub fn play(
    device: &Rc<Device>,
    photos: &[PathBuf],
    look: Look,
    reading: ReadOptions,
    script: &Path,
    output: &Path,
) -> Result<()> {
    let steps = read_script(script)?;
    fs::create_dir_all(output).map_err(|error| Error::write(output, error))?;
    let mut player = Player::new(device, look, [1280, 800])?;
    let failed = |index: usize, reason: String| Error::Script {
        path: script.to_owned(),
        reason: format!("step {}: {reason}", index + 1),
    };
    player.app.read_by(reading);
    for path in photos {
        player.app.open(path.clone());
    }
    let mut outcomes = Vec::new();
    for (index, step) in steps.iter().enumerate() {
        let outcome = match step {
            Step::Screenshot(name) => player.screenshot(&output.join(format!("{name}.png"))).map(|()| player.outcome()),
            step => player.step(step),
        };
        outcomes.push(outcome.map_err(|error| failed(index, error.to_string()))?);
    }
    target::write_json(&output.join("steps.json"), &outcomes, true)
}

impl Player {
    /// With nothing open; photos open with `look`.
    ///
    /// # Errors
    /// [`Error::Gl`] where the driver refuses.
    pub fn new(device: &Rc<Device>, look: Look, size: [u32; 2]) -> Result<Self> {
        Ok(Self {
            app: App::new(device, look, Arc::new(|| {}))?,
            screen: Screen::hidden(device, size)?,
            device: device.clone(),
            time: 0.0,
            scale: 1.0,
            pointer: Pos2::ZERO,
            due: Duration::ZERO,
            frames_ms: Vec::new(),
        })
    }

    /// What is played on.
    pub fn app(&mut self) -> &mut App {
        &mut self.app
    }

    /// What is seen.
    pub fn screen(&self) -> &Screen {
        &self.screen
    }

    /// Runs a frame, and waits until the device has done it.
    ///
    /// # Errors
    /// Those of [`App::frame`], and [`Error::Gl`] where the device says that something went wrong.
    pub fn frame(&mut self, events: Vec<Event>) -> Result<()> {
        self.frame_with(RawInput { events, ..RawInput::default() })
    }

    fn frame_with(&mut self, mut input: RawInput) -> Result<()> {
        self.time += FRAME;
        let size = self.screen.size().map(|side| side as f32 / self.scale);
        input.screen_rect = Some(Rect::from_min_size(Pos2::ZERO, vec2(size[0], size[1])));
        input.time = Some(self.time);
        input.focused = true;
        input.max_texture_side = Some(self.app.max_texture_side());
        input.viewports.entry(egui::ViewportId::ROOT).or_default().native_pixels_per_point = Some(self.scale);
        let started = Instant::now();
        self.due = self.app.frame(input, &self.screen)?.repaint_after;
        self.device.finish();
        self.frames_ms.push(started.elapsed().as_secs_f64() * 1e3);
        self.device.check("a frame of the window")
    }

    /// Does one step but a screenshot.
    ///
    /// # Errors
    /// [`Error::Usage`] where it cannot be done, and those of [`Player::frame`].
    pub fn step(&mut self, step: &Step) -> Result<Outcome> {
        self.frames_ms.clear();
        match step {
            Step::Open(path) => {
                self.app.open(path.clone());
                self.load()?;
            }
            Step::Drop(path) => {
                let file = Arc::new(Dropped(path.clone()));
                self.frame_with(RawInput { dropped_files: vec![file], ..RawInput::default() })?;
            }
            Step::Load => self.load()?,
            Step::Rest => self.rest()?,
            Step::Idle(frames) => (0..*frames).try_for_each(|_| self.frame(Vec::new()))?,
            Step::Move(place) => self.move_to(place)?,
            Step::Press => self.button(true)?,
            Step::Release => self.button(false)?,
            Step::Drag { from, to, frames } => self.drag(from, to, *frames)?,
            Step::Wheel(points) => self.frame(vec![Event::MouseWheel {
                unit: MouseWheelUnit::Point,
                delta: Vec2::new(0.0, *points),
                phase: TouchPhase::Move,
                source: egui::MouseWheelSource::Wheel,
                modifiers: Modifiers::NONE,
            }])?,
            Step::Key { key, ctrl, shift } => self.key(key, *ctrl, *shift)?,
            Step::Resize(size) => {
                self.screen = Screen::hidden(&self.device, *size)?;
                self.frame(Vec::new())?;
            }
            Step::Lose => self.lose()?,
            Step::Scale(scale) => {
                self.scale = scale.clamp(0.25, 8.0);
                self.frame(Vec::new())?;
            }
            Step::Screenshot(_) => return Err(Error::Usage("a screenshot needs a folder to write to".into())),
        }
        Ok(self.outcome())
    }

    fn outcome(&self) -> Outcome {
        let (frames_ms, times) = (self.frames_ms.clone(), self.app.times());
        Outcome { frames_ms, times, status: Status::of(&self.app) }
    }

    fn lose(&mut self) -> Result<()> {
        self.device.abandon();
        self.device = Device::open(&[self.device.info().backend])?;
        self.app.rebuild(&self.device)?;
        self.screen = Screen::hidden(&self.device, self.screen.size())?;
        self.frame(Vec::new())
    }

    fn load(&mut self) -> Result<()> {
        let started = Instant::now();
        self.frame(Vec::new())?;
        while self.app.is_reading() {
            if started.elapsed() > PATIENCE {
                return Err(Error::Usage(format!("a photo is still being read after {PATIENCE:?}")));
            }
            std::thread::sleep(Duration::from_millis(5));
            self.frame(Vec::new())?;
        }
        Ok(())
    }

    fn rest(&mut self) -> Result<()> {
        let started = Instant::now();
        for _ in 0..MOST_FRAMES {
            self.frame(Vec::new())?;
            while self.app.is_veiling() && started.elapsed() < PATIENCE {
                std::thread::sleep(Duration::from_millis(5));
                self.frame(Vec::new())?;
            }
            if self.due > Duration::from_secs(1) {
                return Ok(());
            }
        }
        Err(Error::Usage(format!("it does not come to rest within {MOST_FRAMES} frames")))
    }

    /// Where a place is on the screen now, in points.
    ///
    /// # Errors
    /// [`Error::Usage`] where there is no such thing.
    pub fn find(&self, place: &Place) -> Result<Pos2> {
        let missing = |what: &str| Error::Usage(format!("there is no {what} on the screen"));
        let on_picture = |position: DVec2| {
            let document = self.app.document().ok_or_else(|| missing("photo"))?;
            let placement = self.app.placement().ok_or_else(|| missing("picture"))?;
            Ok(placement.to_screen(document.place(position)))
        };
        match place {
            Place::Screen([x, y]) => Ok(pos2(*x, *y)),
            Place::Picture(position) => on_picture(DVec2::from_array(*position)),
            Place::Light(index) => {
                let light = self.app.document().and_then(|document| document.lights().get(*index).copied());
                on_picture(light.ok_or_else(|| missing("such light"))?.position)
            }
            Place::Control(name, part) => {
                let rail = self.app.control(name).ok_or_else(|| missing(&format!("control called {name:?}")))?;
                Ok(pos2(rail.left() + part * rail.width(), rail.center().y))
            }
        }
    }

    fn move_to(&mut self, place: &Place) -> Result<()> {
        let at = self.find(place)?;
        self.point(at)
    }

    fn point(&mut self, at: Pos2) -> Result<()> {
        self.pointer = at;
        self.frame(vec![Event::PointerMoved(at)])
    }

    fn button(&mut self, pressed: bool) -> Result<()> {
        let (pos, button, modifiers) = (self.pointer, PointerButton::Primary, Modifiers::NONE);
        self.frame(vec![Event::PointerButton { pos, button, pressed, modifiers }])
    }

    fn drag(&mut self, from: &Place, to: &Place, frames: usize) -> Result<()> {
        let (from, to) = (self.find(from)?, self.find(to)?);
        self.point(from)?;
        self.button(true)?;
        // The step is what the drag costs, not its way there.
        self.frames_ms.clear();
        for frame in 1..=frames {
            self.point(from + (to - from) * (frame as f32 / frames as f32))?;
        }
        let dragged = self.frames_ms.clone();
        self.button(false)?;
        self.frames_ms = dragged;
        Ok(())
    }

    fn key(&mut self, name: &str, ctrl: bool, shift: bool) -> Result<()> {
        let key = Key::from_name(name).ok_or_else(|| Error::Usage(format!("no key is called {name:?}")))?;
        let modifiers = Modifiers { ctrl, shift, command: ctrl, ..Modifiers::NONE };
        for pressed in [true, false] {
            let event = Event::Key { key, physical_key: None, pressed, repeat: false, modifiers };
            self.frame(vec![event])?;
        }
        Ok(())
    }

    fn screenshot(&self, path: &Path) -> Result<()> {
        let [width, height] = self.screen.size();
        let pixels = self.screen.read();
        Target::new(path, true)?.write(&|| false, |sink| {
            let mut encoder = png::Encoder::new(sink, width, height);
            encoder.set_color(png::ColorType::Rgba);
            encoder.set_compression(png::Compression::Fast);
            let mut writer = encoder.write_header()?;
            writer.write_image_data(bytemuck::cast_slice(&pixels))?;
            Ok(writer.finish()?)
        })
    }
}

/// A file that a script drops.
#[derive(Debug)]
struct Dropped(PathBuf);

impl egui::DroppedFile for Dropped {
    fn path(&self) -> &Path {
        &self.0
    }

    fn bytes(&self) -> std::result::Result<Vec<u8>, String> {
        fs::read(&self.0).map_err(|error| error.to_string())
    }
}
