//! What of a panorama's cells lies outside of a sight, and is accepted by its hood.

use glam::DVec3;

use super::clip::{Quad, outside};
use super::sight::{Rectangle, Sight};
use super::tree::{Cell, Place, Tree};
use crate::photo::Photo;
use crate::series::sphere::Grid;

/// The widest part of a pixel at the band's edge that is taken to be flat, in radians, and the most parts along its sides.
const FLAT: f64 = 0.02;
const PARTS: usize = 16;

/// A cell that a hood cuts is no larger than this, by its radius: a part of the ten degrees that the cut takes.
const FINE: f64 = 0.025;

/// Directions of which light is taken.
#[derive(Debug, Clone, Copy)]
pub(super) struct Zone {
    /// What is seen, and so no part of it; its edge is exact.
    pub shown: Rectangle,
    /// What lies inside belongs to the zone before.
    pub inner: Option<Border>,
    /// What lies beyond belongs to the zones behind.
    pub outer: Option<Border>,
}

/// Where one zone becomes the next. A cell on it is shared out between them, the same for both.
#[derive(Debug, Clone, Copy)]
pub(super) struct Border {
    pub rectangle: Rectangle,
    /// Cells that are shared are no larger than this, by their radius.
    pub shares: f64,
}

/// A cell of the panorama, or what is left of one.
#[derive(Debug, Clone, Copy)]
pub(super) enum Kept {
    /// All of it.
    Whole(Place),
    /// A part, by its number.
    Part(usize),
}

/// A part of a cell: what it holds, and of what cells.
struct Part {
    cell: Cell,
    kept: Vec<Kept>,
}

/// The light of a zone, by cells.
pub(super) struct Cut {
    parts: Vec<Part>,
    roots: Vec<Kept>,
    all: Cell,
}

/// What becomes of a cell.
enum Fate {
    Gone,
    Whole,
    /// The edge of what is seen goes through it.
    Edged,
    /// So much of it counts, where it is small enough: the first by the hood, the second between zones.
    Shared {
        small: bool,
        share: f64,
    },
}

/// What is cut: a panorama and its cells.
#[derive(Clone, Copy)]
pub(super) struct Whole<'a> {
    pub photo: &'a Photo,
    pub tree: &'a Tree,
}

impl Cut {
    pub fn new(whole: Whole, sight: &Sight, zone: &Zone) -> Self {
        let tree = whole.tree;
        let mut cut = Self { parts: Vec::new(), roots: Vec::new(), all: Cell::default() };
        cut.roots = tree.roots().filter_map(|root| cut.keep(whole, sight, zone, root)).collect();
        let roots: Vec<Cell> = cut.roots.iter().map(|&root| *cut.cell(tree, root)).collect();
        cut.all = Cell::sum(roots.into_iter(), sight.ahead());
        cut
    }

    pub fn roots(&self) -> &[Kept] {
        &self.roots
    }

    pub fn cell<'a>(&'a self, tree: &'a Tree, kept: Kept) -> &'a Cell {
        match kept {
            Kept::Whole(place) => tree.cell(place),
            Kept::Part(part) => &self.parts[part].cell,
        }
    }

    /// Hands what a cell is made of to `take`; says whether there is anything.
    pub fn each(&self, tree: &Tree, kept: Kept, take: impl FnMut(Kept)) -> bool {
        match kept {
            Kept::Whole(place) => tree.children(place).map(Kept::Whole).map(take).count() > 0,
            Kept::Part(part) => self.parts[part].kept.iter().copied().map(take).count() > 0,
        }
    }

    /// ∫ L A dΩ, RGB.
    pub fn flux(&self) -> [f64; 3] {
        self.all.flux
    }

    /// ∫ L A cos dΩ, RGB, by the cosine of the angle from a direction.
    pub fn towards(&self, direction: DVec3) -> [f64; 3] {
        let Cell { flux, dipole, centre, .. } = self.all;
        [0, 1, 2].map(|k| (flux[k] * centre + dipole[k]).dot(direction).max(0.0))
    }

    fn keep(&mut self, whole: Whole, sight: &Sight, zone: &Zone, place: Place) -> Option<Kept> {
        let tree = whole.tree;
        let cell = tree.cell(place);
        if cell.is_dark() {
            return None;
        }
        match zone.fate(cell, sight) {
            Fate::Gone => return None,
            Fate::Whole => return Some(Kept::Whole(place)),
            Fate::Shared { small, share } if small || place.level == 0 => {
                return self.part(cell.times(share), Vec::new());
            }
            Fate::Edged if place.level == 0 => return self.part(whole.edged(sight, zone, place), Vec::new()),
            Fate::Edged | Fate::Shared { .. } => {}
        }
        let kept: Vec<Kept> = tree.children(place).filter_map(|child| self.keep(whole, sight, zone, child)).collect();
        let cells: Vec<Cell> = kept.iter().map(|&kept| *self.cell(tree, kept)).collect();
        self.part(Cell::sum(cells.into_iter(), cell.centre), kept)
    }

    fn part(&mut self, cell: Cell, kept: Vec<Kept>) -> Option<Kept> {
        if cell.is_dark() {
            return None;
        }
        self.parts.push(Part { cell, kept });
        Some(Kept::Part(self.parts.len() - 1))
    }
}

