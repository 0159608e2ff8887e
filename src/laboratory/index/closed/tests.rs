use super::*;
use crate::laboratory::index::field::Field;
use crate::look::Veil;
use crate::photo::View;
use crate::psf::{Name, Parameters};
use crate::scene::{Optical, OpticsSection, VeilSection};

fn look_of(parameters: Parameters) -> Look {
    let none = LookLens::from(crate::scene::named_lens(std::path::Path::new("none"), &Default::default()).unwrap());
    let section = VeilSection { parameters, fov: None, projection: None, border: None, tolerance: Some(1e-3) };
    let look = Look { fov: Some(40.0), ..Look::default() }.through(none, false).unwrap();
    Look { veil: Some(Veil::new(&section, false).unwrap()), ..look }
}

fn frame(look: &Look, size: [u32; 2]) -> Frame {
    let frame = Frame::full(size[0], size[1]);
    look.in_unit(frame, || Ok(View::of_field(40.0, &frame, look.projection()))).unwrap()
}

/// A veil on the plane and one on the sphere, beside the chart as the CPU sums it.
#[test]
fn veils_have_the_index_of_their_charts() {
    // So fine that pixels have the camera's core, and about that of the eye.
    let field = Field::new([480, 320], 40.0);
    let places = field.places(3.0, 3.0).unwrap();
    let eye = Parameters { age: Some(60.0), ..Parameters::new(Name::Cie) };
    for (parameters, close) in [(Parameters::new(Name::Camera), 2e-3), (eye, 6e-3)] {
        let look = look_of(parameters);
        let frame = frame(&look, field.size);
        let rendered = crate::laboratory::index::indices(&look, &field, &places, 3.0, 1.0, None).unwrap();
        let model = Model::new(&look, frame, field.focal).unwrap();
        let on_plane: Vec<Place> = places
            .iter()
            .map(|place| Place {
                name: Some(place.name),
                at: frame.position(place.pixel[0] as f64, place.pixel[1] as f64),
            })
            .collect();
        for (closed, rendered) in model.indices(&on_plane, 3.0).unwrap().iter().zip(&rendered) {
            let off = (closed.index[1] - rendered.index[1]).abs();
            assert!(off < rendered.bound[1].max(close * rendered.index[1]), "{closed:?} {rendered:?}");
            assert!((closed.off_axis_degrees - rendered.off_axis_degrees).abs() < 1e-6 && closed.ghosts == [0.0; 3]);
            assert!((closed.index[1] - closed.veil[1]).abs() < 1e-15 && closed.place == Some(rendered.place));
        }
    }
}

fn through(section: OpticsSection) -> Look {
    let look = Look { unit: crate::choices::LengthUnit::ShortSide, ..Look::default() };
    let look = look.through(LookLens::Optical(Optical::new(section).unwrap()), false).unwrap();
    Look { fov: Some(40.0), ..look }
}

#[test]
fn angles_have_room_in_the_picture_or_are_refused_with_the_room_there_is() {
    let look = through(OpticsSection { lens: Some("triplet".into()), ..OpticsSection::default() });
    let frame = frame(&look, [300, 200]);
    let fitted = look.fitted(&frame);
    let model = Model::new(&fitted, frame, Field::new([300, 200], 40.0).focal).unwrap();
    let places = model.on_diagonal(&[0.0, 10.0], 1.0).unwrap();
    assert!(places[0].at == DVec2::ZERO && places[1].at.x > 0.0 && places[1].at.y > 0.0);
    assert!((places[1].at.x / places[1].at.y - 1.5).abs() < 1e-12);
    let [one] = model.indices(&places[1..], 1.0).unwrap().try_into().unwrap();
    assert!((one.off_axis_degrees - 10.0).abs() < 1e-9, "{one:?}");
    assert!(
        (0..3).all(|c| one.ghosts[c] > 0.0 && one.veil[c] > 0.0 && one.field[c] > 0.9 && one.field[c] < 1.01),
        "{one:?}"
    );
    for (angle, told) in [(22.0, "angles from 0 to"), (89.0, "angles from 0 to"), (95.0, "beyond the picture's edge")] {
        let refused = model.on_diagonal(&[angle], 1.0).unwrap_err().to_string();
        assert!(refused.contains("--angles") && refused.contains(told), "{refused}");
    }
    assert!(model.on_diagonal(&[0.0], 30.0).unwrap_err().to_string().contains("no angle at all"));
    let both = [Place { name: None, at: DVec2::ZERO }, Place { name: None, at: DVec2::new(0.05, 0.0) }];
    assert!(model.indices(&both, 4.0).unwrap_err().to_string().contains("overlap"));
}

#[test]
fn looks_without_a_closed_form_say_why() {
    let look = through(OpticsSection { lens: Some("triplet".into()), ..OpticsSection::default() });
    assert_eq!(refusal(&look), None);
    let preset = Look::default();
    assert!(refusal(&preset).unwrap().contains("known by their surfaces"));
    let moved = Look { axis: DVec2::X, ..look.clone() };
    assert!(refusal(&moved).unwrap().contains("--axis"));
    let mut lights = look.clone();
    lights.shine_by(crate::choices::Sources::Lights);
    assert!(refusal(&lights).unwrap().contains("--sources photo"));
    let normalised = Look { normalize: Normalize::Minmax, ..look };
    assert!(refusal(&normalised).unwrap().contains("normalised"));
}

/// Near the axis, stopped down and bare, rays go where matrices say.
#[test]
fn rays_hold_the_closed_form_where_they_are_paraxial() {
    let section = OpticsSection {
        lens: Some("double-gauss".into()),
        fstop: Some(16.0),
        sensor: Some([6.0, 4.0]),
        coating: Some("none".into()),
        blades: Some(0),
        ..OpticsSection::default()
    };
    let look = Look { veil: None, ..through(section) };
    let frame = frame(&look, [300, 200]);
    let LookLens::Optical(optical) = &look.lens else { unreachable!("it is one") };
    let fov = 2.0 * (3.0 / optical.ghosts().image_per_tangent).atan().to_degrees();
    let fitted = look.fitted(&frame);
    let model = Model::new(&fitted, frame, Field::new([300, 200], fov).focal).unwrap();
    let system = rays::system(&model).unwrap();
    let tracing = rays::Tracing::new(&model, &system, 2048).unwrap();
    let place = Place { name: None, at: DVec2::new(0.3, 0.2) };
    let [closed] = model.indices(&[place], 0.5).unwrap().try_into().unwrap();
    let traced = tracing.index(&model, &[place], &place, &closed).unwrap();
    assert_eq!(traced, tracing.index(&model, &[place], &place, &closed).unwrap(), "it is the same again");
    let ([mean, interval], wanted) = (traced.luminance, traced.closed());
    // Rays are of two reflections; those of four have some of the light, too.
    let more = crate::laboratory::index::told::luminance(closed.ghosts) / wanted - 1.0;
    assert!((0.01..0.1).contains(&more), "{more}");
    assert!(
        (mean - wanted).abs() < interval + 0.01 * wanted && interval < 0.02 * wanted,
        "{wanted}: {mean} ± {interval}"
    );
    let sum = |of: fn(&rays::OfPath) -> f64| traced.paths.iter().map(of).sum::<f64>();
    assert!((sum(|path| path.rays) / mean - 1.0).abs() < 1e-9);
}
