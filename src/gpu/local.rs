//! `local`: ghosts drawn where they reach, one on top of the other, onto a canvas; or, in 64-bit floats, which cannot be
//! blended, summed at each pixel from the list of its block.

use std::ops::Range;

use glow::HasContext as _;

use super::context::Device;
use super::evaluators::{STEP, Words, within_rounds};
use super::exact::room;
use super::field::Bells;
use super::layout::{CANVAS, DoubleGhost, GHOSTS, LARGEST_POINT, LocalGhost, NODES, PARTIALS, PASS, SHAPES};
use super::resource::{Attribute, Buffer, Scratch, Texel, Texture, VertexArray};
use super::runner::Runner;
use crate::Result;
use crate::frame::Frame;

/// What points reach beyond the tile that their centres lie in, at most, in pixels.
const MARGIN: i32 = LARGEST_POINT / 2;

/// Pixels that one draw may add to: drivers reset themselves when one takes seconds.
const MOST_PIXELS: f64 = 2e9;
/// And bells in 64-bit floats.
const MOST_LISTED: f64 = 2e8;

/// The attributes of `local.vert`, in words of a [`LocalGhost`].
const ATTRIBUTES: [Attribute; 5] = [
    Attribute { location: 0, kind: glow::INT, count: 4, first: 0 },
    Attribute { location: 1, kind: glow::INT, count: 2, first: 4 },
    Attribute { location: 2, kind: glow::FLOAT, count: 4, first: 6 },
    Attribute { location: 3, kind: glow::FLOAT, count: 3, first: 10 },
    Attribute { location: 4, kind: glow::UNSIGNED_INT, count: 1, first: 13 },
];

/// Ghosts to be drawn, and which of them have which bell, one after the other.
pub(crate) struct Drawn<'a> {
    pub ghosts: &'a [LocalGhost],
    pub kinds: &'a [Kind],
}

/// Ghosts of one kind of bell, by their places: those that are points, then the others. A program for each: Mesa's software
/// renderer would compute all bells at every pixel where a shader chose between them.
pub(crate) struct Kind {
    /// The bell's file in `shaders/`.
    pub bell: &'static str,
    pub points: Range<usize>,
    pub quads: Range<usize>,
}

/// Ghosts in 64-bit floats, the last of which is none at all, and lists of them: for each kind of bell, where there are several,
/// and each block of pixels, row by row, where its list begins among these numbers; where the last one ends; then the lists, of
/// multiples of [`list_step`].
pub(crate) struct Listed<'a> {
    pub ghosts: &'a [DoubleGhost],
    pub lists: &'a [u32],
    pub kinds: u32,
    pub blocks: [u32; 2],
    /// A block's side is this power of two.
    pub shift: u32,
    /// The most ghosts that any block has, of all kinds together.
    pub longest: usize,
}

/// Ghosts that are summed in one round of a loop: no more than one, since what fills a list up costs as much as a ghost, but where
/// a block has so many that a software renderer would not go through as many rounds.
pub(crate) fn list_step(longest: usize) -> usize {
    const MANY: usize = 1 << 15;
    if longest > MANY { STEP } else { 1 }
}

/// What is on the device of either.
enum Scene {
    Nothing,
    Drawn(Vec<Batches>),
    Listed { columns: u32, blocks: u32, shift: u32, step: usize, bands: u32 },
}

/// The ghosts of one kind of bell as so many draws.
struct Batches {
    bell: &'static str,
    points: Vec<Range<usize>>,
    quads: Vec<Range<usize>>,
}

/// Draws the ghosts of `local`.
pub(crate) struct LocalPass {
    array: VertexArray,
    ghosts: Buffer<LocalGhost>,
    doubles: Buffer<DoubleGhost>,
    lists: Buffer<u32>,
    shapes: Buffer<Words>,
    tile: Buffer<[i32; 16]>,
    canvas: Scratch,
    /// The canvas of listed ghosts that are one layer of some: its head, then pixels of three doubles, two doubles an element.
    exact: Buffer<[f64; 2]>,
    /// Whether that is where it is read.
    in_doubles: bool,
    scene: Scene,
    /// Whether points are as large as they may be asked to.
    points: bool,
    blends: bool,
    device: std::rc::Rc<Device>,
}

