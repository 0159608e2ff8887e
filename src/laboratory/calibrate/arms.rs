//! Small renders that differ in one kind of work, timed in turns.

use std::hint::black_box;
use std::rc::Rc;
use std::time::Instant;

use glam::DVec2;

use crate::frame::Frame;
use crate::gpu::Device;
use crate::laboratory::bench::scenes::{by, by_hand, scattered};
use crate::measure::Rounds;
use crate::plan::{DOUBLE_ORDER, Evaluator, Gatherer, Gathering, Lattice, Plan, Precision, Transform};
use crate::renderer::{Picture, Scatter, Settings};
use crate::scene::Ghost;
use crate::series::CUBIC;
use crate::series::moments::Cells;
use crate::veil;
use crate::{Error, Result};

/// Milliseconds that a timing should take at least: so much that the clock and the waiting do not count.
const LONG_ENOUGH: f64 = 8.0;
/// Most repetitions in one timing.
const REPEATS: usize = 400;

/// What is done, and timed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Work {
    /// Copy the picture.
    Copy,
    /// Field and composite, from a spectrum that is there.
    Frame,
    /// The spectrum alone.
    Spectrum,
    /// Both.
    Everything,
    /// A veil by the CPU.
    VeilByCpu,
    /// The same by the device.
    VeilByDevice,
}

/// One thing to be timed.
pub(super) struct Arm {
    work: Work,
    /// Which of the stage's pictures.
    picture: usize,
    pub plan: Plan,
    /// The veil's, where it is one.
    pub veil: Option<veil::Plan>,
    repeats: usize,
}

impl Arm {
    /// Pixels of its picture.
    pub fn pixels(&self) -> f64 {
        self.plan.problem().frame().window.pixels() as f64
    }

    /// Rows of its picture.
    pub fn rows(&self) -> f64 {
        f64::from(self.plan.problem().frame().window.height)
    }
}

/// Every arm; what two of them differ in is a constant's work.
pub(super) struct Arms {
    pub all: Vec<Arm>,
    renderers: Vec<Picture>,
    scatter: Scatter,
}

/// The arms' places in [`Arms::all`].
pub(super) mod place {
    pub const COPY: usize = 0;
    pub const COPY_WIDE: usize = 1;
    pub const DIRECT: [usize; 2] = [2, 3];
    pub const SERIES: [usize; 2] = [4, 5];
    /// A few harmonics each way; many of y; many of x.
    pub const ROWS: [usize; 3] = [6, 7, 8];
    /// A coarse lattice; a fine one; the coarse one under a wide picture.
    pub const GRID: [usize; 3] = [9, 10, 11];
    pub const SPECTRUM: [usize; 2] = [12, 13];
    pub const MOMENTS: [usize; 2] = [14, 15];
    pub const TINY: usize = 16;
    /// A few small ghosts; many; a few large ones; a few small ones on a wide picture.
    pub const LOCAL: [usize; 4] = [17, 18, 19, 20];
    /// As `SERIES`, `ROWS` and `GRID`, in 64-bit floats.
    pub const SERIES_DOUBLE: [usize; 2] = [21, 22];
    pub const ROWS_DOUBLE: [usize; 3] = [23, 24, 25];
    pub const GRID_DOUBLE: [usize; 3] = [26, 27, 28];
    /// A veil of few taps, and one of many.
    pub const VEIL_BY_CPU: [usize; 2] = [29, 30];
    /// The same; and the one of few taps on a wide picture.
    pub const VEIL_BY_DEVICE: [usize; 3] = [31, 32, 33];
}

/// The narrow picture, the wide one and the tiny one, in pixels: a graphics card needs more to do.
fn pictures(software: bool) -> [Frame; 3] {
    let [narrow, wide] = if software { [[384, 216], [1536, 216]] } else { [[1920, 1080], [7680, 1080]] };
    [Frame::full(narrow[0], narrow[1]), Frame::full(wide[0], wide[1]), Frame::full(16, 16)]
}

