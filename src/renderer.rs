//! The main path: spectrum → field → normalise → composite.
//!
//! ```no_run
//! # use vglare::{frame::Frame, gpu::{Backend, Device}, plan::{plan, Request}, problem::Problem};
//! # use vglare::renderer::{Renderer, Settings};
//! # let (ghosts, frame) = (Vec::new(), Frame::full(1920, 1080));
//! # let mut pixels = vec![[0.0; 4]; frame.window.pixels()];
//! let device = Device::open(&Backend::ALL)?;
//! let plan = plan(&Problem::new(ghosts, frame), &Request::new(1e-3))?;
//! let mut renderer = Renderer::new(&device)?;
//! renderer.set_scene(&plan)?; // the spectrum, once
//! renderer.composite(frame, &mut pixels, &Settings::default())?;
//! # Ok::<(), vglare::Error>(())
//! ```

mod convert;
mod exchange;
mod graf;
mod mask;
mod settings;
mod tiles;
mod view;

use std::rc::Rc;

use crate::frame::{Frame, Window};
use crate::gpu::composite::{Composite, CompositePass};
use crate::gpu::copy::CopyPass;
use crate::gpu::evaluators::Evaluators;
use crate::gpu::field::{FieldPass, Source};
use crate::gpu::mask::MaskPass;
use crate::gpu::range::RangePass;
use crate::gpu::runner::Runner;
use crate::gpu::spectrum::{Coefficients, Ghosts, Spectrum, SpectrumGroup};
use crate::gpu::view::ViewPass;
use crate::gpu::{Device, PassTime};
use crate::plan::{Evaluator, Plan, Precision, Series, Transform};
use crate::{Error, Result};

use exchange::Exchange;
pub use exchange::Pending;
pub use graf::{GrafRenderer, GrafScene};
pub use mask::Mask;
pub use settings::Settings;
pub use view::{Part, View};

pub use crate::choices::Normalize;

/// Holds the scene on the device, and renders pictures with it.
pub struct Renderer {
    runner: Runner,
    spectrum: Spectrum,
    evaluators: Evaluators,
    field: FieldPass,
    range: RangePass,
    composite: CompositePass,
    copy: CopyPass,
    view: ViewPass,
    mask: MaskPass,
    exchange: Exchange,
    scene: Option<Plan>,
    /// The frame whose field is held, if any.
    held: Option<Frame>,
    /// The field whose range is on the device, by what tells it from any other.
    ranged: Option<u64>,
    tile_pixels: usize,
}

impl Renderer {
    /// A renderer without a scene.
    ///
    /// # Errors
    /// [`Error::Gl`] where the driver refuses an object.
    pub fn new(device: &Rc<Device>) -> Result<Self> {
        let runner = Runner::new(device)?;
        Ok(Self {
            spectrum: Spectrum::new(&runner)?,
            evaluators: Evaluators::new(&runner)?,
            field: FieldPass::new(&runner)?,
            range: RangePass::new(&runner)?,
            composite: CompositePass::new(&runner)?,
            copy: CopyPass::default(),
            view: ViewPass::new(&runner)?,
            mask: MaskPass::new(&runner)?,
            // The software renderer's memory is the photo's own: there a buffer is one more copy.
            exchange: Exchange::new(!device.info().software),
            scene: None,
            held: None,
            ranged: None,
            tile_pixels: tiles::PIXELS,
            runner,
        })
    }

    /// Computes the spectrum of the ghosts that the plan keeps, unless it is there already.
    ///
    /// # Errors
    /// [`Error::Gl`] where the driver refuses.
    pub fn set_scene(&mut self, plan: &Plan) -> Result<()> {
        if self.scene.as_ref().is_some_and(|old| old == plan) {
            return Ok(());
        }
        self.forget_scene();
        if plan.series().is_none() || plan.summed() > 0 {
            self.upload_summed(plan)?;
        }
        if let Some(series) = plan.series() {
            self.compute_spectrum(plan, series)?;
        }
        self.runner.device().check("computing the spectrum")?;
        self.scene = Some(plan.clone());
        Ok(())
    }

    /// Uploads the ghosts that are summed directly, in the floats that the plan asks for.
    fn upload_summed(&mut self, plan: &Plan) -> Result<()> {
        if plan.precision == Precision::Double {
            let (direct, shapes) = convert::direct_ghosts(plan, convert::double_ghost);
            return self.evaluators.set_ghosts(&self.runner, &direct, &shapes);
        }
        let (direct, shapes) = convert::direct_ghosts(plan, convert::single_ghost);
        let single: Vec<[f32; 4]> = shapes.iter().map(|row| row.map(|x| x as f32)).collect();
        self.evaluators.set_ghosts(&self.runner, &direct, &single)
    }