impl LocalPass {
    pub fn new(runner: &Runner) -> Result<Self> {
        let device = runner.device();
        let (mut sizes, mut support) = ([0.0; 2], [0]);
        // SAFETY: the device keeps its context current on this thread; the range is of two numbers, and the support one.
        unsafe {
            let (gl, target) = (device.gl(), glow::TEXTURE_2D);
            gl.get_parameter_f32_slice(glow::POINT_SIZE_RANGE, &mut sizes);
            gl.get_internal_format_i32_slice(target, glow::RGBA32F, glow::FRAMEBUFFER_BLEND, &mut support);
        }
        Ok(Self {
            array: VertexArray::new(device)?,
            ghosts: Buffer::new(device, 0)?,
            doubles: Buffer::new(device, 0)?,
            lists: Buffer::new(device, 0)?,
            shapes: Buffer::new(device, 0)?,
            tile: Buffer::new(device, 1)?,
            canvas: Scratch::default(),
            exact: Buffer::new(device, 1)?,
            in_doubles: false,
            scene: Scene::Nothing,
            blends: [glow::FULL_SUPPORT, glow::CAVEAT_SUPPORT].contains(&(support[0] as u32)),
            points: sizes[1] >= LARGEST_POINT as f32,
            device: device.clone(),
        })
    }

    /// Whether the driver adds to what is on a canvas; OpenGL 4.3 lets it say that it does not.
    pub fn can_draw(&self) -> bool {
        self.blends
    }

    /// Uploads ghosts that are drawn, and what their bells need to know beside.
    ///
    /// # Errors
    /// [`Error::Gl`](crate::Error::Gl) where the driver refuses.
    pub fn set_drawn(&mut self, Drawn { ghosts, kinds }: &Drawn<'_>, shapes: &[[f32; 4]]) -> Result<()> {
        self.ghosts.store(ghosts)?;
        self.shapes.store(bytemuck::cast_slice(shapes))?;
        let of = |range: &Range<usize>| batches(&ghosts[range.clone()], range.start);
        let drawn = |kind: &Kind| Batches { bell: kind.bell, points: of(&kind.points), quads: of(&kind.quads) };
        self.scene = Scene::Drawn(kinds.iter().map(drawn).collect());
        Ok(())
    }

    /// Uploads ghosts that are listed, and what their bells need to know beside.
    ///
    /// # Errors
    /// [`Error::Gl`](crate::Error::Gl) where the driver refuses, or a list is longer than the software renderer goes through for one pixel.
    pub fn set_listed(&mut self, runner: &Runner, listed: &Listed<'_>, shapes: &[[f64; 4]]) -> Result<()> {
        let &Listed { kinds, blocks: [columns, rows], shift, longest, .. } = listed;
        let (blocks, step) = (columns * rows, list_step(longest));
        within_rounds(runner, longest / step + kinds as usize, "local", longest, "ghosts")?;
        self.doubles.store(listed.ghosts)?;
        self.lists.store(listed.lists)?;
        self.shapes.store(bytemuck::cast_slice(shapes))?;
        let places = listed.lists.len() - (kinds * blocks) as usize;
        let bands = (f64::from(1u32 << (2 * shift)) * places as f64 / MOST_LISTED).ceil() as u32;
        self.scene = Scene::Listed { columns, blocks, shift, step, bands };
        Ok(())
    }

    /// Draws the canvas of a tile, whose first pixel is `corner` in the picture of a frame, and binds it. `bells` are
    /// those that listed ghosts have.
    ///
    /// # Errors
    /// [`Error::Gl`](crate::Error::Gl) where the driver refuses.
    pub fn draw(
        &mut self,
        runner: &Runner,
        bells: Bells,
        corner: [i32; 2],
        [width, height]: [u32; 2],
        frame: Frame,
    ) -> Result<()> {
        let canvas = self.canvas.get(runner.device(), Texel::Rgba, width, height)?;
        self.shapes.bind_storage(SHAPES);
        self.tile.bind_uniform(PASS);
        match &self.scene {
            Scene::Nothing => canvas.clear(0.0),
            Scene::Drawn(kinds) => {
                let size = [width, height].map(|side| side as i32);
                let widest = self.device.info().limits.viewport;
                let fits = [0, 1].iter().all(|&axis| size[axis] + 2 * MARGIN <= widest[axis] as i32);
                canvas.clear(0.0);
                let mut one = |bell: &str, ranges: &[Range<usize>], points: bool| {
                    let margin = if points { MARGIN } else { 0 };
                    let [[x, y], [wide, high]] = [corner, size];
                    self.tile.store(&[[x, y, wide, high, margin, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]])?;
                    let how = How { points, margin, array: &self.array, bell };
                    add(runner, canvas, &self.ghosts, ranges, &how)
                };
                for Batches { bell, points, quads } in kinds {
                    one(bell, points, self.points && fits)?;
                    one(bell, quads, false)?;
                }
            }
            &Scene::Listed { columns, blocks, shift, step, bands } => {
                let window = frame.window;
                let words = |number: f64| [number.to_bits() as u32 as i32, (number.to_bits() >> 32) as i32];
                let ([aspect, aspect_high], [unit, unit_high]) = (words(frame.pixel_aspect), words(frame.unit));
                let [x, y] = corner;
                let size = [frame.width as i32, frame.height as i32];
                let [columns, blocks, shift, wide] = [columns, blocks, shift, width].map(|number| number as i32);
                #[rustfmt::skip]
                let words = [
                    x, y, size[0], size[1], window.x, window.y, columns, blocks, shift, wide, aspect, aspect_high, unit, unit_high, 0, 0,
                ];
                self.tile.store(&[words])?;
                self.doubles.bind_storage(GHOSTS);
                self.lists.bind_storage(PARTIALS);
                let step = format!("{step}u");
                let mut defines: Vec<(&str, &str)> = bells.defines().collect();
                defines.extend([("DOUBLE", "1"), ("LIST_STEP", &step)]);
                if self.in_doubles {
                    let pixels = width as usize * height as usize;
                    room(runner, &mut self.exact, 1 + (3 * pixels).div_ceil(2))?;
                    self.exact.store(&[[f64::from_bits(u64::from(width)), 0.0]])?;
                    self.exact.bind_storage(NODES);
                    defines.push(("EXACT", "1"));
                }
                runner.draw_in_bands("local_lists.frag", &defines, canvas, bands.min(height))?;
                runner.written();
            }
        }
        canvas.bind(CANVAS);
        Ok(())
    }

