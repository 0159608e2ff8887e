//! A veil apart from its picture: what takes long is summed once, and what it is multiplied by may change afterwards.

use rayon::prelude::*;

use super::account::Loss;
use super::planning::Held;
use super::{Ledger, Seat, check, coarse, computed, enlarged, failed, ledger, light, on_pixels, raised, seated, terms};
use crate::Result;
use crate::frame::Frame;
use crate::look::{Look, Veil as Wanted};
use crate::photo::Photo;
use crate::psf::Grid;
use crate::scene::{Emission, Recover};
use crate::veil;

/// The most layers that a veil has.
pub const MOST_LAYERS: usize = 4;

/// What of a look and a photo the sums of its veil depend on. Looks of equal sums differ in weights only: in strength, in the
/// share that is scattered, in whether the photo keeps its light, and in what changes no part of a [`crate::psf::Basis`], as age
/// and pigment do.
#[derive(Debug, Clone, PartialEq)]
pub struct VeilSums {
    /// The veils whose weighted sum it is, each of a function that scatters all of the light.
    parts: Vec<Wanted>,
    seat: Seat,
    /// The pixels, where the function has to know them.
    grid: Option<Grid>,
    held: Held,
    /// How clipped pixels shine.
    recover: Recover,
}

/// The sums of a veil.
pub struct VeilLayers {
    layers: Vec<Layer>,
    /// The tolerance that it is held to, relative to the local veil.
    pub asked: f64,
    /// The bound of that error.
    pub predicted: f64,
    /// Gaussians of the mixture.
    pub terms: usize,
    /// That it is held to more than was asked, where it is.
    raised: Option<String>,
}

/// One of them, where both its weight and the strength are 1.
struct Layer {
    /// Planes of rows.
    planes: [Vec<f32>; 3],
    loses: Loss,
    ledger: Ledger,
}

impl VeilSums {
    /// Those of a look for pixels of a frame, which is the photo's, or that of a photo made larger or smaller, with lengths in the
    /// look's unit; and what each layer is multiplied by at strength 1, RGB. None without a veil, or at strength 0.
    ///
    /// # Errors
    /// [`crate::Error::Usage`] where the look contradicts itself or the photo.
    pub fn of(look: &Look, photo: &Photo, frame: &Frame) -> Result<Option<(Self, Vec<[f64; 3]>)>> {
        let Some(wanted) = look.veil_on(frame) else { return Ok(None) };
        check(look, wanted, frame)?;
        let (_, seat) = seated(look, wanted, photo, frame)?;
        let (parts, weights) = wanted.parts(MOST_LAYERS);
        let grid = wanted.grid(&enlarged(look, frame));
        let sums = Self { parts, seat, grid, held: Held::new(look, wanted), recover: look.find.recover };
        Ok(Some((sums, weights)))
    }

    /// Sums them for the pixels of the frame as they shine, row by row from the top.
    ///
    /// # Errors
    /// [`crate::Error::ToleranceBelowFloor`] where the veil cannot be had to the tolerance.
    ///
    /// # Panics
    /// If there are not as many pixels as the frame had.
    pub fn compute(&self, emission: Emission, pixels: &[[f32; 4]]) -> Result<VeilLayers> {
        let (pixels, seat) = (&*emission.given(pixels), self.seat);
        let stored = veil::Photo::rgba(pixels.as_flattened(), seat.stored).map_err(failed)?;
        let filled = seat.filled(pixels);
        let sources = veil::Photo::rgba(filled.as_flattened(), seat.size).map_err(failed)?;
        let mut all = VeilLayers { layers: Vec::new(), asked: self.held.asked, predicted: 0.0, terms: 0, raised: None };
        for part in &self.parts {
            let part = &on_pixels(part, self.grid.as_ref())?;
            let (channels, asked) = self.held.channels(part.psf(), seat.pixels(part.border))?;
            let veil::Veil { planes, certified, .. } = seat.cropped(computed(&channels, &sources)?);
            let loses = Loss::new(&part.clone().adding(false), seat, 1.0);
            let ledger = ledger(&stored, &planes, &loses);
            all.layers.push(Layer { planes, loses, ledger });
            all.asked = all.asked.max(asked);
            all.predicted = certified.into_iter().fold(all.predicted, f64::max);
            all.terms += terms(&channels);
        }
        all.raised = raised(all.asked, self.held.asked);
        Ok(all)
    }
}

