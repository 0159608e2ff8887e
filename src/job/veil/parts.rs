//! A veil by the parts of its function, for those who change what these weigh.

use rayon::prelude::*;

use super::planning::{Channel, Held};
use super::{Seat, check, computed, failed, predicted, seated, weighed};
use crate::Result;
use crate::choices::Border;
use crate::frame::Frame;
use crate::look::{Look, Veil};
use crate::photo::Photo;
use crate::psf::Psf;
use crate::veil;

/// How the veils of the parts of a look's function would be summed on a photo: V = Σ w_i V_i, by [`crate::psf::Basis`].
///
/// A change of age, pigment, light or scattered share changes the weights w_i, and the veils V_i are what they were. Each is
/// held to the look's tolerance relative to itself; as no weight is negative, so is V, whatever they are.
pub struct VeilParts {
    parts: Vec<Psf>,
    /// Plans of each.
    channels: Vec<Vec<Channel>>,
    /// The tolerance that each is held to.
    held: Vec<f64>,
    stays: Stays,
}

/// All that is to stay as it is for a change of weights to be all.
#[derive(PartialEq)]
struct Stays {
    seat: Seat,
    border: Border,
    tolerance: f64,
    allow_floor: bool,
}

impl Stays {
    fn new(look: &Look, wanted: &Veil, photo: &Photo, frame: &Frame) -> Result<Self> {
        let (_, seat) = seated(look, wanted, photo, frame)?;
        let (border, allow_floor) = (wanted.border, look.accuracy.allow_floor || !wanted.is_held());
        Ok(Self { seat, border, tolerance: wanted.tolerance(), allow_floor })
    }
}

impl VeilParts {
    /// Plans the parts of a look's veil for the pixels of a frame, which is the photo's, or that of a photo made larger or smaller;
    /// none without a veil. A function of more parts than `most` is one part. The look's strength does not matter.
    ///
    /// # Errors
    /// Those of [`super::plan_veil`]: also where one of the parts cannot be had to the tolerance.
    pub fn new(look: &Look, photo: &Photo, frame: &Frame, most: usize) -> Result<Option<Self>> {
        let Some(wanted) = look.veil.as_ref() else { return Ok(None) };
        let stays = Stays::new(look, wanted, photo, frame)?;
        let parts = wanted.psf().basis(most).parts;
        let task = Held::new(look, wanted, &stays.seat);
        let planned = parts.iter().map(|part| task.channels(part)).collect::<Result<Vec<_>>>()?;
        let (channels, held) = planned.into_iter().unzip();
        Ok(Some(Self { parts, channels, held, stays }))
    }

    /// The parts, each of unit energy.
    pub fn parts(&self) -> &[Psf] {
        &self.parts
    }

    /// What the parts weigh in a look, RGB, times its strength: what is to be known after a change. None where more than weights
    /// is another than in the look that was planned for, so that the parts are to be planned again.
    ///
    /// # Errors
    /// On a look that contradicts itself or the photo.
    pub fn weights(&self, look: &Look, photo: &Photo, frame: &Frame) -> Result<Option<Vec<[f64; 3]>>> {
        let Some(wanted) = look.veil.as_ref() else { return Ok(None) };
        check(look, wanted)?;
        if Stays::new(look, wanted, photo, frame)? != self.stays {
            return Ok(None);
        }
        // What is one part because it has too many may have as few as there are.
        let bases = [self.parts.len(), 1].map(|most| wanted.psf().basis(most));
        let alike = bases.into_iter().find(|basis| basis.parts == self.parts);
        Ok(alike.map(|basis| basis.weights.iter().map(|rgb| rgb.map(|weight| look.strength * weight)).collect()))
    }

    /// The bound of the error of V relative to itself, for all weights.
    pub fn predicted(&self) -> f64 {
        self.channels.iter().map(|channels| predicted(channels).bound).fold(0.0, f64::max)
    }

    /// The error relative to itself that V is held to: the look's tolerance, or the lowest that can be had where that will do.
    pub fn held(&self) -> f64 {
        self.held.iter().copied().fold(0.0, f64::max)
    }

