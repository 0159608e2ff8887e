//! The field of paraboloids by Graf's theorem: the notes' own way, kept for comparison.
//!
//! Bessel functions → the ghosts' spectrum over (k, m) → its sum over k at some hundred radii → at every pixel of a
//! quadrant the sum over m → the picture. Neither a pixel nor a radius costs more for more ghosts.

use std::f64::consts::TAU;
use std::rc::Rc;

use crate::Result;
use crate::frame::Frame;
use crate::gpu::field::FieldPass;
use crate::gpu::graf::{BesselCells, Graf, GrafGhosts, Place};
use crate::gpu::runner::Runner;
use crate::gpu::{Device, PassTime};
use crate::series::fourier_bessel::{FourierBessel, Kappa, Spot};
use crate::series::{phase, special};

/// The cells of the table of Bessel functions: off by 4e-8 at most.
const CELL: f64 = 1.0 / 16.0;
/// Radii lie so close that the fastest term turns by this, in radians, from one to the next. Hermite's cubics are then
/// off by 7e-5 of that term, which is itself some hundredth of the peak where there are many.
const RADIUS_STEP: f64 = 0.4;
/// But there are at least as many, so that few terms, which are not small, turn by less.
const FEWEST_RADII: f64 = 512.0;

/// What [`GrafRenderer`] renders.
#[derive(Debug, Clone, Copy)]
pub struct GrafScene<'a> {
    /// The bell's series about its centre; at least one term. Its radius is a length on the picture plane.
    pub series: &'a FourierBessel,
    /// The ghosts, on the picture plane. The series hold where a pixel is within the radius of each of them.
    pub spots: &'a [Spot],
    /// M, the highest angular order.
    pub highest: u32,
    /// 1, 2, 2, …, or what the notes print.
    pub kappa: Kappa,
}

/// Renders fields by Graf's theorem.
pub struct GrafRenderer {
    runner: Runner,
    graf: Graf,
    field: FieldPass,
}

impl GrafRenderer {
    /// A renderer that has rendered nothing yet.
    ///
    /// # Errors
    /// [`crate::Error::Gl`] where the driver refuses an object.
    pub fn new(device: &Rc<Device>) -> Result<Self> {
        let runner = Runner::new(device)?;
        Ok(Self { graf: Graf::new(&runner)?, field: FieldPass::new(&runner)?, runner })
    }

    /// Whether each pass is timed from now on; see [`GrafRenderer::take_times`].
    pub fn set_timing(&mut self, timing: bool) {
        self.runner.set_timing(timing);
    }

    /// The times of the passes since they were last taken.
    pub fn take_times(&mut self) -> Vec<PassTime> {
        self.runner.take_times()
    }

    /// The field at the pixels of the frame's window, row by row from the top. Builds every table anew.
    ///
    /// # Errors
    /// [`crate::Error::Gl`] where the driver refuses; where a table is larger than its textures may be, for example.
    pub fn render(&mut self, scene: &GrafScene<'_>, frame: Frame) -> Result<Vec<f32>> {
        let lookup = Lookup::new(scene, frame, self.runner.device().info().limits.texture_size);
        let zeros = scene.series.terms.len() as u32;
        let cubics =
            self.runner.run("bessel_cubics", || special::bessel_cubics(scene.highest, lookup.cell, lookup.cells));
        let cells = BesselCells { cubics: &cubics, orders: scene.highest + 1 };
        self.graf.set_bessel(&self.runner, &cells)?;
        self.graf.compute(
            &self.runner,
            zeros,
            &GrafGhosts {
                angles: &angles(scene.spots),
                places: &lookup.ghosts(scene),
                first_kappa: [0, 1].map(|m| scene.kappa.weight(m) as f32),
            },
        )?;
        self.graf.fill_radii(&self.runner, zeros, &lookup.radii(scene))?;
        let source = self.graf.source(&self.runner, frame, lookup.spacing)?;
        let (width, height) = (frame.window.width, frame.window.height);
        let field = self.field.draw(&self.runner, source, width, height)?;
        let mut pixels = vec![[0.0; 4]; frame.window.pixels()];
        self.runner.run("download", || field.read(&mut pixels, width as usize, width, height));
        self.runner.device().check("rendering by Graf's theorem")?;
        Ok(pixels.into_iter().map(|pixel| pixel[0]).collect())
    }
}

/// How fine the tables are.
struct Lookup {
    /// From cell to cell of the Bessel functions' argument.
    cell: f64,
    cells: u32,
    /// From radius to radius on the picture plane.
    spacing: f64,
    radii: u32,
}

impl Lookup {
    /// Tables that reach every pixel and every ghost, with no side above `texture_size`.
    fn new(scene: &GrafScene<'_>, frame: Frame, texture_size: u32) -> Self {
        let (low, high) = frame.bounds();
        let reach = low.abs().max(high.abs()).length().max(frame.pixel_sides().max_element());
        let farthest = scene.spots.iter().map(|spot| spot.center.length()).fold(reach, f64::max);
        let fastest = scene.series.terms.last().map_or(1.0, |term| term.alpha) / scene.series.radius;
        // Three to spare: for the last pixel's own rounding, and because steps have two ends.
        let most = f64::from(texture_size - 3);
        let cell = CELL.max(fastest * farthest / most);
        let steps = (fastest * reach / RADIUS_STEP).ceil().clamp(FEWEST_RADII, most);
        Self { cell, cells: (fastest * farthest / cell) as u32 + 2, spacing: reach / steps, radii: steps as u32 + 2 }
    }

    /// Where J_m(`x`) stands in the table.
    fn place(&self, x: f64, factor: f64) -> Place {
        let position = x / self.cell;
        let cell = position.floor().min(f64::from(self.cells - 1));
        [cell as f32, (position - cell) as f32, factor as f32, 0.0]
    }

    /// a_k w beside the place of α_k d/L, for each ghost and each zero.
    fn ghosts(&self, scene: &GrafScene<'_>) -> Vec<Place> {
        let (terms, radius) = (&scene.series.terms, scene.series.radius);
        let row = |spot: &Spot| {
            let (turn, weight) = (spot.center.length() / radius, spot.weight);
            terms.iter().map(move |term| self.place(term.alpha * turn, term.coefficient * weight))
        };
        scene.spots.iter().flat_map(row).collect()
    }

    /// Cells from radius to radius beside the place of α_k r/L, for each radius and each zero.
    fn radii(&self, scene: &GrafScene<'_>) -> Vec<Place> {
        let (terms, radius) = (&scene.series.terms, scene.series.radius);
        let row = |index: u32| {
            terms.iter().map(move |term| {
                let step = term.alpha * self.spacing / radius;
                self.place(f64::from(index) * step, step / self.cell)
            })
        };
        (0..self.radii).flat_map(row).collect()
    }
}

/// The ghosts' angles, in 2⁻³² of a turn.
fn angles(spots: &[Spot]) -> Vec<u32> {
    spots.iter().map(|spot| phase(spot.center.y.atan2(spot.center.x), TAU)).collect()
}
