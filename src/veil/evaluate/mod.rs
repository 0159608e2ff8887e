//! A planned veil, summed.

mod device;
mod lonely;
mod moments;
mod pool;
mod rows;
mod spherical;

use pulp::Arch;
use rayon::prelude::*;

use super::FLOOR;
use super::error::Error;
use super::geometry::{Border, Geometry};
use super::kernel::Kernel;
use super::photo::{BadSources, Photo, Scale, Sources};
use super::plan::{DIRECT, Layers, Near, OWN_SHARE, PERIOD, Placed, Plan, Planar, Way};
use super::reference::{self, Window};
use super::simd::{BLOCK, Plane, Real};
use super::sweep::{GROUP, Pyramid, Separable};
pub(crate) use device::{Labour, Lights, OnDevice};
use moments::Moments;
pub(super) use pool::Pool;
use rows::{Finished, Rows};

/// The veil of a photo.
#[derive(Debug, Clone)]
pub struct Veil {
    /// Red, green and blue: rows of as many values as the photo has columns, row 0 on top. What is too large for 32 bits is
    /// infinite.
    pub planes: [Vec<f32>; 3],
    /// What of the photo was no light.
    pub bad: BadSources,
    /// Pixels whose veil is below [`FLOOR`] of their channel's largest.
    pub dark: [usize; 3],
    /// Pixels that are so much brighter than their own veil that it had to be summed without their light; by a transform, those whose
    /// veil is so dark that it had to be summed by the definition.
    pub lonely: [usize; 3],
    /// The bound of the error relative to the local veil that holds for this photo: the plan's but for a transform, whose error
    /// depends on the photo and may be above the tolerance.
    pub certified: [f64; 3],
}

impl Plan {
    /// The veil of a photo.
    ///
    /// # Errors
    /// A photo of another size than was planned for.
    pub fn evaluate(&self, photo: &Photo) -> Result<Veil, Error> {
        if photo.size() != self.size() {
            return Err(Error::OtherSize { planned: self.size(), found: photo.size() });
        }
        let bound = self.predicted().bound;
        Ok(match &self.way {
            Way::Plane(planar) => Veil { certified: [bound; 3], ..planar.evaluate(photo) },
            Way::Sphere(spherical) => Veil { certified: [bound; 3], ..spherical.evaluate(photo) },
            Way::Direct(geometry, kernel) => direct(photo, geometry, kernel),
            Way::Transform(transform) => transform.evaluate(photo),
            Way::Rings(rings) => rings.evaluate(photo),
        })
    }
}

/// By the definition.
fn direct(photo: &Photo, geometry: &Geometry, kernel: &Kernel) -> Veil {
    let veil = reference::veil(photo, geometry, kernel, Border::None, Window::whole(photo.size()));
    let planes = [0, 1, 2].map(|channel| veil.iter().map(|veil| veil[channel] as f32).collect::<Vec<f32>>());
    let dark = planes.each_ref().map(|plane| {
        let floor = FLOOR * f64::from(plane.iter().copied().fold(0.0, f32::max));
        plane.iter().filter(|value| f64::from(**value) < floor).count()
    });
    Veil { planes, bad: photo.bad(), dark, lonely: [0; 3], certified: [DIRECT; 3] }
}

/// What an evaluation on a plane needs besides its result.
pub(super) struct Workspace {
    sources: [Sources; 3],
    pyramid: Pyramid<f32>,
    /// The sources pixel by pixel, and then the veil, where a device sums it.
    texels: Vec<[f32; 4]>,
}

impl Planar {
    fn evaluate(&self, photo: &Photo) -> Veil {
        let mut workspace = self.pool.take(|| self.workspace());
        let Workspace { sources, pyramid, .. } = &mut workspace;
        let bad = photo.sources(self.border, self.margin, sources);
        let mut veil = Veil { planes: Default::default(), bad, dark: [0; 3], lonely: [0; 3], certified: [0.0; 3] };
        let layers = Ready::new(&self.layers);
        for (channel, sources) in sources.iter_mut().enumerate() {
            let (mut plane, rows) = self.sum(&layers, sources, pyramid);
            let floor = FLOOR * f64::from(rows.iter().map(|row| row.largest).fold(0.0, f32::max));
            veil.lonely[channel] = self.mend(sources, &rows, (floor, self.own_light()), pyramid, &mut plane);
            veil.dark[channel] = self.dark(&rows, floor, &plane);
            veil.planes[channel] = plane;
        }
        self.pool.give_back(workspace);
        veil
    }

