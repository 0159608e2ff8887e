//! What the composite is told of a look.

use crate::choices::{LightBy, Mix, Normalize};
use crate::frame::Frame;
use crate::look::{Gathered, Look};
use crate::photo::Photo;
use crate::renderer::Settings;
use crate::scene::{Emission, Recovered, is_light};
use crate::{Error, Result};

/// What the composite is told, and what to warn of. Where light is taken from the photo's lights, `bright` gives
/// [`bright_light`] for a threshold.
///
/// # Errors
/// [`Error::Usage`] where light is to be taken for glare that is not physical.
pub fn settings(
    look: &Look,
    photo: &Photo,
    scene: &Gathered,
    bright: impl FnOnce(f64) -> [f64; 3],
) -> Result<(Settings, Option<String>)> {
    // A new field of a look has to say here whether the composite is told of it. These make ghosts and the plan.
    #[rustfmt::skip]
    let &Look {
        strength, mix, normalize,
        description: _, lens: _, unit: _, fov: _, axis: _, size: _, tint: _, lights: _, ghosts: _, find: _, veil: _, accuracy: _,
    } = look;
    let emission = Emission::of(photo).by(look.find.by);
    let mut settings = Settings { strength, normalize, emission, ..Settings::default() };
    if mix == Mix::Add {
        return Ok((settings, None));
    }
    if normalize != Normalize::None {
        return Err(Error::Usage("--mix energy needs --normalize none: only that glare has a light's energy".into()));
    }
    let carried = carried(scene);
    let (gain, enough) = match &scene.images {
        // Where the whole photo shines, what shines of each pixel is light.
        Some(images) => {
            settings.knee = Some(look.find.knee());
            light_gain(images.raster().flux(), carried, strength)
        }
        None => {
            settings.threshold = scene.found.as_ref().map_or(f64::INFINITY, |found| found.threshold);
            light_gain(bright(settings.threshold), carried, strength)
        }
    };
    settings.light_gain = gain;
    let warning = (!enough).then(|| {
        "the glare has more light than the photo's lights; they are black now, and the picture has gained light".into()
    });
    Ok((settings, warning))
}

/// The flux of all pixels of a photo at or above a brightness, RGB, in the photo's unit times the frame's unit of
/// lengths squared: what they give, as they shine, a negative channel none. Fireflies count here as what they are.
pub fn bright_light(photo: &Photo, recovered: &Recovered, frame: &Frame, by: LightBy, threshold: f64) -> [f64; 3] {
    let emission = Emission::of(photo).by(by);
    let (area, threshold) = (frame.pixel_size().powi(2), threshold as f32);
    let mut bright = [0.0; 3];
    let shining = recovered.over(&photo.pixels);
    for (pixel, shown) in shining.iter().zip(&photo.pixels) {
        if is_light(emission.brightness(shown), threshold) {
            let share = f64::from(emission.share(pixel)) * area;
            for (bright, &light) in bright.iter_mut().zip(pixel) {
                *bright += f64::from(light.max(0.0)) * share;
            }
        }
    }
    bright
}

/// What all ghosts carry, RGB.
fn carried(scene: &Gathered) -> [f64; 3] {
    let of_images = scene.images.as_ref().map_or([0.0; 3], |images| {
        let (share, flux) = (images.share(), images.raster().flux());
        [0, 1, 2].map(|colour| share[colour] * flux[colour])
    });
    scene.ghosts.iter().fold(of_images, |sum, ghost| {
        let flux = ghost.flux();
        [0, 1, 2].map(|colour| sum[colour] + flux[colour])
    })
}

/// What pixels with the light `bright` keep of themselves, so that they lose what ghosts carry; and whether they have that
/// much to lose.
fn light_gain(bright: [f64; 3], carried: [f64; 3], strength: f64) -> ([f64; 3], bool) {
    let scattered = carried.map(|flux| strength * flux);
    let kept = [0, 1, 2].map(|c| if scattered[c] > 0.0 { 1.0 - scattered[c] / bright[c] } else { 1.0 });
    (kept.map(|kept| if kept.is_nan() { 0.0 } else { kept.max(0.0) }), kept.iter().all(|&kept| kept >= 0.0))
}

#[cfg(test)]
mod tests {
    use glam::DVec2;

    use super::*;
    use crate::photo::{Alpha, Primaries};
    use crate::scene::Ghost;
    use crate::series::Bell;

    #[test]
    fn lights_lose_what_the_ghosts_carry() {
        let mut pixels = vec![[0.1, 0.1, 0.1, 1.0]; 16];
        pixels[5] = [100.0, 50.0, 20.0, 1.0];
        let photo = Photo::new(4, 4, pixels);
        // The light's flux is 100 × 0.5² = 25 in red.
        let ghost = |flux: f64| Ghost {
            bell: Bell::Gaussian,
            center: DVec2::ZERO,
            size: DVec2::ONE,
            radiance: [flux / std::f64::consts::TAU, 0.0, 0.0],
        };
        let (gain, enough) = light_gain(
            bright_light(&photo, &Recovered::default(), &photo.frame, LightBy::Luminance, 10.0),
            ghost(2.5).flux(),
            2.0,
        );
        assert!((gain[0] - 0.8).abs() < 1e-12 && gain[1..] == [1.0, 1.0] && enough, "{gain:?}");
        let (gain, enough) = light_gain(
            bright_light(&photo, &Recovered::default(), &photo.frame, LightBy::Luminance, 10.0),
            ghost(50.0).flux(),
            1.0,
        );
        assert_eq!((gain, enough), ([0.0, 1.0, 1.0], false));
        let (gain, enough) = light_gain(
            bright_light(&photo, &Recovered::default(), &photo.frame, LightBy::Luminance, f64::INFINITY),
            ghost(1.0).flux(),
            1.0,
        );
        assert_eq!((gain, enough), ([0.0, 1.0, 1.0], false));
        assert_eq!(
            light_gain(
                bright_light(&photo, &Recovered::default(), &photo.frame, LightBy::Luminance, 10.0),
                [0.0; 3],
                1.0
            ),
            ([1.0; 3], true)
        );
    }

    #[test]
    fn straight_alpha_takes_its_share_of_bright_light_and_darker_than_black_has_none() {
        let mut photo = Photo::new(5, 1, [0.0, 0.25, 0.5, 1.0, f32::NAN].map(|alpha| [8.0, 4.0, -2.0, alpha]).to_vec());
        // A pixel's area is 2 × 2.
        let whole = [32.0, 16.0, 0.0];
        assert_eq!(
            bright_light(&photo, &Recovered::default(), &photo.frame, LightBy::Luminance, 1.0),
            whole.map(|light: f64| 5.0 * light)
        );
        photo.source.alpha = Alpha::Straight;
        assert_eq!(
            bright_light(&photo, &Recovered::default(), &photo.frame, LightBy::Luminance, 1.0),
            whole.map(|light: f64| 1.75 * light)
        );
        assert_eq!(
            bright_light(&photo, &Recovered::default(), &photo.frame, LightBy::Luminance, 2.0),
            whole.map(|light: f64| 1.5 * light)
        );
        photo.source.primaries = Some(Primaries::ACES2065_1);
        photo.pixels.fill([0.0, 0.0, 9.0, 1.0]);
        assert_eq!(bright_light(&photo, &Recovered::default(), &photo.frame, LightBy::Luminance, 0.0), [0.0; 3]);
    }
}