    fn compute_spectrum(&mut self, plan: &Plan, series: &Series) -> Result<()> {
        let parts = &series.groups;
        let (mut spectral, mut sums) = (Vec::new(), Vec::new());
        for group in parts {
            let (each, summed) = match &group.transform {
                Transform::Gather(cells) => {
                    (Vec::new(), self.runner.run("moments", || convert::gathered(plan, series.period, group, cells)))
                }
                _ => (convert::spectral_ghosts(plan, series.period, &group.members), Vec::new()),
            };
            spectral.push(each);
            sums.push(summed);
        }
        let tables: Vec<_> = parts.iter().map(|group| convert::table(series, group)).collect();
        let groups = parts.iter().enumerate().map(|(k, group)| SpectrumGroup {
            coefficients: match &tables[k] {
                Some(table) => Coefficients::Table(table),
                None => Coefficients::Factors(group.bell.shape().shader()),
            },
            ghosts: match group.transform {
                Transform::Gather(_) => Ghosts::Sums(&sums[k]),
                _ => Ghosts::Each(&spectral[k]),
            },
            degree: group.degree,
        });
        self.spectrum.compute(&self.runner, &series.counts, &groups.collect::<Vec<_>>())
    }

    /// Computes the spectrum of ghosts whose bell is a table, whatever bells they name: for each mode that the plan
    /// keeps, harmonic by harmonic of x, what stands before c_n c_m, s_n s_m, c_n s_m and s_n c_m in the bell's series
    /// about its own centre, the mode's weight 1, 2 or 4 included.
    ///
    /// # Errors
    /// [`Error::Gl`] where the driver refuses.
    pub(crate) fn set_tabulated(&mut self, plan: &Plan, table: &[[f32; 4]]) -> Result<()> {
        self.forget_scene();
        let everyone: Vec<u32> = (0..plan.problem().ghosts().len() as u32).collect();
        let group = SpectrumGroup {
            coefficients: Coefficients::Table(table),
            ghosts: Ghosts::Each(&convert::spectral_ghosts(plan, plan.period(), &everyone)),
            degree: plan.degree(),
        };
        self.spectrum.compute(&self.runner, plan.counts(), &[group])?;
        self.runner.device().check("computing the spectrum")?;
        self.scene = Some(plan.clone());
        Ok(())
    }

    /// Rounds the spectrum as a store of 16-bit floats would, whose scale is its largest term: what such a store would
    /// cost in accuracy. The next [`Renderer::set_scene`] of the same plan keeps it; [`Renderer::forget_scene`] does not.
    ///
    /// # Errors
    /// [`Error::Gl`] where the driver refuses.
    pub(crate) fn round_spectrum(&mut self) -> Result<()> {
        self.spectrum.round_to_half()
    }

    /// Adds the glare to the pixels of the frame's window, row by row from the top.
    ///
    /// # Errors
    /// [`Error::Gl`] where the driver refuses, or where there is no scene.
    pub fn composite(&mut self, frame: Frame, pixels: &mut [[f32; 4]], settings: &Settings) -> Result<()> {
        let pending = self.submit(frame, pixels, settings)?;
        self.collect(pending, pixels)
    }

    /// Begins what [`Renderer::composite`] does. Until [`Renderer::collect`] has been given the same pixels, some of
    /// them may still be without glare: with pixel buffers, the last tile is on its way while the CPU goes on.
    ///
    /// # Errors
    /// [`Error::Gl`] where the driver refuses, or where there is no scene.
    pub fn submit(&mut self, frame: Frame, pixels: &mut [[f32; 4]], settings: &Settings) -> Result<Pending> {
        let uniforms = self.start(frame, settings)?;
        assert_eq!(pixels.len(), frame.window.pixels(), "as many pixels as the window has");
        let mut pending = Pending::default();
        for tile in self.tiles(frame.window) {
            let source = self.evaluate(frame, tile)?;
            self.upload(frame, tile, pixels)?;
            self.composite.draw(&self.runner, convert::variant(source, settings), &uniforms)?;
            // The tile before this one has come back while this one was drawn.
            let before = std::mem::replace(&mut pending, self.read_back(frame, tile, pixels)?);
            self.collect(before, pixels)?;
            self.runner.device().check("compositing")?;
        }
        Ok(pending)
    }

