//! What glares in a photo, as a look has it.

use std::sync::Arc;

use super::colours::Colours;
use super::patches::Patched;
use super::{Look, LookLens, LookLights};
use crate::choices::{Mix, Sources};
use crate::frame::Frame;
use crate::photo::Photo;
use crate::problem::{Images, Problem};
use crate::raster::Raster;
use crate::scene::{self, Emission, FindOptions, Found, Ghost, Knee, Lens, Light, Recovered, Recovery};

/// What glares in one photo.
pub struct Gathered {
    /// What was found in the photo, if it was searched.
    pub found: Option<Found>,
    /// The lights, found or listed, muted ones too.
    pub lights: Vec<Light>,
    /// The lens, if there are lights.
    pub lens: Option<Lens>,
    /// Ghosts of the lights, then those that no light makes.
    pub ghosts: Arc<[Ghost]>,
    /// Ghosts of all pixels, where they make some.
    pub images: Option<Arc<Images>>,
    /// What became of clipped highlights, if there are any.
    pub recovery: Option<Recovery>,
}

impl Gathered {
    /// Whether nothing glares.
    pub fn is_dark(&self) -> bool {
        self.ghosts.is_empty() && self.images.as_ref().is_none_or(|images| images.all().is_empty())
    }

    /// What in the photo makes ghosts.
    pub fn sources(&self) -> Sources {
        if self.images.is_some() { Sources::Photo } else { Sources::Lights }
    }

    /// How many ghosts there are, those of all pixels too.
    pub fn count(&self) -> usize {
        let images = self.images.as_ref().map_or(0, |images| images.count());
        self.ghosts.len() + images
    }

    /// What is to be planned, on a frame in the same unit.
    pub fn problem(&self, frame: Frame) -> Arc<Problem> {
        match &self.images {
            Some(images) => Problem::with_images(self.ghosts.clone(), images.clone(), frame),
            None => Problem::new(self.ghosts.clone(), frame),
        }
    }
}

/// What a photo was searched by, and what was found.
#[derive(Debug, Clone, PartialEq)]
pub struct Search {
    /// The rules.
    pub options: FindOptions,
    /// The unit of lengths, in half picture heights.
    pub unit: f64,
    /// What there is by them.
    pub found: Found,
}

impl Look {
    /// What glares in a photo, on its frame as [`Look::frame`] gives it. It is searched for lights where none are listed, and
    /// for the threshold where light is taken from it.
    pub fn gather(&self, photo: &Photo, frame: &Frame) -> Gathered {
        self.gather_knowing(photo, &self.recovered(photo), frame, None)
    }

    /// The same for a photo of which it is known how it shines, as [`Look::recovered`] tells, and that may have been searched
    /// already; by other rules than the look's it is searched again.
    pub fn gather_knowing(
        &self,
        photo: &Photo,
        recovered: &Recovered,
        frame: &Frame,
        search: Option<Search>,
    ) -> Gathered {
        let fits = |search: &Search| search.options == self.find && search.unit == frame.unit;
        let known = search.filter(fits).map(|search| search.found);
        let found = self.searches().then(|| known.unwrap_or_else(|| self.find(photo, recovered, frame)));
        let images = self.images(photo, || self.raster(photo, recovered, frame));
        Gathered { images, recovery: recovered.told.clone(), ..self.gather_from(found, photo, frame) }
    }

    /// How the pixels of a photo shine, of which all that glares is made: as they are shown, but for those that are clipped.
    ///
    /// # Panics
    /// For a photo without its pixels.
    pub fn recovered(&self, photo: &Photo) -> Recovered {
        let (emission, is_for_display) = (Emission::of(photo), photo.source.display_referred);
        scene::recover(&photo.pixels, &photo.frame, emission, is_for_display, self.find.recover)
    }

    /// Whether it matters how the pixels of a photo shine.
    pub fn takes_light(&self) -> bool {
        self.veil.is_some() || self.searches() || self.takes_photo()
    }