    /// Whether listed ghosts are one layer of some, and their canvas is to be one of doubles.
    pub fn set_in_doubles(&mut self, in_doubles: bool) {
        self.in_doubles = in_doubles;
    }

    /// Binds a canvas of doubles as it was drawn last.
    pub fn bind(&self) {
        if self.in_doubles {
            self.exact.bind_storage(NODES);
        }
    }
}

/// How ghosts are drawn.
struct How<'a> {
    points: bool,
    margin: i32,
    array: &'a VertexArray,
    bell: &'a str,
}

/// Adds ghosts to a canvas.
fn add(
    runner: &Runner,
    canvas: &Texture,
    ghosts: &Buffer<LocalGhost>,
    ranges: &[Range<usize>],
    how: &How<'_>,
) -> Result<()> {
    if ranges.is_empty() {
        return Ok(());
    }
    let points: &[(&str, &str)] = if how.points { &[("POINTS", "1")] } else { &[] };
    let defines: Vec<_> = std::iter::once(("BELL", how.bell)).chain(points.iter().copied()).collect();
    let program = runner.drawn_by("local.vert", "local.frag", &defines)?;
    let (gl, margin) = (runner.device().gl(), how.margin);
    let (width, height) = (canvas.level_width(0) as i32, canvas.level_height(0) as i32);
    runner.run("local", || {
        canvas.target(0);
        program.bind();
        how.array.bind();
        ghosts.bind_attributes(&ATTRIBUTES, u32::from(!how.points));
        // SAFETY: the device keeps its context current on this thread; the array's attributes are the buffer of ghosts, which
        // has those of every range: `set_drawn` took the ranges from the very slice that it stored.
        unsafe {
            // Points are clipped by their centres, and these may lie beyond the tile.
            gl.viewport(-margin, -margin, width + 2 * margin, height + 2 * margin);
            gl.enable(glow::BLEND);
            gl.blend_equation(glow::FUNC_ADD);
            gl.blend_func(glow::ONE, glow::ONE);
            if how.points {
                gl.enable(glow::PROGRAM_POINT_SIZE);
            }
            for (index, range) in ranges.iter().enumerate() {
                let (first, count) = (range.start, range.len() as i32);
                if index > 0 {
                    gl.flush();
                }
                if how.points {
                    gl.draw_arrays(glow::POINTS, first as i32, count);
                } else {
                    gl.draw_arrays_instanced_base_instance(glow::TRIANGLE_STRIP, 0, 4, count, first as u32);
                }
            }
            gl.disable(glow::PROGRAM_POINT_SIZE);
            gl.blend_func(glow::ONE, glow::ZERO);
            gl.disable(glow::BLEND);
        }
    });
    Ok(())
}

/// Ghosts as so many draws; `first` is the place of the first of them.
fn batches(ghosts: &[LocalGhost], first: usize) -> Vec<Range<usize>> {
    let (mut ranges, mut pixels, mut start) = (Vec::new(), 0.0, 0);
    for (index, ghost) in ghosts.iter().enumerate() {
        let [left, top, right, bottom] = ghost.area.map(f64::from);
        let more = (right - left) * (bottom - top);
        if pixels + more > MOST_PIXELS && index > start {
            ranges.push(first + start..first + index);
            (pixels, start) = (0.0, index);
        }
        pixels += more;
    }
    if start < ghosts.len() {
        ranges.push(first + start..first + ghosts.len());
    }
    ranges
}
