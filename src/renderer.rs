//! The main path: spectrum → field → normalise → composite.
//!
//! ```text
//! let mut renderer = Renderer::new(&device)?;
//! renderer.set_scene(&ghosts, &plan)?;          // the spectrum, once
//! renderer.composite(&frame, &mut pixels, &settings)?;
//! ```

mod tiles;

use std::rc::Rc;

use crate::frame::{Frame, Window};
use crate::gpu::composite::{Composite, CompositePass, Variant};
use crate::gpu::copy::CopyPass;
use crate::gpu::evaluators::Evaluators;
use crate::gpu::field::{FieldPass, Source};
use crate::gpu::layout::{DirectGhost, SpectralGhost};
use crate::gpu::range::RangePass;
use crate::gpu::runner::Runner;
use crate::gpu::spectrum::{Spectrum, SpectrumGroup};
use crate::gpu::{Device, PassTime};
use crate::plan::{Evaluator, Plan};
use crate::scene::Ghost;
use crate::series::{Bell, phase};
use crate::{Error, Result};

/// How the field's values become glare.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, clap::ValueEnum)]
#[serde(rename_all = "lowercase")]
pub enum Normalize {
    /// As they are: physical.
    #[default]
    None,
    /// Clamped to 0..1.
    Clamp,
    /// Stretched so that the smallest over the picture becomes 0 and the largest 1, all colours alike; the prototype's.
    Minmax,
}

/// What a person sets about the picture; the field does not depend on it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// What the glare is multiplied by; 0 leaves the photo as it is.
    pub strength: f64,
    /// How the field's values become glare.
    pub normalize: Normalize,
    /// What a light keeps of itself, RGB; 1 unless light is taken from the photo.
    pub light_gain: [f64; 3],
    /// The luminance from which on a pixel is a light.
    pub threshold: f64,
    /// Weights of R, G and B in luminance.
    pub luminance: [f64; 3],
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            strength: 1.0,
            normalize: Normalize::None,
            light_gain: [1.0; 3],
            threshold: f64::INFINITY,
            luminance: [0.2126, 0.7152, 0.0722],
        }
    }
}

