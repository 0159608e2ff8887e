//! The field of a plan on the device: its spectrum, its evaluators, its range and its values at pixels.

use std::rc::Rc;

use super::plate::Plated;
use super::{convert, lattice, local, tiles};
use crate::frame::{Frame, Window};
use crate::gpu::evaluators::Evaluators;
use crate::gpu::exact::{Exact, Waves};
use crate::gpu::field::{FieldPass, Source};
use crate::gpu::local::LocalPass;
use crate::gpu::range::RangePass;
use crate::gpu::runner::Runner;
use crate::gpu::spectrum::Spectrum;
use crate::gpu::{Device, PassTime};
use crate::plan::{Evaluator, Lattice, Plan, Plate, Precision, Series};
use crate::series::waves;
use crate::{Error, Result};

/// Holds a plan's scene on the device, and evaluates its field: all that certificates and measurements need.
pub struct Field {
    pub(super) runner: Runner,
    pub(super) spectrum: Spectrum,
    evaluators: Evaluators,
    pub(super) exact: Exact,
    /// The spectrum as the CPU has it, where that sums it at nodes.
    terms: Option<Vec<[f32; 4]>>,
    pub(super) values: FieldPass,
    pub(super) range: RangePass,
    local: LocalPass,
    plate: Plated,
    /// The frame that the ghosts of a local layer were placed in.
    localised: Option<Frame>,
    pub(super) scene: Option<Plan>,
    /// The frame whose values are held, if any.
    held: Option<Frame>,
    /// The values whose range is on the device, by what tells them from any others.
    ranged: Option<u64>,
    tile_pixels: usize,
}

