//! The notes' plane: where an experiment's bells lie, and how a part of it becomes a picture.
//!
//! The notes count in units of their own, over x from −8 to 8, say. The renderer's frame counts in half picture heights.
//! A [`Canvas`] turns one into the other, each axis for itself, so that a window may be stretched as the prototype's was.

use std::sync::Arc;

use glam::DVec2;

use super::chart::{Axis, Chart, Map, Scalar};
use super::report::{Field, Figure};
use crate::Result;
use crate::frame::Frame;
use crate::plan::{Evaluator, Group, Layer, Plan, Precision, Series, Transform};
use crate::problem::Problem;
use crate::renderer::{Picture, Settings};
use crate::scene::Ghost;
use crate::series::Bell;

/// A rectangle of the notes' plane, and the pixels that show it. x points right, y up.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Canvas {
    pub frame: Frame,
    center: DVec2,
    /// Frame units for each unit of the notes.
    scale: DVec2,
}

impl Canvas {
    /// `width` × `height` pixels that show x and y between the two ends of each.
    pub fn new([width, height]: [u32; 2], x: [f64; 2], y: [f64; 2]) -> Self {
        let half = 0.5 * DVec2::new(x[1] - x[0], y[1] - y[0]);
        let aspect = f64::from(width) / f64::from(height);
        let center = 0.5 * DVec2::new(x[0] + x[1], y[0] + y[1]);
        Self { frame: Frame::full(width, height), center, scale: DVec2::new(aspect, 1.0) / half }
    }

    /// `count` pixels along x, whose centres lie on the line of that y.
    pub fn along_x(count: u32, x: [f64; 2], y: f64) -> Self {
        Self::new([count, 1], x, [y - 1.0, y + 1.0])
    }

    /// `count` pixels along y, whose centres lie on the line of that x; the first is at the top.
    pub fn along_y(count: u32, y: [f64; 2], x: f64) -> Self {
        Self::new([1, count], [x - 1.0, x + 1.0], y)
    }

    /// Where the centre of a pixel lies, rows counted from the top.
    pub fn position(&self, column: u32, row: u32) -> DVec2 {
        self.frame.position(f64::from(column), f64::from(row)) / self.scale + self.center
    }

    /// The positions of all pixels, row by row from the top.
    pub fn positions(&self) -> impl Iterator<Item = DVec2> + '_ {
        let Frame { width, height, .. } = self.frame;
        (0..height).flat_map(move |row| (0..width).map(move |column| self.position(column, row)))
    }

    /// The ends of x and y.
    fn ends(&self) -> [[f64; 2]; 2] {
        let half = DVec2::new(f64::from(self.frame.width) / f64::from(self.frame.height), 1.0) / self.scale;
        let (low, high) = (self.center - half, self.center + half);
        [[low.x, high.x], [low.y, high.y]]
    }

    /// `f` at all pixels.
    pub fn scalar(&self, f: impl Fn(DVec2) -> f64) -> Scalar {
        Scalar::from_fn(self.frame.width, self.frame.height, |column, row| f(self.position(column, row)))
    }

    /// A chart of a field over the canvas; see [`Scalar::chart`].
    pub fn chart(&self, field: &Scalar, title: &str, value: Axis, map: Map, side: u32) -> Chart {
        let [x, y] = self.ends();
        let axis = |label: &str, range| Axis { label: label.to_owned(), range: Some(range), log: false };
        field.chart(title, [axis("x", x), axis("y", y)], value, map, side)
    }
}

/// Bells of one kind and size, in the notes' units, and the series that they are expanded in.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Scene {
    pub bell: Bell,
    pub size: f64,
    pub centers: Vec<DVec2>,
    pub period: DVec2,
    pub degree: [u32; 2],
}

/// A field at a canvas's pixels.
pub(super) struct Drawn {
    pub canvas: Canvas,
    pub pixels: Vec<[f32; 4]>,
    pub scalar: Scalar,
}

impl Scene {
    /// The sum of the bells at a point, by definition.
    pub fn direct(&self, at: DVec2) -> f64 {
        let shape = self.bell.shape();
        self.centers.iter().map(|&center| shape.value(at - center, DVec2::splat(self.size))).sum()
    }