    /// What of a photo shines where every pixel is a source, on its frame as [`Look::frame`] gives it; `recovered` is how its
    /// pixels shine, as [`Look::recovered`] tells.
    ///
    /// # Panics
    /// For a frame of other pixels than the photo's.
    pub fn raster(&self, photo: &Photo, recovered: &Recovered, frame: &Frame) -> Arc<Raster> {
        let given = Emission::of(photo).given(recovered.over(&photo.pixels));
        let knee = self.find.knee();
        let shining = if knee == Knee::NONE { given } else { knee.shining(&given).into() };
        Raster::new(&shining, *frame).expect("a photo has the pixels of its frame")
    }

    /// The ghosts of all pixels of a photo, as [`Look::raster`] gives it; none where others shine.
    pub fn images(&self, photo: &Photo, raster: impl FnOnce() -> Arc<Raster>) -> Option<Arc<Images>> {
        let of = |raster: Arc<Raster>| {
            let look = self.fitted(&raster.frame());
            let (axis, size, tint) = (self.axis, self.size, self.tint);
            let images = match &look.lens {
                LookLens::Optical(optical) => {
                    let Patched { whole, patches, rims } = Patched::new(optical, &raster, axis);
                    Images::in_patches(raster, &whole, &patches, axis, size, tint).behind(rims)
                }
                _ => Images::new(raster, look.lens_ghosts(), axis, size, tint),
            };
            Arc::new(match Colours::of(photo) {
                Some(colours) => colours.images(images),
                None => images,
            })
        };
        self.takes_photo().then(|| of(raster()))
    }

    /// What glares in a photo of which `found` is known, on its frame.
    pub fn gather_from(&self, found: Option<Found>, photo: &Photo, frame: &Frame) -> Gathered {
        let look = self.fitted(frame);
        let lights = self.lights(found.as_ref().map_or(&[], |found| &found.lights)).into_owned();
        let lens = (!lights.is_empty() || self.takes_photo()).then(|| look.lens());
        let ghosts = match Colours::of(photo) {
            Some(colours) => colours.ghosts(&look, &lights),
            None => look.ghosts(&lights),
        };
        Gathered { ghosts: ghosts.into(), found, lights, lens, images: None, recovery: None }
    }

    /// Whether a photo is to be searched: for lights, or for the threshold that tells them from the rest.
    pub fn searches(&self) -> bool {
        self.finds() || (self.mix == Mix::Energy && !self.takes_photo())
    }

    /// Whether lights of the photo shine.
    pub fn finds(&self) -> bool {
        matches!(self.lights, LookLights::Found | LookLights::FoundAnd(_)) && !self.lens_ghosts().is_empty()
    }

    /// Whether there are any ghosts to be rendered: not through a lens without ghosts, which makes none of any light.
    pub fn renders(&self) -> bool {
        self.strength != 0.0 && !(self.lens_ghosts().is_empty() && self.ghosts.is_empty())
    }

    /// Searches a photo for lights, on its frame as [`Look::frame`] gives it; `recovered` is how its pixels shine, as
    /// [`Look::recovered`] tells.
    pub fn find(&self, photo: &Photo, recovered: &Recovered, frame: &Frame) -> Found {
        let shining = recovered.over(&photo.pixels);
        scene::find_shining(&photo.pixels, shining, frame, Emission::of(photo), &self.find)
    }

