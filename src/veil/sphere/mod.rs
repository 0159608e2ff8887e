//! Pictures of a part of the sphere.
//!
//! On the stereographic image a kernel of the angle is one of the distance, but for factors of both points ([`model`]); so wide
//! Gaussians are summed there, on lattices as on a plane, between pixels that lie scattered on it ([`scatter`]). What is missing near a
//! source is added on the pixels by small kernels of true angles, which vary over the picture ([`tiles`]).

mod block;
mod camera;
mod choose;
mod factors;
mod fit;
mod flat;
mod measure;
mod model;
mod powers;
mod scatter;
mod single;
mod sum;
mod table;
mod tiles;
mod tree;

pub(super) use camera::{Camera, Point, Projection, angle};
pub(super) use choose::{Task, choose};
pub(super) use flat::Flat;
pub(super) use tree::{ROUNDING as TREE_ROUNDING, Tree};

use crate::veil::evaluate::Pool;
use crate::veil::simd::Plane;
use crate::veil::sweep::Separable;
use model::Model;
pub(super) use sum::Workspace;
use table::Table;
use tiles::Tiles;

/// A veil on the sphere, ready to be summed.
#[derive(Debug, Clone)]
pub(super) struct Sphere {
    model: Model,
    tiles: Tiles,
    table: Table,
    /// By slots.
    kernels: Vec<Vec<Separable<f32>>>,
    /// By slots: the factor over the one that the moments are from.
    factors: Vec<Option<Plane<f32>>>,
    /// By how much what the image is taken to return of a pixel's own light can be wrong, over its value.
    pub spread: f64,
    pub pool: Pool<Workspace>,
}

impl Sphere {
    fn new(model: Model, tiles: Tiles) -> Self {
        let spread = model.own_spread();
        let kernels = (0..model.slots.len()).map(|slot| {
            let of_slot = model.placed.iter().filter(|placed| placed.slot == slot);
            of_slot.map(|placed| Separable::new(&placed.half, placed.weight)).collect()
        });
        let (table, factors, kernels) = (Table::new(&model), factors::factors(&model), kernels.collect());
        Self { spread, table, kernels, factors, model, tiles, pool: Pool::default() }
    }

    /// The largest that the image returns of a pixel's own light, over that light.
    pub fn own_largest(&self) -> f64 {
        self.table.own_largest()
    }
}