    /// Draws the loaded photo with its glare and leaves the picture on the device. Does not wait for it.
    ///
    /// # Errors
    /// [`Error::Gl`] where the driver refuses, or where there is no scene.
    pub fn draw(&mut self, frame: Frame, settings: &Settings) -> Result<()> {
        let uniforms = self.start(frame, settings)?;
        let source = self.whole(frame)?;
        self.composite.draw(&self.runner, convert::variant(source, settings), &uniforms)?;
        Ok(())
    }

    /// Copies the loaded photo on the device, and nothing else: the yardstick of the benches.
    ///
    /// # Errors
    /// [`Error::Gl`] where no photo is loaded, or the driver refuses.
    pub fn draw_copy(&mut self) -> Result<()> {
        self.copy.draw(&self.runner, self.composite.loaded()?)
    }

    /// Waits until the device has done all that it was asked to.
    pub fn finish(&self) {
        self.runner.device().finish();
    }

    /// Forgets the scene, so that the next [`Renderer::set_scene`] computes its spectrum anew.
    pub fn forget_scene(&mut self) {
        (self.held, self.scene) = (None, None);
    }

    /// The glare alone, as [`Renderer::composite`] would add it, row by row from the top; alpha is 1.
    ///
    /// # Errors
    /// [`Error::Gl`] where the driver refuses, or where there is no scene.
    pub fn glare(&mut self, frame: Frame, settings: &Settings) -> Result<Vec<[f32; 4]>> {
        let uniforms = self.start(frame, settings)?;
        let stride = frame.window.width as usize;
        let mut pixels = vec![[0.0; 4]; frame.window.pixels()];
        for tile in self.tiles(frame.window) {
            let source = self.evaluate(frame, tile)?;
            let size = [tile.width, tile.height];
            let glare = self.composite.draw_glare(&self.runner, convert::variant(source, settings), &uniforms, size)?;
            let at = offset(frame.window, tile);
            self.runner.run("readback", || glare.read(&mut pixels[at..], stride, tile.width, tile.height));
            self.runner.device().check("drawing the glare")?;
        }
        Ok(pixels)
    }

    /// The smallest and the largest value of the field over the frame's window, all colours alike, by the reduction
    /// that [`Normalize::Minmax`] uses.
    ///
    /// # Errors
    /// [`Error::Gl`] where the driver refuses, or where there is no scene.
    pub fn range(&mut self, frame: Frame) -> Result<[f32; 2]> {
        self.reduce(frame)?;
        Ok(self.range.read())
    }

    /// The field, neither normalised nor multiplied by any strength, at pixels of the frame's window, given as columns
    /// and rows of the picture.
    ///
    /// # Errors
    /// [`Error::Gl`] where the driver refuses, or where there is no scene.
    pub fn probe(&mut self, frame: Frame, pixels: &[[i32; 2]]) -> Result<Vec<[f64; 3]>> {
        let scale = self.plan()?.scale;
        let mut values = vec![[0.0; 3]; pixels.len()];
        for tile in self.tiles(frame.window) {
            let inside = |&[i, j]: &[i32; 2]| {
                (0..tile.width as i32).contains(&(i - tile.x)) && (0..tile.height as i32).contains(&(j - tile.y))
            };
            let mine: Vec<usize> = (0..pixels.len()).filter(|&index| inside(&pixels[index])).collect();
            if mine.is_empty() {
                continue;
            }
            let source = self.evaluate(frame, tile)?;
            // The values come in a texture of one row.
            for mine in mine.chunks(self.runner.device().info().limits.texture_size as usize) {
                let local: Vec<_> = mine.iter().map(|&k| [pixels[k][0] - tile.x, pixels[k][1] - tile.y]).collect();
                for (&index, value) in mine.iter().zip(self.field.probe(&self.runner, source, &local)?) {
                    values[index] = [0, 1, 2].map(|colour| f64::from(value[colour]) * scale[colour]);
                }
            }
            self.runner.device().check("looking up the field")?;
        }
        Ok(values)
    }

    /// The field, neither normalised nor multiplied by any strength, at every pixel of the frame's window: `visit` gets
    /// tile after tile, each with its values row by row from the top.
    ///
    /// # Errors
    /// [`Error::Gl`] where the driver refuses, or where there is no scene.
    pub fn field(&mut self, frame: Frame, mut visit: impl FnMut(Window, &[[f64; 3]])) -> Result<()> {
        let scale = self.plan()?.scale;
        self.held = None;
        for tile in self.tiles(frame.window) {
            let source = self.evaluate(frame, tile)?;
            let mut pixels = vec![[0.0f32; 4]; tile.pixels()];
            let field = self.field.draw(&self.runner, source, tile.width, tile.height)?;
            field.read(&mut pixels, tile.width as usize, tile.width, tile.height);
            self.runner.device().check("reading the field")?;
            let value = |pixel: &[f32; 4]| [0, 1, 2].map(|colour| f64::from(pixel[colour]) * scale[colour]);
            visit(tile, &pixels.iter().map(value).collect::<Vec<_>>());
        }
        Ok(())
    }

