//! A photo that is open: the pixels that are shown, its look, and how it is looked at.

use std::borrow::Cow;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::{DMat3, DVec2};

use super::app::LookFile;
use super::ask::Purpose;
use super::model::{History, Look, LookLens};
use super::shrink::{shrink, side};
use super::viewing::Viewing;
use crate::Result;
use crate::frame::Frame;
use crate::look::Search;
use crate::photo::{self, Photo, ReadOptions};
use crate::printable;
use crate::scene::{FindOptions, Found, Ghost, Light, Recovered};

/// The most pixels that are computed live: one tile of the renderer's, 4 Mpx.
///
/// A larger photo is shown as means of squares of its pixels. Nothing else changes by that: lights, ghosts and tolerance
/// are in units of the picture's height, and the lights are those of the whole photo.
pub const LIVE_PIXELS: usize = 4 << 20;

/// One open photo.
pub struct Document {
    /// Its file.
    pub path: PathBuf,
    /// The whole of it, as it was read.
    pub photo: Arc<Photo>,
    /// The frame of the pixels that are shown, with lengths in the look's unit, as far as that can be had.
    pub frame: Frame,
    /// The side of the square of the file's pixels whose mean is one that is shown.
    pub shrunk: u32,
    /// The means, where they are not the file's own pixels.
    pub(super) means: Option<Arc<Vec<[f32; 4]>>>,
    /// How the file's pixels shine, by the look that it was opened with.
    pub(super) recovered: Arc<Recovered>,
    /// From its primaries to Rec.709's, where they differ.
    pub gamut: Option<DMat3>,
    /// What was found in it, and by which rules.
    pub found: Found,
    /// The rules that it was found by.
    pub searched: FindOptions,
    /// The unit of lengths that it was searched in, in half picture heights, and that of what was found.
    pub searched_in: f64,
    found_in: f64,
    /// What is set; a change becomes a step of the history by [`Document::record`].
    pub look: Look,
    history: History,
    /// The scene file of the look, if it has one.
    pub(super) file: Option<LookFile>,
    /// What was set when it was opened.
    pub opened: Look,
    /// How it is looked at.
    pub viewing: Viewing,
    /// The light that is selected.
    pub selected: Option<usize>,
    /// It as it was when it was selected, for its way back.
    light_before: Option<Light>,
    /// The light that the list of lights is to show next.
    pub(super) shows_light: Option<usize>,
    /// The ghost of no light that is selected, and it as it was then.
    pub(super) selected_ghost: Option<(usize, Ghost)>,
    /// The lens that its table was made from.
    pub(super) lens_before: LookLens,
    /// When it was last chosen among the open ones, by a count.
    pub(super) seen: u64,
    /// Whether it lets go of its pixels and could not be read again.
    pub(super) unreadable: bool,
    /// What a panel wants a path for, until it has been asked.
    pub(super) wants_path: Option<Purpose>,
    /// Why the veil is not as it was last set.
    pub(super) veil_fault: Option<String>,
    /// Whether a control of the threshold is at hand, so that what it tells from the rest is to be seen.
    pub(super) sets_threshold: bool,
}

impl Document {
    /// Reads a photo and finds its lights.
    ///
    /// # Errors
    /// Those of [`photo::read_with`].
    pub fn read(path: &Path, options: &ReadOptions, look: Look) -> Result<Self> {
        Ok(Self::new(path, photo::read_with(path, options)?, look))
    }

