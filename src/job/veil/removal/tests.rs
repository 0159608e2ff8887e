use super::super::{HALF_A_UNIT, cast};
use super::*;
use crate::chance::Chance;
use crate::choices::{Border, Projection};
use crate::frame::Window;
use crate::look::Veil as Wanted;
use crate::photo::Alpha;
use crate::psf::{Name, Parameters};
use crate::scene::{Recovered, VeilSection};
use crate::veil::{Kernel, Mixture, reference};

const WIDTH: usize = 36;
const HEIGHT: usize = 27;

/// A dark room with a window, a lamp and some texture.
fn room() -> Photo {
    let mut chance = Chance::new(7);
    let pixel = |at: usize| {
        let (x, y) = (at % WIDTH, at / WIDTH);
        let lit = if (20..28).contains(&x) && (4..12).contains(&y) { 8.0 } else { 0.05 };
        let lamp = if at == 20 * WIDTH + 6 { 40.0 } else { lit };
        [1.0, 0.8, 0.5].map(|tint| (tint * lamp * chance.between(0.5, 1.0)) as f32)
    };
    let pixels = (0..WIDTH * HEIGHT).map(pixel).map(|[r, g, b]| [r, g, b, 1.0]).collect();
    Photo::new(WIDTH as u32, HEIGHT as u32, pixels)
}

fn look(parameters: Parameters, projection: Option<Projection>, border: Option<Border>) -> Look {
    let section = VeilSection { parameters, fov: None, projection, border, tolerance: None };
    Look { veil: Some(Wanted::new(&section, false).unwrap()), fov: Some(4.0), ..Look::default() }
}

fn gaussian(width: f64, scatter: f64) -> Look {
    look(Parameters { width: Some(width), scatter: Some(scatter), ..Parameters::new(Name::Gaussian) }, None, None)
}

fn cie(scatter: f64, projection: Projection) -> Look {
    look(Parameters { scatter: Some(scatter), ..Parameters::new(Name::Cie) }, Some(projection), None)
}

fn mirrored(scatter: f64) -> Look {
    let gaussian = Parameters { width: Some(0.3), scatter: Some(scatter), ..Parameters::new(Name::Gaussian) };
    look(gaussian, None, Some(Border::Mirror))
}

/// What the veil of a look makes of a photo, sum by sum from its definition.
fn veiled(look: &Look, photo: &Photo) -> Photo {
    let frame = look.frame(photo).unwrap();
    let wanted = look.veil_on(&frame).unwrap();
    let (_, seat) = seated(look, wanted, photo, &frame).unwrap();
    let psf = wanted.psf().clone();
    let none = Mixture { terms: Vec::new(), constant: 0.0, quadratic: 0.0 };
    let kernel = Kernel::new(move |angle| psf.value(angle), none).unwrap();
    let sources = veil::Photo::rgba(photo.pixels.as_flattened(), seat.stored).unwrap();
    let whole = reference::Window::whole(seat.stored);
    let veil = reference::veil(&sources, &seat.geometry, &kernel, wanted.border, whole);
    let (energies, centres) = (wanted.psf().energies(), wanted.psf().centres());
    let mut out = photo.clone();
    for (at, (pixel, veil)) in out.pixels.iter_mut().zip(veil).enumerate() {
        let area = seat.solid_angle([at % seat.stored[0], at / seat.stored[0]]);
        for c in 0..3 {
            let lost = look.strength * (energies[c] - centres[c] * area);
            pixel[c] = ((1.0 - lost) * f64::from(pixel[c]) + look.strength * veil[c]) as f32;
        }
    }
    out
}

/// A photo with the veil of a look, as the job lays it over.
fn applied(look: &Look, photo: &Photo) -> Photo {
    let frame = look.frame(photo).unwrap();
    let stages = &mut Stages::default();
    let cast = cast(look, photo, &Recovered::default(), &frame, Verify::Sample, None, stages).unwrap().unwrap();
    let mut out = photo.clone();
    cast.change(&photo.pixels).add_to(&mut out.pixels);
    out
}

fn removed(look: &Look, photo: &Photo, tolerance: f64) -> Result<Removed> {
    remove(look, photo.clone(), Removing { tolerance, ..Removing::default() }, &mut Stages::default())
}

