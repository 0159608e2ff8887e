//! Pictures of a part of the sphere.
//!
//! On the stereographic image a kernel of the angle is one of the distance, but for a factor of each point ([`depths`]); so wide
//! Gaussians are summed there, on lattices as on a plane, between pixels that lie scattered on it ([`scatter`]). What is missing near a
//! source is added on the pixels by small kernels of true angles, which vary from tile to tile ([`tiles`]).

mod camera;
mod choose;
mod depths;
mod fit;
mod model;
mod scatter;
mod single;
mod sum;
mod tiles;

pub(super) use camera::{Camera, Point, Projection, angle};
pub(super) use choose::{Task, choose};

use crate::veil::evaluate::Pool;
use crate::veil::sweep::Separable;
use model::Model;
use scatter::Table;
use tiles::Tiles;

/// A veil on the sphere, ready to be summed.
#[derive(Debug, Clone)]
pub(super) struct Sphere {
    model: Model,
    tiles: Tiles,
    table: Table,
    /// By lattices and nodes.
    kernels: Vec<Vec<Vec<Separable<f32>>>>,
    /// By how much what the image is taken to return of a pixel's own light can be wrong, over its value.
    pub spread: f64,
    pool: Pool<sum::Workspace>,
}

impl Sphere {
    fn new(model: Model, tiles: Tiles) -> Self {
        let spread = model.own_spread();
        let kernels = (0..model.lattices()).map(|level| {
            let at = |placed: &Vec<model::Placed>| {
                let of_level = placed.iter().filter(|placed| placed.level == level);
                of_level.map(|placed| Separable::new(&placed.half, placed.weight)).collect()
            };
            model.placed.iter().map(at).collect()
        });
        let (table, kernels) = (Table::new(&model), kernels.collect());
        Self { spread, table, kernels, model, tiles, pool: Pool::default() }
    }

    /// The largest that the image returns of a pixel's own light, over that light.
    pub fn own_largest(&self) -> f64 {
        self.table.own_largest()
    }
}
