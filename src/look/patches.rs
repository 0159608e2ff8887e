//! Patches of a photo, for the ghosts that rims of a lens cut by where the light is.
//!
//! What rims leave of a ghost changes with the place of its light, and each shape of a ghost is an image of its own to compute. So the ghost
//! takes the light of a patch as if all of it came from one place: it has the light that rims leave of all the patch's, and the shape that
//! they leave of light in the middle of that. A ghost that hardly changes, or is faint, takes the whole photo at once; another as many
//! patches as it is worth.

use std::collections::BTreeMap;
use std::f64::consts::FRAC_2_PI;

use glam::DVec2;
use rayon::prelude::*;

use crate::frame::Frame;
use crate::problem::{Patch, Rims};
use crate::raster::{Cell, Raster};
use crate::scene::patches::{self, Spot};
use crate::scene::{LensGhost, Optical, Rimmed};

/// Cells along the longer side of a photo, of which its patches are made.
const CELLS: u32 = 48;

/// Patches of a photo that a ghost may take, from the whole photo on.
const COUNTS: [usize; 5] = [1, 3, 8, 20, 48];

/// Patches are enough where no more than this part of the ghosts' light is misplaced.
const MISPLACED: f64 = 0.01;

/// Images at most, for each ghost that rims cut, on average: at 45 double Gauss ghosts of a sunset three images each leave 2 % of the field
/// off in the median, eight 1.3 %; time goes with their number.
const MOST_EACH: usize = 3;

/// Distances from the axis at which a ghost's shift is known, between which it is taken as straight.
const DISTANCES: usize = 64;

/// The ghosts of a photo: those of all of its pixels, and those of patches.
pub(super) struct Patched {
    pub whole: Vec<LensGhost>,
    pub patches: Vec<Patch>,
    pub rims: Rims,
}

/// What rims leave of a ghost, for the light of each cell.
struct Left {
    /// Of its light.
    light: Vec<f64>,
    /// Where the middle of its shape is, in its radii.
    shift: Vec<DVec2>,
}

/// A ghost, as it takes the photo at a level.
struct Row<'a> {
    rimmed: Rimmed<'a>,
    left: Left,
    /// What is misplaced at each level, of all light of the photo.
    misplaced: Vec<f64>,
    level: usize,
}

/// Groups of cells, level by level.
type Levels = Vec<Vec<Vec<usize>>>;

impl Patched {
    /// Of a photo behind a lens that is fitted to it, whose axis meets the picture at `axis`.
    pub fn new(optical: &Optical, raster: &Raster, axis: DVec2) -> Self {
        let side = cell_side(raster.frame());
        let cells = raster.cells(side as usize);
        let columns = cells.ncols();
        let spots: Vec<Spot> = cells.iter().map(|&Cell { light, place }| Spot { place: place - axis, light }).collect();
        let levels = patches::levels(&spots, &COUNTS);
        let (cut, uncut): (Vec<Rimmed<'_>>, Vec<Rimmed<'_>>) = optical.rimmed().partition(Rimmed::is_cut);
        let mut rows: Vec<Row<'_>> = cut.into_par_iter().map(|rimmed| Row::new(rimmed, &spots, &levels)).collect();
        let flux = |share: f64| share * spots.iter().map(|spot| spot.light).sum::<f64>();
        let total = uncut.iter().map(|rimmed| flux(rimmed.row.share)).sum::<f64>()
            + rows.iter().map(|row| row.flux(&spots)).sum::<f64>();
        let misplaced = refine(&mut rows, &levels, MISPLACED * total);

        let mut whole: Vec<LensGhost> = uncut.iter().map(|rimmed| rimmed.row.clone()).collect();
        let mut parts: BTreeMap<(usize, usize), Vec<LensGhost>> = BTreeMap::new();
        for row in &rows {
            let groups = &levels[row.level];
            let ghosts = groups.iter().enumerate().filter_map(|(number, group)| Some((number, row.of(&spots, group)?)));
            match groups.len() {
                1 => whole.extend(ghosts.map(|(_, ghost)| ghost)),
                _ => ghosts.for_each(|(number, ghost)| parts.entry((row.level, number)).or_default().push(ghost)),
            }
        }
        let patch = |((level, number), ghosts): ((usize, usize), Vec<LensGhost>)| {
            let place = |&index: &usize| [index % columns, index / columns].map(|cell| cell as u32);
            let places = || levels[level][number].iter().map(place);
            let [left, top] = [0, 1].map(|axis| side * places().map(|place| place[axis]).min().unwrap_or(0));
            let [right, lower] = [0, 1].map(|axis| side * places().map(|place| place[axis] + 1).max().unwrap_or(0));
            let window = raster.frame().window;
            let [width, height] = [right.min(window.width) - left, lower.min(window.height) - top];
            Patch { raster: raster.part(window.part(left, top, width, height)), ghosts }
        };
        let patches = parts.into_iter().map(patch).collect();
        let images = rows.iter().map(|row| levels[row.level].len()).sum();
        let rims = Rims { cut: rows.len(), images, misplaced: if total > 0.0 { misplaced / total } else { 0.0 } };
        Self { whole, patches, rims }
    }
}