    /// The sum of the bells and their nearest copies, a period away: all that matter where bells are narrower than a period.
    pub fn periodised(&self, at: DVec2) -> f64 {
        let copies = (-1..=1).flat_map(|i| (-1..=1).map(move |j| DVec2::new(f64::from(i), f64::from(j))));
        copies.map(|copy| self.direct(at - copy * self.period)).sum()
    }

    /// The bells as ghosts on a canvas, of peak 1 in every colour.
    fn ghosts(&self, canvas: &Canvas) -> Vec<Ghost> {
        let one = |&center: &DVec2| Ghost {
            bell: self.bell.clone(),
            center: (center - canvas.center) * canvas.scale,
            size: self.size * canvas.scale,
            radiance: [1.0; 3],
        };
        self.centers.iter().map(one).collect()
    }

    /// A plan by hand: the notes' period, their whole rectangle of modes, all of their ghosts, and no promise of any
    /// error.
    fn plan(&self, canvas: &Canvas, evaluator: Evaluator) -> Plan {
        let group = Group {
            bell: self.bell.clone(),
            members: Arc::new((0..self.centers.len() as u32).collect()),
            ghosts: self.centers.len(),
            smallest: self.size * canvas.scale,
            largest: self.size * canvas.scale,
            proportional: true,
            weight: self.centers.len() as f64,
            degree: self.degree,
            transform: Transform::Dispatch,
        };
        let layer = match evaluator {
            Evaluator::Direct => Layer::direct([group]),
            _ => Layer::Series(Series {
                precision: Precision::Single,
                evaluator,
                period: self.period * canvas.scale,
                counts: vec![self.degree[1] + 1; self.degree[0] as usize + 1].into(),
                groups: vec![group],
                modes: None,
                lattice: None,
            }),
        };
        Plan::by_hand(Problem::new(self.ghosts(canvas), canvas.frame), vec![layer])
    }

    /// The bell's own coefficients: (a, b, p, r) for each mode.
    pub fn table(&self) -> Vec<[f64; 4]> {
        let counts = vec![self.degree[1] + 1; self.degree[0] as usize + 1];
        self.bell.shape().modes().table(&counts, self.size / self.period)
    }

    /// Gives the scene to a renderer.
    ///
    /// # Errors
    /// [`crate::Error::Gl`] where the driver refuses.
    pub fn set(&self, renderer: &mut Picture, canvas: &Canvas, evaluator: Evaluator) -> Result<()> {
        renderer.field.set_scene(&self.plan(canvas, evaluator))
    }

    /// The field of the series on the GPU, summed at every pixel as the prototype did.
    ///
    /// # Errors
    /// [`crate::Error::Gl`] where the driver refuses.
    pub fn draw(&self, renderer: &mut Picture, canvas: Canvas, settings: &Settings) -> Result<Drawn> {
        self.set(renderer, &canvas, Evaluator::Series)?;
        Drawn::new(renderer, canvas, settings)
    }

    /// The same with a table of (a, b, p, r) for each mode in the place of the bell's own coefficients.
    ///
    /// # Errors
    /// [`crate::Error::Gl`] where the driver refuses.
    pub fn draw_table(&self, renderer: &mut Picture, canvas: Canvas, table: &[[f64; 4]]) -> Result<Drawn> {
        let plan = self.plan(&canvas, Evaluator::Series);
        let table: Vec<_> = table.iter().map(|mode| mode.map(|value| value as f32)).collect();
        renderer.field.set_tabulated(&plan, &table)?;
        Drawn::new(renderer, canvas, &Settings::default())
    }
}

impl Drawn {
    fn new(renderer: &mut Picture, canvas: Canvas, settings: &Settings) -> Result<Self> {
        let pixels = renderer.glare(canvas.frame, settings)?;
        let values = pixels.iter().map(|pixel| f64::from(pixel[0])).collect();
        let scalar = Scalar { width: canvas.frame.width, height: canvas.frame.height, values };
        Ok(Self { canvas, pixels, scalar })
    }

    /// The largest difference from `f`; NaN where any value is.
    pub fn worst(&self, f: impl Fn(DVec2) -> f64) -> f64 {
        let errors = self.canvas.positions().zip(&self.scalar.values).map(|(at, value)| (value - f(at)).abs());
        errors.fold(0.0, |worst: f64, error| if error.is_nan() || error > worst { error } else { worst })
    }