impl Field {
    /// A field without a scene.
    ///
    /// # Errors
    /// [`Error::Gl`] where the driver refuses an object.
    pub fn new(device: &Rc<Device>) -> Result<Self> {
        let runner = Runner::new(device)?;
        Ok(Self {
            spectrum: Spectrum::new(&runner)?,
            evaluators: Evaluators::new(&runner)?,
            exact: Exact::new(&runner)?,
            terms: None,
            values: FieldPass::new(&runner)?,
            range: RangePass::new(&runner)?,
            local: LocalPass::new(&runner)?,
            plate: Plated::default(),
            localised: None,
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
        if convert::sums(plan) {
            self.upload_summed(plan)?;
        }
        if let Some(local) = plan.local() {
            let frame = plan.problem().frame();
            local::upload(plan, local, frame, &mut self.local, &self.runner)?;
            self.localised = Some(frame);
        }
        if let Some(series) = plan.series() {
            self.compute_spectrum(plan, series)?;
        }
        if let Some(plate) = plan.plate() {
            self.runner.run("plate", || plate.sheet(plan.problem(), plan.problem().frame()))?;
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

    /// Waits until the device has done all that it was asked to.
    pub fn finish(&self) {
        self.runner.device().finish();
    }

    /// Forgets the scene, so that the next [`Field::set_scene`] computes its spectrum, or its plate, anew.
    pub fn forget_scene(&mut self) {
        self.scene.iter().filter_map(Plan::plate).for_each(Plate::forget);
        (self.held, self.scene, self.terms) = (None, None, None);
        self.plate.forget();
    }

    /// The smallest and the largest value of the field over the frame's window, all colours alike, by the reduction
    /// that [`Normalize::Minmax`](crate::choices::Normalize::Minmax) uses.
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
        let scale = self.plan()?.units();
        let mut values = vec![[0.0; 3]; pixels.len()];
        for tile in self.tiles(frame) {
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
                for (&index, value) in mine.iter().zip(self.values.probe(&self.runner, source, &local)?) {
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
    pub fn visit(&mut self, frame: Frame, mut visit: impl FnMut(Window, &[[f64; 3]])) -> Result<()> {
        let scale = self.plan()?.units();
        self.held = None;
        for tile in self.tiles(frame) {
            let source = self.evaluate(frame, tile)?;
            let mut pixels = vec![[0.0f32; 4]; tile.pixels()];
            let field = self.values.draw(&self.runner, source, tile.width, tile.height)?;
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

    pub(super) fn plan(&self) -> Result<&Plan> {
        self.scene.as_ref().ok_or_else(|| Error::Gl("the renderer has no scene".into()))
    }

    /// The parts of a frame's window that are evaluated one after the other.
    pub(super) fn tiles(&self, frame: Frame) -> Vec<Window> {
        let [columns, rows] = self.series_sides(frame);
        let side = self.side();
        tiles::split(frame.window, [columns.min(side), rows.min(side)], self.most_pixels())
    }

    /// The parts of a window that a photo comes in. There are no fewer of those that are evaluated.
    pub(super) fn photo_tiles(&self, window: Window) -> Vec<Window> {
        tiles::split(window, [self.side(); 2], self.most_pixels())
    }

    /// The most columns and rows that anything is drawn on.
    fn side(&self) -> u32 {
        let limits = &self.runner.device().info().limits;
        limits.texture_size.min(limits.viewport[0]).min(limits.viewport[1])
    }

    /// The most pixels of a tile.
    fn most_pixels(&self) -> usize {
        // Drivers reset themselves when one draw takes seconds, and `direct` can make that of a tile of any size.
        let bells = self.scene.as_ref().map_or(0, Plan::summed).max(1);
        self.tile_pixels.min((tiles::BELLS / bells).max(1)).min(self.canvas_pixels())
    }

    /// The most columns and rows that the plan's series, if it has one, lets a tile have: by its lattice, and where it is in
    /// 64-bit floats by what its passes leave each other.
    fn series_sides(&self, frame: Frame) -> [u32; 2] {
        let limits = &self.runner.device().info().limits;
        let mut sides = [u32::MAX; 2];
        let mut at_most = |most: [u32; 2]| sides.iter_mut().zip(most).for_each(|(side, most)| *side = most.min(*side));
        let Some(series) = self.scene.as_ref().and_then(Plan::series) else { return sides };
        if let Some(lattice) = &series.lattice {
            at_most(tiles::sides_on(lattice, frame, limits.texture_size));
        }
        if series.precision == Precision::Double {
            at_most(tiles::sides_of_doubles(series, frame, limits.storage_block));
        }
        sides
    }

    /// The most pixels that a canvas of doubles has, where there is one.
    fn canvas_pixels(&self) -> usize {
        let exact = self.scene.as_ref().is_some_and(|plan| plan.is_exact() && plan.local().is_some());
        let block = self.runner.device().info().limits.storage_block;
        if exact { (block / tiles::CANVAS_BYTES) as usize } else { usize::MAX }
    }

    /// Evaluates all of a frame once and holds it: until the scene changes, pictures of this frame look it up, and a change
    /// of settings costs no evaluation.
    ///
    /// # Errors
    /// [`crate::Error::Gl`] where the driver refuses, or where there is no scene.
    pub fn hold(&mut self, frame: Frame) -> Result<()> {
        if self.held != Some(frame) {
            let size = [frame.window.width, frame.window.height];
            let bands = self.photo_tiles(frame.window).len() as u32;
            match &self.pieces(frame)[..] {
                [_] => {
                    let source = self.evaluate(frame, frame.window)?;
                    self.values.draw_in_bands(&self.runner, source, size, bands)?;
                }
                pieces => {
                    self.held = None;
                    self.values.begin(&self.runner, size)?;
                    for &piece in pieces {
                        let source = self.evaluate(frame, piece)?;
                        let at = [piece.x - frame.window.x, piece.y - frame.window.y].map(|side| side as u32);
                        self.values.draw_piece(&self.runner, source, at, [piece.width, piece.height], bands)?;
                    }
                }
            }
            self.held = Some(frame);
        }
        Ok(())
    }

    /// The parts of a window that the evaluator can be readied for: all of it, but where its lattice is very fine,
    /// or doubles have no room.
    fn pieces(&self, frame: Frame) -> Vec<Window> {
        tiles::split(frame.window, self.series_sides(frame), self.canvas_pixels())
    }

    /// Readies the field of a whole frame: the one that is held, or the evaluator.
    pub(super) fn whole(&mut self, frame: Frame) -> Result<Source> {
        if self.held != Some(frame) && self.pieces(frame).len() == 1 {
            return self.evaluate(frame, frame.window);
        }
        self.hold(frame)?;
        self.values.bind();
        Ok(Source::HELD)
    }

    /// Leaves a range on the device that is not the field's own.
    pub(super) fn set_range(&mut self, range: [f32; 2]) {
        self.range.set(range);
        self.ranged = None;
    }

    /// Finds the field's range over the frame's window, and leaves it on the device.
    pub(super) fn reduce(&mut self, frame: Frame) -> Result<()> {
        let scale = self.plan()?.units().map(|unit| unit as f32);
        if let (true, Some((field, stamp))) = (self.held == Some(frame), self.values.drawn()) {
            if self.ranged != Some(stamp) {
                self.range.reset();
                self.range.add(&self.runner, field, scale)?;
                self.ranged = Some(stamp);
            }
            return Ok(());
        }
        self.range.reset();
        (self.held, self.ranged) = (None, None);
        for tile in self.tiles(frame) {
            let source = self.evaluate(frame, tile)?;
            let field = self.values.draw(&self.runner, source, tile.width, tile.height)?;
            self.range.add(&self.runner, field, scale)?;
        }
        Ok(())
    }

    /// Readies the plan's evaluator for a tile.
    pub(super) fn evaluate(&mut self, frame: Frame, tile: Window) -> Result<Source> {
        let Some(plan) = &self.scene else { return Err(Error::Gl("the renderer has no scene".into())) };
        let (runner, spectrum, evaluators) = (&self.runner, &self.spectrum, &mut self.evaluators);
        // First, since what it draws with is bound where others bind theirs.
        if let Some(local) = plan.local() {
            if self.localised != Some(frame) {
                local::upload(plan, local, frame, &mut self.local, runner)?;
                self.localised = Some(frame);
            }
            let (corner, size) = ([tile.x, tile.y], [tile.width, tile.height]);
            let alone = plan.layers().len() == 1;
            self.local.set_in_doubles(local.precision == Precision::Double && !alone);
            self.local.draw(runner, convert::bells(&local.groups), corner, size, frame)?;
        }
        if convert::sums(plan) {
            evaluators.direct([tile.x, tile.y], frame)?;
        }
        let exact = |series: &&Series| series.precision == Precision::Double;
        if let Some(series) = plan.series().filter(exact) {
            exactly(series, &mut self.exact, runner, frame, tile)?;
        } else if let Some(series) = plan.series() {
            let columns = || tiles::phases(tile.width, |i| frame.x(f64::from(tile.x) + i), series.period.x);
            let rows = || tiles::phases(tile.height, |j| frame.y(f64::from(tile.y) + j), series.period.y);
            match (series.evaluator, &series.lattice) {
                (Evaluator::Direct | Evaluator::Local | Evaluator::Plate, _) => {}
                (Evaluator::Series, _) => evaluators.series(runner, [&columns(), &rows()], spectrum)?,
                (Evaluator::Rows, _) => evaluators.rows(runner, [&columns(), &rows()], spectrum)?,
                (Evaluator::Grid, Some(summed @ Lattice { on_cpu: true, order, .. })) => {
                    let nodes = tiles::Nodes::new(summed, series.period, frame, tile);
                    let terms = self.terms.get_or_insert_with(|| spectrum.read());
                    let values = runner.run("nodes", || lattice::values(&series.counts, terms, &nodes, *order));
                    evaluators.grid_of(runner, &nodes.summed_tile(&values))?;
                }
                (Evaluator::Grid, Some(lattice)) => {
                    let nodes = tiles::Nodes::new(lattice, series.period, frame, tile);
                    let [columns, rows] = [nodes.phases(0), nodes.phases(1)];
                    evaluators.grid(runner, &nodes.tile([&columns, &rows]), spectrum)?;
                }
                (Evaluator::Grid, None) => return Err(Error::Plan("a grid without a lattice".into())),
            }
        }
        if plan.local().is_some() {
            // What a series in 64-bit floats was computed with may be bound in its place.
            self.local.bind();
        }
        if let Some(plate) = plan.plate() {
            self.plate.draw(plan, plate, runner, frame, tile)?;
        }
        Ok(convert::source(plan, evaluators.many()))
    }

    /// The spectrum: for each mode that the plan keeps, harmonic by harmonic of x, A, B, C and D of red, green and blue.
    /// Of a plan without a series it means nothing.
    pub(crate) fn spectrum_terms(&self) -> Vec<[f32; 4]> {
        let exact =
            self.scene.as_ref().and_then(Plan::series).is_some_and(|series| series.precision == Precision::Double);
        if exact {
            return self.exact.spectrum().into_iter().map(|term| term.map(|value| value as f32)).collect();
        }
        self.spectrum.read()
    }

    /// The constant term of the field's series, RGB: its mean over a period. None where the plan has no series.
    pub fn constant_term(&self) -> Option<[f64; 3]> {
        let plan = self.scene.as_ref().filter(|plan| plan.series().is_some())?;
        let (terms, units) = (self.spectrum_terms(), plan.units());
        Some([0, 1, 2].map(|colour| f64::from(terms[colour][0]) * units[colour]))
    }

    /// The device that it renders on.
    pub fn device(&self) -> &Rc<Device> {
        self.runner.device()
    }
}

/// Readies a series in 64-bit floats for a tile.
fn exactly(series: &Series, exact: &mut Exact, runner: &Runner, frame: Frame, tile: Window) -> Result<()> {
    let degree = series.degree();
    if let (Evaluator::Grid, Some(lattice)) = (series.evaluator, &series.lattice) {
        let nodes = tiles::Nodes::new(lattice, series.period, frame, tile);
        let [columns, rows] = [0, 1].map(|axis| nodes.waves(axis, degree[axis], lattice.order));
        return exact.grid(
            runner,
            [0, 1].map(|axis| Waves { positions: nodes.count(axis), values: [&columns, &rows][axis] }),
            &nodes.exact_tile(),
        );
    }
    let turns = [
        tiles::turns(tile.width, |i| frame.x(f64::from(tile.x) + i), series.period.x),
        tiles::turns(tile.height, |j| frame.y(f64::from(tile.y) + j), series.period.y),
    ];
    let [columns, rows] = [0, 1].map(|axis| waves(&turns[axis], &vec![1.0; degree[axis] as usize + 1]));
    let both = [0, 1].map(|axis| Waves { positions: turns[axis].len(), values: [&columns, &rows][axis] });
    match series.evaluator {
        Evaluator::Series => exact.series(runner, both),
        _ => exact.rows(runner, both),
    }
}