/// Holds the scene on the device, and renders pictures with it.
pub struct Renderer {
    runner: Runner,
    spectrum: Spectrum,
    evaluators: Evaluators,
    field: FieldPass,
    range: RangePass,
    composite: CompositePass,
    copy: CopyPass,
    scene: Option<(Vec<Ghost>, Plan)>,
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
            scene: None,
            tile_pixels: tiles::PIXELS,
            runner,
        })
    }

    /// Computes the spectrum of the ghosts that the plan keeps, unless it is there already.
    ///
    /// # Errors
    /// [`Error::Gl`] where the driver refuses.
    pub fn set_scene(&mut self, ghosts: &[Ghost], plan: &Plan) -> Result<()> {
        if self.scene.as_ref().is_some_and(|(old, by)| by == plan && old == ghosts) {
            return Ok(());
        }
        self.scene = None;
        if plan.evaluator == Evaluator::Direct {
            self.evaluators.set_ghosts(&self.runner, &direct_ghosts(ghosts, plan))?;
        } else {
            let spectral: Vec<_> =
                plan.groups.iter().map(|group| spectral_ghosts(ghosts, plan, &group.members)).collect();
            let groups: Vec<_> = (plan.groups.iter().zip(&spectral))
                .map(|(group, ghosts)| SpectrumGroup {
                    bell: group.bell.shape().shader(),
                    ghosts,
                    degree: group.degree,
                })
                .collect();
            self.spectrum.compute(&self.runner, &plan.counts, &groups)?;
        }
        self.scene = Some((ghosts.to_vec(), plan.clone()));
        Ok(())
    }

    /// Adds the glare to the pixels of the frame's window, row by row from the top.
    ///
    /// # Errors
    /// [`Error::Gl`] where the driver refuses, or where there is no scene.
    pub fn composite(&mut self, frame: Frame, pixels: &mut [[f32; 4]], settings: &Settings) -> Result<()> {
        let uniforms = self.start(frame, settings)?;
        let stride = frame.window.width as usize;
        assert_eq!(pixels.len(), frame.window.pixels(), "as many pixels as the window has");
        for tile in self.tiles(frame.window) {
            let source = self.evaluate(frame, tile)?;
            let at = offset(frame.window, tile);
            let photo = self.composite.photo(&self.runner, tile.width, tile.height)?;
            self.runner.run("upload", || photo.write(&pixels[at..], stride, tile.width, tile.height));
            let picture = self.composite.draw(&self.runner, variant(source, settings), &uniforms)?;
            self.runner.run("readback", || picture.read(&mut pixels[at..], stride, tile.width, tile.height));
        }
        Ok(())
    }

    /// Puts the photo of a frame that is small enough for one tile on the device, for [`Renderer::draw`].
    ///
    /// # Errors
    /// [`Error::Gl`] where the frame is too large for one tile, or the driver refuses.
    pub fn load(&mut self, frame: Frame, pixels: &[[f32; 4]]) -> Result<()> {
        assert_eq!(pixels.len(), frame.window.pixels(), "as many pixels as the window has");
        let &[tile] = &self.tiles(frame.window)[..] else {
            return Err(Error::Gl("the picture does not fit one tile".into()));
        };
        let photo = self.composite.photo(&self.runner, tile.width, tile.height)?;
        self.runner.run("upload", || photo.write(pixels, tile.width as usize, tile.width, tile.height));
        Ok(())
    }

    /// Draws the loaded photo with its glare and leaves the picture on the device. Does not wait for it.
    ///
    /// # Errors
    /// [`Error::Gl`] where the driver refuses, or where there is no scene.
    pub fn draw(&mut self, frame: Frame, settings: &Settings) -> Result<()> {
        let uniforms = self.start(frame, settings)?;
        let source = self.evaluate(frame, frame.window)?;
        self.composite.draw(&self.runner, variant(source, settings), &uniforms)?;
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
        self.scene = None;
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
            let glare = self.composite.draw_glare(&self.runner, variant(source, settings), &uniforms, size)?;
            let at = offset(frame.window, tile);
            self.runner.run("readback", || glare.read(&mut pixels[at..], stride, tile.width, tile.height));
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
            let local: Vec<_> = mine.iter().map(|&k| [pixels[k][0] - tile.x, pixels[k][1] - tile.y]).collect();
            for (&index, value) in mine.iter().zip(self.field.probe(&self.runner, source, &local)?) {
                values[index] = [0, 1, 2].map(|colour| f64::from(value[colour]) * scale[colour]);
            }
        }
        Ok(values)
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
        self.scene.as_ref().map(|(_, plan)| plan).ok_or_else(|| Error::Gl("the renderer has no scene".into()))
    }

    fn tiles(&self, window: Window) -> Vec<Window> {
        let limits = &self.runner.device().info().limits;
        let side = limits.texture_size.min(limits.viewport[0]).min(limits.viewport[1]);
        tiles::split(window, side, self.tile_pixels)
    }

    /// Finds the range where the settings ask for it, and gives the composite's uniforms.
    fn start(&mut self, frame: Frame, settings: &Settings) -> Result<Composite> {
        let plan = self.plan()?;
        let rgb = |v: [f64; 3], w: f64| [v[0] as f32, v[1] as f32, v[2] as f32, w as f32];
        let uniforms = Composite {
            scale: rgb(plan.scale, 0.0),
            light_gain: rgb(settings.light_gain, 1.0),
            luminance: rgb(settings.luminance, settings.threshold),
            strength: settings.strength as f32,
            pad: [0.0; 3],
        };
        if settings.normalize == Normalize::Minmax {
            self.reduce(frame)?;
        }
        self.range.bind();
        Ok(uniforms)
    }

    /// Finds the field's range over the frame's window, and leaves it on the device.
    fn reduce(&mut self, frame: Frame) -> Result<()> {
        let scale = self.plan()?.scale.map(|scale| scale as f32);
        self.range.reset();
        for tile in self.tiles(frame.window) {
            let source = self.evaluate(frame, tile)?;
            let field = self.field.draw(&self.runner, source, tile.width, tile.height)?;
            self.range.add(&self.runner, field, scale)?;
        }
        Ok(())
    }

    /// Readies the plan's evaluator for a tile.
    fn evaluate(&mut self, frame: Frame, tile: Window) -> Result<Source> {
        let Some((_, plan)) = &self.scene else { return Err(Error::Gl("the renderer has no scene".into())) };
        let (runner, spectrum, evaluators) = (&self.runner, &self.spectrum, &mut self.evaluators);
        match plan.evaluator {
            Evaluator::Direct => {
                evaluators.direct([tile.x, tile.y], [frame.width as i32, frame.height as i32])?;
            }
            Evaluator::Series | Evaluator::Rows => {
                let columns = tiles::phases(tile.width, |i| frame.x(f64::from(tile.x) + i), plan.period.x);
                let rows = tiles::phases(tile.height, |j| frame.y(f64::from(tile.y) + j), plan.period.y);
                if plan.evaluator == Evaluator::Series {
                    evaluators.series(runner, [&columns, &rows], spectrum)?;
                } else {
                    evaluators.rows(runner, [&columns, &rows], spectrum)?;
                }
            }
            Evaluator::Grid => {
                let lattice = plan.lattice.as_ref().ok_or_else(|| Error::Plan("a grid without a lattice".into()))?;
                let nodes = tiles::Nodes::new(lattice, plan.period, frame, tile);
                evaluators.grid(runner, &nodes.tile(), spectrum)?;
            }
        }
        Ok(source(plan.evaluator))
    }
}

