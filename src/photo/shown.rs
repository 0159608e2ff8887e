//! What a display shows of a photo's light.

use glam::{Mat3A, Vec3A};

use super::{Photo, ToneMap};

/// The way from a photo's light to a display's: that of a display format that is written without options.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Shown {
    gamut: Option<Mat3A>,
    tone_map: ToneMap,
}

impl Shown {
    /// That of one photo.
    pub fn of(photo: &Photo) -> Self {
        let tone_map = if photo.source.display_referred { ToneMap::None } else { ToneMap::default() };
        Self { gamut: photo.to_rec709().map(|matrix| Mat3A::from(matrix.as_mat3())), tone_map }
    }

    /// Linear light of Rec.709 in 0..=1; multiplied by nothing, tone-mapped.
    pub fn light(&self, rgb: [f32; 3]) -> [f32; 3] {
        self.tone_map.apply(self.gamut.map_or(rgb, |gamut| (gamut * Vec3A::from(rgb)).to_array()))
    }
}
