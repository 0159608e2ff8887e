//! The ghosts that all pixels of a photo make.
//!
//! A ghost of a lens shows every light where `along` says, so those of all pixels are an image of the photo: scaled, blurred by the
//! ghost's bell, and tinted. Where what a ghost looks like depends on where the light is, as it does behind the rims of a real lens, the
//! photo is taken in patches, each of which has ghosts of its own.

use std::collections::HashMap;
use std::ops::Range;
use std::sync::Arc;

use glam::DVec2;
use ndarray::{Array2, Axis, concatenate, s};
use rayon::prelude::*;
use serde::Serialize;

use crate::raster::Raster;
use crate::scene::{Ghost, LensGhost};
use crate::series::Modes;

/// What a pixel makes of its light.
#[derive(Debug, Clone, PartialEq)]
pub struct Image {
    /// The ghost of a pixel of flux 1 on the axis.
    pub ghost: Ghost,
    /// The ghost's centre is so many times as far from the axis as the pixel.
    pub along: f64,
    /// Whose pixels: 0 for all of the photo's, or a patch.
    pub patch: usize,
}

impl Image {
    /// How far from its centre a ghost is anything at all.
    pub(crate) fn reached(&self) -> DVec2 {
        let shape = self.ghost.bell.shape();
        shape.ends().min(shape.reach(NOTHING)) * self.ghost.size
    }
}

/// A photo's light, through a lens.
#[derive(Debug, Clone, PartialEq)]
pub struct Images {
    /// The photo, then its patches.
    rasters: Vec<Arc<Raster>>,
    axis: DVec2,
    all: Vec<Image>,
    rims: Option<Rims>,
}

/// What the rims of a lens do to its ghosts, by where the light is.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Rims {
    /// How many ghosts they cut.
    pub cut: usize,
    /// How many images of the photo's parts those are.
    pub images: usize,
    /// The part of all ghosts' light that is not where rims would leave it, since light of a patch shares the shapes of its ghosts: off by a
    /// ghost's breadth at most. An estimate of the model's error, which no bound of the sum has in it.
    pub misplaced: f64,
}

/// A part of a photo, and what a lens makes of a light in it.
#[derive(Debug, Clone)]
pub struct Patch {
    /// The light of its pixels.
    pub raster: Arc<Raster>,
    /// The ghosts that are of its light alone.
    pub ghosts: Vec<LensGhost>,
}

/// Columns of a table of all columns of pixels: some megabytes.
const MOST_COLUMNS: usize = 2048;

/// Which of the centres, which rise or fall, are no farther than `end` from a place, and how far the place is from each.
fn near(centres: &[f64], place: f64, end: f64) -> (Range<usize>, Vec<f64>) {
    let inside = |centre: &&f64| (place - **centre).abs() <= end;
    let first = centres.iter().position(|centre| inside(&centre)).unwrap_or(centres.len());
    let offsets: Vec<f64> = centres[first..].iter().take_while(inside).map(|centre| place - centre).collect();
    (first..first + offsets.len(), offsets)
}

/// What of its peak a bell that does not end is left out at, in a sum over all pixels.
pub(crate) const NOTHING: f64 = 1e-10;

/// The places of points along an axis, each once.
struct Places {
    axis: usize,
    places: Vec<f64>,
    numbers: HashMap<u64, usize>,
}

impl Places {
    fn new(points: &[DVec2], axis: usize) -> Self {
        let (mut places, mut numbers) = (Vec::new(), HashMap::new());
        for point in points {
            numbers.entry(point[axis].to_bits()).or_insert_with(|| {
                places.push(point[axis]);
                places.len() - 1
            });
        }
        Self { axis, places, numbers }
    }

    fn of(&self, point: &DVec2) -> usize {
        self.numbers[&point[self.axis].to_bits()]
    }

    /// What each centre has at each place.
    fn table(&self, centres: &[f64], value: impl Fn(f64) -> f64) -> Array2<f64> {
        Array2::from_shape_fn((centres.len(), self.places.len()), |(centre, place)| {
            value(self.places[place] - centres[centre])
        })
    }
}

/// A pixel's extent over its side: the root mean square distance from the middle of a square along one axis.
const EXTENT: f64 = 0.288_675_134_594_812_9;

impl Images {
    /// Of a lens whose axis meets the picture at `axis`; every ghost `scale` times as large, and `tint` its colour. A pixel is a
    /// light of its own size, as the rule for lights has it.
    pub fn new(raster: Arc<Raster>, lens: &[LensGhost], axis: DVec2, scale: f64, tint: [f64; 3]) -> Self {
        Self::in_patches(raster, lens, &[], axis, scale, tint)
    }

