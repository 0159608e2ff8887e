//! Reflectance and transmittance of a stack of thin films, by characteristic matrices (Born & Wolf, Principles of
//! Optics, §1.6; Macleod, Thin-Film Optical Filters, ch. 2).
//!
//! Media do not absorb, and their indices are real. Fields go as exp(iωt − ikz), so that beyond the critical angle the
//! cosine is negative imaginary and the wave dies away.

use num_complex::Complex64;

/// A film of a stack.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Layer {
    /// Refractive index, 1 or more.
    pub index: f64,
    /// Thickness, in nm.
    pub thickness_nm: f64,
}

/// A part of the light's power, in each polarisation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Polarised {
    /// Electric field perpendicular to the plane of incidence.
    pub s: f64,
    /// Electric field in the plane of incidence.
    pub p: f64,
}

impl Polarised {
    /// That of unpolarised light.
    pub fn mean(self) -> f64 {
        0.5 * (self.s + self.p)
    }
}

/// What becomes of light at a stack; each from 0 to 1, and their sum is 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Response {
    /// The power that is reflected.
    pub reflectance: Polarised,
    /// The power that goes through.
    pub transmittance: Polarised,
}

/// What becomes of a polarisation's electric field along the surface, in amplitude and phase; in transmission by the square
/// root of the power, so that the squares of both add up to 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Amplitudes {
    /// Of the reflected field.
    pub reflected: Complex64,
    /// Of the field that goes through.
    pub transmitted: Complex64,
}

impl Amplitudes {
    const REFLECTED: Self = Self { reflected: Complex64::new(-1.0, 0.0), transmitted: Complex64::ZERO };
}

/// What `layers`, the first of which the light meets first, between media of the indices `front` and `back` do to light of
/// the wavelength `wavelength` in nm, whose angle from the normal in `front` has the cosine `cosine`, 0 to 1.
pub fn response(front: f64, layers: &[Layer], back: f64, wavelength: f64, cosine: f64) -> Response {
    let [s, p] = amplitudes(front, layers, back, wavelength, cosine);
    let power = |amplitude: fn(&Amplitudes) -> Complex64| Polarised {
        s: amplitude(&s).norm_sqr().min(1.0),
        p: amplitude(&p).norm_sqr().min(1.0),
    };
    Response { reflectance: power(|of| of.reflected), transmittance: power(|of| of.transmitted) }
}

/// The same in amplitudes, of s and of p.
pub fn amplitudes(front: f64, layers: &[Layer], back: f64, wavelength: f64, cosine: f64) -> [Amplitudes; 2] {
    let cosine = cosine.clamp(0.0, 1.0);
    let into = |index: f64| {
        // Snell's law for the squared cosine, without the difference that loses grazing light between like media.
        let square = ((index - front) * (index + front) + (front * cosine).powi(2)) / (index * index);
        if square >= 0.0 { Complex64::new(square.sqrt(), 0.0) } else { Complex64::new(0.0, -(-square).sqrt()) }
    };
    let polarised = |admittance: fn(f64, Complex64) -> Complex64| {
        let last = admittance(back, into(back));
        // Tangential electric and magnetic field, from the back to the front.
        let (mut electric, mut magnetic, mut decay) = (Complex64::ONE, last, 0.0);
        for &Layer { index, thickness_nm } in layers.iter().rev() {
            let cosine = into(index);
            // At the critical angle itself s has no admittance and p an infinite one; a little beside it both are right.
            let cosine = if cosine.norm_sqr() < 1e-24 { Complex64::new(1e-12, 0.0) } else { cosine };
            let phase = std::f64::consts::TAU * index * thickness_nm / wavelength * cosine;
            decay -= phase.im;
            if decay > 300.0 {
                // Less than exp(-600) goes through, and the fields outgrow their numbers.
                return Amplitudes::REFLECTED;
            }
            let (sine, cosine_of_phase) = sine_and_cosine(phase);
            let own = admittance(index, cosine);
            (electric, magnetic) = (
                cosine_of_phase * electric + Complex64::I * sine / own * magnetic,
                Complex64::I * own * sine * electric + cosine_of_phase * magnetic,
            );
        }
        at_front(admittance(front, Complex64::new(cosine, 0.0)), electric, magnetic, last)
    };
    [polarised(|index, cosine| index * cosine), polarised(|index, cosine| index / cosine)]
}

/// Of a phase that is real, or negative imaginary.
fn sine_and_cosine(phase: Complex64) -> (Complex64, Complex64) {
    let (re, im) = (|value| Complex64::new(value, 0.0), |value| Complex64::new(0.0, value));
    if phase.im == 0.0 { (re(phase.re.sin()), re(phase.re.cos())) } else { (im(phase.im.sinh()), re(phase.im.cosh())) }
}