impl Arms {
    /// Plans them all, and puts the pictures on the device.
    pub fn new(device: &Rc<Device>) -> Result<Self> {
        let frames = pictures(device.info().software);
        let renderer = |frame: &Frame| {
            let mut renderer = Picture::new(device)?;
            renderer.field.set_tile_pixels(frame.window.pixels());
            renderer.load(*frame, &vec![[0.5; 4]; frame.window.pixels()])?;
            Ok(renderer)
        };
        let sized = |work, picture: usize, count, size, plan: &dyn Fn(&[Ghost], Frame) -> Result<Plan>| {
            let frame = frames[picture];
            let ghosts = scattered(count, size, frame);
            Ok(Arm { work, picture, plan: plan(&ghosts, frame)?, veil: None, repeats: 1 })
        };
        let arm = |work, picture, count, plan: &dyn Fn(&[Ghost], Frame) -> Result<Plan>| {
            sized(work, picture, count, 0.3, plan)
        };
        let few = |evaluator, degree| move |ghosts: &[Ghost], frame| by_hand(evaluator, ghosts, frame, degree);
        let direct = |ghosts: &[Ghost], frame| by(Evaluator::Direct, ghosts, frame, 1e-3);
        let local = |ghosts: &[Ghost], frame| by(Evaluator::Local, ghosts, frame, 1e-2);
        let veil = |work, picture: usize, terms| {
            let veil = Some(veil(frames[picture], terms)?);
            arm(work, picture, 1, &direct).map(|arm| Arm { veil, ..arm })
        };
        let (series, rows) =
            (|degree| few(Evaluator::Series, [degree; 2]), |degree: [u32; 2]| few(Evaluator::Rows, degree));
        let all: Result<Vec<Arm>> = [
            arm(Work::Copy, 0, 1, &direct),
            arm(Work::Copy, 1, 1, &direct),
            arm(Work::Frame, 0, 10, &direct),
            arm(Work::Frame, 0, 60, &direct),
            arm(Work::Frame, 0, 4, &series(2)),
            arm(Work::Frame, 0, 4, &series(7)),
            arm(Work::Frame, 0, 4, &rows([10, 10])),
            arm(Work::Frame, 0, 4, &rows([10, 800])),
            arm(Work::Frame, 0, 4, &rows([60, 10])),
            arm(Work::Frame, 0, 4, &|ghosts, frame| grid(ghosts, frame, 20)),
            arm(Work::Frame, 0, 4, &|ghosts, frame| grid(ghosts, frame, 420)),
            arm(Work::Frame, 1, 4, &|ghosts, frame| grid(ghosts, frame, 20)),
            arm(Work::Spectrum, 0, 100, &rows([31, 31])),
            arm(Work::Spectrum, 0, 1000, &rows([31, 31])),
            arm(Work::Spectrum, 0, 1000, &gathered),
            arm(Work::Spectrum, 0, 11_000, &gathered),
            arm(Work::Everything, 2, 4, &|ghosts, frame| grid(ghosts, frame, 8)),
            sized(Work::Everything, 0, 60, SMALL, &local),
            sized(Work::Everything, 0, 3000, SMALL, &local),
            sized(Work::Everything, 0, 60, 0.3, &local),
            sized(Work::Everything, 1, 60, SMALL, &local),
            arm(Work::Frame, 0, 4, &|ghosts, frame| Ok(in_doubles(series(2)(ghosts, frame)?))),
            arm(Work::Frame, 0, 4, &|ghosts, frame| Ok(in_doubles(series(7)(ghosts, frame)?))),
            arm(Work::Frame, 0, 4, &|ghosts, frame| Ok(in_doubles(rows([10, 10])(ghosts, frame)?))),
            arm(Work::Frame, 0, 4, &|ghosts, frame| Ok(in_doubles(rows([10, 800])(ghosts, frame)?))),
            arm(Work::Frame, 0, 4, &|ghosts, frame| Ok(in_doubles(rows([60, 10])(ghosts, frame)?))),
            arm(Work::Frame, 0, 4, &|ghosts, frame| Ok(in_doubles(grid(ghosts, frame, 20)?))),
            arm(Work::Frame, 0, 4, &|ghosts, frame| Ok(in_doubles(grid(ghosts, frame, 420)?))),
            arm(Work::Frame, 1, 4, &|ghosts, frame| Ok(in_doubles(grid(ghosts, frame, 20)?))),
            veil(Work::VeilByCpu, 0, FEW_TERMS),
            veil(Work::VeilByCpu, 0, MANY_TERMS),
            veil(Work::VeilByDevice, 0, FEW_TERMS),
            veil(Work::VeilByDevice, 0, MANY_TERMS),
            veil(Work::VeilByDevice, 1, FEW_TERMS),
        ]
        .into_iter()
        .collect();
        let renderers = frames.iter().map(renderer).collect::<Result<_>>()?;
        Ok(Self { all: all?, renderers, scatter: Scatter::new(device)? })
    }

    /// Milliseconds that each arm takes, round after round; every other round runs backwards.
    ///
    /// # Errors
    /// [`crate::Error::Gl`] where the driver refuses.
    pub fn time(&mut self, rounds: Rounds) -> Result<Vec<Vec<f64>>> {
        for index in 0..self.all.len() {
            // The second time no shader is compiled.
            self.one(index)?;
            let once = self.one(index)?;
            self.all[index].repeats = ((LONG_ENOUGH / once.max(1e-3)).ceil() as usize).clamp(1, REPEATS);
        }
        let mut times = Vec::with_capacity(rounds.timed());
        for round in 0..rounds.timed() {
            let mut row = vec![0.0; self.all.len()];
            for turn in 0..self.all.len() {
                let index = if round % 2 == 0 { turn } else { self.all.len() - 1 - turn };
                row[index] = self.one(index)?;
            }
            times.push(row);
        }
        Ok(times)
    }