    /// The same where ghosts depend on where the light is: `lens` are those of the whole photo, and each patch has its own beside them.
    pub fn in_patches(
        raster: Arc<Raster>,
        lens: &[LensGhost],
        patches: &[Patch],
        axis: DVec2,
        scale: f64,
        tint: [f64; 3],
    ) -> Self {
        let extent = EXTENT * raster.frame().pixel_sides();
        let image = |lens: &LensGhost, patch: usize| {
            let ghost = lens.image(extent);
            let ghost = if scale == 1.0 { ghost } else { ghost.scaled(scale) };
            let radiance = [0, 1, 2].map(|colour| ghost.radiance[colour] * tint[colour]);
            Image { ghost: Ghost { center: axis, radiance, ..ghost }, along: lens.along, patch }
        };
        let whole = lens.iter().map(|ghost| image(ghost, 0));
        let apart =
            (1..).zip(patches).flat_map(|(number, patch)| patch.ghosts.iter().map(move |ghost| image(ghost, number)));
        let images = whole.chain(apart);
        let rasters: Vec<Arc<Raster>> =
            std::iter::once(raster.clone()).chain(patches.iter().map(|patch| patch.raster.clone())).collect();
        let shines = |image: &Image| {
            let lit = |(radiance, flux): (f64, f64)| radiance != 0.0 && flux != 0.0;
            image.ghost.radiance.into_iter().zip(rasters[image.patch].flux()).any(lit)
        };
        let all = images.filter(shines).collect();
        Self { rasters, axis, all, rims: None }
    }

    /// The same, of which it is known what rims do.
    pub fn behind(self, rims: Rims) -> Self {
        Self { rims: Some(rims), ..self }
    }

    /// What the rims of the lens do, where it has any.
    pub fn rims(&self) -> Option<&Rims> {
        self.rims.as_ref()
    }

    /// The photo.
    pub fn raster(&self) -> &Raster {
        &self.rasters[0]
    }

    /// The pixels that an image is of.
    pub fn raster_of(&self, image: &Image) -> &Raster {
        &self.rasters[image.patch]
    }

    /// How many parts of the photo have ghosts of their own; 0 where all are the whole photo's.
    pub fn patches(&self) -> usize {
        self.rasters.len() - 1
    }

    /// How many ghosts there are: one of each pixel for each image.
    pub fn count(&self) -> usize {
        self.all.iter().map(|image| self.raster_of(image).pixels()).sum()
    }

    /// How many ghosts each pixel has.
    pub fn of_each(&self) -> usize {
        self.count().div_ceil(self.raster().pixels().max(1))
    }

    /// Where the lens's axis meets the picture.
    pub fn axis(&self) -> DVec2 {
        self.axis
    }

    /// One for each ghost of the lens.
    pub fn all(&self) -> &[Image] {
        &self.all
    }

    /// The ghost that an image would be if all of the photo's light came from the axis: no value of the image is beyond its peak.
    pub fn gathered(&self, image: &Image) -> Ghost {
        let flux = self.raster_of(image).flux();
        let radiance = [0, 1, 2].map(|colour| image.ghost.radiance[colour] * flux[colour]);
        Ghost { radiance, ..image.ghost.clone() }
    }

    /// Between which places the centres of an image's ghosts lie.
    pub fn centres(&self, image: &Image) -> [DVec2; 2] {
        let (low, high) = self.raster_of(image).frame().bounds();
        let [one, other] = [low, high].map(|corner| self.axis + image.along * (corner - self.axis));
        [one.min(other), one.max(other)]
    }

    /// The same photo with some of its images alone.
    pub(crate) fn only(&self, members: &[usize]) -> Self {
        Self { all: members.iter().map(|&member| self.all[member].clone()).collect(), ..self.clone() }
    }

    /// The same with the colours of its ghosts changed.
    pub(crate) fn recoloured(mut self, colour: impl Fn([f64; 3]) -> [f64; 3]) -> Self {
        self.all.iter_mut().for_each(|image| image.ghost.radiance = colour(image.ghost.radiance));
        self
    }

    /// What of each colour's flux the ghosts carry in all.
    pub fn share(&self) -> [f64; 3] {
        let whole = self.raster().flux();
        self.all.iter().fold([0.0; 3], |sum, image| {
            let (share, flux) = (image.ghost.flux(), self.raster_of(image).flux());
            // Of a colour that the photo has none of, what it would be were it like the others.
            let part = |colour: usize| match image.patch {
                0 => 1.0,
                _ if whole[colour] > 0.0 => flux[colour] / whole[colour],
                _ => flux.iter().sum::<f64>() / whole.iter().sum::<f64>(),
            };
            [0, 1, 2].map(|colour| sum[colour] + share[colour] * part(colour))
        })
    }