    /// The ghosts that the lens makes of `lights`, then those that no light makes, in the look's size and tint; those of a lens that is
    /// known by its surfaces on the picture that it was fitted to.
    pub fn ghosts(&self, lights: &[Light]) -> Vec<Ghost> {
        let mut ghosts = match (self.lens_ghosts(), &self.lens) {
            ([], _) => Vec::new(),
            (_, LookLens::Optical(optical)) => optical.ghosts_of(lights, self.axis),
            _ => scene::ghosts(lights, &self.lens(), self.axis),
        };
        ghosts.extend_from_slice(&self.ghosts);
        // A look that leaves them alone keeps every bit.
        if self.size != 1.0 {
            ghosts = ghosts.into_iter().map(|ghost| ghost.scaled(self.size)).collect();
        }
        if self.tint != [1.0; 3] {
            for ghost in &mut ghosts {
                for (radiance, tint) in ghost.radiance.iter_mut().zip(self.tint) {
                    *radiance *= tint;
                }
            }
        }
        ghosts
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec2;

    use super::*;
    use crate::look::LookLens;
    use crate::scene::LensGhost;
    use crate::series::Bell;

    /// Of a photo with one lamp each patch that has light has it at its middle, so that pixels make the lamp's ghosts, cut as they are.
    #[test]
    fn a_lamp_in_a_photo_has_the_ghosts_that_it_has_as_a_light() {
        let frame = Frame::full(64, 36);
        let lamp = [57, 4];
        let mut pixels = vec![[0.0, 0.0, 0.0, 1.0]; frame.window.pixels()];
        pixels[(lamp[1] * 64 + lamp[0]) as usize] = [3.0, 2.0, 1.0, 1.0];
        let raster = Raster::new(&pixels, frame).unwrap();
        let flux = raster.flux();
        let look = Look { lens: LookLens::preset("double-gauss").unwrap(), ..Look::default() };
        let images = look.images(&Photo::new(1, 1, vec![[0.0; 4]]), || raster).unwrap();
        let position = frame.position(f64::from(lamp[0]), f64::from(lamp[1]));
        let size = 0.288_675_134_594_812_9 * frame.pixel_sides().x;
        let fitted = look.fitted(&frame);
        let ghosts = fitted.ghosts(&[Light { position, flux, size, muted: false }]);
        let whole = fitted.lens_ghosts().iter().map(|row| row.share * row.tint[1]).sum::<f64>();
        assert!(images.share()[1] < 0.7 * whole, "{} {whole}: it is in a corner", images.share()[1]);
        let points: Vec<DVec2> =
            (0..60).map(|k| frame.position(f64::from(k * 37 % 64), f64::from(k * 23 % 36))).collect();
        let found = images.at(&points);
        let wanted = crate::reference::direct_at(&ghosts, &points);
        let largest = wanted.iter().map(|value| value[1]).fold(0.0, f64::max);
        for (found, wanted) in found.iter().zip(&wanted) {
            // What is below 1e-10 of a bell's peak is left out of pixels' sums.
            assert!((found[1] - wanted[1]).abs() < 1e-8 * largest, "{found:?} {wanted:?}");
        }
    }

    #[test]
    fn size_keeps_the_flux_of_every_bell_and_tint_scales_it() {
        for bell in Bell::examples() {
            let ghost = Ghost { bell, center: DVec2::ONE, size: DVec2::new(0.3, 0.2), radiance: [1.0, -2.0, 3.0] };
            let look = Look { size: 1.7, tint: [0.5, 1.0, 2.0], ghosts: vec![ghost.clone()].into(), ..Look::default() };
            let ghosts = look.ghosts(&[]);
            assert_eq!((ghosts.len(), ghosts[0].size), (1, 1.7 * ghost.size));
            let expected = [0.5, 1.0, 2.0].iter().zip(ghost.flux()).map(|(tint, flux)| tint * flux);
            for (actual, expected) in ghosts[0].flux().into_iter().zip(expected) {
                assert!((actual / expected - 1.0).abs() < 1e-9, "{}: {actual} {expected}", ghost.bell);
            }
        }
    }

    #[test]
    fn ghosts_are_mirrored_about_the_axis_and_muted_lights_make_none() {
        let light = Light { position: DVec2::new(0.5, 0.25), flux: [1.0; 3], size: 0.0, muted: false };
        let (bell, size) = (Bell::Gaussian, DVec2::ONE);
        let mirror = LensGhost { bell, along: -1.0, size, tint: [1.0; 3], share: 1.0 };
        let mut look =
            Look { lens: LookLens::Own(vec![mirror].into()), axis: DVec2::new(0.25, -0.25), ..Look::default() };
        let muted = Light { muted: true, ..light };
        assert_eq!(look.ghosts(&[muted, light]).len(), 1);
        assert_eq!(look.ghosts(&[light])[0].center, DVec2::new(0.0, -0.75));
        look.axis = DVec2::ZERO;
        assert_eq!(look.ghosts(&[light])[0].center, -light.position);
    }
}
