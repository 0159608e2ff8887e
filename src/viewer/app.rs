//! The whole window but the window: what is open, and one frame of it on a screen.

mod ask;
mod device;
mod draw;
mod files;
mod memory;
mod menu;
mod strips;

use std::path::PathBuf;
use std::rc::Rc;
use std::sync::Arc;
use std::time::Duration;

use egui::{CentralPanel, Color32, Key, Modifiers, Panel, RawInput, Ui};

use super::canvas::{self, Canvas, Probe};
use super::control::{self, Told};
use super::document::Document;
use super::loader::{Loader, Read, Wake};
use super::model::{Look, Work, work};
use super::shortcuts::{self, Command};
use super::stage::{Counts, Stage, Times};
use super::study::Study;
use super::task::{State, Task};
use super::timings::Timings;
use super::{panels, viewing};
use crate::gpu::paint::Painter;
use crate::gpu::{Device, Screen};
use crate::look::Search;
use crate::photo::ReadOptions;
use crate::plan::Plan;
use crate::printable::printable;
use crate::{Result, panics};

use files::Files;
pub(super) use files::LookFile;
use memory::Budget;
pub use memory::PIXEL_BYTES;

/// Milliseconds of plan, spectrum, composite and view from which on a drag is shown by previews.
const SLOW: f64 = 33.0;
/// For how long nothing must change before a preview is replaced while the pointer still holds on, in seconds.
const SETTLED: f64 = 0.3;

/// What is open, and what draws it.
pub struct App {
    context: egui::Context,
    painter: Painter,
    stage: Stage,
    loader: Loader,
    wake: Wake,
    look: Look,
    search: Option<Searching>,
    files: Files,
    budget: Budget,
    documents: Vec<(u64, Document)>,
    current: usize,
    next: u64,
    notices: Vec<String>,
    canvas: Canvas,
    probe: Option<Probe>,
    /// When the field's look last changed, and what a full picture of it last cost, in milliseconds.
    moved: f64,
    cost: f64,
    devices: u32,
}

/// A search for lights: of which document, by which rules.
struct Searching {
    document: u64,
    task: Task<Search>,
}

/// What came of a frame.
pub struct Shown {
    /// When the next frame is due, unless something happens before.
    pub repaint_after: Duration,
    /// What egui asks of the window: cursor, clipboard, …
    pub platform: egui::PlatformOutput,
    /// Whether frames are to wait for the display.
    pub vsync: bool,
    /// Whether the window is to close.
    pub close: bool,
}

impl App {
    /// An app with nothing open, on a device that is current. Photos open with `look`; `wake` is called from other
    /// threads when a frame is wanted.
    ///
    /// # Errors
    /// [`crate::Error::Gl`] where the driver refuses.
    pub fn new(device: &Rc<Device>, look: Look, wake: Wake) -> Result<Self> {
        let context = egui::Context::default();
        let by_egui = wake.clone();
        context.set_request_repaint_callback(move |asked| {
            // What is due later is told by the frame itself.
            if asked.delay.is_zero() {
                by_egui();
            }
        });
        Ok(Self {
            context,
            painter: Painter::new(device)?,
            stage: Stage::new(device, wake.clone())?,
            loader: Loader::new(wake.clone()),
            wake,
            look,
            search: None,
            files: Files::default(),
            budget: Budget::default(),
            documents: Vec::new(),
            current: 0,
            next: 0,
            notices: Vec::new(),
            canvas: Canvas::default(),
            probe: None,
            moved: f64::NEG_INFINITY,
            cost: 0.0,
            devices: 1,
        })
    }

    /// Has photos read by these options from now on.
    pub fn read_by(&mut self, options: ReadOptions) {
        self.loader.options = options;
    }

    /// Begins to open a photo; it is shown when it has been read.
    pub fn open(&mut self, path: PathBuf) {
        self.loader.read(path, self.look.clone());
    }

    /// Whether files are being read.
    pub fn is_reading(&self) -> bool {
        self.loader.under_way().next().is_some()
    }

    /// Shows a document, behind the others.
    pub fn add(&mut self, document: Document) {
        self.current = self.documents.len();
        self.documents.push((self.next, document));
        self.next += 1;
    }

    /// The document that is shown.
    pub fn document(&self) -> Option<&Document> {
        self.documents.get(self.current).map(|(_, document)| document)
    }