    /// Whether all bells are products of one for each axis.
    pub fn are_products(&self) -> bool {
        self.all.iter().all(|image| matches!(image.ghost.bell.shape().modes(), Modes::Product(_)))
    }

    /// The sum over all pixels and all ghosts at these points, every bell evaluated: no waves, no moments.
    pub fn at(&self, points: &[DVec2]) -> Vec<[f64; 3]> {
        let is_product = |image: &&Image| matches!(image.ghost.bell.shape().modes(), Modes::Product(_));
        let (products, others): (Vec<&Image>, Vec<&Image>) = self.all.iter().partition(is_product);
        let mut sums = vec![[0.0; 3]; points.len()];
        for patch in 0..self.rasters.len() {
            let products: Vec<&Image> = products.iter().copied().filter(|image| image.patch == patch).collect();
            for (sum, added) in sums.iter_mut().zip(self.of_products(patch, &products, points)) {
                [0, 1, 2].into_iter().for_each(|colour| sum[colour] += added[colour]);
            }
        }
        for image in others {
            for (sum, added) in sums.iter_mut().zip(self.one_by_one(image, points)) {
                [0, 1, 2].into_iter().for_each(|colour| sum[colour] += image.ghost.radiance[colour] * added[colour]);
            }
        }
        sums
    }

    /// Of a patch's bells that are products along x and y: over columns and rows apart, for all points that share them.
    fn of_products(&self, patch: usize, images: &[&Image], points: &[DVec2]) -> Vec<[f64; 3]> {
        let [xs, ys] = [Places::new(points, 0), Places::new(points, 1)];
        let mut sums = vec![[0.0; 3]; points.len()];
        // As many at once as the tables of have room.
        let at_once = (MOST_COLUMNS / xs.places.len().max(1)).max(1);
        for images in images.chunks(at_once) {
            let tables: Vec<[Array2<f64>; 2]> = images
                .par_iter()
                .map(|image| {
                    let (shape, size) = (image.ghost.bell.shape(), image.ghost.size);
                    let peak = shape.value(DVec2::ZERO, size);
                    let [columns, rows] = self.centres_of_pixels(image);
                    let across = xs.table(&columns, |x| shape.value(DVec2::new(x, 0.0), size));
                    [across, ys.table(&rows, |y| shape.value(DVec2::new(0.0, y), size) / peak)]
                })
                .collect();
            let across: Vec<_> = tables.iter().map(|[across, _]| across.view()).collect();
            let across = concatenate(Axis(1), &across).expect("all tables have a row for each column of pixels");
            let along = self.rasters[patch].along_rows(across.view());
            for (number, (image, [_, down])) in images.iter().zip(&tables).enumerate() {
                let mine = number * xs.places.len()..(number + 1) * xs.places.len();
                for (colour, along) in along.iter().enumerate() {
                    let values = along.slice(s![.., mine.clone()]).t().dot(down);
                    for (sum, point) in sums.iter_mut().zip(points) {
                        sum[colour] += image.ghost.radiance[colour] * values[(xs.of(point), ys.of(point))];
                    }
                }
            }
        }
        sums
    }

    /// Of any other: pixel by pixel, but for those whose bell ends before the point.
    fn one_by_one(&self, image: &Image, points: &[DVec2]) -> Vec<[f64; 3]> {
        let (shape, size) = (image.ghost.bell.shape(), image.ghost.size);
        let [columns, rows] = self.centres_of_pixels(image);
        let (ends, raster) = (image.reached(), self.raster_of(image));
        let at = |point: &DVec2| {
            let ((across, xs), (down, ys)) = (near(&columns, point.x, ends.x), near(&rows, point.y, ends.y));
            let mut sum = [0.0; 3];
            shape.over(&xs, &ys, size, &mut |row, values| {
                let added = raster.along_row(down.start + row, across.clone(), values);
                sum.iter_mut().zip(added).for_each(|(sum, added)| *sum += added);
            });
            sum
        };
        points.par_iter().map(at).collect()
    }

    /// The centres of an image's ghosts of all columns of pixels, and of all rows.
    pub(crate) fn centres_of_pixels(&self, image: &Image) -> [Vec<f64>; 2] {
        let places = self.raster_of(image).places();
        let [columns, rows] = [0, 1].map(|axis| {
            let middle = self.axis[axis] + image.along * (places.middle[axis] - self.axis[axis]);
            places.from_middle[axis].iter().map(|place| middle + image.along * place).collect()
        });
        [columns, rows]
    }
}