/// The largest difference in each channel, over its brightest sample.
fn apart(one: &Photo, other: &Photo) -> f64 {
    let peak = |c: usize| other.pixels.iter().map(|pixel| f64::from(pixel[c])).fold(0.0, f64::max);
    let peaks = [0, 1, 2].map(peak);
    let both = one.pixels.iter().zip(&other.pixels);
    both.flat_map(|(a, b)| [0, 1, 2].map(|c| (f64::from(a[c]) - f64::from(b[c])).abs() / peaks[c])).fold(0.0, f64::max)
}

/// What rounding the photo to 32-bit floats makes of the answer.
fn rounded(removal: &Removal) -> f64 {
    2.0 * HALF_A_UNIT * removal.amplification.largest.unwrap_or(100.0)
}

#[test]
fn the_clean_photo_comes_back_within_the_bound() {
    let clean = room();
    for scatter in [0.02, 0.1, 0.25, 0.45] {
        let tolerance = 1e-4;
        let mut looks = vec![gaussian(0.15, scatter), mirrored(scatter), cie(scatter, Projection::Rectilinear)];
        if scatter == 0.1 {
            let camera = Parameters { scatter: Some(scatter), ..Parameters::new(Name::Camera) };
            looks.extend([
                cie(scatter, Projection::Planar),
                cie(scatter, Projection::Fisheye),
                look(camera, None, None),
            ]);
        }
        for look in looks {
            let name = look.veil.as_ref().unwrap().psf().name();
            let bordered = look.veil.as_ref().unwrap().border != Border::None;
            let photo = veiled(&look, &clean);
            assert!(apart(&photo, &clean) > 20.0 * tolerance, "{name} {scatter}: a veil that can be seen");
            let Removed { photo, removal, .. } = removed(&look, &photo, tolerance).unwrap();
            let removal = removal.unwrap();
            let error = apart(&photo, &clean);
            assert!(error <= removal.error.predicted + rounded(&removal), "{name} {scatter}: {error:e} {removal:?}");
            assert!(removal.error.predicted <= tolerance && removal.error.check().is_ok(), "{name}: {removal:?}");
            // On a plane without a border the rows are summed without a veil of a white photo.
            let white =
                usize::from(!matches!(look.veil.as_ref().unwrap().projection(), Projection::Planar) || bordered);
            assert!(scatter > 0.1 || removal.veils <= 3 + white, "{name} {scatter}: {} veils", removal.veils);
        }
    }
}

#[test]
fn the_veil_laid_over_the_answer_gives_the_photo() {
    for look in [gaussian(0.1, 0.1), cie(0.1, Projection::Rectilinear), cie(0.25, Projection::Planar)] {
        // A photo that holds its veil: of another the answer is darker than black, which is no light when a veil is added.
        let photo = veiled(&look, &room());
        let clean = removed(&look, &photo, 1e-5).unwrap().photo;
        assert!(clean.pixels.iter().all(|pixel| pixel[..3].iter().all(|value| *value >= 0.0)));
        let exact = Wanted::new(&VeilSection { tolerance: Some(2e-4), ..look.veil.as_ref().unwrap().section() }, false);
        let again = applied(&Look { veil: Some(exact.unwrap()), ..look }, &clean);
        let error = apart(&again, &photo);
        assert!(error < 1e-5 + 0.25 * 2e-4, "{error:e}");
    }
}

#[test]
fn noise_grows_by_no_more_than_is_stated() {
    let (clean, look) = (room(), gaussian(0.15, 0.25));
    let mut photo = veiled(&look, &clean);
    let mut chance = Chance::new(3);
    let mut noise = [0.0f64; 2];
    for pixel in &mut photo.pixels {
        for value in &mut pixel[..3] {
            let noisy = *value + chance.between(-0.1, 0.1) as f32;
            let added = f64::from(noisy) - f64::from(*value);
            noise = [noise[0].max(added.abs()), noise[1] + added * added];
            *value = noisy;
        }
    }
    assert!(photo.pixels.iter().any(|pixel| pixel[0] < 0.0), "there is noise below black");
    let Removed { photo, removal, .. } = removed(&look, &photo, 1e-6).unwrap();
    let removal = removal.unwrap();
    let (mut largest, mut squares) = (0.0f64, 0.0);
    for (found, clean) in photo.pixels.iter().zip(&clean.pixels) {
        for c in 0..3 {
            let error = f64::from(found[c]) - f64::from(clean[c]);
            (largest, squares) = (largest.max(error.abs()), squares + error * error);
        }
    }
    let Amplification { largest: Some(by_rows), rms: Some(rms) } = removal.amplification else { panic!("{removal:?}") };
    let own = 40.0 * removal.error.predicted;
    assert!(by_rows <= 1.0 / (1.0 - 0.5) * 1.02 && rms <= 1.0 / (1.0 - 0.25) * 1.02, "{removal:?}");
    assert!(largest <= by_rows * noise[0] + own && largest > noise[0], "{largest}");
    assert!(squares.sqrt() <= rms * noise[1].sqrt() + own * 55.0, "{}", squares.sqrt());
}