    /// The document that is shown, to be changed.
    pub fn document_mut(&mut self) -> Option<&mut Document> {
        self.documents.get_mut(self.current).map(|(_, document)| document)
    }

    /// What went wrong and was not dismissed yet.
    pub fn notices(&self) -> &[String] {
        &self.notices
    }

    /// Why there is no picture of the look as it is set, if so.
    pub fn problem(&self) -> Option<&str> {
        self.stage.problem()
    }

    /// Whether a veil is being summed in the background.
    pub fn is_veiling(&self) -> bool {
        self.stage.veiling().is_summing() || self.stage.removing().is_running()
    }

    /// Where the picture lay on the screen in the last frame.
    pub fn placement(&self) -> Option<&viewing::Placement> {
        self.canvas.placement.as_ref()
    }

    /// How often each kind of work was done.
    pub fn counts(&self) -> Counts {
        self.stage.counts()
    }

    /// How long each kind of work last took.
    pub fn times(&self) -> Times {
        self.stage.times()
    }

    /// On how many devices it has been drawn, one after the other.
    pub fn devices(&self) -> u32 {
        self.devices
    }

    /// How long the last pictures took.
    pub fn timings(&self) -> &Timings {
        self.stage.timings()
    }

    /// The plan of the picture.
    pub fn plan(&self) -> Option<&Plan> {
        self.stage.plan()
    }

    /// What is known of the picture.
    pub fn study(&self) -> &Study {
        self.stage.known()
    }

    /// What the panels' controls said of themselves in the last frame, those that were folded away left out.
    pub fn controls(&self) -> Vec<Told> {
        control::told(&self.context)
    }

    /// Where the control called `name`, of a number its slider, or the header of the panel called so, was drawn last, in
    /// points, for scripts to drag and click.
    pub fn control(&self, name: &str) -> Option<egui::Rect> {
        self.controls().into_iter().find(|told| told.name == name).map(|told| told.part)
    }

    /// egui's side of it.
    pub fn context(&self) -> &egui::Context {
        &self.context
    }

    /// The largest side of a texture, for egui's fonts.
    pub fn max_texture_side(&self) -> usize {
        self.painter.max_texture_side()
    }

    /// What the window is called.
    pub fn title(&self) -> String {
        self.document().map_or("vglare".into(), |document| format!("{} – vglare", document.name()))
    }

    /// Runs one frame: takes the input, brings the picture up to date, and draws all of the screen.
    ///
    /// # Errors
    /// [`crate::Error::Gl`] where the driver fails at the screen itself, or the device is lost. What fails at a picture becomes a notice.
    pub fn frame(&mut self, input: RawInput, screen: &Screen) -> Result<Shown> {
        self.take_in();
        let context = self.context.clone();
        self.stage.tick(input.time.unwrap_or_else(|| context.time()));
        let before = self.document().map(Document::known_look);
        let mut close = false;
        let mut output = context.run_ui(input, |ui| {
            close |= ui.input_mut(|input| input.consume_key(Modifiers::COMMAND, Key::Q));
            self.ui(ui, screen);
        });
        self.settle(before);
        self.keep_within_budget();
        self.remember_theme();
        screen.clear(opaque(context.global_style().visuals.extreme_bg_color));
        let again = match panics::caught(|| self.draw(screen)) {
            // What fails on a device that is lost is no news of the picture.
            Err(error) if self.painter.device().is_lost() => return Err(error),
            drawn => drawn.unwrap_or_else(|error| {
                let told = self.notices.len();
                self.notice(error.to_string());
                if self.notices.len() > told { Duration::ZERO } else { Duration::MAX }
            }),
        };
        let shapes = context.tessellate(output.shapes, output.pixels_per_point);
        self.painter.paint(screen, output.pixels_per_point, &shapes, &mut output.textures_delta);
        let by_egui = output.viewport_output.values().map(|viewport| viewport.repaint_delay).min();
        Ok(Shown {
            repaint_after: by_egui.unwrap_or(Duration::MAX).min(again).min(self.next_look()),
            platform: output.platform_output,
            vsync: panels::vsync(&context),
            close,
        })
    }