impl VeilLayers {
    /// How many there are, at most [`MOST_LAYERS`].
    pub fn count(&self) -> usize {
        self.layers.len()
    }

    /// What one of them adds to black pixels, at the weight 1; alpha is 0.
    pub fn alone(&self, layer: usize) -> Vec<[f32; 4]> {
        let [red, green, blue] = self.layers[layer].planes.each_ref();
        let colours = red.par_iter().zip(green).zip(blue);
        colours.map(|((&red, &green), &blue)| [red, green, blue, 0.0]).collect()
    }

    /// What pixels change by through one of them, at the weight 1: less what they lose, more what falls on them; alpha is 0. What
    /// is negative or no number loses nothing.
    pub fn change(&self, layer: usize, pixels: &[[f32; 4]]) -> Vec<[f32; 4]> {
        let Layer { planes, loses, .. } = &self.layers[layer];
        let of = |(at, own): (usize, &[f32; 4])| {
            let (_, lost) = loses.at(at);
            let [red, green, blue] = [0, 1, 2].map(|k| (f64::from(planes[k][at]) - lost[k] * light(own[k])) as f32);
            [red, green, blue, 0.0]
        };
        pixels.par_iter().enumerate().map(of).collect()
    }

    /// What a person ought to know, where the layers have these weights, RGB.
    pub fn notes(&self, weights: &[[f64; 3]], adds: bool) -> Vec<String> {
        let mut lost = [0.0; 3];
        for (layer, weights) in self.layers.iter().zip(weights).filter(|_| !adds) {
            let part = layer.loses.in_the_middle();
            (0..3).for_each(|channel| lost[channel] += weights[channel] * part[channel]);
        }
        self.raised.iter().cloned().chain(coarse(lost)).collect()
    }

    /// Where the light is, where the layers have these weights, RGB, and whether the photo keeps its own.
    pub fn ledger(&self, weights: &[[f64; 3]], adds: bool) -> Ledger {
        let light = self.layers.first().map_or([0.0; 3], |layer| layer.ledger.light);
        let (mut kept, mut inside) = (light, [0.0; 3]);
        for (Layer { ledger: part, .. }, weights) in self.layers.iter().zip(weights) {
            for channel in 0..3 {
                let weight = weights[channel];
                inside[channel] += weight * part.inside[channel];
                let lost = if adds { 0.0 } else { weight * (light[channel] - part.kept[channel]) };
                kept[channel] -= lost;
            }
        }
        Ledger::of(light, kept, inside)
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Stages, cast};
    use super::*;
    use crate::certificate::Verify;
    use crate::choices::Projection;
    use crate::photo::Alpha;
    use crate::psf::{Name, Parameters};
    use crate::scene::{Recovered, VeilSection};

    const TOLERANCE: f64 = 1e-2;

    /// A lamp in a dark room, with pixels that are half hidden, darker than black, and no number.
    fn photo() -> Photo {
        let pixel = |at: usize| match at {
            200 => [900.0, 700.0, 500.0, 1.0],
            201 => [f32::NAN, 1.0, 1.0, 1.0],
            202 => [-0.5, 1.0, 1.0, 1.0],
            _ => [0.02 * (at % 7) as f32, 0.05, 0.1, if at.is_multiple_of(3) { 0.5 } else { 1.0 }],
        };
        let mut photo = Photo::new(33, 21, (0..33 * 21).map(pixel).collect());
        photo.source.alpha = Alpha::Straight;
        photo
    }

    fn look(parameters: Parameters, projection: Option<Projection>, strength: f64, adds: bool) -> Look {
        let section = VeilSection { parameters, fov: None, projection, border: None, tolerance: Some(TOLERANCE) };
        let veil = Some(Wanted::new(&section, adds).unwrap());
        Look { veil, strength, fov: Some(40.0), ..Look::default() }
    }