    /// Whether each pass is timed from now on; that makes the passes wait for each other.
    pub fn set_timing(&mut self, timing: bool) {
        self.runner.set_timing(timing);
    }

    /// The times gathered since they were last taken.
    pub fn take_times(&mut self) -> Vec<PassTime> {
        self.runner.take_times()
    }

    /// The largest tile, in pixels.
    pub fn set_tile_pixels(&mut self, pixels: usize) {
        self.tile_pixels = pixels.max(1);
    }

    fn plan(&self) -> Result<&Plan> {
        self.scene.as_ref().ok_or_else(|| Error::Gl("the renderer has no scene".into()))
    }

    fn tiles(&self, window: Window) -> Vec<Window> {
        let limits = &self.runner.device().info().limits;
        let side = limits.texture_size.min(limits.viewport[0]).min(limits.viewport[1]);
        // Drivers reset themselves when one draw takes seconds, and `direct` can make that of a tile of any size.
        let bells = self.scene.as_ref().map_or(0, Plan::summed).max(1);
        tiles::split(window, side, self.tile_pixels.min((tiles::BELLS / bells).max(1)))
    }

    /// Finds the range where the settings ask for it, and gives the composite's uniforms.
    fn start(&mut self, frame: Frame, settings: &Settings) -> Result<Composite> {
        let plan = self.plan()?;
        settings.check(plan.scale)?;
        let uniforms = convert::uniforms(plan, settings);
        if settings.normalize == Normalize::Minmax {
            self.reduce(frame)?;
        }
        self.range.bind();
        Ok(uniforms)
    }

    /// Finds the field's range over the frame's window, and leaves it on the device.
    fn reduce(&mut self, frame: Frame) -> Result<()> {
        let scale = self.plan()?.scale.map(|scale| scale as f32);
        if let (true, Some((field, stamp))) = (self.held == Some(frame), self.field.drawn()) {
            if self.ranged != Some(stamp) {
                self.range.reset();
                self.range.add(&self.runner, field, scale)?;
                self.ranged = Some(stamp);
            }
            return Ok(());
        }
        self.range.reset();
        (self.held, self.ranged) = (None, None);
        for tile in self.tiles(frame.window) {
            let source = self.evaluate(frame, tile)?;
            let field = self.field.draw(&self.runner, source, tile.width, tile.height)?;
            self.range.add(&self.runner, field, scale)?;
        }
        Ok(())
    }

    /// Readies the plan's evaluator for a tile.
    fn evaluate(&mut self, frame: Frame, tile: Window) -> Result<Source> {
        let Some(plan) = &self.scene else { return Err(Error::Gl("the renderer has no scene".into())) };
        let (runner, spectrum, evaluators) = (&self.runner, &self.spectrum, &mut self.evaluators);
        if plan.series().is_none() || plan.summed() > 0 {
            evaluators.direct([tile.x, tile.y], frame)?;
        }
        if let Some(series) = plan.series() {
            let columns = || tiles::phases(tile.width, |i| frame.x(f64::from(tile.x) + i), series.period.x);
            let rows = || tiles::phases(tile.height, |j| frame.y(f64::from(tile.y) + j), series.period.y);
            match (series.evaluator, &series.lattice) {
                (Evaluator::Direct, _) => {}
                (Evaluator::Series, _) => evaluators.series(runner, [&columns(), &rows()], spectrum)?,
                (Evaluator::Rows, _) => evaluators.rows(runner, [&columns(), &rows()], spectrum)?,
                (Evaluator::Grid, Some(lattice)) => {
                    let nodes = tiles::Nodes::new(lattice, series.period, frame, tile);
                    evaluators.grid(runner, &nodes.tile(), spectrum)?;
                }
                (Evaluator::Grid, None) => return Err(Error::Plan("a grid without a lattice".into())),
            }
        }
        Ok(convert::source(plan, evaluators.many()))
    }
}

/// Where a tile's first pixel stands among the window's.
fn offset(window: Window, tile: Window) -> usize {
    (tile.y - window.y) as usize * window.width as usize + (tile.x - window.x) as usize
}