/// The amplitudes of fields at the front that belong to an electric field of 1 behind.
fn at_front(first: Complex64, electric: Complex64, magnetic: Complex64, last: Complex64) -> Amplitudes {
    // Grazing light: the admittance of p is infinite, that of s is 0; all is reflected.
    if !first.is_finite() || !last.is_finite() || first.norm_sqr() == 0.0 {
        return Amplitudes::REFLECTED;
    }
    let denominator = first * electric + magnetic;
    let through = 2.0 * (first.re * last.re.max(0.0)).sqrt();
    Amplitudes { reflected: (first * electric - magnetic) / denominator, transmitted: through / denominator }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A stack with an index above and one below those of the media around it.
    const STACK: [Layer; 3] = [
        Layer { index: 1.38, thickness_nm: 95.0 },
        Layer { index: 2.1, thickness_nm: 140.0 },
        Layer { index: 1.65, thickness_nm: 60.0 },
    ];

    #[test]
    fn without_films_it_is_fresnels_formula() {
        for (front, back) in [(1.0, 1.52), (1.52, 1.0), (1.7, 1.62)] {
            for degrees in [0.0_f64, 20.0, 35.0, 40.0] {
                let (sine, cosine) = degrees.to_radians().sin_cos();
                let behind = (front * sine / back).asin().cos();
                let s = (front * cosine - back * behind) / (front * cosine + back * behind);
                let p = (back * cosine - front * behind) / (back * cosine + front * behind);
                let found = response(front, &[], back, 550.0, cosine).reflectance;
                assert!((found.s - s * s).abs() < 1e-14 && (found.p - p * p).abs() < 1e-14, "{front} {back} {degrees}");
            }
        }
        let brewster = 1.52_f64.atan().cos();
        assert!(response(1.0, &[], 1.52, 550.0, brewster).reflectance.p < 1e-30);
    }

    #[test]
    fn a_quarter_wave_has_its_closed_form() {
        // On 1.52, where MgF2 is far from ideal; on 1.38² it would reflect nothing.
        for glass in [1.52, 1.9] {
            let film = [Layer { index: 1.38, thickness_nm: 550.0 / (4.0 * 1.38) }];
            let amplitude = (glass - 1.38 * 1.38) / (glass + 1.38 * 1.38);
            let found = response(1.0, &film, glass, 550.0, 1.0).reflectance;
            assert!((found.s - amplitude * amplitude).abs() < 1e-15 && (found.s - found.p).abs() < 1e-15);
        }
    }

    #[test]
    fn a_half_wave_is_not_there() {
        let film = [Layer { index: 2.0, thickness_nm: 550.0 / (2.0 * 2.0) }];
        let [with, without] = [&film[..], &[]].map(|films| response(1.0, films, 1.6, 550.0, 1.0).reflectance.s);
        assert!((with - without).abs() < 1e-15);
    }

    #[test]
    fn power_is_kept_at_every_angle_from_both_sides() {
        for k in 0..=100 {
            let cosine = f64::from(k) / 100.0;
            for (front, back) in [(1.0, 1.52), (1.52, 1.0), (1.8, 1.5)] {
                for films in [&STACK[..], &[]] {
                    let Response { reflectance, transmittance } = response(front, films, back, 480.0, cosine);
                    for (r, t) in [(reflectance.s, transmittance.s), (reflectance.p, transmittance.p)] {
                        assert!((r + t - 1.0).abs() < 1e-12, "{front} {back} {cosine}: {r} + {t}");
                    }
                }
            }
        }
    }

    #[test]
    fn beyond_the_critical_angle_all_is_reflected() {
        let cosine = 60.0_f64.to_radians().cos();
        for films in [&STACK[..], &[]] {
            let found = response(1.52, films, 1.0, 550.0, cosine);
            assert!((found.reflectance.mean() - 1.0).abs() < 1e-12 && found.transmittance.mean() == 0.0);
        }
        // A gap of air that is thin lets some through all the same; a thick one nothing.
        let gap = |thickness_nm| [Layer { index: 1.0, thickness_nm }];
        let through = |thickness| response(1.52, &gap(thickness), 1.52, 550.0, cosine).transmittance.mean();
        assert!(through(20.0) > 0.8 && through(200.0) < 0.4 && through(5000.0) < 1e-9 && through(1e5) == 0.0);
    }

    #[test]
    fn between_equal_media_nothing_happens() {
        for cosine in [1.0, 0.3, 1e-6] {
            assert!(response(1.0, &[], 1.0, 550.0, cosine).reflectance.mean() < 1e-20);
            assert!(
                response(1.7, &[Layer { index: 1.7, thickness_nm: 80.0 }], 1.7, 550.0, cosine).reflectance.s < 1e-9
            );
        }
    }

    #[test]
    fn light_that_goes_back_the_same_way_is_reflected_as_much() {
        let mut back = STACK;
        back.reverse();
        for degrees in [0.0_f64, 30.0, 70.0] {
            let (sine, cosine) = degrees.to_radians().sin_cos();
            let behind = (sine / 1.52).asin().cos();
            let there = response(1.0, &STACK, 1.52, 450.0, cosine);
            let again = response(1.52, &back, 1.0, 450.0, behind);
            assert!((there.reflectance.s - again.reflectance.s).abs() < 1e-13);
            assert!((there.transmittance.p - again.transmittance.p).abs() < 1e-13);
        }
    }
}