    /// Times one arm, after readying the device for it: milliseconds for one of its repetitions.
    fn one(&mut self, index: usize) -> Result<f64> {
        let arm = &self.all[index];
        if let Some(plan) = &arm.veil {
            return one_veil(arm, plan, &mut self.scatter);
        }
        let renderer = &mut self.renderers[arm.picture];
        renderer.field.set_scene(&arm.plan)?;
        renderer.draw(arm.plan.problem().frame(), &Settings::default())?;
        renderer.field.finish();
        let started = Instant::now();
        for _ in 0..arm.repeats {
            if matches!(arm.work, Work::Spectrum | Work::Everything) {
                renderer.field.forget_scene();
                renderer.field.set_scene(&arm.plan)?;
            }
            match arm.work {
                Work::Copy => renderer.draw_copy()?,
                Work::Frame | Work::Everything => renderer.draw(arm.plan.problem().frame(), &Settings::default())?,
                Work::Spectrum | Work::VeilByCpu | Work::VeilByDevice => {}
            }
        }
        renderer.field.finish();
        Ok(started.elapsed().as_secs_f64() * 1e3 / arm.repeats as f64)
    }
}

/// Times a veil: milliseconds for one of its repetitions.
fn one_veil(arm: &Arm, plan: &veil::Plan, scatter: &mut Scatter) -> Result<f64> {
    let told = |error: veil::Error| Error::Plan(error.to_string());
    let size = plan.size();
    let values = vec![0.5; 4 * size[0] * size[1]];
    let photo = veil::Photo::rgba(&values, size).map_err(told)?;
    let started = Instant::now();
    for _ in 0..arm.repeats {
        black_box(match arm.work {
            Work::VeilByCpu => plan.evaluate(&photo).map_err(told)?,
            _ => scatter.evaluate(plan, &photo)?,
        });
    }
    Ok(started.elapsed().as_secs_f64() * 1e3 / arm.repeats as f64)
}

/// Gaussians of a veil, each convolved on the pixels.
const FEW_TERMS: usize = 1;
const MANY_TERMS: usize = 5;

/// A veil of so many Gaussians, too narrow for lattices.
fn veil(frame: Frame, terms: usize) -> Result<veil::Plan> {
    let term = |index: usize| veil::Gaussian { sigma: 1.6 + 0.1 * index as f64, weight: 1.0 };
    let mixture = veil::Mixture { terms: (0..terms).map(term).collect(), ..veil::Mixture::default() };
    let told = |error: veil::Error| Error::Plan(error.to_string());
    let plane = veil::Geometry::Planar { pitch: 1.0, solid_angle: 1.0 };
    let size = [frame.window.width as usize, frame.window.height as usize];
    let kernel = veil::Kernel::from_mixture(mixture).map_err(told)?;
    veil::Plan::new(&plane, &kernel, size, veil::Border::None, 1e-3).map_err(told)
}

/// Small ghosts: of a pixel or two.
const SMALL: f64 = 0.01;

/// The same plan, its series in 64-bit floats.
fn in_doubles(plan: Plan) -> Plan {
    plan.with_series(|series| {
        series.precision = Precision::Double;
        if let Some(lattice) = &mut series.lattice {
            lattice.order = DOUBLE_ORDER;
        }
    })
}

/// A few modes, gathered from cells of many moments. Sizes differ, and the error does not matter here.
fn gathered(ghosts: &[Ghost], frame: Frame) -> Result<Plan> {
    let plan = by_hand(Evaluator::Rows, ghosts, frame, [2, 2])?;
    Ok(plan.with_series(|series| {
        for group in &mut series.groups {
            group.transform = Transform::Gather(Gathering { by: Gatherer::Cells(CELLS), sizes: 1 });
        }
    }))
}

const CELLS: Cells = Cells { counts: [8, 8], orders: [12, 12] };

/// What a plan's gathered ghosts have to do each, in moments.
pub(super) fn moments(plan: &Plan) -> f64 {
    plan.groups().next().map_or(0.0, |group| group.transform.moments())
}

/// By `grid`, with hardly any terms, on a lattice of so many columns and few lines.
fn grid(ghosts: &[Ghost], frame: Frame, columns: u32) -> Result<Plan> {
    const LINES: u32 = 12;
    // Beside the cells that the picture covers, a B-spline needs three nodes more, and the last pixel one.
    const BEYOND: u32 = 4;
    let plan = by_hand(Evaluator::Grid, ghosts, frame, [2, 2])?;
    let (low, high) = frame.bounds();
    let cells = [columns, LINES].map(|nodes| f64::from(nodes - BEYOND) + 0.5);
    let step = (high - low) / DVec2::from(cells);
    let lattice = Lattice {
        order: CUBIC,
        step,
        nodes: [columns, LINES],
        oversampling: DVec2::ONE,
        on_cpu: false,
        error: f64::INFINITY,
    };
    Ok(plan.with_series(|series| series.lattice = Some(lattice)))
}
