//! A few pixels by the definition: sources one by one, or targets.

use rayon::prelude::*;

use super::evaluate::Light;
use super::{Channel, Transform};

/// Bright pixels that are summed by themselves.
const BRIGHTEST: usize = 64;

/// What they and their images beyond the border may be together.
const IMAGES: usize = 4 * BRIGHTEST;

/// How much less ‖L‖₂ has to be without them.
const LESS: f64 = 0.25;

/// The sources of a channel.
pub(super) struct List {
    /// Of each row of the photo and of what the border adds at its ends: those that send light, by the column.
    rows: Vec<Vec<(i32, f32)>>,
    /// How many there are, with the rows that the border adds.
    pub count: usize,
    /// The longest chain of sums.
    pub longest: usize,
}

/// A bright pixel.
pub(super) struct Bright {
    at: [usize; 2],
    pub light: f64,
    /// The columns and the rows where it and its images are.
    places: [Vec<isize>; 2],
}

impl Bright {
    /// How often it is there.
    pub fn images(&self) -> usize {
        self.places[0].len() * self.places[1].len()
    }

    /// Leaves it out of a row of sources that begins at the column −`before`.
    pub fn take_out(&self, row: usize, before: usize, sources: &mut [f64]) {
        if row == self.at[1] {
            self.places[0].iter().for_each(|column| sources[(column + before as isize) as usize] = 0.0);
        }
    }
}

impl Transform {
    /// The sources.
    pub(super) fn list(&self, light: Light) -> List {
        let row = |y: usize| {
            let lights = (-(self.margin[0] as i32)..).zip(self.lights(light, y));
            lights.filter(|(_, light)| *light != 0.0).map(|(column, light)| (column, light as f32)).collect()
        };
        let rows: Vec<Vec<(i32, f32)>> = (0..self.task.size[1]).into_par_iter().map(row).collect();
        let lengths = || self.rows_seen().map(|(_, from)| rows[from].len());
        let longest = lengths().count() + lengths().max().unwrap_or(0);
        List { count: lengths().sum(), longest, rows }
    }

    /// Rows that are seen, the border's included, and which of the photo's each is.
    pub(super) fn rows_seen(&self) -> impl Iterator<Item = (isize, usize)> {
        self.seen(1).filter_map(|y| Some((y, self.task.border.source(y, self.task.size[1])?)))
    }

    /// Columns or rows that are seen, the border's included.
    fn seen(&self, side: usize) -> std::ops::Range<isize> {
        let margin = self.margin[side] as isize;
        -margin..self.task.size[side] as isize + margin
    }

    /// A row of the photo with what the border adds at its ends.
    pub(super) fn lights(&self, light: Light, row: usize) -> Vec<f64> {
        let mut lights = vec![0.0; self.task.size[0] + 2 * self.margin[0]];
        light.photo.lights(light.channel, row, self.task.border, self.margin[0], &mut lights);
        lights
    }

    /// What they all send to a pixel, and the sum of the magnitudes of that.
    pub(super) fn at(&self, channel: usize, list: &List, [x, y]: [usize; 2]) -> [f64; 2] {
        let Channel { taps, .. } = self.channel(channel);
        let mut sums = [0.0; 2];
        for (seen, from) in self.rows_seen() {
            let Some(row) = taps.row(y as isize - seen) else { continue };
            let mut along = [0.0; 2];
            for (column, light) in &list.rows[from] {
                let value = taps.columns.index(x as isize - *column as isize).map_or(0.0, |index| row[index]);
                let part = f64::from(*light) * value;
                along[0] += part;
                along[1] += part.abs();
            }
            sums[0] += along[0];
            sums[1] += along[1];
        }
        sums
    }

    /// The brightest pixels of a channel, if the rest is much less without them.
    pub(super) fn brightest(&self, light: Light) -> Vec<Bright> {
        let width = self.task.size[0];
        let row = |y: usize| {
            let lights = self.lights(light, y);
            let own = lights[self.margin[0]..][..width].iter().enumerate();
            let mut own: Vec<([usize; 2], f64)> =
                own.filter(|(_, light)| **light > 0.0).map(|(x, light)| ([x, y], *light)).collect();
            let squares: f64 = own.iter().map(|(_, light)| light * light).sum();
            own.sort_unstable_by(|one, other| other.1.total_cmp(&one.1));
            own.truncate(BRIGHTEST);
            (squares, own)
        };
        let rows: Vec<_> = (0..self.task.size[1]).into_par_iter().map(row).collect();
        let all: f64 = rows.iter().map(|(squares, _)| squares).sum();
        let mut brightest: Vec<_> = rows.into_iter().flat_map(|(_, own)| own).collect();
        brightest.sort_unstable_by(|one, other| other.1.total_cmp(&one.1));
        let mut images = 0;
        let few =
            brightest.into_iter().take(BRIGHTEST).map(|(at, light)| self.bright(at, light)).take_while(|bright| {
                images += bright.images();
                images <= IMAGES
            });
        let brightest: Vec<Bright> = few.collect();
        let squares: f64 = brightest.iter().map(|bright| bright.light * bright.light).sum();
        if all - squares <= LESS * LESS * all { brightest } else { Vec::new() }
    }

    fn bright(&self, at: [usize; 2], light: f64) -> Bright {
        let border = self.task.border;
        let places = [0, 1].map(|side| {
            self.seen(side).filter(|place| border.source(*place, self.task.size[side]) == Some(at[side])).collect()
        });
        Bright { at, light, places }
    }

    /// Adds what bright pixels send to a row, `times` as much.
    pub(super) fn add_bright(&self, channel: usize, bright: &[Bright], times: f64, y: usize, into: &mut [f64]) {
        let Channel { taps, .. } = self.channel(channel);
        for Bright { light, places: [columns, rows], .. } in bright {
            let light = light * times;
            for values in rows.iter().filter_map(|row| taps.row(y as isize - row)) {
                for column in columns {
                    for (x, into) in into.iter_mut().enumerate() {
                        *into += light * taps.columns.index(x as isize - column).map_or(0.0, |index| values[index]);
                    }
                }
            }
        }
    }
}
