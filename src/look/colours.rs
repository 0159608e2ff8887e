//! Colours that a look gives are those of Rec. 709, whatever primaries a photo's numbers have: what tints make of white light is the same in all.

use glam::{DMat3, DVec3};

use super::Look;
use crate::photo::Photo;
use crate::problem::Images;
use crate::scene::{Ghost, Light};

/// Below this part of the largest a part of a colour is what rounding left of none.
const ROUNDING: f64 = 1e-12;

/// Between the primaries of a photo and those of Rec. 709.
pub(super) struct Colours {
    to_rec709: DMat3,
    from_rec709: DMat3,
}

impl Colours {
    /// Those of a photo; none where it is Rec. 709 already.
    pub fn of(photo: &Photo) -> Option<Self> {
        let to_rec709 = photo.to_rec709()?;
        Some(Self { to_rec709, from_rec709: to_rec709.inverse() })
    }

    /// A colour of Rec. 709 in the photo's primaries; a grey is the same in both.
    fn in_photo(&self, colour: [f64; 3]) -> [f64; 3] {
        if colour[0] == colour[1] && colour[1] == colour[2] {
            return colour;
        }
        let colour = self.from_rec709 * DVec3::from(colour);
        let none = ROUNDING * colour.abs().max_element();
        colour.to_array().map(|part| if part.abs() <= none { 0.0 } else { part })
    }

    /// The ghosts of a look on the photo. Of a light each ghost has the colour that it would have in Rec. 709, and none that is negative.
    pub fn ghosts(&self, look: &Look, lights: &[Light]) -> Vec<Ghost> {
        let in_rec709 = |light: &Light| Light { flux: (self.to_rec709 * DVec3::from(light.flux)).to_array(), ..*light };
        let mut ghosts = look.ghosts(&lights.iter().map(in_rec709).collect::<Vec<_>>());
        let of_lights = ghosts.len() - look.ghosts.len();
        for (index, ghost) in ghosts.iter_mut().enumerate() {
            ghost.radiance = self.in_photo(ghost.radiance);
            if index < of_lights {
                ghost.radiance = ghost.radiance.map(|part| part.max(0.0));
            }
        }
        ghosts
    }

    /// The ghosts of all pixels, which have each colour by itself: the colour of a ghost is the one that it has of white light.
    pub fn images(&self, images: Images) -> Images {
        images.recoloured(|colour| self.in_photo(colour))
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec2;

    use super::*;
    use crate::look::LookLights;
    use crate::photo::Primaries;

    /// The same lamps before black, in Rec. 709 or in other primaries.
    fn photo(lamps: [[f64; 3]; 2], primaries: Option<Primaries>) -> Photo {
        let mut pixels = vec![[0.0, 0.0, 0.0, 1.0]; 48 * 32];
        let mut photo = Photo::new(48, 32, pixels.clone());
        photo.source.primaries = primaries;
        let own = Colours::of(&photo).map_or(DMat3::IDENTITY, |colours| colours.from_rec709);
        for (at, lamp) in [400, 1000].into_iter().zip(lamps) {
            let [r, g, b] = (own * DVec3::from(lamp)).to_array().map(|part| part as f32);
            pixels[at] = [r, g, b, 1.0];
        }
        Photo { pixels, ..photo }
    }

    /// Radiances in Rec. 709.
    fn radiances<'a>(photo: &Photo, ghosts: impl Iterator<Item = &'a Ghost>) -> Vec<DVec3> {
        let to_rec709 = photo.to_rec709().unwrap_or(DMat3::IDENTITY);
        ghosts.map(|ghost| to_rec709 * DVec3::from(ghost.radiance)).collect()
    }

    fn near(one: &[DVec3], other: &[DVec3]) -> bool {
        let close = |(one, other): (&DVec3, &DVec3)| (*one - *other).abs().max_element() <= 1e-6 * other.max_element();
        one.len() == other.len() && !one.is_empty() && one.iter().zip(other).all(close)
    }

    #[test]
    fn ghosts_are_of_one_colour_in_all_primaries() {
        let (coloured, white) = ([[300.0, 200.0, 40.0], [20.0, 90.0, 400.0]], [[300.0; 3], [40.0; 3]]);
        let look =
            Look { lights: LookLights::Found, tint: [1.0, 0.5, 0.25], axis: DVec2::new(0.1, 0.0), ..Look::default() };
        let everywhere = Look { lights: LookLights::Photo(Vec::new().into()), ..look.clone() };
        let of = |look: &Look, lamps, primaries| {
            let photo = photo(lamps, primaries);
            let frame = look.frame(&photo).unwrap();
            let scene = look.gather(&photo, &frame);
            match &scene.images {
                Some(images) => radiances(&photo, images.all().iter().map(|image| &image.ghost)),
                None => radiances(&photo, scene.ghosts.iter()),
            }
        };
        for primaries in [Primaries::ACESCG, Primaries::ACES2065_1, Primaries::REC2020, Primaries::P3_D65] {
            assert!(near(&of(&look, coloured, Some(primaries)), &of(&look, coloured, None)), "{primaries:?}: lights");
            assert!(
                near(&of(&everywhere, white, Some(primaries)), &of(&everywhere, white, None)),
                "{primaries:?}: pixels"
            );
        }
    }
}
