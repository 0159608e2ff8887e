//! What a picture's glare is made of, as layers beside it.

use super::veil::Change;
use crate::look::Gathered;
use crate::photo::Beside;

/// What was added to a photo: by the ghosts of all of its pixels, by the veil, and by the ghosts of lights where these alone make some. The picture is
/// the photo and the sum of the three, each black where there is no such thing; a veil takes light from the photo, too, and is negative there.
pub(super) fn beside(
    scene: &Gathered,
    ghosts: Option<&[[f32; 4]]>,
    veil: Option<&Change>,
    pixels: usize,
) -> Vec<Beside> {
    let dark = || vec![[0.0, 0.0, 0.0, 1.0]; pixels];
    let of_ghosts = |is_theirs: bool| ghosts.filter(|_| is_theirs).map_or_else(dark, <[_]>::to_vec);
    let mut of_veil = dark();
    if let Some(veil) = veil {
        veil.add_to(&mut of_veil);
    }
    let of_all = scene.images.is_some();
    vec![
        Beside { name: "glare", pixels: of_ghosts(of_all) },
        Beside { name: "veil", pixels: of_veil },
        Beside { name: "lights", pixels: of_ghosts(!of_all) },
    ]
}