/// Columns and rows of pixels in a cell.
fn cell_side(frame: Frame) -> u32 {
    let window = frame.window;
    window.width.max(window.height).div_ceil(CELLS).max(1)
}

/// Has the rows take finer patches, always the one that then misplaces least for the images that it has more, until all of them misplace
/// no more than `enough`; how much they still do.
fn refine(rows: &mut [Row<'_>], levels: &Levels, enough: f64) -> f64 {
    let mut room = rows.len() * MOST_EACH;
    let images = |level: usize| levels[level].len();
    loop {
        let misplaced: f64 = rows.iter().map(|row| row.misplaced[row.level]).sum();
        let finer = rows.iter_mut().flat_map(|row| {
            let (level, now) = (row.level, row.misplaced[row.level]);
            // A level that misplaces no less may stand before one that does.
            let gains = (level + 1..levels.len()).map(|finer| {
                let more = images(finer) - images(level);
                (finer, more, (now - row.misplaced[finer]) / more.max(1) as f64)
            });
            let best = gains.filter(|&(_, more, gain)| more <= room && gain > 0.0).max_by(|a, b| a.2.total_cmp(&b.2));
            best.map(|best| (best, row))
        });
        let best = finer.max_by(|one, other| one.0.2.total_cmp(&other.0.2));
        match best {
            Some(((finer, more, _), row)) if misplaced > enough => {
                row.level = finer;
                room -= more;
            }
            _ => return misplaced,
        }
    }
}

impl<'a> Row<'a> {
    fn new(rimmed: Rimmed<'a>, spots: &[Spot], levels: &Levels) -> Self {
        let left = Left::new(&rimmed, spots);
        let off = |groups: &Vec<Vec<usize>>| groups.iter().map(|group| left.misplaced(spots, group)).sum::<f64>();
        let misplaced = levels.iter().map(|groups| rimmed.row.share * off(groups)).collect();
        Self { rimmed, left, misplaced, level: 0 }
    }

    /// The light of the ghost.
    fn flux(&self, spots: &[Spot]) -> f64 {
        self.rimmed.row.share * spots.iter().zip(&self.left.light).map(|(spot, left)| spot.light * left).sum::<f64>()
    }

    /// The ghost of a group's light; none where rims leave nothing.
    fn of(&self, spots: &[Spot], group: &[usize]) -> Option<LensGhost> {
        let light: f64 = group.iter().map(|&spot| spots[spot].light).sum();
        let through = |&spot: &usize| spots[spot].light * self.left.light[spot];
        let passed: f64 = group.iter().map(through).sum();
        if passed.is_nan() || passed <= 0.0 {
            return None;
        }
        let middle = match group {
            [only] => spots[*only].place,
            _ => group.iter().map(|spot| through(spot) * spots[*spot].place).sum::<DVec2>() / passed,
        };
        let share = self.rimmed.row.share * (passed / light);
        let at = |place: DVec2| Some(self.rimmed.at(place)).filter(|ghost| ghost.share > 0.0);
        // Where rims leave nothing of light in the middle, they do of the cell that most passes from.
        let most = || group.iter().max_by(|one, other| through(one).total_cmp(&through(other)));
        let ghost = at(middle).or_else(|| at(spots[*most()?].place))?;
        Some(LensGhost { share, ..ghost })
    }
}

impl Left {
    fn new(rimmed: &Rimmed<'_>, spots: &[Spot]) -> Self {
        let light = spots.iter().map(|spot| if spot.light > 0.0 { rimmed.left(spot.place.length()) } else { 0.0 });
        let farthest = spots.iter().map(|spot| spot.place.length()).fold(0.0, f64::max);
        let step = farthest / (DISTANCES - 1) as f64;
        let known: Vec<f64> = (0..DISTANCES).map(|k| rimmed.shift(k as f64 * step)).collect();
        let shift = |spot: &Spot| {
            let at = if step > 0.0 { spot.place.length() / step } else { 0.0 };
            let before = (at as usize).min(DISTANCES - 2);
            let part = at - before as f64;
            ((1.0 - part) * known[before] + part * known[before + 1]) * spot.place.normalize_or_zero()
        };
        Self { light: light.collect(), shift: spots.iter().map(shift).collect() }
    }

    /// How much of a group's light is misplaced where all of it is given the light and the shift of its mean: what is too much or too
    /// little, and what of two discs as wide as the ghost lies in one of them alone.
    fn misplaced(&self, spots: &[Spot], group: &[usize]) -> f64 {
        let (mut light, mut passed, mut shift) = (0.0, 0.0, DVec2::ZERO);
        for &spot in group {
            let through = spots[spot].light * self.light[spot];
            light += spots[spot].light;
            passed += through;
            shift += through * self.shift[spot];
        }
        if light.is_nan() || light <= 0.0 {
            return 0.0;
        }
        let mean = passed / light;
        let shift = if passed > 0.0 { shift / passed } else { DVec2::ZERO };
        let off = |&spot: &usize| {
            let left = self.light[spot];
            let apart = (FRAC_2_PI * (self.shift[spot] - shift).length()).min(1.0);
            // Light in the wrong place is missing in the right one: it counts once.
            spots[spot].light * (0.5 * (left - mean).abs() + left * apart)
        };
        group.iter().map(off).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chance::Chance;
    use crate::look::{Look, LookLens};
    use crate::photo::Photo;
    use crate::problem::Images;
    use crate::reference::direct_at;
    use crate::scene::Light;

    /// A photo of so few pixels that each is a cell, behind a lens whose rims cut much.
    fn photo(size: [u32; 2]) -> (Look, std::sync::Arc<Raster>) {
        let frame = Frame::full(size[0], size[1]);
        let mut chance = Chance::new(3);
        let pixel = |_| [0.0; 3].map(|_: f32| chance.between(0.1, 1.0) as f32);
        let pixels: Vec<[f32; 4]> = (0..frame.window.pixels()).map(pixel).map(|[r, g, b]| [r, g, b, 1.0]).collect();
        let axis = DVec2::new(0.05, -0.1);
        let look = Look { lens: LookLens::preset("double-gauss").unwrap(), axis, ..Look::default() };
        (look, Raster::new(&pixels, frame).unwrap())
    }

    fn optical(look: &Look) -> &Optical {
        let LookLens::Optical(optical) = &look.lens else { panic!("it has surfaces") };
        optical
    }

    /// The ghosts of every pixel's own light, cut as they are there.
    fn each(look: &Look, raster: &Raster) -> Vec<crate::scene::Ghost> {
        let frame = raster.frame();
        let size = 0.288_675_134_594_812_9 * frame.pixel_sides().x;
        let light = |cell: Cell, flux| Light { position: cell.place, flux, size, muted: false };
        let cells = raster.cells(1);
        let of = |cell: &Cell| {
            let part = raster.flux().map(|flux| flux * cell.light / raster.flux().iter().sum::<f64>());
            let light = light(*cell, part);
            let rows = optical(look).ghosts_at(cell.place - look.axis);
            rows.iter().map(|row| row.of(&light, look.axis)).collect::<Vec<_>>()
        };
        cells.iter().flat_map(of).collect()
    }

    #[test]
    fn patches_have_the_light_that_rims_leave_of_every_pixel() {
        let (look, raster) = photo([45, 30]);
        let look = look.fitted(&raster.frame());
        let images = look.images(&Photo::new(1, 1, vec![[0.0; 4]]), || raster.clone()).unwrap();
        let rims = images.rims().unwrap();
        assert!(rims.cut > 20 && rims.images > 2 * rims.cut && rims.images <= rims.cut * (MOST_EACH + 1), "{rims:?}");
        let light: f64 = raster.flux().iter().sum();
        let left = |cell: &Cell| -> f64 {
            let rows = optical(&look).ghosts_at(cell.place - look.axis);
            cell.light * rows.iter().map(|row| row.share * row.tint.iter().sum::<f64>()).sum::<f64>()
        };
        let wanted = raster.cells(1).iter().map(left).sum::<f64>() / light;
        let found: f64 = (0..images.patches() + 1).map(|patch| share(&images, patch)).sum();
        assert!((found / wanted - 1.0).abs() < 1e-6, "{found} {wanted}");
        assert_eq!(images.of_each(), look.lens_ghosts().len());
    }

    /// What the images of a patch have of all light, as if each colour had as much.
    fn share(images: &Images, patch: usize) -> f64 {
        let of = images.all().iter().filter(|image| image.patch == patch);
        let whole: f64 = images.raster().flux().iter().sum();
        of.map(|image| {
            let part = images.raster_of(image).flux().iter().sum::<f64>() / whole;
            part * image.ghost.flux().iter().sum::<f64>()
        })
        .sum()
    }

    /// As much is off as is estimated at most, and where one image has to do for each ghost, more is and more is said to be.
    #[test]
    fn the_estimate_of_what_is_misplaced_holds() {
        let (look, raster) = photo([12, 8]);
        let look = look.fitted(&raster.frame());
        let frame = raster.frame();
        let points: Vec<DVec2> = (0..12 * 8).map(|k| frame.position(f64::from(k % 12), f64::from(k / 12))).collect();
        let sum = |values: &[[f64; 3]]| values.iter().map(|value| value.iter().sum::<f64>()).collect::<Vec<f64>>();
        let truth = sum(&direct_at(&each(&look, &raster), &points));
        let Patched { whole, patches, rims } = Patched::new(optical(&look), &raster, look.axis);
        let found = Images::in_patches(raster.clone(), &whole, &patches, look.axis, 1.0, [1.0; 3]);
        let off = |found: &[f64]| {
            found.iter().zip(&truth).map(|(found, truth)| (found - truth).abs()).sum::<f64>()
                / truth.iter().sum::<f64>()
        };
        let fine = off(&sum(&found.at(&points)));
        let uncut = Images::new(raster.clone(), look.lens_ghosts(), look.axis, 1.0, [1.0; 3]);
        let coarse = off(&sum(&uncut.at(&points)));
        assert!(fine > 1e-4 && fine <= rims.misplaced, "{fine} {rims:?}");
        assert!(coarse > 3.0 * fine, "{coarse} {fine}");
    }
}