    #[test]
    fn weighted_layers_are_the_veil_that_is_laid_over_the_photo() {
        let (photo, aged) = (photo(), |age| Parameters { age: Some(age), ..Parameters::new(Name::Cie) });
        let tinted = Parameters {
            widths: Some(vec![0.05, 0.4]),
            tints: Some(vec![[1.0, 0.5, 0.0], [0.0, 0.5, 1.0]]),
            scatter: Some(0.2),
            ..Parameters::new(Name::Mixture)
        };
        let starburst = Parameters { fstop: Some(22.0), scatter: Some(0.05), ..Parameters::new(Name::Starburst) };
        for look in [
            look(aged(25.0), None, 1.0, false),
            look(aged(75.0), Some(Projection::Planar), 0.7, false),
            look(Parameters { scatter: Some(0.2), ..aged(60.0) }, None, 3.0, true),
            look(tinted, None, 2.0, false),
            look(starburst, None, 1.5, false),
            // Of pixels that are coarser than its core, which is told.
            Look { fov: Some(150.0), ..look(aged(25.0), Some(Projection::Planar), 1.0, false) },
        ] {
            let frame = look.frame(&photo).unwrap();
            let shining = Recovered::default();
            let cast =
                cast(&look, &photo, &shining, &frame, Verify::Sample, None, &mut Stages::default()).unwrap().unwrap();
            let (sums, weights) = VeilSums::of(&look, &photo, &frame).unwrap().unwrap();
            let layers = sums.compute(Emission::of(&photo), &photo.pixels).unwrap();
            let weights: Vec<_> = weights.into_iter().map(|rgb| rgb.map(|weight| look.strength * weight)).collect();
            let of = |layer: usize| {
                let adds = look.veil.as_ref().unwrap().adds;
                if adds { layers.alone(layer) } else { layers.change(layer, &photo.pixels) }
            };
            let laid: Vec<_> = (0..layers.count()).map(of).collect();
            for (at, wanted) in cast.change(&photo.pixels).0.into_iter().enumerate() {
                for (channel, wanted) in wanted.into_iter().enumerate() {
                    let terms = laid
                        .iter()
                        .zip(&weights)
                        .map(|(layer, weight)| weight[channel] * f64::from(layer[at][channel]));
                    let (sum, size) = terms.fold((0.0, 0.0f64), |(sum, size), term| (sum + term, size + term.abs()));
                    let off = (sum - f64::from(wanted)).abs();
                    // Both are within the tolerance.
                    let veil = f64::from(cast.planes[channel][at]);
                    assert!(off <= 2.0 * TOLERANCE * veil + 1e-6 * size, "{at}: {sum} is not {wanted}");
                }
            }
            let Ledger { light, kept, inside, lost, gained: _ } =
                layers.ledger(&weights, look.veil.as_ref().unwrap().adds);
            let told = cast.veiled.ledger;
            for (mine, told) in [(light, told.light), (kept, told.kept), (inside, told.inside), (lost, told.lost)] {
                for channel in 0..3 {
                    assert!(
                        (mine[channel] - told[channel]).abs() <= 2.0 * TOLERANCE * light[channel],
                        "{mine:?} is not {told:?}"
                    );
                }
            }
            assert_eq!(layers.notes(&weights, look.veil.as_ref().unwrap().adds), cast.veiled.notes);
            assert!(layers.predicted > 0.0 && layers.predicted <= TOLERANCE, "{:e}", layers.predicted);
        }
    }

    /// CIE 146's equation over a rectilinear picture 40 degrees wide, at a pixel.
    fn by_hand(photo: &Photo, age: f64, pigment: f64, at: usize) -> [f64; 3] {
        let [width, height] = [photo.width(), photo.height()].map(|side| side as usize);
        let focal = 0.5 * width as f64 / 20f64.to_radians().tan();
        let direction = |at: usize| {
            let [x, y] =
                [(at % width, width), (at / width, height)].map(|(at, side)| at as f64 - 0.5 * (side as f64 - 1.0));
            let z = 1.0 / (1.0 + (x * x + y * y) / (focal * focal)).sqrt();
            ([x * z / focal, y * z / focal, z], z * z * z / (focal * focal))
        };
        let aged = 1.0 + (age / 62.5f64).powi(4);
        let (target, _) = direction(at);
        let mut sum = [0.0; 3];
        for (index, pixel) in photo.pixels.iter().enumerate().filter(|(index, _)| *index != at) {
            let (source, solid_angle) = direction(index);
            let chord = (0..3).map(|side| (source[side] - target[side]).powi(2)).sum::<f64>().sqrt();
            let theta = (2.0 * (0.5 * chord).asin()).to_degrees();
            let k = 10.0 / theta.powi(3) + (5.0 / theta.powi(2) + 0.1 * pigment / theta) * aged + 0.0025 * pigment;
            (0..3).for_each(|channel| sum[channel] += f64::from(pixel[channel]) * solid_angle * k);
        }
        sum
    }