    fn workspace(&self) -> Workspace {
        let size = [0, 1].map(|side| self.size[side] + 2 * self.margin[side]);
        let sources = [0, 1, 2].map(|_| Sources { plane: Plane::new(size[0], size[1]), exponent: 0 });
        Workspace { sources, pyramid: Pyramid::new(size, self.layers.lattices.len()), texels: Vec::new() }
    }

    /// The veil, and what is to be known of each of its rows.
    fn sum(&self, layers: &Ready, sources: &Sources, pyramid: &mut Pyramid<f32>) -> (Vec<f32>, Vec<Finished>) {
        let arch = Arch::new();
        pyramid.sweep(arch, &sources.plane, &layers.lattices);
        let (fine, moments) = (pyramid.finest(), Moments::new(&self.layers, &sources.plane));
        let [width, height] = self.size;
        let finish = rows::Finish {
            scale: Scale::new(-sources.exponent),
            moments: &moments,
            rest: self.own_light().of_computed() as f32,
        };
        let (mut plane, mut finished) = (vec![0.0; width * height], vec![Finished::default(); height]);
        let groups = plane.par_chunks_mut(width * GROUP).zip(finished.par_chunks_mut(GROUP));
        groups.enumerate().for_each_init(
            || Rows::new(layers, &sources.plane, fine),
            |work, (group, (out, finished))| {
                let first = group * GROUP + self.margin[1];
                work.sum(arch, layers, &sources.plane, fine, first, finished.len());
                for (row, (out, finished)) in out.chunks_exact_mut(width).zip(finished).enumerate() {
                    let at = [self.margin[0], first + row];
                    *finished = finish.row(arch, work.row(row), sources.plane.row(at[1]), &layers.own, at, out);
                }
            },
        );
        (plane, finished)
    }

    fn own_light(&self) -> OwnLight {
        let own = &self.layers.own;
        let rest = own.spread + own.largest * self.roundings * <f32 as Real>::UNIT;
        OwnLight { rest, share: OWN_SHARE * self.tolerance / (1.0 + OWN_SHARE * self.tolerance) }
    }

    /// How many pixels are below the floor.
    fn dark(&self, rows: &[Finished], floor: f64, plane: &[f32]) -> usize {
        let some = plane.chunks_exact(self.size[0]).zip(rows).filter(|(_, finished)| f64::from(finished.least) < floor);
        some.map(|(row, _)| row.iter().filter(|value| f64::from(**value) < floor).count()).sum()
    }
}

/// What becomes of a pixel's own light.
#[derive(Debug, Clone, Copy)]
struct OwnLight {
    /// What may remain of it in the pixel's veil, over that light.
    rest: f64,
    /// The share of the veil that it may make, of the computed veil, which may contain as much of it again.
    share: f64,
}

impl OwnLight {
    /// The rest over its share of what was computed: where light times this is more than that, the pixel is lonely.
    fn of_computed(self) -> f64 {
        self.rest / self.share
    }
}

/// The layers in the precision they are summed in.
struct Ready {
    direct: Vec<Separable<f32>>,
    lattices: Vec<Vec<Separable<f32>>>,
    /// For each distance of rows: the values from the farthest column on the left to that on the right.
    near: Vec<Vec<f32>>,
    /// What is to be added of a pixel's own light, by the lower bits of row and column.
    own: Vec<[f32; BLOCK]>,
}

impl Ready {
    fn new(layers: &Layers) -> Self {
        let separable = |placed: &Placed| Separable::new(&placed.half, placed.weight);
        let Near { rows } = &layers.near;
        let near = |row: &Vec<f64>| row.iter().skip(1).rev().chain(row).map(|value| *value as f32).collect();
        let own = |row: &[f64; PERIOD]| std::array::from_fn(|x| -row[x % PERIOD] as f32);
        Self {
            direct: layers.direct.iter().map(separable).collect(),
            lattices: layers.lattices.iter().map(|terms| terms.iter().map(separable).collect()).collect(),
            near: rows.iter().map(near).collect(),
            own: layers.own.table.iter().map(own).collect(),
        }
    }
}