    /// Value minus `f`, everywhere.
    pub fn error(&self, f: impl Fn(DVec2) -> f64) -> Scalar {
        let values = self.canvas.positions().zip(&self.scalar.values).map(|(at, value)| value - f(at)).collect();
        Scalar { values, ..self.scalar }
    }

    /// The field for OpenEXR.
    pub fn field(&self) -> Field {
        Field { width: self.scalar.width, height: self.scalar.height, pixels: self.pixels.clone() }
    }

    /// A figure of the field in false colours, with its EXR.
    ///
    /// # Errors
    /// [`crate::Error::Chart`] where it cannot be drawn.
    pub fn figure(&self, stem: &str, caption: &str, title: &str, range: [f64; 2]) -> Result<Figure> {
        let value = Axis { label: "value".into(), range: Some(range), log: false };
        let chart = self.canvas.chart(&self.scalar, title, value, Map::Inferno, SIDE);
        Ok(Figure::chart(stem, caption, &chart)?.field(self.field()))
    }
}

/// How long the longer side of a field's plot is, in pixels of the figure.
pub(super) const SIDE: u32 = 560;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn canvases_show_what_they_are_asked_to_and_y_points_up() {
        let canvas = Canvas::new([260, 520], [-8.0, 8.0], [-16.0, 16.0]);
        let [x, y] = canvas.ends();
        assert!((x[0] + 8.0).abs() < 1e-12 && (x[1] - 8.0).abs() < 1e-12, "{x:?}");
        assert!((y[0] + 16.0).abs() < 1e-12 && (y[1] - 16.0).abs() < 1e-12, "{y:?}");
        let top_left = canvas.position(0, 0);
        assert!((top_left - DVec2::new(-8.0 + 8.0 / 260.0, 16.0 - 16.0 / 520.0)).length() < 1e-12, "{top_left}");
        // A stretched window.
        let wide = Canvas::new([160, 90], [-3.0, 3.0], [-3.0, 3.0]);
        let corner = wide.position(159, 89);
        assert!((corner - DVec2::new(3.0 - 3.0 / 160.0, -3.0 + 3.0 / 90.0)).length() < 1e-12, "{corner}");
    }

    #[test]
    fn lines_lie_where_they_are_asked_to() {
        let line = Canvas::along_x(400, [-8.0, 8.0], -10.0);
        let ends = [line.position(0, 0), line.position(399, 0)];
        assert!((ends[0] - DVec2::new(-7.98, -10.0)).length() < 1e-12, "{}", ends[0]);
        assert!((ends[1] - DVec2::new(7.98, -10.0)).length() < 1e-12, "{}", ends[1]);
        let line = Canvas::along_y(400, [-16.0, 16.0], 5.0);
        assert!((line.position(0, 0) - DVec2::new(5.0, 15.96)).length() < 1e-12);
        assert!((line.position(0, 399) - DVec2::new(5.0, -15.96)).length() < 1e-12);
    }

    #[test]
    fn ghosts_stand_where_the_canvas_shows_them() {
        let scene = Scene {
            bell: Bell::Gaussian,
            size: 1.0,
            centers: vec![DVec2::new(5.0, -10.0)],
            period: DVec2::new(16.0, 32.0),
            degree: [20; 2],
        };
        let canvas = Canvas::new([260, 520], [-8.0, 8.0], [-16.0, 16.0]);
        let ghost = &scene.ghosts(&canvas)[0];
        assert!((ghost.center - DVec2::new(5.0 / 16.0, -10.0 / 16.0)).length() < 1e-12, "{}", ghost.center);
        assert!((ghost.size - DVec2::splat(1.0 / 16.0)).length() < 1e-12, "{}", ghost.size);
        assert!((scene.plan(&canvas, Evaluator::Series).period() - DVec2::new(1.0, 2.0)).length() < 1e-12);
        assert_eq!([scene.direct(DVec2::new(5.0, -10.0)), scene.periodised(DVec2::new(-11.0, 22.0))], [1.0, 1.0]);
    }
}