    /// The sums of one observer, laid together by the weights of others, are these observers' veils within the bound.
    #[test]
    fn weights_alone_make_the_veil_of_any_age_and_pigment() {
        let pixel = |at: usize| if at == 300 { [2e4, 1e3, 10.0, 1.0] } else { [1e-3 * (at * 79 % 101) as f32; 4] };
        let photo = Photo::new(33, 21, (0..33 * 21).map(pixel).collect());
        let of = |age, pigment| {
            let seen_by = Parameters { age: Some(age), pigment: Some(pigment), ..Parameters::new(Name::Cie) };
            let look = look(seen_by, None, 1.0, false);
            VeilSums::of(&look, &photo, &look.frame(&photo).unwrap()).unwrap().unwrap()
        };
        let (sums, _) = of(20.0, 0.5);
        let layers = sums.compute(Emission::of(&photo), &photo.pixels).unwrap();
        let veils: Vec<_> = (0..layers.count()).map(|layer| layers.alone(layer)).collect();
        for (age, pigment) in [(20.0, 0.5), (60.0, 0.0), (90.0, 1.2)] {
            let (same, weights) = of(age, pigment);
            assert!(same == sums && veils.len() == 4);
            for at in (0..33 * 21).step_by(17) {
                for (channel, known) in by_hand(&photo, age, pigment, at).into_iter().enumerate() {
                    let terms = veils.iter().zip(&weights);
                    let sum: f64 = terms.map(|(veil, weight)| f64::from(veil[at][channel]) * weight[channel]).sum();
                    let off = (sum / known - 1.0).abs();
                    assert!(off <= layers.predicted, "age {age}, pigment {pigment}, pixel {at}: {off:.1e}");
                }
            }
        }
    }

    #[test]
    fn sums_are_the_same_where_only_weights_differ() {
        let photo = photo();
        let cie = |scatter| Parameters { scatter, ..Parameters::new(Name::Cie) };
        let of = |look: &Look| VeilSums::of(look, &photo, &look.frame(&photo).unwrap()).unwrap();
        let (sums, weights) = of(&look(cie(None), None, 1.0, false)).unwrap();
        let share = |weights: &[[f64; 3]]| weights.iter().map(|rgb| rgb[0]).sum::<f64>();
        assert!(weights.len() == 4 && (share(&weights) - 0.375).abs() < 1e-3);
        for (scatter, strength, adds) in [(Some(0.1), 1.0, false), (None, 2.5, false), (Some(1.0), 0.5, true)] {
            let (other, weights) = of(&look(cie(scatter), None, strength, adds)).unwrap();
            assert!(other == sums && (share(&weights) - scatter.unwrap_or(0.375)).abs() < 1e-3);
        }
        // CIE 146 at 75 is 0.532.
        let old = Parameters { age: Some(75.0), pigment: Some(0.5), ..cie(None) };
        let (other, weights) = of(&look(old, None, 1.0, false)).unwrap();
        assert!(other == sums && (share(&weights) - 0.532).abs() < 1e-3);
        assert!(of(&look(cie(None), None, 0.0, false)).is_none());
        let others = [
            look(cie(None), Some(Projection::Planar), 1.0, false),
            Look { fov: Some(41.0), ..look(cie(None), None, 1.0, false) },
            look(Parameters::new(Name::Camera), None, 1.0, false),
        ];
        assert!(others.iter().all(|other| of(other).unwrap().0 != sums));
        // Of a function in degrees, the ghosts' size is no matter.
        assert!(of(&Look { size: 2.0, ..look(cie(None), None, 1.0, false) }).unwrap().0 == sums);
    }
}