/// The GLSL function that an evaluator has readied.
fn source(evaluator: Evaluator) -> Source {
    match evaluator {
        // The Gaussian is the only bell so far; `direct` would run once for each bell.
        Evaluator::Direct => {
            Source { evaluator: "\"evaluators/direct.glsl\"", bell: Some(Bell::Gaussian.shape().shader()) }
        }
        Evaluator::Series => Source { evaluator: "\"evaluators/series.glsl\"", bell: None },
        Evaluator::Rows => Source { evaluator: "\"evaluators/rows.glsl\"", bell: None },
        Evaluator::Grid => Source { evaluator: "\"evaluators/grid.glsl\"", bell: None },
    }
}

/// The composite that the settings ask for.
fn variant(source: Source, settings: &Settings) -> Variant {
    let normalize = match settings.normalize {
        Normalize::None => "0",
        Normalize::Clamp => "1",
        Normalize::Minmax => "2",
    };
    Variant { source, normalize, take_light: settings.light_gain != [1.0; 3] }
}

/// Where a tile's first pixel stands among the window's.
fn offset(window: Window, tile: Window) -> usize {
    (tile.y - window.y) as usize * window.width as usize + (tile.x - window.x) as usize
}

fn spectral_ghosts(ghosts: &[Ghost], plan: &Plan, members: &[u32]) -> Vec<SpectralGhost> {
    let convert = |&index: &u32| {
        let ghost = &ghosts[index as usize];
        let size = ghost.size / plan.period;
        SpectralGhost {
            phase: [phase(ghost.center.x, plan.period.x), phase(ghost.center.y, plan.period.y)],
            size: [size.x as f32, size.y as f32],
            weight: weight(ghost, plan),
            pad: 0.0,
        }
    };
    members.iter().map(convert).collect()
}

fn direct_ghosts(ghosts: &[Ghost], plan: &Plan) -> Vec<DirectGhost> {
    let convert = |&index: &u32| {
        let ghost = &ghosts[index as usize];
        let inverse = 1.0 / ghost.size;
        DirectGhost {
            center: [ghost.center.x as f32, ghost.center.y as f32],
            inverse_size: [inverse.x as f32, inverse.y as f32],
            weight: weight(ghost, plan),
            pad: 0.0,
        }
    };
    plan.groups.iter().flat_map(|group| &group.members).map(convert).collect()
}

fn weight(ghost: &Ghost, plan: &Plan) -> [f32; 3] {
    [0, 1, 2].map(|colour| (ghost.radiance[colour] / plan.scale[colour]) as f32)
}