    /// V_i of one part, in planes of rows.
    ///
    /// # Errors
    /// On a photo of another size than was planned.
    pub fn veil(&self, part: usize, photo: &Photo) -> Result<[Vec<f32>; 3]> {
        let weighed = weighed(photo);
        let pixels = weighed.as_ref().map_or(&photo.pixels, |pixels| pixels);
        let seat = self.stays.seat;
        let filled = seat.filled(pixels);
        let sources = veil::Photo::rgba(filled.as_flattened(), seat.size).map_err(failed)?;
        Ok(seat.cropped(computed(&self.channels[part], &sources)?).planes)
    }

    /// What a pixel at a column and row weighs as a source: its solid angle in steradians, or its area. It keeps the part
    /// 1 − s (f − k(0) Ω) of its light.
    pub fn solid_angle(&self, pixel: [usize; 2]) -> f64 {
        self.stays.seat.solid_angle(pixel)
    }

    /// Σ w_i V_i, of the veils that are there: what weighs nothing need not be.
    pub fn laid_together(&self, veils: &[Option<[Vec<f32>; 3]>], weights: &[[f64; 3]]) -> [Vec<f32>; 3] {
        let [columns, rows] = self.stays.seat.stored;
        [0, 1, 2].map(|channel| {
            let given: Vec<(&[f32], f64)> = veils
                .iter()
                .zip(weights)
                .filter_map(|(planes, weights)| Some((planes.as_ref()?[channel].as_slice(), weights[channel])))
                .collect();
            let at = |pixel: usize| given.iter().map(|(plane, weight)| f64::from(plane[pixel]) * weight).sum::<f64>();
            (0..columns * rows).into_par_iter().map(|pixel| at(pixel) as f32).collect()
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::psf::{Name, Parameters};
    use crate::scene::VeilSection;

    const SIZE: [usize; 2] = [40, 28];
    const FOV: f64 = 50.0;

    fn look(parameters: Parameters) -> Look {
        let section = VeilSection { parameters, fov: None, projection: None, border: None, tolerance: None };
        Look { veil: Some(Veil::new(&section, false).unwrap()), fov: Some(FOV), ..Look::default() }
    }

    fn cie(age: f64, pigment: f64, scatter: Option<f64>) -> Look {
        look(Parameters { age: Some(age), pigment: Some(pigment), scatter, ..Parameters::new(Name::Cie) })
    }

    /// A dim picture with two lamps.
    fn photo() -> Photo {
        let dim = |at: usize| ((at * 7919) % 101) as f32 * 1e-3;
        let mut pixels: Vec<[f32; 4]> = (0..SIZE[0] * SIZE[1]).map(|at| [dim(at), dim(at + 5), 0.01, 1.0]).collect();
        pixels[40 * 9 + 11] = [2e4, 1e3, 10.0, 1.0];
        pixels[40 * 27 + 39] = [10.0, 3e3, 0.0, 1.0];
        Photo::new(SIZE[0] as u32, SIZE[1] as u32, pixels)
    }

    /// CIE 146's equation, over a rectilinear picture, at a pixel.
    fn by_hand(photo: &Photo, age: f64, pigment: f64, at: usize) -> [f64; 3] {
        let focal = 0.5 * SIZE[0] as f64 / (0.5 * FOV).to_radians().tan();
        let direction = |at: usize| {
            let [x, y] = [at % SIZE[0], at / SIZE[0]].map(|place| place as f64);
            let [u, v] = [(x - 19.5) / focal, (y - 13.5) / focal];
            let z = 1.0 / (1.0 + u * u + v * v).sqrt();
            ([u * z, v * z, z], z * z * z / (focal * focal))
        };
        let aged = 1.0 + (age / 62.5f64).powi(4);
        let (target, _) = direction(at);
        let mut sum = [0.0; 3];
        for (index, pixel) in photo.pixels.iter().enumerate().filter(|(index, _)| *index != at) {
            let (source, solid_angle) = direction(index);
            let cosine: f64 = (0..3).map(|side| source[side] * target[side]).sum();
            let theta = cosine.min(1.0).acos().to_degrees();
            let k = 10.0 / theta.powi(3) + (5.0 / theta.powi(2) + 0.1 * pigment / theta) * aged + 0.0025 * pigment;
            (0..3).for_each(|channel| sum[channel] += f64::from(pixel[channel]) * solid_angle * k);
        }
        sum
    }

    /// The same fields serve every age and pigment, within the bound, which is no larger than what was asked.
    #[test]
    fn weights_alone_make_the_veil_of_any_age_and_pigment() {
        let photo = photo();
        let first = cie(20.0, 0.5, None);
        let parts = VeilParts::new(&first, &photo, &photo.frame, 4).unwrap().unwrap();
        assert!(parts.parts().len() == 4 && parts.predicted() <= parts.held() && parts.held() == 1e-2);
        let veils: Vec<_> = (0..4).map(|part| Some(parts.veil(part, &photo).unwrap())).collect();
        for (age, pigment) in [(20.0, 0.5), (60.0, 0.5), (90.0, 1.2)] {
            let look = cie(age, pigment, None);
            let weights = parts.weights(&look, &photo, &photo.frame).unwrap().unwrap();
            let veil = parts.laid_together(&veils, &weights);
            for at in (0..SIZE[0] * SIZE[1]).step_by(31) {
                for (channel, known) in by_hand(&photo, age, pigment, at).into_iter().enumerate() {
                    let off = (f64::from(veil[channel][at]) / known - 1.0).abs();
                    assert!(off <= parts.predicted(), "age {age}, pigment {pigment}, pixel {at}: {off:.1e}");
                }
            }
            // What a pixel keeps follows from the function itself, whose shares are the weights' sum.
            let f = look.veil.as_ref().unwrap().psf().energy();
            let sum: f64 = weights.iter().map(|weight| weight[0]).sum();
            assert!((sum / f - 1.0).abs() < 1e-8, "{sum} for {f}");
        }
        // Black eyes have no use for two of them.
        let weights = parts.weights(&cie(60.0, 0.0, None), &photo, &photo.frame).unwrap().unwrap();
        assert_eq!([weights[2], weights[3]], [[0.0; 3]; 2]);
        let some: Vec<_> = (0..4).map(|part| veils[part].clone().filter(|_| part < 2)).collect();
        let known = by_hand(&photo, 60.0, 0.0, 500)[1];
        let veil = parts.laid_together(&some, &weights);
        assert!((f64::from(veil[1][500]) / known - 1.0).abs() <= parts.predicted());
    }

    /// Strength and share are weights; where anything else changes there are none.
    #[test]
    fn nothing_but_weights_may_change() {
        let photo = photo();
        let first = cie(20.0, 0.5, None);
        let parts = VeilParts::new(&first, &photo, &photo.frame, 4).unwrap().unwrap();
        let weights = |look: &Look| parts.weights(look, &photo, &photo.frame).unwrap();
        let own = weights(&first).unwrap();
        let times = |look: &Look| weights(look).unwrap()[0][1] / own[0][1];
        assert!((times(&Look { strength: 0.25, ..first.clone() }) - 0.25).abs() < 1e-12);
        let f = first.veil.as_ref().unwrap().psf().energy();
        assert!((times(&cie(20.0, 0.5, Some(0.1))) - 0.1 / f).abs() < 1e-9);
        for other in [
            Look { fov: Some(51.0), ..first.clone() },
            Look { strength: 0.5, ..look(Parameters::new(Name::Cie135)) },
            Look { strength: 0.5, ..look(Parameters { width: Some(0.1), ..Parameters::new(Name::Gaussian) }) },
            Look { veil: None, ..first.clone() },
        ] {
            assert!(weights(&other).is_none());
        }
        assert!(parts.weights(&Look { strength: 3.0, ..first }, &photo, &photo.frame).is_err());
        // Widths are what a mixture is; weights and tints may change.
        let mixture = |widths: [f64; 2], weights: [f64; 2]| {
            let given = (Some(widths.to_vec()), Some(weights.to_vec()));
            look(Parameters { widths: given.0, weights: given.1, ..Parameters::new(Name::Mixture) })
        };
        for most in [1, 2] {
            let first = Look { strength: 0.5, ..mixture([0.1, 0.3], [1.0, 1.0]) };
            let parts = VeilParts::new(&first, &photo, &photo.frame, most).unwrap().unwrap();
            assert!(parts.parts().len() == most && parts.weights(&first, &photo, &photo.frame).unwrap().is_some());
            let other = Look { strength: 0.5, ..mixture([0.1, 0.3], [1.0, 3.0]) };
            let weights = parts.weights(&other, &photo, &photo.frame).unwrap();
            assert_eq!(weights, (most == 2).then(|| vec![[0.125; 3], [0.375; 3]]));
            let wider = Look { strength: 0.5, ..mixture([0.1, 0.4], [1.0, 1.0]) };
            assert!(parts.weights(&wider, &photo, &photo.frame).unwrap().is_none());
        }
    }
}
