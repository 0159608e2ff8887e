//! What of a panorama's cells lies outside of a sight, and is accepted by its hood.

use glam::DVec3;

use super::sight::{Rectangle, Sight};
use super::tree::{Cell, Place, Tree};

/// Parts along each side of a finest cell at the band's edge.
const PARTS: usize = 10;

/// A cell that a hood cuts is no larger than this, by its radius: a part of the ten degrees that the cut takes.
const FINE: f64 = 0.025;

/// Directions of which light is taken.
#[derive(Debug, Clone, Copy)]
pub(super) struct Zone {
    /// What is seen, and so no part of it; its edge is exact.
    pub shown: Rectangle,
    /// What belongs to the zone before; a cell on its edge is shared.
    pub inner: Option<Rectangle>,
    /// What belongs to the zones behind lies beyond that.
    pub outer: Option<Rectangle>,
    /// Cells that zones share are no larger than this, by their radius.
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

impl Cut {
    pub fn new(tree: &Tree, sight: &Sight, zone: &Zone) -> Self {
        let mut cut = Self { parts: Vec::new(), roots: Vec::new(), all: Cell::default() };
        cut.roots = tree.roots().filter_map(|root| cut.keep(tree, sight, zone, root)).collect();
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

    fn keep(&mut self, tree: &Tree, sight: &Sight, zone: &Zone, place: Place) -> Option<Kept> {
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
            Fate::Edged if place.level == 0 => return self.part(edged(tree, sight, zone, place), Vec::new()),
            Fate::Edged | Fate::Shared { .. } => {}
        }
        let kept: Vec<Kept> = tree.children(place).filter_map(|child| self.keep(tree, sight, zone, child)).collect();
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
        let inner = self.inner.map_or(-1.0, |inner| inner.inside(seen));
        let outer = self.outer.map_or(1.0, |outer| outer.inside(seen));
        if inner >= cell.radius || outer <= -cell.radius {
            return Fate::Gone;
        }
        if depth > -cell.radius {
            return Fate::Edged;
        }
        let is_in_one = inner <= -cell.radius && outer >= cell.radius;
        if accepted && is_in_one {
            return Fate::Whole;
        }
        let small = (accepted || cell.radius <= FINE) && (is_in_one || cell.radius <= self.shares);
        Fate::Shared { small, share: sight.accepts(seen.z) * self.own(seen, cell.radius) }
    }

    /// What of a small cell belongs to this zone, and to none before or behind: of all zones that is all of it.
    fn own(&self, seen: DVec3, radius: f64) -> f64 {
        let before = self.inner.map_or(0.0, |inner| inner.share(seen, radius));
        let behind = self.outer.map_or(0.0, |outer| 1.0 - outer.share(seen, radius));
        (1.0 - before - behind).max(0.0)
    }
}

/// What is left of a finest cell at the edge of what is seen: its parts, each by the share of it that lies outside.
fn edged(tree: &Tree, sight: &Sight, zone: &Zone, place: Place) -> Cell {
    let whole = tree.cell(place);
    let share = ((PARTS * PARTS) as f64).recip();
    let half = tree.half() / PARTS as f64;
    let spread = 2.0 * half * half / 3.0;
    let part = |direction: DVec3| {
        let seen = sight.seen(direction);
        let outside = 1.0 - zone.shown.share(seen, half);
        let weight = share * outside * sight.accepts(seen.z) * zone.own(seen, half);
        let flux = whole.flux.map(|flux| weight * flux);
        Cell {
            flux,
            dipole: flux.map(|flux| -0.5 * spread * flux * direction),
            spread: flux.map(|flux| spread * flux),
            centre: direction,
            radius: 1.5 * half,
        }
    };
    Cell::sum(tree.parts(place, PARTS).map(part).collect::<Vec<_>>().into_iter(), whole.centre)
}
