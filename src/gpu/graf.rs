//! Graf's theorem on the device: places of ghosts and of radii in, the function `glare(pixel)` out.
//!
//! What is looked up where comes as tables in f64's accuracy; this file only knows their shapes.

use super::field::Source;
use super::layout::{BESSEL, EVALUATOR, FOLDED, GHOSTS, PASS, PLACES, RADIAL, SPECTRUM};
use super::resource::{Buffer, Scratch, Texel};
use super::runner::Runner;
use crate::Result;
use crate::frame::Frame;

/// Ghosts in one dispatch: far below the 65535 rounds after which Mesa's software renderer ends a loop without a word.
const BATCH: usize = 4096;
/// Invocations along m in a work group.
pub(super) const LANES: u32 = 64;

/// Where to look into the table of Bessel functions: cell, fraction, and what `graf_spectrum.comp` and
/// `graf_radial.frag` say of z; w is unused.
pub(crate) type Place = [f32; 4];

/// A table of J_0 to J_M: for each cell one after the other, for each order, the coefficients of 1, t, t², t³.
pub(crate) struct BesselCells<'a> {
    pub cubics: &'a [[f32; 4]],
    /// M + 1.
    pub orders: u32,
}

/// Ghosts as the spectrum reads them.
pub(crate) struct GrafGhosts<'a> {
    /// Their angles, in 2⁻³² of a turn.
    pub angles: &'a [u32],
    /// For each ghost one after the other, for each zero, its place.
    pub places: &'a [Place],
    /// κ of m = 0 and of m = 1.
    pub first_kappa: [f32; 2],
}

/// The tables on the device.
pub(crate) struct Graf {
    bessel: Scratch,
    places: Scratch,
    radial: Scratch,
    folded: Scratch,
    angles: Buffer<u32>,
    spectrum: Buffer<[f32; 2]>,
    uniforms: Buffer<[u32; 4]>,
    evaluator: Buffer<[u32; 4]>,
    orders: u32,
}

impl Graf {
    /// Tables with nothing in them.
    pub fn new(runner: &Runner) -> Result<Self> {
        let device = runner.device();
        Ok(Self {
            bessel: Scratch::default(),
            places: Scratch::default(),
            radial: Scratch::default(),
            folded: Scratch::default(),
            angles: Buffer::new(device, 0)?,
            spectrum: Buffer::new(device, 0)?,
            uniforms: Buffer::new(device, 3)?,
            evaluator: Buffer::new(device, 2)?,
            orders: 1,
        })
    }

    /// Uploads the Bessel functions, which know nothing of ghosts, and binds them.
    pub fn set_bessel(&mut self, runner: &Runner, cells: &BesselCells<'_>) -> Result<()> {
        self.orders = cells.orders;
        let count = (cells.cubics.len() / cells.orders as usize) as u32;
        let texture = self.bessel.get(runner.device(), Texel::Rgba, cells.orders, count)?;
        texture.write(cells.cubics, cells.orders as usize, cells.orders, count);
        texture.bind(BESSEL);
        Ok(())
    }

    /// Sums the ghosts into the spectrum of `zeros` zeros of J_0.
    pub fn compute(&mut self, runner: &Runner, zeros: u32, ghosts: &GrafGhosts<'_>) -> Result<()> {
        self.spectrum.store(&vec![[0.0; 2]; (zeros * self.orders) as usize])?;
        self.spectrum.bind_storage(SPECTRUM);
        let row = zeros as usize;
        for (angles, places) in ghosts.angles.chunks(BATCH).zip(ghosts.places.chunks(BATCH * row)) {
            self.angles.store(angles)?;
            self.angles.bind_storage(GHOSTS);
            self.set_places(runner, zeros, places)?;
            let [zeroth, first] = ghosts.first_kappa.map(f32::to_bits);
            self.uniforms.store(&[[angles.len() as u32, self.orders, zeroth, first]])?;
            self.uniforms.bind_uniform(PASS);
            runner.dispatch("graf_spectrum.comp", &[], [self.orders.div_ceil(LANES), zeros, 1])?;
        }
        Ok(())
    }

    /// Sums the spectrum over its zeros at each radius: `places` for each radius one after the other, for each zero.
    pub fn fill_radii(&mut self, runner: &Runner, zeros: u32, places: &[Place]) -> Result<()> {
        self.set_places(runner, zeros, places)?;
        self.uniforms.store(&[[zeros, self.orders, 0, 0]])?;
        self.uniforms.bind_uniform(PASS);
        let radii = (places.len() / zeros as usize) as u32;
        let texture = self.radial.get(runner.device(), Texel::Rgba, self.orders, radii)?;
        runner.draw("graf_radial.frag", &[], texture, 0)?;
        texture.bind(RADIAL);
        Ok(())
    }

    /// The function at the pixels of a frame's window, with radii `spacing` apart on the picture plane.
    ///
    /// Pixels that mirror each other in the axes share a radius and all sums over m up to their signs, so these are
    /// done once, in the quadrant that the window is folded into.
    pub fn source(&mut self, runner: &Runner, frame: Frame, spacing: f64) -> Result<Source> {
        let Frame { width, height, window, .. } = frame;
        let (x, y) = (folded(width, window.x, window.width), folded(height, window.y, window.height));
        let radii = self.radial.current().map_or(2, |texture| texture.level_height(0));
        let rate = (1.0 / spacing) as f32;
        let first = [x.0, y.0, 1 - width % 2, 1 - height % 2];
        let unit = (0.5 * frame.pixel_sides()).to_array().map(|half| (half as f32).to_bits());
        self.uniforms.store(&[first, [rate.to_bits(), self.orders, radii - 2, 0], [unit[0], unit[1], 0, 0]])?;
        self.uniforms.bind_uniform(PASS);
        let texture = self.folded.get(runner.device(), Texel::Rgba, x.1 - x.0 + 1, y.1 - y.0 + 1)?;
        runner.draw("graf_folded.frag", &[], texture, 0)?;
        texture.bind(FOLDED);
        self.evaluator.store(&[[window.x as u32, window.y as u32, width, height], [x.0, y.0, 0, 0]])?;
        self.evaluator.bind_uniform(EVALUATOR);
        Ok(Source::of("\"evaluators/graf.glsl\""))
    }

    fn set_places(&mut self, runner: &Runner, zeros: u32, places: &[Place]) -> Result<()> {
        let rows = (places.len() / zeros as usize) as u32;
        let texture = self.places.get(runner.device(), Texel::Rgba, zeros, rows)?;
        texture.write(places, zeros as usize, zeros, rows);
        texture.bind(PLACES);
        Ok(())
    }
}

/// The nearest and the farthest of `count` pixels from `first` on, counted from the middle of a side of `side` pixels.
fn folded(side: u32, first: i32, count: u32) -> (u32, u32) {
    let fold = |pixel: i64| ((2 * pixel + 1 - i64::from(side)).unsigned_abs() / 2) as u32;
    let (first, last) = (i64::from(first), i64::from(first) + i64::from(count) - 1);
    let (near, far) = (fold(first).min(fold(last)), fold(first).max(fold(last)));
    let across = 2 * first + 1 < i64::from(side) && 2 * last + 1 > i64::from(side);
    (if across { 0 } else { near }, far)
}