/// A veil of more than half of the light, whose rows bound nothing.
#[test]
fn more_than_half_of_the_light_comes_back_where_that_can_be_proved() {
    let clean = room();
    for (width, scatter) in [(0.1, 0.6), (0.3, 0.8), (0.12, 0.9)] {
        let look = gaussian(width, scatter);
        let Removed { photo, removal, .. } = removed(&look, &veiled(&look, &clean), 1e-4).unwrap();
        let removal = removal.unwrap();
        let error = apart(&photo, &clean);
        let own = 1e3 * HALF_A_UNIT;
        assert!(
            error <= removal.error.predicted + own && removal.method == "conjugate gradients",
            "{error:e} {removal:?}"
        );
        assert!(removal.amplification.rms.unwrap() < 1.05 / (1.0 - scatter), "{removal:?}");
    }
    // Of a wide field on the sphere nothing of the kind is known.
    let look = look(Parameters { scatter: Some(0.9), ..Parameters::new(Name::StilesHolladay) }, None, None);
    let look = Look { fov: Some(20.0), ..look };
    let refused = removed(&look, &clean, 1e-3).err().unwrap();
    assert!(matches!(refused, Error::Unproved(_)) && refused.exit_code() == 3, "{refused}");
    let usage = removed(&Look { strength: 2.0, ..gaussian(0.1, 0.5) }, &clean, 1e-3).err().unwrap();
    assert!(matches!(usage, Error::Usage(_)), "{usage}");
}

/// A veil of another strength, or an answer that is off in one place, is told from the right one.
#[test]
fn a_wrong_answer_is_told() {
    let (clean, look) = (room(), gaussian(0.15, 0.1));
    let photo = veiled(&look, &clean);
    let Removed { photo: other, removal, .. } = removed(&gaussian(0.15, 0.12), &photo, 1e-4).unwrap();
    assert!(apart(&other, &clean) > 20.0 * removal.unwrap().error.predicted);
    let frame = look.frame(&photo).unwrap();
    let wanted = look.veil.as_ref().unwrap();
    let (_, seat) = seated(&look, wanted, &photo, &frame).unwrap();
    let emission = Emission::of(&photo);
    let mut operator = Operator::new(wanted, seat, 1.0, &photo.pixels, emission, [1e-3, 1e-3]).unwrap();
    let bounds = Bound::all(&mut operator).unwrap();
    let held = |pixels: &[[f32; 4]]| measured(&operator, &photo, pixels, &bounds, &Removing::default()).unwrap().0;
    assert!(held(&clean.pixels) < 1e-6);
    let mut wrong = clean.pixels.clone();
    wrong[500][1] += 0.2;
    assert!(held(&wrong) > 1e-3);
}

#[test]
fn without_a_veil_the_photo_stays_bit_for_bit() {
    let mut photo = room();
    photo.pixels[3] = [f32::NAN, -0.0, f32::INFINITY, 1.0];
    let none = gaussian(0.1, 0.2);
    for look in [Look { strength: 0.0, ..none.clone() }, Look { veil: None, ..none }] {
        let Removed { photo: same, removal, .. } = removed(&look, &photo, 1e-4).unwrap();
        let bits = |photo: &Photo| photo.pixels.iter().flatten().map(|value| value.to_bits()).collect::<Vec<_>>();
        assert!(removal.is_none() && bits(&same) == bits(&photo));
    }
}