    /// Takes what was read in the background.
    fn take_in(&mut self) {
        self.stage.take_in();
        for Read { document, result } in self.loader.take() {
            match (document, result) {
                (Some(number), read) => self.wake(number, read),
                (None, Ok(document)) => {
                    self.remember_photo(&document.path);
                    for note in &document.photo.source.notes {
                        self.notice(format!("{}: {note}", document.path.display()));
                    }
                    self.add(document);
                    // While many are read, those before are let go of as the next come in.
                    self.keep_within_budget();
                }
                (None, Err(error)) => self.notice(error.to_string()),
            }
        }
        self.take_in_files();
        if let Some(Searching { document, task }) = self.search.take() {
            match task.poll() {
                State::Running => self.search = Some(Searching { document, task }),
                State::Failed(error) => self.notice(format!("the search for lights failed: {error}")),
                State::Done(found) => {
                    let searched = self.documents.iter_mut().find(|(number, _)| *number == document);
                    if let Some((_, document)) = searched {
                        document.set_found(found);
                    }
                }
            }
        }
    }

    /// Makes what a frame has changed a step of the history, and begins the search that it asks for.
    fn settle(&mut self, before: Option<Look>) {
        // What is dragged, typed or held down is one change.
        let input = |input: &egui::InputState| input.pointer.any_down() || !input.keys_down.is_empty();
        let gesture = self.context.input(input) || self.context.text_edit_focused();
        let Some((number, document)) = self.documents.get_mut(self.current) else { return };
        document.record(gesture);
        if before.is_none_or(|before| work(&before, &document.known_look()) >= Work::Plan) {
            self.moved = self.context.time();
        }
        if self.search.is_none() && document.wants_search() && !document.is_asleep() {
            let (look, photo, frame) = (document.look.clone(), document.photo.clone(), document.whole_frame());
            let recovered = document.recovered.clone();
            let search = move || {
                let known = recovered.by == look.find.recover;
                let recovered = if known { recovered } else { Arc::new(look.recovered(&photo)) };
                let found = look.find(&photo, &recovered, &frame);
                Search { options: look.find, unit: frame.unit, found }
            };
            let task = Task::start("search", &self.wake, search);
            match task {
                Ok(task) => self.search = Some(Searching { document: *number, task }),
                Err(error) => self.notice(format!("the photo cannot be searched: {error}")),
            }
        }
        self.remember_look(gesture);
    }

    fn notice(&mut self, text: String) {
        let text = printable(&text).into_owned();
        if !self.notices.contains(&text) {
            self.notices.push(text);
        }
    }

    fn ui(&mut self, ui: &mut Ui, screen: &Screen) {
        let dropped = ui.input(|input| input.raw.dropped_files.clone());
        dropped.iter().for_each(|file| self.open(file.path().to_owned()));
        control::begin(ui.ctx());
        let asked = self.asks();
        self.bar(ui);
        self.tabs(ui);
        self.strips(ui);
        self.exports(ui);
        self.asked_elsewhere(ui);
        // What was typed into an answer is no shortcut, even where it was all typed in one frame.
        let asks = asked || self.asks();
        let Some((_, document)) = self.documents.get_mut(self.current) else {
            self.canvas = Canvas::default();
            self.start(ui);
            return;
        };
        let placement = self.canvas.placement.as_ref();
        let command = if asks { None } else { shortcuts::apply(ui.ctx(), document, placement) };
        Panel::right("panels").default_size(320.0).show(ui, |ui| panels::show(ui, document, &self.stage));
        let wants_path = document.wants_path.take();
        let canvas = CentralPanel::no_frame()
            .show(ui, |ui| canvas::show(ui, document, &self.stage, screen.size(), self.probe.as_ref()));
        self.canvas = canvas.inner;
        match command {
            Some(Command::Next) => self.current = (self.current + 1) % self.documents.len(),
            Some(Command::Close) => self.close(self.current),
            None => {}
        }
        if let Some(purpose) = wants_path {
            self.ask(purpose, false);
            // Where the question is asked in the window, it is there with the next frame.
            self.context.request_repaint();
        }
    }

    fn close(&mut self, index: usize) {
        self.documents.remove(index);
        if self.current > index || self.current >= self.documents.len() {
            self.current = self.current.saturating_sub(1);
        }
        if self.documents.is_empty() {
            self.stage.clear();
        }
    }
}

fn opaque(colour: Color32) -> [f32; 3] {
    [colour.r(), colour.g(), colour.b()].map(|code| f32::from(code) / 255.0)
}