impl Zone {
    fn fate(&self, cell: &Cell, sight: &Sight) -> Fate {
        let seen = sight.seen(cell.centre);
        let depth = self.shown.inside(seen);
        if depth >= cell.radius {
            return Fate::Gone;
        }
        let accepted = match sight.accepts_around(seen.z, cell.radius) {
            Some(false) => return Fate::Gone,
            accepted => accepted.is_some(),
        };
        let inner = self.inner.map_or(-1.0, |inner| inner.rectangle.inside(seen));
        let outer = self.outer.map_or(1.0, |outer| outer.rectangle.inside(seen));
        if inner >= cell.radius || outer <= -cell.radius {
            return Fate::Gone;
        }
        if depth > -cell.radius {
            return Fate::Edged;
        }
        // The most that a cell may be to be shared at the borders that cross it.
        let crossed = [(self.inner, -inner), (self.outer, outer)].into_iter().filter(|(_, depth)| *depth < cell.radius);
        let most = crossed.filter_map(|(border, _)| border).map(|border| border.shares).fold(f64::INFINITY, f64::min);
        if accepted && most == f64::INFINITY {
            return Fate::Whole;
        }
        let small = (accepted || cell.radius <= FINE) && cell.radius <= most;
        Fate::Shared { small, share: sight.accepts(seen.z) * self.own(seen, cell.radius) }
    }

    /// What of a small cell belongs to this zone, and to none before or behind: of all zones that is all of it.
    fn own(&self, seen: DVec3, radius: f64) -> f64 {
        let before = self.inner.map_or(0.0, |inner| inner.rectangle.share(seen, radius));
        let behind = self.outer.map_or(0.0, |outer| 1.0 - outer.rectangle.share(seen, radius));
        (1.0 - before - behind).max(0.0)
    }
}

impl Whole<'_> {
    /// What is left of a finest cell at the edge of what is seen: that of its pixels.
    fn edged(self, sight: &Sight, zone: &Zone, place: Place) -> Cell {
        let mut left = Vec::new();
        for (column, row) in self.tree.pixels_of(place) {
            let pixel = Cell::pixel(self.photo, self.tree.pixels(), column, row);
            let seen = sight.seen(pixel.centre);
            let depth = zone.shown.inside(seen);
            if pixel.is_dark() || depth >= pixel.radius {
                continue;
            }
            if depth <= -pixel.radius {
                left.push(pixel.times(sight.accepts(seen.z) * zone.own(seen, pixel.radius)));
            } else {
                left.extend(parts(self.tree.pixels(), [column, row], sight, &zone.shown).into_iter().map(|part| {
                    let seen = sight.seen(part.middle);
                    let share = part.share * sight.accepts(seen.z) * zone.own(seen, part.radius);
                    pixel.part(share, part.middle, part.radius)
                }));
            }
        }
        Cell::sum(left.iter().copied(), self.tree.cell(place).centre)
    }
}

/// A part of a pixel: the share of its light, a direction in the middle, and how far it reaches from there, about.
pub(super) struct Left {
    pub share: f64,
    pub middle: DVec3,
    pub radius: f64,
}

/// What of a pixel lies outside of a rectangle, by parts that are flat enough.
pub(super) fn parts(grid: Grid, [column, row]: [usize; 2], sight: &Sight, shown: &Rectangle) -> Vec<Left> {
    let side = std::f64::consts::PI / grid.height as f64;
    let count = ((side / FLAT).ceil() as usize).clamp(1, PARTS);
    divided(grid, [column, row], count, sight, shown)
}

/// The same by so many parts along each side.
pub(super) fn divided(
    grid: Grid,
    [column, row]: [usize; 2],
    count: usize,
    sight: &Sight,
    shown: &Rectangle,
) -> Vec<Left> {
    let at = |first: usize, k: f64| first as f64 - 0.5 + k / count as f64;
    // What is farther from a pole is wider.
    let width = |down: usize| grid.direction(0.0, at(row, down as f64 + 0.5)).truncate().length();
    let widths: f64 = (0..count).map(width).sum();
    // Half a diagonal, at the equator: no part is larger.
    let radius = std::f64::consts::PI / (grid.height * count) as f64 / std::f64::consts::SQRT_2;
    let mut left = Vec::new();
    for down in 0..count {
        let share = width(down) / widths / count as f64;
        for across in 0..count {
            let corner = |right: usize, below: usize| {
                sight.seen(grid.direction(at(column, (across + right) as f64), at(row, (down + below) as f64)))
            };
            let centre = grid.direction(at(column, across as f64 + 0.5), at(row, down as f64 + 0.5));
            let depth = shown.inside(sight.seen(centre));
            if depth >= radius {
                continue;
            }
            if depth <= -radius {
                left.push(Left { share, middle: centre, radius });
                continue;
            }
            let quad: Quad = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
            if let Some(part) = outside(&quad, shown) {
                let share = share * part.share;
                left.push(Left { share, middle: sight.unseen(part.middle), radius: part.radius });
            }
        }
    }
    left
}