#[test]
fn pictures_of_one_pixel_black_ones_and_huge_ones_come_back() {
    for look in [gaussian(0.4, 0.3), cie(0.3, Projection::Rectilinear)] {
        let one = Photo::new(1, 1, vec![[0.7, 0.0, 1.0, 1.0]]);
        let clean = removed(&look, &veiled(&look, &one), 1e-5).unwrap().photo;
        assert!((clean.pixels[0][0] - 0.7).abs() < 1e-5 && clean.pixels[0][1] == 0.0, "{:?}", clean.pixels);
        let black = Photo::new(9, 7, vec![[0.0, 0.0, 0.0, 1.0]; 63]);
        let answer = removed(&look, &black, 1e-5).unwrap();
        assert!(answer.photo.pixels == black.pixels && answer.removal.unwrap().error.predicted == 0.0);
        let mut bright = room();
        bright.pixels.iter_mut().for_each(|pixel| pixel[..3].iter_mut().for_each(|value| *value *= 1e36));
        let clean = removed(&look, &veiled(&look, &bright), 1e-4).unwrap().photo;
        assert!(apart(&clean, &bright) < 1e-4);
        bright.pixels[0][0] = 0.9 * f32::MAX;
        let beyond = removed(&look, &bright, 1e-4).err().unwrap();
        assert!(matches!(beyond, Error::PictureNotFinite { pixels: 1 }), "{beyond}");
    }
}

#[test]
fn what_is_no_light_stays_and_what_is_hidden_counts_by_its_share() {
    let look = gaussian(0.15, 0.2);
    let mut clean = room();
    clean.source.alpha = Alpha::Straight;
    clean.pixels.iter_mut().step_by(3).for_each(|pixel| pixel[3] = 0.25);
    clean.pixels[100] = [f32::NAN, 1.0, f32::INFINITY, 1.0];
    clean.frame = clean.frame.with_window(Window { x: 4, y: -3, ..clean.frame.window });
    let exact = Wanted::new(&VeilSection { tolerance: Some(1e-4), ..look.veil.as_ref().unwrap().section() }, false);
    let photo = applied(&Look { veil: Some(exact.unwrap()), ..look.clone() }, &clean);
    let Removed { photo, removal, .. } = removed(&look, &photo, 1e-4).unwrap();
    let removal = removal.unwrap();
    assert_eq!((removal.no_light.nan, removal.no_light.infinite), ([1, 0, 0], [0, 0, 1]));
    assert!(photo.pixels[100][0].is_nan() && photo.pixels[100][2] == f32::INFINITY);
    assert!(photo.pixels.iter().zip(&clean.pixels).all(|(a, b)| a[3] == b[3]));
    let finite = |photo: &Photo| {
        let mut photo = photo.clone();
        photo.pixels[100] = [0.0; 4];
        photo
    };
    assert!(apart(&finite(&photo), &finite(&clean)) < 2e-4);
}

#[test]
fn clipped_and_negative_samples_are_told() {
    let look = gaussian(0.15, 0.3);
    let mut photo = room();
    let removing = Removing { clip: Some(4.0), clamp: true, ..Removing::default() };
    let answer = remove(&look, photo.clone(), removing, &mut Stages::default()).unwrap();
    let clipping = answer.clipping.unwrap();
    let above = photo.pixels.iter().filter(|pixel| pixel[..3].iter().any(|value| *value >= 4.0)).count();
    assert!(clipping.pixels == above && above > 10, "{clipping:?}");
    assert_eq!(answer.clipped.iter().filter(|clipped| **clipped).count(), above);
    // The dark room holds less than such a veil of its lights.
    let negative = answer.removal.unwrap().negative;
    assert!(negative.surely > 100 && negative.clamped && negative.deepest > 1e-3, "{negative:?}");
    assert!(answer.photo.pixels.iter().all(|pixel| pixel[..3].iter().all(|value| *value >= 0.0)));
    assert!(answer.warnings.iter().any(|warning| warning.contains("more than the photo holds")));
    let kept = removed(&look, &photo, 1e-4).unwrap();
    assert!(kept.clipping.is_none() && kept.photo.pixels.iter().any(|pixel| pixel[0] < 0.0));
    // A display's white is known.
    photo.source.display_referred = true;
    assert_eq!(removed(&look, &photo, 1e-4).unwrap().clipping.unwrap().level, crate::scene::DISPLAY_WHITE);
}
