//! Which way the veil on a part of the sphere is summed.

use super::{DIRECT, Plan, Predicted, Way, check};
use crate::veil::error::Error;
use crate::veil::evaluate::Pool;
use crate::veil::geometry::Geometry;
use crate::veil::kernel::Kernel;
use crate::veil::photo::Sources;
use crate::veil::sphere::{self, Camera, Flat, Sphere, Task, Tree, angle};

/// Pixels up to which a picture of the sphere is summed directly, in milliseconds.
const TINY: usize = 1 << 8;

/// Pixels up to which it is where nothing else meets the tolerance, in a second or less.
const SMALL: usize = 1 << 13;

/// Operations for a pixel from which on transforms are thought of: those of small kernels wider than some 30 pixels.
const DEAR: f64 = 4000.0;

/// What an operation of 64-bit transforms takes over one of a small kernel, measured.
const OF_TRANSFORMS: f64 = 14.0;

/// On the sphere.
#[derive(Debug, Clone)]
pub(in crate::veil) struct Spherical {
    pub kernel: Kernel,
    pub camera: Camera,
    pub tolerance: f64,
    pub road: Road,
    /// Photos as sources, kept from one evaluation to the next.
    pub sources: Pool<[Sources; 3]>,
}

/// How a picture of the sphere is summed.
#[derive(Debug, Clone)]
pub(in crate::veil) enum Road {
    /// By lattices on its stereographic image, and the longest chain of roundings.
    Lattices(Box<Sphere>, f64),
    /// By transforms, on a narrow field.
    Flat(Box<Flat>),
    /// By tiles of pixels that send to each other, on any.
    Tree(Box<Tree>),
}

impl Plan {
    pub(super) fn spherical(
        geometry: &Geometry,
        camera: Camera,
        kernel: &Kernel,
        tolerance: f64,
    ) -> Result<Self, Error> {
        let size = camera.size;
        let [first, last] = [camera.point(0.0, 0.0), camera.point(size[0] as f64 - 1.0, size[1] as f64 - 1.0)];
        let (mut chord, longest) = (0.5 / camera.focal, first.chord(&last));
        while chord < 1.03 * longest {
            check(kernel.at(angle(chord)), angle(chord))?;
            chord *= 1.03;
        }
        let pixels = size[0] * size[1];
        if pixels <= TINY {
            return Ok(Self::direct(geometry, kernel, size));
        }
        let mixture = kernel.mixture();
        let profile = |angle: f64| kernel.at(angle);
        let task = Task { camera, profile: &profile, mixture: &mixture.terms, constant: mixture.constant, tolerance };
        let chosen = sphere::choose(&task);
        // Where a core is wide, or there are no lattices for it, transforms may be cheaper.
        if chosen.as_ref().map_or(f64::INFINITY, |chosen| chosen.operations) > DEAR
            && let Some(flat) = Flat::new(&task)
            && chosen.as_ref().map_or(f64::INFINITY, |chosen| chosen.operations) > OF_TRANSFORMS * flat.operations()
        {
            let promised = [flat.bound, flat.rounding, flat.operations()];
            return Ok(Self::without_lattices(kernel, camera, tolerance, promised, Road::Flat(Box::new(flat))));
        }
        let chosen = match chosen {
            Err(Error::OutOfReach { .. } | Error::Core { .. }) if pixels <= SMALL && tolerance > DIRECT => {
                return Ok(Self::direct(geometry, kernel, size));
            }
            Err(Error::OutOfReach { asked, .. } | Error::Core { asked, .. }) if pixels <= SMALL => {
                return Err(Error::OutOfReach { asked, best: DIRECT, distance: 0.0 });
            }
            Err(refused @ (Error::OutOfReach { .. } | Error::Core { .. })) => {
                let tree = Tree::new(&task).ok_or(refused)?;
                let promised = [tree.bound, sphere::TREE_ROUNDING, tree.operations];
                return Ok(Self::without_lattices(kernel, camera, tolerance, promised, Road::Tree(Box::new(tree))));
            }
            chosen => chosen?,
        };
        let predicted = Predicted {
            bound: chosen.bound,
            rounding: chosen.rounding,
            operations: chosen.operations,
            direct: 0,
            dropped: mixture.terms.len().saturating_sub(chosen.lattices.iter().sum::<usize>()),
            lattices: chosen.lattices,
            reach: chosen.reach,
        };
        let road = Road::Lattices(Box::new(chosen.sphere), chosen.roundings);
        let spherical = Spherical { kernel: kernel.clone(), camera, tolerance, road, sources: Pool::default() };
        Ok(Self { size, predicted, way: Way::Sphere(Box::new(spherical)) })
    }

    /// On a road whose bound, rounding and operations these are.
    fn without_lattices(
        kernel: &Kernel,
        camera: Camera,
        tolerance: f64,
        [bound, rounding, operations]: [f64; 3],
        road: Road,
    ) -> Self {
        let predicted = Predicted {
            bound,
            rounding,
            operations,
            direct: 0,
            lattices: Vec::new(),
            dropped: kernel.mixture().terms.len(),
            reach: (camera.size[0] as f64).hypot(camera.size[1] as f64),
        };
        let spherical = Spherical { kernel: kernel.clone(), camera, tolerance, road, sources: Pool::default() };
        Self { size: camera.size, predicted, way: Way::Sphere(Box::new(spherical)) }
    }
}

impl Spherical {
    /// What a pixel of light 1 should send to another.
    pub fn wanted(&self, from: [usize; 2], to: [usize; 2]) -> f64 {
        let [from, to] = [from, to].map(|at| self.camera.point(at[0] as f64, at[1] as f64));
        from.solid_angle * self.kernel.at(angle(from.chord(&to)))
    }
}