    /// An open photo.
    pub fn new(path: &Path, photo: Photo, look: Look) -> Self {
        let shrunk = side(photo.frame.window, LIVE_PIXELS);
        let whole = look.frame(&photo).unwrap_or(photo.frame);
        let look = look.fitted(&whole).into_owned();
        let recovered = look.recovered(&photo);
        let (frame, means) = match shrunk {
            1 => (photo.frame, None),
            side => shrink(&photo.frame, &photo.pixels, side),
        };
        let means = means.map(Arc::new);
        Self {
            path: path.to_owned(),
            gamut: photo.to_rec709(),
            found: look.find(&photo, &recovered, &whole),
            searched: look.find,
            searched_in: whole.unit,
            found_in: whole.unit,
            recovered: Arc::new(recovered),
            photo: Arc::new(photo),
            frame: frame.in_units_of(whole.unit),
            shrunk,
            means,
            history: History::new(look.clone()),
            file: None,
            opened: look.clone(),
            lens_before: look.lens.clone(),
            look,
            viewing: Viewing::default(),
            selected: None,
            light_before: None,
            shows_light: None,
            selected_ghost: None,
            seen: 0,
            unreadable: false,
            wants_path: None,
            veil_fault: None,
            sets_threshold: false,
        }
    }

    /// The pixels that are shown, linear RGBA, row by row from the top.
    pub fn pixels(&self) -> &[[f32; 4]] {
        self.means.as_deref().unwrap_or(&self.photo.pixels)
    }

    /// The bytes of its pixels.
    pub(super) fn bytes(&self) -> usize {
        let shown = self.photo.pixels.len() + self.means.as_ref().map_or(0, |means| means.len());
        size_of::<[f32; 4]>() * shown + self.recovered.bytes()
    }

    /// Lets go of the pixels, and of all else of the file that is not needed to show what is set.
    pub(super) fn sleep(&mut self) {
        self.photo = Arc::new(self.photo.without_pixels());
        self.means = None;
        self.recovered = Arc::default();
    }

    /// Whether it has let go of its pixels.
    pub(super) fn is_asleep(&self) -> bool {
        self.photo.pixels.is_empty()
    }

    /// Takes the pixels of the same file, read again, and what was found in it; all that is set stays.
    pub(super) fn wake(&mut self, fresh: Self) {
        (self.photo, self.means, self.frame, self.shrunk) = (fresh.photo, fresh.means, fresh.frame, fresh.shrunk);
        (self.gamut, self.recovered) = (fresh.gamut, fresh.recovered);
        self.set_found(Search { options: fresh.searched, unit: fresh.searched_in, found: fresh.found });
    }

    /// The lights, found or listed, muted ones too.
    pub fn lights(&self) -> Cow<'_, [Light]> {
        self.look.lights(&self.found.lights)
    }

    /// The lights as a list to be edited.
    pub fn lights_mut(&mut self) -> &mut Vec<Light> {
        self.look.lights_mut(&self.found.lights)
    }

    /// Selects a light, and no ghost.
    pub fn select(&mut self, index: usize) {
        self.light_before = self.lights().get(index).copied();
        self.selected = self.light_before.map(|_| index);
        self.shows_light = self.selected;
        self.selected_ghost = None;
    }

    /// Selects a ghost that no light makes, and no light.
    pub fn select_ghost(&mut self, index: usize) {
        self.selected_ghost = self.look.ghosts.get(index).map(|ghost| (index, ghost.clone()));
        self.selected = None;
    }

    /// The light that is selected, as it was then.
    pub(super) fn light_before(&self) -> Option<Light> {
        self.selected.and(self.light_before)
    }

    /// Takes a light away.
    pub fn delete_light(&mut self, index: usize) {
        self.look.delete_light(&self.found.lights, index);
        self.selected = None;
    }

    /// Takes a ghost away that no light makes.
    pub fn delete_ghost(&mut self, index: usize) {
        self.look.delete_ghost(index);
        self.selected_ghost = None;
    }

    /// What is set, as far as it is known what it means: while the photo is searched anew, with the search before. What needs no
    /// search, as a threshold of all pixels, counts at once.
    pub fn known_look(&self) -> Look {
        let find = if self.look.searches() { self.searched } else { self.look.find };
        Look { find, ..self.look.clone() }
    }

    /// How the file's pixels shine by a look.
    pub(super) fn recovered(&self, look: &Look) -> Arc<Recovered> {
        if self.recovered.by == look.find.recover {
            return self.recovered.clone();
        }
        Arc::new(look.recovered(&self.photo))
    }

    /// Whether the photo has to be searched anew.
    pub fn wants_search(&self) -> bool {
        self.look.searches() && (self.look.find != self.searched || self.frame.unit != self.searched_in)
    }

    /// Takes over what a search found.
    pub fn set_found(&mut self, search: Search) {
        let Search { options, unit, found } = search;
        (self.searched, self.searched_in, self.found_in, self.found) = (options, unit, unit, found);
        self.fit_unit();
        self.drop_selection();
    }

    /// What a search found, and by which rules.
    pub fn search(&self) -> Search {
        Search { options: self.searched, unit: self.searched_in, found: self.found.clone() }
    }

    /// The frame of the whole photo, with lengths in the look's unit.
    pub fn whole_frame(&self) -> Frame {
        self.photo.frame.in_units_of(self.frame.unit)
    }

    /// Counts lengths in the unit of a look that has changed, those of lights, too, until they have been searched for anew. A
    /// unit that cannot be had changes nothing here; the stage says why.
    fn fit_unit(&mut self) {
        let unit = self.look.frame(&self.photo).map_or(self.frame.unit, |frame| frame.unit);
        self.frame = self.frame.in_units_of(unit);
        if let Cow::Owned(look) = self.look.fitted(&self.frame) {
            self.look = look;
        }
        if self.found_in != unit {
            self.found.rescale(self.found_in / unit);
            self.found_in = unit;
        }
    }

    /// Makes what has changed since a step of the history. While a gesture goes on, its changes are one step.
    pub fn record(&mut self, gesture: bool) {
        self.fit_unit();
        if gesture && self.look != *self.history.look() {
            self.history.begin();
        }
        if self.look != *self.history.look() {
            self.history.set(self.look.clone());
        }
        if !gesture {
            self.history.commit();
        }
    }

    /// Sets another look altogether.
    pub fn set_look(&mut self, look: Look) {
        self.look = look;
        self.veil_fault = None;
        self.fit_unit();
        self.drop_selection();
    }

    /// Goes a step back.
    pub fn undo(&mut self) {
        self.record(false);
        self.history.undo();
        self.look.clone_from(self.history.look());
        self.veil_fault = None;
        self.fit_unit();
        self.drop_selection();
    }

    /// Goes forward again.
    pub fn redo(&mut self) {
        self.record(false);
        self.history.redo();
        self.look.clone_from(self.history.look());
        self.veil_fault = None;
        self.fit_unit();
        self.drop_selection();
    }

    /// Whether there is a step to undo, and one to redo.
    pub fn steps(&self) -> [bool; 2] {
        [self.history.can_undo(), self.history.can_redo()]
    }

    fn drop_selection(&mut self) {
        let count = self.lights().len();
        self.selected = self.selected.filter(|&index| index < count);
        let ghosts = self.look.ghosts.len();
        self.selected_ghost = self.selected_ghost.take().filter(|&(index, _)| index < ghosts);
    }

    /// The file's name, without its folder, as it can be shown.
    pub fn name(&self) -> String {
        printable::line(&self.path.file_name().unwrap_or(self.path.as_os_str()).to_string_lossy())
    }

    /// Where a point of the picture plane lies among the shown pixels, counted from their top left corner.
    pub fn place(&self, position: DVec2) -> DVec2 {
        let window = self.frame.window;
        self.frame.pixel(position) + 0.5 - DVec2::new(f64::from(window.x), f64::from(window.y))
    }

    /// The inverse of [`Document::place`].
    pub fn position(&self, place: DVec2) -> DVec2 {
        let window = self.frame.window;
        let pixel = place - 0.5 + DVec2::new(f64::from(window.x), f64::from(window.y));
        self.frame.position(pixel.x, pixel.y)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::choices::LengthUnit;
    use crate::look::LookLights;

    #[test]
    fn place_and_position_undo_each_other() {
        let document = Document::new(Path::new("a.exr"), Photo::new(8, 4, vec![[0.5; 4]; 32]), Look::default());
        assert_eq!(document.place(DVec2::ZERO), DVec2::new(4.0, 2.0));
        let at = DVec2::new(-1.25, 7.5);
        assert!((document.place(document.position(at)) - at).length() < 1e-12);
    }

    #[test]
    fn another_unit_moves_nothing_and_asks_for_a_search() {
        // Upright, so that half the height is twice half the shorter side.
        let mut pixels = vec![[0.1, 0.1, 0.1, 1.0]; 8 * 16];
        pixels[3 * 8 + 6] = [90.0, 90.0, 90.0, 1.0];
        pixels[3 * 8 + 7] = [90.0, 90.0, 90.0, 1.0];
        let found = Look { lights: LookLights::Found, ..Look::default() };
        let by_height = Look { unit: LengthUnit::Height, ..found.clone() };
        let mut document = Document::new(Path::new("a.exr"), Photo::new(8, 16, pixels), by_height.clone());
        let (before, place) = (document.found.lights[0], document.place(document.found.lights[0].position));
        document.set_look(Look { unit: LengthUnit::ShortSide, ..found });
        let after = document.found.lights[0];
        assert_eq!((after.position, after.size), (2.0 * before.position, 2.0 * before.size));
        assert_eq!(after.flux, before.flux.map(|flux| 4.0 * flux));
        assert_eq!((document.place(after.position), document.wants_search()), (place, true));
        let (look, frame) = (document.look.clone(), document.whole_frame());
        let found = look.find(&document.photo, &document.recovered, &frame);
        document.set_found(Search { options: look.find, unit: frame.unit, found });
        assert!((document.found.lights[0].position - after.position).length() < 1e-12 && !document.wants_search());
        document.set_look(by_height);
        assert!((document.found.lights[0].position - before.position).length() < 1e-12 && document.wants_search());
        // Nothing says what a degree is here: that changes nothing but what the stage tells.
        document.set_look(Look { unit: LengthUnit::Degrees, ..Look::default() });
        assert_eq!((document.frame.unit, document.look.frame(&document.photo).is_err()), (1.0, true));
    }

    #[test]
    fn a_drag_of_the_strength_copies_no_list() {
        let light = Light { position: DVec2::ZERO, flux: [1.0; 3], size: 0.0, muted: false };
        let bell = crate::series::Bell::Gaussian;
        let ghost = Ghost { bell, center: DVec2::ZERO, size: DVec2::ONE, radiance: [1.0; 3] };
        let lights = LookLights::Listed(vec![light; 1000].into());
        let look = Look { lights, ghosts: vec![ghost; 1000].into(), ..Look::default() };
        let mut document = Document::new(Path::new("a.exr"), Photo::new(2, 1, vec![[0.5; 4]; 2]), look.clone());
        for strength in [2.0, 3.0] {
            document.look.strength = strength;
            document.record(true);
        }
        for other in [&document.look, document.history.look(), &document.known_look()] {
            let (LookLights::Listed(one), LookLights::Listed(other_lights)) = (&look.lights, &other.lights) else {
                panic!("they are listed")
            };
            assert!(one.is(other_lights) && look.ghosts.is(&other.ghosts));
            let (LookLens::Preset(one), LookLens::Preset(other)) = (&look.lens, &other.lens) else {
                panic!("it is a preset")
            };
            assert!(Arc::ptr_eq(one, other));
        }
    }

    #[test]
    fn a_gesture_is_one_step_and_an_edit_lists_the_lights() {
        let look = Look { lights: LookLights::Found, ..Look::default() };
        let mut document = Document::new(Path::new("a.exr"), Photo::new(2, 1, vec![[0.5; 4]; 2]), look);
        for strength in [2.0, 3.0, 4.0] {
            document.look.strength = strength;
            document.record(true);
        }
        document.record(false);
        document.lights_mut().clear();
        document.record(false);
        assert_eq!(document.steps(), [true, false]);
        document.undo();
        assert_eq!((document.look.strength, document.look.searches()), (4.0, true));
        document.undo();
        assert_eq!((&document.look, document.steps()), (&document.opened, [false, true]));
        document.redo();
        assert_eq!(document.look.strength, 4.0);
    }
}
